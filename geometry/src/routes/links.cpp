// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/links.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "routes/piece_tree.h"
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
             const auto d = to(b_) - to(a_), w = to(v_) - to(u);
             const N h = cross(d, to(v_) - to(a_));
             return dot(d, d) * dot(w, w) - h * cross(d, w);
           }) <= 0;
  }

  /// Whether the inside of the segment xy meets the closed disc, given that its ends do not: the middle's foot lies
  /// between them, and its distance is at most the disc's radius. Degree 8.
  bool meets_inside(const Point& x, const Point& y) const {
    return middle_is_beyond(x, x, y) > 0 && middle_is_beyond(y, x, y) < 0 && line_meets(x, y);
  }

  /// Whether the ray from v to u leads into the disc: (u - v).(foot - v) > 0.
  bool entered_from_v_towards(const Point& u) const {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> { return cross(to(u) - to(v_), to(b_) - to(a_)); }) > 0;
  }

 private:
  /// The sign of (m - p).(y - x), times 2 D.
  int middle_is_beyond(const Point& p, const Point& x, const Point& y) const {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> {
      using N = NumberOf<decltype(to)>;
      const auto d = to(b_) - to(a_), e = to(y) - to(x);
      const N h = cross(d, to(v_) - to(a_));
      return to(2.0) * dot(d, d) * dot(to(v_) - to(p), e) - h * cross(d, e);
    });
  }

  bool line_meets(const Point& x, const Point& y) const {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> {
             using N = NumberOf<decltype(to)>;
             const auto d = to(b_) - to(a_), e = to(y) - to(x);
             const N h = cross(d, to(v_) - to(a_));
             const N dd = dot(d, d);
             const N g = to(2.0) * dd * cross(e, to(v_) - to(x)) - h * dot(e, d);
             return h * h * dd * dot(e, e) - g * g;
           }) >= 0;
  }

  const Point& v_;
  const Point& a_;
  const Point& b_;
};

/// Where a wall is to be cut so that fewer sides of triangles lie across the Links that end on it.
struct Crowd {
  int wall;
  double share;  ///< of the Link's foot along the wall's own direction
};

/// Depth first from a vertex through all sides that a Link from it can cross; no recursion, since a Link may cross as
/// many sides as there are vertices.
class LinkSearch {
 public:
  explicit LinkSearch(const CellMap& map) : map_(map), reached_in_(map.triangles.size(), 0) {}

  void from(int triangle, int corner) {
    vertex_ = map_.triangles[triangle].vertex[corner];
    if (!map_.triangles[triangle].free || !map_.is_site(vertex_)) return;
    const int* v = map_.triangles[triangle].vertex;
    if (!map_.is_site(v[(corner + 1) % 3]) || !map_.is_site(v[(corner + 2) % 3])) return;
    depth_first({triangle, corner, 0, v[(corner + 1) % 3], v[(corner + 2) % 3]},
                [&](const Step& step) { through(step); });
  }

  /// The same from a wall, a side of a triangle: through all sides of which a piece is seen straight across from it, to
  /// the vertices that are seen so. Around a curve that faces another, a vertex sees many sides and no wall behind
  /// them.
  void from_wall(int triangle, int side) {
    const Triangle& t = map_.triangles[triangle];
    if (!t.free || t.wall[side] < 0) return;
    const Facing wall{t.wall[side], t.vertex[(side + 1) % 3], t.vertex[(side + 2) % 3]};
    depth_first({triangle, side, 0, wall.b, wall.a}, [&](const Step& step) { away_from(wall, step); });
  }

  std::vector<Link> links;
  std::vector<Crowd> crowds;  ///< of every long way to a wall
  std::size_t steps = 0;      ///< triangles looked at
  std::size_t crossings = 0;  ///< of all links with sides

 private:
  /// A side to leave a triangle by. All sides on the way to it are seen from the vertex between `right` and `left`.
  struct Step {
    int triangle, side;
    std::size_t depth;
    int right, left;
  };
  static constexpr std::size_t kLongWay = 8;

  const Point& point(int v) const { return map_.vertex(v); }

  /// `visit` takes a step, and puts those that follow from it into `todo_`.
  template <typename Visit>
  void depth_first(const Step& first, const Visit& visit) {
    todo_.assign(1, first);
    while (!todo_.empty()) {
      const Step step = todo_.back();
      todo_.pop_back();
      path_.resize(step.depth);
      visit(step);
    }
  }

  void through(const Step& step) {
    ++steps;
    const Triangle& t = map_.triangles[step.triangle];
    const int x = t.vertex[(step.side + 1) % 3], y = t.vertex[(step.side + 2) % 3];
    const Point& v = point(vertex_);
    if (is_too_far(v, point(x), point(y))) return;
    if (along(v, point(x), point(x), point(y)) <= 0 || along(v, point(y), point(x), point(y)) >= 0) return;
    path_.push_back({step.triangle, step.side});
    if (t.wall[step.side] >= 0)
      arrive(t.wall[step.side], x, y, step);
    else if (t.neighbour[step.side] >= 0)
      enter(t.neighbour[step.side], step);
  }

  /// Whether all Links that cross the side xy are surely longer than the widest gate.
  bool is_too_far(const Point& v, const Point& x, const Point& y) const {
    constexpr double kRounding = 0x1p-40;
    if (map_.has_all_gates()) return false;
    const Vec2 from = v.rounded(), p = x.rounded(), q = y.rounded();
    const double size = std::max({std::fabs(from.x), std::fabs(from.y), std::fabs(p.x), std::fabs(p.y), std::fabs(q.x),
                                  std::fabs(q.y), map_.widest_gate()});
    return distance({p, q}, from) > map_.widest_gate() + kRounding * size;
  }

  /// Goes on through those of the next triangle's other two sides of which something is seen. No link crosses a side xc
  /// to a corner c of the square: a circle round it is empty and huge, the link cuts a small cap off it, and x, on the
  /// arc of that cap, would lie in the link's disc.
  void enter(int triangle, const Step& from) {
    const Triangle& t = map_.triangles[triangle];
    const int back = static_cast<int>(std::find(t.neighbour, t.neighbour + 3, from.triangle) - t.neighbour);
    const Point& v = point(vertex_);
    for (const int side : {(back + 1) % 3, (back + 2) % 3}) {
      const int x = t.vertex[(side + 1) % 3], y = t.vertex[(side + 2) % 3];
      if (!map_.is_site(x) || !map_.is_site(y)) continue;
      const int right = orient(v, point(from.right), point(x)) > 0 ? x : from.right;
      const int left = orient(v, point(from.left), point(y)) < 0 ? y : from.left;
      if (orient(v, point(right), point(left)) > 0 && can_be_crossed(x, y, right) && can_be_crossed(x, y, left))
        todo_.push_back({triangle, side, path_.size(), right, left});
    }
  }

  /// Whether the disc over v and some point c of the side xy can be without u: (u - v).(u - c) > 0 for an end of it.
  bool can_be_crossed(int x, int y, int u) const {
    const Point &v = point(vertex_), &p = point(u);
    return along(point(x), p, v, p) < 0 || along(point(y), p, v, p) < 0;
  }

  /// The foot on the wall xy must be seen strictly between the ends of all sides on the way.
  void arrive(int wall, int x, int y, const Step& step) {
    const Point &v = point(vertex_), &a = point(x), &b = point(y);
    if (along(point(step.right), v, a, b) >= 0 || along(point(step.left), v, a, b) <= 0) return;
    if (path_.size() > kLongWay) crowds.push_back({wall, share_of_foot(wall)});
    add_if_gabriel(wall, x, y);
  }

  void add_if_gabriel(int wall, int x, int y) {
    if (!is_gabriel(x, y)) return;
    const Vec2 a = point(x).rounded(), d = point(y).rounded() - a;
    links.push_back({vertex_, wall, x, y, std::fabs(cross(d, point(vertex_).rounded() - a)) / norm(d), path_});
    crossings += path_.size();
  }

  /// A wall whose free triangle lies to the left of ab.
  struct Facing {
    int wall, a, b;
  };

  /// Into the step's triangle through its side; `left` and `right` bound what is seen, from the wall's a to its b.
  void away_from(const Facing& wall, const Step& step) {
    ++steps;
    const Triangle& t = map_.triangles[step.triangle];
    const int apex = t.vertex[step.side];
    if (!map_.is_site(apex)) return;
    path_.push_back({step.triangle, step.side});
    const Point &a = point(wall.a), &b = point(wall.b);
    const bool after_left = along(point(apex), point(step.left), a, b) > 0;
    const bool before_right = along(point(apex), point(step.right), a, b) < 0;
    if (after_left && before_right) link_to(wall, apex);
    // The side from the apex on is seen beyond it towards b, the other one towards a.
    const int towards_b = (step.side + 1) % 3, towards_a = (step.side + 2) % 3;
    if (before_right)
      leave(wall, t, {step.triangle, towards_b, path_.size(), step.right, after_left ? apex : step.left});
    if (after_left)
      leave(wall, t, {step.triangle, towards_a, path_.size(), before_right ? apex : step.right, step.left});
  }

  void leave(const Facing& wall, const Triangle& t, Step seen) {
    const int x = t.vertex[(seen.side + 1) % 3], y = t.vertex[(seen.side + 2) % 3];
    const int beyond = t.neighbour[seen.side];
    if (t.wall[seen.side] >= 0 || beyond < 0 || !map_.is_site(x) || !map_.is_site(y)) return;
    if (is_too_deep(wall, seen, seen.left, x, y) || is_too_deep(wall, seen, seen.right, x, y)) return;
    const int* back = map_.triangles[beyond].neighbour;
    seen.side = static_cast<int>(std::find(back, back + 3, seen.triangle) - back);
    seen.triangle = beyond;
    todo_.push_back(seen);
  }

  /// Whether u, which bounds what is seen, lies in the disc over every point of the side xy that is seen and its foot:
  /// with positions along the wall and heights above it, (position - u's)^2 <= u's height (height - u's height).
  bool is_too_deep(const Facing& wall, const Step& seen, int u, int x, int y) const {
    const Point &a = point(wall.a), &b = point(wall.b);
    if (u == wall.a || u == wall.b) return false;
    const auto holds = [&](int top) {
      return sign_of([&](auto to) -> NumberOf<decltype(to)> {
               const auto origin = to(a), d = to(b) - origin, at = to(point(u));
               const auto width = dot(to(point(seen.right)) - to(point(seen.left)), d);
               const auto height = cross(d, at - origin);
               return squared(width) - height * (cross(d, to(point(top)) - origin) - height);
             }) <= 0;
    };
    return holds(x) && holds(y);
  }

  void link_to(const Facing& wall, int vertex) {
    vertex_ = vertex;
    const std::vector<Link::Exit> inward = path_;
    std::reverse(path_.begin(), path_.end());
    if (path_.size() > kLongWay) crowds.push_back({wall.wall, share_of_foot(wall.wall)});
    add_if_gabriel(wall.wall, wall.a, wall.b);
    path_ = inward;
  }

  double share_of_foot(int wall) const {
    const PlanarGraph::Edge& e = map_.graph.edges[wall];
    const Vec2 a = point(e.a).rounded(), d = point(e.b).rounded() - a;
    return dot(point(vertex_).rounded() - a, d) / squared_norm(d);
  }

  /// Whether no site but v and the wall ab meets the disc: looked up in the triangles that meet it, from those on the
  /// way outward; where these are many, though the disc may be empty, by place.
  bool is_gabriel(int a, int b) {
    constexpr std::size_t kMany = 32;
    const DiametralDisc disc(point(vertex_), point(a), point(b));
    ++searches_;
    reached_.clear();
    for (const Link::Exit& exit : path_) reach(exit.triangle);
    for (std::size_t k = 0; k < reached_.size(); ++k) {
      ++steps;
      if (k >= kMany) return is_gabriel_by_place(a, b, disc);
      if (!spread(reached_[k], a, b, disc)) return false;
    }
    return true;
  }

  bool is_gabriel_by_place(int a, int b, const DiametralDisc& disc) {
    if (!pieces_) pieces_.emplace(map_);
    const Vec2 v = point(vertex_).rounded(), p = point(a).rounded(), d = point(b).rounded() - p;
    const Vec2 to_foot = cross(d, v - p) / squared_norm(d) * Vec2{d.y, -d.x}, middle = v + 0.5 * to_foot;
    return pieces_->for_each_near(middle, middle, 0.5 * norm(to_foot), [&](int piece) {
      ++steps;
      const auto [x, y] = map_.ends_of(piece);
      return (x == a && y == b) || (x == b && y == a) || !meets(x, y, a, b, disc);
    });
  }

  /// Whether the site xy meets the disc anywhere but in v.
  bool meets(int x, int y, int a, int b, const DiametralDisc& disc) const {
    for (const int u : {x, y})
      if (u != vertex_ && u != a && u != b && disc.holds(point(u))) return true;
    return x != y && meets_inside(x, y, disc);
  }

  /// Whether the inside of the site xy meets the disc, given that none of its ends but v lies in it.
  bool meets_inside(int x, int y, const DiametralDisc& disc) const {
    return x == vertex_ || y == vertex_ ? disc.entered_from_v_towards(point(x == vertex_ ? y : x))
                                        : disc.meets_inside(point(x), point(y));
  }

  void reach(int triangle) {
    if (reached_in_[triangle] == searches_) return;
    reached_in_[triangle] = searches_;
    reached_.push_back(triangle);
  }

  /// False where a site in or on this triangle meets the disc; goes on to the neighbours into which the disc reaches.
  bool spread(int triangle, int a, int b, const DiametralDisc& disc) {
    const Triangle& t = map_.triangles[triangle];
    for (const int u : t.vertex)
      if (map_.is_site(u) && meets(u, u, a, b, disc)) return false;
    for (int i = 0; i < 3; ++i) {
      const int x = t.vertex[(i + 1) % 3], y = t.vertex[(i + 2) % 3];
      const bool is_wall = t.wall[i] >= 0;
      if (is_wall ? x == a && y == b : t.neighbour[i] < 0 || reached_in_[t.neighbour[i]] == searches_) continue;
      if (!meets_inside(x, y, disc)) continue;
      if (is_wall) return false;
      reach(t.neighbour[i]);
    }
    return true;
  }

  const CellMap& map_;
  int vertex_ = -1;
  std::vector<Link::Exit> path_;
  std::vector<Step> todo_;
  std::vector<std::size_t> reached_in_;  ///< of a triangle: the last search that reached it
  std::vector<int> reached_;
  std::size_t searches_ = 0;
  std::optional<PieceTree> pieces_;  ///< made when it is first needed
};

/// Feet of Links from vertices all over the map, as many as the steps allow. The stride is prime and larger than any
/// number of corners, so that each corner comes once.
std::vector<Crowd> sampled_crowds(const CellMap& map, std::size_t most_steps) {
  constexpr std::uint64_t kStride = 11400714819323198393u;
  LinkSearch search(map);
  const std::uint64_t corners = 3 * map.triangles.size();
  for (std::uint64_t k = 0, at = 0; k < corners && search.steps < most_steps; ++k) {
    search.from(static_cast<int>(at / 3), static_cast<int>(at % 3));
    at = (at + kStride % corners) % corners;
  }
  return std::move(search.crowds);
}

/// The point of the wall at a share that has few digits, exactly.
Point point_at(const Point& a, const Point& b, double share) {
  const Vector<Rational> p = a.exact(), d = b.exact() - p;
  const Rational s(share);
  return {Rational(p.x + s * d.x), Rational(p.y + s * d.y)};
}

}  // namespace

std::optional<std::vector<Link>> gabriel_links(const CellMap& map, LinkBounds bounds, LinksFrom from) {
  LinkSearch search(map);
  for (std::size_t f = 0; f < map.triangles.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (from == LinksFrom::vertices)
        search.from(static_cast<int>(f), k);
      else
        search.from_wall(static_cast<int>(f), k);
    }
    if (search.steps > bounds.steps || search.crossings > bounds.crossings) return std::nullopt;
  }
  return std::move(search.links);
}

bool cut_crowded_walls(const CellMap& map, std::size_t most_steps, PlanarGraph& graph) {
  std::vector<Crowd> crowds = sampled_crowds(map, most_steps);
  constexpr double kGrid = 0x1p40;  // shares of a wall: finer than any spacing of feet that matters
  for (Crowd& c : crowds) c.share = std::nearbyint(c.share * kGrid) / kGrid;
  std::sort(crowds.begin(), crowds.end(),
            [](const Crowd& p, const Crowd& q) { return p.wall < q.wall || (p.wall == q.wall && p.share < q.share); });
  bool any = false;
  for (std::size_t k = 0; k < crowds.size();) {
    const int wall = crowds[k].wall;
    const PlanarGraph::Edge whole = graph.edges[wall];
    const Point a = graph.vertices[whole.a], b = graph.vertices[whole.b];
    int last = wall;  // the piece that is still to be cut
    for (double before = 0.0; k < crowds.size() && crowds[k].wall == wall; ++k) {
      if (!(crowds[k].share > before && crowds[k].share < 1.0)) continue;
      before = crowds[k].share;
      const int middle = static_cast<int>(graph.vertices.size());
      graph.vertices.push_back(point_at(a, b, before));
      graph.on.push_back(whole.on);
      graph.edges[last].b = middle;
      last = static_cast<int>(graph.edges.size());
      graph.edges.push_back({middle, whole.b, whole.winding, whole.on});
      any = true;
    }
  }
  return any;
}

}  // namespace exactvo::geometry::routing
