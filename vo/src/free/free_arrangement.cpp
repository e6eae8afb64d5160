// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/free_arrangement.h"

#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "cgal_guard.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shape_numbers.h"
#include "free/arrangement.h"

namespace exactvo::vo::detail {
namespace {

/// Certified numbers of walks: boxes round their points, brackets of their areas. MPFR does the arcs.

using geometry::kInfinity;

/// Bits that an answer has beyond the speed (or its square): what is stated is 2^-48.
constexpr int kBits = 56;

/// Each coordinate within 2^-bits.
RationalVector approximate(const Point& x, int bits) {
  return {x.x.approximate(bits), x.y.approximate(bits)};
}

/// x up to 2^error, rounded outward.
/// Each side at most 2^-48 max_speed, or as narrow as doubles are there.
geometry::Bracket bracket_of(const Rational& x, int error) {
  const Rational low = x - Rational(std::ldexp(1.0, error)), high = x + Rational(std::ldexp(1.0, error));
  double a = low.get_d(), b = high.get_d();
  while (Rational(a) > low) a = std::nextafter(a, -kInfinity);
  while (Rational(b) < high) b = std::nextafter(b, kInfinity);
  return {a, b};
}

class Real {
 public:
  explicit Real(mpfr_prec_t precision) { mpfr_init2(value_, precision); }
  Real(mpfr_prec_t precision, const Rational& x) : Real(precision) { mpfr_set_q(value_, x.get_mpq_t(), MPFR_RNDN); }
  ~Real() { mpfr_clear(value_); }
  Real(const Real&) = delete;
  Real& operator=(const Real&) = delete;
  mpfr_ptr get() { return value_; }
  Rational rational() const {
    Rational out;
    mpfr_get_q(out.get_mpq_t(), value_);
    return out;
  }

 private:
  mpfr_t value_;
};

/// The angle between two vectors from 0 to pi, minus its sine. Ends that are rounded may lie the wrong way round by
/// their rounding: then the arc is nothing, or half of the circle.
Rational angle_without_sine(const RationalVector& a, const RationalVector& b, mpfr_prec_t precision) {
  const Rational across = cross(a, b), along = dot(a, b);
  if (sgn(across) < 0 && sgn(along) > 0) return 0;
  Real y(precision, across), x(precision, along), angle(precision), sine(precision);
  mpfr_atan2(angle.get(), y.get(), x.get(), MPFR_RNDN);
  if (sgn(across) < 0) mpfr_neg(angle.get(), angle.get(), MPFR_RNDN);
  mpfr_sin(sine.get(), angle.get(), MPFR_RNDN);
  mpfr_sub(angle.get(), angle.get(), sine.get(), MPFR_RNDN);
  return angle.rational();
}

/// What bounds the errors of a walk: e, of its points' coordinates, moves a cross product of two points by at most
/// 8 V e, and an arc's angle by 4 e/r, that is r^2 (t - sin t)/2 by at most 4 r e. So n stretches are off by n (4 V + 4
/// r) e in all; the roundings of MPFR, of r^2 t, by n r^2 2^(4 - precision).
struct Fineness {
  int bits;
  mpfr_prec_t precision;

  Fineness(const Arrangement& arrangement, const std::vector<Stretch>& walk, double max_speed) {
    double largest = max_speed;
    for (const Stretch& s : walk)
      if (arrangement.curve(s).is_arc) largest = std::max(largest, arrangement.curve(s).circle.radius.get_d());
    const int speed = std::ilogb(max_speed), radius = std::ilogb(largest) + 1;
    const int count = std::ilogb(static_cast<double>(walk.size())) + 1;
    bits = kBits + count + radius + 4 - 2 * speed;
    precision = kBits + count + 8 + 2 * (radius - speed) + 64;
  }
};

PointBracket bracket_of(const Point& x, double max_speed) {
  const int bits = kBits - std::ilogb(max_speed);
  const RationalVector at = approximate(x, bits);
  return {bracket_of(at.x, -bits), bracket_of(at.y, -bits)};
}

// Green's theorem: the triangles with the origin, and the segments between arcs and their chords.
/// The area that the walk goes round: at most 2^-48 max_speed^2 wide, or as narrow as doubles are there.
geometry::Bracket area_of(const Arrangement& arrangement, const std::vector<Stretch>& walk, double max_speed) {
  const Fineness fineness(arrangement, walk, max_speed);
  Rational twice = 0;
  for (const Stretch& s : walk) {
    const RationalVector from = approximate(arrangement.point(s.from), fineness.bits);
    const RationalVector to = approximate(arrangement.point(s.to), fineness.bits);
    twice += cross(from, to);
    const Curve& c = arrangement.curve(s);
    if (!c.is_arc) continue;
    const RationalVector a = from - c.circle.centre, b = to - c.circle.centre;
    const Rational r2 = c.circle.radius * c.circle.radius;
    if (c.is_counter_clockwise) twice += r2 * angle_without_sine(a, b, fineness.precision);
    if (!c.is_counter_clockwise) twice -= r2 * angle_without_sine(b, a, fineness.precision);
  }
  return bracket_of(twice / 2, 2 * std::ilogb(max_speed) - kBits + 1);
}

}  // namespace
}  // namespace exactvo::vo::detail

namespace exactvo::vo {
namespace {

using detail::Arrangement;
using detail::Owner;
using detail::Stretch;
using geometry::Bracket;

bool overlap_any(const std::vector<ShiftedCone>& cones) {
  return std::any_of(cones.begin(), cones.end(), [](const ShiftedCone& c) { return c.cone.overlaps(); });
}

/// The cones' boundaries come last: a stretch that they share with another owner is that one's.
void add_cones(const std::vector<ShiftedCone>& cones, std::vector<Owner>& owners) {
  for (const ShiftedCone& cone : cones) owners.push_back(detail::outside_of(cone));
}

template <class Work>
auto guarded(const std::vector<ShiftedCone>& cones, Work&& work) {
  const auto values = [&] {
    std::string text;
    for (const ShiftedCone& c : cones) text += (text.empty() ? "" : "; ") + geometry::excerpt(c.cone.grown().shape);
    return text;
  };
  return geometry::detail::without_cgal_failures("FreeArrangement", values, std::forward<Work>(work));
}

/// Two legs, and over the front an arc round each centre with an edge between two.
std::size_t most_curves_of(const std::vector<ShiftedCone>& cones) {
  std::size_t most = 0;
  for (const ShiftedCone& cone : cones) most += 2 * detail::exact_sum(cone.cone).centres.size() + 1;
  return most;
}

/// REQUIRES: cones that can be held. A cone in contact has no curves: it forbids everything.
bool has_too_many_curves(const std::vector<ShiftedCone>& cones) {
  if (most_curves_of(cones) <= kMostCurves) return false;
  std::size_t curves = 0;
  for (const ShiftedCone& cone : cones)
    if (!cone.cone.overlaps()) curves += FreeArrangement::curves_of(cone);
  return curves > kMostCurves;
}

/// The brackets of an arrangement's points, each computed once: the arcs that meet in a point show the same numbers, in
/// every piece. (A number that was approximated more closely in between would be rounded otherwise.)
class ShownPoints {
 public:
  ShownPoints(const Arrangement& arrangement, double max_speed) : arrangement_(arrangement), max_speed_(max_speed) {}

  const PointBracket& at(std::size_t point) {
    const auto known = brackets_.find(point);
    if (known != brackets_.end()) return known->second;
    return brackets_.emplace(point, detail::bracket_of(arrangement_.point(point), max_speed_)).first->second;
  }

 private:
  const Arrangement& arrangement_;
  double max_speed_;
  std::map<std::size_t, PointBracket> brackets_;
};

FreeArc shown(const Arrangement& arrangement, const Stretch& s, ShownPoints& points) {
  const detail::Curve& c = arrangement.curve(s);
  FreeArc out{c.kind, c.owner == 0 ? 0 : c.owner - 1, points.at(s.from), points.at(s.to), {}, 0.0, 0};
  if (!c.is_arc) return out;
  out.center = {c.circle.centre.x.get_d(), c.circle.centre.y.get_d()};
  out.radius = c.circle.radius.get_d();
  out.turn = c.is_counter_clockwise ? 1 : -1;
  return out;
}

/// The speed's circle is cut in two for the arrangement's sake: whether b goes on where a ends.
bool is_one_arc(const Arrangement& arrangement, const Stretch& a, const Stretch& b) {
  return arrangement.curve(a).kind == ArcKind::speed_circle && arrangement.curve(b).kind == ArcKind::speed_circle;
}

/// Neighbours on the speed's circle are one arc, unless the walk is all of it.
std::vector<Stretch> merged(const Arrangement& arrangement, std::vector<Stretch> walk) {
  const auto starts_anew = [&](std::size_t i) {
    return !is_one_arc(arrangement, walk[(i + walk.size() - 1) % walk.size()], walk[i]);
  };
  std::size_t first = 0;
  while (first < walk.size() && !starts_anew(first)) ++first;
  if (first == walk.size()) return walk;
  std::rotate(walk.begin(), walk.begin() + static_cast<std::ptrdiff_t>(first), walk.end());
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    if (i > 0 && is_one_arc(arrangement, walk[i - 1], walk[i])) {
      out.back().to = walk[i].to;
    } else {
      out.push_back(walk[i]);
    }
  }
  return out;
}

std::vector<FreePiece> pieces_of(const Arrangement& arrangement, double max_speed) {
  std::vector<FreePiece> pieces;
  ShownPoints points(arrangement, max_speed);
  for (const std::vector<Stretch>& walk : arrangement.walks()) {
    FreePiece piece{{}, detail::area_of(arrangement, walk, max_speed)};
    for (const Stretch& s : merged(arrangement, walk)) piece.boundary.push_back(shown(arrangement, s, points));
    pieces.push_back(std::move(piece));
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const FreePiece& a, const FreePiece& b) { return a.area.low > b.area.low; });
  return pieces;
}

/// Towards the ends of the doubles' range CORE's expressions take minutes or divide by an exponent that is none.
bool has_size_from(double least, double x) {
  return x == 0.0 || (std::fabs(x) >= least && std::fabs(x) <= kMostArrangedNumber);
}

bool is_in_range(const HalfPlane& h) {
  return has_size_from(kLeastOfHalfPlane, h.normal.x) && has_size_from(kLeastOfHalfPlane, h.normal.y) &&
         has_size_from(kLeastOfHalfPlane, h.offset);
}

/// All numbers of the cone as they were given: obstacle, robot, horizon (which may be infinite) and apex.
bool cone_is_in_range(const ShiftedCone& cone) {
  const detail::UnroundedInput input = detail::unrounded_input(cone.cone);
  std::vector<double> numbers = geometry::numbers_of(input.obstacle);
  numbers.insert(numbers.end(), {input.position.x, input.position.y, input.radius});
  std::vector<Vec2> vectors(cone.minus_apex.terms.begin(), cone.minus_apex.terms.end());
  if (input.robot) vectors.insert(vectors.end(), input.robot->vertices.begin(), input.robot->vertices.end());
  for (const Vec2 v : vectors) numbers.insert(numbers.end(), {v.x, v.y});
  if (std::isfinite(cone.cone.time_horizon())) numbers.push_back(cone.cone.time_horizon());
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return has_size_from(kLeastArrangedNumber, x); });
}

bool is_ray(const Owner& owner) {
  return owner.kind == Owner::Kind::ray;
}

}  // namespace

const char* name(Refusal refusal) {
  constexpr const char* kNames[] = {"none", "ellipse", "cones", "curves", "range", "numbers apart"};
  return kNames[static_cast<int>(refusal)];
}

const char* name(ArcKind kind) {
  constexpr const char* kNames[] = {"speed circle", "cut-off arc", "offset edge", "leg"};
  return kNames[static_cast<int>(kind)];
}

bool FreeArrangement::can_hold(const ShiftedCone& cone) {
  return detail::exact_sum(cone.cone).body.is_disc();
}

std::size_t FreeArrangement::curves_of(const ShiftedCone& cone) {
  EXACTVO_REQUIRE(can_hold(cone) && !cone.cone.overlaps(), geometry::excerpt(cone.cone.grown().shape));
  return guarded({cone}, [&] { return detail::outside_of(cone).curves.size(); });
}

Refusal FreeArrangement::refusal_of(const std::vector<ShiftedCone>& cones, double max_speed) {
  const bool in_range = max_speed >= kLeastArrangedNumber && max_speed <= kMostArrangedNumber;
  if (!in_range || !std::all_of(cones.begin(), cones.end(), cone_is_in_range)) return Refusal::range;
  if (!std::all_of(cones.begin(), cones.end(), can_hold)) return Refusal::ellipse;
  if (cones.size() > kMostCones) return Refusal::cones;
  return has_too_many_curves(cones) ? Refusal::curves : Refusal::none;
}

// CGAL's failures alone: a requirement of ours that is broken there is a mistake, no property of the numbers.
FreeArrangement::Attempt FreeArrangement::attempt(std::vector<ShiftedCone> cones, double max_speed) {
  try {
    const Refusal refusal = refusal_of(cones, max_speed);
    if (refusal != Refusal::none) return {{}, refusal};
    return {FreeArrangement(std::move(cones), max_speed), Refusal::none};
  } catch (const geometry::detail::CgalFailure&) {
    return {{}, Refusal::numbers_apart};
  }
}

FreeArrangement::FreeArrangement(std::vector<ShiftedCone> cones, double max_speed)
    : cones_(std::move(cones)), max_speed_(max_speed) {
  const Refusal refusal = refusal_of(cones_, max_speed);
  EXACTVO_REQUIRE(refusal == Refusal::none, name(refusal));
  if (overlap_any(cones_)) return;
  guarded(cones_, [&] {
    std::vector<Owner> owners{detail::speed_disc(max_speed)};
    add_cones(cones_, owners);
    pieces_ = pieces_of(Arrangement(std::move(owners), max_speed), max_speed);
  });
}

bool FreeArrangement::contains(Vec2 v) const {
  const geometry::GrownShape disc{geometry::Disc{{}, max_speed_}, {}, 0.0};
  if (locate(disc, v) == geometry::Place::outside) return false;
  return std::none_of(cones_.begin(), cones_.end(),
                      [v](const ShiftedCone& c) { return c.cone.overlaps() || c.contains(v); });
}

Bracket FreeArrangement::area() const {
  Bracket sum;
  for (const FreePiece& piece : pieces_) {
    sum.low = std::nextafter(sum.low + piece.area.low, 0.0);
    sum.high = std::nextafter(sum.high + piece.area.high, HUGE_VAL);
  }
  return sum;
}

std::optional<bool> FreeArrangement::attempt_holds(const std::vector<HalfPlane>& half_planes) const {
  if (!std::all_of(half_planes.begin(), half_planes.end(), is_in_range)) return std::nullopt;
  try {
    return holds(half_planes);
  } catch (const geometry::detail::CgalFailure&) {
    return std::nullopt;
  }
}

// The half-planes and the disc bound a convex region. Where no cone cuts into it, no cone bounds what is left of it,
// and something is left.
bool FreeArrangement::holds(const std::vector<HalfPlane>& half_planes) const {
  std::vector<Owner> region{detail::speed_disc(max_speed_)};
  for (const HalfPlane& h : half_planes) {
    EXACTVO_REQUIRE(is_in_range(h), geometry::hex_text(h.normal.x) + " " + geometry::hex_text(h.normal.y) + " " +
                                        geometry::hex_text(h.offset));
    if (h.normal == Vec2{} && h.offset > 0.0) return true;  // allows nothing
    if (h.normal != Vec2{}) region.push_back(detail::allowed_by(h));
  }
  return guarded(cones_, [&] {
    if (Arrangement(region, max_speed_).walks().empty()) return true;
    if (overlap_any(cones_)) return false;
    const std::size_t first_cone = region.size();
    add_cones(cones_, region);
    // A ray takes no area away.
    region.erase(std::remove_if(region.begin(), region.end(), is_ray), region.end());
    const Arrangement left(std::move(region), max_speed_);
    const auto is_cone = [&](const Stretch& s) { return left.curve(s).owner >= first_cone; };
    return !left.walks().empty() && std::none_of(left.walks().begin(), left.walks().end(), [&](const auto& walk) {
      return std::any_of(walk.begin(), walk.end(), is_cone);
    });
  });
}

}  // namespace exactvo::vo
