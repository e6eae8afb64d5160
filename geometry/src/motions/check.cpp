// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <queue>
#include <tuple>
#include <unordered_map>

#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/motion_check.h"
#include "exactvo/geometry/require.h"
#include "motions/straight.h"

namespace exactvo::geometry {
namespace motions {
namespace {

void require_trajectory(const Trajectory& t) {
  EXACTVO_REQUIRE(!t.points.empty(), "no points");
  EXACTVO_REQUIRE(t.radius >= 0.0 && std::isfinite(t.radius), hex_text(t.radius));
  for (std::size_t i = 0; i < t.points.size(); ++i) {
    const TimedPoint& p = t.points[i];
    EXACTVO_REQUIRE(is_finite(p.at) && std::isfinite(p.time), hex_text(p.time) + " " + excerpt({p.at}));
    EXACTVO_REQUIRE(i == 0 || t.points[i - 1].time <= p.time, hex_text(t.points[i - 1].time) + " " + hex_text(p.time));
  }
}

/// One motion of one body; `number` counts the body's.
struct TimedPiece {
  Box box;  ///< holds the disc all the time
  double start, end;
  std::uint32_t body, number;
};

std::size_t pieces_of(const Trajectory& t, Between between) {
  return between == Between::hold ? t.points.size() : std::max<std::size_t>(1, t.points.size() - 1);
}

StraightMotion motion_of(const Trajectory& t, Between between, std::size_t number) {
  const TimedPoint& from = t.points[number];
  const TimedPoint& to = t.points[std::min(number + 1, t.points.size() - 1)];
  return between == Between::hold ? held(from, to.time) : StraightMotion{from, to};
}

/// Holds the disc and half of what counts as near; rounded outward.
Box swept_box(const StraightMotion& m, double radius, double near) {
  const double reach = std::nextafter(radius + 0.5 * near, kInfinity);
  Box box;
  box.add(m.from.at);
  box.add(m.to.at);
  const auto down = [&](double x) { return std::nextafter(x - reach, -kInfinity); };
  const auto up = [&](double x) { return std::nextafter(x + reach, kInfinity); };
  return {{down(box.low.x), down(box.low.y)}, {up(box.high.x), up(box.high.y)}};
}

/// Boxes by place, into which pieces come as time goes on and from which they go. Cells are hashed, so that the world
/// has no bounds; boxes of many cells stand in a list of their own.
class MovingGrid {
 public:
  MovingGrid(const std::vector<TimedPiece>& pieces, double side) : pieces_(pieces), side_(side), cells_(kTable) {}

  /// Calls visit(j) once for each piece that is still there at `now` and whose box meets this one's; then adds it.
  template <class Visit>
  void meet_and_add(std::uint32_t i, const Visit& visit) {
    const double now = pieces_[i].start;
    const Cells own = cells_of(pieces_[i].box);
    look_through(large_, i, now, [&](std::uint32_t j) { visit(j); });
    if (own.is_large()) {
      for (std::vector<std::uint32_t>& cell : cells_)
        look_through(cell, i, now, [&](std::uint32_t j) { some_.push_back(j); });
      std::sort(some_.begin(), some_.end());
      some_.erase(std::unique(some_.begin(), some_.end()), some_.end());
      for (const std::uint32_t j : some_) visit(j);
      some_.clear();
      large_.push_back(i);
      return;
    }
    for_each_cell(own, [&](std::int64_t x, std::int64_t y) {
      look_through(cells_[slot(x, y)], i, now, [&](std::uint32_t j) {
        // Of the cells that both have, the first; cells that share a slot are told apart by this, too.
        const Cells other = cells_of(pieces_[j].box);
        if (x == std::max(own.x0, other.x0) && y == std::max(own.y0, other.y0)) visit(j);
      });
    });
    for_each_cell(own, [&](std::int64_t x, std::int64_t y) {
      std::vector<std::uint32_t>& cell = cells_[slot(x, y)];
      if (cell.empty() || cell.back() != i) cell.push_back(i);
    });
  }

 private:
  static constexpr std::size_t kTable = 1u << 16;
  static constexpr std::int64_t kMostCells = 64;
  struct Cells {
    std::int64_t x0, y0, x1, y1;
    bool is_large() const {
      return x1 - x0 >= kMostCells || y1 - y0 >= kMostCells || (x1 - x0 + 1) * (y1 - y0 + 1) > kMostCells;
    }
  };

  Cells cells_of(const Box& box) const {
    const auto cell = [&](double x) {
      constexpr double kMost = 0x1p60;
      return static_cast<std::int64_t>(std::clamp(std::floor(x / side_), -kMost, kMost));
    };
    return {cell(box.low.x), cell(box.low.y), cell(box.high.x), cell(box.high.y)};
  }
  static std::size_t slot(std::int64_t x, std::int64_t y) {
    const auto mixed =
        static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL;
    return static_cast<std::size_t>(mixed ^ (mixed >> 29)) % kTable;
  }
  template <class Visit>
  static void for_each_cell(const Cells& c, const Visit& visit) {
    for (std::int64_t y = c.y0; y <= c.y1; ++y)
      for (std::int64_t x = c.x0; x <= c.x1; ++x) visit(x, y);
  }
  /// Forgets pieces that have ended before `now`.
  template <class Visit>
  void look_through(std::vector<std::uint32_t>& list, std::uint32_t i, double now, const Visit& visit) {
    const TimedPiece& piece = pieces_[i];
    for (std::size_t k = 0; k < list.size();) {
      const TimedPiece& other = pieces_[list[k]];
      if (other.end < now) {
        list[k] = list.back();
        list.pop_back();
        continue;
      }
      if (other.body != piece.body && geometry::meet(other.box, piece.box)) visit(list[k]);
      ++k;
    }
  }

  const std::vector<TimedPiece>& pieces_;
  double side_;
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<std::uint32_t> large_, some_;
};

using Filtered = Vector<RunningError>;

/// Whether the filter clears two discs over the same span of time by more than `near`.
bool surely_clear(const StraightMotion& a, double radius_a, const StraightMotion& b, double radius_b, double near) {
  if (a.from.time != b.from.time || a.to.time != b.to.time) return false;
  const Filtered origin{RunningError(0.0), RunningError(0.0)};
  const Filtered way =
      detail::difference<RunningError>(a.to.at, a.from.at) - detail::difference<RunningError>(b.to.at, b.from.at);
  const RunningError reach = RunningError(radius_a) + RunningError(radius_b) + RunningError(near);
  return beside(detail::difference<RunningError>(b.from.at, a.from.at), origin, way, RunningError(reach * reach)) ==
         Known::positive;
}

bool surely_clear_of(const StraightMotion& a, double radius, const Segment& edge) {
  const Filtered from{RunningError(0.0), RunningError(0.0)};
  const Filtered to = detail::difference<RunningError>(a.to.at, a.from.at);
  const GrownHull<RunningError> hull{
      {detail::difference<RunningError>(edge.a, a.from.at), detail::difference<RunningError>(edge.b, a.from.at)},
      RunningError(radius)};
  return straight_gap(from, to, hull) == Known::positive;
}

/// Joins the pieces' verdicts to events and hands these on as soon as nothing more can be added to them.
class Events {
 public:
  Events(const std::function<void(const MotionEvent&)>& report, MotionCheck& check) : report_(report), check_(check) {}

  void add(const MotionVerdict& v, std::size_t body, bool with_obstacle, std::size_t other) {
    const Key key{body, with_obstacle, other};
    const MotionEvent event{v.encounter, body,        with_obstacle,  other,  v.first,
                            v.last,      v.clearance, v.nearest_time, v.place};
    const auto [last, is_new] = last_of_pair_.try_emplace(key, next_number_);
    if (!is_new && event.first.low <= open_.at(last->second).last.high) {
      join(open_.at(last->second), event);
    } else {
      last->second = next_number_;
      open_.emplace(next_number_++, event);
    }
    ends_.push({open_.at(last->second).last.high, key, last->second});
  }

  /// All that is added from now on begins at `now` or later.
  void advance(double now) {
    while (!ends_.empty() && std::get<0>(ends_.top()) < now) {
      const auto [end, key, number] = ends_.top();
      ends_.pop();
      const auto open = open_.find(number);
      if (open == open_.end() || open->second.last.high != end) continue;  // it has gone on, or is reported already
      ++(open->second.encounter == Encounter::overlap ? check_.overlaps : check_.contacts);
      report_(open->second);
      open_.erase(open);
      const auto last = last_of_pair_.find(key);
      if (last != last_of_pair_.end() && last->second == number) last_of_pair_.erase(last);
    }
  }
  void finish() { advance(kInfinity); }

 private:
  using Key = std::tuple<std::size_t, bool, std::size_t>;
  using End = std::tuple<double, Key, std::uint64_t>;

  static void join(MotionEvent& open, const MotionEvent& next) {
    if (next.last.high > open.last.high) open.last = next.last;
    if (next.first.low < open.first.low) open.first = next.first;
    if (next.clearance.low < open.clearance.low) {
      open.nearest_time = next.nearest_time;
      open.place = next.place;
    }
    open.clearance = {std::min(open.clearance.low, next.clearance.low),
                      std::min(open.clearance.high, next.clearance.high)};
    open.encounter = std::max(open.encounter, next.encounter);
  }
  const std::function<void(const MotionEvent&)>& report_;
  MotionCheck& check_;
  std::map<Key, std::uint64_t> last_of_pair_;
  std::unordered_map<std::uint64_t, MotionEvent> open_;  ///< by number, rising as they begin
  std::uint64_t next_number_ = 0;
  std::priority_queue<End, std::vector<End>, std::greater<>> ends_;
};

/// The map's edges by place, and which obstacle each belongs to.
class Map {
 public:
  explicit Map(const std::vector<Obstacle>& obstacles) : obstacles_(obstacles) {
    std::vector<Box> boxes;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      Box whole;
      for (const Segment& edge : edges_of(obstacles[k])) {
        EXACTVO_REQUIRE(is_finite(edge.a) && is_finite(edge.b), excerpt({edge.a, edge.b}));
        edges_.push_back(edge);
        owner_.push_back(k);
        Box box;
        box.add(edge.a);
        box.add(edge.b);
        boxes.push_back(box);
        whole.add(box);
      }
      if (has_interior(obstacles[k])) {
        solid_.push_back(k);
        extents_.push_back(whole);
      }
    }
    if (!boxes.empty()) grid_ = BoxGrid(std::move(boxes));
    if (!extents_.empty()) solids_ = BoxGrid(extents_);
  }

  /// Adds the obstacles that may be met, each once. Where it is not known that the body begins outside of all polygons,
  /// those round its way are among them.
  void add_suspects(const StraightMotion& m, double radius, const Box& box, bool begins_outside,
                    std::vector<std::size_t>& suspects, MotionCheck& check) const {
    if (edges_.empty()) return;
    grid_.for_each_meeting(box, [&](std::size_t i) {
      ++check.edge_pairs;
      if (!surely_clear_of(m, radius, edges_[i])) suspects.push_back(owner_[i]);
    });
    if (!begins_outside && !extents_.empty())
      solids_.for_each_meeting(box, [&](std::size_t i) { suspects.push_back(solid_[i]); });
    std::sort(suspects.begin(), suspects.end());
    suspects.erase(std::unique(suspects.begin(), suspects.end()), suspects.end());
  }

  const Obstacle& operator[](std::size_t k) const { return obstacles_[k]; }

 private:
  const std::vector<Obstacle>& obstacles_;
  std::vector<Segment> edges_;
  std::vector<std::size_t> owner_, solid_;
  std::vector<Box> extents_;
  BoxGrid grid_, solids_;
};

class Sweep {
 public:
  Sweep(const std::vector<Trajectory>& trajectories, const std::vector<Obstacle>& obstacles,
        const MotionCheckOptions& options, const std::function<void(const MotionEvent&)>& report)
      : trajectories_(trajectories),
        between_(options.between),
        near_(options.near),
        map_(obstacles),
        events_(report, check_) {
    EXACTVO_REQUIRE(near_ >= 0.0 && std::isfinite(near_), hex_text(near_));
    for (std::size_t b = 0; b < trajectories.size(); ++b) {
      require_trajectory(trajectories[b]);
      for (std::size_t k = 0; k < pieces_of(trajectories[b], between_); ++k) {
        const StraightMotion m = motion(b, k);
        pieces_.push_back({swept_box(m, trajectories[b].radius, near_), m.from.time, m.to.time,
                           static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(k)});
      }
    }
    std::sort(pieces_.begin(), pieces_.end(), [](const TimedPiece& x, const TimedPiece& y) {
      return std::tie(x.start, x.body, x.number) < std::tie(y.start, y.body, y.number);
    });
    outside_.assign(trajectories.size(), false);
  }

  MotionCheck run() {
    check_.pieces = pieces_.size();
    MovingGrid grid(pieces_, cell_side());
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      events_.advance(pieces_[i].start);
      meet_map(pieces_[i]);
      grid.meet_and_add(i, [&](std::uint32_t j) { meet_body(pieces_[i], pieces_[j]); });
    }
    events_.finish();
    if (near_ > 0.0)
      for (const auto& [pair, approach] : approaches_) check_.approaches.push_back(approach);
    return check_;
  }

 private:
  StraightMotion motion(std::size_t body, std::size_t number) const {
    return motion_of(trajectories_[body], between_, number);
  }

  /// Twice the mean width of the boxes.
  double cell_side() const {
    double sum = 0.0;
    for (const TimedPiece& p : pieces_) sum += std::max(p.box.width(), p.box.high.y - p.box.low.y);
    const double side = 2.0 * sum / std::max<double>(1.0, static_cast<double>(pieces_.size()));
    return side > 0.0 && std::isfinite(side) ? side : 1.0;
  }

  void meet_map(const TimedPiece& piece) {
    const StraightMotion m = motion(piece.body, piece.number);
    const double radius = trajectories_[piece.body].radius;
    const bool continues = between_ == Between::straight && piece.number > 0;
    suspects_.clear();
    map_.add_suspects(m, radius, piece.box, continues && outside_[piece.body], suspects_, check_);
    outside_[piece.body] = true;
    for (const std::size_t k : suspects_) {
      ++check_.examined;
      const RigidBody body = disc_body(radius);
      if (encounter(m, body, map_[k]) == Encounter::clear) continue;
      outside_[piece.body] = false;
      events_.add(examine(m, body, map_[k]), piece.body, true, k);
    }
  }

  void meet_body(const TimedPiece& one, const TimedPiece& another) {
    ++check_.pairs;
    const bool in_order = one.body < another.body;
    const TimedPiece &a = in_order ? one : another, &b = in_order ? another : one;
    const StraightMotion m = motion(a.body, a.number), other = motion(b.body, b.number);
    const double radius = trajectories_[a.body].radius, other_radius = trajectories_[b.body].radius;
    if (surely_clear(m, radius, other, other_radius, near_)) return;
    ++check_.examined;
    const RigidBody body = disc_body(radius), other_body = disc_body(other_radius);
    if (near_ == 0.0 && encounter(m, body, other, other_body) == Encounter::clear) return;
    const MotionVerdict verdict = examine(m, body, other, other_body);
    if (verdict.clearance.low < near_) add_approach(verdict, a.body, b.body);
    if (verdict.encounter != Encounter::clear) events_.add(verdict, a.body, false, b.body);
  }

  void add_approach(const MotionVerdict& v, std::size_t body, std::size_t other) {
    const auto [place, is_new] =
        approaches_.try_emplace({body, other}, Approach{body, other, v.clearance, v.nearest_time, v.place});
    if (is_new) return;
    Approach& least = place->second;
    if (v.clearance.low < least.clearance.low) {
      least.nearest_time = v.nearest_time;
      least.place = v.place;
    }
    least.clearance = {std::min(least.clearance.low, v.clearance.low),
                       std::min(least.clearance.high, v.clearance.high)};
  }

  const std::vector<Trajectory>& trajectories_;
  const Between between_;
  const double near_;
  MotionCheck check_;
  Map map_;
  Events events_;
  std::vector<TimedPiece> pieces_;
  std::map<std::pair<std::size_t, std::size_t>, Approach> approaches_;
  std::vector<bool> outside_;  ///< of each body: of all polygons as its next piece begins
  std::vector<std::size_t> suspects_;
};

}  // namespace
}  // namespace motions

MotionCheck check_motions(const std::vector<Trajectory>& trajectories, const std::vector<Obstacle>& map,
                          const MotionCheckOptions& options, const std::function<void(const MotionEvent&)>& report) {
  return motions::Sweep(trajectories, map, options, report).run();
}

}  // namespace exactvo::geometry
