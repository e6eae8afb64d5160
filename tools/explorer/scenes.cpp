// SPDX-License-Identifier: GPL-3.0-or-later
#include "explorer/scenes.h"

#include "exactvo/datasets/scenario_file.h"
#include "support/run.h"

namespace exactvo::tools {

namespace {

struct Scene {
  const char* key;
  const char* title;
  const char* words;
  formation::Method method;
  const char* scenario;
};

const Scene kScenes[] = {
    {"wall", "A wall, and why ORCA stops",
     "The robot heads straight for its goal, and the wall's half-plane lies at right angles to that way. As the robot "
     "comes nearer, the line of the half-plane moves to the origin and takes the best allowed velocity along to zero: "
     "play, and watch the green arrow shrink.",
     formation::Method::orca,
     R"({"name": "A wall, and why ORCA stops", "guidance": "none", "liveness": "off", "time_limit": 20,
         "robots": [{"id": "R1", "position": [0, 0], "goal": [12, 0], "max_speed": 2}],
         "obstacles": [{"id": "wall", "polyline": [[6, -3], [6, 3]]}]})"},
    {"circle", "Four robots on a circle",
     "Each robot wants to go through the middle; each takes half of every avoidance upon itself, and a bias to the "
     "right breaks the symmetry. Click a robot in the world and see one half-plane for each of the others.",
     formation::Method::ivo,
     R"({"name": "Four robots on a circle", "time_limit": 30, "robots": [
         {"id": "east", "position": [6, 0], "goal": [-6, 0], "max_speed": 1.5},
         {"id": "north", "position": [0, 6], "goal": [0, -6], "max_speed": 1.5},
         {"id": "west", "position": [-6, 0], "goal": [6, 0], "max_speed": 1.5},
         {"id": "south", "position": [0, -6], "goal": [0, 6], "max_speed": 1.5}]})"},
    {"gap", "A formation through a gap",
     "Three robots keep their places beside a virtual leader that passes between two blocks; the half-planes of the "
     "blocks take precedence over the places. Follow R3 and see which block binds, and when the formation closes "
     "again.",
     formation::Method::ivo,
     R"({"name": "A formation through a gap", "time_limit": 25, "time_step": 0.02, "arrival_tolerance": 0.1,
         "robots": [{"id": "R1", "position": [3, 0], "max_speed": 6}, {"id": "R2", "position": [0, 3], "max_speed": 6},
                    {"id": "R3", "position": [-3, 0], "max_speed": 6}],
         "obstacles": [{"id": "upper block", "polygon": [[7, 11.5], [10, 11.5], [10, 14.5], [7, 14.5]]},
                       {"id": "lower block", "polygon": [[11.5, 7], [14.5, 7], [14.5, 10], [11.5, 10]]}],
         "formation": {"topology": {"adjacency": [[0, 1, 1], [1, 0, 1], [1, 1, 0]], "pinning": [1, 1, 1]},
                       "offsets": [[1, 1], [-1, 1], [1, -1]], "recentre": true,
                       "leader": {"path": [[0, 0], [25, 25]], "speed": 4.242640687119285},
                       "gains": {"k1": 0.25, "k2": 0.45, "k3": 37.5, "kappa": 1.5}, "catch_up_speed": 1.5}})"}};

}  // namespace

std::vector<MadeRun> guided_scenes(const PackedRunLimits& limits) {
  std::vector<MadeRun> runs;
  for (const Scene& scene : kScenes) {
    formation::SimulationOptions options;
    options.method = scene.method;
    options.record_all = true;
    const formation::Scenario scenario = datasets::parse_scenario(scene.scenario, scene.key, ".");
    RunOutput output;
    output.figures = false;
    output.page = true;
    output.page_limits = limits;
    FinishedRun finished = run(scenario, options, datasets::make_provenance({}, 0), output);
    runs.push_back({{scene.key, scene.title, scene.words, std::move(finished.packed)}, options});
  }
  return runs;
}

}  // namespace exactvo::tools
