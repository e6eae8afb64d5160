// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/shape_numbers.h"

#include <variant>

namespace exactvo::geometry {

std::vector<double> numbers_of(const ConvexShape& shape) {
  if (const auto* d = std::get_if<Disc>(&shape)) return {d->center.x, d->center.y, d->radius};
  if (const auto* e = std::get_if<Ellipse>(&shape)) return {e->center.x, e->center.y, e->l11, e->l21, e->l22};
  std::vector<double> all;
  for (const Vec2 v : corners_of(shape)) all.insert(all.end(), {v.x, v.y});
  return all;
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
