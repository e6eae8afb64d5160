// SPDX-License-Identifier: GPL-3.0-or-later
// The arena: every solver on every set. First each answer is compared with the certified one, then all are timed,
// interleaved, in thread CPU time; the table gives ns a solve and the ratio to `textbook`.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "adversarial.h"
#include "competitor.h"
#include "cpu_time.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo_commit.h"
#include "interval.h"
#include "lp/sets/generated_sets.h"
#include "lp/sets/target.h"
#include "options/program_options.h"
#include "problem_file.h"
#include "recorded.h"
#include "results.h"
#include "violation.h"

namespace exactvo::bench {
namespace {

constexpr int kRounds = 11;
/// Velocities farther from the exact ones than this, m/s, are counted as inaccurate: float carries 2^-24 of 2 m/s, a
/// sharp vertex 100 times.
constexpr double kInaccurate = 1e-4;

struct Flags {
  std::string sets = "C10,C10f,C10i,C50,RF10,RF20,RI10,RI20,RI50";
  std::string instances;        ///< file: the sets "file", "filef", "filei", which are all sets unless some are named
  std::string json;             ///< file for Google Benchmark's compare.py
  std::string target;           ///< widest SIMD target to run on ("AVX3", "AVX2", "SSE4"), "" for the best
  std::size_t adversarial = 0;  ///< problems a family and perturbation
  bool table = false;           ///< the figures to reach and what was measured, from the sets they need
  std::uint64_t seed = 1;
  std::size_t problems = 32768;  ///< of a set that is recorded or made: a branch predictor learns a small one
  int rounds = kRounds;
  std::size_t part = 2048;  ///< lines that are laid out just before they are timed
};

/// The target of the entry, or the one forced on all that have none of their own.
std::string forced_target;
bool limit_target(const Entry& entry) {
  return lp::limit_batch_target(entry.target.empty() ? forced_target.c_str() : entry.target.c_str());
}

struct Truth {
  std::vector<lp::Solution> solutions;
  std::size_t exact_stage = 0;
};

Truth certified(const std::vector<lp::Problem>& problems) {
  Truth truth;
  for (const lp::Problem& p : problems) {
    const lp::Proven proven = lp::solve_certified(p);
    truth.exact_stage += proven.exact_stage;
    truth.solutions.push_back(proven.solution);
  }
  return truth;
}

bool is_feasible(const lp::Solution& s) {
  return s.status == lp::Status::optimal || s.status == lp::Status::no_interior;
}

/// The problems of --instances, as a set.
constexpr const char* kFile = "file";

bool has_parts(const std::string& name) {
  return name == kFile || is_recorded_set(name);
}

/// "C10f": the feasible part of "C10"; nothing to do for other names.
char part_of(std::string& name) {
  const char last = name.empty() ? ' ' : name.back();
  if ((last != 'f' && last != 'i') || !has_parts(name.substr(0, name.size() - 1))) return ' ';
  name.pop_back();
  return last;
}

std::vector<lp::Problem> only(const std::vector<lp::Problem>& problems, bool feasible) {
  std::vector<lp::Problem> kept;
  const Truth truth = certified(problems);
  for (std::size_t k = 0; k < problems.size(); ++k)
    if (is_feasible(truth.solutions[k]) == feasible) kept.push_back(problems[k]);
  return kept;
}

std::vector<lp::Problem> instances_of(const std::string& file) {
  std::vector<lp::Problem> problems = read_problems(file);
  make_comparable(problems, file);
  return problems;
}

/// Recorded sets and the file are asked for whole and in parts: each is recorded, or read, once. With the table the
/// file takes the place of C10.
const std::vector<lp::Problem>& recording(const std::string& name, const Flags& flags) {
  static std::map<std::string, std::vector<lp::Problem>> recorded;
  if (recorded.count(name) > 0) return recorded[name];
  const bool is_file = name == kFile || (flags.table && name == "C10" && !flags.instances.empty());
  return recorded[name] = is_file ? instances_of(flags.instances) : record(name, flags.problems);
}

Set set_named(std::string name, const Flags& flags) {
  const std::string whole_name = name;
  const char part = part_of(name);
  std::vector<lp::Problem> problems =
      has_parts(name) ? recording(name, flags) : lp::generate(name, flags.problems, flags.seed);
  if (part != ' ') problems = only(problems, part == 'f');
  for (lp::Problem& p : problems) sort_hard_first(p);
  return {whole_name, problems};
}

/// Before anything is recorded or timed, which takes minutes. Throws std::runtime_error.
void require_known(std::string name, const Flags& flags) {
  part_of(name);
  if (name == kFile && flags.instances.empty()) throw std::runtime_error("the set \"file\" takes --instances FILE");
  if (has_parts(name)) return;
  try {
    lp::generate(name, 0, flags.seed);
  } catch (const std::logic_error& unknown) {
    throw std::runtime_error(std::string(unknown.what()) +
                             "; or recorded here, Cm or Bm, m of 5, 10, 20, 50, 100; or, with --instances, file; of "
                             "these the feasible or infeasible part, as in C10f, C10i, filef");
  }
}

std::vector<std::string> names_of(const Flags& flags) {
  std::vector<std::string> names;
  std::stringstream text(flags.sets);
  for (std::string name; std::getline(text, name, ',');) names.push_back(name);
  return names;
}

bool names_the_file(const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [](std::string name) {
    part_of(name);
    return name == kFile;
  });
}

/// Throws std::runtime_error for sets that are none, and for a file that none of them would be taken from.
void require_known_sets(const Flags& flags) {
  const std::vector<std::string> names = names_of(flags);
  if (names.empty()) throw std::runtime_error("--sets names no set");
  for (const std::string& name : names) require_known(name, flags);
  if (!flags.instances.empty() && !flags.table && !names_the_file(names))
    throw std::runtime_error("--sets names none of " + flags.instances +
                             ": add file, filef or filei, or leave --sets "
                             "out for these three (C10f and the like are recorded here)");
}

std::vector<Set> sets_of(const Flags& flags) {
  std::vector<Set> sets;
  for (const std::string& name : names_of(flags)) sets.push_back(set_named(name, flags));
  return sets;
}

/// One competitor on one set.
struct Run {
  Entry entry;
  std::vector<std::size_t> problems;       ///< that it is given, by their numbers in the set
  std::unique_ptr<Competitor> competitor;  ///< built on all of them
  std::vector<double> times;               ///< ns a solve, one a round
  std::size_t wrong = 0;                   ///< verdicts
  double worst_violation = 0.0;  ///< m/s, in exact arithmetic, of answers rightly called feasible, the disc's too
  std::size_t inaccurate = 0;
};

/// What a solver throws, by its name.
void solve(const Entry& entry, Competitor& competitor) {
  try {
    competitor.run();
  } catch (const std::exception& error) {
    throw std::runtime_error("the solver " + entry.name + " threw: " + error.what());
  } catch (...) {
    throw std::runtime_error("the solver " + entry.name + " threw what is no std::exception");
  }
}

void compare(const std::vector<lp::Problem>& problems, const Truth& truth, Run& run) {
  limit_target(run.entry);
  solve(run.entry, *run.competitor);
  for (std::size_t k = 0; k < run.problems.size(); ++k) {
    const std::size_t i = run.problems[k];
    const Answer answer = run.competitor->answer(k);
    const bool feasible = is_feasible(truth.solutions[i]);
    run.wrong += answer.feasible != feasible;
    if (!feasible || !answer.feasible || run.entry.rules.has_box) continue;
    run.inaccurate += !(norm(answer.velocity - truth.solutions[i].velocity) <= kInaccurate);
    run.worst_violation = std::max(run.worst_violation, worst_breach(problems[i], answer.velocity));
  }
}

/// What reading the clock adds to a time.
double clock_nanoseconds() {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 1000; ++k) {
    const double before = thread_nanoseconds();
    least = std::min(least, thread_nanoseconds() - before);
  }
  return least;
}

/// Problems of a batch that leave no register of any target half empty.
constexpr std::size_t kWhole = 16;

/// A part of the set at a time, which the solver gets in its own layout as it was just written: what is compared is
/// solving, not the machine's memory. A simulation writes its half-planes just before it solves, too.
void time_once(const std::vector<lp::Problem>& problems, Run& run, std::size_t lines, double of_clock) {
  limit_target(run.entry);
  double all = 0.0;
  for (std::size_t k = 0; k < run.problems.size();) {
    std::vector<lp::Problem> part;
    for (std::size_t left = lines; k < run.problems.size() && (left > 0 || part.size() % kWhole != 0); ++k) {
      part.push_back(problems[run.problems[k]]);
      left -= std::min(left, std::max<std::size_t>(1, part.back().constraints.size()));
    }
    const std::unique_ptr<Competitor> competitor = run.entry.build(part);
    const double before = thread_nanoseconds();
    solve(run.entry, *competitor);
    all += thread_nanoseconds() - before - of_clock;
  }
  run.times.push_back(all / static_cast<double>(run.problems.size()));
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

/// How many times as fast as the textbook, round by round: what slows a round down slows both.
std::vector<double> ratios_of(const Run& run, const Run& textbook) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < run.times.size(); ++k) ratios.push_back(textbook.times[k] / run.times[k]);
  return ratios;
}

std::vector<Run> enter(const Set& set, const Truth& truth) {
  std::vector<Run> runs;
  const bool all_feasible =
      std::all_of(truth.solutions.begin(), truth.solutions.end(), [](const auto& s) { return is_feasible(s); });
  for (Entry& entry : entries()) {
    if ((entry.rules.feasible_only && !all_feasible) || !limit_target(entry)) continue;
    Run run;
    run.entry = entry;
    std::vector<lp::Problem> given;
    const std::size_t all = set.problems.size(), count = std::min(all, entry.rules.most);
    for (std::size_t k = 0; k < count; ++k) {
      run.problems.push_back(k * all / count);
      given.push_back(set.problems[run.problems.back()]);
    }
    run.competitor = entry.build(given);
    runs.push_back(std::move(run));
  }
  return runs;
}

void print(const Set& set, const Truth& truth, const std::vector<Run>& runs) {
  const auto feasible = std::count_if(truth.solutions.begin(), truth.solutions.end(), is_feasible);
  std::printf("\n%s: %zu problems, %td feasible, %zu by the exact stage\n", set.name.c_str(), set.problems.size(),
              feasible, truth.exact_stage);
  std::printf("  %-20s %10s %16s %9s %13s %8s %7s %10s %11s\n", "solver", "ns/solve", "p10-p90", "x textbook", "95 %",
              "problems", "wrong", "inaccurate", "violation");
  for (const Run& run : runs) {
    const std::vector<double> ratios = ratios_of(run, runs.front());
    const Interval interval = interval_of_median(ratios);
    std::printf("  %-20s %10.1f %7.1f-%8.1f %9.2f %6.2f-%6.2f %8zu %7zu ", run.entry.name.c_str(),
                quantile(run.times, 0.5), quantile(run.times, 0.1), quantile(run.times, 0.9), quantile(ratios, 0.5),
                interval.low, interval.high, run.problems.size(), run.wrong);
    if (run.entry.rules.has_box)
      std::printf("%10s %11s\n", "-", "-");
    else
      std::printf("%10zu %11.2g\n", run.inaccurate, run.worst_violation);
  }
  std::fflush(stdout);
}

void add_json(const Set& set, const std::vector<Run>& runs, nlohmann::json& out) {
  for (const Run& run : runs) {
    const double median = quantile(run.times, 0.5);
    const std::vector<double> ratios = ratios_of(run, runs.front());
    out["benchmarks"].push_back({{"name", set.name + "/" + run.entry.name},
                                 {"run_name", set.name + "/" + run.entry.name},
                                 {"run_type", "iteration"},
                                 {"repetitions", 1},
                                 {"repetition_index", 0},
                                 {"threads", 1},
                                 {"iterations", run.times.size() * run.problems.size()},
                                 {"real_time", median},
                                 {"cpu_time", median},
                                 {"time_unit", "ns"},
                                 {"p10", quantile(run.times, 0.1)},
                                 {"p90", quantile(run.times, 0.9)},
                                 {"ratio_to_textbook", quantile(ratios, 0.5)},
                                 {"ratios", ratios},
                                 {"problems", run.problems.size()},
                                 {"wrong_verdicts", run.wrong},
                                 {"only_verdicts", run.entry.rules.has_box},
                                 {"inaccurate", run.inaccurate},
                                 {"worst_violation", run.worst_violation}});
  }
}

void add_json(const std::vector<FigureRow>& rows, nlohmann::json& out) {
  out["figures"] = nlohmann::json::array();
  for (const FigureRow& row : rows)
    out["figures"].push_back({{"what", row.what},
                              {"reach", row.reach},
                              {"measured", row.measured},
                              {"at_most", row.at_most},
                              {"reached", row.reached()}});
}

/// "AMD EPYC 9B45"; empty where the system does not say.
std::string processor() {
  std::ifstream facts("/proc/cpuinfo");
  for (std::string line; std::getline(facts, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(": ") + 2);
  return "";
}

/// The mean number of processes that wanted to run in the last minute: figures of a busy machine are not those of a
/// quiet one.
double load() {
  std::ifstream facts("/proc/loadavg");
  double mean = 0.0;
  facts >> mean;
  return mean;
}

nlohmann::json context(const Flags& flags) {
  lp::limit_batch_target(flags.target.c_str());
  return {{"cpu", processor()},
          {"cpus", std::thread::hardware_concurrency()},
          {"load_at_start", load()},
          {"executable", "bench_lp"},
          {"library_build_type", "release"},
          {"compiler", __VERSION__},
          {"simd_target", lp::batch_target()},
          {"commit", EXACTVO_COMMIT},
          {"instances", flags.instances},
          {"seed", flags.seed},
          {"rounds", flags.rounds},
          {"part", flags.part},
          {"clock", "thread CPU time, median of the rounds, solvers interleaved"}};
}

bool disagrees(const std::vector<Run>& runs) {
  return std::any_of(runs.begin(), runs.end(), [](const Run& r) { return r.entry.rules.exact && r.wrong > 0; });
}

void add_results(const Set& set, const Truth& truth, const std::vector<Run>& runs, Results& results) {
  for (const Run& run : runs) results.ns[set.name][run.entry.name] = quantile(run.times, 0.5);
  results.exact_share[set.name] = static_cast<double>(truth.exact_stage) / static_cast<double>(set.problems.size());
}

/// The file of --json, opened before minutes are spent on what it is to hold. Throws std::runtime_error.
class JsonFile {
 public:
  explicit JsonFile(std::string path) : path_(std::move(path)) {
    if (path_.empty()) return;
    out_.open(path_);
    require_good();
  }
  void write(const nlohmann::json& results) {
    if (path_.empty()) return;
    out_ << results.dump(2) << '\n' << std::flush;
    require_good();
  }

 private:
  void require_good() const {
    if (!out_) throw std::runtime_error(path_ + ": found no file that can be written, expected one");
  }

  std::string path_;
  std::ofstream out_;
};

int adversarial(const Flags& flags) {
  JsonFile file(flags.json);
  bool wrong = false;
  file.write({{"context", context(flags)}, {"adversarial", run_adversarial(flags.adversarial, flags.seed, wrong)}});
  return wrong ? 1 : 0;
}

int arena(const Flags& flags) {
  forced_target = flags.target;
  if (flags.adversarial > 0) return adversarial(flags);
  JsonFile file(flags.json);
  Results results;
  nlohmann::json out = {{"context", context(flags)}, {"benchmarks", nlohmann::json::array()}};
  std::printf("%s\n", out["context"].dump().c_str());
  bool sound = true;
  const double of_clock = clock_nanoseconds();
  const std::vector<Set> sets = sets_of(flags);
  if (std::all_of(sets.begin(), sets.end(), [](const Set& set) { return set.problems.empty(); }))
    throw std::runtime_error("found no problem in " + flags.sets + ", expected one or more");
  for (const Set& set : sets) {
    if (set.problems.empty()) {
      std::printf("\n%s: no problems\n", set.name.c_str());
      continue;
    }
    const Truth truth = certified(set.problems);
    std::vector<Run> runs = enter(set, truth);
    for (Run& run : runs) compare(set.problems, truth, run);
    for (int round = 0; round < flags.rounds; ++round)
      for (Run& run : runs) time_once(set.problems, run, flags.part, of_clock);
    print(set, truth, runs);
    add_json(set, runs, out);
    add_results(set, truth, runs, results);
    sound = sound && !disagrees(runs);
  }
  if (flags.table) {
    const std::vector<FigureRow> rows = figures_of(results);
    print_figures(rows);
    add_json(rows, out);
  }
  file.write(out);
  return sound ? 0 : 1;
}

void use_table(Flags& flags) {
  flags.table = true;
  flags.sets.clear();
  for (const std::string& set : sets_of_figures()) flags.sets += (flags.sets.empty() ? "" : ",") + set;
}

constexpr const char* kFooter =
    "FILE holds lines of JSON, CSV or binary instances, as `exactvo lp` reads them, of problems with a disc. It is "
    "the\n"
    "sets file, filef, filei: whole, and its feasible and infeasible part; these three alone are run unless --sets\n"
    "names some. With --table it takes the place of C10.\n"
    "Times in thread CPU time, of problems just laid out (--part). `wrong` counts verdicts that are not the exact\n"
    "ones, `inaccurate` velocities more than 1e-4 m/s from the exact one, `violation` is the worst of a line or the\n"
    "disc by a feasible answer, in exact arithmetic; `-` where a solver takes the box round the disc. The status is 1\n"
    "if a solver that says that it is exact has a wrong verdict, whatever others have.\n"
    "docs/guide/linear-program.md says what the sets and solvers are.";

/// Lists the SIMD targets that both this build and this machine have.
[[noreturn]] void refuse_target(const std::string& target) {
  std::string known;
  for (const char* name : {"AVX3_SPR", "AVX3_ZEN4", "AVX3_DL", "AVX3", "AVX2", "SSE4", "SSSE3", "SSE2", "SVE2_128",
                           "SVE_256", "SVE2", "SVE", "NEON", "PPC10", "PPC9", "PPC8", "WASM", "RVV", "EMU128"})
    if (lp::limit_batch_target(name)) known += std::string(known.empty() ? "" : ", ") + name;
  throw std::runtime_error("no such target: " + target + "; expected one of " + known);
}

/// False where help was asked for.
bool read_flags(int argc, char** argv, Flags& flags) {
  tools::ProgramOptions options("bench_lp", "Which solver of the small linear program is right, and which is fast?",
                                kFooter);
  bool table = false;
  options.flag("--table", table, "The figures to reach and what was measured, from the sets they need");
  options.text("--sets", flags.sets, "Names of sets, with commas between");
  options.text("--instances", flags.instances, "A file of problems");
  options.text("--target", flags.target, "The widest SIMD target to run on (AVX3, AVX2, SSE4)");
  options.text("--json", flags.json, "A file for the results");
  options.whole_number("--adversarial", flags.adversarial, 1, "Problems per family and perturbation; nothing is timed");
  options.whole_number("--seed", flags.seed, 0, "Of the generated sets");
  options.whole_number("--problems", flags.problems, 1, "Of a set that is recorded or made, at most");
  options.whole_number("--rounds", flags.rounds, 1, "Timed passes over a set");
  options.whole_number("--part", flags.part, 1, "Lines of problems that are laid out just before they are timed");
  if (!options.parse(argc, argv)) return false;
  const bool sets_given = options.given("--sets");
  if (sets_given && table) throw std::runtime_error("--table has its own sets: leave --sets out");
  if (table) use_table(flags);
  if (!lp::limit_batch_target(flags.target.c_str())) refuse_target(flags.target);
  if (!flags.instances.empty() && !table && !sets_given) flags.sets = "file,filef,filei";
  require_known_sets(flags);
  return true;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  return exactvo::tools::run_program("bench_lp", [&] {
    exactvo::bench::Flags flags;
    return exactvo::bench::read_flags(argc, argv, flags) ? exactvo::bench::arena(flags) : 0;
  });
}
