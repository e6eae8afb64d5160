// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/route_certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace exactvo::tools {

using geometry::Blocked;
using geometry::ChainPoint;
using geometry::EdgeName;
using geometry::ExactPoint;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::Route;
using geometry::RouteAnswer;
using geometry::RouteQuestion;
using geometry::Separated;
using geometry::Vec2;

namespace {

constexpr const char* kStatuses[] = {"route", "separated", "blocked"};  // in the order of RouteAnswer

// --- Writing ---

RouteJson json_of(Vec2 p) {
  return RouteJson::array({p.x, p.y});
}

RouteJson json_of(const std::vector<Vec2>& points) {
  RouteJson list = RouteJson::array();
  for (const Vec2 p : points) list.push_back(json_of(p));
  return list;
}

/// [x, y], or [x, y, "n/d", "n/d"] where a coordinate is no double; "" for one that is.
RouteJson json_of(const ExactPoint& p) {
  RouteJson list = json_of(p.rounded);
  if (p.x.empty() && p.y.empty()) return list;
  list.push_back(p.x);
  list.push_back(p.y);
  return list;
}

RouteJson json_of(const formation::SceneObstacle& obstacle) {
  RouteJson json{{"id", obstacle.id}};
  if (const auto* wall = std::get_if<Polyline>(&obstacle.shape)) {
    json["polyline"] = json_of(wall->points);
    return json;
  }
  const auto& polygon = std::get<Polygon>(obstacle.shape);
  json["polygon"] = json_of(polygon.outer);
  if (polygon.holes.empty()) return json;
  json["holes"] = RouteJson::array();
  for (const geometry::Ring& hole : polygon.holes) json["holes"].push_back(json_of(hole));
  return json;
}

void add(const Route& route, RouteJson& json) {
  json["length"] = route.length;
  json["lower_bound"] = route.lower_bound;
  json["points"] = RouteJson::array();
  for (const ExactPoint& p : route.points) json["points"].push_back(json_of(p));
}

void add(const Separated& separated, RouteJson& json) {
  json["chain"] = RouteJson::array();
  for (const ChainPoint& p : separated.chain)
    json["chain"].push_back(
        {{"point", json_of(p.point)}, {"obstacle", p.on.obstacle}, {"edge", p.on.edge}, {"gap", p.gap_follows}});
}

void add(const Blocked& blocked, RouteJson& json) {
  json["end"] = blocked.end == Blocked::End::start ? "start" : "goal";
  json["inside"] = blocked.inside;
  json["obstacle"] = blocked.by.obstacle;
  if (!blocked.inside) json["edge"] = blocked.by.edge;
}

// --- Reading: nothing where a member is missing or of another type ---

const RouteJson* member(const RouteJson& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<double> number_in(const RouteJson* json) {
  if (json == nullptr || !json->is_number()) return std::nullopt;
  const double value = json->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<Vec2> pair_in(const RouteJson* json) {
  if (json == nullptr || !json->is_array() || json->size() != 2) return std::nullopt;
  const std::optional<double> x = number_in(&(*json)[0]), y = number_in(&(*json)[1]);
  return x && y ? std::optional(Vec2{*x, *y}) : std::nullopt;
}

std::optional<ExactPoint> point_in(const RouteJson* json) {
  if (json == nullptr || !json->is_array() || (json->size() != 2 && json->size() != 4)) return std::nullopt;
  const std::optional<double> x = number_in(&(*json)[0]), y = number_in(&(*json)[1]);
  if (!x || !y) return std::nullopt;
  ExactPoint point{{*x, *y}, "", ""};
  if (json->size() == 2) return point;
  if (!(*json)[2].is_string() || !(*json)[3].is_string()) return std::nullopt;
  point.x = (*json)[2].get<std::string>();
  point.y = (*json)[3].get<std::string>();
  return point;
}

/// A list of what `read` reads, at least `least` long.
template <typename Value, typename Read>
std::optional<std::vector<Value>> list_in(const RouteJson* json, std::size_t least, const Read& read) {
  if (json == nullptr || !json->is_array() || json->size() < least) return std::nullopt;
  std::vector<Value> list;
  for (const RouteJson& item : *json) {
    std::optional<Value> value = read(&item);
    if (!value) return std::nullopt;
    list.push_back(std::move(*value));
  }
  return list;
}

std::optional<std::vector<Vec2>> points_in(const RouteJson* json, std::size_t least) {
  return list_in<Vec2>(json, least, pair_in);
}

std::optional<Obstacle> obstacle_in(const RouteJson* json) {
  constexpr std::size_t kLeastOfWall = 2, kLeastOfRing = 3;
  if (member(*json, "polyline") && member(*json, "polygon")) return std::nullopt;
  if (const RouteJson* wall = member(*json, "polyline")) {
    auto points = points_in(wall, kLeastOfWall);
    return points ? std::optional<Obstacle>(Polyline{std::move(*points)}) : std::nullopt;
  }
  auto outer = points_in(member(*json, "polygon"), kLeastOfRing);
  if (!outer) return std::nullopt;
  Polygon polygon{std::move(*outer), {}};
  if (const RouteJson* holes = member(*json, "holes")) {
    const auto ring_in = [](const RouteJson* ring) { return points_in(ring, kLeastOfRing); };
    auto rings = list_in<geometry::Ring>(holes, 0, ring_in);
    if (!rings) return std::nullopt;
    polygon.holes = std::move(*rings);
  }
  return polygon;
}

std::optional<std::size_t> number_of(const RouteJson& json, const char* key) {
  const RouteJson* number = member(json, key);
  if (number == nullptr || !number->is_number_unsigned()) return std::nullopt;
  return number->get<std::size_t>();
}

std::optional<EdgeName> edge_in(const RouteJson& json) {
  const std::optional<std::size_t> obstacle = number_of(json, "obstacle"), edge = number_of(json, "edge");
  return obstacle && edge ? std::optional(EdgeName{*obstacle, *edge}) : std::nullopt;
}

std::optional<ChainPoint> chain_point_in(const RouteJson* json) {
  const std::optional<ExactPoint> point = point_in(member(*json, "point"));
  const std::optional<EdgeName> on = edge_in(*json);
  const RouteJson* gap = member(*json, "gap");
  if (!point || !on || gap == nullptr || !gap->is_boolean()) return std::nullopt;
  return ChainPoint{*point, *on, gap->get<bool>()};
}

std::optional<RouteAnswer> route_in(const RouteJson& json) {
  auto points = list_in<ExactPoint>(member(json, "points"), 1, point_in);
  const std::optional<double> length = number_in(member(json, "length"));
  const std::optional<double> lower_bound = number_in(member(json, "lower_bound"));
  if (!points || !length || !lower_bound) return std::nullopt;
  return Route{std::move(*points), *length, *lower_bound};
}

std::optional<RouteAnswer> separated_in(const RouteJson& json) {
  auto chain = list_in<ChainPoint>(member(json, "chain"), 1, chain_point_in);
  if (!chain) return std::nullopt;
  return Separated{std::move(*chain)};
}

/// Inside a polygon no edge of it counts.
std::optional<RouteAnswer> blocked_in(const RouteJson& json) {
  const RouteJson *end = member(json, "end"), *inside = member(json, "inside");
  if (end == nullptr || (*end != "start" && *end != "goal") || inside == nullptr || !inside->is_boolean())
    return std::nullopt;
  const bool is_inside = inside->get<bool>();
  const std::optional<std::size_t> obstacle = number_of(json, "obstacle"), edge = number_of(json, "edge");
  if (!obstacle || (!is_inside && !edge)) return std::nullopt;
  return Blocked{*end == "start" ? Blocked::End::start : Blocked::End::goal, is_inside,
                 EdgeName{*obstacle, edge.value_or(0)}};
}

std::optional<RouteAnswer> answer_in(const RouteJson& json) {
  const std::string kind = json.at("kind").get<std::string>();
  if (kind == "route") return route_in(json);
  return kind == "separated" ? separated_in(json) : blocked_in(json);
}

std::optional<RouteQuestion> question_in(const RouteJson& json) {
  const std::optional<double> radius = number_in(member(json, "radius"));
  const std::optional<Vec2> start = pair_in(member(json, "start")), goal = pair_in(member(json, "goal"));
  if (!radius || !(*radius >= 0.0) || !start || !goal) return std::nullopt;
  return RouteQuestion{*radius, *start, *goal};
}

bool is_status(const RouteJson* json) {
  return json != nullptr &&
         std::any_of(std::begin(kStatuses), std::end(kStatuses), [&](const char* status) { return *json == status; });
}

// --- What stands beside it ---

/// Whether `beside` has no such member, or it is `value`.
bool agrees(const RouteJson& beside, const char* key, const RouteJson& value) {
  const RouteJson* said = member(beside, key);
  return said == nullptr || *said == value;
}

/// Whether the widest radius, where it stands beside, has a route exactly if it is no less than that of the question.
bool agrees_in_widest(const RouteJson& beside, double radius, bool is_route) {
  const RouteJson* widest = member(beside, "widest_radius");
  if (widest == nullptr) return true;
  const std::optional<double> number = number_in(widest);
  return number && (*number >= radius && *number > 0.0) == is_route;
}

/// Whether the gaps that stand beside start at those points of the chain behind which there is one.
bool agrees_in_gaps(const RouteJson& beside, const RouteAnswer& answer) {
  const RouteJson* gaps = member(beside, "gaps");
  if (gaps == nullptr) return true;
  std::vector<Vec2> expected;
  if (const auto* separated = std::get_if<Separated>(&answer))
    for (const ChainPoint& p : separated->chain)
      if (p.gap_follows) expected.push_back(p.point.rounded);
  const auto from_of = [](const RouteJson* gap) { return pair_in(member(*gap, "from")); };
  const std::optional<std::vector<Vec2>> found = list_in<Vec2>(gaps, 0, from_of);
  return found && *found == expected;
}

bool agrees_in_end(const RouteJson& beside, const RouteJson& certificate) {
  const RouteJson* blocked = member(beside, "blocked");
  if (blocked == nullptr) return true;
  const auto same = [&](const char* key) {
    const RouteJson *said = member(*blocked, key), *proven = member(certificate, key);
    return said && proven && *said == *proven;
  };
  return same("end") && same("inside");
}

bool is_of_this_answer(const RouteJson& beside, const RouteJson& certificate, const RouteQuestion& question,
                       const RouteAnswer& answer) {
  const auto* route = std::get_if<Route>(&answer);
  const RouteJson none = nullptr;
  return agrees(beside, "status", certificate.at("kind")) && agrees(beside, "radius", certificate.at("radius")) &&
         agrees(beside, "start", certificate.at("start")) && agrees(beside, "goal", certificate.at("goal")) &&
         agrees(beside, "length", route ? certificate.at("length") : none) &&
         agrees(beside, "lower_bound", route ? certificate.at("lower_bound") : none) &&
         agrees(beside, "points", route ? rounded_json(route->points) : none) &&
         agrees(beside, "needed_width", 2.0 * question.radius) && agrees_in_gaps(beside, answer) &&
         agrees_in_end(beside, certificate) && agrees_in_widest(beside, question.radius, route != nullptr);
}

std::string claim_words(const RouteQuestion& q, const RouteAnswer& answer, std::size_t obstacles) {
  const std::string from_to =
      fmt::format("radius {:.6g} m from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}), {} obstacle{}", q.radius, q.start.x,
                  q.start.y, q.goal.x, q.goal.y, obstacles, obstacles == 1 ? "" : "s");
  if (const auto* route = std::get_if<Route>(&answer))
    return fmt::format("a route of {:.6g} m, {}", route->length, from_to);
  if (const auto* chain = std::get_if<Separated>(&answer))
    return fmt::format("no route, by a chain of {} points, {}", chain->chain.size(), from_to);
  const bool is_start = std::get<Blocked>(answer).end == Blocked::End::start;
  return fmt::format("no route, the {} is not free, {}", is_start ? "start" : "goal", from_to);
}

}  // namespace

const char* status_of(const RouteAnswer& answer) {
  return kStatuses[answer.index()];
}

RouteJson rounded_json(const std::vector<ExactPoint>& points) {
  RouteJson list = RouteJson::array();
  for (const ExactPoint& p : points) list.push_back(json_of(p.rounded));
  return list;
}

RouteJson certificate_json(const RouteQuestion& question, const RouteAnswer& answer,
                           const std::vector<formation::SceneObstacle>* obstacles) {
  RouteJson json{{"kind", status_of(answer)},
                 {"radius", question.radius},
                 {"start", json_of(question.start)},
                 {"goal", json_of(question.goal)}};
  std::visit([&](const auto& kind) { add(kind, json); }, answer);
  if (obstacles == nullptr) return json;
  json["obstacles"] = RouteJson::array();
  for (const formation::SceneObstacle& obstacle : *obstacles) json["obstacles"].push_back(json_of(obstacle));
  return json;
}

bool RouteChecker::is_one(const RouteJson& certificate) {
  return is_status(member(certificate, "kind"));
}

bool RouteChecker::lacks_one(const RouteJson& object) {
  const RouteJson* certificate = member(object, "certificate");
  return is_status(member(object, "status")) && (certificate == nullptr || certificate->is_null());
}

CheckedCertificate RouteChecker::check_one(const RouteJson& certificate, const RouteJson& beside) {
  const std::optional<RouteQuestion> question = question_in(certificate);
  const std::optional<RouteAnswer> answer = answer_in(certificate);
  if (!question || !answer) return {"not a certificate", "", false};
  if (const RouteJson* listed = member(certificate, "obstacles")) {
    obstacles_ = list_in<Obstacle>(listed, 0, obstacle_in);
    if (!obstacles_) return {"obstacles that cannot be read", "", false};
  }
  if (!obstacles_) return {"no obstacles: neither in it nor in one before it", "", false};
  const std::string claim = claim_words(*question, *answer, obstacles_->size());
  const std::string why = geometry::check(*obstacles_, *question, *answer);
  if (!why.empty()) return {"not proven: " + why, claim, false};
  if (!is_of_this_answer(beside, certificate, *question, *answer)) return {"of another answer", claim, false};
  return {"valid", claim, true};
}

}  // namespace exactvo::tools
