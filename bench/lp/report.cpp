// SPDX-License-Identifier: GPL-3.0-or-later
// lp_report ARENA.json ADVERSARIAL.json FOLDER: what `bench_lp --json` wrote, as a page: the ranking with its
// confidence intervals and the machine, the figures to reach, how long each solver takes and how often it is wrong,
// time against the number of lines, wrong verdicts against the perturbation, and a performance profile (Dolan and More
// 2002). A solver has one colour and dash in every picture.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "figures/figure.h"
#include "figures/gnuplot.h"
#include "interval.h"
#include "options/program_options.h"

namespace exactvo::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// ns a solve by set and solver.
using Times = std::map<std::string, std::map<std::string, double>>;

/// One solver on one set: what the page says beside its time.
struct Accuracy {
  double problems = 0.0, wrong = 0.0, inaccurate = 0.0, violation = 0.0;
  bool only_verdicts = false;

  void add(const json& row) {
    problems += row.at("problems").get<double>();
    wrong += row.at("wrong_verdicts").get<double>();
    inaccurate += row.at("inaccurate").get<double>();
    violation = std::max(violation, row.at("worst_violation").get<double>());
    only_verdicts = row.at("only_verdicts");
  }
};
using Accuracies = std::map<std::string, std::map<std::string, Accuracy>>;

/// Competitors that answer another question, or a part of it, are left out of the profile.
const std::set<std::string> kPartial = {"cgal-qp-Gmpzf", "glpk"};
/// A logarithmic axis has no zero: shares of wrong verdicts below this are drawn here.
constexpr double kLeastShare = 1e-6;

json read(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": found no file that can be read, expected one");
  try {
    return json::parse(in);
  } catch (const json::exception& error) {
    throw std::runtime_error(file + ": found no JSON (" + error.what() + "), expected results of bench_lp");
  }
}

/// Refuses a file without a list that `bench_lp` writes, with words about which file is in whose place.
void require_list(const json& file, const char* key, const std::string& name, const char* command) {
  if (file.is_object() && file.contains(key) && file.at(key).is_array()) return;
  throw std::runtime_error(std::string(name) + ": found no list \"" + key + "\", expected what `" + command +
                           "` writes (ARENA.json comes before ADVERSARIAL.json)");
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

Accuracies accuracies_of(const json& arena) {
  Accuracies all;
  for (const json& row : arena.at("benchmarks")) {
    const std::string name = row.at("name");
    const std::size_t slash = name.find('/');
    all[name.substr(0, slash)][name.substr(slash + 1)].add(row);
  }
  return all;
}

std::set<std::string> solvers_of(const Times& times) {
  std::set<std::string> solvers;
  for (const auto& [set, row] : times)
    for (const auto& [solver, ns] : row) solvers.insert(solver);
  return solvers;
}

/// How a solver is drawn, the same everywhere: a colour a family, dashes for its narrower or slower members.
struct Look {
  const char* solver;
  const char* colour;
  const char* dash;
};
constexpr Look kLooks[] = {
    {"textbook", "#555555", ""},        {"batch-double", "#0072B2", ""},  {"batch-double-AVX2", "#0072B2", " dt 2"},
    {"batch-certified", "#009E73", ""}, {"batch-float", "#E69F00", ""},   {"batch-float-AVX2", "#E69F00", " dt 2"},
    {"single", "#56B4E9", ""},          {"solve", "#56B4E9", " dt 2"},    {"certified", "#CC79A7", ""},
    {"exact", "#CC79A7", " dt 2"},      {"cgal-qp-Gmpzf", "#D55E00", ""}, {"glpk", "#D55E00", " dt 2"}};

Look look_of(const std::string& solver) {
  for (const Look& look : kLooks)
    if (solver == look.solver) return look;
  return {"", "#000000", " dt 3"};
}

/// Solvers in the order of the table above, then whatever it does not know.
std::vector<std::string> in_order(const std::set<std::string>& solvers) {
  std::vector<std::string> ordered;
  for (const Look& look : kLooks)
    if (solvers.count(look.solver) != 0) ordered.emplace_back(look.solver);
  for (const std::string& solver : solvers)
    if (std::find(ordered.begin(), ordered.end(), solver) == ordered.end()) ordered.push_back(solver);
  return ordered;
}

/// A curve a solver: `points` gives lines of "x y".
struct Curve {
  std::string label;
  std::string points;
};

void draw(const fs::path& folder, const std::string& name, const std::string& setup, const std::vector<Curve>& curves) {
  tools::Figure figure{name, "", "The arena of the linear program: " + name + ".", {900, 520}, ""};
  tools::PlotCommand plot;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Look look = look_of(curves[i].label);
    figure.data += "# " + tools::commented(curves[i].label) + '\n' + curves[i].points + "\n\n";
    plot.data(
        static_cast<int>(i),
        "with linespoints pt " + std::to_string(4 + i % 9) + " ps 0.7 lw 2 lc rgb '" + look.colour + "'" + look.dash,
        curves[i].label);
  }
  figure.body = "set key outside right\nset grid lc rgb '#dddddd'\n" + setup + plot.text();
  tools::draw({tools::write_sources(figure, folder)});
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
  for (const std::string& solver : in_order(solvers_of(times))) {
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
  for (const std::string& solver : in_order(solvers_of(times))) {
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
  std::set<std::string> solvers;
  for (const auto& [solver, counts] : wrong) solvers.insert(solver);
  std::vector<Curve> curves;
  for (const std::string& solver : in_order(solvers)) {
    std::ostringstream points;
    for (const auto& [e, counts] : wrong.at(solver))
      points << e << ' ' << std::max(kLeastShare, counts.first / counts.second) << '\n';
    curves.push_back({solver, points.str()});
  }
  draw(folder, "accuracy",
       "set logscale xy\nset format x '1e%T'\nset format y '%g'\nset yrange [5e-7:1]\nset xlabel 'perturbation'\n"
       "set ylabel 'wrong verdicts (at the bottom: none)'\n",
       curves);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void write_context(std::ostream& page, const json& context) {
  page << "<h2>Where and how</h2>\n<table class=\"facts\">\n";
  for (const auto& [key, value] : context.items())
    page << "<tr><th>" << escaped(key) << "</th><td>"
         << escaped(value.is_string() ? value.get<std::string>() : value.dump()) << "</td></tr>\n";
  page << "</table>\n<p>All times are of one thread, in its own CPU time, the median of the rounds. A load above the "
          "number of "
          "processors at the start means that caches and wide registers were shared with other work, and that figures "
          "are too high.</p>\n";
}

/// How fast an entry is over all sets, and how often wrong.
struct Standing {
  std::string solver;
  std::size_t sets = 0;
  Accuracy accuracy;
  double ratio = 0.0;
  Interval interval;  ///< of `ratio`
};

/// Round by round the geometric mean over the sets, of how many times as fast as the textbook's solver.
std::vector<double> mean_ratios(const std::vector<std::vector<double>>& of_sets) {
  std::size_t rounds = of_sets.front().size();
  for (const auto& ratios : of_sets) rounds = std::min(rounds, ratios.size());
  std::vector<double> means;
  for (std::size_t k = 0; k < rounds; ++k) {
    double sum = 0.0;
    for (const auto& ratios : of_sets) sum += std::log(ratios[k]);
    means.push_back(std::exp(sum / static_cast<double>(of_sets.size())));
  }
  return means;
}

/// Those that took part in most sets first, the fastest first among them.
std::vector<Standing> standings_of(const json& arena) {
  std::map<std::string, std::vector<std::vector<double>>> ratios;
  std::map<std::string, Accuracy> accuracies;
  for (const json& row : arena.at("benchmarks")) {
    const std::string name = row.at("name"), solver = name.substr(name.find('/') + 1);
    const auto of_rounds = row.at("ratios").get<std::vector<double>>();
    if (of_rounds.empty()) throw std::runtime_error("\"ratios\" of " + name + ": found none, expected one a round");
    ratios[solver].push_back(of_rounds);
    accuracies[solver].add(row);
  }
  std::vector<Standing> standings;
  for (const auto& [solver, of_sets] : ratios) {
    std::vector<double> means = mean_ratios(of_sets);
    const Interval interval = interval_of_median(means);
    std::sort(means.begin(), means.end());
    standings.push_back({solver, of_sets.size(), accuracies[solver], means[means.size() / 2], interval});
  }
  std::sort(standings.begin(), standings.end(), [](const Standing& a, const Standing& b) {
    return a.sets != b.sets ? a.sets > b.sets : a.ratio > b.ratio;
  });
  return standings;
}

std::string of_context(const json& context, const char* key) {
  const auto found = context.find(key);
  if (found == context.end()) return "unknown";
  return escaped(found->is_string() ? found->get<std::string>() : found->dump());
}

/// Its numbers as one cell, or as three.
void write_accuracy(std::ostream& page, const Accuracy& a, const char* between) {
  page << "<td class=\"" << (a.wrong + a.inaccurate > 0.0 ? "bad" : "good") << "\">" << number("%.0f", a.wrong)
       << between;
  if (a.only_verdicts)
    page << "-" << between << "-</td>";
  else
    page << number("%.0f", a.inaccurate) << between << number("%.1g", a.violation) << "</td>";
}

/// An entry shares the rank of its first entry where their intervals overlap.
void write_ranking(std::ostream& page, const json& arena) {
  const json& context = arena.at("context");
  page << "<h2>Ranking</h2>\n<p>Processor " << of_context(context, "cpu") << ", SIMD target "
       << of_context(context, "simd_target") << ", compiler " << of_context(context, "compiler")
       << ". Times as fast as the textbook float solver: the geometric mean over the sets, its median over the rounds "
          "and "
          "the interval that holds that median with 95 % certainty. Entries share the rank of the first of them whose "
          "interval theirs overlaps; those "
          "that took part in fewer sets follow, and are ranked among themselves. The rank says nothing of wrong "
          "answers, which the last columns count.</p>\n"
       << "<table><tr><th>rank</th><th class=\"words\">solver</th><th>sets</th><th>times as fast</th><th>95 %</th>"
          "<th>problems</th><th>wrong verdicts</th><th>inaccurate</th><th>worst violation</th></tr>\n";
  const std::vector<Standing> standings = standings_of(arena);
  std::size_t rank = 0, place = 0;
  double leader = 0.0;  // the low end of the first of the rank
  for (std::size_t k = 0; k < standings.size(); ++k) {
    const Standing& s = standings[k];
    const bool is_first = k == 0 || standings[k - 1].sets != s.sets;
    place = is_first ? 1 : place + 1;
    if (is_first || s.interval.high < leader) {
      rank = place;
      leader = s.interval.low;
    }
    page << "<tr><td>" << rank << "</td><td class=\"words\">" << escaped(s.solver) << "</td><td>" << s.sets
         << "</td><td>" << number("%.3g", s.ratio) << "</td><td>" << number("%.3g", s.interval.low)
         << number(" to %.3g", s.interval.high) << "</td><td>" << number("%.0f", s.accuracy.problems) << "</td>";
    write_accuracy(page, s.accuracy, "</td><td>");
    page << "</tr>\n";
  }
  page << "</table>\n";
}

void write_figures(std::ostream& page, const json& arena) {
  if (!arena.contains("figures")) {
    page << "<p>Without the figures to reach: <code>bench_lp --table --json</code> writes them.</p>\n";
    return;
  }
  page << "<h2>Figures to reach</h2>\n<p>Times as fast as the textbook float solver, where nothing else is said.</p>\n"
       << "<table><tr><th class=\"words\">figure</th><th>reach</th><th>measured</th><th></th></tr>\n";
  for (const json& row : arena.at("figures")) {
    const bool reached = row.at("reached");
    page << "<tr><td class=\"words\">" << escaped(row.at("what")) << "</td><td>"
         << (row.at("at_most").get<bool>() ? "&le; " : "&ge; ") << number("%.4g", row.at("reach")) << "</td><td>"
         << number("%.3g", row.at("measured")) << "</td><td class=\"" << (reached ? "good\">reached" : "bad\">short")
         << "</td></tr>\n";
  }
  page << "</table>\n";
}

std::string header_of(const std::vector<std::string>& solvers) {
  std::string row = "<tr><th>set</th>";
  for (const std::string& solver : solvers)
    row += "<th><span style=\"color:" + std::string(look_of(solver).colour) + "\">&#9632;</span> " + escaped(solver) +
           "</th>";
  return row + "</tr>\n";
}

void write_times(std::ostream& page, const Times& times, const std::vector<std::string>& solvers) {
  page << "<h2>Nanoseconds a solve (times as fast as the textbook solver)</h2>\n<p>Fast is not right: the next table "
          "says "
          "how often each is wrong on the same sets.</p>\n<table>"
       << header_of(solvers);
  for (const auto& [set, row] : times) {
    page << "<tr><th>" << escaped(set) << "</th>";
    for (const std::string& solver : solvers) {
      page << "<td>";
      if (row.count(solver) != 0) {
        page << number("%.3g", row.at(solver));
        if (row.count("textbook") != 0) page << number(" (%.2f)", row.at("textbook") / row.at(solver));
      }
      page << "</td>";
    }
    page << "</tr>\n";
  }
  page << "</table>\n";
}

void write_accuracies(std::ostream& page, const Accuracies& all, const std::vector<std::string>& solvers) {
  page << "<h2>Wrong / inaccurate / violation</h2>\n<p><b>Wrong</b>: verdicts (feasible or not) that are not the exact "
          "one. "
          "<b>Inaccurate</b>: velocities, of problems rightly called feasible, more than 10<sup>-4</sup> m/s from the "
          "exact "
          "optimum. <b>Violation</b>: the worst of a half-plane or the disc by such a velocity, m/s, in exact "
          "arithmetic; 0 "
          "where none is broken at all. Solvers with a dash take the box round the disc. Slow solvers see a part of "
          "each set, evenly spread.</p>\n<table>"
       << header_of(solvers);
  for (const auto& [set, row] : all) {
    page << "<tr><th>" << escaped(set) << "</th>";
    for (const std::string& solver : solvers) {
      const auto found = row.find(solver);
      if (found == row.end()) {
        page << "<td></td>";
        continue;
      }
      write_accuracy(page, found->second, " / ");
    }
    page << "</tr>\n";
  }
  page << "</table>\n";
}

void write_pictures(std::ostream& page, const fs::path& folder) {
  page << "<h2>Time against the number of lines</h2>\n<p>C: recorded from robots on a circle; B: among blocks, with "
          "hard "
          "lines; RF, RI: random, feasible and infeasible.</p>\n";
  for (const char* kind : {"C", "B", "RF", "RI"})
    if (fs::exists(folder / ("time-" + std::string(kind) + ".svg")))
      page << "<img src=\"time-" << kind << ".svg\" alt=\"time against m, " << kind << "\">\n";
  page << "<h2>Wrong verdicts against the perturbation</h2>\n<p>Problems made to be hard: lines that are nearly "
          "parallel, "
          "tangent or through one point, perturbed by so much. Curves at the bottom have no wrong verdict.</p>\n"
       << "<img src=\"accuracy.svg\" alt=\"wrong verdicts\">\n"
       << "<h2>Performance profile</h2>\n<p>On what share of the sets a solver takes at most so many times as long as "
          "the "
          "fastest; higher and further left is faster. It says nothing of wrong answers.</p>\n"
       << "<img src=\"profile.svg\" alt=\"performance profile\">\n";
}

void write_page(const fs::path& folder, const json& arena, const Times& times) {
  std::ofstream page = open(folder / "report.html");
  const std::vector<std::string> solvers = in_order(solvers_of(times));
  page << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>The arena</title>\n"
       << "<style>body{font:15px/1.45 sans-serif;max-width:76em;margin:2em auto;padding:0 1em}table{border-collapse:"
          "collapse;font-size:13px}td,th{padding:.25em .6em;text-align:right;border-bottom:1px solid #ddd}"
          "p{max-width:46em}.words,.facts td,.facts th{text-align:left}.good{color:#006b4f}.bad{color:#b03000}"
          "img{display:block;margin:1em 0}</style></head><body>\n<h1>The arena of the linear program</h1>\n"
       << "<p>Half-planes in, one velocity out: which solver is fast, and which is right? Every answer was first "
          "compared "
          "with the certified one, then all solvers were timed in turns on the same problems. A solver has one colour "
          "throughout; dashes are its narrower or slower kin.</p>\n";
  write_ranking(page, arena);
  write_figures(page, arena);
  write_times(page, times, solvers);
  write_accuracies(page, accuracies_of(arena), solvers);
  write_pictures(page, folder);
  write_context(page, arena.at("context"));
  page << "</body></html>\n";
}

int write_report(const std::string& arena_file, const std::string& adversarial_file,
                 const std::filesystem::path& folder) {
  const json arena = read(arena_file);
  const json adversarial = read(adversarial_file);
  require_list(arena, "benchmarks", arena_file, "bench_lp --json");
  require_list(adversarial, "adversarial", adversarial_file, "bench_lp --adversarial N --json");
  std::filesystem::create_directories(folder);
  const Times times = times_of(arena);
  for (const char* kind : {"C", "B", "RF", "RI"}) draw_times(folder, times, kind);
  draw_profile(folder, times);
  draw_accuracy(folder, adversarial);
  write_page(folder, arena, times);
  return 0;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("lp_report", [&] {
    std::string arena, adversarial, folder;
    tools::ProgramOptions options("lp_report", "The results of bench_lp as a page with pictures.");
    options.text("ARENA", arena, "What bench_lp --json wrote", true);
    options.text("ADVERSARIAL", adversarial, "What bench_lp --adversarial N --json wrote", true);
    options.text("FOLDER", folder, "Gets report.html and its pictures", true);
    return options.parse(argc, argv) ? bench::write_report(arena, adversarial, folder) : 0;
  });
}
