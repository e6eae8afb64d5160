// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles as a map, and over it what was made of them: facades, convex pieces, hulls and ellipses. A map is layers
/// of curves and labels, drawn in the order in which they are added. And polygons before and after a repair, side by
/// side: the rings as given with their problems marked, and the polygons that they became, a colour each.

#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/obstacle_shapes.h"
#include "figures/body_panel.h"
#include "figures/figure.h"
#include "figures/outlines.h"

namespace exactvo::tools {

class MapLayers {
 public:
  /// A layer without curves is left out. Every point drawn belongs to the view. `style` is gnuplot's.
  void curves(const std::string& title, const std::vector<Points>& curves, const std::string& style, bool closed,
              bool in_key = true);

  struct Label {
    Vec2 place;
    std::string text;  ///< of the program's own: gnuplot's markup works in it
  };
  void labels(const std::string& title, const std::vector<Label>& labels, const std::string& style);

  Figure figure(const std::string& title) const;

 private:
  struct Layer {
    std::string title;
    std::vector<Points> curves;
    std::vector<Label> labels;
    std::string style;
    bool closed, in_key;
  };

  Box axes() const;
  static int write(const Layer& layer, DataFile& data);

  std::vector<Layer> layers_;
  Box view_;
};

/// "with ..." for MapLayers::curves, as `line_style` is.
std::string solid_fill(const std::string& colour);

/// Solid grey with holes left free, and walls as lines.
void add_obstacles(const std::vector<geometry::Obstacle>& obstacles, bool with_edges, MapLayers& map);

/// Solid grey with holes left free, and walls as lines.
Figure map_figure(const std::vector<formation::SceneObstacle>& obstacles, const std::string& title);

/// The same for decomposed obstacles: pieces filled in pale colours, facades as bold lines, hulls dashed, the smallest
/// ellipses, the facades' and the trap-free ones.
Figure shapes_figure(const std::vector<geometry::ObstacleShapes>& obstacles, const std::string& title);

/// One polygon that was recombined.
struct RepairedPolygon {
  std::string title;
  std::vector<geometry::Ring> before;
  std::vector<geometry::Vec2> problems;  ///< where
  std::vector<geometry::Polygon> after;  ///< empty where it could not be repaired
};

/// As many as go onto a sheet.
inline constexpr std::size_t kMostRepairedDrawn = 6;

/// A row each. REQUIRES: at least one, at most kMostRepairedDrawn.
Figure repair_figure(const std::vector<RepairedPolygon>& polygons);

}  // namespace exactvo::tools
