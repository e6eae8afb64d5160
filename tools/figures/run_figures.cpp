// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "exactvo/formation/metrics.h"

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
/// The least range of values: nothing is to be seen in less, and gnuplot draws no empty range.
constexpr double kLeastRange = 1e-6;
/// s: the time axis of a run that is over as it begins.
constexpr double kLeastTime = 1.0;
/// m: smaller errors of the formation are drawn here; a logarithmic axis has no zero.
constexpr double kLeastError = 1e-16;

struct Series {
  std::string label;
  std::vector<double> values;  ///< one a row of the recording
};

/// The time axis: to the end, but where robots got stuck not far beyond their last move.
double run_time(const RecordingFile& run) {
  return run.recording.steps.empty() ? 0.0 : run.recording.steps.back().time;
}
double shown_time(const RecordingFile& run) {
  const double end = run_time(run);
  return std::max(kLeastTime, run.scenario.formation ? end : std::min(end, 1.5 * end_of_motion(run) + 1.0));
}

/// What a vertical axis shows.
struct Range {
  double low = 0.0, high = 0.0;
  bool is_logarithmic = false;
};

/// px of the SVG: about what the axes of a figure enclose.
constexpr double kAxesWidth = 720.0, kAxesHeight = 380.0;

/// The rows that are drawn of a curve: all, or those that are seen to make a difference.
std::vector<std::size_t> drawn_rows(const std::vector<double>& times, const std::vector<double>& values, double end,
                                    const Range& range, bool all) {
  if (all) return all_points(values.size());
  const double height = range.is_logarithmic ? std::log10(range.high / range.low) : range.high - range.low;
  const double a_second = kAxesWidth / end, a_unit = kAxesHeight / height;
  Points curve;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double shown = std::clamp(values[k], range.low, range.high);
    curve.push_back({a_second * times[k], a_unit * (range.is_logarithmic ? std::log10(shown) : shown)});
  }
  return drawn_points(curve);
}

bool are_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Robots of one style share a data set where the legend names none: gnuplot looks for each from the file's beginning.
void add_series(const RecordingFile& run, const std::vector<Series>& all, const Range& range, DataFile& data,
                PlotCommand& plot) {
  std::vector<double> times;
  for (const Step& step : run.recording.steps) times.push_back(step.time);
  const bool is_short = all.size() * times.size() <= kMostWholePoints;
  for (const std::vector<std::size_t>& alike : drawn_together(all.size(), kStyles)) {
    const std::size_t first = alike.front();
    const int index = data.begin(names_of(alike, [&](std::size_t i) { return all[i].label; }), "t [s], value");
    for (const std::size_t i : alike) {
      data.gap();
      std::vector<double> values(
          all[i].values.begin(),
          all[i].values.begin() + static_cast<std::ptrdiff_t>(std::min(all[i].values.size(), times.size())));
      const bool whole = is_short || !are_finite(values);
      for (const std::size_t k : drawn_rows(times, values, shown_time(run), range, whole))
        data.row({times[k], values[k]});
    }
    // The curve of a run of one row has no length.
    const std::string style = times.size() == 1 ? "points pt 7" : std::string("lines lw 2") + series_dash(first);
    plot.data(index, fmt::format("using 1:2 with {} lc rgb '{}'", style, series_colour(first)),
              robot_in_legend(first, all.size(), all[first].label, kKeyLength));
  }
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
Range range_of(const std::vector<Series>& all) {
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
  return {low - room, high + room};
}

std::string y_axis(const Range& range) {
  return fmt::format("set yrange [{:.6g}:{:.6g}]", range.low, range.high);
}

/// Distances: from zero up where nothing touches, and a line at contact.
Figure distance_figure(const RecordingFile& run, const std::string& name, const std::string& what,
                       const std::vector<Series>& all) {
  DataFile data;
  PlotCommand plot;
  const Range range = range_of(all);
  add_series(run, all, range, data, plot);
  plot.item("0 with lines lw 1.5 dt (5,4) lc rgb 'black'", "contact");
  const std::string title = run_title(run) + ": " + what;
  return {name, data.text(), title + ". Below zero they overlap.", kCanvas,
          series_body(run, title, "distance [m]", y_axis(range), plot)};
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

/// Row by row, as robot_distance_series has it of each pair.
std::vector<Series> nearest_distances(const RecordingFile& run) {
  const auto& robots = run.scenario.robots;
  std::vector<Series> all;
  for (const auto& robot : robots) all.push_back({robot.id, {}});
  std::vector<double> nearest(robots.size());
  for (const Step& row : run.recording.steps) {
    std::fill(nearest.begin(), nearest.end(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < robots.size(); ++i) {
      for (std::size_t j = i + 1; j < robots.size(); ++j) {
        const double radii = robots[i].radius + robots[j].radius;
        const double distance = norm(row.robots[i].position - row.robots[j].position) - radii;
        nearest[i] = std::min(nearest[i], distance);
        nearest[j] = std::min(nearest[j], distance);
      }
    }
    for (std::size_t i = 0; i < robots.size(); ++i) all[i].values.push_back(nearest[i]);
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

void add_leader(const RecordingFile& run, const std::function<double(Vec2)>& component, const Range& range,
                DataFile& data, PlotCommand& plot) {
  if (!run.scenario.formation) return;
  const int index = data.begin("virtual leader", "t [s], value");
  std::vector<double> times, values;
  for (const Step& step : run.recording.steps) {
    times.push_back(step.time);
    values.push_back(component(step.leader_velocity));
  }
  const bool whole = times.size() <= kMostWholePoints || !are_finite(values);
  for (const std::size_t k : drawn_rows(times, values, shown_time(run), range, whole)) data.row({times[k], values[k]});
  plot.data(index, "using 1:2 with lines lw 1.5 dt (2,4) lc rgb 'black'", "virtual leader");
}

std::string velocity_panel(const RecordingFile& run, const std::string& title, const std::string& y_label,
                           const std::function<double(Vec2)>& component, DataFile& data) {
  PlotCommand plot;
  const std::vector<Series> all = velocity_components(run, component);
  const Range range = range_of(all);
  add_series(run, all, range, data, plot);
  add_leader(run, component, range, data, plot);
  return series_body(run, title, y_label, y_axis(range), plot);
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

/// m^2/s^2: smaller values of V are drawn here on a logarithmic axis.
constexpr double kLeastShown = 1e-24;

/// How many curves the whole figure has.
constexpr std::size_t kCurves = 20;

void add_curve(const Curve& curve, std::size_t number, const std::vector<LyapunovRow>& rows, double floor,
               const Range& range, DataFile& data, PlotCommand& plot) {
  const int index = data.begin(curve.label, "t [s], value");
  std::vector<double> times, values;
  for (const LyapunovRow& row : rows) {
    const double value = curve.value(row);
    if (!std::isfinite(value)) continue;
    times.push_back(row.time);
    values.push_back(std::max(value, floor));
  }
  const bool whole = rows.size() <= kMostWholePoints / kCurves;
  for (const std::size_t k : drawn_rows(times, values, std::max(rows.back().time, kLeastTime), range, whole))
    data.row({times[k], values[k]});
  plot.data(index,
            fmt::format("using 1:2 with lines lw {} lc rgb '{}'", curve.sum ? 4.0 : 1.5,
                        curve.sum ? "black" : series_colour(number)),
            curve.label);
}

std::vector<double> finite_values(const std::vector<Curve>& curves, const std::vector<LyapunovRow>& rows) {
  std::vector<double> values;
  for (const Curve& curve : curves)
    for (const LyapunovRow& row : rows)
      if (std::isfinite(curve.value(row))) values.push_back(curve.value(row));
  return values;
}

/// The range of a derivative: what all but the shortest spikes (the start, the leader's stop) need.
Range range_of_rates(std::vector<double> values) {
  constexpr double kShare = 0.98;  // of the values
  for (double& value : values) value = std::fabs(value);
  std::sort(values.begin(), values.end());
  const double most =
      std::max(1.5 * values[static_cast<std::size_t>(kShare * static_cast<double>(values.size() - 1))], 1e-6);
  return {-most, most};
}

/// The range of the values in one panel. REQUIRES: not empty.
Range panel_range(const std::vector<double>& values, Axis axis) {
  if (axis == Axis::rates) return range_of_rates(values);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (axis == Axis::linear) return {*least, std::max(*most, *least + kLeastRange)};
  const double low = std::max(*least, kLeastShown);
  return {low, std::max(*most, 10.0 * low), true};
}

std::string panel(const std::vector<Curve>& curves, const std::vector<LyapunovRow>& rows, const std::string& title,
                  const std::string& y_label, Axis axis, DataFile& data) {
  const bool logarithmic = axis == Axis::logarithmic;
  const std::vector<double> values = finite_values(curves, rows);
  const Range shown = values.empty() ? Range{0.0, 1.0} : panel_range(values, axis);
  PlotCommand plot;
  const double floor = logarithmic ? kLeastShown : -std::numeric_limits<double>::infinity();
  // The sum first and wide: a term that makes up all of it is seen within.
  for (const bool sum : {true, false})
    for (std::size_t i = 0; i < curves.size(); ++i)
      if (curves[i].sum == sum) add_curve(curves[i], i, rows, floor, shown, data, plot);
  const std::string range = axis == Axis::rates && !values.empty()
                                ? fmt::format("set yrange [{:.4g}:{:.4g}]", shown.low, shown.high)
                                : std::string("set autoscale y");
  const std::string scale =
      logarithmic ? "set logscale y\nunset mytics\nset format y '10^{%T}'\n" : "unset logscale y\nset format y '%g'\n";
  return filled(
      "lyapunov_panel",
      {{"title", quoted(title)}, {"y_label", markup(y_label)}, {"y_axis", scale + range}, {"plot", plot.text()}});
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

/// With a line at each greatest speed that the robots have. REQUIRES a robot on wheels.
std::string wheel_panel(const RecordingFile& run, const std::string& title, double formation::WheelSpeeds::*wheel,
                        DataFile& data) {
  PlotCommand plot;
  std::vector<Series> all;
  std::map<double, std::vector<std::string>> limits;  // m/s, and whose they are
  for (std::size_t i = 0; i < run.scenario.robots.size(); ++i) {
    const formation::Robot& robot = run.scenario.robots[i];
    if (!robot.drive) continue;
    limits[robot.drive->max_wheel_speed].push_back(robot.id);
    Series& series = all.emplace_back(Series{robot.id, {}});
    for (const Step& step : run.recording.steps)
      series.values.push_back(step.robots[i].wheels ? step.robots[i].wheels->speeds.*wheel : 0.0);
  }
  Range range = range_of(all);
  range.high = std::max(range.high, 1.05 * limits.rbegin()->first);
  add_series(run, all, range, data, plot);
  for (const auto& [speed, robots] : limits) {
    const std::string key =
        limits.size() == 1 ? "greatest speed" : fmt::format("at most {:.4g} m/s: {}", speed, fmt::join(robots, ", "));
    plot.item(fmt::format("{:.6g} with lines lw 1.5 dt (5,4) lc rgb 'black'", speed), shortened(key, kKeyLength));
  }
  return series_body(run, title, "speed on the ground [m/s]", y_axis(range), plot);
}

/// The speeds of both wheels. REQUIRES a robot on wheels.
Figure wheel_figure(const RecordingFile& run) {
  DataFile data;
  const std::string left =
      wheel_panel(run, "(a) " + run_title(run) + ": left wheels", &formation::WheelSpeeds::left, data);
  const std::string right = wheel_panel(run, "(b) right wheels", &formation::WheelSpeeds::right, data);
  return {"wheels", data.text(), "Speeds of the wheels in " + run_title(run) + ".", kTallCanvas,
          filled("velocity", {{"x", left}, {"y", right}})};
}

bool has_wheels(const RecordingFile& run) {
  const std::vector<formation::Robot>& robots = run.scenario.robots;
  return std::any_of(robots.begin(), robots.end(), [](const formation::Robot& r) { return r.drive.has_value(); });
}

/// The range of values above 0.
Range logarithmic_range(const std::vector<Series>& all) {
  Range range{1.0, 1.0, true};
  for (const Series& series : all) {
    for (const double value : series.values) {
      if (!std::isfinite(value)) continue;
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  }
  range.high = std::max(range.high, 10.0 * range.low);  // what gnuplot draws at least
  return range;
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
  add_series(run, all, logarithmic_range(all), data, plot);
  const std::string title = run_title(run) + ": distance of each robot from its slot";
  return {"formation_error", data.text(), title + ", logarithmic.", kCanvas,
          series_body(run, title, "|{/:Italic x}_i − {/:Italic x}_L − {/:Italic Δ}_i| [m]",
                      "set logscale y\nunset mytics\nset format y '10^{%T}'", plot)};
}

}  // namespace

std::vector<Figure> run_figures(const datasets::RecordingFile& run) {
  std::vector<Figure> figures{paths_figure(run)};
  if (!run.scenario.obstacles.empty() || !run.scenario.moving_obstacles.empty())
    figures.push_back(obstacle_distance_figure(run));
  if (run.scenario.robots.size() > 1) figures.push_back(robot_distance_figure(run));
  figures.push_back(velocity_figure(run));
  if (has_wheels(run)) figures.push_back(wheel_figure(run));
  if (run.scenario.formation) figures.push_back(formation_error_figure(run));
  if (!run.lyapunov.empty()) figures.push_back(lyapunov_figure(run));
  return figures;
}

Figure lyapunov_figure(const datasets::RecordingFile& run) {
  DataFile data;
  const std::vector<LyapunovRow>& rows = run.lyapunov;
  std::vector<LyapunovRow> moving = rows;
  if (moving.size() > 1) moving.pop_back();  // it has no decision, so no derivative
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
