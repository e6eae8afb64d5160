// SPDX-License-Identifier: GPL-3.0-or-later
#include "instances.h"

#include <cmath>

#include "exactvo/geometry/pi.h"

namespace exactvo::bench {
namespace {

using geometry::kPi;
using geometry::Vec2;

geometry::ConvexPolygon polygon(Stream& random, Vec2 centre, int count) {
  geometry::ConvexPolygon out;
  const double aspect = random.uniform(0.3, 1.0);
  const double turn = random.uniform(0.0, kPi);
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * (i + random.uniform(0.1, 0.9)) / count;
    out.vertices.push_back(centre + geometry::rotated({std::cos(angle), aspect * std::sin(angle)}, turn));
  }
  return out;
}

}  // namespace

geometry::ConvexShape random_shape(Stream& random, Obstacle kind, Vec2 centre) {
  switch (kind) {
    case Obstacle::disc:
      return geometry::Disc{centre, random.uniform(0.2, 1.0)};
    case Obstacle::polygon8:
      return polygon(random, centre, 8);
    case Obstacle::polygon16:
      return polygon(random, centre, 16);
    case Obstacle::segment: {
      const Vec2 half = random.direction();
      return geometry::Segment{centre - half, centre + half};
    }
    case Obstacle::ellipse:
      break;
  }
  return geometry::ellipse_from_axes(centre, {1.0, random.uniform(0.1, 1.0), random.uniform(-0.5 * kPi, 0.5 * kPi)});
}

double Stream::uniform(double low, double high) {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return low + (high - low) * (static_cast<double>(z >> 11) * 0x1p-53);
}

Vec2 Stream::direction() {
  const double angle = uniform(-kPi, kPi);
  return {std::cos(angle), std::sin(angle)};
}

Instance random_instance(Stream& random, Obstacle kind) {
  const Vec2 origin{random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0)};
  const double radius = random.uniform(0.2, 0.6);
  const Vec2 centre = origin + (1.0 + radius + random.uniform(0.05, 5.0)) * random.direction();
  Instance out{{random_shape(random, kind, centre), origin, radius}, random.uniform(0.5, 4.0), {}};
  const bool aimed = random.uniform(0.0, 1.0) < 0.5;
  const Vec2 direction = random.direction();
  const double turn = random.uniform(-0.6, 0.6);
  out.velocity = random.uniform(0.0, 2.0) * (aimed ? geometry::rotated(normalized(centre - origin), turn) : direction);
  return out;
}

std::vector<Instance> random_instances(Obstacle kind, std::size_t count, std::uint64_t seed) {
  Stream random(seed);
  std::vector<Instance> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back(random_instance(random, kind));
  return out;
}

}  // namespace exactvo::bench
