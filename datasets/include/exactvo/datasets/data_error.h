// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Bad data, named: which file, where in it, what stood there, what should have, and a code that docs/guide/codes.md
/// explains. Everything in this room that reads a file throws `DataError` for what is wrong *in the file*; a caller's
/// mistake stays a `std::logic_error`.
///
/// See also: geometry/validity.h finds the problems of a ring, whose codes appear here under the same names.

#include <stdexcept>
#include <string>

#include "exactvo/geometry/validity.h"

namespace exactvo::datasets {

/// Why data was refused. The name on the right is what users see and what the documentation lists.
enum class DataCode {
  file_missing,        ///< E_FILE_MISSING: no such file
  file_unreadable,     ///< E_FILE_UNREADABLE: there, but can't be read
  file_unwritable,     ///< E_FILE_UNWRITABLE: can't be written: no permission, disk full, directory gone
  json_syntax,         ///< E_JSON_SYNTAX: not JSON; the place is line and column
  json_duplicate_key,  ///< E_JSON_DUPLICATE_KEY: a key twice in one object
  key_missing,         ///< E_KEY_MISSING: a required key is not there
  key_unknown,         ///< E_KEY_UNKNOWN: an unknown key; the nearest known one is suggested
  wrong_type,          ///< E_TYPE: a string where a number belongs, and so on
  out_of_range,        ///< E_RANGE: a number outside its stated range
  not_an_option,       ///< E_OPTION: a word that is none of the listed ones
  wrong_count,         ///< E_COUNT: a list too short or too long
  cut_off,             ///< E_CUT_OFF: a recording that ends before its last line
  no_alternative,      ///< E_NO_ALTERNATIVE: fits none of the allowed shapes of the value
  scenario,            ///< E_SCENARIO: well-formed, but can't be run (robots overlapping at the start, ...)
  format_unknown,      ///< E_FORMAT_UNKNOWN: neither content nor name tells what kind of file it is
  format_unavailable,  ///< E_FORMAT_UNAVAILABLE: this build reads no such format (built without GDAL)
  format_syntax,      ///< E_FORMAT_SYNTAX: breaks the rules of its format; the place is a line and column, or a feature
  number,             ///< E_NUMBER: not a number, or one that no finite double can hold
  nesting,            ///< E_NESTING: nested deeper than anything sensible
  size,               ///< E_SIZE: more than the file holds, or more than memory or time allow
  path_escape,        ///< E_PATH_ESCAPE: a file named in a map lies outside the map's folder
  image,              ///< E_IMAGE: the picture of a map is missing or can't be decoded
  projection,         ///< E_PROJECTION: coordinates that can't be brought to metres
  other_run,          ///< E_OTHER_RUN: an output of other inputs, other options or another version
  ranks_differ,       ///< E_RANKS_DIFFER: the ranks of a run computed different states
  library,            ///< E_LIBRARY: GDAL or another library reported an error; its words are in `found`
  not_finite,         ///< E_NOT_FINITE: a coordinate is NaN or infinite
  too_few_points,     ///< E_TOO_FEW_POINTS
  unclosed,           ///< E_UNCLOSED (repaired)
  repeated_vertex,    ///< E_REPEATED_VERTEX (repaired)
  clockwise,          ///< E_CLOCKWISE (repaired)
  zero_area,          ///< E_ZERO_AREA
  self_intersection,  ///< E_SELF_INTERSECTION
  hole_outside,       ///< E_HOLE_OUTSIDE
  rounding            ///< E_ROUNDING: crossings can't be rounded to doubles without making new ones (repair.h)
};

/// "E_FILE_MISSING" and so on.
const char* code_name(DataCode code);

/// The same code, seen from this room.
DataCode data_code(geometry::RingProblemCode code);

/// One refused piece of data. `what()` is one line: "file: place: found ..., expected ... [E_CODE]".
class DataError : public std::runtime_error {
 public:
  /// `place`, `found` and `expected` become parts of `what()`.
  DataError(DataCode code, std::string file, std::string place, std::string found, std::string expected);

  /// Why the data was refused.
  DataCode code() const { return code_; }
  const std::string& file() const { return file_; }    ///< as the caller named it
  const std::string& place() const { return place_; }  ///< JSON pointer, "line 3, column 7", "feature 2, ring 0, ..."
  /// What stands in the file.
  const std::string& found() const { return found_; }
  /// What should stand there.
  const std::string& expected() const { return expected_; }

 private:
  DataCode code_;
  std::string file_;
  std::string place_;
  std::string found_;
  std::string expected_;
};

}  // namespace exactvo::datasets
