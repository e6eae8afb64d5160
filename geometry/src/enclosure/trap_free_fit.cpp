// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest ellipse round some points at which a robot cannot come to rest: a search over orientation, offset and
// semi-minor axis.
#include <array>

#include "enclosure/ellipse_solver.h"
#include "enclosure/trap_free_fit.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/support.h"

namespace exactvo::geometry {
namespace detail {
namespace {

constexpr double kBeyond = 1.0 + 1e-14;  // a few roundings beyond a root
constexpr int kBisections = 40;          // leaves 2^-40 of the extent, far below any margin
constexpr double kFinest = 0x1p-40;

/// The centres x for which all points lie in the ellipse, and the points that bound them.
struct Centres {
  double low = -kInfinity, high = kInfinity;
  Touching at;
  bool is_empty() const { return !(low <= high); }
};

Centres centres_for(const TurnedPoints& f, const std::vector<double>& width, double major) {
  Centres range;
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    const double low = f.x[i] - major * width[i], high = f.x[i] + major * width[i];
    if (low > range.low) range.low = low, range.at.right = i;
    if (high < range.high) range.high = high, range.at.left = i;
  }
  return range;
}

/// Half of each point's chord at its height, for a major axis of 1. False where one lies beyond the minor axis.
bool widths(const TurnedPoints& f, double centre_y, double minor, std::vector<double>& width) {
  width.resize(f.y.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < f.y.size(); ++i) {
    const double t = (f.y[i] - centre_y) / minor;
    farthest = std::max(farthest, std::fabs(t));
    width[i] = std::sqrt(1.0 - t * t);
  }
  return farthest < 1.0;
}

}  // namespace

Turn turn_by(double angle) {
  return {std::cos(-angle), std::sin(-angle)};
}

void turn(const std::vector<Vec2>& points, double angle, const Turn& by, TurnedPoints& f) {
  f.angle = angle;
  f.x.resize(points.size());
  f.y.resize(points.size());
  double low = kInfinity, high = -kInfinity;
  f.leftmost = f.rightmost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 p = by(points[i]);
    f.x[i] = p.x;
    f.y[i] = p.y;
    low = std::min(low, f.y[i]);
    high = std::max(high, f.y[i]);
    if (f.x[i] < f.x[f.leftmost]) f.leftmost = i;
    if (f.x[i] > f.x[f.rightmost]) f.rightmost = i;
  }
  f.middle = 0.5 * (low + high);
  f.half_height = 0.5 * (high - low);
  const double left = f.x[f.leftmost], right = f.x[f.rightmost], first = f.x.front();
  f.extent = std::max(std::fabs(left - first), std::fabs(right - first));
  // Up to the rounding of coordinates.
  const double rounding = 8.0 * kUnitRoundoff * (std::fabs(left) + std::fabs(right));
  f.half_width = 0.5 * (right - left) - rounding;
}

// Whether a major axis is long enough is so from some double on, rounding and all, since every operation of
// `centres_for` is monotone in it: what is known of one axis answers for others.

/// The pair alone, in the same arithmetic: where it leaves no centre, all points don't.
bool LeastMajor::pair_is_apart(double major) const {
  return f_.x[pair_.right] - major * width_[pair_.right] > f_.x[pair_.left] + major * width_[pair_.left];
}

double LeastMajor::least_of_pair() const {
  return kBeyond * ((f_.x[pair_.right] - f_.x[pair_.left]) / (width_[pair_.right] + width_[pair_.left]));
}

/// Remembers what bounds.
bool LeastMajor::has_centre(double major) {
  const Centres c = centres_for(f_, width_, major);
  pair_ = c.at;
  if (c.is_empty()) return false;
  about_ = {major, 0.5 * (c.low + c.high)};
  return true;
}

bool LeastMajor::is_long_enough(double major) {
  if (major >= long_enough_) return true;
  if (major <= too_short_) return false;
  const bool is = !pair_is_apart(major) && has_centre(major);
  (is ? long_enough_ : too_short_) = major;
  return is;
}

/// Draws what is known together round the least one: the gap between two points' centres is linear in the axis, so
/// Newton's method climbs to it from `at`, which is hardly longer, in a few steps. It climbs over axes that two points
/// forbid, so that the first one that is long enough is the least but for rounding: that of the points' own extent, and
/// of what the bisection stops at.
void LeastMajor::approach(double at) {
  constexpr int kSteps = 8;
  constexpr double kRounding = 1e-13;
  at = std::max({too_short_, at, 0.0, least_of_pair()});
  for (int i = 0; i < kSteps && at < long_enough_; ++i) {
    if (has_centre(at)) {
      long_enough_ = at;
      const double chords = width_[pair_.right] + width_[pair_.left];
      doubt_ = kRounding * (1.0 + f_.extent / (at * chords)) + kFinest * high_ / at;
      return;
    }
    too_short_ = std::max(too_short_, at);
    at = kBeyond * std::max(least_of_pair(), at);
  }
}

AxisAnswer LeastMajor::bracket(const AreaLimit& limit) {
  if (!widths(f_, centre_y_, minor_, width_)) return AxisAnswer::never;
  const double narrowest = std::min(1.0, *std::min_element(width_.begin(), width_.end()));
  high_ = f_.extent / narrowest;
  const double longest = limit.longest();
  if (longest < high_ && limit.is_too_long(longest) && !is_long_enough(longest)) return AxisAnswer::too_long;
  approach(f_.half_width);
  return AxisAnswer::fits;
}

MajorFit LeastMajor::exact() {
  double low = 0.0, high = high_;
  for (int i = 0; i < kBisections; ++i) {
    const double mid = 0.5 * (low + high);
    (is_long_enough(mid) ? high : low) = mid;
  }
  const Centres range = centres_for(f_, width_, high);
  return {high, 0.5 * (range.low + range.high)};
}

namespace {

constexpr std::size_t kAngles = 18;

double coarse_angle(std::size_t i) {
  return kPi * static_cast<double>(i) / static_cast<double>(kAngles);
}

const std::array<Turn, kAngles>& coarse_turns() {
  static const std::array<Turn, kAngles> all = [] {
    std::array<Turn, kAngles> turns;
    for (std::size_t i = 0; i < kAngles; ++i) turns[i] = turn_by(coarse_angle(i));
    return turns;
  }();
  return all;
}

/// All round, and along the hull's edges.
void set_coarse_angles(const std::vector<Vec2>& hull, std::vector<double>& angles) {
  angles.clear();
  for (std::size_t i = 0; i < kAngles; ++i) angles.push_back(coarse_angle(i));
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 e = hull[(i + 1) % hull.size()] - hull[i];
    if (e != Vec2{}) angles.push_back(std::atan2(e.y, e.x));
  }
}

/// m, of the candidate's number in an orientation.
Candidate coarse_candidate(const TurnedPoints& f, double size, std::size_t minor, std::size_t offset) {
  const double room = kMinorShares[minor] * size;
  return {f.angle, kOffsetShares[offset] * room, f.half_height + room};
}

/// The candidates of one fit's coarse search, tried with one margin and slack after the other.
class CoarseSearch {
 public:
  CoarseSearch(FitMemory& memory, double size, const Ends& ends) : memory_(memory), size_(size) {
    set_coarse_angles(memory.points, memory.angles);
    if (memory.orientations.size() < memory.angles.size()) memory.orientations.resize(memory.angles.size());
    for (std::size_t k = 0; k < memory.angles.size(); ++k)
      memory.orientations[k].turn_to(memory.angles[k], k < kAngles ? coarse_turns()[k] : turn_by(memory.angles[k]),
                                     memory.points, ends);
    const std::size_t count = memory.angles.size() * kMinors * kOffsets;
    memory.state.assign(count, Known::State::nothing);
    if (memory.major.size() < count) memory.major.resize(count);
    first_ = promising_orientation();
  }

  /// The smallest of all, of equals the first. Central ones are tried first, and of these those along the smallest box
  /// round the points, so that most others are seen at once to be larger.
  void run(CandidateSearch& search) {
    best_ = memory_.state.size();
    try_orientation(first_, 0, 1, search);
    for (std::size_t k = 0; k < memory_.angles.size(); ++k)
      if (k != first_) try_orientation(k, 0, 1, search);
    for (std::size_t k = 0; k < memory_.angles.size(); ++k) try_orientation(k, 1, kOffsets, search);
  }

 private:
  std::size_t promising_orientation() const {
    std::size_t best = 0;
    const auto box = [&](std::size_t k) {
      const TurnedPoints& f = memory_.orientations[k].frame;
      return f.half_width * (f.half_height + kMinorShares[0] * size_);
    };
    for (std::size_t k = 1; k < memory_.angles.size(); ++k)
      if (box(k) < box(best)) best = k;
    return best;
  }

  /// From the smallest minor axis up: once the points' own extent makes too large an ellipse, it does so for all
  /// others.
  void try_orientation(std::size_t k, std::size_t first_offset, std::size_t last_offset, CandidateSearch& search) {
    Orientation& o = memory_.orientations[k];
    for (std::size_t m = 0; m < kMinors; ++m) {
      const std::size_t number = (k * kMinors + m) * kOffsets;
      const double minor = coarse_candidate(o.frame, size_, m, 0).minor;
      const bool or_equal = number + first_offset < best_;
      if (search.is_too_large(o.frame, minor, or_equal)) return;
      if (search.is_row_too_large(o.frame, minor, or_equal)) continue;
      for (std::size_t i = first_offset; i < last_offset; ++i) {
        const Candidate c = coarse_candidate(o.frame, size_, m, i);
        if (search.improves(o, c, number + i < best_, known(number + i))) best_ = number + i;
      }
    }
  }

  Known known(std::size_t number) { return {memory_.state[number], memory_.major[number]}; }

  FitMemory& memory_;
  double size_;
  std::size_t first_ = 0;  ///< orientation
  std::size_t best_ = 0;
};

/// A pattern search from the best of a coarse one.
class Refinement {
 public:
  Refinement(FitMemory& memory, double size, const Ends& ends) : memory_(memory), size_(size), ends_(ends) {}

  void run(CandidateSearch& search) {
    double angle_step = kPi / 36.0;
    double length_step = 0.1 * size_;
    constexpr int kRounds = 60;
    constexpr double kLeastStep = 1e-3;  // of the size: finer changes the area by less than a per mille
    constexpr std::size_t kMoves = 8;
    memory_.here.frame.angle = memory_.aside.frame.angle = std::numeric_limits<double>::quiet_NaN();
    for (int round = 0; round < kRounds && length_step > kLeastStep * size_; ++round) {
      const Candidate c = search.best().candidate;
      if (memory_.aside.frame.angle == c.angle) std::swap(memory_.here, memory_.aside);
      const Candidate moves[kMoves] = {{c.angle + angle_step, c.offset, c.minor},
                                       {c.angle - angle_step, c.offset, c.minor},
                                       {c.angle, c.offset + length_step, c.minor},
                                       {c.angle, c.offset - length_step, c.minor},
                                       {c.angle, c.offset, c.minor + length_step},
                                       {c.angle, c.offset, c.minor - length_step},
                                       {c.angle, c.offset + length_step, c.minor + length_step},
                                       {c.angle, c.offset - length_step, c.minor + length_step}};
      bool better = false;
      for (std::size_t k = 0; k < kMoves; ++k)
        if (moves[k].minor > 0.0 && improves(moves[k], c.angle, search)) better = true;
      if (better) continue;
      angle_step *= 0.5;
      length_step *= 0.5;
    }
  }

 private:
  bool improves(const Candidate& c, double present_angle, CandidateSearch& search) {
    Orientation& o = c.angle == present_angle ? memory_.here : memory_.aside;
    if (o.frame.angle != c.angle) o.turn_to(c.angle, turn_by(c.angle), memory_.points, ends_);
    Known::State state = Known::State::nothing;
    MajorFit major;
    return search.improves(o, c, false, {state, major});
  }

  FitMemory& memory_;
  double size_;
  Ends ends_;
};

/// Whether `end` lies so near the hull that no ellipse round it with a margin can be clear of it.
bool is_too_near(const std::vector<Vec2>& hull, const FitGoal& want, double size, Vec2 end) {
  constexpr double kRounding = 1e-9;  // of the sizes, far above any rounding of the fit, far below a margin
  if (want.margin < kRounding * size) return false;
  const double reach = (1.0 - kRounding) * (want.robot_radius + want.clear) - kRounding * size;
  return locate({ConvexPolygon{hull}, {}, std::max(reach, 0.0)}, end) != Place::outside;
}

/// The area of hull (+) D(0, r): A + P r + pi r^2.
double grown_area(const std::vector<Vec2>& hull, double r) {
  double twice_area = 0.0;
  double perimeter = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 a = hull[i];
    const Vec2 b = hull[(i + 1) % hull.size()];
    twice_area += cross(a - hull[0], b - hull[0]);
    perimeter += norm(b - a);
  }
  return 0.5 * twice_area + perimeter * r + kPi * r * r;
}

double size_of(const std::vector<Vec2>& points) {
  double size = 0.0;
  for (Vec2 p : points) size = std::max(size, norm(p - points.front()));
  constexpr double kLeastSize = 0.1;  // m: a point still needs an ellipse with some extent
  return std::max(size, kLeastSize);
}

/// An end drawn towards the hull by a little less than the robot must stay clear of it.
Vec2 drawn_in(const std::vector<Vec2>& hull, Vec2 end, double clear) {
  constexpr double kLess = 1.0 - 1e-6;
  Vec2 nearest = hull.front();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 p = nearest_point({hull[i], hull[(i + 1) % hull.size()]}, end);
    if (norm(p - end) < norm(nearest - end)) nearest = p;
  }
  const double distance = norm(nearest - end);
  if (distance <= clear) return Vec2{} / 0.0;  // this near, the rounding of a hull decides
  return end + (kLess * clear / distance) * (nearest - end);
}

/// Searched for from the first corner: of ellipses as good as each other the same one is taken wherever the scene lies.
class LocalFit {
 public:
  LocalFit(FitMemory& memory, const std::vector<Vec2>& hull) : memory_(memory), hull_(hull) {
    memory.points.clear();
    for (const Vec2 p : hull) memory.points.push_back(p - hull.front());
    size_ = size_of(memory.points);
  }

  std::optional<Ellipse> operator()(const FitGoal& want) {
    FitGoal local = want;
    local.start -= hull_.front();
    local.goal -= hull_.front();
    if (is_too_near(memory_.points, local, size_, local.start) || is_too_near(memory_.points, local, size_, local.goal))
      return std::nullopt;
    if (!coarse_) {
      const double clear = want.robot_radius + want.clear;
      ends_ = {drawn_in(memory_.points, local.start, clear), drawn_in(memory_.points, local.goal, clear), local.goal};
      coarse_.emplace(memory_, size_, ends_);
    }
    // Without a margin the smallest ellipse round collinear points is a segment to rounding, and contains nothing.
    constexpr double kLeastWidth = 1e-9;
    for (const double least_width : {0.0, kLeastWidth}) {
      CandidateSearch search(local, memory_.width, least_width);
      coarse_->run(search);
      if (!std::isfinite(search.best().area)) return std::nullopt;
      Refinement(memory_, size_, ends_).run(search);
      Ellipse e = search.best().ellipse;
      e.center = e.center + hull_.front();
      if (const std::optional<Ellipse> whole = inflate_to_contain(e, hull_))
        return admissible(*whole, want) ? whole : std::nullopt;
    }
    return std::nullopt;
  }

 private:
  FitMemory& memory_;
  const std::vector<Vec2>& hull_;
  double size_ = 0.0;
  Ends ends_;  ///< the same whatever margin and slack
  std::optional<CoarseSearch> coarse_;
};

}  // namespace

std::optional<FittedEllipse> fit_trap_free(FitMemory& memory, const std::vector<Vec2>& hull, double robot_radius,
                                           Vec2 start, Vec2 goal, const EnclosureOptions& options) {
  const double most = options.most_inflation * grown_area(hull, robot_radius + options.margin) / kPi;
  const double clear = options.clear_of_ends;
  const FitGoal full{robot_radius, start, goal, options.margin, options.slack, clear, most};
  const FitGoal thin{robot_radius, start, goal, options.least_margin, options.least_slack, clear, most};
  const FitGoal bare{robot_radius, start, goal, options.least_margin, std::nullopt, clear, most};
  LocalFit fit(memory, hull);
  if (auto e = fit(full)) return FittedEllipse{*e, EnclosureGrade::trap_free};
  if (auto e = fit(thin)) return FittedEllipse{*e, EnclosureGrade::trap_free_thin};
  if (auto e = fit(bare)) return FittedEllipse{*e, EnclosureGrade::containing};
  return std::nullopt;
}

}  // namespace detail

const char* name(EnclosureGrade grade) {
  constexpr const char* kNames[] = {"trap-free", "trap-free-thin", "containing", "tight"};
  return kNames[static_cast<int>(grade)];
}

std::optional<FittedEllipse> fit_trap_free(const std::vector<Vec2>& points, double robot_radius, Vec2 start, Vec2 goal,
                                           const EnclosureOptions& options) {
  EXACTVO_REQUIRE(!points.empty(), "no points");
  detail::FitMemory memory;
  return detail::fit_trap_free(memory, convex_hull(points).vertices, robot_radius, start, goal, options);
}

}  // namespace exactvo::geometry
