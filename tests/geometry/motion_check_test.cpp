// SPDX-License-Identifier: GPL-3.0-or-later
// Many moving discs at once, and proofs that moving bodies stay clear.
#include "exactvo/geometry/motion_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/turning_motions.h"
#include "geometry/motion_case.h"

namespace exactvo::test {
namespace {

using geometry::Between;
using geometry::check_motions;
using geometry::Encounter;
using geometry::Motion;
using geometry::MotionCertificate;
using geometry::MotionCheck;
using geometry::MotionEvent;
using geometry::MotionVerdict;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::StraightMotion;
using geometry::TimedPoint;
using geometry::Trajectory;
using geometry::Vec2;

using Key = std::tuple<std::size_t, bool, std::size_t>;

std::vector<Motion> pieces_of(const Trajectory& t, Between between) {
  std::vector<Motion> pieces;
  const std::size_t last = t.points.size() - 1;
  const auto velocity = [&](std::size_t i) {
    if (!t.velocities.empty()) return t.velocities[i];
    const TimedPoint &before = t.points[i == 0 ? 0 : i - 1], &after = t.points[std::min(i + 1, last)];
    return before.time < after.time ? geometry::catmull_rom_velocity(before, after) : Vec2{};
  };
  for (std::size_t i = 0; i < last; ++i) {
    const TimedPoint &from = t.points[i], &to = t.points[i + 1];
    if (between == Between::straight) pieces.push_back(StraightMotion{from, to});
    if (between == Between::hold) pieces.push_back(geometry::held(from, to.time));
    if (between == Between::cubic) pieces.push_back(geometry::hermite_cubic(from, velocity(i), to, velocity(i + 1)));
    if (between == Between::none) pieces.push_back(StraightMotion{from, from});
  }
  if (between == Between::hold || between == Between::none || pieces.empty())
    pieces.push_back(StraightMotion{t.points.back(), t.points.back()});
  return pieces;
}

/// Whether one of two held pieces ends as the other begins, at which moment it has gone on.
bool has_gone_on(const Motion& a, const Motion& b) {
  const auto ends_before = [](const Motion& m, const Motion& n) {
    return end_of(m) == start_of(n) && start_of(m) < end_of(m);
  };
  return ends_before(a, b) || ends_before(b, a);
}

/// Every piece against every other and every obstacle; what may be one event is joined.
std::vector<MotionEvent> all_against_all(const std::vector<Trajectory>& trajectories, const std::vector<Obstacle>& map,
                                         Between between) {
  std::map<Key, std::vector<MotionEvent>> by_pair;
  const auto add = [&](const MotionVerdict& v, std::size_t body, bool with_obstacle, std::size_t other) {
    if (v.encounter == Encounter::clear) return;
    by_pair[{body, with_obstacle, other}].push_back(
        {v.encounter, body, with_obstacle, other, v.first, v.last, v.clearance, v.nearest_time, v.place, {}, {}});
  };
  for (std::size_t i = 0; i < trajectories.size(); ++i)
    for (const Motion& m : pieces_of(trajectories[i], between)) {
      const auto body = trajectories[i].body;
      for (std::size_t k = 0; k < map.size(); ++k) add(examine(m, body, map[k]), i, true, k);
      for (std::size_t j = i + 1; j < trajectories.size(); ++j)
        for (const Motion& n : pieces_of(trajectories[j], between))
          if (between != Between::hold || !has_gone_on(m, n))
            add(examine(m, body, n, trajectories[j].body), i, false, j);
    }
  std::vector<MotionEvent> events;
  for (auto& [key, all] : by_pair) {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first.low < b.first.low; });
    bool first = true;
    for (const MotionEvent& e : all) {
      if (first || e.first.low > events.back().last.high) {
        events.push_back(e);
      } else {
        MotionEvent& open = events.back();
        open.last.high = std::max(open.last.high, e.last.high);
        open.encounter = std::max(open.encounter, e.encounter);
        open.clearance.low = std::min(open.clearance.low, e.clearance.low);
      }
      first = false;
    }
  }
  std::sort(events.begin(), events.end(), [](const MotionEvent& a, const MotionEvent& b) {
    return std::tie(a.last.high, a.body, a.with_obstacle, a.other) <
           std::tie(b.last.high, b.body, b.with_obstacle, b.other);
  });
  return events;
}

/// A capsule, a polygon or two discs, not round the reference point.
geometry::RigidBody random_footprint(SeededRandom& random) {
  switch (random.integer(0, 2)) {
    case 0:
      return {{{{-0.5, 0.25}, {0.75, 0}}, 0.25}};
    case 1:
      return geometry::polygon_body({{{-0.5, -0.25}, {0.75, -0.25}, {0, 0.5}}, {}});
    default:
      return {{{{-0.5, 0}}, 0.5}, {{{0.5, 0.25}}, 0.25}};
  }
}

std::vector<Trajectory> random_trajectories(SeededRandom& random, std::size_t bodies, bool whole_numbers) {
  std::vector<Trajectory> all;
  for (std::size_t b = 0; b < bodies; ++b) {
    Trajectory t;
    t.body = b % 4 == 3 ? random_footprint(random)
                        : geometry::disc_body(random.integer(0, 5) == 0 ? 0.0
                                              : whole_numbers           ? 0.5
                                                                        : random.uniform(0.1, 0.6));
    double time = whole_numbers ? random.integer(0, 2) : random.uniform(0.0, 2.0);
    Vec2 at = random.in_box(6.0);
    const int points = random.integer(1, 12);
    for (int k = 0; k < points; ++k) {
      if (whole_numbers) at = {std::nearbyint(at.x), std::nearbyint(at.y)};
      t.points.push_back({time, at});
      time += whole_numbers ? random.integer(0, 2) : random.uniform(0.0, 1.0);
      at += random.integer(0, 5) == 0 ? Vec2{} : random.in_box(random.integer(0, 9) == 0 ? 40.0 : 2.0);
    }
    all.push_back(t);
  }
  return all;
}

const std::vector<Obstacle> kMap{Polygon{{{-4, -4}, {-1, -4}, {-1, -1}, {-4, -1}}, {}}, Polyline{{{0, 0}, {5, 5}}},
                                 Polyline{{{-5, 3}, {-2, 3}, {-2, 6}}},
                                 Polygon{{{1, -6}, {6, -6}, {6, -1}, {1, -1}}, {{{2, -5}, {2, -2}, {5, -2}, {5, -5}}}}};

TEST(MotionCheck, FindsWhatAllAgainstAllFinds) {
  SeededRandom random(seed_of_run(51));
  std::size_t judged = 0, overlaps = 0, contacts = 0;
  for (int round = 0; round < 60; ++round) {
    const auto trajectories = random_trajectories(random, 8, round % 2 == 0);
    const auto between = static_cast<Between>(round % 4);
    std::vector<MotionEvent> found;
    const MotionCheck check =
        check_motions(trajectories, kMap, {between, 0.0}, [&](const MotionEvent& e) { found.push_back(e); });
    const std::vector<MotionEvent> expected = all_against_all(trajectories, kMap, between);
    ASSERT_EQ(found.size(), expected.size()) << "round " << round;
    ASSERT_TRUE(check.approaches.empty());  // none is asked for
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(std::tie(found[i].body, found[i].with_obstacle, found[i].other, found[i].encounter),
                std::tie(expected[i].body, expected[i].with_obstacle, expected[i].other, expected[i].encounter))
          << "round " << round;
      ASSERT_EQ(found[i].first.low, expected[i].first.low);
      ASSERT_EQ(found[i].last.high, expected[i].last.high);
      ASSERT_NEAR(found[i].clearance.low, expected[i].clearance.low, 1e-11);
    }
    judged += found.size();
    overlaps += check.overlaps;
    contacts += check.contacts;
  }
  EXPECT_EQ(overlaps + contacts, judged);
  EXPECT_GE(overlaps, 500u);
  EXPECT_GE(contacts, 10u);
}

TEST(MotionCheck, AnOverlapOverSeveralPiecesIsOneEvent) {
  Trajectory moving{{}, geometry::disc_body(0.5)};
  for (int k = 0; k <= 20; ++k) moving.points.push_back({0.5 * k, {-5.0 + 0.5 * k, 0.0}});
  const Trajectory standing{{{0, {0, 0}}, {10, {0, 0}}}, geometry::disc_body(0.5)};
  std::vector<MotionEvent> events;
  check_motions({moving, standing}, {}, {}, [&](const MotionEvent& e) { events.push_back(e); });
  ASSERT_EQ(events.size(), 1u);
  EXPECT_NEAR(events[0].first.low, 4.0, 1e-9);
  EXPECT_NEAR(events[0].last.high, 6.0, 1e-9);
  EXPECT_LE(events[0].clearance.low, -1.0);
  EXPECT_NEAR(norm(events[0].at - events[0].other_at), 0.0, 1e-9);
}

TEST(MotionCheck, ListsAllPairsThatComeNear) {
  SeededRandom random(seed_of_run(54));
  std::size_t judged = 0;
  for (int round = 0; round < 40; ++round) {
    const double near = random.uniform(0.05, 1.5);
    const auto all = random_trajectories(random, 12, round % 2 == 0);
    const MotionCheck check = check_motions(all, {}, {Between::straight, near}, [](const MotionEvent&) {});
    std::size_t next = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        geometry::Bounds least{INFINITY, INFINITY};
        for (const Motion& m : pieces_of(all[i], Between::straight))
          for (const Motion& n : pieces_of(all[j], Between::straight)) {
            const auto v = examine(m, all[i].body, n, all[j].body);
            least = {std::min(least.low, v.clearance.low), std::min(least.high, v.clearance.high)};
          }
        if (least.low >= near) continue;
        ASSERT_LT(next, check.approaches.size());
        const geometry::Approach& found = check.approaches[next++];
        ASSERT_EQ(std::tie(found.body, found.other), std::tie(i, j));
        // Enclosures of one number. The check leaves out moments at which both bodies go on to a next piece; this loop
        // does not.
        ASSERT_NEAR(found.clearance.low, least.low, 1e-11);
        ASSERT_NEAR(found.clearance.high, least.high, 1e-11);
      }
    ASSERT_EQ(next, check.approaches.size());
    judged += next;
  }
  EXPECT_GE(judged, 100u);
}

TEST(MotionCheck, LooksAtWhatIsNearOnly) {
  // A crowd on a lattice, 3 m apart, walking together: no pair of pieces meets but in time.
  std::vector<Trajectory> crowd;
  for (int x = 0; x < 30; ++x)
    for (int y = 0; y < 30; ++y) {
      Trajectory t{{}, geometry::disc_body(0.3)};
      for (int k = 0; k <= 10; ++k) t.points.push_back({0.1 * k, {3.0 * x + 0.1 * k, 3.0 * y}});
      crowd.push_back(t);
    }
  const MotionCheck check = check_motions(crowd, {}, {}, [](const MotionEvent&) { FAIL(); });
  EXPECT_EQ(check.pieces, 9000u);
  EXPECT_EQ(check.pairs, 0u);
}

TEST(MotionCheck, MistakesAreNamed) {
  const auto check = [](const Trajectory& t) { check_motions({t}, {}, {}, [](const MotionEvent&) {}); };
  const geometry::RigidBody disc = geometry::disc_body(0.5);
  EXPECT_THROW(check({{}, disc}), std::logic_error);
  EXPECT_THROW(check({{{1, {0, 0}}, {0, {0, 0}}}, disc}), std::logic_error);
  EXPECT_THROW(check({{{0, {0, 0}}}, {{{{0, 0}}, -0.5}}}), std::logic_error);
  EXPECT_THROW(check({{{0, {0, 0}}}, {}}), std::logic_error);
  EXPECT_THROW(check({{{0, {NAN, 0}}}, disc}), std::logic_error);
  EXPECT_THROW(check({{{0, {0, 0}}}, disc, {{1, 0}, {1, 0}}}), std::logic_error);
  EXPECT_THROW(check({{{0, {0, 0}}}, disc, {{NAN, 0}}}), std::logic_error);
}

TEST(MotionCheck, ObstaclesThatComeNearAreListed) {
  SeededRandom random(seed_of_run(55));
  std::size_t judged = 0;
  for (int round = 0; round < 40; ++round) {
    const double near = random.uniform(0.05, 1.5);
    const auto all = random_trajectories(random, 6, round % 2 == 0);
    const MotionCheck check = check_motions(all, kMap, {Between::straight, near}, [](const MotionEvent&) {});
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = 0; k < kMap.size(); ++k) {
        geometry::Bounds least{INFINITY, INFINITY};
        for (const Motion& m : pieces_of(all[i], Between::straight)) {
          const MotionVerdict v = examine(m, all[i].body, kMap[k]);
          least = {std::min(least.low, v.clearance.low), std::min(least.high, v.clearance.high)};
        }
        const auto found = std::find_if(check.approaches.begin(), check.approaches.end(),
                                        [&](const auto& a) { return a.body == i && a.with_obstacle && a.other == k; });
        if (least.low >= near) {
          // Bounds of one edge differ from those of a whole obstacle by rounding.
          ASSERT_TRUE(found == check.approaches.end() || found->clearance.high > near - 1e-9);
          continue;
        }
        ASSERT_NE(found, check.approaches.end());
        ASSERT_LE(found->clearance.low, least.high);
        ASSERT_GE(found->clearance.high, least.low);
        ++judged;
      }
  }
  EXPECT_GE(judged, 100u);
}

TEST(MotionCheck, EdgesWhoseLengthUnderflowsAreLookedAt) {
  // The square of the edge's length is 1.44 * 2^-1074, which no double holds.
  const std::vector<Obstacle> map{Polyline{{{0, 0}, {1.2 * 0x1p-537, 0}}}};
  std::size_t overlaps = 0;
  const Trajectory resting{{{0, {0.9, 0}}, {1, {0.9, 0}}}, geometry::disc_body(1.0)};
  check_motions({resting}, map, {}, [&](const MotionEvent& e) { overlaps += e.encounter == Encounter::overlap; });
  EXPECT_EQ(overlaps, 1u);
}

TEST(MotionCheck, DiscsOfTheMapAreThemselves) {
  // A body that passes at a corner of the square round the disc, in contact with the disc, and a bit deeper.
  const std::vector<Obstacle> map{Polyline{{{20, 20}, {21, 20}}}, Polygon{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {}}};
  geometry::MotionCheckOptions options{Between::straight, 0.5};
  options.discs = {std::nullopt, geometry::Disc{{0, 0}, 1.0}};
  std::vector<Encounter> found;
  for (const double x : {1.5, std::nextafter(1.5, 0.0), 0.0}) {
    std::vector<MotionEvent> events;
    const Trajectory passing{{{0, {x, -3}}, {1, {x, 3}}}, geometry::disc_body(0.5)};
    const MotionCheck check =
        check_motions({passing}, map, options, [&](const MotionEvent& e) { events.push_back(e); });
    ASSERT_EQ(events.size(), 1u);
    EXPECT_TRUE(events[0].with_obstacle);
    EXPECT_EQ(events[0].other, 1u);
    EXPECT_EQ(check.approaches.size(), 1u);
    found.push_back(events[0].encounter);
  }
  EXPECT_EQ(found, (std::vector<Encounter>{Encounter::contact, Encounter::overlap, Encounter::overlap}));
  // (1.1, 1.1) is 0.056 m clear of the disc, and overlaps the corner.
  const Trajectory resting{{{0, {1.1, 1.1}}, {1, {1.1, 1.1}}}, geometry::disc_body(0.5)};
  const MotionCheck clear = check_motions({resting}, map, options, [](const MotionEvent&) { FAIL(); });
  ASSERT_EQ(clear.approaches.size(), 1u);
  EXPECT_NEAR(clear.approaches[0].clearance.low, 1.1 * std::sqrt(2.0) - 1.5, 1e-12);
  options.discs.pop_back();
  EXPECT_THROW(check_motions({resting}, map, options, [](const MotionEvent&) {}), std::logic_error);
}

TEST(MotionCheck, DiscsOfTheMapAreBodiesAtRest) {
  SeededRandom random(seed_of_run(58));
  std::size_t touched = 0, near = 0;
  for (int round = 0; round < 60; ++round) {
    const bool whole_numbers = round % 2 == 0;
    const auto all = random_trajectories(random, 6, whole_numbers);
    geometry::MotionCheckOptions options{Between::straight, round % 3 == 0 ? 0.0 : 0.7};
    std::vector<Obstacle> map;
    for (int k = 0; k < 5; ++k) {
      map.push_back(Polyline{{{0, 0}, {5, 5}}});  // which does not matter
      Vec2 at = random.in_box(6.0);
      if (whole_numbers) at = {std::nearbyint(at.x), std::nearbyint(at.y)};
      options.discs.emplace_back(
          geometry::Disc{at, whole_numbers ? 0.5 * random.integer(0, 4) : random.uniform(0.1, 2.0)});
    }
    std::map<Key, Encounter> worst;
    const MotionCheck check = check_motions(all, map, options, [&](const MotionEvent& e) {
      Encounter& w = worst.try_emplace({e.body, e.with_obstacle, e.other}, e.encounter).first->second;
      w = std::max(w, e.encounter);
    });
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = 0; k < map.size(); ++k) {
        const geometry::Disc& disc = *options.discs[k];
        Encounter expected = Encounter::clear;
        double least = INFINITY;
        for (const Motion& m : pieces_of(all[i], Between::straight)) {
          const MotionVerdict v = examine(m, all[i].body, geometry::held({start_of(m), disc.center}, end_of(m)),
                                          geometry::disc_body(disc.radius));
          expected = std::max(expected, v.encounter);
          least = std::min(least, v.clearance.low);
        }
        const auto found = worst.find({i, true, k});
        ASSERT_EQ(found == worst.end() ? Encounter::clear : found->second, expected);
        const bool is_listed = std::any_of(check.approaches.begin(), check.approaches.end(), [&](const auto& a) {
          return a.body == i && a.with_obstacle && a.other == k;
        });
        ASSERT_EQ(is_listed, options.near > 0.0 && least < options.near);
        touched += expected == Encounter::clear ? 0 : 1;
        near += is_listed ? 1 : 0;
      }
  }
  EXPECT_GE(touched, 100u);
  EXPECT_GE(near, 100u);
}

TEST(MotionCheck, HeldRobotsThatFollowEachOtherByOneRowDoNotMeet) {
  // Robot b enters a cell as a leaves it, and a third robot waits in the last one.
  const geometry::RigidBody disc = geometry::disc_body(0.3);
  const auto row = [](std::initializer_list<double> x) {
    std::vector<TimedPoint> points;
    for (const double each : x) points.push_back({static_cast<double>(points.size()), {each, 0}});
    return points;
  };
  const Trajectory a{row({1, 2, 3, 4}), disc}, b{row({0, 1, 2, 3}), disc}, c{{{3, {4, 0}}, {5, {4, 0}}}, disc};
  const auto count = [&](const std::vector<Trajectory>& all) {
    std::vector<MotionEvent> events;
    check_motions(all, {}, {Between::hold}, [&](const MotionEvent& e) { events.push_back(e); });
    return events;
  };
  EXPECT_TRUE(count({a, b}).empty());
  // At its last row a robot is there, though for no time.
  const auto events = count({a, b, c});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(std::tie(events[0].body, events[0].other, events[0].first.low, events[0].last.high),
            std::make_tuple(std::size_t{0}, std::size_t{2}, 3.0, 3.0));
}

TEST(MotionCheck, OnlyTimedPointsCountWhereNothingIsBetween) {
  const geometry::RigidBody disc = geometry::disc_body(0.3);
  const Trajectory a{{{0, {0, 0}}, {1, {10, 0}}, {2, {10, 5}}}, disc},
      b{{{0, {5, -5}}, {1, {5, 5}}, {2, {10, 5}}}, disc};
  std::vector<MotionEvent> events;
  check_motions({a, b}, {}, {Between::none}, [&](const MotionEvent& e) { events.push_back(e); });
  ASSERT_EQ(events.size(), 1u);  // at 0.5 s they meet if they go straight
  EXPECT_EQ(events[0].first.low, 2.0);
}

TEST(MotionCheck, CubicsGoOutsideOfTheirChords) {
  // Along a bow whose highest point is 0.75 m above its chord; a wall is 0.7 m above it.
  const std::vector<Obstacle> map{Polyline{{{-1, 0.7}, {5, 0.7}}}};
  Trajectory t{{{0, {0, 0}}, {1, {4, 0}}}, geometry::disc_body(0.0), {{4, 3}, {4, -3}}};
  std::vector<MotionEvent> events;
  const auto check = [&](Between between) {
    events.clear();
    check_motions({t}, map, {between}, [&](const MotionEvent& e) { events.push_back(e); });
    return events.size();
  };
  EXPECT_EQ(check(Between::straight), 0u);
  ASSERT_EQ(check(Between::cubic), 1u);
  // y = 3 s (1 - s), which is 0.7 at s = (1 -+ sqrt(1 - 2.8 / 3)) / 2.
  EXPECT_NEAR(events[0].first.low, 0.5 - 0.5 * std::sqrt(1.0 - 2.8 / 3.0), 1e-9);
  EXPECT_NEAR(events[0].last.high, 0.5 + 0.5 * std::sqrt(1.0 - 2.8 / 3.0), 1e-9);
  t.velocities.clear();  // with two points a Catmull-Rom spline is the chord
  EXPECT_EQ(check(Between::cubic), 0u);
}

TEST(MotionStream, EqualsCheckMotionsAndForgetsEndedPieces) {
  SeededRandom random(seed_of_run(56));
  std::size_t judged = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Trajectory> all;
    for (int b = 0; b < 10; ++b) {
      Trajectory t{{}, geometry::disc_body(0.3)};
      Vec2 at = random.in_box(3.0);
      for (int k = 0; k <= 400; ++k) {
        t.points.push_back({0.1 * k, at});
        at += random.in_box(0.3) + Vec2{0.5, 0.0};  // away from where they began
      }
      all.push_back(t);
    }
    std::vector<MotionEvent> together, streamed;
    const auto whole = check_motions(all, kMap, {}, [&](const MotionEvent& e) { together.push_back(e); });
    geometry::MotionStream stream(kMap, {}, [&](const MotionEvent& e) { streamed.push_back(e); });
    for (const Trajectory& t : all) stream.add_body(t.body);
    for (std::size_t k = 0; k < 400; ++k)
      for (std::size_t b = 0; b < all.size(); ++b)
        stream.add(b, StraightMotion{all[b].points[k], all[b].points[k + 1]});
    const MotionCheck check = stream.finish();
    EXPECT_EQ(check.pieces, 4000u);
    EXPECT_LE(check.most_held, 3u * all.size());
    EXPECT_EQ(check.pairs, whole.pairs);
    ASSERT_EQ(streamed.size(), together.size());
    for (std::size_t i = 0; i < streamed.size(); ++i) {
      ASSERT_EQ(streamed[i].first.low, together[i].first.low);
      ASSERT_EQ(streamed[i].last.high, together[i].last.high);
    }
    judged += streamed.size();
  }
  EXPECT_GE(judged, 100u);
}

TEST(MotionStream, ForgetsPiecesWithoutSuccessor) {
  geometry::MotionStream stream(kMap, {}, [](const MotionEvent&) {});
  for (int b = 0; b < 10; ++b) stream.add_body(geometry::disc_body(0.1));
  for (int k = 0; k < 3000; ++k)
    for (std::size_t b = 0; b < 10; ++b)
      stream.add(b, geometry::held({0.125 * k, {20.0 + static_cast<double>(b), 0.01 * k}}, 0.125 * k + 0.125));
  const MotionCheck check = stream.finish();
  EXPECT_EQ(check.pieces, 30000u);
  EXPECT_LE(check.most_held, 1100u);
}

TEST(MotionStream, PiecesOutOfOrderAreAMistake) {
  geometry::MotionStream stream(kMap, {}, [](const MotionEvent&) {});
  const std::size_t body = stream.add_body(geometry::disc_body(0.1));
  EXPECT_THROW(stream.add(body + 1, StraightMotion{}), std::logic_error);
  stream.add(body, StraightMotion{{1, {20, 0}}, {2, {21, 0}}});
  EXPECT_THROW(stream.add(body, StraightMotion{{1.5, {20, 0}}, {3, {21, 0}}}), std::logic_error);
  const std::size_t other = stream.add_body(geometry::disc_body(0.1));
  EXPECT_THROW(stream.add(other, StraightMotion{{0, {20, 0}}, {3, {21, 0}}}), std::logic_error);
}

TEST(MotionCheck, ReportsEveryPairThatMayMeet) {
  SeededRandom random(seed_of_run(57));
  std::size_t clear = 0, proven = 0;
  for (int round = 0; round < 30; ++round) {
    const auto all = random_trajectories(random, 8, round % 2 == 0);
    std::vector<geometry::MetPair> met;
    geometry::MotionCheckOptions options;
    options.between = static_cast<Between>(round % 4);
    options.met = [&](const geometry::MetPair& pair) { met.push_back(pair); };
    const MotionCheck check = check_motions(all, kMap, options, [](const MotionEvent&) {});
    EXPECT_GE(met.size(), check.pairs);
    for (const geometry::MetPair& pair : met) {
      const auto& body = all[pair.body].body;
      const auto proof = pair.with_obstacle
                             ? geometry::certify(pair.motion, body, kMap[pair.other])
                             : geometry::certify(pair.motion, body, pair.other_motion, all[pair.other].body);
      const Encounter encounter = pair.with_obstacle
                                      ? geometry::encounter(pair.motion, body, kMap[pair.other])
                                      : geometry::encounter(pair.motion, body, pair.other_motion, all[pair.other].body);
      clear += encounter == Encounter::clear ? 1 : 0;
      proven += proof ? 1 : 0;
    }
    // Whatever is not among them is clear.
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const Motion& m : pieces_of(all[i], options.between))
        for (std::size_t k = 0; k < kMap.size(); ++k) {
          const bool named = std::any_of(met.begin(), met.end(), [&](const geometry::MetPair& p) {
            return p.with_obstacle && p.body == i && p.other == k && start_of(p.motion) == start_of(m);
          });
          if (!named) {
            ASSERT_EQ(geometry::encounter(m, all[i].body, kMap[k]), Encounter::clear);
          }
        }
  }
  EXPECT_GE(clear, 200u);
  EXPECT_GE(proven * 100, clear * 80);
}

// --- Scenes that public reports describe, rebuilt small ---

std::vector<MotionEvent> events_of(const std::vector<Trajectory>& all, const std::vector<Obstacle>& map = {},
                                   Between between = Between::straight) {
  std::vector<MotionEvent> events;
  check_motions(all, map, {between}, [&](const MotionEvent& e) { events.push_back(e); });
  return events;
}

const geometry::RigidBody kBox{{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 0.0}};

TEST(MotionScenes, BoxesThatChangePlacesCollideOnTheWay) {
  // A checker advances by a bound of both motions; where it adds signed bounds, opposite motions cancel.
  const Trajectory a{{{0, {-5, 0}}, {1, {5, 0}}}, kBox}, b{{{0, {5, 0}}, {1, {-5, 0}}}, kBox};
  const auto events = events_of({a, b});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].encounter, Encounter::overlap);
  EXPECT_NEAR(events[0].first.low, 0.4, 1e-9);  // 8 m apart, 20 m/s
  EXPECT_NEAR(events[0].last.high, 0.6, 1e-9);
}

TEST(MotionScenes, ABoxThatPassesABoxAtRestIsFoundAndContactIsReported) {
  // Both poses that a planner gives are clear. Conservative advancement misses the box between them with some bounds.
  const Trajectory rest{{{0, {0, 0}}, {1, {0, 0}}}, kBox};
  for (const double y : {1.5, 2.0, 2.0000000000000004}) {
    const Trajectory passing{{{0, {-10, y}}, {1, {10, y}}}, kBox};
    const auto events = events_of({rest, passing});
    const Encounter expected = y < 2.0 ? Encounter::overlap : y == 2.0 ? Encounter::contact : Encounter::clear;
    EXPECT_EQ(events.empty() ? Encounter::clear : events[0].encounter, expected) << y;
  }
}

TEST(MotionScenes, ACollisionInTheLastQuarterOfATrajectoryIsFound) {
  // A check of the first three quarters, which counts on the next plan, sees nothing.
  const Trajectory a{{{0, {0, 0}}, {4, {8, 0}}}, geometry::disc_body(0.25)};
  const Trajectory b{{{0, {7, 7}}, {4, {7, -1}}}, a.body};  // both are at (7, 0) at 3.5 s
  const auto events = events_of({a, b});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_GT(events[0].first.low, 3.0);
  const Trajectory first_part{{{0, {0, 0}}, {3, {6, 0}}}, a.body}, other_part{{{0, {7, 7}}, {3, {7, 1}}}, a.body};
  EXPECT_TRUE(events_of({first_part, other_part}).empty());
}

TEST(MotionScenes, PositionsOfNowSayNothingOfLater) {
  // A check that compares present positions at every future sample finds 10 m of room, always.
  const Trajectory a{{{0, {0, 0}}, {5, {10, 0}}}, geometry::disc_body(0.3)};
  const Trajectory b{{{0, {10, 0.2}}, {5, {0, 0.2}}}, geometry::disc_body(0.3)};
  const auto events = events_of({a, b});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_NEAR(events[0].nearest_time, 2.5, 1e-9);
}

TEST(MotionScenes, TheFirstMomentIsABoundThatLeavesTimeToBrake) {
  // Two drones head-on on cubics; an emergency stop needs 1 s. What is left before the overlap is certified, so that
  // it can be compared with the time to stop before another plan is tried.
  const Trajectory a{{{0, {0, 0}}, {2, {4, 0}}}, geometry::disc_body(0.5), {{2, 0}, {2, 0}}};
  const Trajectory b{{{0, {5, 0}}, {2, {1, 0}}}, geometry::disc_body(0.5), {{-2, 0}, {-2, 0}}};
  const auto events = events_of({a, b}, {}, Between::cubic);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_LE(events[0].first.low, 1.0);
  EXPECT_GE(events[0].first.high, 1.0);
  EXPECT_LT(events[0].first.high - events[0].first.low, 1e-9);
}

TEST(MotionScenes, ARobotMayDriveUpToAWall) {
  // A dock: the robot stops where its front touches the wall, and one ulp farther it would be in it.
  const std::vector<Obstacle> wall{Polyline{{{5, -3}, {5, 3}}}};
  const auto touching = events_of({{{{0, {0, 0}}, {4, {4, 0}}, {6, {4, 0}}}, kBox}}, wall);
  ASSERT_EQ(touching.size(), 1u);
  EXPECT_EQ(touching[0].encounter, Encounter::contact);
  const auto beyond = events_of({{{{0, {0, 0}}, {4, {std::nextafter(4.0, 5.0), 0}}}, kBox}}, wall);
  ASSERT_EQ(beyond.size(), 1u);
  EXPECT_EQ(beyond[0].encounter, Encounter::overlap);
}

TEST(MotionScenes, AnObstacleInsideAFootprintIsFound) {
  // A post of 2 cm that no corner and no side of the footprint touches at a pose that is looked at.
  const std::vector<Obstacle> post{Polygon{{{0.01, 0.01}, {0.03, 0.01}, {0.03, 0.03}, {0.01, 0.03}}, {}}};
  const auto at_rest = events_of({{{{0, {0, 0}}}, kBox}}, post);
  ASSERT_EQ(at_rest.size(), 1u);
  EXPECT_EQ(at_rest[0].encounter, Encounter::overlap);
  const auto passing = events_of({{{{0, {-4, 0}}, {1, {4, 0}}}, kBox}}, post);
  ASSERT_EQ(passing.size(), 1u);
  EXPECT_EQ(passing[0].encounter, Encounter::overlap);
}

TEST(MotionScenes, ACornerThatCutsAnObstacleBetweenTwoPosesIsFound) {
  // A long footprint at an angle is carried past a post; both poses are clear of it.
  const geometry::RigidBody turned =
      geometry::turned_body({{{{-2, -0.25}, {2, -0.25}, {2, 0.25}, {-2, 0.25}}, 0.0}}, 0.5);
  const std::vector<Obstacle> post{Polygon{{{0, 1.05}, {0.1, 1.05}, {0.1, 1.15}, {0, 1.15}}, {}}};
  const Vec2 from{-4, 0}, to{2, 0};
  for (const Vec2 pose : {from, to}) EXPECT_TRUE(events_of({{{{0, pose}}, turned}}, post).empty());
  EXPECT_EQ(events_of({{{{0, from}, {1, to}}, turned}}, post).size(), 1u);
}

TEST(MotionStream, PolynomialPiecesOfEveryBasisAreDecided) {
  SeededRandom random(seed_of_run(59));
  std::size_t judged = 0, by_chord = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<std::vector<Motion>> all(6);
    const auto body = [&](std::size_t b) { return b % 3 == 2 ? random_footprint(random) : geometry::disc_body(0.3); };
    std::vector<geometry::RigidBody> bodies;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t b = 0; b < all.size(); ++b) {
      bodies.push_back(body(b));
      double time = random.uniform(0.0, 1.0);
      for (int k = 0; k < 5; ++k) {
        geometry::CurvedMotion m{static_cast<geometry::CurveBasis>(random.integer(0, 2)), time, time + 1.0, {}};
        const int degree = random.integer(0, 5);
        for (int i = 0; i <= degree; ++i) m.points.push_back(random.in_box(i == 0 ? 6.0 : 3.0));
        all[b].emplace_back(m);
        order.emplace_back(time, b);
        time += 1.0;
      }
    }
    std::stable_sort(order.begin(), order.end());
    std::map<Key, Encounter> worst;
    geometry::MotionStream stream(kMap, {}, [&](const MotionEvent& e) {
      Encounter& w = worst.try_emplace({e.body, e.with_obstacle, e.other}, e.encounter).first->second;
      w = std::max(w, e.encounter);
    });
    for (const auto& each : bodies) stream.add_body(each);
    std::vector<std::size_t> next(all.size(), 0);
    for (const auto& [time, b] : order) stream.add(b, all[b][next[b]++]);
    const MotionCheck check = stream.finish();
    by_chord += check.pairs + check.edge_pairs - std::min(check.pairs + check.edge_pairs, check.examined);
    const auto expect = [&](const Key& key, Encounter expected) {
      const auto found = worst.find(key);
      ASSERT_EQ(found == worst.end() ? Encounter::clear : found->second, expected) << "round " << round;
      judged += expected == Encounter::clear ? 0 : 1;
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = 0; k < kMap.size(); ++k) {
        Encounter expected = Encounter::clear;
        for (const Motion& m : all[i]) expected = std::max(expected, geometry::encounter(m, bodies[i], kMap[k]));
        expect({i, true, k}, expected);
      }
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        Encounter expected = Encounter::clear;
        for (const Motion& m : all[i])
          for (const Motion& n : all[j]) expected = std::max(expected, geometry::encounter(m, bodies[i], n, bodies[j]));
        expect({i, false, j}, expected);
      }
    }
  }
  EXPECT_GE(judged, 300u);
  EXPECT_GE(by_chord, 100u);
}

// --- Certificates ---

std::optional<MotionCertificate> certify(const MotionCase& c) {
  return c.b ? geometry::certify(c.a, c.body_a, *c.b, c.body_b) : geometry::certify(c.a, c.body_a, *c.obstacle);
}
bool proves_clear(const MotionCertificate& p, const MotionCase& c) {
  return c.b ? geometry::proves_clear(p, c.a, c.body_a, *c.b, c.body_b)
             : geometry::proves_clear(p, c.a, c.body_a, *c.obstacle);
}

TEST(MotionCertificate, ClearMotionsAreProven) {
  SeededRandom random(seed_of_run(52));
  std::size_t clear = 0, proven = 0;
  for (int i = 0; i < 3000; ++i) {
    const MotionCase c = random_motion_case(random, kMotionKinds[i % 5]);
    const auto certificate = certify(c);
    if (encounter(c) != Encounter::clear) {
      ASSERT_FALSE(certificate) << corpus_line(c);
      continue;
    }
    ++clear;
    if (!certificate) continue;
    ++proven;
    ASSERT_TRUE(proves_clear(*certificate, c)) << corpus_line(c);
  }
  EXPECT_GE(clear, 1200u);
  // What is clear by an ulp has none.
  EXPECT_GE(proven * 100, clear * 80);
}

TEST(MotionCertificate, ProvesNothingThatIsNotTrue) {
  SeededRandom random(seed_of_run(53));
  std::size_t changed = 0, refused = 0, untrue = 0;
  for (int i = 0; i < 3000; ++i) {
    MotionCase c = random_motion_case(random, kMotionKinds[i % 5]);
    const auto certificate = certify(c);
    if (!certificate || certificate->separations.empty()) continue;
    MotionCertificate other = *certificate;
    auto& s =
        other.separations[static_cast<std::size_t>(random.integer(0, static_cast<int>(other.separations.size()) - 1))];
    switch (i % 6) {
      case 0:
        s.direction = -s.direction;
        break;
      case 1:
        s.margin = std::nextafter(1.001 * s.margin + 1e-300, 1e300) + norm(s.direction);
        break;
      case 2:
        s.to = s.from + 0.5 * (s.to - s.from);
        break;
      case 3:
        other.separations.pop_back();
        break;
      case 4:
        s.other += 1;
        break;
      case 5: {
        // The proof of a smaller body: false where the larger one is not clear.
        for (auto& part : c.body_a) part.radius = 4.0 * part.radius + 1.0;
        break;
      }
    }
    ++changed;
    const bool accepted = proves_clear(other, c);
    refused += accepted ? 0 : 1;
    if (i % 6 == 5) {
      if (encounter(c) != Encounter::clear) {
        ++untrue;
        ASSERT_FALSE(accepted) << corpus_line(c);
      }
    } else if (i % 6 != 1 && i % 6 != 2) {
      ASSERT_FALSE(accepted) << corpus_line(c);
    }
  }
  EXPECT_GE(changed, 800u);
  EXPECT_GE(refused * 100, changed * 70);
  EXPECT_GE(untrue, 50u);
}

TEST(MotionCertificate, TouchingIsNotProven) {
  const geometry::Motion along = StraightMotion{{0, {-2, 1}}, {1, {2, 1}}};
  const Obstacle wall = Polyline{{{-3, 0}, {3, 0}}};
  EXPECT_FALSE(geometry::certify(along, geometry::disc_body(1.0), wall));
  MotionCertificate touching{{{0, 0, 0.0, 1.0, {0, 1}, 0.0}}};
  EXPECT_FALSE(geometry::proves_clear(touching, along, geometry::disc_body(1.0), wall));
  EXPECT_TRUE(geometry::proves_clear(touching, along, geometry::disc_body(0.5), wall));
}

TEST(MotionCertificate, InsideAPolygonIsNotProvenByItsEdges) {
  const geometry::Motion rest = geometry::held({0, {0, 0}}, 1);
  const Obstacle room = Polygon{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {}};
  MotionCertificate edges{
      {{0, 0, 0, 1, {0, 1}, 1}, {0, 1, 0, 1, {-1, 0}, 1}, {0, 2, 0, 1, {0, -1}, 1}, {0, 3, 0, 1, {1, 0}, 1}}};
  EXPECT_FALSE(geometry::proves_clear(edges, rest, geometry::disc_body(0.5), room));
  const Obstacle walls = Polyline{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}, {-5, -5}}};
  EXPECT_TRUE(geometry::proves_clear(edges, rest, geometry::disc_body(0.5), walls));
}

// A radius below 0 proved a body clear of what it met: the reach of the other one shrank by it.
TEST(MotionCertificate, BodiesAndTimesThatCannotBeAreRefused) {
  const geometry::Motion rest = geometry::held({0, {0, 1}}, 1), other = geometry::held({0, {0, 0}}, 1);
  const MotionCertificate touching{{{0, 0, 0.0, 1.0, {0, 1}, 0.0}}};
  EXPECT_FALSE(geometry::proves_clear(touching, rest, geometry::disc_body(1.0), other, geometry::disc_body(0.0)));
  const geometry::RigidBody negative{{{{0, 0}}, -0.5}}, nothing{{{}, 1.0}};
  const Obstacle wall = Polyline{{{-3, 0}, {3, 0}}};
  EXPECT_THROW(geometry::proves_clear(touching, rest, geometry::disc_body(1.0), other, negative), std::logic_error);
  EXPECT_THROW(geometry::proves_clear(touching, rest, negative, other, geometry::disc_body(1.0)), std::logic_error);
  EXPECT_THROW(geometry::proves_clear(touching, rest, negative, wall), std::logic_error);
  EXPECT_THROW(geometry::proves_clear(touching, rest, nothing, wall), std::logic_error);
  const geometry::Motion back = StraightMotion{{1, {0, 1}}, {0, {0, 1}}};
  EXPECT_THROW(geometry::proves_clear({}, back, geometry::disc_body(1.0), wall), std::logic_error);
  EXPECT_THROW(geometry::proves_clear({}, rest, geometry::disc_body(1.0), back, negative), std::logic_error);
}

// There is no rational for it: the program ended.
TEST(MotionCertificate, NumbersThatAreNotFiniteAreRefused) {
  const MotionCertificate touching{{{0, 0, 0.0, 1.0, {0, 1}, 0.0}}};
  const geometry::RigidBody disc = geometry::disc_body(0.5);
  const geometry::Motion rest = geometry::held({0, {0, 1}}, 1);
  const Obstacle wall = Polyline{{{-3, 0}, {3, 0}}};
  for (const double bad : {std::nan(""), geometry::kInfinity}) {
    const geometry::Motion straight = StraightMotion{{0, {bad, 1}}, {1, {0, 1}}};
    const geometry::Motion curved = geometry::CurvedMotion{geometry::CurveBasis::bezier, 0, 1, {{0, bad}, {0, 1}}};
    const geometry::Motion endless = StraightMotion{{0, {0, 1}}, {bad, {0, 1}}};
    for (const geometry::Motion& m : {straight, curved, endless}) {
      EXPECT_THROW(geometry::proves_clear(touching, m, disc, wall), std::logic_error);
      EXPECT_THROW(geometry::proves_clear(touching, rest, disc, m, disc), std::logic_error);
    }
    EXPECT_THROW(geometry::proves_clear(touching, rest, {{{{0, 0}}, bad}}, wall), std::logic_error);
    EXPECT_THROW(geometry::proves_clear(touching, rest, {{{{bad, 0}}, 0.5}}, wall), std::logic_error);
    EXPECT_THROW(geometry::proves_clear(touching, rest, disc, Polyline{{{-3, 0}, {bad, 0}}}), std::logic_error);
    const geometry::TurningMotion turning{0.0, 1.0, {0, 1}, {{}, 1.0}};
    EXPECT_FALSE(geometry::proves_clear(touching, turning, disc, Polyline{{{-3, 0}, {bad, 0}}}));
  }
  const geometry::Motion nowhere = geometry::CurvedMotion{geometry::CurveBasis::bezier, 0, 1, {}};
  EXPECT_THROW(geometry::proves_clear(touching, nowhere, disc, wall), std::logic_error);
}

}  // namespace
}  // namespace exactvo::test
