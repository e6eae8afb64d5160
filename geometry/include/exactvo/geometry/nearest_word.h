// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a mistyped word may have meant, for messages.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace exactvo::geometry {

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (optimal string alignment).
/// Exact.
inline std::size_t edit_distance(const std::string& a, const std::string& b) {
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

/// The known word nearest to `word`, whatever the case of ASCII letters. Empty where none is near enough to be meant:
/// in a word of two to four letters one may differ, from five letters on two or a third, whichever is more; the shorter
/// of both words counts. Heuristic.
inline std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  const auto lower = [](std::string text) {
    for (char& c : text)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
  };
  const auto may_differ = [](std::size_t letters) {
    const std::size_t few = letters < 2 ? 0 : letters < 5 ? 1 : 2;
    return std::max(few, letters / 3);
  };
  std::string best;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : known) {
    const auto [shorter, longer] = std::minmax({word.size(), candidate.size()});
    if (longer - shorter > may_differ(shorter)) continue;  // a word of a file may be very long
    const std::size_t distance = edit_distance(lower(word), lower(candidate));
    if (distance >= least || distance > may_differ(shorter)) continue;
    least = distance;
    best = candidate;
  }
  return best;
}

}  // namespace exactvo::geometry
