// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of `exactvo serve` asks, and its answers; http_server.cpp carries both.
#include "explorer/server.h"

#include <fmt/format.h>

#include <time.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/scenario_at.h"
#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/vo/free_velocities.h"
#include "exactvo/vo/lp/certificate.h"
#include "explorer/packed_run.h"
#include "explorer/page.h"
#include "modules/load.h"
#include "support/run.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

using datasets::DataCode;
using datasets::DataError;
using formation::DecisionConstraint;
using formation::RobotStep;
using geometry::norm;
using geometry::Vec2;
using Json = nlohmann::json;

namespace {

constexpr const char* kQuestion = "question";  // in the place of a file's name
constexpr int kDeepest = 64;                   // levels of JSON: what is printed again must not exhaust the stack
constexpr double kLatest = 1e9;                // s
constexpr double kFastest = 1e6;               // m/s

[[noreturn]] void refuse(DataCode code, const std::string& place, const std::string& found,
                         const std::string& expected) {
  throw DataError(code, kQuestion, place, found, expected);
}

// --- What moves by itself, at a later time ---

formation::TimedPath advanced(const formation::TimedPath& motion, double time) {
  double left = motion.profile.empty() ? motion.speed * time : formation::distance_at(motion.profile, time);
  std::size_t k = 0;
  while (k + 1 < motion.path.size() && left >= norm(motion.path[k + 1] - motion.path[k]))
    left -= norm(motion.path[k + 1] - motion.path[k]), ++k;
  formation::TimedPath rest{{motion.path[k]}, motion.speed, {}};
  if (k + 1 < motion.path.size()) {
    const Vec2 leg = motion.path[k + 1] - motion.path[k];
    rest.path.front() += (left / norm(leg)) * leg;
  }
  rest.path.insert(rest.path.end(), motion.path.begin() + static_cast<std::ptrdiff_t>(k) + 1, motion.path.end());
  if (!motion.profile.empty()) rest.profile.push_back({0.0, formation::speed_at(motion.profile, time)});
  for (const formation::SpeedKnot& knot : motion.profile)
    if (knot.time > time) rest.profile.push_back({knot.time - time, knot.speed});
  return rest;
}

void advance(formation::Scenario& scenario, double time) {
  if (time == 0.0) return;
  for (formation::MovingObstacle& obstacle : scenario.moving_obstacles) {
    const Vec2 before = obstacle.motion.path.front();
    obstacle.motion = advanced(obstacle.motion, time);
    const Vec2 by = obstacle.motion.path.front() - before;
    if (obstacle.disc) {
      const std::optional<double> max_speed = obstacle.max_speed;
      obstacle = formation::moving_disc(obstacle.id, {obstacle.disc->center + by, obstacle.disc->radius},
                                        std::move(obstacle.motion));
      obstacle.max_speed = max_speed;
    } else
      geometry::shift(obstacle.shape, by);
  }
  if (scenario.formation) scenario.formation->leader = {advanced(scenario.formation->leader, time)};
}

// --- Questions ---

Json parsed(const std::string& text) {
  const auto check_depth = [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest)
      refuse(DataCode::nesting, "", "deeper nesting", "at most " + std::to_string(kDeepest) + " levels");
    return true;
  };
  try {
    return Json::parse(text, check_depth);
  } catch (const Json::exception& e) {
    refuse(DataCode::json_syntax, "", e.what(), "JSON");
  }
}

const Json& member(const Json& object, const char* key, bool (Json::*is_right)() const noexcept, const char* expected) {
  const auto found = object.find(key);
  if (found == object.end()) refuse(DataCode::key_missing, "", "nothing", std::string("the key ") + key);
  if (!((*found).*is_right)()) refuse(DataCode::wrong_type, std::string("/") + key, found->type_name(), expected);
  return *found;
}

/// Entries by themselves: no generator of many robots, and no file.
void check_entries(const Json& scenario, const char* list, std::initializer_list<const char*> allowed) {
  const auto check = [&](const Json& entry, const std::string& pointer) {
    if (!entry.is_object()) return;  // the schema says so
    for (const auto& [key, value] : entry.items())
      if (std::find(allowed.begin(), allowed.end(), key) == allowed.end())
        refuse(key == "file" ? DataCode::path_escape : DataCode::key_unknown, pointer, "the key '" + key + "'",
               "an entry by itself: a page names neither files nor generators");
  };
  const auto found = scenario.find(list);
  if (found == scenario.end()) return;
  const std::string pointer = std::string("/scenario/") + list;
  check(*found, pointer);  // an entry may stand in the place of the list
  for (std::size_t k = 0; found->is_array() && k < found->size(); ++k)
    check((*found)[k], pointer + "/" + std::to_string(k));
}

/// At the moment that is asked about: what moves has come to where it is then before robots are held against it.
formation::Scenario scenario_in(const Json& question, double time) {
  const Json& scenario = member(question, "scenario", &Json::is_object, "a scenario");
  check_entries(scenario, "robots",
                {"id", "position", "velocity", "radius", "max_speed", "goal", "goals", "cooperates"});
  check_entries(scenario, "obstacles", {"id", "polyline", "polygon", "holes", "disc"});
  check_entries(scenario, "moving_obstacles",
                {"id", "polyline", "polygon", "holes", "disc", "path", "speed", "profile", "max_speed"});
  const auto robots = scenario.find("robots");
  if (robots != scenario.end() && robots->size() > kMostLiveRobots)
    refuse(DataCode::size, "/scenario/robots", std::to_string(robots->size()) + " robots",
           "at most " + std::to_string(kMostLiveRobots) + " to compute with");
  return datasets::parse_scenario_at(scenario.dump(-1, ' ', false, Json::error_handler_t::replace), kQuestion,
                                     std::filesystem::path(), [&](formation::Scenario& read) { advance(read, time); });
}

double bounded_number(const Json& value, const std::string& place, double least, double most, const char* expected) {
  if (!value.is_number()) refuse(DataCode::wrong_type, place, value.type_name(), expected);
  const double number = value.get<double>();
  if (!(number >= least && number <= most)) refuse(DataCode::out_of_range, place, value.dump(), expected);
  return number;
}

std::optional<std::size_t> robot_in(const Json& question, const char* key, std::size_t count) {
  const auto found = question.find(key);
  if (found == question.end()) return std::nullopt;
  const std::string place = std::string("/") + key;
  constexpr const char* kExpected = "the index of a robot of the scenario";
  const double index = bounded_number(*found, place, 0.0, static_cast<double>(count) - 1.0, kExpected);
  if (index != std::floor(index)) refuse(DataCode::out_of_range, place, found->dump(), kExpected);
  return static_cast<std::size_t>(index);
}

std::optional<Vec2> preferred_in(const Json& question) {
  const auto found = question.find("preferred");
  if (found == question.end() || found->is_null()) return std::nullopt;
  if (!found->is_array() || found->size() != 2)
    refuse(DataCode::wrong_type, "/preferred", found->type_name(), "[x, y] in m/s, or null");
  const char* expected = "a number of m/s, at most 10^6 in size";
  return Vec2{bounded_number((*found)[0], "/preferred/0", -kFastest, kFastest, expected),
              bounded_number((*found)[1], "/preferred/1", -kFastest, kFastest, expected)};
}

// --- Decisions ---

/// The best of what the step's half-planes allow for another preferred velocity, with its multipliers: what the
/// simulation does with a decision, for half-planes that are there already. They do not depend on the preference.
void choose_anew(const formation::Scenario& scenario, double max_speed, Vec2 preferred, RobotStep& step) {
  lp::Problem problem;
  problem.preferred = preferred;
  if (scenario.speed_bound == formation::SpeedBoundKind::disc) {
    problem.bound.disc = max_speed;
  } else {
    problem.bound.box_x = problem.bound.box_y = max_speed;
  }
  problem.constraints = problem_of(step, step.constraints);
  const lp::Proven proven = lp::solve_certified(problem);
  const lp::Solution& solution = proven.solution;
  step.preferred = preferred;
  step.chosen = solution.velocity;
  step.status = solution.status;
  step.violation = solution.violation;
  step.exact_multipliers = proven.exact_stage && solution.status != lp::Status::no_interior &&
                           lp::check(problem, lp::claim_of(problem, solution)) != lp::CertificateError::none;
  step.bound.clear();
  const auto bind = [](auto& c, std::optional<double> multiplier) {
    c.active = multiplier.has_value();
    c.multiplier = multiplier.value_or(0.0);
  };
  for (DecisionConstraint& c : step.constraints) bind(c, std::nullopt);
  for (formation::OwnConstraint& c : step.own) bind(c, std::nullopt);
  for (std::size_t n = 0; n < solution.active_count; ++n) {
    lp::ActiveConstraint active = solution.active[n];
    if (step.exact_multipliers) active.multiplier = 0.0;
    if (lp::is_speed_bound(active.binding)) {
      step.bound.push_back(active);
    } else {
      const std::size_t k = active.binding.index, against_bodies = step.constraints.size();
      if (k < against_bodies)
        bind(step.constraints[k], active.multiplier);
      else
        bind(step.own[k - against_bodies], active.multiplier);
    }
  }
}

/// What an answer has of robots that were not asked about: the robots they wait for, and their halves of pairs with the
/// robot that was, which its proofs need. All 50 half-planes of 51 robots would take most of an answer's
/// time to pack.
void keep_what_is_shown(std::size_t robot, formation::Step& row) {
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    if (i == robot) continue;
    const Vec2 preferred = row.robots[i].preferred;
    const auto is_not_shown = [&](const DecisionConstraint& c) {
      const bool holds_it = c.active || geometry::violation(c.half_plane, preferred) > 0.0;
      return !holds_it && (c.source != vo::BodyKind::robot || c.index != robot);
    };
    std::vector<DecisionConstraint>& all = row.robots[i].constraints;
    all.erase(std::remove_if(all.begin(), all.end(), is_not_shown), all.end());
  }
}

/// The first row of a run, its decisions with the preferred velocity that was asked for, and the row after it.
formation::Recording moment_of(const LiveQuestion& question) {
  formation::SimulationOptions options = question.options;
  options.record_all = true;
  options.stop_at = 0.0;
  const std::size_t changed = question.preferred_robot;
  // Among movers half-planes depend on how soon the robot is to stand, which the preference decides.
  const bool steers = question.preferred && meets_movers(question.scenario);
  if (steers)
    options.steering = [&](const formation::RobotSlice&, std::vector<Vec2>& all) {
      all[changed] = *question.preferred;
    };
  formation::Recording moment = formation::simulate(question.scenario, options);
  if (question.preferred && !steers)
    choose_anew(question.scenario, question.scenario.robots[changed].max_speed, *question.preferred,
                moment.steps.front().robots[changed]);
  for (formation::Step& row : moment.steps) keep_what_is_shown(question.robot, row);
  return moment;
}

const datasets::Provenance& provenance() {
  static const datasets::Provenance made = datasets::make_provenance({}, 0);
  return made;
}

Json json(const geometry::Bracket& b) {
  return {b.low, b.high};
}

/// The velocity obstacles that the robot's half-planes exclude.
std::vector<vo::ShiftedCone> cones_of(const LiveQuestion& question, const formation::Recording& moment) {
  std::vector<vo::ShiftedCone> cones;
  const formation::Step& row = moment.steps.front();
  for (const DecisionConstraint& c : row.robots[question.robot].constraints) {
    const formation::SeenBody seen = formation::seen_body(question.scenario, moment.bodies, row, question.robot, c);
    cones.push_back({vo::VelocityObstacle(seen.shape, seen.position, seen.radius, c.time_horizon),
                     {{-seen.velocity}},
                     seen.velocity});
  }
  return cones;
}

std::vector<geometry::HalfPlane> half_planes_of(const RobotStep& step) {
  std::vector<geometry::HalfPlane> all;
  for (const DecisionConstraint& c : step.constraints) all.push_back(c.half_plane);
  return all;
}

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kToRun{60};  // of a run on from a moment

/// A run on from a moment gives way to the next one that is asked for.
struct GivesWay : std::runtime_error {
  GivesWay() : std::runtime_error("another run was asked for") {}
};

class RunQueue {
 public:
  std::string run(const LiveQuestion& question) {
    const unsigned mine = ++latest_;
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    const Clock::time_point until = Clock::now() + kToRun;
    return live_run(question, [&] {
      if (mine != latest_) throw GivesWay();
      if (Clock::now() > until)
        throw std::runtime_error(
            fmt::format("the run takes more than {} s: simulate it with exactvo simulate", kToRun.count()));
    });
  }

 private:
  std::atomic<unsigned> latest_{0};
  std::mutex mutex_;
};

/// s of this thread, which another process does not lengthen.
double processor_time() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

using AnswerOfPage = std::function<std::string(const LiveQuestion&)>;

/// JSON for the page.
HttpAnswer refusal(int status, const char* why, nlohmann::json more = nlohmann::json::object()) {
  more["error"] = why;
  return {status, more.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), "application/json", ""};
}

HttpAnswer answer_untimed(const std::string& body, const OptionsOfRun& options_of, const char* type,
                          const AnswerOfPage& answer_of) {
  try {
    return {200, answer_of(parse_live_question(body, options_of)), type, ""};
  } catch (const datasets::DataError& error) {
    return refusal(400, error.what(),
                   {{"code", code_name(error.code())},
                    {"place", error.place()},
                    {"found", error.found()},
                    {"expected", error.expected()}});
  } catch (const GivesWay& error) {
    return refusal(409, error.what());
  } catch (const Interrupted&) {
    return refusal(503, "the server was stopped");
  } catch (const std::bad_alloc&) {
    return refusal(503, "more memory wanted than there is");
  } catch (const std::exception& error) {
    return refusal(500, error.what());
  }
}

HttpAnswer answer(const std::string& body, const OptionsOfRun& options_of, const char* type,
                  const AnswerOfPage& answer_of) {
  const Clock::time_point begin = Clock::now();
  const double processor_begin = processor_time();
  HttpAnswer answer = answer_untimed(body, options_of, type, answer_of);
  const std::chrono::duration<double, std::milli> took = Clock::now() - begin;
  answer.timing =
      fmt::format("compute;dur={:.2f}, processor;dur={:.2f}", took.count(), 1e3 * (processor_time() - processor_begin));
  return answer;
}

constexpr const char* kConnectNothing = "default-src 'none';";
constexpr const char* kConnectSelf = "default-src 'none'; connect-src 'self';";

/// The page's own policy as a header too, where it can also forbid other pages to frame it.
std::string policy() {
  return std::string(kConnectSelf) +
         " script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; media-src blob:; base-uri "
         "'none'; "
         "form-action 'none'; frame-ancestors 'none'";
}

}  // namespace

std::string page_for_server(std::string page) {
  const std::size_t at = page.find(kConnectNothing);
  if (at == std::string::npos) throw std::logic_error("the page has no policy to widen");
  page.replace(at, std::string(kConnectNothing).size(), kConnectSelf);
  const std::size_t body = page.find("<body>");
  if (body == std::string::npos) throw std::logic_error("the page has no body");
  return page.insert(body + std::string("<body>").size(), std::string("\n<script>\n") + kServedScript + "</script>");
}

void serve(HttpSite site, const OptionsOfRun& options_of) {
  RunQueue runs;
  const auto question = [&](const char* path, const char* type, AnswerOfPage answer_of) {
    return HttpQuestion{path, [&options_of, type, answer_of = std::move(answer_of)](const std::string& body) {
                          return answer(body, options_of, type, answer_of);
                        }};
  };
  const char* const packed = "application/octet-stream";
  site.policy = policy();
  site.questions = {question("decide", packed, live_decision),
                    question("free", "application/json", live_free_velocities),
                    question("run", packed, [&](const LiveQuestion& asked) { return runs.run(asked); })};
  site.is_interrupted = interrupted;
  const auto serve_http =
      *static_cast<const ServeHttp*>(datasets::load_module("http", "the server of the page (cpp-httplib)"));
  if (!serve_http(site))
    throw UsageError("--port", std::to_string(site.port), "a port of 127.0.0.1 that is free [E_PORT]");
}

LiveQuestion parse_live_question(const std::string& text, const OptionsOfRun& options_of) {
  const Json question = parsed(text);
  if (!question.is_object()) refuse(DataCode::wrong_type, "", question.type_name(), "an object");
  LiveQuestion asked;
  const std::string key = member(question, "run", &Json::is_string, "the key of a run").get<std::string>();
  const std::optional<formation::SimulationOptions> options = options_of(key);
  if (!options) refuse(DataCode::not_an_option, "/run", "'" + key + "'", "the key of a run of the page");
  asked.options = *options;
  if (const auto method = question.find("method"); method != question.end() && !method->is_null()) {
    if (!method->is_string() || !formation::parse(method->get<std::string>(), asked.options.method))
      refuse(DataCode::not_an_option, "/method", method->dump(-1, ' ', true, Json::error_handler_t::replace),
             "the name of a method");
  }
  const double time = question.contains("time")
                          ? bounded_number(question["time"], "/time", 0.0, kLatest, "seconds from 0 to 10^9")
                          : 0.0;
  asked.scenario = scenario_in(question, time);
  const std::size_t count = asked.scenario.robots.size();
  asked.robot = robot_in(question, "robot", count).value_or(0);
  asked.preferred = preferred_in(question);
  asked.preferred_robot = robot_in(question, "preferred_robot", count).value_or(asked.robot);
  return asked;
}

std::string live_decision(const LiveQuestion& question) {
  datasets::RecordingFile about;
  about.info = datasets::run_info(question.scenario, question.options, provenance());
  about.info.integrator.reset();  // it moves nothing here
  about.scenario = question.scenario;
  about.recording = moment_of(question);
  return packed_run(about, "");
}

std::string live_free_velocities(const LiveQuestion& question) {
  constexpr double kOfSpeed = 1e-3;  // how far polygons may stray from the curves: quick, and what a picture shows
  const double max_speed = question.scenario.robots[question.robot].max_speed;
  if (question.scenario.speed_bound != formation::SpeedBoundKind::disc)
    return Json{{"why_not", "the speed bound is a box, and free velocities are counted within a disc"}}.dump();
  const formation::Recording moment = moment_of(question);
  const RobotStep& step = moment.steps.front().robots[question.robot];
  std::vector<vo::ShiftedCone> cones = cones_of(question, moment);
  const bool overlaps = std::any_of(cones.begin(), cones.end(), [](const auto& c) { return c.cone.overlaps(); });
  if (overlaps) return Json{{"why_not", "the robot touches or overlaps what it must avoid: no cone exists"}}.dump();
  const vo::FreeVelocities free(std::move(cones), {max_speed, kOfSpeed});
  const vo::RegionReport report = free.compare(half_planes_of(step));
  return Json{{"free", json(free.area())},
              {"allowed", json(report.area)},
              {"given_away", json(report.given_away)},
              {"inside", name(report.inside)}}
      .dump();
}

std::string live_run(const LiveQuestion& question, const std::function<void()>& goes_on) {
  formation::SimulationOptions options = question.options;
  options.record_all = true;
  PackedRunLimits limits;
  limits.has_scenario = true;
  RunOutput output = for_page(limits);
  output.progress = [&](double) { goes_on(); };
  return run(question.scenario, options, provenance(), output).packed;
}

}  // namespace exactvo::tools
