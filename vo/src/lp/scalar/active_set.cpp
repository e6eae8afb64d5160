// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/scalar/active_set.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/infinity.h"

namespace exactvo::lp {
namespace {

using geometry::kInfinity;

/// Where the objective would like to be on the line q + s d: at the foot of `preferred`, or at one of its ends.
double wish_on(Vec2 d, double squared_length, Objective objective, Vec2 preferred) {
  const double along = dot(preferred, d);
  if (objective == Objective::nearest) return along / squared_length;
  return along == 0.0 ? 0.0 : std::copysign(kInfinity, along);
}

/// The part of a line that is left, and what cut it off.
struct Stretch {
  double low = -kInfinity, high = kInfinity;
  std::size_t low_owner = kNoPosition, high_owner = kNoPosition;
  bool empty = false;

  void keep_above(double s, std::size_t owner) {
    if (s > low) low = s, low_owner = owner;
  }
  void keep_below(double s, std::size_t owner) {
    if (s < high) high = s, high_owner = owner;
  }
};

Stretch inside_disc(const Line& line, double disc) {
  Stretch stretch;
  if (std::isinf(disc)) return stretch;
  const double room = disc * disc - line.offset * line.offset / line.squared_length;
  if (room < 0.0) {
    stretch.empty = line.offset > 0.0;
    if (!stretch.empty) return stretch;
    stretch.low_owner = kDiscPosition;
    return stretch;
  }
  const double reach = std::sqrt(room / line.squared_length);
  stretch.keep_above(-reach, kDiscPosition);
  stretch.keep_below(reach, kDiscPosition);
  return stretch;
}

/// Cuts the stretch of q + s d with `other`.
void cut(Stretch& stretch, Vec2 q, Vec2 d, const Line& other, std::size_t owner, double speed) {
  const double slope = dot(other.normal, d);
  const double missing = excess(other, q);
  if (slope > 0.0) {
    stretch.keep_above(missing / slope, owner);
  } else if (slope < 0.0) {
    stretch.keep_below(missing / slope, owner);
  } else if (missing > kNoise * speed * std::sqrt(other.squared_length)) {
    stretch = {0.0, 0.0, owner, kNoPosition, true};
  }
}

Found contradiction(std::size_t line, const Stretch& stretch, Vec2 at) {
  Found found;
  found.velocity = at;
  found.basis.add(line);
  if (stretch.low_owner != kNoPosition) found.basis.add(stretch.low_owner);
  if (stretch.high_owner != kNoPosition && stretch.high_owner != stretch.low_owner) found.basis.add(stretch.high_owner);
  return found;
}

/// Lines, and where they stand in the region.
struct Members {
  std::array<const Line*, 3> lines{};
  std::array<std::size_t, 3> positions{};
  std::size_t count = 0;
  void add(const Line& line, std::size_t position) {
    lines[count] = &line;
    positions[count++] = position;
  }
};

/// The lines of a basis, without the disc.
Members members_of(const Basis& basis, const Region& region) {
  Members members;
  for (std::size_t k = 0; k < basis.size; ++k)
    if (basis.member[k] < region.lines.size()) members.add(region.lines[basis.member[k]], basis.member[k]);
  return members;
}

/// The optimum on the boundary of `line` inside the others and the disc.
Found best_on_line(const Line& line, std::size_t position, const Members& others, const Region& region,
                   Objective objective, Vec2 preferred) {
  const Vec2 q = (line.offset / line.squared_length) * line.normal;
  const Vec2 d = perp(line.normal);
  Stretch stretch = inside_disc(line, region.disc);
  for (std::size_t k = 0; k < others.count && !stretch.empty; ++k)
    cut(stretch, q, d, *others.lines[k], others.positions[k], region.speed);
  if (stretch.empty || !(stretch.low <= stretch.high)) return contradiction(position, stretch, q);

  Found found;
  found.feasible = true;
  found.basis.add(position);
  double s = wish_on(d, line.squared_length, objective, preferred);
  if (s > stretch.high) {
    s = stretch.high;
    found.basis.add(stretch.high_owner);
  } else if (s < stretch.low) {
    s = stretch.low;
    found.basis.add(stretch.low_owner);
  }
  found.velocity = q + s * d;
  return found;
}

Vec2 onto_disc(Vec2 v, double disc) {
  return disc * normalized(v);
}

/// The optimum over the disc alone. REQUIRES: for a linear objective a finite disc.
Found start_of(const Region& region, Objective objective, Vec2 preferred) {
  Found found;
  found.feasible = true;
  if (objective == Objective::farthest) {
    found.velocity = onto_disc(preferred, region.disc);
    found.basis.add(kDiscPosition);
    return found;
  }
  found.velocity = preferred;
  if (norm(preferred) <= region.disc) return found;
  found.velocity = onto_disc(preferred, region.disc);
  found.basis.add(kDiscPosition);
  return found;
}

/// What rounding may leave of the line's excess: with short normals, as much less.
double noise_of(const Line& line, double speed) {
  return kNoise * speed * std::min(1.0, std::abs(line.normal.x) + std::abs(line.normal.y));
}

/// The position of the line violated most at v beyond rounding, `level` being what soft lines may be violated by.
std::size_t most_violated(const Region& region, Vec2 v, double level, const Basis& basis) {
  std::size_t worst = kNoPosition;
  double most = 0.0;
  for (std::size_t k = 0; k < region.lines.size(); ++k) {
    const Line& line = region.lines[k];
    const double by = excess(line, v) - (line.soft ? level : 0.0);
    if (by > most && by > noise_of(line, region.speed) && !basis.has(k)) most = by, worst = k;
  }
  return worst;
}

/// `region` within a disc of that radius where it has none.
Region within_disc(const Region& region, double radius) {
  Region bounded = region;
  if (std::isinf(bounded.disc)) bounded.disc = radius;
  return bounded;
}

Found search_best(const Region& region, Objective objective, Vec2 preferred, std::vector<Vec2>* priced) {
  Found found = start_of(region, objective, preferred);
  for (int round = 0; round < kMostRounds; ++round) {
    if (priced) priced->push_back(found.velocity);
    const std::size_t entering = most_violated(region, found.velocity, 0.0, found.basis);
    if (entering == kNoPosition) return found;
    found =
        best_on_line(region.lines[entering], entering, members_of(found.basis, region), region, objective, preferred);
    if (!found.feasible) return found;
  }
  return found;
}

}  // namespace

Found best_velocity(const Region& region, Objective objective, Vec2 preferred, std::vector<Vec2>* priced) {
  if (objective == Objective::nearest || std::isfinite(region.disc))
    return search_best(region, objective, preferred, priced);
  // On a line alone a linear objective has no optimum: a disc beyond the corners of the box stands for what bounds it.
  return search_best(within_disc(region, 2.0 * region.speed), objective, preferred, priced);
}

// The least violation: lines of the space (v_x, v_y, t), where a soft line is the plane t = offset - normal . v. The
// first to enter is soft, and from then on every basis holds a soft line.

namespace {

/// Without a speed bound the least violation lies among the vertices of the soft lines; those beyond this multiple of
/// the data's own speed are left to the exact stage.
constexpr double kFarAway = 0x1p20;

struct Level {
  Found found;
  double level = -kInfinity;
};

/// Where two planes meet, as seen from above: other's plane is not above `top`'s.
Line below(const Line& top, const Line& other) {
  if (!other.soft) return other;
  Line line = other;
  line.normal = other.normal - top.normal;
  line.offset = other.offset - top.offset;
  line.squared_length = squared_norm(line.normal);
  return line;
}

/// The lowest point of the plane of soft line `top` above the planes of the basis and inside its hard lines.
Level lowest_on_plane(std::size_t top, const Basis& basis, const Region& region) {
  const Line& plane = region.lines[top];
  const Members members = members_of(basis, region);
  std::array<Line, 3> projected;
  Members before;
  Found found;
  found.feasible = true;
  found.velocity = onto_disc(plane.normal, region.disc);
  found.basis.add(kDiscPosition);
  for (std::size_t k = 0; k < members.count && found.feasible; ++k) {
    const Line& line = projected[k] = below(plane, *members.lines[k]);
    if (line.squared_length == 0.0) continue;
    if (excess(line, found.velocity) > 0.0)
      found = best_on_line(line, members.positions[k], before, region, Objective::farthest, plane.normal);
    before.add(line, members.positions[k]);
  }
  Basis with_top;
  with_top.add(top);
  for (std::size_t k = 0; k < found.basis.size && k < 2; ++k) with_top.add(found.basis.member[k]);
  found.basis = with_top;
  return {found, excess(plane, found.velocity)};
}

/// Height of the soft planes of `members` over v, and which is highest.
double height_over(Vec2 v, const Members& members, std::size_t& highest) {
  double height = -kInfinity;
  for (std::size_t k = 0; k < members.count; ++k) {
    if (!members.lines[k]->soft) continue;
    const double t = excess(*members.lines[k], v);
    if (t > height) height = t, highest = k;
  }
  return height;
}

/// The point of the hard line `wall` where the soft planes of the basis are lowest: an end of what the hard ones leave,
/// or a crossing of two planes.
Level lowest_on_wall(std::size_t wall, const Basis& basis, const Region& region) {
  const Line& line = region.lines[wall];
  const Members members = members_of(basis, region);
  const Vec2 q = (line.offset / line.squared_length) * line.normal;
  const Vec2 d = perp(line.normal);
  Stretch stretch = inside_disc(line, region.disc);
  for (std::size_t k = 0; k < members.count && !stretch.empty; ++k)
    if (!members.lines[k]->soft) cut(stretch, q, d, *members.lines[k], members.positions[k], region.speed);
  if (stretch.empty || !(stretch.low <= stretch.high)) return {contradiction(wall, stretch, q), -kInfinity};

  Level best;
  best.level = kInfinity;
  const auto consider = [&](double s, std::size_t owner) {
    if (!(s >= stretch.low && s <= stretch.high)) return;
    std::size_t highest = 0;
    const double height = height_over(q + s * d, members, highest);
    if (!(height < best.level)) return;
    best = {{true, q + s * d, {}}, height};
    best.found.basis.add(wall);
    best.found.basis.add(members.positions[highest]);
    if (owner != kNoPosition && owner != members.positions[highest]) best.found.basis.add(owner);
  };
  consider(stretch.low, stretch.low_owner);
  consider(stretch.high, stretch.high_owner);
  for (std::size_t j = 0; j < members.count; ++j) {
    for (std::size_t k = j + 1; k < members.count; ++k) {
      const Line& a = *members.lines[j];
      const Line& b = *members.lines[k];
      if (!a.soft || !b.soft) continue;
      const double slope = dot(a.normal - b.normal, d);
      if (slope == 0.0) continue;
      const double s = (excess(a, q) - excess(b, q)) / slope;
      std::size_t highest = 0;
      height_over(q + s * d, members, highest);
      consider(s, highest == j ? members.positions[k] : members.positions[j]);
    }
  }
  return best;
}

}  // namespace

Found least_violation(const Region& given, Region& with_disc) {
  const bool has_disc = std::isfinite(given.disc);
  if (!has_disc) {
    with_disc = given;
    with_disc.disc = kFarAway * given.speed;
  }
  const Region& region = has_disc ? given : with_disc;
  Level now;
  now.found.feasible = true;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::size_t entering = most_violated(region, now.found.velocity, now.level, now.found.basis);
    if (entering == kNoPosition) return now.found;
    const bool soft = region.lines[entering].soft;
    const Level next =
        soft ? lowest_on_plane(entering, now.found.basis, region) : lowest_on_wall(entering, now.found.basis, region);
    if (!next.found.feasible) return now.found;
    now = next;
  }
  return now.found;
}

}  // namespace exactvo::lp
