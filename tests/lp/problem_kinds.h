// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Every kind of problem: what bounds the speed, what is asked for, which constraints may give. Tests, the fuzz target
/// and the runs of the program draw problems by kind, and a table says which pairs of kind and solver were drawn.

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/vo/lp/solvers.h"
#include "support/seeded_random.h"

namespace exactvo::lp {

enum class BoundKind { none, disc, box_x, box_y, box, disc_box_x, disc_box_y, disc_box };
enum class PriorityKind { no_constraint, hard, soft, mixed };

struct ProblemKind {
  BoundKind bound = BoundKind::none;
  Objective objective = Objective::nearest;
  PriorityKind priority = PriorityKind::no_constraint;
};
bool operator<(const ProblemKind& a, const ProblemKind& b);

/// "disc+box x, farthest, mixed"
std::string name(const ProblemKind& kind);

/// Every kind that `require_well_formed` accepts: 52.
const std::vector<ProblemKind>& well_formed_kinds();

/// Every kind that it refuses: a linear objective without a finite bound.
const std::vector<ProblemKind>& refused_kinds();

/// The kind that a problem is of, read off its fields.
ProblemKind kind_of(const Problem& problem);

/// Numbers at random: a region as thin as a rounding error is improbable.
Problem random_problem(const ProblemKind& kind, test::SeededRandom& random);

/// Small integers: parallel lines, lines through one point, ties, boxes and discs of width 0; half of them with normals
/// along the axes.
Problem grid_problem(const ProblemKind& kind, test::SeededRandom& random);

/// Which pairs of kind and solver were drawn, and how often.
class DrawnPairs {
 public:
  void add(const Problem& problem, Solver solver) { ++drawn_[{kind_of(problem), solver}]; }

  /// The pairs of a well-formed kind and a solver that were not drawn, one per line; empty where all were.
  std::string missing() const;
  /// One row per kind, one column per solver, the number of problems in each.
  std::string table() const;

 private:
  std::map<std::pair<ProblemKind, Solver>, std::size_t> drawn_;
};

/// What a comparison looks at: of an answer that violates something also the choice among the velocities of least
/// violation, which no certificate proves, or only what one proves.
enum class Compared { everything, what_is_proven };

/// Why `answer` is worse than the exact answer by more than `tolerance` (m/s, of the violation or of the objective), or
/// breaks what its status promises by more. Empty where it is as good. A status that differs is no error where the
/// region is thinner than the tolerance.
std::string why_worse(const Problem& problem, const Solution& answer, const Solution& exact, double tolerance,
                      Compared compared = Compared::everything);

}  // namespace exactvo::lp
