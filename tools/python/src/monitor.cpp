// SPDX-License-Identifier: GPL-3.0-or-later
// The monitor of a control loop: movers come as arrays, a verdict goes out as a tuple.
#include "exactvo/formation/monitor.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "module.h"
#include "shapes.h"

namespace exactvo::python {

namespace {

using formation::Monitor;
using formation::MonitorSetup;
using formation::Mover;

geometry::Pose pose_of(py::handle object, const char* name) {
  const Doubles values = doubles(object, name, {3});
  return {{values.data()[0], values.data()[1]}, values.data()[2]};
}

/// What Python calls the place of an error: of "movers/1/radius" "radii[1]".
std::string python_name(const std::string& place) {
  const std::size_t begin = place.find('/');
  if (begin == std::string::npos) return place;
  const std::size_t end = std::min(place.find('/', begin + 1), place.size());
  const std::string index = "[" + place.substr(begin + 1, end - begin - 1) + "]";
  const std::string list = place.substr(0, begin), field = place.substr(std::min(end + 1, place.size()));
  if (list == "trajectory") return "poses" + index;
  if (list != "movers") return list == "footprint" ? list : list + index;
  return (field == "radius" ? "radii" : field + "s") + index;
}

/// Errors of the monitor by the names that Python's arguments have.
template <class Call>
auto named(const Call& call) {
  try {
    return call();
  } catch (const formation::MonitorError& e) {
    throw ArgumentError(python_name(e.place()), e.found(), e.expected());
  }
}

class PythonMonitor {
 public:
  explicit PythonMonitor(const MonitorSetup& setup) : monitor_(setup) {}

  py::tuple judge(py::handle pose, py::handle velocity, py::handle turn, bool in_world_axes, py::handle positions,
                  py::handle radii, py::handle max_speeds, py::handle position_errors) {
    const OneThread use(busy_, "monitor");
    const geometry::Pose at = pose_of(pose, "pose");
    const formation::Command command{{vector(velocity, "velocity"), finite(turn, "turn")}, in_world_axes};
    take_movers(positions, radii, max_speeds, position_errors);
    return as_tuple(named([&] { return without_gil([&] { return monitor_.judge(at, command, movers_); }); }));
  }

  py::tuple judge_trajectory(py::handle poses, py::handle positions, py::handle radii, py::handle max_speeds,
                             py::handle position_errors) {
    const OneThread use(busy_, "monitor");
    const Doubles rows = doubles(poses, "poses", {-1, 4});
    trajectory_.clear();
    for (py::ssize_t k = 0; k < rows.shape(0); ++k) {
      const double* row = rows.data() + 4 * k;
      trajectory_.push_back({row[0], {{row[1], row[2]}, row[3]}});
    }
    take_movers(positions, radii, max_speeds, position_errors);
    return as_tuple(named([&] { return without_gil([&] { return monitor_.judge(trajectory_, movers_); }); }));
  }

 private:
  void take_movers(py::handle positions, py::handle radii, py::handle max_speeds, py::handle position_errors) {
    const Doubles at = doubles(positions, "positions", {-1, 2});
    const py::ssize_t n = at.shape(0);
    const Doubles r = doubles(radii, "radii", {n}), speeds = doubles(max_speeds, "max_speeds", {n});
    const Doubles errors = doubles(position_errors, "position_errors", {n});
    movers_.resize(static_cast<std::size_t>(n));
    for (py::ssize_t k = 0; k < n; ++k) {
      Mover& mover = movers_[static_cast<std::size_t>(k)];
      mover.shape.corners.assign(1, {at.data()[2 * k], at.data()[2 * k + 1]});
      mover.shape.radius = r.data()[k];
      mover.max_speed = speeds.data()[k];
      mover.position_error = errors.data()[k];
    }
  }

  static py::tuple as_tuple(const formation::MonitorVerdict& v) {
    py::object witness = py::none();
    if (v.witness)
      witness =
          py::make_tuple(v.witness->is_mover, v.witness->index, v.witness->time, python::as_tuple(v.witness->place));
    return py::make_tuple(v.share, v.not_above, v.proven, v.in_contact, witness);
  }

  Monitor monitor_;
  std::vector<formation::TimedPose> trajectory_;
  std::vector<Mover> movers_;
  std::atomic<bool> busy_{false};
};

std::unique_ptr<PythonMonitor> monitor(const Obstacles& obstacles, py::handle radius, py::handle footprint,
                                       py::handle max_deceleration, py::handle max_turn_deceleration,
                                       py::handle latency, py::handle period, py::handle margin) {
  MonitorSetup setup;
  const double grown = at_least_zero(radius, "radius");
  if (footprint.is_none()) {
    setup.footprint = geometry::disc_body(grown);
  } else {
    const geometry::NormalizedPolygon outline = geometry::normalize({points(footprint, "footprint")});
    if (!outline.ok())
      throw ArgumentError("footprint", code_name(outline.problems.front().code), "a simple polygon, n x 2 numbers");
    setup.footprint = geometry::polygon_body(outline.polygon);
    for (geometry::RoundedPolygon& part : setup.footprint) part.radius = grown;
  }
  setup.max_deceleration = positive(max_deceleration, "max_deceleration");
  setup.max_turn_deceleration = positive(max_turn_deceleration, "max_turn_deceleration");
  setup.latency = at_least_zero(latency, "latency");
  setup.period = at_least_zero(period, "period");
  setup.margin = at_least_zero(margin, "margin");
  setup.obstacles = obstacles.list;
  return named([&] { return std::make_unique<PythonMonitor>(setup); });
}

}  // namespace

void bind_monitor(py::module_& module) {
  py::class_<PythonMonitor>(module, "Monitor")
      .def("judge", &PythonMonitor::judge)
      .def("judge_trajectory", &PythonMonitor::judge_trajectory);
  module.def("monitor", &monitor);
}

}  // namespace exactvo::python
