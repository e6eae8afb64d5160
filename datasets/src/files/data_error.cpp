// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/data_error.h"

#include <utility>

namespace exactvo::datasets {
namespace {

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
  switch (code) {
    case DataCode::file_missing:
      return "E_FILE_MISSING";
    case DataCode::file_unreadable:
      return "E_FILE_UNREADABLE";
    case DataCode::file_unwritable:
      return "E_FILE_UNWRITABLE";
    case DataCode::json_syntax:
      return "E_JSON_SYNTAX";
    case DataCode::json_duplicate_key:
      return "E_JSON_DUPLICATE_KEY";
    case DataCode::key_missing:
      return "E_KEY_MISSING";
    case DataCode::key_unknown:
      return "E_KEY_UNKNOWN";
    case DataCode::wrong_type:
      return "E_TYPE";
    case DataCode::out_of_range:
      return "E_RANGE";
    case DataCode::not_an_option:
      return "E_OPTION";
    case DataCode::wrong_count:
      return "E_COUNT";
    case DataCode::no_alternative:
      return "E_NO_ALTERNATIVE";
    case DataCode::scenario:
      return "E_SCENARIO";
    case DataCode::format_unknown:
      return "E_FORMAT_UNKNOWN";
    case DataCode::format_unavailable:
      return "E_FORMAT_UNAVAILABLE";
    case DataCode::format_syntax:
      return "E_FORMAT_SYNTAX";
    case DataCode::number:
      return "E_NUMBER";
    case DataCode::nesting:
      return "E_NESTING";
    case DataCode::size:
      return "E_SIZE";
    case DataCode::path_escape:
      return "E_PATH_ESCAPE";
    case DataCode::image:
      return "E_IMAGE";
    case DataCode::projection:
      return "E_PROJECTION";
    case DataCode::other_run:
      return "E_OTHER_RUN";
    case DataCode::ranks_differ:
      return "E_RANKS_DIFFER";
    case DataCode::library:
      return "E_LIBRARY";
    case DataCode::not_finite:
      return "E_NOT_FINITE";
    case DataCode::too_few_points:
      return "E_TOO_FEW_POINTS";
    case DataCode::unclosed:
      return "E_UNCLOSED";
    case DataCode::repeated_vertex:
      return "E_REPEATED_VERTEX";
    case DataCode::clockwise:
      return "E_CLOCKWISE";
    case DataCode::zero_area:
      return "E_ZERO_AREA";
    case DataCode::self_intersection:
      return "E_SELF_INTERSECTION";
    case DataCode::hole_outside:
      return "E_HOLE_OUTSIDE";
    case DataCode::rounding:
      return "E_ROUNDING";
  }
  return "E_UNKNOWN";
}

DataCode data_code(geometry::RingProblemCode code) {
  switch (code) {
    case geometry::RingProblemCode::not_finite:
      return DataCode::not_finite;
    case geometry::RingProblemCode::too_few_points:
      return DataCode::too_few_points;
    case geometry::RingProblemCode::unclosed:
      return DataCode::unclosed;
    case geometry::RingProblemCode::repeated_vertex:
      return DataCode::repeated_vertex;
    case geometry::RingProblemCode::clockwise:
      return DataCode::clockwise;
    case geometry::RingProblemCode::zero_area:
      return DataCode::zero_area;
    case geometry::RingProblemCode::self_intersection:
      return DataCode::self_intersection;
    case geometry::RingProblemCode::hole_outside:
      return DataCode::hole_outside;
  }
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
