// SPDX-License-Identifier: GPL-3.0-or-later
// Exact verdicts for turning bodies against an oracle of 50 digits that looks at every moment at which a gap can
// change its sign, and between any two of them.
#include "exactvo/geometry/turning_motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "support/seeded_random.h"

namespace exactvo::test {
namespace {

using geometry::Encounter;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::RigidBody;
using geometry::RoundedPolygon;
using geometry::TurningMotion;
using geometry::Twist;
using geometry::Vec2;
using Number = boost::multiprecision::cpp_bin_float_50;

struct Far {
  Number x, y;
};
Far operator-(const Far& a, const Far& b) {
  return {a.x - b.x, a.y - b.y};
}
Number dot(const Far& a, const Far& b) {
  return a.x * b.x + a.y * b.y;
}
Far left_of(const Far& a) {
  return {-a.y, a.x};
}

/// One convex part and one convex piece, seen from the centre of the turn (or from anywhere without a turn).
struct OraclePair {
  std::vector<Far> turning, standing;
  Number reach;
};

std::vector<Far> turned(const std::vector<Far>& points, const Number& angle) {
  const Number c = cos(angle), s = sin(angle);
  std::vector<Far> all;
  for (const Far& p : points) all.push_back({c * p.x - s * p.y, s * p.x + c * p.y});
  return all;
}

/// The greatest gap over all directions that count, less the reach.
Number gap_of(const std::vector<Far>& a, const std::vector<Far>& b, const Number& reach) {
  Number most = -1e300;
  const auto along = [&](const Far& n) {
    const Number length = sqrt(dot(n, n));
    if (length == 0) return;
    Number least = 1e300, greatest = -1e300;
    for (const Far& p : a) least = std::min<Number>(least, dot(n, p));
    for (const Far& p : b) greatest = std::max<Number>(greatest, dot(n, p));
    most = std::max<Number>(most, (least - greatest) / length);
  };
  for (const auto* set : {&a, &b})
    for (const Far& p : *set)
      for (const Far& r : *set) along(left_of(p - r));
  for (const Far& p : a)
    for (const Far& r : b) along(p - r);
  if (most == Number(-1e300)) most = 0;
  return most - reach;
}

/// Angles from 0 to `end` at which a cos + b sin + c is 0 or turns round.
void add_events(const Number& a, const Number& b, const Number& c, const Number& end, std::vector<Number>& events) {
  const Number size = sqrt(a * a + b * b);
  if (size == 0) return;
  const Number turn = 2 * boost::math::constants::pi<Number>(), middle = atan2(b, a);
  std::vector<Number> found{middle, middle + turn / 2};
  if (abs(c) <= size) {
    const Number off = acos(Number(-c / size));
    found.push_back(middle + off);
    found.push_back(middle - off);
  }
  for (Number angle : found) {
    while (angle >= 0) angle -= turn;
    for (angle += turn; angle <= end; angle += turn) events.push_back(angle);
  }
}

Encounter judged(const OraclePair& pair, const Number& end) {
  std::vector<Number> events{Number(0), end};
  const auto with_edges = [&](const std::vector<Far>& hull, const std::vector<Far>& points, bool hull_turns) {
    for (std::size_t k = 0; k < hull.size() && hull.size() > 1; ++k) {
      const Far e = hull[(k + 1) % hull.size()] - hull[k], n = left_of(e);
      const Number length = sqrt(dot(e, e));
      for (const Far& p : points) {
        // (R p - hull_k).n, or (p - R hull_k).(R n): of both the zero, the reach to both sides, and along the edge.
        const Far& moving = hull_turns ? n : p;
        const Far& rests = hull_turns ? p : n;
        const Number a = dot(moving, rests), b = dot(left_of(moving), rests), c = -dot(n, hull[k]);
        for (const Number& off : {Number(0), pair.reach, Number(-pair.reach)})
          add_events(a, b, c + off * length, end, events);
        const Far& along = hull_turns ? e : p;
        const Far& other = hull_turns ? p : e;
        for (const Number& far : {Number(0), Number(length * length)})
          add_events(dot(along, other), dot(left_of(along), other), -dot(e, hull[k]) - far, end, events);
      }
    }
  };
  with_edges(pair.standing, pair.turning, false);
  with_edges(pair.turning, pair.standing, true);
  for (const Far& p : pair.turning)
    for (const Far& q : pair.standing)
      add_events(-2 * dot(p, q), -2 * dot(left_of(p), q), dot(p, p) + dot(q, q) - pair.reach * pair.reach, end, events);
  std::sort(events.begin(), events.end());
  const std::size_t count = events.size();
  for (std::size_t k = 1; k < count; ++k) events.push_back((events[k - 1] + events[k]) / 2);
  Number least = 1e300;
  for (const Number& angle : events)
    least = std::min<Number>(least, gap_of(turned(pair.turning, angle), pair.standing, pair.reach));
  const Number nothing = ldexp(Number(1), -100);
  return least < -nothing ? Encounter::overlap : least > nothing ? Encounter::clear : Encounter::contact;
}

/// REQUIRES: it turns.
Encounter oracle(const TurningMotion& m, const RigidBody& body, const std::vector<RoundedPolygon>& pieces) {
  const Number w(m.twist.turn);
  const Number cx = Number(m.at.x) - Number(m.twist.velocity.y) / w,
               cy = Number(m.at.y) + Number(m.twist.velocity.x) / w;
  // A turn to the right is one to the left in a mirror.
  const Number mirror = w < 0 ? -1 : 1;
  Encounter worst = Encounter::clear;
  for (const RoundedPolygon& part : body)
    for (const RoundedPolygon& piece : pieces) {
      OraclePair pair;
      for (const Vec2 c : part.corners)
        pair.turning.push_back({Number(m.at.x) + Number(c.x) - cx, mirror * (Number(m.at.y) + Number(c.y) - cy)});
      for (const Vec2 c : piece.corners) pair.standing.push_back({Number(c.x) - cx, mirror * (Number(c.y) - cy)});
      pair.reach = Number(part.radius) + Number(piece.radius);
      worst = std::max(worst, judged(pair, mirror * w * (Number(m.end) - Number(m.start))));
    }
  return worst;
}

struct Campaign {
  int cases = 0, clear = 0, contact = 0, overlap = 0;
  void judge(const TurningMotion& m, const RigidBody& body, const RoundedPolygon& piece) {
    const Encounter expected = oracle(m, body, {piece});
    const bool is_wall = piece.radius == 0.0 && piece.corners.size() == 2;
    const Encounter found =
        is_wall ? encounter(m, body, Obstacle(Polyline{piece.corners})) : encounter(m, body, RigidBody{piece}, Vec2{});
    ++cases;
    (expected == Encounter::clear ? clear : expected == Encounter::contact ? contact : overlap) += 1;
    const auto hex = [](const std::vector<Vec2>& points) { return geometry::to_string(points); };
    ASSERT_EQ(static_cast<int>(found), static_cast<int>(expected))
        << std::hexfloat << m.start << " " << m.end << " at " << hex({m.at, m.twist.velocity}) << " turn "
        << m.twist.turn << " body " << hex(body[0].corners) << " " << body[0].radius << " piece " << hex(piece.corners)
        << " " << piece.radius;
  }
};

std::vector<Vec2> random_hull(SeededRandom& random, int least, int most, double size) {
  std::vector<Vec2> points;
  const int n = random.integer(least, most);
  for (int i = 0; i < n; ++i) points.push_back(random.in_box(size));
  return geometry::convex_hull(points).vertices;
}

TEST(TurningMotions, RandomDrivesAreJudgedRight) {
  SeededRandom random(seed_of_run(101));
  geometry::reset_stage_counts();
  Campaign campaign;
  for (int i = 0; i < 100 && !HasFatalFailure(); ++i) {
    const Vec2 far = i % 5 == 0 ? Vec2{1e6, -1e6} : Vec2{};
    std::vector<Vec2> corners = random_hull(random, 1, 5, 0.8), other = random_hull(random, 1, 4, 1.5);
    if (i % 7 == 0) corners = {{-2.0, 0.0}, {2.0, -1e-6}, {2.0, 1e-6}};  // a needle
    const RigidBody body{{corners, corners.size() < 3 || i % 2 == 0 ? random.uniform(0.05, 0.5) : 0.0}};
    const Vec2 shift = far + random.in_box(3.0);
    for (Vec2& p : other) p += shift;
    const TurningMotion m{
        random.uniform(-1, 1), random.uniform(1, 4), far, {random.in_box(1.5), random.uniform(-2.5, 2.5)}};
    campaign.judge(m, body, {other, other.size() < 3 && other.size() != 2 ? 0.2 : 0.0});
  }
  std::printf("%d clear, %d contact, %d overlap; %llu by the filter, %llu exactly\n", campaign.clear, campaign.contact,
              campaign.overlap, static_cast<unsigned long long>(geometry::stage_counts().filter),
              static_cast<unsigned long long>(geometry::stage_counts().exact));
  EXPECT_EQ(campaign.cases, 100);
  EXPECT_GE(campaign.clear, 20);
  EXPECT_GE(campaign.overlap, 20);
  EXPECT_GE(geometry::stage_counts().filter, 98u);
}

/// Pairs of whole numbers and their distance from the origin, which is one too.
constexpr int kTriples[][3] = {{3, 4, 5}, {5, 12, 13}, {8, 15, 17}, {7, 24, 25}, {20, 21, 29}, {5, 0, 5}};

TEST(TurningMotions, ContactIsToldFromMissesAndOverlapsByAnUlp) {
  SeededRandom random(seed_of_run(102));
  Campaign campaign;
  geometry::reset_stage_counts();
  for (int i = 0; i < 300 && !HasFatalFailure(); ++i) {
    const int* triple = kTriples[random.integer(0, 5)];
    const double scale = std::ldexp(1.0, -random.integer(2, 5)), size = scale * triple[2];
    const auto quarter = [&](Vec2 p) {
      for (int k = random.integer(0, 3); k > 0; --k) p = geometry::perp(p);
      return p;
    };
    // From the centre of the turn: the far corner at `r`, of a disc or a triangle.
    const Vec2 r = quarter({scale * triple[0], scale * triple[1]});
    const double radius = i % 2 == 0 ? 0.25 * random.integer(1, 4) : 0.0;
    const Vec2 centre{0.25 * random.integer(-8, 8), 0.25 * random.integer(-8, 8)};
    const double turn = (i % 3 == 0 ? -1.0 : 1.0) * std::ldexp(1.0, random.integer(-2, 1));
    const Vec2 at = i % 4 == 0 ? Vec2{1048576.0, -524288.0} : Vec2{0.5, 0.25};
    // J v / w = centre.
    const Twist twist{-turn * geometry::perp(centre), turn};
    std::vector<Vec2> corners{centre + r};
    if (radius == 0.0) {
      corners.push_back(centre + 0.5 * geometry::perp(r));
      corners.push_back(centre - 0.25 * r);
    }
    const RigidBody body{{corners, radius}};
    // A wall that the far end touches as it comes past, or the end of one.
    const Vec2 outward = quarter({1.0, 0.0});
    const Vec2 touched = (size + radius) * outward;
    const double off[] = {0.0, 1.0, -1.0};
    const double nudge = off[i % 3];
    std::vector<Vec2> wall = i % 5 == 0 ? std::vector<Vec2>{touched, 2.0 * touched + geometry::perp(outward)}
                                        : std::vector<Vec2>{touched + 3.0 * geometry::perp(outward),
                                                            touched - 2.0 * geometry::perp(outward)};
    for (Vec2& p : wall) {
      p += centre + at;
      // Near 0 an ulp is nothing that the oracle sees.
      double& across = outward.x != 0.0 ? p.x : p.y;
      const double way = nudge * (outward.x + outward.y);
      across = across == 0.0 ? way * 0x1p-60 : std::nextafter(across, across + way);
    }
    const double duration =
        i % 6 == 0 ? 2.0 * geometry::kPi / std::fabs(turn) * 1.5 : random.uniform(0.1, 7.0 / std::fabs(turn));
    campaign.judge({0.0, duration, at, twist}, body, {wall, 0.0});
  }
  std::printf("%d clear, %d contact, %d overlap; %llu by the filter, %llu exactly\n", campaign.clear, campaign.contact,
              campaign.overlap, static_cast<unsigned long long>(geometry::stage_counts().filter),
              static_cast<unsigned long long>(geometry::stage_counts().exact));
  EXPECT_EQ(campaign.cases, 300);
  EXPECT_GE(campaign.clear, 60);
  EXPECT_GE(campaign.contact, 40);
  EXPECT_GE(campaign.overlap, 40);
  EXPECT_GE(geometry::stage_counts().exact, 100u);
}

TEST(TurningMotions, DriveThatEndsAtTheContactIsDecided) {
  // The end of a turn by a rational angle is never exactly at a contact (Lindemann): one ulp of the end tells.
  const RigidBody needle{{{{0, 0}, {4, 0}}, 0.25}};
  const Obstacle wall = Polyline{{{-1, 3}, {9, 3}}};
  const double then = std::asin(2.75 / 4.0);
  int clear = 0, overlap = 0;
  for (int ulps = -4; ulps <= 4; ++ulps) {
    double end = then;
    for (int k = 0; k < std::abs(ulps); ++k) end = std::nextafter(end, ulps < 0 ? 0.0 : 9.0);
    const Encounter e = encounter({0.0, end, {}, {{}, 1.0}}, needle, wall);
    EXPECT_NE(e, Encounter::contact) << ulps;
    (e == Encounter::clear ? clear : overlap) += 1;
  }
  EXPECT_GE(clear, 3);
  EXPECT_GE(overlap, 3);
}

TEST(TurningMotions, InsideOfAPolygonIsOverlapAndAHoleIsNot) {
  const Obstacle block = Polygon{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {{{-2, -2}, {-2, 2}, {2, 2}, {2, -2}}}};
  const RigidBody square{{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, 0.0}};
  EXPECT_EQ(encounter({0, 9, {}, {{}, 1.0}}, square, block), Encounter::clear);
  EXPECT_EQ(encounter({0, 9, {3.5, 0}, {{}, 1.0}}, square, block), Encounter::overlap);
  EXPECT_EQ(encounter({0, 9, {1.5, 0}, {{}, 0.0}}, square, block), Encounter::contact);
  EXPECT_EQ(encounter({0, 0, {1.5, 0}, {{}, 1.0}}, square, block), Encounter::contact);
  EXPECT_EQ(encounter({0, 9, {1.5, 0}, {{}, 1.0}}, square, block), Encounter::overlap);
}

TEST(TurningMotions, WithoutATurnTheVerdictIsThatOfTheStraightMotion) {
  SeededRandom random(seed_of_run(103));
  int overlaps = 0;
  for (int i = 0; i < 300; ++i) {
    const RigidBody body{{random_hull(random, 1, 4, 0.6), 0.25}};
    const Vec2 a = random.in_box(3.0), v{0.25 * random.integer(-8, 8), 0.25 * random.integer(-8, 8)};
    const Obstacle wall = Polyline{{random.in_box(3.0), random.in_box(3.0)}};
    const geometry::Motion straight = geometry::CurvedMotion{geometry::CurveBasis::powers, 0.0, 2.0, {a, v}};
    const Encounter expected = encounter(straight, body, wall);
    ASSERT_EQ(encounter({0.0, 2.0, a, {v, 0.0}}, body, wall), expected);
    overlaps += expected == Encounter::overlap;
  }
  EXPECT_GE(overlaps, 50);
  EXPECT_LE(overlaps, 250);
}

// --- Certificates ---

TEST(TurningMotions, ClearDrivesHaveCertificatesThatProveThemAndChangedOnesAreRefused) {
  SeededRandom random(seed_of_run(104));
  int proven = 0, changed = 0, without = 0, pieces = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec2 far = i % 4 == 0 ? Vec2{1e6, -1e6} : Vec2{};
    const RigidBody body{{{{-0.3, -0.25}, {0.7, -0.25}, {0.7, 0.25}, {-0.3, 0.25}}, i % 2 == 0 ? 0.0 : 0.1},
                         {{{0.9, 0.0}}, 0.2}};
    const Vec2 a = far + random.in_box(2.5);
    const Obstacle wall = Polyline{{a, a + random.in_box(1.0), a + random.in_box(2.0)}};
    const TurningMotion m{
        0.5, random.uniform(1.0, 4.0), far, {random.in_box(1.0), i % 9 == 0 ? 0.0 : random.uniform(-3.0, 3.0)}};
    const bool is_clear = encounter(m, body, wall) == Encounter::clear;
    const auto certificate = certify(m, body, wall);
    ASSERT_EQ(certificate.has_value(), is_clear) << i;
    if (!is_clear) {
      ++without;
      continue;
    }
    ASSERT_TRUE(proves_clear(*certificate, m, body, wall)) << i;
    ++proven;
    pieces += static_cast<int>(certificate->separations.size());
    const std::size_t k =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(certificate->separations.size()) - 1));
    const auto refused = [&](const auto& change) {
      geometry::MotionCertificate other = *certificate;
      change(other.separations);
      EXPECT_FALSE(proves_clear(other, m, body, wall)) << i << " " << changed;
      ++changed;
    };
    refused([&](auto& all) { all[k].direction = -all[k].direction; });
    refused([&](auto& all) { all[k].direction = {}; });
    refused([&](auto& all) { all[k].margin += 20.0; });
    refused([&](auto& all) { all[k].margin = -1e-9; });
    refused([&](auto& all) { all[k].from = std::nextafter(all[k].from, 9.0); });
    refused([&](auto& all) { all[k].part = 7; });
    refused([&](auto& all) { all.erase(all.begin() + static_cast<std::ptrdiff_t>(k)); });
    refused([&](auto& all) { all.push_back(all.back()); });
    TurningMotion longer = m;
    longer.end += 1.0;
    EXPECT_FALSE(proves_clear(*certificate, longer, body, wall));
    // Margins are as large as they can be but for rounding and the stray of a piece: a larger body has none left.
    RigidBody shrunk = body;
    shrunk[0].radius = -1.0;
    EXPECT_FALSE(proves_clear(*certificate, m, shrunk, wall));
    RigidBody grown = body;
    for (RoundedPolygon& part : grown) part.radius += 10.0;
    EXPECT_FALSE(proves_clear(*certificate, m, grown, wall));
  }
  std::printf("%d proven in %d pieces, %d without, %d changed\n", proven, pieces, without, changed);
  EXPECT_GE(proven, 15);
  EXPECT_GE(without, 5);
  EXPECT_EQ(changed, 8 * proven);
}

TEST(TurningMotions, CertificatesAgainstPolygonsSayThatTheBodyIsOutside) {
  const Obstacle block = Polygon{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {{{-2, -2}, {-2, 2}, {2, 2}, {2, -2}}}};
  const RigidBody square{{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, 0.0}};
  const TurningMotion in_hole{0, 9, {}, {{}, 1.0}}, inside{0, 9, {3.5, 0}, {{}, 1.0}};
  const auto certificate = certify(in_hole, square, block);
  ASSERT_TRUE(certificate);
  EXPECT_TRUE(proves_clear(*certificate, in_hole, square, block));
  EXPECT_FALSE(certify(inside, square, block));
  EXPECT_FALSE(proves_clear(*certificate, inside, square, block));
  EXPECT_FALSE(proves_clear({}, in_hole, square, block));
}

TEST(TurningMotions, BodiesThatTurnTooFarForTheCheckHaveNoCertificate) {
  const Obstacle wall = Polyline{{{-3, 2}, {3, 2}}};
  const RigidBody square{{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, 0.0}};
  const TurningMotion less{0, 63, {}, {{}, 1.0}}, more{0, 65, {}, {{}, -1.0}};
  const auto certificate = certify(less, square, wall);
  ASSERT_TRUE(certificate);
  EXPECT_TRUE(proves_clear(*certificate, less, square, wall));
  EXPECT_EQ(encounter(more, square, wall), Encounter::clear);
  EXPECT_FALSE(certify(more, square, wall));
}

// Squares of the smaller lengths are 0 in doubles.
TEST(TurningMotions, VerdictsDoNotDependOnTheUnitOfLength) {
  int judged = 0;
  for (const double unit : {1.0, 0x1p-600, 0x1p600}) {
    for (int k = 0; k < 8; ++k) {
      const double y = (0.5 + 0.25 * k) * unit;
      const Obstacle wall = Polyline{{{-3.0 * unit, y}, {3.0 * unit, y}}};
      const RigidBody square{
          {{{-0.5 * unit, -0.5 * unit}, {0.5 * unit, -0.5 * unit}, {0.5 * unit, 0.5 * unit}, {-0.5 * unit, 0.5 * unit}},
           0.125 * unit}};
      // It turns by 1 rad. A corner comes to 0.71 cos(0.21) above the middle, which has risen by 0.23: with the radius
      // 1.05 units in all.
      EXPECT_EQ(encounter({0, 2, {}, {{0.25 * unit, 0.0}, 0.5}}, square, wall),
                k < 3 ? Encounter::overlap : Encounter::clear)
          << unit << " " << k;
      ++judged;
    }
  }
  EXPECT_EQ(judged, 24);
}

TEST(TurningMotions, BodiesWithoutAnInteriorAndBadNumbersAreRefused) {
  const Obstacle wall = Polyline{{{0, 1}, {1, 1}}};
  EXPECT_THROW(encounter({0, 1, {}, {{}, 1.0}}, RigidBody{{{{0, 0}, {1, 0}}, 0.0}}, wall), std::logic_error);
  EXPECT_THROW(encounter({0, 1, {}, {{}, 1.0}}, {}, wall), std::logic_error);
  EXPECT_THROW(encounter({1, 0, {}, {{}, 1.0}}, geometry::disc_body(1), wall), std::logic_error);
  EXPECT_THROW(encounter({0, 1, {}, {{}, std::nan("")}}, geometry::disc_body(1), wall), std::logic_error);
}

}  // namespace
}  // namespace exactvo::test
