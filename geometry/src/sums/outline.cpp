// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

constexpr double kHalfPi = 1.57079632679489661923;
/// Quarter turns are halved this often at most: 2^-22 rad.
constexpr int kMostHalvings = 22;

// A point of the boundary and the direction (angle of the normal) in which it is outermost.
struct Contact {
  double angle = 0.0;
  Vec2 point;
};

Contact contact_at(const GrownShape& shape, double angle) {
  return {angle, support_point(shape, {std::cos(angle), std::sin(angle)})};
}

// The height of the triangle of chord and tangents, at most: it is largest when isosceles.
//
//              . apex               angle theta = b.angle - a.angle
//          .       .                height <= chord/2 tan(theta/2)
//      a ------------- b
double sagitta(const Contact& a, const Contact& b) {
  return 0.5 * norm(b.point - a.point) * std::tan(0.5 * (b.angle - a.angle));
}

class Tracer {
 public:
  Tracer(const GrownShape& shape, double tolerance) : shape_(shape), tolerance_(tolerance) {}

  Outline trace() {
    Contact from = contact_at(shape_, 0.0);
    append(from.point);
    for (int quarter = 1; quarter <= 4; ++quarter) {
      const Contact to = contact_at(shape_, quarter * kHalfPi);
      refine(from, to, kMostHalvings);
      from = to;
    }
    if (outline_.ring.size() > 1 && outline_.ring.back() == outline_.ring.front()) outline_.ring.pop_back();
    return outline_;
  }

 private:
  void refine(const Contact& a, const Contact& b, int halvings) {
    const double height = sagitta(a, b);
    if (height <= tolerance_ || halvings == 0) {
      outline_.error = std::max(outline_.error, height);
      append(b.point);
      return;
    }
    const Contact middle = contact_at(shape_, 0.5 * (a.angle + b.angle));
    refine(a, middle, halvings - 1);
    refine(middle, b, halvings - 1);
  }

  void append(Vec2 p) {
    if (outline_.ring.empty() || outline_.ring.back() != p) outline_.ring.push_back(p);
  }

  const GrownShape& shape_;
  double tolerance_;
  Outline outline_;
};

}  // namespace

Outline outline(const GrownShape& shape, double tolerance) {
  EXACTVO_REQUIRE(tolerance > 0.0, hex_text(tolerance));
  EXACTVO_REQUIRE(is_valid(shape.shape) && is_finite(shape.origin) && shape.radius >= 0.0, to_string(shape.shape));
  return Tracer(shape, tolerance).trace();
}

}  // namespace exactvo::geometry
