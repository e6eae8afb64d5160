// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Axes over a plane: of metres, whose numbers count from a round point nearby where the plane lies far from (0, 0),
/// or of velocities. `Panel` holds what is drawn on one set of axes; `MapLayers` draws a map that fits what it shows.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/route_certificate.h"
#include "figures/figure.h"
#include "figures/outlines.h"

namespace exactvo::tools {

/// Sets the ranges of both axes.
std::string axis_ranges(const Box& view);

/// "with ..." of gnuplot.
std::string line_style(double width, const std::string& colour, const std::string& dash = "");
std::string solid_fill(const std::string& colour);
/// With a border; `opacity` in [0, 1].
std::string clear_fill(const std::string& colour, double opacity);

/// The corners of the footprint of a robot on wheels whose reference point is at `at`, m; empty where it has none.
Points footprint_at(const formation::DifferentialDrive& drive, Vec2 at, Vec2 heading);

/// The least of 1, 2, 5, 10, 20, ... and their tenths, hundredths and so on that is not below.
double round_size(double least);

/// A square round the middle of the box, `share` of its longer side from the middle to each side, never empty.
Box square_round(const Box& box, double share);

/// Six digits a tick cannot tell metres at 5.5e6 apart: there the axes count from a round point, which the labels name.
/// Data files keep the coordinates as they are; the scripts subtract. Exact enough for drawing.
class LocalOrigin {
 public:
  /// (0, 0) where the numbers in view can be read as they are: below 10^5 and a hundred times the view.
  explicit LocalOrigin(const Box& view);

  bool is_far() const { return x_.first != 0.0 || y_.first != 0.0; }
  Vec2 place() const { return {x_.first, y_.first}; }

  /// "using 1:2" or the same with x0 and y0 subtracted; `more` are further columns: ":3".
  std::string using_columns(int x = 1, int y = 2, const std::string& more = "") const;
  /// Sets x0 and y0, and the ranges of the axes.
  std::string ranges(const Box& view) const;
  /// "x [m]" or "x - 5500000 [m]".
  std::string x_label() const { return label("x", x_); }
  std::string y_label() const { return label("y", y_); }
  /// " - (500000, 5500000)" for titles of panels without labels; empty where not far.
  std::string in_title() const;

 private:
  /// A number, and its text.
  using Coordinate = std::pair<double, std::string>;

  static Coordinate round_number_near(double low, double high, double extent);
  static std::string label(const char* axis, const Coordinate& c);

  Coordinate x_{0.0, "0"}, y_{0.0, "0"};
};

/// A short text at a place, of the program's own: gnuplot's markup works in it.
struct Label {
  Vec2 place;
  std::string text;
};

/// Closed chains that separate a start from a goal, as lines along obstacles and across gaps.
struct ChainLines {
  void add(const std::vector<geometry::ChainPoint>& chain);

  std::vector<Points> along, across;
};

/// One set of axes: data sets and the plot items that draw them, each over the one before. `title` is that of the data
/// set, `key` what the legend says, which has no entry where it is empty. What has no point is left out.
class Panel {
 public:
  Panel(const Box& shown, DataFile& file) : data(file), view(shown), origin(shown) {}
  /// A panel of velocities, whose axes count from (0, 0).
  static Panel of_velocities(const Box& view, DataFile& data) { return {view, data, "v_x [m/s], v_y [m/s]"}; }

  /// Draws a data set whose first two columns are x and y, and its columns `more`; `how` is what gnuplot has after
  /// them.
  void draw(int index, const std::string& how, const std::string& key = "", const std::string& more = "") {
    plot.data(index, origin.using_columns(1, 2, more) + " " + how, key);
  }
  void curves(const std::string& title, const std::vector<Points>& curves, const std::string& style,
              const std::string& key = "");
  /// Closed.
  void rings(const std::string& title, const std::vector<Points>& rings, const std::string& style,
             const std::string& key = "");
  void points(const std::string& title, const Points& points, const std::string& style, const std::string& key = "");
  void labels(const std::string& title, const std::vector<Label>& labels, const std::string& style);
  void arrow(const std::string& title, Vec2 from, Vec2 by, const std::string& style, const std::string& key = "");
  /// Polygons filled, with their outlines and holes left free, and walls as lines. gnuplot lets fillings run over the
  /// labels of the axes: they are cut at the view.
  void obstacles(const std::vector<formation::SceneObstacle>& obstacles, double wall_width, bool has_key);
  /// The boundaries of half-planes as far as they are in view, and within `others`, with strokes into their forbidden
  /// sides.
  void half_planes(const std::string& title, const std::vector<geometry::HalfPlane>& all, const std::string& style,
                   const std::string& hatching, const std::string& key = "",
                   const std::vector<geometry::HalfPlane>& others = {});

  /// The body of a figure of this panel alone, of metres.
  std::string body(const std::string& quoted_title) const;
  /// `title` is a gnuplot string.
  SheetPanel on_sheet(const std::string& title) const;

  DataFile& data;
  Box view;
  LocalOrigin origin;
  PlotCommand plot;

 private:
  Panel(const Box& shown, DataFile& file, const char* columns)
      : data(file), view(shown), origin(Box{}), columns_(columns) {}

  const char* columns_ = "x [m], y [m]";
};

/// The plot of a velocity plane as the body of a figure; `title` is a gnuplot string.
std::string velocity_plane(const std::string& title, const Box& view, const std::string& plot);

/// A map of layers, in the order in which they are added. Every point drawn belongs to the view. The legend has the
/// titles of those that are `in_key`.
class MapLayers {
 public:
  void curves(const std::string& title, const std::vector<Points>& curves, const std::string& style, bool closed,
              bool in_key = true);
  void labels(const std::string& title, const std::vector<Label>& labels, const std::string& style);
  void obstacles(const std::vector<formation::SceneObstacle>& obstacles);
  Figure figure(const std::string& title) const;

 private:
  Box axes() const;

  std::vector<std::function<void(Panel&)>> layers_;
  Box view_;
};

}  // namespace exactvo::tools
