// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/monitor/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/plane.h"

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
  Panel panel(square_round(view, 0.58), data);
  panel.obstacles(setup.obstacles, 2.5, false);
  panel.rings("where movers may be when the robot rests", later, line_style(1.0, kMoverColour));
  panel.rings("movers", seen, clear_fill(kMoverColour, 0.5));
  panel.rings("not proven", beyond, line_style(0.8, kBeyondColour));
  panel.rings("proven", proven, line_style(0.8, kProvenColour));
  panel.rings("robot at rest", rest, clear_fill(kProvenColour, 0.45));
  panel.rings("robot now", first, clear_fill("#555555", 0.35));
  Points places;
  if (line.verdict.witness) places.push_back(line.verdict.witness->place);
  panel.points("too near", places, kWitnessStyle);
  return panel.on_sheet(quoted(fmt::format("({}) {}", letter, line.title) + panel.origin.in_title()));
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
                  {"keyentry " + line_style(0.8, kProvenColour), "proven clear"},
                  {"keyentry " + line_style(0.8, kBeyondColour), "the rest of the command"},
                  {box(kMoverColour, 0.5), "mover, and where it may come"},
                  {std::string("keyentry ") + kWitnessStyle, "too near"}};
  return sheet_figure("monitor", data.text(), "Commands of a robot, and how much of each is proven clear.", sheet);
}

}  // namespace exactvo::tools
