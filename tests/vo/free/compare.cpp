// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "exactvo/geometry/excerpt.h"
#include "exactvo/vo/free_arrangement.h"
#include "vo/free/oracle.h"

namespace exactvo::test {
namespace {

using geometry::Vec2;
using vo::FreeArc;
using vo::FreeArrangement;
using vo::FreePiece;

/// Rounding of a sum of lengths in doubles.
constexpr double kRounded = 1e-9;

bool are_one(const vo::PointBracket& a, const vo::PointBracket& b) {
  return a.x.low == b.x.low && a.x.high == b.x.high && a.y.low == b.y.low && a.y.high == b.y.high;
}

Vec2 middle(const vo::PointBracket& p) {
  return {0.5 * (p.x.low + p.x.high), 0.5 * (p.y.low + p.y.high)};
}

constexpr double kTurn = 2.0 * 3.14159265358979324;

/// Below this ends look alike, in rad.
constexpr double kAlike = 1e-7;

/// In (-kAlike, 2 pi). Where both ends look alike it may be a whole turn less: their doubles do not tell.
double angle_along(const FreeArc& arc) {
  const Vec2 a = middle(arc.from) - arc.center, b = middle(arc.to) - arc.center;
  const double turned = arc.turn * std::atan2(cross(a, b), dot(a, b));
  return turned < -kAlike ? turned + kTurn : turned;
}

/// All of the speed's circle, or nothing: of no other circle more than half is seen.
bool may_be_whole(const FreeArc& arc) {
  return arc.kind == vo::ArcKind::speed_circle && angle_along(arc) < kAlike;
}

double length_of(const FreeArc& arc) {
  return arc.turn == 0 ? norm(middle(arc.to) - middle(arc.from)) : arc.radius * angle_along(arc);
}

Vec2 halfway(const FreeArc& arc) {
  if (arc.turn == 0) return 0.5 * (middle(arc.from) + middle(arc.to));
  return arc.center + geometry::rotated(middle(arc.from) - arc.center, 0.5 * arc.turn * angle_along(arc));
}

std::string closure_of(const FreePiece& piece) {
  for (std::size_t k = 0; k < piece.boundary.size(); ++k) {
    const FreeArc &arc = piece.boundary[k], &next = piece.boundary[(k + 1) % piece.boundary.size()];
    if (!are_one(arc.to, next.from)) return "arc " + std::to_string(k) + " does not join the next one; ";
  }
  return "";
}

double perimeter_of(const FreePiece& piece) {
  double sum = 0.0;
  for (const FreeArc& arc : piece.boundary) sum += length_of(arc);
  return sum;
}

std::string area_text(const geometry::Bracket& b) {
  return geometry::hex_text(b.low) + " to " + geometry::hex_text(b.high);
}

/// The face that the piece is, taken out of the faces.
std::string take_face_of(const FreePiece& piece, std::vector<OracleFace>& faces) {
  const double perimeter = perimeter_of(piece);
  const auto open = std::find_if(piece.boundary.begin(), piece.boundary.end(), may_be_whole);
  const double or_this = perimeter + (open == piece.boundary.end() ? 0.0 : kTurn * open->radius);
  const auto same = std::find_if(faces.begin(), faces.end(), [&](const OracleFace& face) {
    return piece.area.low <= face.area_high && face.area_low <= piece.area.high &&
           std::min(std::fabs(face.perimeter - perimeter), std::fabs(face.perimeter - or_this)) <=
               kRounded * (1.0 + or_this);
  });
  if (same == faces.end())
    return "no component has the area " + area_text(piece.area) + " and the perimeter " + std::to_string(perimeter) +
           "; ";
  faces.erase(same);
  return "";
}

std::string compare_membership(const FreeScene& scene, const FreeArrangement& free, SeededRandom& random) {
  std::vector<Vec2> samples;
  for (int k = 0; k < 10; ++k) samples.push_back(random.in_box(scene.max_speed));
  for (const FreePiece& piece : free.pieces()) {
    for (const FreeArc& arc : piece.boundary) {
      samples.push_back(middle(arc.from));
      samples.push_back(halfway(arc));
    }
  }
  for (const SceneCone& cone : scene.cones) samples.push_back(cone.apex);
  for (const Vec2 v : samples)
    if (free.contains(v) != is_free(scene, v))
      return "contains(" + geometry::hex_text(v.x) + ", " + geometry::hex_text(v.y) + "); ";
  return "";
}

}  // namespace

std::string difference_from_oracle(const FreeScene& scene, SeededRandom& random) {
  std::vector<OracleFace> faces = free_faces(scene);
  const FreeArrangement::Attempt attempt = FreeArrangement::attempt(cones_of(scene), scene.max_speed);
  if (!attempt.free) return std::string("refused: ") + name(attempt.refusal);
  const FreeArrangement& free = *attempt.free;
  std::string wrong;
  if (free.pieces().size() != faces.size())
    wrong += std::to_string(free.pieces().size()) + " pieces, " + std::to_string(faces.size()) + " components; ";
  for (const FreePiece& piece : free.pieces()) wrong += closure_of(piece) + take_face_of(piece, faces);
  return wrong + compare_membership(scene, free, random);
}

}  // namespace exactvo::test
