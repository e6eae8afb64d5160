// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/data_error.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <limits>
#include <locale>
#include <string_view>
#include <utility>

namespace exactvo::datasets {
namespace {

constexpr std::pair<DataCode, const char*> kCodeNames[] = {{DataCode::file_missing, "E_FILE_MISSING"},
                                                           {DataCode::file_unreadable, "E_FILE_UNREADABLE"},
                                                           {DataCode::file_unwritable, "E_FILE_UNWRITABLE"},
                                                           {DataCode::json_syntax, "E_JSON_SYNTAX"},
                                                           {DataCode::json_duplicate_key, "E_JSON_DUPLICATE_KEY"},
                                                           {DataCode::key_missing, "E_KEY_MISSING"},
                                                           {DataCode::key_unknown, "E_KEY_UNKNOWN"},
                                                           {DataCode::wrong_type, "E_TYPE"},
                                                           {DataCode::out_of_range, "E_RANGE"},
                                                           {DataCode::not_an_option, "E_OPTION"},
                                                           {DataCode::wrong_count, "E_COUNT"},
                                                           {DataCode::cut_off, "E_CUT_OFF"},
                                                           {DataCode::no_alternative, "E_NO_ALTERNATIVE"},
                                                           {DataCode::scenario, "E_SCENARIO"},
                                                           {DataCode::format_unknown, "E_FORMAT_UNKNOWN"},
                                                           {DataCode::format_unavailable, "E_FORMAT_UNAVAILABLE"},
                                                           {DataCode::format_syntax, "E_FORMAT_SYNTAX"},
                                                           {DataCode::number, "E_NUMBER"},
                                                           {DataCode::nesting, "E_NESTING"},
                                                           {DataCode::size, "E_SIZE"},
                                                           {DataCode::path_escape, "E_PATH_ESCAPE"},
                                                           {DataCode::image, "E_IMAGE"},
                                                           {DataCode::projection, "E_PROJECTION"},
                                                           {DataCode::other_run, "E_OTHER_RUN"},
                                                           {DataCode::ranks_differ, "E_RANKS_DIFFER"},
                                                           {DataCode::library, "E_LIBRARY"},
                                                           {DataCode::not_finite, "E_NOT_FINITE"},
                                                           {DataCode::too_few_points, "E_TOO_FEW_POINTS"},
                                                           {DataCode::unclosed, "E_UNCLOSED"},
                                                           {DataCode::repeated_vertex, "E_REPEATED_VERTEX"},
                                                           {DataCode::clockwise, "E_CLOCKWISE"},
                                                           {DataCode::zero_area, "E_ZERO_AREA"},
                                                           {DataCode::self_intersection, "E_SELF_INTERSECTION"},
                                                           {DataCode::hole_outside, "E_HOLE_OUTSIDE"},
                                                           {DataCode::rounding, "E_ROUNDING"}};

std::string one_line(const std::string& file, const std::string& place, const std::string& found,
                     const std::string& expected, DataCode code) {
  std::string text = file;
  if (!place.empty()) text += ": " + place;
  text += ": found " + found + ", expected " + expected + " [" + code_name(code) + "]";
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

/// Letters that may differ in a word that is mistyped.
std::size_t slips_among(std::size_t letters) {
  const std::size_t few = letters < 2 ? 0 : letters < 5 ? 1 : 2;
  return std::max(few, letters / 3);
}

}  // namespace

const char* code_name(DataCode code) {
  for (const auto& [known, name] : kCodeNames)
    if (known == code) return name;
  return "E_UNKNOWN";
}

DataCode data_code(geometry::RingProblemCode code) {
  for (const auto& [known, name] : kCodeNames)
    if (std::string_view(name) == geometry::code_name(code)) return known;
  return DataCode::self_intersection;
}

DataError::DataError(DataCode code, std::string file, std::string place, std::string found, std::string expected)
    : std::runtime_error(one_line(file, place, found, expected, code)),
      code_(code),
      file_(std::move(file)),
      place_(std::move(place)),
      found_(std::move(found)),
      expected_(std::move(expected)) {}

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

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  const std::locale& classic = std::locale::classic();
  const std::string lower = boost::to_lower_copy(word, classic);
  std::string best;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : known) {
    const auto [shorter, longer] = std::minmax({word.size(), candidate.size()});
    if (longer - shorter > slips_among(shorter)) continue;  // a word of a file may be very long
    const std::size_t distance = edit_distance(lower, boost::to_lower_copy(candidate, classic));
    if (distance >= least || distance > slips_among(shorter)) continue;
    least = distance;
    best = candidate;
  }
  return best;
}

}  // namespace exactvo::datasets
