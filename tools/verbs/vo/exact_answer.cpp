// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "support/unsigned_zero.h"

namespace exactvo::tools {
namespace {

using geometry::Bracket;
using geometry::Sign;
using vo::AlgebraicDirection;
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

// --- Legs ---

/// Of the slope: narrower than a double of it.
constexpr double kWidth = 0x1p-60;

std::string joined(const std::vector<std::string>& items, const char* between) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : between) + item;
  return text;
}

std::string leg_json(const char* side, const AlgebraicDirection& leg) {
  const AlgebraicDirection fine = leg.refined(kWidth);
  const geometry::Vec2 d = fine.rounded();
  return fmt::format(
      "{{\"side\": \"{}\", \"polynomial\": [\"{}\"], \"slope\": [\"{}\", \"{}\"], \"quarter_turns\": {}, "
      "\"direction\": [{}, {}]}}",
      side, joined(fine.polynomial(), "\", \""), fine.low(), fine.high(), fine.quarter_turns(), d.x, d.y);
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

struct NamedLeg {
  const LegsOfCone* of;
  const char* side;
  const AlgebraicDirection* leg;
};

std::vector<NamedLeg> in_order(const std::vector<LegsOfCone>& legs) {
  std::vector<NamedLeg> all;
  for (const LegsOfCone& of : legs) {
    all.push_back({&of, "left", &of.legs->left});
    all.push_back({&of, "right", &of.legs->right});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const NamedLeg& a, const NamedLeg& b) { return compare(*a.leg, *b.leg) == Sign::negative; });
  return all;
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

std::string exact_legs_json(const vo::ExactLegs& legs) {
  return fmt::format("[{},\n           {}]", leg_json("left", legs.left), leg_json("right", legs.right));
}

std::string legs_by_angle_json(const std::vector<LegsOfCone>& legs) {
  const std::vector<NamedLeg> all = in_order(legs);
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool equal = i > 0 && compare(*all[i - 1].leg, *all[i].leg) == Sign::zero;
    text += i == 0 ? "[" : equal ? ", " : "], [";
    text += fmt::format("{{\"obstacle\": {}, \"cone\": {}, \"side\": \"{}\"}}", all[i].of->obstacle, all[i].of->cone,
                        all[i].side);
  }
  return "[" + text + (all.empty() ? "]" : "]]");
}

std::string exact_legs_words(const vo::ExactLegs& legs) {
  return leg_words("left leg", legs.left) + leg_words("right leg", legs.right);
}

}  // namespace exactvo::tools
