// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exactvo/geometry/counted.h"

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

// --- Legs ---

/// Of the slope: narrower than a double of it.
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

OrderedJson exact_free_json(const ExactFree& exact, const VoQuestion& question) {
  if (!exact.free) return nullptr;
  OrderedJson pieces = OrderedJson::array();
  for (const vo::FreePiece& piece : exact.free->pieces()) pieces.push_back(json_of(piece, question));
  return {{"components", pieces.size()},
          {"area", json_bracket(exact.free->area())},
          {"region_inside", exact.region_inside ? OrderedJson(word_of(*exact.region_inside)) : OrderedJson()},
          {"pieces", pieces}};
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

OrderedJson exact_legs_json(const vo::ExactLegs& legs) {
  return OrderedJson::array({leg_json("left", legs.left), leg_json("right", legs.right)});
}

OrderedJson legs_by_angle_json(const VoAnswer& answer) {
  std::vector<std::pair<const AlgebraicDirection*, OrderedJson>> legs;
  for (std::size_t k = 0; k < answer.cones.size(); ++k) {
    const std::optional<vo::ExactLegs>& exact = answer.cones[k].exact_legs;
    if (!exact) continue;
    const Place place = place_of(answer.question, k);
    const auto add = [&](const char* side, const AlgebraicDirection& leg) {
      legs.emplace_back(&leg, OrderedJson{{"obstacle", place.obstacle}, {"cone", place.cone}, {"side", side}});
    };
    add("left", exact->left);
    add("right", exact->right);
  }
  std::stable_sort(legs.begin(), legs.end(),
                   [](const auto& a, const auto& b) { return compare(*a.first, *b.first) == Sign::negative; });
  OrderedJson groups = OrderedJson::array();
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (i == 0 || compare(*legs[i - 1].first, *legs[i].first) != Sign::zero) groups.push_back(OrderedJson::array());
    groups.back().push_back(legs[i].second);
  }
  return groups;
}

std::string exact_legs_words(const vo::ExactLegs& legs) {
  return leg_words("left leg", legs.left) + leg_words("right leg", legs.right);
}

}  // namespace exactvo::tools
