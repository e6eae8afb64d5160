// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/solvers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "exactvo/geometry/names.h"
#include "exactvo/vo/lp/solve.h"
#include "lp/lanes/layout.h"
#include "lp/problem/region.h"
#include "lp/proof/multipliers.h"

namespace exactvo::lp {
namespace {

constexpr geometry::Names<Solver, 3> kSolvers{
    {{Solver::batch, "batch"}, {Solver::certified, "certified"}, {Solver::exact, "exact"}}};

/// Padding that always holds (batch.h).
constexpr double kAlwaysHolds = -1e30;
/// Offsets must stay clear of the padding, and their squares of overflow.
constexpr double kMostOffset = 1e29;

/// A register's worth of problems, transposed; those that the lockstep search takes.
class Batch {
 public:
  explicit Batch(const std::vector<Problem>& problems) {
    for (std::size_t i = 0; i < problems.size(); ++i)
      if (takes(problems[i])) place_.push_back(i), lines_ = std::max(lines_, problems[i].constraints.size());
    stride_ = (place_.size() + kMostLanes - 1) / kMostLanes * kMostLanes;
    allocate();
    for (std::size_t slot = 0; slot < place_.size(); ++slot) fill(slot, problems[place_[slot]]);
  }

  void solve() {
    if (place_.empty()) return;
    const BatchProblems<double> in = {place_.size(), lines_,     kMostLanes, nx_.data(),   ny_.data(),
                                      c_.data(),     px_.data(), py_.data(), disc_.data(), hard_.data()};
    solve_batch(in, {vx_.data(), vy_.data(), violation_.data(), status_.data(), active_.data(), stride_, nullptr}, 0,
                place_.size());
  }

  void gather(const std::vector<Problem>& problems, std::vector<Proven>& answers) const {
    for (std::size_t slot = 0; slot < place_.size(); ++slot) {
      answers[place_[slot]].solution = solution(slot);
      set_multipliers(problems[place_[slot]], answers[place_[slot]].solution);
    }
  }

  static bool takes(const Problem& p) {
    if (p.objective != Objective::nearest || !std::isfinite(p.bound.disc) || !(p.bound.disc > 0.0)) return false;
    if (std::isfinite(p.bound.box_x) || std::isfinite(p.bound.box_y)) return false;
    return std::all_of(p.constraints.begin(), p.constraints.end(), [](const Constraint& c) {
      return std::abs(norm(c.half_plane.normal) - 1.0) <= kUnitLength && std::abs(c.half_plane.offset) < kMostOffset;
    });
  }

 private:
  void allocate() {
    for (auto* array : {&px_, &py_, &disc_, &vx_, &vy_, &violation_}) array->assign(stride_, 1.0);
    nx_.assign(lines_ * stride_, 1.0);
    ny_.assign(lines_ * stride_, 0.0);
    c_.assign(lines_ * stride_, kAlwaysHolds);
    hard_.assign(stride_, 0);
    status_.assign(stride_, 0);
    active_.assign(3 * stride_, kNoLine);
    order_.assign(lines_ * stride_, 0);
  }

  void fill(std::size_t slot, const Problem& p) {
    px_[slot] = p.preferred.x;
    py_[slot] = p.preferred.y;
    disc_[slot] = p.bound.disc;
    std::size_t line = 0;
    for (const Priority priority : {Priority::hard, Priority::soft})
      for (std::size_t k = 0; k < p.constraints.size(); ++k)
        if (p.constraints[k].priority == priority) put_line(slot, line++, p.constraints[k], k);
  }

  void put_line(std::size_t slot, std::size_t line, const Constraint& c, std::size_t index) {
    const std::size_t at = slot / kMostLanes * kMostLanes * lines_ + line * kMostLanes + slot % kMostLanes;
    nx_[at] = c.half_plane.normal.x;
    ny_[at] = c.half_plane.normal.y;
    c_[at] = c.half_plane.offset;
    hard_[slot] += c.priority == Priority::hard;
    order_[slot * lines_ + line] = index;
  }

  /// The disc is not told of by the lanes; it may bind wherever a slot is free.
  Solution solution(std::size_t slot) const {
    Solution s;
    s.velocity = {vx_[slot], vy_[slot]};
    s.status = static_cast<Status>(status_[slot]);
    s.violation = violation_[slot];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t line = active_[k * stride_ + slot];
      if (line == kNoLine) continue;
      s.active[s.active_count++].binding = constraint_at(order_[slot * lines_ + static_cast<std::size_t>(line)]);
    }
    const bool room = s.active_count < (s.status == Status::optimal ? 2U : 3U);
    if (room && norm(s.velocity) > disc_[slot] * (1.0 - kOnDisc)) s.active[s.active_count++].binding = kDisc;
    return s;
  }

  std::vector<std::size_t> place_, order_;
  std::size_t lines_ = 0, stride_ = 0;
  std::vector<double> nx_, ny_, c_, px_, py_, disc_, vx_, vy_, violation_;
  std::vector<std::int32_t> hard_, active_;
  std::vector<std::uint8_t> status_;
};

Proven solve_one(Solver solver, const Problem& problem) {
  if (solver == Solver::batch) return {lp::solve(problem), std::nullopt, false};
  return solver == Solver::exact ? solve_exact(problem) : solve_certified(problem);
}

}  // namespace

const char* name(Solver solver) {
  return geometry::name_in(kSolvers, solver);
}

std::vector<std::string> solver_names() {
  return geometry::words_in(kSolvers);
}

bool parse(const std::string& text, Solver& solver) {
  return geometry::parse_in(kSolvers, text, solver);
}

struct Solving::State {
  Solver solver;
  const std::vector<Problem>& problems;
  std::vector<Proven> answers;
  std::vector<std::size_t> alone;  ///< problems that are solved one by one
  std::optional<Batch> lanes;
};

Solving::Solving(Solver solver, const std::vector<Problem>& problems)
    : state_(new State{solver, problems, std::vector<Proven>(problems.size()), {}, {}}) {
  for (std::size_t i = 0; i < problems.size(); ++i) {
    require_well_formed(problems[i]);
    if (solver != Solver::batch || !Batch::takes(problems[i])) state_->alone.push_back(i);
  }
  if (solver == Solver::batch) state_->lanes.emplace(problems);
}

Solving::~Solving() = default;

void Solving::solve() {
  for (const std::size_t i : state_->alone) state_->answers[i] = solve_one(state_->solver, state_->problems[i]);
  if (state_->lanes) state_->lanes->solve();
}

std::vector<Proven> Solving::answers() {
  if (state_->lanes) state_->lanes->gather(state_->problems, state_->answers);
  return std::move(state_->answers);
}

std::vector<Proven> solve_all(Solver solver, const std::vector<Problem>& problems) {
  Solving solving(solver, problems);
  solving.solve();
  return solving.answers();
}

void prove(const Problem& problem, Proven& answer) {
  if (!answer.certificate) answer = certified(problem, answer.solution);
}

}  // namespace exactvo::lp
