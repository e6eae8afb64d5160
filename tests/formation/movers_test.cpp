// SPDX-License-Identifier: GPL-3.0-or-later
// Robots among movers of which they know the greatest speed only: lemma 8 of docs/guide/accelerations.md by its number,
// in rationals, and whole runs among movers that chase them, by their audit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/run_info.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/stuck.h"
#include "rational_point.h"
#include "scene/braking.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using datasets::AuditPoint;
using datasets::RecordingFile;
using testing::HasSubstr;

/// A vector of length 1, exactly: ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)) or its negative.
Point unit(test::SeededRandom& random) {
  const Rational t(random.uniform(-1.0, 1.0)), square = 1 + t * t, sign(random.integer(0, 1) == 0 ? -1 : 1);
  return {Rational(sign * (1 - t * t) / square), Rational(sign * 2 * t / square)};
}

/// n.a >= r |n| exactly, r >= 0.
bool reaches(const Point& n, const Point& a, const Rational& r) {
  const Rational along = dot(n, a);
  return along >= 0 && along * along >= r * r * dot(n, n);
}

/// Across n the robot at `apart` from the mover is clear of it, and, once it stands, of all that it reaches by then.
bool holds(const Point& n, const Point& apart, const Point& u, int steps, const Rational& step, const Rational& radii,
           const Rational& speed) {
  const Rational k(steps);
  return reaches(n, apart, radii) && reaches(n, apart + Rational((k + 1) / 2 * step) * u, radii + speed * k * step);
}

/// Conditions at both ends hold in between, and again after a step at u and one of braking, wherever the mover went.
TEST(Movers, Lemma8_WhatIsClearAtBothEndsIsClearAllTheWhileAndAfterAStep) {
  test::SeededRandom random(test::seed_of_run(8));
  int clear = 0, approaching = 0, moments = 0, not_at_the_end = 0;
  for (int tries = 0; tries < 20000; ++tries) {
    const int steps = random.integer(1, 12);
    const Rational k(steps), step(random.uniform(0.02, 0.2)), radii(random.uniform(0.1, 0.6));
    const Rational speed(random.uniform(0.0, 0.6));
    const Point n = unit(random), u = exactly(random.in_box(1.0)), apart = exactly(random.in_box(1.5));
    if (!holds(n, apart, u, steps, step, radii, speed)) {
      // The end alone says nothing of the start.
      not_at_the_end += reaches(n, apart, radii);
      continue;
    }
    ++clear;
    approaching += dot(n, u) < 0;
    // Between two of these moments the way is straight and even, so that ends show the rest.
    Point place = apart;
    for (int j = 0; j < steps; ++j, ++moments) {
      place = place + Rational((1 - Rational(j) / k) * step) * u;
      ASSERT_TRUE(reaches(n, place, radii + speed * Rational(j + 1) * step)) << "try " << tries << ", step " << j;
    }
    if (steps == 1) continue;
    const Rational share(random.uniform(0.0, 1.0));
    const Point gone = Rational(share * speed * step) * unit(random);
    ASSERT_TRUE(holds(n, apart + step * u - gone, Rational(1 - 1 / k) * u, steps - 1, step, radii, speed)) << tries;
  }
  std::printf("%d judged, %d of them approaching, %d moments; %d clear at the start alone\n", clear, approaching,
              moments, not_at_the_end);
  EXPECT_GT(clear, 3000);
  EXPECT_GT(approaching, 300);
  EXPECT_GT(moments, 10000);
  EXPECT_GT(not_at_the_end, 1000);
}

/// From a velocity that a half-plane allows down to rest: in each step the one that is made for braking is proven, and
/// braking satisfies it.
TEST(Movers, BrakingSatisfiesTheHalfPlanesOfEveryStepUntilTheRobotStands) {
  test::SeededRandom random(test::seed_of_run(88));
  int begun = 0, judged = 0;
  while (begun < 3000) {
    const double step = random.uniform(0.02, 0.2);
    detail::Mover mover{{random.in_box(2.0), random.uniform(0.1, 0.6)}, random.uniform(0.0, 0.6), 1};
    mover.steps = static_cast<std::size_t>(random.integer(1, 12));
    Vec2 place = random.in_box(2.0), u = random.in_box(0.5);
    const auto is_true = [&](const geometry::HalfPlane& h) {
      const Rational k(mover.steps), r(mover.disc.radius), t(step);
      const Point n = exactly(h.normal), apart = exactly(place) - exactly(mover.disc.center);
      const Rational end = dot(n, apart) + (k + 1) / 2 * t * Rational(h.offset);
      const Rational by_then = r + Rational(mover.speed) * k * t;
      return reaches(n, apart, r) && end >= 0 && end * end >= by_then * by_then * dot(n, n);
    };
    const auto allows = [&](const geometry::HalfPlane& h) {
      return dot(exactly(h.normal), exactly(u)) >= Rational(h.offset);
    };
    const vo::ProvenHalfPlane first = detail::mover_half_plane(step, place, u, mover);
    if (first.proof == vo::Proof::none || !allows(first.half_plane)) continue;
    ++begun;
    ASSERT_TRUE(is_true(first.half_plane));
    for (; mover.steps > 1; ++judged) {
      place += step * u;
      mover.disc.center += (1.0 - 1e-12) * step * mover.speed * random.direction();
      u = (1.0 - 1.0 / static_cast<double>(mover.steps)) * u;
      --mover.steps;
      const vo::ProvenHalfPlane now = detail::mover_half_plane(step, place, u, mover);
      ASSERT_EQ(now.proof, vo::Proof::alone) << begun << ", " << mover.steps << " steps left";
      ASSERT_TRUE(is_true(now.half_plane) && allows(now.half_plane)) << begun;
    }
  }
  EXPECT_GT(judged, 10000);
}

/// The mover comes as fast as it can, and of the skin hardly more is left than roundings of far places need.
TEST(Movers, BrakingIsProvenWhereTheSkinIsAlmostUsedUp) {
  test::SeededRandom random(test::seed_of_run(89));
  int begun = 0;
  for (int tries = 0; tries < 20000; ++tries) {
    const double step = random.uniform(0.02, 0.2), speed = random.uniform(0.05, 0.5);
    detail::Mover mover{
        {random.in_box(2.0) + Vec2{1000.0, 0.0}, random.uniform(0.1, 0.6)}, random.uniform(0.0, 0.6), 1};
    mover.steps = static_cast<std::size_t>(random.integer(2, 12));
    const Vec2 away = random.direction();
    Vec2 u = -speed * away;
    const double steps = static_cast<double>(mover.steps), room = random.uniform(1.0, 3.0) * 0x1p-45 * 2006.0;
    const double apart =
        mover.disc.radius + mover.speed * steps * step + detail::way_time(step, mover.steps) * speed + room;
    Vec2 place = mover.disc.center + apart * away;
    const auto is_allowed = [&] {
      const vo::ProvenHalfPlane h = detail::mover_half_plane(step, place, u, mover);
      return h.proof != vo::Proof::none && dot(h.half_plane.normal, u) >= h.half_plane.offset;
    };
    if (!is_allowed()) continue;
    ++begun;
    while (mover.steps > 1) {
      place += step * u;
      mover.disc.center += (1.0 - 1e-12) * step * mover.speed * away;
      u = (1.0 - 1.0 / static_cast<double>(mover.steps)) * u;
      --mover.steps;
      ASSERT_TRUE(is_allowed()) << "try " << tries << ", " << mover.steps << " steps left";
    }
  }
  EXPECT_GT(begun, 1000);
}

constexpr double kStep = 0.1, kSpeed = 0.155, kRadius = 0.185;

/// To and fro, as the reference point of a TurtleBot3.
Scenario to_and_fro() {
  Scenario s;
  s.name = "movers";
  s.time_step = kStep;
  s.time_limit = 30.0;
  s.margins.robot = 0.0;
  s.acceleration = Acceleration{0.45};
  Robot r;
  r.id = "R1";
  r.position = {-1.5, 0.0};
  r.radius = kRadius;
  r.max_speed = kSpeed;
  for (int k = 0; k < 4; ++k) r.goals.insert(r.goals.end(), {{1.5, 0.0}, {-1.5, 0.0}});
  s.robots.push_back(r);
  return s;
}

/// At 8 s people are so near that the robot may do nothing else.
TEST(Movers, ARobotThatHasToStandIsGivenThatReason) {
  Scenario s = datasets::load_scenario(EXACTVO_SOURCE_DIR "/datasets/data/robots/burger_movers.json");
  s.time_limit = 8.1;
  const std::vector<StuckReport> stuck = explain_stuck(s, simulate(s));
  ASSERT_EQ(stuck.size(), 1u);
  EXPECT_THAT(stuck[0].text, HasSubstr("it stands, since a moving obstacle could reach it while it moves"));
}

RecordingFile recorded(const Scenario& s) {
  return {datasets::run_info(s, {}, {}), s, simulate(s)};
}

/// Movers that turn at random, and head for the robot in 30 % of their steps; after they have met it, away from it for
/// a while. How the robot drives is found by running what there is so far: half a second more each time.
Scenario chased(Scenario s, std::uint64_t seed, double speed) {
  constexpr int kStepsAtOnce = 5;
  test::SeededRandom random(seed);
  struct Chaser {
    Vec2 place;
    double course;
    int leaves = 0;
    std::vector<TimedVelocity> velocities = {};
  };
  std::vector<Chaser> chasers;
  while (chasers.size() < 4) {
    const Vec2 place = random.in_box(1.0);
    if (norm(place - s.robots.front().position) > 0.8) chasers.push_back({place, random.uniform(0.0, 6.28)});
  }
  const double limit = s.time_limit;
  std::vector<Vec2> starts;
  for (const Chaser& c : chasers) starts.push_back(c.place);
  const auto until = [&](double end) {
    Scenario now = s;
    now.time_limit = end;
    for (std::size_t k = 0; k < chasers.size(); ++k) {
      const bool rests = chasers[k].velocities.empty() || speed == 0.0;
      TimedPath way = rests ? TimedPath{{{0.0, 0.0}}} : path_of({}, chasers[k].velocities, limit + kStep);
      now.moving_obstacles.push_back(moving_disc("M" + std::to_string(k + 1), {starts[k], kRadius}, std::move(way)));
      now.moving_obstacles.back().max_speed = speed;
    }
    return now;
  };
  for (double time = 0.0; time < limit - 0.5 * kStep; time += kStepsAtOnce * kStep) {
    const Vec2 robot =
        time == 0.0 ? s.robots.front().position : simulate(until(time)).steps.back().robots.front().position;
    for (Chaser& c : chasers)
      for (int k = 0; k < kStepsAtOnce; ++k) {
        c.course += random.uniform(-0.5, 0.5);
        const Vec2 towards = robot - c.place;
        if (norm(towards) < 2.0 * kRadius) c.leaves = 20;
        const bool chases = random.uniform(0.0, 1.0) < 0.3;
        Vec2 way{std::cos(c.course), std::sin(c.course)};
        if (c.leaves > 0)
          way = towards == Vec2{} ? way : -geometry::normalized(towards);
        else if (chases && towards != Vec2{})
          way = geometry::normalized(towards);
        c.leaves = std::max(0, c.leaves - 1);
        const Vec2 v = (1.0 - 1e-9) * speed * way;
        c.velocities.push_back({time + k * kStep, v});
        c.place += kStep * v;
      }
  }
  return until(limit);
}

/// Runs of 30 s among four movers: EXACTVO_MOVER_RUNS of each speed, 20 in docs/measurements/runs.md.
TEST(Movers, NoRobotThatMovesIsHitAmongMoversThatChaseIt) {
  const std::uint64_t seed = test::seed_of_run(20);
  const char* asked = std::getenv("EXACTVO_MOVER_RUNS");
  const std::uint64_t runs = asked ? std::strtoull(asked, nullptr, 10) : 2;
  std::size_t hits = 0;
  for (const double speed : {0.0, 0.1, 0.22, 0.5}) {
    std::size_t moving = 0, standing = 0, relaxed = 0, decisions = 0;
    double way = 0.0, full = 0.0;
    for (std::uint64_t run = 0; run < runs; ++run) {
      const RecordingFile file = recorded(chased(to_and_fro(), seed + run, speed));
      const Metrics m = measure(file.scenario, file.recording);
      const auto stood = static_cast<std::size_t>(
          std::count_if(m.collisions.begin(), m.collisions.end(), [](const Collision& c) { return c.standing; }));
      standing += stood;
      moving += m.collisions.size() - stood;
      relaxed += m.relaxed_steps + m.uncertified_half_planes;
      way += m.robots.front().path_length;
      full += m.time * kSpeed;
      decisions += m.steps;
      const datasets::AuditReport report = audit(file);
      ASSERT_TRUE(report.clean()) << speed << ", run " << run << ": "
                                  << (report.findings.empty() ? "" : report.findings.front());
      EXPECT_EQ(report.hits_standing > 0, stood > 0) << speed << ", run " << run;
      EXPECT_GT(report[AuditPoint::braking].proven, 4 * m.steps);
    }
    std::printf(
        "U = %.2f m/s: %zu decisions, %zu relaxed; hit while moving %zu, while standing %zu times; %.1f m of %.1f m\n",
        speed, decisions, relaxed, moving, standing, way, full);
    EXPECT_EQ(moving, 0u) << speed;
    EXPECT_EQ(relaxed, 0u) << speed;
    EXPECT_EQ(decisions, runs * 300) << speed;
    EXPECT_GT(way, 0.3 * full) << speed;
    hits += standing;
  }
  EXPECT_GT(hits, runs) << "movers that chase hardly met anything";
}

/// Robots that measure each other keep to their own sides whenever they stand.
TEST(Movers, SeveralRobotsThatMeasureEachOtherAmongWallsAndMoversAreProven) {
  Scenario s = to_and_fro();
  s.uncertainty = Uncertainty{0.01, Measurements{0.02, 0.05, 0.1}};
  s.obstacles.push_back({"pillar", geometry::Polygon{{{-0.1, 0.5}, {0.1, 0.5}, {0.1, 0.7}, {-0.1, 0.7}}, {}}});
  s.obstacles.push_back({"wall", geometry::Polyline{{{-2.5, -1.6}, {2.5, -1.6}}}});
  keep_within_tube(s.robots.front(), kRadius, 0.01);
  for (const Vec2 from : {Vec2{0.0, -1.2}, Vec2{1.8, 0.6}}) {
    Robot r = s.robots.front();
    r.id = "R" + std::to_string(s.robots.size() + 1);
    r.position = from;
    r.goals = {-from, from, -from};
    s.robots.push_back(r);
  }
  std::size_t moved = 0, standing = 0;
  for (std::uint64_t run = 0; run < 2; ++run) {
    Scenario scene = chased(to_and_fro(), 40 + run, 0.22);
    s.moving_obstacles = scene.moving_obstacles;
    if (!validate(s).empty()) continue;  // a mover starts on a robot
    const RecordingFile file = recorded(s);
    const datasets::AuditReport report = audit(file);
    EXPECT_TRUE(report.clean()) << run << ": " << (report.findings.empty() ? "" : report.findings.front());
    standing += report.hits_standing;
    for (const Step& row : file.recording.steps)
      for (const RobotStep& r : row.robots) {
        EXPECT_EQ(r.status, lp::Status::optimal);
        moved += r.stopping_steps > 0;
      }
  }
  std::printf("%zu choices of robots that move; %zu steps in which some stood and were hit\n", moved, standing);
  EXPECT_GT(moved, 500u);
}

/// It drives towards a mover that may come, and stands before that.
TEST(Movers, ARobotThatStartsWithAVelocityStandsInTime) {
  Scenario s = to_and_fro();
  s.robots.front().velocity = {kSpeed, 0.0};
  s.time_limit = 5.0;
  // After 4 steps it has driven 2.5 steps at its first velocity, and the mover 4 at its own.
  for (const double spare : {1e-4, -1e-3}) {
    const double gap = (2.5 - 1.0) * kStep * kSpeed + 0.2 * 3 * kStep + spare;
    s.moving_obstacles = {moving_disc("M1", {{-1.5 + 2 * kRadius + gap, 0.0}, kRadius},
                                      path_of({}, {{0.0, {-0.2, 0.0}}, {2.0, {0.2, 0.0}}}, 6.0))};
    s.moving_obstacles.front().max_speed = 0.2;
    EXPECT_EQ(validate(s).empty(), spare > 0.0);
    if (spare < 0.0) continue;
    const RecordingFile file = recorded(s);
    const datasets::AuditReport report = audit(file);
    EXPECT_TRUE(report.clean()) << (report.findings.empty() ? "" : report.findings.front());
    EXPECT_EQ(file.recording.steps.front().robots.front().stopping_steps, 3u);
    EXPECT_GT(report.hits_standing, 0u);
  }
}

/// A robot that takes movers to keep their velocities is run over while it moves.
TEST(Movers, TheAuditRefusesARobotThatTouchesAMoverWhileItMoves) {
  std::size_t refuted = 0, hit = 0;
  for (const std::uint64_t run : {0, 1, 2, 3, 4, 5}) {
    const Scenario meant = chased(to_and_fro(), 20 + run, 0.5);
    Scenario blind = meant;
    blind.acceleration.reset();
    for (MovingObstacle& mover : blind.moving_obstacles) mover.max_speed.reset();
    RecordingFile file = recorded(blind);
    const bool was_hit = audit(file)[AuditPoint::motions].refuted > 0;
    file.scenario = meant;
    const datasets::AuditReport report = audit(file);
    EXPECT_FALSE(report.clean());
    EXPECT_GT(report[AuditPoint::braking].refuted, 0u);
    refuted += report[AuditPoint::motions].refuted > 0;
    hit += was_hit;
  }
  std::printf("%zu runs in which the robot was hit while it moved, %zu refused for it\n", hit, refuted);
  EXPECT_EQ(refuted, hit);
  EXPECT_GE(hit, 2u);
}

TEST(Movers, TheAuditRefusesEditsOfWhatHoldsMoversOff) {
  const RecordingFile file = recorded(chased(to_and_fro(), 23, 0.22));
  ASSERT_TRUE(audit(file).clean());
  int fewer = 0, nearer = 0, other_horizons = 0, dropped = 0;
  for (std::size_t row = 0; row + 1 < file.recording.steps.size() && fewer < 4; ++row) {
    const RobotStep& chosen = file.recording.steps[row].robots.front();
    const auto refuses = [&](RobotStep step, AuditPoint point) {
      RecordingFile forged = file;
      forged.recording.steps[row].robots.front() = std::move(step);
      return audit(forged)[point].refuted > 0;
    };
    const auto binds = std::find_if(
        chosen.constraints.begin(), chosen.constraints.end(),
        [](const DecisionConstraint& c) { return c.source == ConstraintSource::moving_obstacle && c.active; });
    if (binds == chosen.constraints.end()) continue;
    RobotStep step = chosen;
    step.stopping_steps += 1;  // then the mover gets farther
    EXPECT_TRUE(refuses(step, AuditPoint::half_planes)) << row;
    ++fewer;
    step = chosen;
    step.constraints[static_cast<std::size_t>(binds - chosen.constraints.begin())].half_plane.offset -= 1e-3;
    EXPECT_TRUE(refuses(step, AuditPoint::half_planes)) << row;
    ++nearer;
    // Nothing is decided by it, but the page and `explain` print it.
    constexpr double kBy[] = {0x1p-52, 1e-3, -0.5, -1.0};
    step = chosen;
    step.constraints[static_cast<std::size_t>(binds - chosen.constraints.begin())].time_horizon *=
        1.0 + kBy[other_horizons];
    EXPECT_TRUE(refuses(step, AuditPoint::half_planes)) << row << ", " << kBy[other_horizons];
    ++other_horizons;
    step = chosen;
    step.stopping_steps = 0;
    EXPECT_TRUE(refuses(step, AuditPoint::braking)) << row;
    ++dropped;
  }
  std::printf("%d edits of steps, %d of offsets, %d of horizons, %d of what stands\n", fewer, nearer, other_horizons,
              dropped);
  EXPECT_EQ(fewer, 4);
}

TEST(Movers, OutcomeSaysWhatIsAssumedAndThatRobotsStood) {
  const RecordingFile file = recorded(chased(to_and_fro(), 21, 0.5));
  const Metrics m = measure(file.scenario, file.recording);
  EXPECT_THAT(m.outcome, HasSubstr("assumed: no moving obstacle is faster than its max_speed, 0.5 m/s at most: then no "
                                   "robot that moves touches one, and nothing is promised to a robot that stands"));
  ASSERT_FALSE(m.collisions.empty());
  EXPECT_THAT(m.outcome, HasSubstr("robots that stood were hit by moving obstacles"));
  EXPECT_THAT(m.outcome, testing::Not(HasSubstr("COLLISION")));
  EXPECT_THAT(not_audited(audit(file)), testing::Contains(HasSubstr("no faster than their max_speed")));
}

TEST(Movers, ScenariosThatPromiseNothingAreRefused) {
  const Scenario good = chased(to_and_fro(), 20, 0.22);
  ASSERT_TRUE(validate(good).empty());
  const auto refused = [&](const auto& edit) {
    Scenario s = good;
    edit(s);
    const std::vector<ScenarioProblem> problems = validate(s);
    return problems.empty()
               ? std::string("none")
               : problems.front().pointer + ": " + problems.front().found + "; " + problems.front().expected;
  };
  const std::string speed = "/moving_obstacles/0/max_speed: ";
  EXPECT_THAT(refused([](Scenario& s) { s.acceleration.reset(); }), HasSubstr(speed + "robots without /acceleration"));
  EXPECT_THAT(refused([](Scenario& s) { s.moving_obstacles[0].max_speed = -0.1; }), HasSubstr(speed + "-0.1"));
  for (const double no_number : {std::numeric_limits<double>::quiet_NaN(), geometry::kInfinity})
    EXPECT_THAT(refused([&](Scenario& s) { s.moving_obstacles[0].max_speed = no_number; }),
                HasSubstr("a finite number, 0 or more (m/s)"));
  EXPECT_THAT(refused([](Scenario& s) { s.moving_obstacles[0].max_speed = 0.2; }), HasSubstr("at most its max_speed"));
  EXPECT_THAT(refused([](Scenario& s) { s.moving_obstacles[0].disc.reset(); }), HasSubstr("a disc that holds it"));
  EXPECT_THAT(refused([](Scenario& s) { s.moving_obstacles[1].max_speed.reset(); }),
              HasSubstr("/moving_obstacles/1: no max_speed"));
  EXPECT_THAT(refused([](Scenario& s) {
                s.robots.push_back(s.robots[0]);
                s.robots[1].position = {-3.0, 0.0};
              }),
              HasSubstr("/uncertainty/measurements"));
  for (const double least : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT(refused([&](Scenario& s) { s.acceleration->max = least; }), HasSubstr("/acceleration/max"));
  EXPECT_THAT(refused([](Scenario& s) { s.acceleration->max = 1e-300; }), HasSubstr("/horizons/most"));
  EXPECT_THAT(refused([](Scenario& s) {
                s.robots[0].velocity = {0.155, 0.0};  // braking, it drives 0.023 m and meets the mover after 0.02 m
                s.moving_obstacles[0] = moving_disc("M1", {{-1.5 + 2 * kRadius + 0.02, 0.0}, kRadius}, {{{0.0, 0.0}}});
                s.moving_obstacles[0].max_speed = 0.0;
              }),
              HasSubstr("/robots/0/velocity: [0.155, 0], at which moving obstacle 'M1' may meet it before it stands"));
  EXPECT_THAT(refused([](Scenario& s) { s.braking_time = 0.36; }), HasSubstr("/braking_time: 0.36; the 4 time steps"));
}

TEST(Movers, TheirSpeedIsReadAndWrittenAgain) {
  const Scenario s = chased(to_and_fro(), 20, 0.22);
  const std::string text = datasets::write_scenario(s);
  EXPECT_THAT(text, HasSubstr("\"max_speed\": 0.22"));
  EXPECT_EQ(datasets::write_scenario(datasets::parse_scenario(text, "movers.json", ".")), text);
}

}  // namespace
}  // namespace exactvo::formation
