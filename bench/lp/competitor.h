// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The arena's entries. A solver joins with a file of one function and a line in CMakeLists.txt:
///
///     #include "competitor.h"
///     namespace exactvo::bench {
///     Answer mine(const lp::Problem& problem) { ... return {velocity, is_feasible}; }
///     const Join joins("mine", mine);
///     }
///
/// It gets problems with a disc and normals of unit length, hard constraints first, and is timed with its own set-up.
/// docs/guide/linear-program.md has a whole example.

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "sets.h"

namespace exactvo::bench {

struct Answer {
  lp::Vec2 velocity;      ///< m/s; of a problem that is not feasible, the least violation's, or anything
  bool feasible = false;  ///< whether all half-planes can hold within the disc
};

/// A solver with a layout of its own: built on a set, which is not timed, run as often as wanted, then asked for
/// answers.
class Competitor {
 public:
  virtual ~Competitor() = default;
  virtual void run() = 0;
  virtual std::size_t count() const = 0;  ///< problems a run
  virtual Answer answer(std::size_t i) const = 0;
};

/// What the arena must know of a solver.
struct Rules {
  bool feasible_only = false;  ///< knows no relaxation: it enters sets whose problems are all feasible
  bool exact = false;          ///< a verdict that is not the exact one ends the arena with status 1
  /// Problems that it is given at most, evenly spread over the set: slow solvers take fewer.
  std::size_t most = std::numeric_limits<std::size_t>::max();
  bool has_box = false;  ///< bounds the speed by the box around the disc: of its answers only verdicts are judged
};

struct Entry {
  std::string name;
  Rules rules;
  std::string target;  ///< SIMD target to force, "" for the best
  std::function<std::unique_ptr<Competitor>(const std::vector<lp::Problem>&)> build;
};

/// Enters a solver when the program starts: a constant in the solver's file.
class Join {
 public:
  Join(std::string name, Answer (*solve)(const lp::Problem&), Rules rules = {});
};

/// `textbook`, this project's solvers, then those that joined, by name. Throws std::runtime_error where two have one
/// name, one has none or one with a slash, or one takes no problem.
std::vector<Entry> entries();

}  // namespace exactvo::bench
