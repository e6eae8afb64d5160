// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies in motion: verdicts against an oracle in rationals, and what the header promises.
#include "exactvo/geometry/motions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/predicates.h"
#include "geometry/motion_judge.h"

namespace exactvo::test {
namespace {

using geometry::b_spline_pieces;
using geometry::Bounds;
using geometry::CurveBasis;
using geometry::CurvedMotion;
using geometry::disc_body;
using geometry::Encounter;
using geometry::held;
using geometry::Motion;
using geometry::MotionVerdict;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::RigidBody;
using geometry::StraightMotion;
using geometry::Vec2;

bool holds(const Bounds& b, double x) {
  return b.low <= x && x <= b.high;
}

StraightMotion straight(Vec2 from, Vec2 to, double start = 0.0, double end = 1.0) {
  return {{start, from}, {end, to}};
}

// --- Against the oracle ---

class AgainstTheOracle : public testing::TestWithParam<std::pair<MotionKind, std::size_t>> {};

TEST_P(AgainstTheOracle, VerdictsClearancesAndMomentsAreRight) {
  const auto [kind, count] = GetParam();
  const MotionCampaign campaign = judge_motions(kind, count, seed_of_run(31), 4);
  for (const std::string& failure : campaign.failures) ADD_FAILURE() << failure;
  std::printf("%s\n", campaign.summary().c_str());
  EXPECT_EQ(campaign.cases, count);
  EXPECT_LE(campaign.loose * 200, count);
  // The generator's share of each verdict, so that no kind is judged by clear cases alone.
  EXPECT_GE(campaign.clear * 10, count);
  EXPECT_GE(campaign.contact * 100, count);
  EXPECT_GE(campaign.overlap * 10, count);
  EXPECT_EQ(campaign.by_filter + campaign.exactly, count - campaign.apart_in_time);
}

INSTANTIATE_TEST_SUITE_P(Motions, AgainstTheOracle,
                         testing::Values(std::pair{MotionKind::discs, 10000},
                                         std::pair{MotionKind::disc_and_edges, 5000},
                                         std::pair{MotionKind::curved_discs, 2500},
                                         std::pair{MotionKind::curved_edges, 800}, std::pair{MotionKind::bodies, 500}),
                         [](const auto& info) {
                           std::string name = name_of(info.param.first);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(Motions, CasesOfTheCorpusAreRight) {
  MotionCampaign campaign;
  for (const CorpusCase& line : read_corpus("geometry/motions.txt")) judge_motion(motion_case_of(line), campaign);
  for (const std::string& failure : campaign.failures) ADD_FAILURE() << failure;
  EXPECT_GE(campaign.cases, 4u);
}

TEST(Motions, CorpusLinesReadBackBitForBit) {
  SeededRandom random(seed_of_run(32));
  for (int i = 0; i < 500; ++i) {
    const std::string line = corpus_line(random_motion_case(random, kMotionKinds[i % 5]));
    ASSERT_EQ(corpus_line(motion_case_of(parse_corpus(line, "here").at(0))), line);
  }
}

TEST(Motions, TheFilterDecidesRandomMotions) {
  SeededRandom random(seed_of_run(33));
  geometry::reset_stage_counts();
  constexpr int kCases = 20000;
  for (int i = 0; i < kCases; ++i) {
    const auto motion = [&] { return straight(random.in_box(50.0), random.in_box(50.0)); };
    encounter(motion(), disc_body(0.3), motion(), disc_body(0.3));
  }
  EXPECT_EQ(geometry::stage_counts().filter + geometry::stage_counts().exact, static_cast<unsigned>(kCases));
  EXPECT_LE(geometry::stage_counts().exact, 2u);
}

// --- Straight motions ---

TEST(Motions, CrossingDiscsOverlapBetweenTwoMomentsThatAreKnown) {
  // Head-on at 2 m/s from 10 m: distance 10 - 2 t, in contact at 1 m, that is at t = 4.5, apart again at t = 5.5.
  const MotionVerdict v =
      examine(straight({0, 0}, {10, 0}, 0, 10), disc_body(0.5), straight({10, 0}, {0, 0}, 0, 10), disc_body(0.5));
  EXPECT_EQ(v.encounter, Encounter::overlap);
  EXPECT_TRUE(holds(v.first, 4.5));
  EXPECT_TRUE(holds(v.last, 5.5));
  EXPECT_LT(v.first.high - v.first.low, 1e-9);
  EXPECT_TRUE(holds(v.clearance, -1.0)) << "centre upon centre";
  EXPECT_NEAR(v.nearest_time, 5.0, 1e-9);
  EXPECT_NEAR(v.place.x, 5.0, 1e-9);
}

TEST(Motions, SamplesMissWhatHappensBetweenThem) {
  const MotionVerdict v =
      examine(straight({0, 0}, {10, 0}), disc_body(0.25), straight({5, -5}, {5, 5}), disc_body(0.25));
  EXPECT_EQ(v.encounter, Encounter::overlap);
  EXPECT_NEAR(v.nearest_time, 0.5, 1e-9);
}

TEST(Motions, TouchingInPassingIsContactAndAnUlpDecides) {
  const Motion a = straight({-4, 5}, {4, 5}), b = held({0, {0, 0}}, 1);
  EXPECT_EQ(encounter(a, disc_body(2), b, disc_body(3)), Encounter::contact);
  EXPECT_EQ(encounter(a, disc_body(2), b, disc_body(std::nextafter(3, 4))), Encounter::overlap);
  EXPECT_EQ(encounter(a, disc_body(2), b, disc_body(std::nextafter(3, 2))), Encounter::clear);
  const MotionVerdict v = examine(a, disc_body(2), b, disc_body(3));
  EXPECT_EQ(v.clearance.low, 0.0);
  EXPECT_EQ(v.clearance.high, 0.0);
  EXPECT_NEAR(v.place.y, 3.0, 1e-12);
}

TEST(Motions, WithoutACommonMomentTheyAreClear) {
  const MotionVerdict v =
      examine(straight({0, 0}, {1, 0}, 0, 1), disc_body(9), straight({0, 0}, {1, 0}, 2, 3), disc_body(9));
  EXPECT_EQ(v.encounter, Encounter::clear);
  EXPECT_TRUE(std::isinf(v.clearance.low));
}

TEST(Motions, AMomentInCommonIsEnough) {
  const Motion before = straight({0, 0}, {1, 0}, 0, 1), after = straight({1, 0.5}, {9, 9}, 1, 2);
  EXPECT_EQ(encounter(before, disc_body(0.5), after, disc_body(0.5)), Encounter::overlap);
  EXPECT_EQ(encounter(before, disc_body(0.25), after, disc_body(0.25)), Encounter::contact);
}

TEST(Motions, AMotionOfNoDurationCountsWithItsWholeWay) {
  const Motion jump = straight({-5, 0}, {5, 0}, 1, 1), rest = held({0, {0, 0.5}}, 2);
  EXPECT_EQ(encounter(jump, disc_body(0.5), rest, disc_body(0.25)), Encounter::overlap);
  EXPECT_EQ(encounter(jump, disc_body(0.25), rest, disc_body(0.25)), Encounter::contact);
}

TEST(Motions, PointsThatMeetOverlap) {
  EXPECT_EQ(encounter(straight({-1, 0}, {1, 0}), disc_body(0), straight({0, -1}, {0, 1}), disc_body(0)),
            Encounter::overlap);
  EXPECT_EQ(encounter(straight({-1, 0}, {1, 0}), disc_body(0), Polyline{{{0, -1}, {0, 1}}}), Encounter::overlap);
}

TEST(Motions, RobotsInFormationAreDecidedByTheFilter) {
  geometry::reset_stage_counts();
  for (int i = 1; i < 100; ++i) {
    const Vec2 way{0.1 * i, 0.07 * i}, start{0.3 * i, 0.9}, gap{0.6, 0.1 * i};
    EXPECT_EQ(encounter(straight(start, start + way), disc_body(0.2), straight(start + gap, start + gap + way),
                        disc_body(0.2)),
              Encounter::clear);
  }
  EXPECT_EQ(geometry::stage_counts().exact, 0u);
}

// --- Obstacles ---

TEST(Motions, APolygonIsAnObstacleWithItsInside) {
  const Obstacle room = Polygon{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {}};
  EXPECT_EQ(encounter(straight({-1, 0}, {1, 0}), disc_body(0.25), room), Encounter::overlap);
  EXPECT_EQ(encounter(straight({-1, 0}, {1, 0}), disc_body(0), room), Encounter::overlap);
  EXPECT_EQ(encounter(straight({-7, 5}, {7, 5}), disc_body(0), room), Encounter::contact) << "a point along an edge";
  EXPECT_EQ(encounter(straight({-7, 7}, {7, 7}), disc_body(2), room), Encounter::contact);
  EXPECT_EQ(encounter(straight({-6, 4}, {-4, 6}), disc_body(0), room), Encounter::contact) << "a point past a corner";
  const MotionVerdict v = examine(straight({-1, 0}, {1, 0}), disc_body(0.25), room);
  EXPECT_TRUE(holds(v.clearance, -0.25)) << "inside counts as distance 0";
}

TEST(Motions, AHoleIsFree) {
  const Obstacle frame = Polygon{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {{{-2, -2}, {-2, 2}, {2, 2}, {2, -2}}}};
  EXPECT_EQ(encounter(straight({-1, 0}, {1, 0}), disc_body(0.5), frame), Encounter::clear);
  EXPECT_EQ(encounter(straight({-1, 0}, {1, 0}), disc_body(1.0), frame), Encounter::contact);
  EXPECT_TRUE(holds(examine(straight({-1, 0}, {1, 0}), disc_body(0.5), frame).clearance, 0.5));
}

// --- Curves ---

TEST(Motions, AParabolaTouchesADisc) {
  // p(t) = (t, 1 + t^2) for t in [-1, 1]: nearest to the origin at t = 0.
  const Motion curve = CurvedMotion{CurveBasis::powers, 0, 2, {{-1, 2}, {1, -2}, {0, 1}}};
  const Motion rest = held({0, {0, 0}}, 2);
  EXPECT_EQ(encounter(curve, disc_body(0.5), rest, disc_body(0.5)), Encounter::contact);
  const MotionVerdict v = examine(curve, disc_body(0.5), rest, disc_body(0.75));
  EXPECT_EQ(v.encounter, Encounter::overlap);
  EXPECT_TRUE(holds(v.clearance, -0.25));
  EXPECT_NEAR(v.nearest_time, 1.0, 1e-5);
}

TEST(Motions, AllBasesGiveTheSameAnswerForOneCurve) {
  // t -> (t, t^2) on [0, 1], in powers, as a Bezier curve and as a quadratic B-spline.
  const CurvedMotion curves[] = {{CurveBasis::powers, 0, 1, {{0, 0}, {1, 0}, {0, 1}}},
                                 {CurveBasis::bezier, 0, 1, {{0, 0}, {0.5, 0}, {1, 1}}},
                                 {CurveBasis::b_spline, 0, 1, {{-0.5, 0}, {0.5, 0}, {1.5, 2}}}};
  for (const CurvedMotion& curve : curves) {
    for (const double t : {0.0, 0.25, 0.5, 1.0}) {
      EXPECT_NEAR(position_at(curve, t).x, t, 1e-15);
      EXPECT_NEAR(position_at(curve, t).y, t * t, 1e-15);
    }
    // Through (1/2, 1/4) exactly: a wall that ends there is met by a point.
    EXPECT_EQ(encounter(curve, disc_body(0), Polyline{{{0.5, 0.25}, {0.5, 3}}}), Encounter::overlap);
    EXPECT_EQ(encounter(curve, disc_body(0), Polyline{{{0.5, std::nextafter(0.25, 1)}, {0.5, 3}}}), Encounter::clear);
  }
}

TEST(Motions, PiecesOfABSplineJoin) {
  const std::vector<CurvedMotion> pieces =
      b_spline_pieces({{0, 0}, {1, 2}, {3, 1}, {4, 4}, {6, 0}, {7, 1}}, 3, 10, 0.5);
  ASSERT_EQ(pieces.size(), 3u);
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].end, pieces[i + 1].start);
    const Vec2 gap = position_at(pieces[i], pieces[i].end) - position_at(pieces[i + 1], pieces[i + 1].start);
    EXPECT_LT(norm(gap), 1e-14);
  }
}

// --- Bodies ---

TEST(Motions, BoxesSlideAlongEachOther) {
  const RigidBody box{{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 0.0}};
  const Motion rest = held({0, {0, 0}}, 1);
  EXPECT_EQ(encounter(straight({-5, 2}, {5, 2}), box, rest, box), Encounter::contact);
  EXPECT_EQ(encounter(straight({-5, 2}, {5, 1.999}), box, rest, box), Encounter::overlap);
  EXPECT_EQ(encounter(straight({-4, 0}, {0, 4}), box, rest, box), Encounter::contact) << "corner to corner";
  EXPECT_EQ(encounter(straight({0, 0}, {1, 0}), box, Polygon{{{-9, -1}, {9, -1}, {9, 9}, {-9, 9}}, {}}),
            Encounter::overlap)
      << "inside, touching an edge";
}

TEST(Motions, TheMomentShownOfAnOverlapIsNoneAtWhichBoxesOnlyTouch) {
  const RigidBody box{{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 0.0}};
  const Vec2 place{2, 0};
  const Polygon block{{{1, -1}, {3, -1}, {3, 1}, {1, 1}}, {}};
  const auto overlap_there = [&](const Motion& motion, const MotionVerdict& verdict) {
    const Vec2 at = position_at(motion, verdict.nearest_time);
    return verdict.encounter == Encounter::overlap &&
           encounter(held({0, at}, 1), box, held({0, place}, 1), box) == Encounter::overlap;
  };
  const Motion rest = held({0, place}, 1);
  const Motion deeper = straight({0, 0}, {1, 0}), out = straight({1, 0}, {0, 0});
  const Motion soon_out{geometry::CurvedMotion{geometry::CurveBasis::powers, 0, 1, {{0, 0}, {0.125, 0}, {-1, 0}}}};
  for (const Motion& motion : {deeper, out, soon_out}) {
    const MotionVerdict beside = examine(motion, box, rest, box), in_block = examine(motion, box, block);
    EXPECT_TRUE(overlap_there(motion, beside)) << beside.nearest_time;
    EXPECT_TRUE(overlap_there(motion, in_block)) << in_block.nearest_time;
    const Vec2 from_mover = beside.place - position_at(motion, beside.nearest_time), from_other = beside.place - place;
    for (const Vec2 d : {from_mover, from_other}) EXPECT_LE(std::max(std::fabs(d.x), std::fabs(d.y)), 1.0);
  }
}

TEST(Motions, AChainOfDiscsPassesWhereOneDiscDoesNot) {
  const RigidBody chain{{{{-0.3, 0}}, 0.2}, {{{0, 0}}, 0.2}, {{{0.3, 0}}, 0.2}};
  const Obstacle wall = Polyline{{{-9, 0.25}, {9, 0.25}}};
  EXPECT_EQ(encounter(straight({-5, 0}, {5, 0}), chain, wall), Encounter::clear);
  EXPECT_EQ(encounter(straight({-5, 0}, {5, 0}), disc_body(0.5), wall), Encounter::overlap);
}

TEST(Motions, APolygonalBodyNeedNotBeConvex) {
  const RigidBody u =
      geometry::polygon_body({{{-3, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {-2, 1}, {-2, 3}, {-3, 3}}, {}});
  // A small disc between the arms, and one that is too large.
  const Motion rest = held({0, {0, 0}}, 1);
  EXPECT_EQ(encounter(straight({0, 0}, {0, -0.5}), u, held({0, {0, 2.5}}, 1), disc_body(1.5)), Encounter::contact);
  EXPECT_EQ(encounter(rest, u, held({0, {0, 2.5}}, 1), disc_body(2.5)), Encounter::overlap);
}

// --- Properties of the header ---

TEST(Motions, Property1_TheOrderOfTheTwoDoesNotMatter) {
  SeededRandom random(seed_of_run(34));
  int judged = 0;
  for (int i = 0; i < 2000; ++i) {
    const MotionCase c = random_motion_case(random, kMotionKinds[i % 5]);
    if (!c.b) continue;
    ++judged;
    ASSERT_EQ(encounter(c.a, c.body_a, *c.b, c.body_b), encounter(*c.b, c.body_b, c.a, c.body_a)) << corpus_line(c);
  }
  EXPECT_GE(judged, 800);
}

/// Lengths times a power of two; times too, but for curves in powers of time.
MotionCase scaled(MotionCase c, double by, double by_time) {
  const auto scale = [&](Motion& m) {
    if (auto* s = std::get_if<StraightMotion>(&m)) {
      for (geometry::TimedPoint* p : {&s->from, &s->to}) *p = {by_time * p->time, by * p->at};
      return;
    }
    auto& curve = std::get<CurvedMotion>(m);
    curve.start *= by_time;
    curve.end *= by_time;
    double factor = by;
    for (Vec2& p : curve.points) {
      p = factor * p;
      if (curve.basis == CurveBasis::powers) factor /= by_time;
    }
  };
  const auto scale_body = [&](RigidBody& body) {
    for (auto& part : body) {
      part.radius *= by;
      for (Vec2& v : part.corners) v = by * v;
    }
  };
  scale(c.a);
  scale_body(c.body_a);
  if (c.b) scale(*c.b);
  scale_body(c.body_b);
  if (c.obstacle) {
    if (auto* wall = std::get_if<Polyline>(&*c.obstacle))
      for (Vec2& p : wall->points) p = by * p;
    else
      for (auto* ring : {&std::get<Polygon>(*c.obstacle).outer})
        for (Vec2& p : *ring) p = by * p;
    if (auto* polygon = std::get_if<Polygon>(&*c.obstacle))
      for (auto& hole : polygon->holes)
        for (Vec2& p : hole) p = by * p;
  }
  return c;
}

TEST(Motions, Property2_PowersOfTwoChangeNoVerdict) {
  SeededRandom random(seed_of_run(35));
  for (int i = 0; i < 1500; ++i) {
    const MotionCase c = random_motion_case(random, kMotionKinds[i % 5]);
    const Encounter expected = encounter(c);
    ASSERT_EQ(encounter(scaled(c, 1024.0, 1.0)), expected) << corpus_line(c);
    ASSERT_EQ(encounter(scaled(c, 0x1p-10, 8.0)), expected) << corpus_line(c);
  }
}

TEST(Motions, Property3_ALargerRadiusIsNeverClearer) {
  SeededRandom random(seed_of_run(36));
  for (int i = 0; i < 1500; ++i) {
    MotionCase c = random_motion_case(random, kMotionKinds[i % 5]);
    const Encounter before = encounter(c);
    for (auto& part : c.body_a) part.radius = std::nextafter(part.radius, 1e300);
    const Encounter after = encounter(c);
    ASSERT_GE(static_cast<int>(after), static_cast<int>(before)) << corpus_line(c);
    if (before == Encounter::contact) {
      ASSERT_EQ(after, Encounter::overlap) << corpus_line(c);
    }
  }
}

TEST(Motions, Property4_TheWholeIsAsBadAsItsWorstPart) {
  SeededRandom random(seed_of_run(37));
  int overlaps = 0, clear = 0;
  for (int i = 0; i < 1500; ++i) {
    MotionCase c = random_motion_case(random, i % 2 == 0 ? MotionKind::discs : MotionKind::disc_and_edges);
    auto& whole = std::get<StraightMotion>(c.a);
    // Whole numbers, so that the middle is exact.
    for (geometry::TimedPoint* p : {&whole.from, &whole.to}) p->at = {std::nearbyint(p->at.x), std::nearbyint(p->at.y)};
    whole.from.time = std::nearbyint(8 * whole.from.time);
    whole.to.time = std::nearbyint(8 * whole.to.time);
    const Encounter expected = encounter(c);
    const geometry::TimedPoint middle{0.5 * (whole.from.time + whole.to.time), 0.5 * (whole.from.at + whole.to.at)};
    if (whole.from.time == whole.to.time) continue;
    MotionCase first = c, second = c;
    std::get<StraightMotion>(first.a).to = middle;
    std::get<StraightMotion>(second.a).from = middle;
    ASSERT_EQ(std::max(static_cast<int>(encounter(first)), static_cast<int>(encounter(second))),
              static_cast<int>(expected))
        << corpus_line(c);
    overlaps += expected == Encounter::overlap;
    clear += expected == Encounter::clear;
  }
  EXPECT_GT(overlaps, 100);
  EXPECT_GT(clear, 100);
}

// --- Mistakes ---

TEST(Motions, MistakesAreNamed) {
  const Motion fine = straight({0, 0}, {1, 0});
  const Obstacle wall = Polyline{{{0, -1}, {0, 1}}};
  EXPECT_THROW(encounter(straight({0, 0}, {1, 0}, 1, 0), disc_body(1), wall), std::logic_error);
  EXPECT_THROW(encounter(straight({NAN, 0}, {1, 0}), disc_body(1), wall), std::logic_error);
  EXPECT_THROW(encounter(CurvedMotion{CurveBasis::bezier, 0, 1, {}}, disc_body(1), wall), std::logic_error);
  EXPECT_THROW(encounter(CurvedMotion{CurveBasis::bezier, 0, 1, std::vector<Vec2>(12)}, disc_body(1), wall),
               std::logic_error);
  EXPECT_THROW(encounter(fine, {}, wall), std::logic_error);
  EXPECT_THROW(encounter(fine, {{{{0, 0}, {1, 0}, {2, 0}}, 0.0}}, wall), std::logic_error) << "no interior, no point";
  EXPECT_THROW(encounter(fine, disc_body(1), Polyline{{{0, 0}, {INFINITY, 0}}}), std::logic_error);
  EXPECT_THROW(disc_body(-1), std::logic_error);
  EXPECT_THROW(b_spline_pieces({{0, 0}}, 3, 0, 1), std::logic_error);
  EXPECT_THROW(position_at(fine, 2.0), std::logic_error);
}

}  // namespace
}  // namespace exactvo::test
