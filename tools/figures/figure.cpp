// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figure.h"

#include <fmt/format.h>

#include "support/files.h"

namespace exactvo::tools {

std::filesystem::path write_sources(const Figure& figure, const std::filesystem::path& folder) {
  write_text(folder / (figure.name + ".dat"), figure.data);
  std::filesystem::path script = folder / (figure.name + ".gp");
  write_text(script, figure.script);
  return script;
}

int DataFile::begin(const std::string& title, const std::string& columns) {
  if (count_ > 0) text_ += "\n\n";
  text_ += fmt::format("# {}: {}\n# {}\n", count_, title, columns);
  return count_++;
}

void DataFile::row(std::initializer_list<double> values) {
  row(std::vector<double>(values));
}

void DataFile::row(const std::vector<double>& values) {
  const char* separator = "";
  for (const double value : values) {
    text_ += fmt::format("{}{:.9g}", separator, value);
    separator = " ";
  }
  text_ += '\n';
}

void DataFile::labelled_row(std::initializer_list<double> values, const std::string& label) {
  row(values);
  text_.pop_back();
  text_ += fmt::format(" \"{}\"\n", label);
}

void DataFile::gap() {
  text_ += '\n';
}

void PlotCommand::data(int index, const std::string& what, const std::string& title) {
  item(fmt::format("data index {} {}", index, what), title);
}

void PlotCommand::item(const std::string& what, const std::string& title) {
  items_.push_back(what + (title.empty() ? " notitle" : " title " + quoted(title)));
}

std::string PlotCommand::text() const {
  return fmt::format("  plot {}\n", fmt::join(items_, ", \\\n       "));
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

std::string script_text(const std::string& name, const std::string& shows, Canvas canvas, const std::string& body) {
  const double png_scale = 1.5;
  return fmt::format(
      "# {shows}\n"
      "# Draw again with: gnuplot {name}.gp\n"
      "set encoding utf8\n"
      "data = '{name}.dat'\n"
      "do for [format in 'svg png'] {{\n"
      "  if (format eq 'svg') {{\n"
      "    set terminal svg size {w},{h} noenhanced font 'DejaVu Sans,13' background rgb 'white'\n"
      "  }} else {{\n"
      "    set terminal pngcairo size {pw:.0f},{ph:.0f} noenhanced font 'DejaVu Sans,13' fontscale 0.75 * {s} \\\n"
      "      linewidth {s} pointscale {s}\n"
      "  }}\n"
      "  set output '{name}.' . format\n"
      "{body}"
      "  set output\n"
      "}}\n",
      fmt::arg("shows", shows), fmt::arg("name", name), fmt::arg("w", canvas.width), fmt::arg("h", canvas.height),
      fmt::arg("pw", png_scale * canvas.width), fmt::arg("ph", png_scale * canvas.height), fmt::arg("s", png_scale),
      fmt::arg("body", body));
}

}  // namespace exactvo::tools
