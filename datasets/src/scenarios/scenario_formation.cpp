// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "exactvo/formation/leader_route.h"
#include "exactvo/formation/patterns.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/counted.h"
#include "scenarios/scenario_values.h"

namespace exactvo::datasets {
namespace {

using formation::FormationSpec;
using formation::Robot;
using geometry::Vec2;

class FormationReader {
 public:
  FormationReader(const std::vector<Robot>& robots, const std::string& file) : robots_(robots), file_(file) {}

  FormationSpec read(const Json& object) const {
    FormationSpec spec;
    spec.offsets =
        object.contains("offsets") ? object.at("offsets").get<std::vector<Vec2>>() : of_pattern(object.at("pattern"));
    spec.topology = to_topology(object.at("topology"), spec.offsets);
    spec.recentre = object.value("recentre", spec.recentre);
    spec.leader = to_leader(object.at("leader"));
    read_value(JsonCursor(object, file_, ""), spec);
    return spec;
  }

 private:
  [[noreturn]] void refuse(const std::string& at, const std::string& found, const std::string& expected) const {
    throw DataError(DataCode::scenario, file_, "/formation" + at, found, expected);
  }

  std::vector<Vec2> of_pattern(const Json& object) const {
    formation::Pattern pattern{};
    parse(object.at("name").get<std::string>(), pattern);  // the schema knows the names
    const Vec2 heading = object.value("heading", Vec2{1.0, 0.0});
    if (heading == Vec2{}) refuse("/pattern/heading", "[0, 0]", "a direction");
    return pattern_offsets(pattern, robots_.size(), object.at("spacing").get<double>(), heading);
  }

  formation::Topology to_topology(const Json& object, const std::vector<Vec2>& offsets) const {
    if (object.contains("complete")) return formation::complete_topology(robots_.size());
    if (object.contains("neighbours_within"))
      return formation::neighbour_topology(offsets, object.at("neighbours_within").get<double>(), pinned(object));
    formation::Topology topology;
    object.at("adjacency").get_to(topology.adjacency);
    object.at("pinning").get_to(topology.pinning);
    return topology;
  }

  std::vector<std::size_t> pinned(const Json& object) const {
    std::vector<std::size_t> places;
    const Json ids = object.value("pinned", Json::array());
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const std::string id = ids[k].get<std::string>();
      const auto found = std::find_if(robots_.begin(), robots_.end(), [&](const Robot& r) { return r.id == id; });
      if (found == robots_.end())
        refuse("/topology/pinned/" + std::to_string(k), "\"" + id + "\"", "the id of a robot");
      places.push_back(static_cast<std::size_t>(found - robots_.begin()));
    }
    return places;
  }

  formation::Leader to_leader(const Json& object) const {
    formation::Leader leader;
    leader.speed = object.value("speed", leader.speed);
    if (object.contains("to")) return leader;  // plan_leader_of
    object.at("path").get_to(leader.path);
    if (object.contains("profile"))
      leader.profile = to_profile(object.at("profile"), leader.path, file_, "/formation/leader/profile");
    return leader;
  }

  const std::vector<Robot>& robots_;
  const std::string& file_;
};

}  // namespace

std::vector<formation::SpeedKnot> to_profile(const Json& object, const std::vector<Vec2>& path, const std::string& file,
                                             const std::string& pointer) {
  if (object.contains("trapezoid")) {
    const Json& t = object.at("trapezoid");
    return formation::trapezoid(path, t.at("speed").get<double>(), t.at("acceleration").get<double>());
  }
  if (object.contains("legs")) {
    const auto speeds = object.at("legs").get<std::vector<double>>();
    if (speeds.size() + 1 != path.size())
      throw DataError(DataCode::scenario, file, pointer + "/legs", geometry::counted(speeds.size(), "speed"),
                      "one a leg of the path: " + std::to_string(path.size() - 1));
    return formation::speed_of_legs(path, speeds);
  }
  std::vector<formation::SpeedKnot> knots;
  for (const Json& pair : object.at("knots")) knots.push_back({pair[0].get<double>(), pair[1].get<double>()});
  return knots;
}

void plan_leader_of(const Json& object, formation::Scenario& scenario, const std::string& file) {
  const std::string pointer = "/formation/leader/profile";
  const Json profile = object.value("profile", Json::object());
  if (profile.contains("legs"))
    throw DataError(DataCode::scenario, file, pointer + "/legs", "speeds of legs, for a path that is planned",
                    "a trapezoid or knots");
  formation::LeaderGoal goal{object.at("to").get<Vec2>(), std::nullopt};
  if (object.contains("from")) goal.from = object.at("from").get<Vec2>();
  formation::Leader& leader = scenario.formation->leader;
  leader.path = {goal.to};
  if (scenario.formation->offsets.size() != scenario.robots.size()) return;  // refused, as no formation could run
  plan_leader(scenario, goal);
  if (!profile.empty()) leader.profile = to_profile(profile, leader.path, file, pointer);
}

FormationSpec to_formation(const Json& object, const std::vector<Robot>& robots, const std::string& file) {
  return FormationReader(robots, file).read(object);
}

}  // namespace exactvo::datasets
