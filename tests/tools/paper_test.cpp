// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo paper: everything is there, and twice the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;

TEST(Paper, EveryRunIsInTheSummaryAndEveryFigureIsDrawnTwiceTheSame) {
  const Workplace first;
  const Workplace second;
  std::string table;
  for (const Workplace* here : {&first, &second}) {
    const Outcome outcome = here->run("paper --out out");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(table.empty() || table == outcome.out);
    table = outcome.out;
  }
  const auto a = first.files("out");
  const auto b = second.files("out");
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, text] : a) {
    ASSERT_EQ(b.count(name), 1u) << name;
    EXPECT_TRUE(without_times(text) == without_times(b.at(name))) << name << " differs";
  }

  EXPECT_EQ(a.count("explorer.html"), 1u);
  EXPECT_THAT(a.at("report.html"), testing::HasSubstr("<a href=\"explorer.html\">"));
  EXPECT_THAT(a.at("report.md"), testing::HasSubstr("](explorer.html)"));

  std::set<std::string> runs;
  for (const json& run : json::parse(a.at("summary.json"))) {
    runs.insert(run["scenario"].get<std::string>() + " " + run["method"].get<std::string>() + " " +
                (run["controller"].is_null() ? "" : run["controller"].get<std::string>()));
  }
  EXPECT_EQ(runs.size(), 16u * 4u + 4u * 3u);
  for (const char* run : {"A0 ivo ", "A1 orca ", "A15 ivo ", "A7 ivo-edge ", "A14 ivo-cluster ", "B0 ivo paper-literal",
                          "B3 ivo default", "B1 ivo paper-signs"}) {
    EXPECT_EQ(runs.count(run), 1u) << run;
  }
  for (const char* picture : {"fig5-orca/A1/paths", "fig5-orca/A15/obstacle_distance", "fig6-ivo/A1/robot_distance",
                              "fig8-formation/B3/velocity", "fig8-formation/B0/formation_error", "all-ivo"}) {
    EXPECT_EQ(a.count(std::string("figures/") + picture + ".svg"), 1u) << picture;
    EXPECT_EQ(a.count(std::string("figures/") + picture + ".pdf"), 1u) << picture;
    EXPECT_EQ(a.count(std::string("figures/") + picture + ".png"), 1u) << picture;
  }
}

TEST(Paper, TheReportHasEveryPictureThatAClaimNames) {
  const Workplace here;
  ASSERT_EQ(here.run("paper --out out").status, 0);
  EXPECT_THAT(here.read("out/report.html"), testing::Not(testing::HasSubstr("(not drawn:")));
  const std::string text = here.read("out/report.md");
  const std::regex picture("`(figures/[^`]*[.]png)`");
  int named = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), picture), end; it != end; ++it, ++named)
    EXPECT_TRUE(here.has("out/" + (*it)[1].str())) << (*it)[1];
  EXPECT_GE(named, 12);
  EXPECT_THAT(text, testing::HasSubstr("Not run: `exactvo paper --out DIR --random 1000`"));
  ASSERT_EQ(here.run("paper --out out --random 2 -j 1").status, 0);
  EXPECT_THAT(here.read("out/report.md"), testing::HasSubstr("| convex |"));
}

TEST(Paper, AFolderWithoutScenariosIsRefused) {
  const Workplace here;
  const Outcome outcome = here.run("paper --out out --data .");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, testing::HasSubstr("--data"));
  EXPECT_FALSE(here.has("out"));
}

}  // namespace
}  // namespace exactvo::test
