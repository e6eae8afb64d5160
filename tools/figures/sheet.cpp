// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/require.h"

namespace exactvo::tools {

namespace {

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

}  // namespace

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

}  // namespace exactvo::tools
