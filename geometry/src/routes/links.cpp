// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "routes/cell_map.h"
#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// The disc whose diameter is the link from v to its foot on the line ab, v to the left of ab. With d = b - a,
/// D = |d|^2, h = d x (v - a) > 0 and n = (-d.y, d.x), the foot is v - (h / D) n, the middle m = v - (h / 2D) n.
class DiametralDisc {
 public:
  DiametralDisc(const Point& v, const Point& a, const Point& b) : v_(v), a_(a), b_(b) {}

  /// Whether u lies in the closed disc: (u - v).(u - foot) <= 0. Degree 4.
  bool holds(const Point& u) const {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> {
             using N = NumberOf<decltype(to)>;
             const auto d = minus(to(b_), to(a_)), w = minus(to(v_), to(u));
             const N h = cross_of(d, minus(to(v_), to(a_)));
             return dot_of(d, d) * dot_of(w, w) - h * cross_of(d, w);
           }) <= 0;
  }

  /// Whether the inside of the segment xy meets the closed disc, given that its ends do not: the middle's foot lies
  /// between them, and its distance is at most the disc's radius. Degree 8.
  bool meets_inside(const Point& x, const Point& y) const {
    return middle_is_beyond(x, x, y) > 0 && middle_is_beyond(y, x, y) < 0 && line_meets(x, y);
  }

  /// Whether the ray from v to u leads into the disc: (u - v).(foot - v) > 0.
  bool entered_from_v_towards(const Point& u) const {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> {
             return cross_of(minus(to(u), to(v_)), minus(to(b_), to(a_)));
           }) > 0;
  }

 private:
  /// The sign of (m - p).(y - x), times 2 D.
  int middle_is_beyond(const Point& p, const Point& x, const Point& y) const {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> {
      using N = NumberOf<decltype(to)>;
      const auto d = minus(to(b_), to(a_)), e = minus(to(y), to(x));
      const N h = cross_of(d, minus(to(v_), to(a_)));
      return to(2.0) * dot_of(d, d) * dot_of(minus(to(v_), to(p)), e) - h * cross_of(d, e);
    });
  }

  bool line_meets(const Point& x, const Point& y) const {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> {
             using N = NumberOf<decltype(to)>;
             const auto d = minus(to(b_), to(a_)), e = minus(to(y), to(x));
             const N h = cross_of(d, minus(to(v_), to(a_)));
             const N dd = dot_of(d, d);
             const N g = to(2.0) * dd * cross_of(e, minus(to(v_), to(x))) - h * dot_of(e, d);
             return h * h * dd * dot_of(e, e) - g * g;
           }) >= 0;
  }

  const Point& v_;
  const Point& a_;
  const Point& b_;
};

/// From one vertex and one of its triangles through all sides that a Link can cross.
class LinkSearch {
 public:
  LinkSearch(const CellMap& map, std::vector<Link>& out) : map_(map), out_(out) {}

  void from(int triangle, int corner) {
    vertex_ = map_.triangles[triangle].vertex[corner];
    if (map_.is_site(vertex_)) through(triangle, corner);
  }

 private:
  const Point& point(int v) const { return map_.vertex(v); }

  void through(int triangle, int side) {
    const Triangle& t = map_.triangles[triangle];
    const int x = t.vertex[(side + 1) % 3], y = t.vertex[(side + 2) % 3];
    const Point& v = point(vertex_);
    if (along(v, point(x), point(x), point(y)) <= 0 || along(v, point(y), point(x), point(y)) >= 0) return;
    path_.push_back({triangle, side});
    if (t.wall[side] >= 0) {
      if (crosses_whole_path(x, y) && is_gabriel(x, y)) add(t.wall[side], x, y);
    } else if (t.neighbour[side] >= 0) {
      const int next = t.neighbour[side];
      const int back = side_towards(next, triangle);
      through(next, (back + 1) % 3);
      through(next, (back + 2) % 3);
    }
    path_.pop_back();
  }

  int side_towards(int triangle, int neighbour) const {
    const int* n = map_.triangles[triangle].neighbour;
    return static_cast<int>(std::find(n, n + 3, neighbour) - n);
  }

  void add(int wall, int x, int y) {
    const Vec2 v = point(vertex_).rounded(), a = point(x).rounded(), d = point(y).rounded() - a;
    out_.push_back({vertex_, wall, x, y, std::fabs(cross(d, v - a)) / norm(d), path_});
  }

  /// Whether the ends of every side on the way lie strictly on either side of the line from v to its foot on xy.
  bool crosses_whole_path(int x, int y) const {
    return std::all_of(path_.begin(), path_.end() - 1, [&](const Link::Exit& exit) {
      const Triangle& t = map_.triangles[exit.triangle];
      const Point& v = point(vertex_);
      const int a = along(point(t.vertex[(exit.side + 1) % 3]), v, point(x), point(y));
      const int b = along(point(t.vertex[(exit.side + 2) % 3]), v, point(x), point(y));
      return a * b < 0;
    });
  }

  /// Whether no site but v and the wall ab meets the disc: looked up in the triangles that meet it, from those on the
  /// way outward.
  bool is_gabriel(int a, int b) const {
    const DiametralDisc disc(point(vertex_), point(a), point(b));
    std::vector<int> reached;
    for (const Link::Exit& exit : path_) reached.push_back(exit.triangle);
    for (std::size_t k = 0; k < reached.size(); ++k)
      if (!spread(reached[k], a, b, disc, reached)) return false;
    return true;
  }

  /// False where a site in or on this triangle meets the disc; adds the neighbours into which the disc reaches.
  bool spread(int triangle, int a, int b, const DiametralDisc& disc, std::vector<int>& reached) const {
    const Triangle& t = map_.triangles[triangle];
    for (const int u : t.vertex)
      if (u != vertex_ && u != a && u != b && map_.is_site(u) && disc.holds(point(u))) return false;
    for (int i = 0; i < 3; ++i) {
      const int x = t.vertex[(i + 1) % 3], y = t.vertex[(i + 2) % 3];
      const bool at_v = x == vertex_ || y == vertex_;
      if (t.wall[i] >= 0) {
        if (x == a && y == b) continue;
        if (at_v ? disc.entered_from_v_towards(point(x == vertex_ ? y : x)) : disc.meets_inside(point(x), point(y)))
          return false;
      } else if (t.neighbour[i] >= 0 && std::find(reached.begin(), reached.end(), t.neighbour[i]) == reached.end()) {
        if (at_v || disc.meets_inside(point(x), point(y))) reached.push_back(t.neighbour[i]);
      }
    }
    return true;
  }

  const CellMap& map_;
  std::vector<Link>& out_;
  int vertex_ = -1;
  std::vector<Link::Exit> path_;
};

}  // namespace

std::vector<Link> gabriel_links(const CellMap& map) {
  std::vector<Link> links;
  LinkSearch search(map, links);
  for (std::size_t f = 0; f < map.triangles.size(); ++f)
    for (int corner = 0; map.triangles[f].free && corner < 3; ++corner) search.from(static_cast<int>(f), corner);
  return links;
}

}  // namespace exactvo::geometry::routing
