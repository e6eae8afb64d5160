// SPDX-License-Identifier: GPL-3.0-or-later
// Joint plans that are made shorter: what sequences keep, and what their timetables say.
#include "liveness/shortening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "joint_problems.h"
#include "liveness/distances.h"
#include "liveness/timetable.h"

namespace exactvo::formation::detail {
namespace {

using Words = std::vector<std::array<std::size_t, 3>>;

Words words(const std::vector<JointMove>& moves) {
  Words all;
  for (const JointMove& m : moves) all.push_back({m.robot, m.from, m.to});
  return all;
}

RoadmapEdges edges_of(const JointProblem& p) {
  return RoadmapEdges(*p.map, 2.0 * *std::max_element(p.radii.begin(), p.radii.end()));
}

Timetable timetable_of(const JointProblem& p, const std::vector<JointMove>& moves) {
  RoadmapEdges edges = edges_of(p);
  return timetable_of(moves, p.radii, edges);
}

/// m: how far a robot that never waits would go until all robots have arrived, following the plan in small strides.
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

double cost_of(const JointProblem& p, const std::vector<JointMove>& moves) {
  const Timetable t = timetable_of(p, moves);
  return t.last + 0.2 * t.mean;
}

TEST(Shortening, Properties1To3_AreKept) {
  SeededRandom random(test::seed_of_run(61));
  std::size_t found = 0;
  for (int k = 0; k < 24; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    const std::vector<double> sizes = k % 4 < 2 ? std::vector{0.5, 0.5, 0.4} : std::vector{0.5, 0.3, 0.15};
    const Problem p(walls, 2 + random.integer(0, 14), random, sizes);
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    ++found;
    SCOPED_TRACE(described(p, answer.moves));
    const std::vector<JointMove> shorter = shortened(p.joint, answer.moves, k);
    const std::vector<PlannedMove> moves = on_map(p.map, shorter);
    std::vector<Vec2> at = positions(p.map, p.joint.starts);
    expect_apart(at, p.joint.radii, moves, walls);
    for (const PlannedMove& m : moves) at[m.robot] = m.to;
    EXPECT_EQ(at, positions(p.map, p.joint.goals)) << "Property 3";
    EXPECT_LE(cost_of(p.joint, shorter), (1.0 + 1e-9) * cost_of(p.joint, answer.moves));
  }
  EXPECT_GE(found, 18u);
}

/// Among many robots a fifth of the time and more is saved.
TEST(Shortening, ManyRobotsTakeLessTime) {
  SeededRandom random(test::seed_of_run(65));
  double before = 0.0, after = 0.0;
  for (int k = 0; k < 8; ++k) {
    const Problem p(two_rooms(1.5), 14, random);
    const JointAnswer answer = JointSearch(p.joint).run(k, {400000, 6000});
    if (answer.end != SearchEnd::found) continue;
    before += timetable_of(p.joint, answer.moves).last;
    after += timetable_of(p.joint, shortened(p.joint, answer.moves, k)).last;
  }
  EXPECT_GT(before, 0.0);
  EXPECT_LT(after, 0.85 * before);
}

TEST(Shortening, IsDeterministicAndChangesNothingOnceStopped) {
  SeededRandom random(test::seed_of_run(62));
  Problem p(two_rooms(1.5), 10, random);
  const JointAnswer answer = JointSearch(p.joint).run(1, {400000, 6000});
  ASSERT_EQ(answer.end, SearchEnd::found);
  const std::vector<JointMove> once = shortened(p.joint, answer.moves, 5);
  EXPECT_EQ(words(once), words(shortened(p.joint, answer.moves, 5)));
  EXPECT_LT(cost_of(p.joint, once), cost_of(p.joint, answer.moves));
  p.joint.is_stopped = [] { return true; };
  Words stopped = words(shortened(p.joint, answer.moves, 5)), given = words(answer.moves);
  std::sort(stopped.begin(), stopped.end());
  std::sort(given.begin(), given.end());
  EXPECT_EQ(stopped, given);
  EXPECT_TRUE(shortened(p.joint, {}, 5).empty());
}

/// What is near to each other keeps its order, also where a small robot was last on an edge: it hides no large one.
TEST(Timetable, KeepsTheOrderOfMovesThatComeNear) {
  const Walls open({});
  Roadmap map(open, {{0, 0}, {8, 8}}, 0.5);
  const auto place = [&](double x, double y) { return map.attach({1.06 * x, 1.06 * y}, 0.5); };
  JointProblem p;
  p.map = &map;
  p.radii = {0.5, 0.3, 0.3};
  const std::vector<JointMove> moves{{0, place(4, 3), place(4, 4)}, {0, place(4, 4), place(5, 5)},
                                     {0, place(5, 5), place(6, 6)}, {1, place(3, 4), place(4, 4)},
                                     {1, place(4, 4), place(5, 5)}, {2, place(6, 4), place(5, 4)}};
  const Timetable t = timetable_of(p, moves);
  std::size_t large = 0, small = 0;
  for (std::size_t k = 0; k < t.moves.size(); ++k) {
    if (t.moves[k].move.robot == 0 && t.moves[k].move.to == place(5, 5)) large = k;
    if (t.moves[k].move.robot == 2) small = k;
  }
  EXPECT_LT(large, small);
}

TEST(Timetable, IsASequenceOfClearMoves) {
  SeededRandom random(test::seed_of_run(66));
  std::size_t found = 0;
  for (int k = 0; k < 120; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    const Problem p(walls, 6 + random.integer(0, 8), random, {0.5, 0.3, 0.15});
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    ++found;
    SCOPED_TRACE(described(p, answer.moves));
    std::vector<JointMove> by_start;
    for (const TimedMove& m : timetable_of(p.joint, answer.moves).moves) by_start.push_back(m.move);
    expect_apart(positions(p.map, p.joint.starts), p.joint.radii, on_map(p.map, by_start), walls);
  }
  EXPECT_GE(found, 100u);
}

/// Robots in a row go one behind the other without waiting; a robot that crosses another's way waits for it.
TEST(Timetable, KnowsWhichRobotWaitsForWhich) {
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
  int found = 0;
  for (int k = 0; k < 12; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    const Problem p(walls, 4 + random.integer(0, 8), random);
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    const double ratio = driven(p, answer.moves) / timetable_of(p.joint, answer.moves).last;
    ++found;
    EXPECT_GT(ratio, 0.75);
    EXPECT_LT(ratio, 1.35);
  }
  EXPECT_GE(found, 9);
}

/// Against every position and place: whether a robot can stand there while the others make their next move, and
/// whether somebody stands near a way.
TEST(SafeIntervals, SameAsLookingAtEveryMove) {
  SeededRandom random(test::seed_of_run(64));
  std::size_t safe_moves = 0, unsafe_moves = 0, waits = 0;
  for (int k = 0; k < 10; ++k) {
    const Walls walls = k % 2 == 0 ? two_rooms(1.5) : Walls({});
    const Problem p(walls, 3 + random.integer(0, 6), random, {0.5, 0.5, 0.4});
    const JointAnswer answer = JointSearch(p.joint).run(k, {200000, 3000});
    if (answer.end != SearchEnd::found) continue;
    const std::size_t robot = static_cast<std::size_t>(random.integer(0, static_cast<int>(p.joint.radii.size()) - 1));
    std::vector<JointMove> moves;
    for (const JointMove& m : answer.moves)
      if (m.robot != robot) moves.push_back(m);
    RoadmapEdges edges = edges_of(p.joint);
    const Timetable others = timetable_of(moves, p.joint.radii, edges);
    SafeIntervals safe(p.joint);
    safe.set(robot, others, edges);
    const auto reach2 = [&](std::size_t j) {
      const double wanted = (1.0 + kPlannedGap) * (p.joint.radii[robot] + p.joint.radii[j]);
      return wanted * wanted;
    };
    std::vector<PlaceNumber> at = p.joint.starts;
    std::map<PlaceNumber, std::size_t> clear_since;  // by place: where the search for the next clear position began
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
          const auto& near = edges.near_places(edges.number(here, to));
          if (is_close) {
            clear_since.erase(here);
          } else {
            ASSERT_EQ(safe.first_clear(near, position, position) == position, is_clear);
            const std::size_t began = clear_since.try_emplace(here, position).first->second;
            if (is_clear) {
              ASSERT_EQ(safe.first_clear(near, began, others.moves.size()), position);
              waits += began < position;
              clear_since.erase(here);
            }
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
  EXPECT_GT(waits, 50u);
}

}  // namespace
}  // namespace exactvo::formation::detail
