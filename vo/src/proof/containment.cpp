// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/containment.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/shape_numbers.h"
#include "proof/certificate_words.h"

namespace exactvo::vo {
namespace {

using geometry::Ellipse;
using geometry::hex_text;
using geometry::Vec2;
using Rational = mpq_class;

bool is_well_formed(const Ellipse& e, const std::vector<Vec2>& points) {
  const auto finite = [](Vec2 x) { return is_finite(x); };
  return is_finite(e.center) && std::isfinite(e.l11) && std::isfinite(e.l21) && std::isfinite(e.l22) && e.l11 != 0.0 &&
         e.l22 != 0.0 && !points.empty() && std::all_of(points.begin(), points.end(), finite);
}

/// 1 - |L^-1 (x - c)|^2 by forward substitution.
Rational room(const Ellipse& e, Vec2 x) {
  const Rational first = (Rational(x.x) - Rational(e.center.x)) / Rational(e.l11);
  const Rational second = (Rational(x.y) - Rational(e.center.y) - Rational(e.l21) * first) / Rational(e.l22);
  return 1 - first * first - second * second;
}

Rational least_room(const Ellipse& e, const std::vector<Vec2>& points) {
  Rational least = room(e, points.front());
  for (const Vec2 x : points) least = std::min(least, room(e, x));
  return least;
}

std::uint64_t digest_of(const Containment& c) {
  detail::Fnv hash;
  for (const double x : geometry::numbers_of(c.ellipse)) hash.add(x);
  hash.add(static_cast<std::uint64_t>(c.points.size()));
  for (const Vec2 x : c.points) hash.add(x);
  hash.add(c.margin);
  return hash.value();
}

}  // namespace

std::optional<Containment> certify_containment(const Ellipse& ellipse, std::vector<Vec2> points) {
  if (!is_well_formed(ellipse, points)) return std::nullopt;
  const Rational least = least_room(ellipse, points);
  if (sgn(least) < 0) return std::nullopt;
  Containment c{ellipse, std::move(points), least.get_d(), 0};  // get_d truncates: down, as it is not negative
  c.digest = digest_of(c);
  return c;
}

Verdict check(const Containment& c) {
  if (!is_well_formed(c.ellipse, c.points) || !std::isfinite(c.margin)) return Verdict::malformed;
  const Rational least = least_room(c.ellipse, c.points);
  if (c.margin < 0.0 || sgn(least) < 0 || least.get_d() != c.margin) return Verdict::wrong_margin;
  return digest_of(c) == c.digest ? Verdict::valid : Verdict::altered;
}

std::string write_containment(const Containment& c) {
  std::string text = "containment-certificate 1 " + to_string(geometry::ConvexShape{c.ellipse}) + " points " +
                     geometry::to_string(c.points);
  return text + " margin " + hex_text(c.margin) + " digest " + detail::digest_text(c.digest);
}

std::optional<Containment> read_containment(const std::string& text) {
  detail::Reader in(text);
  Containment c;
  for (const char* word : {"containment-certificate", "1", "ellipse"}) in.expect(word);
  c.ellipse.center = in.point();
  for (double* number : {&c.ellipse.l11, &c.ellipse.l21, &c.ellipse.l22}) *number = in.number();
  in.expect("points");
  const auto count = in.integer<std::size_t>(10);
  for (std::size_t k = 0; k < count && in.ok(); ++k) c.points.push_back(in.point());
  in.read("margin", c.margin);
  c.digest = in.digest();
  if (!in.finished() || write_containment(c) != text) return std::nullopt;
  return c;
}

}  // namespace exactvo::vo
