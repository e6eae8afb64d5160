// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/validity.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/too_many_contacts.h"
#include "rings/ring_contacts.h"
#include "shapes/edge_crossing.h"

namespace exactvo::geometry::detail {
namespace {

/// Whether simple rings form a polygon with holes: rings[0] outside, the others inside it and outside each other.
/// Exact.

/// Ring `ring` crosses another ring at `where`, or lies on its wrong side (then `vertex` says which point showed it).
struct Misplacement {
  std::size_t ring = 0;
  std::size_t vertex = 0;
  Vec2 where;
};

/// Pairs of edges whose boxes meet, and tests of a vertex against an edge: two to five seconds each.
inline constexpr std::size_t kMostContactPairs = std::size_t{1} << 26;
inline constexpr std::size_t kMostEdgeTests = std::size_t{1} << 29;

// A ring where it passes through the point `at`: it comes from `before` and goes on to `after`.
struct Passage {
  Vec2 before;
  Vec2 at;
  Vec2 after;
};

Passage passage_at_vertex(const Ring& ring, std::size_t i) {
  const std::size_t n = ring.size();
  return {ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]};
}

// The passage of the ring through `at`, a point of its edge number `edge`.
Passage passage_through(const Ring& ring, std::size_t edge, Vec2 at) {
  const std::size_t next = (edge + 1) % ring.size();
  if (ring[edge] == at) return passage_at_vertex(ring, edge);
  if (ring[next] == at) return passage_at_vertex(ring, next);
  return {ring[edge], at, ring[next]};
}

// Whether the direction at -> q points strictly to the left of the passage:
//
//         q            before
//          \          /            the left side is the cone that turns counter-clockwise
//           at <-----'             from at -> after to at -> before
//             \_ after
bool points_left(const Passage& p, Vec2 q) {
  const bool left_of_after = orientation(p.at, p.after, q) == Sign::positive;
  const bool right_of_before = orientation(p.at, p.before, q) == Sign::negative;
  const Sign turn = orientation(p.at, p.after, p.before);
  if (turn == Sign::positive) return left_of_after && right_of_before;
  if (turn == Sign::zero) return left_of_after;
  const bool right_of_after = orientation(p.at, p.after, q) == Sign::negative;
  const bool left_of_before = orientation(p.at, p.before, q) == Sign::positive;
  return !(right_of_after && left_of_before);
}

bool overlap_along_a_line(const Segment& s, const Segment& t) {
  if (orientation(s.a, s.b, t.a) != Sign::zero || orientation(s.a, s.b, t.b) != Sign::zero) return false;
  const auto less = lexicographically_less;
  const Vec2 from = std::max(std::min(s.a, s.b, less), std::min(t.a, t.b, less), less);
  const Vec2 to = std::min(std::max(s.a, s.b, less), std::max(t.a, t.b, less), less);
  return less(from, to);
}

bool cross_properly(const Segment& s, const Segment& t) {
  return !lies_on(s, t.a) && !lies_on(s, t.b) && !lies_on(t, s.a) && !lies_on(t, s.b);
}

// REQUIRES: edges that meet. Whether their rings cross or overlap there, rather than touch in a point.
bool is_crossing(const Ring& a, std::size_t edge_a, const Ring& b, std::size_t edge_b) {
  const Segment s = {a[edge_a], a[(edge_a + 1) % a.size()]};
  const Segment t = {b[edge_b], b[(edge_b + 1) % b.size()]};
  if (overlap_along_a_line(s, t) || cross_properly(s, t)) return true;
  const Vec2 at = common_point(s, t);
  const Passage through_a = passage_through(a, edge_a, at);
  const Passage through_b = passage_through(b, edge_b, at);
  return points_left(through_a, through_b.before) != points_left(through_a, through_b.after);
}

bool contains(const Box& box, const Box& other) {
  return box.low.x <= other.low.x && other.high.x <= box.high.x && box.low.y <= other.low.y &&
         other.high.y <= box.high.y;
}

Box box_of(const Ring& ring) {
  Box box;
  for (const Vec2 p : ring) box.add(p);
  return box;
}

// The number of the edge of `ring` on which x lies.
std::size_t edge_under(const Ring& ring, Vec2 x) {
  std::size_t i = 0;
  while (!lies_on({ring[i], ring[(i + 1) % ring.size()]}, x)) ++i;
  return i;
}

// A simple ring on the lookout for points: from some size on its edges are sorted into slabs of equal height, so that a
// point is held against those of its own slab alone.
class PointLocator {
 public:
  explicit PointLocator(const Ring& ring) : ring_(ring), box_(box_of(ring)) {
    constexpr std::size_t kFewEdges = 64;
    constexpr std::size_t kEdgesOfSlab = 8;
    if (ring.size() < kFewEdges) return;
    slabs_.resize(ring.size() / kEdgesOfSlab);
    std::size_t entries = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto [low, high] = std::minmax(ring[i].y, ring[(i + 1) % ring.size()].y);
      const std::size_t last = slab_of(high);
      for (std::size_t slab = slab_of(low); slab <= last; ++slab) slabs_[slab].push_back(i);
      entries += last - slab_of(low) + 1;
      if (entries > 8 * ring.size()) {  // long edges: every slab would hold most of them
        slabs_.clear();
        return;
      }
    }
  }

  // By the even-odd rule. Exact.
  Place locate(Vec2 p) const {
    if (!slabs_.empty() && (p.y < box_.low.y || p.y > box_.high.y)) return Place::outside;
    return even_odd_place(p, [&](const auto& visit) {
      const auto visit_edge = [&](std::size_t i) { visit({ring_[i], ring_[(i + 1) % ring_.size()]}); };
      if (slabs_.empty())
        for (std::size_t i = 0; i < ring_.size(); ++i) visit_edge(i);
      else
        for (const std::size_t i : slabs_[slab_of(p.y)]) visit_edge(i);
    });
  }

  // Edges that `locate` looks at.
  std::size_t cost(Vec2 p) const { return slabs_.empty() ? ring_.size() : slabs_[slab_of(p.y)].size(); }

 private:
  std::size_t slab_of(double y) const {
    const double height = box_.high.y - box_.low.y;  // infinite where it lies beyond the doubles
    const double share = std::isfinite(height) ? (y - box_.low.y) / height
                                               : (0.5 * y - 0.5 * box_.low.y) / (0.5 * box_.high.y - 0.5 * box_.low.y);
    const auto last = static_cast<double>(slabs_.size() - 1);
    return static_cast<std::size_t>(std::min(std::max(share, 0.0) * static_cast<double>(slabs_.size()), last));
  }

  const Ring& ring_;
  Box box_;
  std::vector<std::vector<std::size_t>> slabs_;
};

// From the least vertex on two equal rings of one winding have the same vertices.
Ring from_least(const Ring& ring) {
  Ring turned = ring;
  std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(least_vertex(ring)), turned.end());
  return turned;
}

class Search {
 public:
  explicit Search(const std::vector<const Ring*>& rings)
      : rings_(rings), found_(rings.size()), locators_(rings.size()) {
    for (const Ring* ring : rings) boxes_.push_back(box_of(*ring));
  }

  std::vector<Misplacement> run() {
    report_equal_holes();
    report_crossings();
    for (const std::size_t i : different_) {
      if (i > 0 && !found_[i]) report_wrong_side(i);
    }
    std::vector<Misplacement> misplaced;
    for (const auto& m : found_) {
      if (m) misplaced.push_back(*m);
    }
    return misplaced;
  }

 private:
  void report(std::size_t ring, std::size_t vertex, Vec2 where) {
    if (!found_[ring]) found_[ring] = Misplacement{ring, vertex, where};
  }

  // Each lies within the other. One of them, the first, stays among the rings that are `different_`.
  void report_equal_holes() {
    std::vector<std::pair<Ring, std::size_t>> holes;
    for (std::size_t i = 1; i < rings_.size(); ++i) holes.emplace_back(from_least(*rings_[i]), i);
    std::sort(holes.begin(), holes.end(), [](const auto& a, const auto& b) {
      if (a.first == b.first) return a.second < b.second;
      return std::lexicographical_compare(a.first.begin(), a.first.end(), b.first.begin(), b.first.end(),
                                          lexicographically_less);
    });
    different_.push_back(0);
    for (std::size_t k = 0; k < holes.size(); ++k) {
      const bool is_repeated = k > 0 && holes[k].first == holes[k - 1].first;
      const std::size_t ring = holes[k].second;
      if (!is_repeated) different_.push_back(ring);
      if (is_repeated || (k + 1 < holes.size() && holes[k].first == holes[k + 1].first))
        report(ring, least_vertex(*rings_[ring]), holes[k].first.front());
    }
    std::sort(different_.begin(), different_.end());
  }

  // The sweep answers the common case (no two rings touch) alone. Of each ring the first crossing is reported, by ring
  // and edge of the other and its own edge.
  void report_crossings() {
    std::vector<Chain> chains;
    for (const std::size_t i : different_) chains.push_back({rings_[i]});
    if (!find_contact(chains)) return;
    using Key = std::tuple<std::size_t, std::size_t, std::size_t>;
    std::vector<std::optional<Key>> first_crossing(chains.size());
    const bool is_complete = for_each_box_pair(chains, kMostContactPairs, [&](EdgeId first, EdgeId second) {
      std::optional<Key>& best = first_crossing[second.chain];
      const Key key{first.chain, first.edge, second.edge};
      if (first.chain != second.chain && (!best || key < *best) &&
          intersect(chains[first.chain].edge(first.edge), chains[second.chain].edge(second.edge)) &&
          is_crossing(*chains[first.chain].points, first.edge, *chains[second.chain].points, second.edge))
        best = key;
      return true;
    });
    for (std::size_t k = 0; k < chains.size(); ++k) {
      if (!first_crossing[k]) continue;
      const auto [chain, edge, own_edge] = *first_crossing[k];
      report(different_[k], own_edge, common_point(chains[chain].edge(edge), chains[k].edge(own_edge)));
    }
    if (!is_complete) throw TooManyContacts();
  }

  void report_wrong_side(std::size_t i) {
    const Ring& hole = *rings_[i];
    if (!contains(boxes_[0], boxes_[i]) || !lies_within(hole, 0)) report(i, 0, hole[0]);
    for (const std::size_t j : different_) {
      if (found_[i]) return;
      if (j > 0 && j != i && contains(boxes_[j], boxes_[i]) && lies_within(hole, j)) report(i, 0, hole[0]);
    }
  }

  // Whether `inner` lies in the area bounded by ring number `around`, of two rings that do not cross: any vertex off
  // the other ring tells; if all lie on it, the way on from the first one does.
  bool lies_within(const Ring& inner, std::size_t around) {
    const PointLocator& locator = locator_of(around);
    for (const Vec2 p : inner) {
      edge_tests_ += locator.cost(p);
      if (edge_tests_ > kMostEdgeTests) throw TooManyContacts();
      const Place place = locator.locate(p);
      if (place != Place::boundary) return place == Place::inside;
    }
    const Ring& ring = *rings_[around];
    const Passage passage = passage_through(ring, edge_under(ring, inner[0]), inner[0]);
    const bool is_clockwise = around > 0;
    return points_left(passage, inner[1]) != is_clockwise;
  }

  const PointLocator& locator_of(std::size_t ring) {
    if (!locators_[ring]) locators_[ring] = std::make_unique<PointLocator>(*rings_[ring]);
    return *locators_[ring];
  }

  const std::vector<const Ring*>& rings_;
  std::vector<Box> boxes_;
  std::vector<std::optional<Misplacement>> found_;
  std::vector<std::size_t> different_;  ///< numbers of rings, ascending; of equal holes the first
  std::vector<std::unique_ptr<PointLocator>> locators_;
  std::size_t edge_tests_ = 0;
};

/// One misplacement at most a hole, in order. REQUIRES: every ring simple, rings[0] counter-clockwise, others
/// clockwise. Throws TooManyContacts beyond the limits below.
std::vector<Misplacement> misplaced_holes(const std::vector<const Ring*>& rings) {
  return Search(rings).run();
}

}  // namespace
}  // namespace exactvo::geometry::detail

namespace exactvo::geometry {
namespace {

using detail::Chain;
using Problems = std::vector<RingProblem>;

// A ring on its way through the checks: its distinct vertices and where each stood in the input.
struct CleanRing {
  Ring points;
  std::vector<std::size_t> source;
};

bool report_not_finite(const std::vector<Vec2>& points, std::size_t ring, Problems& problems) {
  const std::size_t before = problems.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) problems.push_back({RingProblemCode::not_finite, ring, i, points[i], false});
  }
  return problems.size() != before;
}

std::size_t count_repeats(const std::vector<Vec2>& points) {
  std::size_t repeats = 0;
  for (std::size_t i = 1; i < points.size(); ++i) repeats += points[i] == points[i - 1] ? 1 : 0;
  return repeats;
}

// Millions of points may be one and the same: no more memory is taken than they need.
CleanRing without_repeats(const std::vector<Vec2>& points, std::size_t ring, Problems& problems) {
  const std::size_t repeats = count_repeats(points);
  if (repeats > 1) problems.reserve(problems.size() + repeats);
  CleanRing clean;
  clean.points.reserve(points.size() - repeats);
  clean.source.reserve(points.size() - repeats);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!clean.points.empty() && clean.points.back() == points[i]) {
      problems.push_back({RingProblemCode::repeated_vertex, ring, i, points[i], true});
      continue;
    }
    clean.points.push_back(points[i]);
    clean.source.push_back(i);
  }
  return clean;
}

CleanRing without_closure(const Ring& points, std::size_t ring, Problems& problems) {
  CleanRing clean = without_repeats(points, ring, problems);
  if (clean.points.size() > 1 && clean.points.front() == clean.points.back()) {
    clean.points.pop_back();
    clean.source.pop_back();
  } else if (!points.empty()) {
    problems.push_back({RingProblemCode::unclosed, ring, points.size() - 1, points.back(), true});
  }
  return clean;
}

// Whether the ring by itself bounds an area; otherwise the problem is reported.
bool bounds_an_area(const CleanRing& clean, std::size_t ring, Problems& problems) {
  std::vector<Vec2> distinct = clean.points;
  std::sort(distinct.begin(), distinct.end(), detail::lexicographically_less);
  const bool has_three = std::unique(distinct.begin(), distinct.end()) - distinct.begin() > 2;
  if (!has_three || detail::on_one_line(clean.points)) {
    const Vec2 where = clean.points.empty() ? Vec2{} : clean.points.front();
    const RingProblemCode code = has_three ? RingProblemCode::zero_area : RingProblemCode::too_few_points;
    problems.push_back({code, ring, 0, where, false});
    return false;
  }
  if (const auto contact = detail::find_contact({Chain{&clean.points}})) {
    problems.push_back(
        {RingProblemCode::self_intersection, ring, clean.source[contact->first.edge], contact->where, false});
    return false;
  }
  return true;
}

void turn_if_needed(CleanRing& clean, std::size_t ring, Problems& problems) {
  const Sign wanted = ring == 0 ? Sign::positive : Sign::negative;
  if (winding(clean.points) == wanted) return;
  problems.push_back({RingProblemCode::clockwise, ring, clean.source.front(), clean.points.front(), true});
  std::reverse(std::next(clean.points.begin()), clean.points.end());  // the first vertex stays the first
  std::reverse(std::next(clean.source.begin()), clean.source.end());
}

// The ring, repaired as far as it goes; false if it can't be part of a polygon.
bool check_ring(const Ring& given, std::size_t ring, CleanRing& clean, Problems& problems) {
  if (report_not_finite(given, ring, problems)) return false;
  clean = without_closure(given, ring, problems);
  if (!bounds_an_area(clean, ring, problems)) return false;
  turn_if_needed(clean, ring, problems);
  return true;
}

void check_placement(const std::vector<CleanRing>& rings, Problems& problems) {
  std::vector<const Ring*> points;
  for (const CleanRing& r : rings) points.push_back(&r.points);
  for (const detail::Misplacement& m : detail::misplaced_holes(points)) {
    problems.push_back({RingProblemCode::hole_outside, m.ring, rings[m.ring].source[m.vertex], m.where, false});
  }
}

bool lexicographically_less(const RingProblem& a, const RingProblem& b) {
  return std::tie(a.ring, a.vertex, a.code) < std::tie(b.ring, b.vertex, b.code);
}

bool all_repaired(const Problems& problems) {
  return std::all_of(problems.begin(), problems.end(), [](const RingProblem& p) { return p.repaired; });
}

}  // namespace

const char* code_name(RingProblemCode code) {
  constexpr const char* kNames[] = {"E_NOT_FINITE", "E_TOO_FEW_POINTS", "E_UNCLOSED",          "E_REPEATED_VERTEX",
                                    "E_CLOCKWISE",  "E_ZERO_AREA",      "E_SELF_INTERSECTION", "E_HOLE_OUTSIDE"};
  const auto number = static_cast<std::size_t>(code);
  EXACTVO_REQUIRE(number < std::size(kNames), std::to_string(number));
  return kNames[number];
}

bool NormalizedPolygon::ok() const {
  return all_repaired(problems);
}
bool NormalizedPolyline::ok() const {
  return all_repaired(problems);
}

NormalizedPolygon normalize(const std::vector<Ring>& rings) {
  EXACTVO_REQUIRE(!rings.empty(), std::string("no ring"));
  NormalizedPolygon result;
  std::vector<CleanRing> clean(rings.size());
  bool every_ring_stands = true;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    every_ring_stands = check_ring(rings[i], i, clean[i], result.problems) && every_ring_stands;
  }
  if (every_ring_stands && rings.size() > 1) check_placement(clean, result.problems);
  std::sort(result.problems.begin(), result.problems.end(), lexicographically_less);
  result.polygon.outer = std::move(clean.front().points);
  for (std::size_t i = 1; i < clean.size(); ++i) result.polygon.holes.push_back(std::move(clean[i].points));
  return result;
}

NormalizedPolyline normalize_polyline(const std::vector<Vec2>& points) {
  NormalizedPolyline result;
  if (report_not_finite(points, 0, result.problems)) return result;
  result.polyline.points = without_repeats(points, 0, result.problems).points;
  if (result.polyline.points.size() < 2) {
    const Vec2 where = points.empty() ? Vec2{} : points.front();
    result.problems.push_back({RingProblemCode::too_few_points, 0, 0, where, false});
  }
  std::sort(result.problems.begin(), result.problems.end(), lexicographically_less);
  return result;
}

bool is_simple(const Ring& ring) {
  EXACTVO_REQUIRE(std::all_of(ring.begin(), ring.end(), is_finite), excerpt(ring));
  if (ring.size() < 3) return false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i] == ring[(i + 1) % ring.size()]) return false;
  }
  return !detail::find_contact({Chain{&ring}});
}

// At the lexicographically least vertex of a simple ring the turn is the ring's, and it is never straight.
Sign winding(const Ring& ring) {
  EXACTVO_REQUIRE(ring.size() >= 3, excerpt(ring));
  const std::size_t n = ring.size();
  const std::size_t i = detail::least_vertex(ring);
  return orientation(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
}

}  // namespace exactvo::geometry
