// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/plane.h"
#include "verbs/vo/answer.h"

namespace exactvo::tools {

using geometry::HalfPlane;

namespace {

constexpr const char* kForbidden = "with filledcurves closed fc rgb '#7a8290' fs transparent solid 0.35 noborder";
/// For many that overlap: their union is one grey.
constexpr const char* kForbiddenUnion = "with filledcurves closed fc rgb '#cfd2d7' fs solid noborder";
constexpr const char* kLost = "with filledcurves closed fc rgb '#E69F00' fs solid 0.75 noborder";
constexpr const char* kBoundary = "with lines lw 2.5 lc rgb '#009E73'";
constexpr const char* kHatches = "with lines lw 1 lc rgb '#009E73'";
constexpr const char* kShared = "with lines lw 2 dt (6,4) lc rgb '#009E73'";
constexpr const char* kGiven = "with lines lw 1.5 lc rgb '#0072B2'";
constexpr const char* kScaled = "with lines lw 1.5 dt (2,3) lc rgb '#3f444d'";

void draw_half_planes(const std::string& what, const std::vector<HalfPlane>& all, Panel& panel) {
  panel.half_planes(what, all, kBoundary, kHatches, what);
}

void draw_arrow(const std::string& what, Vec2 from, Vec2 by, const char* colour, Panel& panel) {
  panel.arrow(what, from, by, fmt::format("head filled size screen 0.012,18 lw 2.5 lc rgb '{}'", colour), what);
}

void draw_rings(const std::string& what, const std::vector<Points>& rings, const std::string& style, Panel& panel) {
  panel.rings(what, rings, style, what);
}

/// `title` in gnuplot's markup.
std::string body_of(const std::string& title, Panel& panel) {
  panel.plot.item("keyentry with lines lw 1 lc rgb '#555555'", "hatched side: forbidden");
  return velocity_plane(markup(title), panel.view, panel.plot.text());
}

/// A horizon to draw S by, where there is none: as far as the velocity gets.
double drawn_horizon(const ConeAnswer& a) {
  constexpr double kNearest = 1e-3, kSlowest = 1e-3;  // m, m/s: in contact and at rest there is still something to draw
  if (std::isfinite(a.encounter.time_horizon)) return a.encounter.time_horizon;
  return std::max(a.cone.nearest().distance, kNearest) / std::max(norm(a.encounter.velocity), kSlowest);
}

/// A multiple of the velocities' spread: a wider cone is shown in part, so that the arrows remain to be seen.
constexpr double kWidestView = 3.0;

Box velocities_of(const ConeAnswer& a) {
  Box box;
  box.add(Vec2{});
  box.add(a.encounter.velocity);
  box.add(a.encounter.obstacle_velocity);
  if (a.nearest) box.add(a.encounter.velocity + a.nearest->u);
  return box;
}

/// What lies in both. They meet.
Box common(const Box& a, const Box& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
}

/// The velocities, and as much of S / tau as leaves them visible.
Box view_of(const std::vector<ConeAnswer>& cones) {
  Box velocities;
  for (const ConeAnswer& a : cones) velocities.add(velocities_of(a));
  Box all = velocities;
  for (const ConeAnswer& a : cones)
    for (const Vec2 p : scaled_outline(a.cone.grown(), drawn_horizon(a))) all.add(p + a.encounter.obstacle_velocity);
  const bool at_rest = velocities.width() == 0.0 && velocities.height() == 0.0;
  return square_round(at_rest ? all : common(all, square_round(velocities, kWidestView)), 0.65);
}

Points cone_in(const Box& box, const vo::VelocityObstacle& cone, Vec2 apex) {
  return velocity_obstacle_in(box, cone.grown(), cone.time_horizon(), apex);
}

// --- One cone ---

/// The obstacle that the ellipse stands for, seen from the robot and divided by the horizon as S is.
void draw_given(const VoAnswer& answer, Panel& panel) {
  const ConeAnswer& a = answer.cones.front();
  const AskedObstacle& asked = answer.question.obstacles.front();
  const auto* obstacle = std::get_if<geometry::Obstacle>(&asked.given);
  const bool replaced = asked.taken != Taken::itself && asked.taken != Taken::convex_pieces;
  if (!obstacle || !replaced) return;
  std::vector<Points> edges;
  for (const geometry::Segment& edge : edges_of(*obstacle)) {
    const auto seen = [&](Vec2 x) {
      return (1.0 / drawn_horizon(a)) * (x - a.encounter.position) + a.encounter.obstacle_velocity;
    };
    edges.push_back({seen(edge.a), seen(edge.b)});
  }
  draw_rings("obstacle divided by τ, not grown", edges, kGiven, panel);
}

void draw_cones(const std::vector<ConeAnswer>& cones, Panel& panel) {
  std::vector<Points> forbidden, scaled;
  for (const ConeAnswer& a : cones) {
    const Vec2 u = a.encounter.obstacle_velocity;
    forbidden.push_back(cone_in(panel.view, a.cone, u));
    if (!std::isfinite(a.encounter.time_horizon)) continue;
    scaled.push_back(scaled_outline(a.cone.grown(), a.encounter.time_horizon));
    for (Vec2& p : scaled.back()) p += u;
  }
  draw_rings("velocity obstacle", forbidden, cones.size() == 1 ? kForbidden : kForbiddenUnion, panel);
  draw_rings("grown obstacle divided by τ", scaled, kScaled, panel);
}

/// Those of several that have a side of what all of them allow within the view; all, where that is nothing.
std::vector<HalfPlane> that_bind(const std::vector<HalfPlane>& all, const Box& view) {
  const double near = 1e-9 * view.diagonal();  // m/s: far below a pixel, far above the rounding of the corners
  Points allowed = corners(view);
  for (const HalfPlane& h : all) allowed = clipped(allowed, h);
  if (all.size() == 1 || allowed.empty()) return all;
  std::vector<HalfPlane> binding;
  for (const HalfPlane& h : all) {
    const auto on_it = std::count_if(allowed.begin(), allowed.end(), [&](Vec2 v) {
      return std::fabs(geometry::dot(h.normal, v) - h.offset) <= near * norm(h.normal);
    });
    if (on_it >= 2) binding.push_back(h);
  }
  return binding;
}

void draw_half_planes(const std::vector<ConeAnswer>& cones, Panel& panel) {
  std::vector<HalfPlane> proven, shared;
  for (const ConeAnswer& a : cones) {
    if (const auto& h = a.half_plane ? a.half_plane : a.contact) proven.push_back(*h);
    if (a.shared) shared.push_back(*a.shared);
  }
  draw_half_planes(cones.size() == 1 ? "half-plane" : "half-planes, where they bind", that_bind(proven, panel.view),
                   panel);
  panel.half_planes("shared half-plane", shared, kShared, kHatches, "shared half-plane, not certified");
}

/// With several cones the way to the nearest boundary means something only where the velocity is free.
void draw_change(const std::vector<ConeAnswer>& cones, Panel& panel) {
  const auto nearer = [](const ConeAnswer& a, const ConeAnswer& b) {
    return a.nearest && (!b.nearest || a.nearest->signed_distance < b.nearest->signed_distance);
  };
  const ConeAnswer& a = *std::min_element(cones.begin(), cones.end(), nearer);
  if (!a.nearest || (a.contains && cones.size() > 1)) return;
  draw_arrow(a.contains ? "least change u" : "u, to the boundary", a.encounter.velocity, a.nearest->u, "#D55E00",
             panel);
}

Figure cone_figure(const VoAnswer& answer) {
  const ConeAnswer& a = answer.cones.front();
  DataFile data;
  Panel panel = Panel::of_velocities(view_of(answer.cones), data);
  draw_cones(answer.cones, panel);
  draw_given(answer, panel);
  draw_half_planes(answer.cones, panel);
  const Vec2 u = a.encounter.obstacle_velocity;
  if (u != Vec2{}) draw_arrow("obstacle's velocity", {}, u, "#CC79A7", panel);
  draw_arrow("velocity", {}, a.encounter.velocity, "#444444", panel);
  draw_change(answer.cones, panel);
  const double tau = a.encounter.time_horizon;
  const std::string title =
      "Velocity obstacle, " + (std::isfinite(tau) ? fmt::format("τ = {:g} s", tau) : std::string("no horizon"));
  return {"cone", data.text(), title + ".", {940, 640}, body_of(title, panel)};
}

// --- The free velocities ---

std::vector<Points> pieces_of(const geometry::Region& region) {
  std::vector<Points> rings;
  for (const auto& piece : region.pieces()) rings.push_back(tied_together(piece.polygon));
  return rings;
}

Figure free_figure(const VoAnswer& answer) {
  const FreeAnswer& f = *answer.free;
  DataFile data;
  Box box;
  box.add(Vec2{-f.max_speed, -f.max_speed});
  box.add(Vec2{f.max_speed, f.max_speed});
  Panel panel = Panel::of_velocities(square_round(box, 0.55), data);
  draw_rings("free, but given away", pieces_of(f.free.inner()), kLost, panel);
  if (f.report) draw_rings("kept by the half-planes", pieces_of(f.report->region), solid_fill("#7fcdb4"), panel);
  const bool in_contact =
      std::any_of(answer.cones.begin(), answer.cones.end(), [](const ConeAnswer& a) { return a.overlaps; });
  if (in_contact) draw_rings("nothing is free: contact", {outline(geometry::Disc{{}, f.max_speed})}, kForbidden, panel);
  std::vector<Points> forbidden;
  for (const ConeAnswer& a : answer.cones)
    if (!a.overlaps) forbidden.push_back(cone_in(panel.view, a.cone, a.encounter.obstacle_velocity));
  draw_rings("velocity obstacles", forbidden, kForbidden, panel);
  draw_half_planes("half-planes", f.half_planes, panel);
  draw_arrow("velocity", {}, answer.question.velocity, "#444444", panel);
  const std::string title =
      fmt::format("Free velocities: {:.4g} m²/s² are free, {:.4g} m²/s² are kept by the half-planes", f.free.area().low,
                  f.report ? f.report->area.low : 0.0);
  return {"free", data.text(), "The free velocities of a scene.", {960, 640}, body_of(title, panel)};
}

}  // namespace

Figure vo_figure(const VoAnswer& answer) {
  return answer.free ? free_figure(answer) : cone_figure(answer);
}

}  // namespace exactvo::tools
