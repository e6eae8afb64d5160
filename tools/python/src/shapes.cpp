// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes.h"

#include <pybind11/stl.h>

#include <cmath>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/obstacle_shapes.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/validity.h"
#include "module.h"

namespace exactvo::python {

using geometry::ConvexPolygon;
using geometry::ConvexShape;
using geometry::Disc;
using geometry::Ellipse;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Segment;
using namespace py::literals;

namespace {

constexpr const char* kCoordinates = "coordinates within 2^100 m";

void require_within_range(const std::vector<Vec2>& points, const char* name) {
  for (const Vec2 p : points)
    if (std::fabs(p.x) > datasets::kLargestCoordinate || std::fabs(p.y) > datasets::kLargestCoordinate)
      throw ArgumentError(name, "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")", kCoordinates);
}

ConvexShape polygon_shape(std::vector<Vec2> vertices, const char* name) {
  require_within_range(vertices, name);
  if (vertices.empty()) throw ArgumentError(name, "no vertex", "at least one vertex");
  if (vertices.size() > 1 && vertices.front() == vertices.back()) vertices.pop_back();
  if (vertices.size() <= 2) return Segment{vertices.front(), vertices.back()};
  const ConvexShape given = ConvexPolygon{vertices};
  if (is_valid(given)) return given;
  const ConvexShape turned = ConvexPolygon{{vertices.rbegin(), vertices.rend()}};
  if (is_valid(turned)) return turned;
  throw ArgumentError(
      name, "a polygon that is not convex",
      "a convex polygon; velocity_obstacles() takes any, decomposing it exactly, and hull() encloses it");
}

/// What a ragged array's offsets promise: from 0, never falling, to `end`.
std::vector<std::size_t> offsets(py::handle object, const char* name, std::size_t end) {
  constexpr const char* kExpected = "a one-dimensional array of whole numbers, at least one";
  const auto array = array_of<std::int64_t>(object, name, {-1}, kExpected);
  if (array.size() == 0) throw ArgumentError(name, shown(object), kExpected);
  std::vector<std::size_t> result;
  std::int64_t before = 0;
  for (py::ssize_t k = 0; k < array.shape(0); ++k) {
    const std::int64_t value = array.data()[k];
    if (value < before || (k == 0 && value != 0) || static_cast<std::size_t>(value) > end)
      throw ArgumentError(name, std::to_string(value) + " at " + std::to_string(k),
                          "offsets that begin with 0, never fall and end with " + std::to_string(end));
    before = value;
    result.push_back(static_cast<std::size_t>(value));
  }
  if (result.back() != end)
    throw ArgumentError(name, std::to_string(result.back()) + " at the end",
                        "offsets that end with " + std::to_string(end));
  return result;
}

std::string problem_words(const std::vector<geometry::RingProblem>& problems) {
  for (const geometry::RingProblem& p : problems)
    if (!p.repaired)
      return std::string(geometry::code_name(p.code)) + " in ring " + std::to_string(p.ring) + ", vertex " +
             std::to_string(p.vertex);
  return "";
}

Obstacle obstacle_of(const std::vector<geometry::Ring>& rings, bool is_polygon, const std::string& name) {
  if (is_polygon) {
    const geometry::NormalizedPolygon made = geometry::normalize(rings);
    if (!made.ok())
      throw ArgumentError(name, problem_words(made.problems),
                          "a valid polygon; exactvo.datasets.repair() cuts crossings exactly");
    return made.polygon;
  }
  const geometry::NormalizedPolyline made = geometry::normalize_polyline(rings.front());
  if (!made.ok()) throw ArgumentError(name, problem_words(made.problems), "a wall of two distinct points or more");
  return made.polyline;
}

Obstacles obstacles_from_ragged(py::handle coordinates, py::handle ring_offsets, py::handle obstacle_offsets,
                                py::handle is_polygon, const std::vector<std::string>& ids) {
  const std::vector<Vec2> all = points(coordinates, "coordinates");
  require_within_range(all, "coordinates");
  const std::vector<std::size_t> ring = offsets(ring_offsets, "ring_offsets", all.size());
  const std::vector<std::size_t> obstacle = offsets(obstacle_offsets, "obstacle_offsets", ring.size() - 1);
  const std::size_t count = obstacle.size() - 1;
  const std::string as_many = "as many as obstacles: " + std::to_string(count);
  const auto kinds = array_of<bool>(is_polygon, "is_polygon", {static_cast<py::ssize_t>(count)}, as_many);
  if (ids.size() != count) throw ArgumentError("ids", std::to_string(ids.size()), as_many);
  Obstacles result;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<geometry::Ring> rings;
    for (std::size_t r = obstacle[k]; r < obstacle[k + 1]; ++r)
      rings.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(ring[r]),
                         all.begin() + static_cast<std::ptrdiff_t>(ring[r + 1]));
    const std::string name = "obstacle " + std::to_string(k);
    if (rings.empty()) throw ArgumentError(name, "no ring", "at least one ring");
    if (!kinds.data()[k] && rings.size() > 1)
      throw ArgumentError(name, std::to_string(rings.size()) + " rings", "one chain of points for a wall");
    result.list.push_back({ids[k], obstacle_of(rings, kinds.data()[k], name)});
  }
  return result;
}

/// The ragged arrays again.
py::dict ragged(const Obstacles& obstacles) {
  std::vector<Vec2> all;
  std::vector<std::int64_t> ring_offsets{0}, obstacle_offsets{0};
  py::array_t<bool> is_polygon(static_cast<py::ssize_t>(obstacles.list.size()));
  py::list ids;
  const auto add = [&](const std::vector<Vec2>& ring) {
    all.insert(all.end(), ring.begin(), ring.end());
    ring_offsets.push_back(static_cast<std::int64_t>(all.size()));
  };
  for (std::size_t k = 0; k < obstacles.list.size(); ++k) {
    const Obstacle& shape = obstacles.list[k].shape;
    is_polygon.mutable_data()[k] = has_interior(shape);
    if (const auto* polygon = std::get_if<Polygon>(&shape)) {
      add(polygon->outer);
      for (const geometry::Ring& hole : polygon->holes) add(hole);
    } else {
      add(std::get<geometry::Polyline>(shape).points);
    }
    obstacle_offsets.push_back(static_cast<std::int64_t>(ring_offsets.size()) - 1);
    ids.append(obstacles.list[k].id);
  }
  const auto array = [](const std::vector<std::int64_t>& numbers) {
    return py::array_t<std::int64_t>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  };
  return py::dict("coordinates"_a = as_array(all), "ring_offsets"_a = array(ring_offsets),
                  "obstacle_offsets"_a = array(obstacle_offsets), "is_polygon"_a = is_polygon, "ids"_a = ids);
}

py::list convex_cover_of(const Obstacles& obstacles) {
  py::list result;
  for (const formation::SceneObstacle& obstacle : obstacles.list)
    for (const ConvexShape& piece : geometry::convex_cover(obstacle.shape)) result.append(as_tuple(piece));
  return result;
}

}  // namespace

ConvexShape convex_shape(py::handle object, const char* name) {
  const auto fields = py::cast<py::tuple>(object);
  const std::string kind = py::str(fields[0]);
  ConvexShape shape;
  if (kind == "disc") {
    shape = Disc{vector(fields[1], "center"), at_least_zero(fields[2], "radius")};
  } else if (kind == "segment") {
    shape = Segment{vector(fields[1], "a"), vector(fields[2], "b")};
  } else if (kind == "polygon") {
    return polygon_shape(points(fields[1], name), name);
  } else {
    const auto l = py::cast<py::tuple>(fields[2]);
    shape = Ellipse{vector(fields[1], "center"), finite(l[0], "l11"), finite(l[1], "l21"), finite(l[2], "l22")};
  }
  return shape;
}

py::tuple as_tuple(const ConvexShape& shape) {
  if (const auto* disc = std::get_if<Disc>(&shape)) return py::make_tuple("disc", as_tuple(disc->center), disc->radius);
  if (const auto* s = std::get_if<Segment>(&shape)) return py::make_tuple("segment", as_tuple(s->a), as_tuple(s->b));
  if (const auto* p = std::get_if<ConvexPolygon>(&shape)) return py::make_tuple("polygon", as_array(p->vertices));
  const auto& e = std::get<Ellipse>(shape);
  return py::make_tuple("ellipse", as_tuple(e.center), py::make_tuple(e.l11, e.l21, e.l22));
}

std::vector<Obstacle> shapes_of(const Obstacles& obstacles) {
  std::vector<Obstacle> result;
  for (const formation::SceneObstacle& obstacle : obstacles.list) result.push_back(obstacle.shape);
  return result;
}

py::list rings_of(const Polygon& polygon) {
  py::list rings;
  rings.append(as_array(polygon.outer));
  for (const geometry::Ring& hole : polygon.holes) rings.append(as_array(hole));
  return rings;
}

void bind_shapes(py::module_& module) {
  py::class_<Obstacles>(module, "Obstacles")
      .def(py::init([](py::handle coordinates, py::handle ring_offsets, py::handle obstacle_offsets,
                       py::handle is_polygon, const std::vector<std::string>& ids) {
        return obstacles_from_ragged(coordinates, ring_offsets, obstacle_offsets, is_polygon, ids);
      }))
      .def("__len__", [](const Obstacles& o) { return o.list.size(); })
      .def("ragged", &ragged)
      .def("convex_cover", &convex_cover_of);
  module.def("normalised_shape",
             [](py::handle shape, const char* name) { return as_tuple(convex_shape(shape, name)); });
  module.def("hull", [](py::handle vertices) {
    const std::vector<Vec2> given = points(vertices, "points");
    if (given.empty()) throw ArgumentError("points", "no point", "at least one point");
    require_within_range(given, "points");
    return as_tuple(geometry::hull_shape(given));
  });
  module.def("ellipse_from_axes", [](py::handle center, py::handle a, py::handle b, py::handle angle) {
    const double major = at_least_zero(a, "a"), minor = at_least_zero(b, "b");
    if (minor > major) throw ArgumentError("b", shown(b), "at most a, " + shown(a));
    return as_tuple(ConvexShape(ellipse_from_axes(vector(center, "center"), {major, minor, finite(angle, "angle")})));
  });
  module.def("axes_of", [](py::handle ellipse) {
    const geometry::EllipseAxes axes = axes_of(std::get<Ellipse>(convex_shape(ellipse, "ellipse")));
    return py::make_tuple(axes.a, axes.b, axes.angle);
  });
}

}  // namespace exactvo::python
