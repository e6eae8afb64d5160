// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/template.h"

#include <set>

#include "exactvo/geometry/require.h"

namespace exactvo::tools {

std::string filled_text(const std::string& text, const Filling& filling) {
  std::string result;
  std::set<std::string> used;
  std::size_t from = 0;
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', from)) {
    const std::size_t end = text.find('@', at + 1);
    EXACTVO_REQUIRE(end != std::string::npos, std::string("a place of a template ends with @"));
    const std::string place = text.substr(at + 1, end - at - 1);
    const auto value = filling.find(place);
    EXACTVO_REQUIRE(value != filling.end(), "a template's place is filled: " + place);
    result += text.substr(from, at - from) + value->second;
    used.insert(place);
    from = end + 1;
  }
  EXACTVO_REQUIRE(used.size() == filling.size(), std::string("a template has every place that is filled"));
  return result + text.substr(from);
}

std::string filled(const std::string& name, const Filling& filling) {
  const auto found = embedded_templates().find(name);
  EXACTVO_REQUIRE(found != embedded_templates().end(), "there is a template " + name);
  return filled_text(found->second, filling);
}

}  // namespace exactvo::tools
