// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/motion_certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "json/json_text.h"
#include "support/certificate_json.h"

namespace exactvo::tools {

using datasets::JsonWriter;
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

void append(JsonWriter& out, const char* key, const TimedPoint& p) {
  out.key(key).begin_array().value(p.time).value(p.at.x).value(p.at.y).end_array();
}

void append_body(JsonWriter& out, const RigidBody& body) {
  out.list("body", body, [&](const RoundedPolygon& part) {
    out.begin_object().member("corners", part.corners).member("radius", part.radius).end_object();
  });
}

void append(JsonWriter& out, const BodyInMotion& moving) {
  if (const auto* straight = std::get_if<StraightMotion>(&moving.motion)) {
    append(out, "from", straight->from);
    append(out, "to", straight->to);
  } else {
    const auto& curve = std::get<CurvedMotion>(moving.motion);
    out.member("basis", kBases[static_cast<std::size_t>(curve.basis)]);
    out.member("start", curve.start).member("end", curve.end).member("points", curve.points);
  }
  append_body(out, *moving.body);
}

/// A body that drives and turns.
struct BodyOnTwist {
  const TurningMotion& motion;
  const RigidBody& body;
};

void append(JsonWriter& out, const BodyOnTwist& turning) {
  const TurningMotion& m = turning.motion;
  append(out, "from", {m.start, m.at});
  out.member("until", m.end).member("velocity", m.twist.velocity).member("turn", m.twist.turn);
  append_body(out, turning.body);
}

template <class Moving>
std::string text_with(const MotionCertificate& certificate, const Moving& a, const char* key, std::string_view other) {
  JsonWriter out(JsonWriter::Layout::compact);
  out.begin_object().member("kind", kKind);
  out.object("a", [&](JsonWriter& json) { append(json, a); });
  out.key(key).raw(other);
  out.list("separations", certificate.separations, [&](const Separation& s) {
    out.begin_object().member("part", s.part).member("other", s.other).member("from", s.from).member("to", s.to);
    out.member("direction", s.direction).member("margin", s.margin).end_object();
  });
  return out.end_object().take();
}

template <class Moving>
std::string text_of(const Moving& b) {
  JsonWriter out(JsonWriter::Layout::compact);
  out.begin_object();
  append(out, b);
  return out.end_object().take();
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

std::string obstacle_text(const formation::SceneObstacle& obstacle) {
  return obstacle_json(obstacle).dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

std::string certificate_text(const MotionCertificate& certificate, const BodyInMotion& a, const BodyInMotion& b) {
  return text_with(certificate, a, "b", text_of(b));
}

std::string certificate_text(const MotionCertificate& certificate, const BodyInMotion& a, std::string_view obstacle) {
  return text_with(certificate, a, "obstacle", obstacle);
}

std::string certificate_text(const MotionCertificate& certificate, const TurningMotion& motion, const RigidBody& body,
                             std::string_view obstacle) {
  return text_with(certificate, BodyOnTwist{motion, body}, "obstacle", obstacle);
}

std::string certificate_text(const MotionCertificate& certificate, const TurningMotion& a, const RigidBody& body_a,
                             const TurningMotion& b, const RigidBody& body_b) {
  return text_with(certificate, BodyOnTwist{a, body_a}, "b", text_of(BodyOnTwist{b, body_b}));
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
