// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/routes.h"

#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "exactvo/geometry/require.h"
#include "routes/chain.h"
#include "routes/realise.h"
#include "routes/signs.h"

namespace exactvo::geometry {

using routing::CellMap;
using routing::ClearancePlan;
using routing::Point;

namespace {

/// The box of all obstacles.
struct Extent {
  Vec2 low{0.0, 0.0}, high{0.0, 0.0};
  double size() const { return std::max(high.x - low.x, high.y - low.y); }
};

constexpr double kLargest = 0x1p100;  // m

Extent extent_of(const std::vector<Obstacle>& obstacles) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent e{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (const Obstacle& obstacle : obstacles) {
    for (const Vec2& p : vertices_of(obstacle)) {
      EXACTVO_REQUIRE(std::fabs(p.x) <= kLargest && std::fabs(p.y) <= kLargest, to_string({p}));
      e.low = {std::min(e.low.x, p.x), std::min(e.low.y, p.y)};
      e.high = {std::max(e.high.x, p.x), std::max(e.high.y, p.y)};
    }
  }
  return e.low.x <= e.high.x ? e : Extent{};
}

/// A square so far out that neither the way round all obstacles nor the disc of a link comes near its sides: a link is
/// at most sqrt 2 extents long, and a disc needs two radii of room.
struct Frame {
  Vec2 centre;
  double half;
  Frame(const Extent& e, double radius, double distance)
      : centre(0.5 * (e.low + e.high)), half(4.0 * e.size() + 8.0 * radius + 2.0 * distance + 1.0) {}
};

}  // namespace

struct RouteMap::Parts {
  std::vector<Obstacle> obstacles;
  Extent extent;
  double largest_radius;
  double margin;  ///< how far outside of the extent a start or goal may lie
  CellMap cells;
  routing::EdgeGrid grid;

  static CellMap cells_of(const std::vector<Obstacle>& obstacles, const Frame& frame) {
    const Vec2 c = frame.centre;
    const double h = frame.half;
    const Vec2 corners[4] = {{c.x - h, c.y - h}, {c.x + h, c.y - h}, {c.x + h, c.y + h}, {c.x - h, c.y + h}};
    return CellMap(routing::planar_graph(obstacles), corners);
  }
  Parts(const std::vector<Obstacle>& all, const RouteMapOptions& options)
      : obstacles(all),
        extent(extent_of(obstacles)),
        largest_radius(std::max(options.largest_radius, extent.size())),
        margin(std::max(options.largest_distance, extent.size())),
        cells(cells_of(obstacles, Frame(extent, largest_radius, margin))),
        grid(cells) {}
};

RouteMap::RouteMap(const std::vector<Obstacle>& obstacles, const RouteMapOptions& options) {
  EXACTVO_REQUIRE(options.largest_radius >= 0.0 && options.largest_radius <= kLargest,
                  std::to_string(options.largest_radius));
  EXACTVO_REQUIRE(options.largest_distance >= 0.0 && options.largest_distance <= kLargest,
                  std::to_string(options.largest_distance));
  parts_ = std::make_shared<const Parts>(obstacles, options);
}

std::size_t RouteMap::vertex_count() const {
  return parts_->cells.graph.vertices.size();
}

double RouteMap::largest_radius() const {
  return parts_->largest_radius;
}

bool RouteMap::covers(Vec2 p) const {
  const Extent& e = parts_->extent;
  const double m = parts_->margin;
  return p.x >= e.low.x - m && p.x <= e.high.x + m && p.y >= e.low.y - m && p.y <= e.high.y + m;
}

// --- One radius ---

struct RoutePlan::State {
  RouteMap map;
  ClearancePlan plan;
  std::mutex mutex;
  std::vector<std::unique_ptr<routing::WaySearch>> idle;  ///< scratch memory between queries

  State(const RouteMap& m, double radius) : map(m), plan(map.parts().cells, map.parts().grid, radius) {}

  std::unique_ptr<routing::WaySearch> take() {
    const std::lock_guard<std::mutex> lock(mutex);
    if (idle.empty()) return std::make_unique<routing::WaySearch>(plan);
    std::unique_ptr<routing::WaySearch> search = std::move(idle.back());
    idle.pop_back();
    return search;
  }
  void give_back(std::unique_ptr<routing::WaySearch> search) {
    const std::lock_guard<std::mutex> lock(mutex);
    idle.push_back(std::move(search));
  }
};

namespace {

/// Where a start or goal lies: its cell, or what blocks it.
struct Located {
  int cell = -1;
  Blocked blocked;
};

int triangle_of(const ClearancePlan& plan, const Point& x) {
  const CellMap& map = plan.map();
  int triangle = plan.grid().triangle_near(x.rounded()), before = -1;
  // A walk towards x through the sides that it lies beyond. It may run in circles where the triangulation is not
  // Delaunay: the side to begin with changes from step to step, and after as many steps as triangles all are tried.
  for (std::size_t step = 0; step < map.triangles.size() + 16; ++step) {
    const routing::Triangle& t = map.triangles[triangle];
    int beyond = -1;
    for (int k = 0; k < 3 && beyond < 0; ++k) {
      const int i = static_cast<int>((static_cast<std::size_t>(k) + step) % 3);
      if (t.neighbour[i] < 0 || t.neighbour[i] == before) continue;
      if (routing::orient(map.vertex(t.vertex[(i + 1) % 3]), map.vertex(t.vertex[(i + 2) % 3]), x) < 0)
        beyond = t.neighbour[i];
    }
    if (beyond < 0) {
      if (map.triangle_holds(triangle, x)) return triangle;
      before = -1;
      continue;
    }
    before = triangle;
    triangle = beyond;
  }
  for (std::size_t f = 0; f < map.triangles.size(); ++f)
    if (map.triangle_holds(static_cast<int>(f), x)) return static_cast<int>(f);
  return -1;
}

EdgeName name_of(const CellMap& map, int piece) {
  const int edges = static_cast<int>(map.graph.edges.size());
  return piece < edges ? map.graph.edges[piece].on : map.graph.on[map.graph.isolated[piece - edges]];
}

/// A polygon that holds x, by the parity of the crossings of a ray to the right.
std::size_t polygon_round(const std::vector<Obstacle>& obstacles, Vec2 x) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!has_interior(obstacles[i])) continue;
    bool inside = false;
    for (const Segment& e : edges_of(obstacles[i])) {
      if ((e.a.y > x.y) == (e.b.y > x.y)) continue;
      if ((routing::orient(e.a, e.b, x) > 0) == (e.b.y > x.y)) inside = !inside;
    }
    if (inside) return i;
  }
  return obstacles.size();
}

Located located(const RouteMap::Parts& parts, const ClearancePlan& plan, Vec2 x, Blocked::End end) {
  Located out;
  out.blocked.end = end;
  const int piece = plan.piece_too_near(x);
  if (piece >= 0) {
    out.blocked.by = name_of(parts.cells, piece);
    return out;
  }
  const int triangle = triangle_of(plan, x);
  if (triangle < 0) throw std::runtime_error("routes: no triangle holds " + to_string({x}));
  if (parts.cells.triangles[triangle].free) {
    out.cell = parts.cells.cell_in(triangle, x);
  } else {
    out.blocked.inside = true;
    out.blocked.by.obstacle = polygon_round(parts.obstacles, x);
  }
  return out;
}

double length_of(const std::vector<Point>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += norm(points[i].rounded() - points[i - 1].rounded());
  return length;
}

}  // namespace

RoutePlan::RoutePlan(const RouteMap& map, double radius) {
  EXACTVO_REQUIRE(radius > 0.0 && radius <= map.largest_radius(), std::to_string(radius));
  state_ = std::make_shared<State>(map, radius);
}

double RoutePlan::radius() const {
  return state_->plan.radius();
}

bool RoutePlan::is_reachable(Vec2 start, Vec2 goal) const {
  const RouteMap::Parts& parts = state_->map.parts();
  EXACTVO_REQUIRE(state_->map.covers(start) && state_->map.covers(goal), to_string({start, goal}));
  const Located s = located(parts, state_->plan, start, Blocked::End::start);
  const Located t = located(parts, state_->plan, goal, Blocked::End::goal);
  return s.cell >= 0 && t.cell >= 0 && state_->plan.component(s.cell) == state_->plan.component(t.cell);
}

RouteAnswer RoutePlan::query(Vec2 start, Vec2 goal) const {
  const RouteMap::Parts& parts = state_->map.parts();
  const ClearancePlan& plan = state_->plan;
  EXACTVO_REQUIRE(state_->map.covers(start) && state_->map.covers(goal), to_string({start, goal}));
  const Located s = located(parts, plan, start, Blocked::End::start);
  if (s.cell < 0) return s.blocked;
  const Located t = located(parts, plan, goal, Blocked::End::goal);
  if (t.cell < 0) return t.blocked;
  if (plan.component(s.cell) != plan.component(t.cell)) return routing::separating_chain(plan, start, goal);
  if (start == goal) return Route{{routing::shown(start)}, 0.0, 0.0};
  std::unique_ptr<routing::WaySearch> search = state_->take();
  const std::optional<routing::Way> way = search->find(start, s.cell, goal, t.cell);
  state_->give_back(std::move(search));
  const std::optional<std::vector<Point>> points = way ? routing::realised(plan, start, goal, *way) : std::nullopt;
  if (!points)
    throw std::runtime_error("routes: no proven route from " + to_string({start}) + " to " + to_string({goal}) +
                             " for radius " + hex_text(plan.radius()) + ", though there is one");
  Route route{{}, length_of(*points), way->lower_bound};
  for (const Point& p : *points) route.points.push_back(routing::shown(p));
  return route;
}

}  // namespace exactvo::geometry
