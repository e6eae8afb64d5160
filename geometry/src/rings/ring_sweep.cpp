// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "exactvo/geometry/distance.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

struct SweepEdge {
  Vec2 left;   // the lexicographically smaller end
  Vec2 right;  // the other
  EdgeId id;
};

// Whether `later`, whose left end the sweep has just met, runs above `earlier`: its sign just right of that end.
int side(const SweepEdge& earlier, const SweepEdge& later) {
  const Sign at_left = orientation(earlier.left, earlier.right, later.left);
  if (at_left != Sign::zero) return static_cast<int>(at_left);
  return static_cast<int>(orientation(earlier.left, earlier.right, later.right));
}

// The order along the sweep line, bottom to top. Two edges compare equal only if they overlap from a common left on.
struct Below {
  bool operator()(const SweepEdge* s, const SweepEdge* t) const {
    return lexicographically_less(t->left, s->left) ? side(*t, *s) < 0 : side(*s, *t) > 0;
  }
};

using Status = std::set<const SweepEdge*, Below>;

Contact contact(const SweepEdge& s, const SweepEdge& t) {
  return {s.id, t.id, common_point({s.left, s.right}, {t.left, t.right})};
}

struct Event {
  Vec2 at;
  bool starts = false;
  std::size_t edge = 0;  // index into the sweep's edges
  EdgeId vertex;         // the vertex of the chain that lies here
};

// Ends come before starts, so neighbours that share a vertex never stand in the status together at it.
bool comes_before(const Event& a, const Event& b) {
  if (a.at != b.at) return lexicographically_less(a.at, b.at);
  if (a.starts != b.starts) return b.starts;
  return a.edge < b.edge;
}

class Sweep {
 public:
  explicit Sweep(const std::vector<Chain>& chains) : chains_(chains) {
    for (std::size_t c = 0; c < chains.size(); ++c) {
      for (std::size_t i = 0; i < chains[c].edge_count(); ++i) add({c, i});
    }
    std::sort(events_.begin(), events_.end(), comes_before);
    places_.resize(edges_.size());
  }

  std::optional<Contact> run() {
    if (auto found = coinciding_vertices()) return found;
    for (const Event& event : events_) {
      if (auto found = event.starts ? start(event.edge) : finish(event.edge)) return found;
    }
    return std::nullopt;
  }

 private:
  void add(EdgeId id) {
    const Segment s = chains_[id.chain].edge(id.edge);
    const EdgeId from = id;
    const EdgeId to = {id.chain, (id.edge + 1) % chains_[id.chain].points->size()};
    const bool forward = lexicographically_less(s.a, s.b);
    const std::size_t number = edges_.size();
    edges_.push_back(forward ? SweepEdge{s.a, s.b, id} : SweepEdge{s.b, s.a, id});
    events_.push_back({s.a, forward, number, from});
    events_.push_back({s.b, !forward, number, to});
  }

  // Vertices that coincide without being the same one: the sweep itself would not see two that only meet tip to tip.
  std::optional<Contact> coinciding_vertices() const {
    for (std::size_t i = 1; i < events_.size(); ++i) {
      const Event& a = events_[i - 1];
      const Event& b = events_[i];
      const bool same_vertex = a.vertex.chain == b.vertex.chain && a.vertex.edge == b.vertex.edge;
      if (a.at == b.at && !same_vertex) return contact(edges_[a.edge], edges_[b.edge]);
    }
    return std::nullopt;
  }

  std::optional<Contact> start(std::size_t number) {
    const SweepEdge* edge = &edges_[number];
    const auto [place, fresh] = status_.insert(edge);
    if (!fresh) return contact(**place, *edge);
    places_[number] = place;
    if (place != status_.begin() && meet(**std::prev(place), *edge)) return contact(**std::prev(place), *edge);
    const auto above = std::next(place);
    if (above != status_.end() && meet(**above, *edge)) return contact(**above, *edge);
    return std::nullopt;
  }

  std::optional<Contact> finish(std::size_t number) {
    const auto above = status_.erase(places_[number]);
    if (above == status_.begin() || above == status_.end()) return std::nullopt;
    const auto below = std::prev(above);
    if (meet(**below, **above)) return contact(**below, **above);
    return std::nullopt;
  }

  // Neighbours always share their vertex; they meet elsewhere only if one folds back onto the other.
  bool meet(const SweepEdge& s, const SweepEdge& t) const {
    const Segment a = {s.left, s.right};
    const Segment b = {t.left, t.right};
    if (!are_neighbours(s.id, t.id)) return intersect(a, b);
    if (s.left == t.left) return orientation(s.left, s.right, t.right) == Sign::zero;
    if (s.right == t.right) return orientation(s.right, s.left, t.left) == Sign::zero;
    return false;  // one ends where the other begins
  }

  bool are_neighbours(EdgeId a, EdgeId b) const {
    if (a.chain != b.chain) return false;
    const std::size_t gap = a.edge < b.edge ? b.edge - a.edge : a.edge - b.edge;
    return gap == 1 || (chains_[a.chain].closed && gap + 1 == chains_[a.chain].edge_count());
  }

  const std::vector<Chain>& chains_;
  std::vector<SweepEdge> edges_;
  std::vector<Event> events_;
  std::vector<Status::iterator> places_;
  Status status_;
};

/// Up to here looking at every pair of edges is quicker than sweeping.
constexpr std::size_t kFewEdges = 24;

/// Whether the second edge, which begins where the first ends, folds back onto it. Two that only share their vertex
/// meet nowhere else.
bool folds_back(const Segment& s, const Segment& t) {
  if (orientation(s.a, s.b, t.b) != Sign::zero) return false;
  return lexicographically_less(s.a, s.b) != lexicographically_less(s.b, t.b);
}

/// True: a small closed chain has no contact. False says nothing: the sweep then finds out, and where.
bool keeps_apart(const Chain& chain) {
  const std::size_t n = chain.edge_count();
  if (!chain.closed || n < 3 || n > kFewEdges) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Segment edge = chain.edge(i);
    if (folds_back(edge, chain.edge((i + 1) % n))) return false;
    const std::size_t end = i == 0 ? n - 1 : n;  // the last edge is the first one's neighbour
    for (std::size_t j = i + 2; j < end; ++j)
      if (intersect(edge, chain.edge(j))) return false;
  }
  return true;
}

}  // namespace

std::optional<Contact> find_contact(const std::vector<Chain>& chains) {
  if (chains.size() == 1 && keeps_apart(chains.front())) return std::nullopt;
  return Sweep(chains).run();
}

std::size_t least_vertex(const std::vector<Vec2>& points) {
  return static_cast<std::size_t>(std::min_element(points.begin(), points.end(), lexicographically_less) -
                                  points.begin());
}

double largest_coordinate(const std::vector<Vec2>& points) {
  double largest = 0.0;
  for (const Vec2 p : points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

// distance(s, x) measures to a computed foot point. That is within 10 u M of the segment: u sqrt(2) M for rounding the
// sum, 3 u |b - a| <= 6 sqrt(2) u M for the product and the difference; 16 leaves room for the second order. The
// difference and the hypot add a relative 4 u; 8 is used.
double distance_upper_bound(const Segment& s, Vec2 x, double largest) {
  return distance(s, x) * (1.0 + 8.0 * kUnitRoundoff) + 16.0 * kUnitRoundoff * largest;
}

bool lies_on(const Segment& s, Vec2 x) {
  return std::min(s.a.x, s.b.x) <= x.x && x.x <= std::max(s.a.x, s.b.x) && std::min(s.a.y, s.b.y) <= x.y &&
         x.y <= std::max(s.a.y, s.b.y) && orientation(s.a, s.b, x) == Sign::zero;
}

Vec2 common_point(const Segment& s, const Segment& t) {
  for (const Vec2 end : {s.a, s.b}) {
    if (lies_on(t, end)) return end;
  }
  for (const Vec2 end : {t.a, t.b}) {
    if (lies_on(s, end)) return end;
  }
  const Vec2 d = s.b - s.a;
  const Vec2 e = t.b - t.a;
  return s.a + (cross(t.a - s.a, e) / cross(d, e)) * d;
}

namespace {

// The lexicographic order splits directions in two open halves and no edge is without one; on a straight run the next
// edge goes on in the same half, on a spike it comes back in the other.
bool turns_right_or_back(Vec2 before, Vec2 at, Vec2 after) {
  const Sign turn = orientation(before, at, after);
  const bool goes_on = lexicographically_less(before, at) == lexicographically_less(at, after);
  return turn == Sign::negative || (turn == Sign::zero && !goes_on);
}

// A ring that only turns left and goes k times round changes k times from rightward to leftward and k times back.
std::size_t changes_of_half(const std::vector<Vec2>& ring) {
  const std::size_t n = ring.size();
  std::size_t changes = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = ring[i], b = ring[(i + 1) % n], c = ring[(i + 2) % n];
    changes += lexicographically_less(a, b) != lexicographically_less(b, c) ? 1 : 0;
  }
  return changes;
}

}  // namespace

bool is_convex_ccw(const std::vector<Vec2>& ring) {
  const std::size_t n = ring.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 at = ring[(i + 1) % n];
    if (ring[i] == at || turns_right_or_back(ring[i], at, ring[(i + 2) % n])) return false;
  }
  return changes_of_half(ring) == 2;
}

bool on_one_line(const std::vector<Vec2>& points) {
  const auto other = std::find_if(points.begin(), points.end(), [&](Vec2 p) { return p != points.front(); });
  return other == points.end() ||
         std::all_of(other, points.end(), [&](Vec2 p) { return orientation(points.front(), *other, p) == Sign::zero; });
}

}  // namespace exactvo::geometry::detail
