// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/json_memory.h"

#include <fstream>

#include "exactvo/datasets/input_text.h"

namespace exactvo::datasets {
namespace {

/// Bytes of each token, from above: measured with json-c 0.16 and GDAL 3.6 as the growth of the program's peak with
/// 100,000 equal tokens in the properties of a feature that is the whole file, in those of a feature on a line, and in
/// a member of TopoJSON. Peaks jump where tables double. A long string takes 9 bytes a character instead of 4, which is
/// below what a reader may take in any case.
constexpr double kOfObject = 850.0;  // json-c's table has 16 places from the beginning
constexpr double kOfList = 170.0;
constexpr double kOfInteger = 75.0;
constexpr double kOfReal = 120.0;  // its digits are kept too
constexpr double kOfString = 250.0;
constexpr double kOfMember = 200.0;  // its name, its place in a table that doubles
/// The copies of the text itself.
constexpr double kOfCharacter = 4.0;

}  // namespace

double parser_memory_for(double input_bytes) {
  constexpr double kOfProcess = 60e6;  // libraries
  return 20.0 * input_bytes + 200e6 - kOfProcess;
}

void JsonMemory::take(char c) {
  ++characters_;
  if (!in_string_) return take_outside(c);
  if (c == quote_ && !is_escaped_) in_string_ = false;
  is_escaped_ = c == '\\' && !is_escaped_;
}

void JsonMemory::take_outside(char c) {
  switch (c) {
    case '{':
      of_tokens_ += kOfObject;
      break;
    case '[':
      of_tokens_ += kOfList;
      break;
    case '"':
    case '\'':  // json-c takes both
      of_tokens_ += kOfString;
      in_string_ = true;
      may_be_name_ = true;
      quote_ = c;
      break;
    case ':':
      if (may_be_name_) of_tokens_ += kOfMember - kOfString;  // the string before it was one
      may_be_name_ = false;
      break;
    case ' ':
    case '\t':
    case '\n':
    case '\r':
    case ',':
    case ']':
    case '}':
      break;
    default:
      return take_word(c);
  }
  in_word_ = false;
}

void JsonMemory::take_word(char c) {
  if (!in_word_) {
    in_word_ = true;
    is_real_ = false;
    of_tokens_ += kOfInteger;
  } else if (!is_real_ && (c == '.' || c == 'e' || c == 'E')) {
    is_real_ = true;
    of_tokens_ += kOfReal - kOfInteger;
  }
}

double JsonMemory::bytes() const {
  return of_tokens_ + kOfCharacter * static_cast<double>(characters_);
}

DataError too_bulky(const JsonMemory& memory, const std::string& file, const std::string& place) {
  constexpr double kMegabyte = 1e6;
  return {DataCode::size, file, place,
          "JSON whose parsing takes about " + std::to_string(static_cast<long long>(memory.bytes() / kMegabyte)) +
              " MB, estimated from its objects, lists and values",
          "fewer at a time: features of their own, a line each, or another format"};
}

std::optional<DataError> bulky_json(std::string_view text, const std::string& file, const std::string& place) {
  JsonMemory memory;
  for (std::size_t begin = 0; begin < text.size(); begin += kWaitHookBytes) {
    call_wait_hook();
    for (const char c : text.substr(begin, kWaitHookBytes)) memory.take(c);
  }
  if (!memory.is_too_much()) return std::nullopt;
  return too_bulky(memory, file, place);
}

std::optional<DataError> bulky_json_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string block(kWaitHookBytes, '\0');
  JsonMemory memory;
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0) {
    call_wait_hook();
    const std::string_view read = std::string_view(block).substr(0, static_cast<std::size_t>(file.gcount()));
    const std::string_view text = read.substr(0, read.find('\0'));
    for (const char c : text) memory.take(c);
    if (text.size() < read.size()) break;  // JSON has no such byte, and parsers stop there
  }
  if (!memory.is_too_much()) return std::nullopt;
  return too_bulky(memory, path.string(), "");
}

}  // namespace exactvo::datasets
