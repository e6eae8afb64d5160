// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/run_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "exactvo/geometry/counted.h"
#include "support/escape.h"
#include "support/run.h"

namespace exactvo::tools {

namespace {

/// Lines of a kind; metrics.json has all.
constexpr std::size_t kMostLines = 10;
/// Of so many robots each has its line.
constexpr std::size_t kMostRobots = 50;

std::string or_dash(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.4g} {}", *value, unit) : "-";
}

/// A robot of a formation has no goal to arrive at.
std::string robot_line(const formation::RobotMetrics& robot, bool has_goal) {
  std::string arrival = robot.arrived ? "arrived at " + or_dash(robot.arrival_time, "s") + ", " : "did not arrive, ";
  if (!has_goal) arrival.clear();
  const std::string detour = robot.detour ? fmt::format(" ({:.3g} m more than {})", *robot.detour,
                                                        has_goal ? "straight to its goals" : "its slot's")
                                          : "";
  const std::string slot =
      robot.largest_slot_error ? fmt::format(", up to {:.3g} m from its slot", *robot.largest_slot_error) : "";
  return fmt::format("  {:<12} {}path length {:.4g} m{}{}, minimum clearance to obstacles {}{}\n", shown(robot.id),
                     arrival, robot.path_length, detour, slot, or_dash(robot.min_obstacle_clearance, "m"),
                     formation::touched(robot.min_obstacle_clearance) ? ": overlapped an obstacle" : "");
}

/// The first of them; metrics.json has all.
std::string collision_lines(const std::vector<formation::Collision>& all) {
  std::string text;
  for (std::size_t k = 0; k < std::min(all.size(), kMostLines); ++k) {
    const formation::Collision& c = all[k];
    text += fmt::format("  collision    {} with {} '{}' from {:.4g} s to {:.4g} s, {:.3g} m deep at {:.4g} s\n",
                        shown(c.robot), name(c.kind), shown(c.with), c.from, c.until, c.depth, c.deepest_at);
  }
  if (all.size() > kMostLines)
    text += fmt::format("  collision    and {} more: see metrics.json\n", all.size() - kMostLines);
  return text;
}

std::string formation_lines(const formation::Metrics& m) {
  const formation::FormationCourse& course = *m.formation_course;
  const std::string largest = course.largest_error > 0.0
                                  ? fmt::format("largest error {:.3g} m, of {} at {:.4g} s", course.largest_error,
                                                shown(course.largest_error_of), course.largest_error_at)
                                  : std::string("no error at any time");
  return fmt::format(
      "  formation    position error {}, velocity error {} at the end; leader at the end of its path: {}\n"
      "  formation    {}; first formed at {}, holds since {}\n"
      "  formation    formed for {:.3g} % of the time, root mean square of slot errors {:.3g} m\n",
      or_dash(m.formation_position_error, "m"), or_dash(m.formation_velocity_error, "m/s"),
      or_dash(m.leader_arrival_time, "s"), largest, or_dash(course.first_formed, "s"),
      or_dash(course.formed_since, "s"), 100.0 * course.share_formed, course.rms_error);
}

std::string course_words(const formation::LyapunovCourse& c) {
  const std::string rise =
      c.largest_rise > 0.0 ? fmt::format("rises by up to {:.3g} per step", c.largest_rise) : std::string("never rises");
  return fmt::format("{:.4g} -> {:.4g}, minimum {:.4g}, {}", c.first, c.last, c.least, rise);
}

std::string lyapunov_lines(const formation::LyapunovSummary& s) {
  return fmt::format("  V of (18)    {}\n  valid V      {}\n", course_words(s.paper), course_words(s.sound));
}

/// Where it was not kept.
std::string margin_line(const formation::Metrics& m) {
  if (!m.robot_margin || m.robot_margin->pair_rows == 0) return "";
  const formation::RobotMarginCourse& margin = *m.robot_margin;
  return fmt::format("  margin       {} of robots nearer to each other than margins.robot, {:.4g} m ({})\n",
                     geometry::counted(margin.pair_rows, "pair-row"), margin.asked,
                     geometry::counted(margin.robots, "robot"));
}

/// Of many robots there are lines for those alone that stopped elsewhere.
std::string robot_lines(const formation::Scenario& scenario, const formation::Metrics& m) {
  std::string text;
  if (m.robots.size() > kMostRobots) return text;
  for (const formation::RobotMetrics& robot : m.robots) text += robot_line(robot, !scenario.formation);
  return text;
}

std::string stuck_lines(const std::vector<std::string>& all) {
  std::string text;
  for (std::size_t k = 0; k < std::min(all.size(), kMostLines); ++k)
    text += fmt::format("  stuck        {}\n", shown(all[k]));
  if (all.size() > kMostLines)
    text += fmt::format("  stuck        and {} more: see metrics.json\n", all.size() - kMostLines);
  return text;
}

std::string arrival_line(const formation::Metrics& m) {
  if (m.robots.size() < 2) return "";
  return fmt::format("  arrival      {} of {}, median {}, last {}\n", m.arrived,
                     geometry::counted(m.robots.size(), "robot"), or_dash(m.median_arrival_time, "s"),
                     or_dash(m.last_arrival_time, "s"));
}

/// m, on average.
double mean_path(const formation::Metrics& m) {
  double sum = 0.0;
  for (const formation::RobotMetrics& robot : m.robots) sum += robot.path_length;
  return m.robots.empty() ? 0.0 : sum / static_cast<double>(m.robots.size());
}

/// What was counted of decisions, and what of them is recorded.
std::string decision_lines(const datasets::RunInfo& info, const formation::Metrics& m) {
  const std::size_t count = m.robots.size() * m.steps;
  std::string text = fmt::format("  decisions    {}, {} relaxed", count, m.relaxed_steps);
  if (!m.crowd)
    return text + fmt::format(", {} half-planes not certified; recorded: {}\n", m.uncertified_half_planes,
                              info.decisions == "all" ? "all half-planes" : "half-planes that bind");
  const formation::CrowdMetrics& c = *m.crowd;
  const auto share = [&](std::size_t part) {
    return count > 0 ? static_cast<double>(part) / static_cast<double>(count) : 0.0;
  };
  return text + fmt::format(
                    ", {} cut short before another robot, {} with a reserved place, {} stopped before an edge, "
                    "{} overlapping; none recorded\n"
                    "  half-planes  in a decision {:.3g} against robots, {:.3g} against edges, {:.3g} against bodies "
                    "(discs at rest and moving obstacles)\n",
                    c.cut_short, c.reserved, c.stopped, c.overlapping, share(c.against_robots), share(c.against_edges),
                    share(c.against_bodies));
}

std::string motion_lines(const formation::Metrics& m) {
  std::string text = fmt::format("  path length  {:.4g} m on average\n", mean_path(m));
  text += fmt::format("  jitter       {:.4g} m/s^2, {}", m.jitter,
                      geometry::counted(m.heading_reversals, "heading reversal"));
  if (!m.crowd) text += ", " + geometry::counted(m.active_set_switches, "active-set switch", "active-set switches");
  return text + fmt::format("\n  velocity     total variation {:.4g} m/s, peak acceleration {:.4g} m/s^2\n",
                            m.velocity_variation, m.peak_acceleration);
}

}  // namespace

std::string run_summary(const datasets::RunInfo& info, const formation::Scenario& scenario,
                        const formation::Metrics& m) {
  std::string text = shown(in_words(info)) + ": " + shown(m.outcome) + "\n" + collision_lines(m.collisions);
  text += robot_lines(scenario, m);
  if (scenario.formation) text += formation_lines(m) + lyapunov_lines(*m.lyapunov);
  text += stuck_lines(m.stuck) + arrival_line(m);
  const double robot_steps = static_cast<double>(m.robots.size() * m.steps);
  text += fmt::format("  clearance    to obstacles {}, between robots {}\n{}", or_dash(m.min_obstacle_clearance, "m"),
                      or_dash(m.min_robot_clearance, "m"), margin_line(m));
  text += motion_lines(m) + decision_lines(info, m);
  for (const std::string& words : m.not_measured) text += "  not measured " + words + "\n";
  return text + fmt::format("  steps        {} in {:.3g} s of wall time, {:.3g} robot steps a second\n", m.steps,
                            m.wall_time, m.wall_time > 0.0 ? robot_steps / m.wall_time : 0.0);
}

}  // namespace exactvo::tools
