// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/missing_glyphs.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "figures/gnuplot.h"
#include "support/files.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using boost::locale::utf::code_point;
using Utf8 = boost::locale::utf::utf_traits<char>;

namespace {

/// Up to Latin letters with marks, which the fonts of every figure have.
constexpr code_point kLastCertain = 0x24F;
constexpr code_point kEllipsis = 0x2026;   // of shortened names
constexpr const char* kSquare = "\u25a1";  // which DejaVu Sans has, the font of figures

/// Joins and selects others, and is not seen itself.
bool is_unseen(code_point c) {
  return (c >= 0x200B && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) ||
         (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF;
}

fs::path data_of(const fs::path& script) {
  return fs::path(script).replace_extension(".dat");
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void add_unusual(const fs::path& path, std::set<char32_t>& found) {
  std::ifstream file(path, std::ios::binary);
  for (std::istreambuf_iterator<char> at(file), end; at != end;) {
    const code_point c = Utf8::decode(at, end);
    const bool is_usual = c <= kLastCertain || c == kEllipsis || is_unseen(c);
    if (!is_usual && boost::locale::utf::is_valid_codepoint(c)) found.insert(c);
  }
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

std::set<char32_t> characters_without_font(const std::vector<fs::path>& scripts) {
  std::set<char32_t> missing;
  for (const fs::path& script : scripts) add_unusual(script, missing), add_unusual(data_of(script), missing);
  if (missing.empty()) return missing;
  const auto ranges = characters_of_fonts();
  if (ranges.empty()) return {};
  for (auto at = missing.begin(); at != missing.end();) {
    const auto has = [&](const auto& range) { return range.first <= *at && *at <= range.second; };
    at = std::any_of(ranges.begin(), ranges.end(), has) ? missing.erase(at) : std::next(at);
  }
  return missing;
}

std::string with_squares(const std::string& text, const std::set<char32_t>& missing) {
  std::string result;
  for (auto at = text.begin(); at != text.end();) {
    auto next = at;
    const code_point c = Utf8::decode(next, text.end());
    if (missing.count(c) > 0)
      result += kSquare;
    else
      result.append(at, next);
    at = next;
  }
  return result;
}

std::string listed_characters(const std::set<char32_t>& characters) {
  constexpr std::size_t kMostNamed = 10;
  std::string names;
  std::size_t named = 0;
  for (auto at = characters.begin(); at != characters.end() && named < kMostNamed; ++at, ++named) {
    if (named > 0) names += ' ';
    Utf8::encode(*at, std::back_inserter(names));
  }
  return characters.size() > named ? fmt::format("{} and {} more", names, characters.size() - named) : names;
}

fs::path copy_with_squares(const fs::path& script, const std::set<char32_t>& missing, const fs::path& folder,
                           const std::string& name) {
  fs::path copy = folder / (name + ".gp");
  write_text(data_of(copy), with_squares(content_of(data_of(script)), missing));
  std::istringstream lines(content_of(script));
  std::string text;
  for (std::string line; std::getline(lines, line);) {  // templates/frame.gp
    if (line.rfind("data = ", 0) == 0)
      line = "data = " + exact_string(data_of(copy).string());
    else if (line.find("set output '") == std::string::npos)
      line = with_squares(line, missing);
    text += line + '\n';
  }
  write_text(copy, text);
  return copy;
}

}  // namespace exactvo::tools
