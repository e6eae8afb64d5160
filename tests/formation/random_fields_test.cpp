// SPDX-License-Identifier: GPL-3.0-or-later
// A slice of the random fields; bin/formation_field_campaign counts the thousands.
#include <gtest/gtest.h>

#include "exactvo/datasets/scenario_file.h"
#include "field_verdict.h"

namespace exactvo::test {
namespace {

using datasets::FieldKind;
using datasets::random_field;

TEST(RandomFields, Property1_AFieldDoesNotDependOnThoseBefore) {
  const std::string alone = datasets::write_scenario(random_field(FieldKind::open, 7));
  for (std::uint64_t k = 0; k < 7; ++k) random_field(FieldKind::open, k);
  EXPECT_EQ(datasets::write_scenario(random_field(FieldKind::open, 7)), alone);
  EXPECT_NE(datasets::write_scenario(random_field(FieldKind::open, 8)), alone);
  EXPECT_NE(datasets::write_scenario(random_field(FieldKind::open, 7, 1)), alone);
}

TEST(RandomFields, Property2_EveryFieldCanRun) {
  for (const FieldKind kind : {FieldKind::convex, FieldKind::open, FieldKind::formation}) {
    for (std::uint64_t k = 0; k < 200; ++k) {
      const formation::Scenario field = random_field(kind, k);
      EXPECT_TRUE(formation::validate(field).empty()) << field.name;
      EXPECT_FALSE(field.obstacles.empty()) << field.name;
    }
  }
}

void expect_good(FieldKind kind, std::uint64_t count) {
  for (std::uint64_t k = 0; k < count; ++k) {
    const FieldVerdict verdict = judge_field(random_field(kind, k), {});
    EXPECT_TRUE(verdict.good()) << verdict.text();
  }
}

TEST(RandomFields, ConvexSliceIsReachedAndSafe) {
  expect_good(FieldKind::convex, 20);
}
TEST(RandomFields, OpenSliceIsReachedAndSafe) {
  expect_good(FieldKind::open, 20);
}
TEST(RandomFields, FormationSliceIsReachedAndSafe) {
  expect_good(FieldKind::formation, 10);
}

/// Robots that end beside each other on the wrong sides: one has to go round another that stands on its slot.
TEST(RandomFields, FormationsSortThemselves) {
  const FieldVerdict verdict = judge_field(random_field(FieldKind::formation, 124), {});
  EXPECT_TRUE(verdict.good()) << verdict.text();
}

}  // namespace
}  // namespace exactvo::test
