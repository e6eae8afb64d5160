// SPDX-License-Identifier: GPL-3.0-or-later
#include "page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "published.h"
#include "route_maps.h"

namespace exactvo::bench {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

std::string number(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

/// All runs of a scene by a method.
struct Cell {
  std::size_t runs = 0, successes = 0, collisions = 0, relaxed = 0, plans = 0;
  std::vector<double> makespans;  ///< over the bound, of successes
  std::vector<double> paths;      ///< over the straight ways, of successes
  double cpu_per_step = 0.0;      ///< the sum

  void add(const RunResult& r) {
    ++runs;
    successes += r.success ? 1 : 0;
    collisions += r.collisions;
    relaxed += r.relaxed;
    plans += r.plans;
    cpu_per_step += r.cpu_per_step;
    if (!r.success) return;
    makespans.push_back(r.makespan / r.bound);
    paths.push_back(r.path);
  }
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// One suite's cells by scene and method; scenes in the order of their first run.
struct SuiteTable {
  std::vector<std::string> scenes;
  std::map<std::pair<std::string, std::string>, Cell> cells;
  bool has_makespans = true;  ///< else robots go on to the end

  const Cell* find(const std::string& scene, const std::string& method) const {
    const auto found = cells.find({scene, method});
    return found == cells.end() ? nullptr : &found->second;
  }
};

SuiteTable table_of(const std::string& suite, const std::vector<RunResult>& results) {
  SuiteTable table;
  table.has_makespans = suite != "cross";
  std::vector<std::string> known;
  for (const Extent extent : {Extent::full, Extent::quick})
    for (const Scene& scene : scenes_of(suite, extent, {1})) known.push_back(scene.name);
  std::set<std::string> there;
  for (const RunResult& r : results)
    if (r.suite == suite) {
      table.cells[{r.scene, r.method}].add(r);
      there.insert(r.scene);
    }
  for (const std::string& scene : known)
    if (there.erase(scene) > 0) table.scenes.push_back(scene);
  table.scenes.insert(table.scenes.end(), there.begin(), there.end());
  return table;
}

constexpr const char* kColours[] = {"#0072B2", "#E69F00", "#777777", "#D55E00", "#009E73", "#CC79A7"};

const char* colour_of(std::size_t method) {
  return kColours[method % (sizeof kColours / sizeof *kColours)];
}

void write_head_of_table(std::ostream& out, const std::vector<std::string>& methods, bool has_makespans) {
  const int columns = has_makespans ? 5 : 3;
  out << "<div><table><tr><th rowspan=\"2\" class=\"words\">scene</th>";
  for (std::size_t m = 0; m < methods.size(); ++m)
    out << "<th class=\"first\" colspan=\"" << columns << "\"><span style=\"color:" << colour_of(m)
        << "\">&#9632;</span> " << escaped(methods[m]) << "</th>";
  out << "</tr>\n<tr>";
  for (std::size_t m = 0; m < methods.size(); ++m)
    out << "<th class=\"first\">ok</th><th>coll.</th>" << (has_makespans ? "<th>makespan</th><th>path</th>" : "")
        << "<th>&micro;s</th>";
  out << "</tr>\n";
}

void write_cell(std::ostream& out, const Cell* cell, bool has_makespans) {
  if (cell == nullptr) {
    out << "<td class=\"first\" colspan=\"" << (has_makespans ? 5 : 3) << "\"></td>";
    return;
  }
  const bool all = cell->successes == cell->runs;
  out << "<td class=\"first " << (all ? "good" : "bad") << "\">" << cell->successes << " / " << cell->runs << "</td><td"
      << (cell->collisions > 0 ? " class=\"bad\">" : ">") << cell->collisions << "</td>";
  if (has_makespans && !cell->makespans.empty())
    out << "<td>" << number("%.2f", median(cell->makespans))
        << (cell->makespans.size() > 1
                ? number(" (%.2f)", *std::max_element(cell->makespans.begin(), cell->makespans.end()))
                : "")
        << "</td><td>" << number("%.2f", median(cell->paths)) << "</td>";
  else if (has_makespans)
    out << "<td></td><td></td>";
  out << "<td>" << number("%.1f", cell->cpu_per_step / static_cast<double>(cell->runs)) << "</td>";
}

void write_table(std::ostream& out, const SuiteTable& table, const std::vector<std::string>& methods) {
  write_head_of_table(out, methods, table.has_makespans);
  for (const std::string& scene : table.scenes) {
    out << "<tr><th class=\"words\">" << escaped(scene) << "</th>";
    for (const std::string& method : methods) write_cell(out, table.find(scene, method), table.has_makespans);
    out << "</tr>\n";
  }
  out << "</table></div>\n";
}

/// Makespans over the bound, one line per scene, on a logarithmic axis; a cross at the right margin: not all runs
/// succeeded.
void write_picture(std::ostream& out, const SuiteTable& table, const std::vector<std::string>& methods) {
  constexpr double kLeft = 170.0, kWidth = 620.0, kRow = 20.0, kTop = 24.0, kLargest = 24.0;
  constexpr double kApart = 4.0;  // methods that are as good as each other
  const auto x_of = [&](double ratio) {
    return kLeft + kWidth * std::log(std::clamp(ratio, 1.0, kLargest)) / std::log(kLargest);
  };
  const double height = kTop + kRow * static_cast<double>(table.scenes.size()) + 10.0;
  out << "<svg viewBox=\"0 0 860 " << height
      << "\" width=\"860\" role=\"img\" aria-label=\"makespans over the bound\">\n";
  for (const double tick : {1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0})
    out << "<line x1=\"" << x_of(tick) << "\" x2=\"" << x_of(tick) << "\" y1=\"" << kTop - 4.0 << "\" y2=\""
        << height - 8.0 << "\"/><text x=\"" << x_of(tick) << "\" y=\"14\" text-anchor=\"middle\">" << number("%g", tick)
        << "</text>\n";
  for (std::size_t k = 0; k < table.scenes.size(); ++k) {
    const double y = kTop + kRow * (static_cast<double>(k) + 0.5);
    out << "<text x=\"" << kLeft - 12.0 << "\" y=\"" << y + 4.0 << "\" text-anchor=\"end\">" << escaped(table.scenes[k])
        << "</text>\n";
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Cell* cell = table.find(table.scenes[k], methods[m]);
      if (cell == nullptr) continue;
      const double beside = kApart * (static_cast<double>(m) - 0.5 * static_cast<double>(methods.size() - 1));
      for (const double ratio : cell->makespans)
        out << "<circle cx=\"" << x_of(ratio) << "\" cy=\"" << y + beside << "\" r=\"3.5\" fill=\"" << colour_of(m)
            << "\" fill-opacity=\"0.65\"/>";
      if (cell->successes < cell->runs) {
        const double x = kLeft + kWidth + 16.0 + 14.0 * static_cast<double>(m);
        out << "<path d=\"M" << x - 4.0 << ' ' << y - 4.0 << "l8 8m0 -8l-8 8\" stroke=\"" << colour_of(m)
            << "\" stroke-width=\"2\"/>";
      }
      out << '\n';
    }
  }
  out << "</svg>\n";
}

void write_published(std::ostream& out, const std::string& suite) {
  bool any = false;
  for (const Published& p : published()) {
    if (p.suite != suite) continue;
    if (!any)
      out << "<table class=\"published\"><tr><th>published</th><th>scenes</th><th>source</th><th>beside "
             "ours</th></tr>\n";
    any = true;
    out << "<tr><td>" << escaped(p.figure) << "</td><td>" << escaped(p.scenes) << "</td><td>" << escaped(p.source)
        << "</td><td><b>" << (p.comparable ? "comparable" : "not comparable") << "</b>: " << escaped(p.why)
        << "</td></tr>\n";
  }
  if (any) out << "</table>\n";
}

/// The methods that took part in a suite, in the order of columns.
std::vector<std::string> methods_in(const SuiteTable& table, const std::vector<std::string>& methods) {
  std::vector<std::string> there;
  for (const std::string& method : methods)
    if (std::any_of(table.scenes.begin(), table.scenes.end(),
                    [&](const std::string& scene) { return table.find(scene, method) != nullptr; }))
      there.push_back(method);
  return there;
}

void write_routes(std::ostream& out, const std::vector<RunResult>& results) {
  bool any = false;
  for (const RunResult& r : results) {
    if (r.suite != kRoutesSuite) continue;
    if (!any)
      out << "<h2>routes</h2>\n<p>Shortest-path problems on Moving AI maps, for points and for discs (radius in "
             "cells). <b>Path</b>: lengths over those of a point's shortest paths. <b>Ok</b>: no route is shorter than "
             "that, and of points no lower bound is longer. Discs have less room, and no route where no gap is wide "
             "enough; nor has a point of ours between two cells that touch at a corner. Ends of points are the "
             "published corners, moved into their cells by 2^-36 of a side.</p>\n"
             "<table><tr><th class=\"words\">map</th><th>ok</th><th>problems</th><th>with a route</th><th>path</th>"
             "<th>&micro;s per query</th></tr>\n";
    any = true;
    out << "<tr><th class=\"words\">" << escaped(r.scene) << "</th><td class=\""
        << (r.success ? "good\">yes" : "bad\">no") << "</td><td>" << r.robots << "</td><td>" << r.arrived << "</td><td>"
        << number("%.5f", r.path) << "</td><td>" << number("%.0f", r.cpu_per_step) << "</td></tr>\n";
  }
  if (!any) return;
  out << "</table>\n";
  write_published(out, kRoutesSuite);
}

// Colours in light and dark.
constexpr const char* kStyle =
    ":root{color-scheme:light dark;--back:#fff;--ink:#222;--rule:#ddd;--good:#006b4f;--bad:#b03000}"
    "@media(prefers-color-scheme:dark){:root{--back:#16181b;--ink:#ddd;--rule:#3a3e44;--good:#4cc9a0;--bad:#ff8a5c}}"
    "body{font:15px/1.45 sans-serif;max-width:78em;margin:2em auto;padding:0 1em;color:var(--ink);"
    "background:var(--back)}"
    "table{border-collapse:collapse;font-size:13px;margin:.8em 0}"
    "td,th{padding:.2em .5em;text-align:right;border-bottom:1px solid var(--rule);vertical-align:top}"
    "div{overflow-x:auto}p{max-width:52em}th.words{white-space:nowrap}th[colspan]{text-align:left}.words,.published "
    "td,.published th{text-align:left}.first{border-left:1px solid var(--rule)}"
    ".good{color:var(--good)}.bad{color:var(--bad);font-weight:bold}"
    "svg{font:12px sans-serif;fill:var(--ink);display:block;margin:.5em 0;max-width:100%;height:auto}"
    "svg line{stroke:var(--rule)}svg path{fill:none}"
    ".published{max-width:72em}";

}  // namespace

void write_page(std::ostream& out, const std::vector<RunResult>& results, const std::vector<std::string>& methods,
                const PageFacts& facts) {
  out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>The arena</title>\n<style>"
      << kStyle << "</style></head><body>\n<h1>The arena: many robots arrive</h1>\n"
      << "<p>A run is <b>ok</b> when all robots arrive and none touches another or an obstacle, in continuous time; "
         "of "
         "robots that never end, when none stands at the end. It lasts at most 20 times the bound and 100 s, and ends "
         "before that when for 4 times the bound and 60 s no robot has come nearer to its goal. <b>Coll.</b>: "
         "collisions, of all runs. <b>Makespan</b>: the last arrival over the bound, the longest straight way at full "
         "speed; the median of runs that are ok, and in brackets the worst. <b>Path</b>: of all robots, over their "
         "straight ways. <b>&micro;s</b>: processor time per robot and step, planning included; of a peer, with "
         "reading "
         "and writing.</p>\n"
      << "<p><b>plan</b>: the defaults of <code>simulate</code>. <b>bias</b>: without joint plans. <b>orca</b>: van "
         "den "
         "Berg et al. 2011 along the same routes. Other columns are programs that were named with <code>--peer</code>. "
         "In pictures a dot is a run that is ok; a cross at the right says that not all are.</p>\n";
  if (!facts.is_complete) out << "<p class=\"bad\">Some runs are missing: the arena was stopped.</p>\n";
  for (const SuiteInfo& suite : suites()) {
    const SuiteTable table = table_of(suite.name, results);
    if (table.scenes.empty()) continue;
    out << "<h2>" << escaped(suite.name) << "</h2>\n<p>" << escaped(suite.shows) << "</p>\n";
    const std::vector<std::string> there = methods_in(table, methods);
    if (table.has_makespans) write_picture(out, table, there);
    write_table(out, table, there);
    write_published(out, suite.name);
  }
  write_routes(out, results);
  out << "<p>ExactVO " << escaped(facts.version) << " (" << escaped(facts.commit) << ", " << escaped(facts.build_type)
      << "), " << facts.jobs << " at a time, on " << escaped(facts.processor)
      << ". Times depend on what else runs there; nothing else does.</p>\n</body></html>\n";
}

}  // namespace exactvo::bench
