// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/routes_of_run.h"

namespace exactvo::tools {

std::optional<formation::SimulationOptions> guided_options(const datasets::RunInfo& info) {
  formation::SimulationOptions options;
  const bool is_guided =
      info.guidance && parse(info.method, options.method) && parse(*info.guidance, options.guidance.emplace());
  return is_guided ? std::optional(options) : std::nullopt;
}

std::optional<std::vector<formation::PlannedRoute>> routes_of(const datasets::RecordingFile& run,
                                                              std::size_t most_robots, std::size_t most_vertices) {
  std::size_t vertices = 0;
  for (const formation::SceneObstacle& o : run.scenario.obstacles) vertices += geometry::vertices_of(o.shape).size();
  const std::optional<formation::SimulationOptions> options = guided_options(run.info);
  if (!options || run.scenario.robots.size() > most_robots || vertices > most_vertices) return std::nullopt;
  return formation::planned_routes(run.scenario, *options);
}

}  // namespace exactvo::tools
