// SPDX-License-Identifier: GPL-3.0-or-later
// What a crowd promises of bodies that move (docs/guide/crowd.md, "Bodies"), looked at in rationals from places alone:
// discs that drive through a crowd and do not give way.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "crowd/crowd_audit.h"
#include "exactvo/formation/crowd.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using geometry::Vec2;
using test::SeededRandom;

constexpr double kRobot = 0.5, kBody = 0.75;

/// m: nearer to contact than this a robot touches, by any rounding.
constexpr double kTouching = 0x1p-10;

struct Mover {
  ObstacleId id = 0;
  Vec2 from;
};

struct Counts {
  std::size_t kept_near = 0;      ///< kept robots that a body could meet within the step
  std::size_t kept_met = 0;       ///< of them
  std::size_t others_met = 0;     ///< robots that are not kept and that a body meets
  std::size_t robots_met = 0;     ///< pairs of robots that were apart and overlap
  std::size_t touched_after = 0;  ///< kept robots that a body touched before, and overlaps at the end
};

bool overlap_in_step(Vec2 a, Vec2 a_to, Vec2 b, Vec2 b_to, double radii) {
  return CrowdAuditor::overlap(a, a_to, b, b_to, mpq_class(radii) * mpq_class(radii));
}

/// Robots on a grid, each for a place of its own, and discs that drive to and fro through them.
Counts run_through(CrowdPrecision precision, std::uint64_t seed, double mover_speed) {
  SeededRandom random(seed);
  CrowdOptions options;
  options.precision = precision;
  Crowd crowd(options);
  const KindId kind = crowd.add_kind({kRobot, 1.5, 5.0, 15.0, 10});
  std::vector<Vec2> goals;
  constexpr int kSide = 9;
  constexpr double kSpacing = 1.75;
  for (int k = 0; k < kSide * kSide; ++k) {
    crowd.add_robot({kSpacing * (k % kSide), kSpacing * (k / kSide)}, kind);
    goals.push_back({random.uniform(0.0, kSpacing * kSide), random.uniform(0.0, kSpacing * kSide)});
  }
  std::vector<Mover> movers;
  for (int k = 0; k < 4; ++k) {
    const Vec2 from{k % 2 == 0 ? -4.0 : kSpacing * kSide + 3.0, 1.0 + 4.0 * k};
    movers.push_back(
        {crowd.add_moving_body(geometry::Disc{from, kBody}, {k % 2 == 0 ? mover_speed : -mover_speed, 0.0}), from});
  }
  Counts counts;
  std::vector<Vec2> before, after;
  std::vector<std::uint8_t> kept;
  for (int step = 0; step < 100; ++step) {
    crowd.positions(before);
    std::vector<Vec2> preferred, from, to;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vec2 way = goals[i] - before[i];
      preferred.push_back(way * (1.4 / std::max(1.0, geometry::norm(way))));
    }
    crowd.set_preferred(preferred);
    for (const Mover& m : movers) from.push_back(m.from + crowd.body_displacement(m.id));
    crowd.step();
    for (const Mover& m : movers) to.push_back(m.from + crowd.body_displacement(m.id));
    crowd.positions(after);
    crowd.kept(kept);
    for (std::size_t i = 0; i < before.size(); ++i) {
      for (std::size_t b = 0; b < movers.size(); ++b) {
        const double distance = geometry::norm(before[i] - from[b]), radii = kRobot + kBody;
        if (distance > radii + (1.5 + mover_speed) * crowd.options().time_step + kTouching) continue;
        const bool met = overlap_in_step(before[i], after[i], from[b], to[b], radii);
        if (kept[i] == 0) {
          counts.others_met += met;
        } else if (distance > radii + kTouching) {
          ++counts.kept_near;
          counts.kept_met += met;
        } else {
          counts.touched_after += overlap_in_step(after[i], after[i], to[b], to[b], radii);
        }
      }
      for (std::size_t j = i + 1; j < before.size(); ++j)
        counts.robots_met += geometry::norm(before[i] - before[j]) < 3.0 &&
                             !overlap_in_step(before[i], before[i], before[j], before[j], 2.0 * kRobot) &&
                             overlap_in_step(before[i], after[i], before[j], after[j], 2.0 * kRobot);
    }
  }
  return counts;
}

/// Properties (1) and (9).
TEST(CrowdMovers, MeetNoKeptRobotAndPushNoRobotIntoAnother) {
  Counts sum;
  for (const double speed : {0.6, 1.4, 4.0})
    for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Counts counts = run_through(precision, test::seed_of_run(900 + seed), speed);
        EXPECT_EQ(counts.kept_met, 0U) << name(precision) << ' ' << speed << ' ' << seed;
        EXPECT_EQ(counts.touched_after, 0U) << name(precision) << ' ' << speed << ' ' << seed;
        EXPECT_EQ(counts.robots_met, 0U) << name(precision) << ' ' << speed << ' ' << seed;
        sum.kept_near += counts.kept_near;
        sum.others_met += counts.others_met;
      }
  EXPECT_GT(sum.kept_near, 1000U);
  // For other robots the guide promises nothing: robots in a crowd cannot all make room for a body that does not give
  // way.
  EXPECT_GT(sum.others_met, 0U);
}

}  // namespace
}  // namespace exactvo::formation
