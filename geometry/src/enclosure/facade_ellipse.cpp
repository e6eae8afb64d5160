// SPDX-License-Identifier: GPL-3.0-or-later
// The ellipse of one facade, in closed form (paper, equation (8)), and the inflation that certifies ellipses.
#include <algorithm>
#include <cmath>
#include <string>

#include "enclosure/ellipse_solver.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {

Ellipse facade_ellipse(const Segment& facade, const FacadeEllipseOptions& options) {
  EXACTVO_REQUIRE(is_finite(facade.a) && is_finite(facade.b), to_string(ConvexShape{facade}));
  EXACTVO_REQUIRE(options.fixed_minor > 0.0 || options.minor_to_major > 0.0, std::to_string(options.minor_to_major));
  const Vec2 along = facade.b - facade.a;
  const double half = 0.5 * norm(along);
  const double a = half + options.margin;
  const double b = options.fixed_minor > 0.0 ? std::min(options.fixed_minor, a) : options.minor_to_major * a;
  const Ellipse e = ellipse_from_axes(facade.a + 0.5 * along, {a, b, std::atan2(along.y, along.x)});
  const std::optional<Ellipse> whole = detail::inflate_to_contain(e, {facade.a, facade.b});
  EXACTVO_REQUIRE(whole.has_value(), to_string(ConvexShape{e}));
  return *whole;
}

double clearance_of_equation_8(const Segment& facade, const Ellipse& enclosure, double robot_radius) {
  const EllipseAxes axes = axes_of(enclosure);
  const double half = 0.5 * norm(facade.b - facade.a);
  const double a = axes.a, b = axes.b;
  const bool rounded_end = half >= a - b * b / a;
  const double depth = rounded_end ? a - half : b * std::sqrt(1.0 - half * half / (a * a - b * b));
  return robot_radius + depth;
}

}  // namespace exactvo::geometry
