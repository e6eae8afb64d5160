// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>

namespace exactvo::lp {
namespace {

using test::SeededRandom;

constexpr BoundKind kBounds[] = {BoundKind::none, BoundKind::disc,       BoundKind::box_x,      BoundKind::box_y,
                                 BoundKind::box,  BoundKind::disc_box_x, BoundKind::disc_box_y, BoundKind::disc_box};
constexpr const char* kBoundNames[] = {"no bound", "disc",       "box x",      "box y",
                                       "box",      "disc+box x", "disc+box y", "disc+box"};
constexpr PriorityKind kPriorities[] = {PriorityKind::no_constraint, PriorityKind::hard, PriorityKind::soft,
                                        PriorityKind::mixed};
constexpr const char* kPriorityNames[] = {"no constraint", "hard", "soft", "mixed"};
constexpr Solver kEverySolver[] = {Solver::batch, Solver::certified, Solver::exact};

bool has_disc(BoundKind kind) {
  return kind == BoundKind::disc || kind >= BoundKind::disc_box_x;
}
bool has_box_x(BoundKind kind) {
  return kind == BoundKind::box_x || kind == BoundKind::box || kind == BoundKind::disc_box_x ||
         kind == BoundKind::disc_box;
}
bool has_box_y(BoundKind kind) {
  return kind == BoundKind::box_y || kind == BoundKind::box || kind == BoundKind::disc_box_y ||
         kind == BoundKind::disc_box;
}

bool is_well_formed(const ProblemKind& kind) {
  return kind.objective == Objective::nearest || has_disc(kind.bound) ||
         (has_box_x(kind.bound) && has_box_y(kind.bound));
}

std::vector<ProblemKind> kinds_that_are(bool well_formed) {
  std::vector<ProblemKind> kinds;
  for (const BoundKind bound : kBounds)
    for (const Objective objective : {Objective::nearest, Objective::farthest})
      for (const PriorityKind priority : kPriorities)
        if (is_well_formed({bound, objective, priority}) == well_formed) kinds.push_back({bound, objective, priority});
  return kinds;
}

BoundKind bound_kind_of(const SpeedBound& b) {
  for (const BoundKind kind : kBounds)
    if (has_disc(kind) == std::isfinite(b.disc) && has_box_x(kind) == std::isfinite(b.box_x) &&
        has_box_y(kind) == std::isfinite(b.box_y))
      return kind;
  return BoundKind::none;
}

/// The priority of constraint k; where kinds are mixed, the first two differ.
Priority priority_of(PriorityKind kind, int k, SeededRandom& random) {
  if (kind == PriorityKind::hard || (kind == PriorityKind::mixed && k == 0)) return Priority::hard;
  if (kind == PriorityKind::soft || (kind == PriorityKind::mixed && k == 1)) return Priority::soft;
  return random.integer(0, 1) == 0 ? Priority::hard : Priority::soft;
}

int count_of(PriorityKind kind, SeededRandom& random) {
  if (kind == PriorityKind::no_constraint) return 0;
  return random.integer(kind == PriorityKind::mixed ? 2 : 1, 8);
}

double broken_by(const Problem& problem, const Solution& s) {
  const SpeedBound& b = problem.bound;
  double by =
      std::max({0.0, norm(s.velocity) - b.disc, std::abs(s.velocity.x) - b.box_x, std::abs(s.velocity.y) - b.box_y});
  for (const Constraint& c : problem.constraints) {
    const bool must = s.status == Status::optimal || (s.status == Status::relaxed && c.priority == Priority::hard);
    if (must) by = std::max(by, geometry::violation(c.half_plane, s.velocity));
  }
  return by;
}

/// What the objective wants small, m/s.
double cost(const Problem& problem, Vec2 v) {
  if (problem.objective == Objective::nearest) return norm(v - problem.preferred);
  return -dot(v, normalized(problem.preferred));
}

/// Where constraints give, the objective chooses among the velocities of least violation.
std::string why_costlier(const Problem& problem, const Solution& answer, const Solution& exact, double tolerance,
                         Compared compared) {
  const bool gives = answer.status != Status::optimal;
  const double violated = gives ? answer.violation - exact.violation : 0.0;
  const double farther = cost(problem, answer.velocity) - cost(problem, exact.velocity);
  if (!(std::abs(violated) <= tolerance)) return "violated by " + std::to_string(violated) + " m/s more";
  if (gives && compared == Compared::what_is_proven) return "";
  const bool is_costlier = !(gives ? farther <= tolerance : std::abs(farther) <= tolerance);
  return is_costlier ? "worse by " + std::to_string(farther) + " m/s" : "";
}

std::string words(const Solution& s) {
  std::ostringstream out;
  out.precision(17);
  out << name(s.status) << " (" << s.velocity.x << ", " << s.velocity.y << "), violation " << s.violation;
  return out.str();
}

}  // namespace

bool operator<(const ProblemKind& a, const ProblemKind& b) {
  return std::tie(a.bound, a.objective, a.priority) < std::tie(b.bound, b.objective, b.priority);
}

std::string name(const ProblemKind& kind) {
  return std::string(kBoundNames[static_cast<int>(kind.bound)]) +
         (kind.objective == Objective::nearest ? ", nearest, " : ", farthest, ") +
         kPriorityNames[static_cast<int>(kind.priority)];
}

const std::vector<ProblemKind>& well_formed_kinds() {
  static const std::vector<ProblemKind> kinds = kinds_that_are(true);
  return kinds;
}

const std::vector<ProblemKind>& refused_kinds() {
  static const std::vector<ProblemKind> kinds = kinds_that_are(false);
  return kinds;
}

ProblemKind kind_of(const Problem& problem) {
  const auto count = [&](Priority priority) {
    return std::count_if(problem.constraints.begin(), problem.constraints.end(),
                         [&](const Constraint& c) { return c.priority == priority; });
  };
  const bool hard = count(Priority::hard) > 0, soft = count(Priority::soft) > 0;
  const PriorityKind priority = hard && soft ? PriorityKind::mixed
                                : hard       ? PriorityKind::hard
                                : soft       ? PriorityKind::soft
                                             : PriorityKind::no_constraint;
  return {bound_kind_of(problem.bound), problem.objective, priority};
}

Problem random_problem(const ProblemKind& kind, SeededRandom& random) {
  Problem p;
  p.objective = kind.objective;
  if (has_disc(kind.bound)) p.bound.disc = random.uniform(0.5, 3.0);
  if (has_box_x(kind.bound)) p.bound.box_x = random.uniform(0.2, 3.0);
  if (has_box_y(kind.bound)) p.bound.box_y = random.uniform(0.2, 3.0);
  p.preferred = random.in_box(3.0);
  const double reach = random.uniform(0.1, 2.0);
  const bool unit = random.integer(0, 1) == 0;  // the lanes take normals of unit length only
  const int count = count_of(kind.priority, random);
  for (int k = 0; k < count; ++k) {
    const Vec2 n = (unit ? 1.0 : random.uniform(0.5, 2.0)) * random.direction();
    p.constraints.push_back({{n, random.uniform(-reach, 0.6 * reach)}, priority_of(kind.priority, k, random), k});
  }
  return p;
}

Problem grid_problem(const ProblemKind& kind, SeededRandom& random) {
  Problem p;
  p.objective = kind.objective;
  if (has_disc(kind.bound)) p.bound.disc = random.integer(0, 5);
  if (has_box_x(kind.bound)) p.bound.box_x = random.integer(0, 4);
  if (has_box_y(kind.bound)) p.bound.box_y = random.integer(0, 4);
  p.preferred = {1.0 * random.integer(-4, 4), 1.0 * random.integer(-4, 4)};
  if (kind.objective == Objective::farthest && p.preferred == Vec2{}) p.preferred = {1.0, 0.0};
  const int count = count_of(kind.priority, random);
  const bool unit = random.integer(0, 1) == 0;  // else violations are in different units, which only `exact` compares
  for (int k = 0; k < count; ++k) {
    Vec2 n;
    while (n == Vec2{} || (unit && squared_norm(n) != 1.0))
      n = {1.0 * random.integer(-3, 3), 1.0 * random.integer(-3, 3)};
    p.constraints.push_back({{n, 1.0 * random.integer(-6, 4)}, priority_of(kind.priority, k, random), k});
  }
  return p;
}

std::string DrawnPairs::missing() const {
  std::string pairs;
  for (const ProblemKind& kind : well_formed_kinds())
    for (const Solver solver : kEverySolver)
      if (drawn_.count({kind, solver}) == 0) pairs += name(kind) + ": " + name(solver) + "\n";
  return pairs;
}

std::string DrawnPairs::table() const {
  std::ostringstream out;
  for (const ProblemKind& kind : well_formed_kinds()) {
    out << name(kind) << ':';
    for (const Solver solver : kEverySolver) {
      const auto found = drawn_.find({kind, solver});
      out << ' ' << name(solver) << ' ' << (found == drawn_.end() ? 0 : found->second);
    }
    out << '\n';
  }
  return out.str();
}

std::string why_worse(const Problem& problem, const Solution& answer, const Solution& exact, double tolerance,
                      Compared compared) {
  const double broken = broken_by(problem, answer);
  const std::string both = "\n  answer: " + words(answer) + "\n  exact:  " + words(exact);
  if (!(broken <= tolerance)) return "breaks what it promises by " + std::to_string(broken) + " m/s" + both;
  if (answer.status == exact.status) {
    const std::string why = why_costlier(problem, answer, exact, tolerance, compared);
    return why.empty() ? why : why + both;
  }
  const Solution& severe = answer.status > exact.status ? answer : exact;
  return severe.violation <= tolerance ? "" : "another status" + both;
}

}  // namespace exactvo::lp
