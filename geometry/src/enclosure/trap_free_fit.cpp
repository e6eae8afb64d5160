// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest ellipse round some points at which a robot cannot come to rest: a search over orientation, offset and
// semi-minor axis.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "enclosure/inflate.h"
#include "enclosure/least_axis.h"
#include "enclosure/trap_free_fit.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using detail::AreaLimit;
using detail::AxisAnswer;
using detail::inflate_to_contain;
using detail::LeastMajor;
using detail::MajorFit;
using detail::PairView;
using detail::Touching;
using detail::Turn;
using detail::turn_by;
using detail::TurnedPoints;

struct FitGoal {
  double robot_radius;
  Vec2 start, goal;
  double margin;
  std::optional<double> slack;  ///< none: the evolute condition is dropped
  double clear;
  double most_area = 0.0;       ///< m^2 / pi: a larger ellipse shuts more ways than it opens
  bool is_last_margin = false;  ///< no other margin will be tried
};

/// A candidate in a frame turned by `angle`: the centre lies `offset` across the middle of the points, `minor` is b -
/// margin.
struct Candidate {
  double angle = 0.0;
  double offset = 0.0;  ///< m
  double minor = 0.0;   ///< m
};

struct Scored {
  Candidate candidate;
  Ellipse ellipse;
  double area = std::numeric_limits<double>::infinity();
};

bool admissible(const Ellipse& e, const FitGoal& want) {
  const GrownShape kept_clear{e, {}, want.robot_radius + want.clear};
  if (locate(kept_clear, want.goal) != Place::outside || locate(kept_clear, want.start) != Place::outside) return false;
  return !want.slack || goal_outside_evolute(e, want.goal, *want.slack);
}

constexpr double kMinorShares[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8};
constexpr double kOffsetShares[] = {0.0, -0.25, 0.25, -0.5, 0.5, -0.9, 0.9};
constexpr std::size_t kMinors = std::size(kMinorShares), kOffsets = std::size(kOffsetShares);

/// What is known of a candidate whatever its margin and slack, where a fit keeps it.
struct Known {
  enum class State : unsigned char {
    nothing,
    estimated,  ///< `major` is known to kEstimate
    fitted,     ///< `major` is known
    hopeless    ///< no ellipse, or one that the start or the goal lies in
  };
  State& state;
  MajorFit& major;

  void set(State now, const MajorFit& then) const {
    state = now;
    major = then;
  }
};

/// Start and goal, drawn towards the points by a little less than they must stay clear: an ellipse that holds such a
/// place does not leave the end itself outside. NaN where nothing follows from it.
struct Ends {
  Vec2 start, goal;
  Vec2 whole_goal;  ///< where it is
};

/// The points in one orientation, and what it was last like there.
struct Orientation {
  TurnedPoints frame;
  Ends ends;                ///< in the frame
  Touching pair[kOffsets];  ///< what touched last at each offset

  void turn_to(double angle, const Turn& by, const std::vector<Vec2>& points, const Ends& from) {
    turn(points, angle, by, frame);
    ends = {by(from.start), by(from.goal), by(from.whole_goal)};
    for (Touching& p : pair) p = {frame.rightmost, frame.leftmost};
  }
};

/// Whether every ellipse of a candidate holds a place, or is too long: two of the points say so from both sides. One on
/// the right at x, whose half chord is a w, has the centre no farther left than x - a w; the place is within its own
/// half chord (a + margin) w' of that for all axes a from `shortest` to `longest` if it is for these two.
class Holds {
 public:
  Holds(const Orientation& o, const Candidate& c, double margin, const Touching& pair, const PairView& view,
        double longest)
      : f_(o.frame),
        pair_(pair),
        view_(view),
        centre_y_(f_.middle + c.offset),
        minor_(c.minor + margin),
        margin_(margin),
        longest_(longest) {
    shortest_ = std::max(f_.half_width, (1.0 - kDoubt) * view.least_major());
  }

  bool operator()(Vec2 place) const {
    const double t = (place.y - centre_y_) / minor_;
    if (!(t * t < 1.0 - kLeastWidth * kLeastWidth)) return false;
    const double w = std::sqrt(1.0 - t * t) - kDoubt;
    const double spare = margin_ * w - kDoubt * (shortest_ + std::fabs(place.x) + std::fabs(place.y));
    return reaches(place.x - f_.x[pair_.right] - spare, w - view_.right_width()) &&
           reaches(f_.x[pair_.left] - place.x - spare, w - view_.left_width());
  }

 private:
  /// Far above any rounding here, far below what an end is drawn in by.
  static constexpr double kDoubt = 1e-8;
  /// Where the chord is a smaller share of the axis, the rounding of its height is seen in it.
  static constexpr double kLeastWidth = 0.01;

  bool reaches(double beyond, double wider) const { return beyond <= (wider > 0.0 ? shortest_ : longest_) * wider; }

  const TurnedPoints& f_;
  const Touching& pair_;
  const PairView& view_;
  double centre_y_, minor_, margin_;
  double shortest_ = 0.0, longest_;  ///< m: between these the major axis is, or it is too long
};

/// Whether an ellipse holds a place beyond doubt, in its frame.
bool surely_holds(Vec2 centre, double major, double minor, Vec2 place) {
  constexpr double kDoubt = 1e-6;
  const double x = (place.x - centre.x) / major, y = (place.y - centre.y) / minor;
  return x * x + y * y < 1.0 - kDoubt;
}

/// Shares of an axis, by which estimates may be off, and what is allowed for that and for all rounding.
constexpr double kEstimate = 1e-9;
constexpr double kAllowance = 1e-7;

/// Whether a place lies inside the evolute beyond doubt, in the ellipse's frame. With A = a^2 x^2, B = b^2 y^2 and C =
/// factor (a^2 - b^2)^2 it does where (A + B - C)^3 + 27 A B C < 0 (predicates.cpp), so that larger A and B and a
/// smaller C err towards no.
bool surely_inside_evolute(Vec2 centre, double a, double b, Vec2 place, double slack) {
  const double most = a + b;
  const double x = (1.0 + kAllowance) * a * (std::fabs(place.x - centre.x) + kAllowance * most);
  const double y = (1.0 + kAllowance) * b * (std::fabs(place.y - centre.y) + kAllowance * most);
  const double spread = std::fabs(a - b) * most - kAllowance * most * most;
  if (!(spread > 0.0)) return false;
  const double factor = (1.0 + slack) * (1.0 + slack) * (1.0 + slack);
  const double A = x * x, B = y * y, C = (1.0 - kAllowance) * factor * spread * spread;
  const double beyond = C - A - B;
  return beyond > 0.0 && beyond * beyond * beyond > 27.0 * A * B * C;
}

/// What a fit leaves to the next: memory.
struct FitMemory {
  std::vector<Vec2> points;    ///< the hull's corners from the first of them
  std::vector<double> angles;  ///< of the coarse search
  std::vector<Orientation> orientations;
  // Of each candidate: orientation x semi-minor axis x offset across.
  std::vector<Known::State> state;
  std::vector<MajorFit> major;  ///< read where the state says so
  Orientation here, aside;      ///< of the pattern search
  std::vector<double> width;
};

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

/// Tries candidates on one set of points; keeps the smallest that will do.
class Search {
 public:
  /// `least_width`: of the length of an ellipse.
  Search(const FitGoal& want, std::vector<double>& width, double least_width)
      : want_(want), width_(width), least_width_(least_width) {}

  /// Whether the ellipse of a candidate of that minor axis is larger than the best, whatever else it is.
  bool is_too_large(const TurnedPoints& f, double minor, bool or_equal) const {
    return limit(minor, or_equal).is_too_long(f.half_width);
  }

  /// Whether every ellipse of a row of candidates, of that minor axis and whatever offset, is: with a pair of points
  /// d apart in height the sum of their half chords is largest midway between them, 2 sqrt(1 - (d / 2b)^2).
  bool is_row_too_large(const Orientation& o, double minor, bool or_equal) const {
    constexpr double kRounding = 4e-12;
    const TurnedPoints& f = o.frame;
    const AreaLimit area = limit(minor, or_equal);
    const double longest = area.longest();
    const auto asks_for_more = [&](const Touching& pair) {
      const double t = 0.5 * (f.y[pair.right] - f.y[pair.left]) / minor;
      return f.x[pair.right] - f.x[pair.left] > 2.0 * longest * std::sqrt(1.0 - t * t) + kRounding * f.extent;
    };
    return area.is_too_long(longest) && (asks_for_more(o.pair[0]) || asks_for_more(recent_));
  }

  /// Whether it is smaller than the best so far (`or_equal`: or as large) and will do: then it is the best. `pair` is
  /// where to look first, and is kept up.
  bool improves(const Orientation& o, const Candidate& c, bool or_equal, const Known& known, Touching& pair) {
    if (known.state == Known::State::hopeless) return false;
    const AreaLimit area = limit(c.minor, or_equal);
    if (known.state == Known::State::estimated && is_surely_refused(o, c, area, known.major)) return false;
    if (known.state != Known::State::fitted && !is_fitted(o, c, area, known, pair)) return false;
    if (area.is_too_long(known.major.major) || is_refused(o, c, area, known.major)) return false;
    const double a = known.major.major + want_.margin, b = area.minor;
    if (std::min(a, b) < least_width_ * std::max(a, b)) return false;
    const Vec2 centre = rotated({known.major.centre, o.frame.middle + c.offset}, c.angle);
    const bool upright = a >= b;
    const Ellipse ellipse =
        ellipse_from_axes(centre, {std::max(a, b), std::min(a, b), upright ? c.angle : c.angle + 0.5 * kPi});
    if (!admissible(ellipse, want_)) return false;
    best_ = {c, ellipse, a * b};
    return true;
  }

  const Scored& best() const { return best_; }

 private:
  AreaLimit limit(double minor, bool or_equal) const {
    return {minor + want_.margin, want_.margin, want_.most_area, best_.area, or_equal};
  }

  /// Whether the ends are beyond doubt where they may not be. A glance in doubles, for most candidates.
  bool is_refused(const Orientation& o, const Candidate& c, const AreaLimit& area, const MajorFit& major) const {
    const double a = major.major + want_.margin, b = area.minor;
    const Vec2 centre{major.centre, o.frame.middle + c.offset};
    return (want_.slack && surely_inside_evolute(centre, a, b, o.ends.whole_goal, *want_.slack)) ||
           surely_holds(centre, a, b, o.ends.start) || surely_holds(centre, a, b, o.ends.goal);
  }
  /// The same of an estimate.
  bool is_surely_refused(const Orientation& o, const Candidate& c, const AreaLimit& area, const MajorFit& major) const {
    return area.is_too_long((1.0 - 2.0 * kEstimate) * major.major) || is_refused(o, c, area, major);
  }

  /// Two points tell of most candidates that they are too long or hold an end.
  bool is_ruled_out(const Orientation& o, const Candidate& c, const AreaLimit& area, const Touching& pair,
                    const Known& known) const {
    const PairView view(o.frame, o.frame.middle + c.offset, c.minor, pair);
    if (const double longest = area.longest(); view.asks_for_more_than(longest) && area.is_too_long(longest))
      return true;
    const double longest_of_any = want_.most_area / c.minor;
    const Holds holds(o, c, want_.margin, pair, view, longest_of_any);
    if (!holds(o.ends.start) && !holds(o.ends.goal)) return false;
    if (want_.is_last_margin) known.state = Known::State::hopeless;
    return true;
  }

  bool is_fitted(const Orientation& o, const Candidate& c, const AreaLimit& area, const Known& known, Touching& pair) {
    const TurnedPoints& f = o.frame;
    if (area.is_too_long(f.half_width) || is_ruled_out(o, c, area, pair, known)) return false;
    if (recent_ != pair && is_ruled_out(o, c, area, recent_, known)) {
      pair = recent_;
      return false;
    }
    LeastMajor least(f, f.middle + c.offset, c.minor, pair, width_);
    const AxisAnswer answer = least.bracket(area);
    recent_ = pair;
    if (answer == AxisAnswer::never) known.state = Known::State::hopeless;
    if (answer != AxisAnswer::fits) return false;
    if (least.doubt() <= kEstimate) {
      known.set(Known::State::estimated, least.about());
      if (is_surely_refused(o, c, area, known.major)) return false;
    }
    known.set(Known::State::fitted, least.exact());
    recent_ = pair;
    return true;
  }

  const FitGoal& want_;
  std::vector<double>& width_;
  double least_width_;
  Scored best_;
  Touching recent_;  ///< what touched last
};

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
  void run(Search& search) {
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
  void try_orientation(std::size_t k, std::size_t first_offset, std::size_t last_offset, Search& search) {
    Orientation& o = memory_.orientations[k];
    for (std::size_t m = 0; m < kMinors; ++m) {
      const std::size_t number = (k * kMinors + m) * kOffsets;
      const double minor = coarse_candidate(o.frame, size_, m, 0).minor;
      const bool or_equal = number + first_offset < best_;
      if (search.is_too_large(o.frame, minor, or_equal)) return;
      if (first_offset > 0 && search.is_row_too_large(o, minor, or_equal)) continue;
      for (std::size_t i = first_offset; i < last_offset; ++i) {
        const Candidate c = coarse_candidate(o.frame, size_, m, i);
        if (search.improves(o, c, number + i < best_, known(number + i), o.pair[i])) best_ = number + i;
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

  void run(Search& search) {
    double angle_step = kPi / 36.0;
    double length_step = 0.1 * size_;
    constexpr int kRounds = 60;
    constexpr double kLeastStep = 1e-3;  // of the size: finer changes the area by less than a per mille
    constexpr std::size_t kMoves = 8;
    Touching pair[kMoves];
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
        if (moves[k].minor > 0.0 && improves(moves[k], c.angle, pair[k], search)) better = true;
      if (better) continue;
      angle_step *= 0.5;
      length_step *= 0.5;
    }
  }

 private:
  bool improves(const Candidate& c, double present_angle, Touching& pair, Search& search) {
    Orientation& o = c.angle == present_angle ? memory_.here : memory_.aside;
    if (o.frame.angle != c.angle) o.turn_to(c.angle, turn_by(c.angle), memory_.points, ends_);
    Known::State state = Known::State::nothing;
    MajorFit major;
    return search.improves(o, c, false, {state, major}, pair);
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

FitGoal seen_from(Vec2 origin, FitGoal want) {
  want.start = want.start - origin;
  want.goal = want.goal - origin;
  return want;
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
    const FitGoal local = seen_from(hull_.front(), want);
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
      Search search(local, memory_.width, least_width);
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

const char* name(EnclosureGrade grade) {
  switch (grade) {
    case EnclosureGrade::trap_free:
      return "trap-free";
    case EnclosureGrade::trap_free_thin:
      return "trap-free-thin";
    case EnclosureGrade::containing:
      return "containing";
    case EnclosureGrade::tight:
      return "tight";
  }
  return "tight";
}

namespace detail {

struct TrapFreeFit::Memory : FitMemory {};

TrapFreeFit::TrapFreeFit() : memory_(std::make_unique<Memory>()) {}
TrapFreeFit::~TrapFreeFit() = default;

std::optional<FittedEllipse> TrapFreeFit::operator()(const std::vector<Vec2>& hull, double robot_radius, Vec2 start,
                                                     Vec2 goal, const EnclosureOptions& options) {
  const double most = options.most_inflation * grown_area(hull, robot_radius + options.margin) / kPi;
  const double clear = options.clear_of_ends;
  const FitGoal full{robot_radius, start, goal, options.margin, options.slack, clear, most, false};
  const FitGoal thin{robot_radius, start, goal, options.least_margin, options.least_slack, clear, most, true};
  const FitGoal bare{robot_radius, start, goal, options.least_margin, std::nullopt, clear, most, true};
  LocalFit fit(*memory_, hull);
  if (auto e = fit(full)) return FittedEllipse{*e, EnclosureGrade::trap_free};
  if (auto e = fit(thin)) return FittedEllipse{*e, EnclosureGrade::trap_free_thin};
  if (auto e = fit(bare)) return FittedEllipse{*e, EnclosureGrade::containing};
  return std::nullopt;
}

}  // namespace detail

std::optional<FittedEllipse> fit_trap_free(const std::vector<Vec2>& points, double robot_radius, Vec2 start, Vec2 goal,
                                           const EnclosureOptions& options) {
  EXACTVO_REQUIRE(!points.empty(), "no points");
  return detail::TrapFreeFit()(convex_hull(points).vertices, robot_radius, start, goal, options);
}

}  // namespace exactvo::geometry
