// SPDX-License-Identifier: GPL-3.0-or-later
#include "rings/hole_placement.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "exactvo/geometry/distance.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

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
  switch (orientation(p.at, p.after, p.before)) {
    case Sign::positive:
      return left_of_after && right_of_before;
    case Sign::zero:
      return left_of_after;
    case Sign::negative:
      break;
  }
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

// Of two edges that are known to meet: whether their rings cross or overlap there, rather than touch in a point.
bool is_crossing(const Ring& a, std::size_t edge_a, const Ring& b, std::size_t edge_b) {
  const Segment s = {a[edge_a], a[(edge_a + 1) % a.size()]};
  const Segment t = {b[edge_b], b[(edge_b + 1) % b.size()]};
  if (overlap_along_a_line(s, t) || cross_properly(s, t)) return true;
  const Vec2 at = common_point(s, t);
  const Passage through_a = passage_through(a, edge_a, at);
  const Passage through_b = passage_through(b, edge_b, at);
  return points_left(through_a, through_b.before) != points_left(through_a, through_b.after);
}

struct Box {
  double x_low = std::numeric_limits<double>::infinity();
  double x_high = -std::numeric_limits<double>::infinity();
  double y_low = std::numeric_limits<double>::infinity();
  double y_high = -std::numeric_limits<double>::infinity();

  bool contains(const Box& other) const {
    return x_low <= other.x_low && other.x_high <= x_high && y_low <= other.y_low && other.y_high <= y_high;
  }
};

Box box_of(const Ring& ring) {
  Box box;
  for (const Vec2 p : ring) {
    box.x_low = std::min(box.x_low, p.x);
    box.x_high = std::max(box.x_high, p.x);
    box.y_low = std::min(box.y_low, p.y);
    box.y_high = std::max(box.y_high, p.y);
  }
  return box;
}

// The number of the edge of `ring` on which x lies.
std::size_t edge_under(const Ring& ring, Vec2 x) {
  std::size_t i = 0;
  while (!lies_on({ring[i], ring[(i + 1) % ring.size()]}, x)) ++i;
  return i;
}

// Whether `inner` lies in the area bounded by `around`, of two rings that do not cross: any vertex off the other ring
// tells; if all lie on it, the way on from the first one does.
bool lies_within(const Ring& inner, const Ring& around, bool around_is_clockwise) {
  const Polygon area = {around, {}};
  for (const Vec2 p : inner) {
    const Place place = locate(area, p);
    if (place != Place::boundary) return place == Place::inside;
  }
  const Passage passage = passage_through(around, edge_under(around, inner[0]), inner[0]);
  return points_left(passage, inner[1]) != around_is_clockwise;
}

class Placement {
 public:
  explicit Placement(const std::vector<const Ring*>& rings) : rings_(rings), found_(rings.size()) {
    for (const Ring* ring : rings) boxes_.push_back(box_of(*ring));
  }

  std::vector<Misplacement> run() {
    report_crossings();
    for (std::size_t i = 1; i < rings_.size(); ++i) report_wrong_side(i);
    std::vector<Misplacement> out;
    for (const auto& m : found_) {
      if (m) out.push_back(*m);
    }
    return out;
  }

 private:
  void report(std::size_t ring, std::size_t vertex, Vec2 where) {
    if (!found_[ring]) found_[ring] = Misplacement{ring, vertex, where};
  }

  // The sweep answers the common case (no two rings touch) alone.
  void report_crossings() {
    std::vector<Chain> chains;
    for (const Ring* ring : rings_) chains.push_back({ring});
    if (!find_contact(chains)) return;
    for (const Contact& c : all_contacts_between(chains)) {
      const Ring& a = *rings_[c.first.chain];
      const Ring& b = *rings_[c.second.chain];
      if (is_crossing(a, c.first.edge, b, c.second.edge)) report(c.second.chain, c.second.edge, c.where);
    }
  }

  void report_wrong_side(std::size_t i) {
    const Ring& hole = *rings_[i];
    if (!boxes_[0].contains(boxes_[i]) || !lies_within(hole, *rings_[0], false)) report(i, 0, hole[0]);
    for (std::size_t j = 1; j < rings_.size() && !found_[i]; ++j) {
      if (j != i && boxes_[j].contains(boxes_[i]) && lies_within(hole, *rings_[j], true)) report(i, 0, hole[0]);
    }
  }

  const std::vector<const Ring*>& rings_;
  std::vector<Box> boxes_;
  std::vector<std::optional<Misplacement>> found_;
};

}  // namespace

std::vector<Misplacement> misplaced_holes(const std::vector<const Ring*>& rings) {
  return Placement(rings).run();
}

}  // namespace exactvo::geometry::detail
