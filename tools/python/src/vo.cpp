// SPDX-License-Identifier: GPL-3.0-or-later
// Velocity obstacles, their half-planes with certificates, and what several of them leave.
#include <pybind11/stl.h>

#include <cmath>

#include "exactvo/vo/certificate.h"
#include "exactvo/vo/free_arrangement.h"
#include "exactvo/vo/free_velocities.h"
#include "exactvo/vo/reciprocal.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "module.h"
#include "shapes.h"

namespace exactvo::python {

using geometry::HalfPlane;
using namespace py::literals;

namespace {

/// The cone of a convex shape; its apex is the velocity of the shape.
using Cone = vo::ShiftedCone;

Cone make_cone(py::handle shape, py::handle position, py::handle radius, py::handle time_horizon, py::handle velocity) {
  geometry::ConvexShape s = convex_shape(shape, "obstacle");
  const Vec2 p = vector(position, "position");
  const double r = at_least_zero(radius, "radius");
  const double tau = positive_or_infinite(time_horizon, "time_horizon");
  const Vec2 u = vector(velocity, "obstacle_velocity");
  return {vo::VelocityObstacle(std::move(s), p, r, tau), {{-u}}, u};
}

vo::HalfPlaneClaim claim_of(const Cone& c, const HalfPlane& h) {
  const geometry::GrownShape& s = c.cone.grown();
  return {s.shape, s.origin, s.radius, c.cone.time_horizon(), c.apex, h};
}

void require_apart(const Cone& cone, const char* what) {
  if (cone.cone.overlaps())
    throw ArgumentError(what, "a robot that touches or overlaps the obstacle: it has no velocity obstacle",
                        "a robot apart from it (see `overlaps`); `contact_half_plane()` leads away");
}

py::object as_object(const std::optional<HalfPlane>& h) {
  return h ? py::object(as_tuple(*h)) : py::none();
}

/// The half-plane of the obstacle at rest, moved by the obstacle's velocity and rounded up: still certified, by
/// `is_true`.
std::optional<HalfPlane> half_plane(const Cone& cone, Vec2 v, double responsibility) {
  std::optional<HalfPlane> h = cone.cone.half_plane(v - cone.apex, responsibility);
  if (!h || cone.apex == Vec2{}) return h;
  const double moved = dot(h->normal, cone.apex);
  h->offset += moved;
  for (double step = std::ldexp(std::fabs(h->offset) + std::fabs(moved), -52); responsibility >= 1.0; step *= 2.0) {
    if (vo::is_true(claim_of(cone, *h))) break;
    if (!(step < 1.0)) return std::nullopt;
    h->offset += std::fmax(step, 0x1p-1070);
  }
  return h;
}

py::object certificate_text(const Cone& cone, const HalfPlane& h) {
  const auto c = vo::certify(claim_of(cone, h));
  return c ? py::object(py::str(write_certificate(*c))) : py::none();
}

py::dict fields_of(const vo::Certificate& c) {
  const vo::HalfPlaneClaim& claim = c.claim;
  return py::dict("shape"_a = as_tuple(claim.shape), "position"_a = as_tuple(claim.position), "radius"_a = claim.radius,
                  "time_horizon"_a = claim.time_horizon, "obstacle_velocity"_a = as_tuple(claim.shape_velocity),
                  "half_plane"_a = as_tuple(claim.half_plane), "margin"_a = c.margin);
}

py::tuple leg_tuple(const vo::Leg& leg) {
  return py::make_tuple(as_tuple(leg.normal), as_tuple(leg.normal_outside), as_tuple(leg.direction),
                        as_tuple(leg.touch));
}

py::array_t<bool> contains_many(const Cone& cone, py::handle velocities) {
  require_apart(cone, "contains");
  const std::vector<Vec2> all = points(velocities, "velocities");
  py::array_t<bool> result(static_cast<py::ssize_t>(all.size()));
  bool* const out = result.mutable_data();
  const py::gil_scoped_release released;
  for (std::size_t k = 0; k < all.size(); ++k) out[k] = cone.contains(all[k]);
  return result;
}

std::vector<vo::ShiftedCone> cones_of(const py::list& cones) {
  std::vector<vo::ShiftedCone> result;
  for (const py::handle cone : cones) result.push_back(cone.cast<const Cone&>());
  return result;
}

py::tuple bracket(const geometry::Bracket& b) {
  return py::make_tuple(b.low, b.high);
}

py::list pieces_of(const geometry::Region& region) {
  py::list result;
  for (const geometry::Region::Piece& piece : region.pieces())
    result.append(py::make_tuple(rings_of(piece.polygon), bracket(piece.area)));
  return result;
}

std::vector<HalfPlane> half_planes_of(py::handle normals, py::handle offsets) {
  const std::vector<Vec2> n = points(normals, "normals");
  const Doubles c = doubles(offsets, "offsets", {static_cast<py::ssize_t>(n.size())});
  std::vector<HalfPlane> result;
  for (std::size_t k = 0; k < n.size(); ++k) {
    if (!std::isfinite(c.data()[k])) throw ArgumentError("offsets", "a number that is not finite", "finite numbers");
    result.push_back({n[k], c.data()[k]});
  }
  return result;
}

py::tuple compare(const vo::FreeVelocities& free, py::handle normals, py::handle offsets) {
  const std::vector<HalfPlane> half_planes = half_planes_of(normals, offsets);
  const vo::RegionReport report = without_gil([&] { return free.compare(half_planes); });
  py::list lost;
  for (const vo::LostPiece& piece : report.lost)
    lost.append(
        py::make_tuple(rings_of(piece.polygon), bracket(piece.area), as_tuple(piece.farthest), piece.half_plane));
  return py::make_tuple(name(report.inside), bracket(report.area), bracket(report.given_away), lost);
}

vo::FreeVelocities make_free(const py::list& cones, py::handle max_speed, py::handle tolerance) {
  vo::FreeVelocityOptions options;
  options.max_speed = positive(max_speed, "max_speed");
  options.relative_tolerance = finite(tolerance, "relative_tolerance");
  if (options.max_speed < vo::kLeastMaxSpeed || options.max_speed > vo::kMostMaxSpeed)
    throw ArgumentError("max_speed", shown(max_speed), "2^-60 to 2^60 m/s");
  if (options.relative_tolerance < 1e-7 || options.relative_tolerance > 0.1)
    throw ArgumentError("relative_tolerance", shown(tolerance), "1e-7 to 0.1");
  std::vector<vo::ShiftedCone> shifted = cones_of(cones);
  const py::gil_scoped_release released;
  return {std::move(shifted), options};
}

/// The number of components and the bracket of the area, exactly; or the word why not.
py::object exact_free(const py::list& cones, py::handle max_speed) {
  std::vector<vo::ShiftedCone> shifted = cones_of(cones);
  const double speed = positive(max_speed, "max_speed");
  const vo::FreeArrangement::Attempt attempt =
      without_gil([&] { return vo::FreeArrangement::attempt(std::move(shifted), speed); });
  if (!attempt.free) return py::str(name(attempt.refusal));
  return py::make_tuple(attempt.free->pieces().size(), bracket(attempt.free->area()));
}

}  // namespace

void bind_vo(py::module_& module) {
  py::class_<Cone>(module, "Cone")
      .def(py::init(&make_cone))
      .def("overlaps", [](const Cone& c) { return c.cone.overlaps(); })
      .def("contains",
           [](const Cone& c, py::handle v) {
             require_apart(c, "contains");
             return c.contains(vector(v, "velocity"));
           })
      .def("contains_many", &contains_many)
      .def("nearest",
           [](const Cone& c) {
             const auto n = c.cone.nearest();
             return py::make_tuple(as_tuple(n.normal), n.distance);
           })
      .def("legs",
           [](const Cone& c) -> py::object {
             const auto legs = c.cone.legs();
             return legs ? py::object(py::make_tuple(leg_tuple(legs->left), leg_tuple(legs->right))) : py::none();
           })
      .def("nearest_boundary",
           [](const Cone& c, py::handle velocity) {
             require_apart(c, "nearest_boundary");
             const auto b = c.cone.nearest_boundary(vector(velocity, "velocity") - c.apex);
             return py::make_tuple(as_tuple(b.normal), b.signed_distance, as_tuple(b.u), name(b.part));
           })
      .def("half_plane",
           [](const Cone& c, py::handle velocity, py::handle responsibility) {
             const double part = finite(responsibility, "responsibility");
             if (!(part > 0.0) || part > 1.0)
               throw ArgumentError("responsibility", shown(responsibility), "a number above 0, at most 1");
             return as_object(half_plane(c, vector(velocity, "velocity"), part));
           })
      .def("contact_half_plane",
           [](const Cone& c) {
             std::optional<HalfPlane> h = c.cone.contact_half_plane();
             if (h && c.apex != Vec2{}) h->offset += dot(h->normal, c.apex);
             return as_object(h);
           })
      .def("certificate", [](const Cone& c, py::handle normal, py::handle offset) {
        return certificate_text(c, {vector(normal, "normal"), finite(offset, "offset")});
      });
  module.def("check_certificate", [](const std::string& text) {
    const auto certificate = vo::read_certificate(text);
    return std::string(certificate ? name(check(*certificate)) : "malformed");
  });
  module.def("read_certificate", [](const std::string& text) -> py::object {
    const auto certificate = vo::read_certificate(text);
    return certificate ? py::object(fields_of(*certificate)) : py::none();
  });
  module.def("reciprocal_half_planes",
             [](py::handle position_a, py::handle velocity_a, py::handle radius_a, py::handle position_b,
                py::handle velocity_b, py::handle radius_b, py::handle time_horizon, py::handle responsibility) {
               const vo::MovingDisc a{vector(position_a, "position_a"), vector(velocity_a, "velocity_a"),
                                      at_least_zero(radius_a, "radius_a")};
               const vo::MovingDisc b{vector(position_b, "position_b"), vector(velocity_b, "velocity_b"),
                                      at_least_zero(radius_b, "radius_b")};
               vo::ReciprocalOptions options;
               options.time_horizon = positive(time_horizon, "time_horizon");
               options.responsibility_of_a = finite(responsibility, "responsibility_of_a");
               if (options.responsibility_of_a < 0.0 || options.responsibility_of_a > 1.0)
                 throw ArgumentError("responsibility_of_a", shown(responsibility), "0 to 1");
               const vo::ReciprocalHalfPlanes halves = reciprocal_half_planes(a, b, options);
               return py::make_tuple(as_tuple(halves.a), as_tuple(halves.b), halves.certified);
             });
  py::class_<vo::FreeVelocities>(module, "FreeVelocities")
      .def(py::init(&make_free))
      .def("contains", [](const vo::FreeVelocities& f, py::handle v) { return f.contains(vector(v, "velocity")); })
      .def("area", [](const vo::FreeVelocities& f) { return bracket(f.area()); })
      .def("least_components", &vo::FreeVelocities::least_components)
      .def("inner", [](const vo::FreeVelocities& f) { return pieces_of(f.inner()); })
      .def("outer", [](const vo::FreeVelocities& f) { return pieces_of(f.outer()); })
      .def("compare", &compare);
  module.def("exact_free", &exact_free);
}

}  // namespace exactvo::python
