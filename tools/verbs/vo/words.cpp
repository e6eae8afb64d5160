// SPDX-License-Identifier: GPL-3.0-or-later
// What `exactvo vo` answers, in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/counted.h"
#include "support/unsigned_zero.h"
#include "verbs/vo/answer.h"

namespace exactvo::tools {

using geometry::HalfPlane;

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

namespace {

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

/// Where the half-plane of contact stands: below, and under which key.
std::string contact_words(const VoAnswer& a) {
  const bool any =
      std::any_of(a.cones.begin(), a.cones.end(), [](const ConeAnswer& c) { return c.contact.has_value(); });
  return any ? "The half-plane of contact stands below (\"contact_half_plane\" with --json).\n"
             : "No half-plane of contact can be proven (\"contact_half_plane\" with --json is null).\n";
}

std::string verdict_words(bool overlaps, bool contains, const char* what) {
  if (overlaps) return fmt::format("The robot touches or overlaps {}: there is no cone.\n", what);
  return contains ? "The velocity collides within the horizon (contact counts as a collision).\n"
                  : "The velocity is free within the horizon.\n";
}

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

/// IVO's ellipse reaches beyond the obstacle, so that the robot may be in contact with it alone.
std::string member_words(const vo::Member& m, bool overlaps, Vec2 velocity) {
  const auto answer = m.allows(velocity);
  if (answer) return fmt::format("{:<17} {} the velocity\n", name(m.variant), word_of_allowed(answer));
  const char* ellipse = m.variant == vo::Variant::ivo ? "in contact with its ellipse, or rounding" : "rounding";
  return fmt::format("{:<17} {}: {}\n", name(m.variant), word_of_allowed(answer), overlaps ? "in contact" : ellipse);
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

}  // namespace

std::string in_words(const VoAnswer& a) {
  if (!a.free) {
    std::string text = single_words(a);
    for (const vo::Member& m : a.members) text += member_words(m, any_overlaps(a), a.question.velocity);
    return text;
  }
  std::string text = free_words(a);
  for (const ConeAnswer& cone : a.cones)
    if (cone.exact_legs) text += exact_legs_words(*cone.exact_legs);
  return text;
}

}  // namespace exactvo::tools
