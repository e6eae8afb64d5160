// SPDX-License-Identifier: GPL-3.0-or-later
// Options of benches and campaigns: what is refused, and in which words.
#include "options/program_options.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace exactvo::tools {
namespace {

struct Given {
  int rounds = 11;
  std::uint64_t seed = 1;
  std::string json, file;
  bool table = false, parsed = false, has_seed = false;
};

Given parse(const std::vector<const char*>& words, bool file_is_required = false) {
  Given given;
  ProgramOptions options("bench", "Which is fast?");
  options.whole_number("--rounds", given.rounds, 1, "Passes");
  options.whole_number("--seed", given.seed, 0, "Seed");
  options.text("--json", given.json, "Results");
  options.flag("--table", given.table, "A table");
  options.text("FILE", given.file, "Problems", file_is_required);
  std::vector<const char*> all = {"bench"};
  all.insert(all.end(), words.begin(), words.end());
  given.parsed = options.parse(static_cast<int>(all.size()), all.data());
  given.has_seed = given.parsed && options.given("--seed");
  return given;
}

std::string refusal(const std::vector<const char*>& words, bool file_is_required = false) {
  try {
    parse(words, file_is_required);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ProgramOptions, AreRead) {
  const Given given =
      parse({"--rounds", "3", "--table", "p.jsonl", "--json=out.json", "--seed", "18446744073709551615"});
  EXPECT_EQ(given.rounds, 3);
  EXPECT_TRUE(given.table);
  EXPECT_EQ(given.file, "p.jsonl");
  EXPECT_EQ(given.json, "out.json");
  EXPECT_EQ(given.seed, 18446744073709551615U);
  EXPECT_TRUE(given.has_seed);
  EXPECT_FALSE(parse({}).has_seed);
  EXPECT_EQ(parse({}).rounds, 11);
}

TEST(ProgramOptions, ANumberIsWholeAndWithinItsRange) {
  for (const char* text : {"abc", "0", "-1", "1.5", "3x", "", " 3", "0x10", "99999999999", "99999999999999999999"})
    EXPECT_EQ(refusal({"--rounds", text}),
              "--rounds: found '" + std::string(text) + "', expected a whole number from 1 to 2147483647");
  EXPECT_EQ(refusal({"--seed", "18446744073709551616"}),
            "--seed: found '18446744073709551616', expected a whole number from 0 on");
}

TEST(ProgramOptions, WhatMeansNothingIsNamedWithTheNearest) {
  EXPECT_EQ(refusal({"--round", "3"}), "unknown option '--round'; did you mean '--rounds'?");
  EXPECT_EQ(refusal({"--elephant"}), "unknown option '--elephant'");
  EXPECT_EQ(refusal({"a", "b"}), "'b' is one word too many");
}

TEST(ProgramOptions, WhatIsMissingIsNamed) {
  EXPECT_EQ(refusal({"--json"}), "--json takes a value");
  EXPECT_EQ(refusal({"--json", "--table"}), "--json takes a value");
  EXPECT_EQ(refusal({}, true), "FILE is missing");
}

TEST(ProgramOptions, HelpIsPrintedWhateverElseIsAsked) {
  testing::internal::CaptureStdout();
  EXPECT_FALSE(parse({"--rounds", "abc", "--help"}).parsed);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("--rounds N"), std::string::npos);
}

TEST(ProgramOptions, ErrorsEndTheProgramWithItsName) {
  const auto status = [](const std::function<int()>& run) { return run_program("bench", run); };
  testing::internal::CaptureStderr();
  EXPECT_EQ(status([] { return 7; }), 7);
  EXPECT_EQ(status([]() -> int { throw std::runtime_error("no such file"); }), 2);
  EXPECT_EQ(status([]() -> int { throw std::logic_error("a hole"); }), 3);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "bench: error: no such file (bench --help)\nbench: error: internal: a hole (bench --help)\n");
}

}  // namespace
}  // namespace exactvo::tools
