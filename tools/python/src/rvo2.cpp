// SPDX-License-Identifier: GPL-3.0-or-later
// The simulator of exactvo/rvo2.h, for the names of Python-RVO2 (rvo2.py).
#include "exactvo/rvo2.h"

#include "arguments.h"
#include "module.h"

namespace exactvo::python {

namespace {

using RVO::RVOSimulator;

float single(py::handle object, const char* name) {
  return static_cast<float>(number(object, name));
}

RVO::Vector2 vector2(py::handle object, const char* name) {
  const Vec2 v = vector(object, name);
  return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

py::tuple as_value(const RVO::Vector2& v) {
  return py::make_tuple(v.x(), v.y());
}
template <class Number>
Number as_value(Number value) {
  return value;
}

/// What RVO2 takes for a size, or an ArgumentError.
std::size_t count(py::handle object, const char* name) {
  const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
  const long long value = whole ? PyLong_AsLongLong(whole.ptr()) : -1;
  PyErr_Clear();
  if (value < 0) throw ArgumentError(name, shown(object), "a whole number, 0 or more");
  return static_cast<std::size_t>(value);
}

/// A number below `end`, or an IndexError: RVO2 itself reads beyond its arrays.
std::size_t index(py::handle object, const char* name, std::size_t end) {
  const std::size_t value = count(object, name);
  if (value >= end)
    throw py::index_error(std::string(name) + " " + std::to_string(value) + ": there are " + std::to_string(end));
  return value;
}

std::size_t agent(const RVOSimulator& sim, py::handle object) {
  return index(object, "agent_no", sim.getNumAgents());
}

std::size_t vertex(const RVOSimulator& sim, py::handle object) {
  return index(object, "vertex_no", sim.getNumObstacleVertices());
}

/// A getter by number; `index_of` (`agent` or `vertex`) checks the number.
template <class IndexOf, class Value>
auto of(IndexOf index_of, Value (RVOSimulator::*get)(std::size_t) const) {
  return [=](const RVOSimulator& sim, py::handle no) { return as_value((sim.*get)(index_of(sim, no))); };
}

/// `read` makes the value of the argument `name`.
template <class Set, class Value>
auto set_of_agent(Set set, Value (*read)(py::handle, const char*), const char* name) {
  return [=](RVOSimulator& sim, py::handle no, py::handle value) { (sim.*set)(agent(sim, no), read(value, name)); };
}

std::size_t add_obstacle(RVOSimulator& sim, const py::list& vertices) {
  std::vector<RVO::Vector2> all;
  for (const py::handle vertex : vertices) all.push_back(vector2(vertex, "vertices"));
  const std::size_t no = sim.addObstacle(all);
  if (no == RVO::RVO_ERROR) throw std::runtime_error("Error adding obstacle to RVO simulation");
  return no;
}

std::size_t add_agent(RVOSimulator& sim, py::handle pos, const py::object& neighbour_distance,
                      const py::object& neighbours, const py::object& time_horizon, const py::object& time_horizon_obst,
                      const py::object& radius, const py::object& max_speed, const py::object& velocity) {
  const RVO::Vector2 p = vector2(pos, "pos");
  const std::size_t no =
      neighbour_distance.is_none()
          ? sim.addAgent(p)
          : sim.addAgent(p, single(neighbour_distance, "neighborDist"), count(neighbours, "maxNeighbors"),
                         single(time_horizon, "timeHorizon"), single(time_horizon_obst, "timeHorizonObst"),
                         single(radius, "radius"), single(max_speed, "maxSpeed"), vector2(velocity, "velocity"));
  if (no == RVO::RVO_ERROR) throw std::runtime_error("Error adding agent to RVO simulation");
  return no;
}

void bind_agents(py::class_<RVOSimulator>& c) {
  c.def("getAgentPosition", of(agent, &RVOSimulator::getAgentPosition))
      .def("getAgentVelocity", of(agent, &RVOSimulator::getAgentVelocity))
      .def("getAgentPrefVelocity", of(agent, &RVOSimulator::getAgentPrefVelocity))
      .def("getAgentMaxNeighbors", of(agent, &RVOSimulator::getAgentMaxNeighbors))
      .def("getAgentMaxSpeed", of(agent, &RVOSimulator::getAgentMaxSpeed))
      .def("getAgentNeighborDist", of(agent, &RVOSimulator::getAgentNeighborDist))
      .def("getAgentRadius", of(agent, &RVOSimulator::getAgentRadius))
      .def("getAgentTimeHorizon", of(agent, &RVOSimulator::getAgentTimeHorizon))
      .def("getAgentTimeHorizonObst", of(agent, &RVOSimulator::getAgentTimeHorizonObst))
      .def("getAgentNumAgentNeighbors", of(agent, &RVOSimulator::getAgentNumAgentNeighbors))
      .def("getAgentNumObstacleNeighbors", of(agent, &RVOSimulator::getAgentNumObstacleNeighbors))
      .def("getAgentNumORCALines", of(agent, &RVOSimulator::getAgentNumORCALines))
      .def("getAgentAgentNeighbor",
           [](const RVOSimulator& s, py::handle no, py::handle neighbour) {
             const std::size_t k = agent(s, no);
             return s.getAgentAgentNeighbor(k, index(neighbour, "neighbor_no", s.getAgentNumAgentNeighbors(k)));
           })
      .def("getAgentObstacleNeighbor",
           [](const RVOSimulator& s, py::handle no, py::handle neighbour) {
             const std::size_t k = agent(s, no);
             return s.getAgentObstacleNeighbor(k, index(neighbour, "obstacle_no", s.getAgentNumObstacleNeighbors(k)));
           })
      .def("getAgentORCALine",
           [](const RVOSimulator& s, py::handle no, py::handle line) {
             const std::size_t k = agent(s, no);
             const RVO::Line& l = s.getAgentORCALine(k, index(line, "line_no", s.getAgentNumORCALines(k)));
             return py::make_tuple(l.point.x(), l.point.y(), l.direction.x(), l.direction.y());
           })
      .def("setAgentMaxNeighbors", set_of_agent(&RVOSimulator::setAgentMaxNeighbors, count, "max_neighbors"))
      .def("setAgentMaxSpeed", set_of_agent(&RVOSimulator::setAgentMaxSpeed, single, "max_speed"))
      .def("setAgentNeighborDist", set_of_agent(&RVOSimulator::setAgentNeighborDist, single, "neighbor_dist"))
      .def("setAgentRadius", set_of_agent(&RVOSimulator::setAgentRadius, single, "radius"))
      .def("setAgentTimeHorizon", set_of_agent(&RVOSimulator::setAgentTimeHorizon, single, "time_horizon"))
      .def("setAgentTimeHorizonObst", set_of_agent(&RVOSimulator::setAgentTimeHorizonObst, single, "time_horizon_obst"))
      .def("setAgentPosition", set_of_agent(&RVOSimulator::setAgentPosition, vector2, "position"))
      .def("setAgentVelocity", set_of_agent(&RVOSimulator::setAgentVelocity, vector2, "velocity"))
      .def("setAgentPrefVelocity", set_of_agent(&RVOSimulator::setAgentPrefVelocity, vector2, "velocity"));
}

}  // namespace

void bind_rvo2(py::module_& module) {
  py::class_<RVOSimulator> c(module, "RvoSimulator");
  c.def(py::init([](py::handle time_step, py::handle neighbour_distance, py::handle neighbours, py::handle time_horizon,
                    py::handle time_horizon_obst, py::handle radius, py::handle max_speed, py::handle velocity) {
     return std::make_unique<RVOSimulator>(single(time_step, "timeStep"), single(neighbour_distance, "neighborDist"),
                                           count(neighbours, "maxNeighbors"), single(time_horizon, "timeHorizon"),
                                           single(time_horizon_obst, "timeHorizonObst"), single(radius, "radius"),
                                           single(max_speed, "maxSpeed"), vector2(velocity, "velocity"));
   }))
      .def("addAgent", &add_agent)
      .def("addObstacle", &add_obstacle)
      .def("processObstacles", &RVOSimulator::processObstacles, py::call_guard<py::gil_scoped_release>())
      .def("doStep", &RVOSimulator::doStep, py::call_guard<py::gil_scoped_release>())
      .def("getGlobalTime", &RVOSimulator::getGlobalTime)
      .def("getTimeStep", &RVOSimulator::getTimeStep)
      .def("setTimeStep", [](RVOSimulator& s, py::handle step) { s.setTimeStep(single(step, "time_step")); })
      .def("getNumAgents", &RVOSimulator::getNumAgents)
      .def("getNumObstacleVertices", &RVOSimulator::getNumObstacleVertices)
      .def("getObstacleVertex", of(vertex, &RVOSimulator::getObstacleVertex))
      .def("getNextObstacleVertexNo", of(vertex, &RVOSimulator::getNextObstacleVertexNo))
      .def("getPrevObstacleVertexNo", of(vertex, &RVOSimulator::getPrevObstacleVertexNo))
      .def("queryVisibility",
           [](const RVOSimulator& s, py::handle point1, py::handle point2, py::handle radius) {
             const RVO::Vector2 a = vector2(point1, "point1"), b = vector2(point2, "point2");
             const float r = single(radius, "radius");
             const py::gil_scoped_release released;
             return s.queryVisibility(a, b, r);
           })
      .def("setAgentDefaults",
           [](RVOSimulator& s, py::handle neighbour_distance, py::handle neighbours, py::handle time_horizon,
              py::handle time_horizon_obst, py::handle radius, py::handle max_speed, py::handle velocity) {
             s.setAgentDefaults(single(neighbour_distance, "neighbor_dist"), count(neighbours, "max_neighbors"),
                                single(time_horizon, "time_horizon"), single(time_horizon_obst, "time_horizon_obst"),
                                single(radius, "radius"), single(max_speed, "max_speed"),
                                vector2(velocity, "velocity"));
           })
      .def("relaxedInLastStep", [](const RVOSimulator& s) { return s.getStepReport().relaxed; })
      .def("setThreads", &RVOSimulator::setThreads);
  bind_agents(c);
}

}  // namespace exactvo::python
