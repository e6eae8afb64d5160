// SPDX-License-Identifier: GPL-3.0-or-later
// A segment seen from a robot answers in the same bits as any shape does: nearest point, half-plane, the whole
// sequence.
#include "cone/seen_segment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

#include "cone/separation.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/constraint.h"
#include "support/seeded_random.h"

namespace exactvo::vo::detail {
namespace {

using geometry::Place;
using geometry::Segment;
using test::seed_of_run;
using test::SeededRandom;

/// Signs of zeros too.
template <class Value>
bool same_bits(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
bool same_bits(const std::optional<HalfPlane>& a, const std::optional<HalfPlane>& b) {
  return a.has_value() == b.has_value() && (!a || same_bits(*a, *b));
}
bool same_bits(const VelocityObstacle::Nearest& a, const VelocityObstacle::Nearest& b) {
  return same_bits(a.normal, b.normal) && same_bits(a.distance, b.distance);
}

struct Case {
  GrownShape seen;
  double room = 0.0;  ///< m
  double tau = 1.0;   ///< s
  Vec2 v;             ///< m/s
};

void print(const Case& c) {
  const Segment& s = std::get<Segment>(c.seen.shape);
  std::printf("segment %a %a %a %a robot %a %a radius %a room %a tau %a v %a %a\n", s.a.x, s.a.y, s.b.x, s.b.y,
              c.seen.origin.x, c.seen.origin.y, c.seen.radius, c.room, c.tau, c.v.x, c.v.y);
}

/// Segments of a grid of cells, slanting ones, points; robots beside them, on their lines, at the margin within
/// rounding, touching, inside; coordinates small and large.
class Cases {
 public:
  explicit Cases(std::uint64_t seed) : random_(seed) {}

  Case next() {
    Case c;
    const double size = scale();
    const Vec2 a = place(size);
    const Segment s{a, a + along(size)};
    c.seen.shape = s;
    c.seen.radius = random_.integer(0, 9) == 0 ? 0.0 : size * random_.uniform(0.01, 0.5);
    c.room = random_.integer(0, 3) == 0 ? 0.0 : size * random_.uniform(1e-6, 0.1);
    c.seen.origin = robot(s, c.seen.radius + c.room, size);
    c.tau = random_.uniform(0.05, 3.0);
    c.v = random_.integer(0, 9) == 0 ? Vec2{} : size * random_.uniform(0.0, 2.0) * random_.direction();
    if (random_.integer(0, 5) == 0) c.v.y = 0.0;
    return c;
  }

 private:
  double scale() {
    constexpr double kScales[] = {1.0, 1.0, 1.0, 1e-3, 1e6, 0x1p-500, 0x1p-530, 0x1p-1060, 0x1p400};
    return kScales[random_.integer(0, 8)];
  }
  Vec2 place(double size) {
    const Vec2 p = random_.in_box(20.0);
    return random_.integer(0, 1) == 0 ? size * p : size * 0.05 * Vec2{std::floor(p.x), std::floor(p.y)};
  }
  Vec2 along(double size) {
    const double length = size * 0.05 * random_.integer(1, 40);
    switch (random_.integer(0, 5)) {
      case 0:
        return {length, 0.0};
      case 1:
        return {0.0, -length};
      case 2:
        return {-length, 0.0};
      case 3:
        return {};
      default:
        return length * random_.direction();
    }
  }
  /// At about the distance `reach` of the segment, or anywhere.
  Vec2 robot(const Segment& s, double reach, double size) {
    const Vec2 on = s.a + random_.uniform(-0.5, 1.5) * (s.b - s.a);
    const Vec2 across = s.a == s.b ? random_.direction() : geometry::normalized(geometry::perp(s.b - s.a));
    constexpr double kGaps[] = {0.0, 1e-16, 1e-12, 1e-9, 1e-6, 0.01, 0.1, -1e-12, -0.01};
    switch (random_.integer(0, 4)) {
      case 0:
        return on;
      case 1:
        return on + size * random_.uniform(0.0, 5.0) * random_.direction();
      case 2:
        return s.b + reach * random_.direction();
      default:
        return on + (reach + size * kGaps[random_.integer(0, 8)]) * across;
    }
  }

  SeededRandom random_;
};

constexpr int kCases = 60000;

TEST(SeenSegment, GivesTheBitsOfAnyShape) {
  Cases cases(seed_of_run(71));
  int legs = 0, cut_offs = 0;
  for (int k = 0; k < kCases; ++k) {
    const Case c = cases.next();
    const SeenSegment segment(c.seen);
    const Vec2 n = geometry::normalized(c.v);
    const geometry::SupportValue mine = support(segment, n), theirs = geometry::support(c.seen, n);
    const std::optional<HalfPlane> h = separating_half_plane(segment, c.tau, c.v);
    const bool same = same_bits(mine, theirs) && same_bits(nearest_to(segment, {}), nearest_to(c.seen, {})) &&
                      same_bits(nearest_to(segment, c.tau * c.v), nearest_to(c.seen, c.tau * c.v)) &&
                      same_bits(h, separating_half_plane(c.seen, c.tau, c.v));
    if (!same) print(c);
    ASSERT_TRUE(same) << k;
    if (h) ++(h->offset < 0.0 ? cut_offs : legs);
  }
  EXPECT_GT(legs, kCases / 20);
  EXPECT_GT(cut_offs, kCases / 20);
}

TEST(SeenSegment, IsSurelyApartOnlyWhereItIsApart) {
  Cases cases(seed_of_run(72));
  int sure = 0, apart = 0;
  for (int k = 0; k < kCases; ++k) {
    Case c = cases.next();
    const double clearance = nearest_to(c.seen, {}).distance;
    c.seen.radius += c.room;
    const bool is_sure = is_surely_apart(SeenSegment(c.seen), c.room, clearance);
    const bool is_apart = locate(c.seen, Vec2{}) == Place::outside;
    if (is_sure && !is_apart) print(c);
    ASSERT_TRUE(is_apart || !is_sure) << k;
    sure += is_sure;
    apart += is_apart;
  }
  EXPECT_GT(sure, apart / 2);
  EXPECT_LT(sure, apart) << "no case in doubt was drawn";
}

/// Against the sequence's steps taken with the functions for any shape.
TEST(SeenSegment, GoesThroughTheWholeSequenceInTheSameBits) {
  Cases cases(seed_of_run(73));
  for (int k = 0; k < kCases; ++k) {
    Case c = cases.next();
    ClearancePolicy policy;
    policy.time_horizon = c.tau;
    policy.room = c.room;
    policy.push_out_speed = 0.3;
    const VelocityObstacle::Nearest nearest = nearest_to(c.seen, {});
    ASSERT_TRUE(same_bits(clearance_of(c.seen), nearest)) << k;
    GrownShape grown = c.seen;
    grown.radius += c.room;
    std::optional<HalfPlane> h;
    if (locate(grown, Vec2{}) == Place::outside) h = separating_half_plane(grown, c.tau, c.v);
    const ProvenHalfPlane expected =
        h ? ProvenHalfPlane{*h, Proof::alone} : contact_or_push_out(c.seen, nearest, policy);
    const ProvenHalfPlane found = half_plane_against(c.seen, nearest, c.v, policy);
    const bool same = same_bits(found.half_plane, expected.half_plane) && found.proof == expected.proof;
    if (!same) print(c);
    ASSERT_TRUE(same) << k;
  }
}

}  // namespace
}  // namespace exactvo::vo::detail
