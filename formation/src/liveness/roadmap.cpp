// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/roadmap.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace exactvo::formation::detail {
namespace {

// In diameters.
constexpr double kPitch = 1.06;
constexpr double kLongestWay = 1.6;
constexpr double kCell = 2.0;
constexpr double kFine = 0.125;       ///< the grid of points that guards must see
constexpr double kSeesWithin = 0.8;   ///< of a guard
constexpr double kLatticeGap = 0.03;  ///< beside the radius
constexpr double kGuardGap = 0.02;
constexpr double kWayGap = 0.01;
constexpr double kNarrow = 1.5;  ///< where clearance is more, the lattice is enough

/// Which places are joined by ways.
class Parts {
 public:
  explicit Parts(std::size_t size) : up_(size) { std::iota(up_.begin(), up_.end(), 0u); }
  PlaceNumber of(PlaceNumber p) {
    while (up_[p] != p) p = up_[p] = up_[up_[p]];
    return p;
  }
  void join(PlaceNumber a, PlaceNumber b) { up_[of(a)] = of(b); }
  void add() { up_.push_back(static_cast<PlaceNumber>(up_.size())); }

 private:
  std::vector<PlaceNumber> up_;
};

}  // namespace

Roadmap::Roadmap(const FreeSpace& space, const geometry::Box& region, double radius)
    : space_(&space),
      diameter_(2.0 * radius),
      way_clearance_(radius + kWayGap * diameter_),
      longest_(kLongestWay * diameter_) {
  add_lattice(region);
  const std::vector<FreePoint> narrow = space.is_open() ? std::vector<FreePoint>{} : narrow_points(region);
  add_guards(narrow);
  add_ways();
  add_connectors(narrow);
}

Roadmap::Cell Roadmap::cell_of(Vec2 p) const {
  const double side = kCell * diameter_;
  return {static_cast<std::int32_t>(std::floor(p.x / side)), static_cast<std::int32_t>(std::floor(p.y / side))};
}

std::uint64_t Roadmap::key_of(Cell c) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(c.x)) << 32) | static_cast<std::uint32_t>(c.y);
}

PlaceNumber Roadmap::add(Vec2 place) {
  const auto number = static_cast<PlaceNumber>(places_.size());
  places_.push_back(place);
  ways_.emplace_back();
  blocked_.push_back(0);
  cells_[key_of(cell_of(place))].push_back(number);
  return number;
}

void Roadmap::link(PlaceNumber a, PlaceNumber b) {
  ways_[a].push_back(b);
  ways_[b].push_back(a);
}

void Roadmap::add_lattice(const geometry::Box& region) {
  const double pitch = kPitch * diameter_, least = 0.5 * diameter_ + kLatticeGap * diameter_;
  const auto columns = static_cast<int>((region.high.x - region.low.x) / pitch);
  const auto rows = static_cast<int>((region.high.y - region.low.y) / pitch);
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) {
      const Vec2 p = region.low + Vec2{x * pitch, y * pitch};
      if (space_->clearance(p, least) >= least) add(p);
    }
}

/// Points of a fine grid that are not far from what stands, the roomiest first.
std::vector<Roadmap::FreePoint> Roadmap::narrow_points(const geometry::Box& region) const {
  const double step = kFine * diameter_, least = 0.5 * diameter_ + kGuardGap * diameter_, most = kNarrow * diameter_;
  const auto columns = static_cast<int>((region.high.x - region.low.x) / step);
  const auto rows = static_cast<int>((region.high.y - region.low.y) / step);
  std::vector<FreePoint> points;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) {
      const Vec2 p = region.low + Vec2{x * step, y * step};
      const double clearance = space_->clearance(p, most);
      if (clearance >= least && clearance < most) points.push_back({clearance, p});
    }
  std::stable_sort(points.begin(), points.end(),
                   [](const FreePoint& a, const FreePoint& b) { return a.clearance > b.clearance; });
  return points;
}

void Roadmap::add_guards(const std::vector<FreePoint>& narrow) {
  for (const FreePoint& point : narrow) {
    bool is_seen = false;
    for_each_near(point.place, kSeesWithin * diameter_, [&](PlaceNumber p) {
      is_seen = is_seen || space_->is_clear(point.place, places_[p], way_clearance_);
    });
    if (!is_seen) add(point.place);
  }
}

void Roadmap::add_ways() {
  for (PlaceNumber a = 0; a < places_.size(); ++a)
    for_each_near(places_[a], longest_, [&](PlaceNumber b) {
      if (b > a && space_->is_clear(places_[a], places_[b], way_clearance_)) link(a, b);
    });
}

void Roadmap::add_connectors(const std::vector<FreePoint>& narrow) {
  Parts parts(places_.size());
  for (PlaceNumber a = 0; a < places_.size(); ++a)
    for (const PlaceNumber b : ways_[a]) parts.join(a, b);
  constexpr int kRounds = 2;  // what one connector joins another may join with more
  for (int round = 0; round < kRounds; ++round)
    for (const FreePoint& point : narrow) {
      std::vector<PlaceNumber> near, seen;
      for_each_near(point.place, longest_, [&](PlaceNumber p) { near.push_back(p); });
      const auto in_two_parts = [&](const std::vector<PlaceNumber>& some) {
        return std::any_of(some.begin(), some.end(), [&](PlaceNumber p) { return parts.of(p) != parts.of(some[0]); });
      };
      if (!in_two_parts(near)) continue;
      for (const PlaceNumber p : near)
        if (space_->is_clear(point.place, places_[p], way_clearance_)) seen.push_back(p);
      if (!in_two_parts(seen)) continue;
      const PlaceNumber connector = add(point.place);
      parts.add();
      for (const PlaceNumber p : seen) {
        link(connector, p);
        parts.join(connector, p);
      }
    }
}

PlaceNumber Roadmap::attach(Vec2 place) {
  constexpr double kSame = 1e-9;  // diameters
  std::vector<PlaceNumber> near, same;
  for_each_near(place, longest_, [&](PlaceNumber p) {
    if (squared_norm(places_[p] - place) <= kSame * kSame * diameter_ * diameter_) same.push_back(p);
    near.push_back(p);
  });
  if (!same.empty()) return same.front();
  // A disc that stands nearer to something leaves as it stands.
  const double stands = space_->clearance(place, way_clearance_) - kSame * diameter_;
  const double least = std::min(way_clearance_, stands);
  const PlaceNumber number = add(place);
  for (const PlaceNumber p : near)
    if (!blocked_[p] && space_->is_clear(place, places_[p], least)) link(number, p);
  return number;
}

void Roadmap::block(Vec2 centre, double keep) {
  const auto drop = [&](PlaceNumber a, PlaceNumber b) {
    ways_[a].erase(std::remove(ways_[a].begin(), ways_[a].end(), b), ways_[a].end());
  };
  for_each_near(centre, keep + longest_, [&](PlaceNumber a) {
    if (squared_norm(places_[a] - centre) < keep * keep) blocked_[a] = 1;
    for (const PlaceNumber b : std::vector<PlaceNumber>(ways_[a]))
      if (squared_distance(centre, places_[a], places_[b]) < keep * keep) {
        drop(a, b);
        drop(b, a);
      }
  });
}

}  // namespace exactvo::formation::detail
