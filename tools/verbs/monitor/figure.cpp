// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/monitor/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/local_origin.h"

namespace exactvo::tools {
namespace {

using formation::MonitorSetup;
using geometry::Pose;

constexpr const char* kProvenColour = "#0072B2";
constexpr const char* kBeyondColour = "#D55E00";
constexpr const char* kMoverColour = "#E69F00";
constexpr const char* kWitnessStyle = "with points pt 6 ps 1.5 lw 2.5 lc rgb '#e00000'";

/// Poses of the robot that are drawn.
constexpr int kPoses = 16;

/// Where the robot is, at a share of a way's length.
Pose pose_on(const std::vector<formation::MonitorArc>& way, double share) {
  const double at = share * way.back().motion.end;
  std::size_t k = 0;
  while (k + 1 < way.size() && way[k].motion.end < at) ++k;
  const geometry::TurningMotion& m = way[k].motion;
  const geometry::Displacement d = displacement_after(m.twist, at - m.start);
  return {m.at + d.by, way[k].heading + m.twist.turn * (at - m.start)};
}

class MonitorPanel {
 public:
  MonitorPanel(const Box& view, DataFile& data) : view_(view), origin_(view), data_(data) { origin_.prepare(data); }

  void rings(const std::string& title, const std::vector<Points>& rings, const std::string& style) {
    const int index = data_.begin(title, "x, y [m]");
    for (const Points& ring : rings) data_.ring(ring);
    plot_.data(index, origin_.using_columns() + " " + style);
  }
  void points(const std::string& title, const Points& points, const std::string& style) {
    const int index = data_.begin(title, "x, y [m]");
    data_.rows(points);
    plot_.data(index, origin_.using_columns() + " " + style);
  }
  void obstacles(const std::vector<formation::SceneObstacle>& all) {
    std::vector<Points> solids;
    const int walls = data_.begin("walls", "x, y [m]");
    for (const formation::SceneObstacle& obstacle : all) {
      if (const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape)) {
        for (std::size_t k = 1; k < wall->points.size(); ++k)
          if (const Points piece = segment_within(view_, wall->points[k - 1], wall->points[k]); !piece.empty())
            data_.curve(piece);
      } else if (Points ring = clipped_to(tied_together(std::get<geometry::Polygon>(obstacle.shape)), view_);
                 ring.size() > 2) {
        solids.push_back(std::move(ring));
      }
    }
    plot_.data(walls, origin_.using_columns() + fmt::format(" with lines lw 2.5 lc rgb '{}'", kObstacleLine));
    rings(
        "obstacles", solids,
        fmt::format("with filledcurves closed fs solid border lc rgb '{}' fc rgb '{}'", kObstacleLine, kObstacleFill));
  }
  SheetPanel done(const std::string& title) const {
    return {quoted(title + origin_.in_title()), origin_.ranges(view_), plot_.text()};
  }

 private:
  Box view_;
  LocalOrigin origin_;
  DataFile& data_;
  PlotCommand plot_;
};

std::string outline_style(const char* colour, double width) {
  return fmt::format("with lines lw {} lc rgb '{}'", width, colour);
}

std::string filled_style(const char* colour, double opacity) {
  return fmt::format("with filledcurves closed fs transparent solid {0} border lc rgb '{1}' fc rgb '{1}'", opacity,
                     colour);
}

SheetPanel panel_of(const MonitorSetup& setup, const JudgedLine& line, char letter, DataFile& data) {
  std::vector<Points> first, proven, rest, beyond, seen, later;
  const auto add = [&](std::vector<Points>& rings, const Pose& pose) {
    for (const geometry::RoundedPolygon& part : setup.footprint) rings.push_back(hull_outline(part, pose));
  };
  const double length = line.whole.back().motion.end, cleared = line.proven.back().motion.end;
  add(first, pose_on(line.whole, 0.0));
  for (int k = 1; k <= kPoses; ++k) {
    const double share = static_cast<double>(k) / kPoses;
    add(share * length < cleared ? proven : beyond, pose_on(line.whole, share));
  }
  if (line.verdict.share == 1.0) beyond.clear();
  add(rest, pose_on(line.proven, 1.0));
  for (const formation::Mover& mover : line.movers) {
    seen.push_back(hull_outline(mover.shape, {}));
    later.push_back(hull_outline(mover.shape, {}, mover.position_error + mover.max_speed * cleared));
  }
  Box view;
  for (const auto* rings : {&first, &proven, &rest, &beyond, &seen})
    for (const Points& ring : *rings)
      for (const Vec2 p : ring) view.add(p);
  const double half = 0.58 * std::max(view.width(), view.height());
  const Vec2 middle = 0.5 * (view.low + view.high);
  MonitorPanel panel({middle - Vec2{half, half}, middle + Vec2{half, half}}, data);
  panel.obstacles(setup.obstacles);
  panel.rings("where movers may be when the robot rests", later, outline_style(kMoverColour, 1.0));
  panel.rings("movers", seen, filled_style(kMoverColour, 0.5));
  panel.rings("not proven", beyond, outline_style(kBeyondColour, 0.8));
  panel.rings("proven", proven, outline_style(kProvenColour, 0.8));
  panel.rings("robot at rest", rest, filled_style(kProvenColour, 0.45));
  panel.rings("robot now", first, filled_style("#555555", 0.35));
  Points places;
  if (line.verdict.witness) places.push_back(line.verdict.witness->place);
  panel.points("too near", places, kWitnessStyle);
  return panel.done(fmt::format("({}) {}", letter, line.title));
}

}  // namespace

Figure MonitorPicture::figure(const std::string& title) const {
  DataFile data;
  Sheet sheet;
  for (std::size_t k = 0; k < lines_.size(); ++k)
    sheet.panels.push_back(panel_of(setup_, lines_[k], static_cast<char>('a' + k), data));
  sheet.title = quoted(title);
  sheet.x_label = "'x [m]'";
  sheet.y_label = "'y [m]'";
  sheet.columns = lines_.size() == 1 ? 1 : lines_.size() == 2 || lines_.size() == 4 ? 2 : 3;
  sheet.panel_width = sheet.panel_height = lines_.size() == 1 ? 520.0 : 300.0;
  sheet.gap = 60.0;
  const auto box = [](const char* colour, double opacity) {
    return fmt::format("keyentry with boxes fs transparent solid {} noborder fc rgb '{}'", opacity, colour);
  };
  sheet.legend = {{box("#555555", 0.35), "robot now"},
                  {box(kProvenColour, 0.45), "at rest, after the share that is proven"},
                  {"keyentry " + outline_style(kProvenColour, 0.8), "proven clear"},
                  {"keyentry " + outline_style(kBeyondColour, 0.8), "the rest of the command"},
                  {box(kMoverColour, 0.5), "mover, and where it may come"},
                  {std::string("keyentry ") + kWitnessStyle, "too near"}};
  return sheet_figure("monitor", data.text(), "Commands of a robot, and how much of each is proven clear.", sheet);
}

}  // namespace exactvo::tools
