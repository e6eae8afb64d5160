// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "exactvo/formation/metrics.h"
#include "exactvo/geometry/pi.h"
#include "figures/label_places.h"
#include "figures/outlines.h"
#include "figures/plane.h"
#include "figures/run_figures.h"
#include "support/seeded_random.h"

namespace exactvo::tools {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Two robots that walk straight for ten steps past a polygon with a hole, and stand for ten more.
datasets::RecordingFile short_run() {
  datasets::RecordingFile run;
  run.info.scenario = "short";
  run.info.method = "ivo";
  run.scenario.robots = {{"R'1", {0.0, 0.0}, {}, 0.5, 1.0, {{1.0, 0.0}}},
                         {"R2", {0.0, 3.0}, {}, 0.5, 1.0, {{1.0, 3.0}}}};
  run.scenario.obstacles = {
      {"block", geometry::Polygon{{{3, 0}, {6, 0}, {6, 3}, {3, 3}}, {{{4, 1}, {4, 2}, {5, 2}, {5, 1}}}}}};
  for (int k = 0; k <= 20; ++k) {
    const double way = 0.1 * std::min(k, 10);
    const geometry::Vec2 v{k < 10 ? 1.0 : 0.0, 0.0};
    formation::Step step;
    step.time = 0.1 * k;
    step.robots.resize(2);
    step.robots[0].position = {way, 0.0};
    step.robots[1].position = {way, 3.0};
    step.robots[0].velocity = step.robots[1].velocity = v;
    run.recording.steps.push_back(step);
  }
  run.recording.time_step = 0.1;
  return run;
}

std::vector<std::string> names_of(const std::vector<Figure>& figures) {
  std::vector<std::string> names;
  for (const Figure& figure : figures) names.push_back(figure.name);
  return names;
}

TEST(PathsFigure, WhatStandsInAHoleIsNotPaintedOver) {
  datasets::RecordingFile run = short_run();
  run.scenario.obstacles.push_back({"shelf", geometry::Polygon{{{4.2, 1.2}, {4.8, 1.2}, {4.8, 1.8}, {4.2, 1.8}}, {}}});
  const Figure figure = paths_figure(run);
  EXPECT_THAT(figure.body, Not(HasSubstr("white' fs solid")));
  EXPECT_THAT(figure.data, HasSubstr("3 0\n4 1\n"));  // the bridge to the hole
  EXPECT_THAT(figure.data, HasSubstr("4.2 1.2"));
}

/// `run` moved by `by`, as a map in the coordinates of a country is.
datasets::RecordingFile moved(datasets::RecordingFile run, geometry::Vec2 by) {
  for (formation::Robot& robot : run.scenario.robots) {
    robot.position += by;
    for (geometry::Vec2& goal : robot.goals) goal += by;
  }
  auto& block = std::get<geometry::Polygon>(run.scenario.obstacles[0].shape);
  for (geometry::Vec2& p : block.outer) p += by;
  for (geometry::Vec2& p : block.holes[0]) p += by;
  for (formation::Step& step : run.recording.steps)
    for (formation::RobotStep& robot : step.robots) robot.position += by;
  return run;
}

TEST(PathsFigure, FarFromTheOriginAxesCountFromARoundPointNearby) {
  const Figure here = paths_figure(short_run());
  EXPECT_THAT(here.body, HasSubstr("set xlabel 'x [m]'"));
  EXPECT_THAT(here.body, HasSubstr("using 1:2 with lines"));
  const Figure far = paths_figure(moved(short_run(), {1e9, 5.5e6}));
  EXPECT_THAT(far.body, HasSubstr("set xlabel 'x - 1000000000 [m]'"));
  EXPECT_THAT(far.body, HasSubstr("set ylabel 'y - 5500000 [m]'"));
  EXPECT_THAT(far.body, HasSubstr("using ($1 - x0):($2 - y0) with lines"));
  EXPECT_THAT(far.body, Not(HasSubstr("using 1:2 ")));
  EXPECT_THAT(far.data, HasSubstr("\n1000000000.1 5500000 0.1\n"));  // the way, a tenth of a metre later
}

TEST(LocalOrigin, IsAMultipleOfThePowerOfTenAboveTheView) {
  EXPECT_FALSE(LocalOrigin(Box{{-3, -2}, {9, 4}}).is_far());
  EXPECT_FALSE(LocalOrigin(Box{{0, 0}, {3e6, 3e6}}).is_far());
  EXPECT_FALSE(LocalOrigin(Box{{900, 900}, {940, 940}}).is_far());
  EXPECT_EQ(LocalOrigin(Box{{512345, 0}, {512349, 3}}).place(), (geometry::Vec2{512350, 0}));
  EXPECT_EQ(LocalOrigin(Box{{-1e9, 7e5}, {-1e9 + 4, 7e5 + 3}}).place(), (geometry::Vec2{-1e9, 7e5}));
  EXPECT_EQ(LocalOrigin(Box{{-1e9, 0}, {-1e9 + 4, 3}}).x_label(), "x + 1000000000 [m]");
  EXPECT_EQ(LocalOrigin(Box{{1e4, 0}, {1e4 + 4e-9, 3e-9}}).x_label(), "x - 10000.00000000 [m]");
}

TEST(DataFile, NumbersItsDataSetsAsGnuplotDoes) {
  DataFile data;
  EXPECT_EQ(data.begin("first", "x"), 0);
  data.row({1.0, 0.1});
  data.gap();
  data.row({2.0});
  EXPECT_EQ(data.begin("second", "x"), 1);
  data.labelled_row({3.0}, "here");
  EXPECT_EQ(data.text(), "# 0: first\n# x\n1 0.1\n\n2\n\n\n# 1: second\n# x\n3 \"here\"\n");
}

TEST(Quoted, LeavesNoQuoteOpen) {
  EXPECT_EQ(quoted("plain"), "'plain'");
  EXPECT_EQ(quoted("R'1"), R"("R'1")");
  EXPECT_EQ(quoted("'a\"`b`\\"), R"("'a\"\140b\140\\\\")");
  EXPECT_EQ(quoted("a_{k}@^&~\\"), R"('a\_\{k\}\@\^\&\~\\')");
  EXPECT_EQ(markup("{/:Italic a}_{k+1}"), "'{/:Italic a}_{k+1}'");
  EXPECT_EQ(markup("the robot's v_x"), "\"the robot's v_x\"");
}

TEST(RunFigures, AreThoseThatApply) {
  datasets::RecordingFile run = short_run();
  EXPECT_THAT(names_of(run_figures(run)), ElementsAre("paths", "obstacle_distance", "robot_distance", "velocity"));
  run.scenario.obstacles.clear();
  EXPECT_THAT(names_of(run_figures(run)), ElementsAre("paths", "robot_distance", "velocity"));
  run.scenario.robots.pop_back();
  for (auto& step : run.recording.steps) step.robots.pop_back();
  EXPECT_THAT(names_of(run_figures(run)), ElementsAre("paths", "velocity"));
}

TEST(RunFigures, HaveUnitsAndLegendsAndNameTheirOwnFiles) {
  for (const Figure& figure : run_figures(short_run())) {
    EXPECT_THAT(script_text(figure), HasSubstr("data = '" + figure.name + ".dat'"));
    EXPECT_THAT(script_text(figure), HasSubstr("set output '" + figure.name + ".' . format"));
    EXPECT_THAT(script_text(figure), HasSubstr("set key outside"));
    EXPECT_THAT(figure.body, HasSubstr("[m"));
    EXPECT_THAT(figure.data, Not(HasSubstr("nan")));
  }
}

TEST(PathsFigure, HasEqualAxesObstaclesHolesAndQuotedNames) {
  const Figure figure = paths_figure(short_run());
  EXPECT_THAT(figure.body, HasSubstr("set size ratio -1"));
  EXPECT_THAT(figure.body, HasSubstr("title \"R'1\""));
  EXPECT_THAT(figure.data, HasSubstr("obstacles with an inside"));
  EXPECT_THAT(figure.data, HasSubstr("\n3 0\n4 1\n4 2\n"));
}

TEST(PathsFigure, EndOfMotionIsWhenTheLastRobotStops) {
  EXPECT_DOUBLE_EQ(end_of_motion(short_run()), 0.9);
}

TEST(PathsFigure, ViewHoldsEverythingButARunaway) {
  datasets::RecordingFile run = short_run();
  const Box calm = view_of(run);
  for (const Vec2 p : {Vec2{-0.5, -0.5}, Vec2{6.0, 3.0}, Vec2{1.5, 3.5}}) EXPECT_TRUE(calm.contains(p));
  run.recording.steps.back().robots[0].position = {1e9, 0.0};
  const Box still = view_of(run);
  EXPECT_EQ(still.high.x, calm.high.x);
  run.recording.steps.back().robots[0].position = {std::nan(""), 0.0};
  EXPECT_EQ(view_of(run).high.x, calm.high.x);
}

TEST(DataFile, EveryDataSetCounts) {
  DataFile data;
  data.begin("nothing in view", "x");
  data.gap();
  data.begin("two curves", "x");
  data.row({1.0});
  data.gap();
  data.gap();
  data.row({2.0});
  EXPECT_EQ(data.text(), "# 0: nothing in view\n# x\nNaN NaN NaN NaN\n\n\n# 1: two curves\n# x\n1\n\n2\n");
}

TEST(Quoted, ShowsWhatWouldEndALine) {
  EXPECT_EQ(quoted("a\nb\x1b[31m'"), R"("a\\\\nb\\\\x1b[31m'")");
  EXPECT_EQ(commented("a`b`\nc\\"), "a'b'\\nc\\ ");
  DataFile data;
  data.begin("a\nsystem('b')", "x");
  data.labelled_row({1.0}, "\"x\n");
  EXPECT_EQ(data.text(), "# 0: a\\nsystem('b')\n# x\n1 \"'x/n\"\n");
}

TEST(Shortened, KeepsHeadAndTailAndCountsCharacters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcdefgh", 5), "ab…gh");
  EXPECT_EQ(shortened("äöü", 3), "äöü");
}

TEST(PathsFigure, MarksWhereARobotWasDeepestInAnObstacle) {
  datasets::RecordingFile run = short_run();
  EXPECT_THAT(paths_figure(run).body, Not(HasSubstr("collision")));
  run.scenario.obstacles.push_back({"wall", geometry::Polyline{{{0.5, -1.0}, {0.5, 1.0}}}});
  run.collisions = measure(run.scenario, run.recording).collisions;
  const Figure figure = paths_figure(run);
  EXPECT_THAT(figure.body, HasSubstr("title 'collision'"));
  EXPECT_THAT(figure.data, HasSubstr("collisions: where they were deepest\n# x [m], y [m]\n0.5 0\n"));
}

TEST(PathsFigure, MarksACollisionWithWhatMovesBetweenTwoRows) {
  datasets::RecordingFile run = short_run();
  formation::MovingObstacle cart;
  run.scenario.obstacles.clear();
  cart.id = "cart";
  cart.shape = geometry::Polygon{{{0.4, 4}, {0.6, 4}, {0.6, 4.2}, {0.4, 4.2}}, {}};
  const double there_and_back = 10.0 / run.recording.time_step;
  cart.motion = {{{0, 0}, {0, -5}, {0, 0}}, there_and_back};
  run.scenario.moving_obstacles = {cart};
  run.collisions = measure(run.scenario, run.recording).collisions;
  ASSERT_FALSE(run.collisions.empty());
  EXPECT_THAT(paths_figure(run).body, HasSubstr("title 'collision'"));
  for (formation::Collision& c : run.collisions) c.standing = true;
  EXPECT_THAT(paths_figure(run).body, AllOf(HasSubstr("title 'hit, it stood'"), Not(HasSubstr("title 'collision'"))));
  EXPECT_THAT(paths_sheet("sheet", "a run", {{"a", &run}}, 1).body,
              AllOf(HasSubstr("'hit, it stood'"), Not(HasSubstr("'collision'"))));
  bool has_distances = false;
  for (const Figure& figure : run_figures(run)) has_distances |= figure.name == "obstacle_distance";
  EXPECT_TRUE(has_distances) << "with moving obstacles alone";
}

TEST(PathsFigure, TheLastPlaceIsThereWithItsTime) {
  EXPECT_THAT(paths_figure(short_run()).data, testing::ContainsRegex("\n1 0 0.5 [-0-9.]+ [-0-9.]+ \"1 s\""));
}

TEST(PathsFigure, DrawsWhatMovesAtEveryTimeMark) {
  datasets::RecordingFile run = short_run();
  EXPECT_THAT(paths_figure(run).body, Not(HasSubstr("moving obstacle")));
  formation::MovingObstacle cart;
  cart.shape = geometry::Polygon{{{3, 4}, {4, 4}, {4, 5}}, {}};
  cart.motion = {{{0, 0}, {0, 9}}, 2.0};
  run.scenario.moving_obstacles = {cart};
  const Figure figure = paths_figure(run);
  EXPECT_THAT(figure.body, HasSubstr("title 'moving obstacle'"));
  EXPECT_THAT(figure.data, HasSubstr("moving obstacles at the time marks\n# x [m], y [m]\n3 4\n4 4\n4 5\n3 4\n"));
  EXPECT_THAT(figure.data, HasSubstr("3 5.8\n4 5.8\n4 6.8\n"));  // at 0.9 s, when the last robot stops
}

TEST(LabelPlaces, KeepClearOfLinesAndOfEachOther) {
  LabelPlaces places(Box{{0, 0}, {20, 20}}, 30.0);
  places.keep_off({{0, 10}, {20, 10}}, false);
  places.keep_off({{10, 0}, {10, 20}}, false);
  std::vector<Vec2> taken;
  for (int k = 0; k < 3; ++k) {
    const std::optional<Vec2> place = places.place_beside({10, 10}, 0.5, false);
    ASSERT_TRUE(place.has_value());
    EXPECT_GT(30.0 * std::fabs(place->y - 10.0), 8.0);
    EXPECT_GT(30.0 * std::fabs(place->x - 10.0), 22.0);
    for (Vec2 other : taken) EXPECT_GT(norm(*place - other), 16.0 / 30.0);
    taken.push_back(*place);
  }
  LabelPlaces crowded(Box{{0, 0}, {20, 20}}, 30.0);
  for (int k = 0; k < 200; ++k) crowded.keep_off({{0, 0.1 * k}, {20, 0.1 * k}}, false);
  EXPECT_FALSE(crowded.place_beside({10, 10}, 0.5, false).has_value());
  EXPECT_TRUE(crowded.place_beside({10, 10}, 0.5, true).has_value());
}

TEST(LabelPlaces, AtTheSideKeepClearOfTheWayAndOfEachOther) {
  LabelPlaces places(Box{{0, 0}, {20, 20}}, 30.0);
  places.keep_off({{0, 10}, {20, 10}}, false);
  std::vector<Vec2> taken;
  for (int k = 0; k < 4; ++k) {
    const std::optional<Vec2> place = places.place_at_side({10, 10}, {0.5, 0.5}, true);
    ASSERT_TRUE(place.has_value());
    EXPECT_GT(30.0 * std::fabs(place->y - 10.0), 8.0) << "on the way";
    for (const Vec2 other : taken)
      EXPECT_TRUE(30.0 * std::fabs(place->x - other.x) > 44.0 || 30.0 * std::fabs(place->y - other.y) > 16.0);
    taken.push_back(*place);
  }
}

/// Where a label goes when all points of all curves are looked at.
class EveryPointLooked {
 public:
  EveryPointLooked(const Box& view, double scale) : view_(view), scale_(scale) {}
  void keep_off(const Points& curve) {
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      const int count = static_cast<int>(std::clamp(norm(curve[i + 1] - curve[i]) * scale_ / 4.0, 1.0, 1000.0));
      for (int k = 0; k <= count; ++k)
        lines_.push_back(curve[i] + (static_cast<double>(k) / count) * (curve[i + 1] - curve[i]));
    }
  }
  std::optional<Vec2> place_beside(Vec2 p, double radius, bool must) {
    std::optional<Vec2> best;
    double most = -2.0;
    for (const double out : {18.0, 30.0, 44.0}) {
      if (out > 30.0 && !must) break;
      for (const int turn : {1, 7, 3, 5, 0, 4, 2, 6}) {
        const double angle = 0.25 * geometry::kPi * turn, away = radius + out / scale_;
        const Vec2 place = p + Vec2{1.2 * away * std::cos(angle), away * std::sin(angle)};
        const double room = most >= 5.0 ? -2.0 : room_round(place);
        if (room > most) best = place, most = room;
      }
    }
    if (!must && most <= 0.0) return std::nullopt;
    labels_.push_back(*best);
    return best;
  }

 private:
  double room_round(Vec2 p) const {
    if (!view_.grown(-22.0 / scale_).contains(p)) return -1.0;
    double room = 1e9;
    const auto beside = [&](Vec2 q, double width, double height) {
      room = std::min(room, std::max(std::max(0.0, scale_ * std::fabs(q.x - p.x) - width),
                                     std::max(0.0, scale_ * std::fabs(q.y - p.y) - height)));
    };
    for (const Vec2 q : lines_) beside(q, 22.0, 8.0);
    for (const Vec2 q : labels_) beside(q, 44.0, 16.0);
    return room;
  }
  Box view_;
  double scale_;
  Points lines_, labels_;
};

TEST(LabelPlaces, AreThoseOfALookAtEveryPoint) {
  test::SeededRandom random(test::seed_of_run(31));
  int placed = 0, refused = 0;
  for (int k = 0; k < 60; ++k) {
    const double size = std::pow(10.0, random.uniform(-3.0, 6.0)), scale = 700.0 / size;
    const Vec2 corner{random.uniform(-3.0, 3.0) * size, random.uniform(-3.0, 3.0) * size};
    const auto anywhere = [&] { return corner + size * Vec2{random.uniform(-0.3, 1.3), random.uniform(-0.3, 1.3)}; };
    const Box view{corner, corner + Vec2{size, random.uniform(0.4, 1.0) * size}};
    LabelPlaces places(view, scale);
    EveryPointLooked all(view, scale);
    for (int curve = random.integer(0, 40); curve > 0; --curve) {
      const Points points{anywhere(), anywhere(), anywhere()};
      places.keep_off(points, false);
      all.keep_off(points);
    }
    for (int label = 0; label < 40; ++label) {
      const Vec2 at = anywhere();
      const bool must = random.integer(0, 9) == 0;
      const std::optional<Vec2> place = places.place_beside(at, 0.01 * size, must);
      ASSERT_EQ(place, all.place_beside(at, 0.01 * size, must)) << k << ' ' << label;
      ++(place ? placed : refused);
    }
  }
  EXPECT_GT(placed, 200);
  EXPECT_GT(refused, 200);
}

/// px: how far `p` is from a stretch.
double distance_px(Vec2 a, Vec2 b, Vec2 p) {
  const double length = dot(b - a, b - a);
  const double along = length > 0.0 ? std::clamp(dot(p - a, b - a) / length, 0.0, 1.0) : 0.0;
  return norm(p - (a + along * (b - a)));
}

TEST(DrawnPoints, LeaveNoPointFartherThanTheThinning) {
  test::SeededRandom random(test::seed_of_run(32));
  std::size_t all = 0, kept = 0;
  for (int k = 0; k < 40; ++k) {
    Points curve{{0.0, 300.0}};
    const double step = std::pow(10.0, random.uniform(-2.0, 1.0)), turn = random.uniform(0.0, 0.5);
    double angle = 0.0;
    for (int i = random.integer(0, 6000); i > 0; --i) {
      angle += random.uniform(-turn, turn);
      curve.push_back(curve.back() + step * Vec2{std::cos(angle), std::sin(angle)});
    }
    const std::vector<std::size_t> drawn = drawn_points(curve);
    ASSERT_EQ(drawn.front(), 0U);
    ASSERT_EQ(drawn.back(), curve.size() - 1);
    for (std::size_t d = 0; d + 1 < drawn.size(); ++d) {
      ASSERT_LT(drawn[d], drawn[d + 1]);
      for (std::size_t i = drawn[d]; i <= drawn[d + 1]; ++i)
        ASSERT_LE(distance_px(curve[drawn[d]], curve[drawn[d + 1]], curve[i]), kThinning) << k << ' ' << i;
    }
    all += curve.size();
    kept += drawn.size();
  }
  EXPECT_LT(2 * kept, all);
  EXPECT_EQ(drawn_points({{0, 0}, {1, 0}, {2, 0}, {3, 0}}), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(drawn_points({{0, 0}, {1, 0}}), (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(drawn_points({}).empty());
}

/// This many robots side by side that all drive upward in waves.
datasets::RecordingFile long_run(std::size_t robots, int rows) {
  datasets::RecordingFile run = short_run();
  run.scenario.robots.clear();
  run.recording.steps.clear();
  const auto place = [](std::size_t i, int k) {
    return Vec2{static_cast<double>(i) + 0.3 * std::sin(0.02 * k), 0.01 * k};
  };
  for (std::size_t i = 0; i < robots; ++i)
    run.scenario.robots.push_back({"R" + std::to_string(i + 1), place(i, 0), {}, 0.2, 1.0, {place(i, rows)}});
  for (int k = 0; k <= rows; ++k) {
    formation::Step step;
    step.time = 0.1 * k;
    for (std::size_t i = 0; i < robots; ++i) {
      formation::RobotStep& robot = step.robots.emplace_back();
      robot.position = place(i, k);
      robot.velocity = {0.06 * std::cos(0.02 * k), 0.1};
    }
    run.recording.steps.push_back(step);
  }
  return run;
}

std::size_t count_of(const std::string& words, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

TEST(RunFigures, ManyRobotsTakeFewDataSetsAndFewRows) {
  const datasets::RecordingFile run = long_run(300, 300);
  const std::vector<Figure> figures = run_figures(run);
  EXPECT_EQ(figures.size(), 4u);
  for (const Figure& figure : figures) {
    EXPECT_LT(count_of("data index ", figure.body), 160u) << figure.name;
    EXPECT_LT(count_of("\n", figure.data), 30'000u) << figure.name << ": of 90,000 states";
    EXPECT_THAT(figure.body, HasSubstr("title '300 robots'"));
    EXPECT_THAT(figure.data, Not(HasSubstr("nan")));
  }
  const std::string& paths = figures[0].data;
  EXPECT_THAT(paths, HasSubstr(": path of R1 and 10 more\n"));
  EXPECT_THAT(paths, HasSubstr(": outlines of R28 and 9 more\n"));
  EXPECT_THAT(figures[0].body, Not(HasSubstr("with circles")));
}

/// Numbers of the second column of the data set that has this title.
std::vector<double> values_of(const Figure& figure, const std::string& title) {
  std::istringstream lines(figure.data.substr(figure.data.find(title)));
  std::vector<double> values;
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);  // the columns
  for (double time = 0.0, value = 0.0; std::getline(lines, line) && !line.empty();) {
    std::istringstream(line) >> time >> value;
    values.push_back(value);
  }
  return values;
}

TEST(RunFigures, AThinnedCurveKeepsItsExtremes) {
  const datasets::RecordingFile run = long_run(4, 12'000);
  const Figure velocity = run_figures(run)[3];
  ASSERT_EQ(velocity.name, "velocity");
  const std::vector<double> drawn = values_of(velocity, ": R2\n");
  EXPECT_LT(drawn.size(), 6000u);
  EXPECT_GT(drawn.size(), 200u);
  const double a_pixel = 0.132 / 380.0;  // of an axis from -0.066 to 0.066
  EXPECT_NEAR(*std::max_element(drawn.begin(), drawn.end()), 0.06, 0.2 * a_pixel);
  EXPECT_NEAR(*std::min_element(drawn.begin(), drawn.end()), -0.06, 0.2 * a_pixel);
}

TEST(RunFigures, ShortRunsHaveEveryRow) {
  const datasets::RecordingFile run = long_run(4, 1000);
  for (const char* robot : {": R1\n", ": R4\n"}) EXPECT_EQ(values_of(run_figures(run)[3], robot).size(), 1001u);
}

TEST(LyapunovFigure, ALongRunIsThinned) {
  datasets::RecordingFile run = short_run();
  run.lyapunov.resize(50'000);
  for (std::size_t k = 0; k < run.lyapunov.size(); ++k) {
    run.lyapunov[k].time = 0.1 * static_cast<double>(k);
    run.lyapunov[k].paper.kinetic = std::exp(-0.001 * static_cast<double>(k));
    run.lyapunov[k].sound.kinetic = run.lyapunov[k].paper.kinetic;
  }
  const Figure figure = lyapunov_figure(run);
  EXPECT_LT(count_of("\n", figure.data), 5000u);
  const std::vector<double> drawn = values_of(figure, ": V of (18)\n");
  EXPECT_EQ(drawn.front(), 1.0);
  EXPECT_NEAR(drawn.back(), std::exp(-49.999), 1e-25);
}

TEST(LyapunovFigure, HasEveryTerm) {
  datasets::RecordingFile run = short_run();
  run.lyapunov.resize(run.recording.steps.size());
  for (std::size_t k = 0; k < run.lyapunov.size(); ++k) run.lyapunov[k].time = run.recording.steps[k].time;
  run.lyapunov[1].sound_rates.intervention = 0.625;
  const Figure figure = lyapunov_figure(run);
  for (const char* term : {"'kinetic'", "'consensus'", "'pinning'", "'integral'", "'V of (18)'", "'claimed by (20)'",
                           "'slots'", "'tracking'", "'intervention'", "'bound'"})
    EXPECT_THAT(figure.body, HasSubstr(std::string("title ") + term));
  EXPECT_THAT(figure.data, HasSubstr("0.625"));
}

TEST(Template, EveryPlaceIsFilledOnceAndNoOther) {
  EXPECT_EQ(filled_text("a @b@ c@d@\n", {{"b", "@d@"}, {"d", "x"}}), "a @d@ cx\n");
  EXPECT_THROW(filled_text("@b@", {}), std::logic_error);
  EXPECT_THROW(filled_text("@b", {{"b", ""}}), std::logic_error);
  EXPECT_THROW(filled_text("nothing", {{"b", ""}}), std::logic_error);
  EXPECT_THROW(filled("no such template", {}), std::logic_error);
  EXPECT_EQ(embedded_templates().count("frame"), 1u);
}

/// The numbers of every "set NAME [low:high]" of a script.
std::vector<double> extents(const std::string& script, const std::string& name) {
  std::vector<double> all;
  const std::string setting = "set " + name + " [";
  for (std::size_t at = script.find(setting); at != std::string::npos; at = script.find(setting, at + 1)) {
    double low = 0.0, high = 0.0;
    std::sscanf(script.c_str() + at + setting.size(), "%lf:%lf", &low, &high);
    all.push_back(high - low);
  }
  return all;
}

TEST(PathsSheet, HasOneScaleLettersLabelsAndALegend) {
  const datasets::RecordingFile small = short_run();
  datasets::RecordingFile large = moved(short_run(), {30.0, 0.0});
  large.scenario.robots[0].goals = {{60.0, 20.0}};
  large.scenario.robots[1].id = "other";
  const Figure sheet = paths_sheet("sheet", "Two runs", {{"small", &small}, {"large", &large}, {"again", &small}}, 2);
  for (const char* axis : {"xrange", "yrange"}) {
    std::vector<double> all = extents(sheet.body, axis);
    ASSERT_EQ(all.size(), 4u) << axis << ": three panels and the legend";
    EXPECT_NEAR(all[0], all[1], 1e-6 * all[0]) << axis;
    EXPECT_NEAR(all[0], all[2], 1e-6 * all[0]) << axis;
  }
  for (const char* words : {"'(a) small'", "'(b) large'", "'(c) again'", "xlabel 'x [m]'", "label 1 'y [m]'",
                            "title \"R'1\"", "title 'robot 2'", "title 'obstacle'", "title 'goal'"})
    EXPECT_THAT(sheet.body, HasSubstr(words));
  EXPECT_THAT(sheet.body, Not(HasSubstr("title 'collision'")));
}

TEST(PathsSheet, ARunThatDivergesShrinksNoPanel) {
  const datasets::RecordingFile calm = short_run();
  datasets::RecordingFile wild = short_run();
  for (int k = 1; k <= 20; ++k) wild.recording.steps[static_cast<std::size_t>(k)].robots[0].position = {3.0 * k, 0.0};
  const Figure alone = paths_sheet("sheet", "One run", {{"calm", &calm}}, 1);
  const Figure both = paths_sheet("sheet", "Two runs", {{"calm", &calm}, {"wild", &wild}}, 2);
  EXPECT_LT(extents(both.body, "xrange")[0], 1.6 * extents(alone.body, "xrange")[0]);
}

TEST(PathsSheet, WithoutAPanelIsRefused) {
  EXPECT_THROW(paths_sheet("sheet", "No run", {}, 2), std::logic_error);
  EXPECT_THROW(sheet_figure("sheet", "", "", {}), std::logic_error);
}

TEST(Sheet, HasAnAxisLabelAtEachEdgeAndRoomForItsLegend) {
  Sheet sheet;
  sheet.title = "'t'";
  sheet.x_label = "'x'";
  sheet.y_label = "'y'";
  sheet.columns = 2;
  for (std::size_t k = 0; k < 5; ++k) sheet.panels.push_back({quoted(letter_of(k)), "", "plot 2\n"});
  const Figure few = sheet_figure("s", "", "s", sheet);
  const auto count = [&](const std::string& words) {
    int n = 0;
    for (std::size_t at = few.body.find(words); at != std::string::npos; at = few.body.find(words, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("set xlabel 'x'"), 2) << "below the last panel of each column";
  EXPECT_EQ(count("set label 1 'y' at"), 3) << "left of the first panel of each row";
  EXPECT_EQ(count("plot 2"), 6);
  for (int k = 0; k < 30; ++k) sheet.legend.emplace_back("keyentry with lines", "robot");
  EXPECT_GE(sheet_figure("s", "", "s", sheet).canvas.height, few.canvas.height + 5 * 18);
}

TEST(Sheet, LettersGoOnWithNumbers) {
  EXPECT_EQ(letter_of(0), "(a)");
  EXPECT_EQ(letter_of(25), "(z)");
  EXPECT_EQ(letter_of(26), "(27)");
}

TEST(SeriesFigures, ARunThatIsOverAtOnceHasAxes) {
  datasets::RecordingFile run = short_run();
  run.recording.steps.resize(1);
  run.recording.steps[0].robots[0].velocity = run.recording.steps[0].robots[1].velocity = {};
  for (const Figure& figure : run_figures(run)) EXPECT_THAT(figure.body, Not(HasSubstr("[0:0]"))) << figure.name;
}

}  // namespace
}  // namespace exactvo::tools
