// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>
#include <system_error>

#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/require.h"
#include "support/escape.h"
#include "support/files.h"
#include "support/run.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

// --- Text ---

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

// --- Sheets ---

constexpr double kLabel = 16.0;  // px from the left: the middle of the vertical label

/// Where everything of a sheet lies, px from the top left.
class Layout {
 public:
  explicit Layout(const Sheet& sheet)
      : sheet_(sheet), rows_((static_cast<int>(sheet.panels.size()) + sheet.columns - 1) / sheet.columns) {}

  double width() const {
    return std::max(kLeft + kRight + sheet_.columns * sheet_.panel_width + (sheet_.columns - 1) * sheet_.gap, kLeast);
  }
  double height() const { return top(rows_ - 1) + sheet_.panel_height + kBottom + legend_height(); }
  double left(int column) const { return kLeft + column * (sheet_.panel_width + sheet_.gap); }
  double top(int row) const { return kTop + row * (sheet_.panel_height + kGapY); }
  /// As many rows as gnuplot needs for entries that are all as wide as the widest.
  double legend_height() const {
    std::size_t longest = 0;
    for (const auto& entry : sheet_.legend) longest = std::max(longest, entry.second.size());
    const double entry = 70.0 + 7.0 * static_cast<double>(longest);
    const double in_a_row = std::max(1.0, std::floor(0.95 * width() / entry));
    return 14.0 + 18.0 * std::ceil(static_cast<double>(sheet_.legend.size()) / in_a_row);
  }
  std::string across(double px) const { return fmt::format("{:.5f}", px / width()); }
  std::string up(double px) const { return fmt::format("{:.5f}", 1.0 - px / height()); }

 private:
  static constexpr double kLeft = 68.0, kRight = 14.0, kTop = 62.0, kBottom = 46.0, kGapY = 50.0;
  static constexpr double kLeast = 460.0;  // for the title

  const Sheet& sheet_;
  int rows_;
};

std::string panel_text(const Sheet& sheet, const Layout& layout, int k) {
  const SheetPanel& panel = sheet.panels[static_cast<std::size_t>(k)];
  const int column = k % sheet.columns, row = k / sheet.columns;
  const bool is_lowest = k + sheet.columns >= static_cast<int>(sheet.panels.size());
  return filled("sheet_panel", {{"left", layout.across(layout.left(column))},
                                {"right", layout.across(layout.left(column) + sheet.panel_width)},
                                {"top", layout.up(layout.top(row))},
                                {"bottom", layout.up(layout.top(row) + sheet.panel_height)},
                                {"title", panel.title},
                                {"x_label", is_lowest ? sheet.x_label : "''"},
                                {"y_label", column == 0 ? sheet.y_label : "''"},
                                {"label", layout.across(kLabel)},
                                {"settings", panel.settings},
                                {"plot", panel.plot}});
}

std::string legend_text(const Sheet& sheet) {
  PlotCommand plot;
  plot.item("2");  // beyond the axes: gnuplot draws no legend alone
  for (const auto& [what, words] : sheet.legend) plot.item(what, words);
  return plot.text();
}

// --- Files of a verb ---

/// One file of a figure: what it is called where it is drawn, and what in the end.
using FigureFile = std::pair<std::string, std::string>;

constexpr const char* kFreeName =
    "a name whose .svg, .png, .pdf, .dat and .gp the command neither reads nor writes besides";

constexpr const char* kPictures[] = {".pdf", ".png", ".svg"};

std::vector<FigureFile> files_of(const fs::path& out) {
  const std::string stem = out.stem().string(), plain = plain_name(stem);
  std::vector<FigureFile> files;
  for (const char* source : {".dat", ".gp"}) files.push_back({plain + source, plain + source});
  for (const char* picture : kPictures) files.push_back({plain + picture, stem + picture});
  return files;
}

/// By whatever name or link; also of files that are not there yet.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path canonical_a = fs::weakly_canonical(a, error), canonical_b = fs::weakly_canonical(b, error);
  return !canonical_a.empty() && canonical_a == canonical_b;
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

void DataFile::row(const std::vector<double>& values) {
  constexpr double kLarge = 1e5;
  const char* separator = "";
  for (const double value : values) {
    text_ += separator;
    text_ += std::fabs(value) < kLarge ? fmt::format("{:.9g}", value) : fmt::format("{}", value);
    separator = " ";
  }
  text_ += '\n';
  empty_ = lifted_ = false;
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

void DataFile::labelled_row(const std::vector<double>& values, const std::string& label) {
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

void PlotCommand::data(int index, const std::string& what, const std::string& title) {
  item(fmt::format("data index {} {}", index, what), title);
}

void PlotCommand::item(const std::string& what, const std::string& title) {
  items_.push_back(what + (title.empty() ? " notitle" : " title " + quoted(title)));
}

std::vector<std::vector<std::size_t>> drawn_together(std::size_t count, std::size_t styles) {
  std::vector<std::vector<std::size_t>> sets(count <= kMostInLegend ? count : std::min(count, styles));
  for (std::size_t i = 0; i < count; ++i) sets[i % sets.size()].push_back(i);
  return sets;
}

std::string robot_in_legend(std::size_t i, std::size_t count, const std::string& name, std::size_t longest) {
  if (count <= kMostInLegend) return shortened(name, longest);
  return i == 0 ? std::to_string(count) + " robots" : "";
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

std::string letter_of(std::size_t panel) {
  return panel < 26 ? fmt::format("({})", static_cast<char>('a' + panel)) : fmt::format("({})", panel + 1);
}

Figure sheet_figure(const std::string& name, const std::string& data, const std::string& shows, const Sheet& sheet) {
  EXACTVO_REQUIRE(!sheet.panels.empty(), std::string("a sheet has a panel"));
  const Layout layout(sheet);
  std::string panels;
  for (int k = 0; k < static_cast<int>(sheet.panels.size()); ++k) panels += panel_text(sheet, layout, k);
  const double legend = layout.legend_height();
  const std::string body = filled("sheet", {{"title", sheet.title},
                                            {"panels", panels},
                                            {"legend_top", layout.up(layout.height() - legend)},
                                            {"legend_middle", layout.up(layout.height() - 0.55 * legend)},
                                            {"legend", legend_text(sheet)}});
  const Canvas canvas{static_cast<int>(std::lround(layout.width())), static_cast<int>(std::lround(layout.height()))};
  return {name, data, shows, canvas, body};
}

void check_figure_name(const std::string& option, const std::string& name, const std::vector<fs::path>& others) {
  if (name.empty()) return;
  if (has_control_characters(name)) throw UsageError(option, name, "a name without control characters");
  if (std::find(std::begin(kPictures), std::end(kPictures), fs::path(name).extension()) == std::end(kPictures))
    throw UsageError(option, name, "a name that ends in .svg, .png or .pdf");
  for (const auto& [drawn, asked] : files_of(name)) {
    const fs::path path = fs::path(name).parent_path() / asked;
    if (fs::is_directory(path)) throw UsageError(option, path.string() + ", a folder", "names that are free or files");
    for (const fs::path& other : others)
      if (is_same_file(path, other))
        throw UsageError(option, name + ", which would replace " + path.string(), kFreeName);
  }
}

void write_figure(Figure figure, const fs::path& out) {
  figure.name = plain_name(out.stem().string());
  const fs::path parent = fs::absolute(out).parent_path();
  make_folder(parent);
  StagedFolder folder(parent / "exactvo-figure", out);
  draw({write_sources(figure, folder.path())});
  const bool is_redrawn = fs::exists(parent / (figure.name + ".gp"));
  for (const auto& [drawn, asked] : files_of(out)) {
    if (fs::exists(folder.path() / drawn)) {
      fs::rename(folder.path() / drawn, parent / asked);
    } else if (is_redrawn) {
      fs::remove(parent / asked);  // an earlier one would show something else than its neighbours
    }
  }
  const fs::path script = out.parent_path() / (figure.name + ".gp");
  message("wrote " + (fs::exists(out) ? out : script).string());
}

}  // namespace exactvo::tools
