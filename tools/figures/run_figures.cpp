// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "exactvo/formation/metrics.h"
#include "figures/outlines.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::LyapunovRow;
using formation::Step;

namespace {

// --- What changes over time ---

constexpr Canvas kCanvas{960, 480};
constexpr Canvas kTallCanvas{960, 700};
/// With more robots than this, one curve per pair would be too many to tell apart.
constexpr std::size_t kMostRobotsInPairs = 4;

/// Characters of a legend's entry.
constexpr std::size_t kKeyLength = 32;
/// Entries of a legend in one column.
constexpr std::size_t kKeyRows = 22;
/// Of values: nothing is to be seen in less, and gnuplot draws no empty range.
constexpr double kLeastRange = 1e-6;
/// s: the time axis of a run that is over as it begins.
constexpr double kLeastTime = 1.0;
/// m: smaller errors of the formation are drawn here; a logarithmic axis has no zero.
constexpr double kLeastError = 1e-16;

struct Series {
  std::string label;
  std::vector<double> values;  ///< one a row of the recording
};

/// For a run of one row, whose curve has no length.
std::string point_style(std::size_t i) {
  return fmt::format("with points pt 7 lc rgb '{}'", series_colour(i));
}

std::string line_style(std::size_t i) {
  return fmt::format("with lines lw 2{} lc rgb '{}'", series_dash(i), series_colour(i));
}

void add_series(const RecordingFile& run, const std::vector<Series>& all, DataFile& data, PlotCommand& plot) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int index = data.begin(all[i].label, "t [s], value");
    const std::size_t rows = std::min(all[i].values.size(), run.recording.steps.size());
    for (std::size_t k = 0; k < rows; ++k) data.row({run.recording.steps[k].time, all[i].values[k]});
    plot.data(index, "using 1:2 " + (rows == 1 ? point_style(i) : line_style(i)),
              robot_in_legend(i, all.size(), all[i].label, kKeyLength));
  }
}

/// The time axis: to the end, but where robots got stuck not far beyond their last move.
double run_time(const RecordingFile& run) {
  return run.recording.steps.empty() ? 0.0 : run.recording.steps.back().time;
}
double shown_time(const RecordingFile& run) {
  const double end = run_time(run);
  return std::max(kLeastTime, run.scenario.formation ? end : std::min(end, 1.5 * end_of_motion(run) + 1.0));
}

/// Where the axis ends before the run does: a line where the robots came to rest, with words.
std::string rest_mark(const RecordingFile& run) {
  if (shown_time(run) >= run_time(run)) return "";
  return filled("rest_mark",
                {{"time", fmt::format("{:.6g}", end_of_motion(run))}, {"end", fmt::format("{:.6g}", run_time(run))}});
}

/// `y_label` in gnuplot's markup, `y_axis` settings of the axis.
std::string series_body(const RecordingFile& run, const std::string& title, const std::string& y_label,
                        const std::string& y_axis, const PlotCommand& plot) {
  const std::size_t room = characters_in(kCanvas.width - 60.0);
  return filled("series", {{"title", quoted(shortened(title, room))},
                           {"end", fmt::format("{:.6g}", shown_time(run))},
                           {"y_label", markup(y_label)},
                           {"key_rows", std::to_string(kKeyRows)},
                           {"rest", rest_mark(run)},
                           {"y_axis", y_axis},
                           {"plot", plot.text()}});
}

/// From a little below the lesser of zero and the values to a little above them; never empty.
std::string value_range(const std::vector<Series>& all) {
  double low = 0.0;
  double high = 0.0;
  for (const Series& series : all) {
    for (const double value : series.values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  const double room = high - low < kLeastRange ? 0.5 : 0.05 * (high - low);
  return fmt::format("set yrange [{:.6g}:{:.6g}]", low - room, high + room);
}

/// Distances: from zero up where nothing touches, and a line at contact.
Figure distance_figure(const RecordingFile& run, const std::string& name, const std::string& what,
                       const std::vector<Series>& all) {
  DataFile data;
  PlotCommand plot;
  add_series(run, all, data, plot);
  plot.item("0 with lines lw 1.5 dt (5,4) lc rgb 'black'", "contact");
  const std::string title = run_title(run) + ": " + what;
  return {name, data.text(), title + ". Below zero they overlap.", kCanvas,
          series_body(run, title, "distance [m]", value_range(all), plot)};
}

std::vector<Series> pair_distances(const RecordingFile& run) {
  std::vector<Series> all;
  const auto& robots = run.scenario.robots;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = i + 1; j < robots.size(); ++j) {
      all.push_back({robots[i].id + " and " + robots[j].id, robot_distance_series(run.scenario, run.recording, i, j)});
    }
  }
  return all;
}

void lower(std::vector<double>& values, const std::vector<double>& to) {
  if (values.empty()) values = to;
  for (std::size_t k = 0; k < std::min(values.size(), to.size()); ++k) values[k] = std::min(values[k], to[k]);
}

std::vector<Series> nearest_distances(const RecordingFile& run) {
  const auto& robots = run.scenario.robots;
  std::vector<Series> all;
  for (const auto& robot : robots) all.push_back({robot.id, {}});
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = i + 1; j < robots.size(); ++j) {
      const std::vector<double> values = robot_distance_series(run.scenario, run.recording, i, j);
      lower(all[i].values, values);
      lower(all[j].values, values);
    }
  }
  return all;
}

std::vector<Series> velocity_components(const RecordingFile& run, const std::function<double(Vec2)>& component) {
  std::vector<Series> all;
  for (std::size_t i = 0; i < run.scenario.robots.size(); ++i) {
    Series series{run.scenario.robots[i].id, {}};
    for (const Step& step : run.recording.steps) series.values.push_back(component(step.robots[i].velocity));
    all.push_back(series);
  }
  return all;
}

void add_leader(const RecordingFile& run, const std::function<double(Vec2)>& component, DataFile& data,
                PlotCommand& plot) {
  if (!run.scenario.formation) return;
  const int index = data.begin("virtual leader", "t [s], value");
  for (const Step& step : run.recording.steps) data.row({step.time, component(step.leader_velocity)});
  plot.data(index, "using 1:2 with lines lw 1.5 dt (2,4) lc rgb 'black'", "virtual leader");
}

std::string velocity_panel(const RecordingFile& run, const std::string& title, const std::string& y_label,
                           const std::function<double(Vec2)>& component, DataFile& data) {
  PlotCommand plot;
  const std::vector<Series> all = velocity_components(run, component);
  add_series(run, all, data, plot);
  add_leader(run, component, data, plot);
  return series_body(run, title, y_label, value_range(all), plot);
}

// --- The Lyapunov functions ---

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

/// From each robot's rim to the nearest obstacle (paper, Figs. 5(b), 6(b)). REQUIRES obstacles.
Figure obstacle_distance_figure(const RecordingFile& run) {
  std::vector<Series> all;
  for (std::size_t i = 0; i < run.scenario.robots.size(); ++i) {
    all.push_back({run.scenario.robots[i].id, obstacle_distance_series(run.scenario, run.recording, i)});
  }
  return distance_figure(run, "obstacle_distance", "distance from the robot's rim to the nearest obstacle", all);
}

/// Between the rims of each pair of up to four robots; with more robots, from each to the nearest other (paper,
/// Figs. 6(c), 8(d)). REQUIRES two robots.
Figure robot_distance_figure(const RecordingFile& run) {
  const bool pairs = run.scenario.robots.size() <= kMostRobotsInPairs;
  return distance_figure(
      run, "robot_distance",
      pairs ? "distance between the robots' rims" : "distance from each robot's rim to the nearest other",
      pairs ? pair_distances(run) : nearest_distances(run));
}

/// Both components of each robot and of the leader (paper, Fig. 8(c)).
Figure velocity_figure(const RecordingFile& run) {
  DataFile data;
  const std::string x = velocity_panel(
      run, "(a) " + run_title(run) + ": velocity along x", "{/:Italic v}_x [m/s]", [](Vec2 v) { return v.x; }, data);
  const std::string y = velocity_panel(
      run, "(b) velocity along y", "{/:Italic v}_y [m/s]", [](Vec2 v) { return v.y; }, data);
  return {"velocity", data.text(), "Components of the robots' velocities in " + run_title(run) + ".", kTallCanvas,
          filled("velocity", {{"x", x}, {"y", y}})};
}

/// |x_i - x_L - Delta_i|, logarithmic. REQUIRES a formation.
Figure formation_error_figure(const RecordingFile& run) {
  DataFile data;
  PlotCommand plot;
  std::vector<Series> all;
  for (std::size_t i = 0; i < run.scenario.robots.size(); ++i) {
    all.push_back({run.scenario.robots[i].id, formation_error_series(run.scenario, run.recording, i)});
    for (double& value : all.back().values) value = std::max(value, kLeastError);
  }
  add_series(run, all, data, plot);
  const std::string title = run_title(run) + ": distance of each robot from its slot";
  return {"formation_error", data.text(), title + ", logarithmic.", kCanvas,
          series_body(run, title, "|{/:Italic x}_i − {/:Italic x}_L − {/:Italic Δ}_i| [m]",
                      "set logscale y\nunset mytics\nset format y '10^{%T}'", plot)};
}

}  // namespace

std::vector<Figure> run_figures(const datasets::RecordingFile& run) {
  std::vector<Figure> figures = {paths_figure(run)};
  if (!run.scenario.obstacles.empty() || !run.scenario.moving_obstacles.empty())
    figures.push_back(obstacle_distance_figure(run));
  if (run.scenario.robots.size() > 1) figures.push_back(robot_distance_figure(run));
  figures.push_back(velocity_figure(run));
  if (run.scenario.formation) figures.push_back(formation_error_figure(run));
  if (!run.lyapunov.empty()) figures.push_back(lyapunov_figure(run));
  return figures;
}

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

}  // namespace exactvo::tools
