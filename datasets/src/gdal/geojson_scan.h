// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What has to be known of a GeoJSON file before GDAL opens it, from one pass over its bytes. Memory does not grow with
/// the file, but for the entries that GDAL will skip.

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gdal/json_memory.h"

namespace exactvo::datasets {

/// White space between tokens of JSON.
inline bool is_json_blank(int c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// How deep in objects and strings the next byte of a text of JSON stands.
class JsonNesting {
 public:
  void take(char c);
  long objects() const { return objects_; }
  long arrays() const { return arrays_; }
  bool in_string() const { return in_string_; }

 private:
  long objects_ = 0;
  long arrays_ = 0;
  bool in_string_ = false;
  bool is_escaped_ = false;
};

/// The members of the outermost objects, byte by byte: a string before a colon is a member's name, the one behind it
/// its value.
class JsonMembers {
 public:
  void take(char c);
  const JsonNesting& nesting() const { return nesting_; }
  /// The last value of a member "type" so far.
  const std::string& type() const { return type_; }
  /// Between the entries of "features".
  bool is_among_features() const {
    return nesting_.objects() == 1 && nesting_.arrays() == 1 && !nesting_.in_string() && member_ == "features";
  }

 private:
  JsonNesting nesting_;
  std::string text_;
  std::string member_;
  std::string type_;
};

/// The object that stands first: whether it is one of a sequence.
class FirstObject {
 public:
  /// `whatever_type`: a type of no record does not end the look at it.
  explicit FirstObject(bool whatever_type) : whatever_type_(whatever_type) {}

  /// `c` was taken by `members`, and stood `in_string` or not.
  void take(char c, bool in_string, const JsonMembers& members);

  /// Nothing that follows is of interest.
  bool is_over() const { return stage_ == Stage::over; }
  /// It has an end with a byte behind it, and is a feature or a geometry. Its lines are not broken within strings.
  bool is_record() const;
  bool spans_lines() const { return spans_lines_; }
  /// More than white space follows its end.
  bool more_follows() const { return more_follows_; }
  /// "" before it is known: the first one where that is of no record, else the last one.
  const std::string& type() const;

 private:
  enum class Stage { before, inside, behind, over };
  bool whatever_type_;
  Stage stage_ = Stage::before;
  bool spans_lines_ = false;
  bool is_complete_ = false;
  bool more_follows_ = false;
  std::string first_type_, last_type_;
};

/// An entry of a collection's "features" that is no object: GDAL skips it without a word.
struct StrayEntry {
  std::size_t number = 0;  ///< among the entries
  char begin = 0;          ///< its first byte
};

struct GeoJsonScan {
  /// More than white space follows the first object, which is complete, and it is a feature or a geometry, or the
  /// file's name says that it is a sequence: GDAL may take such a file for GeoJSON of one object, and then says nothing
  /// of the rest. Then nothing else here is known.
  bool is_sequence = false;
  std::string type;                ///< the first member "type" of the outermost object, wherever it stands
  JsonMemory memory;               ///< of what GDAL parses at once: all before a collection's "features", else the file
  std::vector<StrayEntry> strays;  ///< of a collection

  bool is_collection() const { return type == "FeatureCollection"; }
};

/// Calls the wait hook on its way.
GeoJsonScan scan_geojson(const std::filesystem::path& path, bool name_says_sequence);

/// Whether a sequence's records span lines: the first one does. The stream stands at the first byte, and does so again.
bool first_record_spans_lines(std::ifstream& file);

/// To the first byte behind a byte order mark.
void skip_byte_order_mark(std::ifstream& file);

}  // namespace exactvo::datasets
