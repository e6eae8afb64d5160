// SPDX-License-Identifier: GPL-3.0-or-later
// The sequence margin, restore, contact, push-out: which step answers when, and that each proof is one.
#include "exactvo/vo/constraint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/geometry/predicates.h"
#include "support/seeded_random.h"

namespace exactvo::vo {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::Segment;
using test::seed_of_run;
using test::SeededRandom;

constexpr Vec2 kAt{0, 0};

/// A wall at x = `distance` in front of a robot of radius 0.5.
GrownShape wall(double distance) {
  return {Segment{{distance, -3}, {distance, 3}}, kAt, 0.5};
}

ProvenHalfPlane against(GrownShape s, Vec2 velocity, const ClearancePolicy& policy) {
  return half_plane_against(s, clearance_of(s), velocity, policy);
}

ClearancePolicy with_room(double room) {
  ClearancePolicy policy;
  policy.room = room;
  policy.push_out_time = 0.2;
  policy.push_out_speed = 0.9;
  return policy;
}

TEST(BodyTable, WhatIsSeenOutlastsOtherBodies) {
  BodyTable bodies;
  const BodyTable::Number first = bodies.add({BodyKind::robot, Disc{{3, 0}, 0.5}, {}, {0}});
  GrownShape& seen = bodies.seen(first, {1, 2}, 0.25);
  const Body& body = bodies[first];
  for (std::size_t k = 1; k < 500; ++k) bodies.add({BodyKind::robot, Disc{{0, 0}, 1.0}, {}, {k}});
  EXPECT_EQ(&body, &bodies[first]);
  EXPECT_EQ(&seen, &bodies.seen(first, {1, 2}, 0.25));
}

TEST(Sequence, KeepsItsRoomWhileThereIsRoom) {
  const ProvenHalfPlane h = against(wall(2.5), {1, 0}, with_room(0.1));
  EXPECT_EQ(h.proof, Proof::alone);
  EXPECT_NEAR(h.half_plane.offset, -(2.5 - 0.5 - 0.1) / 2.0, 1e-12);
}

TEST(Sequence, StopsInBareContactWhereTheRoomIsUsedUp) {
  const ProvenHalfPlane h = against(wall(0.55), {1, 0}, with_room(0.1));
  EXPECT_EQ(h.proof, Proof::alone);
  EXPECT_EQ(h.half_plane.offset, 0.0);
  EXPECT_EQ(h.half_plane.normal, (Vec2{-1, 0}));
}

TEST(Sequence, RestoresTheRoomWhereAsked) {
  ClearancePolicy policy = with_room(0.1);
  policy.restore_within = 0.5;
  const ProvenHalfPlane h = against({Disc{{1.05, 0}, 0.5}, kAt, 0.5}, {1, 0}, policy);
  EXPECT_EQ(h.proof, Proof::alone);
  EXPECT_NEAR(h.half_plane.offset, 0.05 / 0.5, 1e-12);
}

TEST(Sequence, LeadsOutOfOverlapAndPromisesNothing) {
  const ProvenHalfPlane shallow = against(wall(0.4), {1, 0}, with_room(0.1));
  EXPECT_EQ(shallow.proof, Proof::none);
  EXPECT_NEAR(shallow.half_plane.offset, 0.1 / 0.2, 1e-12);
  const ProvenHalfPlane deep = against(wall(0.1), {1, 0}, with_room(0.1));
  EXPECT_EQ(deep.half_plane.offset, 0.9) << "no faster than the policy says";
}

TEST(Sequence, LeavesTheBodyAsTheBareRobotSeesIt) {
  for (const double distance : {0.1, 0.55, 2.5}) {
    GrownShape s = wall(distance);
    half_plane_against(s, clearance_of(s), {1, 0}, with_room(0.1));
    EXPECT_EQ(s.radius, 0.5);
  }
}

TEST(Sequence, EveryProofIsOne) {
  SeededRandom random(seed_of_run(21));
  std::size_t proven = 0, refused = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec2 c = random.in_box(k % 3 == 0 ? 0.8 : 3.0);
    const geometry::ConvexShape shapes[] = {Disc{c, 0.3}, Segment{c, c + random.in_box(2)},
                                            Ellipse{c, 0.7, random.uniform(-0.3, 0.3), 0.4},
                                            ConvexPolygon{{c, c + Vec2{1, 0}, c + Vec2{0.2, 0.7}}}};
    ClearancePolicy policy = with_room(random.uniform(0.0, 0.2));
    policy.time_horizon = random.uniform(0.1, 4.0);
    if (k % 2 == 0) policy.restore_within = 0.3;
    for (const geometry::ConvexShape& shape : shapes) {
      const GrownShape s{shape, kAt, 0.4};
      const ProvenHalfPlane h = against(s, random.in_box(3.0), policy);
      if (h.proof == Proof::none) {
        ++refused;
        continue;
      }
      ++proven;
      ASSERT_TRUE(half_plane_is_safe(s, policy.time_horizon, h.half_plane)) << geometry::to_string(shape);
      const HalfPlane shifted = shifted_by(h.half_plane, {0.5, -0.25});
      ASSERT_GE(shifted.offset, h.half_plane.offset + dot(h.half_plane.normal, {0.5, -0.25}));
    }
  }
  EXPECT_GT(proven, 8000u);
  EXPECT_GT(refused, 100u);
}

TEST(Bodies, AreSeenWithoutACopyAndMoveWhereTheyAreMoved) {
  BodyTable table;
  const auto post = table.add({BodyKind::enclosure, Disc{{3, 0}, 1}, {}, {0}});
  const auto cart = table.add({BodyKind::moving_obstacle, ConvexPolygon{{{0, 0}, {1, 0}, {0, 1}}}, {}, {0}});
  const GrownShape* first = &table.seen(post, {0, 0}, 0.5);
  EXPECT_NEAR(clearance_of(*first).distance, 1.5, 1e-12);
  EXPECT_EQ(first, &table.seen(post, {1, 0}, 0.5));
  EXPECT_NEAR(clearance_of(*first).distance, 0.5, 1e-12);
  table.move(cart, ConvexPolygon{{{5, 0}, {6, 0}, {5, 1}}}, {2, 0});
  EXPECT_EQ(table[cart].velocity, (Vec2{2, 0}));
  EXPECT_EQ(table.box(cart).low, (Vec2{5, 0}));
  EXPECT_NEAR(clearance_of(table.seen(cart, {0, 0}, 0.5)).distance, 4.5, 1e-12);
  EXPECT_THROW(table.add({BodyKind::enclosure, ConvexPolygon{}, {}, {}}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::vo
