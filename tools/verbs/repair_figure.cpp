// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/repair_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/require.h"
#include "figures/local_origin.h"
#include "figures/outlines.h"
#include "figures/style.h"
#include "figures/template.h"

namespace exactvo::tools {

namespace {

using geometry::Polygon;
using geometry::Ring;
using geometry::Vec2;

Box view_of(const MendedPolygon& polygon) {
  Box box;
  for (const Ring& ring : polygon.before) {
    for (const Vec2 p : ring) box.add(p);
  }
  const double pad = 0.04;
  return box.grown(std::max(pad * box.diagonal(), 1e-9));
}

constexpr double kWidthOfPanel = 440.0;  // px, with its margins
constexpr double kSideOfPlot = 330.0;    // px, the longer one of what the axes enclose
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

class Panels {
 public:
  void row(const MendedPolygon& polygon) {
    LocalOrigin(view_of(polygon)).prepare(data_);
    before(polygon);
    after(polygon);
  }
  Figure figure(std::size_t rows) const {
    const std::string shows = "Polygons before and after a repair.";
    const Canvas canvas{1000, 60 + 420 * static_cast<int>(rows)};
    return {"repair", data_.text(), shows, canvas,
            filled("repair", {{"rows", std::to_string(rows)}, {"panels", plots_}})};
  }

 private:
  void before(const MendedPolygon& polygon) {
    const LocalOrigin origin(view_of(polygon));
    PlotCommand plot;
    plot.data(rings("before: " + polygon.title, polygon.before),
              origin.using_columns() + " with lines lw 2 lc rgb '#3f444d'");
    const int marks = data_.begin("problems", "x, y [m]");
    for (const Vec2 p : polygon.problems) data_.row({p.x, p.y});
    plot.data(marks, origin.using_columns() + " with points pt 6 ps 1.6 lw 2.5 lc rgb '#e00000'");
    panel("before: " + polygon.title, view_of(polygon), plot);
  }

  /// Each polygon with its own holes: what lies in a hole of another keeps its colour.
  void after(const MendedPolygon& polygon) {
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
    for (const Ring& ring : rings) {
      for (const Vec2 p : ring) data_.row({p.x, p.y});
      if (!ring.empty()) data_.row({ring.front().x, ring.front().y});
      data_.gap();
    }
    return index;
  }

  void panel(const std::string& title, const Box& view, const PlotCommand& plot) {
    const LocalOrigin origin(view);
    const std::string from = origin.in_title();
    const std::size_t room = characters_in(kWidthOfPanel);
    const std::string shown = shortened(title, room - std::min(from.size(), room / 2)) + from;
    plots_ += filled("repair_panel", {{"title", quoted(shown)},
                                      {"ranges", origin.ranges(view)},
                                      {"tics", fmt::format("{:.9g}", distance_of_tics(view))},
                                      {"plot", plot.text()}});
  }

  DataFile data_;
  std::string plots_;
};

}  // namespace

Figure repair_figure(const std::vector<MendedPolygon>& polygons) {
  EXACTVO_REQUIRE(!polygons.empty(), std::string("no polygon"));
  Panels panels;
  const std::size_t rows = std::min(polygons.size(), kMostMendedDrawn);
  for (std::size_t k = 0; k < rows; ++k) panels.row(polygons[k]);
  return panels.figure(rows);
}

}  // namespace exactvo::tools
