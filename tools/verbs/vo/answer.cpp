// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/names.h"
#include "exactvo/geometry/predicates.h"
#include "support/json_layout.h"

namespace exactvo::tools {

using geometry::HalfPlane;
using vo::AlgebraicDirection;
using vo::FreeArrangement;
using vo::ShiftedCone;

namespace {

bool any_overlaps(const VoAnswer& a) {
  return std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& cone) { return cone.overlaps; });
}
bool any_contains(const VoAnswer& a) {
  return std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& cone) { return cone.contains; });
}

/// Why there is no certificate: "contact" or "rounding"; nothing where there is one.
const char* why_no_certificate(const ConeAnswer& a) {
  if (a.certificate) return nullptr;
  return a.overlaps ? "contact" : "rounding";
}

/// Whose half-plane excludes the piece.
Place place_of(const VoAnswer& a, const vo::LostPiece& piece) {
  if (a.free->half_planes.empty()) return {};
  return place_of(a.question, a.free->cone_of[piece.half_plane]);
}

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

/// Where the half-plane of contact stands: below, and under which key.
std::string contact_words(const VoAnswer& a) {
  const bool any =
      std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& c) { return c.contact.has_value(); });
  return any ? "The half-plane of contact stands below (\"contact_half_plane\" with --json).\n"
             : "No half-plane of contact can be proven (\"contact_half_plane\" with --json is null).\n";
}

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

namespace {

std::string contact_words(const VoQuestion& question, std::size_t cone) {
  return fmt::format("the robot touches or overlaps obstacle {}", place_of(question, cone).obstacle);
}

/// REQUIRES: not Refusal::none.
std::string words(vo::Refusal refusal, const std::vector<ShiftedCone>& cones, const VoQuestion& question) {
  switch (refusal) {
    case vo::Refusal::ellipse: {
      const auto held = [](const ShiftedCone& c) { return FreeArrangement::can_hold(c); };
      const auto first = std::find_if_not(cones.begin(), cones.end(), held);
      return fmt::format("obstacle {} takes part as an ellipse, whose offset has degree eight",
                         place_of(question, static_cast<std::size_t>(first - cones.begin())).obstacle);
    }
    case vo::Refusal::cones:
      return fmt::format("{}, more than {}", geometry::counted(cones.size(), "convex shape"), vo::kMostCones);
    case vo::Refusal::curves: {
      std::size_t curves = 0;
      for (const ShiftedCone& cone : cones) curves += FreeArrangement::curves_of(cone);
      return fmt::format("{}, more than {}", geometry::counted(curves, "boundary curve"), vo::kMostCurves);
    }
    case vo::Refusal::range:
      return "a number of the scene is neither 0 nor between 2^-60 and 2^30";
    default:
      return "the scene's magnitudes are too different for exact results";
  }
}

OrderedJson json_of(const vo::PointBracket& p) {
  return OrderedJson::array({json_bracket(p.x), json_bracket(p.y)});
}

OrderedJson json_of(const vo::FreeArc& arc, const VoQuestion& question) {
  OrderedJson json{{"kind", name(arc.kind)}, {"obstacle", nullptr}, {"cone", nullptr}};
  if (arc.kind != vo::ArcKind::speed_circle) {
    const Place place = place_of(question, arc.cone);
    json["obstacle"] = place.obstacle;
    json["cone"] = place.cone;
  }
  json["from"] = json_of(arc.from);
  json["to"] = json_of(arc.to);
  if (arc.turn == 0) return json;
  json["center"] = json_point(arc.center);
  json["radius"] = arc.radius;
  json["turn"] = arc.turn;
  return json;
}

OrderedJson json_of(const vo::FreePiece& piece, const VoQuestion& question) {
  OrderedJson arcs = OrderedJson::array();
  for (const vo::FreeArc& arc : piece.boundary) arcs.push_back(json_of(arc, question));
  return {{"area", json_bracket(piece.area)}, {"arcs", arcs}};
}

const char* word_of(bool inside) {
  return inside ? "yes" : "no";
}

/// The width of the slope's interval: narrower than a double of it.
constexpr double kWidth = 0x1p-60;

OrderedJson leg_json(const char* side, const AlgebraicDirection& leg) {
  const AlgebraicDirection fine = leg.refined(kWidth);
  return {{"side", side},
          {"polynomial", fine.polynomial()},
          {"slope", {fine.low(), fine.high()}},
          {"quarter_turns", fine.quarter_turns()},
          {"direction", json_point(fine.rounded())}};
}

std::string polynomial_words(const std::vector<std::string>& coefficients) {
  std::string text;
  for (std::size_t i = coefficients.size(); i-- > 0;) {
    const std::string& c = coefficients[i];
    if (c == "0") continue;
    const bool minus = c.front() == '-';
    text += text.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
    text += minus ? c.substr(1) : c;
    if (i > 0) text += i == 1 ? " t" : fmt::format(" t^{}", i);
  }
  return text;
}

std::string leg_words(const char* side, const AlgebraicDirection& leg) {
  const geometry::Vec2 d = leg.rounded();
  return fmt::format("{:<17} ({:.6g}, {:.6g}): (1, t) turned by {} quarters, {} = 0\n", side, d.x, d.y,
                     leg.quarter_turns(), polynomial_words(leg.polynomial()));
}

}  // namespace

/// The cones are those of the question's encounters. `half_planes` is null where a cone has none.
ExactFree exact_free_of(const std::vector<ShiftedCone>& cones, const VoQuestion& question,
                        const std::vector<geometry::HalfPlane>* half_planes) {
  const auto touched = std::find_if(cones.begin(), cones.end(), [](const ShiftedCone& c) { return c.cone.overlaps(); });
  if (touched != cones.end())
    return {{}, {}, contact_words(question, static_cast<std::size_t>(touched - cones.begin()))};
  FreeArrangement::Attempt attempt = FreeArrangement::attempt(cones, question.max_speed);
  if (!attempt.free) return {{}, {}, words(attempt.refusal, cones, question)};
  ExactFree exact{std::move(attempt.free), {}, ""};
  if (half_planes) exact.region_inside = exact.free->attempt_holds(*half_planes);
  return exact;
}

/// Null where there is none.
OrderedJson exact_free_json(const ExactFree& exact, const VoQuestion& question) {
  if (!exact.free) return nullptr;
  OrderedJson pieces = OrderedJson::array();
  for (const vo::FreePiece& piece : exact.free->pieces()) pieces.push_back(json_of(piece, question));
  return {{"components", pieces.size()},
          {"area", json_bracket(exact.free->area())},
          {"region_inside", exact.region_inside ? OrderedJson(word_of(*exact.region_inside)) : OrderedJson()},
          {"pieces", pieces}};
}

/// One line or two.
std::string exact_free_words(const ExactFree& exact) {
  if (!exact.free) return fmt::format("exact result      none: {}\n", exact.why_not);
  const std::size_t pieces = exact.free->pieces().size();
  const geometry::Bracket area = exact.free->area();
  const std::string text = fmt::format("exact result      area {:.10g} to {:.10g} (m/s)^2, {}", area.low, area.high,
                                       geometry::counted(pieces, "connected part"));
  return text + (exact.region_inside
                     ? fmt::format("; all that the half-planes allow is free: {}\n", word_of(*exact.region_inside))
                     : "\n");
}

std::string exact_legs_words(const vo::ExactLegs& legs) {
  return leg_words("left leg", legs.left) + leg_words("right leg", legs.right);
}

/// "its 3 convex pieces", "the smallest ellipse round it".
std::string in_words(const AskedObstacle& o) {
  switch (o.taken) {
    case Taken::itself:
      return "it stands";
    case Taken::convex_pieces:
      return fmt::format("its {} convex pieces", o.encounters);
    case Taken::convex_hull:
      return "its convex hull, which is larger";
    case Taken::smallest_ellipse:
      return "the smallest ellipse round it";
    case Taken::trap_free_ellipse:
      break;
  }
  return "a trap-free ellipse round it";
}

std::string text_of(const HalfPlane& h) {
  return fmt::format("{:+.6g} v_x {:+.6g} v_y >= {:.6g} m/s", unsigned_zero(h.normal.x), unsigned_zero(h.normal.y),
                     unsigned_zero(h.offset));
}

const char* why_words(const std::string& why) {
  return why == "contact"
             ? "in contact, no velocity is certified safe"
             : "rounding: too near contact, or magnitudes too different, to certify a half-plane in doubles";
}

std::string half_plane_words(const ConeAnswer& a) {
  const char* why = why_no_certificate(a);
  const std::string verdict = why ? fmt::format("none: {}", why_words(why)) : name(check(*a.certificate));
  std::string text;
  if (a.half_plane) text += fmt::format("half-plane        {}\n", text_of(*a.half_plane));
  if (a.contact)
    text += fmt::format("half-plane        {}, away from the nearest point (contact)\n", text_of(*a.contact));
  text += fmt::format("certificate       {}{}\n", verdict, a.certificate ? ", of this half-plane" : "");
  if (a.shared)
    text += fmt::format(
        "shared            {}: responsibility {:g}, not certified,\n"
        "                  holds only if the other side takes the rest\n",
        text_of(*a.shared), a.encounter.responsibility);
  return text;
}

/// To the boundary either way; only a velocity that collides has to change.
std::string nearest_words(const ConeAnswer& a) {
  return fmt::format(
      "nearest boundary  {}, {:.6g} m/s away\n"
      "u                 ({:.6g}, {:.6g}) m/s, {}\n",
      name(a.nearest->part), std::fabs(a.nearest->signed_distance), unsigned_zero(a.nearest->u.x),
      unsigned_zero(a.nearest->u.y),
      a.contains ? "the least change that avoids it" : "to that boundary; no change is needed");
}

/// Directions from the apex, which is the obstacle's velocity.
std::string legs_words(const ConeAnswer& a) {
  const auto legs = a.overlaps ? std::nullopt : a.cone.legs();
  if (!legs) return "";
  const auto words = [](const char* side, const vo::Leg& leg) {
    return fmt::format("{:<17} direction ({:.6g}, {:.6g}), touches at ({:.6g}, {:.6g}) m from the robot\n", side,
                       unsigned_zero(leg.direction.x), unsigned_zero(leg.direction.y), unsigned_zero(leg.touch.x),
                       unsigned_zero(leg.touch.y));
  };
  return words("left leg", legs->left) + words("right leg", legs->right);
}

std::string cone_words(const ConeAnswer& a) {
  return legs_words(a) + (a.nearest ? nearest_words(a) : "") + half_plane_words(a) +
         (a.exact_legs ? exact_legs_words(*a.exact_legs) : "");
}

std::string verdict_words(bool overlaps, bool contains, const char* what) {
  if (overlaps) return fmt::format("The robot touches or overlaps {}: there is no cone.\n", what);
  return contains ? "The velocity collides within the horizon (contact counts as a collision).\n"
                  : "The velocity is free within the horizon.\n";
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

std::string taken_words(const VoQuestion& q, const AskedObstacle& o) {
  if (o.taken == Taken::itself) return "";
  const std::string text = fmt::format("The obstacle is taken as {}", in_words(o));
  const auto enclosed = enclosed_of(q, o);
  if (!enclosed) return text + ".\n";
  return text + fmt::format(";\nit contains {} of its {} vertices exactly, certificate: {}.\n", enclosed->contained,
                            enclosed->vertices, enclosed->certificate ? name(check(*enclosed->certificate)) : "none");
}

std::string single_words(const VoAnswer& a) {
  const AskedObstacle& o = a.question.obstacles.front();
  const bool stands_in = o.taken != Taken::itself && o.taken != Taken::convex_pieces;
  const std::string what = stands_in ? in_words(o) : "the obstacle";
  std::string text = taken_words(a.question, o) + verdict_words(any_overlaps(a), any_contains(a), what.c_str());
  if (any_overlaps(a)) text += contact_words(a);
  if (a.cones.size() == 1) return text + cone_words(a.cones.front());
  for (std::size_t k = 0; k < a.cones.size(); ++k)
    text += fmt::format("piece {}: {}{}", k, verdict_words(a.cones[k].overlaps, a.cones[k].contains, "it"),
                        cone_words(a.cones[k]));
  const bool all_proven =
      std::all_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& cone) { return cone.certificate.has_value(); });
  return text + (all_proven ? "A velocity is safe that satisfies the half-planes of all pieces.\n"
                            : "No velocity is proven safe: a piece has no half-plane.\n");
}

std::string region_words(const VoAnswer& a) {
  const vo::RegionReport& report = *a.free->report;
  std::string text = fmt::format("half-planes       allow an area of {:.6g} to {:.6g} (m/s)^2; all of it is free: {}\n",
                                 report.area.low, report.area.high, name(report.inside));
  text += fmt::format("free, excluded    area {:.6g} to {:.6g} (m/s)^2{}\n", report.given_away.low,
                      report.given_away.high, report.lost.empty() ? "" : ", in these parts:");
  for (const vo::LostPiece& piece : report.lost) {
    const auto [obstacle, cone] = place_of(a, piece);
    const bool one = a.question.obstacles[obstacle].encounters == 1;
    text += fmt::format(
        "  {:.4g} (m/s)^2, excluded by the half-plane of obstacle {}{}; farthest beyond it: ({:.4g}, {:.4g}) m/s\n",
        piece.area.high, obstacle, one ? "" : fmt::format(", piece {}", cone), unsigned_zero(piece.farthest.x),
        unsigned_zero(piece.farthest.y));
  }
  return text;
}

std::string free_words(const VoAnswer& a) {
  const FreeAnswer& f = *a.free;
  std::string text;
  for (std::size_t k = 0; k < a.question.obstacles.size(); ++k)
    if (const AskedObstacle& o = a.question.obstacles[k]; o.taken != Taken::itself)
      text += fmt::format("obstacle {:<8} taken as {}\n", k, in_words(o));
  text += fmt::format("free velocities   area {:.6g} to {:.6g} (m/s)^2, at least {}\n", f.free.area().low,
                      f.free.area().high, geometry::counted(f.free.least_components(), "connected part"));
  text += exact_free_words(f.exact);
  if (f.report) return text + region_words(a);
  return text + (any_overlaps(a) ? "The robot touches or overlaps an obstacle: no velocity is free.\n"
                                 : "half-planes       an obstacle has no proven one: they allow no velocity\n");
}

constexpr geometry::Names<Taken, 5> kTaken{{{Taken::itself, "itself"},
                                            {Taken::convex_pieces, "convex pieces"},
                                            {Taken::convex_hull, "convex hull"},
                                            {Taken::smallest_ellipse, "smallest ellipse"},
                                            {Taken::trap_free_ellipse, "trap-free ellipse"}}};

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

/// What the certificate is about: the obstacle's convex shape, and a robot that is no disc.
void add_shape(const ConeAnswer& a, Json& json) {
  json["shape"] = to_string(a.encounter.obstacle);
  if (a.encounter.robot) json["robot"] = to_string(geometry::ConvexShape{*a.encounter.robot});
}

void add_verdict(bool overlaps, bool contains, Json& json) {
  json["overlaps"] = overlaps;
  json["contains_velocity"] = overlaps ? Json() : Json(contains);
}

/// Where they were asked for.
void add_exact_legs(const ConeAnswer& a, Json& json) {
  if (a.exact_legs)
    json["exact_legs"] =
        OrderedJson::array({leg_json("left", a.exact_legs->left), leg_json("right", a.exact_legs->right)});
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
  json["apex"] = json_point(first.encounter.obstacle_velocity);
  json["time_horizon"] = first.encounter.time_horizon;
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
  add_stages(json);
  return json;
}

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
  add_stages(json);
  return json;
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
  VoAnswer a{question, {}, {}};
  for (const vo::Encounter& e : question.encounters) {
    a.cones.push_back(answer_of(e, question.responsibility));
    if (question.exact_legs) a.cones.back().exact_legs = a.cones.back().cone.exact_legs();
  }
  if (question.free) a.free = free_answer_of(a.cones, question);
  return a;
}

std::string to_json(const VoAnswer& a) {
  return laid_out(a.free ? free_json(a) : single_json(a));
}

std::string in_words(const VoAnswer& a) {
  if (!a.free) return single_words(a);
  std::string text = free_words(a);
  for (const ConeAnswer& cone : a.cones)
    if (cone.exact_legs) text += exact_legs_words(*cone.exact_legs);
  return text;
}

}  // namespace exactvo::tools
