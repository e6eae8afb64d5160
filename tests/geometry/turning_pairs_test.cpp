// SPDX-License-Identifier: GPL-3.0-or-later
// Two bodies of which at least one turns: against the exact verdict where one rests, else against poses looked at
// densely.
#include "exactvo/geometry/turning_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/motion_check.h"
#include "exactvo/geometry/pi.h"
#include "geometry/turning_judge.h"
#include "support/seeded_random.h"

namespace exactvo::test {
namespace {

using geometry::Encounter;
using geometry::kInfinity;
using geometry::kPi;
using geometry::MotionEvent;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::RigidBody;
using geometry::StraightMotion;
using geometry::TurningMotion;
using geometry::TurningVerdict;
using geometry::Vec2;

RigidBody box(double back, double front, double half_width) {
  return {{{{-back, -half_width}, {front, -half_width}, {front, half_width}, {-back, half_width}}, 0.0}};
}

/// The corners of a part at a moment, by the definition of a twist.
std::vector<Vec2> placed(const TurningMotion& m, const geometry::RoundedPolygon& part, double time) {
  const double t = time - m.start, w = m.twist.turn, c = std::cos(w * t), s = std::sin(w * t);
  const Vec2 v = m.twist.velocity;
  const Vec2 by = w == 0.0 ? t * v : Vec2{(s * v.x - (1.0 - c) * v.y) / w, ((1.0 - c) * v.x + s * v.y) / w};
  std::vector<Vec2> corners;
  for (const Vec2 q : part.corners) corners.push_back(m.at + by + Vec2{c * q.x - s * q.y, s * q.x + c * q.y});
  return corners;
}

/// The gap of two hulls over all directions of edges and of pairs of corners.
double gap_of(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double most = -kInfinity;
  const auto along = [&](Vec2 n) {
    if (norm(n) == 0.0) return;
    double least = kInfinity, greatest = -kInfinity;
    for (const Vec2 p : a) least = std::min(least, dot(n, p));
    for (const Vec2 p : b) greatest = std::max(greatest, dot(n, p));
    most = std::max(most, (least - greatest) / norm(n));
  };
  for (const auto* set : {&a, &b})
    for (const Vec2 p : *set)
      for (const Vec2 r : *set) along(perp(p - r));
  for (const Vec2 p : a)
    for (const Vec2 r : b) along(p - r);
  return most;
}

double gap_at(const TurningMotion& a, const RigidBody& body_a, const TurningMotion& b, const RigidBody& body_b,
              double time) {
  double least = kInfinity;
  for (const auto& p : body_a)
    for (const auto& q : body_b)
      least = std::min(least, gap_of(placed(a, p, time), placed(b, q, time)) - p.radius - q.radius);
  return least;
}

TEST(TurningPairs, BesideWhatRestsTheVerdictIsTheExactOne) {
  const std::uint64_t seed = seed_of_run(301);
  std::size_t judged = 0, contacts = 0, moments = 0;
  for (const TurningKind kind : kTurningKinds) {
    SeededRandom random(seed);
    for (int i = 0; i < 150; ++i) {
      const TurningCase c = random_turning_case(random, kind);
      const bool is_obstacle = c.piece.radius == 0.0 && c.piece.corners.size() > 1;
      TurningVerdict found;
      Encounter exact{};
      if (is_obstacle) {
        const Obstacle obstacle =
            c.piece.corners.size() == 2 ? Obstacle(Polyline{c.piece.corners}) : Obstacle(Polygon{c.piece.corners, {}});
        found = examine(c.motion, c.body, obstacle);
        exact = encounter(c.motion, c.body, obstacle);
      } else {
        found = examine(c.motion, c.body, {c.motion.start, c.motion.end, {}, {}}, RigidBody{c.piece});
        exact = encounter(c.motion, c.body, RigidBody{c.piece}, Vec2{});
      }
      const geometry::MotionVerdict& v = found.verdict;
      EXPECT_FALSE(found.is_open) << line_of(c);
      EXPECT_EQ(v.encounter, exact) << line_of(c);
      EXPECT_LE(v.clearance.low, v.clearance.high) << line_of(c);
      EXPECT_TRUE(exact != Encounter::overlap || v.clearance.high <= 0.0) << line_of(c);
      EXPECT_TRUE(exact != Encounter::clear || v.clearance.low >= 0.0) << line_of(c);
      ++judged;
      contacts += exact == Encounter::contact;
      if (exact == Encounter::clear) continue;
      ++moments;
      EXPECT_LE(v.first.low, v.first.high) << line_of(c);
      EXPECT_LE(v.last.low, v.last.high) << line_of(c);
      EXPECT_LE(v.first.low, v.last.high) << line_of(c);
    }
  }
  std::printf("%zu judged, %zu contacts, %zu with moments\n", judged, contacts, moments);
  EXPECT_EQ(judged, 600u);
  EXPECT_GE(contacts, 20u);
  EXPECT_GE(moments, 150u);
}

TEST(TurningPairs, TwoThatTurnAreAsPosesThatAreLookedAtDenselySay) {
  SeededRandom random(seed_of_run(302));
  constexpr int kLooks = 2000;
  std::size_t judged = 0, overlaps = 0, clear = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec2 far = i % 4 == 0 ? Vec2{1e6, -1e6} : Vec2{};
    const auto body = [&] {
      RigidBody made = box(random.uniform(0.1, 0.5), random.uniform(0.3, 1.0), random.uniform(0.05, 0.4));
      if (random.integer(0, 2) == 0) made.push_back({{{0.6, 0.1}}, 0.3});
      if (random.integer(0, 2) == 0) made[0].radius = 0.125;
      return made;
    };
    const auto drive = [&](Vec2 at) {
      const double start = random.uniform(0.0, 0.5);
      return TurningMotion{
          start, start + random.uniform(0.5, 3.0), at, {random.in_box(1.0), random.uniform(-3.0, 3.0)}};
    };
    const RigidBody body_a = body(), body_b = body();
    const TurningMotion a = drive(far), b = drive(far + random.in_box(2.5));
    const TurningVerdict found = examine(a, body_a, b, body_b);
    const geometry::MotionVerdict& v = found.verdict;
    const double from = std::max(a.start, b.start), to = std::min(a.end, b.end);
    double least = kInfinity, first = kInfinity, last = -kInfinity;
    // Places at 1e6 m are rounded to 1e-10 m.
    const double sure = far.x == 0.0 ? 1e-11 : 1e-8;
    for (int k = 0; k <= kLooks; ++k) {
      const double time = std::min(to, from + (to - from) * k / kLooks), gap = gap_at(a, body_a, b, body_b, time);
      least = std::min(least, gap);
      if (gap >= -sure) continue;
      first = std::min(first, time);
      last = time;
    }
    EXPECT_FALSE(found.is_open) << i;
    ++judged;
    if (first < kInfinity) {
      ++overlaps;
      ASSERT_EQ(v.encounter, Encounter::overlap) << i;
      EXPECT_LE(v.first.low, first) << i;
      EXPECT_GE(v.last.high, last) << i;
      const double step = (to - from) / kLooks;
      EXPECT_GE(v.first.high, first - step) << i;
      EXPECT_LE(v.first.high, first + step) << i;
      EXPECT_GE(v.last.low, last - step) << i;
      EXPECT_LT(gap_at(a, body_a, b, body_b, std::min(to, v.first.high + 1e-9)), sure) << i;
      continue;
    }
    if (v.encounter == Encounter::overlap) continue;  // shorter than a look
    ++clear;
    EXPECT_EQ(v.encounter, Encounter::clear) << i;
    EXPECT_LE(v.clearance.low, least + sure) << i;
    EXPECT_LE(v.clearance.high, least + 1e-9 + sure) << i;
    EXPECT_LE(v.clearance.high - v.clearance.low, 1e-3 * least + sure) << i;
  }
  std::printf("%zu judged, %zu overlaps, %zu clear\n", judged, overlaps, clear);
  EXPECT_EQ(judged, 200u);
  EXPECT_GE(overlaps, 30u);
  EXPECT_GE(clear, 60u);
}

// A wheel with one spike, which passes by the other body in a tenth of a radian, between two looks; the corners of the
// wheel have shallower dips of their own.
TEST(TurningPairs, TheMomentOfTheLeastClearanceIsTheLeastOfAllDips) {
  SeededRandom random(seed_of_run(304));
  std::size_t judged = 0;
  for (int i = 0; i < 30; ++i) {
    RigidBody wheel{{{}, 0.0}};
    for (int k = 0; k < 24; ++k) wheel[0].corners.push_back(geometry::rotated({1.0, 0.0}, 2.0 * kPi * k / 24));
    const double spike = random.uniform(0.0, 2.0 * kPi);
    wheel.push_back({{geometry::rotated({0.9, 0.02}, spike), geometry::rotated({1.05, 0.0}, spike),
                      geometry::rotated({0.9, -0.02}, spike)},
                     0.0});
    const TurningMotion turns{0.0, 1.0, {0, 0}, {{0, 0}, (i % 2 == 0 ? 1.0 : -1.0) * 2.0 * kPi}};
    const RigidBody other = box(0.5, 0.5, 0.5);
    const TurningMotion beside{0.0, 1.0, {1.8, 0}, {{0, 0}, random.uniform(0.1, 0.3)}};
    const geometry::MotionVerdict v = examine(turns, wheel, beside, other).verdict;
    ASSERT_EQ(v.encounter, Encounter::clear) << i;
    double least = kInfinity;
    for (int k = 0; k <= 4000; ++k) least = std::min(least, gap_at(turns, wheel, beside, other, k / 4000.0));
    EXPECT_LE(v.clearance.low, least) << i;
    EXPECT_LE(v.clearance.high, least + 1e-9) << i << ": a dip that is not the least";
    EXPECT_LE(v.clearance.high - v.clearance.low, 1e-9) << i;
    EXPECT_NEAR(gap_at(turns, wheel, beside, other, v.nearest_time), v.clearance.high, 1e-9) << i;
    ++judged;
  }
  EXPECT_EQ(judged, 30u);
}

// Two squares turn like cogs whose teeth meet tip to tip.
TEST(TurningPairs, TipsThatMeetExactlyStayOpenAndSayHowNear) {
  const RigidBody square{{{{-3, 0}, {0, -3}, {3, 0}, {0, 3}}, 0.0}};
  const TurningMotion a{-1.0, 1.0, {0, 0}, {{0, 0}, 0.5}};
  const auto with = [&](double apart) {
    // Both as they stand at 0, told from -1 on.
    RigidBody turned = turned_body(square, -0.5);
    return examine(a, turned, {-1.0, 1.0, {apart, 0}, {{0, 0}, 0.5}}, turned);
  };
  const TurningVerdict open = with(6.0);
  EXPECT_TRUE(open.is_open);
  EXPECT_EQ(open.verdict.encounter, Encounter::contact);
  EXPECT_LT(open.verdict.clearance.high, 1e-9);
  EXPECT_GT(open.verdict.clearance.high, 0.0);
  EXPECT_LE(open.verdict.clearance.low, 0.0);
  EXPECT_NEAR(open.verdict.first.low, 0.0, 1e-3);
  const TurningVerdict clear = with(6.0 + 1e-6), overlap = with(6.0 - 1e-6);
  EXPECT_EQ(clear.verdict.encounter, Encounter::clear);
  EXPECT_FALSE(clear.is_open);
  EXPECT_NEAR(clear.verdict.clearance.high, 1e-6, 1e-9);
  EXPECT_EQ(overlap.verdict.encounter, Encounter::overlap);
  EXPECT_FALSE(overlap.is_open);
}

TEST(TurningPairs, InsideOfAPolygonIsAnOverlapFromTheStart) {
  const Obstacle block = Polygon{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {}};
  const TurningVerdict inside = examine({2, 4, {0, 0}, {{0.1, 0}, 1.0}}, box(0.5, 0.5, 0.25), block);
  EXPECT_EQ(inside.verdict.encounter, Encounter::overlap);
  EXPECT_EQ(inside.verdict.first.high, 2.0);
  EXPECT_EQ(inside.verdict.last.low, 4.0);
  const TurningVerdict leaves = examine({0, 4, {4, 0}, {{1, 0}, 1e-3}}, box(0.5, 0.5, 0.25), block);
  EXPECT_EQ(leaves.verdict.first.high, 0.0);
  EXPECT_NEAR(leaves.verdict.last.high, 1.5, 1e-2);
}

TEST(TurningPairs, ClearPairsHaveCertificatesAndChangedOnesAreRefused) {
  SeededRandom random(seed_of_run(303));
  int proven = 0, changed = 0, without = 0;
  for (int i = 0; i < 40; ++i) {
    const Vec2 far = i % 4 == 0 ? Vec2{1e6, -1e6} : Vec2{};
    const RigidBody body_a = box(0.3, 0.7, 0.25), body_b = box(0.2, 0.9, 0.15);
    const TurningMotion a{0.5, 2.5, far, {random.in_box(1.0), random.uniform(-3.0, 3.0)}};
    const TurningMotion b{
        0.25, 2.0, far + random.in_box(3.0), {random.in_box(1.0), i % 5 ? random.uniform(-3.0, 3.0) : 0.0}};
    const bool is_clear = examine(a, body_a, b, body_b).verdict.encounter == Encounter::clear;
    const auto certificate = certify(a, body_a, b, body_b);
    ASSERT_EQ(certificate.has_value(), is_clear) << i;
    if (!is_clear) {
      ++without;
      continue;
    }
    ASSERT_TRUE(proves_clear(*certificate, a, body_a, b, body_b)) << i;
    ++proven;
    const std::size_t k =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(certificate->separations.size()) - 1));
    const auto refused = [&](const auto& change) {
      geometry::MotionCertificate other = *certificate;
      change(other.separations);
      EXPECT_FALSE(proves_clear(other, a, body_a, b, body_b)) << i << " " << changed;
      ++changed;
    };
    refused([&](auto& all) { all[k].direction = -all[k].direction; });
    refused([&](auto& all) { all[k].margin += 20.0; });
    refused([&](auto& all) { all[k].other = 1; });
    refused([&](auto& all) { all.erase(all.begin() + static_cast<std::ptrdiff_t>(k)); });
    TurningMotion moved = b;
    moved.at = a.at;
    EXPECT_FALSE(proves_clear(*certificate, a, body_a, moved, body_b)) << i;
    TurningMotion turned = a;
    turned.twist.turn += 40.0;
    EXPECT_FALSE(proves_clear(*certificate, turned, body_a, b, body_b)) << i;
  }
  std::printf("%d proven, %d without, %d changed\n", proven, without, changed);
  EXPECT_GE(proven, 15);
  EXPECT_GE(without, 5);
  EXPECT_EQ(changed, 4 * proven);
}

// --- Many bodies (motion_check.h) ---

struct Posed {
  StraightMotion piece;
  geometry::Turned turned;
};

std::vector<MotionEvent> events_of(const std::vector<std::vector<Posed>>& ways, const RigidBody& body,
                                   const std::vector<Obstacle>& map, double near, geometry::MotionCheck* check = {}) {
  std::vector<MotionEvent> events;
  geometry::MotionStream stream(map, {geometry::Between::straight, near},
                                [&](const MotionEvent& e) { events.push_back(e); });
  for (std::size_t k = 0; k < ways.size(); ++k) stream.add_body(body);
  std::vector<std::pair<std::size_t, Posed>> all;
  for (std::size_t k = 0; k < ways.size(); ++k)
    for (const Posed& p : ways[k]) all.emplace_back(k, p);
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.second.piece.from.time < b.second.piece.from.time; });
  for (const auto& [k, p] : all) stream.add(k, p.piece, p.turned);
  const geometry::MotionCheck result = stream.finish();
  if (check) *check = result;
  return events;
}

TEST(TurningPairs, StreamFindsTheCornerThatSwingsThroughAWallBetweenTwoClearRows) {
  // Before and after the quarter turn the box is 0.1 m from the wall; its diagonal is 1.118 m from the axle.
  const RigidBody body = box(0.5, 1.0, 0.5);
  const Obstacle wall = Polyline{{{-4, 1.1}, {4, 1.1}}};
  const std::vector<Posed> turns{{{{0, {0, 0}}, {1, {0, 0}}}, {0.0, kPi / 2}},
                                 {{{1, {0, 0}}, {2, {3, 0}}}, {kPi / 2, 0.0}}};
  const std::vector<MotionEvent> found = events_of({turns}, body, {wall}, 0.2);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].encounter, Encounter::overlap);
  EXPECT_GT(found[0].first.low, 0.5);
  EXPECT_LT(found[0].last.high, 1.0);
  EXPECT_NEAR(found[0].turned, std::atan2(1.0, 0.5), 0.3);
  // The same without a turn, and with the wall beyond the diagonal.
  EXPECT_TRUE(events_of({{{{{0, {0, 0}}, {2, {3, 0}}}, {}}}}, body, {wall}, 0.2).empty());
  EXPECT_TRUE(events_of({turns}, body, {Polyline{{{-4, 1.2}, {4, 1.2}}}}, 0.2).empty());
}

TEST(TurningPairs, StreamFindsTwoThatTurnIntoEachOther) {
  const RigidBody body = box(0.5, 1.0, 0.25);
  const std::vector<Posed> one{{{{0, {0, 0}}, {1, {0, 0}}}, {kPi / 2, -kPi}}};
  const std::vector<Posed> other{{{{0, {1.9, 0}}, {1, {1.9, 0}}}, {kPi / 2, kPi}}};
  geometry::MotionCheck check;
  const std::vector<MotionEvent> found = events_of({one, other}, body, {}, 0.5, &check);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].encounter, Encounter::overlap);
  // Their fronts meet half way; both are clear at both ends.
  EXPECT_GT(found[0].first.low, 0.2);
  EXPECT_LT(found[0].last.high, 0.8);
  ASSERT_EQ(check.approaches.size(), 1u);
  EXPECT_EQ(check.overlaps, 1u);
  EXPECT_EQ(check.open, 0u);
}

TEST(TurningPairs, AMomentThatIsShorterThanDoublesCanDivideIsDecided) {
  const TurningMotion a{0.0, 1.0, {0, 0}, {{0, 0}, 0.5}}, b{-1.0, 1e-320, {2, 0}, {}};
  const RigidBody bar{{{{0, 0}, {1, 0}}, 0.5}}, disc{{{{0, 0}}, 0.5}};
  EXPECT_NE(examine(a, bar, b, disc).verdict.encounter, Encounter::overlap);  // at the start they touch
}

/// The distance of corners that overlap counts as 0, so that discs beside them are what is deepest.
TEST(TurningPairs, DepthIsCountedFromTheRims) {
  const RigidBody square = box(1.0, 1.0, 1.0);
  RigidBody first = square, second = square;
  first.push_back({{{0, 10}}, 0.25});
  second.push_back({{{2, 10}}, 0.25});
  const TurningVerdict v =
      examine(TurningMotion{0.0, 2.0, {0, 0}, {{1, 0}, 1e-9}}, first, TurningMotion{0.0, 2.0, {0, 0}, {}}, second);
  EXPECT_EQ(v.verdict.encounter, Encounter::overlap);
  EXPECT_NEAR(v.verdict.clearance.high, -0.5, 1e-6);
  EXPECT_NEAR(v.verdict.nearest_time, 2.0, 1e-6);
}

TEST(TurningPairs, ABodyThatIsTurnedAndDoesNotTurnIsDecidedAsItStands) {
  const RigidBody body = box(0.5, 1.0, 0.25);
  const Obstacle wall = Polyline{{{-4, 0.6}, {4, 0.6}}};
  EXPECT_TRUE(events_of({{{{{0, {0, 0}}, {1, {1, 0}}}, {}}}}, body, {wall}, 0.0).empty());
  EXPECT_EQ(events_of({{{{{0, {0, 0}}, {1, {1, 0}}}, {kPi / 2, 0.0}}}}, body, {wall}, 0.0).size(), 1u);
}

}  // namespace
}  // namespace exactvo::test
