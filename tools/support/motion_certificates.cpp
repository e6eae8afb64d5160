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

struct Moving {
  Motion motion;
  RigidBody body;
};

Motion motion_in(const OrderedJson& json) {
  if (!json.contains("basis")) return StraightMotion{timed_in(json.at("from")), timed_in(json.at("to"))};
  const auto basis = std::find(std::begin(kBases), std::end(kBases), json["basis"].get<std::string>());
  require_readable(basis != std::end(kBases));
  return CurvedMotion{static_cast<geometry::CurveBasis>(basis - std::begin(kBases)), json.at("start").get<double>(),
                      json.at("end").get<double>(), list_in(json.at("points"), 1, pair_in)};
}

Moving moving_in(const OrderedJson& json) {
  return {motion_in(json), list_in(json.at("body"), 1, part_in)};
}

Separation separation_in(const OrderedJson& json) {
  return {index_in(json.at("part")),   index_in(json.at("other")),    json.at("from").get<double>(),
          json.at("to").get<double>(), pair_in(json.at("direction")), json.at("margin").get<double>()};
}

struct Read {
  MotionCertificate certificate;
  Moving a;
  std::optional<Moving> b;
  std::optional<geometry::Obstacle> obstacle;
};

Read certificate_in(const OrderedJson& json) {
  Read read{{list_in(json.at("separations"), 0, separation_in)}, moving_in(json.at("a")), {}, {}};
  require_readable(json.contains("b") != json.contains("obstacle"));
  if (json.contains("b")) read.b = moving_in(json["b"]);
  if (json.contains("obstacle")) read.obstacle = obstacle_in(json["obstacle"]);
  return read;
}

/// A body that drives and turns.
struct Turning {
  TurningMotion motion;
  RigidBody body;
};

Turning turning_in(const OrderedJson& json) {
  const TimedPoint from = timed_in(json.at("from"));
  return {{from.time,
           json.at("until").get<double>(),
           from.at,
           {pair_in(json.at("velocity")), json.at("turn").get<double>()}},
          list_in(json.at("body"), 1, part_in)};
}

/// Against another, or against an obstacle.
struct ReadTurning {
  MotionCertificate certificate;
  Turning a;
  std::optional<Turning> b;
  std::optional<geometry::Obstacle> obstacle;
};

CheckedCertificate check_turning(const OrderedJson& certificate) {
  const auto read = read_or_nothing([&] {
    ReadTurning all{
        {list_in(certificate.at("separations"), 0, separation_in)}, turning_in(certificate.at("a")), {}, {}};
    require_readable(certificate.contains("b") != certificate.contains("obstacle"));
    if (certificate.contains("b")) all.b = turning_in(certificate["b"]);
    if (certificate.contains("obstacle")) all.obstacle = obstacle_in(certificate["obstacle"]);
    return all;
  });
  if (!read) return {"not a certificate", "", false};
  const TurningMotion& m = read->a.motion;
  const std::string claim = fmt::format(
      "clear of {}, from ({:.6g}, {:.6g}) at {:.6g} s with ({:.6g}, {:.6g}) m/s, {:.6g} rad/s until {:.6g} s",
      read->b ? "another body" : "an obstacle", m.at.x, m.at.y, m.start, m.twist.velocity.x, m.twist.velocity.y,
      m.twist.turn, m.end);
  const bool is_proven = read->b ? proves_clear(read->certificate, m, read->a.body, read->b->motion, read->b->body)
                                 : proves_clear(read->certificate, m, read->a.body, *read->obstacle);
  return {is_proven ? "valid" : "not proven", claim, is_proven};
}

bool proves(const Read& read) {
  if (read.obstacle) return proves_clear(read.certificate, read.a.motion, read.a.body, *read.obstacle);
  return proves_clear(read.certificate, read.a.motion, read.a.body, read.b->motion, read.b->body);
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
  const auto read = read_or_nothing([&] { return certificate_in(certificate); });
  if (!read) return {"not a certificate", "", false};
  const Motion& m = read->a.motion;
  std::string claim = read->b ? "clear of another body" : "clear of an obstacle";
  try {
    const double start = start_of(m), end = end_of(m);
    const geometry::Vec2 from = position_at(m, start), to = position_at(m, end);
    claim += fmt::format(", from ({:.6g}, {:.6g}) at {:.6g} s to ({:.6g}, {:.6g}) at {:.6g} s", from.x, from.y, start,
                         to.x, to.y, end);
    return proves(*read) ? CheckedCertificate{"valid", claim, true} : CheckedCertificate{"not proven", claim, false};
  } catch (const std::logic_error&) {
    return {"not a certificate", claim, false};  // times that fall, a radius below 0
  }
}

}  // namespace exactvo::tools
