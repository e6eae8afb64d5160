// SPDX-License-Identifier: GPL-3.0-or-later
// What a solution says of itself: what binds, how strongly, and that this proves it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "problem_kinds.h"
#include "problem_text.h"

namespace exactvo::lp {
namespace {

using test::SeededRandom;

constexpr int kPerKind = 100;

/// Vertices as sharp as 10^-4 rad make multipliers of 10^4, and a slack of 10^-15 that much larger.
constexpr double kStationary = 1e-7;

Vec2 side_normal(BindingKind side) {
  switch (side) {
    case BindingKind::box_right:
      return {-1.0, 0.0};
    case BindingKind::box_left:
      return {1.0, 0.0};
    case BindingKind::box_top:
      return {0.0, -1.0};
    default:
      return {0.0, 1.0};
  }
}

Vec2 pull_of(const Problem& problem, const Solution& s, const ActiveConstraint& a) {
  if (a.binding == kDisc) return -a.multiplier * s.velocity;
  return a.multiplier * (is_speed_bound(a.binding) ? side_normal(a.binding.kind)
                                                   : problem.constraints[a.binding.index].half_plane.normal);
}

/// By how much the equation of solution.h is missed, as a share of its largest term and at least of 1.
double missed(const Problem& problem, const Solution& s) {
  Vec2 sum;
  double largest = 1.0;
  for (std::size_t k = 0; k < s.active_count; ++k) {
    const Vec2 pull = pull_of(problem, s, s.active[k]);
    sum = sum + pull;
    largest = std::max(largest, norm(pull));
  }
  if (s.status == Status::optimal)
    sum = sum - (problem.objective == Objective::nearest ? s.velocity - problem.preferred : -problem.preferred);
  return norm(sum) / largest;
}

template <class Check>
void for_each_kind(std::uint64_t seed, Check check) {
  SeededRandom random(test::seed_of_run(seed));
  for (const ProblemKind& kind : well_formed_kinds())
    for (int k = 0; k < kPerKind; ++k) check(random_problem(kind, random));
}

TEST(Multipliers, MakeTheVelocityStationaryForEveryKind) {
  for_each_kind(81, [](const Problem& problem) {
    for (const Solver solver : {Solver::batch, Solver::certified, Solver::exact}) {
      const Solution s = solve_all(solver, {problem}).front().solution;
      EXPECT_LE(missed(problem, s), kStationary) << name(solver) << ' ' << name(s.status) << '\n' << text_of(problem);
      for (std::size_t k = 0; k < s.active_count; ++k) EXPECT_GE(s.active[k].multiplier, 0.0) << text_of(problem);
    }
  });
}

TEST(Multipliers, OfARelaxedAnswerWeightAViolatedConstraint) {
  for_each_kind(82, [](const Problem& problem) {
    const Solution s = solve(problem);
    if (s.status == Status::optimal) return;
    double giving = 0.0;
    for (std::size_t k = 0; k < s.active_count; ++k)
      if (!is_speed_bound(s.active[k].binding)) giving += s.active[k].multiplier;
    EXPECT_GT(giving, 0.0) << text_of(problem);
  });
}

TEST(Multipliers, OfAProvenAnswerAreThoseOfItsCertificate) {
  for_each_kind(83, [](const Problem& problem) {
    const Proven proven = solve_certified(problem);
    ASSERT_TRUE(proven.certificate.has_value()) << text_of(problem);
    for (const Term& term : proven.certificate->bound) {
      const auto& active = proven.solution.active;
      const auto same = std::find_if(active.begin(), active.begin() + proven.solution.active_count,
                                     [&](const ActiveConstraint& a) { return a.binding == term.binding; });
      ASSERT_NE(same, active.begin() + proven.solution.active_count) << text_of(problem);
      double sum = 0.0;
      for (const double part : term.multiplier) sum += part;
      EXPECT_EQ(same->multiplier, sum);
    }
  });
}

TEST(Multipliers, AloneProveTheAnswer) {
  std::size_t proven = 0, problems = 0;
  for_each_kind(84, [&](const Problem& problem) {
    const Proven answer = solve_certified(problem);
    if (answer.exact_stage) return;  // these may need a witness of their own, which the certificate holds
    ++problems;
    const Certificate claim = claim_of(problem, answer.solution);
    EXPECT_STREQ(name(check(problem, claim)), "none") << name(claim.status) << '\n' << text_of(problem);
    proven += check(problem, claim_of(problem, solve(problem))) == CertificateError::none;
  });
  EXPECT_GT(problems, 80U * well_formed_kinds().size())
      << "normals of different lengths that give, and violations without a speed bound, are the exact stage's";
  EXPECT_GE(1000 * proven, 999 * problems) << "plain answers: their multipliers are rounded, not chosen";
}

/// A robot that others and walls touch all around to within a rounding error: what is allowed is no larger than that.
Problem robot_in_contact(SeededRandom& random) {
  Problem problem;
  problem.bound.disc = 1.5;
  problem.preferred = {random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)};
  const int touching = random.integer(3, 6), beside = random.integer(0, 3);
  for (int k = 0; k < touching + beside; ++k) {
    const Vec2 normal = geometry::rotated({1.0, 0.0}, random.integer(0, 11) * 0.5235987755982988);
    const double offset = k < touching ? -5e-15 * random.uniform(0.0, 1.0) : -random.uniform(0.0, 2.0);
    problem.constraints.push_back({{normal, offset}, random.integer(0, 2) == 0 ? Priority::hard : Priority::soft});
  }
  return problem;
}

TEST(Multipliers, OfARobotThatIsTouchedAllAroundProveItsVelocity) {
  SeededRandom random(test::seed_of_run(86));
  int by_doubles = 0, exactly = 0;
  for (int k = 0; k < 5000; ++k) {
    const Problem problem = robot_in_contact(random);
    const Proven proven = certified(problem, solve(problem));
    ASSERT_TRUE(proven.certificate.has_value()) << text_of(problem);
    EXPECT_STREQ(name(check(problem, *proven.certificate)), "none") << text_of(problem);
    ++(proven.exact_stage ? exactly : by_doubles);
  }
  EXPECT_GT(by_doubles, 3000) << exactly << " exactly";
}

/// An answer with a number of its own changed, or left as it is.
Solution edited(Solution s, SeededRandom& random) {
  const double factor = random.integer(0, 1) == 0 ? 1.0 + random.uniform(-1e-12, 1e-12) : random.uniform(-1.0, 2.0);
  switch (random.integer(0, 4)) {
    case 0:
      s.velocity.x *= factor;
      break;
    case 1:
      s.velocity.y *= factor;
      break;
    case 2:
      if (s.active_count > 0) s.active[0].multiplier *= factor;
      break;
    case 3:
      if (s.active_count > 0) --s.active_count;
      break;
    default:
      break;
  }
  return s;
}

TEST(Multipliers, ProveOnlyWhatTheCheckerAccepts) {
  SeededRandom random(test::seed_of_run(87));
  std::size_t proven = 0, refused = 0;
  for_each_kind(88, [&](const Problem& problem) {
    Solution s = edited(solve(problem), random);
    const bool is_proven = is_proven_by_multipliers(problem, s);
    (is_proven ? proven : refused) += 1;
    if (!is_proven) return;
    EXPECT_STREQ(name(check(problem, claim_of(problem, s))), "none") << name(s.status) << '\n' << text_of(problem);
  });
  EXPECT_GT(proven, refused);
  EXPECT_GT(refused, 10U * well_formed_kinds().size());
}

TEST(Multipliers, OfAnotherVelocityProveNothing) {
  for_each_kind(85, [](const Problem& problem) {
    Solution s = solve_certified(problem).solution;
    if (s.status != Status::optimal || s.active_count == 0) return;
    s.velocity = 0.5 * s.velocity;
    if (why_worse(problem, s, solve_exact(problem).solution, 1e-6).empty()) return;
    EXPECT_NE(check(problem, claim_of(problem, s)), CertificateError::none) << text_of(problem);
  });
}

TEST(Multipliers, OfOneProblemInArraysAreThoseOfSolve) {
  SeededRandom random(test::seed_of_run(86));
  for (int k = 0; k < 5000; ++k) {
    Problem p = random_problem({BoundKind::disc, Objective::nearest, PriorityKind::soft}, random);
    std::vector<double> x(kSinglePadding * 2), y(x), c(x);
    for (std::size_t j = 0; j < p.constraints.size(); ++j) {
      HalfPlane& h = p.constraints[j].half_plane;
      h.normal = normalized(h.normal);
      x[j] = h.normal.x, y[j] = h.normal.y, c[j] = h.offset;
    }
    Solution s;
    solve({x.data(), y.data(), c.data(), p.constraints.size(), 0, p.preferred, p.bound.disc}, s);
    EXPECT_LE(missed(p, s), kStationary) << text_of(p);
    EXPECT_EQ(check(p, claim_of(p, s)), CertificateError::none) << name(s.status) << '\n' << text_of(p);
  }
}

TEST(Multipliers, OfWhatIsPushedAsidePullItThere) {
  Problem p;
  p.bound.disc = 2.0;
  p.preferred = {1.0, 1.0};
  p.constraints.push_back({{{-1.0, 0.0}, -0.5}, Priority::hard, -1});
  p.constraints.push_back({{{0.0, -1.0}, -0.25}, Priority::hard, -1});
  const Solution s = solve(p);
  ASSERT_EQ(s.active_count, 2U);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(s.active[k].multiplier, s.active[k].binding == constraint_at(0) ? 0.5 : 0.75, 1e-12);
}

TEST(Binding, IsNamedAndComparedByWhatItIs) {
  EXPECT_STREQ(name(kDisc.kind), "disc");
  EXPECT_STREQ(name(kBoxSides[3].kind), "box-bottom");
  EXPECT_EQ(constraint_at(2), (Binding{BindingKind::constraint, 2}));
  EXPECT_NE(constraint_at(2), constraint_at(3));
  EXPECT_NE(constraint_at(0), kDisc);
  EXPECT_EQ((Binding{BindingKind::disc, 7}), kDisc) << "a bound has no number";
}

// --- Tangency: what binds is parallel, and the allowed velocities are a point or a stretch of a line ---

struct Tangent {
  BoundKind bound;
  Objective objective;
  double length;  ///< of the lines' normals
};

SpeedBound bound_of(BoundKind kind, double reach) {
  SpeedBound bound;
  if (kind != BoundKind::box) bound.disc = reach;
  if (kind != BoundKind::disc) bound.box_x = bound.box_y = reach;
  return bound;
}

/// A line at the end of what the bound allows in its direction, an ulp before it, at it or behind it, by itself or with
/// its opposite; the preferred velocity at the centre, straight before the line, beside it, along it and beyond it.
std::vector<Problem> tangent_problems(const Tangent& t) {
  std::vector<Problem> problems;
  constexpr double kReach = 3.0;
  for (const Vec2 unit : {Vec2{1, 0}, Vec2{0, -1}, Vec2{-0.6, 0.8}, Vec2{0x1.6a09e667f3bcdp-1, 0x1.6a09e667f3bcdp-1}}) {
    const double end =
        t.bound == BoundKind::disc ? kReach : std::min(kReach, kReach * (std::fabs(unit.x) + std::fabs(unit.y)));
    for (const double offset : {end, std::nextafter(end, 0.0), std::nextafter(end, 9.0), 0.0}) {
      for (const bool opposite : {false, true}) {
        for (const Vec2 preferred : {Vec2{}, 2.0 * unit, Vec2{-unit.y, unit.x}, 2.5 * Vec2{unit.y, -unit.x}, 5.0 * unit,
                                     -1.0 * unit, end * unit}) {
          if (t.objective == Objective::farthest && preferred == Vec2{}) continue;
          Problem p;
          p.bound = bound_of(t.bound, kReach);
          p.objective = t.objective;
          p.preferred = preferred;
          p.constraints.push_back({{t.length * unit, t.length * offset}});
          if (opposite) p.constraints.push_back({{-t.length * unit, -t.length * offset}});
          for (const bool soft : {false, true}) {
            for (Constraint& c : p.constraints) c.priority = soft ? Priority::soft : Priority::hard;
            problems.push_back(p);
          }
        }
      }
    }
  }
  return problems;
}

void expect_usable_multipliers(const Solution& s, const char* solver, const Problem& problem) {
  for (std::size_t k = 0; k < s.active_count; ++k) {
    const double m = s.active[k].multiplier;
    EXPECT_TRUE(std::isfinite(m) && !std::signbit(m)) << solver << ' ' << name(s.status) << ' ' << m << '\n'
                                                      << text_of(problem);
  }
}

TEST(Multipliers, AreFiniteAndNotNegativeAtTangency) {
  for (const BoundKind bound : {BoundKind::disc, BoundKind::box, BoundKind::disc_box}) {
    for (const Objective objective : {Objective::nearest, Objective::farthest}) {
      for (const double length : {1.0, 0.37, 1e-170, 1e170}) {
        for (const Problem& problem : tangent_problems({bound, objective, length}))
          for (const Solver solver : {Solver::batch, Solver::certified, Solver::exact})
            expect_usable_multipliers(solve_all(solver, {problem}).front().solution, name(solver), problem);
      }
    }
  }
}

TEST(Multipliers, OfOneProblemInArraysAreFiniteAndNotNegativeAtTangency) {
  for (const Problem& problem : tangent_problems({BoundKind::disc, Objective::nearest, 1.0})) {
    std::vector<double> x(kSinglePadding), y(x), c(x);
    std::size_t hard = 0;
    for (std::size_t j = 0; j < problem.constraints.size(); ++j) {
      x[j] = problem.constraints[j].half_plane.normal.x;
      y[j] = problem.constraints[j].half_plane.normal.y;
      c[j] = problem.constraints[j].half_plane.offset;
      hard += problem.constraints[j].priority == Priority::hard;
    }
    const SingleProblem single{x.data(), y.data(),          c.data(),          problem.constraints.size(),
                               hard,     problem.preferred, problem.bound.disc};
    Solution plain, certified;
    solve(single, plain);
    expect_usable_multipliers(plain, "solve of arrays", problem);
    solve_certified(single, certified);
    expect_usable_multipliers(certified, "solve_certified of arrays", problem);
  }
}

}  // namespace
}  // namespace exactvo::lp
