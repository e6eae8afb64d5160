// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/data_error.h"

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

}  // namespace exactvo::datasets
