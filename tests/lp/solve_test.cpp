// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"

namespace exactvo::lp {
namespace {

/// Answers are rounded inward by at most 24 u V times the sharpness of the vertex, which is below 10 in these cases.
constexpr double kRounding = 1e-13;

Problem in_disc(double disc, Vec2 preferred) {
  Problem problem;
  problem.bound.disc = disc;
  problem.preferred = preferred;
  return problem;
}

void add(Problem& problem, Vec2 normal, double offset, Priority priority = Priority::hard) {
  problem.constraints.push_back({{normal, offset}, priority, -1});
}

void expect_at(const Solution& solution, Status status, Vec2 v) {
  EXPECT_STREQ(name(solution.status), name(status));
  EXPECT_NEAR(solution.velocity.x, v.x, kRounding);
  EXPECT_NEAR(solution.velocity.y, v.y, kRounding);
}

TEST(Solve, WithoutConstraintsReturnsThePreferredVelocityItself) {
  const Solution s = solve(in_disc(2.0, {2.0, 0.0}));
  EXPECT_EQ(s.velocity.x, 2.0);
  EXPECT_EQ(s.active_count, 0u);
}

TEST(Solve, ProjectsOntoTheDisc) {
  const Solution s = solve(in_disc(2.0, {3.0, 4.0}));
  expect_at(s, Status::optimal, {1.2, 1.6});
  EXPECT_EQ(s.active[0].binding, kDisc);
}

TEST(Solve, ProjectsOntoALine) {
  Problem p = in_disc(2.0, {1.0, 1.0});
  add(p, {-1.0, 0.0}, -0.5);
  const Solution s = solve(p);
  expect_at(s, Status::optimal, {0.5, 1.0});
  EXPECT_EQ(s.active_count, 1u);
  EXPECT_LE(s.velocity.x, 0.5);
}

TEST(Solve, StopsAtTheVertexOfTwoLines) {
  Problem p = in_disc(2.0, {1.0, 1.0});
  add(p, {-1.0, 0.0}, -0.5);
  add(p, {0.0, -1.0}, -0.25);
  expect_at(solve(p), Status::optimal, {0.5, 0.25});
}

TEST(Solve, StopsWhereLineAndDiscMeet) {
  Problem p = in_disc(1.0, {0.0, 5.0});
  add(p, {1.0, 0.0}, 0.6);
  expect_at(solve(p), Status::optimal, {0.6, 0.8});
}

TEST(Solve, KeepsTheBoxExactly) {
  Problem p;
  p.bound.box_x = 1.0 / 3.0;
  p.bound.box_y = 0.1;
  p.preferred = {5.0, -7.0};
  const Solution s = solve(p);
  EXPECT_EQ(s.velocity.x, 1.0 / 3.0);
  EXPECT_EQ(s.velocity.y, -0.1);
}

TEST(Solve, KeepsDiscAndBoxAtOnce) {
  Problem p = in_disc(1.0, {5.0, 4.0});
  p.bound.box_x = 0.6;
  expect_at(solve(p), Status::optimal, {0.6, 0.8});
}

TEST(Solve, MaximisesALinearObjective) {
  Problem p = in_disc(1.0, {0.0, 3.0});
  p.objective = Objective::farthest;
  expect_at(solve(p), Status::optimal, {0.0, 1.0});
  add(p, {0.0, -1.0}, -0.5);
  expect_at(solve(p), Status::optimal, {0.0, 0.5});
}

TEST(Solve, RelaxesSoftConstraintsEvenly) {
  Problem p = in_disc(2.0, {0.0, 1.0});
  add(p, {1.0, 0.0}, 0.5, Priority::soft);
  add(p, {-1.0, 0.0}, 0.1, Priority::soft);
  const Solution s = solve(p);
  expect_at(s, Status::relaxed, {0.2, 1.0});  // the whole line x = 0.2 is equally bad; (0.2, 1) is nearest
  EXPECT_NEAR(s.violation, 0.3, kRounding);
}

TEST(Solve, RelaxesThreeSoftConstraintsToTheirMiddle) {
  Problem p = in_disc(2.0, {1.0, 1.0});
  add(p, {0.0, 1.0}, 1.0, Priority::soft);
  add(p, {0.8, -0.6}, 1.0, Priority::soft);
  add(p, {-0.8, -0.6}, 1.0, Priority::soft);
  const Solution s = solve(p);
  expect_at(s, Status::relaxed, {0.0, 0.0});
  EXPECT_NEAR(s.violation, 1.0, kRounding);
  EXPECT_EQ(s.active_count, 3u);
}

TEST(Solve, HardConstraintsHoldWhereSoftOnesGive) {
  Problem p = in_disc(2.0, {0.0, 0.0});
  add(p, {1.0, 0.0}, 1.0, Priority::soft);
  add(p, {-1.0, 0.0}, 0.5, Priority::hard);
  const Solution s = solve(p);
  expect_at(s, Status::relaxed, {-0.5, 0.0});
  EXPECT_LE(s.velocity.x, -0.5);
  EXPECT_NEAR(s.violation, 1.5, kRounding);
}

TEST(Solve, SoftConstraintBeyondTheDiscGoesAsNearAsItCan) {
  Problem p = in_disc(1.0, {0.0, -1.0});
  add(p, {0.6, 0.8}, 3.0, Priority::soft);
  const Solution s = solve(p);
  expect_at(s, Status::relaxed, {0.6, 0.8});
  EXPECT_NEAR(s.violation, 2.0, kRounding);
}

// A hard wall opposite a soft one: the whole wall violates the soft one alike, and of it the nearest is wanted.
TEST(Solve, AmongVelocitiesThatViolateLeastTheNearestIsTaken) {
  Problem p = in_disc(3.0, {-1.35, 0.98});
  add(p, {0.8, -0.6}, 0.39, Priority::soft);
  add(p, {0.0, 1.0}, 1.12, Priority::soft);
  add(p, {-0.8, 0.6}, 0.87, Priority::hard);
  EXPECT_LT(norm(solve(p).velocity - Vec2{-0.7116, 0.5012}), 1e-9);
  Problem longer = in_disc(10.0, {-11.0, 7.0});
  add(longer, {6.0, -2.0}, 4.0, Priority::soft);
  add(longer, {-42.0, 14.0}, 28.0, Priority::hard);
  EXPECT_LT(norm(solve(longer).velocity - Vec2{0.4, 3.2}), 1e-9);
}

TEST(Solve, OppositeConstraintsOfEveryKindAreAnsweredAsByExactArithmetic) {
  constexpr unsigned kSeed = 20;
  std::mt19937 random(kSeed);
  const Vec2 directions[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {0.6, 0.8}, {-0.6, -0.8}, {0.8, -0.6}, {-0.8, 0.6}};
  std::uniform_int_distribution<int> count(2, 6), direction(0, 7), kind(0, 2), length(0, 3);
  std::uniform_real_distribution<double> offset(-1.0, 1.5), wish(-3.0, 3.0);
  std::size_t relaxed = 0, infeasible = 0;
  for (int k = 0; k < 4000; ++k) {
    Problem p = in_disc(3.0, {wish(random), wish(random)});
    for (int m = count(random); m > 0; --m) {
      const double size = std::ldexp(1.0, length(random) == 0 ? 3 : 0);
      add(p, size * directions[direction(random)], size * offset(random),
          kind(random) == 0 ? Priority::hard : Priority::soft);
    }
    const Solution s = solve(p), exact = solve_exact(p).solution;
    ASSERT_STREQ(name(s.status), name(exact.status)) << "problem " << k << " of seed " << kSeed;
    ASSERT_LT(norm(s.velocity - exact.velocity), 1e-9) << "problem " << k << " of seed " << kSeed;
    relaxed += s.status == Status::relaxed;
    infeasible += s.status == Status::infeasible;
  }
  EXPECT_GT(relaxed, 1000u);
  EXPECT_GT(infeasible, 100u);
}

// A component of 2^-1000 is more than nothing.
TEST(Solve, NormalsOfVeryDifferentLengthsKeepTheirSmallComponents) {
  Problem p = in_disc(10.0, {0.0, -1.0});
  add(p, {0.0, -0x1p290}, -5.0 * 0x1p290);
  add(p, {1.0, 0x1p-1000}, 1.0);
  const Proven answer = solve_exact(p);
  ASSERT_EQ(answer.solution.status, Status::optimal);
  EXPECT_TRUE(answer.certificate);
  for (const Constraint& c : p.constraints) EXPECT_LE(geometry::violation(c.half_plane, answer.solution.velocity), 0.0);
  Problem flat = in_disc(1000.0, {0.0, 0.0});
  add(flat, {1e-308, 0.0}, 1e-306);
  const Solution s = solve(flat);
  for (std::size_t k = 0; k < s.active_count; ++k) EXPECT_TRUE(std::isfinite(s.active[k].multiplier));
}

// One exponent cannot bring both near 1, and their product leaves the doubles.
TEST(Solve, ExactAnswersToNormalsOfVeryDifferentLengthsAreThoseToUnitNormals) {
  std::size_t solved = 0;
  for (const int longer : {0, 99, 200})
    for (const int shorter : {-50, -300, -420, -900}) {
      Problem p = in_disc(2.0, {-1.0, 0.3});
      const double a = std::ldexp(1.0, longer), b = std::ldexp(1.0, shorter);
      add(p, {a, 0.25 * a}, -0.5 * a);
      add(p, {0.7 * b, -0.9 * b}, 0.1 * b);
      const Proven answer = solve_exact(p);
      ASSERT_STREQ(name(answer.solution.status), "optimal") << longer << ' ' << shorter;
      EXPECT_NEAR(answer.solution.velocity.x, -0.39534883720930231, 1e-15);
      EXPECT_NEAR(answer.solution.velocity.y, -0.41860465116279066, 1e-15);
      ASSERT_TRUE(answer.certificate);
      EXPECT_EQ(check(p, *answer.certificate), CertificateError::none);
      ++solved;
    }
  EXPECT_EQ(solved, 12U);
}

// The coordinate of the answer is subnormal, and a long normal multiplies what rounding takes from it.
TEST(Solve, LongNormalsBesideSubnormalVelocitiesEnd) {
  std::size_t ended = 0;
  for (const double length : {1e200, 1e300}) {
    const double u = length * std::numeric_limits<double>::denorm_min();
    for (const Priority second : {Priority::hard, Priority::soft}) {
      Problem p = in_disc(1.0, {-1.0, 0.0});
      add(p, {length, 0.0}, 1.3 * u);
      add(p, {second == Priority::hard ? length : -length, 0.0}, (second == Priority::hard ? 1.4 : -1.2) * u, second);
      for (const Solution& s : {solve(p), solve_exact(p).solution}) {
        EXPECT_GE(length * s.velocity.x, 1.0 * u);
        EXPECT_LE(s.velocity.x, 1e-14);
        ++ended;
      }
    }
  }
  EXPECT_EQ(ended, 8U);
}

TEST(Solve, ContradictingHardConstraintsAreInfeasible) {
  Problem p = in_disc(2.0, {0.0, 0.0});
  add(p, {1.0, 0.0}, 1.0);
  add(p, {-1.0, 0.0}, 0.5);
  add(p, {0.0, 1.0}, 5.0, Priority::soft);
  const Solution s = solve(p);
  expect_at(s, Status::infeasible, {0.25, 0.0});
  EXPECT_NEAR(s.violation, 0.75, kRounding);
}

TEST(Solve, HardConstraintBeyondTheBoxIsInfeasible) {
  Problem p;
  p.bound.box_x = p.bound.box_y = 1.0;
  add(p, {1.0, 0.0}, 2.0);
  const Solution s = solve(p);
  expect_at(s, Status::infeasible, {1.0, 0.0});
  EXPECT_LE(s.velocity.x, 1.0);
}

TEST(Solve, NamesTheCallersMistakes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Problem p = in_disc(2.0, {nan, 0.0});
  EXPECT_THROW(solve(p), std::logic_error);
  p = in_disc(-1.0, {0.0, 0.0});
  EXPECT_THROW(solve(p), std::logic_error);
  p = in_disc(nan, {0.0, 0.0});
  EXPECT_THROW(solve(p), std::logic_error);
  p = in_disc(2.0, {0.0, 0.0});
  add(p, {0.0, 0.0}, 1.0);
  EXPECT_THROW(solve(p), std::logic_error);
  p.constraints[0].half_plane = {{1.0, 0.0}, std::numeric_limits<double>::infinity()};
  EXPECT_THROW(solve(p), std::logic_error);
  Problem unbounded;
  unbounded.preferred = {1.0, 0.0};
  unbounded.objective = Objective::farthest;
  EXPECT_THROW(solve(unbounded), std::logic_error);
}

/// The bounds of the speed among what a solution says binds.
std::size_t bounds_that_bind(const Solution& s) {
  return static_cast<std::size_t>(std::count_if(s.active.begin(), s.active.begin() + s.active_count,
                                                [](const auto& a) { return is_speed_bound(a.binding); }));
}

TEST(Solve, NamesNoSpeedBoundThatDoesNotBind) {
  Problem between;  // two walls and no bound at all
  between.constraints = {{{{1.0, 0.0}, 1.0}, Priority::hard, -1}, {{{-1.0, 0.0}, 1.0}, Priority::soft, -1}};
  EXPECT_EQ(bounds_that_bind(solve(between)), 0u);
  Problem beyond;  // a wall outside the box, to be neared as far as the right side lets it be
  beyond.bound.box_x = beyond.bound.box_y = 1.0;
  beyond.constraints = {{{{1.0, 0.0}, 10.0}, Priority::hard, -1}};
  const Solution s = solve(beyond);
  EXPECT_EQ(bounds_that_bind(s), 1u);
  EXPECT_EQ(std::count_if(s.active.begin(), s.active.begin() + s.active_count,
                          [](const auto& a) { return a.binding.kind == BindingKind::box_right; }),
            1);
}

/// Without the constraints that hold at `v` with room to spare.
Problem without_those_with_room(const Problem& problem, geometry::Vec2 v, std::size_t& left_out) {
  constexpr double kRoom = 1e-6;
  Problem part = problem;
  part.constraints.clear();
  for (const Constraint& c : problem.constraints) {
    const bool has_room = violation(c.half_plane, v) < -kRoom;
    if (!has_room) part.constraints.push_back(c);
    left_out += has_room;
  }
  return part;
}

TEST(Solve, WithoutConstraintsThatHaveRoomAnOptimumHasTheSameBits) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> angle(0.0, 6.283), offset(-1.2, 0.4), length(0.5, 2.0);
  std::size_t of_two = 0, left_out = 0;
  for (int k = 0; k < 3000; ++k) {
    Problem problem = in_disc(1.2, {1.5 * std::cos(angle(random)), std::sin(angle(random))});
    for (int i = 0; i < 12; ++i) {
      const double a = angle(random), n = k % 2 == 0 ? 1.0 : length(random);
      add(problem, {n * std::cos(a), n * std::sin(a)}, n * offset(random),
          i % 4 == 3 ? Priority::soft : Priority::hard);
    }
    SolveMemory memory;
    Solution whole, part;
    if (!solve(problem, memory, whole) || whole.status != Status::optimal) continue;
    ASSERT_TRUE(solve(without_those_with_room(problem, whole.velocity, left_out), memory, part));
    EXPECT_EQ(part.velocity, whole.velocity);
    EXPECT_EQ(part.status, whole.status);
    ASSERT_EQ(part.active_count, whole.active_count);
    for (std::size_t i = 0; i < whole.active_count; ++i)
      EXPECT_EQ(part.active[i].multiplier, whole.active[i].multiplier);
    of_two += whole.active_count == 2;
  }
  EXPECT_GT(of_two, 300u);
  EXPECT_GT(left_out, 3000u);
}

}  // namespace
}  // namespace exactvo::lp
