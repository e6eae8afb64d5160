// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What parsing JSON will take, before it is parsed: json-c, GDAL's parser, spends up to 400 bytes on each character.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

/// Bytes that a reader may take for `input_bytes` of input: 20 for each and 200 MB beside, of which the libraries of
/// the process have a share.
double parser_memory_for(double input_bytes);

/// Estimates from its tokens, character by character, how much memory the reading of a JSON text takes.
class JsonMemory {
 public:
  void take(char c);
  double bytes() const;
  /// Whether the text so far takes more than `parser_memory_for` allows.
  bool is_too_much() const { return bytes() > parser_memory_for(static_cast<double>(characters_)); }

 private:
  void take_outside(char c);
  void take_word(char c);

  double of_tokens_ = 0.0;
  std::size_t characters_ = 0;
  bool in_string_ = false;
  bool is_escaped_ = false;
  bool may_be_name_ = false;  ///< the last string, of a member
  char quote_ = '"';          ///< that ends the string
  bool in_word_ = false;      ///< a number, true, false or null
  bool is_real_ = false;      ///< of a number
};

/// E_SIZE, in the words of all that is refused for its estimate.
DataError too_bulky(const JsonMemory& memory, const std::string& file, const std::string& place);

/// E_SIZE, if parsing `text` would take more memory than a reader may (an estimate). Calls the wait hook on its way.
std::optional<DataError> bulky_json(std::string_view text, const std::string& file, const std::string& place);

/// The same of a whole file, which is not kept in memory.
std::optional<DataError> bulky_json_file(const std::filesystem::path& path);

}  // namespace exactvo::datasets
