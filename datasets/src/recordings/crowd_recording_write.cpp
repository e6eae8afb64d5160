// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>
#include <ostream>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "exactvo/geometry/require.h"
#include "recordings/crowd_recording_format.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {

CrowdRecorder::CrowdRecorder(const std::filesystem::path& path, const formation::Scenario& scenario,
                             std::uint32_t every, Unfinished unfinished)
    : file_(path, MissingFolder::is_made, unfinished) {
  EXACTVO_REQUIRE(every > 0, "every 0");
  robots_ = scenario.robots.size();
  head_.scenario = scenario.name;
  head_.every = every;
  for (const formation::SceneObstacle& o : scenario.obstacles) {
    if (o.disc) {  // a body
      disc_names_.push_back(o.id);
      continue;
    }
    const std::vector<geometry::Segment> edges = geometry::edges_of(o.shape);
    head_.edges.insert(head_.edges.end(), edges.begin(), edges.end());
    head_.obstacles.push_back({o.id, static_cast<std::uint32_t>(edges.size())});
  }
  head_.tracking = tracking_error_of(scenario);
  for (const formation::MovingObstacle& o : scenario.moving_obstacles) moving_names_.push_back(o.id);
  const bool has_wheels = std::any_of(scenario.robots.begin(), scenario.robots.end(),
                                      [](const formation::Robot& robot) { return robot.drive.has_value(); });
  for (std::size_t i = 0; has_wheels && i < robots_; ++i) {
    const formation::Robot& robot = scenario.robots[i];
    head_.half_headings.push_back(formation::half_heading_of(robot.drive ? robot.drive->heading : 0.0));
  }
  std::string_view before;
  std::unordered_set<std::string_view> seen;
  for (const formation::Robot& robot : scenario.robots) {
    ids_differ_ = seen.insert(robot.id).second && ids_differ_;
    append_id(ids_, robot.id, before);
    before = robot.id;
    body_radii_.push_back(robot.drive ? robot.drive->body_radius : body_radius_of(robot));
  }
}

void CrowdRecorder::put(const std::string& bytes) {
  file_.write(bytes);
  bytes_ += bytes.size();
}

/// Bodies that move, and discs at rest, stand in the crowd in the order of the scenario, if they are its bodies.
void CrowdRecorder::name_bodies() {
  const auto moving = static_cast<std::size_t>(
      std::count_if(head_.bodies.begin(), head_.bodies.end(), [](const CrowdBodyRecord& body) { return body.moves; }));
  if (moving != moving_names_.size() || head_.bodies.size() - moving != disc_names_.size()) return;
  auto next_moving = moving_names_.begin(), next_disc = disc_names_.begin();
  for (CrowdBodyRecord& body : head_.bodies) body.id = body.moves ? *next_moving++ : *next_disc++;
}

/// Takes the head and what follows from it.
std::string CrowdRecorder::head_of(const formation::Crowd& crowd) {
  head_.time_step = crowd.options().time_step;
  head_.position_step = crowd.options().position_step;
  const std::size_t robots = crowd.id_end();
  EXACTVO_REQUIRE((head_.half_headings.empty() && head_.tracking == 0.0) || robots == robots_,
                  "a crowd of other robots, on wheels or with a tracking error");
  std::size_t kinds = 0;
  for (std::size_t i = 0; i < robots; ++i) {
    head_.kind_of.push_back(crowd.kind_of(static_cast<formation::RobotId>(i)));
    kinds = std::max<std::size_t>(kinds, head_.kind_of.back() + 1U);
  }
  for (std::size_t k = 0; k < kinds; ++k) {
    const formation::CrowdKind& kind = crowd.kind(static_cast<formation::KindId>(k));
    head_.kinds.push_back({kind.radius, kind.max_speed, kind.wheels});
  }
  for (std::size_t i = 0; i < std::min(robots, robots_); ++i) {
    double& body = head_.kinds[head_.kind_of[i]].body_radius;
    body = std::max(body, body_radii_[i]);
  }
  for (const formation::CrowdBodyState& body : crowd.bodies()) {
    head_.bodies.push_back({body.shape, body.moves});
    body_ids_.push_back(body.id);
    body_start_.push_back(body.displacement);
  }
  name_bodies();
  row_.body_x.assign(head_.bodies.size(), 0);
  last_.body_x = last_.body_y = row_.body_y = row_.body_x;
  row_.x.assign(robots, 0);
  row_.y.assign(robots, 0);
  last_.x = last_.y = row_.x;
  row_.kept.assign(robots, 1);
  const bool has_ids = robots == robots_ && ids_differ_;  // of another number the crowd is not the scenario's
  const std::string head = to_bytes(head_, has_ids ? ids_ : std::string());
  std::string out(kCrowdMarks[version_of(head_, has_ids) - 1]);
  append(out, static_cast<std::uint64_t>(head.size()));
  head_sum_ = sum_ = checksum(head);
  append(out, sum_);
  return out + head;
}

// What a row is the difference from, and what will be in the next one. The positions of that one come with its step.

void CrowdRecorder::save(std::ostream& to) {
  file_.sync();
  std::string out;
  for (const std::uint64_t number : {head_sum_, bytes_, rows_, sum_, std::uint64_t{row_.step}, std::uint64_t{is_due_}})
    append(out, number);
  for (const geometry::Vec2 start : body_start_) append(out, start);
  for (const auto* all : {&last_.x, &last_.y, &row_.x, &row_.y})
    for (const std::int32_t number : *all) append(out, number);
  for (const auto* all : {&last_.body_x, &last_.body_y, &row_.body_x, &row_.body_y})
    for (const std::int64_t number : *all) append(out, number);
  for (const std::uint8_t kept : row_.kept) append(out, kept);
  to.write(out.data(), static_cast<std::streamsize>(out.size()));
}

void CrowdRecorder::restore(const formation::RunState& now, std::istream& from) {
  head_of(*now.crowd);
  const std::string bytes{std::istreambuf_iterator<char>(from), std::istreambuf_iterator<char>()};
  const std::string name = "a snapshot";
  CrowdBytes in(bytes, name, 0);
  in.require(in.get<std::uint64_t>() == head_sum_, "a recording of something else");
  bytes_ = in.get<std::uint64_t>();
  rows_ = in.get<std::uint64_t>();
  sum_ = in.get<std::uint64_t>();
  row_.step = static_cast<std::uint32_t>(in.get<std::uint64_t>());
  is_due_ = in.get<std::uint64_t>() != 0;
  for (geometry::Vec2& start : body_start_) start = in.get<geometry::Vec2>();
  for (auto* all : {&last_.x, &last_.y, &row_.x, &row_.y})
    for (std::int32_t& number : *all) number = in.get<std::int32_t>();
  for (auto* all : {&last_.body_x, &last_.body_y, &row_.body_x, &row_.body_y})
    for (std::int64_t& number : *all) number = in.get<std::int64_t>();
  for (std::uint8_t& kept : row_.kept) kept = in.get<std::uint8_t>();
  in.require_end();
  file_.continue_behind(bytes_);
}

void CrowdRecorder::take(const formation::RunState& now) {
  for (std::size_t i = 0; i < now.positions.size(); ++i) {
    row_.x[i] = static_cast<std::int32_t>(now.positions[i].x / head_.position_step);
    row_.y[i] = static_cast<std::int32_t>(now.positions[i].y / head_.position_step);
  }
  for (std::size_t k = 0; k < body_ids_.size(); ++k) {
    const geometry::Vec2 at = now.crowd->body_displacement(body_ids_[k]) - body_start_[k];
    row_.body_x[k] = static_cast<std::int64_t>(at.x / head_.position_step);
    row_.body_y[k] = static_cast<std::int64_t>(at.y / head_.position_step);
  }
}

void CrowdRecorder::add_state(const formation::RunState& now) {
  EXACTVO_REQUIRE(now.crowd, "the state of no crowd");
  if (now.steps == 0) {
    file_.continue_behind(0);
    put(head_of(*now.crowd));
  } else {
    now.crowd->kept(kept_);
    for (std::size_t i = 0; i < kept_.size(); ++i) row_.kept[i] &= kept_[i];
  }
  row_.step = static_cast<std::uint32_t>(now.steps);
  take(now);
  is_due_ = true;
  if (now.steps % head_.every == 0) write_row();
}

void CrowdRecorder::write_row() {
  std::string out;
  append(out, row_.step);
  for (auto [now, last] : {std::pair(&row_.x, &last_.x), std::pair(&row_.y, &last_.y)}) {
    for (std::size_t i = 0; i < now->size(); ++i)
      append_difference(out, std::int64_t{(*now)[i]} - std::int64_t{(*last)[i]});
    *last = *now;
  }
  for (auto [now, last] : {std::pair(&row_.body_x, &last_.body_x), std::pair(&row_.body_y, &last_.body_y)}) {
    for (std::size_t k = 0; k < now->size(); ++k) append_difference(out, (*now)[k] - (*last)[k]);
    *last = *now;
  }
  for (std::size_t first = 0; first < row_.kept.size(); first += 8) {
    unsigned bits = 0;
    for (std::size_t k = first; k < std::min(first + 8, row_.kept.size()); ++k)
      bits |= unsigned{row_.kept[k]} << (k - first);
    out.push_back(static_cast<char>(bits));
  }
  std::string before(1, kCrowdRow);
  append(before, static_cast<std::uint64_t>(out.size()));
  append(before, checksum(out));
  sum_ = chained(sum_, checksum(out));
  ++rows_;
  put(before);
  put(out);
  row_.kept.assign(row_.kept.size(), 1);
  is_due_ = false;
}

void CrowdRecorder::finish() {
  if (is_due_) write_row();
  std::string seal;
  append(seal, rows_);
  append(seal, sum_);
  std::string end(1, kCrowdEnd);
  append(end, static_cast<std::uint64_t>(seal.size()));
  append(end, checksum(seal));
  put(end + seal);
  file_.commit();
}

}  // namespace exactvo::datasets
