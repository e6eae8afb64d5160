// SPDX-License-Identifier: GPL-3.0-or-later
// Exact verdicts for turning bodies, against the oracle of turning_judge.h and by what must hold.
#include "exactvo/geometry/turning_motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "geometry/turning_judge.h"
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

TEST(TurningMotions, DrivesAreJudgedRight) {
  const std::uint64_t seed = seed_of_run(101);
  std::size_t judged = 0;
  for (const TurningKind kind : kTurningKinds) {
    const MotionCampaign campaign = judge_turnings(kind, 100, seed, 4);
    for (const std::string& failure : campaign.failures) ADD_FAILURE() << name_of(kind) << ": " << failure;
    std::printf("%s: %s\n", name_of(kind), campaign.summary().c_str());
    EXPECT_GE(campaign.clear, 10u) << name_of(kind);
    EXPECT_GE(campaign.overlap, 10u) << name_of(kind);
    EXPECT_GE(campaign.contact, kind == TurningKind::drives ? 0u : 3u) << name_of(kind);
    EXPECT_GE(campaign.clearances, 2u) << name_of(kind);
    EXPECT_GE(campaign.by_filter, 20u) << name_of(kind);
    judged += campaign.cases;
  }
  EXPECT_EQ(judged, 400u);
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

TEST(TurningMotions, AWallOfManyEdgesHasACertificate) {
  Polyline wall;
  for (int k = 0; k <= 70000; ++k) wall.points.push_back({0.001 * k, k % 2 == 0 ? 1.5 : 1.6});
  const RigidBody square{{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 0.0}};
  const TurningMotion m{0.0, 1.0, {35, 0}, {{0, 0}, 0.1}};
  const auto certificate = certify(m, square, wall);
  ASSERT_TRUE(certificate);
  EXPECT_GE(certificate->separations.size(), 70000u);
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
