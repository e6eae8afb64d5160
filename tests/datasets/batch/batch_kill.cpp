// SPDX-License-Identifier: GPL-3.0-or-later
// Kills batches at random moments, goes on with them, and compares what comes out with a run that nobody disturbed.
//
//   datasets_batch_kill PROGRAM [KILLS [SEED [RANKS [STARS]]]]
//
// With RANKS > 1 under mpirun, where one rank, drawn anew each time, is killed. Status 0: as many kills as asked for
// struck a running batch, and every output was the same byte for byte but for its times.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "batch_files.h"
#include "options/program_options.h"

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using exactvo::test::SeededRandom;

struct Plan {
  std::string program;
  int kills = 50;
  std::uint64_t seed = 1;
  int ranks = 1;
  int stars = 6000;
};

class Campaign {
 public:
  explicit Campaign(const Plan& plan) : plan_(plan), random_(plan.seed) {
    std::string name = (fs::temp_directory_path() / "exactvo_kill_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder " + name);
    folder_ = name;
    exactvo::datasets::test::write_inputs(folder_ / "in", plan.stars);
    // Several inputs of some size, so that every rank has work.
    for (int k = 0; k < 4; ++k) {
      exactvo::datasets::test::write_text(folder_ / "in" / ("more" + std::to_string(k) + ".wkt"),
                                          exactvo::datasets::test::stars_as_wkt(100 + k, plan.stars / 4));
    }
  }
  ~Campaign() { fs::remove_all(folder_); }
  Campaign(const Campaign&) = delete;
  Campaign& operator=(const Campaign&) = delete;

  bool run() {
    const auto start = Clock::now();
    if (!finishes(start_batch("whole", false))) return fail("the undisturbed run failed");
    if (!fs::exists(folder_ / "whole" / "summary.json")) return fail("the undisturbed run left no summary");
    usual_ = std::chrono::duration<double>(Clock::now() - start).count();
    while (struck_ < plan_.kills) {
      if (!disturbed_run()) return false;
    }
    std::printf("%d kills struck in %d runs, %d rank(s), seed %llu; every output equal; a run takes %.2f s\n", struck_,
                runs_, plan_.ranks, static_cast<unsigned long long>(plan_.seed), usual_);
    return true;
  }

 private:
  static bool fail(const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    return false;
  }

  /// Killed now and again until one attempt is left alone, then compared.
  bool disturbed_run() {
    ++runs_;
    constexpr int kMostKillsARun = 6;
    bool resume = false;
    for (int attempt = 0; attempt < kMostKillsARun && struck_ < plan_.kills; ++attempt) {
      const pid_t batch = start_batch("killed", resume);
      resume = true;
      std::this_thread::sleep_for(std::chrono::duration<double>(random_.uniform(0.0, 1.05 * usual_)));
      const Strike what = strike(batch);
      if (what == Strike::failed) return fail("a batch failed of itself after kills" + history_);
      if (what == Strike::too_late) break;
      ++struck_;
      history_ += " " + std::to_string(struck_);
    }
    if (!finishes(start_batch("killed", true))) return fail("could not go on after kills" + history_);
    const std::string differs = exactvo::datasets::test::difference(folder_ / "whole", folder_ / "killed");
    if (!differs.empty()) return fail("differs after kills" + history_ + ": " + differs);
    fs::remove_all(folder_ / "killed");
    history_.clear();
    return true;
  }

  pid_t start_batch(const std::string& out, bool resume) {
    std::vector<std::string> words;
    if (plan_.ranks > 1) words = {"mpirun", "--oversubscribe", "-n", std::to_string(plan_.ranks)};
    const std::string in = (folder_ / "in").string();
    const std::string to = (folder_ / out).string();
    for (const std::string& word : {plan_.program, std::string("batch"), in, std::string("--out"), to,
                                    std::string("-j"), std::string(plan_.ranks > 1 ? "1" : "2")}) {
      words.push_back(word);
    }
    if (resume) words.emplace_back("--resume");
    const pid_t child = ::fork();
    if (child == 0) {
      ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
      ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
      if (plan_.ranks > 1) ::setenv("LSAN_OPTIONS", "detect_leaks=0", 1);  // they are Open MPI's
      if (std::freopen("/dev/null", "w", stdout) == nullptr || std::freopen("/dev/null", "w", stderr) == nullptr) {
        ::_exit(126);
      }
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execvp(arguments[0], arguments.data());
      ::_exit(127);
    }
    return child;
  }

  static bool finishes(pid_t batch) {
    int status = 0;
    ::waitpid(batch, &status, 0);
    return has_finished(status);
  }
  /// 1: some of the inputs were rejected.
  static bool has_finished(int status) { return WIFEXITED(status) && WEXITSTATUS(status) <= 1; }

  enum class Strike { struck, too_late, failed };

  /// Kills the batch, or one of its ranks. What ends in any other way than through or by that signal has failed.
  Strike strike(pid_t batch) {
    bool sent = false;
    if (plan_.ranks == 1) {
      sent = ::kill(batch, SIGKILL) == 0;
    } else {
      const std::vector<pid_t> ranks = children_of(batch);
      sent = !ranks.empty() && ::kill(ranks[random_.bits() % ranks.size()], SIGKILL) == 0;
    }
    int status = 0;
    ::waitpid(batch, &status, 0);
    if (has_finished(status)) return Strike::too_late;
    // mpirun says by its status what signal its rank died of.
    const bool by_signal = plan_.ranks == 1 ? WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL
                                            : WIFEXITED(status) && WEXITSTATUS(status) == 128 + SIGKILL;
    if (sent && by_signal) return Strike::struck;
    std::fprintf(stderr, "ended with status 0x%x, not by the signal\n", static_cast<unsigned>(status));
    return Strike::failed;
  }

  static std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string stat = exactvo::datasets::test::text_of(entry.path() / "stat");
      const std::size_t name_end = stat.rfind(')');
      if (name_end == std::string::npos) continue;
      char state = 0;
      int of = 0;
      if (std::sscanf(stat.c_str() + name_end + 1, " %c %d", &state, &of) == 2 && of == parent) {
        found.push_back(static_cast<pid_t>(std::atoi(stat.c_str())));
      }
    }
    return found;
  }

  Plan plan_;
  SeededRandom random_;
  fs::path folder_;
  double usual_ = 0.0;  ///< s
  int struck_ = 0;
  int runs_ = 0;
  std::string history_;
};

}  // namespace

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("datasets_batch_kill", [&] {
    Plan plan;
    tools::ProgramOptions options("datasets_batch_kill", "Kills batches at random moments and resumes them.",
                                  "Exit status 1: an output differs from that of an undisturbed run.");
    options.text("PROGRAM", plan.program, "The program exactvo", true);
    options.whole_number("KILLS", plan.kills, 1, "That must strike a running batch");
    options.whole_number("SEED", plan.seed, 0, "Of the moments");
    options.whole_number("RANKS", plan.ranks, 1, "Above 1: under mpirun, one rank killed at a time");
    options.whole_number("STARS", plan.stars, 1, "Obstacles of a batch");
    if (!options.parse(argc, argv)) return 0;
    return Campaign(plan).run() ? 0 : 1;
  });
}
