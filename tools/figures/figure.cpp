// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/require.h"
#include "support/escape.h"
#include "support/files.h"

namespace exactvo::tools {

namespace {

/// Bytes from 0x80 on are those of letters beyond ASCII.
bool is_plain(char c) {
  const auto byte = static_cast<unsigned char>(c);
  const bool is_letter = (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') || byte >= 0x80;
  return is_letter || (byte >= '0' && byte <= '9') || byte == '_' || byte == '-' || byte == '.' || byte == ' ';
}

bool is_plain(const std::string& name) {
  const auto is_plain_byte = [](char c) { return is_plain(c); };
  return !name.empty() && name[0] != ' ' && name[0] != '-' && std::all_of(name.begin(), name.end(), is_plain_byte) &&
         !has_control_characters(name);
}

/// Every line a step to the right, and empty ones left out.
std::string indented(const std::string& text) {
  std::string result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) result += (result.empty() ? "  " : "\n  ") + line;
  return result;
}

}  // namespace

std::string plain_name(const std::string& name) {
  if (is_plain(name)) return name;
  const std::size_t most = 40;  // of what is kept of the name: enough to recognise it by
  std::string kept;
  for (const char c : name.substr(0, most)) kept += is_plain(c) && static_cast<unsigned char>(c) < 0x80 ? c : '_';
  return "figure-" + kept + "-" + datasets::sha256_of(name).substr(0, 8);
}

std::string script_text(const Figure& figure) {
  EXACTVO_REQUIRE(is_plain(figure.name), "the name of a figure is plain: " + shown(figure.name));
  return filled("frame", {{"shows", commented(figure.shows)},
                          {"name", figure.name},
                          {"width", std::to_string(figure.canvas.width)},
                          {"height", std::to_string(figure.canvas.height)},
                          {"body", indented(figure.body)}});
}

std::filesystem::path write_sources(const Figure& figure, const std::filesystem::path& folder) {
  write_text(folder / (figure.name + ".dat"), figure.data);
  std::filesystem::path script = folder / (figure.name + ".gp");
  write_text(script, script_text(figure));
  return script;
}

int DataFile::begin(const std::string& title, const std::string& columns) {
  fill_if_empty();
  if (count_ > 0) text_ += "\n\n";
  empty_ = lifted_ = true;
  text_ += fmt::format("# {}: {}\n# {}\n", count_, commented(title), columns);
  return count_++;
}

void DataFile::row(std::initializer_list<double> values) {
  row(std::vector<double>(values));
}

void DataFile::row(const std::vector<double>& values) {
  const char* separator = "";
  for (const double value : values) {
    text_ += separator;
    text_ += all_digits_ ? fmt::format("{}", value) : fmt::format("{:.9g}", value);
    separator = " ";
  }
  text_ += '\n';
  empty_ = lifted_ = false;
}

void DataFile::rows(const std::vector<geometry::Vec2>& points) {
  for (const geometry::Vec2 p : points) row({p.x, p.y});
}

void DataFile::curve(const std::vector<geometry::Vec2>& points) {
  rows(points);
  gap();
}

void DataFile::ring(const std::vector<geometry::Vec2>& points) {
  if (points.empty()) return;
  rows(points);
  curve({points.front()});
}

void DataFile::labelled_row(std::initializer_list<double> values, const std::string& label) {
  row(values);
  text_.pop_back();
  // A data file has no way to write a double quote or a backslash within double quotes.
  std::string word = shown(label);
  std::replace(word.begin(), word.end(), '"', '\'');
  std::replace(word.begin(), word.end(), '\\', '/');
  text_ += fmt::format(" \"{}\"\n", word);
}

void DataFile::gap() {
  if (!lifted_) text_ += '\n';  // two would end the data set
  lifted_ = true;
}

void DataFile::fill_if_empty() {
  if (empty_) text_ += "NaN NaN NaN NaN\n";
}

void PlotCommand::data(int index, const std::string& what, const std::string& title) {
  item(fmt::format("data index {} {}", index, what), title);
}

void PlotCommand::item(const std::string& what, const std::string& title) {
  items_.push_back(what + (title.empty() ? " notitle" : " title " + quoted(title)));
}

std::string PlotCommand::text() const {
  return fmt::format("plot {}\n", fmt::join(items_, ", \\\n     "));
}

std::string quoted(const std::string& text) {
  std::string plain;
  for (const char c : shown(text)) {
    if (std::string("\\^_{}@&~").find(c) != std::string::npos) plain += '\\';
    plain += c;
  }
  return markup(plain);
}

std::string markup(const std::string& text) {
  if (text.find('\'') == std::string::npos) return "'" + text + "'";
  // A string in single quotes cannot begin with one, even doubled.
  std::string result;
  for (const char c : text) {
    if (c == '`') {
      result += "\\140";  // what stands between two of them would be run
    } else {
      result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    }
  }
  return '"' + result + '"';
}

std::string commented(const std::string& text) {
  std::string result = shown(text);
  std::replace(result.begin(), result.end(), '`', '\'');        // what stands between two of them would be run
  if (!result.empty() && result.back() == '\\') result += ' ';  // else the comment would go on
  return result;
}

std::string shortened(const std::string& text, std::size_t most) {
  std::vector<std::string> characters;
  for (const char c : text) {
    const bool continues = (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
    if (continues && !characters.empty()) {
      characters.back() += c;
    } else {
      characters.emplace_back(1, c);
    }
  }
  if (characters.size() <= most) return text;
  const auto head = static_cast<std::ptrdiff_t>(most / 2);
  const auto tail = static_cast<std::ptrdiff_t>(most) - head - 1;
  return fmt::format("{}…{}", fmt::join(characters.begin(), characters.begin() + head, ""),
                     fmt::join(characters.end() - tail, characters.end(), ""));
}

std::size_t characters_in(double pixels) {
  const double widest = 8.4;  // px: the mean of DejaVu Sans at 13 px is 7.8
  return static_cast<std::size_t>(std::max(pixels / widest, 8.0));
}

std::string filled_text(const std::string& text, const Filling& filling) {
  std::string result;
  std::set<std::string> used;
  std::size_t from = 0;
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', from)) {
    const std::size_t end = text.find('@', at + 1);
    EXACTVO_REQUIRE(end != std::string::npos, std::string("a place of a template ends with @"));
    const std::string place = text.substr(at + 1, end - at - 1);
    const auto value = filling.find(place);
    EXACTVO_REQUIRE(value != filling.end(), "a template's place is filled: " + place);
    result += text.substr(from, at - from) + value->second;
    used.insert(place);
    from = end + 1;
  }
  EXACTVO_REQUIRE(used.size() == filling.size(), std::string("a template has every place that is filled"));
  return result + text.substr(from);
}

std::string filled(const std::string& name, const Filling& filling) {
  const auto found = embedded_templates().find(name);
  EXACTVO_REQUIRE(found != embedded_templates().end(), "there is a template " + name);
  return filled_text(found->second, filling);
}

}  // namespace exactvo::tools
