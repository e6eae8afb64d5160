// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/missing_glyphs.h"

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

namespace exactvo::tools {

namespace fs = std::filesystem;
using boost::locale::utf::code_point;
using Utf8 = boost::locale::utf::utf_traits<char>;

namespace {

/// Up to Latin letters with marks, which the fonts of every figure have.
constexpr code_point kLastCertain = 0x24F;
constexpr code_point kEllipsis = 0x2026;  // of shortened names

/// Joins and selects others, and is not seen itself.
bool is_unseen(code_point c) {
  return (c >= 0x200B && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) ||
         (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF;
}

std::set<code_point> unusual_characters(const std::vector<fs::path>& scripts) {
  std::set<code_point> found;
  for (const fs::path& script : scripts)
    for (const fs::path& path : {script, fs::path(script).replace_extension(".dat")}) {
      std::ifstream file(path, std::ios::binary);
      for (std::istreambuf_iterator<char> at(file), end; at != end;) {
        const code_point c = Utf8::decode(at, end);
        const bool is_usual = c <= kLastCertain || c == kEllipsis || is_unseen(c);
        if (!is_usual && boost::locale::utf::is_valid_codepoint(c)) found.insert(c);
      }
    }
  return found;
}

/// From first to last, of all fonts; empty where they are not known.
std::vector<std::pair<code_point, code_point>> characters_of_fonts() {
  std::vector<std::pair<code_point, code_point>> ranges;
  std::FILE* const list = ::popen("fc-list --format='%{charset} ' 2>/dev/null", "r");
  if (!list) return ranges;
  std::string text;
  for (int c = 0; (c = std::fgetc(list)) != EOF;) text += static_cast<char>(c);
  if (::pclose(list) != 0) return ranges;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    unsigned first = 0, last = 0;
    const int numbers = std::sscanf(word.c_str(), "%x-%x", &first, &last);
    if (numbers > 0) ranges.emplace_back(first, numbers == 2 ? last : first);
  }
  return ranges;
}

}  // namespace

std::vector<std::string> characters_without_font(const std::vector<fs::path>& scripts) {
  constexpr std::size_t kMostNamed = 10;
  std::vector<std::string> missing;
  const std::set<code_point> unusual = unusual_characters(scripts);
  if (unusual.empty()) return missing;
  const auto ranges = characters_of_fonts();
  for (const code_point c : unusual) {
    const auto has = [c](const auto& range) { return range.first <= c && c <= range.second; };
    if (ranges.empty() || missing.size() == kMostNamed || std::any_of(ranges.begin(), ranges.end(), has)) continue;
    std::string& bytes = missing.emplace_back();
    Utf8::encode(c, std::back_inserter(bytes));
  }
  return missing;
}

}  // namespace exactvo::tools
