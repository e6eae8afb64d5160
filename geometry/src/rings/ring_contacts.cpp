// SPDX-License-Identifier: GPL-3.0-or-later
#include "rings/ring_contacts.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "cgal_guard.h"
#include "exactvo/geometry/distance.h"

namespace exactvo::geometry::detail {
namespace {

using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 2, EdgeId>;

Box box_of(const Segment& s, EdgeId id) {
  double low[2] = {std::min(s.a.x, s.b.x), std::min(s.a.y, s.b.y)};
  double high[2] = {std::max(s.a.x, s.b.x), std::max(s.a.y, s.b.y)};
  return {low, high, id};
}

/// Ends the search: an exception is the only way out of CGAL's.
struct Ended {};

auto key(const Contact& c) {
  return std::make_tuple(c.first.chain, c.first.edge, c.second.chain, c.second.edge);
}

}  // namespace

bool for_each_box_pair(const std::vector<Chain>& chains, std::size_t most,
                       const std::function<bool(EdgeId first, EdgeId second)>& take) {
  std::size_t pairs = 0;
  const auto report = [&](const Box& a, const Box& b) {
    if (++pairs > most) throw Ended{};
    const bool is_ordered = a.info().chain <= b.info().chain;
    const bool goes_on = is_ordered ? take(a.info(), b.info()) : take(b.info(), a.info());
    if (!goes_on) throw Ended{};
  };
  try {
    without_cgal_failures(
        "for_each_box_pair", [&] { return std::to_string(chains.size()) + " chains"; },
        [&] {
          std::vector<Box> boxes;
          for (std::size_t c = 0; c < chains.size(); ++c)
            for (std::size_t i = 0; i < chains[c].edge_count(); ++i) boxes.push_back(box_of(chains[c].edge(i), {c, i}));
          CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), report);
        });
  } catch (const Ended&) {
    return false;
  }
  return true;
}

std::vector<Contact> all_contacts_between(const std::vector<Chain>& chains) {
  std::vector<Contact> contacts;
  for_each_box_pair(chains, std::numeric_limits<std::size_t>::max(), [&](EdgeId first, EdgeId second) {
    const Segment s = chains[first.chain].edge(first.edge);
    const Segment t = chains[second.chain].edge(second.edge);
    if (first.chain != second.chain && intersect(s, t)) contacts.push_back({first, second, common_point(s, t)});
    return true;
  });
  std::sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  return contacts;
}

bool has_more_crossings_than(std::size_t most, const std::vector<Ring>& rings) {
  std::vector<Chain> chains;
  for (const Ring& ring : rings) chains.push_back(Chain{&ring});
  const auto are_neighbours = [&](EdgeId a, EdgeId b) {
    const std::size_t n = rings[a.chain].size();
    return a.chain == b.chain && ((a.edge + 1) % n == b.edge || (b.edge + 1) % n == a.edge);
  };
  std::size_t crossings = 0;
  return !for_each_box_pair(chains, kMostBoxPairs, [&](EdgeId a, EdgeId b) {
    const bool cross = !are_neighbours(a, b) && intersect(chains[a.chain].edge(a.edge), chains[b.chain].edge(b.edge));
    return !cross || ++crossings <= most;
  });
}

}  // namespace exactvo::geometry::detail
