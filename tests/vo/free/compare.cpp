// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/excerpt.h"
#include "exactvo/vo/free_velocities.h"
#include "vo/free/oracle.h"

namespace exactvo::test {
namespace {

using geometry::Vec2;
using vo::FreeVelocities;

/// Sums of as many areas as a scene has faces, in doubles: shares of the disc's area.
constexpr double kRounded = 1e-12;

std::string bracket_text(double low, double high) {
  return geometry::hex_text(low) + " to " + geometry::hex_text(high);
}

std::string compare_areas(const FreeScene& scene, const FreeVelocities& free, const std::vector<OracleFace>& faces) {
  double low = 0.0, high = 0.0;
  for (const OracleFace& face : faces) {
    low += face.area_low;
    high += face.area_high;
  }
  const geometry::Bracket area = free.area();
  const double slack = kRounded * 4.0 * scene.max_speed * scene.max_speed;
  if (area.low <= high + slack && low - slack <= area.high) return "";
  return "the area is " + bracket_text(low, high) + ", not " + bracket_text(area.low, area.high) + "; ";
}

std::string compare_membership(const FreeScene& scene, const FreeVelocities& free, SeededRandom& random) {
  std::vector<Vec2> samples;
  for (int k = 0; k < 10; ++k) samples.push_back(random.in_box(scene.max_speed));
  for (const geometry::Region* region : {&free.inner(), &free.outer()})
    for (const geometry::Region::Piece& piece : region->pieces())
      samples.insert(samples.end(), piece.polygon.outer.begin(), piece.polygon.outer.end());
  for (const SceneCone& cone : scene.cones) samples.push_back(cone.apex);
  for (const Vec2 v : samples)
    if (free.contains(v) != is_free(scene, v))
      return "contains(" + geometry::hex_text(v.x) + ", " + geometry::hex_text(v.y) + "); ";
  return "";
}

}  // namespace

std::string difference_from_oracle(const FreeScene& scene, SeededRandom& random) {
  const std::vector<OracleFace> faces = free_faces(scene);
  const FreeVelocities free(cones_of(scene), {scene.max_speed});
  std::string wrong = compare_areas(scene, free, faces);
  if (free.least_components() > faces.size())
    wrong += "at least " + std::to_string(free.least_components()) + " components, the oracle has " +
             std::to_string(faces.size()) + "; ";
  return wrong + compare_membership(scene, free, random);
}

}  // namespace exactvo::test
