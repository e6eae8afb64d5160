// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/body_panel.h"

#include <fmt/format.h>

#include <algorithm>

namespace exactvo::tools {

Box square_view(const Box& box, double share) {
  const double half = share * std::max({box.width(), box.height(), 1e-6});
  const Vec2 middle = 0.5 * (box.low + box.high);
  return {middle - Vec2{half, half}, middle + Vec2{half, half}};
}

std::string line_style(double width, const std::string& colour, const std::string& dash) {
  return fmt::format("with lines lw {} lc rgb '{}'{}", width, colour, dash);
}

std::string filled_style(const char* colour, double opacity) {
  return fmt::format("with filledcurves closed fs transparent solid {0} border lc rgb '{1}' fc rgb '{1}'", opacity,
                     colour);
}

std::string filled_key(const char* colour, double opacity) {
  return fmt::format("keyentry with boxes fs transparent solid {} noborder fc rgb '{}'", opacity, colour);
}

std::vector<Points> outlines_of(const geometry::RigidBody& body, const geometry::Pose& pose) {
  std::vector<Points> rings;
  for (const geometry::RoundedPolygon& part : body) rings.push_back(hull_outline(part, pose));
  return rings;
}

void BodyPanel::add(const std::string& title, const std::vector<Points>& curves, const std::string& style,
                    bool closed) {
  const int index = data_.begin(title, "x, y [m]");
  for (const Points& curve : curves) closed ? data_.ring(curve) : data_.curve(curve);
  plot_.data(index, origin_.using_columns() + " " + style);
}

void BodyPanel::points(const std::string& title, const Points& points, const std::string& style) {
  const int index = data_.begin(title, "x, y [m]");
  data_.rows(points);
  plot_.data(index, origin_.using_columns() + " " + style);
}

void BodyPanel::add_seen(const Points& way, std::vector<Points>& pieces) const {
  for (std::size_t k = 1; k < way.size(); ++k)
    if (Points piece = segment_within(view_, way[k - 1], way[k]); !piece.empty()) pieces.push_back(std::move(piece));
}

void BodyPanel::way(const std::string& title, const Points& way, const std::string& style) {
  std::vector<Points> seen;
  add_seen(way, seen);
  curves(title, seen, style);
}

void BodyPanel::map(const std::vector<geometry::Obstacle>& obstacles) {
  std::vector<Points> solids, rims, walls;
  for (const geometry::Obstacle& obstacle : obstacles) {
    if (const auto* wall = std::get_if<geometry::Polyline>(&obstacle)) {
      add_seen(wall->points, walls);
      continue;
    }
    const auto& polygon = std::get<geometry::Polygon>(obstacle);
    // The lines that tie holes to the outer ring are no rim.
    if (Points ring = clipped_to(tied_together(polygon), view_); ring.size() > 2) solids.push_back(std::move(ring));
    for (const geometry::Segment& edge : geometry::edges_of(obstacle)) add_seen({edge.a, edge.b}, rims);
  }
  rings("obstacles", solids, fmt::format("with filledcurves closed fs solid noborder fc rgb '{}'", kObstacleFill));
  curves("their rims", rims, line_style(1.0, kObstacleLine));
  curves("walls", walls, line_style(2.5, kObstacleLine));
}

SheetPanel BodyPanel::done(const std::string& title) const {
  return {quoted(title + origin_.in_title()), origin_.ranges(view_), plot_.text()};
}

}  // namespace exactvo::tools
