// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/shape_numbers.h"

#include <utility>
#include <variant>

namespace exactvo::geometry {
namespace {

struct NumbersOf {
  std::vector<double> operator()(const Disc& s) const { return {s.center.x, s.center.y, s.radius}; }
  std::vector<double> operator()(const Segment& s) const { return {s.a.x, s.a.y, s.b.x, s.b.y}; }
  std::vector<double> operator()(const ConvexPolygon& s) const {
    std::vector<double> all;
    for (const Vec2 v : s.vertices) all.push_back(v.x), all.push_back(v.y);
    return all;
  }
  std::vector<double> operator()(const Ellipse& s) const { return {s.center.x, s.center.y, s.l11, s.l21, s.l22}; }
};

}  // namespace

std::vector<double> numbers_of(const ConvexShape& shape) {
  return std::visit(NumbersOf{}, shape);
}

std::optional<ConvexShape> shape_of(std::size_t kind, const std::vector<double>& v) {
  if (kind == 0 && v.size() == 3) return Disc{{v[0], v[1]}, v[2]};
  if (kind == 1 && v.size() == 4) return Segment{{v[0], v[1]}, {v[2], v[3]}};
  if (kind == 3 && v.size() == 5) return Ellipse{{v[0], v[1]}, v[2], v[3], v[4]};
  if (kind != 2 || v.size() % 2 != 0) return std::nullopt;
  ConvexPolygon polygon;
  for (std::size_t k = 0; k < v.size(); k += 2) polygon.vertices.push_back({v[k], v[k + 1]});
  return polygon;
}

}  // namespace exactvo::geometry
