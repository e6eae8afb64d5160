// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/route_certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "support/certificate_json.h"

namespace exactvo::tools {

using geometry::Blocked;
using geometry::ChainPoint;
using geometry::EdgeName;
using geometry::ExactPoint;
using geometry::Obstacle;
using geometry::Route;
using geometry::RouteAnswer;
using geometry::RouteQuestion;
using geometry::Separated;
using geometry::Vec2;

namespace {

constexpr const char* kStatuses[] = {"route", "separated", "blocked"};  // in the order of RouteAnswer

// --- Writing ---

OrderedJson json_of(Vec2 p) {
  return json_point(p);
}

/// [x, y], or [x, y, "n/d", "n/d"] where a coordinate is no double; "" for one that is.
OrderedJson json_of(const ExactPoint& p) {
  OrderedJson list = json_of(p.rounded);
  if (p.x.empty() && p.y.empty()) return list;
  list.push_back(p.x);
  list.push_back(p.y);
  return list;
}

OrderedJson json_of(const ChainPoint& p) {
  return {{"point", json_of(p.point)}, {"obstacle", p.on.obstacle}, {"edge", p.on.edge}, {"gap", p.gap_follows}};
}

template <typename Value>
OrderedJson json_of(const std::vector<Value>& values) {
  OrderedJson list = OrderedJson::array();
  for (const Value& value : values) list.push_back(json_of(value));
  return list;
}

void add(const Route& route, OrderedJson& json) {
  json["length"] = route.length;
  json["lower_bound"] = route.lower_bound;
  json["points"] = json_of(route.points);
}

void add(const Separated& separated, OrderedJson& json) {
  json["chain"] = json_of(separated.chain);
}

void add(const Blocked& blocked, OrderedJson& json) {
  json["end"] = blocked.end == Blocked::End::start ? "start" : "goal";
  json["inside"] = blocked.inside;
  json["obstacle"] = blocked.by.obstacle;
  if (!blocked.inside) json["edge"] = blocked.by.edge;
}

// --- Reading (certificate_json.h) ---

ExactPoint point_in(const OrderedJson& json) {
  require_readable(json.is_array() && (json.size() == 2 || json.size() == 4));
  ExactPoint point{{json[0].get<double>(), json[1].get<double>()}, "", ""};
  if (json.size() == 2) return point;
  json[2].get_to(point.x);
  json[3].get_to(point.y);
  return point;
}

/// Neither negative nor a fraction, which `get` would convert.
std::size_t number_in(const OrderedJson& json) {
  return json.get_ref<const OrderedJson::number_unsigned_t&>();
}

ChainPoint chain_point_in(const OrderedJson& json) {
  return {point_in(json.at("point")),
          {number_in(json.at("obstacle")), number_in(json.at("edge"))},
          json.at("gap").get<bool>()};
}

/// Inside a polygon no edge of it counts.
Blocked blocked_in(const OrderedJson& json) {
  const bool is_start = json.at("end") == "start", is_inside = json.at("inside").get<bool>();
  require_readable(is_start || json.at("end") == "goal");
  return {is_start ? Blocked::End::start : Blocked::End::goal, is_inside,
          EdgeName{number_in(json.at("obstacle")), is_inside ? 0 : number_in(json.at("edge"))}};
}

RouteAnswer answer_in(const OrderedJson& json) {
  const OrderedJson& kind = json.at("kind");
  if (kind == "separated") return Separated{list_in(json.at("chain"), 1, chain_point_in)};
  if (kind == "blocked") return blocked_in(json);
  return Route{list_in(json.at("points"), 1, point_in), json.at("length").get<double>(),
               json.at("lower_bound").get<double>()};
}

RouteQuestion question_in(const OrderedJson& json) {
  const RouteQuestion question{json.at("radius").get<double>(), pair_in(json.at("start")), pair_in(json.at("goal"))};
  require_readable(question.radius >= 0.0);
  return question;
}

bool is_status(const OrderedJson* json) {
  return json != nullptr &&
         std::any_of(std::begin(kStatuses), std::end(kStatuses), [&](const char* status) { return *json == status; });
}

// --- What stands beside it ---

/// Whether `beside` has no such member, or it is `value`.
bool agrees(const OrderedJson& beside, const char* key, const OrderedJson& value) {
  const OrderedJson* said = member(beside, key);
  return said == nullptr || *said == value;
}

/// Whether no disc has a route, however small, since an end lies on an edge.
bool is_in_contact(const std::vector<Obstacle>& obstacles, const RouteQuestion& question) {
  constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
  const auto has_room = [&](Vec2 p) {
    return geometry::check(obstacles, {kSmallest, p, p}, Route{{{p, {}, {}}}, 0.0, 0.0}).empty();
  };
  return !has_room(question.start) || !has_room(question.goal);
}

/// Whether the widest radius, where it stands beside, has a route exactly if it is no less than that of the question.
bool agrees_in_widest(const OrderedJson& beside, const std::vector<Obstacle>& obstacles, const RouteQuestion& question,
                      bool is_route) {
  const OrderedJson* widest = member(beside, "widest_radius");
  if (widest == nullptr) return true;
  if (!widest->is_number()) return false;
  const double number = widest->get<double>();
  const bool is_of_disc = is_route && !(question.radius == 0.0 && is_in_contact(obstacles, question));
  return (number >= question.radius && number > 0.0) == is_of_disc;
}

/// Whether the gaps that stand beside start at those points of the chain behind which there is one.
bool agrees_in_gaps(const OrderedJson& beside, const RouteAnswer& answer) {
  const OrderedJson* gaps = member(beside, "gaps");
  if (gaps == nullptr) return true;
  std::vector<Vec2> expected;
  if (const auto* separated = std::get_if<Separated>(&answer))
    for (const ChainPoint& p : separated->chain)
      if (p.gap_follows) expected.push_back(p.point.rounded);
  const auto begins_at = [](const OrderedJson& gap, Vec2 p) {
    const OrderedJson* from = member(gap, "from");
    return from != nullptr && *from == json_of(p);
  };
  return gaps->is_array() && std::equal(gaps->begin(), gaps->end(), expected.begin(), expected.end(), begins_at);
}

bool agrees_in_end(const OrderedJson& beside, const OrderedJson& certificate) {
  const OrderedJson* blocked = member(beside, "blocked");
  if (blocked == nullptr) return true;
  const auto same = [&](const char* key) {
    const OrderedJson *said = member(*blocked, key), *proven = member(certificate, key);
    return said && proven && *said == *proven;
  };
  return same("end") && same("inside");
}

bool is_of_this_answer(const OrderedJson& beside, const OrderedJson& certificate,
                       const std::vector<Obstacle>& obstacles, const RouteQuestion& question,
                       const RouteAnswer& answer) {
  const auto* route = std::get_if<Route>(&answer);
  const OrderedJson none = nullptr;
  return agrees(beside, "status", certificate.at("kind")) && agrees(beside, "radius", certificate.at("radius")) &&
         agrees(beside, "start", certificate.at("start")) && agrees(beside, "goal", certificate.at("goal")) &&
         agrees(beside, "length", route ? certificate.at("length") : none) &&
         agrees(beside, "lower_bound", route ? certificate.at("lower_bound") : none) &&
         agrees(beside, "points", route ? rounded_json(route->points) : none) &&
         agrees(beside, "needed_width", 2.0 * question.radius) && agrees_in_gaps(beside, answer) &&
         agrees_in_end(beside, certificate) && agrees_in_widest(beside, obstacles, question, route != nullptr);
}

std::string claim_words(const RouteQuestion& q, const RouteAnswer& answer, std::size_t obstacles) {
  const std::string from_to =
      fmt::format("radius {:.6g} m from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}), {}", q.radius, q.start.x, q.start.y,
                  q.goal.x, q.goal.y, geometry::counted(obstacles, "obstacle"));
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

OrderedJson rounded_json(const std::vector<ExactPoint>& points) {
  OrderedJson list = OrderedJson::array();
  for (const ExactPoint& p : points) list.push_back(json_of(p.rounded));
  return list;
}

OrderedJson certificate_json(const RouteQuestion& question, const RouteAnswer& answer,
                             const std::vector<formation::SceneObstacle>* obstacles) {
  OrderedJson json{{"kind", status_of(answer)},
                   {"radius", question.radius},
                   {"start", json_of(question.start)},
                   {"goal", json_of(question.goal)}};
  std::visit([&](const auto& kind) { add(kind, json); }, answer);
  if (obstacles == nullptr) return json;
  json["obstacles"] = OrderedJson::array();
  for (const formation::SceneObstacle& obstacle : *obstacles) json["obstacles"].push_back(obstacle_json(obstacle));
  return json;
}

bool RouteChecker::is_one(const OrderedJson& certificate) {
  return is_status(member(certificate, "kind"));
}

bool RouteChecker::lacks_one(const OrderedJson& object) {
  const OrderedJson* certificate = member(object, "certificate");
  return is_status(member(object, "status")) && (certificate == nullptr || certificate->is_null());
}

CheckedCertificate RouteChecker::check_one(const OrderedJson& certificate, const OrderedJson& beside) {
  const auto read = read_or_nothing([&] { return std::pair(question_in(certificate), answer_in(certificate)); });
  if (!read) return {"not a certificate", "", false};
  const auto& [question, answer] = *read;
  if (const OrderedJson* listed = member(certificate, "obstacles")) {
    obstacles_ = read_or_nothing([&] { return list_in(*listed, 0, obstacle_in); });
    if (!obstacles_) return {"obstacles that cannot be read", "", false};
  }
  if (!obstacles_) return {"no obstacles: neither in it nor in one before it", "", false};
  const std::string claim = claim_words(question, answer, obstacles_->size());
  const std::string why = geometry::check(*obstacles_, question, answer);
  if (!why.empty()) return {"not proven: " + why, claim, false};
  if (!is_of_this_answer(beside, certificate, *obstacles_, question, answer))
    return {"of another answer", claim, false};
  return {"valid", claim, true};
}

}  // namespace exactvo::tools
