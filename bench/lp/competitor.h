// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A solver in the arena: built on a set (in its own layout, not timed), run as often as wanted, then asked for
/// answers.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sets.h"

namespace exactvo::bench {

struct Answer {
  lp::Vec2 velocity;
  bool feasible = false;
};

class Competitor {
 public:
  virtual ~Competitor() = default;
  virtual void run() = 0;
  virtual std::size_t count() const = 0;  ///< problems a run
  virtual Answer answer(std::size_t i) const = 0;
};

struct Entry {
  std::string name;
  bool feasible_only = false;  ///< knows no relaxation
  bool exact = false;          ///< must agree with the exact verdict everywhere
  std::size_t most = 0;        ///< problems it is given at most: slow ones get fewer
  std::string target;          ///< SIMD target to force, "" for the best
  std::function<std::unique_ptr<Competitor>(const std::vector<lp::Problem>&)> build;
};

/// Every solver and every competitor, `textbook` first.
std::vector<Entry> entries();

std::unique_ptr<Competitor> make_cgal_qp(const std::vector<lp::Problem>& problems);
#ifdef EXACTVO_HAVE_GLPK
std::unique_ptr<Competitor> make_glpk(const std::vector<lp::Problem>& problems);
#endif

}  // namespace exactvo::bench
