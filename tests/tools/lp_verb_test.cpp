// SPDX-License-Identifier: GPL-3.0-or-later
// The verb `lp` as a user meets it: what it refuses and how, what it says of answers without a proof.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kGood = R"({"bound": {"disc": 2}, "preferred": [2, 0],
 "constraints": [{"normal": [-1, 0], "offset": -0.5}]})";

std::string on_one_line(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text + "\n";
}

/// What stdin's only line, or its second after a good one, is refused with.
struct Refusal {
  const char* line;
  const char* place;
  const char* words;
};

TEST(Lp, WhatALineMayNotHoldIsNamedWithItsPlace) {
  const Workplace here;
  const Refusal refusals[] = {
      {R"({"bound":{"disk":1.2},"preferred":[3,3],"constraints":[]})", "line 2, /bound/disk", "did you mean \"disc\"?"},
      {R"({"preferred":[3,3],"constraints":[{"normal":[1,0],"offset":1,"hard":false}]})", "line 2, /constraints/0/hard",
       "[E_KEY_UNKNOWN]"},
      {R"({"preferred":[3,3],"constraints":[],"foo":1})", "line 2, /foo", "[E_KEY_UNKNOWN]"},
      {R"({"preferred":[3,3]})", "line 2", "[E_KEY_MISSING]"},
      {R"({"preferred":[3,3],"constraints":[],"constraints":[]})", "line 2, column", "[E_JSON_DUPLICATE_KEY]"},
      {R"({"preferred":[3,3],"constraints":[})", "line 2, column 35", "[E_JSON_SYNTAX]"},
      {R"({"preferred":[3,3],"constraints":[{"normal":[0,0],"offset":1}]})", "line 2, /constraints/0/normal",
       "a normal that is not 0"},
      {R"({"bound":{"disc":-1},"preferred":[3,3],"constraints":[]})", "line 2, /bound/disc", "[E_RANGE]"},
      {R"({"bound":{"disc":1e300},"preferred":[3,3],"constraints":[]})", "line 2, /bound/disc", "1e+90"},
      {R"({"preferred":[3,3],"constraints":[],"objective":"farthest"})", "line 2, /bound", "a disc or a box"},
      {R"({"preferred":[3,3],"constraints":[{"normal":[1,0],"offset":1,"label":0.5}]})", "line 2, /constraints/0/label",
       "a whole number"},
      {R"({"preferred":[3,3],"constraints":[],"objective":"nearst"})", "line 2, /objective", "[E_OPTION]"}};
  for (const Refusal& r : refusals) {
    here.write("p.jsonl", on_one_line(kGood) + r.line + "\n");
    const Outcome outcome = here.run("lp p.jsonl");
    EXPECT_EQ(outcome.status, 2) << r.line;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(r.place), HasSubstr(r.words), Not(HasSubstr("requires")))) << r.line;
  }
}

// --- Answers of other solvers ---

/// Feasible, with the best velocity (0.5, 0); contradictory; relaxed, with a least violation of 0.5 m/s.
constexpr const char* kThree =
    R"({"bound": {"disc": 2}, "preferred": [2, 0], "constraints": [{"normal": [-1, 0], "offset": -0.5}]}
{"bound": {"disc": 2}, "preferred": [2, 0], "constraints": [{"normal": [-1, 0], "offset": 1}, {"normal": [1, 0], "offset": 1}]}
{"bound": {"disc": 2}, "preferred": [0, 1], "constraints": [{"normal": [1, 0], "offset": 0.5, "priority": "soft"}, {"normal": [-1, 0], "offset": 0.5, "priority": "soft"}]}
)";

struct Judged {
  const char* answers;  ///< CSV of index, vx, vy, status, or JSON Lines
  std::vector<const char*> verdicts;
  int status = 0;
};

TEST(LpCheck, EveryAnswerGetsItsVerdict) {
  const Workplace here;
  here.write("p.jsonl", kThree);
  const Judged cases[] = {
      {"index,vx,vy,status\n0,0.5,0,optimal\n1,,,infeasible\n2,0,1,relaxed\n", {"optimal", "infeasible", "optimal"}},
      {"vx,vy\n0.5,0\n0,0\n0,1\n", {"optimal", "wrongly-feasible", "optimal"}, 1},
      {"vx vy\n0.4999999 0\n0 0\n0 1\n", {"optimal", "wrongly-feasible", "optimal"}, 1},
      {"index,vx,vy,status\n2,0,1,infeasible\n0,0.5000001,0,optimal\n1,,,infeasible\n",
       {"optimal", "infeasible", "wrong-status"},
       1},
      {"vx,vy,status\n0.51,0,optimal\n,,infeasible\n0.2,1,relaxed\n", {"violated", "infeasible", "violated"}, 1},
      {"vx,vy,status\n0.4,0,optimal\n,,infeasible\n0,1,optimal\n", {"not-optimal", "infeasible", "wrong-status"}, 1},
      {"vx,vy,status\n,,infeasible\n,,infeasible\n0,0.2,\n", {"wrongly-infeasible", "infeasible", "optimal"}, 1},
      {"vx,vy,status\n0.5,0,relaxed\n,,infeasible\n0,3,relaxed\n", {"wrong-status", "infeasible", "violated"}, 1},
      {"index,vx,vy\n2,0,1\n", {"missing", "missing", "optimal"}, 1},
      {"{\"velocity\": [0.5, 0]}\n{\"velocity\": null, \"status\": \"infeasible\"}\n{\"index\": 2, \"velocity\": [0, "
       "1], "
       "\"other\": 1}\n{\"summary\": {}}\n",
       {"optimal", "infeasible", "optimal"}},
      {"vx,vy\nnan,0\n0,0\n1e300,1\n", {"violated", "wrongly-feasible", "violated"}, 1},
  };
  for (const Judged& c : cases) {
    here.write("a", c.answers);
    const Outcome outcome = here.run("lp p.jsonl --check a --json");
    EXPECT_EQ(outcome.status, c.status) << c.answers << outcome.err;
    std::istringstream lines(outcome.out);
    std::string line;
    for (const char* verdict : c.verdicts) {
      ASSERT_TRUE(std::getline(lines, line)) << c.answers << outcome.err;
      const json judged = json::parse(line);
      EXPECT_EQ(judged["verdict"], verdict) << c.answers << line;
      EXPECT_EQ(judged["right"], judged["verdict"] == "optimal" || judged["verdict"] == "infeasible");
    }
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(json::parse(line)["summary"]["problems"], 3);
    EXPECT_EQ(here.run("lp p.jsonl --check a").status, c.status);
  }
}

TEST(LpCheck, TheGapIsProvenAndCountsTheLoss) {
  const Workplace here;
  here.write("p.jsonl", kThree);
  here.write("a.csv", "index,vx,vy\n0,0.4,0\n2,0,1\n");
  std::istringstream lines(here.run("lp p.jsonl --check a.csv --json --tolerance 0.2").out);
  std::string line;
  std::getline(lines, line);
  const json first = json::parse(line);
  EXPECT_EQ(first["verdict"], "optimal");
  EXPECT_NEAR(first["excess"].get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(first["certified_gap"].get<double>(), 1.6 * 1.6 - 1.5 * 1.5, 1e-9);
  EXPECT_EQ(first["violation"], 0.0);
  std::getline(lines, line);
  std::getline(lines, line);
  EXPECT_TRUE(json::parse(line)["certified_gap"].is_number()) << line;
}

TEST(LpCheck, EverySolverPassesAndItsAnswersMovedDoNot) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/A7.json") + " --decisions all --no-figures --out out").status, 0);
  const Outcome written = here.run("lp out --out problems.jsonl");
  ASSERT_EQ(written.status, 0) << written.err;
  EXPECT_EQ(here.run("lp out/recording.jsonl --out again.jsonl").status, 0);
  EXPECT_EQ(here.read("problems.jsonl"), here.read("again.jsonl"));
  for (const char* solver : {"batch", "certified"}) {
    here.write("answers.jsonl", here.run(std::string("lp problems.jsonl --json --solver ") + solver).out);
    const Outcome outcome = here.run("lp problems.jsonl --check answers.jsonl --json");
    EXPECT_EQ(outcome.status, 0) << solver << outcome.out.substr(0, 500);
  }
  std::istringstream answers(here.read("answers.jsonl"));
  std::string moved, line;
  std::size_t count = 0;
  while (std::getline(answers, line)) {
    json answer = json::parse(line);
    if (answer.contains("summary")) break;
    const bool is_first = ++count == 1;
    if (!is_first) answer["velocity"] = {answer["velocity"][0].get<double>() + 0.01, answer["velocity"][1]};
    moved += answer.dump() + "\n";
  }
  here.write("moved.jsonl", moved);
  const Outcome outcome = here.run("lp problems.jsonl --check moved.jsonl --json");
  EXPECT_EQ(outcome.status, 1);
  const json summary = json::parse(outcome.out.substr(outcome.out.rfind("{\"summary\"")))["summary"];
  EXPECT_EQ(summary["problems"], count);
  EXPECT_GE(summary["wrong"].get<std::size_t>() + 1, count);
  EXPECT_GT(count, 500u);
}

TEST(LpCheck, TheDecisionsOfARunAreItsProblems) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/A2.json") + " --no-figures --out out").status, 0);
  std::istringstream lines(here.run("lp out --json").out), table(here.read("out/trajectory.csv"));
  std::string line, row;
  std::getline(table, row);
  std::vector<std::string> names;
  std::istringstream header(row);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  const auto column = [&](const std::string& start) {
    return static_cast<std::size_t>(
        std::find_if(names.begin(), names.end(), [&](const std::string& n) { return n.rfind(start, 0) == 0; }) -
        names.begin());
  };
  const std::size_t x = column("chosen_vx"), y = column("chosen_vy");
  ASSERT_LT(std::max(x, y), names.size()) << row;
  std::size_t compared = 0;
  while (std::getline(table, row) && std::getline(lines, line)) {
    std::vector<std::string> fields;
    std::istringstream cells(row);
    for (std::string field; std::getline(cells, field, ',');) fields.push_back(field);
    const json answer = json::parse(line);
    if (answer.contains("summary")) break;
    EXPECT_NEAR(answer["velocity"][0].get<double>(), std::stod(fields.at(x)), 1e-9) << row;
    EXPECT_NEAR(answer["velocity"][1].get<double>(), std::stod(fields.at(y)), 1e-9) << row;
    ++compared;
  }
  EXPECT_GT(compared, 300u);
}

TEST(Lp, ARunWithoutDecisionsHasNoProblems) {
  const Workplace here;
  ASSERT_EQ(here.run("simulate " + data_file("paper/A2.json") + " --decisions none --no-figures --out out").status, 0);
  for (const char* run : {"lp out", "lp out/recording.evr"}) {
    const Outcome refused = here.run(run);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("a recording without decisions"), HasSubstr("[E_FORMAT_UNKNOWN]")));
  }
}

TEST(LpCheck, WhatIsNoAnswerIsRefusedWithItsLine) {
  const Workplace here;
  here.write("p.jsonl", kThree);
  const std::pair<const char*, const char*> cases[] = {
      {"", "no answer"},
      {"x,y\n1,2\n", "line 1: found an unknown column \"x\", expected answers"},
      {"vx,vy\n1\n", "line 2: found 1 field, expected 2, as many"},
      {"vx,vy\n1,two\n", "line 2: found two, expected a number in column vy"},
      {"index,vx,vy\n3,0,0\n", "found an answer to problem 3, expected a problem of the file, 0 to 2"},
      {"index,vx,vy\n0,0,0\n0,1,0\n", "line 3: found a second answer to problem 0"},
      {"vx,vy,status\n0,0,fine\n", "found fine, expected optimal, relaxed"},
      {"vx,vy,status\n,,optimal\n", "found an answer without a velocity"},
      {"{\"velocity\": [1]}\n", "line 1: found [1], expected \"velocity\": [x, y]"},
      {"{\"velocity\": [0, 0]}\n{oops\n", "line 2: found {oops"},
      {"vx,vy\n0,0\n0,0\n0,0\n0,0\n", "line 5: found an answer to problem 3"}};
  for (const auto& [answers, words] : cases) {
    here.write("a", answers);
    const Outcome outcome = here.run("lp p.jsonl --check a");
    EXPECT_EQ(outcome.status, 2) << answers;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << answers;
  }
  for (const auto& [options, words] :
       {std::pair("--check a --out b", "--check cannot be combined with --out"),
        std::pair("--check a --certify", "--certify cannot be combined with --check"),
        std::pair("--check a --solver batch", "--solver cannot be combined with --check"),
        std::pair("--check a --tolerance=-1", "--tolerance: found '-1'"),
        std::pair("--out b --json", "--json cannot be combined with --out")})
    EXPECT_THAT(here.run(std::string("lp p.jsonl ") + options).err, HasSubstr(words)) << options;
}

/// Two instances without a line in binary: m, m_hard, v_max, v_pref.
std::string two_instances() {
  const std::string one = std::string(8, '\0') + std::string("\0\0\x80\x3f", 4) + std::string(8, '\0');
  return std::string("\2\0\0\0", 4) + one + one;
}

TEST(Lp, TextInNoFormatIsRefusedWithTheNamesOfAllFormats) {
  const Workplace here;
  const std::pair<std::string, const char*> cases[] = {
      {"hello\n", "line 1, column 1: found \"hello\""},
      {"\n\nhi\n", "line 3, column 1: found \"hi\""},
      {"12\n", "found \"12\""},
      {"\x89PNG\r\n\x1a\n....", "found \"?PNG\""},
      {two_instances().substr(0, 40), "byte 0: found a count of 2 and 36 bytes after it"},
      {"", "standard input: found an empty file"},
      {"\n \n", "standard input: found blank lines alone"}};
  for (const auto& [bytes, words] : cases) {
    here.write("p", bytes);
    const Outcome outcome = here.run("lp - <p");
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(words), HasSubstr("lines of JSON"), HasSubstr("CSV"),
                                   HasSubstr("binary instances"), HasSubstr("[E_FORMAT_UNKNOWN]")));
  }
  here.write("p", "[1, 2]\n");
  EXPECT_THAT(here.run("lp p").err, HasSubstr("[E_TYPE]"));
}

constexpr const char* kHeader = "problem,disc,preferred_x,preferred_y,normal_x,normal_y,offset,priority\n";

TEST(Lp, AnswersCarryTheNamesThatCsvGivesToProblems) {
  const Workplace here;
  here.write("p.csv",
             "problem,disc,preferred_x,preferred_y,normal_x,normal_y,offset\n"
             "slow,2,2,0,-1,0,-0.5\nfree,,0,1,,,\n");
  here.write("a.csv", "vx,vy\n0.4,0\n0,1\n");
  for (const std::string how : {"lp p.csv --json", "lp p.csv --json --check a.csv"}) {
    std::istringstream lines(here.run(how).out);
    for (const std::string expected : {"slow", "free"}) {
      std::string line;
      ASSERT_TRUE(std::getline(lines, line));
      EXPECT_EQ(json::parse(line).at("name"), expected) << how;
    }
  }
  EXPECT_THAT(here.run("lp p.csv").out, AllOf(HasSubstr("    slow "), HasSubstr("    free ")));
  EXPECT_THAT(here.run("lp p.csv --check a.csv").out, AllOf(HasSubstr("    slow "), HasSubstr("    free ")));
}

TEST(LpCheck, AnswersBelongToTheProblemsThatTheyName) {
  const Workplace here;
  here.write("p.csv",
             "problem,disc,preferred_x,preferred_y,normal_x,normal_y,offset\n"
             "slow,2,2,0,-1,0,-0.5\nfree,,0,1,,,\n");
  for (const char* answers :
       {"problem,vx,vy\nfree,0,1\nslow,0.5,0\n", "index,vx,vy,problem\n1,0,1,free\n,0.5,0,slow\n"}) {
    here.write("a.csv", answers);
    const Outcome outcome = here.run("lp p.csv --check a.csv");
    EXPECT_EQ(outcome.status, 0) << answers << outcome.out << outcome.err;
  }
  here.write("a.csv", "problem,vx,vy\nfree,0.5,0\nslow,0,1\n");
  EXPECT_EQ(here.run("lp p.csv --check a.csv").status, 1) << "the answers of each other";
  here.write("p.jsonl", kThree);
  here.write("a.csv", "problem,vx,vy\n2,0,1\n0,0.5,0\n");
  EXPECT_THAT(here.run("lp p.jsonl --check a.csv").out, HasSubstr("2 right, 1 wrong"));
  here.write("twice.csv",
             "problem,disc,preferred_x,preferred_y,normal_x,normal_y,offset\na,,0,1,,,\nb,,0,1,,,\na,,1,0,,,\n");
  const std::tuple<const char*, const char*, const char*, const char*> cases[] = {
      {"p.csv", "problem,vx,vy\nfast,0,1\n", "line 2: found an answer to problem \"fast\"", "[E_OPTION]"},
      {"p.csv", "problem,vx,vy\nfree,0,1\nfree,0,1\n", "line 3: found a second answer to problem 1", "[E_COUNT]"},
      {"p.csv", "problem,vx,vy,index\nfree,0,1,0\n", "line 2: found index 0 of problem \"free\"", "[E_RANGE]"},
      {"p.csv", "problem,vx,vy,speed\nfree,0,1,2\n", "line 1: found an unknown column \"speed\"", "[E_KEY_UNKNOWN]"},
      {"p.csv", "vx,vy,vx\n0,1,2\n", "line 1: found column \"vx\" a second time", "[E_JSON_DUPLICATE_KEY]"},
      {"p.jsonl", "problem,vx,vy\nfree,0,1\n", "these problems have no names", "[E_OPTION]"},
      {"twice.csv", "problem,vx,vy\na,0,1\n", "the name of two problems", "[E_COUNT]"}};
  for (const auto& [problems, answers, words, code] : cases) {
    here.write("a.csv", answers);
    const Outcome outcome = here.run(std::string("lp ") + problems + " --check a.csv");
    EXPECT_EQ(outcome.status, 2) << answers;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(words), HasSubstr(code))) << answers;
  }
}

TEST(Lp, ATableIsTheSameProblemsAsLinesOfJson) {
  const Workplace here;
  here.write("p.csv", std::string(kHeader) + "a,2,2,0,-1,0,-0.5,soft\n\na,2,2,0,0,1,0.25,hard\nb,,0,1,,,,\n");
  here.write(
      "p.jsonl",
      "{\"bound\":{\"disc\":2},\"preferred\":[2,0],\"constraints\":[{\"normal\":[-1,0],\"offset\":-0.5,\"priority\":"
      "\"soft\"},{\"normal\":[0,1],\"offset\":0.25}]}\n{\"preferred\":[0,1],\"constraints\":[]}\n");
  EXPECT_EQ(here.run("lp p.csv --out a.jsonl").status, 0);
  EXPECT_EQ(here.run("lp p.jsonl --out b.jsonl").status, 0);
  EXPECT_EQ(here.read("a.jsonl"), here.read("b.jsonl"));
  EXPECT_THAT(here.read("a.jsonl"), HasSubstr("0.25"));
}

TEST(Lp, ATableIsRefusedWithItsLine) {
  const Workplace here;
  const std::string header = kHeader;
  const std::tuple<std::string, const char*, const char*> cases[] = {
      {"problem,preferred_x\n", "line 1: found no column \"disc\"", "[E_KEY_MISSING]"},
      {"preferred_x,preferred_x\n", "line 1: found column \"preferred_x\" a second time", "[E_JSON_DUPLICATE_KEY]"},
      {"speed," + header, "line 1: found", "[E_KEY_UNKNOWN]"},
      {header + "a,2,2,0,-1,0\n", "line 2: found 6 fields, expected 8", "[E_COUNT]"},
      {header + "a,2,2,0,x,0,1,\n", "line 2: found", "[E_NUMBER]"},
      {header + "a,-1,2,0,,,,\n", "line 2: found disc -1, expected 0 to 1e90", "[E_RANGE]"},
      {header + "a,2,2,0,0,0,1,\n", "line 2: found the normal 0, 0", "[E_RANGE]"},
      {header + "a,2,2,0,1,0,1,maybe\n", "line 2: found maybe, expected hard or soft", "[E_OPTION]"},
      {header + "a,2,2,0,1,0,1,\na,3,2,0,1,0,1,\n", "line 3: found another disc or preferred velocity in problem a",
       "[E_FORMAT_SYNTAX]"}};
  for (const auto& [text, words, code] : cases) {
    here.write("p.csv", text);
    const Outcome outcome = here.run("lp p.csv");
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(words), HasSubstr(code))) << text;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(Lp, BytesAfterTheInstancesAreRefusedWithTheirPlace) {
  const Workplace here;
  here.write("whole", two_instances());
  EXPECT_EQ(here.run("lp whole").status, 0);
  here.write("longer", two_instances() + "junk");
  const Outcome outcome = here.run("lp longer");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("byte 44, after the last instance: found more bytes, expected the end"),
                                 HasSubstr("[E_FORMAT_SYNTAX]")));
  EXPECT_EQ(outcome.out, "");
}

TEST(Lp, AFolderAMissingFileAndAFullDiskAreNoDefectsOfTheProgram) {
  const Workplace here;
  here.write("p.jsonl", on_one_line(kGood));
  const Outcome folder = here.run("lp .");
  EXPECT_EQ(folder.status, 2);
  EXPECT_THAT(folder.err, HasSubstr("E_FILE_UNREADABLE"));
  const Outcome missing = here.run("lp nowhere.jsonl");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("E_FILE_MISSING"));
  here.run("lp p.jsonl 2>words >/dev/full; echo $? >status; } ; true", "{");
  EXPECT_EQ(here.read("status"), "2\n");
  EXPECT_THAT(here.read("words"), HasSubstr("E_FILE_UNWRITABLE"));
}

// "Input/output error" where the disk filled up before the end.
TEST(Lp, AFullDiskIsCalledOneAfterManyAnswersToo) {
  const Workplace here;
  std::string lines;
  for (int k = 0; k < 4000; ++k) lines += on_one_line(kGood);
  here.write("many.jsonl", lines);
  here.run("lp many.jsonl --json 2>words >/dev/full; echo $? >status; } ; true", "{");
  EXPECT_EQ(here.read("status"), "2\n");
  EXPECT_THAT(here.read("words"), HasSubstr("No space left on device"));
}

TEST(Lp, AReaderThatLeavesIsNoError) {
  const Workplace here;
  std::string lines;
  for (int k = 0; k < 4000; ++k) lines += on_one_line(kGood);
  here.write("many.jsonl", lines);
  here.run("lp many.jsonl --json 2>words; echo $? >status; } | head -1 ; true", "{");
  EXPECT_EQ(here.read("status"), "0\n");
  EXPECT_EQ(here.read("words"), "");
}

/// The distance squared to the only velocity is 18: what is proven is that, up to rounding.
TEST(Lp, AGapIsARoundingErrorAlsoWhereTheDiscIsAPoint) {
  const Workplace here;
  for (const char* disc : {"0", "1e-300", "1e-30", "1"}) {
    here.write("p.jsonl", std::string(R"({"bound":{"disc":)") + disc + R"(},"preferred":[3,3],"constraints":[]})");
    for (const char* solver : {"certified", "exact"}) {
      const Outcome outcome = here.run(std::string("lp p.jsonl --json --solver ") + solver);
      EXPECT_EQ(outcome.status, 0) << disc << outcome.err;
      const json answer = json::parse(outcome.out.substr(0, outcome.out.find('\n')));
      ASSERT_TRUE(answer.at("certificate").is_object()) << disc << ' ' << solver;
      EXPECT_LE(answer.at("certificate").at("gap"), 18 * 0x1p-40) << disc << ' ' << solver;
    }
  }
}

json summary_of(const Outcome& outcome) {
  const std::size_t last = outcome.out.rfind('\n', outcome.out.size() - 2);
  return json::parse(outcome.out.substr(last == std::string::npos ? 0 : last + 1)).at("summary");
}

TEST(Lp, MissingProofsAreCountedWhereProofsAreRequested) {
  const Workplace here;
  here.write("p.jsonl", on_one_line(kGood));
  EXPECT_EQ(summary_of(here.run("lp p.jsonl --json")).at("unproven"), 0);
  EXPECT_EQ(summary_of(here.run("lp p.jsonl --json --solver batch --certify")).at("unproven"), 0);
  EXPECT_TRUE(summary_of(here.run("lp p.jsonl --json --solver batch")).at("unproven").is_null());
}

// The tip of this needle is no double: what lies inside is far from the best velocity, and was called proven.
TEST(Lp, AnAnswerFarFromTheBestIsNotCalledProven) {
  const Workplace here;
  here.write("p.jsonl",
             R"({"bound":{"disc":2},"preferred":[-1,0.3333333333333333],"constraints":[{"normal":[0,3],"offset":1},)"
             R"({"normal":[3e-14,-3],"offset":-1}]})");
  const Outcome table = here.run("lp p.jsonl");
  EXPECT_EQ(table.status, 1);
  EXPECT_THAT(table.out, AllOf(HasSubstr("NOT proven: within "), HasSubstr("0 proven")));
  const json summary = summary_of(here.run("lp p.jsonl --json"));
  EXPECT_EQ(summary.at("certified"), 0);
  EXPECT_EQ(summary.at("unproven"), 1);
}

// Lines of the document were read as documents of their own.
TEST(Lp, OneDocumentOverSeveralLinesIsOneProblem) {
  const Workplace here;
  here.write("p.json", json::parse(kGood).dump(2) + "\n");
  const Outcome whole = here.run("lp p.json --json");
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(summary_of(whole).at("problems"), 1);
  here.write("p.json", "{\n  \"preferred\": [3, 3],\n  \"constraints\": [],\n  \"foo\": 1\n}\n");
  EXPECT_THAT(here.run("lp p.json").err, AllOf(HasSubstr("/foo"), HasSubstr("[E_KEY_UNKNOWN]")));
  here.write("p.json", json::parse(kGood).dump(2) + "\n" + json::parse(kGood).dump(2) + "\n");
  const Outcome two = here.run("lp p.json");
  EXPECT_EQ(two.status, 2);
  EXPECT_THAT(two.err, HasSubstr("one JSON document per line, or one document over several lines"));
}

/// Two soft lines half a metre a second apart: each gives a quarter.
constexpr const char* kApart = R"({"bound": {"disc": 2}, "preferred": [2, 0], "constraints": [
 {"normal": [1, 0], "offset": 0.25, "priority": "soft"}, {"normal": [-1, 0], "offset": 0.25, "priority": "soft"}]})";
/// A hard line that no speed keeps.
constexpr const char* kTooFast = R"({"bound": {"disc": 1}, "preferred": [0, 0],
 "constraints": [{"normal": [1, 0], "offset": 1e60}]})";

TEST(Lp, TheWorstViolationIsTheLargestOfTheAnswers) {
  const Workplace here;
  const std::pair<std::string, double> cases[] = {
      {on_one_line(kGood), 0.0}, {on_one_line(kGood) + on_one_line(kApart), 0.25}, {on_one_line(kTooFast), 1e60}};
  for (const auto& [lines, worst] : cases) {
    here.write("p.jsonl", lines);
    for (const char* solver : {"batch", "certified", "exact"}) {
      const json summary = summary_of(here.run(std::string("lp p.jsonl --json --solver ") + solver));
      EXPECT_NEAR(summary.at("worst_violation"), worst, 1e-12 * worst) << solver << lines;
      EXPECT_LE(summary.at("worst_breach"), 1e-15) << solver << lines;
    }
  }
  here.write("p.jsonl", on_one_line(kApart));
  EXPECT_THAT(here.run("lp p.jsonl").out, HasSubstr("worst violation 0.25 m/s; solver alone "));
}

/// How long is another matter, of the machine.
TEST(Lp, WhatIsTimedIsReported) {
  const Workplace here;
  EXPECT_THAT(here.run("lp --help").out, AllOf(HasSubstr("the solver alone"), HasSubstr("bench_lp --instances FILE")));
  here.write("p.jsonl", on_one_line(kGood));
  EXPECT_GT(summary_of(here.run("lp p.jsonl --json")).at("ns_per_solve"), 0.0);
  here.write("none", std::string(4, '\0'));  // says itself that it has none
  EXPECT_EQ(summary_of(here.run("lp none --json")).at("ns_per_solve"), 0.0);
}

}  // namespace
}  // namespace exactvo::test
