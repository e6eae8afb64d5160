// SPDX-License-Identifier: GPL-3.0-or-later
// lp_report ARENA.json ADVERSARIAL.json FOLDER: what `bench_lp --json` wrote, as a page with three pictures: time
// against the number of lines, wrong verdicts against the perturbation, and a performance profile (Dolan and More
// 2002).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace exactvo::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// ns a solve by set and solver.
using Times = std::map<std::string, std::map<std::string, double>>;

/// Competitors that answer another question, or a part of it, are left out of the profile.
const std::set<std::string> kPartial = {"cgal-qp-Gmpzf", "glpk"};
/// A logarithmic axis has no zero: shares of wrong verdicts below this are drawn here.
constexpr double kLeastShare = 1e-6;

json read(const char* file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(std::string("cannot read ") + file);
  return json::parse(in);
}

std::ofstream open(const fs::path& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  return out;
}

Times times_of(const json& arena) {
  Times times;
  for (const json& row : arena.at("benchmarks")) {
    const std::string name = row.at("name");
    const std::size_t slash = name.find('/');
    times[name.substr(0, slash)][name.substr(slash + 1)] = row.at("cpu_time");
  }
  return times;
}

std::set<std::string> solvers_of(const Times& times) {
  std::set<std::string> solvers;
  for (const auto& [set, row] : times)
    for (const auto& [solver, ns] : row) solvers.insert(solver);
  return solvers;
}

const char* colour(std::size_t i) {
  constexpr const char* kColours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#555555"};
  return kColours[i % std::size(kColours)];
}

/// A curve a solver: `points` gives lines of "x y".
struct Curve {
  std::string label;
  std::string points;
};

void draw(const fs::path& folder, const std::string& name, const std::string& setup, const std::vector<Curve>& curves) {
  std::ofstream data = open(folder / (name + ".dat"));
  std::ofstream script = open(folder / (name + ".gp"));
  script << "set terminal svg size 900,520 font 'sans,13' background 'white'\nset output '" << name << ".svg'\n"
         << "set key outside right\nset grid lc rgb '#dddddd'\n"
         << setup << "plot";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    data << "# " << curves[i].label << '\n' << curves[i].points << "\n\n";
    script << (i == 0 ? " " : ", ") << "'" << name << ".dat' index " << i << " with linespoints pt " << 4 + i % 9
           << " ps 0.7 lw 2 lc rgb '" << colour(i) << "'" << (i >= 7 ? " dt 2" : "") << " title '" << curves[i].label
           << "'";
  }
  script << '\n';
  script.close();
  data.close();
  const std::string command = "cd '" + folder.string() + "' && gnuplot " + name + ".gp";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("gnuplot failed on " + name + ".gp");
}

/// The set "<kind><m>" with the smallest and larger m.
std::map<int, std::string> sets_by_lines(const Times& times, const std::string& kind) {
  std::map<int, std::string> sets;
  for (const auto& [set, row] : times) {
    if (set.rfind(kind, 0) != 0) continue;
    const std::string digits = set.substr(kind.size());
    if (!digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos) sets[std::stoi(digits)] = set;
  }
  return sets;
}

void draw_times(const fs::path& folder, const Times& times, const std::string& kind) {
  std::vector<Curve> curves;
  for (const std::string& solver : solvers_of(times)) {
    std::ostringstream points;
    for (const auto& [m, set] : sets_by_lines(times, kind))
      if (times.at(set).count(solver) != 0) points << m << ' ' << times.at(set).at(solver) << '\n';
    if (!points.str().empty()) curves.push_back({solver, points.str()});
  }
  if (curves.empty()) return;
  draw(folder, "time-" + kind,
       "set logscale xy\nset xlabel 'lines a problem, sets " + kind + "<m>'\nset ylabel 'ns a solve'\n", curves);
}

void draw_profile(const fs::path& folder, const Times& times) {
  std::vector<Curve> curves;
  for (const std::string& solver : solvers_of(times)) {
    if (kPartial.count(solver) != 0) continue;
    std::vector<double> factors;
    for (const auto& [set, row] : times) {
      double best = row.begin()->second;
      for (const auto& [other, ns] : row)
        if (kPartial.count(other) == 0) best = std::min(best, ns);
      if (row.count(solver) != 0) factors.push_back(row.at(solver) / best);
    }
    std::sort(factors.begin(), factors.end());
    std::ostringstream points;
    for (std::size_t k = 0; k < factors.size(); ++k)
      points << factors[k] << ' ' << static_cast<double>(k + 1) / static_cast<double>(times.size()) << '\n';
    curves.push_back({solver, points.str()});
  }
  draw(folder, "profile",
       "set logscale x\nset yrange [0:1.05]\nset xlabel 'times as long as the fastest'\nset ylabel 'share of sets'\n",
       curves);
}

void draw_accuracy(const fs::path& folder, const json& adversarial) {
  std::map<std::string, std::map<double, std::pair<double, double>>> wrong;  // by solver and perturbation
  for (const json& row : adversarial.at("adversarial")) {
    const double e = std::stod(row.at("perturbation").get<std::string>());
    if (e == 0.0) continue;
    auto& [bad, all] = wrong[row.at("solver")][e];
    bad += row.at("false_infeasible").get<double>() + row.at("false_feasible").get<double>();
    all += row.at("problems").get<double>();
  }
  std::vector<Curve> curves;
  for (const auto& [solver, by_perturbation] : wrong) {
    std::ostringstream points;
    for (const auto& [e, counts] : by_perturbation)
      points << e << ' ' << std::max(kLeastShare, counts.first / counts.second) << '\n';
    curves.push_back({solver, points.str()});
  }
  draw(folder, "accuracy",
       "set logscale xy\nset format x '1e%T'\nset format y '%g'\nset yrange [5e-7:1]\nset xlabel 'perturbation'\n"
       "set ylabel 'wrong verdicts (at the bottom: none)'\n",
       curves);
}

void write_page(const fs::path& folder, const json& arena, const Times& times) {
  std::ofstream page = open(folder / "report.html");
  const std::set<std::string> solvers = solvers_of(times);
  page << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>The arena</title>\n"
       << "<style>body{font:15px sans-serif;max-width:70em;margin:2em auto}td,th{padding:.2em .6em;text-align:right}"
       << "img{display:block;margin:1em 0}</style></head><body>\n<h1>The arena of the linear program</h1>\n<p>";
  for (const auto& [key, value] : arena.at("context").items())
    page << key << ": " << (value.is_string() ? value.get<std::string>() : value.dump()) << "; ";
  page << "</p>\n<h2>Nanoseconds a solve (times as fast as the usual solver)</h2>\n<table><tr><th>set</th>";
  for (const std::string& solver : solvers) page << "<th>" << solver << "</th>";
  page << "</tr>\n";
  for (const auto& [set, row] : times) {
    page << "<tr><th>" << set << "</th>";
    for (const std::string& solver : solvers) {
      page << "<td>";
      if (row.count(solver) != 0) {
        char cell[64];
        std::snprintf(cell, sizeof cell, "%.3g (%.2f)", row.at(solver), row.at("usual") / row.at(solver));
        page << cell;
      }
      page << "</td>";
    }
    page << "</tr>\n";
  }
  page << "</table>\n<h2>Time against the number of lines</h2>\n";
  for (const char* kind : {"C", "B", "RF", "RI"})
    if (fs::exists(folder / ("time-" + std::string(kind) + ".svg")))
      page << "<img src=\"time-" << kind << ".svg\" alt=\"time against m, " << kind << "\">\n";
  page << "<h2>Wrong verdicts against the perturbation</h2>\n<img src=\"accuracy.svg\" alt=\"wrong verdicts\">\n"
       << "<h2>Performance profile</h2>\n<img src=\"profile.svg\" alt=\"performance profile\">\n</body></html>\n";
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) try {
  using namespace exactvo::bench;
  if (argc != 4) throw std::runtime_error("usage: lp_report ARENA.json ADVERSARIAL.json FOLDER");
  const std::filesystem::path folder = argv[3];
  std::filesystem::create_directories(folder);
  const json arena = read(argv[1]);
  const Times times = times_of(arena);
  for (const char* kind : {"C", "B", "RF", "RI"}) draw_times(folder, times, kind);
  draw_profile(folder, times);
  draw_accuracy(folder, read(argv[2]));
  write_page(folder, arena, times);
  return 0;
} catch (const std::exception& e) {
  std::cerr << "lp_report: " << e.what() << '\n';
  return 2;
}
