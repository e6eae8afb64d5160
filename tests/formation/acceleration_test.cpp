// SPDX-License-Identifier: GPL-3.0-or-later
// Robots with bounded accelerations: lemma 4 and theorem 3 of docs/guide/accelerations.md by their numbers, in
// rationals, and whole runs by their audit.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/run_info.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/navigator.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/vo/lp/solve.h"
#include "liveness_scenes.h"
#include "rational_point.h"
#include "scene/braking.h"
#include "scene/free_space.h"
#include "scene/goals.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

/// Squared distance to 0 of the way from `from` to `from` + `along`.
Rational squared_distance(const Point& from, const Point& along) {
  const Rational length = dot(along, along);
  Rational share(0);
  if (length > 0) share = std::clamp(Rational(-dot(from, along) / length), Rational(0), Rational(1));
  const Point nearest = from + share * along;
  return dot(nearest, nearest);
}

/// Invariant I of a pair: the way at v that lasts tau keeps `reach` from 0.
bool brakes_clear(Vec2 apart, Vec2 velocity, double tau, double reach) {
  return squared_distance(exactly(apart), Rational(tau) * exactly(velocity)) >= Rational(reach) * Rational(reach);
}

bool satisfies(const geometry::HalfPlane& h, Vec2 v) {
  return dot(exactly(h.normal), exactly(v)) >= Rational(h.offset);
}

detail::DecisionRules rules(double acceleration, double tau, double step = 0.05) {
  detail::DecisionRules r;
  r.acceleration = acceleration;
  r.braking_time = tau;
  r.time_step = step;
  return r;
}

/// x + T v + [0, tau] lambda v is a part of x + [0, tau] v.
TEST(Acceleration, Lemma4_AfterAStepOfBrakingWhatIsLeftOfTheWayIsClear) {
  test::SeededRandom random(test::seed_of_run(4));
  int clear = 0, touching = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec2 apart = random.in_box(3.0), v = random.in_box(2.0);
    const double reach = random.uniform(0.2, 1.5);
    const Rational tau(random.uniform(0.1, 3.0)), step = tau * Rational(random.uniform(0.0, 1.0));
    const Rational least = squared_distance(exactly(apart), tau * exactly(v));
    if (least < Rational(reach) * Rational(reach)) continue;
    const Rational lambda = 1 - step / tau;
    const Point from = exactly(apart) + step * exactly(v), along = tau * lambda * exactly(v);
    EXPECT_GE(squared_distance(from, along), least) << k;
    touching += squared_distance(from, along) == least;
    ++clear;
  }
  EXPECT_GT(clear, 5000);
  EXPECT_GT(touching, 500) << "the way that is left holds the nearest point often";
}

/// (a) lambda v satisfies both halves, though as much room is asked for as there is; (b) any velocities that satisfy
/// them have ways that keep clear.
TEST(Acceleration, Theorem3_HalvesOfAPairAllowBrakingAndKeepItPossible) {
  test::SeededRandom random(test::seed_of_run(3));
  int pairs = 0, tight = 0, chosen = 0;
  for (int k = 0; k < 20000; ++k) {
    const double tau = random.uniform(0.1, 3.0), step = random.uniform(0.01, 0.9) * tau;
    const detail::DecisionRules r = rules(1.0, tau, step);
    vo::MovingDisc a{random.in_box(3.0), random.in_box(2.0), random.uniform(0.1, 0.7)};
    vo::MovingDisc b{random.in_box(3.0), random.in_box(2.0), random.uniform(0.1, 0.7)};
    const double reach = a.radius + b.radius;
    if (k % 4 == 0) {  // the way grazes the other robot: it is turned onto a tangent
      const Vec2 apart = b.position - a.position;
      if (norm(apart) <= reach) continue;
      const double turn = std::asin(reach / norm(apart)) + 1e-12;
      a.velocity = b.velocity + norm(a.velocity) *
                                    Vec2{std::cos(turn) * apart.x - std::sin(turn) * apart.y,
                                         std::sin(turn) * apart.x + std::cos(turn) * apart.y} /
                                    norm(apart);
    }
    if (!brakes_clear(a.position - b.position, a.velocity - b.velocity, tau, reach)) continue;
    const vo::MovingDisc now_a{a.position + step * a.velocity, r.braked(a.velocity), a.radius};
    const vo::MovingDisc now_b{b.position + step * b.velocity, r.braked(b.velocity), b.radius};
    const Vec2 apart = now_a.position - now_b.position;
    if (!brakes_clear(apart, now_a.velocity - now_b.velocity, tau, reach + 1e-13)) continue;  // positions are rounded
    const vo::ReciprocalHalfPlanes pair = detail::braking_half_planes(now_a, now_b, tau);
    ++pairs;
    EXPECT_TRUE(pair.certified) << k;
    EXPECT_TRUE(satisfies(pair.a, now_a.velocity)) << k;
    EXPECT_TRUE(satisfies(pair.b, now_b.velocity)) << k;
    tight += geometry::violation(pair.a, now_a.velocity) > -1e-9;
    for (int n = 0; n < 8; ++n) {
      const Vec2 u = now_a.velocity + random.in_box(1.0), w = now_b.velocity + random.in_box(1.0);
      if (!satisfies(pair.a, u) || !satisfies(pair.b, w)) continue;
      ++chosen;
      EXPECT_TRUE(brakes_clear(apart, u - w, tau, reach)) << k;
    }
  }
  EXPECT_GT(pairs, 5000);
  EXPECT_GT(tight, 500) << "of few pairs does braking lie on the line";
  EXPECT_GT(chosen, 10000);
}

/// The same against what stands, of every kind of shape.
TEST(Acceleration, Theorem3_HalfPlanesAgainstObstaclesAllowBraking) {
  test::SeededRandom random(test::seed_of_run(33));
  int made = 0, used_up = 0;
  for (int k = 0; k < 20000; ++k) {
    const double tau = random.uniform(0.1, 3.0), radius = random.uniform(0.1, 0.7);
    geometry::GrownShape seen;
    const Vec2 a = random.in_box(3.0), b = a + random.in_box(2.0);
    if (k % 2 == 0)
      seen.shape = geometry::Segment{a, b};
    else
      seen.shape = geometry::Disc{a, random.uniform(0.05, 1.0)};
    seen.radius = radius;
    const vo::VelocityObstacle::Nearest nearest = vo::clearance_of(seen);
    if (!(nearest.distance > 0.0)) continue;
    // As much of a velocity as leaves the way clear, up to the last bits of the skin.
    const Vec2 whole = random.in_box(3.0);
    const auto is_clear = [&](double share) {
      geometry::GrownShape moved = seen;
      for (int s = 0; s <= 64; ++s) {
        moved.origin = seen.origin + (s / 64.0) * tau * share * whole;
        if (geometry::locate(moved, Vec2{}) != geometry::Place::outside) return false;
      }
      return true;
    };
    double least = 0.0, most = 1.0;
    if (is_clear(1.0)) least = 1.0;
    for (int n = 0; n < 40 && least < 1.0; ++n) {
      const double middle = 0.5 * (least + most);
      (is_clear(middle) ? least : most) = middle;
    }
    // Ways are sampled: an end is exact, a passage is not, and keeps a little more.
    const Vec2 braked = (least < 1.0 ? 0.98 : 1.0) * least * whole;
    if (!is_clear(least < 1.0 ? 0.98 * least : least)) continue;
    const vo::ProvenHalfPlane found = detail::braking_half_plane(seen, nearest, braked, tau);
    EXPECT_EQ(seen.radius, radius);
    EXPECT_EQ(found.proof, vo::Proof::alone) << k;
    ++made;
    used_up += least < 1.0;
    if (geometry::half_plane_is_safe(seen, tau, found.half_plane) && satisfies(found.half_plane, braked)) continue;
    ADD_FAILURE() << k << " " << geometry::violation(found.half_plane, braked);
  }
  EXPECT_GT(made, 5000);
  EXPECT_GT(used_up, 500);
}

/// Whatever satisfies the polygon is within A T of the velocity, by its corners, and braking is in it.
TEST(Acceleration, LimitsLieWithinTheDiscAndHoldBraking) {
  test::SeededRandom random(test::seed_of_run(24));
  int corners = 0;
  std::vector<geometry::HalfPlane> limit;
  for (int k = 0; k < 2000; ++k) {
    const double most = random.uniform(0.1, 5.0), fastest = random.uniform(0.1, 5.0);
    const detail::DecisionRules r = rules(most, (1.0 + 1e-9) * fastest / most + 1e-3 * (k % 3), 0.05);
    const Vec2 v = k % 10 == 0 ? Vec2{} : random.uniform(0.0, 1.0) * fastest * random.direction();
    limit.clear();
    detail::add_acceleration_limits(r, v, limit);
    ASSERT_EQ(limit.size(), static_cast<std::size_t>(detail::kSidesOfLimit));
    const Rational reach = Rational(most) * Rational(r.time_step);
    for (std::size_t i = 0; i < limit.size(); ++i) {
      EXPECT_TRUE(satisfies(limit[i], r.braked(v))) << k;
      const geometry::HalfPlane &one = limit[i], &next = limit[(i + 1) % limit.size()];
      const Point m = exactly(one.normal), n = exactly(next.normal);
      const Rational det = m.x * n.y - m.y * n.x, c(one.offset), d(next.offset);
      const Point corner{Rational((c * n.y - d * m.y) / det), Rational((d * m.x - c * n.x) / det)};
      const Point change = corner - exactly(v);
      EXPECT_LE(dot(change, change), reach * reach) << k;
      EXPECT_GE(dot(change, change), Rational(0.999) * reach * reach) << k;
      ++corners;
    }
  }
  EXPECT_EQ(corners, 2000 * detail::kSidesOfLimit);
}

TEST(Acceleration, ASpeedThatIsWantedCanBeBrakedFromBeforeTheGoal) {
  for (const double most : {0.3, 1.0, 7.0}) {
    for (double way : {0.001, 0.02, 0.5, 3.0, 40.0}) {
      const double step = 0.05, reached = way;
      double speed = detail::speed_to_stop_within(way, step, most);
      for (int k = 0; k < 10000 && way > 1e-9; ++k) {
        way -= step * speed;
        const double next = detail::speed_to_stop_within(way, step, most);
        EXPECT_GE(way, -1e-9) << most << " " << reached;
        EXPECT_LE(speed - next, most * step * (1.0 + 1e-9)) << most << " " << reached << " " << k;
        speed = next;
      }
      EXPECT_LT(way, 1e-6) << most << " " << reached;
    }
  }
}

// --- Runs ---

Scenario on_circle(int robots, double radius, double acceleration) {
  Scenario s;
  s.name = "circle";
  for (int k = 0; k < robots; ++k) {
    const double angle = 2.0 * geometry::kPi * k / robots;
    const Vec2 place{radius * std::cos(angle), radius * std::sin(angle)};
    test_scenes::add_robot(s, place, -place);
    s.robots.back().max_speed = 1.5;
  }
  s.acceleration = Acceleration{acceleration};
  s.horizons.robots = s.horizons.orca = std::max(2.0, braking_time_of(s));
  s.horizons.most = std::max(3.0, braking_time_of(s));
  return s;
}

datasets::RecordingFile recorded(const Scenario& s, const SimulationOptions& options = {}) {
  return {datasets::run_info(s, options, {}), s, simulate(s, options)};
}

struct Seen {
  std::size_t decisions = 0, relaxed = 0, braking = 0, limited = 0;  ///< braking: half-planes of pairs that fell back
  double last = 0.0, most_change = 0.0;
};

Seen seen_in(const Scenario& s, const Recording& run) {
  Seen seen;
  for (std::size_t row = 0; row + 1 < run.steps.size(); ++row) {
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      const RobotStep& r = run.steps[row].robots[i];
      ++seen.decisions;
      seen.relaxed += r.status != lp::Status::optimal;
      seen.most_change = std::max(seen.most_change, norm(r.chosen - r.velocity) / s.time_step);
      for (const DecisionConstraint& c : r.constraints) {
        seen.limited += c.active && is_own_limit(c);
        seen.braking += c.fell_back;
      }
      if (norm(r.position - s.robots[i].goals.back()) > s.arrival_tolerance) seen.last = run.steps[row].time;
    }
  }
  return seen;
}

void expect_proven(const datasets::RecordingFile& file) {
  const datasets::AuditReport report = datasets::audit(file);
  EXPECT_TRUE(report.clean()) << file.scenario.name << ": " << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_GT(report[datasets::AuditPoint::braking].proven, file.recording.steps.size());
  EXPECT_EQ(report[datasets::AuditPoint::half_planes].open, 0u);
}

/// Twelve on a circle of 8 m, 1.5 m/s: the times are those of the prototype, whose straight way takes 10.7 s.
TEST(Acceleration, TwelveOnACircleArriveWithNothingRelaxed) {
  struct Row {
    double acceleration, last;
  };
  for (const Row row : {Row{3.0, 13.9}, Row{1.0, 16.7}, Row{0.5, 22.5}}) {
    const datasets::RecordingFile file = recorded(on_circle(12, 8.0, row.acceleration));
    const Seen seen = seen_in(file.scenario, file.recording);
    EXPECT_EQ(file.recording.outcome, "all robots arrived") << row.acceleration;
    EXPECT_EQ(seen.relaxed, 0u);
    EXPECT_LE(seen.last, row.last) << row.acceleration;
    EXPECT_LE(seen.most_change, row.acceleration * (1.0 + 1e-9));
    EXPECT_GT(seen.most_change, 0.99 * row.acceleration) << "the limit was never met";
    EXPECT_GT(seen.limited, 100u);
    expect_proven(file);
    std::printf("A = %g: last %.2f s of %.2f s allowed, %zu decisions, %zu braking half-planes on record\n",
                row.acceleration, seen.last, row.last, seen.decisions, seen.braking);
  }
}

/// Goals at random, one after the other, in a box with pillars: so full that half-planes contradict each other.
Scenario stress(test::SeededRandom& random, int robots, double acceleration) {
  Scenario s;
  s.name = "stress";
  s.time_limit = 15.0;
  test_scenes::add_box(s, 6.0, 6.0);
  s.obstacles.push_back({"pillar", geometry::Polygon{{{-0.4, -0.4}, {0.4, -0.4}, {0.4, 0.4}, {-0.4, 0.4}}, {}}});
  s.obstacles.push_back({"fin", geometry::Polyline{{{3.0, -2.0}, {4.0, -0.5}, {3.2, 1.0}}}});
  const auto is_free = [&](Vec2 place) {
    return norm(place) > 1.3 && norm(place - Vec2{3.5, -0.5}) > 2.2 &&
           std::all_of(s.robots.begin(), s.robots.end(),
                       [&](const Robot& r) { return norm(r.position - place) > 1.05; });
  };
  while (static_cast<int>(s.robots.size()) < robots) {
    const Vec2 place = random.in_box(5.3);
    if (!is_free(place)) continue;
    test_scenes::add_robot(s, place, random.in_box(5.3));
    for (int k = 0; k < 8; ++k) s.robots.back().goals.push_back(random.in_box(5.3));
    s.robots.back().max_speed = random.uniform(0.8, 1.5);
    s.robots.back().radius = random.uniform(0.3, 0.5);
  }
  s.acceleration = Acceleration{acceleration};
  s.horizons.robots = s.horizons.orca = std::max(2.0, braking_time_of(s));
  s.horizons.most = std::max(3.0, braking_time_of(s));
  return s;
}

/// Ten in a box of 16 m with pillars, whose turning circles are up to 15 m wide. Rule R1 took slow turns for robots in
/// the way and turned these farther, so that they drove in circles: 3 of 40 did not arrive, over ways of 19 m instead
/// of 9 m.
TEST(Acceleration, RobotsWithWideTurnsDoNotCircle) {
  test::SeededRandom random(test::seed_of_run(3));
  std::size_t arrived = 0, robots = 0;
  double way = 0.0;
  for (const double acceleration : {0.3, 0.6}) {
    for (int scene = 0; scene < 2; ++scene) {
      Scenario s;
      s.name = "wide turns";
      test_scenes::add_box(s, 8.0, 8.0);
      for (const Vec2 p : {Vec2{-4, -4}, Vec2{4, -4}, Vec2{-4, 4}, Vec2{4, 4}, Vec2{0, 0}})
        s.obstacles.push_back(
            {"pillar", geometry::Polygon{
                           {p + Vec2{-0.6, -0.6}, p + Vec2{0.6, -0.6}, p + Vec2{0.6, 0.6}, p + Vec2{-0.6, 0.6}}, {}}});
      std::vector<Vec2> starts, goals;
      const detail::ObstacleSpace space(s.obstacles);
      const auto place = [&](std::vector<Vec2>& taken) {
        for (;;) {
          const Vec2 at = random.in_box(6.8);
          const auto is_near = [&](Vec2 other) { return norm(at - other) < 1.3; };
          if (space.clearance(at, 1.0) < 0.5 || std::any_of(taken.begin(), taken.end(), is_near)) continue;
          taken.push_back(at);
          return at;
        }
      };
      for (int k = 0; k < 10; ++k) {
        const Vec2 from = place(starts);
        test_scenes::add_robot(s, from, place(goals));
        s.robots.back().radius = 0.4;
        s.robots.back().max_speed = 1.5;
      }
      s.acceleration = Acceleration{acceleration};
      s.horizons.robots = s.horizons.orca = std::max(2.0, braking_time_of(s));
      s.horizons.most = std::max(3.0, braking_time_of(s));
      s.time_limit = 90.0;
      const Metrics m = measure(s, simulate(s));
      arrived += m.arrived;
      robots += s.robots.size();
      for (const RobotMetrics& r : m.robots) way += r.path_length;
    }
  }
  EXPECT_EQ(arrived, robots);
  EXPECT_EQ(robots, 40u);
  EXPECT_LT(way / 40.0, 12.0) << "m";
}

TEST(Acceleration, NothingIsRelaxedInAFullBoxWhateverTheGuidance) {
  test::SeededRandom random(test::seed_of_run(12));
  Seen all;
  for (const Guidance guidance : {Guidance::route, Guidance::none}) {
    for (const Method method : {Method::ivo, Method::orca, Method::ivo_edge}) {
      Scenario s = stress(random, 24, guidance == Guidance::route ? 1.0 : 2.0);
      s.guidance = guidance;
      SimulationOptions options;
      options.method = method;
      const datasets::RecordingFile file = recorded(s, options);
      const Seen seen = seen_in(s, file.recording);
      EXPECT_EQ(seen.relaxed, 0u) << name(method) << " " << name(guidance);
      expect_proven(file);
      all.decisions += seen.decisions;
      all.braking += seen.braking;
    }
  }
  EXPECT_GT(all.decisions, 20000u);
  EXPECT_GT(all.braking, 1000u) << "nothing contradicted";
}

/// Their horizon, the braking time, is the usual one here, so that it does not tell them apart.
TEST(Acceleration, PairsThatFellBackAreMarkedInTheRecording) {
  test::SeededRandom random(test::seed_of_run(12));
  Scenario s = stress(random, 24, 0.5);
  s.time_limit = 4.0;
  ASSERT_EQ(s.horizons.robots, braking_time_of(s));
  const datasets::RecordingFile file = recorded(s);
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("exactvo_fallen_" + std::to_string(::getpid()) + ".jsonl");
  datasets::write_recording(path, file);
  const datasets::RecordingFile read = datasets::read_recording(path);
  std::filesystem::remove(path);
  EXPECT_GT(seen_in(s, file.recording).braking, 100u);
  EXPECT_EQ(seen_in(s, read.recording).braking, seen_in(s, file.recording).braking);
}

/// The half-planes of every pair made at the velocities themselves instead of those after a step of braking: what is
/// certified is the same, but decisions have nothing left, and the audit finds ways that do not end in time.
TEST(Acceleration, HalfPlanesMadeAtTheVelocitiesThemselvesAreRefused) {
  Scenario s = on_circle(12, 4.0, 1.0);
  s.liveness = Liveness::off;
  s.guidance = Guidance::none;
  const double tau = braking_time_of(s);
  const detail::DecisionRules r = rules(s.acceleration->max, tau, s.time_step);
  datasets::RecordingFile file;
  file.scenario = s;
  file.info = datasets::run_info(s, {}, {});
  Recording& run = file.recording;
  run.time_step = s.time_step;
  for (std::size_t i = 0; i < s.robots.size(); ++i)
    run.bodies.push_back({vo::BodyKind::robot, geometry::Disc{s.robots[i].position, s.robots[i].radius}, {}, {i}});
  Step row;
  for (const Robot& robot : s.robots) {
    RobotStep step;
    step.position = step.anchor = robot.position;
    row.robots.push_back(step);
  }
  std::size_t nothing_left = 0;
  std::vector<geometry::HalfPlane> limit;
  for (int k = 0; k < 200; ++k) {
    row.time = k * s.time_step;
    Step next = row;
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      RobotStep& me = row.robots[i];
      lp::Problem problem;
      problem.bound.disc = s.robots[i].max_speed;
      const Vec2 straight =
          detail::straight_for(me.position, 1.5, s.robots[i].goals[0], s.time_step, s.acceleration->max);
      me.preferred = problem.preferred = geometry::rotated(straight, -0.1 * static_cast<double>(1 + i % 3));
      me.constraints.clear();
      for (std::size_t j = 0; j < s.robots.size(); ++j) {
        if (j == i) continue;
        const RobotStep& other = row.robots[j];
        const vo::ReciprocalHalfPlanes pair =
            detail::braking_half_planes({me.position, me.velocity, 0.5}, {other.position, other.velocity, 0.5}, tau);
        problem.constraints.push_back({pair.a, lp::Priority::soft});
      }
      limit.clear();
      detail::add_acceleration_limits(r, me.velocity, limit);
      for (const geometry::HalfPlane& h : limit) problem.constraints.push_back({h, lp::Priority::hard});
      const lp::Solution solution = lp::solve(problem);
      nothing_left += solution.status != lp::Status::optimal;
      me.chosen = solution.velocity;
      me.status = solution.status;
      next.robots[i].position = next.robots[i].anchor = me.position + s.time_step * me.chosen;
      next.robots[i].velocity = next.robots[i].anchor_velocity = me.chosen;
    }
    run.steps.push_back(row);
    row.robots = next.robots;
  }
  row.time = 200 * s.time_step;
  run.steps.push_back(row);
  EXPECT_GT(nothing_left, 50u);
  const datasets::AuditReport report = datasets::audit(file);
  EXPECT_GT(report[datasets::AuditPoint::braking].refuted, nothing_left) << "ways that do not end in time as well";
  const auto says = [&](const char* words) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [&](const std::string& f) { return f.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(says("could not brake without touching each other") || says("relaxes a half-plane"));
}

/// Robots that decide by themselves, each told where the others are and how fast: nothing is relaxed, and all of them
/// can brake in every step.
TEST(Acceleration, NavigatorsKeepBrakingPossible) {
  Scenario s = on_circle(8, 4.0, 1.0);
  s.obstacles.push_back({"post", geometry::Polygon{{{-0.3, -0.2}, {0.2, -0.3}, {0.3, 0.3}}, {}}});
  s.guidance = Guidance::none;
  const double tau = braking_time_of(s);
  std::vector<Navigator> navigators;
  std::vector<NavigatorState> now;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    // Aside of the opposite place, so that they need not wait for each other for ever.
    navigators.emplace_back(navigator_setup(s, i), std::vector<Vec2>{geometry::rotated(s.robots[i].goals[0], 0.6)});
    now.push_back({0.0, s.robots[i].position, {}});
  }
  std::size_t decisions = 0, wishes_changed = 0, arrived = 0;
  for (int k = 0; k < 800; ++k) {
    std::vector<Vec2> chosen;
    for (std::size_t i = 0; i < now.size(); ++i) {
      std::vector<Neighbour> others;
      for (std::size_t j = 0; j < now.size(); ++j)
        if (j != i) others.push_back({j, now[j].position, now[j].velocity, s.robots[j].radius, s.robots[j].max_speed});
      const Decision& d = navigators[i].decide(now[i], others);
      EXPECT_EQ(d.status, lp::Status::optimal) << k << " " << i;
      EXPECT_EQ(d.uncertified, 0u);
      wishes_changed += d.preferred != d.chosen;
      chosen.push_back(d.chosen);
      ++decisions;
      const Point change = exactly(d.chosen) - exactly(now[i].velocity);
      const Rational most = Rational(s.acceleration->max) * Rational(s.time_step);
      EXPECT_LE(dot(change, change), most * most);
    }
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_TRUE(brakes_clear(now[i].position - now[j].position, chosen[i] - chosen[j], tau, 1.0)) << k;
    for (std::size_t i = 0; i < now.size(); ++i)
      now[i] = {(k + 1) * s.time_step, now[i].position + s.time_step * chosen[i], chosen[i]};
  }
  for (const Navigator& n : navigators) arrived += n.has_arrived();
  EXPECT_EQ(decisions, 800u * navigators.size());
  EXPECT_GT(wishes_changed, 100u);
  EXPECT_GE(arrived, navigators.size() / 2);
}

TEST(Acceleration, NavigatorsRefuseWhatTheirProofLacks) {
  const auto words_of = [](const auto& change) -> std::string {
    NavigatorSetup setup;
    setup.max_speed = 1.5;
    setup.acceleration = 1.0;
    change(setup);
    try {
      Navigator navigator(setup, {{6, 0}});
      navigator.decide({0.0, {0, 0}, {0, 0}}, {{1, {3, 0}, {0, 0}, 0.5, 1.5, false}});
    } catch (const NavigatorError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(words_of([](NavigatorSetup&) {}),
            "neighbour 0 cooperates: found false, expected true with an acceleration, a braking_time or a drive");
  EXPECT_NE(words_of([](NavigatorSetup& n) { n.acceleration = -1.0; }).find("acceleration: found -1"),
            std::string::npos);
  EXPECT_NE(words_of([](NavigatorSetup& n) { n.braking_time = 1.4; }).find("braking_time: found 1.4"),
            std::string::npos);
  EXPECT_NE(words_of([](NavigatorSetup& n) { n.horizons.robots = 1.0; }).find("horizons/robots: found 1"),
            std::string::npos);
  EXPECT_NE(words_of([](NavigatorSetup& n) { n.cooperates = false; }).find("cooperates: found false"),
            std::string::npos);
}

/// Slow brakes: the usual horizons, which look less far, are raised as in a scenario, and others are refused.
TEST(Acceleration, NavigatorsLookAheadWhileTheyBrake) {
  NavigatorSetup setup;
  setup.max_speed = 1.5;
  setup.acceleration = 0.4;
  Navigator navigator(setup, {{60, 0}});
  const auto refusal = [&](double max_speed, std::optional<double> braking_time) -> std::string {
    setup.braking_time = braking_time;
    try {
      Navigator(setup, {{60, 0}}).decide({0.0, {0, 0}, {0, 0}}, {{1, {30, 0}, {0, 0}, 0.5, max_speed, true}});
    } catch (const NavigatorError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(1.5, {}), "");
  EXPECT_NE(refusal(1.0, {}).find("neighbour 0 max_speed: found 1, expected the robot's own, or the same braking_time"),
            std::string::npos);
  EXPECT_EQ(refusal(1.0, 5.0), "");
  EXPECT_NE(refusal(2.5, 5.0).find("expected less than braking_time times acceleration, 2 m/s"), std::string::npos);
}

/// A run without an acceleration has no question about braking, and none of its bits is another (determinism_test.cpp
/// has those).
TEST(Acceleration, WithoutItTheAuditAsksNothing) {
  Scenario s = on_circle(3, 3.0, 1.0);
  s.acceleration.reset();
  EXPECT_EQ(braking_time_of(s), 0.0);
  EXPECT_EQ(datasets::audit(recorded(s))[datasets::AuditPoint::braking].asked(), 0u);
}

/// What is done by hand to a recording: each is refuted.
TEST(Acceleration, ForgeriesAreRefuted) {
  const datasets::RecordingFile file = recorded(on_circle(4, 3.0, 1.0));
  const auto refuted = [&](datasets::AuditPoint point, const auto& forge) {
    datasets::RecordingFile forged = file;
    forge(forged);
    return datasets::audit(forged)[point].refuted;
  };
  using datasets::AuditPoint;
  ASSERT_TRUE(datasets::audit(file).clean());
  EXPECT_GT(refuted(AuditPoint::braking, [](auto& f) { f.scenario.acceleration->max *= 0.999; }), 0u);
  EXPECT_GT(refuted(AuditPoint::braking, [](auto& f) { f.scenario.braking_time = 1.0; }), 0u);
  EXPECT_GT(refuted(AuditPoint::braking, [](auto& f) { f.recording.steps[20].robots[1].chosen.x += 0.2; }), 0u);
  EXPECT_GT(refuted(AuditPoint::braking, [](auto& f) { f.recording.steps[9].robots[0].status = lp::Status::relaxed; }),
            0u);
  EXPECT_GT(refuted(AuditPoint::braking,
                    [](auto& f) {
                      for (Robot& r : f.scenario.robots) r.radius += 0.4;
                    }),
            0u)
      << "larger robots could not all have braked";
  // A limit that cuts off more than an acceleration does makes a slower choice the best.
  const auto limit_of = [](auto& f) -> DecisionConstraint& {
    for (Step& step : f.recording.steps)
      for (RobotStep& r : step.robots)
        for (DecisionConstraint& c : r.constraints)
          if (is_own_limit(c)) return c;
    throw std::runtime_error("no limit binds");
  };
  EXPECT_GT(refuted(AuditPoint::half_planes, [&](auto& f) { limit_of(f).half_plane.offset += 0.01; }), 0u);
  EXPECT_GT(refuted(AuditPoint::half_planes, [&](auto& f) { limit_of(f).index += 1; }), 0u);
  EXPECT_GT(refuted(AuditPoint::half_planes, [&](auto& f) { limit_of(f).time_horizon *= 2.0; }), 0u);
  EXPECT_GT(refuted(AuditPoint::choices, [&](auto& f) { limit_of(f).multiplier *= 0.5; }), 0u);
}

// --- What cannot be run ---

std::string problem_at(const Scenario& s, const std::string& pointer) {
  for (const ScenarioProblem& p : validate(s))
    if (p.pointer == pointer) return p.found + "; expected " + p.expected;
  return "";
}

TEST(Acceleration, ValidateSaysWhatToChange) {
  Scenario s = on_circle(3, 3.0, 1.0);
  ASSERT_TRUE(validate(s).empty());
  const auto with = [&](const auto& change) {
    Scenario other = s;
    change(other);
    return other;
  };
  EXPECT_EQ(problem_at(with([](Scenario& o) { o.braking_time = 1.5; }), "/braking_time"),
            "1.5; expected more than the fastest robot needs to stop, its speed divided by its acceleration: 1.5 (s)");
  EXPECT_NE(problem_at(with([](Scenario& o) {
                         o.acceleration.reset();
                         o.braking_time = 2.0;
                       }),
                       "/braking_time"),
            "");
  EXPECT_NE(problem_at(with([](Scenario& o) { o.acceleration->max = 0.0; }), "/acceleration/max"), "");
  EXPECT_NE(
      problem_at(with([](Scenario& o) { o.horizons.robots = 1.6; }), "/horizons/robots").find("needs to stop, 1.65"),
      std::string::npos);
  EXPECT_NE(problem_at(with([](Scenario& o) { o.horizons.most = 1.6; }), "/horizons/most"), "");
  EXPECT_NE(problem_at(with([](Scenario& o) { o.robots[1].cooperates = false; }), "/robots/1/cooperates"), "");
  EXPECT_NE(problem_at(with([](Scenario& o) { o.robots[1].velocity = {1.6, 0.0}; }), "/robots/1/velocity"), "");
  EXPECT_NE(problem_at(
                with([](Scenario& o) {
                  o.moving_obstacles.push_back({"cart", geometry::Polygon{{{9, 9}, {10, 9}, {9, 10}}, {}}, {{{9, 9}}}});
                }),
                "/moving_obstacles/0"),
            "");
  // Heading for a wall, and for another robot, faster than it can stop.
  EXPECT_NE(problem_at(with([](Scenario& o) {
                         o.robots[0].velocity = {1.4, 0.0};
                         o.obstacles.push_back({"wall", geometry::Polyline{{{5.0, -9.0}, {5.0, 9.0}}}});
                       }),
                       "/robots/0/velocity")
                .find("meets an obstacle before it has braked"),
            std::string::npos);
  EXPECT_NE(problem_at(with([](Scenario& o) {
                         o.robots[0].position = {2.0, 2.6};
                         o.robots[0].velocity = {-1.4, 0.0};
                         o.robots[1].position = {-0.2, 2.6};
                       }),
                       "/robots/0/velocity")
                .find("meets robot"),
            std::string::npos);
}

constexpr const char* kText =
    R"({"name": "one", "robots": [{"id": "R1", "position": [0, 0], "max_speed": 1.5, "goal": [4, 0]}],
  "acceleration": {"max": 1.25}, "braking_time": 1.4})";

TEST(Acceleration, ScenariosAreReadAndWritten) {
  const Scenario s = datasets::parse_scenario(kText, "one.json", {});
  ASSERT_TRUE(s.acceleration);
  EXPECT_EQ(s.acceleration->max, 1.25);
  EXPECT_EQ(braking_time_of(s), 1.4);
  const std::string written = datasets::write_scenario(s);
  EXPECT_NE(written.find("\"acceleration\""), std::string::npos);
  EXPECT_EQ(datasets::write_scenario(datasets::parse_scenario(written, "again.json", {})), written);
  EXPECT_EQ(crowd_problems(s).at(0).pointer, "/acceleration");
}

TEST(Acceleration, WrongValuesInAFileAreRefusedWithACode) {
  const auto refusal = [](const std::string& from,
                          const std::string& to) -> std::pair<datasets::DataCode, std::string> {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    try {
      datasets::parse_scenario(text, "one.json", {});
    } catch (const datasets::DataError& e) {
      return {e.code(), e.place()};
    }
    return {datasets::DataCode::cut_off, "was read"};
  };
  using datasets::DataCode;
  EXPECT_EQ(refusal("{\"max\": 1.25}", "1.25").first, DataCode::wrong_type);
  EXPECT_EQ(refusal("1.25", "0").first, DataCode::out_of_range);
  EXPECT_EQ(refusal("\"max\"", "\"most\"").first, DataCode::key_unknown);
  EXPECT_EQ(refusal("1.4", "1.2"), std::pair(DataCode::scenario, std::string("/braking_time")));
  EXPECT_EQ(refusal("\"acceleration\": {\"max\": 1.25}, ", ""),
            std::pair(DataCode::scenario, std::string("/braking_time")));
}

/// Through a file: limits of a robot's own are half-planes of the recording like others.
TEST(Acceleration, RecordingsKeepLimits) {
  const datasets::RecordingFile file = recorded(on_circle(3, 2.0, 1.0));
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("exactvo_acceleration_" + std::to_string(::getpid()) + ".jsonl");
  datasets::write_recording(path, file);
  const datasets::AuditReport report = datasets::audit_recording(path, &file.scenario);
  const datasets::RecordingFile read = datasets::read_recording(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_GT(report[datasets::AuditPoint::braking].proven, file.recording.steps.size());
  EXPECT_EQ(seen_in(read.scenario, read.recording).limited, seen_in(file.scenario, file.recording).limited);
  EXPECT_GT(seen_in(read.scenario, read.recording).limited, 10u);
}

/// A robot that starts with a velocity from which it can just brake.
TEST(Acceleration, AStartAtSpeedIsProvenToo) {
  Scenario s = on_circle(2, 4.0, 1.0);
  s.robots[0].velocity = {-1.5, 0.0};
  s.obstacles.push_back({"wall", geometry::Polyline{{{4.0 - 0.5 - 1.6 * 1.5 - 1e-3, -1.0}, {1.0, 1.0}}}});
  const datasets::RecordingFile file = recorded(s);
  EXPECT_EQ(seen_in(s, file.recording).relaxed, 0u);
  expect_proven(file);
}

}  // namespace
}  // namespace exactvo::formation
