// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo view as far as it can be seen without a browser (tests/browser has the rest).
#include <gtest/gtest.h>

#include <string>

#include "run_program.h"

namespace exactvo::test {
namespace {

constexpr const char* kScenario = R"({"name": "short", "guidance": "none", "time_limit": 2,
    "robots": [{"id": "R1", "position": [0, 0], "goal": [3, 0]}],
    "obstacles": [{"id": "wall", "polyline": [[5, -1], [5, 1]]}]})";

TEST(ViewVerb, WritesOnePageThatNamesNoOtherFile) {
  const Workplace here;
  here.write("s.json", kScenario);
  ASSERT_EQ(here.run("simulate s.json --no-figures --out run").status, 0);
  ASSERT_EQ(here.run("view run --out page.html").status, 0);
  const std::string page = here.read("page.html");
  EXPECT_LT(page.size(), 300'000u);
  for (const char* word : {"src=", "@import", "url(h", "fetch(", "XMLHttpRequest", "WebSocket", "import(", "__RUNS__",
                           "__SCRIPT__", "__STYLE__", "\nimport ", "\nexport "})
    EXPECT_EQ(page.find(word), std::string::npos) << word;
  for (std::size_t at = page.find("http"); at != std::string::npos; at = page.find("http", at + 1))
    EXPECT_TRUE(page.compare(at, 10, "http-equiv") == 0 || page.compare(at, 18, "http://www.w3.org/") == 0)
        << page.substr(at, 60);
  for (const char c : page) ASSERT_TRUE(c == '\n' || (c >= ' ' && c < 127)) << static_cast<int>(c);
}

TEST(ViewVerb, TakesFolderRecordingAndScenarioTogether) {
  const Workplace here;
  here.write("s.json", kScenario);
  ASSERT_EQ(here.run("simulate s.json --no-figures --out run").status, 0);
  EXPECT_EQ(here.run("view run run/recording.jsonl s.json --method orca --out page.html").status, 0);
  EXPECT_TRUE(here.has("page.html"));
}

TEST(ViewVerb, EqualRunsGiveEqualPages) {
  const Workplace here;
  here.write("s.json", kScenario);
  for (const char* out : {"a", "b"}) {
    ASSERT_EQ(here.run("simulate s.json --no-figures --out run --force").status, 0);
    ASSERT_EQ(here.run(std::string("view run --out ") + out + ".html").status, 0);
  }
  EXPECT_EQ(here.read("a.html"), here.read("b.html"));
}

TEST(ViewVerb, RefusesNamesThatAreNoPage) {
  const Workplace here;
  here.write("s.json", kScenario);
  for (const char* command :
       {"view s.json", "view s.json --out ''", "view s.json --out page.txt", "view s.json --out .",
        "view nothing.json --out p.html", "view nothing.jsonl --out p.html"})
    EXPECT_EQ(here.run(command).status, 2) << command;
  EXPECT_FALSE(here.has("p.html"));
}

TEST(ViewVerb, SaysThatARecordingIsCutShortAndWritesNothing) {
  const Workplace here;
  here.write("s.json", kScenario);
  ASSERT_EQ(here.run("simulate s.json --no-figures --out run").status, 0);
  const std::string whole = here.read("run/recording.jsonl");
  here.write("cut.jsonl", whole.substr(0, whole.size() / 2));
  here.write("page.html", "an earlier one");
  const Outcome outcome = here.run("view cut.jsonl --out page.html");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("cut.jsonl"), std::string::npos) << outcome.err;
  EXPECT_EQ(here.read("page.html"), "an earlier one");
}

TEST(ViewVerb, SimulateWritesThePageBesideItsFigures) {
  const Workplace here;
  here.write("s.json", kScenario);
  ASSERT_EQ(here.run("simulate s.json --out run", "PATH=/nowhere").status, 0);
  EXPECT_TRUE(here.has("run/explorer.html"));
  ASSERT_EQ(here.run("simulate s.json --out run --no-figures").status, 0);
  EXPECT_FALSE(here.has("run/explorer.html")) << "it would show another run";
}

}  // namespace
}  // namespace exactvo::test
