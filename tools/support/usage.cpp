// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/nearest_word.h"

namespace exactvo::tools {

UsageError::UsageError(const std::string& where, const std::string& found, const std::string& expected)
    : std::runtime_error(where + ": found '" + found + "', expected " + expected) {}

UsageError missing_option(const std::string& verb, const std::string& what, const std::string& description) {
  return UsageError("missing " + what + ": " + description + " (see 'exactvo " + verb + " --help')");
}

UsageError unknown_word(const std::string& where, const std::string& word, const std::vector<std::string>& known) {
  return {where, word, fmt::format("one of {}{}", fmt::join(known, " "), suggestion(word, known))};
}

void require_known(const std::string& where, const std::string& word, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), word) == known.end()) throw unknown_word(where, word, known);
}

void require(bool holds, const std::string& where, const std::string& found, const std::string& expected) {
  if (!holds) throw UsageError(where, found, expected);
}

void require_length(const std::string& option, double value) {
  require(value >= 0.0 && !std::isinf(value), option, fmt::format("{}", value), "a length in m, at least 0");
}

UsageError conflict(const std::string& option, const std::string& other, const std::string& why) {
  return UsageError(option + " cannot be combined with " + other + ": " + why);
}

void refuse_both(bool both, const std::string& option, const std::string& other, const std::string& why) {
  if (both) throw conflict(option, other, why);
}

UsageError lacking(const std::string& option, const std::string& needed, const std::string& why) {
  return UsageError(option + " needs " + needed + (why.empty() ? "" : ": " + why));
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = geometry::nearest_word(word, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace exactvo::tools
