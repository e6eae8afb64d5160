// SPDX-License-Identifier: GPL-3.0-or-later
// One robot's decisions for a control loop: neighbours come as arrays, a decision goes out as a tuple.
#include "exactvo/formation/navigator.h"

#include <pybind11/stl.h>

#include <atomic>
#include <cmath>

#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/simulation.h"
#include "module.h"
#include "shapes.h"

namespace exactvo::python {

namespace {

using formation::Navigator;
using formation::NavigatorSetup;

/// Numbers of a struct by name; others are refused.
template <class Struct>
void take_numbers(const py::dict& given, const char* name, Struct& out,
                  const std::vector<std::pair<const char*, double Struct::*>>& fields) {
  for (const auto& [key, value] : given) {
    const std::string word = py::str(key);
    bool is_known = false;
    std::vector<std::string> known;
    for (const auto& [field, member] : fields) {
      known.emplace_back(field);
      if (word != field) continue;
      out.*member = finite(value, field);
      is_known = true;
    }
    if (!is_known) refuse_word(word, name, known);
  }
}

/// What stands in `kinematics` of a scenario, but for its type; `radius`: m, of the body about the axle.
formation::DifferentialDrive drive_of(const py::dict& kinematics, double radius) {
  using Drive = formation::DifferentialDrive;
  Drive drive;
  py::dict numbers;
  for (const auto& [key, value] : kinematics)
    if (const std::string word = py::str(key); word != "type")
      numbers[key] = value;
    else
      require_word(py::str(value), "kinematics", {"differential"});
  take_numbers<Drive>(numbers, "kinematics", drive,
                      {{"wheel_separation", &Drive::wheel_separation},
                       {"max_wheel_speed", &Drive::max_wheel_speed},
                       {"max_wheel_acceleration", &Drive::max_wheel_acceleration},
                       {"max_angular_speed", &Drive::max_angular_speed},
                       {"max_backward_speed", &Drive::max_backward_speed},
                       {"reference", &Drive::reference}});
  for (const auto& [name, number] : {std::pair{"wheel_separation", drive.wheel_separation},
                                     {"max_wheel_speed", drive.max_wheel_speed},
                                     {"max_wheel_acceleration", drive.max_wheel_acceleration}})
    if (!(number > 0.0))
      throw ArgumentError(name, number == 0.0 ? "none, or 0" : std::to_string(number), "a number above 0");
  if (drive.reference == 0.0) drive.reference = 0.5 * drive.wheel_separation;
  drive.body_radius = radius;
  return drive;
}

/// `heading`: radians.
formation::OnWheels on_wheels(py::handle heading, py::handle wheels) {
  const double angle = finite(heading, "heading");
  const Vec2 speeds = vector(wheels, "wheels");
  return {{std::cos(angle), std::sin(angle)}, {speeds.x, speeds.y}};
}

class PythonNavigator {
 public:
  PythonNavigator(const NavigatorSetup& setup, std::vector<Vec2> goals) : navigator_(setup, std::move(goals)) {}

  py::tuple decide(py::handle time, py::handle position, py::handle velocity, py::handle heading, py::handle wheels,
                   const std::vector<std::size_t>& ids, py::handle positions, py::handle velocities, py::handle radii,
                   py::handle max_speeds, py::handle cooperate, const py::list& bodies, py::handle measured) {
    const OneThread use(busy_, "navigator");
    const formation::NavigatorState now{finite(time, "time"), vector(position, "position"),
                                        vector(velocity, "velocity"), on_wheels(heading, wheels)};
    take_neighbours(ids, positions, velocities, radii, max_speeds, cooperate);
    if (!measured.is_none()) {
      using formation::Measurements;
      Measurements bounds;
      const auto numbers = py::cast<py::dict>(measured);
      take_numbers<Measurements>(
          numbers, "measured", bounds,
          {{"position", &Measurements::position}, {"velocity", &Measurements::velocity}, {"age", &Measurements::age}});
      for (const char* key : {"position", "velocity", "age"})
        if (!numbers.contains(key)) throw ArgumentError("measured", std::string("no ") + key, "all three bounds");
      for (formation::Neighbour& n : neighbours_) n.measured = bounds;
    }
    moving_.clear();
    for (const py::handle body : bodies) {
      const py::tuple fields = py::cast<py::tuple>(body);
      moving_.push_back({convex_shape(fields[0], "bodies"), vector(fields[1], "bodies")});
    }
    const formation::Decision& d = *without_gil([&] { return &navigator_.decide(now, neighbours_, moving_); });
    const formation::Twist twist = navigator_.twist();
    return py::make_tuple(as_tuple(d.chosen), as_tuple(d.preferred), static_cast<int>(d.status), d.violation,
                          d.uncertified, std::string(formation::name(d.mode)), d.side, d.note, constraints(),
                          py::make_tuple(twist.linear, twist.angular),
                          py::make_tuple(twist.wheels.left, twist.wheels.right));
  }

  void set_goals(std::vector<Vec2> goals) { navigator_.set_goals(std::move(goals)); }
  std::size_t goal() const { return navigator_.goal(); }
  bool has_arrived() const { return navigator_.has_arrived(); }

 private:
  void take_neighbours(const std::vector<std::size_t>& ids, py::handle positions, py::handle velocities,
                       py::handle radii, py::handle max_speeds, py::handle cooperate) {
    const Doubles at = doubles(positions, "positions", {-1, 2});
    const py::ssize_t n = at.shape(0);
    const Doubles v = doubles(velocities, "velocities", {n, 2}), r = doubles(radii, "radii", {n});
    const Doubles speeds = doubles(max_speeds, "max_speeds", {n});
    const auto yields = array_of<bool>(cooperate, "cooperate", {n}, "a truth value, or one per neighbour");
    if (ids.size() != static_cast<std::size_t>(n))
      throw ArgumentError("ids", std::to_string(ids.size()), "as many as positions: " + std::to_string(n));
    neighbours_.clear();
    for (py::ssize_t k = 0; k < n; ++k)
      neighbours_.push_back({ids[static_cast<std::size_t>(k)],
                             {at.data()[2 * k], at.data()[2 * k + 1]},
                             {v.data()[2 * k], v.data()[2 * k + 1]},
                             r.data()[k],
                             speeds.data()[k],
                             yields.data()[k]});
  }

  py::list constraints() const {
    py::list result;
    for (const formation::DecisionConstraint& c : navigator_.constraints())
      result.append(py::make_tuple(as_tuple(c.half_plane), static_cast<int>(c.source), c.index, c.certified, c.hard,
                                   c.active, c.multiplier, c.clearance));
    return result;
  }

  Navigator navigator_;
  std::vector<formation::Neighbour> neighbours_;
  std::vector<formation::MovingBody> moving_;
  std::atomic<bool> busy_{false};
};

std::unique_ptr<PythonNavigator> navigator(py::handle goals, const Obstacles& obstacles, py::handle radius,
                                           py::handle max_speed, bool cooperates, std::size_t id,
                                           const std::string& method, const std::string& speed_bound,
                                           const py::dict& horizons, const py::dict& margins, py::handle time_step,
                                           py::handle arrival_tolerance, py::handle neighbour_distance,
                                           py::handle acceleration, py::handle braking_time, py::handle kinematics) {
  NavigatorSetup setup;
  setup.radius = positive(radius, "radius");
  setup.max_speed = positive(max_speed, "max_speed");
  setup.cooperates = cooperates;
  setup.id = id;
  setup.obstacles = obstacles.list;
  setup.method = word<formation::Method>(method, "method", formation::method_names(), &formation::parse);
  require_word(speed_bound, "speed_bound", {"disc", "box"});
  setup.speed_bound = speed_bound == "box" ? formation::SpeedBoundKind::box : formation::SpeedBoundKind::disc;
  using formation::Horizons;
  using formation::Margins;
  take_numbers<Horizons>(horizons, "horizons", setup.horizons,
                         {{"least", &Horizons::least},
                          {"most", &Horizons::most},
                          {"speed_floor", &Horizons::speed_floor},
                          {"orca", &Horizons::orca},
                          {"robots", &Horizons::robots}});
  take_numbers<Margins>(margins, "margins", setup.margins,
                        {{"obstacle", &Margins::obstacle}, {"robot", &Margins::robot}});
  setup.time_step = positive(time_step, "time_step");
  setup.arrival_tolerance = positive(arrival_tolerance, "arrival_tolerance");
  setup.neighbour_distance = positive(neighbour_distance, "neighbour_distance");
  if (!acceleration.is_none()) setup.acceleration = positive(acceleration, "acceleration");
  if (!braking_time.is_none()) setup.braking_time = positive(braking_time, "braking_time");
  if (!kinematics.is_none()) setup.drive = drive_of(py::cast<py::dict>(kinematics), setup.radius);
  return std::make_unique<PythonNavigator>(setup, points(goals, "goals"));
}

py::tuple neighbour_on_wheels(py::handle position, py::handle heading, py::handle wheels, const py::dict& kinematics,
                              py::handle radius, py::handle time_step) {
  const formation::Neighbour seen = formation::neighbour_on_wheels(
      0, drive_of(kinematics, positive(radius, "radius")), positive(time_step, "time_step"),
      vector(position, "positions"), on_wheels(heading, wheels));
  return py::make_tuple(as_tuple(seen.position), as_tuple(seen.velocity), seen.radius, seen.max_speed);
}

std::unique_ptr<PythonNavigator> navigator_of(const datasets::LoadedScenario& loaded, std::size_t robot,
                                              const std::string& method) {
  const formation::Scenario& scenario = loaded.scenario;
  if (scenario.formation)
    throw ArgumentError("scenario", "a formation, whose robots have no goals", "robots with goals");
  if (robot >= scenario.robots.size())
    throw ArgumentError("robot", std::to_string(robot),
                        "less than the number of robots, " + std::to_string(scenario.robots.size()));
  return std::make_unique<PythonNavigator>(
      navigator_setup(scenario, robot,
                      word<formation::Method>(method, "method", formation::method_names(), &formation::parse)),
      scenario.robots[robot].goals);
}

}  // namespace

void bind_navigator(py::module_& module) {
  py::class_<PythonNavigator>(module, "Navigator")
      .def("decide", &PythonNavigator::decide)
      .def("set_goals", [](PythonNavigator& self, py::handle goals) { self.set_goals(points(goals, "goals")); })
      .def("goal", &PythonNavigator::goal)
      .def("has_arrived", &PythonNavigator::has_arrived);
  module.def("navigator", &navigator);
  module.def("navigator_of", &navigator_of);
  module.def("neighbour_on_wheels", &neighbour_on_wheels);
}

}  // namespace exactvo::python
