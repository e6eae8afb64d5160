// SPDX-License-Identifier: GPL-3.0-or-later
// Every pair of a problem's kind (bound, objective, priorities) and a solver, against the exact solver.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "oracle.h"
#include "problem_kinds.h"
#include "problem_text.h"

namespace exactvo::lp {
namespace {

using test::SeededRandom;

/// Random vertices are seldom sharper than 10^-6 rad, which makes 16 u V of slack 10^-9 m/s.
constexpr double kAlike = 1e-7;

/// As many problems in all as EXACTVO_LP_PROBLEMS says; 100000 take eight seconds.
std::size_t problems_per_kind() {
  const char* asked = std::getenv("EXACTVO_LP_PROBLEMS");
  const std::size_t all = asked ? std::strtoull(asked, nullptr, 10) : 25000;
  return all / well_formed_kinds().size() + 1;
}

std::vector<Problem> drawn(const ProblemKind& kind, std::size_t count, SeededRandom& random) {
  std::vector<Problem> problems;
  for (std::size_t k = 0; k < count; ++k) problems.push_back(random_problem(kind, random));
  return problems;
}

TEST(EveryKind, HasAProblemOfItsKind) {
  SeededRandom random(test::seed_of_run(61));
  EXPECT_EQ(well_formed_kinds().size(), 52U);
  for (const ProblemKind& kind : well_formed_kinds()) {
    for (int k = 0; k < 20; ++k) {
      EXPECT_EQ(name(kind_of(random_problem(kind, random))), name(kind));
      EXPECT_EQ(name(kind_of(grid_problem(kind, random))), name(kind));
    }
  }
}

TEST(EveryKind, ThatIsNotDrawnIsNamed) {
  SeededRandom random(test::seed_of_run(62));
  DrawnPairs pairs;
  for (const ProblemKind& kind : well_formed_kinds()) {
    const Problem problem = random_problem(kind, random);
    for (const std::string& text : solver_names()) {
      Solver solver{};
      ASSERT_TRUE(parse(text, solver));
      if (name(kind) != "box, farthest, mixed" || solver != Solver::batch) pairs.add(problem, solver);
    }
  }
  EXPECT_EQ(pairs.missing(), "box, farthest, mixed: batch\n");
}

TEST(EveryKind, EverySolverIsAsGoodAsTheExactOne) {
  SeededRandom random(test::seed_of_run(63));
  DrawnPairs pairs;
  std::size_t wrong = 0;
  for (const ProblemKind& kind : well_formed_kinds()) {
    const std::vector<Problem> problems = drawn(kind, problems_per_kind(), random);
    const std::vector<Proven> exact = solve_all(Solver::exact, problems);
    for (const std::string& text : solver_names()) {
      Solver solver{};
      ASSERT_TRUE(parse(text, solver));
      const std::vector<Proven> answers = solve_all(solver, problems);
      for (std::size_t k = 0; k < problems.size(); ++k) {
        pairs.add(problems[k], solver);
        const Compared compared = solver == Solver::batch ? Compared::what_is_proven : Compared::everything;
        const std::string why = why_worse(problems[k], answers[k].solution, exact[k].solution, kAlike, compared);
        if (!why.empty() && ++wrong <= 10)
          ADD_FAILURE() << name(kind) << ", " << text << ": " << why << '\n' << text_of(problems[k]);
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(pairs.missing(), "") << pairs.table();
}

/// An answer that no solver should give, and that its active set cannot support.
struct Lie {
  const char* what;
  bool (*tell)(const Problem&, Solution&);
};

constexpr Lie kLies[] = {
    {"0 is optimal", [](const Problem&, Solution& s) { return s.velocity = {}, s.status = Status::optimal, true; }},
    {"half of the velocity", [](const Problem&, Solution& s) { return s.velocity = 0.5 * s.velocity, true; }},
    {"nothing binds", [](const Problem&, Solution& s) { return s.velocity = {}, s.active_count = 0, true; }},
    {"what is optimal was relaxed",
     [](const Problem&, Solution& s) { return s.status == Status::optimal && (s.status = Status::relaxed, true); }},
    {"what is infeasible was relaxed",
     [](const Problem&, Solution& s) { return s.status == Status::infeasible && (s.status = Status::relaxed, true); }}};

/// Without a finite bound, multipliers in double hardly ever cancel the normals exactly, as a contradiction asks.
bool is_bounded(BoundKind kind) {
  return kind != BoundKind::none && kind != BoundKind::box_x && kind != BoundKind::box_y;
}

TEST(EveryKind, NoSolverThatLiesIsCertified) {
  SeededRandom random(test::seed_of_run(64));
  for (const ProblemKind& kind : well_formed_kinds()) {
    std::size_t lies = 0;
    for (const Problem& problem : drawn(kind, 60, random)) {
      const Solution exact = solve_exact(problem).solution;
      for (const Solution& honest : {exact, solve(problem)}) {
        EXPECT_TRUE(certify(problem, honest).has_value() || !is_bounded(kind.bound))
            << (honest.velocity == exact.velocity ? "exact, or as it\n" : "plain\n") << text_of(problem);
        for (const Lie& lie : kLies) {
          Solution s = honest;
          if (!lie.tell(problem, s) || why_worse(problem, s, exact, kAlike, Compared::what_is_proven).empty()) continue;
          ++lies;
          EXPECT_FALSE(certify(problem, s).has_value()) << lie.what << '\n' << text_of(problem);
        }
      }
    }
    EXPECT_GT(lies, kind.bound == BoundKind::none && kind.priority == PriorityKind::no_constraint ? 0U : 60U)
        << name(kind);
  }
}

TEST(EveryKind, IsRightByBruteForce) {
  SeededRandom random(test::seed_of_run(65));
  for (const ProblemKind& kind : well_formed_kinds()) {
    for (int k = 0; k < 40; ++k) {
      const Problem problem = k % 2 == 0 ? random_problem(kind, random) : grid_problem(kind, random);
      const Proven exact = solve_exact(problem);
      ASSERT_TRUE(exact.certificate.has_value()) << text_of(problem);
      EXPECT_EQ(check(problem, *exact.certificate), CertificateError::none) << text_of(problem);
      const Solution& s = exact.solution;
      if (s.status == Status::no_interior) continue;
      ASSERT_EQ(s.status, oracle::verdict(problem)) << text_of(problem);
      if (s.status != Status::optimal)
        EXPECT_NEAR(s.violation, oracle::least_violation(problem), kAlike) << text_of(problem);
      else if (problem.objective == Objective::farthest)
        EXPECT_NEAR(dot(s.velocity, problem.preferred), oracle::farthest(problem), kAlike) << text_of(problem);
      else
        EXPECT_NEAR(squared_norm(s.velocity - problem.preferred), oracle::least_squared_distance(problem), kAlike)
            << text_of(problem);
    }
  }
}

// With ties a region may be as thin as a line, where the verdict of doubles is heuristic; proven answers are right.
TEST(EveryKind, WithTiesIsAsGoodAsTheExactAnswerOrHasNoProof) {
  SeededRandom random(test::seed_of_run(66));
  std::size_t doubtful = 0, problems = 0;
  for (const ProblemKind& kind : well_formed_kinds()) {
    for (int k = 0; k < 200; ++k) {
      const Problem problem = grid_problem(kind, random);
      const Solution exact = solve_exact(problem).solution;
      EXPECT_EQ(why_worse(problem, solve_certified(problem).solution, exact, kAlike), "") << text_of(problem);
      const Solution s = solve_all(Solver::batch, {problem}).front().solution;
      ++problems;
      if (why_worse(problem, s, exact, kAlike, Compared::what_is_proven).empty()) continue;
      ++doubtful;
      EXPECT_FALSE(certify(problem, s).has_value()) << text_of(problem);
    }
  }
  EXPECT_LT(100 * doubtful, problems) << doubtful;
}

// What is let pass as rounding was not scaled with short normals: wrong from 1e-15 down.
TEST(EveryKind, WithShortAndLongNormalsIsAsGoodAsTheExactAnswer) {
  SeededRandom random(test::seed_of_run(68));
  std::size_t optimal = 0, relaxed = 0;
  for (const ProblemKind& kind : well_formed_kinds()) {
    for (const int exponent : {-500, -300, -50, 50, 300, 500}) {
      for (int k = 0; k < 10; ++k) {
        Problem problem = random_problem(kind, random);
        const Solution plain = solve_exact(problem).solution;
        if (plain.status == Status::no_interior) continue;
        for (Constraint& c : problem.constraints) {
          HalfPlane& h = c.half_plane;
          h = {{std::ldexp(h.normal.x, exponent), std::ldexp(h.normal.y, exponent)}, std::ldexp(h.offset, exponent)};
        }
        for (const Solver solver : {Solver::batch, Solver::certified}) {
          const Solution s = solve_all(solver, {problem}).front().solution;
          ASSERT_EQ(s.status, plain.status) << name(kind) << ", 2^" << exponent << ", " << text_of(problem);
          EXPECT_LE(norm(s.velocity - plain.velocity), s.status == Status::optimal ? 1e-5 : HUGE_VAL)
              << text_of(problem);
          EXPECT_NEAR(std::ldexp(s.violation, -exponent), plain.violation, kAlike) << text_of(problem);
          ++(s.status == Status::optimal ? optimal : relaxed);
        }
      }
    }
  }
  EXPECT_GT(optimal, 1000U);
  EXPECT_GT(relaxed, 1000U);
}

/// The speed that rounding is measured by, and with it the violation: m/s, m/s |n|.
double largest_speed_of(const Problem& p, Vec2 velocity) {
  double speed = norm(velocity) + norm(p.preferred);
  for (const Constraint& c : p.constraints)
    speed = std::max(speed, std::abs(c.half_plane.offset) / norm(c.half_plane.normal));
  return speed;
}
double longest_normal(const Problem& p) {
  double length = 0.0;
  for (const Constraint& c : p.constraints) length = std::max(length, norm(c.half_plane.normal));
  return length;
}

void expect_small_gap(const Problem& problem, const Proven& answer) {
  ASSERT_TRUE(answer.certificate.has_value()) << text_of(problem);
  const Certificate& c = *answer.certificate;
  EXPECT_STREQ(name(check(problem, c)), "none") << text_of(problem);
  EXPECT_TRUE(is_tight(problem, c)) << c.gap << '\n' << text_of(problem);
  if (c.status == Status::no_interior) return;
  const double speed = largest_speed_of(problem, c.velocity);
  const double unit = c.status == Status::optimal ? speed * speed : c.violation + speed * longest_normal(problem);
  EXPECT_LE(c.gap, 1e-11 * unit) << name(c.status) << " by " << c.violation << '\n' << text_of(problem);
}

// Without a disc or a box the gap of a least violation was the violation itself: multipliers in doubles leave a sum of
// normals of about u. With a region that is one point of the disc it was some m/s: no multipliers are largest there.
TEST(EveryKind, AGapIsARoundingError) {
  SeededRandom random(test::seed_of_run(69));
  std::size_t without_bound = 0;
  for (const ProblemKind& kind : well_formed_kinds()) {
    for (int k = 0; k < 200; ++k) {
      const Problem problem = k % 2 == 0 ? random_problem(kind, random) : grid_problem(kind, random);
      const Proven answer = solve_certified(problem);
      expect_small_gap(problem, answer);
      if (k % 8 < 2) expect_small_gap(problem, solve_exact(problem));
      without_bound += !is_bounded(kind.bound) && answer.solution.status != Status::optimal;
    }
  }
  EXPECT_GT(without_bound, 200U);
}

// A gap was measured by the speed alone, and a violation of short normals is smaller than that.
TEST(EveryKind, AGapIsARoundingErrorOfShortNormals) {
  SeededRandom random(test::seed_of_run(70));
  for (const ProblemKind& kind : well_formed_kinds()) {
    for (int k = 0; k < 20; ++k) {
      Problem problem = random_problem(kind, random);
      for (Constraint& c : problem.constraints) {
        HalfPlane& h = c.half_plane;
        h = {{std::ldexp(h.normal.x, -50), std::ldexp(h.normal.y, -50)}, std::ldexp(h.offset, -50)};
      }
      expect_small_gap(problem, solve_certified(problem));
    }
  }
}

// The only double inside this needle near its tip lies 0.7 m/s away from it.
TEST(Certificate, AGapThatIsNoRoundingErrorIsReportedAsWide) {
  Problem p;
  p.bound.disc = 2.0;
  p.preferred = {-1.0, 1.0 / 3.0};
  p.constraints.push_back({{{0.0, 3.0}, 1.0}, Priority::hard, -1});
  p.constraints.push_back({{{3e-14, -3.0}, -1.0}, Priority::hard, -1});
  const Proven answer = solve_certified(p);
  ASSERT_EQ(answer.solution.status, Status::optimal);
  ASSERT_TRUE(answer.certificate.has_value());
  EXPECT_EQ(check(p, *answer.certificate), CertificateError::none);
  EXPECT_GT(answer.certificate->gap, 1e-2);
  EXPECT_FALSE(is_tight(p, *answer.certificate));
}

TEST(EveryKind, WithoutAFiniteBoundIsRefusedForALinearObjective) {
  SeededRandom random(test::seed_of_run(67));
  EXPECT_EQ(refused_kinds().size(), 12U);
  for (const ProblemKind& kind : refused_kinds()) EXPECT_THROW(solve(random_problem(kind, random)), std::logic_error);
}

// The solver once called the centre of the box optimal: it searched to an infinite end of a line, where no disc ends
// it.
TEST(Farthest, ReachesTheCornerOfABoxWithoutADisc) {
  Problem p;
  p.objective = Objective::farthest;
  p.bound.box_x = 1.0;
  p.bound.box_y = 2.0;
  p.preferred = {0.3, 1.0};
  for (const Solver solver : {Solver::batch, Solver::certified, Solver::exact}) {
    const Solution s = solve_all(solver, {p}).front().solution;
    EXPECT_EQ(s.status, Status::optimal);
    EXPECT_EQ(s.velocity, (Vec2{1.0, 2.0})) << name(solver);
  }
}

// 0 stood for a velocity that left the range of doubles, and was then found to hold.
TEST(Solve, AVelocityBeyondDoublesIsNotReplacedByAnOptimum) {
  Problem p;
  p.preferred = {0.0, 0.0};
  p.constraints.push_back({{{1e-10, 0.0}, 1e300}, Priority::hard, -1});
  const Solution s = solve(p);
  EXPECT_TRUE(is_finite(s.velocity));
  EXPECT_STREQ(name(s.status), "no-interior");
}

TEST(Solve, AVelocityWithinDoublesIsFoundThoughProductsLeaveThem) {
  Problem p;
  p.preferred = {1e300, -1e300};
  p.constraints.push_back({{{-1e10, 1.0}, -1.0}, Priority::hard, -1});
  const Solution s = solve(p);
  EXPECT_STREQ(name(s.status), "optimal");
  EXPECT_NEAR(s.velocity.y / 1e300, -1.0, 1e-9);
  EXPECT_LE(s.velocity.x / 1e290, -1.0 + 1e-9);
}

}  // namespace
}  // namespace exactvo::lp
