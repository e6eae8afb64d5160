// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "verbs/obstacles/map_figure.h"
#include "verbs/route/answer.h"

namespace exactvo::tools {

using geometry::Route;
using geometry::Separated;

namespace {

constexpr const char* kSweptColour = "#cfe3f1";
constexpr const char* kStartColour = "#009E73";
constexpr const char* kChainColour = "#D55E00";

Points points_of(const Route& route) {
  Points points;
  for (const geometry::ExactPoint& p : route.points) points.push_back(p.rounded);
  return points;
}

/// What the disc sweeps over on one straight piece.
Points capsule(Vec2 a, Vec2 b, double radius) {
  constexpr int kSteps = 24;
  const Vec2 along = geometry::normalized(b - a);
  Points ring;
  for (const auto& [centre, forward] : {std::pair(b, along), std::pair(a, -along)}) {
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = (static_cast<double>(k) / kSteps - 0.5) * geometry::kPi;
      ring.push_back(centre + radius * geometry::rotated(forward, angle));
    }
  }
  return ring;
}

void add_swept(const Points& points, double radius, MapLayers& map) {
  std::vector<Points> pieces;
  for (std::size_t k = 1; k < points.size(); ++k) pieces.push_back(capsule(points[k - 1], points[k], radius));
  map.curves("swept by the disc", pieces, solid_fill(kSweptColour), true);
}

/// Along edges and across gaps, each gap with its width where there is room for all of them.
void add_chain(const Separated& separated, MapLayers& map) {
  constexpr std::size_t kMostLabels = 24;
  std::vector<Points> along;
  const std::vector<geometry::ChainPoint>& chain = separated.chain;
  for (std::size_t k = 0; k < chain.size(); ++k)
    if (!chain[k].gap_follows) along.push_back({chain[k].point.rounded, chain[(k + 1) % chain.size()].point.rounded});
  map.curves("closed chain", along, line_style(3.0, kChainColour), false);
  std::vector<Points> across;
  std::vector<Gap> gaps = gaps_of(separated);
  for (const Gap& gap : gaps) across.push_back({gap.from, gap.to});
  map.curves("gap, too narrow", across, line_style(3.0, kChainColour, " dt (4,3)"), false);
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.width > b.width; });
  gaps.resize(std::min(gaps.size(), kMostLabels));
  std::vector<MapLayers::Label> labels;
  for (const Gap& gap : gaps) labels.push_back({0.5 * (gap.from + gap.to), fmt::format("{:.3g} m", gap.width)});
  map.labels("widths of gaps", labels,
             fmt::format("with labels left offset 0.6,0.6 font ',11' tc rgb '{}'", kChainColour));
}

std::string title_of_route(const AnsweredRoute& answered, const AskedMap& map) {
  const std::string file = std::filesystem::path(map.file).filename().string();
  const std::string disc = fmt::format("{}: a disc of radius {:.6g} m", file, answered.question.radius);
  if (const auto* route = std::get_if<Route>(&*answered.answer))
    return fmt::format("{} has a route of {:.6g} m", disc, route->length);
  if (std::holds_alternative<Separated>(*answered.answer)) return disc + " has no route";
  const bool is_start = std::get<geometry::Blocked>(*answered.answer).end == geometry::Blocked::End::start;
  return disc + (is_start ? " does not fit at the start" : " does not fit at the goal");
}

}  // namespace

Figure route_figure(const AnsweredRoute& answered, const AskedMap& asked) {
  EXACTVO_REQUIRE(answered.answer.has_value(), std::string("an answer to draw"));
  const geometry::RouteQuestion& question = answered.question;
  MapLayers map;
  const auto* route = std::get_if<Route>(&*answered.answer);
  if (route) add_swept(points_of(*route), question.radius, map);
  add_obstacles(asked.shapes, true, map);
  if (const auto* separated = std::get_if<Separated>(&*answered.answer)) add_chain(*separated, map);
  if (route) map.curves("route", {points_of(*route)}, line_style(2.2, kRouteColour), false);
  map.curves("disc at the start", {outline(geometry::Disc{question.start, question.radius})},
             line_style(2.0, kStartColour), true);
  map.curves("disc at the goal", {outline(geometry::Disc{question.goal, question.radius})},
             line_style(2.0, kGoalColour), true);
  constexpr const char* kMiddle = "with points pt 7 ps 0.5 lc rgb '{}'";
  map.curves("start", {{question.start}}, fmt::format(kMiddle, kStartColour), false, false);
  map.curves("goal", {{question.goal}}, fmt::format(kMiddle, kGoalColour), false, false);
  return map.figure(title_of_route(answered, asked));
}

}  // namespace exactvo::tools
