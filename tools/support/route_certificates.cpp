// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/route_certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "support/certificate_json.h"

namespace exactvo::tools {

using geometry::Blocked;
using geometry::ChainPoint;
using geometry::ExactPoint;
using geometry::Route;
using geometry::RouteAnswer;
using geometry::RouteQuestion;
using geometry::Separated;

namespace {

constexpr const char* kStatuses[] = {"route", "separated", "blocked"};  // in the order of RouteAnswer

// --- Writing ---

OrderedJson json_of(geometry::Vec2 p) {
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
          geometry::EdgeName{number_in(json.at("obstacle")), is_inside ? 0 : number_in(json.at("edge"))}};
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

CheckedCertificate RouteChecker::check_one(const OrderedJson& certificate) {
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
  return {"valid", claim, true};
}

}  // namespace exactvo::tools
