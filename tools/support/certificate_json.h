// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What certificates in JSON have in common: obstacles and lists of points. What cannot be read throws
/// OrderedJson::exception or std::invalid_argument. (No number that was parsed is infinite.)

#include <optional>
#include <stdexcept>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "support/json_layout.h"

namespace exactvo::tools {

/// A list of [x, y].
inline OrderedJson points_json(const std::vector<geometry::Vec2>& points) {
  OrderedJson list = OrderedJson::array();
  for (const geometry::Vec2 p : points) list.push_back(json_point(p));
  return list;
}

/// {"id", "polyline"} or {"id", "polygon", "holes"}.
inline OrderedJson obstacle_json(const formation::SceneObstacle& obstacle) {
  OrderedJson json{{"id", obstacle.id}};
  if (const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape)) {
    json["polyline"] = points_json(wall->points);
    return json;
  }
  const auto& polygon = std::get<geometry::Polygon>(obstacle.shape);
  json["polygon"] = points_json(polygon.outer);
  if (polygon.holes.empty()) return json;
  json["holes"] = OrderedJson::array();
  for (const geometry::Ring& hole : polygon.holes) json["holes"].push_back(points_json(hole));
  return json;
}

inline void require_readable(bool holds) {
  if (!holds) throw std::invalid_argument("");
}

/// Nothing where `read` throws either.
template <typename Read>
auto read_or_nothing(const Read& read) -> std::optional<decltype(read())> try {
  return read();
} catch (const OrderedJson::exception&) {
  return std::nullopt;
} catch (const std::invalid_argument&) {
  return std::nullopt;
}

inline geometry::Vec2 pair_in(const OrderedJson& json) {
  require_readable(json.is_array() && json.size() == 2);
  return {json[0].get<double>(), json[1].get<double>()};
}

/// A list of what `read` reads, at least `least` long.
template <typename Read>
auto list_in(const OrderedJson& json, std::size_t least, const Read& read) {
  require_readable(json.is_array() && json.size() >= least);
  std::vector<decltype(read(json))> list;
  for (const OrderedJson& item : json) list.push_back(read(item));
  return list;
}

/// What `obstacle_json` writes, without its id.
inline geometry::Obstacle obstacle_in(const OrderedJson& json) {
  constexpr std::size_t kLeastOfWall = 2, kLeastOfRing = 3;
  const bool is_wall = json.contains("polyline");
  require_readable(is_wall != json.contains("polygon"));
  if (is_wall) return geometry::Polyline{list_in(json["polyline"], kLeastOfWall, pair_in)};
  const auto ring_in = [](const OrderedJson& ring) { return list_in(ring, kLeastOfRing, pair_in); };
  geometry::Polygon polygon{ring_in(json["polygon"]), {}};
  if (json.contains("holes")) polygon.holes = list_in(json["holes"], 0, ring_in);
  return polygon;
}

/// Null where there is none.
inline const OrderedJson* member(const OrderedJson& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

}  // namespace exactvo::tools
