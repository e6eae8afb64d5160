// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/cell_map.h"

#include <algorithm>

#include "routes/links.h"
#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// Where the Link crosses the side xy, as a share of it: numerator and denominator.
template <typename Convert>
std::pair<NumberOf<Convert>, NumberOf<Convert>> crossing(const CellMap& map, const Link& link, const Point& x,
                                                         const Point& y, Convert to) {
  const auto d = to(map.vertex(link.b)) - to(map.vertex(link.a));
  return {dot(to(map.vertex(link.vertex)) - to(x), d), dot(to(y) - to(x), d)};
}

/// Whether one Link crosses the side before another does. Degree 8.
bool crosses_before(const CellMap& map, int one, int two, const Side& side) {
  const Point& x = map.vertex(side.a);
  const Point& y = map.vertex(side.b);
  return sign_of([&](auto to) -> NumberOf<decltype(to)> {
           const auto p = crossing(map, map.links[one], x, y, to), q = crossing(map, map.links[two], x, y, to);
           return (p.first * q.second - q.first * p.second) * p.second * q.second;
         }) < 0;
}

void mark_crossings(CellMap& map) {
  for (std::size_t l = 0; l < map.links.size(); ++l)
    for (const Link::Exit& exit : map.links[l].exits)
      map.sides[map.side_of[exit.triangle][exit.side]].marks.push_back(static_cast<int>(l));
  for (Side& side : map.sides)
    if (side.marks.size() > 1)
      std::sort(side.marks.begin(), side.marks.end(),
                [&](int one, int two) { return crosses_before(map, one, two, side); });
}

/// Cuts one triangle along its Links, and makes the portals between its cells and to the triangles beside it.
///
/// Places are numbered counter-clockwise round the triangle: its corners, and the marks of its sides. A cell is the
/// list of its stretches, each with the place where it starts: a piece of a side, or a chord.
class TriangleCutter {
 public:
  TriangleCutter(CellMap& map) : map_(map), side_portals_(map.sides.size()), link_portals_(map.links.size()) {
    for (std::size_t l = 0; l < map.links.size(); ++l) link_portals_[l].assign(map.links[l].exits.size(), -1);
  }

  void cut(int triangle, const std::vector<int>& links) {
    triangle_ = triangle;
    std::vector<Cell> cells{whole()};
    for (const int link : links) cut_along(link, cells);
    for (const Cell& cell : cells) add(cell);
  }

 private:
  struct Stretch {
    int start;
    int side = -1;  ///< local, and which piece of it, counted from the side's own a
    int piece = 0;
    int link = -1;  ///< or a chord
    int sense = 0;  ///< of a chord: 1 as the Link leaves its vertex, -1 back
  };
  using Cell = std::vector<Stretch>;

  const Triangle& triangle() const { return map_.triangles[triangle_]; }
  Side& side(int local) const { return map_.sides[map_.side_of[triangle_][local]]; }
  bool runs_forward(int local) const { return side(local).a == triangle().vertex[(local + 1) % 3]; }

  Cell whole() {
    Cell cell;
    mark_places_.clear();
    int place = 0;
    for (const int local : {2, 0, 1}) {
      corner_place_[(local + 1) % 3] = place;
      const std::vector<int>& marks = side(local).marks;
      const int count = static_cast<int>(marks.size());
      const bool forward = runs_forward(local);
      for (int k = 0; k <= count; ++k) {
        cell.push_back({place++, local, forward ? k : count - k});
        if (k < count) mark_places_.push_back({local, marks[forward ? k : count - 1 - k], place});
      }
    }
    return cell;
  }

  int place_of_mark(int local, int link) const {
    const auto found = std::find_if(mark_places_.begin(), mark_places_.end(),
                                    [&](const MarkPlace& m) { return m.local == local && m.link == link; });
    return found->place;
  }
  int local_of(int side) const {
    const std::array<int, 3>& mine = map_.side_of[triangle_];
    return static_cast<int>(std::find(mine.begin(), mine.end(), side) - mine.begin());
  }

  /// Where the Link comes into this triangle and where it leaves.
  std::pair<int, int> ends_of(int link) const {
    const Link& l = map_.links[link];
    std::size_t k = 0;
    while (l.exits[k].triangle != triangle_) ++k;
    const int leaves = place_of_mark(l.exits[k].side, link);
    if (k == 0) {
      const int* v = triangle().vertex;
      return {corner_place_[std::find(v, v + 3, l.vertex) - v], leaves};
    }
    const Link::Exit& before = l.exits[k - 1];
    return {place_of_mark(local_of(map_.side_of[before.triangle][before.side]), link), leaves};
  }

  void cut_along(int link, std::vector<Cell>& cells) const {
    const auto [from, to] = ends_of(link);
    const auto starts_at = [](int place) { return [place](const Stretch& s) { return s.start == place; }; };
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const Cell& cell = cells[c];
      const auto i = std::find_if(cell.begin(), cell.end(), starts_at(from));
      const auto j = std::find_if(cell.begin(), cell.end(), starts_at(to));
      if (i == cell.end() || j == cell.end()) continue;
      Cell right = between(cell, i - cell.begin(), j - cell.begin()),
           left = between(cell, j - cell.begin(), i - cell.begin());
      right.push_back({to, -1, 0, link, -1});
      left.push_back({from, -1, 0, link, 1});
      cells[c] = std::move(right);
      cells.push_back(std::move(left));
      return;
    }
  }
  static Cell between(const Cell& cell, std::ptrdiff_t first, std::ptrdiff_t last) {
    Cell out;
    for (std::size_t k = static_cast<std::size_t>(first); k != static_cast<std::size_t>(last);
         k = (k + 1) % cell.size())
      out.push_back(cell[k]);
    return out;
  }

  void add(const Cell& cell) {
    const int number = static_cast<int>(map_.cell_portals.size());
    map_.cell_portals.emplace_back();
    map_.cell_chords.emplace_back();
    for (const Stretch& stretch : cell) {
      if (stretch.link >= 0) {
        map_.cell_chords.back().push_back({stretch.link, stretch.sense});
        add_chord(stretch, number);
      } else if (triangle().wall[stretch.side] < 0 && triangle().neighbour[stretch.side] >= 0) {
        add_piece(stretch, number);
      }
    }
  }

  /// The cell that comes first is the portal's left one.
  void connect(int& slot, const Portal& fresh, int cell) {
    const bool first = slot < 0;
    if (first) {
      slot = static_cast<int>(map_.portals.size());
      map_.portals.push_back(fresh);
      map_.portals.back().left = cell;
    } else {
      map_.portals[slot].right = cell;
    }
    map_.cell_portals.back().push_back({slot, first});
  }

  void add_chord(const Stretch& stretch, int cell) {
    const std::vector<Link::Exit>& exits = map_.links[stretch.link].exits;
    std::size_t piece = 0;
    while (exits[piece].triangle != triangle_) ++piece;
    Portal portal;
    portal.link = stretch.link;
    portal.piece = static_cast<int>(piece);
    portal.outward = stretch.sense > 0;
    connect(link_portals_[stretch.link][piece], portal, cell);
  }

  void add_piece(const Stretch& stretch, int cell) {
    const int number = map_.side_of[triangle_][stretch.side];
    const Side& s = map_.sides[number];
    std::vector<int>& slots = side_portals_[number];
    if (slots.empty()) slots.assign(s.marks.size() + 1, -1);
    const std::size_t k = static_cast<std::size_t>(stretch.piece);
    PortalEnd low{s.a, -1}, high{s.b, -1};
    if (k > 0) low = {-1, s.marks[k - 1]};
    if (k < s.marks.size()) high = {-1, s.marks[k]};
    const bool forward = runs_forward(stretch.side);
    Portal portal;
    portal.side = number;
    portal.from = forward ? low : high;
    portal.to = forward ? high : low;
    connect(slots[k], portal, cell);
  }

  struct MarkPlace {
    int local, link, place;
  };
  CellMap& map_;
  std::vector<std::vector<int>> side_portals_, link_portals_;
  int triangle_ = -1;
  int corner_place_[3] = {};
  std::vector<MarkPlace> mark_places_;
};

void cut_into_cells(CellMap& map) {
  std::vector<std::vector<int>> links_of(map.triangles.size());
  for (std::size_t l = 0; l < map.links.size(); ++l)
    for (const Link::Exit& exit : map.links[l].exits) links_of[exit.triangle].push_back(static_cast<int>(l));
  TriangleCutter cutter(map);
  for (std::size_t f = 0; f < map.triangles.size(); ++f) {
    map.first_cell.push_back(static_cast<int>(map.cell_portals.size()));
    if (map.triangles[f].free) cutter.cut(static_cast<int>(f), links_of[f]);
  }
  map.first_cell.push_back(static_cast<int>(map.cell_portals.size()));
}

}  // namespace

CellMap::CellMap(PlanarGraph g, const Vec2 (&corners)[4], double widest_gate)
    : graph(std::move(g)), widest_gate_(widest_gate) {
  triangulate_and_link(corners);
  mark_crossings(*this);
  cut_into_cells(*this);
  find_smooth_vertices();
}

CellMap::CellMap(const CellMap& map, Uncut)
    : graph(map.graph),
      vertices(map.vertices),
      triangles(map.triangles),
      side_of(map.side_of),
      widest_gate_(map.widest_gate_) {
  sides.reserve(map.sides.size());
  for (const Side& side : map.sides) sides.push_back({side.a, side.b, side.right, side.left, {}});
}

CellMap::CellMap(const CellMap& map, const std::vector<int>& kept_links) : CellMap(map, Uncut{}) {
  for (const int l : kept_links) links.push_back(map.links[l]);
  mark_crossings(*this);
  cut_into_cells(*this);
}

void CellMap::find_smooth_vertices() {
  constexpr double kCosine = 0.966;  // of 15 degrees: the arc round such a corner is its chord up to 0.003 of itself
  struct Walls {
    int count = 0;
    Vec2 first;
    bool is_smooth = false;
  };
  std::vector<Walls> at(graph.vertices.size());
  const auto add = [&](int v, int other) {
    Walls& w = at[v];
    const Vec2 along = normalized(vertex(other).rounded() - vertex(v).rounded());
    w.is_smooth = ++w.count == 2 && dot(w.first, along) <= -kCosine;
    if (w.count == 1) w.first = along;
  };
  for (const PlanarGraph::Edge& e : graph.edges) {
    add(e.a, e.b);
    add(e.b, e.a);
  }
  is_smooth_.reserve(at.size());
  for (const Walls& w : at) is_smooth_.push_back(w.is_smooth ? 1 : 0);
}

std::vector<int> CellMap::needed_links(double r) const {
  constexpr double kMuchWider = 4.0;
  std::vector<int> needed;
  for (std::size_t l = 0; l < links.size(); ++l)
    if (!is_smooth_[links[l].vertex] || links[l].length < kMuchWider * r) needed.push_back(static_cast<int>(l));
  return needed;
}

/// As many links and crossings as vertices, up to a constant: where there are more, crowded walls are cut. (Maps
/// without such walls take 2 to 4 steps a corner, and at most 2 crossings a vertex.)
void CellMap::triangulate_and_link(const Vec2 (&corners)[4]) {
  constexpr std::size_t kStepsACorner = 8, kCrossingsAVertex = 8, kSmall = 4096;
  constexpr int kMostRounds = 8;  // each lets a fan shrink by a factor of hundreds; then whatever it takes
  for (int round = 0;; ++round) {
    vertices = graph.vertices;
    for (const Vec2& corner : corners) vertices.emplace_back(corner);
    triangles = triangulate(graph, corners);
    sides.clear();
    number_sides();
    const std::size_t steps = kStepsACorner * 3 * triangles.size() + kSmall;
    LinkBounds bounds{steps, kCrossingsAVertex * vertices.size() + kSmall};
    if (round == kMostRounds) bounds = {};
    std::optional<std::vector<Link>> found = gabriel_links(*this, bounds);
    if (!found) found = gabriel_links(*this, bounds, LinksFrom::walls);
    if (!found && !cut_crowded_walls(*this, steps, graph)) found = gabriel_links(*this, {});
    if (!found) continue;
    links = std::move(*found);
    return;
  }
}

void CellMap::number_sides() {
  side_of.assign(triangles.size(), {-1, -1, -1});
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    for (int i = 0; i < 3; ++i) {
      if (side_of[f][i] >= 0) continue;
      side_of[f][i] = static_cast<int>(sides.size());
      Side side{t.vertex[(i + 1) % 3], t.vertex[(i + 2) % 3], -1, static_cast<int>(f), {}};
      const int beyond = t.neighbour[i];
      if (t.wall[i] < 0 && beyond >= 0) {
        const int* back = triangles[beyond].neighbour;
        side_of[beyond][std::find(back, back + 3, static_cast<int>(f)) - back] = side_of[f][i];
        side.right = beyond;
      }
      sides.push_back(std::move(side));
    }
  }
}

Point CellMap::foot(const Link& link) const {
  const Vector<Rational> v = vertex(link.vertex).exact(), a = vertex(link.a).exact(), b = vertex(link.b).exact();
  const Vector<Rational> d = b - a;
  const Rational share = dot(v - a, d) / dot(d, d);
  return {Rational(a.x + share * d.x), Rational(a.y + share * d.y)};
}

Point CellMap::crossing_of(const Link& link, const Side& side) const {
  const Vector<Rational> x = vertex(side.a).exact(), y = vertex(side.b).exact();
  const auto [part, whole] = crossing(*this, link, vertex(side.a), vertex(side.b), ToRational{});
  const Rational share = part / whole;
  return {Rational(x.x + share * (y.x - x.x)), Rational(x.y + share * (y.y - x.y))};
}

std::pair<Point, Point> CellMap::ends_of(const Portal& portal) const {
  if (portal.link < 0) {
    const auto end = [&](const PortalEnd& e) {
      return e.vertex >= 0 ? vertex(e.vertex) : crossing_of(links[e.link], sides[portal.side]);
    };
    return {end(portal.from), end(portal.to)};
  }
  const Link& link = links[portal.link];
  const auto exit = [&](int k) {
    const Link::Exit& e = link.exits[k];
    return crossing_of(link, sides[side_of[e.triangle][e.side]]);
  };
  const bool last = portal.piece + 1 == static_cast<int>(link.exits.size());
  const Point near = portal.piece == 0 ? vertex(link.vertex) : exit(portal.piece - 1);
  const Point far = last ? foot(link) : exit(portal.piece);
  return portal.outward ? std::pair(near, far) : std::pair(far, near);
}

bool CellMap::link_admits(const Link& link, double r) const {
  return compare_line_distance(vertex(link.vertex), vertex(link.a), vertex(link.b), r, 4.0) >= 0;
}

bool CellMap::side_admits(const Side& side, double r) const {
  return !is_site(side.a) || !is_site(side.b) || compare_distance(vertex(side.a), vertex(side.b), r, 4.0) >= 0;
}

int CellMap::cell_in(int triangle, const Point& x) const {
  if (links.empty()) return first_cell[triangle];
  for (int c = first_cell[triangle]; c < first_cell[triangle + 1]; ++c) {
    const auto holds = [&](const Chord& chord) {
      const Link& l = links[chord.link];
      // To the left of v -> foot lies what is farther along ab turned back: foot - v points to the right of ab.
      return along(x, vertex(l.vertex), vertex(l.a), vertex(l.b)) * chord.side >= 0;
    };
    if (std::all_of(cell_chords[c].begin(), cell_chords[c].end(), holds)) return c;
  }
  return first_cell[triangle];
}

bool CellMap::triangle_holds(int triangle, const Point& x) const {
  const int* v = triangles[triangle].vertex;
  for (int i = 0; i < 3; ++i)
    if (orient(vertex(v[(i + 1) % 3]), vertex(v[(i + 2) % 3]), x) < 0) return false;
  return true;
}

Point CellMap::middle_of(int triangle) const {
  const int* v = triangles[triangle].vertex;
  const Vector<Rational> a = vertex(v[0]).exact(), b = vertex(v[1]).exact(), c = vertex(v[2]).exact();
  return {Rational((a.x + b.x + c.x) / 3), Rational((a.y + b.y + c.y) / 3)};
}

std::vector<CellMap::TriangleAt> CellMap::triangles_at(int triangle, const Point& x) const {
  const Triangle& first = triangles[triangle];
  int zero = -1, corner = -1;  // the side that x lies on; the vertex where two of them meet
  for (int i = 0; i < 3; ++i) {
    if (orient(vertex(first.vertex[(i + 1) % 3]), vertex(first.vertex[(i + 2) % 3]), x) != 0) continue;
    if (zero >= 0) corner = 3 - zero - i;
    zero = i;
  }
  if (zero < 0) return {{triangle, -1, -1}};
  const auto local = [&](int t, int v) {
    const int* vertices_of = triangles[t].vertex;
    return static_cast<int>(std::find(vertices_of, vertices_of + 3, v) - vertices_of);
  };
  std::vector<TriangleAt> found;
  if (corner < 0) {
    found.push_back({triangle, zero, -1});
    const int other = first.neighbour[zero];
    if (other >= 0)
      found.push_back(
          {other, 3 - local(other, first.vertex[(zero + 1) % 3]) - local(other, first.vertex[(zero + 2) % 3]), -1});
    return found;
  }
  const int v = first.vertex[corner];
  for (int t = triangle; t >= 0 && (found.empty() || t != triangle);) {
    const int at = local(t, v);
    found.push_back({t, (at + 1) % 3, at});
    t = triangles[t].neighbour[(at + 1) % 3];
  }
  return found;
}

bool CellMap::opens_towards(const std::vector<TriangleAt>& about, const Point& to) const {
  return std::any_of(about.begin(), about.end(), [&](const TriangleAt& t) {
    const Triangle& triangle = triangles[t.triangle];
    const auto side = [&](int a, int b) {
      return orient(vertex(triangle.vertex[a % 3]), vertex(triangle.vertex[b % 3]), to);
    };
    if (!triangle.free) return false;
    if (t.corner < 0) return side(t.side_to_next + 1, t.side_to_next + 2) > 0;
    return side(t.corner, t.corner + 1) >= 0 && side(t.corner + 2, t.corner) >= 0;
  });
}

}  // namespace exactvo::geometry::routing
