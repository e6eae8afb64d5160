// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo_answer.h"

#include <fmt/format.h>

#include <cmath>

#include "exactvo/geometry/predicates.h"

namespace exactvo::tools {

using geometry::HalfPlane;

namespace {

// --- JSON ---

std::string json(double x) {
  return std::isfinite(x) ? fmt::format("{}", x) : "null";
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

const char* name(vo::BoundaryPart part) {
  switch (part) {
    case vo::BoundaryPart::cut_off:
      return "cut-off";
    case vo::BoundaryPart::apex:
      return "apex";
    case vo::BoundaryPart::left_leg:
      return "left leg";
    case vo::BoundaryPart::right_leg:
      break;
  }
  return "right leg";
}

std::string boundary_json(const ConeAnswer& a) {
  if (!a.nearest) return "\"nearest_boundary\": null,\n  \"u\": null";
  return fmt::format(
      "\"nearest_boundary\": {{\"part\": \"{}\", \"normal\": {}, \"signed_distance\": {}, \"point\": {}}},\n"
      "  \"u\": {}",
      name(a.nearest->part), json(a.nearest->normal), json(a.nearest->signed_distance),
      json(a.encounter.velocity + a.nearest->u), json(a.nearest->u));
}

std::string certificate_json(const ConeAnswer& a) {
  if (!a.certificate) return "null";
  return fmt::format("{{\"verdict\": \"{}\", \"margin\": {}, \"text\": \"{}\"}}", name(check(*a.certificate)),
                     json(a.certificate->margin), write_certificate(*a.certificate));
}

std::string member_json(const vo::Member& m, Vec2 velocity) {
  std::string text =
      fmt::format("{{\"variant\": \"{}\", \"allows_velocity\": {}", name(m.variant), json(m.allows(velocity)));
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

std::string cone_json(const ConeAnswer& a) {
  return fmt::format(
      "  \"shape\": \"{}\",\n  \"overlaps\": {},\n  \"contains_velocity\": {},\n  \"apex\": {},\n"
      "  \"time_horizon\": {},\n  \"legs\": {},\n  {},\n  \"half_plane\": {},\n  \"certificate\": {},\n",
      to_string(a.encounter.obstacle), json(a.overlaps), a.overlaps ? "null" : json(a.contains),
      json(a.encounter.obstacle_velocity), json(a.encounter.time_horizon), legs_json(a), boundary_json(a),
      json(a.half_plane), certificate_json(a));
}

// --- The same of --free ---

std::string obstacle_json(const ConeAnswer& a) {
  return fmt::format("{{\"shape\": \"{}\", \"overlaps\": {}, \"half_plane\": {}, \"certificate\": {}}}",
                     to_string(a.encounter.obstacle), json(a.overlaps), json(a.full), certificate_json(a));
}

std::string lost_json(const FreeAnswer& f, const vo::LostPiece& piece) {
  return fmt::format("{{\"area\": {}, \"farthest\": {}, \"obstacle\": {}}}", json(piece.area), json(piece.farthest),
                     f.half_planes.empty() ? 0 : f.obstacle_of[piece.half_plane]);
}

std::string joined(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "\n    " : ",\n    ") + item;
  return text;
}

std::string free_json(const VoAnswer& a) {
  const FreeAnswer& f = *a.free;
  std::vector<std::string> obstacles, lost;
  for (const ConeAnswer& cone : a.cones) obstacles.push_back(obstacle_json(cone));
  for (const vo::LostPiece& piece : f.report.lost) lost.push_back(lost_json(f, piece));
  return fmt::format(
      "{{\n  \"obstacles\": [{}],\n  \"max_speed\": {},\n  \"velocity_is_free\": {},\n  \"area\": {},\n"
      "  \"least_components\": {},\n  \"region\": {{\n    \"inside\": \"{}\",\n    \"area\": {},\n"
      "    \"given_away\": {},\n    \"lost\": [{}]}},\n  {}\n}}\n",
      joined(obstacles), json(f.max_speed), json(f.free.contains(a.question.velocity)), json(f.free.area()),
      f.free.least_components(), name(f.report.inside), json(f.report.area), json(f.report.given_away), joined(lost),
      stages_json());
}

// --- Words ---

std::string cone_words(const ConeAnswer& a) {
  if (a.overlaps) return "The robot touches or overlaps the obstacle: there is no cone.\n";
  std::string text =
      a.contains ? "The velocity collides within the horizon.\n" : "The velocity is free within the horizon.\n";
  if (a.nearest) {
    text += fmt::format("nearest boundary  {}, {:.6g} m/s away\n", name(a.nearest->part),
                        std::fabs(a.nearest->signed_distance));
    text += fmt::format("u                 ({:.6g}, {:.6g}) m/s\n", a.nearest->u.x, a.nearest->u.y);
  }
  if (a.half_plane)
    text += fmt::format("half-plane        {:+.6g} v_x {:+.6g} v_y >= {:.6g} m/s\n", a.half_plane->normal.x,
                        a.half_plane->normal.y, a.half_plane->offset);
  return text + fmt::format("certificate       {}\n", a.certificate ? name(check(*a.certificate)) : "none");
}

std::string member_words(const vo::Member& m, Vec2 velocity) {
  return fmt::format("{:<17} {} the velocity\n", name(m.variant), m.allows(velocity) ? "allows" : "forbids");
}

std::string free_words(const FreeAnswer& f) {
  std::string text =
      fmt::format("free velocities   {:.6g} to {:.6g} (m/s)^2, in at least {} {}\n", f.free.area().low,
                  f.free.area().high, f.free.least_components(), f.free.least_components() == 1 ? "piece" : "pieces");
  text += fmt::format("half-planes       keep {:.6g} to {:.6g} of it; all free: {}\n", f.report.area.low,
                      f.report.area.high, name(f.report.inside));
  text += fmt::format("given away        {:.6g} to {:.6g}\n", f.report.given_away.low, f.report.given_away.high);
  for (const vo::LostPiece& piece : f.report.lost)
    text +=
        fmt::format("  {:.4g} as far as ({:.4g}, {:.4g}) m/s, by the half-plane of obstacle {}\n", piece.area.high,
                    piece.farthest.x, piece.farthest.y, f.half_planes.empty() ? 0 : f.obstacle_of[piece.half_plane]);
  return text;
}

}  // namespace

ConeAnswer answer_of(const vo::Encounter& e, double alpha) {
  ConeAnswer a{e, cone_of(e), false, false, {}, {}, {}, {}};
  a.overlaps = a.cone.overlaps();
  if (a.overlaps) return a;
  vo::Encounter shared = e;
  const auto half_plane = [&](double share) {
    shared.share = share;
    return family_member(vo::Variant::orca, shared).half_plane;
  };
  a.contains = a.cone.contains_sum({{e.velocity, -e.obstacle_velocity}});
  a.nearest = a.cone.nearest_boundary(e.velocity - e.obstacle_velocity);
  a.half_plane = half_plane(alpha);
  a.full = half_plane(1.0);
  if (a.full) {
    const geometry::GrownShape& s = a.cone.grown();
    a.certificate = vo::certify({s.shape, s.origin, s.radius, e.time_horizon, e.obstacle_velocity, *a.full});
  }
  return a;
}

/// How far the polygons may stray from the curves, of the speed: finer than a pixel of the figure. The guide quotes it.
constexpr double kOfSpeed = 1e-4;

FreeAnswer free_answer_of(const std::vector<ConeAnswer>& cones, const VoQuestion& question) {
  std::vector<vo::ShiftedCone> shifted;
  std::vector<HalfPlane> half_planes;
  std::vector<std::size_t> obstacle_of;
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const Vec2 u = cones[k].encounter.obstacle_velocity;
    shifted.push_back({cones[k].cone, {{-u}}, u});
    if (!cones[k].full) continue;
    half_planes.push_back(*cones[k].full);
    obstacle_of.push_back(k);
  }
  FreeAnswer answer{vo::FreeVelocities(std::move(shifted), {question.max_speed, kOfSpeed}),
                    question.max_speed,
                    std::move(half_planes),
                    std::move(obstacle_of),
                    {}};
  answer.report = answer.free.compare(answer.half_planes);
  return answer;
}

VoAnswer answer_of(const VoQuestion& question) {
  VoAnswer a{question, {}, {}, {}};
  for (const vo::Encounter& e : question.encounters) a.cones.push_back(answer_of(e, question.alpha));
  for (const vo::Variant v : question.variants) a.members.push_back(family_member(v, question.encounters.front()));
  if (question.free) a.free = free_answer_of(a.cones, question);
  return a;
}

std::string to_json(const VoAnswer& a) {
  if (a.free) return free_json(a);
  return "{\n" + cone_json(a.cones.front()) + members_json(a) + "  " + stages_json() + "\n}\n";
}

std::string in_words(const VoAnswer& a) {
  if (a.free) return free_words(*a.free);
  std::string text = cone_words(a.cones.front());
  for (const vo::Member& m : a.members) text += member_words(m, a.question.velocity);
  return text;
}

}  // namespace exactvo::tools
