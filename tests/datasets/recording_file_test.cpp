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
using formation::DecisionConstraint;
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

/// Bodies of every kind and shape: three robots, a moving obstacle and what stands still.
std::vector<vo::Body> bodies(SeededRandom& random) {
  std::vector<vo::Body> all;
  for (int k = 0; k < 5; ++k)
    all.push_back({k % 2 ? vo::BodyKind::obstacle_edge : vo::BodyKind::enclosure, shape_number(k, random), {}, {0}});
  for (std::size_t i = 0; i < 3; ++i) all.push_back({vo::BodyKind::robot, {}, {}, {i}});
  all.push_back({vo::BodyKind::moving_obstacle, {}, {}, {0}});
  return all;
}

DecisionConstraint constraint_number(int k, SeededRandom& random) {
  DecisionConstraint c;
  c.half_plane = {random.direction(), random.uniform(-1e-9, 1e9)};
  c.body = static_cast<std::size_t>(k % 9);
  c.index = static_cast<std::size_t>(k);
  c.piece = static_cast<std::size_t>(k % 2);
  c.certified = k % 2 == 0;
  c.hard = k % 3 == 0;
  c.active = k % 5 == 0;
  c.multiplier = k % 5 == 0 ? random.uniform(0, 3) : 0.0;
  c.clearance = random.uniform(-1, 9);
  c.time_horizon = random.uniform(0, 3);
  return c;
}

RobotStep robot_step(int k, SeededRandom& random) {
  RobotStep robot;
  robot.position = random.in_box(100);
  robot.velocity = {-0.0, 5e-324};
  robot.anchor = k % 2 ? random.in_box(100) : robot.position;
  robot.anchor_velocity = k % 3 ? Vec2{0.0, 5e-324} : robot.velocity;
  robot.preferred = random.in_box(3);
  robot.chosen = k == 7 ? Vec2{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}
                        : random.in_box(3);
  robot.status = static_cast<lp::Status>(k % 3);
  if (k % 6 == 0) robot.bound = {{lp::kDisc, random.uniform(0, 2)}};
  if (k % 6 == 1) robot.bound = {{lp::kBoxSides[0], 0.25}, {lp::kBoxSides[3], random.uniform(0, 2)}};
  robot.violation = k % 3 == 1 ? random.uniform(0, 1) : 0.0;
  robot.exact_multipliers = k % 5 == 2;
  robot.mode = static_cast<formation::Mode>(k % 5);
  robot.side = k % 3 - 1;
  robot.note = k % 4 == 0 ? "turned \"left\",\tbecause\nof \x01 \\" : "";
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
    spec.leader = {{{{0, 0}, {25, 25}}, 4.0}};
    file.scenario.formation = spec;
    file.recording.offsets = {random.in_box(2), random.in_box(2), random.in_box(2)};
    file.recording.controller_options.emplace();
    file.recording.controller_options->horizon_clamp = file.recording.controller_options->margins = false;
    file.recording.controller_options->acceleration_bound = 0.1;
    for (formation::Robot& robot : file.scenario.robots) robot.goals.clear();
  }
  file.scenario.obstacles = {{"wall", geometry::Polyline{{{-5, -5}, {-5, -9}}}}};
  file.scenario.moving_obstacles = {{"cart", geometry::Polygon{{{90, 90}, {91, 90}, {90, 91}}, {}}, {{{0, 0}}, 0.0}}};
  file.recording.bodies = bodies(random);
  file.recording.goal_bodies = {{0.0, 0, 0, {0, 3}}, {0.0, 1, 0, {}}, {0.0, 2, 0, {2}}};
  file.recording.motion = with_formation ? formation::MotionLaw::exponential : formation::MotionLaw::straight;
  file.recording.time_step = 0.02;
  file.recording.tracking_gain = 37.5;
  file.recording.outcome = "all arrived";
  file.recording.warnings = {"a step of 0.5 s is beyond euler's limit", "\"quoted\""};
  file.recording.wall_time = 0.125;
  file.recording.all_half_planes = file.recording.relative_frame = with_formation;
  if (!with_formation) {
    file.recording.goal_bodies.push_back({0.1, 2, 1, {4}});
    file.recording.goal_bodies.push_back({0.2, 0, 1, {}});
  }
  if (!with_formation)
    file.recording.plans = {{0, 0, {0, 2}, {random.in_box(9), random.in_box(9)}, {{2, random.in_box(9)}}},
                            {7, 3, {1}, {random.in_box(9)}, {}}};
  file.stuck = {{1, random.in_box(5), 3.5, 0.25, {binding(random)}, std::nullopt, "bound \"here\"", 12.5}};
  file.stuck.front().binding.front().pressing = true;
  if (with_formation) file.stuck.front().equilibrium = formation::Equilibrium{random.in_box(1), {1, 0}, 2.5, 1.5, true};
  for (int k = 0; k < 20; ++k) {
    formation::Step step;
    step.time = 0.02 * k;
    for (int i = 0; i < 3; ++i) step.robots.push_back(robot_step(k + i, random));
    if (with_formation) step.leader_position = random.in_box(9), step.leader_velocity = random.in_box(3);
    step.moving = {{random.in_box(9), random.in_box(1)}};
    for (std::size_t i = 0; i < 3; ++i)
      for (DecisionConstraint& c : step.robots[i].constraints) c.source = file.recording.bodies[c.body].kind;
    file.recording.steps.push_back(step);
    if (with_formation) file.lyapunov.push_back(lyapunov_row(step.time, random));
  }
  return file;
}

void expect_same_constraint(const DecisionConstraint& a, const DecisionConstraint& b) {
  EXPECT_TRUE(same_bits(a.half_plane.normal, b.half_plane.normal));
  EXPECT_TRUE(same_bits(a.half_plane.offset, b.half_plane.offset));
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.piece, b.piece);
  EXPECT_EQ(a.certified, b.certified);
  EXPECT_EQ(a.hard, b.hard);
  EXPECT_EQ(a.active, b.active);
  EXPECT_TRUE(same_bits(a.time_horizon, b.time_horizon));
  EXPECT_EQ(a.body, b.body);
  EXPECT_TRUE(same_bits(a.clearance, b.clearance));
  EXPECT_TRUE(same_bits(a.multiplier, b.multiplier));
}

void expect_same_step(const RobotStep& a, const RobotStep& b) {
  EXPECT_TRUE(same_bits(a.position, b.position));
  EXPECT_TRUE(same_bits(a.velocity, b.velocity));
  EXPECT_TRUE(same_bits(a.anchor, b.anchor));
  EXPECT_TRUE(same_bits(a.anchor_velocity, b.anchor_velocity));
  EXPECT_TRUE(same_bits(a.preferred, b.preferred));
  EXPECT_TRUE(same_bits(a.chosen, b.chosen));
  EXPECT_EQ(a.status, b.status);
  EXPECT_TRUE(same_bits(a.violation, b.violation));
  ASSERT_EQ(a.bound.size(), b.bound.size());
  for (std::size_t i = 0; i < a.bound.size(); ++i) {
    EXPECT_EQ(a.bound[i].binding, b.bound[i].binding);
    EXPECT_TRUE(same_bits(a.bound[i].multiplier, b.bound[i].multiplier));
  }
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
  ASSERT_EQ(a.recording.goal_bodies.size(), b.recording.goal_bodies.size());
  for (std::size_t i = 0; i < a.recording.goal_bodies.size(); ++i) {
    EXPECT_EQ(a.recording.goal_bodies[i].robot, b.recording.goal_bodies[i].robot);
    EXPECT_EQ(a.recording.goal_bodies[i].goal, b.recording.goal_bodies[i].goal);
    EXPECT_TRUE(same_bits(a.recording.goal_bodies[i].time, b.recording.goal_bodies[i].time));
    EXPECT_EQ(a.recording.goal_bodies[i].bodies, b.recording.goal_bodies[i].bodies);
  }
  ASSERT_EQ(a.recording.plans.size(), b.recording.plans.size());
  for (std::size_t i = 0; i < a.recording.plans.size(); ++i) {
    const formation::JointPlan &p = a.recording.plans[i], &q = b.recording.plans[i];
    EXPECT_EQ(p.row, q.row);
    EXPECT_EQ(p.from_row, q.from_row);
    EXPECT_EQ(p.robots, q.robots);
    EXPECT_TRUE(same_bits(p.starts, q.starts));
    ASSERT_EQ(p.moves.size(), q.moves.size());
    for (std::size_t k = 0; k < p.moves.size(); ++k) {
      EXPECT_EQ(p.moves[k].robot, q.moves[k].robot);
      EXPECT_TRUE(same_bits(p.moves[k].to, q.moves[k].to));
    }
  }
  ASSERT_EQ(a.stuck.size(), b.stuck.size());
  for (std::size_t i = 0; i < a.stuck.size(); ++i) expect_same_reports(a.stuck[i], b.stuck[i]);
  ASSERT_EQ(a.lyapunov.size(), b.lyapunov.size());
  for (std::size_t k = 0; k < a.lyapunov.size(); ++k)
    EXPECT_TRUE(same_bits(terms_of(a.lyapunov[k]), terms_of(b.lyapunov[k]))) << k;
}

/// Half-planes keep clear of the same as before: a file has a body's shape once, and places in its rows.
void expect_same_bodies(const RecordingFile& a, const RecordingFile& b) {
  std::size_t moving = 0, judged = 0;
  for (std::size_t k = 0; k < a.recording.steps.size(); ++k)
    for (std::size_t i = 0; i < a.recording.steps[k].robots.size(); ++i)
      for (std::size_t n = 0; n < a.recording.steps[k].robots[i].constraints.size(); ++n) {
        const auto seen_in = [&](const RecordingFile& file) {
          const formation::Step& row = file.recording.steps[k];
          return seen_body(file.scenario, file.recording.bodies, row, i, row.robots[i].constraints[n]);
        };
        const formation::SeenBody before = seen_in(a), after = seen_in(b);
        EXPECT_TRUE(same_bits(before.shape, after.shape));
        EXPECT_TRUE(same_bits(before.position, after.position));
        EXPECT_TRUE(same_bits(before.radius, after.radius));
        EXPECT_TRUE(same_bits(before.velocity, after.velocity));
        moving += !(after.velocity == Vec2{});
        ++judged;
      }
  EXPECT_GT(moving, 10u);
  EXPECT_GT(judged, moving);
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
    expect_same_bodies(a, b);
    expect_same_extras(a, b);
    write_recording(folder_ / "again.jsonl", b);
    EXPECT_EQ(content_of(folder_ / "again.jsonl"), content_of(folder_ / "r.jsonl"));
  }
}

TEST_F(RecordingFileTest, RowsThatAreTakenOneByOneAreThoseOfTheWhole) {
  for (const bool with_formation : {false, true}) {
    write_recording(folder_ / "r.jsonl", sample(with_formation));
    const RecordingFile whole = read_recording(folder_ / "r.jsonl");
    RecordingFile taken;
    const RecordingFile rest = read_recording(folder_ / "r.jsonl", [&](const RecordingFile& so_far, formation::Step row,
                                                                       const formation::LyapunovRow* lyapunov) {
      EXPECT_TRUE(so_far.recording.steps.empty() && so_far.lyapunov.empty()) << "none is kept";
      EXPECT_EQ(so_far.scenario.robots.size(), 3u);
      EXPECT_LT(taken.recording.steps.size(), whole.recording.steps.size());
      taken.recording.steps.push_back(std::move(row));
      if (lyapunov) taken.lyapunov.push_back(*lyapunov);
    });
    EXPECT_TRUE(rest.recording.steps.empty() && rest.lyapunov.empty());
    RecordingFile again = rest;
    again.recording.steps = taken.recording.steps;
    again.lyapunov = taken.lyapunov;
    write_recording(folder_ / "again.jsonl", again);
    EXPECT_EQ(content_of(folder_ / "again.jsonl"), content_of(folder_ / "r.jsonl"));
  }
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST_F(RecordingFileTest, AHeaderThenBodiesOnceAndARowAStepThenTheEnd) {
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string text = content_of(folder_ / "r.jsonl");
  EXPECT_EQ(text.substr(0, 58), "{\"header\":{\"kind\":\"exactvo-recording\",\"format_version\":2,\"");
  EXPECT_EQ(count_of(text, "\n{\"row\":"), 20u);
  EXPECT_EQ(count_of(text, "\n{\"goal_bodies\":"), 5u);
  EXPECT_EQ(count_of(text, "\n{\"plan\":"), 2u);
  EXPECT_LT(text.find("{\"row\":{\"time\":0.12,"), text.find("{\"plan\":{\"row\":7,"));
  EXPECT_LT(text.find("{\"plan\":{\"row\":7,"), text.find("{\"row\":{\"time\":0.14"));
  EXPECT_EQ(count_of(text, "\n{\"body\":"), 9u) << "each once, though many rows name it";
  EXPECT_EQ(text.compare(text.rfind('\n', text.size() - 2) + 1, 8, "{\"end\":{"), 0);
  // A body stands before the first line that names it.
  EXPECT_LT(text.find("{\"body\":{\"number\":7,"), text.find("{\"body\":7,"));
}

TEST_F(RecordingFileTest, ARunThatIsWrittenWhileItIsMadeGivesTheFileWrittenAtOnce) {
  const RecordingFile whole = sample(true);
  write_recording(folder_ / "at_once.jsonl", whole);
  RecordingFile about = whole;  // before the run nothing is known of how it goes
  about.recording.steps.clear();
  about.recording.outcome.clear();
  about.stuck.clear();
  RecordingWriter writer(folder_ / "as_made.jsonl", about);
  for (const formation::GoalBodies& of_goal : whole.recording.goal_bodies) writer.add(of_goal, whole.recording.bodies);
  for (std::size_t k = 0; k < whole.recording.steps.size(); ++k)
    writer.add(whole.recording.steps[k], whole.recording.bodies, &whole.lyapunov[k]);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "as_made.jsonl")) << "whole or not at all";
  writer.finish(whole);
  EXPECT_EQ(content_of(folder_ / "as_made.jsonl"), content_of(folder_ / "at_once.jsonl"));
}

TEST_F(RecordingFileTest, LyapunovFunctionsAreATable) {
  formation::LyapunovRow row;
  row.time = 0.05;
  row.paper = {1e5, 1e15, 1e16, -0.0};
  row.paper_rates = {1e-4, -9.9e-5, 0.625, 1.25e20};
  row.sound.slots = 123456789.125;
  LyapunovWriter writer(folder_ / "lyapunov.csv");
  for (const bool has_rates : {true, false}) {
    row.has_rates = has_rates;
    writer.add(row);
  }
  writer.finish();
  const std::string text = content_of(folder_ / "lyapunov.csv");
  const std::string head = text.substr(0, text.find('\n'));
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), 16);
  EXPECT_EQ(text.substr(head.size()),
            "\n0.05,1e+05,1e+15,1e+16,-0.0,1e-04,-9.9e-05,0.625,1.25e+20,0,0,0,123456789.125,0,0,0,0\n"
            "0.05,1e+05,1e+15,1e+16,-0.0,,,,,,0,0,123456789.125,,,,\n");
}

TEST_F(RecordingFileTest, ErrorsNameLineAndPointer) {
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string good = content_of(folder_ / "r.jsonl");
  const std::size_t first_row = good.find("\n{\"row\":") + 1;
  const std::string line = "line " + std::to_string(1 + std::count(good.begin(), good.begin() + first_row, '\n'));
  const auto refused = [&](const std::string& from, const std::string& to, std::size_t after) {
    std::string bad = good;
    const std::size_t at = bad.find(from, after);
    return refusal_of([&] { read_recording(put("bad.jsonl", bad.replace(at, from.size(), to))); });
  };
  expect_refusal(refused("\"status\":\"optimal\"", "\"status\":\"fine\"", first_row), DataCode::not_an_option,
                 line + ", /row/robots/0/status");
  expect_refusal(refused("\"position\":[", "\"position\":[1,", first_row), DataCode::wrong_count,
                 line + ", /row/robots/0/position");
  expect_refusal(refused("\"chosen\"", "\"choosen\"", first_row), DataCode::key_missing, line + ", /row/robots/0");
  expect_refusal(refused("{\"time\":0,", "{\"time\":oops,", first_row), DataCode::json_syntax, line + ", column 16");
  expect_refusal(refused("\"bodies\":[0,3]", "\"bodies\":[0,8]", 0), DataCode::out_of_range,
                 "line 4, /goal_bodies/bodies/1");
  expect_refusal(refused("\"owners\":[0]", "\"owners\":[7]", 0), DataCode::out_of_range, "line 2, /body/owners/0");
  expect_refusal(refused("\"rows\":20", "\"rows\":21", first_row), DataCode::wrong_count,
                 "line " + std::to_string(std::count(good.begin(), good.end(), '\n')) + ", /end/rows");
  const auto pointer_of_plan = [&](const std::string& from, const std::string& to) {
    const DataError error = refused(from, to, good.find("{\"plan\":"));
    EXPECT_EQ(error.code(), DataCode::out_of_range) << error.what();
    return error.place().substr(error.place().find(", ") + 2);
  };
  EXPECT_EQ(pointer_of_plan("\"row\":0", "\"row\":1"), "/plan/row");
  EXPECT_EQ(pointer_of_plan("\"from_row\":0", "\"from_row\":1"), "/plan/from_row");
  EXPECT_EQ(pointer_of_plan("\"robot\":2", "\"robot\":3"), "/plan/robots/1/robot");
  EXPECT_EQ(pointer_of_plan("\"robot\":2", "\"robot\":0"), "/plan/robots/1/robot");
  EXPECT_EQ(pointer_of_plan("\"moves\":[{\"robot\":2", "\"moves\":[{\"robot\":1"), "/plan/moves/0/robot");
  expect_refusal(refused("\"number\":3", "\"number\":300000000", 0), DataCode::out_of_range, "line 3, /body/number");
}

TEST_F(RecordingFileTest, KeysThatNoRecordingHasAreRefusedWhereverTheyStand) {
  write_recording(folder_ / "r.jsonl", sample(true));
  const std::string of_formation = content_of(folder_ / "r.jsonl");
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string with_plan = content_of(folder_ / "r.jsonl");
  // Beside what stands there already.
  const std::pair<const char*, const char*> places[] = {
      {"{\"header\":", "/new"},
      {"\"header\":{", "/header/new"},
      {"\"controller_options\":{", "/header/controller_options/new"},
      {"{\"body\":", "/new"},
      {"\"body\":{", "/body/new"},
      {"\"shape\":{", "/body/shape/new"},
      {"\"goal_bodies\":{", "/goal_bodies/new"},
      {"\"plan\":{", "/plan/new"},
      {"\"plan\":{\"row\":0,\"from_row\":0,\"robots\":[{", "/plan/robots/0/new"},
      {"\"moves\":[{", "/plan/moves/0/new"},
      {"\"row\":{", "/row/new"},
      {"\"leader\":{", "/row/leader/new"},
      {"\"robots\":[{\"position\"", "/row/robots/0/new"},
      {"\"constraints\":[{", "/row/robots/1/constraints/0/new"},
      {"\"lyapunov\":{", "/row/lyapunov/new"},
      {"\"sound_rates\":{", "/row/lyapunov/sound_rates/new"},
      {"\"end\":{", "/end/new"}};
  for (const auto& [beside, pointer] : places) {
    const bool is_of_plan = std::string(pointer).find("/plan") == 0;
    std::string bad = is_of_plan ? with_plan : of_formation;
    const bool is_of_row = std::string(pointer).find("/row/") == 0;  // the header's scenario has a leader too
    const std::size_t at = bad.find(beside, is_of_row ? bad.find("{\"row\":") : 0);
    ASSERT_NE(at, std::string::npos) << beside;
    bad.insert(bad.find('{', at + std::string(beside).find_last_of('{')) + 1, "\"new\":1,");
    const DataError error = refusal_of([&] { read_recording(put("bad.jsonl", bad)); });
    EXPECT_EQ(error.code(), DataCode::key_unknown) << pointer << ": " << error.what();
    EXPECT_EQ(error.place().substr(error.place().find(", ") + 2), pointer) << error.what();
    EXPECT_EQ(error.found(), "an unknown key \"new\"") << pointer;
  }
}

TEST_F(RecordingFileTest, ARecordingOfFormat1IsRefused) {
  const std::string header = "{\"kind\":\"exactvo-recording\",\"format_version\":1,\"method\":\"ivo\"}\n";
  const DataError error = refusal_of([&] { read_recording(put("old.jsonl", header)); });
  expect_refusal(error, DataCode::out_of_range, "line 1, /format_version");
}

TEST_F(RecordingFileTest, ARecordingCutShortIsNotTakenForAWholeOne) {
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string text = content_of(folder_ / "r.jsonl");
  const std::size_t end = text.rfind('\n', text.size() - 2) + 1;
  const auto refused = [&](std::size_t bytes) {
    const DataError error = refusal_of([&] { read_recording(put("cut.jsonl", text.substr(0, bytes))); });
    EXPECT_EQ(error.code(), DataCode::cut_off) << bytes << ": " << error.what();
    return error;
  };
  EXPECT_EQ(
      refused(end).place(),
      "line " + std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n')));
  EXPECT_EQ(refused(end).found(), "the end of the file after 20 rows");
  EXPECT_EQ(refused(end - 2).found(), "the end of the file after 19 rows, within a line");
  // Wherever it was cut off, but before the line feed of the last line alone.
  SeededRandom random(exactvo::test::seed_of_run(41));
  for (std::size_t bytes = 0; bytes < 60; ++bytes) refused(bytes);
  for (std::size_t bytes = end; bytes + 1 < text.size(); ++bytes) refused(bytes);
  for (int k = 0; k < 300; ++k) refused(static_cast<std::size_t>(random.integer(0, static_cast<int>(end))));
  EXPECT_NO_THROW(read_recording(put("whole.jsonl", text.substr(0, text.size() - 1))));
  // What ends in no line of JSON is something else, and so is another file that ends early.
  EXPECT_EQ(refusal_of([&] { read_recording(put("bad.jsonl", text.substr(0, end) + "oops\n")); }).code(),
            DataCode::json_syntax);
  EXPECT_EQ(refusal_of([&] { read_recording(put("bad.jsonl", "{\"head\n{}\n")); }).code(), DataCode::format_unknown);
}

TEST_F(RecordingFileTest, LinesThatStandTwiceOrTooLateAreRefused) {
  write_recording(folder_ / "r.jsonl", sample(false));
  const std::string good = content_of(folder_ / "r.jsonl");
  const auto line_at = [&](std::size_t at) { return good.substr(at, good.find('\n', at) + 1 - at); };
  const auto refused_with = [&](std::size_t at, const std::string& more) {
    return refusal_of([&] { read_recording(put("bad.jsonl", std::string(good).insert(at, more))); });
  };
  const std::size_t body = good.find("{\"body\":"), of_goal = good.find("{\"goal_bodies\":");
  const std::size_t end = good.find("{\"end\":");  // all rows have passed
  const std::string last = "line " + std::to_string(std::count(good.begin(), good.end(), '\n'));
  expect_refusal(refused_with(body + line_at(body).size(), line_at(body)), DataCode::out_of_range,
                 "line 3, /body/number");
  expect_refusal(refused_with(end, line_at(body)), DataCode::out_of_range, last + ", /body/number");
  expect_refusal(refused_with(end, line_at(of_goal)), DataCode::out_of_range, last + ", /goal_bodies/time");
}

void write_table(const std::filesystem::path& path, const RecordingFile& file) {
  TrajectoryWriter writer(path, file.scenario);
  for (const formation::Step& row : file.recording.steps) writer.add(row);
  EXPECT_FALSE(std::filesystem::exists(path));
  writer.finish();
}

TEST_F(RecordingFileTest, TheTrajectoryHasARowARobotAndStep) {
  write_table(folder_ / "t.csv", sample(false));
  const std::string text = content_of(folder_ / "t.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 20 * 3);
  EXPECT_EQ(text.find("leader"), std::string::npos);
  EXPECT_NE(text.find("\n0,\"R, \"\"0\"\"\","), std::string::npos);
  write_table(folder_ / "f.csv", sample(true));
  const std::string rows = content_of(folder_ / "f.csv");
  EXPECT_NE(rows.find(",leader_x_m,"), std::string::npos);
}

}  // namespace
}  // namespace exactvo::datasets::test
