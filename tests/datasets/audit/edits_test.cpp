// SPDX-License-Identifier: GPL-3.0-or-later
// Random edits of recordings: each is rejected, or leaves one that is true and safe by a second, independent program.
// The whole number by hand: audit_edits 100000.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "audit/second_opinion.h"
#include "audit/verdicts.h"

namespace exactvo::datasets::test {
namespace {

const std::vector<ShortRun>& runs() {
  static const std::vector<ShortRun> all = short_runs();
  return all;
}

TEST(AuditEdits, UneditedRunsHoldByBothOpinions) {
  for (const ShortRun& run : runs()) {
    const Judged judged = judge(run, run.lines);
    EXPECT_EQ(judged.fate, Fate::holds) << run.name << ": " << judged.why;
  }
}

TEST(AuditEdits, AreRejectedOrTrue) {
  Campaign campaign;
  campaign.run(runs(), exactvo::test::seed_of_run(96), 0, 420);
  for (const std::string& line : campaign.wrong) ADD_FAILURE() << line;
  EXPECT_GT(campaign.sum.rejected, 150u) << campaign.table();
  EXPECT_GT(campaign.sum.holds, 30u) << campaign.table();
}

TEST(AuditEdits, ThatOncePassedWronglyAreRejected) {
  std::ifstream corpus(EXACTVO_SOURCE_DIR "/tests/corpus/audit/edits.jsonl");
  ASSERT_TRUE(corpus);
  for (std::string text; std::getline(corpus, text);) {
    const nlohmann::json line = nlohmann::json::parse(text);
    const auto run =
        std::find_if(runs().begin(), runs().end(), [&](const ShortRun& r) { return r.name == line["run"]; });
    ASSERT_NE(run, runs().end()) << text;
    const Fate fate = judge(*run, patched(*run, line)).fate;
    EXPECT_TRUE(fate == Fate::refused || fate == Fate::rejected) << text;
  }
}

/// One of the runs has a plan, or nothing above would be asked of plans.
TEST(AuditEdits, PlansAreAmongWhatIsEdited) {
  const auto has_plan = [](const ShortRun& run) {
    return std::any_of(run.lines.begin(), run.lines.end(), [](const auto& line) { return line.contains("plan"); });
  };
  EXPECT_EQ(std::count_if(runs().begin(), runs().end(), has_plan), 1);
}

/// A scenario that leaves out what is a default is the same one.
TEST(SecondOpinion, TakesWhatIsLeftOutForItsDefault) {
  std::size_t guided = 0;
  for (const ShortRun& run : runs()) {
    Lines lines = run.lines;
    nlohmann::json& scenario = lines.front()["header"]["scenario"];
    if (scenario.value("guidance", "") != "route") continue;
    ++guided;
    scenario.erase("guidance");
    EXPECT_EQ(second_opinion(lines, run.lines), "") << run.name;
    EXPECT_EQ(judge(run, lines).fate, Fate::holds) << run.name;
  }
  EXPECT_GT(guided, 0u);
}

/// The second opinion sees what the first must.
TEST(SecondOpinion, SeesCrudeForgeries) {
  const auto forged = [](const char* name, const auto& how) {
    const auto run = std::find_if(runs().begin(), runs().end(), [&](const ShortRun& r) { return r.name == name; });
    Lines lines = run->lines;
    for (nlohmann::json& line : lines)
      if (line.contains("row")) how(line["row"]);
    return second_opinion(lines, run->lines);
  };
  EXPECT_NE(forged("corner ivo", [](auto& row) { row["robots"][0]["position"] = {1.0, -1.0}; }), "");
  EXPECT_NE(forged("crossing ivo", [](auto& row) { row["robots"][0].erase("constraints"); }), "");
  EXPECT_NE(forged("crossing ivo", [](auto& row) { row["robots"][0]["chosen"] = {0.0, 0.0}; }), "");
  EXPECT_NE(forged("three ivo exact default", [](auto& row) { row["robots"][1]["velocity"] = {0.0, 0.0}; }), "");
  EXPECT_NE(forged("cart ivo",
                   [](auto& row) {
                     if (row.contains("moving")) row["moving"][0]["displacement"] = {5.0, 0.0};
                   }),
            "");
}

}  // namespace
}  // namespace exactvo::datasets::test
