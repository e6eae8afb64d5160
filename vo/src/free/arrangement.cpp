// SPDX-License-Identifier: GPL-3.0-or-later
#include "free/arrangement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/require.h"

namespace exactvo::vo::detail {
namespace {

/// Points farther apart than this part of the speed are told apart by their doubles, whose own error is some 2^-53 of
/// it; nearer ones by exact signs.
constexpr double kFarApart = 0x1p-30;

Vec2 rounded(const Point& x) {
  return {x.x.rounded(), x.y.rounded()};
}

/// Where a stretch leaves a point, clockwise of the way back: 0 just beside it, 1 within half a turn, 2 at half a turn,
/// 3 within the other half, 4 just before a whole turn. Of tangent ones the curvature tells; one along the way back
/// itself, the other side of a ray, comes last.
int place_clockwise(const Departure& back, const Departure& d) {
  const int side = cross(back.heading, d.heading).sign();
  if (side != 0) return side < 0 ? 1 : 3;
  if (dot(back.heading, d.heading).sign() < 0) return 2;
  return d.curvature < back.curvature ? 0 : 4;
}

/// Whether a comes before b on the way clockwise from the way back.
bool comes_first(const Departure& back, const Departure& a, const Departure& b) {
  const int of_a = place_clockwise(back, a), of_b = place_clockwise(back, b);
  if (of_a != of_b) return of_a < of_b;
  const int turn = cross(a.heading, b.heading).sign();
  return turn != 0 ? turn < 0 : a.curvature > b.curvature;
}

}  // namespace

// A coordinate of a point within reach, an anchor or a centre errs by a few u of its size; so do differences, and a
// distance to a line by as much of what is multiplied with its unit normal. kFarApart of all sizes is more by far.
RoundedOwner::RoundedOwner(const Owner& owner, double margin) {
  if (owner.kind == Owner::Kind::disc) return;
  for (const Curve& c : owner.curves) {
    Side side;
    side.anchor = rounded(c.anchor);
    side.left = perp(geometry::normalized(rounded(c.direction)));
    side.has_disc = c.is_arc;
    if (c.is_arc) {
      side.centre = {c.circle.centre.x.get_d(), c.circle.centre.y.get_d()};
      side.radius = c.circle.radius.get_d();
    }
    side.margin = margin + kFarApart * (norm(side.anchor) + norm(side.centre) + side.radius);
    sides_.push_back(side);
  }
}

bool RoundedOwner::forbids(Vec2 x) const {
  if (sides_.empty()) return false;
  return std::all_of(sides_.begin(), sides_.end(), [x](const Side& s) {
    // Written so that a NaN tells nothing.
    return dot(s.left, x - s.anchor) < -s.margin || (s.has_disc && norm(x - s.centre) < s.radius - s.margin);
  });
}

Arrangement::Arrangement(std::vector<Owner> owners, double max_speed)
    : owners_(std::move(owners)), max_speed_(max_speed) {
  for (const Owner& owner : owners_) rounded_owners_.emplace_back(owner, kFarApart * max_speed);
  for (std::size_t o = 0; o < owners_.size(); ++o) {
    for (Curve& c : owners_[o].curves) {
      c.owner = o;
      curves_.push_back(c);
    }
  }
  cuts_.resize(curves_.size());
  coinciding_.resize(curves_.size());
  for (std::size_t a = 0; a < curves_.size(); ++a) {
    if (curves_[a].has_from) cuts_[a].push_back(index_of(curves_[a].from));
    if (curves_[a].has_to) cuts_[a].push_back(index_of(curves_[a].to));
    for (std::size_t b = 0; b < a; ++b)
      if (curves_[a].owner != curves_[b].owner) cut_at_common_points(a, b);
  }
  std::vector<Stretch> boundary;
  for (std::size_t k = 0; k < curves_.size(); ++k)
    for (const Stretch& s : stretches_of(k))
      if (is_boundary(s)) boundary.push_back(s);
  walk_all(boundary);
}

void Arrangement::cut_at_ends_of(std::size_t a, std::size_t b) {
  const Curve& c = curves_[b];
  if (c.has_from && curves_[a].reaches(c.from)) cuts_[a].push_back(index_of(c.from));
  if (c.has_to && curves_[a].reaches(c.to)) cuts_[a].push_back(index_of(c.to));
}

void Arrangement::cut_at_common_points(std::size_t a, std::size_t b) {
  if (coincide(curves_[a], curves_[b])) {
    coinciding_[a].push_back(b);
    coinciding_[b].push_back(a);
    cut_at_ends_of(a, b);
    cut_at_ends_of(b, a);
    return;
  }
  for (const Point& x : common_points(curves_[a], curves_[b])) {
    const Vec2 at = rounded(x);
    if (is_out_of_reach(at) || is_hidden(at, curves_[a].owner, curves_[b].owner)) continue;
    if (!curves_[a].reaches(x) || !curves_[b].reaches(x)) continue;
    const std::size_t k = index_of(x);
    cuts_[a].push_back(k);
    cuts_[b].push_back(k);
  }
}

/// Beyond the disc by more than any rounding: nothing there bounds anything.
bool Arrangement::is_out_of_reach(Vec2 rounded) const {
  return !(std::hypot(rounded.x, rounded.y) <= (1.0 + kFarApart) * max_speed_);
}

/// Where a curve enters or leaves what all allow, no owner forbids a neighbourhood of the point. So a cut that a third
/// one hides may be left out: all of the stretch that it would have ended is hidden, up to the cuts that are kept.
bool Arrangement::is_hidden(Vec2 rounded, std::size_t owner_a, std::size_t owner_b) const {
  for (std::size_t o = 0; o < rounded_owners_.size(); ++o)
    if (o != owner_a && o != owner_b && rounded_owners_[o].forbids(rounded)) return true;
  return false;
}

std::size_t Arrangement::index_of(const Point& x) {
  const Vec2 at = rounded(x);
  const double near = kFarApart * (max_speed_ + std::fabs(at.x) + std::fabs(at.y));
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (std::fabs(rounded_[k].x - at.x) > near || std::fabs(rounded_[k].y - at.y) > near) continue;
    if ((points_[k].x - x.x).sign() == 0 && (points_[k].y - x.y).sign() == 0) return k;
  }
  points_.push_back(x);
  rounded_.push_back(at);
  return points_.size() - 1;
}

std::vector<Stretch> Arrangement::stretches_of(std::size_t curve) {
  const Curve& c = curves_[curve];
  std::vector<std::size_t> cuts = cuts_[curve];
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::sort(cuts.begin(), cuts.end(),
            [&](std::size_t i, std::size_t k) { return i != k && c.position(points_[i]) < c.position(points_[k]); });
  std::vector<Stretch> out;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) out.push_back({curve, cuts[i], cuts[i + 1]});
  return out;
}

/// The middle of an arc that is no more than half of its circle lies over the middle of its chord.
Point Arrangement::middle_of(const Stretch& s) const {
  const Curve& c = curves_[s.curve];
  const Point &from = points_[s.from], &to = points_[s.to];
  if (!c.is_arc) return Number(0.5) * (from + to);
  const Point left = perp(to - from), out = c.is_counter_clockwise ? Number(-1) * left : left;
  return detail::point(c.circle.centre) + quotient(Number(c.circle.radius), root_of(dot(out, out))) * out;
}

// Where the owner's boundary runs along the stretch, it allows the stretch's left side if some curve of its runs the
// same way: a ray has curves both ways there. The stretch then counts for the first owner that it bounds on this side.
bool Arrangement::passes(std::size_t owner, const Stretch& s, const Point& middle) const {
  const Curve& own = curves_[s.curve];
  bool runs_along = false;
  for (const std::size_t k : coinciding_[s.curve]) {
    const Curve& other = curves_[k];
    if (other.owner != owner || !other.reaches(middle)) continue;
    runs_along = true;
    const bool same_side = own.is_arc ? own.is_counter_clockwise == other.is_counter_clockwise
                                      : dot(own.direction, other.direction).sign() > 0;
    if (same_side) return own.owner < owner;
  }
  return !runs_along && owners_[owner].allows(middle);
}

bool Arrangement::is_boundary(const Stretch& s) const {
  const Vec2 mean = 0.5 * (rounded_[s.from] + rounded_[s.to]);
  if (!curves_[s.curve].is_arc && is_out_of_reach(mean)) return false;
  const Point middle = middle_of(s);
  for (std::size_t o = 0; o < owners_.size(); ++o)
    if (o != curves_[s.curve].owner && !passes(o, s, middle)) return false;
  return true;
}

Departure Arrangement::leaving(const Stretch& s) const {
  const Curve& c = curves_[s.curve];
  return {heading(s, s.from), c.curvature()};
}

// Seen the other way, what bends to the left bends to the right.
Departure Arrangement::way_back(const Stretch& s) const {
  const Curve& c = curves_[s.curve];
  return {Number(-1) * heading(s, s.to), Rational(-c.curvature())};
}

/// The direction of the stretch at one of its ends.
Point Arrangement::heading(const Stretch& s, std::size_t at) const {
  const Curve& c = curves_[s.curve];
  if (!c.is_arc) return c.direction;
  const Point left = perp(points_[at] - detail::point(c.circle.centre));
  return c.is_counter_clockwise ? left : Number(-1) * left;
}

// Arriving at a point where several stretches leave, what is allowed lies clockwise of the way back: the first one met
// that way bounds it.
//
//            \  allowed  ^
//             \  .--->  /
//     --------->o -----'  next
void Arrangement::walk_all(const std::vector<Stretch>& stretches) {
  std::vector<std::vector<std::size_t>> starting(points_.size());
  for (std::size_t i = 0; i < stretches.size(); ++i) starting[stretches[i].from].push_back(i);
  const auto next_of = [&](std::size_t i) {
    const std::vector<std::size_t>& choices = starting[stretches[i].to];
    EXACTVO_REQUIRE(!choices.empty(), "a boundary that ends");
    if (choices.size() == 1) return choices.front();
    const Departure back = way_back(stretches[i]);
    return *std::min_element(choices.begin(), choices.end(), [&](std::size_t a, std::size_t b) {
      return a != b && comes_first(back, leaving(stretches[a]), leaving(stretches[b]));
    });
  };
  std::vector<bool> walked(stretches.size(), false);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    std::vector<Stretch> walk;
    for (std::size_t k = i; !walked[k]; k = next_of(k)) {
      walked[k] = true;
      walk.push_back(stretches[k]);
    }
    if (!walk.empty()) walks_.push_back(std::move(walk));
  }
}

}  // namespace exactvo::vo::detail
