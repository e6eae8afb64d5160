// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/validity.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/require.h"
#include "rings/convexity.h"
#include "rings/hole_placement.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry {
namespace {

using detail::Chain;
using detail::Contact;
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

std::size_t count_distinct(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), detail::lexicographically_less);
  return static_cast<std::size_t>(std::distance(points.begin(), std::unique(points.begin(), points.end())));
}

// The reason why a ring encloses nothing, if so.
std::optional<RingProblemCode> degeneracy(const Ring& ring) {
  if (count_distinct(ring) < 3) return RingProblemCode::too_few_points;
  if (detail::on_one_line(ring)) return RingProblemCode::zero_area;
  return std::nullopt;
}

// Whether the ring by itself bounds an area; otherwise the problem is reported.
bool bounds_an_area(const CleanRing& clean, std::size_t ring, Problems& problems) {
  if (const auto code = degeneracy(clean.points)) {
    const Vec2 where = clean.points.empty() ? Vec2{} : clean.points.front();
    problems.push_back({*code, ring, 0, where, false});
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
