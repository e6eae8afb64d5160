// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo_exact_free.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

namespace exactvo::tools {
namespace {

using geometry::Bracket;
using vo::FreeArrangement;
using vo::ShiftedCone;

std::string ellipse_words(const VoQuestion& question, std::size_t cone) {
  return fmt::format("obstacle {} takes part as an ellipse, whose offset has degree eight",
                     place_of(question, cone).obstacle);
}

std::string contact_words(const VoQuestion& question, std::size_t cone) {
  return fmt::format("the robot touches or overlaps obstacle {}", place_of(question, cone).obstacle);
}

std::string limit_words(const std::vector<ShiftedCone>& cones) {
  if (cones.size() > vo::kMostCones) return fmt::format("{} convex shapes, more than {}", cones.size(), vo::kMostCones);
  std::size_t curves = 0;
  for (const ShiftedCone& cone : cones) curves += FreeArrangement::curves_of(cone);
  if (curves > vo::kMostCurves) return fmt::format("{} boundary curves, more than {}", curves, vo::kMostCurves);
  return "";
}

/// Numbers closer to 0 or larger are not tried: towards the ends of the doubles' range the exact ones take minutes or
/// stop the program. 2^-60 lets pass what rounding leaves of a 0, 2^30 what maps count in.
constexpr double kLeastNumber = 0x1p-60;
constexpr double kMostNumber = 0x1p30;

bool is_moderate(double x) {
  return x == 0.0 || (std::fabs(x) >= kLeastNumber && std::fabs(x) <= kMostNumber);
}
bool is_moderate(Vec2 v) {
  return is_moderate(v.x) && is_moderate(v.y);
}
bool are_moderate(const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), [](Vec2 v) { return is_moderate(v); });
}
bool is_moderate(const geometry::ConvexShape& shape) {
  if (const auto* disc = std::get_if<geometry::Disc>(&shape))
    return is_moderate(disc->center) && is_moderate(disc->radius);
  if (const auto* segment = std::get_if<geometry::Segment>(&shape))
    return is_moderate(segment->a) && is_moderate(segment->b);
  if (const auto* polygon = std::get_if<geometry::ConvexPolygon>(&shape)) return are_moderate(polygon->vertices);
  const auto& e = std::get<geometry::Ellipse>(shape);
  return is_moderate(e.center) && is_moderate(e.l11) && is_moderate(e.l21) && is_moderate(e.l22);
}

bool is_moderate(const vo::Encounter& e) {
  const bool horizon = std::isinf(e.time_horizon) || is_moderate(e.time_horizon);
  const bool robot = e.robot ? are_moderate(e.robot->vertices) : is_moderate(e.radius);
  return horizon && robot && is_moderate(e.position) && is_moderate(e.obstacle_velocity) && is_moderate(e.obstacle);
}

bool are_moderate(const VoQuestion& q) {
  return is_moderate(q.max_speed) &&
         std::all_of(q.encounters.begin(), q.encounters.end(), [](const vo::Encounter& e) { return is_moderate(e); });
}

/// Nothing where all can be held.
std::string obstruction(const std::vector<ShiftedCone>& cones, const VoQuestion& question) {
  for (std::size_t k = 0; k < cones.size(); ++k) {
    if (cones[k].cone.overlaps()) return contact_words(question, k);
    if (!FreeArrangement::can_hold(cones[k])) return ellipse_words(question, k);
  }
  if (!are_moderate(question)) return "a number of the scene is neither 0 nor between 2^-60 and 2^30";
  return limit_words(cones);
}

std::string json(const Bracket& b) {
  return fmt::format("[{}, {}]", b.low, b.high);
}
std::string json(const vo::PointBracket& p) {
  return fmt::format("[{}, {}]", json(p.x), json(p.y));
}

std::string owner_json(const vo::FreeArc& arc, const VoQuestion& question) {
  if (arc.kind == vo::ArcKind::speed_circle) return "\"obstacle\": null, \"cone\": null";
  const Place place = place_of(question, arc.cone);
  return fmt::format("\"obstacle\": {}, \"cone\": {}", place.obstacle, place.cone);
}

std::string circle_json(const vo::FreeArc& arc) {
  if (arc.turn == 0) return "";
  return fmt::format(", \"center\": [{}, {}], \"radius\": {}, \"turn\": {}", arc.center.x, arc.center.y, arc.radius,
                     arc.turn);
}

std::string arc_json(const vo::FreeArc& arc, const VoQuestion& question) {
  return fmt::format("{{\"kind\": \"{}\", {},\n         \"from\": {}, \"to\": {}{}}}", name(arc.kind),
                     owner_json(arc, question), json(arc.from), json(arc.to), circle_json(arc));
}

std::string piece_json(const vo::FreePiece& piece, const VoQuestion& question) {
  std::string arcs;
  for (const vo::FreeArc& arc : piece.boundary)
    arcs += (arcs.empty() ? "\n        " : ",\n        ") + arc_json(arc, question);
  return fmt::format("{{\"area\": {}, \"arcs\": [{}]}}", json(piece.area), arcs);
}

const char* word_of(bool inside) {
  return inside ? "yes" : "no";
}

std::string inside_json(const std::optional<bool>& inside) {
  return inside ? fmt::format("\"{}\"", word_of(*inside)) : "null";
}

}  // namespace

ExactFree exact_free_of(const std::vector<ShiftedCone>& cones, const VoQuestion& question,
                        const std::vector<geometry::HalfPlane>* half_planes) {
  // The bounds stand also where the exact numbers give up, which they say by a logic_error.
  try {
    ExactFree exact{{}, {}, obstruction(cones, question)};
    if (!exact.why_not.empty()) return exact;
    exact.free.emplace(cones, question.max_speed);
    if (half_planes) exact.region_inside = exact.free->holds(*half_planes);
    return exact;
  } catch (const std::logic_error&) {
    return {{}, {}, "the scene's numbers are too far apart for the exact ones"};
  }
}

std::string exact_free_json(const ExactFree& exact, const VoQuestion& question) {
  if (!exact.free) return fmt::format("\"exact\": null,\n  \"why_not_exact\": \"{}\"", exact.why_not);
  std::string pieces;
  for (const vo::FreePiece& piece : exact.free->pieces())
    pieces += (pieces.empty() ? "\n      " : ",\n      ") + piece_json(piece, question);
  return fmt::format(
      "\"exact\": {{\n    \"components\": {},\n    \"area\": {},\n    \"region_inside\": {},\n    \"pieces\": [{}]}},\n"
      "  \"why_not_exact\": null",
      exact.free->pieces().size(), json(exact.free->area()), inside_json(exact.region_inside), pieces);
}

std::string exact_free_words(const ExactFree& exact) {
  if (!exact.free) return fmt::format("exactly           not shown: {}\n", exact.why_not);
  const std::size_t pieces = exact.free->pieces().size();
  const Bracket area = exact.free->area();
  const std::string text = fmt::format("exactly           {:.10g} to {:.10g} (m/s)^2, in {} {}", area.low, area.high,
                                       pieces, pieces == 1 ? "piece" : "pieces");
  return text + (exact.region_inside
                     ? fmt::format("; what half-planes keep is free: {}\n", word_of(*exact.region_inside))
                     : "\n");
}

}  // namespace exactvo::tools
