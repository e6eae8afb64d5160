// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/answer.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/names.h"
#include "exactvo/geometry/predicates.h"

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

using Json = OrderedJson;

Json json_of(const std::optional<HalfPlane>& h) {
  return h ? Json{{"normal", json_point(h->normal)}, {"offset", h->offset}} : Json();
}

Json json_of(const char* side, const vo::Leg& leg) {
  return {{"side", side},
          {"direction", json_point(leg.direction)},
          {"touch", json_point(leg.touch)},
          {"bracket", {{"inside", json_point(leg.normal)}, {"outside", json_point(leg.normal_outside)}}}};
}

Json legs_json(const ConeAnswer& a) {
  const auto legs = a.overlaps ? std::nullopt : a.cone.legs();
  return legs ? Json::array({json_of("left", legs->left), json_of("right", legs->right)}) : Json();
}

Json boundary_json(const ConeAnswer& a) {
  return {{"part", name(a.nearest->part)},
          {"normal", json_point(a.nearest->normal)},
          {"signed_distance", a.nearest->signed_distance},
          {"point", json_point(a.encounter.velocity + a.nearest->u)}};
}

template <class Certificate>
Json certificate_json(const std::optional<Certificate>& c, std::string (*text_of)(const Certificate&)) {
  return c ? Json{{"verdict", name(check(*c))}, {"margin", c->margin}, {"text", text_of(*c)}} : Json();
}

void add_half_planes(const ConeAnswer& a, Json& json) {
  const char* why = why_no_certificate(a);
  json["half_plane"] = json_of(a.half_plane);
  json["contact_half_plane"] = json_of(a.contact);
  json["certificate"] = certificate_json(a.certificate, vo::write_certificate);
  json["why_no_certificate"] = why ? Json(why) : Json();
}

void add_shared(const ConeAnswer& a, Json& json) {
  if (a.encounter.responsibility >= 1.0) return;
  json["shared_half_plane"] = {{"responsibility", a.encounter.responsibility},
                               {"half_plane", json_of(a.shared)},
                               {"certificate", nullptr},
                               {"holds", "only if the other side takes the rest"}};
}

Json member_json(const vo::Member& m, Vec2 velocity) {
  Json json{{"variant", name(m.variant)}, {"allows_velocity", json_or_null(m.allows(velocity))}};
  if (m.cone) {
    json["apex"] = json_point(m.cone->apex);
    json["time_horizon"] = m.cone->cone.time_horizon();
  }
  if (m.half_plane) json["half_plane"] = json_of(m.half_plane);
  return json;
}

/// Of what the certificate is: the obstacle's convex shape, and a robot that is no disc.
void add_shape(const ConeAnswer& a, Json& json) {
  json["shape"] = to_string(a.encounter.obstacle);
  if (a.encounter.robot) json["robot"] = to_string(geometry::ConvexShape{*a.encounter.robot});
}

void add_verdict(bool overlaps, bool contains, Json& json) {
  json["overlaps"] = overlaps;
  json["contains_velocity"] = overlaps ? Json() : Json(contains);
}

void add_relative(const ConeAnswer& a, Json& json) {
  json["apex"] = json_point(a.encounter.obstacle_velocity);
  json["time_horizon"] = a.encounter.time_horizon;
}

/// Where they were asked for.
void add_exact_legs(const ConeAnswer& a, Json& json) {
  if (a.exact_legs) json["exact_legs"] = exact_legs_json(*a.exact_legs);
}

void add_bounds(const ConeAnswer& a, Json& json) {
  json["legs"] = legs_json(a);
  add_exact_legs(a, json);
  json["nearest_boundary"] = a.nearest ? boundary_json(a) : Json();
  json["u"] = a.nearest ? json_point(a.nearest->u) : Json();
  add_shared(a, json);
  add_half_planes(a, json);
}

/// What stands for the obstacle.
Json taken_json(const VoQuestion& q, const AskedObstacle& o) {
  Json json{{"what", geometry::name_in(kTaken, o.taken)}, {"convex_shapes", o.encounters}};
  if (const auto enclosed = enclosed_of(q, o)) {
    json["vertices"] = enclosed->vertices;
    json["contained"] = enclosed->contained;
    json["certificate"] = certificate_json(enclosed->certificate, vo::write_containment);
  }
  return json;
}

bool has_exact_legs(const VoAnswer& a) {
  return std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& c) { return c.exact_legs.has_value(); });
}

/// Which fields are what. A certificate's numbers are doubles; what it proves of them is exact.
Json kinds_of_cone(const VoAnswer& a) {
  Json exact{"shape", "robot", "taken_as", "overlaps", "contains_velocity", "apex"};
  if (has_exact_legs(a)) exact.insert(exact.begin(), "exact_legs");
  return {{"exact", exact},
          {"certified", {"half_plane", "contact_half_plane", "certificate", "why_no_certificate", "legs/bracket"}},
          {"rounded", {"legs/direction", "legs/touch", "nearest_boundary", "u", "shared_half_plane", "variants"}}};
}

Json kinds_of_free(const VoAnswer& a) {
  Json exact{"obstacles/shape",        "obstacles/robot",        "obstacles/taken_as",
             "obstacles/overlaps",     "velocity_is_free",       "exact/components",
             "exact/region_inside",    "exact/pieces/arcs/kind", "exact/pieces/arcs/obstacle",
             "exact/pieces/arcs/cone", "exact/pieces/arcs/turn"};
  if (has_exact_legs(a)) exact.insert(exact.begin(), {"obstacles/exact_legs", "legs_by_angle"});
  return {
      {"exact", exact},
      {"certified",
       {"obstacles/half_plane", "obstacles/contact_half_plane", "obstacles/certificate", "obstacles/why_no_certificate",
        "area", "least_components", "region/inside", "region/area", "region/given_away", "region/lost/area",
        "exact/area", "exact/pieces/area", "exact/pieces/arcs/from", "exact/pieces/arcs/to"}},
      {"rounded", {"region/lost/farthest", "exact/pieces/arcs/center", "exact/pieces/arcs/radius"}}};
}

void add_stages(Json& json) {
  const geometry::StageCounts counts = geometry::stage_counts();
  json["stage_counts"] = {{"filter", counts.filter}, {"exact", counts.exact}};
}

/// A cone a convex shape; where the obstacle is one of those, its fields stand at the top.
Json single_json(const VoAnswer& a) {
  const ConeAnswer& first = a.cones.front();
  Json json{{"taken_as", taken_json(a.question, a.question.obstacles.front())}};
  if (a.cones.size() == 1) add_shape(first, json);
  add_verdict(any_overlaps(a), any_contains(a), json);
  add_relative(first, json);
  if (a.cones.size() == 1) {
    add_bounds(first, json);
  } else {
    for (const ConeAnswer& cone : a.cones) {
      Json& one = json["cones"].emplace_back(Json::object());
      add_shape(cone, one);
      add_verdict(cone.overlaps, cone.contains, one);
      add_bounds(cone, one);
    }
  }
  for (const vo::Member& m : a.members) json["variants"].push_back(member_json(m, a.question.velocity));
  json["kinds"] = kinds_of_cone(a);
  add_stages(json);
  return json;
}

// --- The same of --free ---

void add_piece(const ConeAnswer& a, Json& json) {
  add_shape(a, json);
  json["overlaps"] = a.overlaps;
  add_exact_legs(a, json);
  add_half_planes(a, json);
}

Json obstacle_json(const VoAnswer& a, const AskedObstacle& o) {
  Json json{{"taken_as", taken_json(a.question, o)}};
  const auto first = a.cones.begin() + static_cast<std::ptrdiff_t>(o.first_encounter);
  const auto last = first + static_cast<std::ptrdiff_t>(o.encounters);
  if (o.encounters == 1) {
    add_piece(*first, json);
    return json;
  }
  json["overlaps"] = std::any_of(first, last, [](const ConeAnswer& c) { return c.overlaps; });
  for (auto cone = first; cone != last; ++cone) add_piece(*cone, json["cones"].emplace_back(Json::object()));
  return json;
}

Json region_json(const VoAnswer& a) {
  if (!a.free->report) return nullptr;
  const vo::RegionReport& report = *a.free->report;
  Json lost = Json::array();
  for (const vo::LostPiece& piece : report.lost) {
    const auto [obstacle, cone] = place_of(a, piece);
    lost.push_back({{"area", json_bracket(piece.area)},
                    {"farthest", json_point(piece.farthest)},
                    {"obstacle", obstacle},
                    {"cone", cone}});
  }
  return {{"inside", name(report.inside)},
          {"area", json_bracket(report.area)},
          {"given_away", json_bracket(report.given_away)},
          {"lost", lost}};
}

Json free_json(const VoAnswer& a) {
  const FreeAnswer& f = *a.free;
  Json json{{"obstacles", Json::array()}};
  for (const AskedObstacle& o : a.question.obstacles) json["obstacles"].push_back(obstacle_json(a, o));
  json["max_speed"] = f.max_speed;
  json["velocity_is_free"] = f.free.contains(a.question.velocity);
  json["area"] = json_bracket(f.free.area());
  json["least_components"] = f.free.least_components();
  json["region"] = region_json(a);
  json["exact"] = exact_free_json(f.exact, a.question);
  json["why_not_exact"] = f.exact.free ? Json() : Json(f.exact.why_not);
  if (has_exact_legs(a)) json["legs_by_angle"] = legs_by_angle_json(a);
  json["kinds"] = kinds_of_free(a);
  add_stages(json);
  return json;
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

ConeAnswer answer_of(const vo::Encounter& e, double responsibility) {
  ConeAnswer a{e, cone_of(e), false, false, {}, {}, {}, {}, {}, {}};
  a.overlaps = a.cone.overlaps();
  if (!a.overlaps) {
    vo::Encounter shared = e;
    const auto half_plane = [&](double taken) {
      shared.responsibility = taken;
      return family_member(vo::Variant::orca, shared).half_plane;
    };
    a.contains = a.cone.contains_sum({{e.velocity, -e.obstacle_velocity}});
    a.nearest = a.cone.nearest_boundary(e.velocity - e.obstacle_velocity);
    a.half_plane = half_plane(1.0);
    if (responsibility < 1.0) a.shared = half_plane(responsibility);
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

}  // namespace

VoAnswer answer_of(const VoQuestion& question) {
  VoAnswer a{question, {}, {}, {}};
  for (const vo::Encounter& e : question.encounters) {
    a.cones.push_back(answer_of(e, question.responsibility));
    if (question.exact_legs) a.cones.back().exact_legs = a.cones.back().cone.exact_legs();
  }
  for (const vo::Variant v : question.variants) a.members.push_back(family_member(v, question.encounters.front()));
  if (question.free) a.free = free_answer_of(a.cones, question);
  return a;
}

std::string to_json(const VoAnswer& a) {
  return laid_out(a.free ? free_json(a) : single_json(a));
}

}  // namespace exactvo::tools
