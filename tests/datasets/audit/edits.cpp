// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/edits.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <sstream>

#include "exactvo/datasets/provenance.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;
using formation::Robot;
using formation::Scenario;
using formation::SimulationOptions;
using geometry::Vec2;
using nlohmann::json;

// --- Runs ---

Robot robot(const std::string& id, Vec2 position, Vec2 goal) {
  Robot r;
  r.id = id;
  r.position = position;
  r.goals = {goal};
  return r;
}

geometry::Polygon box(Vec2 low, Vec2 high) {
  return {{low, {high.x, low.y}, high, {low.x, high.y}}, {}};
}

Lines recorded(const Scenario& scenario, const SimulationOptions& options) {
  RecordingFile file;
  file.scenario = scenario;
  file.info.scenario = scenario.name;
  file.info.method = name(options.method);
  if (scenario.formation) {
    file.info.controller = name(options.controller);
    file.info.integrator = name(options.integrator);
  }
  file.recording = formation::simulate(scenario, options);
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("exactvo_edits_" + std::to_string(::getpid()) + "_" + scenario.name + ".jsonl");
  write_recording(path, file);
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  std::filesystem::remove(path);
  std::istringstream in(text.str());
  Lines lines;
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

Scenario kinematic(const std::string& name) {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.name = name;
  s.time_step = 0.1;
  s.time_limit = 0.8;
  return s;
}

/// Two meet head-on beside a wall.
Scenario crossing() {
  Scenario s = kinematic("crossing");
  s.robots = {robot("a", {0.0, 0.1}, {8.0, 0.0}), robot("b", {1.9, -0.1}, {-4.0, 0.0})};
  s.obstacles = {{"wall", geometry::Polyline{{{0.9, 0.9}, {0.9, 3.0}, {2.0, 4.0}}}}};
  return s;
}

/// The same at speed: both have to brake, beside a post.
Scenario braking() {
  Scenario s = kinematic("braking");
  s.robots = {robot("a", {0.0, 0.1}, {8.0, 0.0}), robot("b", {3.4, -0.1}, {-4.0, 0.0})};
  for (Robot& r : s.robots) r.max_speed = 1.5;
  s.robots[0].velocity = {1.2, 0.0};
  s.robots[1].velocity = {-0.8, 0.1};
  s.obstacles = {{"post", box({1.4, 0.8}, {1.6, 1.2})}};
  s.acceleration = formation::Acceleration{2.0};
  return s;
}

/// Two on wheels, one after the other round a post; they turn on their way.
Scenario wheels() {
  Scenario s = kinematic("wheels");
  s.braking_time = 0.5;
  formation::DifferentialDrive drive;
  drive.wheel_separation = 0.16;
  drive.max_wheel_speed = 0.22;
  drive.max_wheel_acceleration = 1.0;
  drive.max_angular_speed = 2.5;
  drive.max_backward_speed = 0.1;
  drive.reference = 0.07;
  drive.body_radius = 0.1;
  s.robots = {robot("a", {}, {2.0, 0.3}), robot("b", {}, {-1.0, -0.1})};
  drive.heading = 70.0;
  put_on_wheels(s.robots[0], drive, s.time_step);
  drive.heading = 150.0;
  drive.axle = {0.52, 0.05};
  put_on_wheels(s.robots[1], drive, s.time_step);
  s.obstacles = {{"post", box({-0.3, 0.35}, {0.2, 0.45})}};
  return s;
}

/// Past the corner of a block, with two goals.
Scenario corner() {
  Scenario s = kinematic("corner");
  s.robots = {robot("a", {0.0, 0.0}, {1.0, 0.3})};
  s.robots[0].goals.push_back({6.0, 0.0});
  s.obstacles = {{"block", box({0.8, -2.0}, {2.0, -0.62})}, {"wall", geometry::Polyline{{{1.4, 0.9}, {1.4, 3.0}}}}};
  return s;
}

/// A cart comes along, turns and slows down.
Scenario cart() {
  Scenario s = kinematic("cart");
  s.robots = {robot("a", {0.0, 0.0}, {6.0, 0.0})};
  s.robots[0].velocity = {1.0, 0.0};
  s.moving_obstacles = {{"cart",
                         box({1.2, -1.4}, {1.8, -1.0}),
                         {{{0, 0}, {0, 0.5}, {0.3, 0.9}}, 1.0, {{0.0, 1.5}, {0.3, 1.5}, {0.3, 0.5}, {0.7, 1.0}}}}};
  return s;
}

/// Five robots meet at one place with a box as speed bound, so that choices are relaxed. The last robot does not
/// cooperate.
Scenario crowd() {
  Scenario s = kinematic("crowd");
  s.speed_bound = formation::SpeedBoundKind::box;
  s.time_limit = 0.5;
  for (int k = 0; k < 5; ++k) {
    const double angle = 1.2566 * k;
    const Vec2 out{std::cos(angle), std::sin(angle)};
    s.robots.push_back(robot("r" + std::to_string(k), 0.95 * out, -5.0 * out));
  }
  s.robots[4].cooperates = false;
  s.robots[4].goals[0] = {6.0, -5.0};
  s.obstacles = {{"post", box({-0.1, -2.0}, {0.1, -1.6})}};
  return s;
}

/// Two meet head-on where they cannot pass; they wait for each other, then one plan moves both.
Scenario passage() {
  Scenario s = kinematic("passage");
  s.guidance = formation::Guidance::route;
  s.liveness = formation::Liveness::plan;
  s.time_step = 0.15;
  s.time_limit = 4.5;
  s.robots = {robot("a", {-0.5, 0.0}, {2.5, 0.0}), robot("b", {0.5, 0.0}, {-2.5, 0.0})};
  for (Robot& r : s.robots) r.radius = 0.4;
  s.obstacles = {{"north", box({-1.5, 0.6}, {1.5, 1.0})}, {"south", box({-1.5, -1.0}, {1.5, -0.6})}};
  return s;
}

Scenario three(const std::string& name) {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.name = name;
  s.time_step = 0.02;
  s.time_limit = 0.16;
  s.robots = {robot("a", {0.0, 0.0}, {}), robot("b", {1.05, 0.0}, {}), robot("c", {0.0, 1.2}, {})};
  for (Robot& r : s.robots) {
    r.goals.clear();
    r.velocity = {1.0, 0.0};
  }
  s.formation.emplace();
  s.formation->topology = {{{0, 1, 1}, {1, 0, 0}, {1, 0, 0}}, {1, 1, 1}};
  s.formation->offsets = {{0, 0}, {1, 0}, {0, 1}};
  s.formation->leader = {{{{0.5, 0.5}, {0.6, 0.5}, {9, 3}}, 1.5}};
  s.obstacles = {{"post", box({1.62, -0.3}, {1.9, 0.2})}, {"wall", geometry::Polyline{{{-0.6, 2.0}, {-0.6, -2.0}}}}};
  return s;
}

/// Farther apart, for a controller that lets them come nearer.
Scenario apart() {
  Scenario s = three("apart");
  s.robots[1].position = {0.0, -1.6};
  s.robots[2].position = {0.0, 1.6};
  s.formation->offsets = {{0, 0}, {0, -1.6}, {0, 1.6}};
  return s;
}

Scenario with_cart(Scenario s) {
  s.moving_obstacles = {{"cart", box({-0.3, -0.9}, {0.3, -0.58}), {{{0, 0}, {4, 1}}, 1.0}}};
  return s;
}

Scenario guided(Scenario s) {
  s.guidance = formation::Guidance::route;
  s.name += "_guided";
  return s;
}

}  // namespace

std::vector<ShortRun> short_runs() {
  using formation::Controller;
  using formation::Integrator;
  using formation::Method;
  struct Case {
    Scenario scenario;
    Method method;
    bool all;
    Integrator integrator = Integrator::exact;
    Controller controller = Controller::standard;
  };
  const Case cases[] = {
      {crossing(), Method::ivo, false},
      {crossing(), Method::orca, true},
      {braking(), Method::ivo, false},
      {braking(), Method::orca, true},
      {wheels(), Method::ivo, false},
      {wheels(), Method::orca, true},
      {corner(), Method::ivo, true},
      {corner(), Method::orca, false},
      {corner(), Method::ivo_edge, false},
      {guided(corner()), Method::ivo, false},
      {passage(), Method::ivo, false},
      {cart(), Method::ivo, false},
      {cart(), Method::orca, true},
      {crowd(), Method::ivo, false},
      {three("three"), Method::ivo, false},
      {three("three"), Method::orca, true},
      {three("three"), Method::ivo, false, Integrator::euler},
      {with_cart(three("three_cart")), Method::ivo, false},
      {with_cart(three("three_cart")), Method::ivo, false, Integrator::rk4},
      {apart(), Method::ivo_edge, false, Integrator::exact, Controller::corrected},
  };
  std::vector<ShortRun> runs;
  for (const Case& c : cases) {
    SimulationOptions options;
    options.method = c.method;
    options.record_all = c.all;
    options.integrator = c.integrator;
    options.controller = c.controller;
    std::string title = c.scenario.name + " " + name(c.method);
    if (c.scenario.formation) title += std::string(" ") + name(c.integrator) + " " + name(c.controller);
    runs.push_back({title, c.scenario, recorded(c.scenario, options)});
  }
  return runs;
}

std::string sealed(const Lines& lines) {
  std::string text;
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) text += lines[k].dump() + "\n";
  json end = lines.back();
  if (end.is_object() && end.contains("end") && end["end"].is_object()) end["end"]["sha256"] = sha256_of(text);
  return text + end.dump() + "\n";
}

// --- Edits ---

namespace {

/// A value, and the way to it.
struct Place {
  json* value;
  json* parent;
  std::string field, place;
};

void gather(json& value, json* parent, const std::string& field, const std::string& place, std::vector<Place>& all) {
  all.push_back({&value, parent, field, place});
  if (value.is_object())
    for (auto& [key, member] : value.items())
      gather(member, &value, field.empty() ? key : field + "." + key, place + "/" + key, all);
  if (value.is_array())
    for (std::size_t k = 0; k < value.size(); ++k)
      gather(value[k], &value, field, place + "/" + std::to_string(k), all);
}

double another_number(double x, int how) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  switch (how) {
    case 0:
      return std::nextafter(x, kInfinity);
    case 1:
      return std::nextafter(x, -kInfinity);
    case 2:
      return x * (1.0 + 1e-12) + 1e-300;
    case 3:
      return x * (1.0 - 1e-6);
    case 4:
      return x + 0.05;
    case 5:
      return x - 0.3;
    case 6:
      return 1.5 * x;
    case 7:
      return -x;
    case 8:
      return 0.0;
    case 9:
      return 1e300;
    default:
      return x + 1e-9;
  }
}
constexpr const char* kNumberWords[] = {"an ulp up", "an ulp down", "a part in 1e12", "a part in 1e6",
                                        "+ 0.05",    "- 0.3",       "times 1.5",      "negated",
                                        "0",         "1e300",       "+ 1e-9"};

const std::vector<std::string>& other_words() {
  static const std::vector<std::string> words{
      "optimal",        "relaxed", "infeasible", "no-interior", "direct",   "boost",       "following", "pushing-out",
      "staying",        "arrived", "enclosure",  "robot",       "straight", "exponential", "hermite",   "exact",
      "euler",          "rk4",     "rk5",        "ivo",         "orca",     "default",     "corrected", "disc",
      "right",          "left",    "top",        "bottom",      "nan",      "inf",         "",          "obstacle-edge",
      "moving-obstacle"};
  return words;
}

std::size_t any(SeededRandom& random, std::size_t count) {
  return static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
}

std::string short_text(const json& value) {
  const std::string text = value.dump();
  return text.size() > 120 ? text.substr(0, 117) + "..." : text;
}

std::string change_leaf(json& value, SeededRandom& random, const std::vector<Place>& all) {
  if (value.is_boolean()) {
    value = !value.get<bool>();
    return "flipped";
  }
  if (value.is_string()) {
    value = other_words()[any(random, other_words().size())];
    return "another word";
  }
  if (value.is_number()) {
    const int how = random.integer(0, 11);
    if (how == 11) {
      for (int tries = 0; tries < 50; ++tries) {
        const json& other = *all[any(random, all.size())].value;
        if (!other.is_number() || other == value) continue;
        value = other;
        return "a number from elsewhere";
      }
    }
    if (value.is_number_integer() && how != 7 && how != 9) {
      value = value.get<std::int64_t>() + (how % 2 ? 1 : -1);
      return "one more or less";
    }
    value = another_number(value.get<double>(), std::min(how, 10));
    return kNumberWords[std::min(how, 10)];
  }
  value = 1;
  return "a number for nothing";
}

std::string change_list(json& list, SeededRandom& random) {
  const std::size_t k = any(random, list.size()), m = any(random, list.size());
  switch (random.integer(0, 2)) {
    case 0:
      list.erase(k);
      return "an entry less";
    case 1: {
      const json twice = list[k];
      list.insert(list.begin() + static_cast<std::ptrdiff_t>(k), twice);
      return "an entry twice";
    }
    default:
      std::swap(list[k], list[m]);
      return "entries swapped";
  }
}

Edit change_lines(Lines& lines, SeededRandom& random) {
  const std::size_t k = any(random, lines.size()), m = any(random, lines.size());
  const std::string kind = lines[k].begin().key();
  switch (random.integer(0, 2)) {
    case 0:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(k));
      return {kind + " (line)", "a line less", "line " + std::to_string(k)};
    case 1: {
      const json twice = lines[k];
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(k), twice);
      return {kind + " (line)", "a line twice", "line " + std::to_string(k)};
    }
    default:
      std::swap(lines[k], lines[m]);
      return {kind + " (line)", "lines swapped", "lines " + std::to_string(k) + " and " + std::to_string(m)};
  }
}

std::vector<json*> rows_of(Lines& lines) {
  std::vector<json*> rows;
  for (json& line : lines)
    if (line.contains("row")) rows.push_back(&line["row"]);
  return rows;
}

json moved_by(const json& point, Vec2 by) {
  return {point[0].get<double>() + by.x, point[1].get<double>() + by.y};
}

constexpr const char* kStatusWords[] = {"optimal", "relaxed", "infeasible", "no-interior"};

/// Edits of one who knows the format: what follows from the forged number is forged too.
Edit change_consistently(Lines& lines, SeededRandom& random) {
  const std::vector<json*> rows = rows_of(lines);
  const std::size_t k = any(random, rows.size() - 1);
  json& robots = (*rows[k])["robots"];
  const std::size_t i = any(random, robots.size());
  json& robot = robots[i];
  const double size = std::pow(10.0, random.uniform(-9.0, 0.0));
  const Vec2 by = size * random.direction();
  const std::string place = "row " + std::to_string(k) + " robot " + std::to_string(i);
  switch (random.integer(0, 6)) {
    case 0: {  // another choice, and the kinematic row after it
      robot["chosen"] = moved_by(robot["chosen"], by);
      json& next = (*rows[k + 1])["robots"][i];
      next["velocity"] = robot["chosen"];
      const double dt = lines.front()["header"]["time_step"].get<double>();
      for (int a = 0; a < 2; ++a)
        next["position"][a] = robot["position"][a].get<double>() + dt * robot["chosen"][a].get<double>();
      return {"(choice and what follows)", "changed", place};
    }
    case 1:  // what it prefers is what it chose, or the choice is what it prefers
      if (random.integer(0, 1)) {
        robot["preferred"] = robot["chosen"];
      } else {
        robot["chosen"] = robot["preferred"];
      }
      robot.erase("bound");
      for (json& c : robot.contains("constraints") ? robot["constraints"] : json::array()) {
        c["active"] = false;
        c.erase("multiplier");
      }
      return {"(choice without what binds)", "changed", place};
    case 2:  // a half-plane never was
      if (!robot.contains("constraints")) break;
      robot["constraints"].erase(any(random, robot["constraints"].size()));
      robot["preferred"] = robot["chosen"];
      robot.erase("bound");
      for (json& c : robot["constraints"]) {
        c["active"] = false;
        c.erase("multiplier");
      }
      return {"(half-plane and its push)", "left out", place};
    case 3:  // a body never was
      for (json& line : lines)
        if (line.contains("body") && line["body"].contains("shape") && random.integer(0, 1)) {
          json& shape = line["body"]["shape"];
          if (shape.contains("ellipse"))
            for (const char* key : {"l11", "l21", "l22"})
              shape["ellipse"][key] = shape["ellipse"][key].get<double>() * (1.0 - size);
          return {"(body made smaller)", "changed", "body " + line["body"]["number"].dump()};
        }
      break;
    case 4: {  // all choices of a robot are said to be of one kind
      const char* status = kStatusWords[any(random, std::size(kStatusWords))];
      for (json* row : rows) (*row)["robots"][i]["status"] = status;
      robot["chosen"] = moved_by(robot["chosen"], by);
      return {"(status of every row)", status, place};
    }
    case 5: {  // nothing is certified, and one half-plane gives more
      if (!robot.contains("constraints")) break;
      robot["uncertified"] = robot["constraints"].size();
      for (json& c : robot["constraints"]) c["certified"] = false;
      json& one = robot["constraints"][any(random, robot["constraints"].size())];
      one["offset"] = one["offset"].get<double>() - size;
      return {"(uncertified half-planes)", "changed", place};
    }
    default:  // everything before or after is another place
      for (json* row : rows) {
        json& r = (*row)["robots"][i];
        r["position"] = moved_by(r["position"], by);
        if (r.contains("anchor")) r["anchor"] = moved_by(r["anchor"], by);
      }
      return {"(a robot's whole way)", "moved", place};
  }
  robot["chosen"] = moved_by(robot["chosen"], by);
  return {"row.robots.chosen", "moved", place};
}

/// Edits of plans alone, which are few lines among many: another way that may be as good, or not.
Edit change_plan(json& plan, SeededRandom& random) {
  json& moves = plan["moves"];
  const std::size_t m = any(random, moves.size());
  const double size = std::pow(10.0, random.uniform(-12.0, 0.5));
  const std::string place = "move " + std::to_string(m);
  switch (random.integer(0, 5)) {
    case 0:
      moves[m]["to"] = moved_by(moves[m]["to"], size * random.direction());
      return {"plan.moves.to", "moved", place};
    case 1:
      moves.erase(m);
      return {"plan.moves", "an entry less", place};
    case 2:
      std::swap(moves[m], moves[any(random, moves.size())]);
      return {"plan.moves", "entries swapped", place};
    case 3:
      moves[m]["robot"] = 1 - moves[m]["robot"].get<int>();
      return {"plan.moves.robot", "the other", place};
    case 4: {
      json& start = plan["robots"][any(random, plan["robots"].size())]["start"];
      start = moved_by(start, size * random.direction());
      return {"plan.robots.start", "moved", place};
    }
    default: {
      json& row = plan[random.integer(0, 1) ? "row" : "from_row"];
      row = row.get<int>() + random.integer(-2, 2);
      return {"plan.row, plan.from_row", "others", place};
    }
  }
}

Edit change_anything(Lines& lines, SeededRandom& random) {
  const std::size_t line = any(random, lines.size());
  std::vector<Place> all;
  gather(lines[line], nullptr, "", "line " + std::to_string(line), all);
  const Place& at = all[any(random, all.size())];
  Edit edit{at.field, "", at.place + ": " + short_text(*at.value)};
  if (at.parent && at.parent->is_object() && random.integer(0, 7) == 0) {
    edit.how = "left out";
    const std::string key = at.place.substr(at.place.rfind('/') + 1);
    at.parent->erase(key);
    return edit;
  }
  if (at.value->is_array() && !at.value->empty()) {
    edit.how = change_list(*at.value, random);
  } else if (at.value->is_structured()) {
    edit.how = "emptied";
    at.value->clear();
  } else {
    edit.how = change_leaf(*at.value, random, all);
  }
  edit.place += " -> " + short_text(*at.value);
  return edit;
}

}  // namespace

Edit edit(Lines& lines, SeededRandom& random) {
  const int kind = random.integer(0, 19);
  const auto plan = std::find_if(lines.begin(), lines.end(), [](const json& line) { return line.contains("plan"); });
  const bool in_plan = plan != lines.end() && random.integer(0, 1);
  Edit done = in_plan     ? change_plan((*plan)["plan"], random)
              : kind == 0 ? change_lines(lines, random)
              : kind < 4  ? change_consistently(lines, random)
                          : change_anything(lines, random);
  std::size_t rows = 0;
  for (const json& line : lines) rows += line.is_object() && line.contains("row");
  if (!lines.empty() && lines.back().is_object() && lines.back().contains("end") && lines.back()["end"].is_object() &&
      done.field != "end.rows")
    lines.back()["end"]["rows"] = rows;
  return done;
}

}  // namespace exactvo::datasets::test
