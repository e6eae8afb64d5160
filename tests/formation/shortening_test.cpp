// SPDX-License-Identifier: GPL-3.0-or-later
// Joint plans that are made shorter: what sequences keep, and what their timetables say.
#include "liveness/shortening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "joint_problems.h"
#include "liveness/distances.h"
#include "liveness/timetable.h"
#include "liveness/way_among_others.h"

namespace exactvo::formation::detail {
namespace {

using Words = std::vector<std::array<std::size_t, 3>>;

Words words(const std::vector<JointMove>& moves) {
  Words all;
  for (const JointMove& m : moves) all.push_back({m.robot, m.from, m.to});
  return all;
}

Ways ways_of(const JointProblem& p) {
  return Ways(*p.map, 2.0 * *std::max_element(p.radii.begin(), p.radii.end()));
}

Timetable timetable_of(const JointProblem& p, const std::vector<JointMove>& moves) {
  Ways ways = ways_of(p);
  return timetable_of(moves, p.radii, ways);
}

/// m: the way that a robot goes until all are there that never waits, if they follow the plan in small strides.
double driven(const Problem& p, const std::vector<JointMove>& moves) {
  constexpr double kStride = 0.02;
  std::vector<Vec2> at = positions(p.map, p.joint.starts);
  Following following(plan_of(p.map, moves, p.joint.radii), p.joint.radii);
  int strides = 0;
  for (; following.moves_left() > 0 && strides < 100000; ++strides) {
    std::vector<Vec2> next = at;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec2 way = following.within_reach(i, at) - at[i];
      const double size = norm(way);
      next[i] = size <= kStride ? at[i] + way : at[i] + kStride / size * way;
    }
    at = next;
    following.advance(at);
  }
  return kStride * strides;
}

TEST(Shortening, Properties1To3_AreKept) {
  SeededRandom random(test::seed_of_run(61));
  double before = 0.0, after = 0.0;
  for (int k = 0; k < 24; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    const Problem p(walls, 2 + random.integer(0, 14), random);
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    const std::vector<JointMove> shorter = shortened(p.joint, answer.moves, k);
    const std::vector<PlannedMove> moves = on_map(p.map, shorter);
    std::vector<Vec2> at = positions(p.map, p.joint.starts);
    expect_apart(at, p.joint.radii, moves, walls);
    for (const PlannedMove& m : moves) at[m.robot] = m.to;
    EXPECT_EQ(at, positions(p.map, p.joint.goals)) << "Property 3";
    const Timetable given = timetable_of(p.joint, answer.moves), found = timetable_of(p.joint, shorter);
    EXPECT_LE(found.last + 0.2 * found.mean, (1.0 + 1e-9) * (given.last + 0.2 * given.mean));
    before += given.last;
    after += found.last;
  }
  EXPECT_LT(after, 0.95 * before);
}

TEST(Shortening, IsDeterministicAndChangesNothingOnceStopped) {
  SeededRandom random(test::seed_of_run(62));
  Problem p(two_rooms(1.5), 10, random);
  const JointAnswer answer = JointSearch(p.joint).run(1, {400000, 6000});
  ASSERT_EQ(answer.end, SearchEnd::found);
  const std::vector<JointMove> once = shortened(p.joint, answer.moves, 5);
  EXPECT_EQ(words(once), words(shortened(p.joint, answer.moves, 5)));
  EXPECT_NE(words(once), words(answer.moves));
  p.joint.is_stopped = [] { return true; };
  Words stopped = words(shortened(p.joint, answer.moves, 5)), given = words(answer.moves);
  std::sort(stopped.begin(), stopped.end());
  std::sort(given.begin(), given.end());
  EXPECT_EQ(stopped, given);
  EXPECT_TRUE(shortened(p.joint, {}, 5).empty());
}

/// Robots in a row go one behind the other without waiting; who crosses another's way waits for it.
TEST(Timetable, KnowsWhoWaitsForWhom) {
  const Walls open({});
  Roadmap map(open, {{0, 0}, {12, 12}}, 0.5);
  const auto place = [&](double x, double y) { return map.attach({1.06 * x, 1.06 * y}, 0.5); };
  JointProblem p;
  p.map = &map;
  p.radii = {0.5, 0.5, 0.5};
  const double way = 1.06;
  std::vector<JointMove> row;
  for (int x = 0; x < 5; ++x)
    for (std::size_t i = 0; i < 3; ++i)
      row.push_back({i, place(4.0 + x - static_cast<double>(i), 2), place(5.0 + x - static_cast<double>(i), 2)});
  EXPECT_NEAR(timetable_of(p, row).last, 5.0 * way, 1e-12);

  const std::vector<JointMove> crossing{{0, place(3, 4), place(4, 4)},
                                        {0, place(4, 4), place(5, 4)},
                                        {1, place(4, 3), place(4, 4)},
                                        {1, place(4, 4), place(4, 5)}};
  const Timetable t = timetable_of(p, crossing);
  EXPECT_GT(t.last, 2.5 * way);
  EXPECT_LE(t.last, 4.0 * way);
  ASSERT_EQ(t.moves[t.last_move].move.robot, 1u);
  const TimedMove& first_of_1 = t.moves[t.moves[t.last_move].waits_for];
  ASSERT_EQ(first_of_1.move.robot, 1u);
  EXPECT_EQ(t.moves[first_of_1.waits_for].move.robot, 0u);
}

/// What a timetable says is about what following the plan takes.
TEST(Timetable, IsNearToWhatIsDriven) {
  SeededRandom random(test::seed_of_run(63));
  for (int k = 0; k < 12; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    const Problem p(walls, 4 + random.integer(0, 8), random);
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    const double ratio = driven(p, answer.moves) / timetable_of(p.joint, answer.moves).last;
    EXPECT_GT(ratio, 0.75);
    EXPECT_LT(ratio, 1.35);
  }
}

/// Against every position and place: whether a robot can stand there while the others make their next move, and
/// whether somebody stands near a way.
TEST(SafeIntervals, SameAsLookingAtEveryMove) {
  SeededRandom random(test::seed_of_run(64));
  std::size_t safe_moves = 0, unsafe_moves = 0;
  for (int k = 0; k < 10; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    const Problem p(walls, 3 + random.integer(0, 6), random);
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    const std::size_t robot = static_cast<std::size_t>(random.integer(0, static_cast<int>(p.joint.radii.size()) - 1));
    std::vector<JointMove> moves;
    for (const JointMove& m : answer.moves)
      if (m.robot != robot) moves.push_back(m);
    Ways ways = ways_of(p.joint);
    const Timetable others = timetable_of(moves, p.joint.radii, ways);
    SafeIntervals safe(p.joint);
    safe.set(robot, others, ways);
    const auto reach2 = [&](std::size_t j) {
      const double wanted = (1.0 + kPlannedGap) * (p.joint.radii[robot] + p.joint.radii[j]);
      return wanted * wanted;
    };
    std::vector<PlaceNumber> at = p.joint.starts;
    for (std::size_t position = 0; position <= others.moves.size(); ++position) {
      for (PlaceNumber here = 0; here < p.map.size(); here += 3) {
        const PlaceNumber to = p.map.ways(here).empty() ? here : p.map.ways(here).front();
        if (to != here) {
          bool is_clear = true, is_close = false;
          for (std::size_t j = 0; j < at.size(); ++j) {
            if (j == robot) continue;
            const Vec2 other = p.map.place(at[j]);
            const double squared = squared_distance(other, p.map.place(here), p.map.place(to));
            const double keep = std::min(reach2(j), squared_norm(p.map.place(here) - other));
            is_clear = is_clear && squared >= keep - 1e-9;
            is_close = is_close || std::fabs(squared - keep) < 1e-5;
          }
          const auto& near = ways.near_places(ways.number(here, to));
          if (!is_close) {
            ASSERT_EQ(safe.first_clear(near, position, position).has_value(), is_clear);
          }
        }
        if (position == others.moves.size()) continue;
        const JointMove& m = others.moves[position].move;
        const Vec2 from = p.map.place(m.from), place = p.map.place(here);
        const double squared = squared_distance(place, from, p.map.place(m.to));
        const double keep = std::min(reach2(m.robot), squared_norm(from - place));
        if (std::fabs(squared - keep) < 1e-5) continue;
        const bool may_stay = safe.at(here, position) == safe.at(here, position + 1);
        ASSERT_EQ(may_stay, squared >= keep) << "place " << here << ", position " << position;
        ++(may_stay ? safe_moves : unsafe_moves);
      }
      if (position < others.moves.size()) at[others.moves[position].move.robot] = others.moves[position].move.to;
    }
  }
  EXPECT_GT(safe_moves, 1000u);
  EXPECT_GT(unsafe_moves, 100u);
}

}  // namespace
}  // namespace exactvo::formation::detail
