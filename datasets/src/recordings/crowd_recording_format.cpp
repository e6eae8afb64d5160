// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/crowd_recording_format.h"

#include <cmath>
#include <optional>
#include <vector>

#include "exactvo/geometry/shape_numbers.h"

namespace exactvo::datasets {
namespace {

constexpr std::uint32_t kMostKinds = 1U << 14U, kMostRobots = 1U << 30U, kMostEdges = 1U << 24U;
constexpr std::size_t kLongestName = 1000;

CrowdBodyRecord get_body(CrowdBytes& in) {
  CrowdBodyRecord body;
  const auto moves = in.get<std::uint8_t>(), kind = in.get<std::uint8_t>();
  const auto count = in.get<std::uint32_t>();
  in.require(moves <= 1, "a body that neither moves nor rests");
  std::vector<double> v;
  for (std::uint32_t k = 0; k < count; ++k) {
    v.push_back(in.get<double>());
    in.require(std::isfinite(v.back()), "a body that is nowhere");
  }
  const std::optional<geometry::ConvexShape> shape = geometry::shape_of(kind, v);
  in.require(shape && geometry::is_valid(*shape), "a body of no shape");
  body.moves = moves == 1;
  body.shape = *shape;
  return body;
}

bool is_positive(double v) {
  return std::isfinite(v) && v > 0.0;
}

}  // namespace

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

std::uint64_t chained(std::uint64_t sum, std::uint64_t next) {
  std::string both;
  append(both, sum);
  append(both, next);
  return checksum(both);
}

void append_difference(std::string& to, std::int64_t difference) {
  auto left = (static_cast<std::uint64_t>(difference) << 1U) ^ static_cast<std::uint64_t>(difference >> 63);
  for (; left >= 0x80; left >>= 7U) to.push_back(static_cast<char>(left | 0x80U));
  to.push_back(static_cast<char>(left));
}

void CrowdBytes::refuse(const std::string& found) const {
  throw DataError(DataCode::format_syntax, file_, "byte " + std::to_string(at_), found,
                  "what simulate --record has written");
}

std::string to_bytes(const CrowdRecordingHead& head) {
  std::string out;
  append(out, static_cast<std::uint32_t>(head.scenario.size()));
  out += head.scenario;
  append(out, head.time_step);
  append(out, head.position_step);
  append(out, head.every);
  append(out, static_cast<std::uint32_t>(head.kinds.size()));
  for (const CrowdKindRecord& kind : head.kinds) append(out, kind.radius), append(out, kind.max_speed);
  append(out, static_cast<std::uint32_t>(head.kind_of.size()));
  for (const std::uint16_t kind : head.kind_of) append(out, kind);
  append(out, static_cast<std::uint32_t>(head.edges.size()));
  for (const geometry::Segment& e : head.edges)
    for (const double v : {e.a.x, e.a.y, e.b.x, e.b.y}) append(out, v);
  if (head.bodies.empty()) return out;
  append(out, static_cast<std::uint32_t>(head.bodies.size()));
  for (const CrowdBodyRecord& body : head.bodies) {
    append(out, static_cast<std::uint8_t>(body.moves));
    append(out, static_cast<std::uint8_t>(body.shape.index()));
    const std::vector<double> numbers = geometry::numbers_of(body.shape);
    append(out, static_cast<std::uint32_t>(numbers.size()));
    for (const double v : numbers) append(out, v);
  }
  return out;
}

CrowdRecordingHead to_head(CrowdBytes in, bool has_bodies) {
  CrowdRecordingHead head;
  const auto length = in.get<std::uint32_t>();
  in.require(length <= kLongestName, "a name of more than 1000 bytes");
  head.scenario = in.text(length);
  head.time_step = in.get<double>();
  head.position_step = in.get<double>();
  in.require(is_positive(head.time_step) && is_positive(head.position_step), "a step that is not positive");
  head.every = in.get<std::uint32_t>();
  in.require(head.every > 0, "a row every 0 steps");
  const auto kinds = in.get<std::uint32_t>();
  in.require(kinds <= kMostKinds, "more than 2^14 kinds");
  for (std::uint32_t k = 0; k < kinds; ++k) {
    const auto radius = in.get<double>(), speed = in.get<double>();
    in.require(is_positive(radius) && is_positive(speed), "a kind that no crowd has");
    head.kinds.push_back({radius, speed});
  }
  const auto robots = in.get<std::uint32_t>();
  in.require(robots <= kMostRobots, "more than 2^30 robots");
  for (std::uint32_t i = 0; i < robots; ++i) {
    head.kind_of.push_back(in.get<std::uint16_t>());
    in.require(head.kind_of.back() < kinds, "a robot of an unknown kind");
  }
  const auto edges = in.get<std::uint32_t>();
  in.require(edges <= kMostEdges, "more than 2^24 edges");
  for (std::uint32_t k = 0; k < edges; ++k) {
    double v[4];
    for (double& number : v) {
      number = in.get<double>();
      in.require(std::isfinite(number), "an edge that is nowhere");
    }
    head.edges.push_back({{v[0], v[1]}, {v[2], v[3]}});
  }
  if (has_bodies) {
    const auto bodies = in.get<std::uint32_t>();
    in.require(bodies <= kMostEdges, "more than 2^24 bodies");
    for (std::uint32_t k = 0; k < bodies; ++k) head.bodies.push_back(get_body(in));
  }
  in.require_end();
  return head;
}

}  // namespace exactvo::datasets
