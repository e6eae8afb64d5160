// SPDX-License-Identifier: GPL-3.0-or-later
// Section V.A, a test a row and method, by name: PaperTable.A4_ivo.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

#include "paper/expected.h"
#include "paper_scenes.h"

namespace exactvo::test {
namespace {

using formation::Method;
using formation::Metrics;

using tools::kExpected;
using tools::kLatest;
using tools::kOrcaTolerance;
using tools::kStuck;
using Row = tools::Expected;

constexpr double kNothingNear = 1e9;  // m: where the scene has nothing to be clear of

void expect_safe(const Metrics& m) {
  EXPECT_GT(m.min_obstacle_clearance.value_or(kNothingNear), 0.0);
  EXPECT_GT(m.min_robot_clearance.value_or(kNothingNear), 0.0);
  EXPECT_EQ(m.uncertified_half_planes, 0u);
}

void default_method_arrives(const Row& row) {
  const Metrics m = run(paper_scene(row.scenario), with_method(Method::ivo)).metrics;
  ASSERT_TRUE(m.all_arrived);
  EXPECT_LT(*m.last_arrival_time, kLatest);
  EXPECT_EQ(m.min_obstacle_clearance.has_value(), row.has_obstacles);
  expect_safe(m);
}

void cluster_arrives_where_pure_12_can(const Row& row) {
  const Metrics m = run(paper_scene(row.scenario), with_method(Method::ivo_cluster)).metrics;
  EXPECT_EQ(m.all_arrived, row.cluster);
  expect_safe(m);
}

void orca_is_stuck_where_the_table_says(const Row& row) {
  const Metrics m = run(paper_scene(row.scenario), with_method(Method::orca)).metrics;
  EXPECT_EQ(m.all_arrived, row.orca != kStuck);
  EXPECT_NEAR(m.last_arrival_time.value_or(kStuck), row.orca, kOrcaTolerance);
  EXPECT_EQ(m.uncertified_half_planes, 0u);
}

void edge_with_half_axes(const Row& row) {
  const Metrics m = run(paper_scene(row.scenario), with_method(Method::ivo_edge)).metrics;
  EXPECT_EQ(m.all_arrived, row.edge_half);
  expect_safe(m);
}

void edge_with_thin_axes(const Row& row) {
  formation::SimulationOptions options = with_method(Method::ivo_edge);
  options.facade_fixed_minor = 0.1;  // m
  const Metrics m = run(paper_scene(row.scenario), options).metrics;
  EXPECT_EQ(m.all_arrived, row.edge_thin);
  expect_safe(m);
}

class TableTest : public testing::Test {
 public:
  explicit TableTest(std::function<void()> body) : body_(std::move(body)) {}
  void TestBody() override { body_(); }

 private:
  std::function<void()> body_;
};

void register_row(const Row& row, const char* method, void (*check)(const Row&)) {
  const std::string name = std::string(row.scenario) + "_" + method;
  testing::RegisterTest("PaperTable", name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                        [&row, check]() -> testing::Test* { return new TableTest([&row, check] { check(row); }); });
}

const bool kRegistered = [] {
  for (const Row& row : kExpected) {
    register_row(row, "orca", orca_is_stuck_where_the_table_says);
    register_row(row, "ivo_edge", edge_with_half_axes);
    register_row(row, "ivo_edge_thin", edge_with_thin_axes);
    register_row(row, "ivo_cluster", cluster_arrives_where_pure_12_can);
    register_row(row, "ivo", default_method_arrives);
  }
  return true;
}();

}  // namespace
}  // namespace exactvo::test
