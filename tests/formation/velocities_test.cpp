// SPDX-License-Identifier: GPL-3.0-or-later
// Every scene that comes with the project, under every method and controller, drives the bits that are recorded in
// golden_velocities.txt: one line per run, "scene method controller digest". Record anew (EXACTVO_RECORD_GOLDEN=FILE)
// only for a change that is meant to move robots, or that is known to move them by rounding alone: the commit says
// which.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "exactvo/datasets/provenance.h"
#include "paper_scenes.h"
#include "support/c_library.h"

namespace exactvo::formation {
namespace {

using test::append_bits;

/// SHA-256 over the bits of every state and chosen velocity.
std::string fingerprint(const Recording& recording) {
  std::string bytes;
  for (const Step& row : recording.steps)
    for (const RobotStep& r : row.robots)
      for (const Vec2 v : {r.position, r.velocity, r.chosen}) {
        append_bits(bytes, v.x);
        append_bits(bytes, v.y);
      }
  return datasets::sha256_of(bytes);
}

Scenario scene(const std::string& name) {
  const std::string data = std::string(EXACTVO_SOURCE_DIR) + "/datasets/data/";
  if (name == "office") return datasets::load_scenario(data + "office/office.json");
  if (name == "hundred") return datasets::load_scenario(data + "formation/hundred.json");
  if (name == "room") return datasets::load_scenario(data + "room/room.json");
  return test::paper_scene(name);
}

std::vector<std::string> scenes() {
  std::vector<std::string> names{"A0"};
  for (int k = 1; k <= 15; ++k) names.push_back("A" + std::to_string(k));
  for (int k = 0; k <= 3; ++k) names.push_back("B" + std::to_string(k));
  for (const char* name : {"room", "office", "hundred"}) names.push_back(name);
  return names;
}

constexpr Method kMethods[] = {Method::orca, Method::ivo_edge, Method::ivo_cluster, Method::ivo};
constexpr Controller kControllers[] = {Controller::paper_literal, Controller::paper_signs, Controller::corrected,
                                       Controller::standard};

/// The runs of a scene: every method, of robots with goals along routes ("ivo+route") and with liveness too, and of a
/// formation every controller with the default method.
std::map<std::string, SimulationOptions> runs_of(const Scenario& s) {
  std::map<std::string, SimulationOptions> runs;
  const auto add = [&](const SimulationOptions& o) {
    runs[std::string(name(o.method)) + " " + name(o.controller)] = o;
  };
  for (const Method method : kMethods) {
    SimulationOptions options = test::with_method(method);
    options.guidance = Guidance::none;
    options.liveness = Liveness::off;
    add(options);
    if (s.formation || method == Method::ivo_edge) continue;
    options.guidance = Guidance::route;
    runs[std::string(name(method)) + "+route " + name(options.controller)] = options;
    options.liveness = Liveness::bias;
    runs[std::string(name(method)) + "+route+bias " + name(options.controller)] = options;
  }
  if (!s.formation || s.robots.size() > 10) return runs;
  for (const Controller controller : kControllers) add(test::with_controller(controller));
  return runs;
}

std::map<std::string, std::string> golden() {
  std::map<std::string, std::string> known;
  std::ifstream in(std::string(EXACTVO_SOURCE_DIR) + "/tests/formation/golden_velocities.txt");
  std::string where, method, controller, digest;
  while (in >> where >> method >> controller >> digest) known[where + " " + method + " " + controller] = digest;
  return known;
}

class Velocities : public testing::TestWithParam<std::string> {};

TEST_P(Velocities, AreTheRecordedBits) {
  if (!test::c_library_is_the_recorded_one()) GTEST_SKIP() << "another C library rounds otherwise";
  const std::map<std::string, std::string> known = golden();
  const Scenario s = scene(GetParam());
  for (const auto& [what, options] : runs_of(s)) {
    const std::string key = GetParam() + " " + what;
    const std::string digest = fingerprint(simulate(s, options));
    if (const char* file = std::getenv("EXACTVO_RECORD_GOLDEN")) {
      std::ofstream(file, std::ios::app) << key << " " << digest << "\n";
      continue;
    }
    const auto found = known.find(key);
    ASSERT_NE(found, known.end()) << key << " " << digest;
    EXPECT_EQ(found->second, digest) << key;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Velocities, testing::ValuesIn(scenes()), [](const auto& row) { return row.param; });

}  // namespace
}  // namespace exactvo::formation
