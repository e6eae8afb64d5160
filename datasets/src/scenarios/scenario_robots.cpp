// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <variant>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/repair.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/obstacle_index.h"
#include "exactvo/geometry/pi.h"
#include "files/text_file.h"
#include "generators/counter_random.h"
#include "readers/line_reader.h"
#include "scenarios/scenario_values.h"

namespace exactvo::datasets {
namespace {

using formation::Robot;
using geometry::Vec2;

/// Robots of a scenario.
constexpr std::size_t kMostRobots = 10'000'000;

/// Places drawn for a robot until one is free.
constexpr int kDraws = 1000;

/// The stream of random_key that these draws share with no others.
constexpr std::uint64_t kStream = 0x726f626f7473;  // "robots"

/// m and m/s; the schema's bound of radii and speeds.
constexpr double kLargest = 1e6;

/// Where robots stand: at the start, or at their last goals.
Vec2 start_of(const Robot& robot) {
  return robot.position;
}
Vec2 end_of(const Robot& robot) {
  return robot.goals.empty() ? robot.position : robot.goals.back();
}

/// What is free of obstacles and of the robots there are, where `place` says.
class FreeRoom {
 public:
  FreeRoom(const std::vector<formation::SceneObstacle>& obstacles, const std::vector<Robot>& robots,
           Vec2 (*place)(const Robot&), double radius, double apart)
      : radius_(radius), apart_(apart), cell_(2.0 * radius + apart) {
    std::vector<geometry::Box> boxes;
    obstacles_.reserve(obstacles.size());
    for (const formation::SceneObstacle& o : obstacles) {
      obstacles_.emplace_back(o.shape);
      boxes.push_back(obstacles_.back().box());
    }
    by_place_ = geometry::BoxGrid(std::move(boxes));
    boxes.clear();
    for (const Robot& r : robots) {
      const Vec2 reach{r.radius, r.radius};
      boxes.push_back({place(r) - reach, place(r) + reach});
      others_.push_back({place(r), r.radius});
    }
    others_by_place_ = geometry::BoxGrid(std::move(boxes));
  }

  bool is_clear_of_obstacles(Vec2 x, double room) const {
    bool clear = true;
    by_place_.for_each_within(x, room, [&](std::size_t k) {
      clear = clear && obstacles_[k].swept_distance({x, x}, room) >= room;
    });
    return clear;
  }

  bool is_free(Vec2 x) const {
    bool free = is_clear_of_obstacles(x, radius_ + apart_);
    others_by_place_.for_each_within(x, radius_ + apart_, [&](std::size_t k) {
      free = free && geometry::norm(x - others_[k].center) >= radius_ + apart_ + others_[k].radius;
    });
    const auto [column, row] = cell_of(x);
    for (std::int64_t c = column - 1; c <= column + 1; ++c)
      for (std::int64_t r = row - 1; r <= row + 1; ++r) {
        const auto cell = taken_.find({c, r});
        if (cell == taken_.end()) continue;
        for (const Vec2 y : cell->second) free = free && geometry::norm(x - y) >= cell_;
      }
    return free;
  }

  void take(Vec2 x) { taken_[cell_of(x)].push_back(x); }

 private:
  using Cell = std::pair<std::int64_t, std::int64_t>;
  struct HashOfCell {
    std::size_t operator()(const Cell& c) const {
      return mixed(static_cast<std::uint64_t>(c.first) * kRandomStride + static_cast<std::uint64_t>(c.second));
    }
  };
  Cell cell_of(Vec2 x) const {
    return {static_cast<std::int64_t>(std::floor(x.x / cell_)), static_cast<std::int64_t>(std::floor(x.y / cell_))};
  }

  double radius_, apart_, cell_;
  std::vector<geometry::ObstacleIndex> obstacles_;
  std::vector<geometry::Disc> others_;
  geometry::BoxGrid by_place_, others_by_place_;
  std::unordered_map<Cell, std::vector<Vec2>, HashOfCell> taken_;
};

class RobotsReader {
 public:
  RobotsReader(const formation::Scenario& scenario, const std::string& file, const std::filesystem::path& base_dir)
      : obstacles_(scenario.obstacles),
        file_(file),
        base_dir_(base_dir),
        time_step_(scenario.time_step),
        tracking_(formation::tracking_error_of(scenario)) {}

  RobotList read(const Json& list) {
    if (list.is_object()) {
      read_entry(list, 0, "/robots");
    } else {
      for (std::size_t k = 0; k < list.size(); ++k) read_entry(list[k], k, "/robots/" + std::to_string(k));
    }
    return std::move(out_);
  }

 private:
  void read_entry(const Json& entry, std::size_t k, std::string pointer) {
    entry_ = k;
    pointer_ = std::move(pointer);
    const JsonCursor at(entry, file_, "");
    if (entry.contains("position")) {
      Robot& robot = out_.robots.emplace_back();
      members(at, robot);
      if (entry.contains("goal")) robot.goals = {entry.at("goal").get<Vec2>()};
      read_drive(entry, robot);
      out_.origins.push_back({k, false});
      return;
    }
    prefix_ = entry.value("prefix", "G" + std::to_string(k + 1)) + "/";
    pattern_ = Robot{};
    at.optional("radius", pattern_.radius).optional("max_speed", pattern_.max_speed);
    at.optional("cooperates", pattern_.cooperates);
    read_drive(entry, pattern_);
    heading_.reset();
    if (entry.contains("heading")) heading_ = pattern_.drive->heading;
    made_ = 0;
    if (entry.contains("circle")) make_circle(entry.at("circle"));
    if (entry.contains("grid")) make_grid(entry.at("grid"));
    if (entry.contains("random")) make_random(entry.at("random"));
    if (entry.contains("file")) read_table(entry.at("file").get<std::string>());
  }

  /// Where it has wheels its drive, and the disc that it has.
  void read_drive(const Json& entry, Robot& robot) const {
    const bool has_wheels = entry.contains("kinematics") && entry["kinematics"].value("type", "") == "differential";
    for (const char* key : {"heading", "footprint"})
      if (!has_wheels && entry.contains(key))
        refuse(DataCode::scenario, key, std::string("a ") + key + " of a robot that moves in any direction",
               "none without \"kinematics\" of the type \"differential\"");
    if (!has_wheels) {
      if (entry.contains("kinematics") && entry["kinematics"].size() > 1)
        refuse(DataCode::scenario, "kinematics", "wheels of a robot that moves in any direction",
               "\"type\": \"differential\", or no other key");
      keep_within_tube(robot, robot.radius, tracking_);
      return;
    }
    for (const char* key : {"wheel_separation", "max_wheel_speed", "max_wheel_acceleration"})
      if (!entry["kinematics"].contains(key))
        refuse(DataCode::key_missing, "kinematics", std::string("no ") + key, std::string("the key ") + key);
    if (entry.contains("max_speed"))
      refuse(DataCode::scenario, "max_speed", "a greatest speed of a robot on wheels",
             "kinematics/max_wheel_speed alone");
    formation::DifferentialDrive& drive = robot.drive.emplace();
    const JsonCursor kinematics(entry.at("kinematics"), file_, pointer_ + "/kinematics");
    members(kinematics, drive);
    drive.heading = entry.value("heading", 0.0);
    drive.axle = robot.position;
    drive.body_radius = robot.radius;
    read_footprint(entry, drive);
    if (!(drive.reference > 0.0)) drive.reference = 0.5 * drive.wheel_separation;
    take_wheels(robot);
  }

  /// The reference point and the disc about it. A drive that is refused later has none.
  void take_wheels(Robot& robot) const {
    if (robot.drive->max_wheel_speed * time_step_ < robot.drive->reference)
      put_on_wheels(robot, formation::DifferentialDrive(*robot.drive), time_step_, tracking_);
  }

  void read_footprint(const Json& entry, formation::DifferentialDrive& drive) const {
    if (!entry.contains("footprint")) return;
    if (entry.contains("radius"))
      refuse(DataCode::scenario, "radius", "a radius of a robot that has a footprint", "the footprint alone");
    drive.footprint = entry["footprint"].at("polygon").get<std::vector<Vec2>>();
    if (drive.footprint.front() == drive.footprint.back()) drive.footprint.pop_back();
    drive.body_radius = 0.0;
    for (const Vec2 corner : drive.footprint) drive.body_radius = std::max(drive.body_radius, norm(corner));
  }

  [[noreturn]] void refuse(DataCode code, const char* key, const std::string& found,
                           const std::string& expected) const {
    throw DataError(code, file_, pointer_ + "/" + key, found, expected);
  }

  void require_room_for(std::uint64_t more, const char* key) const {
    if (more + out_.robots.size() > kMostRobots)
      refuse(DataCode::size, key, std::to_string(more + out_.robots.size()) + " robots so far", "at most 10^7");
  }

  /// On wheels `position` is that of the reference point, as `goal` is.
  Robot& add(Vec2 position, Vec2 goal) {
    Robot& robot = out_.robots.emplace_back(pattern_);
    robot.id = prefix_ + std::to_string(++made_);
    robot.position = position;
    robot.goals = {goal};
    out_.origins.push_back({entry_, true});
    if (!robot.drive) return robot;
    const Vec2 way = goal - position;
    robot.drive->heading = heading_ ? *heading_ : std::atan2(way.y, way.x) * (180.0 / geometry::kPi);
    robot.drive->axle = position - robot.drive->reference * formation::heading_vector(robot.drive->heading);
    take_wheels(robot);
    return robot;
  }

  void make_circle(const Json& rule) {
    const auto count = rule.at("count").get<std::size_t>();
    require_room_for(count, "circle");
    const double radius = rule.value("radius", roomy_circle(count));
    const Vec2 centre = rule.value("centre", Vec2{});
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 2.0 * geometry::kPi * static_cast<double>(i) / static_cast<double>(count);
      const Vec2 out = radius * Vec2{std::cos(angle), std::sin(angle)};
      add(centre + out, centre - out);
    }
  }

  /// m: a circle on which neighbours leave a diameter of room between their rims.
  double roomy_circle(std::size_t count) const {
    constexpr double kApart = 4.0, kLeast = 10.0;  // radii of a robot, from centre to centre
    const double half_angle = geometry::kPi / static_cast<double>(count);
    const double needed = count < 2 ? 0.0 : 0.5 * kApart / std::sin(half_angle);
    return pattern_.radius * std::max(needed, kLeast);
  }

  void make_grid(const Json& rule) {
    const auto columns = rule.at("columns").get<std::uint64_t>(), rows = rule.at("rows").get<std::uint64_t>();
    require_room_for(columns * rows, "grid");
    const double spacing = rule.at("spacing").get<double>();
    const Vec2 corner = rule.value("corner", Vec2{}), way = rule.at("goal").get<Vec2>();
    for (std::uint64_t row = 0; row < rows; ++row)
      for (std::uint64_t column = 0; column < columns; ++column) {
        const Vec2 at = corner + spacing * Vec2{static_cast<double>(column), static_cast<double>(row)};
        add(at, at + way);
      }
  }

  void make_random(const Json& rule) {
    const auto count = rule.at("count").get<std::size_t>();
    require_room_for(count, "random");
    const auto seed = rule.value("seed", std::uint64_t{0});
    const double apart = rule.value("apart", 0.0);
    if (rule.contains("low") != rule.contains("high"))
      refuse(DataCode::scenario, "random", rule.contains("low") ? "low without high" : "high without low",
             "both corners of the box, or neither");
    const geometry::Box box = rule.contains("low")
                                  ? geometry::Box{rule.at("low").get<Vec2>(), rule.at("high").get<Vec2>()}
                                  : roomy_box(count, apart);
    const Vec2 low = box.low, high = box.high;
    const Vec2 goal_low = rule.value("goal_low", low), goal_high = rule.value("goal_high", high);
    FreeRoom starts(obstacles_, out_.robots, start_of, pattern_.radius, apart);
    FreeRoom ends(obstacles_, out_.robots, end_of, pattern_.radius, apart);
    for (std::size_t i = 0; i < count; ++i) {
      CounterRandom random(random_key(kStream, i, seed));
      const std::optional<Vec2> at = drawn(random, low, high, [&](Vec2 x) { return starts.is_free(x); });
      if (!at) refuse_narrow("place", i, count);
      const std::optional<Vec2> goal = drawn(random, goal_low, goal_high, [&](Vec2 x) { return ends.is_free(x); });
      if (!goal) refuse_narrow("goal", i, count);
      starts.take(*at);
      ends.take(*goal);
      add(*at, *goal);
    }
  }

  /// The box of all obstacles, widened about its middle where it is too small for so many robots: for each the room of
  /// nine squares about it, beside what polygons cover.
  geometry::Box roomy_box(std::size_t count, double apart) const {
    constexpr double kSquares = 9.0;
    const double side_of_one = 2.0 * pattern_.radius + apart;
    geometry::Box box;
    double needed = kSquares * static_cast<double>(count) * side_of_one * side_of_one;
    for (const formation::SceneObstacle& o : obstacles_) {
      for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
      if (const auto* polygon = std::get_if<geometry::Polygon>(&o.shape)) needed += area(*polygon);
    }
    if (box.is_empty()) box.add(Vec2{});
    const double side = std::sqrt(needed);
    const double more_x = 0.5 * std::max(0.0, side - box.width()), more_y = 0.5 * std::max(0.0, side - box.height());
    return {box.low - Vec2{more_x, more_y}, box.high + Vec2{more_x, more_y}};
  }

  template <class IsFree>
  static std::optional<Vec2> drawn(CounterRandom& random, Vec2 low, Vec2 high, const IsFree& is_free) {
    for (int k = 0; k < kDraws; ++k) {
      const double x = random.uniform(low.x, high.x), y = random.uniform(low.y, high.y);
      if (is_free(Vec2{x, y})) return Vec2{x, y};
    }
    return std::nullopt;
  }

  [[noreturn]] void refuse_narrow(const char* what, std::size_t have, std::size_t wanted) const {
    refuse(DataCode::scenario, "random",
           "a free " + std::string(what) + " for " + std::to_string(have) + " of " +
               geometry::counted(wanted, "robot") + ", none for the next in " + std::to_string(kDraws) + " draws",
           "a larger box, fewer or smaller robots, or fewer obstacles");
  }

  std::string text_of(const std::filesystem::path& path) const {
    try {
      return read_text_file(path);
    } catch (const DataError& error) {
      refuse(error.code(), "file", error.found() + " (" + path.string() + ")", error.expected());
    }
  }

  void read_table(const std::string& name) {
    const std::filesystem::path path = base_dir_ / name;
    const std::string text = text_of(path), shown = path.string();
    if (std::find(out_.tables.begin(), out_.tables.end(), path) == out_.tables.end()) out_.tables.push_back(path);
    CsvTable<LineReader> table(text, shown);
    table.read_header({"x", "y", "goal_x", "goal_y", "id", "vx", "vy", "radius", "max_speed", "heading"}, 4,
                      "a header with x, y, goal_x and goal_y, and where wanted id, vx, vy, radius, max_speed, heading");
    const auto refuse_column = [&](const char* name, bool has_no_use, const char* expected) {
      if (has_no_use && table.has(name)) table.refuse(DataCode::scenario, std::string("the column ") + name, expected);
    };
    refuse_column("max_speed", pattern_.drive.has_value(), "max_wheel_speed in kinematics alone, for robots on wheels");
    refuse_column("radius", pattern_.drive && !pattern_.drive->footprint.empty(), "the footprint alone");
    refuse_column("heading", !pattern_.drive, "none without \"kinematics\" of the type \"differential\"");
    const std::size_t before = out_.robots.size();
    while (table.next_row()) {
      require_room_for(1, "file");
      read_row(table);
    }
    if (out_.robots.size() == before)
      throw DataError(DataCode::wrong_count, shown, "", "a header without robots", "at least one robot");
  }

  void read_row(const CsvTable<LineReader>& table) {
    const auto number = [&](const char* name, double otherwise, double least, double most) {
      if (!table.has(name)) return otherwise;
      const double value = table.to_number(table.field(name));
      if (!(value >= least && value <= most))
        table.refuse(DataCode::out_of_range, std::string(name) + " " + table.field(name),
                     "a number from " + in_words(least) + " to " + in_words(most));
      return value;
    };
    const auto coordinate = [&](const char* name) { return number(name, 0.0, -kFarthest, kFarthest); };
    Robot& robot = add({coordinate("x"), coordinate("y")}, {coordinate("goal_x"), coordinate("goal_y")});
    robot.velocity = {number("vx", 0.0, -kLargest, kLargest), number("vy", 0.0, -kLargest, kLargest)};
    if (robot.drive) {  // the place is that of the axle, as for a single robot
      robot.drive->axle = {coordinate("x"), coordinate("y")};
      robot.drive->heading = number("heading", robot.drive->heading, -kLargest, kLargest);
      robot.drive->body_radius = number("radius", robot.drive->body_radius, 1e-300, kLargest);
      take_wheels(robot);
    } else {
      keep_within_tube(robot, number("radius", body_radius_of(robot), 1e-300, kLargest), tracking_);
      robot.max_speed = number("max_speed", robot.max_speed, 1e-300, kLargest);
    }
    if (!table.has("id")) return;
    if (table.field("id").empty()) table.refuse(DataCode::wrong_count, "an empty id", "at least 1 character");
    robot.id = table.field("id");
  }

  static std::string in_words(double bound) {
    if (bound == 1e-300) return "above 0";
    return (bound < 0.0 ? "-" : "") + std::string(std::fabs(bound) == kFarthest ? "1e9" : "1e6");
  }

  const std::vector<formation::SceneObstacle>& obstacles_;
  const std::string& file_;
  const std::filesystem::path& base_dir_;
  const double time_step_, tracking_;  ///< s, m
  std::optional<double> heading_;      ///< degrees, of all robots of the entry; else each looks towards its goal
  RobotList out_;
  std::size_t entry_ = 0, made_ = 0;
  std::string pointer_, prefix_;
  Robot pattern_;
};

}  // namespace

RobotList read_robots(const Json& list, const formation::Scenario& scenario, const std::string& file,
                      const std::filesystem::path& base_dir) {
  return RobotsReader(scenario, file, base_dir).read(list);
}

}  // namespace exactvo::datasets
