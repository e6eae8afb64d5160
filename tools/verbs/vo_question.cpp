// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo_question.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/vo/free_velocities.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using geometry::ConvexPolygon;
using geometry::ConvexShape;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Of coordinates and velocities: their squares and those of their sums stay far within doubles.
constexpr double kLargestNumber = vo::kMostApex;

bool is_in_range(Vec2 v) {
  return std::fabs(v.x) <= kLargestNumber && std::fabs(v.y) <= kLargestNumber;
}

Vec2 parse_point(const std::string& option, const std::string& text) {
  Vec2 v;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf%c", &v.x, &v.y, &rest) != 2 || !is_in_range(v))
    throw UsageError(option, text, fmt::format("two numbers within {:g}, X,Y", kLargestNumber));
  return v;
}

/// The points of every obstacle in the text: WKT, or the name of a file.
std::vector<std::vector<Vec2>> obstacles_in(const std::string& option, const std::string& text) {
  const datasets::ObstacleFile file =
      fs::exists(text) ? datasets::read_obstacles(text) : datasets::parse_wkt(text, option, {});
  std::vector<std::vector<Vec2>> points;
  for (const auto& obstacle : file.obstacles) {
    points.push_back(vertices_of(obstacle.shape));
    for (const Vec2 v : points.back())
      if (!is_in_range(v))
        throw UsageError(option, fmt::format("{:g} {:g}", v.x, v.y), fmt::format("within {:g}", kLargestNumber));
  }
  return points;
}

ConvexShape hull_of(const std::vector<Vec2>& points) {
  ConvexPolygon hull = geometry::convex_hull(points);
  if (hull.vertices.size() > 2) return hull;
  return geometry::Segment{hull.vertices.front(), hull.vertices.back()};
}

ConvexShape trap_free(const std::vector<Vec2>& points, const VoFlags& flags) {
  if (flags.goal.empty()) throw UsageError("--enclose", "trap-free without --goal", "a goal, X,Y");
  const auto fitted = geometry::fit_trap_free(points, flags.radius, parse_point("--position", flags.position),
                                              parse_point("--goal", flags.goal));
  if (!fitted) throw UsageError("--enclose", "trap-free", "a robot and a goal farther from the obstacle");
  return fitted->ellipse;
}

/// A velocity obstacle is built of a convex shape: the hull of the obstacle, or an ellipse round it.
ConvexShape convex_shape(const std::vector<Vec2>& points, const VoFlags& flags) {
  if (flags.enclose == "none") return hull_of(points);
  if (flags.enclose == "ellipse") return geometry::smallest_ellipse(points);
  if (flags.enclose == "trap-free") return trap_free(points, flags);
  throw UsageError("--enclose", flags.enclose, "one of none ellipse trap-free");
}

ConvexPolygon robot_of(const std::string& text) {
  const auto rings = obstacles_in("--robot", text);
  if (rings.size() != 1) throw UsageError("--robot", fmt::format("{} geometries", rings.size()), "one polygon");
  return geometry::convex_hull(rings[0]);
}

/// The paper's rule gives no horizon to a robot whose distance rounds to nothing.
double paper_horizon(const vo::VelocityObstacle& cone, Vec2 relative) {
  const double seconds = vo::paper_time_horizon(cone, relative);
  if (!(seconds > 0.0))
    throw UsageError("--time-horizon", "paper, which is 0 s so near the obstacle", "a time above 0 s, or clamped");
  return seconds;
}

/// A number of seconds, or a rule.
double horizon_of(const std::string& text, const vo::Encounter& encounter) {
  if (text == "infinite") return kInfinity;
  if (text == "paper" || text == "clamped") {
    vo::Encounter any = encounter;
    any.time_horizon = 1.0;
    const vo::VelocityObstacle cone = cone_of(any);
    const Vec2 relative = encounter.velocity - encounter.obstacle_velocity;
    if (cone.overlaps()) return 1.0;  // no cone, so no horizon
    return text == "paper" ? paper_horizon(cone, relative) : vo::clamped_time_horizon(cone, relative);
  }
  double seconds = 0.0;
  char rest = 0;
  const bool is_number = std::sscanf(text.c_str(), "%lf%c", &seconds, &rest) == 1;
  if (!is_number || !(seconds > 0.0) || !std::isfinite(seconds))
    throw UsageError("--time-horizon", text, "a time above 0 s, or infinite, paper or clamped");
  return seconds;
}

std::vector<vo::Variant> variants_of(const std::vector<std::string>& names) {
  std::vector<vo::Variant> variants;
  for (const std::string& word : names) {
    std::string upper = word;
    std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
    const auto* found = std::find_if(std::begin(vo::kVariants), std::end(vo::kVariants),
                                     [&](vo::Variant v) { return upper == name(v); });
    if (upper == "ALL") {
      variants.assign(std::begin(vo::kVariants), std::end(vo::kVariants));
    } else if (found != std::end(vo::kVariants)) {
      variants.push_back(*found);
    } else {
      throw UsageError("--variant", word, "one of vo rvo hrvo orca ivo all");
    }
  }
  return variants;
}

void check_numbers(const VoFlags& flags) {
  const auto require = [](bool ok, const char* option, double found, const char* expected) {
    if (!ok) throw UsageError(option, fmt::format("{}", found), expected);
  };
  require(flags.radius >= 0.0 && flags.radius <= kLargestNumber, "--radius", flags.radius,
          "a length from 0 m to 2^100 m");
  require(flags.alpha > 0.0 && flags.alpha <= 1.0, "--alpha", flags.alpha, "a number in (0, 1]");
  if (flags.free)
    require(flags.max_speed >= vo::kLeastMaxSpeed && flags.max_speed <= vo::kMostMaxSpeed, "--max-speed",
            flags.max_speed, "a speed from 2^-60 to 2^60 m/s, with --free");
  if (!flags.figure.empty() && fs::path(flags.figure).extension() != ".svg")
    throw UsageError("--figure", flags.figure, "a name that ends in .svg");
}

/// What all obstacles share.
vo::Encounter robot_alone(const VoFlags& flags) {
  vo::Encounter e;
  e.position = parse_point("--position", flags.position);
  e.velocity = parse_point("--velocity", flags.velocity);
  e.radius = flags.radius;
  if (!flags.robot.empty()) e.robot = robot_of(flags.robot);
  return e;
}

}  // namespace

VoQuestion question_of(const VoFlags& flags) {
  check_numbers(flags);
  VoQuestion q;
  q.variants = variants_of(flags.variants);
  q.alpha = flags.alpha;
  q.free = flags.free;
  q.max_speed = flags.max_speed;
  const vo::Encounter alone = robot_alone(flags);
  q.velocity = alone.velocity;
  for (std::size_t i = 0; i < flags.obstacles.size(); ++i) {
    for (const std::vector<Vec2>& points : obstacles_in("--obstacle", flags.obstacles[i])) {
      vo::Encounter e = alone;
      e.obstacle = convex_shape(points, flags);
      if (i < flags.obstacle_velocities.size())
        e.obstacle_velocity = parse_point("--obstacle-velocity", flags.obstacle_velocities[i]);
      e.time_horizon = horizon_of(flags.time_horizon, e);
      e.share = flags.alpha;
      q.encounters.push_back(std::move(e));
    }
  }
  if (q.encounters.empty() || (q.encounters.size() > 1 && !q.free))
    throw UsageError("--obstacle", fmt::format("{} obstacles", q.encounters.size()),
                     q.free ? "an obstacle" : "one obstacle (several go with --free)");
  if (flags.obstacle_velocities.size() > flags.obstacles.size())
    throw UsageError("--obstacle-velocity", fmt::format("{} velocities", flags.obstacle_velocities.size()),
                     "at most one an --obstacle");
  return q;
}

void declare_options(CLI::App& app, VoFlags& flags) {
  app.add_option("--obstacle", flags.obstacles,
                 "WKT, or a file with one obstacle; its convex hull is taken. Several with --free")
      ->required()
      ->allow_extra_args(false);
  app.add_option("--obstacle-velocity", flags.obstacle_velocities,
                 "X,Y in m/s, one an --obstacle; at rest where missing")
      ->allow_extra_args(false);
  app.add_option("--enclose", flags.enclose, "none, ellipse (the smallest) or trap-free (needs --goal)");
  app.add_option("--position", flags.position, "Of the robot, X,Y in m")->required();
  app.add_option("--velocity", flags.velocity, "X,Y in m/s")->required();
  app.add_option("--radius", flags.radius, "Of the robot, m; without meaning where --robot is given");
  app.add_option("--robot", flags.robot, "A robot that is a convex polygon: WKT round 0,0, its reference point");
  app.add_option("--time-horizon", flags.time_horizon,
                 "s; or infinite, paper (distance over speed) or clamped (the same within 0.3 s and 3 s)")
      ->required();
  app.add_option("--alpha", flags.alpha, "The share of the change that the robot takes; 1 is certified");
  app.add_option("--goal", flags.goal, "X,Y in m, for --enclose trap-free");
  app.add_option("--variant", flags.variants, "vo, rvo, hrvo, orca, ivo or all: the family, side by side in the figure")
      ->allow_extra_args(false);
  app.add_flag("--free", flags.free, "The free velocities of all obstacles, with what the half-planes give away");
  app.add_option("--max-speed", flags.max_speed, "m/s, for --free");
  app.add_flag("--json", flags.json, "Everything as JSON on stdout");
  app.add_option("--figure", flags.figure, "FILE.svg; FILE.png, FILE.dat and FILE.gp (gnuplot) appear beside it");
}

}  // namespace exactvo::tools
