// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes, NaN and infinities included, as input of the constructions: what they certify holds in rationals, what
// they refuse is a std::logic_error, and nothing else leaves them.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include "bytes.h"
#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/validity.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/family.h"
#include "exactvo/vo/free_velocities.h"
#include "geometry/rational_oracle.h"

namespace exactvo::fuzz {
namespace {

[[noreturn]] void fail(const char* what, const std::string& text) {
  std::fprintf(stderr, "# %s\n%s\n", what, text.c_str());
  std::abort();
}

/// Whether the input is one that the constructions promise to take.
bool is_place(const std::vector<Vec2>& points) {
  for (const Vec2 p : points)
    if (!(std::fabs(p.x) < 0x1p900 && std::fabs(p.y) < 0x1p900)) return false;
  return true;
}

/// Runs it; a refusal of good input is a failure, and so is any that CGAL has to make.
template <class Work>
void guarded(bool good, const std::string& text, const Work& work) {
  try {
    work();
  } catch (const std::logic_error& refusal) {
    if (good || std::strstr(refusal.what(), "CGAL") != nullptr) fail(refusal.what(), text);
  }
}

void examine_points(const std::vector<Vec2>& points) {
  const std::string text = "ring " + geometry::to_string(points);
  const bool good = is_place(points);
  guarded(good, text, [&] {
    const geometry::Ellipse ellipse = geometry::fast_smallest_ellipse(points).ellipse;
    for (const Vec2 p : points)
      if (!test::in_ellipse(ellipse, p)) fail("a point outside its ellipse", text);
  });
  guarded(good, text, [&] {
    const geometry::Disc disc = geometry::smallest_circle(points);
    for (const Vec2 p : points)
      if (!test::in_disc(disc, p)) fail("a point outside its circle", text);
  });
  guarded(false, text, [&] {
    const geometry::NormalizedPolygon polygon = geometry::normalize({points});
    if (polygon.ok()) (void)geometry::convex_pieces(polygon.polygon.outer);
  });
}

void examine_sum(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  const std::string text = "ring " + geometry::to_string(a) + " (+) " + geometry::to_string(b);
  guarded(false, text, [&] { (void)geometry::minkowski_sum(geometry::ConvexPolygon{a}, geometry::ConvexPolygon{b}); });
  if (!is_place(a) || !is_place(b)) return;
  const geometry::ConvexPolygon p = geometry::convex_hull(a), q = geometry::convex_hull(b);
  guarded(true, text, [&] {
    const geometry::ConvexSum sum = geometry::minkowski_sum(p, q);
    if (!is_valid(geometry::ConvexShape{sum.polygon})) fail("a sum that is not convex", text);
  });
}

/// The bounds of what one cone leaves, asked at its apex, at a velocity and at the corners of the bounds.
void examine_free(const vo::ShiftedCone& cone, Vec2 velocity, double speed, const std::string& text) {
  if (!(std::fabs(cone.apex.x) <= vo::kMostApex && std::fabs(cone.apex.y) <= vo::kMostApex)) return;
  const vo::FreeVelocities free({cone}, {speed, 1e-2});
  std::vector<Vec2> asked{cone.apex, velocity, {}, {speed, 0.0}};
  for (const geometry::Region* region : {&free.inner(), &free.outer()})
    for (const auto& piece : region->pieces())
      asked.insert(asked.end(), piece.polygon.outer.begin(), piece.polygon.outer.end());
  for (const Vec2 v : asked) {
    const bool is_free = free.contains(v);
    if (!is_free && free.inner().locate(v) == geometry::Place::inside) fail("a collision called free", text);
    if (is_free && free.outer().locate(v) == geometry::Place::outside) fail("a free velocity left out", text);
  }
}

void examine_encounter(Bytes& bytes) {
  vo::Encounter e;
  e.obstacle = bytes.shape();
  e.position = bytes.point();
  e.radius = bytes.length();
  e.velocity = bytes.point();
  e.obstacle_velocity = bytes.point();
  e.time_horizon = bytes.length();
  e.responsibility = 1.0;
  const int kind = bytes.byte();
  if (kind % 3 == 0) e.robot = geometry::convex_hull(bytes.points());
  if (kind % 5 == 0) e.time_horizon = INFINITY;
  if (e.time_horizon == 0.0) return;
  const double length = bytes.length();
  const double speed = length > 0.0 ? length : 1.0;
  const std::string text = to_string(e.obstacle);
  guarded(true, text, [&] {
    for (const vo::Variant v : {vo::Variant::vo, vo::Variant::rvo, vo::Variant::hrvo, vo::Variant::orca}) {
      const vo::Member member = vo::family_member(v, e);
      if (member.cone) examine_free(*member.cone, e.velocity, speed, text);
      if (v != vo::Variant::orca || !member.half_plane || e.robot) continue;
      if (!vo::is_true({e.obstacle, e.position, e.radius, e.time_horizon, e.obstacle_velocity, *member.half_plane}))
        fail("an unsafe half-plane", text);
    }
  });
}

void examine(Bytes bytes) {
  const int what = bytes.byte() % 3;
  if (what == 0) examine_points(bytes.points(true));
  if (what == 1) {
    const std::vector<Vec2> a = bytes.points(true);
    examine_sum(a, bytes.points(true));
  }
  if (what == 2) examine_encounter(bytes);
}

}  // namespace
}  // namespace exactvo::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  exactvo::fuzz::examine({data, size});
  return 0;
}
