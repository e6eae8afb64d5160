// SPDX-License-Identifier: GPL-3.0-or-later
// Robots that start in overlap or in one place, and part.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using testing::HasSubstr;

Scenario heap(const std::vector<Vec2>& places) {
  Scenario s;
  s.name = "heap";
  s.separate = true;
  s.time_step = 0.1;
  s.time_limit = 40.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    Robot r;
    r.id = "R" + std::to_string(k + 1);
    r.radius = 0.3;
    r.max_speed = 1.0;
    r.position = places[k];
    r.goals = {Vec2{8.0, 1.5 * static_cast<double>(k)}};
    s.robots.push_back(r);
  }
  return s;
}

datasets::AuditReport audit_of(const Scenario& s, const Recording& run) {
  return datasets::audit({datasets::run_info(s, {}, {}), s, run});
}

/// Pairs that overlap in the first row; of them and of all others, how often two come nearer while they overlap.
struct Nearing {
  std::size_t pairs = 0, judged = 0, nearer = 0, overlaps = 0;
};

Nearing nearing_in(const Scenario& s, const Recording& run) {
  Nearing n;
  for (std::size_t i = 0; i < s.robots.size(); ++i)
    for (std::size_t j = i + 1; j < s.robots.size(); ++j) {
      const double radii = s.robots[i].radius + s.robots[j].radius;
      const auto apart = [&](std::size_t k) {
        return norm(run.steps[k].robots[i].position - run.steps[k].robots[j].position);
      };
      bool is_parting = apart(0) < radii;
      n.pairs += is_parting;
      for (std::size_t k = 0; k + 1 < run.steps.size(); ++k) {
        if (is_parting) {
          ++n.judged;
          n.nearer += apart(k + 1) < apart(k) - 1e-12;
        } else {
          n.overlaps += apart(k + 1) < radii - 1e-9;
        }
        is_parting = is_parting && apart(k + 1) < radii;
      }
    }
  return n;
}

void expect_parted(const Scenario& s, const std::string& what) {
  const Recording run = simulate(s);
  const Nearing n = nearing_in(s, run);
  EXPECT_GT(n.pairs, 0U) << what;
  EXPECT_GT(n.judged, n.pairs) << what;
  EXPECT_EQ(n.nearer, 0U) << what;
  EXPECT_EQ(n.overlaps, 0U) << what;
  const Metrics m = measure(s, run);
  EXPECT_EQ(m.arrived, s.robots.size()) << what << ": " << m.outcome;
  EXPECT_TRUE(m.collisions.empty()) << what;
  EXPECT_EQ(m.warnings.size(), run.warnings.size() + n.pairs) << what;
  const datasets::AuditReport report = audit_of(s, run);
  EXPECT_TRUE(report.clean()) << what << ": " << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_EQ(report.started_overlapping.size(), n.pairs) << what;
  for (const std::string& pair : report.started_overlapping) EXPECT_THAT(pair, HasSubstr(", apart from ")) << what;
}

TEST(Separate, RobotsInOnePlacePart) {
  for (const std::size_t robots : {2U, 3U, 7U})
    expect_parted(heap(std::vector<Vec2>(robots, Vec2{1.0, 2.0})), std::to_string(robots));
}

TEST(Separate, RobotsInAHeapPart) {
  test::SeededRandom random(test::seed_of_run(77));
  for (int scene = 0; scene < 20; ++scene) {
    std::vector<Vec2> places;
    const int robots = 2 + scene % 9;
    for (int k = 0; k < robots; ++k) places.push_back(random.in_box(0.15 * robots));
    places.push_back(places.front());
    expect_parted(heap(places), std::to_string(scene));
  }
}

TEST(Separate, WithoutItOverlapsAreRefusedByTheNamesOfBoth) {
  Scenario s = heap({{0.0, 0.0}, {0.2, 0.0}});
  EXPECT_TRUE(validate(s).empty());
  s.separate = false;
  const std::vector<ScenarioProblem> problems = validate(s);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].pointer, "/robots/1/position");
  EXPECT_THAT(problems[0].found, HasSubstr("overlapping robot 'R1' by 0.4 m"));
}

TEST(Separate, AnAuditRefutesRobotsThatComeNearerOrMeetLater) {
  const Scenario s = heap({{0.0, 0.0}, {0.2, 0.0}});
  const Recording run = simulate(s);
  ASSERT_TRUE(audit_of(s, run).clean());
  Recording nearer = run;
  nearer.steps[1].robots[0].position = nearer.steps[1].robots[1].position - Vec2{0.1, 0.0};
  const datasets::AuditReport refuting = audit_of(s, nearer);
  EXPECT_GT(refuting[datasets::AuditPoint::motions].refuted, 0U);
  EXPECT_EQ(refuting.started_overlapping.at(0), "R1 and R2, came nearer after row 0");
  Recording later = run;
  later.steps[60].robots[0].position = later.steps[60].robots[1].position;
  EXPECT_GT(audit_of(s, later)[datasets::AuditPoint::motions].refuted, 0U);
  Scenario without = s;
  without.separate = false;
  EXPECT_GT(audit_of(without, run)[datasets::AuditPoint::motions].refuted, 0U);
}

/// The last row has no step of its own, and counts all the same.
TEST(Separate, APairThatPartsInTheLastRowIsApart) {
  Scenario s = heap({{0.0, 0.0}, {0.55, 0.0}});
  s.time_limit = s.time_step;
  const Recording run = simulate(s);
  ASSERT_EQ(run.steps.size(), 2U);
  ASSERT_GT(norm(run.steps[1].robots[0].position - run.steps[1].robots[1].position), 0.6);
  EXPECT_EQ(audit_of(s, run).started_overlapping.at(0), "R1 and R2, apart from 0.1 s on");
}

TEST(Separate, IsReadAndWritten) {
  const Scenario s = heap({{0.0, 0.0}, {0.2, 0.0}});
  const std::string text = datasets::write_scenario(s);
  EXPECT_THAT(text, HasSubstr("\"separate\": true"));
  EXPECT_TRUE(datasets::parse_scenario(text, "heap.json", {}).separate);
}

}  // namespace
}  // namespace exactvo::formation
