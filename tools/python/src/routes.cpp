// SPDX-License-Identifier: GPL-3.0-or-later
// From A to B with proof.
#include <pybind11/stl.h>

#include "exactvo/geometry/route_certificate.h"
#include "exactvo/geometry/routes.h"
#include "module.h"
#include "shapes.h"

namespace exactvo::python {

namespace {

constexpr double kLeastRadius = 0x1p-100;

using geometry::RouteMap;

struct Plan {
  RouteMap map;
  geometry::RoutePlan plan;
};

Vec2 covered(const RouteMap& map, py::handle point, const char* name) {
  const Vec2 p = vector(point, name);
  if (!map.covers(p))
    throw ArgumentError(name, shown(point),
                        "a point nearer to the obstacles; RouteMap(..., largest_distance=...) reaches farther");
  return p;
}

py::tuple as_tuple(const geometry::ExactPoint& p) {
  return py::make_tuple(p.rounded.x, p.rounded.y, p.x, p.y);
}

geometry::ExactPoint exact_point(py::handle object) {
  const auto f = py::cast<py::tuple>(object);
  return {{number(f[0], "x"), number(f[1], "y")}, py::cast<std::string>(f[2]), py::cast<std::string>(f[3])};
}

/// ("route", points, length, lower_bound), ("separated", chain) or ("blocked", end, inside, obstacle, edge).
py::tuple answer_tuple(const geometry::RouteAnswer& answer) {
  if (const auto* route = std::get_if<geometry::Route>(&answer)) {
    py::tuple points(route->points.size());
    for (std::size_t k = 0; k < route->points.size(); ++k) points[k] = as_tuple(route->points[k]);
    return py::make_tuple("route", points, route->length, route->lower_bound);
  }
  if (const auto* separated = std::get_if<geometry::Separated>(&answer)) {
    py::tuple chain(separated->chain.size());
    for (std::size_t k = 0; k < separated->chain.size(); ++k) {
      const geometry::ChainPoint& p = separated->chain[k];
      chain[k] = py::make_tuple(as_tuple(p.point), p.on.obstacle, p.on.edge, p.gap_follows);
    }
    return py::make_tuple("separated", chain);
  }
  const auto& blocked = std::get<geometry::Blocked>(answer);
  return py::make_tuple("blocked", blocked.end == geometry::Blocked::End::start ? "start" : "goal", blocked.inside,
                        blocked.by.obstacle, blocked.by.edge);
}

geometry::RouteAnswer answer_from(py::handle object) {
  const auto f = py::cast<py::tuple>(object);
  const std::string kind = py::str(f[0]);
  if (kind == "route") {
    geometry::Route route;
    for (const py::handle p : f[1]) route.points.push_back(exact_point(p));
    route.length = number(f[2], "length");
    route.lower_bound = number(f[3], "lower_bound");
    return route;
  }
  if (kind == "separated") {
    geometry::Separated separated;
    for (const py::handle item : f[1]) {
      const auto p = py::cast<py::tuple>(item);
      separated.chain.push_back(
          {exact_point(p[0]), {py::cast<std::size_t>(p[1]), py::cast<std::size_t>(p[2])}, py::cast<bool>(p[3])});
    }
    return separated;
  }
  geometry::Blocked blocked;
  blocked.end = py::cast<std::string>(f[1]) == "start" ? geometry::Blocked::End::start : geometry::Blocked::End::goal;
  blocked.inside = py::cast<bool>(f[2]);
  blocked.by = {py::cast<std::size_t>(f[3]), py::cast<std::size_t>(f[4])};
  return blocked;
}

/// An answer that was made by hand may be anything.
geometry::RouteAnswer answer_of(py::handle object) {
  try {
    return answer_from(object);
  } catch (const py::error_already_set&) {
  } catch (const py::cast_error&) {
  }
  throw ArgumentError("answer", shown(object), "the answer of a certificate");
}

RouteMap make_map(const Obstacles& obstacles, py::handle largest_radius, py::handle largest_distance) {
  const geometry::RouteMapOptions options{at_least_zero(largest_radius, "largest_radius"),
                                          at_least_zero(largest_distance, "largest_distance")};
  const py::gil_scoped_release released;
  return RouteMap(shapes_of(obstacles), options);
}

Plan make_plan(const RouteMap& map, py::handle radius) {
  const double r = at_least_zero(radius, "radius");
  if (r != 0.0 && (r < kLeastRadius || r > map.largest_radius()))
    throw ArgumentError("radius", shown(radius),
                        "0, or 2^-100 m to " + std::to_string(map.largest_radius()) +
                            " m; RouteMap(..., largest_radius=...) allows more");
  const py::gil_scoped_release released;
  return {map, geometry::RoutePlan(map, r)};
}

}  // namespace

void bind_routes(py::module_& module) {
  py::class_<RouteMap>(module, "RouteMap")
      .def(py::init(&make_map))
      .def_property_readonly("vertex_count", &RouteMap::vertex_count)
      .def_property_readonly("largest_radius", &RouteMap::largest_radius)
      .def("covers", [](const RouteMap& map, py::handle point) { return map.covers(vector(point, "point")); })
      .def("widest_radius",
           [](const RouteMap& map, py::handle start, py::handle goal) {
             const Vec2 a = covered(map, start, "start"), b = covered(map, goal, "goal");
             const py::gil_scoped_release released;
             return map.widest_radius(a, b);
           })
      .def("plan", &make_plan);
  py::class_<Plan>(module, "RoutePlan")
      .def_property_readonly("radius", [](const Plan& p) { return p.plan.radius(); })
      .def("is_reachable",
           [](const Plan& p, py::handle start, py::handle goal) {
             const Vec2 a = covered(p.map, start, "start"), b = covered(p.map, goal, "goal");
             const py::gil_scoped_release released;
             return p.plan.is_reachable(a, b);
           })
      .def("query", [](const Plan& p, py::handle start, py::handle goal) {
        const Vec2 a = covered(p.map, start, "start"), b = covered(p.map, goal, "goal");
        const geometry::RouteAnswer answer = without_gil([&] { return p.plan.query(a, b); });
        return answer_tuple(answer);
      });
  module.def("check_route",
             [](const Obstacles& obstacles, py::handle radius, py::handle start, py::handle goal, py::handle answer) {
               const geometry::RouteQuestion question{at_least_zero(radius, "radius"), vector(start, "start"),
                                                      vector(goal, "goal")};
               const geometry::RouteAnswer claimed = answer_of(answer);
               const std::vector<geometry::Obstacle> shapes = shapes_of(obstacles);
               const py::gil_scoped_release released;
               return check(shapes, question, claimed);
             });
}

}  // namespace exactvo::python
