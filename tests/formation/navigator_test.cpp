// SPDX-License-Identifier: GPL-3.0-or-later
// Navigators beside simulate: robots that go by them drive the same bits; what they decide is audited like a run; they
// allocate nothing once they are under way; and what is wrong with their input is said by a typed error.
#include "exactvo/formation/navigator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "counted_allocations.h"
#include "exactvo/datasets/audit.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/shapes.h"
#include "paper_scenes.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using testing::HasSubstr;

/// Through each other on a small circle, one of them without yielding, beside a cart and a block: too dense for all
/// half-planes.
Scenario squeeze() {
  Scenario s;
  s.name = "squeeze";
  constexpr int kRobots = 12;
  for (int k = 0; k < kRobots; ++k) {
    const double angle = 2.0 * geometry::kPi * k / kRobots;
    const Vec2 at{3.2 * std::cos(angle), 3.2 * std::sin(angle)};
    s.robots.push_back({"R" + std::to_string(k + 1), at, {}, 0.4 + 0.01 * k, 1.5, {-at, Vec2{5.0, 0.2 * k}}, k != 3});
  }
  s.obstacles = {{"block", geometry::Polygon{{{-0.3, -0.3}, {0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}}, {}}}};
  s.moving_obstacles = {{"cart",
                         geometry::Polygon{{{-8, -0.5}, {-7, -0.5}, {-6.5, 0}, {-7, 0.5}, {-8, 0.5}}, {}},
                         {{{-7, 0}, {7, 1}}, 0.9}}};
  s.time_limit = 20.0;
  return s;
}

Scenario scene(const std::string& name) {
  if (name == "squeeze") return squeeze();
  const std::string data = std::string(EXACTVO_SOURCE_DIR) + "/datasets/data/";
  if (name == "office" || name == "room") return datasets::load_scenario(data + name + "/" + name + ".json");
  return test::paper_scene(name);
}

SimulationOptions alone(Method method) {
  SimulationOptions options = test::with_method(method);
  options.guidance = Guidance::none;
  options.liveness = Liveness::off;
  return options;
}

/// All robots of a scenario, each with a navigator and the others for neighbours.
class Fleet {
 public:
  Fleet(const Scenario& scenario, Method method) : scenario_(scenario), neighbours_(scenario.robots.size()) {
    for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
      navigators_.emplace_back(navigator_setup(scenario, i, method), scenario.robots[i].goals);
      states_.push_back({0.0, scenario.robots[i].position, scenario.robots[i].velocity});
    }
  }

  /// Decides for all, calling before(i) and after(i, navigator) round each decision, then moves all.
  template <class Before, class After>
  void step(const Step& row, const Before& before, const After& after) {
    std::vector<MovingBody> moving;
    for (std::size_t k = 0; k < row.moving.size(); ++k)
      moving.push_back({hull_of(scenario_.moving_obstacles[k], row.moving[k].displacement), row.moving[k].velocity});
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].time = row.time;
      neighbours_[i].clear();
      for (std::size_t j = 0; j < states_.size(); ++j) {
        const Robot& other = scenario_.robots[j];
        if (j == i) continue;
        neighbours_[i].push_back(
            {j, states_[j].position, states_[j].velocity, other.radius, other.max_speed, other.cooperates});
      }
    }
    std::vector<Vec2> chosen;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      before(i);
      const Vec2 v = navigators_[i].decide(states_[i], neighbours_[i], moving).chosen;
      after(i, navigators_[i]);
      chosen.push_back(v);
    }
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].velocity = chosen[i];
      states_[i].position += scenario_.time_step * chosen[i];
    }
  }

 private:
  const Scenario& scenario_;
  std::vector<Navigator> navigators_;
  std::vector<NavigatorState> states_;
  std::vector<std::vector<Neighbour>> neighbours_;
};

bool same(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
bool same(Vec2 a, Vec2 b) {
  return same(a.x, b.x) && same(a.y, b.y);
}

std::string difference(const DecisionConstraint& a, const DecisionConstraint& b) {
  if (!same(a.half_plane.normal, b.half_plane.normal) || !same(a.half_plane.offset, b.half_plane.offset))
    return "half-plane";
  if (a.source != b.source || a.index != b.index || a.piece != b.piece) return "name";
  if (a.certified != b.certified || a.hard != b.hard || a.active != b.active) return "flags";
  if (!same(a.time_horizon, b.time_horizon) || !same(a.clearance, b.clearance) || !same(a.multiplier, b.multiplier))
    return "numbers";
  return "";
}

/// The same body from the same place, whatever its number.
std::string difference(const vo::Body& body, const SeenBody& seen) {
  if (geometry::to_string(body.shape) != geometry::to_string(seen.shape)) return "shape";
  return same(body.velocity, seen.velocity) ? "" : "velocity of the body";
}

/// In what they differ beside the numbers of bodies, which count others in a run; empty: in nothing.
std::string difference(const RobotStep& a, const RobotStep& b) {
  if (!same(a.position, b.position) || !same(a.velocity, b.velocity)) return "state";
  if (!same(a.preferred, b.preferred)) return "preferred";
  if (!same(a.chosen, b.chosen)) return "chosen";
  if (a.status != b.status || !same(a.violation, b.violation) || a.exact_multipliers != b.exact_multipliers)
    return "status";
  if (a.mode != b.mode || a.side != b.side || a.note != b.note)
    return "mode or note: '" + a.note + "', '" + b.note + "'";
  if (a.uncertified != b.uncertified || a.bound.size() != b.bound.size()) return "counts";
  for (std::size_t k = 0; k < a.bound.size(); ++k)
    if (a.bound[k].binding != b.bound[k].binding || !same(a.bound[k].multiplier, b.bound[k].multiplier)) return "bound";
  if (a.constraints.size() != b.constraints.size()) return "number of half-planes";
  for (std::size_t k = 0; k < a.constraints.size(); ++k)
    if (const std::string what = difference(a.constraints[k], b.constraints[k]); !what.empty())
      return "half-plane " + std::to_string(k) + ": " + what;
  return "";
}

void expect_the_bits_of_simulate(const std::string& name, Method method) {
  const Scenario s = scene(name);
  const Recording run = simulate(s, alone(method));
  Fleet fleet(s, method);
  std::size_t decisions = 0;
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k) {
    const Step& row = run.steps[k];
    fleet.step(
        row, [](std::size_t) {},
        [&](std::size_t i, const Navigator& navigator) {
          ++decisions;
          const auto where = [&] {
            return name + " " + formation::name(method) + ": robot " + std::to_string(i) + " at " +
                   std::to_string(row.time) + " s";
          };
          const RobotStep recorded = navigator.recorded();
          ASSERT_EQ(difference(recorded, row.robots[i]), "") << where();
          for (std::size_t c = 0; c < recorded.constraints.size(); ++c)
            ASSERT_EQ(difference(navigator.bodies()[recorded.constraints[c].body],
                                 seen_body(s, run.bodies, row, i, row.robots[i].constraints[c])),
                      "")
                << where();
        });
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(decisions, 10u) << name;
}

class Fleets : public testing::TestWithParam<std::string> {};

TEST_P(Fleets, DriveTheBitsOfSimulate) {
  for (const Method method : {Method::ivo, Method::ivo_cluster, Method::ivo_edge, Method::orca})
    expect_the_bits_of_simulate(GetParam(), method);
}

// Walls and corridors, crossings, a room, an office; with moving obstacles, robots that do not yield, several goals.
INSTANTIATE_TEST_SUITE_P(Scenes, Fleets,
                         testing::Values("A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10", "A11",
                                         "A12", "A13", "A14", "A15", "room", "office", "squeeze"),
                         [](const auto& row) { return row.param; });

struct Counted {
  std::size_t decisions = 0, allocations = 0;
  std::map<Mode, std::size_t> modes;
  std::size_t relaxed = 0;
};

/// In steps that do not head for another goal.
void count_under_way(const std::string& name, Counted& counted) {
  const Scenario s = scene(name);
  const Recording run = simulate(s, alone(Method::ivo));
  Fleet fleet(s, Method::ivo);
  std::vector<std::size_t> goal(s.robots.size(), 0);
  std::size_t before = 0;
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k)
    fleet.step(
        run.steps[k], [&](std::size_t) { before = test::allocations(); },
        [&](std::size_t i, const Navigator& navigator) {
          const std::size_t made = test::allocations() - before;
          const RobotStep decision = navigator.recorded();
          if (k == 0 || navigator.goal() != std::exchange(goal[i], navigator.goal())) return;
          ++counted.decisions;
          ++counted.modes[decision.mode];
          counted.relaxed += decision.status == lp::Status::relaxed;
          counted.allocations += made;
          if (made > 0) std::printf("%s: %zu allocations, robot %zu, row %zu\n", name.c_str(), made, i, k);
        });
}

/// Past a post and a robot that comes towards it, by poses and twists.
TEST(Navigator, OnWheelsAllocatesNothingUnderWay) {
  NavigatorSetup setup;
  DifferentialDrive& drive = setup.drive.emplace();
  drive.wheel_separation = 0.16;
  drive.max_wheel_speed = 0.22;
  drive.max_wheel_acceleration = 1.0;
  drive.reference = 0.08;
  drive.body_radius = 0.105;
  setup.obstacles = {{"post", geometry::Polygon{{{1.0, -0.3}, {1.2, -0.3}, {1.1, -0.1}}, {}}}};
  Navigator navigator(setup, {{3.0, 0.1}});
  NavigatorState now{0.0, {0.0, 0.0}, {}, {{1.0, 0.0}, {}}};
  std::vector<Neighbour> others(1);
  std::size_t decisions = 0, allocations = 0;
  for (int k = 0; k < 900 && !navigator.has_arrived(); ++k, now.time += setup.time_step) {
    others[0] = neighbour_on_wheels(1, drive, setup.time_step, {2.5 - 0.01 * k, 0.3}, {{-1.0, 0.0}, {0.2, 0.2}});
    const std::size_t before = test::allocations();
    const Decision& decision = navigator.decide(now, others);
    const std::size_t made = test::allocations() - before;
    EXPECT_EQ(decision.status, lp::Status::optimal) << k;
    if (k > 0) allocations += made;
    ++decisions;
    const Twist twist = navigator.twist();
    const double turn = twist.angular * setup.time_step;
    now.position += setup.time_step * twist.linear * geometry::rotated(now.wheels.heading, 0.5 * turn);
    now.wheels = {geometry::rotated(now.wheels.heading, turn), twist.wheels};
  }
  EXPECT_TRUE(navigator.has_arrived());
  EXPECT_GT(decisions, 200u);
  EXPECT_EQ(allocations, 0u);
}

TEST(Navigator, AllocatesNothingUnderWay) {
  Counted counted;
  for (const char* name : {"A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10", "A11", "A12", "A13",
                           "A14", "A15", "room", "squeeze"})
    count_under_way(name, counted);
  EXPECT_EQ(counted.allocations, 0u) << "in " << counted.decisions << " decisions";
  EXPECT_GT(counted.decisions, 5000u);
  EXPECT_GT(counted.relaxed, 0u);
  for (const Mode mode : {Mode::direct, Mode::boost, Mode::following, Mode::arrived})
    EXPECT_GT(counted.modes[mode], 10u) << formation::name(mode);
}

/// A run of one robot, put together from its navigator's decisions.
datasets::RecordingFile recording_by_navigator(const std::string& name) {
  datasets::RecordingFile file;
  file.scenario = scene(name);
  file.scenario.robots.resize(1);
  file.scenario.moving_obstacles.clear();
  file.scenario.guidance = Guidance::none;
  file.scenario.liveness = Liveness::off;
  file.info.scenario = file.scenario.name;
  file.info.method = "ivo";
  file.recording.time_step = file.scenario.time_step;
  Fleet fleet(file.scenario, Method::ivo);
  Step row;
  for (std::size_t k = 0; k < 400; ++k) {
    row.time = static_cast<double>(k) * file.scenario.time_step;
    bool has_arrived = false;
    fleet.step(
        row, [](std::size_t) {},
        [&](std::size_t, const Navigator& navigator) {
          row.robots = {navigator.recorded()};
          has_arrived = navigator.has_arrived();
          const GoalBodies of_goal = navigator.goal_bodies();
          std::vector<GoalBodies>& all = file.recording.goal_bodies;
          if (all.empty() || all.back().goal != of_goal.goal) all.push_back(of_goal);
          if (!has_arrived) return;
          for (std::size_t b = 0; b < navigator.bodies().size(); ++b)
            file.recording.bodies.push_back(navigator.bodies()[b]);
        });
    file.recording.steps.push_back(row);
    if (!has_arrived) continue;
    RobotStep& last = file.recording.steps.back().robots.front();
    last.constraints.clear();
    last.bound.clear();
    return file;
  }
  ADD_FAILURE() << name << ": the robot did not arrive";
  return file;
}

TEST(Navigator, WhatItDecidesIsAuditedLikeARun) {
  for (const char* name : {"A1", "A6"}) {
    const datasets::RecordingFile file = recording_by_navigator(name);
    const datasets::AuditReport report = datasets::audit(file, &file.scenario);
    EXPECT_TRUE(report.clean()) << name << ": " << testing::PrintToString(report.findings);
    EXPECT_GT(report.half_planes, 20u) << name;
    EXPECT_EQ(report[datasets::AuditPoint::choices].refuted, 0u) << name;
  }
}

// --- Robots that do not drive exactly what is chosen ---

/// What a real robot makes of a chosen velocity, and what is known of where it is.
struct Plant {
  double reached = 1.0;  ///< share of a change of velocity that a tenth of a second reaches
  double noise = 0.0;    ///< m, of each coordinate of the place that the navigator hears of
  double quantum = 0.0;  ///< m/s, the wheels take multiples of it; 0: any velocity
  std::uint64_t seed = 1;
};

/// How a drive with a plant ended.
struct Drive {
  bool arrived = false;
  double time = 0.0;       ///< s
  double clearance = 1e9;  ///< m, the least, of the robot where it is
  std::string notes;
};

Drive drive(const NavigatorSetup& setup, Vec2 from, Vec2 goal, const Plant& plant, double time_limit) {
  test::SeededRandom random(plant.seed);
  Navigator navigator(setup, {goal});
  const auto rounded = [&](double x) {
    return plant.quantum > 0.0 ? plant.quantum * std::round(x / plant.quantum) : x;
  };
  Drive result;
  const double in_a_step = 1.0 - std::pow(1.0 - plant.reached, setup.time_step / 0.1);
  Vec2 position = from, velocity{};
  for (; result.time < time_limit && !result.arrived; result.time += setup.time_step) {
    const Vec2 heard = position + random.in_box(plant.noise);
    const Decision& decision = navigator.decide({result.time, heard, velocity});
    if (!decision.note.empty()) result.notes += decision.note + "; ";
    velocity += in_a_step * (Vec2{rounded(decision.chosen.x), rounded(decision.chosen.y)} - velocity);
    position += setup.time_step * velocity;
    result.arrived = navigator.has_arrived();
    for (const SceneObstacle& o : setup.obstacles)
      result.clearance = std::min(result.clearance, geometry::signed_distance(o.shape, position) - setup.radius);
  }
  return result;
}

/// A small robot with two wheels before a wall.
NavigatorSetup before_a_wall(double half_width, double time_step) {
  NavigatorSetup setup;
  setup.radius = 0.18;
  setup.max_speed = 0.22;
  setup.time_step = time_step;
  setup.obstacles = {{"wall", geometry::Polyline{{{2.0, -half_width}, {2.0, half_width}}}}};
  return setup;
}

TEST(Navigator, PassesAWallInSpiteOfLagNoiseAndQuantisedVelocities) {
  constexpr std::pair<double, double> kDrives[] = {{-0.3, 0.1}, {0.0, 0.1}, {0.1, 0.02}, {0.5, 0.02}};  // m, s
  std::size_t judged = 0;
  for (const double reached : {1.0, 0.6, 0.3})
    for (const double noise : {0.0, 0.01, 0.02})
      for (const double quantum : {0.0, 0.01, 0.02})
        for (const auto& [y, time_step] : kDrives) {
          const Plant plant{reached, noise, quantum, ++judged};
          const Drive d = drive(before_a_wall(0.8, time_step), {0.0, y}, {4.0, y}, plant, 120.0);
          const std::string what = "reached " + std::to_string(reached) + ", noise " + std::to_string(noise) +
                                   " m, quantum " + std::to_string(quantum) + " m/s, y " + std::to_string(y);
          EXPECT_TRUE(d.arrived) << what << ": " << d.notes;
          EXPECT_GT(d.clearance, 0.0) << what;
          EXPECT_EQ(d.notes.find("circuit"), std::string::npos) << what << ": " << d.notes;
        }
  EXPECT_EQ(judged, 108u);
}

// --- Bad input ---

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A block from (2, -1) to (4, 1).
NavigatorSetup by_a_block() {
  NavigatorSetup setup;
  setup.radius = 0.5;
  setup.max_speed = 1.5;
  setup.obstacles = {{"block", geometry::Polygon{{{2, -1}, {4, -1}, {4, 1}, {2, 1}}, {}}}};
  return setup;
}

template <class Call>
void expect_refused(const Call& call, NavigatorProblem problem, const std::string& words) {
  try {
    call();
    FAIL() << "was taken: " << words;
  } catch (const NavigatorError& error) {
    EXPECT_STREQ(name(error.problem()), name(problem)) << error.what();
    EXPECT_THAT(std::string(error.what()), HasSubstr(words));
  }
}

template <class Change>
void expect_setup_refused(const Change& change, NavigatorProblem problem, const std::string& words) {
  NavigatorSetup setup = by_a_block();
  change(setup);
  expect_refused([&] { Navigator(setup, {{6, 0}}); }, problem, words);
}

TEST(NavigatorErrors, StatesOfWheelsThatNoDriveHas) {
  NavigatorSetup setup;
  DifferentialDrive& drive = setup.drive.emplace();
  drive.wheel_separation = 0.05;
  drive.max_wheel_speed = 1.0;
  drive.max_wheel_acceleration = 5.0;
  drive.reference = 0.2;
  drive.body_radius = 0.1;
  drive.max_angular_speed = 20.0;
  setup.time_step = 0.1;
  Navigator navigator(setup, {{6, 0}});
  const auto decide = [&](Vec2 heading, WheelSpeeds wheels) { navigator.decide({0.0, {}, {}, {heading, wheels}}, {}); };
  using P = NavigatorProblem;
  expect_refused([&] { decide({1, 0}, {-1.0, 1.0}); }, P::out_of_range, "less than a half turn");
  expect_refused([&] { decide({1.1, 0}, {}); }, P::out_of_range, "heading");
  expect_refused([&] { neighbour_on_wheels(1, drive, 0.1, {}, {{2, 0}, {}}); }, P::out_of_range, "heading");
  decide({1, 0}, {0.1, 0.1});
}

TEST(NavigatorErrors, SetupsOutOfRange) {
  using P = NavigatorProblem;
  expect_setup_refused([](auto& s) { s.radius = -1.0; }, P::out_of_range, "radius: found -1");
  expect_setup_refused([](auto& s) { s.radius = kNan; }, P::not_finite, "radius");
  expect_setup_refused([](auto& s) { s.max_speed = 0.0; }, P::out_of_range, "max_speed");
  expect_setup_refused([](auto& s) { s.time_step = -0.1; }, P::out_of_range, "time_step");
  expect_setup_refused([](auto& s) { s.time_step = 1.0; }, P::out_of_range, "time_step");
  expect_setup_refused([](auto& s) { s.margins.obstacle = kInfinity; }, P::not_finite, "margins/obstacle");
  expect_setup_refused([](auto& s) { s.neighbours = std::size_t{1} << 40; }, P::out_of_range, "neighbours");
  expect_setup_refused(
      [](auto& s) {
        s.obstacles[0].shape = geometry::Polyline{{{0, 0}, {kNan, 1}}};
      },
      P::not_finite, "obstacle 0 vertex");
  expect_setup_refused([](auto& s) { s.obstacles[0].disc = geometry::Disc{{kNan, 0}, 1.0}; }, P::not_finite,
                       "obstacle 0 disc centre");
  expect_setup_refused([](auto& s) { s.obstacles[0].disc = geometry::Disc{{3, 0}, -1.0}; }, P::out_of_range,
                       "obstacle 0 disc radius");
  expect_refused([] { Navigator(by_a_block(), {}); }, P::no_goal, "goals");
  expect_refused([] { Navigator(by_a_block(), {{0, 0}, {kNan, 0}}); }, P::not_finite, "goal 1");
}

TEST(NavigatorErrors, StatesNeighboursAndBodies) {
  using P = NavigatorProblem;
  Navigator navigator(by_a_block(), {{6, 0}});
  Navigator undisturbed(by_a_block(), {{6, 0}});
  const NavigatorState now{1.0, {0, 0}, {1, 0}};
  navigator.decide(now);
  undisturbed.decide(now);
  const auto refused = [&](const NavigatorState& state, P problem, const std::string& words) {
    expect_refused([&] { navigator.decide(state); }, problem, words);
  };
  refused({kNan, {0, 0}, {1, 0}}, P::not_finite, "time");
  refused({1.1, {kNan, 0}, {1, 0}}, P::not_finite, "position");
  refused({1.1, {0, 0}, {kInfinity, 0}}, P::not_finite, "velocity");
  refused({1.1, {1e200, 0}, {0, 0}}, P::out_of_range, "position");
  refused({0.9, {0, 0}, {1, 0}}, P::time_backwards, "time: found 0.9");
  refused({1.1, {3, 0}, {0, 0}}, P::inside_obstacle, "obstacle 'block'");
  const auto with = [&](const Neighbour& n, P problem, const std::string& words) {
    expect_refused([&] { navigator.decide({1.1, {0, 0}, {1, 0}}, {{7, {9, 9}}, n}); }, problem, words);
  };
  with({1, {kNan, 3}}, P::not_finite, "neighbour 1 position");
  with({1, {3, 3}, {0, kNan}}, P::not_finite, "neighbour 1 velocity");
  with({1, {3, 3}, {}, -0.5}, P::out_of_range, "neighbour 1 radius");
  with({1, {3, 3}, {}, 0.5, 0.0}, P::out_of_range, "neighbour 1 max_speed");
  with({1, {0, 0}}, P::coincident, "neighbour 1 position");
  expect_refused(
      [&] {
        navigator.decide({1.1, {0, 0}, {1, 0}}, {}, {{geometry::Disc{{3, 3}, -1.0}, {}}});
      },
      P::out_of_range, "moving body 0 shape");
  expect_refused(
      [&] {
        navigator.decide({1.1, {0, 0}, {1, 0}}, {}, {{geometry::Disc{{3, 3}, 1.0}, {kNan, 0}}});
      },
      P::not_finite, "moving body 0 velocity");
  expect_refused([&] { navigator.set_goals({}); }, P::no_goal, "goals");
  // It is as it was.
  navigator.decide({1.1, {0.1, 0}, {1, 0}});
  undisturbed.decide({1.1, {0.1, 0}, {1, 0}});
  EXPECT_EQ(difference(navigator.recorded(), undisturbed.recorded()), "");
}

TEST(Navigator, LeadsARobotThatOverlapsAnObstacleOutAndPromisesNothing) {
  Navigator navigator(by_a_block(), {{6, 0}});
  const Decision& decision = navigator.decide({0.0, {1.7, 0.2}, {0, 0}});
  EXPECT_EQ(decision.mode, Mode::pushing_out);
  EXPECT_EQ(decision.uncertified, 1u);
  EXPECT_LT(decision.chosen.x, 0.0);
}

TEST(Navigator, TakesANeighbourThatOverlapsItOrABodyRoundIt) {
  Navigator navigator(by_a_block(), {{6, 0}});
  const Decision& decision =
      navigator.decide({0.0, {0, 0}, {0, 0}}, {{1, {0.3, 0}}}, {{geometry::Disc{{0, 0}, 2.0}, {}}});
  EXPECT_EQ(decision.uncertified, 2u);
  EXPECT_TRUE(geometry::is_finite(decision.chosen));
}

TEST(Navigator, HeadsForOtherGoals) {
  Navigator navigator(by_a_block(), {{0, 5}, {0, -5}});
  EXPECT_EQ(navigator.decide({0.0, {0, 0}, {0, 0}}).preferred.x, 0.0);
  EXPECT_EQ(navigator.goal(), 0u);
  navigator.decide({0.1, {0, 4.8}, {0, 0}});
  EXPECT_EQ(navigator.goal(), 1u);
  EXPECT_FALSE(navigator.has_arrived());
  navigator.set_goals({{-5, 0}});
  EXPECT_LT(navigator.decide({0.2, {0, 0}, {0, 0}}).chosen.x, -1.0);
  navigator.decide({9.0, {-5, 0}, {0, 0}});
  EXPECT_TRUE(navigator.has_arrived());
}

}  // namespace
}  // namespace exactvo::formation
