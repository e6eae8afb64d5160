// SPDX-License-Identifier: GPL-3.0-or-later
// The motion nearest to a wish where one row binds or two, against the linear program and in whole numbers.
#include "crowd/few_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactvo/vo/lp/solve.h"
#include "lp/sets/target.h"
#include "support/seeded_random.h"

namespace exactvo::formation::crowd {
namespace {

using test::SeededRandom;

constexpr double kNormal = 0x1p20, kFar = 1e5;

std::int32_t whole_in(SeededRandom& random, double most) {
  return static_cast<std::int32_t>(std::lround(random.uniform(-most, most)));
}

struct Row {
  double x, y, least;
};

/// Of one robot.
struct Wanted {
  Motion wish;
  double squared_disc = kFar * kFar, squared_way = kFar * kFar;
  std::vector<Row> rows;
};

struct Answer {
  Few found;
  Motion m;
};

/// Rows that rest satisfies; some twice, some opposite to another.
Wanted random_rows(SeededRandom& random) {
  Wanted w;
  w.wish = {whole_in(random, 0.7 * kFar), whole_in(random, 0.7 * kFar)};
  w.squared_way *= random.integer(0, 3) == 0 ? 0.25 : 1.0;
  const int count = random.integer(1, 16);
  for (int k = 0; k < count; ++k) {
    const double side = random.integer(0, 1) == 0 ? 1.0 : -1.0;
    if (k > 0 && random.integer(0, 7) == 0) {
      w.rows.push_back({side * w.rows[0].x, side * w.rows[0].y, w.rows[0].least});
      continue;
    }
    const double angle = random.uniform(0.0, 6.2831853);
    w.rows.push_back({side * std::round(kNormal * std::cos(angle)), side * std::round(kNormal * std::sin(angle)),
                      -std::round(random.uniform(0.0, 0.8 * kFar) * kNormal)});
  }
  return w;
}

std::vector<Wanted> many_random_rows(SeededRandom& random, std::size_t count) {
  std::vector<Wanted> many;
  while (many.size() < count) many.push_back(random_rows(random));
  return many;
}

/// `together` robots at a time.
std::vector<Answer> answers(const std::vector<Wanted>& many, std::size_t together) {
  std::vector<Answer> all;
  FewRows rows;
  for (std::size_t k = 0; k < many.size(); ++k) {
    for (const Row& row : many[k].rows) EXPECT_TRUE(rows.add(1.0, row.x, row.y, row.least));
    rows.finish(many[k].wish, many[k].squared_disc, many[k].squared_way);
    const std::size_t count = rows.robots;
    if (count < together && k + 1 < many.size()) continue;
    Few found[FewRows::kLanes];
    Motion m[FewRows::kLanes];
    nearest_of_few(rows, found, m);
    for (std::size_t lane = 0; lane < count; ++lane) all.push_back({found[lane], m[lane]});
  }
  return all;
}

void expect_same(const std::vector<Answer>& some, const std::vector<Answer>& others, const char* what) {
  ASSERT_EQ(some.size(), others.size());
  for (std::size_t k = 0; k < some.size(); ++k) {
    ASSERT_EQ(some[k].found, others[k].found) << k << ' ' << what;
    if (some[k].found != Few::not_found) {
      ASSERT_TRUE(some[k].m == others[k].m) << k << ' ' << what;
    }
  }
}

bool all_allow(const Wanted& w, Motion m) {
  return std::all_of(w.rows.begin(), w.rows.end(), [&](const Row& row) {
    return MotionRow{static_cast<std::int64_t>(row.x), static_cast<std::int64_t>(row.y),
                     static_cast<std::int64_t>(row.least)}
        .allows(m);
  });
}

double distance(Motion m, double x, double y) {
  return std::hypot(m.x - x, m.y - y);
}

/// How far the linear program's answer for the rows, moved inward, is from the wish; negative: it has none.
double distance_of_program(const Wanted& w) {
  lp::Problem problem;
  problem.bound.disc = kFar;
  problem.preferred = {static_cast<double>(w.wish.x), static_cast<double>(w.wish.y)};
  for (const Row& row : w.rows) {
    const double length = std::hypot(row.x, row.y);
    problem.constraints.push_back(
        {{{row.x / length, row.y / length}, row.least / length + kHalfDiagonal}, lp::Priority::hard, -1});
  }
  const lp::Solution s = lp::solve(problem);
  return s.status == lp::Status::optimal ? distance(w.wish, s.velocity.x, s.velocity.y) : -1.0;
}

TEST(FewRows, AllowedMotionsSatisfyAllRowsAndAreAsNearAsTheLinearPrograms) {
  SeededRandom random(test::seed_of_run(81));
  const std::vector<Wanted> many = many_random_rows(random, 20000);
  const std::vector<Answer> all = answers(many, FewRows::kLanes);
  std::size_t allowed = 0, moved = 0, too_far = 0, not_found = 0;
  for (std::size_t k = 0; k < many.size(); ++k) {
    const Wanted& given = many[k];
    const auto [found, m] = all[k];
    too_far += found == Few::not_allowed;
    not_found += found == Few::not_found;
    if (found != Few::allowed) continue;
    ++allowed;
    ASSERT_TRUE(all_allow(given, m)) << k;
    if (m == given.wish) continue;
    ++moved;
    ASSERT_FALSE(all_allow(given, given.wish)) << k;
    ASSERT_LE(1.0 * m.x * m.x + 1.0 * m.y * m.y, given.squared_way) << k;
    const double best = distance_of_program(given);
    ASSERT_GE(best, 0.0) << k;
    ASSERT_NEAR(distance(m, given.wish.x, given.wish.y), best, 1.0) << k;
  }
  EXPECT_GT(allowed, 8000U);
  EXPECT_GT(moved, 4000U);
  EXPECT_GT(too_far, 100U);
  EXPECT_GT(not_found, 300U);
}

TEST(FewRows, TargetsAndRobotsBesideChangeNothing) {
  SeededRandom random(test::seed_of_run(83));
  const std::vector<Wanted> many = many_random_rows(random, 20000);
  const std::vector<Answer> alone = answers(many, 1);
  std::size_t targets = 0;
  for (const char* target : {"AVX3", "AVX2", "SSE4", "SSE2"}) {
    if (!lp::limit_batch_target(target)) continue;  // not on this machine
    ++targets;
    for (const std::size_t together : {1, 3, 8}) expect_same(alone, answers(many, together), target);
  }
  lp::limit_batch_target("");
  EXPECT_GT(targets, 1U);
}

TEST(FewRows, ARobotWithMoreRowsThanThereIsRoomForIsDropped) {
  FewRows rows;
  for (std::size_t k = 0; k < FewRows::kMost; ++k) ASSERT_TRUE(rows.add(1.0, kNormal, 0.0, -1.0)) << k;
  ASSERT_FALSE(rows.add(1.0, kNormal, 0.0, -1.0));
  rows.drop();
  ASSERT_TRUE(rows.add(1.0, kNormal, 0.0, -kNormal));
  rows.finish({-5, 7}, kFar, kFar);
  Few found[FewRows::kLanes];
  Motion m[FewRows::kLanes];
  nearest_of_few(rows, found, m);
  EXPECT_EQ(found[0], Few::allowed);
  EXPECT_TRUE((m[0] == Motion{0, 7}));
  EXPECT_EQ(rows.robots, 0U);
}

/// Which robots come first in a list of pairs depends on how robots are divided among threads.
TEST(FewRows, TheOrderOfRowsChangesNothing) {
  SeededRandom random(test::seed_of_run(82));
  std::vector<Wanted> many = many_random_rows(random, 20000);
  const std::vector<Answer> before = answers(many, FewRows::kLanes);
  for (Wanted& w : many) std::reverse(w.rows.begin(), w.rows.end());
  expect_same(before, answers(many, FewRows::kLanes), "in another order");
  std::size_t changed = 0;
  for (std::size_t k = 0; k < many.size(); ++k)
    changed += before[k].found != Few::not_found && before[k].m != many[k].wish;
  EXPECT_GT(changed, 4000U);
}

}  // namespace
}  // namespace exactvo::formation::crowd
