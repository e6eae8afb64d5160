// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/json_layout.h"

#include <fmt/format.h>

#include <cmath>

namespace exactvo::tools {
namespace {

constexpr std::size_t kWidth = 100;  // characters of a line

std::string leaf(const OrderedJson& json) {
  if (!json.is_number_float()) return json.dump();
  const double x = json.get<double>();
  return std::isfinite(x) ? fmt::format("{}", unsigned_zero(x)) : "null";
}

std::string laid_out(const OrderedJson& json, std::size_t indent) {
  if (!json.is_structured()) return leaf(json);
  const auto joined = [&](std::size_t deeper, const std::string& between) {
    std::string text;
    for (const auto& [key, value] : json.items())
      text += (text.empty() ? "" : between) + (json.is_object() ? OrderedJson(key).dump() + ": " : "") +
              laid_out(value, deeper);
    return text;
  };
  const char *open = json.is_object() ? "{" : "[", *close = json.is_object() ? "}" : "]";
  const std::string line = joined(indent, ", ");
  if (line.find('\n') == std::string::npos && indent + line.size() <= kWidth) return open + line + close;
  const std::string margin(indent, ' ');
  return fmt::format("{}\n  {}{}\n{}{}", open, margin, joined(indent + 2, ",\n  " + margin), margin, close);
}

}  // namespace

std::string laid_out(const OrderedJson& json) {
  return laid_out(json, 0) + "\n";
}

std::string json_line(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace exactvo::tools
