// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <locale>

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

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

namespace {

std::size_t allowed(std::size_t letters) {
  const std::size_t few = letters < 2 ? 0 : letters < 5 ? 1 : 2;
  return std::max(few, letters / 3);
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  const std::locale& classic = std::locale::classic();
  std::string best;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : known) {
    const std::size_t distance =
        edit_distance(boost::to_lower_copy(word, classic), boost::to_lower_copy(candidate, classic));
    if (distance < least && distance <= allowed(std::min(word.size(), candidate.size()))) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace exactvo::tools
