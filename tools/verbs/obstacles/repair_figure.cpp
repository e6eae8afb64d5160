// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/obstacles/repair_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/require.h"
#include "figures/local_origin.h"
#include "figures/outlines.h"
#include "figures/sheet.h"
#include "figures/style.h"

namespace exactvo::tools {

namespace {

using geometry::Polygon;
using geometry::Ring;
using geometry::Vec2;

/// A square.
Box view_of(const RepairedPolygon& polygon) {
  Box box;
  for (const Ring& ring : polygon.before) {
    for (const Vec2 p : ring) box.add(p);
  }
  const double pad = 0.04;
  const double half = 0.5 * std::max(box.width(), box.height()) + std::max(pad * box.diagonal(), 1e-9);
  const Vec2 middle = 0.5 * (box.low + box.high);
  return {{middle.x - half, middle.y - half}, {middle.x + half, middle.y + half}};
}

constexpr double kSideOfPlot = 340.0;  // px of what the axes enclose
constexpr double kGapOfPlots = 60.0;   // px
/// "-1.2e+06", eight characters of 6 px, and a gap of two.
constexpr double kWidthOfTic = 60.0;  // px

/// The least of 1, 2, 5, 10, ... metres that is as wide as a label.
double distance_of_tics(const Box& view) {
  const double least = kWidthOfTic / kSideOfPlot * std::max(view.width(), view.height());
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= least) return digit * power;
  return 10.0 * power;
}

constexpr const char* kProblemMark = "with points pt 6 ps 1.6 lw 2.5 lc rgb '#e00000'";

class Panels {
 public:
  void row(const RepairedPolygon& polygon) {
    LocalOrigin(view_of(polygon)).prepare(data_);
    before(polygon);
    after(polygon);
  }
  Figure figure() && {
    sheet_.title = "'Polygons before and after their repair'";
    sheet_.x_label = "'x [m]'";
    sheet_.y_label = "'y [m]'";
    sheet_.columns = 2;
    sheet_.panel_width = sheet_.panel_height = kSideOfPlot;
    sheet_.gap = kGapOfPlots;
    sheet_.legend = {
        {"keyentry with lines lw 2 lc rgb '#3f444d'", "outline"},
        {std::string("keyentry ") + kProblemMark, "problem"},
        {fmt::format("keyentry with boxes fs transparent solid 0.45 noborder fc rgb '{}'", series_colour(0)),
         "polygon, a colour each"}};
    return sheet_figure("repair", data_.text(), "Polygons before and after a repair.", sheet_);
  }

 private:
  void before(const RepairedPolygon& polygon) {
    const LocalOrigin origin(view_of(polygon));
    PlotCommand plot;
    plot.data(rings("before: " + polygon.title, polygon.before),
              origin.using_columns() + " with lines lw 2 lc rgb '#3f444d'");
    const int marks = data_.begin("problems", "x, y [m]");
    data_.rows(polygon.problems);
    plot.data(marks, origin.using_columns() + " " + kProblemMark);
    panel("before: " + polygon.title, view_of(polygon), plot);
  }

  /// Each polygon with its own holes: what lies in a hole of another keeps its colour.
  void after(const RepairedPolygon& polygon) {
    const LocalOrigin origin(view_of(polygon));
    PlotCommand plot;
    std::vector<Ring> all;
    for (std::size_t k = 0; k < polygon.after.size(); ++k) {
      const Polygon& part = polygon.after[k];
      const std::string fill =
          fmt::format(" with filledcurves closed fs transparent solid 0.45 noborder fc rgb '{}'", series_colour(k));
      plot.data(rings("polygon, its holes tied to it", {tied_together(part)}), origin.using_columns() + fill);
      all.push_back(part.outer);
      all.insert(all.end(), part.holes.begin(), part.holes.end());
    }
    plot.data(rings("rings after", all), origin.using_columns() + " with lines lw 1.5 lc rgb '#3f444d'");
    const std::size_t n = polygon.after.size();
    panel(n == 0 ? std::string("after: cannot be repaired") : fmt::format("after: {} polygon{}", n, n == 1 ? "" : "s"),
          view_of(polygon), plot);
  }

  int rings(const std::string& title, const std::vector<Ring>& rings) {
    const int index = data_.begin(title, "x, y [m]");
    for (const Ring& ring : rings) data_.ring(ring);
    return index;
  }

  void panel(const std::string& title, const Box& view, const PlotCommand& plot) {
    const LocalOrigin origin(view);
    const std::string from = origin.in_title();
    const std::size_t room = characters_in(1.3 * (kSideOfPlot + 0.5 * kGapOfPlots));
    const std::string words = letter_of(sheet_.panels.size()) + " " + title;
    sheet_.panels.push_back({quoted(shortened(words, room - std::min(from.size(), room / 2)) + from),
                             origin.ranges(view) + fmt::format("\nset xtics {:.9g}", distance_of_tics(view)),
                             plot.text()});
  }

  DataFile data_;
  Sheet sheet_;
};

}  // namespace

Figure repair_figure(const std::vector<RepairedPolygon>& polygons) {
  EXACTVO_REQUIRE(!polygons.empty(), std::string("no polygon"));
  Panels panels;
  const std::size_t rows = std::min(polygons.size(), kMostRepairedDrawn);
  for (std::size_t k = 0; k < rows; ++k) panels.row(polygons[k]);
  return std::move(panels).figure();
}

}  // namespace exactvo::tools
