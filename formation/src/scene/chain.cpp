// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/chain.h"

#include <cmath>

namespace exactvo::formation::detail {
namespace {

/// m: a part of a turn by which a disc moves no more than this is not divided further.
constexpr double kFinestTurn = 1e-4;

struct Link {
  const FreeSpace& space;
  Vec2 at, way;   ///< m, of the reference point
  double behind;  ///< m
  double room;    ///< m

  /// While the heading turns from `a` to `b`, unit vectors less than a right angle apart: the disc about the middle,
  /// and how far it moves from there.
  bool is_clear(Vec2 a, Vec2 b) const {
    const Vec2 middle = geometry::normalized(a + b), from = at - behind * middle;
    const double moves = std::fabs(behind) * norm(a - middle);
    if (space.is_clear(from, from + way, room + moves)) return true;
    return moves > kFinestTurn && is_clear(a, middle) && is_clear(middle, b);
  }
};

}  // namespace

bool links_are_clear(const FreeSpace& space, const DifferentialDrive& drive, Vec2 at, Vec2 heading, Vec2 u,
                     double braking_time) {
  constexpr double kStraightBack = 1e-9;  // it may turn to either side
  const Vec2 towards = u == Vec2{} ? heading : geometry::normalized(u), left{-heading.y, heading.x};
  const double side = cross(heading, towards);
  const bool is_behind = dot(heading, towards) < 0.0;
  for (std::size_t k = 1; k < drive.chain.size(); ++k) {
    const geometry::Disc& disc = drive.chain[k];
    const Link link{space, at, braking_time * u, drive.reference - disc.center.x, disc.radius + kRoomOfLinks};
    const auto by_way_of = [&](Vec2 across) {
      return link.is_clear(heading, across) && link.is_clear(across, towards);
    };
    const bool clear = !is_behind
                           ? link.is_clear(heading, towards)
                           : (side < -kStraightBack || by_way_of(left)) && (side > kStraightBack || by_way_of(-left));
    if (!clear) return false;
  }
  return true;
}

}  // namespace exactvo::formation::detail
