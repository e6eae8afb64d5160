// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/repair_figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "exactvo/geometry/require.h"
#include "figures/style.h"

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

class Panels {
 public:
  void row(const MendedPolygon& polygon) {
    before(polygon);
    after(polygon);
  }
  Figure figure(const std::string& name, std::size_t rows) const {
    const std::string shows = "Polygons before and after a repair.";
    const Canvas canvas{1000, 60 + 420 * static_cast<int>(rows)};
    const std::string body = fmt::format(
        "  set multiplot layout {},2\n  set size ratio -1\n  set grid lc rgb '#e9e9e9'\n  unset key\n  set tics font "
        "',10'\n{}"
        "  unset multiplot\n",
        rows, plots_);
    return {name, data_.text(), script_text(name, shows, canvas, body)};
  }

 private:
  void before(const MendedPolygon& polygon) {
    PlotCommand plot;
    plot.data(rings("before: " + polygon.title, polygon.before), "using 1:2 with lines lw 2 lc rgb '#3f444d'");
    const int marks = data_.begin("problems", "x, y [m]");
    for (const Vec2 p : polygon.problems) data_.row({p.x, p.y});
    plot.data(marks, "using 1:2 with points pt 6 ps 1.6 lw 2.5 lc rgb '#e00000'");
    panel("before: " + polygon.title, view_of(polygon), plot);
  }

  void after(const MendedPolygon& polygon) {
    PlotCommand plot;
    for (std::size_t k = 0; k < polygon.after.size(); ++k) {
      const std::string fill = fmt::format(
          "using 1:2 with filledcurves closed fs transparent solid 0.45 noborder fc rgb '{}'", series_colour(k));
      plot.data(rings("polygon", {polygon.after[k].outer}), fill);
    }
    for (const Polygon& part : polygon.after) {
      for (const Ring& hole : part.holes)
        plot.data(rings("hole", {hole}), "using 1:2 with filledcurves closed fs solid noborder fc rgb 'white'");
    }
    std::vector<Ring> all;
    for (const Polygon& part : polygon.after) {
      all.push_back(part.outer);
      all.insert(all.end(), part.holes.begin(), part.holes.end());
    }
    plot.data(rings("rings after", all), "using 1:2 with lines lw 1.5 lc rgb '#3f444d'");
    const std::size_t n = polygon.after.size();
    panel(n == 0 ? std::string("after: can't be mended") : fmt::format("after: {} polygon{}", n, n == 1 ? "" : "s"),
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
    const double width_of_panel = 440.0;
    plots_ += fmt::format("  set title {}\n  set xrange [{:.9g}:{:.9g}]\n  set yrange [{:.9g}:{:.9g}]\n{}",
                          quoted(shortened(title, characters_in(width_of_panel))), view.low.x, view.high.x, view.low.y,
                          view.high.y, plot.text());
  }

  DataFile data_;
  std::string plots_;
};

}  // namespace

Figure repair_figure(const std::vector<MendedPolygon>& polygons, const std::string& name) {
  EXACTVO_REQUIRE(!polygons.empty(), std::string("no polygon"));
  Panels panels;
  const std::size_t rows = std::min(polygons.size(), kMostMendedDrawn);
  for (std::size_t k = 0; k < rows; ++k) panels.row(polygons[k]);
  return panels.figure(name, rows);
}

}  // namespace exactvo::tools
