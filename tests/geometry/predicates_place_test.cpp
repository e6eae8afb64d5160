// SPDX-License-Identifier: GPL-3.0-or-later
// Predicates B1 (a point against S), B2 (a segment from the robot against S) and E.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "geometry/exact_oracle.h"
#include "geometry/random_grown.h"

namespace exactvo::test {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::locate;
using geometry::perp;
using geometry::Place;
using geometry::Segment;
using geometry::segment_meets;
using geometry::Vec2;

using geometry::kInfinity;

int as_int(Place p) {
  return static_cast<int>(p);
}

/// Near the boundary of S: a rounded support point moved along its normal by a few to many ulps, or by a good part.
Vec2 near_boundary(SeededRandom& random, const RandomScene& scene) {
  const Vec2 n = random.direction();
  const double by = scene.size * std::pow(10.0, random.uniform(-18.0, 0.0));
  return support_point(scene.s, n) + (random.integer(0, 1) != 0 ? by : -by) * n;
}

TEST(Locate, AgreesWithNearestPointsInRationals) {
  SeededRandom random(seed_of_run(21));
  for (int i = 0; i < 12000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 q = near_boundary(random, scene);
    ASSERT_EQ(as_int(locate(scene.s, q)), place_in(scene.s, exactly(q)))
        << to_string(scene.s.shape) << " q " << geometry::to_string(std::vector<Vec2>{q, scene.s.origin}) << " r "
        << geometry::hex_text(scene.s.radius);
  }
}

TEST(Locate, TangentEllipsesTouchAndAnUlpDecides) {
  SeededRandom random(seed_of_run(22));
  for (int i = 0; i < 10000; ++i) {
    const TangentCase t = random_tangent_ellipse(random);
    ASSERT_EQ(locate(t.s, t.touch), Place::boundary) << to_string(t.s.shape);
    // A step along the outward normal leaves; S is convex, so a short one against it enters unless S is a point.
    const double step = std::ldexp(1.0, std::ilogb(norm(t.touch) + 1e-300) - 48);
    ASSERT_EQ(locate(t.s, t.touch + step * t.normal), Place::outside);
  }
}

TEST(Locate, TangentDiscsAndCapsulesTouch) {
  SeededRandom random(seed_of_run(23));
  for (int i = 0; i < 5000; ++i) {
    const Pythagorean n = random_pythagorean(random);
    const double unit = std::ldexp(1.0, random.integer(-30, 10));
    const Vec2 centre{random.integer(-999, 999) * unit, random.integer(-999, 999) * unit};
    const double r = random.integer(1, 99) * n.h * unit;
    const Vec2 touch = centre + (r / n.h) * Vec2{n.p, n.q};
    ASSERT_EQ(locate({Disc{centre, 0.25 * r}, {}, 0.75 * r}, touch), Place::boundary);
    // A wall along the tangent's direction, as a segment, a polygon of two vertices and a flat ellipse.
    const Vec2 along = (unit * random.integer(1, 50)) * perp(Vec2{n.p, n.q});
    ASSERT_EQ(locate({Segment{centre - along, centre + along}, {}, r}, touch), Place::boundary);
    ASSERT_EQ(locate({ConvexPolygon{{centre - along, centre + along}}, {}, r}, touch), Place::boundary);
    ASSERT_EQ(locate({Ellipse{centre, along.x, along.y, 0.0}, {}, r}, touch), Place::boundary);
    ASSERT_EQ(locate({Segment{centre - along, centre + along}, {}, r}, touch + unit * Vec2{n.p, n.q}), Place::outside);
  }
}

TEST(Locate, VerticalSegmentsWithIrrationalEnds) {
  // l11 = 0: half-length sqrt(l21^2 + l22^2); (3, 4) makes it 5.
  const Ellipse e{{0, 0}, 0.0, 3.0, 4.0};
  EXPECT_EQ(locate({e, {}, 0.0}, {0, 5}), Place::boundary);
  EXPECT_EQ(locate({e, {}, 0.0}, {0, std::nextafter(5.0, 6.0)}), Place::outside);
  EXPECT_EQ(locate({e, {}, 2.0}, {0, 7}), Place::boundary);
  EXPECT_EQ(locate({e, {}, 2.0}, {2, 3}), Place::boundary);
  EXPECT_EQ(locate({e, {}, 5.0}, {3, 9}), Place::boundary);
  EXPECT_EQ(locate({e, {}, 2.0}, {0, 0}), Place::inside);
  EXPECT_EQ(locate({Ellipse{{0, 0}, 0, 1, 1}, {}, 0.0}, {0, std::sqrt(2.0)}), Place::outside) << "rounded up";
}

TEST(Locate, PolygonsWithoutAreaAreWalls) {
  const ConvexPolygon flat{{{0, 0}, {1, 1}, {3, 3}, {2, 2}}};
  EXPECT_EQ(locate({flat, {}, 0.0}, {2.5, 2.5}), Place::boundary);
  EXPECT_EQ(locate({flat, {}, 0.5}, {2.5, 2.5}), Place::inside);
  EXPECT_EQ(locate({flat, {}, 0.0}, {4, 4}), Place::outside);
  EXPECT_EQ(locate({ConvexPolygon{{{1, 2}}}, {}, 5.0}, {4, 6}), Place::boundary);
}

TEST(Locate, TheFilterAnswersRandomQuestionsOfEllipses) {
  SeededRandom random(seed_of_run(24));
  geometry::reset_stage_counts();
  for (int i = 0; i < 50000; ++i) {
    const geometry::ConvexShape e =
        geometry::ellipse_from_axes(random.in_box(5.0), {1.0, random.uniform(0.1, 1.0), random.uniform(-1.5, 1.5)});
    locate({e, {}, 0.5}, random.in_box(5.0));
  }
  EXPECT_LE(geometry::stage_counts().exact, 50u);
  EXPECT_EQ(geometry::stage_counts().exact + geometry::stage_counts().filter, 50000u);
}

// --- B2 ---

/// The truth by witness: a point of the segment that lies in S, or a line that parts the two. 0: neither was found.
class MeetingWitness {
 public:
  MeetingWitness(const GrownShape& s, Vec2 v, double t_max) : s_(s), v_(v), t_max_(t_max) {}

  int operator()() const {
    const double t = nearest_time();
    const QPoint at{Q(t) * Q(v_.x), Q(t) * Q(v_.y)};
    if (place_in(s_, at) <= 0) return 1;
    return parted_by(best_normal(t * v_)) ? -1 : 0;
  }

 private:
  double gap(Vec2 q, double angle) const {
    const Vec2 n{std::cos(angle), std::sin(angle)};
    return dot(n, q) - support(s_, n).h;
  }
  /// Coarse to fine over the angle: the gap is the distance at its maximum and has one maximum where it is positive.
  double best_angle(Vec2 q) const {
    double best = 0.0, step = geometry::kPi / 32;
    for (int i = 0; i < 64; ++i)
      if (gap(q, i * step) > gap(q, best)) best = i * step;
    while (step > 1e-17) {
      step *= 0.5;
      if (gap(q, best + step) > gap(q, best))
        best += step;
      else if (gap(q, best - step) > gap(q, best))
        best -= step;
    }
    return best;
  }
  Vec2 best_normal(Vec2 q) const {
    const double angle = best_angle(q);
    return {std::cos(angle), std::sin(angle)};
  }
  double distance(double t) const { return gap(t * v_, best_angle(t * v_)); }
  double nearest_time() const {
    double low = 0.0, high = t_max_;
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      const double at_a = distance(a), at_b = distance(b);
      if (at_a <= 0.0) return a;
      if (at_b <= 0.0) return b;
      (at_a <= at_b ? high : low) = at_a <= at_b ? b : a;
    }
    return 0.5 * (low + high);
  }
  bool parted_by(Vec2 n) const {
    const QPoint m = exactly(n);
    const Q end = Q(t_max_) * dot(m, exactly(v_));
    return sign_of_support_minus(s_, m, std::min(Q(0), end)) < 0;
  }

  const GrownShape& s_;
  Vec2 v_;
  double t_max_;
};

TEST(SegmentMeets, AgreesWithWitnesses) {
  SeededRandom random(seed_of_run(25));
  int met = 0, parted = 0, unknown = 0;
  for (int i = 0; i < 1200; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 aim = support_point(scene.s, random.direction());
    const double t_max = random.uniform(0.2, 3.0);
    const Vec2 v = random.uniform(0.3, 2.0) * aim + 0.1 * scene.size * random.direction();
    const int truth = MeetingWitness(scene.s, v, t_max)();
    unknown += truth == 0;
    met += truth > 0;
    parted += truth < 0;
    if (truth != 0) {
      ASSERT_EQ(segment_meets(scene.s, v, t_max), truth > 0)
          << to_string(scene.s.shape) << geometry::to_string(std::vector<Vec2>{scene.s.origin, v});
    }
  }
  EXPECT_LE(unknown, 60) << "the witness search itself is rounded; near contact it may find neither";
  EXPECT_GE(met, 200);
  EXPECT_GE(parted, 200);
}

TEST(SegmentMeets, PolygonsDiscsAndSegmentsAgreeWithRationalDistances) {
  SeededRandom random(seed_of_run(26));
  for (int i = 0; i < 12000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 3]);
    const Vec2 aim = support_point(scene.s, random.direction());
    const double t_max = random.uniform(0.2, 3.0);
    const Vec2 v = random.uniform(0.3, 2.0) * aim;
    const QPoint from = exactly(scene.s.origin);
    const QPoint to{Q(from.x + Q(t_max) * Q(v.x)), Q(from.y + Q(t_max) * Q(v.y))};
    std::vector<QPoint> vertices;
    Q reach(scene.s.radius);
    if (const auto* d = std::get_if<Disc>(&scene.s.shape)) {
      vertices = {exactly(d->center)};
      reach += Q(d->radius);
    } else if (const auto* g = std::get_if<Segment>(&scene.s.shape)) {
      vertices = {exactly(g->a), exactly(g->b)};
    } else {
      for (Vec2 x : std::get<ConvexPolygon>(scene.s.shape).vertices) vertices.push_back(exactly(x));
    }
    ASSERT_EQ(segment_meets(scene.s, v, t_max), squared_distance_to_hull(vertices, from, to) <= reach * reach)
        << to_string(scene.s.shape);
  }
}

TEST(SegmentMeets, GrazingRaysTouchFromTheFirstMomentOn) {
  SeededRandom random(seed_of_run(27));
  int judged = 0;
  for (int i = 0; i < 10000; ++i) {
    TangentCase t = random_tangent_ellipse(random);
    // The robot stands on the tangent, `steps` of the direction before the touching point.
    const Vec2 v = perp(t.normal);
    const double unit = std::ldexp(1.0, std::ilogb(std::fabs(t.touch.x) + std::fabs(t.touch.y) + 1e-300) - 20);
    const double steps = random.integer(1, 1000) * unit;
    t.s.origin = t.touch - steps * v;
    if (t.s.origin + steps * v != t.touch) continue;
    ASSERT_TRUE(segment_meets(t.s, v, steps)) << to_string(t.s.shape);
    ASSERT_TRUE(segment_meets(t.s, v, 2.0 * steps));
    ASSERT_FALSE(segment_meets(t.s, v, std::nextafter(steps, 0.0)));
    t.s.origin = t.s.origin + unit * t.normal;
    ASSERT_FALSE(segment_meets(t.s, v, 2.0 * steps)) << "off the tangent by " << unit;
    ++judged;
  }
  EXPECT_GT(judged, 5000);
}

TEST(SegmentMeets, Property5_GrowsWithTimeAndHoldsAtItsEnds) {
  SeededRandom random(seed_of_run(28));
  int met = 0, ends = 0;
  for (int i = 0; i < 4000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const Vec2 v = support_point(scene.s, random.direction());
    const double t = random.uniform(0.5, 1.5);
    if (segment_meets(scene.s, v, t)) {
      ASSERT_TRUE(segment_meets(scene.s, v, std::nextafter(t, 2.0)));
      ASSERT_TRUE(segment_meets(scene.s, v, 10.0 * t));
      ++met;
    }
    const Vec2 q = 2.0 * v;
    if (locate(scene.s, q) != Place::outside) {
      ASSERT_TRUE(segment_meets(scene.s, v, 2.0));
      ++ends;
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(ends, 100);
}

TEST(SegmentMeets, DegenerateEllipsesAndRestingRobots) {
  const Ellipse along{{5, 0}, 2.0, 0.0, 0.0};  // a segment along the ray
  EXPECT_TRUE(segment_meets({along, {}, 0.0}, {1, 0}, 3.0));
  EXPECT_FALSE(segment_meets({along, {}, 0.0}, {1, 0}, std::nextafter(3.0, 0.0)));
  EXPECT_FALSE(segment_meets({along, {}, 0.0}, {-1, 0}, 100.0));
  EXPECT_TRUE(segment_meets({along, {}, 1.0}, {1, 0}, 2.0));
  EXPECT_FALSE(segment_meets({along, {}, 1.0}, {1, 0}, std::nextafter(2.0, 0.0)));
  const Ellipse upright{{5, 0}, 0.0, 3.0, 4.0};  // a vertical segment of half-length 5
  EXPECT_TRUE(segment_meets({upright, {}, 0.0}, {1, 1}, 5.0));
  EXPECT_FALSE(segment_meets({upright, {}, 0.0}, {1, std::nextafter(1.0, 2.0)}, 9.0));
  EXPECT_TRUE(segment_meets({upright, {}, 0.0}, {5, 5}, 1.0));
  EXPECT_FALSE(segment_meets({upright, {}, 4.0}, {0, 0}, 9.0));
  EXPECT_TRUE(segment_meets({upright, {}, 5.0}, {0, 0}, 9.0));
  EXPECT_TRUE(segment_meets({upright, {}, 5.0}, {-1, 0}, 0.0)) << "in touch at t = 0";
}

TEST(SegmentMeets, SpeedsWhoseSquaresAreLostToUnderflow) {
  SeededRandom random(seed_of_run(29));
  for (int i = 0; i < 4000; ++i) {
    RandomScene scene = random_scene(random, kKinds[i % 4]);
    if (i % 2 == 0) scene.s.origin += support_point(scene.s, random.direction());  // on the rim of what is forbidden
    const Vec2 n = random.direction();
    const bool stands_in_it = locate(scene.s, {}) != Place::outside;
    for (const int halvings : {440, 500, 520, 540, 700, 1000, 1060})
      ASSERT_EQ(segment_meets(scene.s, std::ldexp(1.0, -halvings) * n, 1.0), stands_in_it)
          << to_string(scene.s.shape) << " 2^-" << halvings;
  }
}

TEST(Place, NotANumberIsTheCallersMistake) {
  const double nan = std::nan("");
  const GrownShape s{Ellipse{{5, 0}, 2, 0, 1}, {}, 1};
  EXPECT_THROW(locate(s, {nan, 0}), std::logic_error);
  EXPECT_THROW(locate({Ellipse{{5, 0}, kInfinity, 0, 1}, {}, 1}, {0, 0}), std::logic_error);
  EXPECT_THROW(locate({Disc{{5, 0}, 1}, {nan, 0}, 1}, {0, 0}), std::logic_error);
  EXPECT_THROW(locate({Disc{{5, 0}, 1}, {}, -1}, {0, 0}), std::logic_error);
  EXPECT_THROW(locate({ConvexPolygon{}, {}, 1}, {0, 0}), std::logic_error);
  EXPECT_THROW(segment_meets(s, {kInfinity, 0}, 1.0), std::logic_error);
  EXPECT_THROW(segment_meets(s, {1, 0}, -1.0), std::logic_error);
  for (const Vec2 bad : {Vec2{nan, 0.0}, Vec2{0.0, kInfinity}})
    for (const Vec2 v : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}, Vec2{1.0, 1.0}})
      EXPECT_THROW(segment_meets({ConvexPolygon{{{5, 0}, {6, 0}, bad}}, {}, 1}, v, 1.0), std::logic_error);
  EXPECT_THROW(segment_meets(s, {1, 0}, kInfinity), std::logic_error);
  EXPECT_THROW(contains(Ellipse{{5, 0}, 2, 0, 1}, {nan, 0}), std::logic_error);
  EXPECT_THROW(contains(Ellipse{{5, 0}, nan, 0, 1}, {0, 0}), std::logic_error);
}

// --- E ---

TEST(EllipseContains, TangentAndRandomPoints) {
  SeededRandom random(seed_of_run(29));
  int inside = 0, outside = 0;
  for (int i = 0; i < 10000; ++i) {
    TangentCase t = random_tangent_ellipse(random);
    const Ellipse e = std::get<Ellipse>(t.s.shape);
    const double hypotenuse = std::hypot(t.normal.x, t.normal.y);
    const Vec2 foot = t.touch - (t.s.radius / hypotenuse) * t.normal;  // exact: r is a multiple of the unit
    ASSERT_TRUE(contains(e, foot)) << to_string(t.s.shape);
    const double step = std::ldexp(1.0, std::ilogb(norm(foot) + 1e-300) - 48);
    ASSERT_FALSE(contains(e, foot + step * t.normal));
    const Vec2 x =
        e.center + Vec2{e.l11, e.l21} * random.uniform(-1.2, 1.2) + Vec2{0, e.l22} * random.uniform(-1.2, 1.2);
    const QPoint u = minus(exactly(x), exactly(e.center));
    const Q v = Q(e.l22) * u.x, w = Q(e.l11) * u.y - Q(e.l21) * u.x, det = Q(e.l11) * Q(e.l22);
    if (sgn(det) != 0) {
      ASSERT_EQ(contains(e, x), v * v + w * w <= det * det);
      ++(contains(e, x) ? inside : outside);
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

}  // namespace
}  // namespace exactvo::test
