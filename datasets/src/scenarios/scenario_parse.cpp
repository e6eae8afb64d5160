// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/input_files.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/scenario_at.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/datasets/trajectory_file.h"
#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/simulation.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "readers/raw_geometry.h"
#include "scenarios/scenario_values.h"
#include "scenarios/schema_check.h"

namespace exactvo::datasets {
namespace {

using formation::Scenario;
using geometry::Vec2;

/// By the rules alone, since the whole schema takes several times as long to parse; it is for the words of a refusal.
void check_by_schema(const Json& tree, const std::string& file) {
  try {
    check_against_scenario_rules(tree, file);
  } catch (const DataError&) {
    check_against_schema(tree, parse_json(scenario_schema(), "scenario.schema.json"), file);
    throw;
  }
}

// The schema has been held against the text: types and required keys are as they should be from here on.

/// The member, uncopied; an empty list where there is none.
const Json& list_in(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const auto found = object.find(key);
  return found == object.end() ? kNone : *found;
}

RawGeometry to_raw(const Json& object, const std::string& id, const std::string& pointer) {
  const bool is_line = object.contains("polyline");
  const char* key = is_line ? "polyline" : "polygon";
  RawGeometry raw{is_line ? RawKind::polyline : RawKind::polygon, id, pointer, {object.at(key).get<geometry::Ring>()}};
  raw.ring_pointers.push_back(pointer + "/" + key);
  const Json& holes = list_in(object, "holes");
  for (std::size_t h = 0; h < holes.size(); ++h) {
    raw.rings.push_back(holes[h].get<geometry::Ring>());
    raw.ring_pointers.push_back(pointer + "/holes/" + std::to_string(h));
  }
  return raw;
}

Units to_units(const std::string& word) {
  if (word == "metres") return Units::metres;
  return word == "degrees" ? Units::degrees : Units::automatic;
}

/// A file of obstacles where a scenario is expected, and how a scenario takes it.
DataError no_scenario(const std::string& file, const std::string& format) {
  const std::string name = file == "-" ? "FILE" : std::filesystem::path(file).filename().string();
  return {DataCode::format_unknown, file, "", "a file of obstacles, " + format,
          R"(a scenario in JSON, which has robots and names such a file: "obstacles": [{"file": ")" + name + R"("}])"};
}

/// Says so of text in another format than JSON, and of a bare list in one of obstacles.
void refuse_other_formats(const std::filesystem::path& path, const std::string& text) {
  if (begins_crowd_recording(text))
    throw DataError(DataCode::format_unknown, path.string(), "", "the recording of a crowd (.evr)",
                    "a scenario in JSON; audit, convert, draw and view read recordings of crowds");
  const std::string_view beginning(text.data(), std::min<std::size_t>(text.size(), 100));
  if (beginning.find("exactvo-recording") != std::string_view::npos)
    throw DataError(DataCode::format_unknown, path.string(), "", "the recording of a run",
                    "a scenario in JSON; draw, explain, view, serve and audit take runs");
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  std::error_code error;
  if (first == std::string::npos || text[first] == '{' || !std::filesystem::is_regular_file(path, error)) return;
  if (const std::string rows = recognised_trajectory_format(path.string()); !rows.empty())
    throw DataError(DataCode::format_unknown, path.string(), "", "a file of trajectories, format " + rows,
                    "a scenario in JSON; check takes trajectories");
  std::string format;
  try {
    format = format_of(path);
  } catch (const DataError&) {
    return;  // the parser says what is wrong
  }
  const std::string extension = path.extension().string();
  const bool is_json_by_name = extension == ".json" || extension == ".geojson" || extension == ".topojson";
  if (format == "scenario" || (format == "gdal" && is_json_by_name)) return;
  throw no_scenario(path.string(), format == "gdal" ? "a vector file" : "format " + format);
}

/// Share of the coordinates, above what `polygon_round` takes.
constexpr double kLeastDisc = 1e-12;

/// Reads one scenario; a class only so that the file's name and folder need not be handed round.
class ScenarioReader {
 public:
  ScenarioReader(std::string file_name, std::filesystem::path base_dir)
      : file_(std::move(file_name)), base_dir_(std::move(base_dir)) {}

  LoadedScenario read(const Json& tree, const AdvanceScenario& advance = {}) {
    Scenario scenario = read_scenario(tree, advance);
    return {std::move(scenario), std::move(notes_), std::move(files_)};
  }

 private:
  Scenario read_scenario(const Json& tree, const AdvanceScenario& advance) {
    refuse_geojson(tree);
    refuse_motion_of_obstacles(tree);
    check_by_schema(tree, file_);
    Scenario scenario;
    scenario.name = tree.at("name").get<std::string>();
    scenario.description = tree.value("description", std::string());
    read_value(JsonCursor(tree, file_, ""), scenario);
    read_obstacle_list(list_in(tree, "obstacles"), scenario);
    read_robot_list(tree.at("robots"), scenario);
    if (tree.contains("formation")) scenario.formation = to_formation(tree.at("formation"), scenario.robots, file_);
    scenario.separate = tree.value("separate", false);
    if (tree.value("speed_bound", "disc") == "box") scenario.speed_bound = formation::SpeedBoundKind::box;
    if (tree.value("guidance", "route") == "none") scenario.guidance = formation::Guidance::none;
    if (tree.contains("unreachable")) formation::parse(tree.at("unreachable").get<std::string>(), scenario.unreachable);
    if (tree.contains("liveness")) formation::parse(tree.at("liveness").get<std::string>(), scenario.liveness);
    read_moving_obstacles(list_in(tree, "moving_obstacles"), scenario);  // velocities end with the run
    look_ahead_while_braking(tree, scenario);
    refuse_repeated_ids(scenario);
    if (scenario.formation && tree.at("formation").at("leader").contains("to"))
      plan_leader_of(tree.at("formation").at("leader"), scenario, file_);
    if (advance) {
      // Paths and speeds of what moves by itself: they must be right before anything is moved along them.
      for (const formation::ScenarioProblem& problem : formation::validate(scenario))
        if (starts_with(problem.pointer, "/moving_obstacles") || starts_with(problem.pointer, "/formation"))
          refuse(scenario, problem);
      advance(scenario);
    }
    // What no schema can say: robots that overlap, lists whose lengths must agree, ...
    const std::vector<formation::ScenarioProblem> problems = formation::validate(scenario);
    if (!problems.empty()) refuse(scenario, problems.front());
    return scenario;
  }

  /// Obstacles alone, which begin as a scenario does.
  void refuse_geojson(const Json& tree) const {
    const auto type = tree.is_object() ? tree.find("type") : tree.end();
    if (type == tree.end() || !type->is_string() || tree.contains("robots")) return;
    const bool is_topology = *type == "Topology";
    throw no_scenario(file_, (is_topology ? "TopoJSON" : "GeoJSON") + (" (" + type->get<std::string>()) + ")");
  }

  /// Obstacles stand: one with a velocity is meant as a moving obstacle, which is in another list.
  void refuse_motion_of_obstacles(const Json& tree) const {
    const auto list = tree.is_object() ? tree.find("obstacles") : tree.end();
    if (list == tree.end() || !list->is_array()) return;
    for (std::size_t k = 0; k < list->size(); ++k)
      for (const char* key : {"velocity", "speed", "path", "profile", "motion", "moving", "vx", "vy"})
        if ((*list)[k].is_object() && (*list)[k].contains(key))
          throw DataError(DataCode::key_unknown, file_, "/obstacles/" + std::to_string(k) + "/" + key,
                          "an unknown key \"" + std::string(key) + "\"",
                          "an obstacle that stands; one that moves goes into the list \"moving_obstacles\", with a "
                          "\"path\" and a \"speed\", or a \"velocity\"");
  }

  void read_robot_list(const Json& list, Scenario& scenario) {
    RobotList read = read_robots(list, scenario, file_, base_dir_);
    robots_are_one_entry_ = list.is_object();
    scenario.robots = std::move(read.robots);
    origin_of_robot_ = std::move(read.origins);
    for (std::filesystem::path& table : read.tables) files_.push_back(std::move(table));
  }

  void read_obstacle_list(const Json& list, Scenario& scenario) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      const std::string pointer = "/obstacles/" + std::to_string(k);
      if (list[k].contains("file")) {
        read_obstacle_file(list[k], pointer, scenario);
      } else {
        scenario.obstacles.push_back(to_obstacle(list[k], list[k].value("id", "O" + std::to_string(k + 1)), pointer));
      }
      origin_of_.resize(scenario.obstacles.size(), {pointer, list[k].contains("id")});
    }
  }

  void read_moving_obstacles(const Json& list, Scenario& scenario) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      const std::string pointer = "/moving_obstacles/" + std::to_string(k);
      formation::TimedPath motion = to_motion(list[k], pointer, scenario);
      formation::SceneObstacle o = to_obstacle(list[k], list[k].value("id", "M" + std::to_string(k + 1)), pointer);
      scenario.moving_obstacles.push_back({std::move(o.id), std::move(o.shape), std::move(motion), o.disc});
      if (list[k].contains("max_speed"))
        scenario.moving_obstacles.back().max_speed = list[k].at("max_speed").get<double>();
    }
  }

  formation::SceneObstacle to_obstacle(const Json& object, const std::string& id, const std::string& pointer) const {
    if (object.contains("disc")) return formation::disc_obstacle(id, to_disc(object.at("disc"), pointer));
    ValidationResult checked = validate(to_raw(object, id, pointer));
    refuse_unrepaired(checked, file_);
    return {id, std::move(checked.shape), std::nullopt};
  }

  geometry::Disc to_disc(const Json& object, const std::string& pointer) const {
    const geometry::Disc disc{object.at("centre").get<Vec2>(), object.at("radius").get<double>()};
    const double size = std::max(std::fabs(disc.center.x), std::fabs(disc.center.y)) + disc.radius;
    if (!(disc.radius >= kLeastDisc * size))
      throw DataError(DataCode::scenario, file_, pointer + "/disc/radius", number_text(disc.radius),
                      "at least a 10^12-th of the coordinates (m): less is lost in their rounding");
    return disc;
  }

  /// Along a path, or with velocities: those become the path of a run's whole time.
  formation::TimedPath to_motion(const Json& object, const std::string& pointer, const Scenario& scenario) const {
    if (!object.contains("velocity") && !object.contains("velocities")) {
      formation::TimedPath motion{object.at("path").get<std::vector<Vec2>>()};
      motion.speed = object.value("speed", 0.0);
      if (object.contains("profile"))
        motion.profile = to_profile(object.at("profile"), motion.path, file_, pointer + "/profile");
      return motion;
    }
    for (const char* key : {"path", "speed", "profile"})
      if (object.contains(key))
        throw DataError(DataCode::no_alternative, file_, pointer, "a velocity and \"" + std::string(key) + "\"",
                        "\"path\" with \"speed\" or \"profile\", or \"velocity\", or \"velocities\"");
    std::vector<formation::TimedVelocity> velocities;
    if (object.contains("velocity")) velocities.push_back({0.0, object.at("velocity").get<Vec2>()});
    for (const Json& entry : list_in(object, "velocities")) {
      const formation::TimedVelocity next{entry[0].get<double>(), {entry[1].get<double>(), entry[2].get<double>()}};
      if (next.time < 0.0 || (!velocities.empty() && next.time < velocities.back().time))
        throw DataError(DataCode::scenario, file_, pointer + "/velocities/" + std::to_string(velocities.size()) + "/0",
                        number_text(next.time) + " s", "times that begin at 0 or later and do not fall");
      velocities.push_back(next);
    }
    formation::TimedPath motion = formation::path_of({}, velocities, scenario.time_limit + scenario.time_step);
    for (const Vec2 p : motion.path)
      if (std::max(std::fabs(p.x), std::fabs(p.y)) > kFarthest)
        throw DataError(DataCode::scenario, file_, pointer, "a velocity that leads " + number_text(norm(p)) + " m away",
                        "at most 1e9 m within time_limit");
    return motion;
  }

  void read_obstacle_file(const Json& object, const std::string& pointer, Scenario& scenario) {
    const std::filesystem::path named = object.at("file").get<std::string>();
    ReadOptions options;
    options.format = object.value("format", std::string());
    options.units = to_units(object.value("units", std::string("automatic")));
    if (object.contains("unknown")) parse(object.at("unknown").get<std::string>(), options.unknown);
    const std::string prefix = object.value("id", named.stem().string());
    const std::filesystem::path path = base_dir_ / named;
    ObstacleFile file = read_named_file(path, options, pointer);
    for (std::filesystem::path& read : files_read_with(path, options.format))
      if (std::find(files_.begin(), files_.end(), read) == files_.end()) files_.push_back(std::move(read));
    add_notes(file);
    for (const formation::SceneObstacle& obstacle : file.obstacles) refuse_far(obstacle, path);
    if (file.origin) projected_ += (projected_.empty() ? "" : ", ") + named.string();
    for (formation::SceneObstacle& obstacle : file.obstacles) {
      scenario.obstacles.push_back({prefix + "/" + obstacle.id, std::move(obstacle.shape)});
    }
  }

  /// A file may go farther than a robot can tell a metre.
  static void refuse_far(const formation::SceneObstacle& obstacle, const std::filesystem::path& path) {
    for (const Vec2 p : geometry::vertices_of(obstacle.shape)) {
      if (std::max(std::fabs(p.x), std::fabs(p.y)) <= kFarthest) continue;
      throw DataError(DataCode::out_of_range, path.string(), "obstacle " + obstacle.id,
                      "a vertex at " + number_text(p.x) + ", " + number_text(p.y),
                      "coordinates within 1e9 m of (0, 0), as in a scenario itself");
    }
  }

  /// Whether the mistake is in naming the file, not in what stands in it.
  static bool is_of_the_name(DataCode code) {
    return code == DataCode::file_missing || code == DataCode::file_unreadable || code == DataCode::format_unknown ||
           code == DataCode::format_unavailable || code == DataCode::not_an_option;
  }

  ObstacleFile read_named_file(const std::filesystem::path& path, const ReadOptions& options,
                               const std::string& pointer) const {
    try {
      return read_obstacles(path, options);
    } catch (const DataError& error) {
      if (!is_of_the_name(error.code()) || error.file() != path.string()) throw;
      const bool is_its_format = error.place() == "format";
      if (!is_its_format && !error.place().empty()) throw;
      throw DataError(error.code(), file_, pointer + (is_its_format ? "/format" : "/file"),
                      error.found() + " (" + path.string() + ")", with_the_key(error.expected()));
    }
  }

  /// A reader names the program's option for the format, which here is a key.
  static std::string with_the_key(std::string expected) {
    const std::string option = "--format (convert: --from; check, monitor: --map-format)";
    const std::size_t at = expected.find(option);
    return at == std::string::npos ? expected : expected.replace(at, option.size(), "the key \"format\"");
  }

  void add_notes(const ObstacleFile& file) {
    const std::string name = file.file + ": ";
    for (const DataNote& note : file.notes) {
      if (!note.of_feature) notes_.push_back(name + (note.place.empty() ? "" : note.place + ": ") + note.text);
    }
    const auto count = [&](std::size_t n, const char* words) {
      if (n > 0) notes_.push_back(name + std::to_string(n) + words);
    };
    count(file.counts.repaired, " of the obstacles repaired (winding, closure, repeated vertices)");
    count(file.counts.passed_over, " skipped (points, empty geometries)");
  }

  void refuse_repeated_ids(const Scenario& scenario) const {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
      const std::string& id = scenario.robots[i].id;
      if (seen.insert(id).second) continue;
      refuse(in_the_text("/robots/" + std::to_string(i) + "/id"), "\"" + id + "\" a second time");
    }
    seen.clear();
    for (std::size_t k = 0; k < scenario.obstacles.size(); ++k) {
      const std::string& id = scenario.obstacles[k].id;
      const Origin& origin = origin_of_[k];
      const std::string found = origin.is_named ? "\"" + id + "\"" : "no id, so \"" + id + "\",";
      if (!seen.insert(id).second) refuse(origin.pointer + (origin.is_named ? "/id" : ""), found + " a second time");
    }
    seen.clear();
    for (std::size_t k = 0; k < scenario.moving_obstacles.size(); ++k) {
      const std::string& id = scenario.moving_obstacles[k].id;
      if (!seen.insert(id).second) refuse("/moving_obstacles/" + std::to_string(k), "\"" + id + "\" a second time");
    }
  }

  [[noreturn]] void refuse(const std::string& pointer, const std::string& found) const {
    throw DataError(DataCode::scenario, file_, pointer, found, "an id of its own");
  }

  /// Robots that brake slowly look ahead at least until they stand, unless the file says otherwise.
  static void look_ahead_while_braking(const Json& tree, Scenario& scenario) {
    const double tau = formation::braking_time_of(scenario);
    const Json given = tree.value("horizons", Json::object());
    const auto look = [&](const char* name, double& horizon) {
      if (!given.contains(name)) horizon = std::max(horizon, tau);
    };
    look("most", scenario.horizons.most);
    look("orca", scenario.horizons.orca);
    look("robots", scenario.horizons.robots);
  }

  [[noreturn]] void refuse(const Scenario& scenario, const formation::ScenarioProblem& problem) const {
    throw DataError(DataCode::scenario, file_, in_the_text(problem.pointer),
                    words_of_robot(scenario, problem.pointer) + problem.found + words_of_projection(),
                    problem.expected);
  }

  static bool starts_with(const std::string& text, const std::string& prefix) {
    return text.compare(0, prefix.size(), prefix) == 0;
  }

  /// Numbers that were no degrees are the likeliest reason why robots and obstacles do not fit together.
  std::string words_of_projection() const {
    if (projected_.empty()) return "";
    return " (" + projected_ +
           ": projected from degrees to metres; \"units\": \"metres\" takes its numbers as they stand)";
  }

  /// Problems name obstacles by their place in the scenario; in the text one entry may stand for a file of many.
  std::string in_the_text(const std::string& pointer) const {
    if (const auto robot = robot_in(pointer)) {
      const RobotOrigin& origin = origin_of_robot_.at(*robot);
      const std::string entry = robots_are_one_entry_ ? "/robots" : "/robots/" + std::to_string(origin.entry);
      return origin.is_one_of_many ? entry : entry + pointer.substr(pointer.find('/', kRobots.size()));
    }
    const std::string prefix = "/obstacles/";
    if (!starts_with(pointer, prefix)) return pointer;
    const std::size_t end = pointer.find('/', prefix.size());
    const std::size_t k = std::stoul(pointer.substr(prefix.size(), end - prefix.size()));
    return origin_of_.at(k).pointer + (end == std::string::npos ? "" : pointer.substr(end));
  }

  /// The robot that "/robots/17/position" names.
  static std::optional<std::size_t> robot_in(const std::string& pointer) {
    if (!starts_with(pointer, kRobots)) return std::nullopt;
    return std::stoul(pointer.substr(kRobots.size()));
  }

  /// Names a robot that no entry of its own names.
  std::string words_of_robot(const Scenario& scenario, const std::string& pointer) const {
    const auto robot = robot_in(pointer);
    if (!robot || !origin_of_robot_.at(*robot).is_one_of_many) return "";
    return "robot '" + scenario.robots[*robot].id + "' at ";
  }

  inline static const std::string kRobots = "/robots/";
  std::string file_;
  std::filesystem::path base_dir_;
  std::vector<RobotOrigin> origin_of_robot_;
  bool robots_are_one_entry_ = false;  ///< which stands in the place of the list
  /// An obstacle's entry in the text, and whether that has an id.
  struct Origin {
    std::string pointer;
    bool is_named = false;
  };
  std::vector<Origin> origin_of_;  ///< per obstacle of the scenario
  std::vector<std::string> notes_;
  std::vector<std::filesystem::path> files_;  ///< of obstacles, and what is read with them
  std::string projected_;                     ///< files that were projected from degrees to metres, with commas between
};

}  // namespace

LoadedScenario parse_scenario_with_notes(const std::string& text, const std::string& file_name,
                                         const std::filesystem::path& base_dir) {
  return ScenarioReader(file_name, base_dir).read(parse_json(text, file_name));
}

Scenario parse_scenario(const std::string& text, const std::string& file_name, const std::filesystem::path& base_dir) {
  return parse_scenario_with_notes(text, file_name, base_dir).scenario;
}

Scenario parse_scenario_at(const std::string& text, const std::string& file_name, const std::filesystem::path& base_dir,
                           const AdvanceScenario& advance) {
  return ScenarioReader(file_name, base_dir).read(parse_json(text, file_name), advance).scenario;
}

LoadedScenario load_scenario_with_notes(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  if (text.empty()) throw DataError(DataCode::json_syntax, path.string(), "", "an empty file", "a scenario in JSON");
  refuse_other_formats(path, text);
  LoadedScenario loaded = parse_scenario_with_notes(text, path.string(), path.parent_path());
  loaded.files.insert(loaded.files.begin(), path);
  return loaded;
}

Scenario load_scenario(const std::filesystem::path& path) {
  return load_scenario_with_notes(path).scenario;
}

std::vector<std::filesystem::path> files_of_scenario(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files{path};
  const Json tree = parse_json(read_text_file(path), path.string());
  const auto add_file_of = [&](const Json& entry) {
    if (entry.contains("file")) files.push_back(path.parent_path() / entry.at("file").get<std::string>());
  };
  for (const char* name : {"robots", "obstacles"}) {
    const Json& list = list_in(tree, name);
    if (list.is_object()) add_file_of(list);
    if (list.is_array()) std::for_each(list.begin(), list.end(), add_file_of);
  }
  return files;
}

}  // namespace exactvo::datasets
