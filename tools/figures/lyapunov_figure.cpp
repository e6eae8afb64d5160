// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/lyapunov_figure.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "figures/paths_figure.h"
#include "figures/style.h"

namespace exactvo::tools {

using formation::LyapunovRow;

namespace {

constexpr Canvas kTermsCanvas{960, 1240};

/// A curve: what the legend says, and its value in a row.
struct Curve {
  const char* label;
  double (*value)(const LyapunovRow&);
  bool sum = false;  ///< drawn black: the others add up to it, or bound it
};

const std::vector<Curve> kPaper{
    {"kinetic", [](const LyapunovRow& r) { return r.paper.kinetic; }},
    {"consensus", [](const LyapunovRow& r) { return r.paper.consensus; }},
    {"pinning", [](const LyapunovRow& r) { return r.paper.pinning; }},
    {"integral", [](const LyapunovRow& r) { return r.paper.integral; }},
    {"V of (18)", [](const LyapunovRow& r) { return r.paper.value(); }, true},
};
const std::vector<Curve> kPaperRates{
    {"kinetic", [](const LyapunovRow& r) { return r.paper_rates.kinetic; }},
    {"consensus", [](const LyapunovRow& r) { return r.paper_rates.consensus; }},
    {"pinning", [](const LyapunovRow& r) { return r.paper_rates.pinning; }},
    {"integral", [](const LyapunovRow& r) { return r.paper_rates.integral; }},
    {"claimed by (20)", [](const LyapunovRow& r) { return r.paper_rate; }},
    {"derivative of V", [](const LyapunovRow& r) { return r.paper_rates.value(); }, true},
};
const std::vector<Curve> kSound{
    {"kinetic", [](const LyapunovRow& r) { return r.sound.kinetic; }},
    {"consensus", [](const LyapunovRow& r) { return r.sound.consensus; }},
    {"slots", [](const LyapunovRow& r) { return r.sound.slots; }},
    {"valid V", [](const LyapunovRow& r) { return r.sound.value(); }, true},
};
const std::vector<Curve> kSoundRates{
    {"consensus", [](const LyapunovRow& r) { return r.sound_rates.consensus; }},
    {"tracking", [](const LyapunovRow& r) { return r.sound_rates.tracking; }},
    {"intervention", [](const LyapunovRow& r) { return r.sound_rates.intervention; }},
    {"bound", [](const LyapunovRow& r) { return r.rate_bound; }},
    {"derivative of V", [](const LyapunovRow& r) { return r.sound_rates.value(); }, true},
};

enum class Axis { linear, logarithmic, rates };

/// Of V on a logarithmic axis, m^2/s^2: what is smaller is drawn here.
constexpr double kLeastShown = 1e-24;

void add_curve(const Curve& curve, std::size_t number, const std::vector<LyapunovRow>& rows, double floor,
               DataFile& data, PlotCommand& plot) {
  const int index = data.begin(curve.label, "t [s], value");
  for (const LyapunovRow& row : rows) {
    const double value = curve.value(row);
    if (std::isfinite(value)) data.row({row.time, std::max(value, floor)});
  }
  plot.data(index,
            fmt::format("using 1:2 with lines lw {} lc rgb '{}'", curve.sum ? 4.0 : 1.5,
                        curve.sum ? "black" : series_colour(number)),
            curve.label);
}

/// Of a derivative: what all but the shortest spikes (the start, the leader's stop) need.
std::string range_of_rates(const std::vector<Curve>& curves, const std::vector<LyapunovRow>& rows) {
  constexpr double kShare = 0.98;  // of the values
  std::vector<double> sizes;
  for (const Curve& curve : curves)
    for (const LyapunovRow& row : rows)
      if (std::isfinite(curve.value(row))) sizes.push_back(std::fabs(curve.value(row)));
  if (sizes.empty()) return "set autoscale y";
  std::sort(sizes.begin(), sizes.end());
  const double most =
      std::max(1.5 * sizes[static_cast<std::size_t>(kShare * static_cast<double>(sizes.size() - 1))], 1e-6);
  return fmt::format("set yrange [{:.4g}:{:.4g}]", -most, most);
}

std::string panel(const std::vector<Curve>& curves, const std::vector<LyapunovRow>& rows, const std::string& title,
                  const std::string& y_label, Axis axis, DataFile& data) {
  const bool logarithmic = axis == Axis::logarithmic;
  PlotCommand plot;
  const double floor = logarithmic ? kLeastShown : -std::numeric_limits<double>::infinity();
  // The sum first and wide: a term that makes up all of it is seen within.
  for (const bool sum : {true, false})
    for (std::size_t i = 0; i < curves.size(); ++i)
      if (curves[i].sum == sum) add_curve(curves[i], i, rows, floor, data, plot);
  const std::string range = axis == Axis::rates ? range_of_rates(curves, rows) : std::string("set autoscale y");
  const std::string scale =
      logarithmic ? "set logscale y\nunset mytics\nset format y '10^{%T}'\n" : "unset logscale y\nset format y '%g'\n";
  return filled(
      "lyapunov_panel",
      {{"title", quoted(title)}, {"y_label", markup(y_label)}, {"y_axis", scale + range}, {"plot", plot.text()}});
}

std::vector<LyapunovRow> without_the_last(std::vector<LyapunovRow> rows) {
  if (rows.size() > 1) rows.pop_back();  // it has no decision, so no derivative
  return rows;
}

}  // namespace

Figure lyapunov_figure(const datasets::RecordingFile& run) {
  DataFile data;
  const std::vector<LyapunovRow>& rows = run.lyapunov;
  const std::vector<LyapunovRow> moving = without_the_last(rows);
  const double end = rows.empty() ? 1.0 : std::max(rows.back().time, 1.0);
  const std::string title = run_title(run);
  // One after the other: their data sets are numbered.
  std::string panels =
      panel(kPaper, rows, "(a) " + title + ": function (18) of the paper", "{/:Italic V} [m²/s²]", Axis::linear, data);
  panels += panel(kPaperRates, moving, "(b) its derivative (19), and what (20) claims it is (tallest spikes cut off)",
                  "d{/:Italic V}/d{/:Italic t} [m²/s³]", Axis::rates, data);
  panels +=
      panel(kSound, rows, "(c) a Lyapunov function that is valid", "{/:Italic V} [m²/s²]", Axis::logarithmic, data);
  panels += panel(kSoundRates, moving, "(d) its derivative, and the bound near obstacles (tallest spikes cut off)",
                  "d{/:Italic V}/d{/:Italic t} [m²/s³]", Axis::rates, data);
  return {"lyapunov", data.text(), "Both Lyapunov functions along " + title + ", term by term.", kTermsCanvas,
          filled("lyapunov", {{"end", fmt::format("{:.6g}", end)}, {"panels", panels}})};
}

std::string lyapunov_csv_head() {
  return "time_s,paper_kinetic_m2_s2,paper_consensus_m2_s2,paper_pinning_m2_s2,paper_integral_m2_s2,"
         "paper_rate_kinetic_m2_s3,paper_rate_consensus_m2_s3,paper_rate_pinning_m2_s3,paper_rate_integral_m2_s3,"
         "paper_rate_claimed_m2_s3,sound_kinetic_m2_s2,sound_consensus_m2_s2,sound_slots_m2_s2,"
         "sound_rate_consensus_m2_s3,sound_rate_tracking_m2_s3,sound_rate_intervention_m2_s3,"
         "sound_rate_bound_m2_s3\n";
}

std::string lyapunov_csv_line(const LyapunovRow& r) {
  std::string text;
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), r.time);
  const auto values = [&text](std::initializer_list<double> all) {
    for (const double x : all) fmt::format_to(std::back_inserter(text), FMT_COMPILE(",{}"), x);
  };
  // A cell of a derivative that does not exist is empty.
  const auto rates = [&](std::initializer_list<double> all) {
    r.has_rates ? values(all) : void(text.append(all.size(), ','));
  };
  values({r.paper.kinetic, r.paper.consensus, r.paper.pinning, r.paper.integral});
  rates({r.paper_rates.kinetic, r.paper_rates.consensus, r.paper_rates.pinning, r.paper_rates.integral, r.paper_rate});
  values({r.sound.kinetic, r.sound.consensus, r.sound.slots});
  rates({r.sound_rates.consensus, r.sound_rates.tracking, r.sound_rates.intervention, r.rate_bound});
  return text + "\n";
}

}  // namespace exactvo::tools
