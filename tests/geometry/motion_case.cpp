// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/motion_case.h"

#include <cmath>
#include <stdexcept>

namespace exactvo::test {
namespace {

using geometry::CurveBasis;
using geometry::CurvedMotion;
using geometry::Encounter;
using geometry::hex_text;
using geometry::Motion;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::RigidBody;
using geometry::Ring;
using geometry::RoundedPolygon;
using geometry::StraightMotion;
using geometry::Vec2;

// --- The corpus ---

std::string text_of(const Motion& m) {
  if (const auto* s = std::get_if<StraightMotion>(&m))
    return " -1 " + hex_text(s->from.time) + " " + hex_text(s->from.at.x) + " " + hex_text(s->from.at.y) + " " +
           hex_text(s->to.time) + " " + hex_text(s->to.at.x) + " " + hex_text(s->to.at.y);
  const auto& c = std::get<CurvedMotion>(m);
  return " " + std::to_string(static_cast<int>(c.basis)) + " " + hex_text(c.start) + " " + hex_text(c.end) + " " +
         geometry::to_string(c.points);
}
std::string text_of(const RigidBody& body) {
  std::string text = " " + std::to_string(body.size());
  for (const RoundedPolygon& part : body) text += " " + hex_text(part.radius) + " " + geometry::to_string(part.corners);
  return text;
}
std::string text_of(const Obstacle& obstacle) {
  if (const auto* wall = std::get_if<Polyline>(&obstacle)) return " 0 " + geometry::to_string(wall->points);
  const auto& polygon = std::get<Polygon>(obstacle);
  std::string text = " " + std::to_string(1 + polygon.holes.size()) + " " + geometry::to_string(polygon.outer);
  for (const Ring& hole : polygon.holes) text += " " + geometry::to_string(hole);
  return text;
}

class Reader {
 public:
  explicit Reader(const CorpusCase& line) : line_(line) {}
  double number() {
    if (next_ >= line_.numbers.size()) throw std::runtime_error(line_.kind + ": expected more numbers");
    return line_.numbers[next_++];
  }
  std::size_t count() {
    const double n = number();
    if (!(n >= 0.0 && n < 1e6 && n == std::floor(n))) throw std::runtime_error(line_.kind + ": expected a count");
    return static_cast<std::size_t>(n);
  }
  std::vector<Vec2> points() {
    std::vector<Vec2> all(count());
    for (Vec2& p : all) {
      p.x = number();
      p.y = number();
    }
    return all;
  }
  Motion motion() {
    const double basis = number();
    if (basis < 0.0) {
      StraightMotion m;
      for (geometry::TimedPoint* p : {&m.from, &m.to}) {
        p->time = number();
        p->at.x = number();
        p->at.y = number();
      }
      return m;
    }
    CurvedMotion m;
    m.basis = static_cast<CurveBasis>(static_cast<int>(basis));
    m.start = number();
    m.end = number();
    m.points = points();
    return m;
  }
  RigidBody body() {
    RigidBody parts(count());
    for (RoundedPolygon& part : parts) {
      part.radius = number();
      part.corners = points();
    }
    return parts;
  }
  Obstacle obstacle() {
    const std::size_t rings = count();
    if (rings == 0) return Polyline{points()};
    Polygon polygon;
    polygon.outer = points();
    for (std::size_t i = 1; i < rings; ++i) polygon.holes.push_back(points());
    return polygon;
  }
  bool at_end() const { return next_ == line_.numbers.size(); }

 private:
  const CorpusCase& line_;
  std::size_t next_ = 0;
};

// --- Random cases ---

/// A Pythagorean triple p^2 + q^2 = h^2 with signs.
struct Triple {
  double p, q, h;
};
Triple random_triple(SeededRandom& random) {
  const int m = random.integer(2, 12), n = random.integer(1, m - 1);
  const double a = m * m - n * n, b = 2 * m * n, h = m * m + n * n;
  const double x = random.integer(0, 1) ? a : -a, y = random.integer(0, 1) ? b : -b;
  return random.integer(0, 1) ? Triple{x, y, h} : Triple{y, x, h};
}

double power_of_two(SeededRandom& random, int low, int high) {
  return std::ldexp(1.0, random.integer(low, high));
}
double whole(SeededRandom& random, int most) {
  return random.integer(-most, most);
}
Vec2 whole_point(SeededRandom& random, int most) {
  const double x = whole(random, most);
  return {x, whole(random, most)};
}

/// Times, in a fine grid or not: some equal, some of no duration.
void random_times(SeededRandom& random, StraightMotion& m) {
  m.from.time = random.integer(0, 3) ? random.integer(0, 8) * 0.25 : random.uniform(0.0, 2.0);
  const int kind = random.integer(0, 9);
  const double lasts = kind == 0 ? 0.0 : kind < 4 ? random.integer(1, 8) * 0.25 : random.uniform(0.01, 3.0);
  m.to.time = m.from.time + lasts;
}

/// The same times, touching spans, spans apart or others.
void times_of_second(SeededRandom& random, const StraightMotion& a, StraightMotion& b) {
  const int kind = random.integer(0, 9);
  if (kind < 5) {
    b.from.time = a.from.time;
    b.to.time = a.to.time;
  } else if (kind == 5) {
    b.from.time = a.to.time;
    b.to.time = a.to.time + random.integer(0, 4) * 0.5;
  } else if (kind == 6) {
    b.from.time = a.to.time + 0.125;
    b.to.time = b.from.time + 1.0;
  } else {
    random_times(random, b);
  }
}

/// Anywhere: ordinary sizes, far from the origin, tiny or large.
MotionCase random_discs(SeededRandom& random) {
  const double unit = random.integer(0, 3) ? 1.0 : std::pow(10.0, random.uniform(-9.0, 6.0));
  const Vec2 far = random.integer(0, 2) ? Vec2{} : random.in_box(1e6);
  StraightMotion a, b;
  const auto point = [&] { return far + unit * random.in_box(3.0); };
  a.from.at = point();
  a.to.at = point();
  b.from.at = point();
  b.to.at = point();
  random_times(random, a);
  times_of_second(random, a, b);
  const int kind = random.integer(0, 9);
  if (kind == 0) a.to.at = a.from.at;
  if (kind == 1) b = geometry::held(b.from, b.to.time);
  if (kind == 2) b.to.at = b.from.at + (a.to.at - a.from.at);
  const double radius = random.integer(0, 5) ? unit * random.uniform(0.0, 1.0) : 0.0;
  const double other = random.integer(0, 5) ? unit * random.uniform(0.0, 1.0) : 0.0;
  return {a, geometry::disc_body(radius), b, geometry::disc_body(other), std::nullopt, std::nullopt};
}

/// An ulp or so more or less than a number, or the number.
double nearly(SeededRandom& random, double x, int& side) {
  side = random.integer(-1, 1);
  return side == 0 ? x : std::nextafter(x, side > 0 ? 1e300 : 0.0);
}

/// Passing at exactly the sum of the radii, or an ulp nearer or farther. Whole numbers times a power of two, so that
/// nothing rounds; both get the same motion on top.
MotionCase grazing_discs(SeededRandom& random) {
  const Triple n = random_triple(random);
  const double unit = power_of_two(random, -20, 10);
  const int k = random.integer(2, 40);
  // Relative to b, a passes n r at the share before / (before + after) of its way, which runs along perp(n).
  const double before = random.integer(0, 20), after = random.integer(before == 0.0 ? 1 : 0, 20);
  const Vec2 along{-n.q, n.p}, nearest{k * n.p, k * n.q};
  const Vec2 start = whole_point(random, 1 << 20), way = whole_point(random, 1000);
  StraightMotion a, b;
  b.from = {0.0, unit * start};
  b.to = {1.0, unit * (start + way)};
  a.from = {0.0, unit * (start + nearest - before * along)};
  a.to = {1.0, unit * (start + way + nearest + after * along)};
  const double start_time = random.integer(0, 16) * 0.25;
  for (StraightMotion* m : {&a, &b}) {
    m->from.time += start_time;
    m->to.time += start_time;
  }
  int side = 0;
  const int first = random.integer(1, k);
  const double radius = nearly(random, unit * first * n.h, side);
  const double other = unit * (k - first) * n.h;
  const Encounter known = side > 0 ? Encounter::overlap : side < 0 ? Encounter::clear : Encounter::contact;
  return {a, geometry::disc_body(radius), b, geometry::disc_body(other), std::nullopt, known};
}

/// In contact at the moment that the two have in common as one ends, or at a frame.
MotionCase contact_at_frame(SeededRandom& random) {
  const Triple n = random_triple(random);
  const double unit = power_of_two(random, -20, 10);
  const double k = random.integer(1, 40);
  const Vec2 at = whole_point(random, 1 << 20);
  const Vec2 out{n.p, n.q};
  // Both move away from each other before or after the frame.
  StraightMotion a, b;
  const double frame = random.integer(0, 16) * 0.25, lasts = random.integer(1, 8) * 0.5;
  a.to = {frame, unit * (at + k * out)};
  a.from = {frame - lasts, unit * (at + k * out + random.integer(0, 9) * out + whole(random, 9) * Vec2{-n.q, n.p})};
  b.from = {frame, unit * at};
  b.to = {frame + lasts, unit * (at + whole_point(random, 50))};
  if (random.integer(0, 1)) {
    b.from.time = frame - lasts;
    b.to = {frame, unit * at};
    b.from.at = unit * (at - random.integer(0, 9) * out);
  }
  int side = 0;
  const double radius = nearly(random, unit * k * n.h, side);
  const Encounter known = side > 0 ? Encounter::overlap : side < 0 ? Encounter::clear : Encounter::contact;
  return {a, geometry::disc_body(radius), b, geometry::disc_body(0.0), std::nullopt, known};
}

Obstacle random_obstacle(SeededRandom& random, Vec2 far, double unit) {
  const auto point = [&] { return far + unit * random.in_box(3.0); };
  const int kind = random.integer(0, 5);
  if (kind < 2) return Polyline{{point(), point()}};
  if (kind == 2) {  // a needle
    const Vec2 p = point(), along = unit * 3.0 * random.direction();
    return Polyline{{p, p + along, p + (1.0 + 1e-12) * along + 1e-12 * unit * random.in_box(1.0)}};
  }
  if (kind == 3) return Polyline{{point(), point(), point()}};
  // Star-shaped round a point: simple, not convex.
  const Vec2 centre = point();
  const int n = random.integer(3, 7);
  Polygon polygon;
  for (int i = 0; i < n; ++i) {
    const double angle = (i + random.uniform(0.1, 0.9)) * 6.283185307179586 / n;
    polygon.outer.push_back(centre + unit * random.uniform(0.3, 2.0) * Vec2{std::cos(angle), std::sin(angle)});
  }
  if (n > 4 && random.integer(0, 2) == 0) {
    Ring hole;
    for (int i = 2; i >= 0; --i) hole.push_back(centre + 0.05 * unit * Vec2{std::cos(2.1 * i), std::sin(2.1 * i)});
    polygon.holes.push_back(hole);
  }
  return polygon;
}

MotionCase random_disc_and_edges(SeededRandom& random) {
  const double unit = random.integer(0, 3) ? 1.0 : std::pow(10.0, random.uniform(-9.0, 6.0));
  const Vec2 far = random.integer(0, 2) ? Vec2{} : random.in_box(1e6);
  StraightMotion a;
  a.from.at = far + unit * random.in_box(3.0);
  a.to.at = random.integer(0, 9) ? far + unit * random.in_box(3.0) : a.from.at;
  random_times(random, a);
  const double radius = random.integer(0, 4) ? unit * random.uniform(0.0, 1.0) : 0.0;
  return {a, geometry::disc_body(radius), std::nullopt, {}, random_obstacle(random, far, unit), std::nullopt};
}

/// Along a wall, or round its end, at exactly the radius; on whole numbers.
MotionCase grazing_edges(SeededRandom& random) {
  const Triple n = random_triple(random);
  const double unit = power_of_two(random, -20, 10);
  const double k = random.integer(1, 40);
  const Vec2 at = whole_point(random, 1 << 20), out{n.p, n.q}, along{-n.q, n.p};
  StraightMotion a;
  Polyline wall;
  const int kind = random.integer(0, 2);
  if (kind == 0) {  // parallel
    a.from.at = unit * (at + k * out + whole(random, 30) * along);
    a.to.at = unit * (at + k * out + random.integer(-5, 60) * along);
    wall.points = {unit * (at - 30.0 * along), unit * (at + 30.0 * along)};
  } else if (kind == 1) {  // past the wall's end, across
    a.from.at = unit * (at + k * out - random.integer(0, 20) * along);
    a.to.at = unit * (at + k * out + random.integer(0, 20) * along);
    wall.points = {unit * at, unit * (at - random.integer(1, 30) * out)};
  } else {  // with its end onto the wall
    a.from.at = unit * (at + (k + random.integer(0, 30)) * out + whole(random, 30) * along);
    a.to.at = unit * (at + k * out + whole(random, 29) * along);
    wall.points = {unit * (at - 30.0 * along), unit * (at + 30.0 * along)};
  }
  if (random.integer(0, 1)) std::swap(a.from.at, a.to.at);
  a.from.time = 0.0;
  a.to.time = 1.0;
  int side = 0;
  const double radius = nearly(random, unit * k * n.h, side);
  std::optional<Encounter> known = side > 0 ? Encounter::overlap : side < 0 ? Encounter::clear : Encounter::contact;
  if (kind == 0) known.reset();  // the way may lie beyond the wall's end
  return {a, geometry::disc_body(radius), std::nullopt, {}, wall, known};
}

/// A point on whole numbers among walls and rooms on whole numbers: along edges, through corners, from edge to edge.
MotionCase point_among_whole_numbers(SeededRandom& random) {
  StraightMotion a;
  a.from = {0.0, whole_point(random, 4)};
  a.to = {1.0, whole_point(random, 4)};
  Obstacle obstacle = Polyline{{whole_point(random, 4), whole_point(random, 4)}};
  const int kind = random.integer(0, 3);
  if (kind == 1) obstacle = Polygon{{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}, {}};
  if (kind == 2) obstacle = Polygon{{{-3, -3}, {3, -3}, {3, 3}, {0, 0}, {-3, 3}}, {}};
  if (kind == 3) obstacle = Polygon{{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}}, {{{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}}};
  const double radius = random.integer(0, 2) ? 0.0 : random.integer(1, 3);
  return {a, geometry::disc_body(radius), std::nullopt, {}, obstacle, std::nullopt};
}

// --- Curved motions ---

CurvedMotion random_curve(SeededRandom& random, Vec2 far, double unit, double start, double end) {
  CurvedMotion m;
  m.basis = static_cast<CurveBasis>(random.integer(0, 2));
  m.start = start;
  m.end = end;
  const int degree = random.integer(0, 9) ? random.integer(0, 4) : random.integer(5, 7);
  for (int k = 0; k <= degree; ++k)
    m.points.push_back(m.basis == CurveBasis::powers && k > 0 ? unit * random.in_box(3.0)
                                                              : far + unit * random.in_box(3.0));
  return m;
}

MotionCase random_curved_discs(SeededRandom& random) {
  MotionCase c = random_discs(random);
  const auto& a = std::get<StraightMotion>(c.a);
  const Vec2 far = a.from.at;
  const double unit = std::fmax(1e-12, norm(a.to.at - a.from.at) / 3.0);
  const double start = a.from.time, end = a.to.time;
  c.a = random_curve(random, far, unit, start, end);
  if (random.integer(0, 1)) {
    const auto b = std::get<StraightMotion>(*c.b);
    c.b = random_curve(random, far, unit, b.from.time, b.to.time);
  }
  return c;
}

/// A parabola, or a curve of degree 4 that is in contact at an irrational time, touching a disc from outside: seen
/// along n, p = R + y^2, and across it y, with y = (t - t0) or t^2 - 1/2. With a common motion of both on top.
MotionCase grazing_curves(SeededRandom& random) {
  const Triple n = random_triple(random);
  const double k = random.integer(1, 40);
  const bool irrational = random.integer(0, 1) != 0;
  const double t0 = random.integer(0, 8) * 0.125;
  // Powers of t: y, and y^2.
  std::vector<double> y = irrational ? std::vector<double>{-0.5, 0.0, 1.0} : std::vector<double>{-t0, 1.0};
  std::vector<double> y2(2 * y.size() - 1, 0.0);
  for (std::size_t i = 0; i < y.size(); ++i)
    for (std::size_t j = 0; j < y.size(); ++j) y2[i + j] += y[i] * y[j];
  y.resize(y2.size(), 0.0);
  CurvedMotion a{CurveBasis::powers, 0.0, 1.0, {}}, b{CurveBasis::powers, 0.0, 1.0, {}};
  const Vec2 out{n.p, n.q}, along{-n.q, n.p};
  for (std::size_t i = 0; i < y2.size(); ++i) {
    const Vec2 common = whole_point(random, i == 0 ? 1 << 20 : 100);
    a.points.push_back(common + (y2[i] + (i == 0 ? k : 0.0)) * out + y[i] * along);
    b.points.push_back(common);
  }
  int side = 0;
  const double radius = nearly(random, k * n.h, side);
  const Encounter known = side > 0 ? Encounter::overlap : side < 0 ? Encounter::clear : Encounter::contact;
  return {a, geometry::disc_body(radius), b, geometry::disc_body(0.0), std::nullopt, known};
}

MotionCase random_curved_edges(SeededRandom& random) {
  MotionCase c = random_disc_and_edges(random);
  const auto a = std::get<StraightMotion>(c.a);
  const double unit = std::fmax(1e-12, norm(a.to.at - a.from.at) / 3.0);
  c.a = random_curve(random, a.from.at, unit, a.from.time, a.to.time);
  return c;
}

/// The same curves, onto a wall of which they touch the side or the end.
MotionCase grazing_curve_and_wall(SeededRandom& random) {
  MotionCase c = grazing_curves(random);
  CurvedMotion& a = std::get<CurvedMotion>(c.a);
  const std::vector<Vec2> b = std::get<CurvedMotion>(*c.b).points;
  for (std::size_t i = 0; i < b.size(); ++i) a.points[i] = a.points[i] - b[i];
  const Vec2 out = a.points.back(), along{-out.y, out.x};  // the coefficient of y^2
  Polyline wall{{-40.0 * along, 40.0 * along}};
  if (random.integer(0, 1)) wall.points = {Vec2{}, Vec2{} - 3.0 * out};
  c.b.reset();
  c.body_b.clear();
  c.obstacle = wall;
  return c;
}

// --- Bodies ---

RigidBody random_body(SeededRandom& random, double unit) {
  RigidBody body;
  const int parts = random.integer(1, 2);
  for (int i = 0; i < parts; ++i) {
    RoundedPolygon part;
    part.corners.clear();
    const int n = random.integer(1, 5);
    for (int k = 0; k < n; ++k) part.corners.push_back(unit * random.in_box(0.5));
    part.radius = n == 2 || random.integer(0, 1) ? unit * random.uniform(0.01, 0.4) : 0.0;
    body.push_back(part);
  }
  return body;
}

/// Boxes on whole numbers, sliding along each other, corner to corner.
MotionCase boxes_on_whole_numbers(SeededRandom& random) {
  const auto box = [&] {
    const double w = random.integer(1, 3), h = random.integer(1, 3);
    return RigidBody{{{{-w, -h}, {w, -h}, {w, h}, {-w, h}}, random.integer(0, 3) ? 0.0 : 1.0}};
  };
  StraightMotion a{{0.0, whole_point(random, 6)}, {1.0, whole_point(random, 6)}};
  StraightMotion b{{0.0, whole_point(random, 6)}, {1.0, whole_point(random, 6)}};
  MotionCase c{a, box(), b, box(), std::nullopt, std::nullopt};
  if (random.integer(0, 1)) {
    c.b.reset();
    c.body_b.clear();
    c.obstacle = Polygon{{{-7, -7}, {7, -7}, {7, 7}, {0, 1}, {-7, 7}}, {}};
    if (random.integer(0, 1)) c.obstacle = Polyline{{{-2, -1}, {3, -1}, {5, 4}}};
  }
  return c;
}

MotionCase random_bodies(SeededRandom& random) {
  const int kind = random.integer(0, 9);
  MotionCase c = kind < 3   ? random_discs(random)
                 : kind < 6 ? random_disc_and_edges(random)
                 : kind < 8 ? random_curved_discs(random)
                            : random_curved_edges(random);
  double unit = 1.0;
  if (const auto* s = std::get_if<StraightMotion>(&c.a)) unit = std::fmax(1e-9, norm(s->to.at - s->from.at) / 3.0);
  c.body_a = random_body(random, unit);
  if (c.b) c.body_b = random_body(random, unit);
  c.known.reset();
  return c;
}

}  // namespace

Encounter encounter(const MotionCase& c) {
  return c.b ? geometry::encounter(c.a, c.body_a, *c.b, c.body_b) : geometry::encounter(c.a, c.body_a, *c.obstacle);
}

geometry::MotionVerdict examine(const MotionCase& c) {
  return c.b ? geometry::examine(c.a, c.body_a, *c.b, c.body_b) : geometry::examine(c.a, c.body_a, *c.obstacle);
}

std::string corpus_line(const MotionCase& c) {
  if (c.b) return "motion_pair" + text_of(c.a) + text_of(c.body_a) + text_of(*c.b) + text_of(c.body_b);
  return "motion_obstacle" + text_of(c.a) + text_of(c.body_a) + text_of(*c.obstacle);
}

MotionCase motion_case_of(const CorpusCase& line) {
  Reader reader(line);
  MotionCase c;
  c.a = reader.motion();
  c.body_a = reader.body();
  if (line.kind == "motion_pair") {
    c.b = reader.motion();
    c.body_b = reader.body();
  } else if (line.kind == "motion_obstacle") {
    c.obstacle = reader.obstacle();
  } else {
    throw std::runtime_error("expected motion_pair or motion_obstacle, found " + line.kind);
  }
  if (!reader.at_end()) throw std::runtime_error(line.kind + ": expected no more numbers");
  return c;
}

const char* name_of(MotionKind kind) {
  static const char* const kNames[] = {"discs", "disc-and-edges", "curved-discs", "curved-edges", "bodies"};
  return kNames[static_cast<int>(kind)];
}

MotionCase random_motion_case(SeededRandom& random, MotionKind kind) {
  const int which = random.integer(0, 3);
  switch (kind) {
    case MotionKind::discs:
      return which == 0 ? grazing_discs(random) : which == 1 ? contact_at_frame(random) : random_discs(random);
    case MotionKind::disc_and_edges:
      return which == 0   ? grazing_edges(random)
             : which == 1 ? point_among_whole_numbers(random)
                          : random_disc_and_edges(random);
    case MotionKind::curved_discs:
      return which == 0 ? grazing_curves(random) : random_curved_discs(random);
    case MotionKind::curved_edges:
      return which == 0 ? grazing_curve_and_wall(random) : random_curved_edges(random);
    case MotionKind::bodies:
      return which == 0 ? boxes_on_whole_numbers(random) : random_bodies(random);
  }
  throw std::logic_error("unknown kind");
}

}  // namespace exactvo::test
