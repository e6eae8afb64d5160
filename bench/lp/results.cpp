// SPDX-License-Identifier: GPL-3.0-or-later
#include "results.h"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace exactvo::bench {
namespace {

constexpr const char* kTextbook = "textbook";

/// `slower` over `faster` must be at least `reach`, or at most where so.
struct Figure {
  const char* what;
  const char* set;
  const char* slower;
  const char* faster;
  double reach;
  bool at_most = false;
};

constexpr Figure kFigures[] = {
    {"C10f, widest target, double", "C10f", kTextbook, "batch-double", 4.0},
    {"C10f, widest target, float", "C10f", kTextbook, "batch-float", 8.0},
    {"C10f, AVX2, double", "C10f", kTextbook, "batch-double-AVX2", 2.5},
    {"C10f, AVX2, float", "C10f", kTextbook, "batch-float-AVX2", 5.0},
    {"C10i, double", "C10i", kTextbook, "batch-double", 6.0},
    {"C10i, float", "C10i", kTextbook, "batch-float", 12.0},
    {"C10 as recorded, double", "C10", kTextbook, "batch-double", 4.0},
    {"C10 as recorded, float", "C10", kTextbook, "batch-float", 7.0},
    {"RF10, double", "RF10", kTextbook, "batch-double", 5.0},
    {"RI10, double", "RI10", kTextbook, "batch-double", 12.0},
    {"C50, double", "C50", kTextbook, "batch-double", 2.0},
    {"one problem, double, C10f", "C10f", kTextbook, "single", 1.3},
    {"one problem, double, C10i", "C10i", kTextbook, "single", 1.3},
    {"one problem, certified, C10f", "C10f", "single-certified", kTextbook, 1.5, true},
    {"one problem, certified, C10i", "C10i", "single-certified", kTextbook, 1.5, true},
    {"one problem, certified, RF10", "RF10", "single-certified", kTextbook, 1.5, true},
    {"one problem, certified, B10", "B10", "single-certified", kTextbook, 1.5, true},
    {"certified against plain double, C10", "C10", "batch-certified", "batch-double", 1.25, true},
    {"CGAL QP (Gmpzf) against certified, C10f", "C10f", "cgal-qp-Gmpzf", "batch-certified", 1000.0},
    {"CGAL QP (Gmpzf) against the exact stage alone, C10f", "C10f", "cgal-qp-Gmpzf", "exact", 3.0},
};

constexpr double kWithoutExact = 0.999;

}  // namespace

double Results::ratio(const std::string& set, const std::string& slower, const std::string& faster) const {
  const auto row = ns.find(set);
  if (row == ns.end() || row->second.count(slower) == 0 || row->second.count(faster) == 0) return 0.0;
  return row->second.at(slower) / row->second.at(faster);
}

std::vector<std::string> sets_of_figures() {
  return {"C10", "C10f", "C10i", "C5",   "C20",  "C50",  "C100", "B10",
          "B50", "RF10", "RF20", "RF50", "RI10", "RI20", "RI50"};
}

bool FigureRow::reached() const {
  return at_most ? measured > 0.0 && measured <= reach : measured >= reach;
}

std::vector<FigureRow> figures_of(const Results& results) {
  std::vector<FigureRow> rows;
  for (const Figure& f : kFigures)
    rows.push_back({f.what, f.reach, results.ratio(f.set, f.slower, f.faster), f.at_most});
  double least = std::numeric_limits<double>::infinity();
  std::string where;
  for (const auto& [set, times] : results.ns) {
    const double ratio = results.ratio(set, kTextbook, "batch-double");
    if (ratio < least) least = ratio, where = set;
  }
  rows.push_back({"every set, double: least, on " + where, 1.0, least, false});
  double most_exact = 0.0;
  for (const auto& [set, share] : results.exact_share)
    if (set[0] == 'C' || set[0] == 'B') most_exact = std::max(most_exact, share);
  rows.push_back({"recorded instances without exact arithmetic, least", kWithoutExact, 1.0 - most_exact, false});
  return rows;
}

void print_figures(const std::vector<FigureRow>& rows) {
  std::printf("\n  %-54s %11s %10s\n", "figure (times as fast)", "reach", "measured");
  for (const FigureRow& row : rows)
    std::printf("  %-54s %s %8.3g %10.3g   %s\n", row.what.c_str(), row.at_most ? "<=" : ">=", row.reach, row.measured,
                row.reached() ? "reached" : "short");
}

}  // namespace exactvo::bench
