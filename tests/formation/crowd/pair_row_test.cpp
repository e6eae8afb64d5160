// SPDX-License-Identifier: GPL-3.0-or-later
// The lemmas of pair_row.h, by their numbers, in whole numbers of any length.
#include "crowd/pair_row.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "lp/sets/target.h"
#include "support/seeded_random.h"

namespace exactvo::formation::crowd {
namespace {

using test::SeededRandom;

/// A pair in the order of ids.
struct PairInStep {
  std::int64_t dx = 0, dy = 0;  ///< p_a - p_b
  std::int64_t radius = 0;      ///< R
  Motion wish_a, wish_b;
  Motion safe_a, safe_b;  ///< u
};

struct PairRows {
  MotionRow a, b;
  bool found;
};

/// Robots in columns, two of each pair.
class Columns {
 public:
  void add(const PairInStep& p) {
    put(p.dx - p.dx / 2, p.dy - p.dy / 2, p.wish_a, p.safe_a);
    put(-(p.dx / 2), -(p.dy / 2), p.wish_b, p.safe_b);
  }
  MotionColumns motions(bool at_rest) const {
    return {x_.data(),
            y_.data(),
            wish_x_.data(),
            wish_y_.data(),
            at_rest ? nullptr : safe_x_.data(),
            at_rest ? nullptr : safe_y_.data()};
  }

 private:
  void put(std::int64_t x, std::int64_t y, Motion wish, Motion safe) {
    x_.push_back(static_cast<std::int32_t>(x)), y_.push_back(static_cast<std::int32_t>(y));
    wish_x_.push_back(wish.x), wish_y_.push_back(wish.y);
    safe_x_.push_back(safe.x), safe_y_.push_back(safe.y);
  }

  std::vector<std::int32_t> x_, y_, wish_x_, wish_y_, safe_x_, safe_y_;
};

/// The row of a, and that of b.
PairRows pair_rows(const PairInStep& pair) {
  Columns columns;
  columns.add(pair);
  PairTable table;
  const std::size_t k = table.add(0, 1);
  table.radii[k] = static_cast<double>(pair.radius);
  make_pair_rows(columns.motions(pair.safe_a == Motion{} && pair.safe_b == Motion{}), table, 0);
  const PairRows rows{table.row(k, true), table.row(k, false), table.found(k)};
  EXPECT_TRUE(!table.grants(k, true) || rows.a.allows(pair.wish_a));
  EXPECT_TRUE(!table.grants(k, false) || rows.b.allows(pair.wish_b));
  return rows;
}

std::string text(const PairInStep& p) {
  std::string all = "D (" + std::to_string(p.dx) + ", " + std::to_string(p.dy) + "), R " + std::to_string(p.radius);
  const auto add = [&](const char* name, Motion m) {
    all += std::string(", ") + name + " (" + std::to_string(m.x) + ", " + std::to_string(m.y) + ")";
  };
  add("w_a", p.wish_a), add("w_b", p.wish_b), add("u_a", p.safe_a), add("u_b", p.safe_b);
  return all;
}

/// Whether |D + s M| < R for some s in [0, 1]. Exact.
bool meets(const PairInStep& p, Motion a, Motion b) {
  const mpz_class dx(static_cast<long>(p.dx)), dy(static_cast<long>(p.dy)), r(static_cast<long>(p.radius));
  const mpz_class mx = mpz_class(a.x) - b.x, my = mpz_class(a.y) - b.y;
  const mpz_class squared = mx * mx + my * my, along = dx * mx + dy * my, limit = r * r;
  if (along >= 0 || squared == 0) return dx * dx + dy * dy < limit;
  const mpz_class ex = dx + mx, ey = dy + my;
  if (-along >= squared) return ex * ex + ey * ey < limit;
  const mpz_class across = dx * my - dy * mx;
  return across * across < limit * squared;
}

mpz_class at(const MotionRow& row, Motion m) {
  return mpz_class(static_cast<long>(row.nx)) * m.x + mpz_class(static_cast<long>(row.ny)) * m.y;
}

bool allows(const MotionRow& row, Motion m) {
  return at(row, m) >= mpz_class(static_cast<long>(row.least));
}

/// Pairs at every scale; many in contact, all but in contact, or with wishes that cross.
class PairMaker {
 public:
  explicit PairMaker(std::uint64_t seed) : random_(test::seed_of_run(seed)) {}

  PairInStep next() {
    PairInStep p;
    const int scale = static_cast<int>(below(5));
    p.radius = std::int64_t{1} << (6 + 6 * scale);
    p.radius += static_cast<std::int64_t>(below(static_cast<std::uint64_t>(p.radius)));
    if (scale == 4) p.radius = (std::int64_t{1} << 29) + static_cast<std::int64_t>(below(1U << 28));
    const double angle = 6.283185307179586 * unit(), radius = static_cast<double>(p.radius);
    double gap = 0.0;
    const std::uint64_t kind = below(4);
    if (kind == 1) gap = static_cast<double>(below(4));
    if (kind == 2) gap = std::ldexp(unit(), static_cast<int>(below(24)));
    if (kind == 3) gap = 0.5 * radius * unit();
    const double far = radius + gap;
    p.dx = static_cast<std::int64_t>(std::nearbyint(far * std::cos(angle)));
    p.dy = static_cast<std::int64_t>(std::nearbyint(far * std::sin(angle)));
    if (below(8) == 0) p.dx = p.radius + static_cast<std::int64_t>(gap), p.dy = 0;
    p.wish_a = motion();
    p.wish_b = motion();
    if (below(16) == 0) p.wish_b = p.wish_a;
    return p;
  }

  Motion motion() {
    const double longest = std::ldexp(1.0, static_cast<int>(below(23))), angle = 6.283185307179586 * unit();
    return {static_cast<std::int32_t>(longest * unit() * std::cos(angle)),
            static_cast<std::int32_t>(longest * unit() * std::sin(angle))};
  }

  /// A motion that the row allows, most of them at its boundary.
  Motion allowed(const MotionRow& row, Motion wish, Motion safe) {
    for (int k = 0; k < 40; ++k) {
      const double share = k == 0 ? 1.0 : unit();
      const Motion m{static_cast<std::int32_t>(std::nearbyint(safe.x + share * (wish.x - safe.x))),
                     static_cast<std::int32_t>(std::nearbyint(safe.y + share * (wish.y - safe.y)))};
      if (allows(row, m)) return m;
    }
    return safe;
  }

 private:
  std::uint64_t below(std::uint64_t end) { return random_.bits() % end; }
  double unit() { return random_.uniform(0.0, 1.0); }

  SeededRandom random_;
};

bool overlaps(const PairInStep& p) {
  return mpz_class(static_cast<long>(p.dx)) * static_cast<long>(p.dx) +
             mpz_class(static_cast<long>(p.dy)) * static_cast<long>(p.dy) <
         mpz_class(static_cast<long>(p.radius)) * static_cast<long>(p.radius);
}

TEST(PairRow, Lemmas1And2_MotionsThatSatisfyTheirRowsNeverMeet) {
  PairMaker make(1);
  std::size_t judged = 0, moved = 0, would_meet = 0;
  for (int k = 0; k < 200000; ++k) {
    const PairInStep p = make.next();
    if (overlaps(p)) continue;
    const PairRows rows = pair_rows(p);
    ASSERT_TRUE(rows.found) << text(p);
    const Motion a = make.allowed(rows.a, p.wish_a, {}), b = make.allowed(rows.b, p.wish_b, {});
    ASSERT_FALSE(meets(p, a, b)) << text(p);
    ++judged;
    moved += a != Motion{} || b != Motion{};
    would_meet += meets(p, p.wish_a, p.wish_b);
  }
  EXPECT_GT(judged, 150000U);
  EXPECT_GT(moved, judged / 2);
  EXPECT_GT(would_meet, 10000U);
}

TEST(PairRow, Lemma3_RobotsThatOverlapDoNotComeNearer) {
  PairMaker make(2);
  std::size_t judged = 0;
  for (int k = 0; k < 50000; ++k) {
    PairInStep p = make.next();
    p.dx /= 2, p.dy /= 2;
    if (k % 100 == 0) p.dx = p.dy = 0;
    if (!overlaps(p)) continue;
    const PairRows rows = pair_rows(p);
    ASSERT_TRUE(rows.found) << text(p);
    const Motion a = make.allowed(rows.a, p.wish_a, {}), b = make.allowed(rows.b, p.wish_b, {});
    PairInStep before = p;
    before.radius = static_cast<std::int64_t>(std::sqrt(static_cast<double>(p.dx * p.dx + p.dy * p.dy)));
    while (overlaps(before)) --before.radius;
    ASSERT_FALSE(meets(before, a, b)) << text(p);
    ++judged;
  }
  EXPECT_GT(judged, 35000U);
}

TEST(PairRow, Lemma4_RowsAllowTheSafeMotionAndRest) {
  PairMaker make(3);
  std::size_t second = 0;
  for (int k = 0; k < 100000; ++k) {
    PairInStep p = make.next();
    PairRows rows = pair_rows(p);
    ASSERT_LE(rows.a.least, 0) << text(p);
    ASSERT_LE(rows.b.least, 0) << text(p);
    ASSERT_TRUE(rows.a.nx != 0 || rows.a.ny != 0) << text(p);
    p.safe_a = make.allowed(rows.a, p.wish_a, {});
    p.safe_b = make.allowed(rows.b, p.wish_b, {});
    rows = pair_rows(p);
    if (!rows.found) continue;
    ++second;
    ASSERT_TRUE(allows(rows.a, p.safe_a) && allows(rows.b, p.safe_b)) << text(p);
    if (overlaps(p)) continue;
    const Motion a = make.allowed(rows.a, p.wish_a, p.safe_a), b = make.allowed(rows.b, p.wish_b, p.safe_b);
    ASSERT_FALSE(meets(p, a, b)) << text(p);
    ASSERT_FALSE(meets(p, p.safe_a, b)) << text(p);
    ASSERT_FALSE(meets(p, a, p.safe_b)) << text(p);
  }
  EXPECT_GT(second, 80000U);
}

/// Whether every relative motion { s w_a - t w_b } keeps the two R apart. Exact.
bool all_stay_apart(const PairInStep& p) {
  const Motion a = p.wish_a, b = p.wish_b;
  const auto from = [&](std::int64_t x, std::int64_t y) {
    PairInStep moved = p;
    moved.dx += x, moved.dy += y;
    return moved;
  };
  if (meets(p, a, {}) || meets(p, {}, b) || meets(from(a.x, a.y), {}, b) || meets(from(-b.x, -b.y), a, {}))
    return false;
  const mpz_class x[] = {p.dx, p.dx + a.x, p.dx + a.x - b.x, p.dx - b.x},
                  y[] = {p.dy, p.dy + a.y, p.dy + a.y - b.y, p.dy - b.y};
  int left = 0, right = 0;
  for (int k = 0; k < 4; ++k) {
    const mpz_class side = x[k] * y[(k + 1) % 4] - y[k] * x[(k + 1) % 4];
    left += side > 0, right += side < 0;
  }
  return left > 0 && right > 0;  // 0 is not inside
}

TEST(PairRow, Lemma5_WishesThatStayApartAreNotHindered) {
  PairMaker make(4);
  std::size_t apart = 0;
  for (int k = 0; k < 100000; ++k) {
    PairInStep p = make.next();
    const std::int64_t room = 64 + p.radius / 4096;  // for the rounding of normals
    p.radius += room;
    if (overlaps(p) || !all_stay_apart(p)) continue;
    p.radius -= room;
    const PairRows rows = pair_rows(p);
    ASSERT_TRUE(allows(rows.a, p.wish_a) && allows(rows.b, p.wish_b)) << text(p);
    ++apart;
  }
  EXPECT_GT(apart, 20000U);
}

TEST(PairRow, ManyPairsAtOnceGetTheRowsOfEachAloneOnEveryTarget) {
  PairMaker make(6);
  std::vector<PairInStep> pairs;
  std::vector<PairRows> alone;
  for (int k = 0; k < 5000; ++k) {
    pairs.push_back(make.next());
    alone.push_back(pair_rows(pairs.back()));
  }
  std::size_t targets = 0;
  for (const char* target : {"", "AVX3", "AVX2", "SSE4", "SSE2"}) {
    if (!lp::limit_batch_target(target)) continue;  // not on this machine
    ++targets;
    for (const std::size_t first : {std::size_t{0}, std::size_t{5}}) {  // some of them later
      Columns columns;
      PairTable table;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        columns.add(pairs[k]);
        if (k == first && k > 0) make_pair_rows(columns.motions(true), table, 0);
        table.radii[table.add(2 * k, 2 * k + 1)] = static_cast<double>(pairs[k].radius);
      }
      make_pair_rows(columns.motions(true), table, first);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        for (const bool of_a : {true, false}) {
          const MotionRow expected = of_a ? alone[k].a : alone[k].b, got = table.row(k, of_a);
          ASSERT_TRUE(got.nx == expected.nx && got.ny == expected.ny && got.least == expected.least)
              << target << ' ' << text(pairs[k]);
        }
        ASSERT_TRUE(table.found(k));
      }
    }
  }
  lp::limit_batch_target("");
  EXPECT_GT(targets, 2U);
}

TEST(PairRow, TheOrderOfIdsIsAllThatTellsTheTwoApart) {
  PairMaker make(5);
  for (int k = 0; k < 20000; ++k) {
    const PairInStep p = make.next();
    const PairRows once = pair_rows(p), again = pair_rows(p);
    ASSERT_EQ(once.a.nx, again.a.nx);
    ASSERT_EQ(once.a.nx, -once.b.nx) << text(p);
    ASSERT_EQ(once.a.ny, -once.b.ny) << text(p);
  }
}

}  // namespace
}  // namespace exactvo::formation::crowd
