// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/kernel.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "exactvo/geometry/infinity.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/exact/inward.h"
#include "lp/lanes/layout.h"
#include "lp/lanes/vertex.h"
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

/// The normal of a half-plane, of about unit length.
Vec2 unit_normal(const HalfPlane& h, double& length) {
  const bool is_unit = std::abs(squared_norm(h.normal) - 1.0) <= kUnitLength;
  length = is_unit ? 1.0 : std::hypot(h.normal.x, h.normal.y);
  return is_unit ? h.normal : h.normal / length;
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
    const double more = slack_units - kSlacks[0];  // than the kernel's own
    inward_ = more > 0.0 ? more * kSlackUnits * kUnitRoundoff * unit_ * largest_speed(problem_) : 0.0;
    shortest_ = kInfinity;
    longest_ = 0.0;
    if (!lay_out(part)) return false;
    SingleProblem p{a_.x.data(), a_.y.data(), a_.offset.data(), count_, hard_, {}, {}};
    p.disc = unit_ * disc * (1.0 - more * kDiscUnits * kUnitRoundoff);
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
    double length = 0.0;
    const Vec2 normal = unit_normal(h, length);
    if (gives) shortest_ = std::min(shortest_, length), longest_ = std::max(longest_, length);
    const double offset = unit_ * (h.offset / length) + inward_;
    add(normal, offset, constraint_at(k));
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
    s.velocity = {std::ldexp(s.velocity.x, exponent_), std::ldexp(s.velocity.y, exponent_)};
    s.velocity = into_box(s.velocity, problem_.bound);
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

/// The vertex of what binds; the line that is followed becomes the first, the disc the last. `line_of` a binding.
template <class LineOf>
bool find_vertex(const Vertex& vertex, const LineOf& line_of, Vec2 preferred, Solution& s, Vec2& v) {
  v = preferred;
  if (s.active_count == 0) return true;
  if (s.active[0].binding == kDisc) std::swap(s.active[0], s.active[s.active_count - 1]);
  v = vertex.on_disc();
  if (s.active[0].binding == kDisc) return true;
  const BindingLine first = line_of(s.active[0].binding);
  if (s.active_count == 1 || s.active[1].binding == kDisc) return vertex.of_one(first, v);
  const BindingLine second = line_of(s.active[1].binding);
  if (vertex.follows(first, second)) return vertex.of_two(first, second, v);
  std::swap(s.active[0], s.active[1]);
  return vertex.of_two(second, first, v);
}

/// The optimum that holds, with as little slack as does; the kernel's own where what binds shows none.
void set_velocity(const Problem& problem, Solution& s) {
  const std::size_t count = problem.constraints.size();
  const auto line_of = [&](const Binding& binding) {
    const HalfPlane h = half_plane_at(problem, binding);
    if (is_speed_bound(binding)) return BindingLine{h.normal, h.offset, static_cast<std::size_t>(binding.kind), true};
    const bool is_soft = problem.constraints[binding.index].priority == Priority::soft;
    double length = 0.0;
    const Vec2 normal = unit_normal(h, length);
    return BindingLine{normal, h.offset / length, 2 * kSidesOfBox + (is_soft ? count : 0) + binding.index, false};
  };
  const double largest = largest_speed(problem);
  for (const double slack : kSlacks) {
    Vec2 v;
    const Vertex vertex(problem.objective, problem.preferred, problem.bound.disc, largest, slack);
    if (!find_vertex(vertex, line_of, problem.preferred, s, v) || !is_finite(v)) continue;
    const Vec2 inside = into_box(v, problem.bound);
    if (!holds(problem, Status::optimal, inside)) continue;
    s.velocity = inside;
    return;
  }
}

/// Two normals with a sine below this between them count as opposite.
constexpr double kOpposite = 0x1p-39;

/// Whether two of what binds are opposite to each other, up to rounding. A whole stretch of velocities then violates
/// least, of which the kernel has one, not the nearest to `preferred`.
bool leaves_a_stretch(const Problem& problem, const Solution& s) {
  Vec2 normal[3];
  std::size_t count = 0;
  double length = 0.0;
  for (std::size_t k = 0; k < s.active_count; ++k)
    if (s.active[k].binding.kind != BindingKind::disc)
      normal[count++] = unit_normal(half_plane_at(problem, s.active[k].binding), length);
  bool leaves = false;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j)
      leaves |= (dot(normal[i], normal[j]) < 0.0) & (std::abs(cross(normal[i], normal[j])) <= kOpposite);
  return leaves;
}

/// Whether no two of three lines are opposite to each other: of a problem in the kernel's units the multipliers are the
/// sines between the normals.
bool are_apart(const Solution& s) {
  if (s.active_count != 3 || s.active[2].binding == kDisc) return false;
  return std::min({s.active[0].multiplier, s.active[1].multiplier, s.active[2].multiplier}) > kOpposite;
}

/// A problem as most are: a disc, the nearest velocity, unit normals, hard constraints first. Proven, with the bits of
/// `find_candidate`; false where it is none, or not well-formed, or where it takes more to find or to prove the answer.
bool solve_plainly(const Problem& problem, Solution& s) {
  const SpeedBound& b = problem.bound;
  const bool is_plain = (problem.objective == Objective::nearest) & (squared_norm(problem.preferred) < kInfinity) &
                        (b.disc > 0.0) & (b.disc < kInfinity) & (b.box_x == kInfinity) & (b.box_y == kInfinity);
  if (!is_plain || !run_plain(problem, s)) return false;
  if (s.status != Status::optimal) return are_apart(s) || !leaves_a_stretch(problem, s);
  // What may be the preferred velocity but for rounding is, if that holds.
  constexpr double kNear = 64.0 * kUnitRoundoff;
  const double near = kNear * b.disc;
  return ((s.active_count == 0) | (squared_norm(s.velocity - problem.preferred) > near * near)) ||
         sign_of_excess_speed(problem.preferred, b.disc) > 0;
}

}  // namespace

bool set_vertex(const SingleProblem& p, Solution& s) {
  const auto line_of = [&](const Binding& binding) {
    const std::size_t k = binding.index;
    return BindingLine{{p.normal_x[k], p.normal_y[k]}, p.offset[k], k, false};
  };
  const Vertex vertex(Objective::nearest, p.preferred, p.disc, p.disc, kSlacks[0]);
  if (!find_vertex(vertex, line_of, p.preferred, s, s.velocity)) return false;
  Normals normals{};
  for (std::size_t k = 0; k < s.active_count; ++k)
    if (s.active[k].binding != kDisc) normals[k] = line_of(s.active[k].binding).normal;
  set_multipliers(normals, Objective::nearest, p.preferred, s);
  return true;
}

bool find_candidate(const Problem& problem, SolveMemory& memory, Solution& s) {
  if (problem.objective == Objective::nearest && holds(problem, Status::optimal, problem.preferred)) {
    s = {problem.preferred, Status::optimal, {}, 0, 0.0};
    return true;
  }
  SolveArrays& arrays = *memory.arrays_;
  const auto is_settled = [&](double beyond_data) {
    Kernel kernel(problem, arrays, beyond_data);
    return kernel.run(Part::all, kSlacks[0], s) || kernel.run(Part::hard_ones_give, kSlacks[0], s);
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

namespace {

bool solve_generally(const Problem& problem, SolveMemory& memory, Solution& answer) {
  require_well_formed(problem);
  return find_candidate(problem, memory, answer) && is_proven_by_multipliers(problem, answer);
}

}  // namespace

bool solve(const Problem& problem, SolveMemory& memory, Solution& answer) {
  return solve_plainly(problem, answer) || solve_generally(problem, memory, answer);
}

Solution solve(const Problem& problem) {
  // Copied: what clears so much at once (`rep stos`) takes a processor longer than copying.
  static Solution unsolved;
  Solution answer = unsolved;
  if (!solve_plainly(problem, answer) && !solve_generally(problem, memory_of_thread(), answer))
    answer = solve_exact(problem).solution;
  return answer;
}

}  // namespace exactvo::lp
