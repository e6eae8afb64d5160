// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/routes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "routes/cell_map.h"
#include "routes/chain.h"
#include "routes/piece_tree.h"
#include "routes/point_route.h"
#include "routes/realise.h"
#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

// The widest disc that gets from one cell to another: the narrowest gate on the widest way, from a maximum spanning
// tree of the cells over the widths of gates. Exact: widths are compared, not rounded.

class GateTree {
 public:
  explicit GateTree(const CellMap& map);

  bool connects(int one, int other) const { return root_of(one) == root_of(other); }
  /// The largest double radius for which the disc fits through all gates of some way between two cells; infinite if no
  /// gate is in the way. REQUIRES: `connects`.
  double widest_radius(int one, int other) const;

 private:
  int root_of(int cell) const;

  const CellMap* map_;
  std::vector<int> gates_;   ///< portals that joined two parts, widest first
  std::vector<int> parent_;  ///< of a cell
  std::vector<int> joined_;  ///< by which of `gates_` the cell came under its parent: increasing towards the root
};

/// The squared width of a gate as a fraction: numerator and denominator.
template <typename Convert>
std::pair<NumberOf<Convert>, NumberOf<Convert>> squared_width(const CellMap& map, const Portal& portal, Convert to) {
  using N = NumberOf<Convert>;
  if (portal.link < 0) {
    const Side& side = map.sides[portal.side];
    const auto d = to(map.vertex(side.b)) - to(map.vertex(side.a));
    return {N(dot(d, d)), N(to(1.0))};
  }
  const Link& link = map.links[portal.link];
  const auto d = to(map.vertex(link.b)) - to(map.vertex(link.a));
  const N area = cross(d, to(map.vertex(link.vertex)) - to(map.vertex(link.a)));
  return {N(squared(area)), N(dot(d, d))};
}

/// A side that ends at a corner of the square is no gate: it holds nothing up.
bool is_gate(const CellMap& map, const Portal& portal) {
  if (portal.link >= 0) return true;
  const Side& side = map.sides[portal.side];
  return map.is_site(side.a) && map.is_site(side.b);
}

bool is_wider(const CellMap& map, int one, int other) {
  const Portal &p = map.portals[one], &q = map.portals[other];
  const bool gate = is_gate(map, p), other_gate = is_gate(map, q);
  if (!gate || !other_gate) return !gate && other_gate;
  return sign_of([&](auto to) -> NumberOf<decltype(to)> {
           const auto a = squared_width(map, p, to), b = squared_width(map, q, to);
           return a.first * b.second - b.first * a.second;
         }) > 0;
}

/// The largest double r > 0 with f(r), which holds up to some number near `guess` and not beyond; 0 where there is
/// none.
template <typename F>
double largest_with(double guess, const F& f) {
  constexpr double kFirstStep = 0x1p-53;  // to a neighbour: the guess is mostly right, and each f near it is exact
  double low = guess, high = guess;
  for (double step = kFirstStep; !f(low); step *= 16.0) {
    high = low;
    if (step >= 1.0 || low == 0.0) {
      low = 0.0;
      break;
    }
    low = std::min(std::nextafter(low, 0.0), guess * (1.0 - step));
  }
  // From the last one on, not from the guess: that may be 0 where the distance to a crossing of walls rounds to it.
  for (double step = kFirstStep; high == low; step *= 16.0) {
    const double next = std::max(std::nextafter(low, kInfinity), low * (1.0 + step));
    (f(next) ? low : high) = next;
    if (low == next) high = low;
    if (!(next < kInfinity)) return low;
  }
  while (std::nextafter(low, kInfinity) < high) {
    const double middle = low + 0.5 * (high - low);
    const double inside = middle > low && middle < high ? middle : std::nextafter(low, kInfinity);
    (f(inside) ? low : high) = inside;
  }
  return low;
}

GateTree::GateTree(const CellMap& map) : map_(&map) {
  std::vector<int> portals;
  for (std::size_t p = 0; p < map.portals.size(); ++p)
    if (map.portals[p].right >= 0) portals.push_back(static_cast<int>(p));
  std::stable_sort(portals.begin(), portals.end(), [&](int p, int q) { return is_wider(map, p, q); });
  const std::size_t count = map.cell_portals.size();
  parent_.resize(count);
  std::iota(parent_.begin(), parent_.end(), 0);
  joined_.assign(count, std::numeric_limits<int>::max());
  std::vector<int> size(count, 1);
  for (const int p : portals) {
    int a = root_of(map.portals[p].left), b = root_of(map.portals[p].right);
    if (a == b) continue;
    if (size[a] < size[b]) std::swap(a, b);
    parent_[b] = a;  // the smaller under the larger: at most log2(n) steps to a root
    size[a] += size[b];
    joined_[b] = static_cast<int>(gates_.size());
    gates_.push_back(p);
  }
}

int GateTree::root_of(int cell) const {
  while (parent_[cell] != cell) cell = parent_[cell];
  return cell;
}

double GateTree::widest_radius(int one, int other) const {
  int last = -1;
  while (one != other) {
    int& earlier = joined_[one] < joined_[other] ? one : other;
    last = std::max(last, joined_[earlier]);
    earlier = parent_[earlier];
  }
  if (last < 0 || !is_gate(*map_, map_->portals[gates_[last]])) return kInfinity;
  const Portal& portal = map_->portals[gates_[last]];
  if (portal.link >= 0) {
    const Link& link = map_->links[portal.link];
    return largest_with(0.5 * link.length, [&](double r) { return map_->link_admits(link, r); });
  }
  const Side& side = map_->sides[portal.side];
  return largest_with(0.5 * norm(map_->vertex(side.b).rounded() - map_->vertex(side.a).rounded()),
                      [&](double r) { return map_->side_admits(side, r); });
}

/// Whether every piece stays at least r away from x. Exact.
bool is_clear(const CellMap& map, const PieceTree& grid, Vec2 x, double r) {
  const Point p = x;
  return grid.for_each_near(x, x, r, [&](int piece) {
    const auto [a, b] = map.ends_of(piece);
    return compare_segment_distance(p, map.vertex(a), map.vertex(b), r) >= 0;
  });
}

/// The largest double r such that every piece stays at least r away from x; infinite where there are none.
double clearance_of(const CellMap& map, const PieceTree& grid, Vec2 x) {
  if (map.graph.vertices.empty()) return kInfinity;
  // A distance at which some piece is found, then the least of those within it.
  double nearest = norm(map.vertex(0).rounded() - x);
  for (double r = 0x1p-20 * nearest; r < nearest; r *= 4.0) {
    grid.for_each_near(x, x, r, [&](int piece) {
      const auto [a, b] = map.ends_of(piece);
      const Segment s{map.vertex(a).rounded(), map.vertex(b).rounded()};
      nearest = std::min(nearest, distance(s, x));
      return true;
    });
  }
  return largest_with(nearest, [&](double r) { return is_clear(map, grid, x, r); });
}

}  // namespace
}  // namespace exactvo::geometry::routing

namespace exactvo::geometry {

using routing::CellMap;
using routing::ClearancePlan;
using routing::Point;

namespace {

constexpr double kLargest = 0x1p100, kSmallestRadius = 0x1p-100;  // m

Box box_of(const std::vector<Obstacle>& obstacles) {
  Box box;
  for (const Obstacle& obstacle : obstacles) {
    for (const Vec2& p : vertices_of(obstacle)) {
      EXACTVO_REQUIRE(std::fabs(p.x) <= kLargest && std::fabs(p.y) <= kLargest, to_string({p}));
      box.add(p);
    }
  }
  return box.is_empty() ? Box{{0.0, 0.0}, {0.0, 0.0}} : box;
}

/// m: what is far and near on this map. All obstacles may be one point, or none: then far is some places of the last
/// digit of its coordinates away.
double scale_of(const Box& box) {
  constexpr double kPoint = 0x1p-20;
  double scale = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  for (const double x : {box.low.x, box.low.y, box.high.x, box.high.y}) scale = std::max(scale, kPoint * std::fabs(x));
  return scale > 0.0 ? scale : 1.0;
}

/// A square so far out that neither the way round all obstacles nor the disc of a link comes near its sides: a link is
/// at most sqrt 2 extents long, and a disc needs two radii of room.
struct Frame {
  Vec2 corners[4];
  Frame(const Box& box, double scale, double radius, double distance) {
    const Vec2 c = 0.5 * (box.low + box.high);
    const double h = 5.0 * scale + 8.0 * radius + 2.0 * distance;
    const Vec2 square[4] = {{c.x - h, c.y - h}, {c.x + h, c.y - h}, {c.x + h, c.y + h}, {c.x - h, c.y + h}};
    std::copy(square, square + 4, corners);
  }
};

}  // namespace

struct RouteMap::Parts {
  std::vector<Obstacle> obstacles;
  Box box;
  double scale;
  double largest_radius;  ///< m, that the square has room for
  bool chains_only;
  double asked_radius;  ///< m, the largest that may be asked for
  double margin;        ///< m: how far outside of the box a start or goal may lie
  CellMap cells;
  routing::PieceTree grid;
  mutable std::once_flag gates_made;
  mutable std::optional<routing::GateTree> gates;  ///< made when the widest radius is first asked for

  const routing::GateTree& gate_tree() const {
    std::call_once(gates_made, [this] { gates.emplace(cells); });
    return *gates;
  }

  Parts(const std::vector<Obstacle>& all, const RouteMapOptions& options)
      : obstacles(all),
        box(box_of(obstacles)),
        scale(scale_of(box)),
        largest_radius(std::max(options.largest_radius, 2.0 * scale)),
        chains_only(options.chains_only),
        asked_radius(chains_only ? options.largest_radius : largest_radius),
        margin(std::max(options.largest_distance, 4.0 * scale)),
        cells(routing::planar_graph(obstacles), Frame(box, scale, largest_radius, margin).corners,
              chains_only ? 2.0 * asked_radius : CellMap::kAllGates),
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

std::size_t RouteMap::cell_count() const {
  return parts_->cells.cell_portals.size();
}

double RouteMap::largest_radius() const {
  return parts_->asked_radius;
}

bool RouteMap::covers(Vec2 p) const {
  const Box& b = parts_->box;
  const double m = parts_->margin;
  return p.x >= b.low.x - m && p.x <= b.high.x + m && p.y >= b.low.y - m && p.y <= b.high.y + m;
}

// --- One radius ---

struct RoutePlan::State {
  RouteMap map;
  std::optional<CellMap> own_cells;  ///< where the map's are more than the radius needs
  ClearancePlan plan;
  std::mutex mutex;
  std::vector<std::unique_ptr<routing::WaySearch>> idle;  ///< scratch memory between queries
  std::once_flag arcs_made;
  std::optional<routing::ArcGraph> arcs;  ///< made for the first chain

  State(const RouteMap& m, double radius)
      : map(m),
        own_cells(cells_for(map.parts(), radius)),
        plan(own_cells ? *own_cells : map.parts().cells, map.parts().grid, radius) {}

  static std::optional<CellMap> cells_for(const RouteMap::Parts& parts, double radius) {
    constexpr std::size_t kWorthIt = 2;  // times as many Links as are needed: cutting anew takes a few plans' time
    if (parts.chains_only) return std::nullopt;
    if (radius == 0.0) return CellMap(parts.cells, CellMap::ForPoints{});
    const std::vector<int> needed = parts.cells.needed_links(radius);
    if (kWorthIt * needed.size() >= parts.cells.links.size()) return std::nullopt;
    return CellMap(parts.cells, needed);
  }

  std::unique_ptr<routing::WaySearch> take() {
    const std::lock_guard<std::mutex> lock(mutex);
    if (idle.empty()) return std::make_unique<routing::WaySearch>(plan);
    std::unique_ptr<routing::WaySearch> search = std::move(idle.back());
    idle.pop_back();
    return search;
  }
  Separated chain_between(const routing::ChainEnd& start, const routing::ChainEnd& goal) {
    std::call_once(arcs_made, [this] { arcs.emplace(plan); });
    return routing::separating_chain(plan, *arcs, start, goal);
  }
  void give_back(std::unique_ptr<routing::WaySearch> search) {
    const std::lock_guard<std::mutex> lock(mutex);
    idle.push_back(std::move(search));
  }
};

namespace {

/// Where a start or goal lies: the cells that it can leave into, or what blocks it.
struct Located {
  std::vector<int> cells;  ///< one, unless it is a point's and touches an obstacle; none where it is blocked
  /// Where it is a point's and touches an obstacle, the triangles about it.
  std::vector<CellMap::TriangleAt> about;
  Blocked blocked;
};

int triangle_of(const CellMap& map, const routing::PieceTree& grid, const Point& x) {
  int triangle = grid.triangle_near(x.rounded()), before = -1;
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

/// The first polygon that holds x inside; the number of obstacles if there is none.
std::size_t polygon_round(const std::vector<Obstacle>& obstacles, Vec2 x) {
  const auto holds = [&](const Obstacle& obstacle) {
    const auto* polygon = std::get_if<Polygon>(&obstacle);
    return polygon != nullptr && locate(*polygon, x) == Place::inside;
  };
  return static_cast<std::size_t>(std::find_if(obstacles.begin(), obstacles.end(), holds) - obstacles.begin());
}

/// The free cells among those of the triangles about x, each once.
std::vector<int> free_cells(const CellMap& map, const std::vector<CellMap::TriangleAt>& about, Vec2 x) {
  std::vector<int> cells;
  for (const CellMap::TriangleAt& t : about) {
    if (!map.triangles[t.triangle].free) continue;
    const int cell = map.cell_in(t.triangle, x);
    if (std::find(cells.begin(), cells.end(), cell) == cells.end()) cells.push_back(cell);
  }
  return cells;
}

Located located(const RouteMap::Parts& parts, const ClearancePlan& plan, Vec2 x, Blocked::End end) {
  Located out;
  out.blocked.end = end;
  const int piece = plan.piece_too_near(x);
  if (piece >= 0) out.blocked.by = name_of(parts.cells, piece);
  if (piece >= 0 && plan.radius() > 0.0) return out;
  const int triangle = triangle_of(parts.cells, parts.grid, x);
  if (triangle < 0) throw std::runtime_error("routes: no triangle holds " + to_string({x}));
  if (piece >= 0) {
    out.about = parts.cells.triangles_at(triangle, x);
    out.cells = free_cells(plan.map(), out.about, x);
  } else if (parts.cells.triangles[triangle].free) {
    out.cells.push_back(plan.map().cell_in(triangle, x));
  }
  if (!out.cells.empty()) return out;
  // On an edge that two polygons share x is inside neither.
  const std::size_t polygon = polygon_round(parts.obstacles, x);
  out.blocked.inside = polygon < parts.obstacles.size();
  if (out.blocked.inside) out.blocked.by = {polygon, 0};
  return out;
}

/// Those cells of one end that a disc can go from to a cell of the other.
std::vector<int> connected(const ClearancePlan& plan, const Located& end, const Located& other) {
  std::vector<int> cells;
  std::copy_if(end.cells.begin(), end.cells.end(), std::back_inserter(cells), [&](int cell) {
    return std::any_of(other.cells.begin(), other.cells.end(),
                       [&](int there) { return plan.component(cell) == plan.component(there); });
  });
  return cells;
}

int last_cell(const CellMap& map, const routing::Way& way) {
  int cell = way.start;
  for (const int portal : way.portals) {
    const routing::Portal& p = map.portals[portal];
    cell = p.left == cell ? p.right : p.left;
  }
  return cell;
}

/// The end x of a route that begins or ends in the cell.
routing::RouteEnd end_in(const CellMap& map, const Located& end, Vec2 x, int cell) {
  for (const CellMap::TriangleAt& t : end.about)
    if (map.triangles[t.triangle].free && map.cell_in(t.triangle, x) == cell)
      return {x, map.middle_of(t.triangle), end.about};
  return {x, std::nullopt, {}};
}

/// Rounded: of the exact differences, since points may lie near to each other and far from the origin.
double length_of(const std::vector<Point>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point &p = points[i - 1], &q = points[i];
    if (p.is_double() && q.is_double()) {
      length += norm(q.rounded() - p.rounded());
    } else {
      const routing::Vector<routing::Rational> d = q.exact() - p.exact();
      length += norm(Vec2{d.x.get_d(), d.y.get_d()});
    }
  }
  return length;
}

}  // namespace

double RouteMap::widest_radius(Vec2 start, Vec2 goal) const {
  EXACTVO_REQUIRE(!parts_->chains_only, "a map for chains only");
  EXACTVO_REQUIRE(covers(start) && covers(goal), to_string({start, goal}));
  const CellMap& cells = parts_->cells;
  const int s = triangle_of(cells, parts_->grid, start), t = triangle_of(cells, parts_->grid, goal);
  if (s < 0 || t < 0) throw std::runtime_error("routes: no triangle holds " + to_string({start, goal}));
  // One on an edge may be said to lie in either triangle: its clearance is 0.
  if (!cells.triangles[s].free || !cells.triangles[t].free) return 0.0;
  const int from = cells.cell_in(s, start), to = cells.cell_in(t, goal);
  const routing::GateTree& tree = parts_->gate_tree();
  if (!tree.connects(from, to)) return 0.0;
  double widest = std::min(tree.widest_radius(from, to), largest_radius());
  for (const Vec2 x : {start, goal})
    if (!routing::is_clear(cells, parts_->grid, x, widest)) widest = routing::clearance_of(cells, parts_->grid, x);
  return widest >= kSmallestRadius ? widest : 0.0;
}

RoutePlan::RoutePlan(const RouteMap& map, double radius) {
  EXACTVO_REQUIRE(radius == 0.0 || (radius >= kSmallestRadius && radius <= map.largest_radius()), hex_text(radius));
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
  return !connected(state_->plan, s, t).empty();
}

RouteAnswer RoutePlan::query(Vec2 start, Vec2 goal) const {
  const RouteMap::Parts& parts = state_->map.parts();
  const ClearancePlan& plan = state_->plan;
  EXACTVO_REQUIRE(state_->map.covers(start) && state_->map.covers(goal), to_string({start, goal}));
  const Located s = located(parts, plan, start, Blocked::End::start);
  if (s.cells.empty()) return s.blocked;
  const Located t = located(parts, plan, goal, Blocked::End::goal);
  if (t.cells.empty()) return t.blocked;
  const std::vector<int> starts = connected(plan, s, t);
  if (starts.empty()) return state_->chain_between({start, s.about}, {goal, t.about});
  EXACTVO_REQUIRE(!parts.chains_only, "a route on a map for chains only");
  if (start == goal) return Route{{routing::shown(start)}, 0.0, 0.0};
  std::unique_ptr<routing::WaySearch> search = state_->take();
  const std::optional<routing::Way> way = search->find(start, starts, goal, connected(plan, t, s));
  state_->give_back(std::move(search));
  std::optional<std::vector<Point>> points;
  if (way && plan.radius() > 0.0) points = routing::realised(plan, start, goal, *way);
  if (way && plan.radius() == 0.0)
    points = routing::point_route(plan, end_in(plan.map(), s, start, way->start),
                                  end_in(plan.map(), t, goal, last_cell(plan.map(), *way)), *way);
  if (!points)
    throw RouteNotProven("routes: no proven route from " + to_string({start}) + " to " + to_string({goal}) +
                         " for radius " + hex_text(plan.radius()) + ", though there is one");
  const double length = length_of(*points);
  Route route{{}, length, std::min(length, way->lower_bound)};
  for (const Point& p : *points) route.points.push_back(routing::shown(p));
  return route;
}

}  // namespace exactvo::geometry
