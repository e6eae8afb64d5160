// SPDX-License-Identifier: GPL-3.0-or-later
#include "suites.h"

#include <cstdio>
#include <stdexcept>
#include <utility>

#include "exactvo/datasets/scenario_file.h"
#include "formation/liveness_scenes.h"
#include "maps.h"

namespace exactvo::bench {
namespace {

using formation::Scenario;
using geometry::Vec2;
using test::SeededRandom;
namespace scenes = formation::test_scenes;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

class Scenes {
 public:
  Scenes(std::string suite, const Draws& draws) : suite_(std::move(suite)), draws_(draws) {}

  void add(const std::string& name, std::function<Scenario()> make) {
    all_.push_back({suite_, name, 1, Success::all_arrive, std::move(make)});
  }
  /// `make` takes a SeededRandom.
  template <class Make>
  void add_seeds(const std::string& name, std::uint64_t seeds, const Make& make,
                 Success success = Success::all_arrive) {
    const std::uint64_t end = draws_.first + draws_.count.value_or(seeds);
    for (std::uint64_t seed = draws_.first; seed < end; ++seed)
      all_.push_back({suite_, name, seed, success, [seed, make] {
                        SeededRandom random(seed);
                        return make(random);
                      }});
  }
  std::vector<Scene> all() && { return std::move(all_); }

 private:
  std::string suite_;
  Draws draws_;
  std::vector<Scene> all_;
};

void add_circles(Scenes& suite, bool full) {
  std::vector<int> counts{2, 4, 12};
  if (full) {
    counts.clear();
    for (int count = 2; count <= 30; ++count) counts.push_back(count);
    counts.push_back(250);
  }
  for (const int count : counts) suite.add(std::to_string(count), [count] { return scenes::circle(count); });
}

void add_streets(Scenes& suite, bool full) {
  std::vector<std::pair<int, double>> streets{{14, 3}};
  if (full) streets = {{14, 3}, {14, 4}, {18, 4}, {60, 4}, {60, 6}, {100, 6}};
  for (const auto& [robots, width] : streets)
    suite.add(std::to_string(robots) + " in " + number(width),
              [count = robots, wide = width] { return scenes::street(count, wide); });
}

void add_boxes(Scenes& suite, bool full) {
  const int robots = full ? 50 : 20;
  for (const double percent : full ? std::vector<double>{20, 30, 40, 50} : std::vector<double>{20})
    suite.add_seeds(std::to_string(robots) + " on " + number(percent) + " %", full ? 5 : 1,
                    [=](SeededRandom& random) { return scenes::crowded_box(robots, percent, random); });
}

void add_doors(Scenes& suite, bool full) {
  const int robots = full ? 20 : 8;
  for (const double width : full ? std::vector<double>{1.2, 1.5, 2.5} : std::vector<double>{1.5})
    suite.add_seeds(std::to_string(robots) + " through " + number(width), full ? 5 : 1,
                    [=](SeededRandom& random) { return scenes::door(robots, width, random); });
  if (full) suite.add_seeds("40 through 1.5", 5, [](SeededRandom& random) { return scenes::door(40, 1.5, random); });
}

void add_swaps(Scenes& suite, bool full) {
  if (!full) return suite.add("siding", scenes::siding);
  suite.add("siding", scenes::siding);
  for (const int robots : {10, 20})
    suite.add_seeds(std::to_string(robots) + " by a corridor of 1.4", 5,
                    [=](SeededRandom& random) { return scenes::rooms(robots, 1.4, random); });
}

/// SMGLib's doorway, hallway and intersection (CRAL-UVA/SMGLib, `StandardizedEnvironment`): 2 robots of radius 0.3 m at
/// 1 m/s in a room of 12 by 16 m; walls as lines.
Scenario social(const std::string& kind) {
  constexpr double kX = 6.0, kY = 8.0, kHalf = 2.0;
  Scenario s;
  s.name = kind;
  scenes::add_box(s, kX, kY);
  if (kind == "doorway") {
    for (const double side : {-1.0, 1.0}) scenes::add_wall(s, {{0.0, side * kY}, {0.0, side * kHalf}});
    scenes::add_robot(s, {-3.0, -0.5}, {3.0, 0.5});
    scenes::add_robot(s, {3.0, 0.5}, {-3.0, -0.5});
  } else if (kind == "hallway") {
    for (const double y : {-kHalf, kHalf}) scenes::add_wall(s, {{-kX, y}, {kX, y}});
    scenes::add_robot(s, {-4.0, -0.3}, {4.0, 0.3});
    scenes::add_robot(s, {4.0, 0.3}, {-4.0, -0.3});
  } else {
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        scenes::add_wall(s, {{x * kX, y * kHalf}, {x * kHalf, y * kHalf}, {x * kHalf, y * kY}});
    scenes::add_robot(s, {-4.0, -0.5}, {4.0, 0.5});
    scenes::add_robot(s, {-0.5, -4.0}, {0.5, 4.0});
  }
  for (formation::Robot& r : s.robots) {
    r.radius = 0.3;
    r.max_speed = 1.0;
  }
  return s;
}

void add_narrow(Scenes& suite, bool full) {
  for (const char* kind : {"doorway", "hallway", "intersection"}) suite.add(kind, [kind] { return social(kind); });
  if (!full) return;
  for (const double gap : {1.05, 1.5, 2.0, 2.5})
    suite.add_seeds("6 through " + number(gap), 3, [=](SeededRandom& random) { return scenes::door(6, gap, random); });
}

/// Scenarios of Section V.A, as files have them but for guidance and liveness, which are the arena's.
void add_papers(Scenes& suite, bool full) {
  for (int k = 1; k <= (full ? 15 : 2); ++k) {
    const std::string name = "A" + std::to_string(k);
    suite.add(name, [name] {
      Scenario s = datasets::load_scenario(EXACTVO_SOURCE_DIR "/datasets/data/paper/" + name + ".json");
      s.guidance = formation::Guidance::route;
      s.liveness = formation::Liveness::plan;
      return s;
    });
  }
}

void add_crosses(Scenes& suite, bool full) {
  suite.add_seeds("margin 0 to 0.25 m", full ? 250 : 2, scenes::cross_with_any_margin, Success::nobody_stands);
}

void add_maps(Scenes& suite, bool full) {
  const int robots = full ? 50 : 6;
  const std::string count = std::to_string(robots) + " on ";
  suite.add_seeds(count + "gap", full ? 10 : 1, [=](SeededRandom& random) { return gap_map(robots, random); });
  suite.add_seeds(count + "rooms", full ? 10 : 1, [=](SeededRandom& random) { return room_map(robots, random); });
}

struct SuiteEntry {
  SuiteInfo info;
  void (*add)(Scenes&, bool full);
};

const std::vector<SuiteEntry>& entries() {
  static const std::vector<SuiteEntry> all{
      {{"circle", "Robots on a circle go to the opposite places; exactly symmetric, 3 diameters apart."}, add_circles},
      {{"street", "Half of the robots from each end of a street; N in a width, in diameters."}, add_streets},
      {{"swap", "Two head-on in a corridor with a niche; two rooms that exchange their robots through a corridor."},
       add_swaps},
      {{"door", "Two rooms that exchange their robots through a door; width in diameters."}, add_doors},
      {{"box", "A closed box. Robots cover that share of its floor, and go from random places to others."}, add_boxes},
      {{"cross",
        "navground's Cross: 20 robots of radius 0.08 m go to and fro along two lines 4 m long that cross, for 300 s, "
        "with a safety margin that is drawn for each run."},
       add_crosses},
      {{"narrow",
        "SMGLib's doorway, hallway and intersection with two robots; three robots from each side of narrower doors."},
       add_narrow},
      {{"paper", "A1 to A15 of the paper's Section V.A, along routes."}, add_papers},
      {{"maps", "Maps after Dergachev and Yakovlev: 64 x 64 cells, a wall with one gap, or sixteen rooms with doors."},
       add_maps}};
  return all;
}

}  // namespace

const std::vector<SuiteInfo>& suites() {
  static const std::vector<SuiteInfo> all = [] {
    std::vector<SuiteInfo> infos;
    for (const SuiteEntry& entry : entries()) infos.push_back(entry.info);
    return infos;
  }();
  return all;
}

std::vector<std::string> suite_names() {
  std::vector<std::string> names;
  for (const SuiteInfo& suite : suites()) names.push_back(suite.name);
  return names;
}

std::vector<Scene> scenes_of(const std::string& suite, Extent extent, const Draws& draws) {
  for (const SuiteEntry& entry : entries()) {
    if (entry.info.name != suite) continue;
    Scenes scenes(suite, draws);
    entry.add(scenes, extent == Extent::full);
    return std::move(scenes).all();
  }
  throw std::invalid_argument(suite);
}

}  // namespace exactvo::bench
