// SPDX-License-Identifier: GPL-3.0-or-later
// The verb `monitor` as a control loop meets it: one answer a line, at once; bad lines are answered, and the next is
// read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kWall = "LINESTRING (1 -2, 1 2)\n";

std::vector<json> lines_of(const std::string& text) {
  std::vector<json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

/// The answers to these lines, beside the wall at x = 1.
std::vector<json> answers(const std::string& lines, int status = 0, const std::string& robot = "--radius 0.3") {
  const Workplace here;
  here.write("wall.wkt", kWall);
  here.write("lines.jsonl", lines);
  const Outcome outcome = here.run("monitor lines.jsonl --map wall.wkt " + robot);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  return lines_of(outcome.out);
}

TEST(MonitorVerb, AnswersEachLineWithItsShareAndTheScaledCommand) {
  const std::vector<json> all = answers(R"({"id": "a", "pose": [0, 0, 0], "velocity": [1.5, 0], "turn": 0})"
                                        "\n"
                                        R"({"id": 7, "pose": [0, 0, 3.14159], "velocity": [1.5, 0], "turn": 0.2})"
                                        "\n");
  ASSERT_EQ(all.size(), 2u);
  const double s = (-0.3 + std::sqrt(0.09 + 4.0 * 1.125 * 0.7)) / 2.25;
  EXPECT_EQ(all[0]["id"], "a");
  EXPECT_EQ(all[0]["line"], 1);
  EXPECT_NEAR(all[0]["share"], s, 1e-7);
  EXPECT_NEAR(all[0]["velocity"][0], 1.5 * s, 1e-6);
  EXPECT_NEAR(all[0]["witness"]["place"][0], 0.85, 1e-6);
  EXPECT_TRUE(all[0]["witness"].contains("obstacle"));
  EXPECT_EQ(all[1]["id"], 7);
  EXPECT_EQ(all[1]["line"], 2);
  EXPECT_EQ(all[1]["share"], 1.0);
  EXPECT_EQ(all[1]["turn"], 0.2);
  EXPECT_EQ(all[1]["witness"], nullptr);
}

TEST(MonitorVerb, TrajectoryThatIsTooFastIsAnsweredAndTheNextLineIsRead) {
  const std::vector<json> all = answers(R"({"trajectory": [[0, -5, 0, 0], [5e-324, -5, 0, 3]]})"
                                        "\n"
                                        R"({"trajectory": [[0, -5, 0, 0], [1e-300, 0.9, 0, 0]]})"
                                        "\n"
                                        R"({"pose": [-5, 0, 0], "velocity": [0.5, 0]})"
                                        "\n",
                                        1);
  ASSERT_EQ(all.size(), 3u);
  for (int k = 0; k < 2; ++k) EXPECT_THAT(all[k]["error"]["found"].get<std::string>(), HasSubstr("m/s")) << k;
  EXPECT_EQ(all[2]["share"], 1.0);
}

TEST(MonitorVerb, TrajectoriesMoversAndFootprintsAreRead) {
  const std::vector<json> all = answers(
      R"({"trajectory": [[5, -2, 0, 0], [8, 1, 0, 0]]})"
      "\n"
      R"({"pose": [-5, 0, 0], "velocity": [1, 0], "movers": [{"id": "walker", "position": [-3, 0], "radius": 0.3,)"
      R"( "max_speed": 1.5, "position_error": 0.1}]})"
      "\n"
      R"({"pose": [-5, 0, 1.5707963267948966], "velocity": [2, 0], "frame": "world",)"
      R"( "movers": [{"polygon": [[-3, -1], [-2, -1], [-2, 1], [-3, 1]], "max_speed": 0}]})"
      "\n",
      0, "--footprint 'POLYGON ((-0.3 -0.2, 0.5 -0.2, 0.5 0.2, -0.3 0.2, -0.3 -0.2))'");
  ASSERT_EQ(all.size(), 3u);
  // The front is at the wall after 2.5 s; 0.1 s and half a second of way are for braking.
  EXPECT_NEAR(all[0]["share"], 1.9 / 3.0, 1e-6);
  EXPECT_NEAR(all[0]["until"], 5.0 + 1.9, 1e-6);
  EXPECT_EQ(all[1]["witness"]["mover"], "walker");
  EXPECT_LT(all[1]["share"], 1.0);
  EXPECT_EQ(all[2]["witness"]["mover"], "0");
  EXPECT_GT(all[2]["share"], 0.5) << "its side is 0.2 m ahead";
}

TEST(MonitorVerb, BadLinesAreAnsweredWithACodeAndTheNextIsRead) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"{", "E_JSON_SYNTAX"},
      {"", "E_JSON_SYNTAX"},
      {" \t\r", "E_JSON_SYNTAX"},
      {"[1]", "E_TYPE"},
      {R"({"velocity": [1, 0]})", "E_KEY_MISSING"},
      {R"({"pose": [0, 0, 0], "velocity": [1, 0], "trun": 1})", "E_KEY_UNKNOWN"},
      {R"({"pose": [0, 0, 0], "velocity": [1, 0], "turn": "fast"})", "E_TYPE"},
      {R"({"pose": [0, 0], "velocity": [1, 0]})", "E_COUNT"},
      {R"({"pose": [0, 0, "nan"], "velocity": [1, 0]})", "E_NOT_FINITE"},
      {R"({"pose": [0, 0, 1e999], "velocity": [1, 0]})", "E_NUMBER"},
      {R"({"pose": [0, 0, 0], "velocity": [1e200, 0]})", "E_RANGE"},
      {R"({"pose": [0, 0, 0], "velocity": [1, 0], "frame": "map"})", "E_OPTION"},
      {R"({"pose": [0, 0, 0], "velocity": [1, 0], "turn": 1, "frame": "world"})", "E_RANGE"},
      {R"({"trajectory": [[0, 0, 0, 0]]})", "E_COUNT"},
      {R"({"trajectory": [[1, 0, 0, 0], [0, 1, 0, 0]]})", "E_COUNT"},
      {R"({"pose": [0, 0, 0], "velocity": [1, 0], "movers": [{"max_speed": 1}]})", "E_NO_ALTERNATIVE"},
      {R"({"pose": [0, 0, 0], "velocity": [1, 0], "pose": [0, 0, 0]})", "E_JSON_DUPLICATE_KEY"},
      {std::string(300, '['), "E_NESTING"}};
  std::string text;
  for (const auto& [line, code] : bad) text += line + "\n" + R"({"pose": [0, 0, 3.1], "velocity": [1, 0]})" + "\n";
  const std::vector<json> all = answers(text, 1);
  ASSERT_EQ(all.size(), 2 * bad.size());
  for (std::size_t k = 0; k < bad.size(); ++k) {
    EXPECT_EQ(all[2 * k]["error"]["code"], bad[k].second) << bad[k].first << " " << all[2 * k];
    EXPECT_EQ(all[2 * k]["line"], 2 * k + 1);
    EXPECT_EQ(all[2 * k]["error"]["place"].get<std::string>().rfind("line " + std::to_string(2 * k + 1), 0), 0u)
        << all[2 * k];
    for (const char* key : {"found", "expected"})
      EXPECT_FALSE(all[2 * k]["error"][key].get<std::string>().empty()) << all[2 * k];
    EXPECT_EQ(all[2 * k + 1]["share"], 1.0) << "the line after " << bad[k].first;
  }
}

TEST(MonitorVerb, ErrorsNameTheKeyOrTheOption) {
  const std::vector<json> all =
      answers(R"({"pose": [0, 0, 0], "velocity": [1, 0], "movers": [{"position": [5, 5], "radius": 1, "max_speed": 1},)"
              R"( {"position": [5, 5], "radius": -1, "max_speed": 1}]})"
              "\n"
              R"({"trajectory": [[0, 0, 0, 0], [1, 1, 0, 0], [1, 2, 0, 0]]})"
              "\n"
              R"({"pose": [0, 0, 0], "velocity": [1, "x"]})"
              "\n",
              1);
  ASSERT_EQ(all.size(), 3u);
  const json radius{{"code", "E_RANGE"},
                    {"place", "line 1, /movers/1/radius"},
                    {"found", "-1"},
                    {"expected", "a number of at least 0 and less than 2^30"}};
  EXPECT_EQ(all[0]["error"], radius);
  EXPECT_EQ(all[1]["error"]["place"], "line 2, /trajectory/2");
  EXPECT_EQ(all[2]["error"]["place"], "line 3, /velocity/1");
}

TEST(MonitorVerb, ProofsOfNothingAreAcceptedByTheAudit) {
  const Workplace here;
  here.write("lines.jsonl", R"({"pose": [0, 0, 0], "velocity": [1, 0]})"
                            "\n");
  ASSERT_EQ(here.run("monitor lines.jsonl --radius 0.3 --certificates proofs.jsonl").status, 0);
  const Outcome audit = here.run("audit --certificate proofs.jsonl");
  EXPECT_EQ(audit.status, 0) << audit.err;
  EXPECT_THAT(audit.out, HasSubstr("0 certificates"));
  here.write("other.jsonl", R"({"summary": {"overlaps": 0}})"
                            "\n");
  EXPECT_EQ(here.run("audit --certificate other.jsonl").status, 2);
}

TEST(MonitorVerb, AShareThatEndsAtAWallIsProven) {
  const Workplace here;
  here.write("wall.wkt", kWall);
  here.write("lines.jsonl", R"({"pose": [0, 0, 0], "velocity": [1.5, 0]})"
                            "\n"
                            R"({"pose": [0.2, 0, 0], "velocity": [1.5, 0], "turn": 1.1})"
                            "\n");
  const Outcome made = here.run("monitor lines.jsonl --map wall.wkt --radius 0.3 --certificates proofs.jsonl");
  ASSERT_EQ(made.status, 0) << made.err;
  for (const json& answer : lines_of(made.out)) EXPECT_LT(answer["share"], 1.0);
  const std::vector<json> proofs = lines_of(here.read("proofs.jsonl"));
  EXPECT_EQ(proofs.back()["summary"]["certificates"], 2);
  EXPECT_EQ(proofs.back()["summary"]["without"], 0);
  EXPECT_EQ(here.run("audit --certificate proofs.jsonl").status, 0);
}

TEST(MonitorVerb, MistypedKeysAreReportedWithTheNearestKey) {
  const std::vector<json> all =
      answers(R"({"pose": [0, 0, 0], "velocty": [1, 0]})"
              "\n"
              R"({"pose": [0, 0, 0], "velocity": [1, 0], "movers": [{"positon": [5, 5], "radius": 1, "max_speed": 1}]})"
              "\n",
              1);
  EXPECT_THAT(all.at(0)["error"]["expected"].get<std::string>(), HasSubstr("did you mean 'velocity'"));
  EXPECT_EQ(all.at(0)["error"]["place"], "line 1, /velocty");
  EXPECT_THAT(all.at(1)["error"]["expected"].get<std::string>(), HasSubstr("did you mean 'position'"));
}

TEST(MonitorVerb, CertificatesOfWhatIsClearAreAcceptedByTheAuditAndChangedOnesAreNot) {
  const Workplace here;
  here.write("wall.wkt", kWall + std::string("POLYGON ((-1 1, 0.2 1, 0.2 2, -1 2, -1 1))\n"));
  here.write("lines.jsonl", R"({"pose": [0, 0, 0], "velocity": [1.5, 0], "turn": 0.8})"
                            "\n"
                            R"({"trajectory": [[0, -2, 0, 0], [1, -1, 0.2, 0.5], [3, -1, 0.2, -1.5]]})"
                            "\n");
  const Outcome made = here.run(
      "monitor lines.jsonl --map wall.wkt --certificates proofs.jsonl --footprint "
      "'POLYGON ((-0.3 -0.2, 0.5 -0.2, 0.5 0.2, -0.3 0.2, -0.3 -0.2))'");
  ASSERT_EQ(made.status, 0) << made.err;
  const std::vector<json> proofs = lines_of(here.read("proofs.jsonl"));
  ASSERT_GE(proofs.size(), 4u);
  EXPECT_EQ(proofs.back()["summary"]["certificates"], proofs.size() - 1);
  EXPECT_EQ(proofs.back()["summary"]["without"], 0);
  EXPECT_EQ(here.run("audit --certificate proofs.jsonl").status, 0);
  int changed = 0;
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, json>>{{"/certificate/a/turn", 2.5},
                                                 {"/certificate/a/until", 9.0},
                                                 {"/certificate/a/velocity", {9.0, 0.0}},
                                                 {"/certificate/a/body/0/radius", 5.0},
                                                 {"/certificate/a/body/0/radius", -5.0},
                                                 {"/certificate/separations/0/margin", 9.0},
                                                 {"/certificate/separations/0/direction", {0.0, 0.0}},
                                                 {"/certificate/separations", json::array()},
                                                 {"/certificate/a/turn", "fast"}}) {
    json other = proofs[0];
    other[json::json_pointer(key)] = value;
    here.write("changed.jsonl", other.dump() + "\n");
    EXPECT_EQ(here.run("audit --certificate changed.jsonl").status, 1) << key << " " << value;
    ++changed;
  }
  EXPECT_EQ(changed, 9);
}

TEST(MonitorVerb, FigureIsDrawn) {
  const Workplace here;
  here.write("wall.wkt", kWall);
  here.write("lines.jsonl", R"({"id": "on", "pose": [0, 0, 0], "velocity": [1.5, 0], "turn": 0.8})"
                            "\n");
  EXPECT_EQ(here.run("monitor lines.jsonl --map wall.wkt --radius 0.3 --figure m.svg").status, 0);
  EXPECT_THAT(here.read("m.svg"), HasSubstr("on: share 0."));
}

/// The program between two pipes.
class Loop {
 public:
  explicit Loop(std::vector<std::string> words) {
    words.insert(words.begin(), EXACTVO_PROGRAM);
    int in[2], out[2];
    EXPECT_EQ(::pipe(in), 0);
    EXPECT_EQ(::pipe(out), 0);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(in[0], STDIN_FILENO);
      ::dup2(out[1], STDOUT_FILENO);
      for (const int end : {in[0], in[1], out[0], out[1]}) ::close(end);
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      ::execv(EXACTVO_PROGRAM, argv.data());
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    to_ = in[1];
    from_ = out[0];
  }
  ~Loop() {
    if (to_ >= 0) ::close(to_);
    ::close(from_);
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// The answer to a line; nothing more is written until it is there. Empty where none comes.
  std::string ask(const std::string& line) {
    const std::string text = line + "\n";
    if (::write(to_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) return "";
    std::string answer;
    constexpr int kLongestWait = 60000;  // ms; no answer is an error, a late one is not
    for (pollfd one{from_, POLLIN, 0}; ::poll(&one, 1, kLongestWait) > 0;) {
      char c = 0;
      if (::read(from_, &c, 1) != 1) break;
      if (c == '\n') return answer;
      answer += c;
    }
    return "";
  }
  int end() {
    ::close(to_);
    to_ = -1;
    int status = -1;
    ::waitpid(pid_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int to_ = -1, from_ = -1;
};

TEST(MonitorVerb, AnswersComeBeforeTheNextLineGoesIn) {
  Loop loop({"monitor", "--radius", "0.3"});
  for (int k = 0; k < 20; ++k) {
    const std::string answer =
        loop.ask(R"({"id": )" + std::to_string(k) + R"(, "pose": [0, 0, 0], "velocity": [1, 0]})");
    ASSERT_FALSE(answer.empty()) << k;
    EXPECT_EQ(json::parse(answer)["id"], k);
  }
  EXPECT_EQ(loop.end(), 0);
}

TEST(MonitorVerb, OptionsThatAreWrongAreNamed) {
  const Workplace here;
  EXPECT_THAT(here.run("monitor - < /dev/null").err, HasSubstr("--radius or --footprint"));
  EXPECT_THAT(here.run("monitor - --radius 0.3 --max-deceleration 0 < /dev/null").err, HasSubstr("--max-deceleration"));
  EXPECT_THAT(here.run("monitor - --radius -1 < /dev/null").err, HasSubstr("--radius"));
  EXPECT_THAT(here.run("monitor - --radius 0 < /dev/null").err,
              HasSubstr("--radius: found '0', expected a radius above"));
  EXPECT_THAT(here.run("monitor - --footprint 'LINESTRING (0 0, 1 0)' < /dev/null").err, HasSubstr("half its width"));
  EXPECT_EQ(here.run("monitor - --radius 0.3 --latency nan < /dev/null").status, 2);
  EXPECT_EQ(here.run("monitor none.jsonl --radius 0.3").status, 2);
}

}  // namespace
}  // namespace exactvo::test
