// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/route/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/told_apart.h"
#include "figures/plane.h"
#include "support/escape.h"
#include "support/robot_numbers.h"
#include "support/route_certificates.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

using geometry::Blocked;
using geometry::ChainPoint;
using geometry::Route;
using geometry::Separated;

namespace {

constexpr const char* kSweptColour = "#cfe3f1";
constexpr const char* kStartColour = "#009E73";
constexpr const char* kChainColour = "#D55E00";

Points points_of(const Route& route) {
  Points points;
  for (const geometry::ExactPoint& p : route.points) points.push_back(p.rounded);
  return points;
}

/// What the disc sweeps over on one straight piece.
Points capsule(Vec2 a, Vec2 b, double radius) {
  constexpr int kSteps = 24;
  const Vec2 along = geometry::normalized(b - a);
  Points ring;
  for (const auto& [centre, forward] : {std::pair(b, along), std::pair(a, -along)}) {
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = (static_cast<double>(k) / kSteps - 0.5) * geometry::kPi;
      ring.push_back(centre + radius * geometry::rotated(forward, angle));
    }
  }
  return ring;
}

void add_swept(const Points& points, double radius, MapLayers& map) {
  std::vector<Points> pieces;
  for (std::size_t k = 1; k < points.size(); ++k) pieces.push_back(capsule(points[k - 1], points[k], radius));
  map.curves("swept by the disc", pieces, solid_fill(kSweptColour), true);
}

/// Along edges and across gaps, each gap with its width where there is room for all of them.
void add_chain(const Separated& separated, MapLayers& map) {
  constexpr std::size_t kMostLabels = 24;
  ChainLines lines;
  lines.add(separated.chain);
  map.curves("closed chain", lines.along, line_style(3.0, kChainColour), false);
  map.curves("gap, too narrow", lines.across, line_style(3.0, kChainColour, " dt (4,3)"), false);
  std::vector<Gap> gaps = gaps_of(separated);
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.width > b.width; });
  gaps.resize(std::min(gaps.size(), kMostLabels));
  std::vector<Label> labels;
  for (const Gap& gap : gaps) labels.push_back({0.5 * (gap.from + gap.to), fmt::format("{:.3g} m", gap.width)});
  map.labels("widths of gaps", labels,
             fmt::format("with labels left offset 0.6,0.6 font ',11' tc rgb '{}'", kChainColour));
}

std::string title_of_route(const AnsweredRoute& answered, const AskedMap& map) {
  const std::string file = std::filesystem::path(map.file).filename().string();
  const std::string disc = fmt::format("{}: a disc of radius {:.6g} m", file, answered.question.radius);
  if (const auto* route = std::get_if<Route>(&*answered.answer))
    return fmt::format("{} has a route of {:.6g} m", disc, route->length);
  if (std::holds_alternative<Separated>(*answered.answer)) return disc + " has no route";
  const bool is_start = std::get<geometry::Blocked>(*answered.answer).end == geometry::Blocked::End::start;
  return disc + (is_start ? " does not fit at the start" : " does not fit at the goal");
}

// --- The map ---

CellPlaces cells_of(const std::string& file, const datasets::ReadOptions& reading, const std::string& cell_point) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw UsageError("map", file, "a regular file: the size of a Moving AI map is read from it once more");
  const double side = reading.cell_size > 0.0 ? reading.cell_size : 1.0;
  return {datasets::read_map_size(file), side, cell_point == kCellPoints[0] ? 0.5 : 0.0};
}

formation::SceneObstacle border_of(const CellPlaces& cells) {
  const double x = static_cast<double>(cells.size.columns) * cells.side;
  const double y = static_cast<double>(cells.size.rows) * cells.side;
  return {"the border of the map", geometry::Polyline{{{0.0, 0.0}, {x, 0.0}, {x, y}, {0.0, y}, {0.0, 0.0}}}};
}

/// Listed in words; further ones are counted.
constexpr std::size_t kMostListed = 20;

const Gap& widest_of(const std::vector<Gap>& gaps) {
  return *std::max_element(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.width < b.width; });
}

std::string between(const Gap& gap, const AskedMap& map) {
  if (gap.from_obstacle == gap.to_obstacle) return "between two parts of " + map.name_of(gap.from_obstacle);
  return "between " + map.name_of(gap.from_obstacle) + " and " + map.name_of(gap.to_obstacle);
}

// --- Words ---

/// As WKT has them, every digit.
std::string line_string(const Route& route) {
  std::string text;
  for (const geometry::ExactPoint& p : route.points)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", p.rounded.x, p.rounded.y);
  return "LINESTRING (" + text + ")";
}

std::string words_of(const Route& route, bool in_full) {
  const std::size_t corners = route.points.size() < 2 ? 0 : route.points.size() - 2;
  const std::string text = fmt::format("route: {:.6g} m, no route is shorter than {:.6g} m, {} corner{}", route.length,
                                       route.lower_bound, corners, corners == 1 ? "" : "s");
  return in_full ? text + "\n" + line_string(route) : text;
}

std::string closed_by_obstacles(const Separated& separated, const AskedMap& map) {
  std::set<std::size_t> all;
  for (const ChainPoint& p : separated.chain) all.insert(p.on.obstacle);
  if (all.size() == 1) return "closed by " + map.name_of(*all.begin()) + " alone";
  std::string names;
  std::size_t listed = 0;
  for (const std::size_t obstacle : all) {
    if (listed++ == kMostListed) break;
    names += (names.empty() ? "" : ", ") + map.name_of(obstacle);
  }
  return fmt::format("closed by {} obstacles without a gap: {}{}", all.size(), names,
                     all.size() > kMostListed ? ", ..." : "");
}

std::string listed(const std::vector<Gap>& gaps, const AskedMap& map) {
  std::string text;
  for (std::size_t k = 0; k < std::min(gaps.size(), kMostListed); ++k)
    text += fmt::format("\n  gap of {:.6g} m {}, from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g})", gaps[k].width,
                        between(gaps[k], map), gaps[k].from.x, gaps[k].from.y, gaps[k].to.x, gaps[k].to.y);
  if (gaps.size() > kMostListed) text += fmt::format("\n  ... and {} more", gaps.size() - kMostListed);
  return text;
}

/// "start" or "goal"; nothing where the rounded chain cannot tell.
const char* enclosed_end(const Separated& separated, const geometry::RouteQuestion& question) {
  geometry::Polygon chain;
  for (const ChainPoint& p : separated.chain) chain.outer.push_back(p.point.rounded);
  const auto goes_round = [&](Vec2 p) { return geometry::locate(chain, p) == geometry::Place::inside; };
  const bool start = goes_round(question.start), goal = goes_round(question.goal);
  if (start == goal) return nullptr;
  return start ? "start" : "goal";
}

std::string words_of(const Separated& separated, const AskedMap& map, const geometry::RouteQuestion& question,
                     bool in_full) {
  const std::vector<Gap> gaps = gaps_of(separated);
  const char* const enclosed = enclosed_end(separated, question);
  const std::string begin = enclosed ? fmt::format("separated, the {} is enclosed: ", enclosed) : "separated: ";
  if (gaps.empty()) return begin + closed_by_obstacles(separated, map);
  const Gap& widest = widest_of(gaps);
  const auto [width, needed] = geometry::told_apart(widest.width, 2.0 * question.radius);
  const std::string text = gaps.size() == 1
                               ? begin + fmt::format("closed by 1 gap, {} m, {}, which would have to be {} m", width,
                                                     between(widest, map), needed)
                               : begin + fmt::format("closed by {} gaps; the widest, {} m, {}, would have to be {} m",
                                                     gaps.size(), width, between(widest, map), needed);
  return in_full ? text + listed(gaps, map) : text;
}

double distance_to(const Blocked& blocked, const AskedMap& map, Vec2 end) {
  return geometry::distance(geometry::edges_of(map.shapes[blocked.by.obstacle])[blocked.by.edge], end);
}

Vec2 end_of(const Blocked& blocked, const geometry::RouteQuestion& question) {
  return blocked.end == Blocked::End::start ? question.start : question.goal;
}

const char* end_name(const Blocked& blocked) {
  return blocked.end == Blocked::End::start ? "start" : "goal";
}

std::string words_of(const Blocked& blocked, const AskedMap& map, const geometry::RouteQuestion& question) {
  const std::string by = map.name_of(blocked.by.obstacle);
  if (blocked.inside) return fmt::format("blocked: the {} is inside {}", end_name(blocked), by);
  const double distance = distance_to(blocked, map, end_of(blocked, question));
  if (distance == 0.0 && question.radius > 0.0) return fmt::format("blocked: the {} is on {}", end_name(blocked), by);
  if (question.radius == 0.0)
    return fmt::format("blocked: the {} is on {}, with obstacles on every side of it", end_name(blocked), by);
  const auto [near, needed] = geometry::told_apart(distance, question.radius);
  return fmt::format("blocked: the {} is {} m from {} and would have to be {} m", end_name(blocked), near, by, needed);
}

// --- JSON ---

/// For people and their programs: the certificate alone is what is proven.
OrderedJson gaps_json(const Separated& separated, const AskedMap& map) {
  OrderedJson list = OrderedJson::array();
  for (const Gap& gap : gaps_of(separated))
    list.push_back({{"width", gap.width},
                    {"from", json_point(gap.from)},
                    {"to", json_point(gap.to)},
                    {"between", {map.obstacles[gap.from_obstacle].id, map.obstacles[gap.to_obstacle].id}}});
  return list;
}

OrderedJson blocked_json(const Blocked& blocked, const AskedMap& map, const geometry::RouteQuestion& question) {
  const OrderedJson distance =
      blocked.inside ? OrderedJson(nullptr) : OrderedJson(distance_to(blocked, map, end_of(blocked, question)));
  return {{"end", end_name(blocked)},
          {"inside", blocked.inside},
          {"obstacle", map.obstacles[blocked.by.obstacle].id},
          {"distance", distance}};
}

void add_answer(const AnsweredRoute& answered, const AskedMap& map, bool with_obstacles, OrderedJson& json) {
  const geometry::RouteAnswer& answer = *answered.answer;
  const auto* route = std::get_if<Route>(&answer);
  json["length"] = route ? OrderedJson(route->length) : OrderedJson(nullptr);
  json["lower_bound"] = route ? OrderedJson(route->lower_bound) : OrderedJson(nullptr);
  json["points"] = route ? rounded_json(route->points) : OrderedJson(nullptr);
  if (const auto* separated = std::get_if<Separated>(&answer)) {
    const char* const enclosed = enclosed_end(*separated, answered.question);
    json["enclosed"] = enclosed ? OrderedJson(enclosed) : OrderedJson(nullptr);
    json["needed_width"] = 2.0 * answered.question.radius;
    json["gaps"] = gaps_json(*separated, map);
  }
  if (const auto* blocked = std::get_if<Blocked>(&answer))
    json["blocked"] = blocked_json(*blocked, map, answered.question);
  json["certificate"] = tools::certificate_json(answered.question, answer, with_obstacles ? &map.obstacles : nullptr);
}

}  // namespace

std::optional<Vec2> AskedMap::in_metres(Vec2 given) const {
  if (!is_in_range(given)) return std::nullopt;
  if (!cells) return given;
  const double rows = static_cast<double>(cells->size.rows), columns = static_cast<double>(cells->size.columns);
  const double x = given.x + cells->offset, y = rows - (given.y + cells->offset);
  if (!(x >= 0.0 && x <= columns && y >= 0.0 && y <= rows)) return std::nullopt;
  return Vec2{x * cells->side, y * cells->side};
}

std::string AskedMap::accepted_points() const {
  if (!cells) return "two numbers within 2^100, X,Y in m";
  return fmt::format("a cell of the map, which has {} columns and {} rows: X,Y, the first 0,0", cells->size.columns,
                     cells->size.rows);
}

AskedMap read_asked_map(const std::string& file, const datasets::ReadOptions& reading, const std::string& cell_point) {
  datasets::ObstacleFile content = datasets::read_obstacles(file, reading);
  say_map(content);
  AskedMap map{file, content.format, std::move(content.obstacles), {}, std::nullopt};
  if (map.format == "movingai-map") {
    map.cells = cells_of(file, reading, cell_point);
    map.obstacles.push_back(border_of(*map.cells));
  }
  for (const formation::SceneObstacle& o : map.obstacles) map.shapes.push_back(o.shape);
  return map;
}

bool AnsweredRoute::is_route() const {
  return is_of_radius ? answer && std::holds_alternative<Route>(*answer) : widest.value_or(0.0) > 0.0;
}

std::vector<Gap> gaps_of(const Separated& separated) {
  std::vector<Gap> gaps;
  const std::vector<ChainPoint>& chain = separated.chain;
  for (std::size_t k = 0; k < chain.size(); ++k) {
    if (!chain[k].gap_follows) continue;
    const ChainPoint& next = chain[(k + 1) % chain.size()];
    const Vec2 from = chain[k].point.rounded, to = next.point.rounded;
    gaps.push_back({from, to, chain[k].on.obstacle, next.on.obstacle, geometry::norm(to - from)});
  }
  return gaps;
}

std::string words_of(const AnsweredRoute& answered, const AskedMap& map, bool in_full) {
  std::string text;
  if (answered.answer) {
    if (const auto* route = std::get_if<Route>(&*answered.answer)) text = words_of(*route, in_full);
    if (const auto* separated = std::get_if<Separated>(&*answered.answer))
      text = words_of(*separated, map, answered.question, in_full);
    if (const auto* blocked = std::get_if<Blocked>(&*answered.answer))
      text = words_of(*blocked, map, answered.question);
    text = shown_lines(text);
  }
  if (answered.widest) {
    if (answered.answer) text += in_full ? "\n" : "; ";
    text += map.shapes.empty()
                ? "widest radius: any, there is no obstacle"
                : fmt::format("widest radius: {}{} m", answered.is_widest_of_map ? "at least " : "", *answered.widest);
  }
  return text + "\n";
}

std::string json_of(const AnsweredRoute& answered, const AskedMap& map, bool with_obstacles) {
  OrderedJson json;
  json["index"] = answered.index;
  if (answered.answer) {
    json["status"] = status_of(*answered.answer);
    json["radius"] = answered.question.radius;
  }
  json["start"] = json_point(answered.question.start);
  json["goal"] = json_point(answered.question.goal);
  if (answered.widest) json["widest_radius"] = *answered.widest;
  if (answered.is_widest_of_map) json["widest_radius_is_bound_of_map"] = true;
  if (answered.answer) add_answer(answered, map, with_obstacles, json);
  return json_line(json);
}

Figure route_figure(const AnsweredRoute& answered, const AskedMap& asked) {
  EXACTVO_REQUIRE(answered.answer.has_value(), std::string("an answer to draw"));
  const geometry::RouteQuestion& question = answered.question;
  MapLayers map;
  const auto* route = std::get_if<Route>(&*answered.answer);
  if (route) add_swept(points_of(*route), question.radius, map);
  map.obstacles(asked.obstacles);
  if (const auto* separated = std::get_if<Separated>(&*answered.answer)) add_chain(*separated, map);
  if (route) map.curves("route", {points_of(*route)}, line_style(2.2, kRouteColour), false);
  map.curves("disc at the start", {outline(geometry::Disc{question.start, question.radius})},
             line_style(2.0, kStartColour), true);
  map.curves("disc at the goal", {outline(geometry::Disc{question.goal, question.radius})},
             line_style(2.0, kGoalColour), true);
  constexpr const char* kMiddle = "with points pt 7 ps 0.5 lc rgb '{}'";
  map.curves("start", {{question.start}}, fmt::format(kMiddle, kStartColour), false, false);
  map.curves("goal", {{question.goal}}, fmt::format(kMiddle, kGoalColour), false, false);
  return map.figure(title_of_route(answered, asked));
}

}  // namespace exactvo::tools
