// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a shape, a point, a direction and a half-plane: each predicate against the rational oracle.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bytes.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/swept.h"
#include "geometry/exact_oracle.h"
#include "geometry/rational_oracle.h"

namespace exactvo::fuzz {
namespace {

using geometry::GrownShape;
using geometry::HalfPlane;

/// The corpus format (tests/corpus/README.md): the shape's word and numbers, then origin, radius and what was asked.
[[noreturn]] void fail(const char* what, const GrownShape& s, std::initializer_list<double> asked) {
  std::string line = to_string(s.shape);
  for (const double x : {s.origin.x, s.origin.y, s.radius}) line += " " + geometry::hex_text(x);
  for (const double x : asked) line += " " + geometry::hex_text(x);
  std::fprintf(stderr, "# %s\n%s\n", what, line.c_str());
  std::abort();
}

/// Its nearest-point oracle is for ellipses with an area, and ends on a touch only after long halving: the touching
/// answers are left to the constructed tests.
bool oracle_can_place(const GrownShape& s) {
  const auto* e = std::get_if<geometry::Ellipse>(&s.shape);
  return e == nullptr || (e->l11 != 0.0 && e->l22 != 0.0);
}

void examine_place(const GrownShape& s, Vec2 q) {
  if (!oracle_can_place(s)) {
    (void)locate(s, q);
    return;
  }
  const int expected = test::place_in(s, test::exactly(q));
  const int found = static_cast<int>(locate(s, q));
  const bool ellipse = std::holds_alternative<geometry::Ellipse>(s.shape);
  if (found != expected && !(ellipse && expected == 0)) fail("place", s, {q.x, q.y});
}

void examine_support(const GrownShape& s, Vec2 n, double tau, double c) {
  const int expected = test::sign_of_support_minus(s, test::exactly(n), test::Q(tau) * test::Q(c));
  if (static_cast<int>(sign_of_support(s, n, tau, c)) != expected) fail("support", s, {n.x, n.y, tau, c});
  const HalfPlane h{n, c};
  if (tau > 0.0 && half_plane_is_safe(s, tau, h) != test::is_safe(s, tau, h)) fail("safe", s, {n.x, n.y, tau, c});
}

/// By the definition for shapes with corners; for all: grows with time, and both ends are met.
void examine_motion(const GrownShape& s, Vec2 v, double t) {
  const bool met = segment_meets(s, v, t);
  if (met && !segment_meets(s, v, 2.0 * t)) fail("later is not met", s, {v.x, v.y, t});
  if (!met && locate(s, {}) != geometry::Place::outside) fail("starts inside", s, {v.x, v.y, t});
  if (met && !segment_meets(s, geometry::VectorSum{{v}}, 0x1p900 > t ? INFINITY : t))
    fail("never met", s, {v.x, v.y, t});
  if (met != segment_meets(s, geometry::VectorSum{{v, v, -v}}, t)) fail("a sum of velocities", s, {v.x, v.y, t});
}

void examine(Bytes bytes) {
  const GrownShape s = bytes.grown();
  const Vec2 q = bytes.point(), n = bytes.point();
  const double tau = bytes.length(), c = bytes.number();
  examine_place(s, q);
  examine_support(s, n, tau, c);
  examine_motion(s, q, tau);
  if (const auto* e = std::get_if<geometry::Ellipse>(&s.shape)) {
    if (contains(*e, q) != test::in_ellipse(*e, q)) fail("in the ellipse", s, {q.x, q.y});
    (void)goal_outside_evolute(*e, q);
  }
}

}  // namespace
}  // namespace exactvo::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  exactvo::fuzz::examine({data, size});
  return 0;
}
