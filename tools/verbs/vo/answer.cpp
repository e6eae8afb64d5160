// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/names.h"
#include "exactvo/geometry/predicates.h"
#include "support/unsigned_zero.h"

namespace exactvo::tools {

using geometry::HalfPlane;

bool any_overlaps(const VoAnswer& a) {
  return std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& cone) { return cone.overlaps; });
}
bool any_contains(const VoAnswer& a) {
  return std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& cone) { return cone.contains; });
}

const char* word_of_allowed(const std::optional<bool>& allowed) {
  if (!allowed) return "no cone";
  return *allowed ? "allows" : "forbids";
}

const char* why_no_certificate(const ConeAnswer& a) {
  if (a.certificate) return nullptr;
  return a.overlaps ? "contact" : "rounding";
}

Place place_of(const VoAnswer& a, const vo::LostPiece& piece) {
  if (a.free->half_planes.empty()) return {};
  return place_of(a.question, a.free->cone_of[piece.half_plane]);
}

namespace {

constexpr geometry::Names<Taken, 5> kTaken{{{Taken::itself, "itself"},
                                            {Taken::convex_pieces, "convex pieces"},
                                            {Taken::convex_hull, "convex hull"},
                                            {Taken::smallest_ellipse, "smallest ellipse"},
                                            {Taken::trap_free_ellipse, "trap-free ellipse"}}};

// --- JSON ---

std::string json(double x) {
  return std::isfinite(x) ? fmt::format("{}", unsigned_zero(x)) : "null";
}
std::string json(Vec2 v) {
  return fmt::format("[{}, {}]", json(v.x), json(v.y));
}
std::string json(bool b) {
  return b ? "true" : "false";
}
std::string json(const geometry::Bracket& b) {
  return fmt::format("[{}, {}]", json(b.low), json(b.high));
}
std::string json(const std::optional<HalfPlane>& h) {
  if (!h) return "null";
  return fmt::format("{{\"normal\": {}, \"offset\": {}}}", json(h->normal), json(h->offset));
}

std::string leg_json(const char* side, const vo::Leg& leg) {
  return fmt::format(
      "{{\"side\": \"{}\", \"direction\": {}, \"touch\": {}, \"bracket\": {{\"inside\": {}, \"outside\": {}}}}}", side,
      json(leg.direction), json(leg.touch), json(leg.normal), json(leg.normal_outside));
}

std::string legs_json(const ConeAnswer& a) {
  if (a.overlaps) return "null";
  const auto legs = a.cone.legs();
  if (!legs) return "null";
  return fmt::format("[{},\n           {}]", leg_json("left", legs->left), leg_json("right", legs->right));
}

std::string boundary_json(const ConeAnswer& a) {
  if (!a.nearest) return "\"nearest_boundary\": null,\n  \"u\": null";
  return fmt::format(
      "\"nearest_boundary\": {{\"part\": \"{}\", \"normal\": {}, \"signed_distance\": {}, \"point\": {}}},\n"
      "  \"u\": {}",
      name(a.nearest->part), json(a.nearest->normal), json(a.nearest->signed_distance),
      json(a.encounter.velocity + a.nearest->u), json(a.nearest->u));
}

std::string text_of(const vo::Certificate& c) {
  return write_certificate(c);
}
std::string text_of(const vo::Containment& c) {
  return write_containment(c);
}

template <class Certificate>
std::string json(const std::optional<Certificate>& c) {
  if (!c) return "null";
  return fmt::format("{{\"verdict\": \"{}\", \"margin\": {}, \"text\": \"{}\"}}", name(check(*c)), json(c->margin),
                     text_of(*c));
}

std::string half_planes_json(const ConeAnswer& a) {
  const char* why = why_no_certificate(a);
  return fmt::format(
      "\"half_plane\": {},\n  \"contact_half_plane\": {},\n  \"certificate\": {},\n  \"why_no_certificate\": {}",
      json(a.half_plane), json(a.contact), json(a.certificate), why ? fmt::format("\"{}\"", why) : "null");
}

std::string shared_json(const ConeAnswer& a) {
  if (a.encounter.share >= 1.0) return "";
  return fmt::format(
      "\"shared_half_plane\": {{\"alpha\": {}, \"half_plane\": {}, \"certificate\": null,\n"
      "    \"holds\": \"only if the other side takes its share\"}},\n  ",
      json(a.encounter.share), json(a.shared));
}

std::string member_json(const vo::Member& m, Vec2 velocity) {
  const auto answer = m.allows(velocity);
  std::string text =
      fmt::format("{{\"variant\": \"{}\", \"allows_velocity\": {}", name(m.variant), answer ? json(*answer) : "null");
  if (m.cone)
    text += fmt::format(", \"apex\": {}, \"time_horizon\": {}", json(m.cone->apex), json(m.cone->cone.time_horizon()));
  if (m.half_plane) text += fmt::format(", \"half_plane\": {}", json(m.half_plane));
  return text + "}";
}

std::string members_json(const VoAnswer& a) {
  if (a.members.empty()) return "";
  std::string text = "  \"variants\": [";
  for (std::size_t i = 0; i < a.members.size(); ++i)
    text += (i == 0 ? "\n    " : ",\n    ") + member_json(a.members[i], a.question.velocity);
  return text + "],\n";
}

std::string stages_json() {
  const geometry::StageCounts counts = geometry::stage_counts();
  return fmt::format("\"stage_counts\": {{\"filter\": {}, \"exact\": {}}}", counts.filter, counts.exact);
}

/// Of what the certificate is: the obstacle's convex shape, and a robot that is no disc.
std::string shape_json(const ConeAnswer& a) {
  const auto& robot = a.encounter.robot;
  const std::string grown_by =
      robot ? fmt::format("\"robot\": \"{}\",\n  ", to_string(geometry::ConvexShape{*robot})) : "";
  return fmt::format("\"shape\": \"{}\",\n  {}", to_string(a.encounter.obstacle), grown_by);
}

std::string verdict_json(bool overlaps, bool contains) {
  return fmt::format("\"overlaps\": {},\n  \"contains_velocity\": {},\n  ", json(overlaps),
                     overlaps ? "null" : json(contains));
}

std::string relative_json(const ConeAnswer& a) {
  return fmt::format("\"apex\": {},\n  \"time_horizon\": {},\n  ", json(a.encounter.obstacle_velocity),
                     json(a.encounter.time_horizon));
}

/// Where they were asked for.
std::string exact_json(const ConeAnswer& a) {
  return a.exact_legs ? fmt::format("\"exact_legs\": {},\n  ", exact_legs_json(*a.exact_legs)) : "";
}

std::string bounds_json(const ConeAnswer& a) {
  return fmt::format("\"legs\": {},\n  {}{},\n  {}{}", legs_json(a), exact_json(a), boundary_json(a), shared_json(a),
                     half_planes_json(a));
}

/// What stands for the obstacle.
std::string taken_json(const VoQuestion& q, const AskedObstacle& o) {
  const auto enclosed = enclosed_of(q, o);
  const std::string proof = enclosed ? fmt::format(", \"vertices\": {}, \"contained\": {},\n    \"certificate\": {}",
                                                   enclosed->vertices, enclosed->contained, json(enclosed->certificate))
                                     : "";
  return fmt::format("\"taken_as\": {{\"what\": \"{}\", \"convex_shapes\": {}{}}},\n  ",
                     geometry::name_in(kTaken, o.taken), o.encounters, proof);
}

std::string cone_json(const ConeAnswer& a) {
  return shape_json(a) + verdict_json(a.overlaps, a.contains) + relative_json(a) + bounds_json(a);
}

std::string joined(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "\n    " : ",\n    ") + item;
  return text;
}

/// Which fields are what. A certificate's numbers are doubles; what it proves of them is exact.
constexpr const char* kKindsOfCone =
    "\"kinds\": {\n    \"exact\": [\"shape\", \"robot\", \"taken_as\", \"overlaps\", \"contains_velocity\", "
    "\"apex\"],\n"
    "    \"certified\": [\"half_plane\", \"contact_half_plane\", \"certificate\", \"why_no_certificate\", "
    "\"legs/bracket\"],\n"
    "    \"rounded\": [\"legs/direction\", \"legs/touch\", \"nearest_boundary\", \"u\", \"shared_half_plane\", "
    "\"variants\"]},\n  ";
constexpr const char* kKindsOfFree =
    "\"kinds\": {\n    \"exact\": [\"obstacles/shape\", \"obstacles/robot\", \"obstacles/taken_as\", "
    "\"obstacles/overlaps\", "
    "\"velocity_is_free\",\n      \"exact/components\", \"exact/region_inside\", \"exact/pieces/arcs/kind\", "
    "\"exact/pieces/arcs/obstacle\", \"exact/pieces/arcs/cone\", \"exact/pieces/arcs/turn\"],\n"
    "    \"certified\": [\"obstacles/half_plane\", \"obstacles/contact_half_plane\", \"obstacles/certificate\", "
    "\"obstacles/why_no_certificate\", "
    "\"area\",\n      \"least_components\", \"region/inside\", \"region/area\", \"region/given_away\", "
    "\"region/lost/area\",\n      \"exact/area\", \"exact/pieces/area\", \"exact/pieces/arcs/from\", "
    "\"exact/pieces/arcs/to\"],\n"
    "    \"rounded\": [\"region/lost/farthest\", \"exact/pieces/arcs/center\", \"exact/pieces/arcs/radius\"]},\n  ";

bool has_exact_legs(const VoAnswer& a) {
  return std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& c) { return c.exact_legs.has_value(); });
}

/// With the fields that were asked for besides.
std::string kinds(const char* always, const VoAnswer& a) {
  std::string text = always;
  const std::string exact = "\"exact\": [";
  if (has_exact_legs(a)) {
    const std::string more = a.free ? "\"obstacles/exact_legs\", \"legs_by_angle\", " : "\"exact_legs\", ";
    text.insert(text.find(exact) + exact.size(), more);
  }
  return text;
}

/// A cone a convex shape; where the obstacle is one of those, its fields stand at the top.
std::string single_json(const VoAnswer& a) {
  const AskedObstacle& o = a.question.obstacles.front();
  const std::string head = "{\n  " + taken_json(a.question, o);
  const std::string tail = ",\n" + members_json(a) + "  " + kinds(kKindsOfCone, a) + stages_json() + "\n}\n";
  if (a.cones.size() == 1) return head + cone_json(a.cones.front()) + tail;
  std::vector<std::string> cones;
  for (const ConeAnswer& cone : a.cones)
    cones.push_back("{" + shape_json(cone) + verdict_json(cone.overlaps, cone.contains) + bounds_json(cone) + "}");
  return head + verdict_json(any_overlaps(a), any_contains(a)) + relative_json(a.cones.front()) + "\"cones\": [" +
         joined(cones) + "]" + tail;
}

// --- The same of --free ---

std::string piece_json(const ConeAnswer& a) {
  return shape_json(a) + fmt::format("\"overlaps\": {}, ", json(a.overlaps)) + exact_json(a) + half_planes_json(a);
}

std::string obstacle_json(const VoAnswer& a, const AskedObstacle& o) {
  const std::string head = "{" + taken_json(a.question, o);
  if (o.encounters == 1) return head + piece_json(a.cones[o.first_encounter]) + "}";
  std::vector<std::string> pieces;
  bool overlaps = false;
  for (std::size_t k = 0; k < o.encounters; ++k) {
    pieces.push_back("{" + piece_json(a.cones[o.first_encounter + k]) + "}");
    overlaps = overlaps || a.cones[o.first_encounter + k].overlaps;
  }
  return head + fmt::format("\"overlaps\": {}, \"cones\": [{}]}}", json(overlaps), joined(pieces));
}

std::string lost_json(const VoAnswer& a, const vo::LostPiece& piece) {
  const auto [obstacle, cone] = place_of(a, piece);
  return fmt::format("{{\"area\": {}, \"farthest\": {}, \"obstacle\": {}, \"cone\": {}}}", json(piece.area),
                     json(piece.farthest), obstacle, cone);
}

std::string region_json(const VoAnswer& a) {
  if (!a.free->report) return "null";
  const vo::RegionReport& report = *a.free->report;
  std::vector<std::string> lost;
  for (const vo::LostPiece& piece : report.lost) lost.push_back(lost_json(a, piece));
  return fmt::format("{{\n    \"inside\": \"{}\",\n    \"area\": {},\n    \"given_away\": {},\n    \"lost\": [{}]}}",
                     name(report.inside), json(report.area), json(report.given_away), joined(lost));
}

/// Which cones share a leg: numbered as in `obstacles`, the cones of each in their order.
std::string by_angle_json(const VoAnswer& a) {
  if (!has_exact_legs(a)) return "";
  std::vector<LegsOfCone> legs;
  for (std::size_t i = 0; i < a.question.obstacles.size(); ++i) {
    const AskedObstacle& o = a.question.obstacles[i];
    for (std::size_t k = 0; k < o.encounters; ++k) {
      const auto& exact = a.cones[o.first_encounter + k].exact_legs;
      if (exact) legs.push_back({i, k, &*exact});
    }
  }
  return fmt::format("\"legs_by_angle\": {},\n  ", legs_by_angle_json(legs));
}

std::string free_json(const VoAnswer& a) {
  const FreeAnswer& f = *a.free;
  std::vector<std::string> obstacles;
  for (const AskedObstacle& o : a.question.obstacles) obstacles.push_back(obstacle_json(a, o));
  return fmt::format(
      "{{\n  \"obstacles\": [{}],\n  \"max_speed\": {},\n  \"velocity_is_free\": {},\n  \"area\": {},\n"
      "  \"least_components\": {},\n  \"region\": {},\n  {},\n  {}{}{}\n}}\n",
      joined(obstacles), json(f.max_speed), json(f.free.contains(a.question.velocity)), json(f.free.area()),
      f.free.least_components(), region_json(a), exact_free_json(f.exact, a.question), by_angle_json(a),
      kinds(kKindsOfFree, a), stages_json());
}

}  // namespace

std::optional<Enclosed> enclosed_of(const VoQuestion& question, const AskedObstacle& o) {
  const auto* obstacle = std::get_if<geometry::Obstacle>(&o.given);
  const auto* ellipse = std::get_if<geometry::Ellipse>(&question.encounters[o.first_encounter].obstacle);
  if (!obstacle || !ellipse) return std::nullopt;
  const std::vector<Vec2> vertices = vertices_of(*obstacle);
  const auto contained =
      std::count_if(vertices.begin(), vertices.end(), [&](Vec2 x) { return geometry::contains(*ellipse, x); });
  return Enclosed{vertices.size(), static_cast<std::size_t>(contained), vo::certify_containment(*ellipse, vertices)};
}

namespace {

/// What can be proven where the robot is in contact or within a few ulps of it. For an obstacle that moves the offset
/// is rounded up: two products and a sum err by less than 2u of the sum of their magnitudes, u = 2^-53.
std::optional<HalfPlane> contact_half_plane(const ConeAnswer& a) {
  constexpr double kFourRoundings = 4.0 * 0x1p-53;
  std::optional<HalfPlane> h = a.cone.contact_half_plane();
  const Vec2 u = a.encounter.obstacle_velocity;
  if (h)
    h->offset =
        geometry::dot(h->normal, u) + kFourRoundings * (std::fabs(h->normal.x * u.x) + std::fabs(h->normal.y * u.y));
  return h;
}

}  // namespace

ConeAnswer answer_of(const vo::Encounter& e, double alpha) {
  ConeAnswer a{e, cone_of(e), false, false, {}, {}, {}, {}, {}, {}};
  a.overlaps = a.cone.overlaps();
  if (!a.overlaps) {
    vo::Encounter shared = e;
    const auto half_plane = [&](double share) {
      shared.share = share;
      return family_member(vo::Variant::orca, shared).half_plane;
    };
    a.contains = a.cone.contains_sum({{e.velocity, -e.obstacle_velocity}});
    a.nearest = a.cone.nearest_boundary(e.velocity - e.obstacle_velocity);
    a.half_plane = half_plane(1.0);
    if (alpha < 1.0) a.shared = half_plane(alpha);
  }
  if (!a.half_plane) a.contact = contact_half_plane(a);
  if (const auto& proven = a.half_plane ? a.half_plane : a.contact) {
    const geometry::GrownShape& s = a.cone.grown();
    a.certificate = vo::certify({s.shape, s.origin, s.radius, e.time_horizon, e.obstacle_velocity, *proven});
  }
  if (a.contact && !a.certificate) a.contact.reset();
  return a;
}

/// How far the polygons may stray from the curves, of the speed: finer than a pixel of the figure. The guide quotes it.
constexpr double kOfSpeed = 1e-4;

FreeAnswer free_answer_of(const std::vector<ConeAnswer>& cones, const VoQuestion& question) {
  std::vector<vo::ShiftedCone> shifted;
  std::vector<HalfPlane> half_planes;
  std::vector<std::size_t> cone_of;
  bool overlaps = false;
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const Vec2 u = cones[k].encounter.obstacle_velocity;
    shifted.push_back({cones[k].cone, {{-u}}, u});
    overlaps = overlaps || cones[k].overlaps;
    const auto& proven = cones[k].half_plane ? cones[k].half_plane : cones[k].contact;
    if (!proven) continue;
    half_planes.push_back(*proven);
    cone_of.push_back(k);
  }
  FreeAnswer answer{vo::FreeVelocities(std::move(shifted), {question.max_speed, kOfSpeed}),
                    question.max_speed,
                    std::move(half_planes),
                    std::move(cone_of),
                    {},
                    {}};
  const bool keep_something = !overlaps && answer.half_planes.size() == cones.size();
  if (keep_something) answer.report = answer.free.compare(answer.half_planes);
  answer.exact = exact_free_of(answer.free.cones(), question, keep_something ? &answer.half_planes : nullptr);
  return answer;
}

VoAnswer answer_of(const VoQuestion& question) {
  VoAnswer a{question, {}, {}, {}};
  for (const vo::Encounter& e : question.encounters) {
    a.cones.push_back(answer_of(e, question.alpha));
    if (question.exact_legs) a.cones.back().exact_legs = a.cones.back().cone.exact_legs();
  }
  for (const vo::Variant v : question.variants) a.members.push_back(family_member(v, question.encounters.front()));
  if (question.free) a.free = free_answer_of(a.cones, question);
  return a;
}

std::string to_json(const VoAnswer& a) {
  return a.free ? free_json(a) : single_json(a);
}

}  // namespace exactvo::tools
