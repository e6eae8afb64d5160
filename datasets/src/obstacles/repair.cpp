// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/repair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/even_odd.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/too_many_contacts.h"
#include "obstacles/courses.h"

namespace exactvo::datasets {
namespace {

using geometry::EvenOddStatus;
using geometry::NormalizedPolygon;
using geometry::Polygon;
using geometry::Ring;
using geometry::RingProblem;
using geometry::RingProblemCode;

/// Twice the signed area, about the first vertex so that places far from the origin cost nothing.
double doubled_area(const Ring& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) sum += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return sum;
}

double ring_area(const Ring& ring) {
  return 0.5 * std::fabs(doubled_area(ring));
}

/// All but `area`.
void add_polygon(const std::vector<Ring>& rings, RepairFacts& facts) {
  ++facts.polygons;
  facts.rings += rings.size();
  for (std::size_t k = 0; k < rings.size(); ++k) {
    const bool is_closed = rings[k].size() > 1 && rings[k].front() == rings[k].back();
    facts.vertices += rings[k].size() - (is_closed ? 1 : 0);
    (k == 0 ? facts.outer_area : facts.hole_area) += ring_area(rings[k]);
  }
}

bool encloses_nothing(const RingProblem& problem) {
  return problem.code == RingProblemCode::too_few_points || problem.code == RingProblemCode::zero_area;
}

/// The first problem that no rule repairs.
std::optional<DataCode> hopeless(const std::vector<RingProblem>& problems) {
  for (const RingProblem& problem : problems) {
    const bool is_fatal =
        problem.code == RingProblemCode::not_finite || (encloses_nothing(problem) && problem.ring == 0);
    if (is_fatal) return data_code(problem.code);
  }
  return std::nullopt;
}

/// The rings that enclose something, and where each stood.
struct Kept {
  std::vector<Ring> rings;
  std::vector<std::size_t> source;  ///< ascending
};

Kept without_empty_holes(const std::vector<Ring>& rings, const std::vector<RingProblem>& problems) {
  Kept kept;
  std::vector<bool> is_empty(rings.size());
  for (const RingProblem& p : problems) is_empty[p.ring] = is_empty[p.ring] || encloses_nothing(p);
  for (std::size_t k = 0; k < rings.size(); ++k) {
    if (is_empty[k]) continue;
    kept.rings.push_back(rings[k]);
    kept.source.push_back(k);
  }
  return kept;
}

/// Holes that enclose nothing keep `normalize` from looking at the places of the others: what it says once they are
/// gone.
NormalizedPolygon normalized_without(const Kept& kept, std::vector<RingProblem>& problems) {
  NormalizedPolygon normal = geometry::normalize(kept.rings);
  for (RingProblem& problem : normal.problems) problem.ring = kept.source[problem.ring];
  std::vector<RingProblem> all;
  std::copy_if(problems.begin(), problems.end(), std::back_inserter(all), [&](const RingProblem& p) {
    return !std::binary_search(kept.source.begin(), kept.source.end(), p.ring);
  });
  all.insert(all.end(), normal.problems.begin(), normal.problems.end());
  std::stable_sort(all.begin(), all.end(), [](const RingProblem& a, const RingProblem& b) { return a.ring < b.ring; });
  problems = std::move(all);
  return normal;
}

DataCode reason_for(EvenOddStatus status) {
  if (status == EvenOddStatus::too_large) return DataCode::out_of_range;
  if (status == EvenOddStatus::too_many_crossings) return DataCode::size;
  return status == EvenOddStatus::not_roundable ? DataCode::rounding : DataCode::library;
}

bool is_valid(const Polygon& polygon) {
  return geometry::normalize(courses_of(polygon)).problems.empty();
}

void recombine(const std::vector<Ring>& rings, Repair& repair) {
  geometry::EvenOddRegion region = geometry::even_odd_region(rings);
  repair.recombined = true;
  repair.moved = region.moved;
  if (region.status != EvenOddStatus::done) {
    repair.refused = reason_for(region.status);
  } else if (region.polygons.empty()) {
    repair.refused = DataCode::zero_area;
  } else if (!std::all_of(region.polygons.begin(), region.polygons.end(), is_valid)) {
    repair.refused = DataCode::rounding;  // never seen: even_odd_region's own property
  } else {
    repair.polygons = std::move(region.polygons);
  }
}

void repair_rings(const std::vector<Ring>& rings, Repair& repair) {
  NormalizedPolygon normal = geometry::normalize(rings);
  repair.problems = std::move(normal.problems);
  repair.refused = hopeless(repair.problems);
  if (repair.refused) return;
  const Kept kept = without_empty_holes(rings, repair.problems);
  if (kept.rings.size() < rings.size()) normal = normalized_without(kept, repair.problems);
  const auto is_bad = [](const RingProblem& p) { return !p.repaired && !encloses_nothing(p); };
  if (std::any_of(repair.problems.begin(), repair.problems.end(), is_bad)) {
    recombine(kept.rings, repair);
  } else {
    repair.polygons = {std::move(normal.polygon)};
  }
}

}  // namespace

double area(const Polygon& polygon) {
  double sum = ring_area(polygon.outer);
  for (const Ring& hole : polygon.holes) sum -= ring_area(hole);
  return sum;
}

Repair repair(const std::vector<Ring>& rings) {
  EXACTVO_REQUIRE(!rings.empty(), std::string("no ring"));
  Repair result;
  add_polygon(rings, result.before);
  result.before.area = result.before.outer_area - result.before.hole_area;
  try {
    repair_rings(rings, result);
  } catch (const geometry::TooManyContacts&) {
    result.refused = DataCode::size;
  }
  if (!result.ok()) return result;
  for (RingProblem& problem : result.problems) problem.repaired = true;
  for (const Polygon& polygon : result.polygons) {
    add_polygon(courses_of(polygon), result.after);
    result.after.area += area(polygon);
  }
  return result;
}

}  // namespace exactvo::datasets
