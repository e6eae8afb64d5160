// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo route: whether a disc gets from A to B among obstacles, by a route or a reason why not, with certificates.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/routes.h"
#include "figures/figure.h"
#include "readers/line_reader.h"
#include "support/robot_numbers.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/route/answer.h"

namespace exactvo::tools {

using datasets::DataCode;
using geometry::Vec2;

namespace {

struct RouteFlags {
  std::string map;
  ReadingFlags reading;
  std::string cell_point = kCellPoints[0];
  std::string from, to, queries, figure;
  std::optional<double> radius;
  bool widest = false;
  bool repair = false;
  bool json = false;
};

// --- Many questions from a file or a pipe, one after the other: CSV with a header that has the columns start_x,
// start_y, goal_x and goal_y, or the .scen format of the Moving AI benchmarks ---

constexpr const char* kHeader = "a header with the columns start_x,start_y,goal_x,goal_y, or \"version 1\" of a .scen";

/// bucket, map, width, height, start x, start y, goal x, goal y, optimal length.
constexpr std::size_t kTaskFields = 9, kWidthField = 2, kStartField = 4;

struct RouteQuery {
  std::size_t index = 0;       ///< from 0
  geometry::Vec2 start, goal;  ///< as given
};

class RouteQueries {
 public:
  /// Reads the header. Throws DataError, as `next` does: a file without one, a .scen for another kind of map.
  RouteQueries(const std::string& file, const AskedMap& map) : lines_(file), map_(map) {
    if (!lines_.next_filled()) lines_.refuse(DataCode::format_syntax, "an empty file", kHeader);
    take_header();
  }

  /// The next question; nothing at the end.
  std::optional<RouteQuery> next() {
    if (!(is_scen_ ? lines_.next_filled() : lines_.next_row())) return std::nullopt;
    RouteQuery query = is_scen_ ? from_task() : from_columns();
    query.index = count_++;
    return query;
  }

  /// Throws DataError for the question that `next` gave last.
  [[noreturn]] void refuse(DataCode code, const std::string& found, const std::string& expected) const {
    lines_.refuse(code, found, expected);
  }

 private:
  void take_header() {
    const std::vector<std::string> words = lines_.fields();
    is_scen_ = words.size() == 2 && words[0] == "version" && (words[1] == "1" || words[1] == "1.0");
    if (is_scen_ && !map_.cells)
      lines_.refuse(DataCode::format_syntax, "cells of a Moving AI map",
                    fmt::format("CSV with coordinates, since {} is {}", map_.file, map_.format));
    if (!is_scen_)
      lines_.take_header({"start_x", "start_y", "goal_x", "goal_y"}, 4, kHeader, Table::OtherColumns::passed_over);
  }

  RouteQuery from_columns() const {
    const auto number = [&](const char* column) {
      double value = 0.0;
      if (!datasets::parse_whole(lines_.field(column), value) || !std::isfinite(value))
        lines_.refuse(DataCode::number, lines_.field(column), fmt::format("a number in the column {}", column));
      return value;
    };
    return {0, {number("start_x"), number("start_y")}, {number("goal_x"), number("goal_y")}};
  }

  RouteQuery from_task() const {
    // Tabs part fields, so that a map's name may hold blanks; some files have blanks throughout.
    std::vector<std::string_view> fields = datasets::fields_of(lines_.line(), '\t');
    if (fields.size() != kTaskFields) fields = datasets::words_of(lines_.line());
    if (fields.size() != kTaskFields)
      lines_.refuse(DataCode::wrong_count, fmt::format("{} fields", fields.size()),
                    fmt::format("{} fields", kTaskFields));
    std::array<double, 6> numbers{};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (!datasets::parse_whole(fields[kWidthField + k], numbers[k]) || numbers[k] != std::floor(numbers[k]))
        lines_.refuse(DataCode::number, fields[kWidthField + k], "a whole number of cells");
    }
    const datasets::MapSize& size = map_.cells->size;
    if (numbers[0] != static_cast<double>(size.columns) || numbers[1] != static_cast<double>(size.rows))
      lines_.refuse(DataCode::out_of_range, fmt::format("a task for a map of {} x {} cells", numbers[0], numbers[1]),
                    fmt::format("{} x {} cells, the size of {}", size.columns, size.rows, map_.file));
    static_assert(kStartField == kWidthField + 2);
    return {0, {numbers[2], numbers[3]}, {numbers[4], numbers[5]}};
  }

  using Table = datasets::CsvTable<datasets::TableLines>;
  Table lines_;
  const AskedMap& map_;
  bool is_scen_ = false;
  std::size_t count_ = 0;
};

// --- What goes together ---

void check_radius(const RouteFlags& flags) {
  require(flags.radius || flags.widest, "--radius", "nothing", "the radius of the disc in m, or --widest");
  if (!flags.radius) return;
  constexpr double kLeast = 0x1p-100;
  require(*flags.radius == 0.0 || (*flags.radius >= kLeast && *flags.radius <= kLargestNumber), "--radius",
          fmt::format("{}", *flags.radius), "0 (a point), or a length from 2^-100 m to 2^100 m");
}

void check(const RouteFlags& flags) {
  if (flags.queries.empty()) {
    require(!flags.from.empty(), "--from", "nothing", "the start, X,Y, or --queries FILE for many questions");
    require(!flags.to.empty(), "--to", "nothing", "the goal, X,Y");
  } else {
    refuse_both(!flags.from.empty(), "--queries", "--from");
    refuse_both(!flags.to.empty(), "--queries", "--to");
    refuse_both(!flags.figure.empty(), "--figure", "--queries",
                "a figure shows the answer to one question; give --from and --to");
  }
  check_radius(flags);
  if (!flags.figure.empty() && !flags.radius) throw lacking("--figure", "--radius", "it draws the disc to scale");
  require_known("--cell-point", flags.cell_point, {std::begin(kCellPoints), std::end(kCellPoints)});
  if (flags.figure.empty()) return;
  check_figure_name("--figure", flags.figure, all_read_with({flags.map}, flags.reading.format));
}

// --- Points ---

Vec2 point_in(const char* option, const std::string& text, const AskedMap& map) {
  const std::vector<std::string_view> fields = datasets::fields_of(text, ',');
  Vec2 p;
  const bool is_point =
      fields.size() == 2 && datasets::parse_whole(fields[0], p.x) && datasets::parse_whole(fields[1], p.y);
  const std::optional<Vec2> metres = is_point ? map.in_metres(p) : std::nullopt;
  if (!metres) throw UsageError(option, text, map.accepted_points());
  return *metres;
}

geometry::Box box_of(const AskedMap& map) {
  geometry::Box box;
  for (const geometry::Obstacle& obstacle : map.shapes)
    for (const Vec2 p : geometry::vertices_of(obstacle)) box.add(p);
  return box.is_empty() ? geometry::Box{{0.0, 0.0}, {0.0, 0.0}} : box;
}

/// m: how far outside of the obstacles' box the points lie, in x or in y.
double distance_of(const geometry::Box& box, std::initializer_list<Vec2> points) {
  double distance = 0.0;
  for (const Vec2 p : points)
    distance = std::max({distance, box.low.x - p.x, p.x - box.high.x, box.low.y - p.y, p.y - box.high.y});
  return distance;
}

/// What a map has to cover for points so far outside of the obstacles' box.
geometry::RouteMapOptions options_for(const RouteFlags& flags, const geometry::Box& box, double distance) {
  // No point keeps farther from all obstacles than sqrt 2 (distance + side): no wider disc is free anywhere.
  const double side = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  const double widest = flags.widest ? 2.0 * (distance + side) : 0.0;
  const auto within_range = [](double length) { return std::min(length, kLargestNumber); };
  return {within_range(std::max(flags.radius.value_or(0.0), widest)),
          within_range(2.0 * distance)};  // twice: more than is needed, whatever is rounded
}

// --- Answering ---

class Answers {
 public:
  Answers(const AskedMap& asked, const RouteFlags& flags, const geometry::RouteMapOptions& options)
      : asked_(asked), flags_(flags), routes_(asked.shapes, options) {
    if (flags.radius) plan_.emplace(routes_, *flags.radius);
  }

  bool covers(Vec2 point) const { return routes_.covers(point); }

  AnsweredRoute answer(std::size_t index, Vec2 start, Vec2 goal) {
    AnsweredRoute answered{index,        {flags_.radius.value_or(0.0), start, goal},
                           std::nullopt, std::nullopt,
                           false,        flags_.radius.has_value()};
    if (flags_.radius) answered.answer = plan_->query(start, goal);
    if (!flags_.widest) return answered;
    answered.widest = routes_.widest_radius(start, goal);
    answered.is_widest_of_map = *answered.widest == routes_.largest_radius();
    if (*answered.widest == 0.0 && !answered.answer) answered.answer = answer_for_a_point(start, goal);
    return answered;
  }

  /// Obstacles go with the first certificate.
  void print_answer(const AnsweredRoute& answered) {
    if (flags_.json) {
      print(json_of(answered, asked_, !has_certificate_));
      has_certificate_ = has_certificate_ || answered.answer;
      return;
    }
    const bool is_one_of_many = !flags_.queries.empty();
    print((is_one_of_many ? fmt::format("{}: ", answered.index) : "") + words_of(answered, asked_, !is_one_of_many));
  }

 private:
  /// Why no disc has a route: what stops even a point. REQUIRES: no radius is asked for.
  geometry::RouteAnswer answer_for_a_point(Vec2 start, Vec2 goal) {
    if (!plan_) plan_.emplace(routes_, 0.0);
    return plan_->query(start, goal);
  }

  const AskedMap& asked_;
  const RouteFlags& flags_;
  geometry::RouteMap routes_;
  std::optional<geometry::RoutePlan> plan_;  ///< of the radius, or of a point where none is given
  bool has_certificate_ = false;             ///< one was printed
};

ExitCode answer_one(const AskedMap& map, const RouteFlags& flags) {
  const Vec2 start = point_in("--from", flags.from, map), goal = point_in("--to", flags.to, map);
  const geometry::Box box = box_of(map);
  Answers answers(map, flags, options_for(flags, box, distance_of(box, {start, goal})));
  const AnsweredRoute answered = answers.answer(0, start, goal);
  if (!flags.figure.empty()) write_figure(route_figure(answered, map), flags.figure);
  answers.print_answer(answered);
  return answered.is_route() ? ExitCode::success : ExitCode::negative;
}

Vec2 place_of(Vec2 given, const char* end, const AskedMap& map, const Answers& answers, const RouteQueries& queries) {
  const std::optional<Vec2> metres = map.in_metres(given);
  const std::string found = fmt::format("the {} {},{}", end, given.x, given.y);
  if (!metres) queries.refuse(datasets::DataCode::out_of_range, found, map.accepted_points());
  if (!answers.covers(*metres))
    queries.refuse(datasets::DataCode::out_of_range, found,
                   "a point within four times the size of the map from it (--from and --to take any)");
  return *metres;
}

/// A multiple of the longer side of the obstacles' box.
constexpr double kFarthestOfQueries = 4.0;
/// m; all that --from and --to take.
constexpr double kFarthestOfEmptyMap = kLargestNumber;

ExitCode answer_many(const AskedMap& map, const RouteFlags& flags) {
  RouteQueries queries(flags.queries, map);
  const geometry::Box box = box_of(map);
  const double side = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  const double farthest = map.shapes.empty() ? kFarthestOfEmptyMap : kFarthestOfQueries * side;
  Answers answers(map, flags, options_for(flags, box, farthest));
  bool all = true;
  while (const std::optional<RouteQuery> query = queries.next()) {
    const Vec2 start = place_of(query->start, "start", map, answers, queries);
    const Vec2 goal = place_of(query->goal, "goal", map, answers, queries);
    const AnsweredRoute answered = answers.answer(query->index, start, goal);
    answers.print_answer(answered);
    all = all && answered.is_route();
  }
  return all ? ExitCode::success : ExitCode::negative;
}

/// Share of a cell's side: its sum with the number of a cell up to 2^16 is exact, and it is negligible against any
/// length.
constexpr double kIntoCell = 0x1p-36;

ExitCode route(const RouteFlags& flags) {
  check(flags);
  datasets::ReadOptions reading = reading_options(flags.reading);
  reading.keep_going = false;
  reading.repair = flags.repair;
  AskedMap map = read_asked_map(flags.map, reading, flags.cell_point);
  if (map.cells) {
    // A corner where two blocked cells touch has a free cell on either side: it stands for the one that is named.
    const bool is_moved = flags.radius == 0.0 && map.cells->offset == 0.0;
    if (is_moved) map.cells->offset = kIntoCell;
    message(fmt::format(
        "{}: points are {}s of cells{}, columns from the left and rows from the top, from 0; answers are "
        "in m, y upward",
        map.file, flags.cell_point, is_moved ? fmt::format(", moved into them by {:.2g} of a side", kIntoCell) : ""));
  }
  const TerminateOnSignal terminate_on_signal;
  return flags.queries.empty() ? answer_one(map, flags) : answer_many(map, flags);
}

void declare_route(CLI::App& app, RouteFlags& flags) {
  app.add_option("map", flags.map, "An obstacle file of any readable format, or a scenario")->required();
  app.add_option("--from", flags.from,
                 "Start X,Y in metres of the map as it is read (one in degrees is projected, and a message says how); "
                 "on a Moving AI map a cell, as in its .scen");
  app.add_option("--to", flags.to, "Goal X,Y, likewise");
  app.add_option("--radius", flags.radius,
                 "Radius of the disc, m; 0: a point, which touches obstacles with its start and goal at most");
  app.add_flag("--widest", flags.widest,
               "The largest radius for which there is a route, an exact double; 0 with the reason if there is none");
  app.add_option("--queries", flags.queries,
                 "FILE, or - for stdin: many questions, one line of answer each. CSV with the columns "
                 "start_x,start_y,goal_x,goal_y, or a .scen of the Moving AI benchmarks");
  app.add_option("--cell-point", flags.cell_point, "Point of a cell of a Moving AI map: middle, or corner (top left)")
      ->capture_default_str();
  declare_reading_flags(app, flags.reading);
  app.add_flag("--repair", flags.repair, "Repair invalid geometry first");
  app.add_flag("--json", flags.json, "One line of JSON per question, with its certificate");
  app.add_option("--figure", flags.figure, std::string("Of the answer for --radius. ") + kFigureFileHelp);
}

}  // namespace

Verb route_verb() {
  return {"route", "Decide whether a disc gets from A to B: a route, or the closed chain of obstacles and gaps",
          "  exactvo route office.geojson --from 2,3 --to 18,7 --radius 0.4 --figure out/route.svg\n"
          "  exactvo route office.geojson --from 2,3 --to 18,7 --widest\n"
          "  exactvo route arena.map --queries arena.map.scen --radius 0.3 --json > answers.jsonl\n"
          "  exactvo audit --certificate answers.jsonl\n"
          "    (status 1: for one question at least there is no route; answers of --queries are printed as the "
          "questions are\n"
          "    read, so those before a bad line stay)\n",
          with_flags(declare_route, route)};
}

}  // namespace exactvo::tools
