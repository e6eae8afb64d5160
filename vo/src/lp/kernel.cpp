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

/// A line that binds, moved inward.
struct BindingLine {
  Vec2 normal;
  double offset, squared_length;
};

/// The optimum as what binds gives it, one or two lines and the disc, whichever way a search found them.
class Vertex {
 public:
  Vertex(const Problem& problem, double slack_units)
      : problem_(problem),
        largest_(largest_speed(problem)),
        disc_(problem.bound.disc * (1.0 - 0.5 * slack_units * kInwardSlack)),
        slack_(slack_units * kInwardSlack * largest_) {}

  BindingLine line(const Binding& binding, const HalfPlane& h) const {
    const double inward = is_speed_bound(binding) ? 0.0 : slack_ * (std::abs(h.normal.x) + std::abs(h.normal.y));
    return {h.normal, h.offset + inward, squared_norm(h.normal)};
  }

  /// The optimum of the disc alone.
  Vec2 on_disc() const { return disc_ * normalized(problem_.preferred); }

  /// The line that is violated less at the optimum of the disc alone is followed, so that the velocity does not depend
  /// on the search.
  bool enters_later(const BindingLine& a, const BindingLine& b, const Binding& name_a, const Binding& name_b) const {
    const bool starts_on_disc = problem_.objective == Objective::farthest || !(norm(problem_.preferred) <= disc_);
    const double radius = std::isfinite(disc_) ? disc_ : 2.0 * largest_;
    const Vec2 start = starts_on_disc ? radius * normalized(problem_.preferred) : problem_.preferred;
    const double by_a = a.offset - dot(a.normal, start), by_b = b.offset - dot(b.normal, start);
    if (by_a != by_b) return by_a < by_b;
    return std::pair(name_a.kind, name_a.index) > std::pair(name_b.kind, name_b.index);
  }

  /// False where it does not meet the disc; of two, where what binds does not meet.
  bool of_one(const BindingLine& line, Vec2& v) const {
    double low = -kInfinity, high = kInfinity;
    return cut_by_disc(line, low, high) && best_between(line, foot_of(line), low, high, v);
  }

  bool of_two(const BindingLine& line, const BindingLine& other, Vec2& v) const {
    double low = -kInfinity, high = kInfinity;
    if (!cut_by_disc(line, low, high)) return false;
    const Vec2 foot = foot_of(line);
    const double slope = dot(other.normal, perp(line.normal)), where = (other.offset - dot(other.normal, foot)) / slope;
    if (slope > 0.0) low = std::max(low, where);
    if (slope < 0.0) high = std::min(high, where);
    return best_between(line, foot, low, high, v);
  }

 private:
  static Vec2 foot_of(const BindingLine& line) { return (line.offset / line.squared_length) * line.normal; }

  bool cut_by_disc(const BindingLine& line, double& low, double& high) const {
    if (!std::isfinite(disc_)) return true;
    const double room = disc_ * disc_ - line.offset * line.offset / line.squared_length;
    if (room < 0.0 && line.offset > 0.0) return false;
    if (room >= 0.0) high = std::sqrt(room / line.squared_length), low = -high;
    return true;
  }

  bool best_between(const BindingLine& line, Vec2 foot, double low, double high, Vec2& v) const {
    if (!(low <= high)) return false;
    v = foot + std::min(std::max(wish_on(line), low), high) * perp(line.normal);
    return true;
  }

  /// Where the objective would like to be on foot + s perp(normal): at the foot of `preferred`, or at one of its ends.
  double wish_on(const BindingLine& line) const {
    const double along = dot(problem_.preferred, perp(line.normal));
    if (problem_.objective == Objective::nearest) return along / line.squared_length;
    return along == 0.0 ? 0.0 : std::copysign(kInfinity, along);
  }

  const Problem& problem_;
  double largest_, disc_, slack_;
};

/// The vertex of what binds; the line that is followed becomes the first. `half_plane` of a binding.
template <class HalfPlanes>
bool find_vertex(const Vertex& vertex, const HalfPlanes& half_plane, Vec2 preferred, Solution& s, Vec2& v) {
  v = preferred;
  if (s.active_count == 0) return true;
  if (s.active[0].binding == kDisc) std::swap(s.active[0], s.active[s.active_count - 1]);
  v = vertex.on_disc();
  const Binding &a = s.active[0].binding, &b = s.active[1].binding;
  if (a == kDisc) return true;
  const BindingLine first = vertex.line(a, half_plane(a));
  if (s.active_count == 1 || b == kDisc) return vertex.of_one(first, v);
  const BindingLine second = vertex.line(b, half_plane(b));
  if (vertex.enters_later(first, second, a, b)) return vertex.of_two(first, second, v);
  std::swap(s.active[0], s.active[1]);
  return vertex.of_two(second, first, v);
}

/// The optimum that holds, with as little slack as does; the kernel's own where what binds shows none.
void set_velocity(const Problem& problem, Solution& s) {
  const auto half_plane = [&](const Binding& binding) { return half_plane_at(problem, binding); };
  for (const double slack : kSlacks) {
    Vec2 v;
    if (!find_vertex(Vertex(problem, slack), half_plane, problem.preferred, s, v) || !is_finite(v)) continue;
    const Vec2 inside = into_box(v, problem.bound);
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

/// A problem as most are: a disc, the nearest velocity, unit normals, hard constraints first. The kernel takes its
/// numbers as they are, and what is proven of the copy is proven of the problem.
class PlainProblem {
 public:
  /// False where it is not plain, or not well-formed. Then it must not be used.
  bool copy(const Problem& problem) {
    const SpeedBound& b = problem.bound;
    problem_ = {x_, y_, offset_, problem.constraints.size(), 0, problem.preferred, b.disc};
    return problem_.count <= kMostCopied && problem.objective == Objective::nearest && is_finite(problem.preferred) &&
           b.disc > 0.0 && b.disc < kInfinity && b.box_x == kInfinity && b.box_y == kInfinity &&
           copy_unit_lines(problem.constraints.data(), problem_.count, {x_, y_, offset_}, problem_.hard);
  }

  /// The optimum that what binds gives, with its multipliers; false where they give none, or where it may be the
  /// preferred velocity but for rounding.
  bool set_optimum(const Problem& problem, Solution& s) const {
    constexpr double kNear = 64.0 * kUnitRoundoff;
    const auto half_plane = [&](const Binding& binding) {
      return HalfPlane{{x_[binding.index], y_[binding.index]}, offset_[binding.index]};
    };
    Vec2 v;
    if (!find_vertex(Vertex(problem, kSlacks[0]), half_plane, problem.preferred, s, v)) return false;
    if (squared_norm(v - problem_.preferred) <= kNear * problem_.disc * (kNear * problem_.disc)) return false;
    s.velocity = v;
    if (!set_both_multipliers(s)) set_multipliers(problem, s);
    return true;
  }

  /// As `leaves_a_stretch`, for normals of about unit length; true in some more cases.
  bool may_leave_a_stretch(const Solution& s) const {
    constexpr double kOpposite = 0x1p-39;
    for (std::size_t i = 0; i < s.active_count; ++i)
      for (std::size_t j = i + 1; j < s.active_count; ++j) {
        if (s.active[i].binding == kDisc || s.active[j].binding == kDisc) continue;
        const Vec2 a = normal(s.active[i]), b = normal(s.active[j]);
        if ((dot(a, b) < 0.0) & (std::abs(cross(a, b)) <= kOpposite)) return true;
      }
    return false;
  }

  const SingleProblem& arrays() const { return problem_; }

 private:
  Vec2 normal(const ActiveConstraint& a) const { return {x_[a.binding.index], y_[a.binding.index]}; }

  /// As set_multipliers does where two bind, which is the usual case; false elsewhere.
  bool set_both_multipliers(Solution& s) const {
    const Vec2 v = s.velocity, pull = v - problem_.preferred;
    if (s.active_count != 2 || problem_.disc > kMostUsual || problem_.disc < 1.0 / kMostUsual) return false;
    const Vec2 a = normal(s.active[0]), b = s.active[1].binding == kDisc ? -v : normal(s.active[1]);
    const double turn = cross(a, b), of_a = cross(pull, b) / turn, of_b = cross(a, pull) / turn;
    s.active[0].multiplier = of_a;
    s.active[1].multiplier = of_b;
    return of_a > 0.0 && of_b > 0.0 && of_a < kInfinity && of_b < kInfinity;
  }

  static constexpr double kMostUsual = 0x1p100;

  double x_[kMostCopied + kSinglePadding], y_[kMostCopied + kSinglePadding], offset_[kMostCopied + kSinglePadding];
  SingleProblem problem_;
};

/// A proven answer with the bits of `find_candidate`; false where it takes more to find or to prove it.
bool solve_plainly(const Problem& problem, Solution& s) {
  PlainProblem plain;
  if (!plain.copy(problem) || !run_kernel(plain.arrays(), s)) return false;
  if (s.status != Status::optimal) return !plain.may_leave_a_stretch(s) && prove_in_arrays(plain.arrays(), s);
  if (s.active_count > 0 && !plain.set_optimum(problem, s)) return false;
  return prove_in_arrays(plain.arrays(), s);
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
  if (solve_plainly(problem, answer)) return true;
  require_well_formed(problem);
  return find_candidate(problem, memory, answer) && is_proven_by_multipliers(problem, answer);
}

Solution solve(const Problem& problem) {
  Solution answer;
  return solve(problem, memory_of_thread(), answer) ? answer : solve_exact(problem).solution;
}

}  // namespace exactvo::lp
