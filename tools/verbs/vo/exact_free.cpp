// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/exact_free.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "support/unsigned_zero.h"

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

std::string curves_words(const std::vector<ShiftedCone>& cones) {
  std::size_t curves = 0;
  for (const ShiftedCone& cone : cones) curves += FreeArrangement::curves_of(cone);
  return fmt::format("{}, more than {}", geometry::counted(curves, "boundary curve"), vo::kMostCurves);
}

/// REQUIRES: not Refusal::none.
std::string words(vo::Refusal refusal, const std::vector<ShiftedCone>& cones, const VoQuestion& question) {
  switch (refusal) {
    case vo::Refusal::ellipse: {
      const auto held = [](const ShiftedCone& c) { return FreeArrangement::can_hold(c); };
      const auto first = std::find_if_not(cones.begin(), cones.end(), held);
      return ellipse_words(question, static_cast<std::size_t>(first - cones.begin()));
    }
    case vo::Refusal::cones:
      return fmt::format("{}, more than {}", geometry::counted(cones.size(), "convex shape"), vo::kMostCones);
    case vo::Refusal::curves:
      return curves_words(cones);
    case vo::Refusal::range:
      return "a number of the scene is neither 0 nor between 2^-60 and 2^30";
    default:
      return "the scene's magnitudes are too different for exact results";
  }
}

std::string bracket_json(const Bracket& b) {
  return fmt::format("[{}, {}]", unsigned_zero(b.low), unsigned_zero(b.high));
}
std::string bracket_json(const vo::PointBracket& p) {
  return fmt::format("[{}, {}]", bracket_json(p.x), bracket_json(p.y));
}

std::string owner_json(const vo::FreeArc& arc, const VoQuestion& question) {
  if (arc.kind == vo::ArcKind::speed_circle) return "\"obstacle\": null, \"cone\": null";
  const Place place = place_of(question, arc.cone);
  return fmt::format("\"obstacle\": {}, \"cone\": {}", place.obstacle, place.cone);
}

std::string circle_json(const vo::FreeArc& arc) {
  if (arc.turn == 0) return "";
  return fmt::format(", \"center\": [{}, {}], \"radius\": {}, \"turn\": {}", unsigned_zero(arc.center.x),
                     unsigned_zero(arc.center.y), arc.radius, arc.turn);
}

std::string arc_json(const vo::FreeArc& arc, const VoQuestion& question) {
  return fmt::format("{{\"kind\": \"{}\", {},\n         \"from\": {}, \"to\": {}{}}}", name(arc.kind),
                     owner_json(arc, question), bracket_json(arc.from), bracket_json(arc.to), circle_json(arc));
}

std::string piece_json(const vo::FreePiece& piece, const VoQuestion& question) {
  std::string arcs;
  for (const vo::FreeArc& arc : piece.boundary)
    arcs += (arcs.empty() ? "\n        " : ",\n        ") + arc_json(arc, question);
  return fmt::format("{{\"area\": {}, \"arcs\": [{}]}}", bracket_json(piece.area), arcs);
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
  const auto touched = std::find_if(cones.begin(), cones.end(), [](const ShiftedCone& c) { return c.cone.overlaps(); });
  if (touched != cones.end())
    return {{}, {}, contact_words(question, static_cast<std::size_t>(touched - cones.begin()))};
  FreeArrangement::Attempt attempt = FreeArrangement::attempt(cones, question.max_speed);
  if (!attempt.free) return {{}, {}, words(attempt.refusal, cones, question)};
  ExactFree exact{std::move(attempt.free), {}, ""};
  if (half_planes) exact.region_inside = exact.free->attempt_holds(*half_planes);
  return exact;
}

std::string exact_free_json(const ExactFree& exact, const VoQuestion& question) {
  if (!exact.free) return fmt::format("\"exact\": null,\n  \"why_not_exact\": \"{}\"", exact.why_not);
  std::string pieces;
  for (const vo::FreePiece& piece : exact.free->pieces())
    pieces += (pieces.empty() ? "\n      " : ",\n      ") + piece_json(piece, question);
  return fmt::format(
      "\"exact\": {{\n    \"components\": {},\n    \"area\": {},\n    \"region_inside\": {},\n    \"pieces\": [{}]}},\n"
      "  \"why_not_exact\": null",
      exact.free->pieces().size(), bracket_json(exact.free->area()), inside_json(exact.region_inside), pieces);
}

std::string exact_free_words(const ExactFree& exact) {
  if (!exact.free) return fmt::format("exact result      none: {}\n", exact.why_not);
  const std::size_t pieces = exact.free->pieces().size();
  const Bracket area = exact.free->area();
  const std::string text = fmt::format("exact result      area {:.10g} to {:.10g} (m/s)^2, {}", area.low, area.high,
                                       geometry::counted(pieces, "connected part"));
  return text + (exact.region_inside
                     ? fmt::format("; all that the half-planes allow is free: {}\n", word_of(*exact.region_inside))
                     : "\n");
}

}  // namespace exactvo::tools
