// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/free_arrangement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "cgal_guard.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shape_numbers.h"
#include "free/arc_measure.h"

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

/// Of cones that can be held. A cone in contact has no curves: it forbids everything.
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

/// A half-plane without a normal allows everything or nothing.
bool allows_nothing(const HalfPlane& h) {
  return h.normal == Vec2{} && h.offset > 0.0;
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
    if (allows_nothing(h)) return true;
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
