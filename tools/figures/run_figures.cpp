// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/run_figures.h"

#include "figures/lyapunov_figure.h"
#include "figures/paths_figure.h"
#include "figures/series_figures.h"

namespace exactvo::tools {

std::vector<Figure> run_figures(const datasets::RecordingFile& run) {
  std::vector<Figure> figures = {paths_figure(run)};
  if (!run.scenario.obstacles.empty() || !run.scenario.moving_obstacles.empty())
    figures.push_back(obstacle_distance_figure(run));
  if (run.scenario.robots.size() > 1) figures.push_back(robot_distance_figure(run));
  figures.push_back(velocity_figure(run));
  if (run.scenario.formation) figures.push_back(formation_error_figure(run));
  if (!run.lyapunov.empty()) figures.push_back(lyapunov_figure(run));
  return figures;
}

}  // namespace exactvo::tools
