// SPDX-License-Identifier: GPL-3.0-or-later
#include "vo/free/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "geometry/random_grown.h"

namespace exactvo::test {
namespace {

using geometry::ConvexPolygon;
using geometry::ConvexShape;
using geometry::Disc;
using geometry::Segment;
using geometry::Vec2;

using geometry::kInfinity;

// --- The corpus ---

class Numbers {
 public:
  explicit Numbers(const std::vector<double>& numbers) : numbers_(numbers) {}
  double next() {
    if (at_ == numbers_.size()) throw std::runtime_error("a free_scene with too few numbers");
    return numbers_[at_++];
  }
  std::size_t count() {
    const double n = next();
    if (!(n >= 0.0 && n <= 1000.0)) throw std::runtime_error("a free_scene with a wrong count");
    return static_cast<std::size_t>(n);
  }
  Vec2 point() {
    const double x = next();
    return {x, next()};
  }
  std::vector<Vec2> points(std::size_t n) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back(point());
    return out;
  }
  bool at_end() const { return at_ == numbers_.size(); }

 private:
  const std::vector<double>& numbers_;
  std::size_t at_ = 0;
};

/// How many points the shape has, and these; the radius of a disc after its centre.
std::vector<Vec2> points_of(const ConvexShape& shape) {
  if (const auto* disc = std::get_if<Disc>(&shape)) return {disc->center};
  if (const auto* segment = std::get_if<Segment>(&shape)) return {segment->a, segment->b};
  return std::get<ConvexPolygon>(shape).vertices;
}

ConvexShape shape_of(std::vector<Vec2> points, double radius) {
  if (points.size() == 1) return Disc{points[0], radius};
  if (points.size() == 2) return Segment{points[0], points[1]};
  return ConvexPolygon{std::move(points)};
}

// --- Random numbers ---

double one_of(SeededRandom& random, std::initializer_list<double> values) {
  return values.begin()[random.integer(0, static_cast<int>(values.size()) - 1)];
}

Vec2 lattice_point(SeededRandom& random, int size) {
  const double x = random.integer(-size, size);
  return {x, static_cast<double>(random.integer(-size, size))};
}

/// A hull of some points; a wall or a point where they lie on a line.
ConvexShape hull_shape(const std::vector<Vec2>& points) {
  const ConvexPolygon hull = geometry::convex_hull(points);
  return shape_of(hull.vertices, 0.0);
}

ConvexShape lattice_shape(SeededRandom& random, int size) {
  const Vec2 at = lattice_point(random, size);
  const int kind = random.integer(0, 5);
  if (kind == 0) return Disc{at, static_cast<double>(random.integer(0, 2))};
  std::vector<Vec2> points{at};
  for (int i = 0; i < kind; ++i) points.push_back(at + lattice_point(random, 2));
  return hull_shape(points);
}

double lattice_horizon(SeededRandom& random) {
  return one_of(random, {1.0, 2.0, 4.0, kInfinity});
}

/// Keeps what does not overlap the robot.
void add(FreeScene& scene, SceneCone cone) {
  if (scene.cones.size() < 5 && !cone_of(cone).cone.overlaps()) scene.cones.push_back(std::move(cone));
}

ConvexShape scaled(const ConvexShape& shape, double factor) {
  std::vector<Vec2> points = points_of(shape);
  for (Vec2& p : points) p = factor * p;
  const auto* disc = std::get_if<Disc>(&shape);
  return shape_of(std::move(points), disc ? factor * disc->radius : 0.0);
}

// --- The classes ---

FreeScene generic(SeededRandom& random) {
  FreeScene scene{1.5, {}};
  const int count = random.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    SceneCone cone;
    const Vec2 at = random.uniform(1.6, 4.0) * random.direction();
    cone.shape = random_shape(random, kKinds[random.integer(0, 2)], at, 1.0);
    cone.radius = random.integer(0, 2) == 0 ? 0.0 : random.uniform(0.1, 0.4);
    if (random.integer(0, 5) == 0) cone.robot = random_convex_polygon(random, {}, 0.3, 5).vertices;
    cone.time_horizon = random.integer(0, 4) == 0 ? kInfinity : random.uniform(0.5, 4.0);
    if (random.integer(0, 1) == 0) cone.apex = random.in_box(0.7);
    add(scene, cone);
  }
  return scene;
}

FreeScene walls(SeededRandom& random) {
  FreeScene scene{random.uniform(0.5, 2.5), {}};
  const double tau = random.integer(0, 4) == 0 ? kInfinity : random.uniform(0.5, 5.0);
  const Vec2 shared = random.in_box(1.0);
  for (int i = 0; i < 3; ++i) {
    SceneCone cone;
    const Vec2 at = random.uniform(1.0, 6.0) * random.direction();
    cone.shape = i == 0 ? ConvexShape{random_convex_polygon(random, at, 1.0, 6)}
                        : ConvexShape{Segment{at, at + random.in_box(4.0)}};
    cone.time_horizon = tau;
    if (i > 0) cone.apex = random.integer(0, 2) == 0 ? shared : random.in_box(1.5);
    add(scene, cone);
  }
  return scene;
}

FreeScene lattice(SeededRandom& random) {
  FreeScene scene{one_of(random, {1.0, 2.0, 3.0, 5.0}), {}};
  const int count = random.integer(2, 5);
  for (int i = 0; i < count; ++i) {
    SceneCone cone;
    cone.shape = lattice_shape(random, 6);
    cone.radius = random.integer(0, 2);
    cone.time_horizon = lattice_horizon(random);
    if (random.integer(0, 1) == 0) cone.apex = lattice_point(random, 3);
    add(scene, cone);
  }
  return scene;
}

// Fronts are circles of radius r / tau round centre / tau + apex; triangles of integers put them where they touch.
FreeScene tangent_fronts(SeededRandom& random) {
  FreeScene scene{one_of(random, {4.0, 5.0, 8.0}), {}};
  const Vec2 steps[] = {{5.0, 0.0}, {0.0, 5.0}, {3.0, 4.0}, {4.0, 3.0}, {-3.0, 4.0}, {-4.0, 3.0}, {4.0, -3.0}};
  const Vec2 at = lattice_point(random, 3);
  const double r = random.integer(1, 4);
  const auto front = [&](Vec2 centre, double radius) {
    const Vec2 seen = one_of(random, {2.0, 3.0}) * radius * steps[random.integer(0, 6)];
    const double tau = one_of(random, {1.0, 2.0});
    add(scene, {Disc{tau * seen, tau * radius}, 0.0, {}, tau, centre - seen});
  };
  front(at, r);
  const Vec2 step = steps[random.integer(0, 6)];
  front(at + step, 5.0 - r);                                        // touches from outside
  if (random.integer(0, 1) == 0) front(at - step, 5.0 - r);         // on the other side, through another point
  if (random.integer(0, 1) == 0) front(at - step, 5.0 + r);         // from inside
  if (random.integer(0, 1) == 0) front(at + 2.0 * step, 10.0 - r);  // through the first point as well
  return scene;
}

FreeScene shared_legs(SeededRandom& random) {
  FreeScene scene{one_of(random, {1.0, 2.0, 5.0}), {}};
  const ConvexShape shape = lattice_shape(random, 6);
  const double radius = random.integer(0, 1);
  const Vec2 apex = random.integer(0, 1) == 0 ? Vec2{} : lattice_point(random, 2);
  for (const double factor : {1.0, 2.0, 4.0}) {
    if (random.integer(0, 3) == 0) continue;
    add(scene, {scaled(shape, factor), factor * radius, {}, lattice_horizon(random), apex});
  }
  // One that shares a single leg, or its line: a wall from a corner of the shape.
  const Vec2 corner = points_of(shape).front();
  add(scene,
      {hull_shape({2.0 * corner, 2.0 * corner + lattice_point(random, 3)}), 0.0, {}, lattice_horizon(random), apex});
  add(scene, {hull_shape({-1.0 * corner, lattice_point(random, 3) - corner}), 0.0, {}, lattice_horizon(random), apex});
  return scene;
}

FreeScene apex_on_boundary(SeededRandom& random) {
  FreeScene scene{one_of(random, {2.0, 5.0}), {}};
  SceneCone first{lattice_shape(random, 5), 0.0, {}, lattice_horizon(random), lattice_point(random, 1)};
  add(scene, first);
  const std::vector<Vec2> points = points_of(first.shape);
  const double scale = std::isinf(first.time_horizon) ? 1.0 : 1.0 / first.time_horizon;
  const Vec2 places[] = {first.apex + scale * points.front(),
                         first.apex + 0.5 * scale * (points.front() + points.back()),
                         first.apex + 2.0 * scale * points.back(), first.apex};
  const int count = random.integer(1, 3);
  for (int i = 0; i < count; ++i) {
    add(scene, {lattice_shape(random, 5),
                static_cast<double>(random.integer(0, 1)),
                {},
                random.integer(0, 1) == 0 ? kInfinity : lattice_horizon(random),
                places[random.integer(0, 3)]});
  }
  return scene;
}

FreeScene walls_in_line(SeededRandom& random) {
  FreeScene scene{one_of(random, {1.0, 2.0, 5.0}), {}};
  const Vec2 along = lattice_point(random, 2), shared = lattice_point(random, 1);
  const int count = random.integer(2, 5);
  for (int i = 0; i < count; ++i) {
    const double at = random.integer(1, 4) * (random.integer(0, 2) == 0 ? -1.0 : 1.0);
    const Vec2 near = at * along, far = (at < 0.0 ? at - random.integer(0, 2) : at + random.integer(0, 2)) * along;
    SceneCone cone{
        hull_shape({near, far}), 0.0, {}, lattice_horizon(random), random.integer(0, 2) == 0 ? Vec2{} : shared};
    if (random.integer(0, 2) == 0) cone.apex = static_cast<double>(random.integer(-2, 2)) * along;
    if (random.integer(0, 3) == 0) cone.shape = hull_shape({near, far, near + lattice_point(random, 2)});
    if (random.integer(0, 4) == 0) cone = {lattice_shape(random, 4), 0.0, {}, lattice_horizon(random), cone.apex};
    if (random.integer(0, 5) == 0) cone.radius = 1.0;
    add(scene, cone);
  }
  return scene;
}

FreeScene parallel_legs(SeededRandom& random) {
  FreeScene scene{random.uniform(1.0, 3.0), {}};
  const bool is_lattice = random.integer(0, 1) == 0;
  const ConvexShape shape = is_lattice
                                ? lattice_shape(random, 5)
                                : random_shape(random, kKinds[random.integer(0, 2)], 3.0 * random.direction(), 1.0);
  const double radius = random.integer(0, 1) == 0 ? 0.0 : 0.25;
  const int count = random.integer(2, 4);
  for (int i = 0; i < count; ++i)
    add(scene,
        {shape, radius, {}, lattice_horizon(random), is_lattice ? lattice_point(random, 2) : random.in_box(1.0)});
  return scene;
}

// Each leg runs from an apex on the lattice through the same point, which walls of integers make exact.
FreeScene concurrent(SeededRandom& random) {
  FreeScene scene{one_of(random, {3.0, 5.0}), {}};
  const Vec2 through = lattice_point(random, 2);
  for (int i = 0; i < 5; ++i) {
    const Vec2 apex = lattice_point(random, 4), d = through - apex;
    if (d == Vec2{}) continue;
    const double sign = random.integer(0, 1) == 0 ? 1.0 : -1.0;
    const double factor = one_of(random, {1.0, 2.0});
    add(scene, {hull_shape({factor * d, factor * (d + sign * perp(d)) + lattice_point(random, 1)}),
                0.0,
                {},
                random.integer(0, 1) == 0 ? kInfinity : one_of(random, {factor, 2.0 * factor}),
                apex});
  }
  return scene;
}

FreeScene speed_circle(SeededRandom& random) {
  FreeScene scene{5.0, {}};
  const Vec2 points[] = {{5.0, 0.0}, {0.0, 5.0}, {3.0, 4.0}, {-3.0, 4.0}, {4.0, -3.0}, {-5.0, 0.0}};
  const int count = random.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    const Vec2 on = points[random.integer(0, 5)];
    switch (random.integer(0, 4)) {
      case 0:  // an apex on the circle
        add(scene, {lattice_shape(random, 5), 0.0, {}, kInfinity, on});
        break;
      case 1: {  // a front that touches it from outside, or from inside
        const double s = one_of(random, {1.4, 0.6, 2.0});
        add(scene, {Disc{5.0 * on, std::fabs(s - 1.0) * 5.0}, 0.0, {}, 1.0, (s - 5.0) * on});
        break;
      }
      case 2:  // a leg along a tangent
        add(scene, {hull_shape({3.0 * perp(on), 3.0 * perp(on) + lattice_point(random, 3)}),
                    0.0,
                    {},
                    lattice_horizon(random),
                    on - 2.0 * perp(on)});
        break;
      case 3:  // a wall's front with an end on the circle
        add(scene, {hull_shape({on, on + lattice_point(random, 4)}), 0.0, {}, 1.0, {}});
        break;
      default:  // the circle itself, or one with the same centre
        add(scene, {Disc{{20.0, 0.0}, one_of(random, {5.0, 4.0, 6.0})}, 0.0, {}, 1.0, {-20.0, 0.0}});
    }
  }
  return scene;
}

FreeScene polygonal_robots(SeededRandom& random) {
  FreeScene scene = lattice(random);
  const std::vector<Vec2> robots[] = {{{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}},
                                      {{-1.0, 0.0}, {1.0, -1.0}, {1.0, 1.0}},
                                      {{0.0, -1.0}, {2.0, 0.0}, {0.0, 1.0}}};
  const std::vector<Vec2>& robot = robots[random.integer(0, 2)];
  FreeScene out{scene.max_speed, {}};
  for (SceneCone cone : scene.cones) {
    cone.radius = 0.0;
    cone.robot = robot;
    add(out, cone);
  }
  return out;
}

double nudged(SeededRandom& random, double x) {
  if (x == 0.0 || random.integer(0, 2) != 0) return x;
  const double ulp = std::fabs(x) * 0x1p-52;
  return x + random.integer(-2, 2) * ulp;
}

FreeScene nudged_scene(SeededRandom& random) {
  const FreeScene scene = random_scene(random, static_cast<SceneClass>(random.integer(2, 9)));
  FreeScene out{scene.max_speed, {}};
  for (SceneCone cone : scene.cones) {
    std::vector<Vec2> points = points_of(cone.shape);
    for (Vec2& p : points) p = {nudged(random, p.x), nudged(random, p.y)};
    const auto* disc = std::get_if<Disc>(&cone.shape);
    // A polygon stays as it is: it would no longer be convex.
    if (points.size() < 3) cone.shape = shape_of(points, disc ? nudged(random, disc->radius) : 0.0);
    cone.radius = nudged(random, cone.radius);
    cone.apex = {nudged(random, cone.apex.x), nudged(random, cone.apex.y)};
    if (std::isfinite(cone.time_horizon)) cone.time_horizon = nudged(random, cone.time_horizon);
    add(out, cone);
  }
  return out;
}

}  // namespace

vo::ShiftedCone cone_of(const SceneCone& cone) {
  const geometry::VectorSum minus_apex{{-cone.apex}};
  if (!cone.robot.empty())
    return {{cone.shape, {}, ConvexPolygon{cone.robot}, cone.time_horizon}, minus_apex, cone.apex};
  return {{cone.shape, {}, cone.radius, cone.time_horizon}, minus_apex, cone.apex};
}

std::vector<vo::ShiftedCone> cones_of(const FreeScene& scene) {
  std::vector<vo::ShiftedCone> out;
  for (const SceneCone& cone : scene.cones) out.push_back(cone_of(cone));
  return out;
}

// A cone: the number of its points, these, the radius of the disc; the robot's radius, the number of its vertices,
// these; the horizon; the apex.
std::string corpus_line(const FreeScene& scene) {
  std::string line = "free_scene";
  const auto number = [&line](double x) { line += " " + geometry::hex_text(x); };
  const auto points = [&](const std::vector<Vec2>& all) {
    line += " " + std::to_string(all.size());
    for (const Vec2 p : all) {
      number(p.x);
      number(p.y);
    }
  };
  number(scene.max_speed);
  line += " " + std::to_string(scene.cones.size());
  for (const SceneCone& cone : scene.cones) {
    points(points_of(cone.shape));
    const auto* disc = std::get_if<Disc>(&cone.shape);
    number(disc ? disc->radius : 0.0);
    number(cone.radius);
    points(cone.robot);
    number(cone.time_horizon);
    number(cone.apex.x);
    number(cone.apex.y);
  }
  return line;
}

FreeScene free_scene_of(const CorpusCase& corpus_case) {
  if (corpus_case.kind != "free_scene")
    throw std::runtime_error("found a case \"" + corpus_case.kind + "\", expected \"free_scene\"");
  Numbers numbers(corpus_case.numbers);
  FreeScene scene{numbers.next(), {}};
  const std::size_t cones = numbers.count();
  for (std::size_t i = 0; i < cones; ++i) {
    SceneCone cone;
    std::vector<Vec2> points = numbers.points(numbers.count());
    cone.shape = shape_of(std::move(points), numbers.next());
    cone.radius = numbers.next();
    cone.robot = numbers.points(numbers.count());
    cone.time_horizon = numbers.next();
    cone.apex = numbers.point();
    scene.cones.push_back(std::move(cone));
  }
  if (!numbers.at_end()) throw std::runtime_error("a free_scene with too many numbers");
  return scene;
}

const char* name(SceneClass scene_class) {
  constexpr const char* kNames[] = {
      "generic",       "walls",         "lattice",    "tangent_fronts", "shared_legs",      "apex_on_boundary",
      "walls_in_line", "parallel_legs", "concurrent", "speed_circle",   "polygonal_robots", "nudged"};
  return kNames[static_cast<int>(scene_class)];
}

FreeScene random_scene(SeededRandom& random, SceneClass scene_class) {
  constexpr FreeScene (*kMake[])(SeededRandom&) = {
      generic,       walls,         lattice,    tangent_fronts, shared_legs,      apex_on_boundary,
      walls_in_line, parallel_legs, concurrent, speed_circle,   polygonal_robots, nudged_scene};
  return kMake[static_cast<int>(scene_class)](random);
}

}  // namespace exactvo::test
