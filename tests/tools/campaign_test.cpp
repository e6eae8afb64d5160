// SPDX-License-Identifier: GPL-3.0-or-later
// Campaigns over random fields: the same bytes for any number of threads, and after a kill.
#include "paper/campaign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <map>

#include "exactvo/datasets/provenance.h"
#include "run_program.h"
#include "support/c_library.h"

namespace exactvo::tools {
namespace {

using test::Workplace;
using testing::HasSubstr;

TEST(Parts, WhatIsThereIsNotDoneAgain) {
  const Workplace here;
  std::atomic<int> calls{0};
  const auto tasks = [&](int count) {
    std::vector<PartTask> list;
    for (int i = 0; i < count; ++i)
      list.push_back({"p" + std::to_string(i), [&calls, i] {
                        ++calls;
                        return "text " + std::to_string(i) + "\n";
                      }});
    return list;
  };
  const std::vector<std::string> first = run_parts(tasks(5), here.path() / "parts", "key", 2);
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(first[3], "text 3\n");
  EXPECT_EQ(run_parts(tasks(7), here.path() / "parts", "key", 1)[6], "text 6\n");
  EXPECT_EQ(calls, 7);
  run_parts(tasks(5), here.path() / "parts", "another key", 1);
  EXPECT_EQ(calls, 12);
}

TEST(Parts, ADamagedPartIsDoneAgain) {
  const Workplace here;
  int calls = 0;
  const std::vector<PartTask> tasks{{"p", [&] {
                                       ++calls;
                                       return std::string("whole\n");
                                     }}};
  run_parts(tasks, here.path(), "key", 1);
  here.write("p.part", here.read("p.part").substr(0, 40));
  EXPECT_EQ(run_parts(tasks, here.path(), "key", 1)[0], "whole\n");
  here.write("p.part", here.read("p.part") + "more");
  EXPECT_EQ(run_parts(tasks, here.path(), "key", 1)[0], "whole\n");
  EXPECT_EQ(calls, 3);
}

TEST(Parts, AMistakeInOneGoesThrough) {
  const Workplace here;
  const std::vector<PartTask> tasks{{"good", [] { return std::string("x"); }},
                                    {"bad", []() -> std::string { throw std::runtime_error("broken"); }}};
  EXPECT_THROW(run_parts(tasks, here.path(), "key", 2), std::runtime_error);
  EXPECT_TRUE(here.has("good.part"));
}

/// SHA-256 of the rows of a campaign over four fields of each kind and method. (Jitter is summed robot by robot:
/// another order of the sum changes its last digit.)
constexpr const char* kGoldenRows = "8566211e3911ce83cdee1aaea6d0f8a4c7a4ff755a624e6d470dbab291a08a7d";

TEST(Campaign, TheSameBytesForOneTwoAndFourThreads) {
  std::string golden;
  for (const unsigned jobs : {1u, 2u, 4u}) {
    const Workplace here;
    const CampaignFiles files = random_fields({here.path() / "parts", 4, datasets::kFieldSeed, jobs});
    const std::string digest = datasets::sha256_of(files.csv + files.json + files.table);
    if (golden.empty()) golden = digest;
    EXPECT_EQ(digest, golden) << jobs << " threads";
    EXPECT_THAT(files.table, HasSubstr("4 (4)"));
    if (test::c_library_is_the_recorded_one()) {
      EXPECT_EQ(datasets::sha256_of(files.csv), kGoldenRows);
    }
  }
}

TEST(Campaign, AnotherSeedIsAnotherField) {
  const Workplace here;
  const std::vector<Variant> one{random_field_variants().at(3)};
  EXPECT_EQ(one[0].name, "ivo");
  const auto results = run_campaign(one, {here.path(), 3, 7, 1});
  const auto others = run_campaign(one, {here.path(), 3, 8, 1});
  EXPECT_EQ(results[0].good(), 3u);
  EXPECT_NE(campaign_csv(results), campaign_csv(others));
}

TEST(Campaign, AJitterThatIsNoNumberIsReadBackAndLeftOut) {
  FieldResult good, bad;
  good.jitter = 5.0;
  bad.field = 1;
  bad.jitter = std::numeric_limits<double>::quiet_NaN();
  const std::vector<VariantResult> results{{"convex", "ivo", {bad, good}}};
  EXPECT_EQ(results[0].median_jitter(), 5.0);
  EXPECT_EQ(results[0].without_jitter(), 1u);
  EXPECT_THAT(campaign_json("x", results, {"", 2, 7, 1}), HasSubstr("\"without_jitter\": 1"));
  // The same rows as a finished part.
  const std::string head = "convex,ivo,", csv = campaign_csv({{"convex", "ivo", {good, bad}}});
  std::string text = csv.substr(csv.find(head));
  for (std::size_t at; (at = text.find(head)) != std::string::npos;) text.erase(at, head.size());
  const Workplace here;
  here.write("convex-ivo-7-000000-000001.part",
             "exactvo-part " + datasets::sha256_of(program_key()) + " " + datasets::sha256_of(text) + "\n" + text);
  const auto read = run_campaign({random_field_variants().at(3)}, {here.path(), 2, 7, 1});
  ASSERT_EQ(read[0].fields.size(), 2u);
  EXPECT_EQ(read[0].fields[0].jitter, 5.0);
  EXPECT_TRUE(std::isnan(read[0].fields[1].jitter));
}

using PartTimes = std::map<std::string, std::filesystem::file_time_type>;
PartTimes parts_in(const std::filesystem::path& folder) {
  PartTimes parts;
  if (!std::filesystem::exists(folder)) return parts;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".part") parts[entry.path().filename().string()] = entry.last_write_time();
  return parts;
}

TEST(Campaign, AKilledRunGoesOnAndGivesTheSameBytes) {
  const Workplace whole, killed;
  ASSERT_EQ(whole.run("paper --out out --random 15 --jobs 1").status, 0);
  // Killed once the first part is there, by the shell that started it.
  const std::string kill_it =
      "sh -c '\"$@\" & while [ -z \"$(ls out/random/parts/*.part 2>/dev/null)\" ] && kill -0 $!; do sleep 0.02; done; "
      "kill -KILL $!; wait $!' sh";
  EXPECT_NE(killed.run("paper --out out --random 15 --jobs 2", kill_it).status, 0);
  EXPECT_FALSE(killed.has("out/random/random.json"));
  const PartTimes survived = parts_in(killed.path() / "out/random/parts");
  ASSERT_FALSE(survived.empty());
  const test::Outcome again = killed.run("paper --out out --random 15 --jobs 2");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("parts are there already"));
  const PartTimes after = parts_in(killed.path() / "out/random/parts");
  for (const auto& [name, time] : survived) EXPECT_EQ(after.at(name), time) << name << " was done again";
  for (const char* file : {"out/random/random.json", "out/random/random.csv", "out/random/random.txt"})
    EXPECT_EQ(whole.read(file), killed.read(file)) << file;
}

}  // namespace
}  // namespace exactvo::tools
