// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/timetable.h"

#include <algorithm>
#include <numeric>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/infinity.h"

namespace exactvo::formation::detail {
namespace {

constexpr EdgeNumber kNotAsked = std::numeric_limits<EdgeNumber>::max();

}  // namespace

RoadmapEdges::RoadmapEdges(const Roadmap& map, double most_radii)
    : map_(map), reach_((1.0 + kPlannedGap) * most_radii), from_(map.size()), cells_(2.0 * reach_) {}

EdgeNumber RoadmapEdges::number(PlaceNumber from, PlaceNumber to) {
  const auto [entry, is_new] =
      numbers_.try_emplace((static_cast<std::uint64_t>(from) << 32) | to, static_cast<EdgeNumber>(edges_.size()));
  if (is_new) {
    edges_.push_back({map_.place(from), map_.place(to)});
    lengths_.push_back(norm(edges_.back().b - edges_.back().a));
    near_places_.emplace_back();
    near_edges_.emplace_back();
    has_near_edges_.push_back(0);
    add_near_places(entry->second);
  }
  return entry->second;
}

EdgeNumber RoadmapEdges::kth_from(PlaceNumber from, std::size_t k) {
  std::vector<EdgeNumber>& known = from_[from];
  if (known.empty()) known.assign(map_.ways(from).size(), kNotAsked);
  if (known[k] == kNotAsked) known[k] = number(from, map_.ways(from)[k]);
  return known[k];
}

void RoadmapEdges::add_near_places(EdgeNumber w) {
  const Segment s = edges_[w];
  const double radii = reach_ / (1.0 + kPlannedGap);
  map_.for_each_near(0.5 * (s.a + s.b), reach_ + 0.5 * length(w), [&](PlaceNumber p) {
    const double squared = squared_distance(map_.place(p), s.a, s.b);
    // A disc may get away from a place however near to it it was.
    if (squared < squared_keep(radii, squared_norm(map_.place(p) - s.a)))
      near_places_[w].push_back({p, static_cast<float>(squared)});
  });
  // Where the edge ends comes first: mostly that is what is taken.
  std::stable_sort(near_places_[w].begin(), near_places_[w].end(),
                   [](const NearPlace& a, const NearPlace& b) { return a.squared < b.squared; });
}

const std::vector<RoadmapEdges::NearEdge>& RoadmapEdges::near_edges(EdgeNumber w) {
  if (!has_near_edges_[w]) add_near_edges(w);
  return near_edges_[w];
}

void RoadmapEdges::add_near_edges(EdgeNumber w) {
  has_near_edges_[w] = 1;
  const geometry::Box box = geometry::box_of(edges_[w]);
  cells_.add(box, w);
  std::vector<EdgeNumber> about;
  cells_.for_each_in(box.grown(reach_), [&](EdgeNumber v) { about.push_back(v); });
  std::sort(about.begin(), about.end());
  about.erase(std::unique(about.begin(), about.end()), about.end());
  for (const EdgeNumber v : about) {
    const double squared = squared_distance(edges_[v], edges_[w]);
    if (!(squared < kSingleRounding * reach_ * reach_)) continue;
    near_edges_[w].push_back({v, static_cast<float>(squared), static_cast<float>(lead(v, w))});
    if (v != w) near_edges_[v].push_back({w, static_cast<float>(squared), static_cast<float>(lead(w, v))});
  }
}

/// m: in quarters of the first edge. With it the second keeps clear of what the first has still to sweep, at the same
/// speed.
double RoadmapEdges::lead(EdgeNumber first, EdgeNumber second) const {
  constexpr int kParts = 4;
  const Segment f = edges_[first], s = edges_[second];
  const double whole = length(first), other = length(second);
  const auto is_clear = [&](double ahead, double gone) {
    const double share = std::min(1.0, (ahead + gone) / whole);
    return squared_distance(s.a + gone / other * (s.b - s.a), f.a + share * (f.b - f.a), f.b) >= reach_ * reach_;
  };
  for (int quarters = 0; quarters < kParts; ++quarters) {
    const double ahead = quarters * whole / kParts;
    bool all = true;
    for (int k = 0; k <= kParts && all; ++k) all = is_clear(ahead, k * other / kParts);
    if (all) return ahead;
  }
  return whole;
}

namespace {

/// Moves near to each other keep their order: the later never starts before the earlier.
void sort_by_start(Timetable& table) {
  std::vector<std::size_t> order(table.moves.size()), rank(table.moves.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return table.moves[a].start < table.moves[b].start; });
  std::vector<TimedMove> sorted;
  sorted.reserve(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    rank[order[k]] = k;
    sorted.push_back(table.moves[order[k]]);
  }
  for (TimedMove& m : sorted)
    if (m.waits_for != kNoMove) m.waits_for = rank[m.waits_for];
  if (table.last_move != kNoMove) table.last_move = rank[table.last_move];
  table.moves = std::move(sorted);
}

}  // namespace

std::size_t position_at(const Timetable& table, double time) {
  const auto starts_before = [&](const TimedMove& m) { return m.start < time; };
  const auto found = std::partition_point(table.moves.begin(), table.moves.end(), starts_before);
  return static_cast<std::size_t>(found - table.moves.begin());
}

Timetable timetable_of(const std::vector<JointMove>& moves, const std::vector<double>& radii, RoadmapEdges& edges) {
  Timetable table;
  table.moves.reserve(moves.size());
  std::vector<double> end(radii.size(), 0.0);
  std::vector<std::size_t> own(radii.size(), kNoMove);
  std::vector<double> latest_start;                  // by edge
  std::vector<std::size_t> latest_on, before_it_on;  // by edge, and by move: the one before it on its edge
  for (const JointMove& m : moves) {
    TimedMove timed{m, edges.number(m.from, m.to), end[m.robot], own[m.robot]};
    const auto is_near = [&](float squared, const TimedMove& other) {
      const double wanted = (1.0 + kPlannedGap) * (radii[m.robot] + radii[other.move.robot]);
      return other.move.robot != m.robot && squared < kSingleRounding * wanted * wanted;
    };
    const std::vector<RoadmapEdges::NearEdge>& near = edges.near_edges(timed.edge);
    latest_on.resize(edges.size(), kNoMove);
    latest_start.resize(edges.size(), -geometry::kInfinity);
    for (const RoadmapEdges::NearEdge& n : near) {
      // The latest move on the edge of a robot that is large enough to be near: those before it started no later.
      if (!(latest_start[n.edge] + n.lead > timed.start)) continue;
      std::size_t earlier = latest_on[n.edge];
      while (earlier != kNoMove && !is_near(n.squared, table.moves[earlier])) earlier = before_it_on[earlier];
      if (earlier == kNoMove || !(table.moves[earlier].start + n.lead > timed.start)) continue;
      timed.start = table.moves[earlier].start + n.lead;
      timed.waits_for = earlier;
    }
    before_it_on.push_back(latest_on[timed.edge]);
    latest_on[timed.edge] = own[m.robot] = table.moves.size();
    latest_start[timed.edge] = timed.start;
    end[m.robot] = timed.start + edges.length(timed.edge);
    table.moves.push_back(timed);
  }
  for (std::size_t i = 0; i < end.size(); ++i) {
    table.mean += end[i] / static_cast<double>(end.size());
    if (!(end[i] > table.last)) continue;
    table.last = end[i];
    table.last_move = own[i];
  }
  sort_by_start(table);
  return table;
}

}  // namespace exactvo::formation::detail
