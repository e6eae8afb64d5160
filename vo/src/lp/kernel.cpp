// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/kernel.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "exactvo/geometry/infinity.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/exact/inward.h"
#include "lp/problem/exact_sign.h"
#include "lp/problem/region.h"
#include "lp/proof/duality.h"
#include "lp/proof/multipliers.h"

namespace exactvo::lp {

/// The lines of a problem as the kernel reads them, and what each of them is.
struct detail::SolveArrays {
  std::vector<double> x, y, offset;
  std::vector<Binding> binding;
  void resize(std::size_t lines) {
    const std::size_t room = (lines / kSinglePadding + 1) * kSinglePadding;
    if (x.size() >= room) return;
    for (auto* array : {&x, &y, &offset}) array->resize(room);
    binding.resize(room);
  }
};

namespace {

using detail::SolveArrays;
using geometry::kInfinity;

constexpr std::size_t kSidesOfBox = 4;

/// Without a disc the kernel gets one this many times as large as the box, or as the speeds of the data: an answer on
/// that disc is rejected. Vertices of sharp angles lie far away, but the slack grows with the disc.
constexpr double kBeyondBox = 2.0, kBeyondData = 8.0, kFarBeyondData = 0x1p20;

/// Violations count in units of |n|: with normals that differ by more they are not those that the kernel compares.
constexpr double kSameLength = 1.0 + 0x1p-48;

/// A direction as a preferred velocity: this many times the disc along it. The optimum then has the same lines, and
/// what binds says where it lies.
constexpr double kFar = 0x1p20;

/// Which constraints there are, and which of them may give.
enum class Part { all, hard_ones_give };

double disc_for_kernel(const Problem& problem, double beyond_data) {
  const SpeedBound& b = problem.bound;
  if (std::isfinite(b.disc)) return b.disc;
  return bound_is_finite(b) ? kBeyondBox * std::hypot(b.box_x, b.box_y) : beyond_data * largest_speed(problem);
}

Vec2 multiplied(Vec2 v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent)};
}

/// One problem on its way to the kernel and back, in units of speed in which the disc is between 1 and 2.
class Kernel {
 public:
  Kernel(const Problem& problem, SolveArrays& arrays, double beyond_data = kBeyondData)
      : problem_(problem), a_(arrays), beyond_data_(beyond_data) {}

  bool run(Part part, double slack_units, Solution& s) {
    const double disc = disc_for_kernel(problem_, beyond_data_);
    if (!(disc > 0.0) || !std::isfinite(disc)) return false;
    exponent_ = std::ilogb(disc);
    if (exponent_ > kMostExponent || exponent_ < -kMostExponent) return false;
    unit_ = std::ldexp(1.0, -exponent_);
    inward_ = slack_units > 0.0 ? slack_units * kInwardSlack * unit_ * largest_speed(problem_) : 0.0;
    shortest_ = kInfinity;
    longest_ = 0.0;
    if (!lay_out(part)) return false;
    SingleProblem p{a_.x.data(), a_.y.data(), a_.offset.data(), count_, hard_, {}, {}};
    p.disc = unit_ * disc * (1.0 - 0.5 * slack_units * kInwardSlack);
    p.preferred = problem_.objective == Objective::nearest ? unit_ * problem_.preferred
                                                           : (kFar * p.disc) * normalized(problem_.preferred);
    return run_kernel(p, s) && take_back(part, s);
  }

 private:
  /// 2^-exponent must be an ordinary number too.
  static constexpr int kMostExponent = 1000;

  bool lay_out(Part part) {
    a_.resize(problem_.constraints.size() + kSidesOfBox);
    count_ = 0;
    for (const Binding side : kBoxSides) {
      const HalfPlane h = side_of_box(problem_.bound, side.kind);
      if (std::isfinite(h.offset)) add(h.normal, unit_ * h.offset, side);
    }
    hard_ = count_;
    const std::size_t end = problem_.constraints.size();
    bool is_laid_out = true;
    for (std::size_t k = 0; k < end; ++k)
      if (problem_.constraints[k].priority == Priority::hard) is_laid_out &= lay_out(k, part != Part::all);
    if (part != Part::all) return is_laid_out;
    hard_ = count_;
    for (std::size_t k = 0; k < end; ++k)
      if (problem_.constraints[k].priority == Priority::soft) is_laid_out &= lay_out(k, true);
    return is_laid_out;
  }

  bool lay_out(std::size_t k, bool gives) {
    const HalfPlane& h = problem_.constraints[k].half_plane;
    double length = 1.0;
    if (!(std::abs(squared_norm(h.normal) - 1.0) <= kUnitLength)) length = std::hypot(h.normal.x, h.normal.y);
    if (gives) shortest_ = std::min(shortest_, length), longest_ = std::max(longest_, length);
    const double offset = unit_ * (h.offset / length) + inward_;
    add({h.normal.x / length, h.normal.y / length}, offset, constraint_at(k));
    return std::isfinite(length) && std::isfinite(offset);
  }

  void add(Vec2 normal, double offset, Binding binding) {
    a_.x[count_] = normal.x;
    a_.y[count_] = normal.y;
    a_.offset[count_] = offset;
    a_.binding[count_++] = binding;
  }

  /// False where the answer leans on what is no part of the problem: the kernel's own disc or, where constraints give,
  /// their violations in another unit.
  bool take_back(Part part, Solution& s) const {
    const bool gives = s.status == Status::relaxed;
    if ((!gives && s.status != Status::optimal) || (gives && !(longest_ <= shortest_ * kSameLength))) return false;
    if (part != Part::all && !gives) return false;
    if (gives && part != Part::all) s.status = Status::infeasible;
    for (std::size_t k = 0; k < s.active_count; ++k) {
      Binding& binding = s.active[k].binding;
      if (binding != kDisc)
        binding = a_.binding[binding.index];
      else if (std::isinf(problem_.bound.disc))
        return false;
    }
    s.velocity = into_box(multiplied(s.velocity, exponent_), problem_.bound);
    return true;
  }

  const Problem& problem_;
  SolveArrays& a_;
  double beyond_data_;
  std::size_t count_ = 0, hard_ = 0;
  int exponent_ = 0;
  double unit_ = 1.0, inward_ = 0.0;
  double shortest_ = kInfinity, longest_ = 0.0;  ///< of the normals that give
};

/// Where the objective would like to be on the line q + s d: at the foot of `preferred`, or at one of its ends.
double wish_on(Vec2 d, double squared_length, const Problem& problem) {
  const double along = dot(problem.preferred, d);
  if (problem.objective == Objective::nearest) return along / squared_length;
  return along == 0.0 ? 0.0 : std::copysign(kInfinity, along);
}

/// A line that binds, moved inward.
struct BindingLine {
  Vec2 normal;
  double offset = 0.0, squared_length = 1.0;
};

BindingLine binding_line(const Problem& problem, Binding binding, double slack) {
  const HalfPlane h = half_plane_at(problem, binding);
  const double inward = is_speed_bound(binding) ? 0.0 : slack * (std::abs(h.normal.x) + std::abs(h.normal.y));
  return {h.normal, h.offset + inward, squared_norm(h.normal)};
}

/// The optimum as what binds gives it, one or two lines and the disc, whichever way a search found them.
class Vertex {
 public:
  Vertex(const Problem& problem, double slack_units)
      : problem_(problem),
        disc_(problem.bound.disc * (1.0 - 0.5 * slack_units * kInwardSlack)),
        slack_(slack_units * kInwardSlack * largest_speed(problem)) {}

  /// Nothing where they do not meet. The line that is violated less at the optimum of the disc alone becomes the
  /// first, so that the velocity does not depend on the search.
  std::optional<Vec2> of(Solution& s) const {
    if (s.active_count == 0) return problem_.preferred;
    if (s.active[0].binding == kDisc) std::swap(s.active[0], s.active[s.active_count - 1]);
    if (s.active[0].binding == kDisc) return disc_ * normalized(problem_.preferred);
    const BindingLine first = binding_line(problem_, s.active[0].binding, slack_);
    if (s.active_count == 1 || s.active[1].binding == kDisc) return on(first, nullptr);
    const BindingLine second = binding_line(problem_, s.active[1].binding, slack_);
    if (!enters_later(s.active[0].binding, first, s.active[1].binding, second)) {
      std::swap(s.active[0], s.active[1]);
      return on(second, &first);
    }
    return on(first, &second);
  }

 private:
  bool enters_later(Binding a, const BindingLine& line_a, Binding b, const BindingLine& line_b) const {
    const bool starts_on_disc = problem_.objective == Objective::farthest || !(norm(problem_.preferred) <= disc_);
    const double radius = std::isfinite(disc_) ? disc_ : 2.0 * largest_speed(problem_);
    const Vec2 start = starts_on_disc ? radius * normalized(problem_.preferred) : problem_.preferred;
    const double by_a = line_a.offset - dot(line_a.normal, start), by_b = line_b.offset - dot(line_b.normal, start);
    if (by_a != by_b) return by_a < by_b;
    return std::pair(a.kind, a.index) > std::pair(b.kind, b.index);
  }

  std::optional<Vec2> on(const BindingLine& line, const BindingLine* other) const {
    const Vec2 q = (line.offset / line.squared_length) * line.normal, d = perp(line.normal);
    double low = -kInfinity, high = kInfinity;
    if (std::isfinite(disc_)) {
      const double room = disc_ * disc_ - line.offset * line.offset / line.squared_length;
      if (room < 0.0 && line.offset > 0.0) return std::nullopt;
      if (room >= 0.0) high = std::sqrt(room / line.squared_length), low = -high;
    }
    if (other) {
      const double slope = dot(other->normal, d), where = (other->offset - dot(other->normal, q)) / slope;
      if (slope > 0.0) low = std::max(low, where);
      if (slope < 0.0) high = std::min(high, where);
    }
    if (!(low <= high)) return std::nullopt;
    const double s = std::min(std::max(wish_on(d, line.squared_length, problem_), low), high);
    return q + s * d;
  }

  const Problem& problem_;
  double disc_, slack_;
};

/// The optimum that holds, with as little slack as does; the kernel's own where what binds shows none.
void set_velocity(const Problem& problem, Solution& s) {
  for (const double slack : kSlacks) {
    const std::optional<Vec2> v = Vertex(problem, slack).of(s);
    if (!v || !is_finite(*v)) continue;
    const Vec2 inside = into_box(*v, problem.bound);
    if (!holds(problem, Status::optimal, inside)) continue;
    s.velocity = inside;
    return;
  }
}

/// Whether two of what binds are opposite to each other, up to rounding. A whole stretch of velocities then violates
/// least, of which the kernel has one, not the nearest to `preferred`.
bool leaves_a_stretch(const Problem& problem, const Solution& s) {
  constexpr double kOpposite = 0x1p-40;
  for (std::size_t i = 0; i < s.active_count; ++i)
    for (std::size_t j = i + 1; j < s.active_count; ++j) {
      if (s.active[i].binding == kDisc || s.active[j].binding == kDisc) continue;
      const Vec2 a = half_plane_at(problem, s.active[i].binding).normal;
      const Vec2 b = half_plane_at(problem, s.active[j].binding).normal;
      const Vec2 ua = a / std::hypot(a.x, a.y), ub = b / std::hypot(b.x, b.y);
      if (dot(ua, ub) < 0.0 && std::abs(cross(ua, ub)) <= kOpposite) return true;
    }
  return false;
}

}  // namespace

bool find_candidate(const Problem& problem, SolveMemory& memory, Solution& s) {
  if (problem.objective == Objective::nearest && holds(problem, Status::optimal, problem.preferred)) {
    s = {problem.preferred, Status::optimal, {}, 0, 0.0};
    return true;
  }
  SolveArrays& arrays = *memory.arrays_;
  const auto is_settled = [&](double beyond_data) {
    Kernel kernel(problem, arrays, beyond_data);
    return kernel.run(Part::all, 0.0, s) || kernel.run(Part::hard_ones_give, 0.0, s);
  };
  if (!is_settled(kBeyondData) && (bound_is_finite(problem.bound) || !is_settled(kFarBeyondData))) return false;
  if (s.status != Status::optimal && leaves_a_stretch(problem, s)) return false;
  if (s.status == Status::optimal) set_velocity(problem, s);
  s.violation = s.status == Status::optimal ? 0.0 : violation_that_counts(problem, s.status, s.velocity);
  set_multipliers(problem, s);
  return true;
}

std::optional<Vec2> optimum_inside(const Problem& problem, double slack_units) {
  SolveArrays arrays;
  Solution s;
  const bool is_found = Kernel(problem, arrays).run(Part::all, slack_units, s) && s.status == Status::optimal;
  return is_found ? std::optional<Vec2>(s.velocity) : std::nullopt;
}

SolveMemory::SolveMemory() : arrays_(std::make_unique<detail::SolveArrays>()) {}
SolveMemory::~SolveMemory() = default;
SolveMemory::SolveMemory(SolveMemory&&) noexcept = default;
SolveMemory& SolveMemory::operator=(SolveMemory&&) noexcept = default;

void SolveMemory::reserve(std::size_t constraints) {
  arrays_->resize(constraints + kSidesOfBox);
}

SolveMemory& memory_of_thread() {
  thread_local SolveMemory memory;
  return memory;
}

bool solve(const Problem& problem, SolveMemory& memory, Solution& answer) {
  require_well_formed(problem);
  return find_candidate(problem, memory, answer) && is_proven_by_multipliers(problem, answer);
}

Solution solve(const Problem& problem) {
  Solution answer;
  return solve(problem, memory_of_thread(), answer) ? answer : solve_exact(problem).solution;
}

}  // namespace exactvo::lp
