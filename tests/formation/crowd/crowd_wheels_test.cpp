// SPDX-License-Identifier: GPL-3.0-or-later
// Robots on wheels in crowds: the lemmas of crowd/wheels.h and property (10) of crowd.h, in rationals.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <sstream>
#include <vector>

#include "crowd/crowd_audit.h"
#include "crowd/driven_arcs.h"
#include "crowd/overlaps.h"
#include "crowd/wheels.h"
#include "crowd_scenes.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/pi.h"

namespace exactvo::formation {
namespace {

using crowd::Motion;

constexpr double kStep = 0.25, kLattice = 0x1p-18;

/// A TurtleBot3 Burger, with the stray of its steps.
CrowdKind burger() {
  CrowdKind kind;
  kind.radius = 0.105 + 0.08 + 0.008;
  kind.max_speed = 0.22;
  kind.neighbour_distance = 3.0;
  kind.wheels = CrowdWheels{0.08, 0.16, 1.0};
  return kind;
}

/// m, stray_of.
double stray_of(const CrowdKind& kind) {
  const double way = kind.max_speed * kStep;
  return way * way / (4.0 * (2.0 * kind.wheels->reference - way));
}

/// Robots on a square of places, each with a random goal and heading.
struct Room {
  Crowd crowd;
  std::vector<Vec2> goals, half;
  SceneRandom random;

  explicit Room(const CrowdKind& kind, std::size_t side = 6, double spacing = 0.5, const CrowdOptions& options = {})
      : crowd(options) {
    crowd.add_kind(kind);
    for (std::size_t k = 0; k < side * side; ++k) {
      const auto x = static_cast<double>(k % side), y = static_cast<double>(k / side);
      const RobotId id = crowd.add_robot({spacing * x + 0.05 * random(), spacing * y + 0.05 * random()});
      const double degrees = k % 5 == 0 ? 90.0 * static_cast<double>(k % 4) : 720.0 * random() - 360.0;
      crowd.set_heading(id, degrees);
      half.push_back(half_heading_of(degrees));
      goals.push_back({});
    }
    draw_goals();
  }
  void draw_goals() {
    const double width = 0.5 * std::sqrt(static_cast<double>(goals.size()));
    for (Vec2& goal : goals) goal = {width * random(), width * random()};
  }
  void prefer() {
    std::vector<Vec2> at;
    crowd.positions(at);
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = goals[i] - at[i];
    crowd.set_preferred(at);
  }
};

TEST(CrowdWheels, Lemma1_TheHalfHeadingFollowsTheoremTwo) {
  SceneRandom random;
  const auto whole = [&](double most) { return std::floor((2.0 * random() - 1.0) * most); };
  std::size_t judged = 0;
  for (int k = 0; k < 2000; ++k) {
    const mpq_class a = whole(1000.0), b = whole(1000.0), mx = whole(500.0), my = whole(500.0);
    const mpq_class ahead = 1414 + std::floor(1000.0 * random());
    if (a == 0 && b == 0) continue;
    const mpq_class size = a * a + b * b, ex = (a * a - b * b) / size, ey = 2 * a * b / size;
    const mpq_class x = mx * ex + my * ey, y = my * ex - mx * ey, t = y / (ahead + x), one = 1 + t * t;
    const mpq_class turned_x = (1 - t * t) / one * ex - 2 * t / one * ey,
                    turned_y = (1 - t * t) / one * ey + 2 * t / one * ex;
    const mpq_class na = (ahead + mx) * a + my * b, nb = (ahead - mx) * b + my * a, after = na * na + nb * nb;
    EXPECT_EQ(mpq_class((na * na - nb * nb) / after), turned_x);
    EXPECT_EQ(mpq_class(2 * na * nb / after), turned_y);
    ++judged;
  }
  EXPECT_GT(judged, 1990U);
}

TEST(CrowdWheels, Lemma2_TheUnknownAngleGrowsByTheFactorThatIsStated) {
  using Complex = std::complex<long double>;
  SceneRandom random;
  for (int k = 0; k < 2000; ++k) {
    const long double ahead = 1.0L, way = 0.5L * static_cast<long double>(random());
    const auto direction = [&] { return std::polar(1.0L, 6.2831853L * static_cast<long double>(random())); };
    const Complex m = way * direction(), e = direction();
    const long double doubt = 1e-7L;
    const auto after = [&](Complex h) { return (ahead * h + m) / (ahead + std::conj(m) * h); };
    const long double grown = std::abs(std::arg(after(e * std::polar(1.0L, doubt)) / after(e)));
    const long double factor = (ahead * ahead - std::norm(m)) / std::norm(ahead + m * std::conj(e));
    EXPECT_LE(grown, doubt * factor * (1.0L + 0x1p-21L)) << static_cast<double>(way);
    EXPECT_GE(grown, doubt * factor * (1.0L - 0x1p-20L)) << static_cast<double>(way);
    if (std::real(m * std::conj(e)) > 0.0L) {
      EXPECT_LT(factor, 1.0L);
    }
  }
}

TEST(CrowdWheels, Lemma3_WheelsDependOnTheHeadingByLessThanIsStated) {
  SceneRandom random;
  long double most = 0.0L;
  for (int k = 0; k < 200000; ++k) {
    const long double ahead = 1.0L, separation = 8.0L, way = 0.5L,
                      angle = 6.2831853L * static_cast<long double>(random());
    const auto wheels = [&](long double turned, int side) {
      const long double x = way * std::cos(turned), y = way * std::sin(turned), t = y / (ahead + x);
      return (x + y * t + static_cast<long double>(side) * separation * t) * (t == 0.0L ? 1.0L : std::atan(t) / t);
    };
    for (const int side : {-1, 1})
      most = std::max(most, std::abs(wheels(angle + 1e-6L, side) - wheels(angle, side)) / (1e-6L * way));
  }
  EXPECT_LT(most, 32.0L);
  EXPECT_GT(most, 8.0L);
}

/// Motions allowed under a limit of 0.003 rad/s, with the heading as uncertain as it may be.
TEST(CrowdWheels, Lemma3_RobotsThatTurnSlowlyKeepTheirLimitWhereverTheyReallyHead) {
  constexpr double kTurn = 0.003;
  CrowdKind kind = burger();
  kind.wheels->max_angular_speed = kTurn;
  crowd::Wheels wheels;
  wheels.take_kinds({kind}, {});
  wheels.put(0, {1.0, 0.0});
  std::vector<crowd::WheelState> states = wheels.states();
  states[0].doubt = crowd::kMostDoubt;
  ASSERT_TRUE(wheels.set_states(states));
  const long double ahead = 2.0L * 0.08L / static_cast<long double>(kLattice);
  long double most = 0.0L;
  std::size_t judged = 0;
  for (std::int32_t x = 1; x < 14400; ++x)
    for (std::int32_t y = 0; wheels.allow(0, 0, {x, y}) && y < 100; ++y) {
      const long double d = -static_cast<long double>(crowd::kMostDoubt);  // it heads to the right of that
      const long double along = x * std::cos(d) + y * std::sin(d), aside = y * std::cos(d) - x * std::sin(d);
      most = std::max(most, 2.0L * std::atan(aside / (ahead + along)) / static_cast<long double>(kStep));
      ++judged;
    }
  EXPECT_GT(judged, 14000U);
  EXPECT_LE(most, static_cast<long double>(kTurn));
  EXPECT_GT(most, 0.99L * static_cast<long double>(kTurn));
}

TEST(CrowdWheels, Lemma4_RestIsAlwaysAllowed) {
  crowd::Wheels wheels;
  CrowdOptions options;
  wheels.take_kinds({burger()}, options);
  wheels.put(0, {1.0, 0.0});
  crowd::Robots robots;
  robots.append(0, 0, 0, 0);
  robots.next_mx[0] = 14000;
  robots.next_my[0] = 0;
  wheels.drive(robots, 0, 1);
  EXPECT_GT(wheels.state(0).left, 13999.0);
  EXPECT_TRUE(wheels.allow(0, 0, {}));
  EXPECT_FALSE(wheels.allow(0, 0, {14500, 0})) << "faster than 0.22 m/s";
  EXPECT_FALSE(wheels.allow(0, 0, {0, 13000})) << "the side, where the outer wheel would have to be faster";
}

TEST(CrowdWheels, AHeadingIsKeptToTheDegreesThatWereGiven) {
  Crowd crowd;
  crowd.add_kind(burger());
  const double degrees[] = {0.0, 90.0, 180.0, 270.0, -90.0, 30.0, 359.0};
  for (const double d : degrees) crowd.set_heading(crowd.add_robot({d, 0.0}), d);
  for (RobotId id = 0; id < 7; ++id) {
    const double angle = degrees[id] * geometry::kPi / 180.0;
    EXPECT_NEAR(geometry::norm(crowd.heading(id) - Vec2{std::cos(angle), std::sin(angle)}), 0.0, 1e-15) << degrees[id];
  }
  EXPECT_EQ(crowd.heading(1), (Vec2{0.0, 1.0}));
  EXPECT_EQ(crowd.heading(2), (Vec2{-1.0, 0.0}));
}

/// Whichever sine and cosine the library of the machine has.
TEST(CrowdWheels, HalfHeadingsHaveTheSameBitsEverywhere) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (int k = -3600; k <= 7200; ++k) {
    const Vec2 half = half_heading_of(0.1 * k);
    for (const double x : {half.x, half.y}) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3U;
    }
    const long double angle = 0.1 * k * 3.14159265358979323846264L / 360.0L;
    const long double x = half.x, y = half.y, off = y * std::cos(angle) - x * std::sin(angle);
    ASSERT_LE(std::abs(off), 0x1p-51L * std::hypot(x, y)) << k;
    ASSERT_GT(x * std::cos(angle) + y * std::sin(angle), 0.0L) << k;
  }
  EXPECT_EQ(hash, 0xd5a2acdfd6c301f3U) << std::hex << hash;
}

/// Runs it and asks everything of every step.
void expect_driven(const CrowdKind& kind, Room& room, int steps) {
  Crowd& crowd = room.crowd;
  std::vector<DrivenArc> arcs;
  for (const Vec2 half : room.half) arcs.emplace_back(kind, kStep, kLattice, half);
  std::vector<Vec2> before, after;
  std::vector<RobotId> all;
  for (RobotId id = 0; id < crowd.id_end(); ++id) all.push_back(id);
  MotionOverlaps overlaps;
  std::size_t moved = 0, turned = 0, changed = 0;
  for (int step = 0; step < steps; ++step) {
    if (step % 40 == 20) room.draw_goals();
    room.prefer();
    crowd.positions(before);
    const std::vector<LatticePlace> from = lattice_places(crowd, all);
    crowd.step();
    crowd.positions(after);
    overlaps.look(from, lattice_places(crowd, all), std::vector<double>(all.size(), kind.radius), kLattice,
                  static_cast<std::size_t>(step));
    for (const RobotId id : all) {
      DrivenArc& arc = arcs[id];
      const mpq_class was = arc.left.low;
      arc.go(before[id], after[id]);
      ASSERT_EQ(arc.wrong, "") << "robot " << id << ", step " << step;
      ASSERT_LT(geometry::norm(arc.heading() - crowd.heading(id)), 0x1p-23) << "robot " << id << ", step " << step;
      ASSERT_NEAR(crowd.wheel_speeds(id).x, arc.left.low.get_d(), 0x1p-17 * kind.max_speed);
      ASSERT_NEAR(crowd.wheel_speeds(id).y, arc.right.low.get_d(), 0x1p-17 * kind.max_speed);
      moved += before[id] != after[id];
      turned += abs(arc.turn) > 0.05;
      changed += abs(arc.left.low - was) > kind.max_speed / 2;
    }
  }
  EXPECT_EQ(overlaps.overlaps, 0U) << overlaps.first;
  EXPECT_GT(overlaps.motions, 100U);
  EXPECT_GT(moved, all.size() * 10);
  EXPECT_GT(turned, all.size());
  EXPECT_GT(changed, 0U);
}

TEST(CrowdWheels, Property10_WheelsKeepWithinTheirLimitsInEveryStep) {
  const CrowdKind kind = burger();
  Room room(kind);
  expect_driven(kind, room, 120);
}

TEST(CrowdWheels, Property10_AlsoWithDoubleLinesAndLimitsOfTurningAndOfDrivingBack) {
  CrowdKind kind = burger();
  kind.wheels->max_angular_speed = 1.2;
  kind.wheels->max_backward_speed = 0.05;
  CrowdOptions options;
  options.precision = CrowdPrecision::double_lines;
  Room room(kind, 5, 0.5, options);
  expect_driven(kind, room, 80);
}

TEST(CrowdWheels, BodiesKeepClearOnTheArcsThatTheyDrive) {
  const CrowdKind kind = burger();
  Room room(kind, 7, 0.43);
  Crowd& crowd = room.crowd;
  const double body = kind.radius - stray_of(kind), reference = kind.wheels->reference, b = 0.16;
  std::vector<Vec2> before, after;
  double longest_stray = 0.0;
  std::size_t near = 0;
  for (int step = 0; step < 120; ++step) {
    if (step % 40 == 20) room.draw_goals();
    room.prefer();
    crowd.positions(before);
    std::vector<Vec2> headings;
    for (RobotId id = 0; id < crowd.id_end(); ++id) headings.push_back(crowd.heading(id));
    crowd.step();
    crowd.positions(after);
    constexpr int kShares = 8;
    std::vector<Vec2> ways[kShares + 1];
    for (RobotId id = 0; id < crowd.id_end(); ++id) {
      const Vec2 wheels = crowd.wheel_speeds(id), axle = before[id] - reference * headings[id];
      const double angle = std::atan2(headings[id].y, headings[id].x), turn = (wheels.y - wheels.x) / b * kStep,
                   way = 0.5 * (wheels.x + wheels.y) * kStep;
      for (int k = 0; k <= kShares; ++k) {
        const double f = static_cast<double>(k) / kShares, half = 0.5 * f * turn;
        const double chord = f * way * (half == 0.0 ? 1.0 : std::sin(half) / half);
        const Vec2 at = axle + chord * Vec2{std::cos(angle + half), std::sin(angle + half)} +
                        reference * Vec2{std::cos(angle + 2.0 * half), std::sin(angle + 2.0 * half)};
        ways[k].push_back(at);
        longest_stray = std::max(longest_stray, geometry::norm(at - before[id] - f * (after[id] - before[id])));
      }
      ASSERT_LT(geometry::norm(ways[kShares].back() - after[id]), 1e-6) << "robot " << id << ", step " << step;
    }
    for (const std::vector<Vec2>& at : ways)
      for (std::size_t i = 0; i < at.size(); ++i)
        for (std::size_t j = i + 1; j < at.size(); ++j) {
          const double distance = geometry::norm(at[i] - at[j]);
          near += distance < 2.0 * kind.radius;
          ASSERT_GE(distance, 2.0 * body - 1e-6) << i << " and " << j << ", step " << step;
        }
  }
  EXPECT_LE(longest_stray, stray_of(kind));
  EXPECT_GT(longest_stray, 0.1 * stray_of(kind));
  EXPECT_GT(near, 0U) << "some came nearer than discs with their stray";
}

TEST(CrowdWheels, OneRobotAndSixteenGetTheSameBitsAndHalfPlanesAreTrue) {
  const CrowdKind kind = burger();
  Room room(kind);
  const geometry::Obstacle wall = geometry::Polyline{{{-0.4, -0.4}, {3.4, -0.4}, {3.4, 3.4}}};
  room.crowd.add_obstacle(wall);
  CrowdAuditor auditor(room.crowd, {wall});
  CrowdAudit audit;
  for (int k = 0; k < 40; ++k) {
    if (k % 20 == 10) room.draw_goals();
    room.prefer();
    auditor.step(audit);
  }
  EXPECT_EQ(audit.failures(), 0U) << audit.first;
  EXPECT_GT(audit.pairs, 1000U);
  EXPECT_GT(audit.edges, 100U);
  EXPECT_FALSE(room.crowd.explain(0).wheels.empty());
}

/// Some lanes of a pack have other limits than the next, or no wheels.
TEST(CrowdWheels, OneRobotAndSixteenGetTheSameBitsWhereKindsAreMixed) {
  for (const bool has_wall : {false, true}) {
    CrowdKind slow = burger(), free = burger();
    slow.wheels->max_angular_speed = 1.2;
    slow.wheels->max_backward_speed = 0.05;
    free.wheels.reset();
    Crowd crowd;
    for (const CrowdKind& kind : {burger(), slow, free}) crowd.add_kind(kind);
    SceneRandom random;
    std::vector<Vec2> at, goals;
    for (int k = 0; k < 49; ++k) {
      const auto kind = static_cast<KindId>(k % 3);
      const RobotId id = crowd.add_robot({0.45 * (k % 7), 0.45 * (k / 7)}, kind);
      if (kind != 2) crowd.set_heading(id, 360.0 * random());
      goals.push_back({3.0 * random(), 3.0 * random()});
    }
    std::vector<geometry::Obstacle> walls;
    if (has_wall) walls.push_back(geometry::Polyline{{{-0.4, -0.4}, {3.4, -0.4}, {3.4, 3.4}}});
    for (const geometry::Obstacle& wall : walls) crowd.add_obstacle(wall);
    CrowdAuditor auditor(crowd, walls);
    CrowdAudit audit;
    for (int step = 0; step < 40; ++step) {
      crowd.positions(at);
      for (std::size_t i = 0; i < at.size(); ++i) at[i] = goals[i] - at[i];
      crowd.set_preferred(at);
      auditor.step(audit);
    }
    EXPECT_EQ(audit.failures(), 0U) << audit.first;
    EXPECT_GT(audit.pairs, 1000U);
  }
}

TEST(CrowdWheels, RobotsWithAndWithoutWheelsKeepClearOfEachOther) {
  CrowdKind other = burger();
  other.wheels.reset();
  Crowd crowd;
  crowd.add_kind(burger());
  crowd.add_kind(other);
  SceneRandom random;
  std::vector<RobotId> all;
  std::vector<Vec2> goals, at;
  for (int k = 0; k < 49; ++k) {
    all.push_back(crowd.add_robot({0.45 * (k % 7), 0.45 * (k / 7)}, static_cast<KindId>(k % 2)));
    goals.push_back({3.0 * random(), 3.0 * random()});
  }
  MotionOverlaps overlaps;
  for (std::size_t step = 0; step < 150; ++step) {
    crowd.positions(at);
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = goals[i] - at[i];
    crowd.set_preferred(at);
    const std::vector<LatticePlace> from = lattice_places(crowd, all);
    crowd.step();
    overlaps.look(from, lattice_places(crowd, all), std::vector<double>(49, burger().radius), kLattice, step);
  }
  EXPECT_EQ(overlaps.overlaps, 0U) << overlaps.first;
  EXPECT_GT(overlaps.motions, 1000U);
}

TEST(CrowdWheels, Property6_ASnapshotHasHeadingsAndWheels) {
  Room room(burger(), 4);
  for (int k = 0; k < 15; ++k) room.prefer(), room.crowd.step();
  std::stringstream bytes;
  room.crowd.snapshot(bytes);
  Crowd restored = Crowd::restored(bytes);
  EXPECT_EQ(restored.digest(), room.crowd.digest());
  EXPECT_EQ(restored.wheel_speeds(3), room.crowd.wheel_speeds(3));
  std::vector<Vec2> at;
  for (int k = 0; k < 15; ++k) {
    room.prefer();
    restored.positions(at);
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = room.goals[i] - at[i];
    restored.set_preferred(at);
    room.crowd.step();
    restored.step();
  }
  EXPECT_EQ(restored.digest(), room.crowd.digest());
}

TEST(CrowdWheels, Property4_TheSameBitsWithAnyNumberOfThreads) {
  std::uint64_t digest = 0;
  for (const int threads : {1, 3}) {
    CrowdOptions options;
    options.threads = threads;
    Room room(burger(), 30, 0.5, options);
    for (int k = 0; k < 12; ++k) room.prefer(), room.crowd.step();
    if (threads == 1) digest = room.crowd.digest();
    EXPECT_EQ(room.crowd.digest(), digest);
  }
}

TEST(CrowdWheels, AHalfTurnBeginsWithoutBackingUpForEver) {
  Crowd crowd;
  crowd.add_kind(burger());
  const RobotId robot = crowd.add_robot({});
  crowd.set_heading(robot, 179.0);
  for (int k = 0; k < 30; ++k) {
    crowd.set_preferred({{0.22, 0.0}});
    crowd.step();
  }
  EXPECT_GT(crowd.heading(robot).x, 0.99);
  EXPECT_GT(crowd.velocity(robot).x, 0.21) << "full speed ahead, beyond the disc of theorem 1";
}

TEST(CrowdWheels, KindsThatCannotStopOrTurnAreRefused) {
  const auto refused = [](const char* named, const auto& change) {
    CrowdKind kind = burger();
    change(kind);
    Crowd crowd;
    try {
      crowd.add_kind(kind);
      FAIL() << named;
    } catch (const CrowdError& e) {
      EXPECT_NE(std::string(e.what()).find(named), std::string::npos) << e.what();
      EXPECT_NE(e.problem(), CrowdProblem::unknown_kind);
    }
  };
  refused("max_wheel_acceleration", [](CrowdKind& k) { k.wheels->max_wheel_acceleration = 0.87; });
  refused("max_wheel_acceleration", [](CrowdKind& k) { k.wheels->max_wheel_acceleration = std::nan(""); });
  refused("reference", [](CrowdKind& k) { k.wheels->reference = 0.054; });
  refused("reference", [](CrowdKind& k) { k.wheels->wheel_separation = 1.5; });
  refused("reference", [](CrowdKind& k) { k.wheels->reference = 1e200; });
  refused("max_angular_speed", [](CrowdKind& k) { k.wheels->max_angular_speed = 1e-6; });
  refused("wheel_separation", [](CrowdKind& k) { k.wheels->wheel_separation = 0.0; });
  refused("max_angular_speed", [](CrowdKind& k) { k.wheels->max_angular_speed = 0.0; });
  refused("max_backward_speed", [](CrowdKind& k) { k.wheels->max_backward_speed = -0.1; });
}

TEST(CrowdWheels, RobotsThatMoveOrHaveNoWheelsAreRefusedHeadings) {
  Crowd crowd;
  crowd.add_kind(burger());
  CrowdKind other = burger();
  other.wheels.reset();
  crowd.add_kind(other);
  EXPECT_THROW(crowd.add_robot({5.0, 0.0}, 0, {0.1, 0.0}), CrowdError);
  const RobotId driven = crowd.add_robot({}), free = crowd.add_robot({2.0, 0.0}, 1);
  EXPECT_THROW(crowd.set_heading(free, 0.0), CrowdError);
  EXPECT_THROW(crowd.set_heading(driven, std::nan("")), CrowdError);
  EXPECT_THROW(crowd.set_heading(7, 0.0), CrowdError);
  crowd.set_preferred({{0.2, 0.0}, {}});
  crowd.step();
  EXPECT_THROW(crowd.set_heading(driven, 90.0), CrowdError);
}

}  // namespace
}  // namespace exactvo::formation
