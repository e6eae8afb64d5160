// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/consensus.h"

#include <algorithm>

namespace exactvo::formation::detail {

std::vector<Vec2> recentred(std::vector<Vec2> offsets) {
  Vec2 mean{};
  for (Vec2 d : offsets) mean += d;
  mean = mean / static_cast<double>(offsets.size());
  for (Vec2& d : offsets) d -= mean;
  return offsets;
}

std::vector<Vec2> offsets_in_use(const FormationSpec& spec, const ControllerOptions& options) {
  return spec.recentre && options.recentred ? recentred(spec.offsets) : spec.offsets;
}

std::vector<Vec2> offsets_in_use(const Scenario& scenario, const SimulationOptions& options) {
  if (!scenario.formation) return {};
  return offsets_in_use(*scenario.formation, controller_options_in_use(scenario, options));
}

Vec2 consensus_input(const FormationSpec& spec, const RelativeState& state, std::size_t i, double position_sign) {
  const Topology& t = spec.topology;
  Vec2 position_term = t.pinning[i] * state.position[i];
  Vec2 velocity_term = t.pinning[i] * state.velocity[i];
  for (std::size_t j = 0; j < state.position.size(); ++j) {
    const double a = t.adjacency[i][j];
    position_term += a * (state.position[i] - state.position[j]);
    velocity_term += a * (state.velocity[i] - state.velocity[j]);
  }
  return (position_sign * spec.gains.k1) * position_term - spec.gains.k2 * velocity_term;
}

Vec2 preference(const FormationSpec& spec, const ControllerOptions& options, Vec2 relative_position,
                Vec2 leader_velocity, double max_speed) {
  const double saturated = std::min(spec.gains.kappa * norm(relative_position), spec.catch_up_speed);
  const double speed = options.saturation ? saturated : max_speed;
  const Vec2 outward = speed * geometry::normalized(relative_position);
  const Vec2 relative = options.signs ? -outward : outward;
  return options.absolute_frame ? leader_velocity + relative : relative;
}

}  // namespace exactvo::formation::detail
