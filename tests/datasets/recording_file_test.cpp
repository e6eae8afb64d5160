// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/recording_file.h"

#include <algorithm>
#include <limits>

#include "refusal.h"
#include "same_scenario.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;
using formation::RecordedConstraint;
using formation::RobotStep;
using geometry::Vec2;

geometry::ConvexShape shape_number(int k, SeededRandom& random) {
  switch (k % 4) {
    case 0:
      return geometry::Disc{random.in_box(9), random.uniform(0, 1)};
    case 1:
      return geometry::Segment{random.in_box(9), random.in_box(9)};
    case 2:
      return geometry::ConvexPolygon{{random.in_box(9), random.in_box(9), random.in_box(9)}};
    default:
      return geometry::Ellipse{random.in_box(9), random.uniform(0, 1), random.uniform(-1, 1), -0.0};
  }
}

RecordedConstraint constraint_number(int k, SeededRandom& random) {
  RecordedConstraint c;
  c.half_plane = {random.direction(), random.uniform(-1e-9, 1e9)};
  c.source = static_cast<formation::ConstraintSource>(k % 3);
  c.index = static_cast<std::size_t>(k);
  c.piece = static_cast<std::size_t>(k % 2);
  c.certified = k % 2 == 0;
  c.hard = k % 3 == 0;
  c.active = k % 5 == 0;
  c.shape = shape_number(k, random);
  c.position = random.in_box(1e6);
  c.radius = random.uniform(0, 1);
  c.tau = random.uniform(0, 3);
  c.shape_velocity = random.in_box(1);
  return c;
}

RobotStep robot_step(int k, SeededRandom& random) {
  RobotStep robot;
  robot.position = random.in_box(100);
  robot.velocity = {-0.0, 5e-324};
  robot.preferred = random.in_box(3);
  robot.chosen = k == 7 ? Vec2{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}
                        : random.in_box(3);
  robot.status = static_cast<lp::Status>(k % 3);
  robot.violation = k % 3 == 1 ? random.uniform(0, 1) : 0.0;
  robot.mode = static_cast<formation::Mode>(k % 5);
  robot.side = k % 3 - 1;
  robot.note = k % 4 == 0 ? "turned \"left\", because" : "";
  robot.uncertified = static_cast<std::size_t>(k % 2);
  for (int c = 0; c < k % 4; ++c) robot.constraints.push_back(constraint_number(k + c, random));
  return robot;
}

formation::BindingConstraint binding(SeededRandom& random) {
  formation::BindingConstraint b;
  b.constraint.source = formation::ConstraintSource::obstacle_edge;
  b.constraint.index = 7;
  b.constraint.piece = 3;
  b.normal = random.in_box(1);
  b.clearance = random.uniform(0, 1);
  b.radius_of_curvature = std::numeric_limits<double>::infinity();
  return b;
}

/// Every term another number.
formation::LyapunovRow lyapunov_row(double time, SeededRandom& random) {
  const auto any = [&random] { return random.uniform(-9, 9); };
  return {time,
          true,
          {any(), any(), any(), any()},
          {any(), any(), any(), any()},
          any(),
          {any(), any(), any()},
          {any(), any(), any()},
          any()};
}

std::vector<double> terms_of(const formation::LyapunovRow& r) {
  return {r.time,
          r.paper.kinetic,
          r.paper.consensus,
          r.paper.pinning,
          r.paper.integral,
          r.paper_rates.kinetic,
          r.paper_rates.consensus,
          r.paper_rates.pinning,
          r.paper_rates.integral,
          r.paper_rate,
          r.sound.kinetic,
          r.sound.consensus,
          r.sound.slots,
          r.sound_rates.consensus,
          r.sound_rates.tracking,
          r.sound_rates.intervention,
          r.rate_bound};
}

RecordingFile sample(bool with_formation) {
  SeededRandom random(exactvo::test::seed_of_run(3));
  RecordingFile file;
  file.info = {"sample", "ivo", std::nullopt, std::nullopt, make_provenance({"exactvo", "simulate"}, 5)};
  file.scenario.name = "sample";
  for (int i = 0; i < 3; ++i) {
    formation::Robot robot;
    robot.id = "R, \"" + std::to_string(i) + "\"";
    robot.position = {20.0 * i, 0.0};
    robot.goals = {{20.0 * i, 30.0}};
    file.scenario.robots.push_back(robot);
  }
  if (with_formation) {
    file.info.controller = "default";
    file.info.integrator = "exact";
    formation::FormationSpec spec;
    spec.topology = {{{0, 1, 1}, {1, 0, 1}, {1, 1, 0}}, {1, 1, 1}};
    spec.offsets = {{1, 1}, {-1, 1}, {1, -1}};
    spec.leader = {{{0, 0}, {25, 25}}, 4.0};
    file.scenario.formation = spec;
    file.recording.offsets = {random.in_box(2), random.in_box(2), random.in_box(2)};
    for (formation::Robot& robot : file.scenario.robots) robot.goals.clear();
  }
  file.enclosures = {{shape_number(0, random), shape_number(3, random)}, {}, {shape_number(2, random)}};
  file.recording.motion = with_formation ? formation::MotionLaw::exponential : formation::MotionLaw::straight;
  file.recording.time_step = 0.02;
  file.recording.tracking_gain = 37.5;
  file.recording.outcome = "all arrived";
  file.recording.warnings = {"a step of 0.5 s is beyond euler's limit", "\"quoted\""};
  file.recording.wall_time = 0.125;
  file.recording.all_half_planes = file.recording.relative_frame = with_formation;
  if (!with_formation) file.recording.later_outlooks = {{0.1, 2, 1, {shape_number(1, random)}}, {0.2, 0, 1, {}}};
  file.stuck = {{1, random.in_box(5), 3.5, 0.25, {binding(random)}, std::nullopt, "bound \"here\"", 12.5}};
  file.stuck.front().binding.front().pressing = true;
  if (with_formation) file.stuck.front().equilibrium = formation::Equilibrium{random.in_box(1), {1, 0}, 2.5, 1.5, true};
  for (int k = 0; k < 20; ++k) {
    formation::Step step;
    step.time = 0.02 * k;
    for (int i = 0; i < 3; ++i) step.robots.push_back(robot_step(k + i, random));
    if (with_formation) step.leader_position = random.in_box(9), step.leader_velocity = random.in_box(3);
    file.recording.steps.push_back(step);
    if (with_formation) file.lyapunov.push_back(lyapunov_row(step.time, random));
  }
  return file;
}

void expect_same_constraint(const RecordedConstraint& a, const RecordedConstraint& b) {
  EXPECT_TRUE(same_bits(a.half_plane.normal, b.half_plane.normal));
  EXPECT_TRUE(same_bits(a.half_plane.offset, b.half_plane.offset));
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.piece, b.piece);
  EXPECT_EQ(a.certified, b.certified);
  EXPECT_EQ(a.hard, b.hard);
  EXPECT_EQ(a.active, b.active);
  EXPECT_TRUE(same_bits(a.shape, b.shape));
  EXPECT_TRUE(same_bits(a.position, b.position));
  EXPECT_TRUE(same_bits(a.radius, b.radius));
  EXPECT_TRUE(same_bits(a.tau, b.tau));
  EXPECT_TRUE(same_bits(a.shape_velocity, b.shape_velocity));
}

void expect_same_step(const RobotStep& a, const RobotStep& b) {
  EXPECT_TRUE(same_bits(a.position, b.position));
  EXPECT_TRUE(same_bits(a.velocity, b.velocity));
  EXPECT_TRUE(same_bits(a.preferred, b.preferred));
  EXPECT_TRUE(same_bits(a.chosen, b.chosen));
  EXPECT_EQ(a.status, b.status);
  EXPECT_TRUE(same_bits(a.violation, b.violation));
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.side, b.side);
  EXPECT_EQ(a.note, b.note);
  EXPECT_EQ(a.uncertified, b.uncertified);
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t i = 0; i < a.constraints.size(); ++i) expect_same_constraint(a.constraints[i], b.constraints[i]);
}

void expect_same_reports(const formation::StuckReport& a, const formation::StuckReport& b) {
  EXPECT_EQ(a.robot, b.robot);
  EXPECT_EQ(a.text, b.text);
  EXPECT_TRUE(same_bits(a.position, b.position));
  EXPECT_TRUE(same_bits(a.rest_time, b.rest_time));
  ASSERT_EQ(a.binding.size(), b.binding.size());
  EXPECT_EQ(a.binding[0].pressing, b.binding[0].pressing);
  EXPECT_EQ(a.binding[0].constraint.source, b.binding[0].constraint.source);
  EXPECT_EQ(a.binding[0].constraint.piece, b.binding[0].constraint.piece);
  EXPECT_TRUE(same_bits(a.binding[0].radius_of_curvature, b.binding[0].radius_of_curvature));
  ASSERT_EQ(a.equilibrium.has_value(), b.equilibrium.has_value());
  if (a.equilibrium) {
    EXPECT_TRUE(same_bits(a.equilibrium->distance, b.equilibrium->distance));
    EXPECT_EQ(a.equilibrium->stable, b.equilibrium->stable);
  }
}

void expect_same_extras(const RecordingFile& a, const RecordingFile& b) {
  EXPECT_EQ(a.recording.all_half_planes, b.recording.all_half_planes);
  EXPECT_EQ(a.recording.relative_frame, b.recording.relative_frame);
  ASSERT_EQ(a.recording.later_outlooks.size(), b.recording.later_outlooks.size());
  for (std::size_t i = 0; i < a.recording.later_outlooks.size(); ++i) {
    EXPECT_EQ(a.recording.later_outlooks[i].robot, b.recording.later_outlooks[i].robot);
    EXPECT_TRUE(same_bits(a.recording.later_outlooks[i].enclosures, b.recording.later_outlooks[i].enclosures));
  }
  ASSERT_EQ(a.stuck.size(), b.stuck.size());
  for (std::size_t i = 0; i < a.stuck.size(); ++i) expect_same_reports(a.stuck[i], b.stuck[i]);
  ASSERT_EQ(a.lyapunov.size(), b.lyapunov.size());
  for (std::size_t k = 0; k < a.lyapunov.size(); ++k)
    EXPECT_TRUE(same_bits(terms_of(a.lyapunov[k]), terms_of(b.lyapunov[k]))) << k;
}

using RecordingFileTest = TemporaryFolder;

TEST_F(RecordingFileTest, Property1_EveryBitComesBack) {
  for (const bool with_formation : {false, true}) {
    const RecordingFile a = sample(with_formation);
    write_recording(folder_ / "r.jsonl", a);
    const RecordingFile b = read_recording(folder_ / "r.jsonl");
    expect_same(a.scenario, b.scenario);
    EXPECT_EQ(a.info.method, b.info.method);
    EXPECT_EQ(a.info.controller, b.info.controller);
    EXPECT_EQ(a.info.integrator, b.info.integrator);
    EXPECT_EQ(to_json(a.info.provenance), to_json(b.info.provenance));
    ASSERT_EQ(a.enclosures.size(), b.enclosures.size());
    for (std::size_t i = 0; i < a.enclosures.size(); ++i) EXPECT_TRUE(same_bits(a.enclosures[i], b.enclosures[i]));
    EXPECT_EQ(a.recording.motion, b.recording.motion);
    EXPECT_EQ(a.recording.outcome, b.recording.outcome);
    EXPECT_EQ(a.recording.warnings, b.recording.warnings);
    EXPECT_EQ(a.recording.diverged, b.recording.diverged);
    EXPECT_EQ(a.recording.time_step, b.recording.time_step);
    EXPECT_EQ(a.recording.tracking_gain, b.recording.tracking_gain);
    EXPECT_TRUE(same_bits(a.recording.offsets, b.recording.offsets));
    ASSERT_EQ(a.recording.steps.size(), b.recording.steps.size());
    for (std::size_t k = 0; k < a.recording.steps.size(); ++k) {
      EXPECT_TRUE(same_bits(a.recording.steps[k].time, b.recording.steps[k].time));
      EXPECT_TRUE(same_bits(a.recording.steps[k].leader_position, b.recording.steps[k].leader_position));
      EXPECT_TRUE(same_bits(a.recording.steps[k].leader_velocity, b.recording.steps[k].leader_velocity));
      for (std::size_t i = 0; i < 3; ++i)
        expect_same_step(a.recording.steps[k].robots[i], b.recording.steps[k].robots[i]);
    }
    expect_same_extras(a, b);
    write_recording(folder_ / "again.jsonl", b);
    EXPECT_EQ(content_of(folder_ / "again.jsonl"), content_of(folder_ / "r.jsonl"));
  }
}

TEST_F(RecordingFileTest, AHeaderThenARowAStep) {
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string text = content_of(folder_ / "r.jsonl");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 21);
  EXPECT_EQ(text.substr(0, 28), "{\"kind\":\"exactvo-recording\",");
}

TEST_F(RecordingFileTest, WhatIsWrongIsPlacedByLineAndPointer) {
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string good = content_of(folder_ / "r.jsonl");
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string bad = good;
    const std::size_t at = bad.find(from, bad.find('\n'));
    return refusal_of([&] { read_recording(put("bad.jsonl", bad.replace(at, from.size(), to))); });
  };
  expect_refusal(refused("\"status\":\"optimal\"", "\"status\":\"fine\""), DataCode::not_an_option,
                 "line 2, /robots/0/status");
  expect_refusal(refused("\"position\":[", "\"position\":[1,"), DataCode::wrong_count, "line 2, /robots/0/position");
  expect_refusal(refused("\"chosen\"", "\"choosen\""), DataCode::key_missing, "line 2, /robots/0");
  expect_refusal(refused("{\"time\":0,", "{\"time\":oops,"), DataCode::json_syntax, "line 2, column 9");
}

TEST_F(RecordingFileTest, ARecordingCutShortIsNotTakenForAWholeOne) {
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string text = content_of(folder_ / "r.jsonl");
  const std::size_t last_row = text.rfind('\n', text.size() - 2) + 1;
  const DataError error = refusal_of([&] { read_recording(put("cut.jsonl", text.substr(0, last_row))); });
  expect_refusal(error, DataCode::wrong_count, "line 1, /rows");
}

TEST_F(RecordingFileTest, TheTrajectoryHasARowARobotAndStep) {
  write_trajectory_csv(folder_ / "t.csv", sample(false));
  const std::string text = content_of(folder_ / "t.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 20 * 3);
  EXPECT_EQ(text.find("leader"), std::string::npos);
  EXPECT_NE(text.find("\n0,\"R, \"\"0\"\"\","), std::string::npos);
  write_trajectory_csv(folder_ / "f.csv", sample(true));
  const std::string rows = content_of(folder_ / "f.csv");
  EXPECT_NE(rows.find(",leader_x_m,"), std::string::npos);
}

}  // namespace
}  // namespace exactvo::datasets::test
