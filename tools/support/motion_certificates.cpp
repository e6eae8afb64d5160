// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/motion_certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "support/certificate_json.h"

namespace exactvo::tools {

using geometry::CurvedMotion;
using geometry::Motion;
using geometry::MotionCertificate;
using geometry::RigidBody;
using geometry::RoundedPolygon;
using geometry::Separation;
using geometry::StraightMotion;
using geometry::TimedPoint;
using geometry::TurningMotion;

namespace {

constexpr const char* kKind = "clear";
/// In the order of geometry::CurveBasis.
constexpr const char* kBases[] = {"powers", "bezier", "b-spline"};

OrderedJson timed_json(const TimedPoint& p) {
  return OrderedJson::array({p.time, p.at.x, p.at.y});
}

OrderedJson parts_json(const RigidBody& body) {
  OrderedJson parts = OrderedJson::array();
  for (const RoundedPolygon& part : body)
    parts.push_back({{"corners", points_json(part.corners)}, {"radius", part.radius}});
  return parts;
}

OrderedJson moving_json(const BodyInMotion& moving) {
  if (const auto* straight = std::get_if<StraightMotion>(&moving.motion))
    return {{"from", timed_json(straight->from)}, {"to", timed_json(straight->to)}, {"body", parts_json(*moving.body)}};
  const auto& curve = std::get<CurvedMotion>(moving.motion);
  return {{"basis", kBases[static_cast<std::size_t>(curve.basis)]},
          {"start", curve.start},
          {"end", curve.end},
          {"points", points_json(curve.points)},
          {"body", parts_json(*moving.body)}};
}

OrderedJson turning_json(const TurningMotion& motion, const RigidBody& body) {
  return {{"from", timed_json({motion.start, motion.at})},
          {"until", motion.end},
          {"velocity", json_point(motion.twist.velocity)},
          {"turn", motion.twist.turn},
          {"body", parts_json(body)}};
}

OrderedJson json_with(const MotionCertificate& certificate, OrderedJson a, const char* key, OrderedJson other) {
  OrderedJson separations = OrderedJson::array();
  for (const Separation& s : certificate.separations)
    separations.push_back({{"part", s.part},
                           {"other", s.other},
                           {"from", s.from},
                           {"to", s.to},
                           {"direction", json_point(s.direction)},
                           {"margin", s.margin}});
  return {{"kind", kKind}, {"a", std::move(a)}, {key, std::move(other)}, {"separations", separations}};
}

// --- Reading (certificate_json.h) ---

std::size_t index_in(const OrderedJson& json) {
  return json.get_ref<const OrderedJson::number_unsigned_t&>();
}

TimedPoint timed_in(const OrderedJson& json) {
  require_readable(json.is_array() && json.size() == 3);
  return {json[0].get<double>(), {json[1].get<double>(), json[2].get<double>()}};
}

RoundedPolygon part_in(const OrderedJson& json) {
  return {list_in(json.at("corners"), 1, pair_in), json.at("radius").get<double>()};
}

Motion motion_in(const OrderedJson& json) {
  if (!json.contains("basis")) return StraightMotion{timed_in(json.at("from")), timed_in(json.at("to"))};
  const auto basis = std::find(std::begin(kBases), std::end(kBases), json["basis"].get<std::string>());
  require_readable(basis != std::end(kBases));
  return CurvedMotion{static_cast<geometry::CurveBasis>(basis - std::begin(kBases)), json.at("start").get<double>(),
                      json.at("end").get<double>(), list_in(json.at("points"), 1, pair_in)};
}

TurningMotion turning_in(const OrderedJson& json) {
  const TimedPoint from = timed_in(json.at("from"));
  return {from.time,
          json.at("until").get<double>(),
          from.at,
          {pair_in(json.at("velocity")), json.at("turn").get<double>()}};
}

Separation separation_in(const OrderedJson& json) {
  return {index_in(json.at("part")),   index_in(json.at("other")),    json.at("from").get<double>(),
          json.at("to").get<double>(), pair_in(json.at("direction")), json.at("margin").get<double>()};
}

template <class AnyMotion>
struct Moving {
  AnyMotion motion;
  RigidBody body;
};

/// A certificate of a body against another one, or against an obstacle.
template <class AnyMotion>
struct Read {
  MotionCertificate certificate;
  Moving<AnyMotion> a;
  std::optional<Moving<AnyMotion>> b;
  std::optional<geometry::Obstacle> obstacle;

  bool is_proven() const {
    return b ? proves_clear(certificate, a.motion, a.body, b->motion, b->body)
             : proves_clear(certificate, a.motion, a.body, *obstacle);
  }
};

template <class AnyMotion>
std::optional<Read<AnyMotion>> certificate_in(const OrderedJson& json, AnyMotion (*motion)(const OrderedJson&)) {
  return read_or_nothing([&] {
    const auto moving = [&](const OrderedJson& m) {
      return Moving<AnyMotion>{motion(m), list_in(m.at("body"), 1, part_in)};
    };
    Read<AnyMotion> read{{list_in(json.at("separations"), 0, separation_in)}, moving(json.at("a")), {}, {}};
    require_readable(json.contains("b") != json.contains("obstacle"));
    if (json.contains("b")) read.b = moving(json["b"]);
    if (json.contains("obstacle")) read.obstacle = obstacle_in(json["obstacle"]);
    return read;
  });
}

CheckedCertificate check_turning(const OrderedJson& certificate) {
  const auto read = certificate_in(certificate, turning_in);
  if (!read) return {"not a certificate", "", false};
  const TurningMotion& m = read->a.motion;
  const std::string claim = fmt::format(
      "clear of {}, from ({:.6g}, {:.6g}) at {:.6g} s with ({:.6g}, {:.6g}) m/s, {:.6g} rad/s until {:.6g} s",
      read->b ? "another body" : "an obstacle", m.at.x, m.at.y, m.start, m.twist.velocity.x, m.twist.velocity.y,
      m.twist.turn, m.end);
  const bool is_proven = read->is_proven();
  return {is_proven ? "valid" : "not proven", claim, is_proven};
}

}  // namespace

OrderedJson certificate_json(const MotionCertificate& certificate, const BodyInMotion& a, const BodyInMotion& b) {
  return json_with(certificate, moving_json(a), "b", moving_json(b));
}

OrderedJson certificate_json(const MotionCertificate& certificate, const BodyInMotion& a,
                             const formation::SceneObstacle& obstacle) {
  return json_with(certificate, moving_json(a), "obstacle", obstacle_json(obstacle));
}

OrderedJson certificate_json(const MotionCertificate& certificate, const TurningMotion& motion, const RigidBody& body,
                             const formation::SceneObstacle& obstacle) {
  return json_with(certificate, turning_json(motion, body), "obstacle", obstacle_json(obstacle));
}

OrderedJson certificate_json(const MotionCertificate& certificate, const TurningMotion& a, const RigidBody& body_a,
                             const TurningMotion& b, const RigidBody& body_b) {
  return json_with(certificate, turning_json(a, body_a), "b", turning_json(b, body_b));
}

bool is_motion_certificate(const OrderedJson& certificate) {
  const OrderedJson* kind = member(certificate, "kind");
  return kind != nullptr && *kind == kKind;
}

CheckedCertificate check_motion_certificate(const OrderedJson& certificate) {
  const OrderedJson* a = member(certificate, "a");
  if (a != nullptr && member(*a, "turn") != nullptr) return check_turning(certificate);
  const auto read = certificate_in(certificate, motion_in);
  if (!read) return {"not a certificate", "", false};
  const Motion& m = read->a.motion;
  std::string claim = read->b ? "clear of another body" : "clear of an obstacle";
  try {
    const double start = start_of(m), end = end_of(m);
    const geometry::Vec2 from = position_at(m, start), to = position_at(m, end);
    claim += fmt::format(", from ({:.6g}, {:.6g}) at {:.6g} s to ({:.6g}, {:.6g}) at {:.6g} s", from.x, from.y, start,
                         to.x, to.y, end);
    return read->is_proven() ? CheckedCertificate{"valid", claim, true}
                             : CheckedCertificate{"not proven", claim, false};
  } catch (const std::logic_error&) {
    return {"not a certificate", claim, false};  // times that fall, a radius below 0
  }
}

}  // namespace exactvo::tools
