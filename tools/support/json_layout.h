// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// JSON as people read it.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "exactvo/geometry/region.h"
#include "exactvo/geometry/vec2.h"
#include "support/unsigned_zero.h"

namespace exactvo::tools {

/// Keys stay in the order in which they were added.
using OrderedJson = nlohmann::ordered_json;

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

}  // namespace exactvo::tools
