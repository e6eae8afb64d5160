// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/question.h"

#include <fmt/format.h>
#include <system_error>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/algorithm/string/case_conv.hpp>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <string_view>
#include <utility>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/vo/free_velocities.h"
#include "figures/figure.h"
#include "readers/line_reader.h"
#include "support/robot_numbers.h"
#include "support/usage.h"

namespace exactvo::tools {

using geometry::ConvexShape;

namespace {

namespace fs = std::filesystem;

constexpr const char* kShapeWords = "DISC(x y, r), ELLIPSE(cx cy, l11 l21 l22) or ELLIPSE(cx cy, a b, degrees)";

/// Numbers between blanks, as WKT has them; so large at most that their squares and those of their sums stay far within
/// doubles.
std::optional<std::vector<double>> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (;;) {
    while (std::isspace(static_cast<unsigned char>(*at))) ++at;
    if (*at == '\0') return numbers;
    char* end = nullptr;
    numbers.push_back(std::strtod(at, &end));
    const bool whole = *end == '\0' || std::isspace(static_cast<unsigned char>(*end));
    if (end == at || !whole || !(std::fabs(numbers.back()) <= datasets::kLargestCoordinate)) return std::nullopt;
    at = end;
  }
}

/// A word before a bracket, and the groups of numbers between commas within; nothing where the text is no such thing.
struct Call {
  std::string word;
  std::vector<std::vector<double>> groups;

  bool has(std::initializer_list<std::size_t> sizes) const {
    return std::equal(groups.begin(), groups.end(), sizes.begin(), sizes.end(),
                      [](const std::vector<double>& group, std::size_t size) { return group.size() == size; });
  }
};

std::string word_before_bracket(const std::string& text) {
  return boost::to_upper_copy(std::string(datasets::trimmed(std::string_view(text).substr(0, text.find('(')))),
                              std::locale::classic());
}

Call call_in(const std::string& text) {
  Call call{word_before_bracket(text), {}};
  const std::string whole(datasets::trimmed(text));
  if (whole.empty() || whole.back() != ')') return call;
  const auto open = whole.find('(');
  const std::string within = whole.substr(open + 1, whole.size() - open - 2);
  std::vector<std::string> texts;
  for (const std::string& group : boost::split(texts, within, boost::is_any_of(","))) {
    const auto numbers = numbers_in(group);
    if (!numbers) return {call.word, {}};
    call.groups.push_back(*numbers);
  }
  return call;
}

std::optional<ConvexShape> shape_of(const Call& call) {
  const auto& g = call.groups;
  if (call.word == "DISC" && call.has({2, 1}) && g[1][0] >= 0.0) return geometry::Disc{{g[0][0], g[0][1]}, g[1][0]};
  if (call.word != "ELLIPSE") return std::nullopt;
  const Vec2 center = g.empty() || g[0].size() != 2 ? Vec2{} : Vec2{g[0][0], g[0][1]};
  if (call.has({2, 3})) return geometry::Ellipse{center, g[1][0], g[1][1], g[1][2]};
  if (call.has({2, 2, 1}) && g[1][0] >= 0.0 && g[1][1] >= 0.0) {
    const auto [a, b] = std::pair(g[1][0], g[1][1]);
    const double turned = a >= b ? g[2][0] : g[2][0] + 90.0;
    return geometry::ellipse_from_axes(center, {std::max(a, b), std::min(a, b), turned * geometry::kPi / 180.0});
  }
  return std::nullopt;
}

/// What begins WKT; EMPTY and Z, M are the reader's to validate.
bool begins_wkt(const std::string& word) {
  for (const char* known :
       {"POLYGON", "LINESTRING", "POINT", "MULTI", "GEOMETRYCOLLECTION", "TRIANGLE", "LINEARRING", "SRID"})
    if (word.rfind(known, 0) == 0) return true;
  return false;
}

bool ends_in_empty(const std::string& text) {
  const std::string whole = word_before_bracket(text);
  return whole != "EMPTY" && boost::ends_with(whole, "EMPTY");
}

datasets::ObstacleFile read(const std::string& option, const std::string& text, const datasets::ReadOptions& reading) {
  if (is_there(text)) {
    datasets::ObstacleFile file = datasets::read_obstacles(text, reading);
    say_notes(file);
    return file;
  }
  if ((text.find('(') == std::string::npos && !ends_in_empty(text)) || !begins_wkt(word_before_bracket(text)))
    throw UsageError(option, text, std::string("a file that is there, WKT (POLYGON(...), ...), ") + kShapeWords);
  datasets::ObstacleFile file = datasets::parse_wkt(text, option, {});
  say_notes(file);
  return file;
}

using geometry::kInfinity;

constexpr const char* kHorizons = "a time from 2^-100 s to 2^100 s, or infinite, paper or clamped";

// --- The obstacles ---

ConvexShape trap_free(const std::vector<Vec2>& points, const VoFlags& flags) {
  if (flags.goal.empty()) throw lacking("--enclose trap-free", "--goal X,Y", "the ellipse is fitted for a goal");
  const auto fitted = geometry::fit_trap_free(
      points, flags.radius.value_or(0.0), parse_point("--position", flags.position), parse_point("--goal", flags.goal));
  if (!fitted) throw UsageError("--enclose", "trap-free", "a robot and a goal farther from the obstacle");
  return fitted->ellipse;
}

/// What stands for an obstacle: a velocity obstacle is built of convex shapes.
using Shapes = std::pair<Taken, std::vector<ConvexShape>>;

Shapes shapes_of(const geometry::Obstacle& obstacle, const VoFlags& flags) {
  if (flags.enclose == "ellipse")
    return {Taken::smallest_ellipse, {geometry::fast_smallest_ellipse(vertices_of(obstacle)).ellipse}};
  if (flags.enclose == "trap-free") return {Taken::trap_free_ellipse, {trap_free(vertices_of(obstacle), flags)}};
  if (geometry::is_convex(obstacle)) return {Taken::itself, geometry::convex_cover(obstacle)};
  if (flags.pieces == "hull") return {Taken::convex_hull, {geometry::hull_shape(vertices_of(obstacle))}};
  return {Taken::convex_pieces, geometry::convex_cover(obstacle)};
}

Shapes shapes_of(const GivenObstacle& given, const VoFlags& flags) {
  if (const auto* obstacle = std::get_if<geometry::Obstacle>(&given)) return shapes_of(*obstacle, flags);
  if (flags.enclose != "none")
    throw UsageError("--enclose", flags.enclose, "a polygon or a wall to enclose: a disc or an ellipse is one already");
  return {Taken::itself, {std::get<ConvexShape>(given)}};
}

/// One bad obstacle refuses its file.
datasets::ReadOptions whole_files(const ReadingFlags& reading) {
  datasets::ReadOptions options = reading_options(reading);
  options.keep_going = false;
  return options;
}

/// The hull of a robot that is its own hull.
geometry::ConvexPolygon robot_of(const std::string& text, const ReadingFlags& reading) {
  const std::vector<GivenObstacle> given = obstacles_in("--robot", text, whole_files(reading));
  if (given.size() != 1)
    throw UsageError("--robot", geometry::counted(given.size(), "geometry", "geometries"), "one convex polygon");
  const auto* polygon = std::get_if<geometry::Obstacle>(&given.front());
  if (!polygon) throw UsageError("--robot", text, "a convex polygon (a disc is given by --radius)");
  if (!geometry::is_convex(*polygon))
    throw UsageError("--robot", "a shape that is not convex", "a convex polygon without holes, or --radius");
  return geometry::convex_hull(vertices_of(*polygon));
}

// --- The horizon ---

/// A number of seconds, or a rule, which takes the distance over the speed: nothing for a piece in contact, which has
/// no cone to measure it from. The paper's gives none to a robot whose distance rounds to nothing, an infinite one at
/// rest.
std::optional<double> horizon_of(const std::string& text, vo::Encounter e) {
  if (text == "infinite") return kInfinity;
  if (text != "paper" && text != "clamped") {
    double seconds = 0.0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf%c", &seconds, &rest) != 1 || !is_horizon(seconds))
      throw UsageError("--time-horizon", text, kHorizons);
    return seconds;
  }
  e.time_horizon = 1.0;  // any: the distance does not depend on it
  const vo::VelocityObstacle cone = cone_of(e);
  if (cone.overlaps()) return std::nullopt;
  const Vec2 relative = e.velocity - e.obstacle_velocity;
  if (text == "clamped") return vo::clamped_time_horizon(cone, relative);
  const double seconds = vo::paper_time_horizon(cone, relative);
  if (!is_horizon(seconds) && seconds != kInfinity)
    throw UsageError("--time-horizon", fmt::format("paper, which is {:g} s here", std::fabs(seconds)), kHorizons);
  return seconds;
}

/// What goes with what, and what would be ignored.
void check_option_conflicts(const VoFlags& flags) {
  require(flags.radius || !flags.robot.empty(), "--radius", "nothing", "the robot's radius in m (or --robot WKT)");
  refuse_both(flags.radius && !flags.robot.empty(), "--radius", "--robot");
  require(flags.max_speed || !flags.free, "--max-speed", "nothing", "a speed in m/s, which --free needs");
  if (flags.max_speed && !flags.free) throw lacking("--max-speed", "--free");
  if (!flags.goal.empty() && flags.enclose != "trap-free") throw lacking("--goal", "--enclose trap-free");
  refuse_both(flags.enclose == "trap-free" && !flags.robot.empty(), "--robot", "--enclose trap-free",
              "the ellipse is fitted for a disc; give --radius");
  refuse_both(flags.responsibility != 1.0 && flags.free, "--responsibility", "--free");
}

/// The files among the obstacles and the robot, with what is read with them.
std::vector<std::filesystem::path> files_named_in(const VoFlags& flags) {
  std::vector<std::string> texts = flags.obstacles;
  texts.push_back(flags.robot);
  texts.erase(std::remove_if(texts.begin(), texts.end(), [](const std::string& t) { return !is_there(t); }),
              texts.end());
  return all_read_with(texts, flags.reading.format);
}

void check_words(const VoFlags& flags) {
  require_known("--enclose", flags.enclose, {"none", "ellipse", "trap-free"});
  if (!flags.pieces.empty()) require_known("--pieces", flags.pieces, {"convex", "hull"});
  refuse_both(!flags.pieces.empty() && flags.enclose != "none", "--pieces", "--enclose");
  if (!flags.figure.empty()) check_figure_name("--figure", flags.figure, files_named_in(flags));
}

void check_numbers(const VoFlags& flags) {
  const double radius = flags.radius.value_or(0.0), speed = flags.max_speed.value_or(vo::kLeastMaxSpeed);
  require(is_radius(radius), "--radius", fmt::format("{}", radius), kRadii);
  require(flags.responsibility > 0.0 && flags.responsibility <= 1.0, "--responsibility",
          fmt::format("{}", flags.responsibility), "a number in (0, 1]");
  require(speed >= vo::kLeastMaxSpeed && speed <= vo::kMostMaxSpeed, "--max-speed", fmt::format("{}", speed),
          "a speed from 2^-60 to 2^60 m/s, with --free");
}

/// What all obstacles share.
vo::Encounter robot_alone(const VoFlags& flags) {
  vo::Encounter e;
  e.position = parse_point("--position", flags.position);
  e.velocity = parse_point("--velocity", flags.velocity);
  e.radius = flags.radius.value_or(0.0);
  e.responsibility = flags.responsibility;
  if (!flags.robot.empty()) e.robot = robot_of(flags.robot, flags.reading);
  return e;
}

/// All pieces of an obstacle look as far ahead as the free one with the shortest horizon: for a rule that is the
/// nearest. Where a rule finds all of them in contact there is none: what is proven of contact holds for any time.
void add_obstacle(const GivenObstacle& given, vo::Encounter e, const VoFlags& flags, VoQuestion& q) {
  auto [taken, shapes] = shapes_of(given, flags);
  const std::size_t first = q.encounters.size();
  double horizon = kInfinity;
  for (ConvexShape& shape : shapes) {
    e.obstacle = std::move(shape);
    horizon = std::min(horizon, horizon_of(flags.time_horizon, e).value_or(kInfinity));
    q.encounters.push_back(e);
  }
  for (std::size_t k = first; k < q.encounters.size(); ++k) q.encounters[k].time_horizon = horizon;
  q.obstacles.push_back({given, taken, first, q.encounters.size() - first});
}

void check_obstacles(const VoFlags& flags, const VoQuestion& q) {
  if (q.obstacles.size() != 1 && !q.free)
    throw UsageError("--obstacle", geometry::counted(q.obstacles.size(), "obstacle"),
                     "one obstacle (several go with --free)");
  if (flags.obstacle_velocities.size() > flags.obstacles.size())
    throw UsageError("--obstacle-velocity",
                     geometry::counted(flags.obstacle_velocities.size(), "velocity", "velocities"),
                     "at most one an --obstacle");
}

}  // namespace

Place place_of(const VoQuestion& question, std::size_t encounter) {
  const std::vector<AskedObstacle>& all = question.obstacles;
  std::size_t k = 0;
  while (k + 1 < all.size() && all[k + 1].first_encounter <= encounter) ++k;
  return {k, encounter - all[k].first_encounter};
}

VoQuestion question_of(const VoFlags& flags) {
  check_option_conflicts(flags);
  check_words(flags);
  check_numbers(flags);
  VoQuestion q;
  q.responsibility = flags.responsibility;
  q.exact_legs = flags.exact_legs;
  q.free = flags.free;
  q.max_speed = flags.max_speed.value_or(0.0);
  const vo::Encounter alone = robot_alone(flags);
  q.velocity = alone.velocity;
  for (std::size_t i = 0; i < flags.obstacles.size(); ++i) {
    vo::Encounter e = alone;
    if (i < flags.obstacle_velocities.size())
      e.obstacle_velocity = parse_point("--obstacle-velocity", flags.obstacle_velocities[i]);
    for (const GivenObstacle& given : obstacles_in("--obstacle", flags.obstacles[i], whole_files(flags.reading)))
      add_obstacle(given, e, flags, q);
  }
  check_obstacles(flags, q);
  return q;
}

void declare_options(CLI::App& app, VoFlags& flags) {
  app.add_option("--obstacle", flags.obstacles,
                 "WKT; a file with one obstacle; 'DISC(x y, r)'; 'ELLIPSE(cx cy, l11 l21 l22)', the image of the unit "
                 "disc under [l11 0; l21 l22]; 'ELLIPSE(cx cy, a b, degrees)'. Several with --free")
      ->required()
      ->allow_extra_args(false);
  declare_reading_flags(app, flags.reading);
  app.add_option("--obstacle-velocity", flags.obstacle_velocities,
                 "X,Y in m/s, one for each --obstacle; at rest if missing")
      ->allow_extra_args(false);
  app.add_option("--pieces", flags.pieces,
                 "For a non-convex obstacle: convex (default: all of its convex pieces) or hull");
  app.add_option("--enclose", flags.enclose, "none, ellipse (the smallest) or trap-free (needs --goal)");
  app.add_option("--position", flags.position, "Position of the robot, X,Y in m")->required();
  app.add_option("--velocity", flags.velocity, "X,Y in m/s")->required();
  app.add_option("--radius", flags.radius, "Radius of the robot, m; required unless --robot is given");
  app.add_option("--robot", flags.robot,
                 "A robot that is a convex polygon, instead of --radius: WKT round its reference point 0,0");
  app.add_option(
         "--time-horizon", flags.time_horizon,
         "s, from 2^-100 to 2^100; or infinite, paper (distance over speed) or clamped (the same within 0.3 s and 3 s)")
      ->required();
  app.add_option("--responsibility", flags.responsibility,
                 "Share of the change that the robot takes, in (0, 1]. Below 1 a second half-plane is printed, which "
                 "holds only if the other side takes the rest");
  app.add_option("--goal", flags.goal, "X,Y in m, for --enclose trap-free");
  app.add_flag("--exact-legs", flags.exact_legs,
               "The legs as algebraic numbers: polynomial, interval; with --free also which cones share one");
  app.add_flag(
      "--free", flags.free,
      "The free velocities of all obstacles: their area and pieces, between bounds and (without ellipses) exactly; "
      "what the half-planes give away");
  app.add_option("--max-speed", flags.max_speed, "m/s, required by --free");
  app.add_flag("--json", flags.json, "Everything as JSON on stdout");
  app.add_option("--figure", flags.figure, kFigureFileHelp);
}

bool is_there(const std::string& text) {
  std::error_code too_long;
  return fs::exists(text, too_long);
}

std::vector<GivenObstacle> obstacles_in(const std::string& option, const std::string& text,
                                        const datasets::ReadOptions& reading) {
  const Call call = text.find('(') == std::string::npos || is_there(text) ? Call{} : call_in(text);
  if (call.word == "DISC" || call.word == "ELLIPSE") {
    const std::optional<ConvexShape> shape = shape_of(call);
    if (!shape) throw UsageError(option, text, std::string(kShapeWords) + ", lengths >= 0 m, within 2^100 m");
    return {*shape};
  }
  std::vector<GivenObstacle> given;
  for (auto& obstacle : read(option, text, reading).obstacles) given.emplace_back(std::move(obstacle.shape));
  if (given.empty())
    throw UsageError(option, text, "a polygon or a line (a point is no obstacle, but DISC(x y, 0) is one)");
  return given;
}

}  // namespace exactvo::tools
