// SPDX-License-Identifier: GPL-3.0-or-later
// Do many robots arrive, how soon, and what have others published about the same scenes?
//
//   bench_arena --out arena                                  # everything: half an hour on two cores
//   bench_arena --suite circle --suite street --out arena    # some; goes on where it was stopped
//   bench_arena --quick --out arena                          # a minute
//   bench_arena --peer rvo2=./arena_rvo2 --out arena         # beside another program (peer.h)
//
// Writes results.csv, one line per run as soon as it is over, and index.html.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <tuple>

#include "exactvo/datasets/provenance.h"
#include "options/program_options.h"
#include "page.h"
#include "route_maps.h"

namespace exactvo::bench {
namespace {

namespace fs = std::filesystem;

struct Asked {
  std::string out, routes;
  std::vector<std::string> suites, methods, peers;
  std::size_t jobs = 0, seeds = 0, first_seed = 1;
  bool quick = false;
};

/// Which run: suite, scene, seed, method.
using Key = std::tuple<std::string, std::string, std::uint64_t, std::string>;

struct Job {
  Key key;
  std::function<std::optional<RunResult>()> run;  ///< empty: interrupted
};

Key key_of(const RunResult& r) {
  return {r.suite, r.scene, r.seed, r.method};
}

std::atomic<bool> is_interrupted{false};

/// "a, b, c".
std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void require_known(const std::string& option, const std::vector<std::string>& asked,
                   const std::vector<std::string>& known) {
  for (const std::string& word : asked)
    if (std::find(known.begin(), known.end(), word) == known.end())
      throw std::runtime_error(option + ": found '" + word + "', expected one of " + listed(known));
}

std::vector<ArenaMethod> methods_of(const Asked& asked) {
  require_known("--method", asked.methods, own_methods());
  std::vector<ArenaMethod> methods;
  for (const std::string& name : own_methods())
    if (asked.methods.empty() || std::find(asked.methods.begin(), asked.methods.end(), name) != asked.methods.end())
      methods.push_back({name});
  for (const std::string& peer : asked.peers) {
    const std::size_t equals = peer.find('=');
    const std::string name = peer.substr(0, equals);
    const bool is_plain = !name.empty() && name != "route" && name.find_first_of(",\n\"") == std::string::npos;
    if (equals == std::string::npos || equals + 1 == peer.size() || !is_plain)
      throw std::runtime_error("--peer: found '" + peer + "', expected NAME=PROGRAM");
    if (std::any_of(methods.begin(), methods.end(), [&](const ArenaMethod& m) { return m.name == name; }))
      throw std::runtime_error("--peer: the name '" + name + "' is taken, expected another");
    methods.push_back({name, peer.substr(equals + 1)});
  }
  return methods;
}

bool is_asked_for(const std::string& suite, const Asked& asked) {
  return asked.suites.empty() || std::find(asked.suites.begin(), asked.suites.end(), suite) != asked.suites.end();
}

std::vector<Job> jobs_of(const Asked& asked, const std::vector<ArenaMethod>& methods) {
  std::vector<std::string> known = suite_names();
  known.emplace_back(kRoutesSuite);
  require_known("--suite", asked.suites, known);
  const Extent extent = asked.quick ? Extent::quick : Extent::full;
  Draws draws;
  draws.first = asked.first_seed;
  if (asked.seeds > 0) draws.count = asked.seeds;
  std::vector<Job> jobs;
  for (const std::string& suite : suite_names()) {
    if (!is_asked_for(suite, asked)) continue;
    for (const Scene& scene : scenes_of(suite, extent, draws))
      for (const ArenaMethod& method : methods)
        jobs.push_back(
            {{suite, scene.name, scene.seed, method.name}, [=] { return run_scene(scene, method, is_interrupted); }});
  }
  if (asked.routes.empty() && !asked.suites.empty() && is_asked_for(kRoutesSuite, asked))
    throw std::runtime_error("--suite routes takes --routes FOLDER");
  if (!asked.routes.empty() && is_asked_for(kRoutesSuite, asked))
    for (const RouteProblems& problems : route_problems_in(asked.routes, extent))
      jobs.push_back({{kRoutesSuite, problems.scene(), 1, "route"}, [=] { return run_routes(problems); }});
  return jobs;
}

std::string builder_of(const datasets::Provenance& p) {
  return "# ExactVO " + p.version + " " + p.commit + " " + p.build_type;
}

/// results.csv: what is there already, and lines for what is new.
class Results {
 public:
  Results(const fs::path& file, const std::string& builder) {
    std::ifstream in(file);
    std::string line;
    if (std::getline(in, line)) {
      if (line != builder)
        throw std::runtime_error(file.string() + ": found results of '" + line + "', expected '" + builder +
                                 "'; name another folder");
      std::getline(in, line);  // the header
      for (bool whole = true; whole && std::getline(in, line);) {
        whole = !in.eof();  // the last one may have been cut off
        if (whole) all_.push_back(parsed(line));
      }
    }
    in.close();
    out_.open(file, std::ios::trunc);
    out_ << builder << '\n' << csv_header();
    for (const RunResult& r : all_) out_ << csv_line(r);
    if (!out_.flush()) throw std::runtime_error(file.string() + ": cannot be written");
  }

  void add(RunResult r) {
    out_ << csv_line(r);
    if (!out_.flush()) throw std::runtime_error("results.csv cannot be written");
    all_.push_back(std::move(r));
  }
  const std::vector<RunResult>& all() const { return all_; }

 private:
  std::vector<RunResult> all_;
  std::ofstream out_;
};

void print_progress(const RunResult& r, std::size_t done, std::size_t all, double seconds) {
  std::fprintf(stderr, "%zu of %zu, %.0f s: %s, %s, seed %llu, %s: %s\n", done, all, seconds, r.suite.c_str(),
               r.scene.c_str(), static_cast<unsigned long long>(r.seed), r.method.c_str(),
               r.success              ? "success"
               : r.collisions > 0     ? "collisions"
               : r.arrived < r.robots ? "not all arrived"
                                      : "not a success");
}

/// Runs the jobs in their order, some at a time.
void run_all(const std::vector<Job>& jobs, std::size_t threads, Results& results) {
  const auto start = std::chrono::steady_clock::now();
  std::mutex mutex;
  std::size_t next = 0, done = 0;
  std::exception_ptr error;
  const auto work = [&] {
    for (;;) {
      std::unique_lock<std::mutex> lock(mutex);
      if (next == jobs.size() || error || is_interrupted) return;
      const Job& job = jobs[next++];
      lock.unlock();
      try {
        const std::optional<RunResult> r = job.run();
        if (!r) return;
        lock.lock();
        results.add(*r);
        print_progress(*r, ++done, jobs.size(),
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      } catch (...) {
        if (!lock.owns_lock()) lock.lock();
        if (!error) error = std::current_exception();
      }
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t k = 0; k < threads; ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  if (error) std::rethrow_exception(error);
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "an unknown processor";
}

int run(const Asked& asked, const std::vector<std::string>& command_line) {
  constexpr int kStopped = 130;
  const std::vector<ArenaMethod> methods = methods_of(asked);
  const std::vector<Job> wanted = jobs_of(asked, methods);
  const datasets::Provenance made_by = datasets::make_provenance(command_line, 0);
  const fs::path folder(asked.out);
  fs::create_directories(folder);
  Results results(folder / "results.csv", builder_of(made_by));
  std::set<Key> known;
  for (const RunResult& r : results.all()) known.insert(key_of(r));
  std::vector<Job> jobs;
  for (const Job& job : wanted)
    if (known.count(job.key) == 0) jobs.push_back(job);
  std::signal(SIGINT, [](int) { is_interrupted = true; });
  std::signal(SIGTERM, [](int) { is_interrupted = true; });
  const std::size_t threads = asked.jobs > 0 ? asked.jobs : std::max(1u, std::thread::hardware_concurrency());
  run_all(jobs, threads, results);

  std::vector<std::string> names;
  for (const ArenaMethod& method : methods) names.push_back(method.name);
  names.emplace_back("route");
  std::vector<RunResult> shown;
  std::set<Key> keys;
  for (const Job& job : wanted) keys.insert(job.key);
  for (const RunResult& r : results.all())
    if (keys.count(key_of(r)) > 0) shown.push_back(r);
  std::ofstream page(folder / "index.html");
  write_page(
      page, shown, names,
      {made_by.version, made_by.commit, made_by.build_type, processor(), threads, shown.size() == wanted.size()});
  if (!page.flush()) throw std::runtime_error((folder / "index.html").string() + ": cannot be written");
  const auto successes = std::count_if(shown.begin(), shown.end(), [](const RunResult& r) { return r.success; });
  std::printf("%zu runs, %zu of them successes: %s\n", shown.size(), static_cast<std::size_t>(successes),
              (folder / "index.html").c_str());
  return is_interrupted ? kStopped : 0;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("bench_arena", [&] {
    bench::Asked asked;
    tools::ProgramOptions options(
        "bench_arena", "Do many robots arrive, how soon, and what have others published about the same scenes?",
        "Writes results.csv and index.html; goes on where it was stopped.");
    options.text("--out", asked.out, "Folder of the results", true);
    options.texts("--suite", asked.suites, "Only these suites");
    options.texts("--method", asked.methods, "Only these methods: plan, bias, orca");
    options.texts("--peer", asked.peers, "NAME=PROGRAM: another program beside ours (bench/arena/peer.h)");
    options.text("--routes", asked.routes,
                 "Folder of Moving AI maps with lengths, NAME.map and NAME.lengths.tsv: suite routes");
    options.whole_number("--seeds", asked.seeds, 1, "Draws of each random scene");
    options.whole_number("--first-seed", asked.first_seed, 1, "Seed of the first draw; 1 unless given");
    options.whole_number("--jobs", asked.jobs, 1, "Runs at a time");
    options.flag("--quick", asked.quick, "A few small scenes of each suite");
    if (!options.parse(argc, argv)) return 0;
    return bench::run(asked, std::vector<std::string>(argv, argv + argc));
  });
}
