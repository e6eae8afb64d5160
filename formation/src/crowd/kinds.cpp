// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/kinds.h"

#include <algorithm>

#include "crowd/layout.h"
#include "crowd/near_pairs.h"

namespace exactvo::formation::crowd {
namespace {

/// m, how far a search for neighbours goes at least.
constexpr double kNearby = 0.01;

/// In lattice steps a time step: what lines are moved inward by, and how much of that may be used up again.
constexpr double kSlackSteps = 0.75, kSpareSteps = 0.72;

/// Checking a line rounds by at most 11 u V: three roundings a product, the velocity itself, the difference.
constexpr double kCheckUnits = 16.0;

template <class T>
T rounded_down(double value) {
  return -rounded_up<T>(-value);
}

}  // namespace

float without_number(float squared) {
  return float_of(bits_of(squared) & ~kIndexBits);
}

double reach_of_pairs(const CrowdKind& kind, const CrowdOptions& options, double largest, double fastest) {
  const double ways = kLongerWay * (kind.max_speed + fastest) * options.time_step;
  return (kind.radius + largest + ways) * (1.0 + 0x1p-20) / options.position_step + 2.0 * (kWayMargin + 1.0);
}

template <class T>
KindTable<T> kind_table(const CrowdOptions& options, const std::vector<CrowdKind>& kinds) {
  constexpr double u = sizeof(T) == 8 ? 0x1p-53 : 0x1p-24;
  const double dt = options.time_step, q = options.position_step;
  double largest = 0.0, fastest = 0.0;
  for (const CrowdKind& k : kinds) {
    largest = std::max(largest, k.radius);
    fastest = std::max(fastest, k.max_speed);
  }
  KindTable<T> table;
  table.velocity_step = q / dt;
  table.position_step = static_cast<T>(q);
  table.inverse_step = static_cast<T>(1.0 / table.velocity_step);
  table.inverse_time = static_cast<T>(1.0 / dt);
  table.certified = options.certified;
  table.nearby = kNearby / q;
  if (options.certified) {
    table.lattice_slack = static_cast<T>(kSlackSteps * q / dt + 2.0 * kCheckUnits * u * fastest);
    table.spare = kSpareSteps * q / dt + 1.5 * kCheckUnits * u * fastest;
  }
  for (const CrowdKind& k : kinds) {
    table.radius.push_back(rounded_up<T>(k.radius));
    table.inverse_horizon.push_back(static_cast<T>(1.0 / k.time_horizon));
    table.least_offset.push_back(static_cast<T>(-4.0 * k.max_speed));
    const double share = sizeof(T) == 8 ? 0x1p-48 : 0x1p-20;
    table.disc.push_back(rounded_down<T>((k.max_speed - kHalfDiagonal * q / dt) * (1.0 - share)));
    table.allowed.push_back(rounded_down<T>(table.spare - kCheckUnits * u * k.max_speed));
    // A squared distance in float is off by 3 u, 2^-22; cut, it is below that. Twice 2^-20 is put on.
    const double reach = (k.radius + largest + (k.max_speed + fastest) * dt) * (1.0 + 0x1p-20) / q + 1.0;
    table.reach.push_back(rounded_up<float>(reach * reach * (1.0 + 0x1p-20)));
    const double meeting = reach_of_pairs(k, options, largest, fastest) + 1.0;
    // A key's number adds 2^-15 to a squared distance at most.
    table.meeting.push_back(rounded_up<float>(meeting * meeting * (1.0 + 0x1p-14)));
    // Beyond what cutting takes off: 2^-15 of the square.
    const double within = std::min(std::max(k.neighbour_distance / q, reach * (1.0 + 0x1p-10)), 0x1p31);
    table.none.push_back(without_number(static_cast<float>(within * within)));
    table.window.push_back(within);
    table.whole_window.push_back(static_cast<std::int32_t>(std::min(within, 0x1p30)));
    table.neighbours.push_back(k.neighbours);
    table.most_neighbours = std::max(table.most_neighbours, k.neighbours);
  }
  return table;
}

template KindTable<float> kind_table(const CrowdOptions&, const std::vector<CrowdKind>&);
template KindTable<double> kind_table(const CrowdOptions&, const std::vector<CrowdKind>&);

}  // namespace exactvo::formation::crowd
