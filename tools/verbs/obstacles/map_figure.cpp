// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/obstacles/map_figure.h"

#include <fmt/format.h>

#include "figures/outlines.h"
#include "figures/style.h"
#include "verbs/obstacles/map_layers.h"

namespace exactvo::tools {

namespace {

using geometry::ObstacleShapes;

std::vector<Points> pieces_with_inside(const ObstacleShapes& shapes) {
  std::vector<Points> pieces;
  for (const geometry::ConvexShape& piece : shapes.pieces) {
    Points ring = outline(piece);
    if (ring.size() > 2) pieces.push_back(std::move(ring));
  }
  return pieces;
}

/// Neighbouring pieces in different colours, as far as taking turns does that.
void draw_pieces(const std::vector<ObstacleShapes>& obstacles, MapLayers& map) {
  constexpr std::size_t kColours = 4;
  std::vector<std::vector<Points>> by_colour(kColours);
  for (const ObstacleShapes& shapes : obstacles) {
    const std::vector<Points> pieces = pieces_with_inside(shapes);
    for (std::size_t k = 0; k < pieces.size(); ++k) by_colour[k % kColours].push_back(pieces[k]);
  }
  bool in_key = true;
  for (std::size_t k = 0; k < kColours; ++k) {
    map.curves("convex pieces", by_colour[k],
               fmt::format("with filledcurves closed fs transparent solid 0.22 border lc rgb '#8a919c' fc rgb '{}'",
                           series_colour(k + 1)),
               true, in_key);
    in_key = in_key && by_colour[k].empty();
  }
}

template <class Pick>
std::vector<Points> gathered(const std::vector<ObstacleShapes>& obstacles, const Pick& pick) {
  std::vector<Points> curves;
  for (const ObstacleShapes& shapes : obstacles) pick(shapes, curves);
  return curves;
}

}  // namespace

Figure map_figure(const std::vector<formation::SceneObstacle>& obstacles, const std::string& title) {
  MapLayers map;
  std::vector<geometry::Obstacle> all;
  for (const formation::SceneObstacle& o : obstacles) all.push_back(o.shape);
  add_obstacles(all, true, map);
  return map.figure(title);
}

Figure shapes_figure(const std::vector<ObstacleShapes>& obstacles, const std::string& title) {
  MapLayers map;
  std::vector<geometry::Obstacle> all;
  for (const ObstacleShapes& shapes : obstacles) all.push_back(shapes.obstacle);
  constexpr std::size_t kMostDrawnBold = 40;
  const bool crowded = obstacles.size() > kMostDrawnBold;
  add_obstacles(all, false, map);
  draw_pieces(obstacles, map);
  map.curves("facade ellipses",
             gathered(obstacles,
                      [](const ObstacleShapes& s, std::vector<Points>& out) {
                        for (const geometry::FacadeEnclosure& e : s.facade_ellipses) out.push_back(outline(e.ellipse));
                      }),
             line_style(crowded ? 0.4 : 0.8, "#56B4E9"), true);
  map.curves(
      "hulls",
      gathered(obstacles, [](const ObstacleShapes& s, std::vector<Points>& out) { out.push_back(s.hull.vertices); }),
      line_style(1.6, "#009E73", " dt (8,5)"), true);
  map.curves("smallest ellipses",
             gathered(obstacles, [](const ObstacleShapes& s,
                                    std::vector<Points>& out) { out.push_back(outline(s.smallest_ellipse)); }),
             line_style(1.8, "#0072B2"), true);
  map.curves("trap-free ellipses",
             gathered(obstacles,
                      [](const ObstacleShapes& s, std::vector<Points>& out) {
                        if (s.trap_free.ellipse) out.push_back(outline(*s.trap_free.ellipse));
                      }),
             line_style(1.8, "#CC79A7", " dt (3,3)"), true);
  map.curves("facades",
             gathered(obstacles,
                      [](const ObstacleShapes& s, std::vector<Points>& out) {
                        for (const geometry::Segment& f : s.facades.facades) out.push_back({f.a, f.b});
                      }),
             crowded ? line_style(1.0, "#D55E00") : "with linespoints lw 2.2 pt 7 ps 0.35 lc rgb '#D55E00'", false);
  return map.figure(title);
}

}  // namespace exactvo::tools
