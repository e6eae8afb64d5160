// SPDX-License-Identifier: GPL-3.0-or-later
// Reservations alone: robots that only drive as they are told by their reservations get home and never overlap.
#include "liveness/reservations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "counted_allocations.h"
#include "liveness/sweeps.h"
#include "liveness_scenes.h"
#include "reservation_drive.h"

namespace exactvo::formation {
namespace {

using namespace detail;
using namespace test_scenes;

/// Places that are `apart` from each other on this many columns and rows, and other such places, in random order.
Scenario exchange_of_places(int columns, int rows, double apart, test::SeededRandom& random) {
  Scenario s;
  std::vector<Vec2> from, to;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      from.push_back(Vec2{apart * x, apart * y} + random.in_box(0.5 * (apart - 1.02)));
      to.push_back(Vec2{apart * x, apart * y} + random.in_box(0.5 * (apart - 1.02)));
    }
  for (std::size_t k = to.size(); k > 1; --k)
    std::swap(to[k - 1], to[static_cast<std::size_t>(random.integer(0, static_cast<int>(k) - 1))]);
  for (std::size_t k = 0; k < from.size(); ++k) add_robot(s, from[k], to[k]);
  return s;
}

Scenario moved(Scenario s, double scale, double angle, Vec2 by) {
  const auto move = [&](Vec2& p) { p = geometry::rotated(scale * p, angle) + by; };
  for (Robot& r : s.robots) {
    move(r.position);
    for (Vec2& goal : r.goals) move(goal);
    r.radius *= scale;
    r.max_speed *= scale;
  }
  for (SceneObstacle& o : s.obstacles)
    for (Vec2& p : std::get<geometry::Polyline>(o.shape).points) move(p);
  return s;
}

struct Judged {
  std::size_t pairs = 0, waiting = 0, driving = 0;
};

/// Promises (1) to (3) after a `look`.
void judge(const Reservations& reservations, const std::vector<RobotUnderWay>& robots, double time_step,
           Judged& judged) {
  const auto place = [&](std::size_t i) { return reservations.places()[i]; };
  const auto at = [&](std::size_t i) { return robots[i].position; };
  const auto drives = [&](std::size_t i) { return norm(place(i) - at(i)) > kPlaceReached; };
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!reservations.reserved()[i] || !drives(i)) continue;
    const Vec2 way = place(i) - at(i), v = reservations.preferred()[i];
    ASSERT_LE(std::fabs(cross(way, v)), 1e-9 * norm(way)) << "(3) robot " << i;
    ASSERT_GE(dot(way, v), 0.0) << "(3) robot " << i;
    ASSERT_LE(norm(v), robots[i].max_speed * (1.0 + 1e-12));
    bool waits_for_earlier = false;
    for (std::size_t j = 0; j < robots.size(); ++j) {
      if (i == j || norm(at(i) - at(j)) > 8.0) continue;
      const double radii = robots[i].radius + robots[j].radius;
      const bool is_earlier = drives(j) && reservations.ticket(j) < reservations.ticket(i);
      if (!drives(j)) {  // robots that touch may part
        ++judged.pairs;
        ASSERT_GE(squared_distance(at(j), at(i), place(i)), radii * radii - 1e-9) << "(1) " << i << " past " << j;
      } else if (is_earlier) {
        ++judged.pairs;
        ASSERT_GE(squared_distance(place(j), at(i), place(i)), radii * radii - 1e-9) << "(1) " << i << " past " << j;
        ASSERT_GE(squared_distance(at(i), at(j), place(j)), radii * radii - 1e-9) << "(1) " << j << " past " << i;
        waits_for_earlier = waits_for_earlier ||
                            squared_distance({at(i), place(i)}, {at(j), place(j)}) < (radii + 4e-3) * (radii + 4e-3);
      }
    }
    const double full = std::min(robots[i].max_speed, norm(way) / time_step);
    judged.waiting += waits_for_earlier;
    if (!waits_for_earlier) {
      ++judged.driving;
      ASSERT_GE(norm(v), full * (1.0 - 1e-9)) << "(2) nothing earlier is in the way of " << i;
    }
  }
}

struct Scene {
  std::string name;
  Scenario scenario;
};

std::vector<Scene> scenes() {
  test::SeededRandom random(test::seed_of_run(7));
  std::vector<Scene> all;
  all.push_back({"circle", circle(30)});
  all.push_back({"street of 3 diameters", street(14, 3.0)});
  all.push_back({"oblique street", moved(street(20, 4.4), 1.0, 0.3, {1.7, -3.1})});
  all.push_back({"door", door(20, 1.5, random)});
  all.push_back({"rooms", rooms(16, 2.2, random)});
  all.push_back({"half full", exchange_of_places(7, 7, 1.25, random)});
  all.push_back({"box", crowded_box(30, 30.0, random)});
  Scenario mixed = exchange_of_places(6, 6, 1.5, random);
  for (Robot& r : mixed.robots) {
    r.radius = random.uniform(0.25, 0.5);
    r.max_speed = random.uniform(0.75, 2.0);
  }
  all.push_back({"mixed", mixed});
  return all;
}

/// (1) to (4) in every step, and everybody is home once.
TEST(Reservations, Properties1To4_AllRobotsGetHomeAndNoneOverlap) {
  Judged judged;
  for (const auto& [name, s] : scenes()) {
    ReservationDrive drive(s);
    const double limit = 400.0;
    while (drive.report().once_home < s.robots.size() &&
           static_cast<double>(drive.report().steps) * drive.time_step() < limit) {
      drive.look();
      drive.reservations().look(drive.robots());
      judge(drive.reservations(), drive.robots(), drive.time_step(), judged);
      if (testing::Test::HasFatalFailure()) FAIL() << name << ", step " << drive.report().steps;
      drive.drive();
    }
    EXPECT_EQ(drive.report().once_home, s.robots.size()) << name;
    EXPECT_EQ(drive.report().overlaps, 0u) << name;
    EXPECT_EQ(drive.report().at_walls, 0u) << name;
  }
  EXPECT_GT(judged.pairs, 100000u);
  EXPECT_GT(judged.waiting, 1000u);
  EXPECT_GT(judged.driving, 1000u);
}

TEST(Reservations, HomeAtOneTimeInTheOpenAndInDoorsAndBoxes) {
  test::SeededRandom random(test::seed_of_run(11));
  const std::vector<Scene> all = {{"circle", circle(40)},
                                  {"open", exchange_of_places(8, 8, 1.5, random)},
                                  {"door", door(16, 1.5, random)},
                                  {"street", street(14, 4.0)},
                                  {"box", crowded_box(30, 40.0, random)}};
  for (const auto& [name, s] : all) {
    const DriveReport r = ReservationDrive(s).run(400.0);
    EXPECT_EQ(r.home, s.robots.size()) << name;
    EXPECT_EQ(r.overlaps, 0u) << name;
  }
}

/// Also a thousand times as large, and as small, and far away.
TEST(Reservations, AnySizeAndPlace) {
  for (const double scale : {1.0, 0x1p-6, 0x1p10})
    for (const Vec2 by : {Vec2{}, Vec2{1e6, -1e6}}) {
      if (scale < 1.0 && by.x != 0.0) continue;  // no lattice place for each then
      const Scenario s = moved(street(14, 4.0), scale, 0.0, by);
      ReservationDrive drive(s);
      while (drive.report().once_home < s.robots.size() && drive.report().steps < 4000) drive.step();
      EXPECT_EQ(drive.report().once_home, s.robots.size()) << scale << " " << by.x;
      EXPECT_EQ(drive.report().overlaps, 0u) << scale << " " << by.x;
    }
}

TEST(Reservations, LongStepsAreSafeToo) {
  test::SeededRandom random(test::seed_of_run(3));
  const Scenario s = exchange_of_places(8, 8, 1.3, random);
  const DriveReport r = ReservationDrive(s, 1.0).run(600.0);
  EXPECT_EQ(r.once_home, s.robots.size());
  EXPECT_EQ(r.overlaps, 0u);
}

// --- Ways in which earlier rules jammed for ever ---

RobotUnderWay robot_at(Vec2 position, Vec2 goal) {
  RobotUnderWay r;
  r.position = position;
  r.goal = r.ahead[0] = goal;
  r.is_at_goal = norm(goal - position) < 0.1;
  return r;
}

const ObstacleSpace& open_space() {
  static const std::vector<SceneObstacle> none;
  static const ObstacleSpace space(none);
  return space;
}

/// A robot counts as being on its place a little before: by less than what ways keep from places.
TEST(Reservations, ARobotThatHasAllButReachedItsPlaceIsInNoRobotsWay) {
  for (const double off : {0.0, 0.5 * kPlaceReached, 0.999 * kPlaceReached}) {
    Reservations reservations(open_space(), 2, 0.1, 0.5, WhoReserves::all);
    // The first drives past the place of the second as near as it may; that stops a little before its place.
    std::vector<RobotUnderWay> robots = {robot_at({0.0, 0.0}, {1.0, 0.0}), robot_at({0.9, 1.0041}, {0.9, 1.0041})};
    reservations.look(robots);
    ASSERT_EQ(reservations.places()[0], robots[0].goal);
    robots[1].position.y -= off;
    for (; norm(robots[0].goal - robots[0].position) > kPlaceReached; reservations.look(robots)) {
      ASSERT_GT(norm(reservations.preferred()[0]), 0.0) << off;
      robots[0].position = robots[0].position + 0.1 * reservations.preferred()[0];
      ASSERT_GE(norm(robots[0].position - robots[1].position), 1.0) << off;
    }
    ASSERT_EQ(reservations.places()[1], (Vec2{0.9, 1.0041}));
  }
}

/// A robot waits for what was earlier when it reserved, not for what the same robots do next.
TEST(Reservations, AWaitingRobotIsNotOvertakenByTheNextReservationsOfTheOneItWaitsFor) {
  // A queue in a row: the first drives on and on, and each that follows waits for one reservation of it at most.
  Reservations reservations(open_space(), 3, 0.1, 0.5, WhoReserves::all);
  std::vector<RobotUnderWay> robots;
  for (int k = 0; k < 3; ++k) robots.push_back(robot_at({-1.06 * k, 0.0}, {30.0 - 1.5 * k, 0.0}));
  std::vector<std::uint64_t> waited(3, 0);
  for (int step = 0; step < 300; ++step) {
    reservations.look(robots);
    for (std::size_t i = 0; i < 3; ++i) {
      robots[i].position = robots[i].position + 0.1 * reservations.preferred()[i];
      robots[i].is_at_goal = norm(robots[i].goal - robots[i].position) < 0.1;
      waited[i] = norm(reservations.preferred()[i]) < 0.1 && !robots[i].is_at_goal ? waited[i] + 1 : 0;
      EXPECT_LE(waited[i], 10u) << "robot " << i << " in step " << step;
    }
  }
  for (const RobotUnderWay& r : robots) EXPECT_LT(norm(r.goal - r.position), 2e-3);
}

/// Beside a wall too: a robot that is turned leaves its way.
TEST(Reservations, NoRobotIsTurnedOffItsWayBesideAWall) {
  const std::vector<SceneObstacle> walls = {{"wall", geometry::Polyline{{{-20.0, 0.0}, {20.0, 0.0}}}}};
  const ObstacleSpace space(walls);
  Reservations reservations(space, 1, 0.1, 0.5, WhoReserves::all);
  std::vector<RobotUnderWay> robots = {robot_at({0.0, 0.5 + 1e-6}, {10.0, 0.5 + 2e-6})};
  std::size_t driven = 0;
  for (int step = 0; step < 200 && !robots[0].is_at_goal; ++step) {
    reservations.look(robots);
    const Vec2 way = reservations.places()[0] - robots[0].position, v = reservations.preferred()[0];
    ASSERT_LE(std::fabs(cross(way, v)), 1e-12);
    ASSERT_TRUE(space.is_clear(robots[0].position, robots[0].position + 0.1 * v, 0.5));
    driven += norm(v) > 0.0;
    robots[0].position = robots[0].position + 0.1 * v;
    robots[0].is_at_goal = norm(robots[0].goal - robots[0].position) < 0.1;
  }
  EXPECT_GT(driven, 50u);
  EXPECT_TRUE(robots[0].is_at_goal);
}

/// A robot without a reservation that drives through a place keeps others from reserving it; one that stands is pushed.
TEST(Reservations, NoWayLeadsOverARobotThatHasNoReservation) {
  for (const double speed : {0.0, 1.4}) {
    Reservations reservations(open_space(), 2, 0.1, 0.5);
    std::vector<RobotUnderWay> robots = {robot_at({0.0, 0.0}, {9.0, 0.0}), robot_at({1.1, 0.0}, {1.1, 9.0})};
    robots[1].velocity = {0.0, speed};
    std::size_t looked = 0;
    for (int step = 0; step < 60; ++step) {  // none gets on: the first stalls; the second counts as driving
      if (speed > 0.0) robots[1].goal = robots[1].ahead[0] = {1.1, 1000.0 - step};
      reservations.look(robots);
      if (reservations.reserved()[1]) break;
      const Vec2 place = reservations.places()[0];
      if (!reservations.reserved()[0] || place == robots[0].position) continue;
      ++looked;
      EXPECT_GE(squared_distance(robots[1].position, robots[0].position, place), 1.0) << step;
    }
    EXPECT_TRUE(reservations.reserved()[0]);
    if (speed == 0.0) {
      EXPECT_TRUE(reservations.reserved()[1]) << "pushed, or stalled itself";
    } else {
      EXPECT_GT(looked, 0u);
    }
  }
}

/// What it costs to push must not make a robot stay before its goal.
TEST(Reservations, ARobotPushesAnotherOffItsGoal) {
  Reservations reservations(open_space(), 2, 0.1, 0.5, WhoReserves::all);
  // The second is at its own goal, 0.9 m from that of the first, which is 0.15 m from there.
  std::vector<RobotUnderWay> robots = {robot_at({0.0, 0.0}, {0.15, 0.0}), robot_at({1.05, 0.0}, {1.05, 0.0})};
  reservations.look(robots);
  EXPECT_EQ(reservations.places()[0], robots[0].goal);
  EXPECT_GT(norm(reservations.places()[1] - robots[0].goal), 1.0);
  EXPECT_LT(reservations.ticket(1), reservations.ticket(0)) << "it makes way first";
}

/// Places of the lattice are at the goals of others where goals lie close: robots pushed each other off them by turns.
TEST(Reservations, ARobotAtItsGoalStepsAsideNoFartherThanItMust) {
  std::size_t looked = 0;
  for (const double off : {-0.9, -0.5, -0.1, 0.1, 0.5, 0.9}) {
    Reservations reservations(open_space(), 2, 0.1, 0.5, WhoReserves::all);
    std::vector<RobotUnderWay> robots = {robot_at({0.0, 0.0}, {1.5, 0.0}), robot_at({0.75, off}, {0.75, off})};
    reservations.look(robots);
    ASSERT_EQ(reservations.places()[0], robots[0].goal) << "it pushes";
    const Vec2 aside = reservations.places()[1] - robots[1].goal;
    EXPECT_LE(norm(aside), 1.0 + kKeptFromOthers - std::fabs(off) + 1e-6) << off;
    EXPECT_GT(aside.y * off, 0.0) << off;
    ++looked;
  }
  EXPECT_EQ(looked, 6u);
}

/// If places always came in the same order, a few robots could push each other off their goals in a cycle for ever.
TEST(Reservations, RobotsDoNotPushEachOtherOffTheirGoalsInACycle) {
  test::SeededRandom random(test::seed_of_run(7));
  std::size_t home = 0, robots = 0;
  for (int k = 0; k < 60; ++k) {
    const Scenario s = exchange_of_places(5, 5, 1.1, random);
    const DriveReport r = ReservationDrive(s).run(200.0);
    home += r.home;
    robots += s.robots.size();
    EXPECT_EQ(r.overlaps, 0u) << "scene " << k;
  }
  EXPECT_EQ(robots, 60u * 25u);
  EXPECT_EQ(home, robots);
}

/// It steps out of the way rather than ahead of the robot that pushes it, though ahead would be nearer to its goal.
TEST(Reservations, APushedRobotIsNotPushedOnAndOn) {
  for (const double side : {1.0, -1.0}) {
    Reservations reservations(open_space(), 2, 0.1, 0.5, WhoReserves::all);
    std::vector<RobotUnderWay> robots = {robot_at({0.0, 0.0}, {2.3 * side, 0.0}),
                                         robot_at({1.06 * side, 0.0}, {4.3 * side, 0.0})};
    robots[1].yields = true;
    reservations.look(robots);
    ASSERT_GT(side * reservations.places()[0].x, 0.5) << "it pushes";
    EXPECT_GE(std::fabs(reservations.places()[1].y), 1.0);
  }
}

/// Off the rows of places and in touch with the corners, each of the two is in the way of every place of the other but
/// those straight on.
TEST(Reservations, TwoRobotsSideBySideInTheMouthOfAPassageMakeWay) {
  Scenario s;
  add_wall(s, {{3.0, 8.0}, {3.0, 1.0}, {-3.0, 1.0}, {-3.0, 8.0}});
  add_wall(s, {{3.0, -8.0}, {3.0, -1.0}, {-3.0, -1.0}, {-3.0, -8.0}});
  add_robot(s, {2.12, 0.0}, {9.0, 0.0});
  add_robot(s, {1.06, 0.0}, {9.0, 3.0});
  add_robot(s, {0.0, 0.0}, {9.0, -3.0});
  add_robot(s, {3.0396, -0.5015}, {-20.0, -2.0});
  add_robot(s, {3.0461, 0.5}, {-20.0, 2.0});
  const DriveReport r = ReservationDrive(s).run(100.0);
  EXPECT_EQ(r.home, s.robots.size());
  EXPECT_EQ(r.overlaps, 0u);
  EXPECT_EQ(r.at_walls, 0u);
}

// --- Rows of places ---

TEST(PlaceRows, FitThePassage) {
  struct Case {
    double width;
    int rows;
  };
  std::size_t looked = 0;
  for (const Case c :
       {Case{1.02, 1}, Case{1.5, 1}, Case{2.04, 1}, Case{2.1, 2}, Case{3.0, 2}, Case{3.2, 3}, Case{4.4, 4}})
    for (const double angle : {0.0, 0.4, 1.5707963267948966, 2.9})
      for (const Vec2 by : {Vec2{}, Vec2{1e6, 3e5}}) {
        const Scenario s = moved(street(2, c.width), 1.0, angle, by);
        const ObstacleSpace space(s.obstacles);
        const double free = c.width - 1.0;
        const PlaceRows first = rows_about(space, by, 0.5, 1.06);
        for (const double share : {0.001, 0.3, 0.5, 0.77, 0.999}) {
          const Vec2 p = geometry::rotated({3.3 * share, free * (share - 0.5)}, angle) + by;
          const PlaceRows rows = rows_about(space, p, 0.5, 1.06);
          ASSERT_EQ(rows.rows, c.rows) << c.width << " at " << angle;
          const double column = std::round(dot(by - rows.origin, rows.along) / rows.column);
          for (int k = 0; k < rows.rows; ++k) {
            const Vec2 place = rows.place(column, k), from = place - first.origin;
            EXPECT_GE(space.clearance(place, 1.0), 0.5);
            EXPECT_GE(rows.row, 1.06 * (1.0 - 1e-9));
            const double u = dot(from, first.along) / first.column, v = dot(from, first.across) / first.row;
            EXPECT_LE(std::fabs(u - std::round(u)) + std::fabs(v - std::round(v)), by.x > 0.0 ? 2e-3 : 1e-9)
                << "the same from everywhere";
            EXPECT_TRUE(first.has_row(std::round(v)));
          }
          ++looked;
        }
      }
  EXPECT_EQ(looked, 7u * 4u * 2u * 5u);
}

TEST(PlaceRows, InTheOpenAndInWideStreetsTheyAreALatticeForAll) {
  const Scenario wide = street(2, 12.0);
  const ObstacleSpace space(wide.obstacles);
  for (const ObstacleSpace* s : {&space, &open_space()})
    for (const Vec2 p : {Vec2{}, Vec2{3.0, 5.4}, Vec2{-7.0, -5.4}}) {
      const PlaceRows rows = rows_about(*s, p, 0.5, 1.06);
      EXPECT_EQ(rows.rows, 0);
      EXPECT_EQ(rows.place(2.0, -1.0), (Vec2{2.12, -1.06}));
    }
}

// --- (5) ---

std::string bytes_of(const Reservations& reservations) {
  std::ostringstream out;
  crowd::SnapshotWriter to(out);
  reservations.put(to);
  return out.str();
}

TEST(Reservations, Property5_AStateThatWasPutAndGotGoesOnWithTheSameBits) {
  test::SeededRandom random(test::seed_of_run(5));
  const Scenario s = door(24, 1.5, random);
  ReservationDrive drive(s);
  for (int step = 0; step < 150; ++step) drive.step();
  drive.look();
  std::istringstream in(bytes_of(drive.reservations()));
  const ObstacleSpace space(s.obstacles);
  Reservations other(space, s.robots.size(), drive.time_step(), 0.5, WhoReserves::all);
  crowd::SnapshotReader from(in, "reservations");
  other.get(from);
  std::size_t reserved_anew = 0;
  for (int step = 0; step < 150; ++step) {
    drive.look();
    const std::vector<Vec2> before = other.places();
    drive.reservations().look(drive.robots());
    other.look(drive.robots());
    ASSERT_EQ(bytes_of(drive.reservations()), bytes_of(other)) << step;
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      ASSERT_EQ(drive.reservations().preferred()[i], other.preferred()[i]);
      reserved_anew += before[i] != other.places()[i];
    }
    drive.drive();
  }
  EXPECT_GT(reserved_anew, 50u);
}

TEST(Reservations, Property5_AlsoWhereRobotsAreNotOnTheirWays) {
  test::SeededRandom random(test::seed_of_run(6));
  const Scenario s = exchange_of_places(7, 7, 1.3, random);
  ReservationDrive drive(s);
  Reservations known(open_space(), s.robots.size(), drive.time_step(), 0.5, WhoReserves::all);
  std::size_t waiting = 0;
  for (int step = 0; step < 200; ++step) {
    drive.look();
    drive.reservations().look(drive.robots());
    std::vector<RobotUnderWay> robots = drive.robots();
    if (step % 5 == 4)
      for (RobotUnderWay& r : robots) r.position = r.position + random.in_box(0.01);
    std::istringstream in(bytes_of(known));
    Reservations fresh(open_space(), s.robots.size(), drive.time_step(), 0.5, WhoReserves::all);
    crowd::SnapshotReader from(in, "reservations");
    fresh.get(from);
    known.look(robots);
    fresh.look(robots);
    ASSERT_EQ(bytes_of(known), bytes_of(fresh)) << step;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      ASSERT_EQ(known.preferred()[i], fresh.preferred()[i]) << step << ", robot " << i;
      const double left = norm(known.places()[i] - robots[i].position);
      waiting += left > 0.3 && norm(known.preferred()[i]) < 0.5 * robots[i].max_speed;
    }
    drive.drive();
  }
  EXPECT_GT(waiting, 100u);
}

TEST(Reservations, ACutStateIsRefused) {
  Reservations reservations(open_space(), 3, 0.1, 0.5), other(open_space(), 4, 0.1, 0.5);
  const std::string bytes = bytes_of(reservations);
  std::istringstream cut(bytes.substr(0, bytes.size() - 1)), whole(bytes);
  crowd::SnapshotReader from_cut(cut, "reservations"), from_whole(whole, "reservations");
  EXPECT_THROW(reservations.get(from_cut), CrowdError);
  EXPECT_THROW(other.get(from_whole), CrowdError);
}

TEST(Reservations, NothingIsAllocatedOnceTheyRun) {
  test::SeededRandom random(test::seed_of_run(9));
  const Scenario s = exchange_of_places(8, 8, 1.3, random);
  ReservationDrive drive(s);
  for (int step = 0; step < 60; ++step) drive.step();
  std::size_t made = 0, tickets = 0;
  for (int step = 0; step < 60; ++step) {
    drive.look();
    const std::vector<Vec2> before = drive.reservations().places();
    const std::size_t count = test::allocations();
    drive.reservations().look(drive.robots());
    made += test::allocations() - count;
    for (std::size_t i = 0; i < before.size(); ++i) tickets += before[i] != drive.reservations().places()[i];
    drive.drive();
  }
  EXPECT_GT(tickets, 100u);
  EXPECT_EQ(made, 0u);
}

}  // namespace
}  // namespace exactvo::formation
