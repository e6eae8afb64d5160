// SPDX-License-Identifier: GPL-3.0-or-later
#include "table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <stdexcept>
#include <vector>

namespace exactvo::bench {
namespace {

struct Rate {
  double steps = 0.0;  ///< a second of CPU time
  std::string label;
};

std::string quoted(const std::string& word) {
  return "'" + std::regex_replace(word, std::regex("'"), "'\\''") + "'";
}

/// A pattern that matches the name of a benchmark, which may have a plus.
std::string as_regex(const std::string& name) {
  return std::regex_replace(name, std::regex("[+]"), "[+]");
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t got = fread(part.data(), 1, part.size(), pipe.get())) text.append(part.data(), got);
  return text;
}

/// The benchmarks that a program has, "ivo/A1" and so on, in its order.
std::vector<std::string> names_in(const std::string& program, const TableOptions& options) {
  const std::regex wanted(as_regex(options.method) + "/" +
                          (options.scenes.empty() ? "[^/]*" : "(" + options.scenes + ")"));
  std::vector<std::string> names;
  std::string listed = output_of(quoted(program) + " --benchmark_list_tests=true 2>/dev/null");
  for (std::size_t end = 0; (end = listed.find('\n')) != std::string::npos; listed.erase(0, end + 1))
    if (const std::string name = listed.substr(0, end); std::regex_match(name, wanted)) names.push_back(name);
  if (names.empty()) throw std::runtime_error(program + " has no such benchmark");
  return names;
}

/// How fast a run with its metrics is, which is what the verb `simulate` does before it writes. Nothing where the
/// program lacks it.
std::optional<Rate> rate_of(const std::string& program, const std::string& name, double duration) {
  const std::string cut = duration > 0.0 ? fmt::format(" --duration={}", duration) : "";
  const std::string text = output_of(quoted(program) + cut + " --benchmark_format=json --benchmark_min_time=0.2 " +
                                     quoted("--benchmark_filter=^" + as_regex(name) + "/measured$") + " 2>/dev/null");
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("benchmarks", nlohmann::json::array()).empty()) return std::nullopt;
  const nlohmann::json& row = json["benchmarks"][0];
  return Rate{row.value("robot_steps", 0.0), row.value("label", "")};
}

/// What the rounds of a scene gave: a second of CPU time, and of each round the ratio.
struct Rounds {
  std::vector<double> now, before, ratio;
  bool same = true;  ///< the runs
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

Rounds rounds_of(const std::string& name, const TableOptions& options) {
  Rounds all;
  for (int round = 0; round < options.rounds; ++round) {
    const std::optional<Rate> now = rate_of(options.self, name, options.duration);
    if (!now) throw std::runtime_error(options.self + " gave nothing for " + name);
    all.now.push_back(now->steps);
    if (options.against.empty()) continue;
    const std::optional<Rate> before = rate_of(options.against, name, options.duration);
    if (!before) return all;
    all.before.push_back(before->steps);
    all.ratio.push_back(now->steps / before->steps);
    all.same = all.same && now->label == before->label;
  }
  return all;
}

std::string cpu() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace

void print_table(const TableOptions& options) {
  const bool both = !options.against.empty();
  fmt::print("CPU: {}\n\n", cpu());
  fmt::print("{}",
             both ? "| scene | before [robot steps/s] | now [robot steps/s] | ratio | runs |\n|---|---|---|---|---|\n"
                  : "| scene | [robot steps/s] |\n|---|---|\n");
  for (const std::string& name : names_in(options.self, options)) {
    const Rounds rounds = rounds_of(name, options);
    const double now = quantile(rounds.now, 0.5);
    const std::string scene = name.substr(name.find('/') + 1);
    if (!both) {
      fmt::print("| {} | {:.0f} |\n", scene, now);
    } else if (rounds.ratio.empty()) {
      fmt::print("| {} | - | {:.0f} | - | - |\n", scene, now);
    } else {
      fmt::print("| {} | {:.0f} | {:.0f} | {:.3g} ({:.3g} to {:.3g}) | {} |\n", scene, quantile(rounds.before, 0.5),
                 now, quantile(rounds.ratio, 0.5), quantile(rounds.ratio, 0.25), quantile(rounds.ratio, 0.75),
                 rounds.same ? "the same bits" : "differ");
    }
    std::fflush(stdout);
  }
}

}  // namespace exactvo::bench
