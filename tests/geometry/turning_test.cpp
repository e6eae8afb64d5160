// SPDX-License-Identifier: GPL-3.0-or-later
// Gaps of turning sets against an oracle of 50 digits that samples and finds the first moment of loss by halving.
#include "exactvo/geometry/turning.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <vector>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/pieces.h"
#include "support/seeded_random.h"

namespace exactvo::test {
namespace {

using geometry::ConvexOnTwist;
using geometry::GapKeeper;
using geometry::GapToKeep;
using geometry::KeptGap;
using geometry::kInfinity;
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

/// Where the corners are at a moment, by the instantaneous centre.
std::vector<Far> corners_at(const ConvexOnTwist& set, double time) {
  std::vector<Far> all;
  const Number w(set.twist.turn), a = w * Number(time), c = cos(a), s = sin(a);
  for (std::size_t i = 0; i < set.corners.size; ++i) {
    const Number qx(set.corners.data[i].x), qy(set.corners.data[i].y), vx(set.twist.velocity.x),
        vy(set.twist.velocity.y);
    Far p{qx + Number(time) * vx, qy + Number(time) * vy};
    if (w != 0) {
      const Number cx = -vy / w, cy = vx / w, rx = qx - cx, ry = qy - cy;
      p = {cx + c * rx - s * ry, cy + s * rx + c * ry};
    }
    all.push_back({p.x + Number(set.at.x), p.y + Number(set.at.y)});
  }
  return all;
}

/// The greatest gap over the normals of all pairs of points of one set and the lines between points of both: these are
/// all candidates, and some more.
Number gap_exactly(const GapToKeep& q, double time) {
  const std::vector<Far> a = corners_at(q.a, time), b = corners_at(q.b, time);
  Number most = -1e300;
  const auto along = [&](const Far& n) {
    const Number length = sqrt(dot(n, n));
    if (length == 0) return;
    Number least = 1e300, greatest = -1e300;
    for (const Far& p : a) least = std::min<Number>(least, dot(n, p));
    for (const Far& p : b) greatest = std::max<Number>(greatest, dot(n, p));
    most = std::max<Number>(most, (least - greatest) / length);
  };
  const auto both_normals = [&](const std::vector<Far>& set) {
    for (const Far& p : set)
      for (const Far& r : set) along({p.y - r.y, r.x - p.x});
  };
  both_normals(a);
  both_normals(b);
  for (const Far& p : a)
    for (const Far& r : b) along(p - r);
  return most - (Number(q.reach) + Number(q.growth) * Number(time));
}

struct Judged {
  int whole = 0, lost = 0, tight = 0, uncertain = 0, kept_nothing = 0;
};

void judge(const GapToKeep& q, Judged& judged) {
  GapKeeper keeper;
  const KeptGap kept = keeper.keep(q);
  const double rounding = GapKeeper::rounding_of(q);
  ASSERT_EQ(kept.kept_until == q.duration || !kept.whole, true);
  // Kept at every moment that is looked at.
  const bool kept_some = kept.whole || kept.kept_until > 0.0;
  for (int k = 0; kept_some && k <= 8; ++k) {
    const double t = kept.kept_until * k / 8.0;
    ASSERT_GE(gap_exactly(q, t), Number(q.required)) << t << " of " << kept.kept_until;
  }
  ASSERT_NEAR(keeper.gap_at(q, 0.5 * q.duration), static_cast<double>(gap_exactly(q, 0.5 * q.duration)), rounding);
  if (kept.whole) {
    ++judged.whole;
    return;
  }
  const double lost_by = keeper.lose(q, kept).lost_by;
  if (lost_by == kInfinity) {
    ++judged.uncertain;
    return;
  }
  ASSERT_LT(gap_exactly(q, lost_by), Number(q.required));
  ++judged.lost;
  if (!kept_some) ++judged.kept_nothing;
  if (lost_by - kept.kept_until <= 1e-6 * q.duration) ++judged.tight;
}

std::vector<Vec2> random_hull(SeededRandom& random, int most, double size) {
  std::vector<Vec2> points;
  const int n = random.integer(1, most);
  for (int i = 0; i < n; ++i) points.push_back(random.in_box(size));
  const geometry::ConvexShape hull = geometry::hull_shape(points);
  return geometry::corners_of(hull);
}

TEST(GapKeeper, KeepsWhatItSaysAndLosesIt) {
  SeededRandom random(seed_of_run(81));
  Judged judged;
  constexpr int kCases = 800;
  for (int i = 0; i < kCases && !testing::Test::HasFailure(); ++i) {
    const std::vector<Vec2> a = random_hull(random, 6, 0.8), b = random_hull(random, 6, 1.5);
    GapToKeep q;
    const double far = i % 7 == 0 ? 1e6 : 0.0;
    q.a = {{far, -far}, {random.in_box(1.5), i % 5 == 0 ? 0.0 : random.uniform(-2.0, 2.0)}, {a.data(), a.size()}};
    q.b = {{far + random.uniform(-2.5, 2.5), -far + random.uniform(-2.5, 2.5)}, {}, {b.data(), b.size()}};
    if (i % 3 == 0) q.b.twist = {random.in_box(1.0), i % 2 == 0 ? random.uniform(-1.0, 1.0) : 0.0};
    q.duration = random.uniform(0.0, 4.0);
    q.reach = i % 2 == 0 ? 0.0 : random.uniform(0.0, 0.5);
    q.growth = i % 4 == 0 ? random.uniform(0.0, 0.5) : 0.0;
    q.required = i % 11 == 0 ? -0.3 : 0.0;
    judge(q, judged);
  }
  std::printf("%d whole, %d lost (%d within 1e-6 of the time, %d at the start), %d uncertain\n", judged.whole,
              judged.lost, judged.tight, judged.kept_nothing, judged.uncertain);
  EXPECT_EQ(judged.whole + judged.lost + judged.uncertain, kCases);
  EXPECT_GE(judged.whole, kCases / 4);
  EXPECT_GE(judged.lost, kCases / 4);
  EXPECT_GE(judged.tight, judged.lost * 98 / 100);
  EXPECT_LE(judged.uncertain, kCases / 100);
}

TEST(GapKeeper, ACornerThatTurnsIntoAWallIsSeenBetweenTwoClearPoses) {
  // A square of side 2 turns by a quarter beside a wall at x = 1.2: clear at both ends, its corner reaches 1.414.
  const std::vector<Vec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, wall{{1.2, -5}, {1.2, 5}};
  GapToKeep q{{{}, {{}, 0.5 * geometry::kPi}, {square.data(), 4}}, {{}, {}, {wall.data(), 2}}, 1.0, 0.0, 0.0, 0.0};
  GapKeeper keeper;
  EXPECT_NEAR(keeper.gap_at(q, 0.0), 0.2, 1e-12);
  EXPECT_NEAR(keeper.gap_at(q, 1.0), 0.2, 1e-12);
  const KeptGap kept = keeper.keep(q);
  EXPECT_FALSE(kept.whole);
  // sqrt(2) sin(45 deg + a) = 1.2.
  const double then = (std::asin(1.2 / std::sqrt(2.0)) - 0.25 * geometry::kPi) / (0.5 * geometry::kPi);
  EXPECT_NEAR(kept.kept_until, then, 1e-9);
  const geometry::LostGap lost = keeper.lose(q, kept);
  EXPECT_NEAR(lost.lost_by, then, 1e-6);
  EXPECT_NEAR(lost.place.x, 1.2, 1e-6);
}

TEST(GapKeeper, FullTurnsBesideAWallAreClearIfTheCornersAre) {
  const std::vector<Vec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const double x : {1.41, 1.4142135, 1.4142136, 1.42, 2.0}) {
    const std::vector<Vec2> wall{{x, -5}, {x, 5}};
    const GapToKeep q{
        {{}, {{}, 2.0 * geometry::kPi}, {square.data(), 4}}, {{}, {}, {wall.data(), 2}}, 3.0, 0.0, 0.0, 0.0};
    EXPECT_EQ(GapKeeper().keep(q).whole, x > std::sqrt(2.0)) << x;
  }
}

TEST(GapKeeper, SlidingAlongAWallInContactIsKeptWithANanometre) {
  const std::vector<Vec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, wall{{-9, -1}, {9, -1}};
  const GapToKeep q{{{}, {{1, 0}, 0.0}, {square.data(), 4}}, {{}, {}, {wall.data(), 2}}, 3.0, 0.0, 0.0, -1e-9};
  EXPECT_TRUE(GapKeeper().keep(q).whole);
}

TEST(GapKeeper, ANeedleThatTurnsPastAPostIsDecided) {
  // A needle of 4 m and no width turns about its end; posts at the distance 3.9 and 4.1 from it.
  const std::vector<Vec2> needle{{0, 0}, {4, 0}};
  for (const double at : {3.9, 4.1}) {
    const std::vector<Vec2> post{{0, at}};
    const GapToKeep q{{{}, {{}, 1.0}, {needle.data(), 2}}, {{}, {}, {post.data(), 1}}, 3.0, 0.0, 0.0, 0.0};
    const KeptGap kept = GapKeeper().keep(q);
    EXPECT_EQ(kept.whole, at > 4.0);
    if (at < 4.0) {
      EXPECT_NEAR(kept.kept_until, 0.5 * geometry::kPi, 1e-8);
    }
  }
}

// A known failure of conservative advancement: two boxes that come towards each other, whose bounds of motion cancelled
// where they were added with their signs.
TEST(GapKeeper, TwoBoxesThatComeTowardsEachOtherMeetWhenTheyShould) {
  const std::vector<Vec2> box{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const geometry::CornerView corners{box.data(), box.size()};
  GapKeeper keeper;
  for (const double speed : {1.0, -1.0}) {
    const GapToKeep q{{{-3, 0}, {{1, 0}, 0.0}, corners}, {{3, 0}, {{-speed, 0}, 0.0}, corners}, 10.0, 0.0, 0.0, 0.0};
    const KeptGap kept = keeper.keep(q);
    EXPECT_EQ(kept.whole, speed < 0.0) << "they keep their distance only where both go the same way";
    if (speed > 0.0) {
      EXPECT_NEAR(kept.kept_until, 2.0, 1e-8);
    }
  }
}

// A share of so short a duration is 0, so that the search for the moment of loss did not end.
TEST(GapKeeper, AnswersWhereTheDurationIsHardlyMoreThanNothing) {
  const std::vector<Vec2> point{{0, 0}};
  const geometry::CornerView corners{point.data(), 1};
  const GapToKeep q{{{}, {{0x1p510, 0}, 0.0}, corners}, {{0x1p-531, 0}, {}, corners}, 0x1p-1040, 0.0, 0.0, 0.0};
  const KeptGap kept = GapKeeper().keep(q);
  EXPECT_FALSE(kept.whole);
  EXPECT_NEAR(kept.kept_until / 0x1p-1041, 1.0, 1e-8);
}

TEST(GapKeeper, CornersMustBeThere) {
  EXPECT_THROW(GapKeeper().keep({}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::test
