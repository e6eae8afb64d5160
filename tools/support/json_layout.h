// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// JSON as people read it.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "exactvo/geometry/region.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::tools {

/// Keys stay in the order in which they were added.
using OrderedJson = nlohmann::ordered_json;

/// 0 for -0; every other number as it is.
inline double unsigned_zero(double x) {
  return x == 0.0 ? 0.0 : x;
}
inline geometry::Vec2 unsigned_zero(geometry::Vec2 v) {
  return {unsigned_zero(v.x), unsigned_zero(v.y)};
}

inline OrderedJson json_point(geometry::Vec2 v) {
  return OrderedJson::array({v.x, v.y});
}
inline OrderedJson json_bracket(const geometry::Bracket& b) {
  return OrderedJson::array({b.low, b.high});
}
template <class T>
OrderedJson json_or_null(const std::optional<T>& value) {
  return value ? OrderedJson(*value) : OrderedJson();
}

/// What fits into a line stands on one, the rest on indented lines. Zero has no sign, and what is not finite is null.
std::string laid_out(const OrderedJson& json);
/// On one line, which ends. Bytes that are no UTF-8 become U+FFFD.
std::string json_line(const OrderedJson& json);

}  // namespace exactvo::tools
