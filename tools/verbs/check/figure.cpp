// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/check/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "exactvo/geometry/counted.h"
#include "figures/plane.h"
#include "support/obstacle_name.h"

namespace exactvo::tools {

using geometry::RigidBody;

namespace {

constexpr const char* kWayColour = "#8fa3b8";
constexpr const char* kFirstColour = "#0072B2";
constexpr const char* kOtherColour = "#009E73";

/// Share of the diagonal of all ways: less than a pixel.
constexpr double kFinest = 1.0 / 2000.0;
/// Places of overlaps that are drawn.
constexpr std::size_t kMostPlaces = 2000;

std::vector<Points> outlines_of(const RigidBody& body, Vec2 at, double turned) {
  std::vector<Points> rings;
  for (const geometry::RoundedPolygon& part : body) rings.push_back(hull_outline(part, {at, turned}));
  return rings;
}

/// With its rows.
void draw_way(const std::string& title, const Points& way, const char* colour, Panel& panel) {
  panel.curves(title, {way}, line_style(1.4, colour));
  panel.points(title, way, fmt::format("with points pt 7 ps 0.5 lc rgb '{}'", colour));
}

SheetPanel on_sheet(const Panel& panel, const std::string& title) {
  return panel.on_sheet(quoted(title + panel.origin.in_title()));
}

constexpr const char* kPlaceStyle = "with points pt 6 ps 1.4 lw 2 lc rgb '#e00000'";

}  // namespace

CheckPicture::CheckPicture(const CheckedFile& asked, const std::vector<RigidBody>& bodies)
    : asked_(asked), bodies_(bodies), least_step_(kFinest * asked.survey.extent().diagonal()), agents_(bodies.size()) {}

void CheckPicture::add(const datasets::TrajectoryRow& row) {
  Agent& agent = agents_[row.agent];
  agent.recent[agent.rows++ % kRecent] = row.at;
  if (agent.way.empty() || norm(row.at - agent.way.back()) >= least_step_) agent.way.push_back(row.at);
}

void CheckPicture::add(const geometry::MotionEvent& event) {
  if (event.encounter != geometry::Encounter::overlap) return;
  if (places_.size() < kMostPlaces) places_.push_back(event.place);
  if (close_.size() == kMostNear) return;
  close_.push_back({event, recent_of(event.body), event.with_obstacle ? Points{} : recent_of(event.other)});
}

Points CheckPicture::recent_of(std::size_t agent) const {
  const Agent& a = agents_[agent];
  Points points;
  for (std::size_t k = a.rows < kRecent ? 0 : a.rows - kRecent; k < a.rows; ++k)
    points.push_back(a.recent[k % kRecent]);
  return points;
}

Figure CheckPicture::figure(const geometry::MotionCheck& check) const {
  DataFile data;
  Sheet sheet;
  Box all;
  for (const Agent& agent : agents_)
    for (const Vec2 p : agent.way) all.add(p);
  for (const formation::SceneObstacle& obstacle : asked_.obstacles)
    for (const Vec2 p : geometry::vertices_of(obstacle.shape)) all.add(p);
  Panel whole(square_round(all, 0.54), data);
  whole.obstacles(asked_.obstacles, 2.0, false);
  std::vector<Points> ways, alone;
  for (const Agent& agent : agents_) (agent.way.size() > 1 ? ways : alone).push_back(agent.way);
  whole.curves("ways", ways, line_style(0.8, kWayColour));
  Points places;
  for (const Points& way : alone)
    if (!way.empty()) places.push_back(way.front());
  whole.points("agents that do not move", places, fmt::format("with points pt 7 ps 0.3 lc rgb '{}'", kWayColour));
  whole.points("overlaps", places_, kPlaceStyle);
  sheet.panels.push_back(on_sheet(whole, "(a) all ways"));
  for (std::size_t k = 0; k < close_.size(); ++k) {
    const Close& c = close_[k];
    const std::vector<Points> body = outlines_of(bodies_[c.event.body], c.event.at, c.event.turned);
    const std::vector<Points> other = c.event.with_obstacle
                                          ? std::vector<Points>{}
                                          : outlines_of(bodies_[c.event.other], c.event.other_at, c.event.other_turned);
    Box near;
    for (const auto* rings : {&body, &other})
      for (const Points& ring : *rings)
        for (const Vec2 p : ring) near.add(p);
    near = near.grown(0.6 * std::max(near.width(), near.height()));
    Panel panel(square_round(near, 0.54), data);
    panel.obstacles(asked_.obstacles, 2.0, false);
    panel.rings("first body", body, clear_fill(kFirstColour, 0.3));
    panel.rings("other body", other, clear_fill(kOtherColour, 0.3));
    draw_way("way of the first", c.way, kFirstColour, panel);
    draw_way("way of the other", c.other_way, kOtherColour, panel);
    panel.points("deepest", {c.event.place}, kPlaceStyle);
    const std::string names =
        asked_.file.agents[c.event.body] + " and " +
        (c.event.with_obstacle ? obstacle_name(asked_.obstacles[c.event.other]) : asked_.file.agents[c.event.other]);
    sheet.panels.push_back(on_sheet(
        panel, fmt::format("{} {}, t = {:.6g} s", letter_of(k + 1), shortened(names, 24), c.event.nearest_time)));
  }
  const std::string file = std::filesystem::path(asked_.file.file).filename().string();
  sheet.title = quoted(shortened(fmt::format("{}: {}", file, geometry::counted(check.overlaps, "overlap")), 70));
  sheet.x_label = "'x [m]'";
  sheet.y_label = "'y [m]'";
  sheet.columns = close_.empty() ? 1 : close_.size() <= 1 ? 2 : 3;
  sheet.panel_width = sheet.panel_height = close_.empty() ? 560.0 : 300.0;
  sheet.gap = 60.0;
  sheet.legend = {{"keyentry " + line_style(0.8, kWayColour), "way"},
                  {std::string("keyentry ") + kPlaceStyle, "where an overlap is deepest"}};
  if (!close_.empty()) {
    sheet.legend.push_back(
        {fmt::format("keyentry with boxes fs transparent solid 0.3 noborder fc rgb '{}'", kFirstColour),
         "first body; dots are its rows"});
    sheet.legend.push_back(
        {fmt::format("keyentry with boxes fs transparent solid 0.3 noborder fc rgb '{}'", kOtherColour), "other body"});
  }
  return sheet_figure("check", data.text(), "Ways of agents, and where they overlap.", sheet);
}

}  // namespace exactvo::tools
