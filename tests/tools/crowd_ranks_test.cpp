// SPDX-License-Identifier: GPL-3.0-or-later
// simulate without recorded decisions over the ranks of mpirun: the bytes of one process, whatever happens to a rank.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Robots of two kinds to two goals each, round blocks, a wall and a tram.
constexpr const char* kMixed = R"({"name": "mixed", "time_step": 0.1, "time_limit": 25, "horizons": {"least": 0.3},
  "robots": [{"circle": {"count": 40, "radius": 20}, "max_speed": 1.5},
             {"grid": {"columns": 6, "rows": 5, "spacing": 1.5, "corner": [-30, -40], "goal": [40, 25]}, "radius": 0.3}],
  "obstacles": [{"polygon": [[4, 4], [6, 4], [6, 6], [4, 6]]}, {"polygon": [[-9, -6], [-5, -6], [-5, -4], [-9, -4]]},
                {"polyline": [[-12, 3], [-12, 12], [-3, 12]]}],
  "moving_obstacles": [{"id": "tram", "polygon": [[-1, -29], [1, -29], [1, -26], [-1, -26]],
                        "path": [[0, -27], [0, 50]], "speed": 1.3}]})";

/// Long enough to be killed in.
constexpr const char* kRing = R"({"name": "ring", "time_step": 0.05, "time_limit": 40, "horizons": {"least": 0.3},
  "robots": [{"circle": {"count": 4000, "radius": 1000}, "max_speed": 1.5}],
  "moving_obstacles": [{"id": "tram", "polygon": [[-1, -9], [1, -9], [1, -6], [-1, -6]],
                        "path": [[0, -7], [0, 70]], "speed": 1.3}]})";

/// Leaks are Open MPI's, in modules that it unloads.
const std::string kEnvironment =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 LSAN_OPTIONS=detect_leaks=0 timeout 250 ";

std::string over(int ranks) {
  return kEnvironment + "mpirun --oversubscribe -n " + std::to_string(ranks);
}

json results_of(const Outcome& outcome) {
  json results = json::parse(outcome.out);
  for (const char* key : {"wall_time", "provenance"}) results.erase(key);
  return results;
}

std::size_t count_of(const std::string& word, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(CrowdOverRanks, TwoThreeAndFourGiveTheBytesOfOne) {
  const Workplace here;
  here.write("mixed.json", kMixed);
  for (const std::string guidance : {"route", "none"}) {
    const std::string run = "simulate mixed.json --decisions none --json --guidance " + guidance + " --record ";
    const Outcome one = here.run(run + "one.evr");
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_GT(results_of(one)["arrived"].get<int>(), 0);
    for (const int ranks : {1, 2, 3, 4}) {
      const Outcome many = here.run(run + "many.evr --threads " + std::to_string(1 + ranks % 2), over(ranks));
      ASSERT_EQ(many.status, 0) << many.err;
      EXPECT_EQ(results_of(many), results_of(one)) << ranks;
      EXPECT_TRUE(here.read("many.evr") == here.read("one.evr")) << ranks;
    }
  }
  // The tram drives through the crowd: robots that cannot get out of its way are all that overlaps.
  const Outcome audit = here.run("audit one.evr");
  EXPECT_EQ(audit.status, 1) << audit.err;
  EXPECT_GT(count_of(" overlaps ", audit.out), 0U) << audit.out;
  EXPECT_EQ(count_of(" overlaps ", audit.out), count_of(" overlaps moving obstacle 'tram'", audit.out)) << audit.out;
  // Ranks imply it, and write one folder.
  const Outcome folder = here.run("simulate mixed.json --no-figures --out out", over(2));
  EXPECT_EQ(folder.status, 0) << folder.err;
  EXPECT_EQ(count_of("wrote out", folder.err), 1U) << folder.err;
  ASSERT_EQ(here.run("simulate mixed.json --decisions none --record alone.evr").status, 0);
  EXPECT_TRUE(here.read("out/recording.evr") == here.read("alone.evr"));
}

/// Starts three ranks and, as soon as there is a new snapshot, sends `signal` to one of them, or to mpirun.
void write_killer(const Workplace& here) {
  here.write("kill.sh", R"(signal=$1 whom=$2; shift 2
rm -f ranks; touch before; sleep 0.1
mpirun --oversubscribe -n 3 sh -c 'echo $OMPI_COMM_WORLD_RANK $$ >> ranks; exec "$@"' sh "$@" &
run=$!
for k in $(seq 9000); do [ killed.evr.snapshot -nt before ] && break; kill -0 $run || break; sleep 0.01; done
if [ $whom = mpirun ]; then kill -$signal $run; else kill -$signal $(awk -v rank=$whom '$1 == rank { print $2 }' ranks); fi
wait $run
)");
}

TEST(CrowdOverRanks, ARankThatDiesEndsTheRunWithAWordAndResumeGoesOnToTheSameBytes) {
  const Workplace here;
  here.write("ring.json", kRing);
  write_killer(here);
  const std::string options = "simulate ring.json --decisions none --guidance none --every 10 --json";
  const Outcome whole = here.run(options + " --record whole.evr");
  ASSERT_EQ(whole.status, 0) << whole.err;
  const std::string run = options + " --record killed.evr --snapshot-every 25 --resume";
  for (const std::string lost : {"2", "0", "1"}) {
    const Outcome killed = here.run(run, kEnvironment + "sh kill.sh KILL " + lost);
    EXPECT_NE(killed.status, 0);
    EXPECT_TRUE(killed.out.empty()) << killed.out;
    EXPECT_THAT(killed.err, HasSubstr("error: rank " + lost +
                                      " of 3 is gone; --resume goes on from the last snapshot [E_RANK_LOST]"));
    EXPECT_EQ(count_of("E_RANK_LOST", killed.err), 1U) << killed.err;
    EXPECT_TRUE(here.has("killed.evr.snapshot") && here.has("killed.evr.unfinished"));
    EXPECT_FALSE(here.has("killed.evr"));
  }
  // Whoever started it, another number of ranks goes on.
  const Outcome outcome = here.run(run, over(2));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("goes on from killed.evr.snapshot"));
  EXPECT_EQ(results_of(outcome), results_of(whole));
  EXPECT_TRUE(here.read("killed.evr") == here.read("whole.evr"));
  EXPECT_FALSE(here.has("killed.evr.snapshot") || here.has("killed.evr.unfinished"));
}

TEST(CrowdOverRanks, AnMpirunThatIsToldToEndLeavesASnapshot) {
  const Workplace here;
  here.write("long.json", R"({"name": "long", "time_step": 0.05, "time_limit": 100000, "horizons": {"least": 0.3},
    "robots": [{"circle": {"count": 400, "radius": 100000}, "max_speed": 1}]})");
  write_killer(here);
  const Outcome stopped = here.run(
      "simulate long.json --decisions none --guidance none --every 1000 --record killed.evr --snapshot-every 25 "
      "--resume",
      kEnvironment + "sh kill.sh TERM mpirun");
  EXPECT_NE(stopped.status, 0);
  EXPECT_TRUE(stopped.out.empty()) << stopped.out;
  EXPECT_THAT(stopped.err, HasSubstr("; --resume goes on"));
  EXPECT_TRUE(here.has("killed.evr.snapshot") && here.has("killed.evr.unfinished"));
  EXPECT_FALSE(here.has("killed.evr"));
}

TEST(CrowdOverRanks, OneProcessGoesOnWithWhatRanksLeft) {
  const Workplace here;
  here.write("ring.json", kRing);
  write_killer(here);
  const std::string options = "simulate ring.json --decisions none --guidance none --every 10 --json";
  ASSERT_EQ(here.run(options + " --record whole.evr").status, 0);
  const std::string run = options + " --record killed.evr --snapshot-every 25 --resume";
  ASSERT_NE(here.run(run, kEnvironment + "sh kill.sh KILL 1").status, 0);
  EXPECT_EQ(here.run(run).status, 0);
  EXPECT_TRUE(here.read("killed.evr") == here.read("whole.evr"));
}

TEST(CrowdOverRanks, AnErrorOfAllRanksIsReportedOnce) {
  const Workplace here;
  here.write("mixed.json", kMixed);
  here.write("slow.json", R"({"name": "s", "robots": [{"id": "A", "position": [0, 0], "goal": [9, 0]},
      {"id": "B", "position": [5, 5], "goal": [9, 0], "max_speed": 1e-6}]})");
  const std::pair<const char*, const char*> cases[] = {
      {"simulate mixed.json --decisions binding",
       "--decisions: found 'binding', expected none: runs over ranks of MPI record no decisions"},
      {"simulate mixed.json --method ivo", "--method ivo cannot be combined with ranks of MPI"},
      {"simulate - --decisions none", "scenario: found '-', expected a file"},
      {"simulate none.json --decisions none", "E_FILE_MISSING"},
      {"simulate slow.json --decisions none", "slow.json: robot B: max_speed: found "},
      {"simulate mixed.json --decisions none --record mixed.json/out.evr", "E_FILE_UNWRITABLE"}};
  for (const auto& [arguments, words] : cases) {
    const Outcome outcome = here.run(arguments, over(3));
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(count_of(words, outcome.err), 1U) << arguments << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << arguments;
  }
}

TEST(CrowdOverRanks, ARankWithAnotherScenarioIsRefused) {
  const Workplace here;
  std::filesystem::create_directories(here.path() / "a");
  std::filesystem::create_directories(here.path() / "b");
  here.write("a/s.json", kMixed);
  here.write("b/s.json", kRing);
  const std::string program = "-n 1 -wdir '" + here.path().string() + "/",
                    run = " simulate s.json --decisions none --record ../out.evr";
  const Outcome outcome = here.run(run, kEnvironment + "mpirun --oversubscribe " + program +
                                            "a' '" EXACTVO_PROGRAM "' " + run + " : " + program + "b'");
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(count_of("s.json: rank 1: found another scenario", outcome.err), 1U) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("E_OTHER_RUN"));
  EXPECT_FALSE(here.has("out.evr"));
}

}  // namespace
}  // namespace exactvo::test
