// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/roadmap.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>

#include "exactvo/geometry/pi.h"

namespace exactvo::formation::detail {
namespace {

// In diameters.
constexpr double kPitch = 1.06;
constexpr double kLongestWay = 1.6;
constexpr double kCell = 2.0;
constexpr double kFine = 0.125;       ///< the grid of points that guards must see
constexpr double kSeesWithin = 0.8;   ///< of a guard
constexpr double kDense = 0.5;        ///< the same for a dense map
constexpr double kLatticeGap = 0.03;  ///< beside the radius
constexpr double kGuardGap = 0.02;
constexpr double kNarrow = 1.5;  ///< where clearance is more, the lattice is enough

}  // namespace

Roadmap::Roadmap(const FreeSpace& space, const geometry::Box& region, double radius, Detail detail)
    : space_(&space),
      diameter_(2.0 * radius),
      way_clearance_(radius + kWayGap * diameter_),
      longest_(kLongestWay * diameter_),
      cells_(kCell * diameter_) {
  add_lattice(region);
  const std::vector<FreePoint> narrow = space.is_open() ? std::vector<FreePoint>{} : narrow_points(region);
  add_guards(narrow, detail);
  if (detail == Detail::walls) add_places_beside_walls();
  add_ways();
  add_connectors(narrow);
}

double Roadmap::lattice_places(const geometry::Box& region, double radius) {
  const Vec2 size = (region.high - region.low) / (kPitch * 2.0 * radius);
  return (size.x + 1.0) * (size.y + 1.0);
}

PlaceNumber Roadmap::add(Vec2 place) {
  const auto number = static_cast<PlaceNumber>(places_.size());
  places_.push_back(place);
  ways_.emplace_back();
  blocked_.push_back(0);
  room_.push_back(0.5 * diameter_);
  cells_.add(place, number);
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

namespace {

/// Points of a grid, by column and row.
struct GridBlock {
  int x0, y0, x1, y1;  // both included
  bool is_empty() const { return x0 > x1 || y0 > y1; }
};

/// Calls visit(point, clearance) for every point of the block whose clearance is in [least, most). Quarters at whose
/// middle the clearance says that there is no such point are left out, so that large rooms and large obstacles cost
/// little.
template <class PointAt, class Clearance, class Visit>
void for_each_between(const GridBlock& block, double step, double least, double most, const PointAt& point_at,
                      const Clearance& clearance, const Visit& visit) {
  constexpr int kSmall = 3;
  constexpr double kRounding = 1.0 + 1e-6;
  if (block.is_empty()) return;
  const int width = block.x1 - block.x0, height = block.y1 - block.y0;
  if (std::max(width, height) < kSmall) {
    for (int y = block.y0; y <= block.y1; ++y)
      for (int x = block.x0; x <= block.x1; ++x) {
        const double c = clearance(point_at(x, y), most);
        if (c >= least && c < most) visit(x, y, c);
      }
    return;
  }
  const int x = block.x0 + width / 2, y = block.y0 + height / 2;
  const double reach = kRounding * step * std::hypot(width / 2 + 1, height / 2 + 1);
  const double c = clearance(point_at(x, y), most + reach);
  if (c >= most + reach || c < least - reach) return;
  for (const GridBlock& quarter :
       {GridBlock{block.x0, block.y0, x, y}, GridBlock{x + 1, block.y0, block.x1, y},
        GridBlock{block.x0, y + 1, x, block.y1}, GridBlock{x + 1, y + 1, block.x1, block.y1}})
    for_each_between(quarter, step, least, most, point_at, clearance, visit);
}

}  // namespace

/// Points of a fine grid that are not far from what stands, the roomiest first; of equals those of lower rows.
std::vector<Roadmap::FreePoint> Roadmap::narrow_points(const geometry::Box& region) const {
  const double step = kFine * diameter_, least = 0.5 * diameter_ + kGuardGap * diameter_, most = kNarrow * diameter_;
  struct Found {
    int x, y;
    double clearance;
  };
  std::vector<Found> found;
  const auto point_at = [&](int x, int y) { return region.low + Vec2{x * step, y * step}; };
  for_each_between(
      {0, 0, static_cast<int>((region.high.x - region.low.x) / step),
       static_cast<int>((region.high.y - region.low.y) / step)},
      step, least, most, point_at, [&](Vec2 p, double enough) { return space_->clearance(p, enough); },
      [&](int x, int y, double clearance) {
        found.push_back({x, y, clearance});
      });
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    if (a.clearance != b.clearance) return a.clearance > b.clearance;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  std::vector<FreePoint> points;
  for (const Found& f : found) points.push_back({f.clearance, point_at(f.x, f.y)});
  return points;
}

void Roadmap::add_guards(const std::vector<FreePoint>& narrow, Detail detail) {
  const double reach = (detail == Detail::seen ? kSeesWithin : kDense) * diameter_;
  for (const FreePoint& point : narrow) {
    bool is_seen = false;
    for_each_near(point.place, reach, [&](PlaceNumber p) {
      is_seen = is_seen || space_->is_clear(point.place, places_[p], way_clearance_);
    });
    if (!is_seen) add(point.place);
  }
}

/// From every place that far straight to the walls about it that ways still keep clear.
void Roadmap::add_places_beside_walls() {
  constexpr int kDirections = 8, kHalvings = 20;
  constexpr double kFarthest = 0.75, kApart = 0.1, kOffWall = 1e-4;  // diameters
  const std::size_t before = places_.size();
  for (std::size_t a = 0; a < before; ++a)
    for (int k = 0; k < kDirections; ++k) {
      const Vec2 way = geometry::rotated({kFarthest * diameter_, 0.0}, 2.0 * geometry::kPi * k / kDirections);
      const auto is_clear = [&](double share) {
        return space_->is_clear(places_[a], places_[a] + share * way, way_clearance_ + kOffWall * diameter_);
      };
      if (is_clear(1.0)) continue;
      double clear = 0.0;
      for (double step = 0.5; step > std::ldexp(1.0, -kHalvings); step *= 0.5)
        if (is_clear(clear + step)) clear += step;
      const Vec2 beside = places_[a] + clear * way;
      bool is_known = false;
      for_each_near(beside, kApart * diameter_, [&](PlaceNumber) { is_known = true; });
      if (!is_known) add(beside);
    }
}

void Roadmap::add_ways() {
  for (PlaceNumber a = 0; a < places_.size(); ++a)
    for_each_near(places_[a], longest_, [&](PlaceNumber b) {
      if (b > a && space_->is_clear(places_[a], places_[b], way_clearance_)) link(a, b);
    });
}

void Roadmap::add_connectors(const std::vector<FreePoint>& narrow) {
  constexpr int kRounds = 2;  // what one connector joins another may join with more
  boost::disjoint_sets_with_storage<> parts(places_.size() + kRounds * narrow.size());
  for (PlaceNumber a = 0; a < places_.size(); ++a)
    for (const PlaceNumber b : ways_[a]) parts.union_set(a, b);
  for (int round = 0; round < kRounds; ++round)
    for (const FreePoint& point : narrow) {
      std::vector<PlaceNumber> near, seen;
      for_each_near(point.place, longest_, [&](PlaceNumber p) { near.push_back(p); });
      const auto in_two_parts = [&](const std::vector<PlaceNumber>& some) {
        return std::any_of(some.begin(), some.end(),
                           [&](PlaceNumber p) { return parts.find_set(p) != parts.find_set(some[0]); });
      };
      if (!in_two_parts(near)) continue;
      for (const PlaceNumber p : near)
        if (space_->is_clear(point.place, places_[p], way_clearance_)) seen.push_back(p);
      if (!in_two_parts(seen)) continue;
      const PlaceNumber connector = add(point.place);
      for (const PlaceNumber p : seen) {
        link(connector, p);
        parts.union_set(connector, p);
      }
    }
}

/// Whether the straight way from a place keeps clear of what blocks, or comes no nearer than the place is.
bool Roadmap::is_clear_of_blocked(Vec2 place, Vec2 to) const {
  return std::all_of(blocking_.begin(), blocking_.end(), [&](const geometry::Disc& b) {
    const double keep2 = std::min(b.radius * b.radius, squared_norm(place - b.center));
    return squared_distance(b.center, place, to) >= (1.0 - kSweepRounding) * keep2;
  });
}

Roadmap::Neighbours Roadmap::neighbours_of(Vec2 place) const {
  constexpr double kSame = 1e-9;  // diameters
  // A disc that stands nearer to something leaves as it stands.
  const double stands = space_->clearance(place, way_clearance_) - kSame * diameter_;
  const double least = std::min(way_clearance_, stands);
  Neighbours found;
  found.is_tight =
      least < way_clearance_ || std::any_of(blocking_.begin(), blocking_.end(), [&](const geometry::Disc& b) {
        return squared_norm(place - b.center) < b.radius * b.radius;
      });
  for_each_near(place, longest_, [&](PlaceNumber p) {
    if (blocked_[p]) return;
    if (!found.same && squared_norm(places_[p] - place) <= kSame * kSame * diameter_ * diameter_) found.same = p;
    if (space_->is_clear(place, places_[p], least) && is_clear_of_blocked(place, places_[p])) found.joined.push_back(p);
  });
  return found;
}

PlaceNumber Roadmap::attach(Vec2 place, double radius, const Neighbours& neighbours) {
  if (neighbours.same) {
    room_[*neighbours.same] = std::max(room_[*neighbours.same], radius);
    return *neighbours.same;
  }
  const PlaceNumber number = add(place);
  if (neighbours.is_tight) room_[number] = radius;
  for (const PlaceNumber p : neighbours.joined) link(number, p);
  return number;
}

PlaceNumber Roadmap::attach(Vec2 place, double radius) {
  return attach(place, radius, neighbours_of(place));
}

std::optional<PlaceNumber> Roadmap::attach_where_joined(Vec2 place, double radius) {
  const Neighbours neighbours = neighbours_of(place);
  const bool is_joined = neighbours.same ? !ways_[*neighbours.same].empty() : !neighbours.joined.empty();
  return is_joined ? std::optional<PlaceNumber>(attach(place, radius, neighbours)) : std::nullopt;
}

void Roadmap::block(Vec2 centre, double keep) {
  blocking_.push_back({centre, keep});
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
