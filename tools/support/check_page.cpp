// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/check_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/pi.h"
#include "explorer/page.h"
#include "figures/outlines.h"
#include "support/footprint.h"
#include "support/obstacle_name.h"

namespace exactvo::tools {

using geometry::MotionEvent;

namespace {

/// What a page lists.
constexpr std::size_t kMostOverlaps = 1000;
/// Chords that are drawn for a curve.
constexpr int kChords = 16;

bool is_plain_disc(const geometry::RigidBody& body) {
  return body.size() == 1 && body.front().corners.size() == 1 && body.front().corners.front() == Vec2{};
}

}  // namespace

CheckPage::CheckPage(const CheckedFile& asked, const std::vector<geometry::RigidBody>& bodies)
    : asked_(asked), bodies_(bodies), ways_(bodies.size()), last_(bodies.size()), has_last_(bodies.size()) {
  const datasets::TrajectorySurvey& s = asked.survey;
  const double knots = static_cast<double>(s.rows()) * (asked.has_curves ? kChords : 1);
  if (knots > static_cast<double>(limits_.states))
    least_step_ = (s.last() - s.first()) * static_cast<double>(bodies.size()) / static_cast<double>(limits_.states);
}

void CheckPage::put(std::size_t agent, const Knot& knot) {
  std::vector<Knot>& way = ways_[agent];
  if (has_last_[agent]) {
    const Knot& last = last_[agent];
    const bool is_end = knot.begins || last.begins;
    if (way.empty() || is_end || last.time - way.back().time >= least_step_) way.push_back(last);
  }
  last_[agent] = knot;
  has_last_[agent] = true;
}

void CheckPage::add(std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned) {
  const bool is_disc = is_plain_disc(bodies_[agent]), turns = turned.by != 0.0 && !is_disc;
  has_headings_ |= (turned.from != 0.0 || turned.by != 0.0) && !is_disc;
  const double start = start_of(piece), end = end_of(piece);
  const bool goes_on = has_last_[agent] && (last_[agent].time == start || asked_.between == geometry::Between::none);
  const Vec2 from = position_at(piece, start);
  const bool is_moved = last_[agent].at != from || last_[agent].heading != turned.from;
  if (!goes_on || is_moved || last_[agent].time != start) put(agent, {start, from, !goes_on, turned.from});
  const bool is_chord = !turns && std::holds_alternative<geometry::StraightMotion>(piece);
  const int chords = is_chord ? 1 : kChords;
  std::optional<geometry::TurningMotion> arc;
  if (turns) arc = turning_motion(std::get<geometry::StraightMotion>(piece), turned);
  for (int k = 1; k <= chords && start < end; ++k) {
    const double time = k == chords ? end : start + (end - start) * k / chords;
    const Vec2 at = arc ? arc->at + displacement_after(arc->twist, time - start).by : position_at(piece, time);
    put(agent, {time, at, false, turned.from + turned.by * k / chords});
  }
}

void CheckPage::add(const MotionEvent& event) {
  if (event.encounter != geometry::Encounter::overlap) return;
  if (overlaps_.size() < kMostOverlaps)
    overlaps_.push_back(event);
  else
    ++overlaps_left_out_;
}

std::vector<std::vector<CheckPage::Knot>> CheckPage::whole_ways() const {
  std::vector<std::vector<Knot>> ways = ways_;
  for (std::size_t k = 0; k < ways.size(); ++k)
    if (has_last_[k]) ways[k].push_back(last_[k]);
  return ways;
}

/// Every moment at which a way bends and every witness, as many as a page holds.
std::vector<double> CheckPage::moments(const std::vector<std::vector<Knot>>& ways, bool& is_thinned) const {
  std::vector<double> times, witnesses;
  const bool jumps = !asked_.has_curves && asked_.between == geometry::Between::hold;
  for (const std::vector<Knot>& way : ways)
    for (const Knot& knot : way) {
      times.push_back(knot.time);
      if (jumps) times.push_back(std::nextafter(knot.time, -INFINITY));
    }
  for (const MotionEvent& e : overlaps_) witnesses.push_back(e.nearest_time);
  const auto sort = [](std::vector<double>& all) {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  sort(times);
  while (times.size() > 2 && (times.size() + witnesses.size()) * ways.size() > limits_.states) {
    is_thinned = true;
    const double last = times.back();
    keep_every_second(times);
    if (times.back() != last) times.push_back(last);
  }
  times.insert(times.end(), witnesses.begin(), witnesses.end());
  sort(times);
  return times;
}

/// The outline of what is no disc, and from when to when the agent is there.
nlohmann::ordered_json CheckPage::body_json(std::size_t agent, const std::vector<Knot>& way) const {
  nlohmann::ordered_json json{{"there", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < way.size(); ++k) {
    if (way[k].begins) json["there"].push_back(way[k].time);
    if (k + 1 == way.size() || way[k + 1].begins) json["there"].push_back(way[k].time);
  }
  if (is_plain_disc(bodies_[agent])) return json;
  json["outline"] = nlohmann::ordered_json::array();
  for (const geometry::RoundedPolygon& part : bodies_[agent]) {
    nlohmann::ordered_json ring = nlohmann::ordered_json::array();
    for (const Vec2 p : hull_outline(part)) {
      ring.push_back(p.x);
      ring.push_back(p.y);
    }
    json["outline"].push_back(std::move(ring));
  }
  return json;
}

datasets::RecordingFile CheckPage::about(const geometry::MotionCheck& check, bool is_thinned) const {
  datasets::RecordingFile about;
  about.info.scenario = about.scenario.name = std::filesystem::path(asked_.file.file).filename().string();
  about.scenario.description = asked_.bodies;
  about.info.method = "check";
  about.info.decisions = "none";
  about.info.provenance = datasets::make_provenance({}, 0);
  about.scenario.obstacles = asked_.obstacles;
  for (formation::SceneObstacle& o : about.scenario.obstacles) o.id = obstacle_name(o);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    formation::Robot robot;
    robot.id = asked_.file.agents[k];
    robot.radius = reach_of(bodies_[k]);
    robot.max_speed = asked_.survey.agents()[k].speed.value;
    about.scenario.robots.push_back(std::move(robot));
  }
  for (const MotionEvent& e : overlaps_) {
    formation::Collision c;
    c.robot = asked_.file.agents[e.body];
    c.kind = e.with_obstacle ? formation::CollisionKind::obstacle : formation::CollisionKind::robot;
    c.with = e.with_obstacle ? about.scenario.obstacles[e.other].id : asked_.file.agents[e.other];
    c.from = e.first.low;
    c.until = e.last.high;
    c.deepest_at = e.nearest_time;
    c.depth = asked_.has_depth(e) ? 0.0 - e.clearance.low : std::nan("");
    c.place = e.place;
    about.collisions.push_back(std::move(c));
  }
  about.outcome =
      fmt::format("{}, {}", geometry::counted(check.overlaps, "overlap"), geometry::counted(check.contacts, "contact"));
  std::vector<std::string>& warnings = about.recording.warnings;
  if (overlaps_left_out_ > 0)
    warnings.push_back(fmt::format("{} more overlaps are not in this page.", overlaps_left_out_));
  if (is_thinned)
    warnings.emplace_back(
        "The trajectories are long: the page has some of their bends, and draws straight lines between them.");
  return about;
}

std::string CheckPage::packed(const geometry::MotionCheck& check) const {
  const std::vector<std::vector<Knot>> ways = whole_ways();
  RunPacker packer(limits_);
  formation::Step step;
  step.robots.resize(ways.size());
  std::vector<std::size_t> next(ways.size(), 0);  // of each way, its first knot after the moment
  bool is_thinned = least_step_ > 0.0;
  for (const double time : moments(ways, is_thinned)) {
    step.time = time;
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const std::vector<Knot>& way = ways[k];
      while (next[k] < way.size() && way[next[k]].time <= time) ++next[k];
      const Knot& from = way[std::max<std::size_t>(next[k], 1) - 1];
      const bool is_on_way = next[k] > 0 && next[k] < way.size() && !way[next[k]].begins;
      const Knot& to = is_on_way ? way[next[k]] : from;
      const double span = to.time - from.time;
      // As a way ends, the velocity is the last one.
      if (is_on_way || time > from.time) step.robots[k].velocity = span > 0.0 ? (to.at - from.at) / span : Vec2{};
      const double share = span > 0.0 ? (time - from.time) / span : 0.0;
      step.robots[k].position = from.at + share * (to.at - from.at);
      if (!has_headings_) continue;
      const double heading = from.heading + share * std::remainder(to.heading - from.heading, 2.0 * geometry::kPi);
      step.robots[k].wheels.emplace();
      step.robots[k].wheels->heading = {std::cos(heading), std::sin(heading)};
    }
    packer.add_positions(step);
  }
  std::vector<nlohmann::ordered_json> bodies;
  for (std::size_t k = 0; k < ways.size(); ++k) bodies.push_back(body_json(k, ways[k]));
  return packer.finish(about(check, is_thinned), "", bodies);
}

std::string CheckPage::page(const geometry::MotionCheck& check) const {
  const std::string name = std::filesystem::path(asked_.file.file).filename().string();
  return explorer_page({{page_key(name), name, "", packed(check)}});
}

}  // namespace exactvo::tools
