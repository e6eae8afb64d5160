// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/figure.h"
#include "figures/outlines.h"
#include "figures/velocity_space.h"
#include "verbs/vo/answer.h"

namespace exactvo::tools {

using geometry::dot;
using geometry::HalfPlane;

namespace {

constexpr const char* kForbidden = "with filledcurves closed fc rgb '#7a8290' fs transparent solid 0.35 noborder";
/// For many that overlap: their union is one grey.
constexpr const char* kForbiddenUnion = "with filledcurves closed fc rgb '#cfd2d7' fs solid noborder";
constexpr const char* kAllowed = "with filledcurves closed fc rgb '#009E73' fs transparent solid 0.35 noborder";
constexpr const char* kLost = "with filledcurves closed fc rgb '#E69F00' fs solid 0.75 noborder";
constexpr const char* kBoundary = "with lines lw 2.5 lc rgb '#009E73'";
constexpr const char* kHatches = "with lines lw 1 lc rgb '#009E73'";
constexpr int kHatchesAcross = 45;  // over the width of the view
constexpr const char* kShared = "with lines lw 2 dt (6,4) lc rgb '#009E73'";
constexpr const char* kGiven = "with lines lw 1.5 lc rgb '#0072B2'";
constexpr const char* kScaled = "with lines lw 1.5 dt (2,3) lc rgb '#3f444d'";

/// One set of axes: data sets and the items that draw them.
class Panel {
 public:
  Panel(DataFile& data, Box view) : data_(data), view_(view) {}

  void ring(const std::string& title, Points points, const std::string& style) {
    if (points.empty()) return;
    points.push_back(points.front());
    const int index = data_.begin(title, "v_x [m/s], v_y [m/s]");
    data_.rows(points);
    plot_.data(index, "using 1:2 " + style, title);
  }
  /// Each ring a polygon of its own: holes are drawn in white over them.
  void rings(const std::string& title, const std::vector<Points>& all, const std::string& style) {
    if (std::all_of(all.begin(), all.end(), [](const Points& points) { return points.empty(); })) return;
    const int index = data_.begin(title, "v_x [m/s], v_y [m/s]");
    for (const Points& points : all) data_.ring(points);
    plot_.data(index, "using 1:2 " + style, title);
  }
  /// With their forbidden sides hatched. One data set however many they are: gnuplot reads the file anew for each.
  void boundaries(const std::string& title, const std::vector<HalfPlane>& all, const char* style = kBoundary,
                  const char* hatches = kHatches) {
    std::vector<Points> lines, strokes;
    for (const HalfPlane& h : all) {
      const Points line = boundary_within(view_, h);
      if (line.empty()) continue;
      lines.push_back(line);
      for (const Points& stroke : hatching(line, h.normal, view_.width() / kHatchesAcross)) strokes.push_back(stroke);
    }
    curves(title, lines, style);
    curves("", strokes, hatches);
    hatched_ |= !strokes.empty();
  }
  void boundary(const std::string& title, const HalfPlane& h) { boundaries(title, {h}); }
  void arrow(const std::string& title, Vec2 from, Vec2 by, const char* colour) {
    const int index = data_.begin(title, "from v_x, v_y, by v_x, v_y [m/s]");
    data_.row({from.x, from.y, by.x, by.y});
    plot_.data(index,
               fmt::format("using 1:2:3:4 with vectors head filled size screen 0.012,18 lw 2.5 lc rgb '{}'", colour),
               title);
  }
  void point(const std::string& title, Vec2 at, const char* colour) {
    const int index = data_.begin(title, "v_x [m/s], v_y [m/s]");
    data_.rows({at});
    plot_.data(index, fmt::format("using 1:2 with points pt 7 ps 1 lc rgb '{}'", colour), title);
  }
  /// `title` in gnuplot's markup.
  std::string text(const std::string& title) {
    if (hatched_) plot_.item("keyentry with lines lw 1 lc rgb '#555555'", "hatched side: forbidden");
    return velocity_plane(markup(title), view_, plot_.text());
  }
  /// The same without axes of its own, for a sheet.
  SheetPanel on_sheet(const std::string& title) const {
    return {markup(title),
            fmt::format("set clip two\nset xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]", view_.low.x,
                        view_.high.x, view_.low.y, view_.high.y),
            plot_.text()};
  }
  const Box& view() const { return view_; }

 private:
  void curves(const std::string& title, const std::vector<Points>& all, const char* style) {
    if (all.empty()) return;
    const int index = data_.begin(title.empty() ? "strokes" : title, "v_x [m/s], v_y [m/s]");
    for (const Points& points : all) data_.curve(points);
    plot_.data(index, std::string("using 1:2 ") + style, title);
  }

  DataFile& data_;
  Box view_;
  PlotCommand plot_;
  bool hatched_ = false;
};

Box square_round(const Box& box, double margin) {
  constexpr double kLeast = 1e-9;  // m/s: a range that gnuplot can still put tics on
  const double half = margin * std::max({box.width(), box.height(), kLeast});
  const Vec2 middle = 0.5 * (box.low + box.high);
  return {{middle.x - half, middle.y - half}, {middle.x + half, middle.y + half}};
}

/// A horizon to draw S by, where there is none: as far as the velocity gets.
double drawn_horizon(const ConeAnswer& a) {
  constexpr double kNearest = 1e-3, kSlowest = 1e-3;  // m, m/s: in contact and at rest there is still something to draw
  if (std::isfinite(a.encounter.time_horizon)) return a.encounter.time_horizon;
  return std::max(a.cone.nearest().distance, kNearest) / std::max(norm(a.encounter.velocity), kSlowest);
}

/// Of the velocities' spread: a cone that is wider is shown in part, so that the arrows remain to be seen.
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

std::string horizon_text(double tau) {
  return std::isfinite(tau) ? fmt::format("τ = {:g} s", tau) : std::string("no horizon");
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
  panel.rings("obstacle divided by τ, not grown", edges, kGiven);
}

void draw_cones(const std::vector<ConeAnswer>& cones, Panel& panel) {
  std::vector<Points> forbidden, scaled;
  for (const ConeAnswer& a : cones) {
    const Vec2 u = a.encounter.obstacle_velocity;
    forbidden.push_back(cone_in(panel.view(), a.cone, u));
    if (!std::isfinite(a.encounter.time_horizon)) continue;
    scaled.push_back(scaled_outline(a.cone.grown(), a.encounter.time_horizon));
    for (Vec2& p : scaled.back()) p += u;
  }
  panel.rings("velocity obstacle", forbidden, cones.size() == 1 ? kForbidden : kForbiddenUnion);
  panel.rings("grown obstacle divided by τ", scaled, kScaled);
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
      return std::fabs(dot(h.normal, v) - h.offset) <= near * norm(h.normal);
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
  panel.boundaries(cones.size() == 1 ? "half-plane" : "half-planes, where they bind", that_bind(proven, panel.view()));
  panel.boundaries("shared half-plane, not certified", shared, kShared);
}

/// Of several cones the way to the nearest means something where the velocity is free, and no single one else.
void draw_change(const std::vector<ConeAnswer>& cones, Panel& panel) {
  const auto nearer = [](const ConeAnswer& a, const ConeAnswer& b) {
    return a.nearest && (!b.nearest || a.nearest->signed_distance < b.nearest->signed_distance);
  };
  const ConeAnswer& a = *std::min_element(cones.begin(), cones.end(), nearer);
  if (!a.nearest || (a.contains && cones.size() > 1)) return;
  panel.arrow(a.contains ? "least change u" : "u, to the boundary", a.encounter.velocity, a.nearest->u, "#D55E00");
}

Figure cone_figure(const VoAnswer& answer) {
  const ConeAnswer& a = answer.cones.front();
  DataFile data;
  Panel panel(data, view_of(answer.cones));
  draw_cones(answer.cones, panel);
  draw_given(answer, panel);
  draw_half_planes(answer.cones, panel);
  const Vec2 u = a.encounter.obstacle_velocity;
  if (u != Vec2{}) panel.arrow("obstacle's velocity", {}, u, "#CC79A7");
  panel.arrow("velocity", {}, a.encounter.velocity, "#444444");
  draw_change(answer.cones, panel);
  const std::string title = "Velocity obstacle, " + horizon_text(a.encounter.time_horizon);
  return {"cone", data.text(), title + ".", {940, 640}, panel.text(title)};
}

// --- The family ---

void draw_member(const vo::Member& m, const ConeAnswer& a, Panel& panel) {
  if (m.cone) panel.ring("forbidden", cone_in(panel.view(), m.cone->cone, m.cone->apex), kForbidden);
  if (m.half_plane) {
    const HalfPlane beyond{-m.half_plane->normal, -m.half_plane->offset};
    panel.ring("forbidden", clipped(corners(panel.view()), beyond), kForbidden);
    panel.boundary("boundary", *m.half_plane);
  }
  panel.arrow("robot's velocity", {}, a.encounter.velocity, "#444444");
  panel.arrow("obstacle's velocity", {}, a.encounter.obstacle_velocity, "#CC79A7");
  if (m.cone) panel.point("apex", m.cone->apex, "#D55E00");
}

std::string member_title(const vo::Member& m, Vec2 velocity) {
  const auto answer = m.allows(velocity);
  return fmt::format("{}: {}{}", name(m.variant), word_of_allowed(answer), answer ? " {/:Italic v}" : "");
}

std::vector<std::pair<std::string, std::string>> family_legend(const VoAnswer& answer) {
  bool cones = false, half_planes = false;
  for (const vo::Member& m : answer.members) {
    cones = cones || m.cone;
    half_planes = half_planes || m.half_plane;
  }
  std::vector<std::pair<std::string, std::string>> all{{std::string("keyentry ") + kForbidden, "forbidden"}};
  if (cones) all.emplace_back("keyentry with points pt 7 ps 1 lc rgb '#D55E00'", "apex of the cone");
  if (half_planes) all.emplace_back(std::string("keyentry ") + kBoundary, "half-plane, hatched where it forbids");
  all.emplace_back("keyentry with vectors head filled lw 2.5 lc rgb '#444444'", "velocity v of the robot");
  all.emplace_back("keyentry with vectors head filled lw 2.5 lc rgb '#CC79A7'", "velocity of the obstacle");
  return all;
}

Figure family_figure(const VoAnswer& answer) {
  const ConeAnswer& a = answer.cones.front();
  Sheet sheet;
  sheet.title = markup("What different rules forbid in one encounter, " + horizon_text(a.encounter.time_horizon));
  sheet.x_label = markup("{/:Italic v}_x [m/s]");
  sheet.y_label = markup("{/:Italic v}_y [m/s]");
  sheet.columns = static_cast<int>(std::min<std::size_t>(answer.members.size(), 3));
  sheet.panel_width = sheet.panel_height = 300.0;
  sheet.legend = family_legend(answer);
  DataFile data;
  for (std::size_t k = 0; k < answer.members.size(); ++k) {
    Panel panel(data, square_round(view_of(answer.cones), 0.7));
    draw_member(answer.members[k], a, panel);
    sheet.panels.push_back(panel.on_sheet(letter_of(k) + " " + member_title(answer.members[k], a.encounter.velocity)));
  }
  return sheet_figure("family", data.text(), "What different rules forbid in one encounter.", sheet);
}

// --- The free velocities ---

std::vector<Points> outer_rings(const geometry::Region& region) {
  std::vector<Points> rings;
  for (const auto& piece : region.pieces()) rings.push_back(piece.polygon.outer);
  return rings;
}

std::vector<Points> hole_rings(const geometry::Region& region) {
  std::vector<Points> rings;
  for (const auto& piece : region.pieces())
    rings.insert(rings.end(), piece.polygon.holes.begin(), piece.polygon.holes.end());
  return rings;
}

Figure free_figure(const VoAnswer& answer) {
  const FreeAnswer& f = *answer.free;
  DataFile data;
  Box box;
  box.add(Vec2{-f.max_speed, -f.max_speed});
  box.add(Vec2{f.max_speed, f.max_speed});
  Panel panel(data, square_round(box, 0.55));
  panel.rings("free, but given away", outer_rings(f.free.inner()), kLost);
  panel.rings("", hole_rings(f.free.inner()), "with filledcurves closed fc rgb '#ffffff' fs solid noborder");
  if (f.report)
    panel.rings("kept by the half-planes", outer_rings(f.report->region),
                "with filledcurves closed fc rgb '#7fcdb4' fs solid noborder");
  const bool in_contact =
      std::any_of(answer.cones.begin(), answer.cones.end(), [](const ConeAnswer& a) { return a.overlaps; });
  if (in_contact) panel.ring("nothing is free: contact", outline(geometry::Disc{{}, f.max_speed}), kForbidden);
  std::vector<Points> forbidden;
  for (const ConeAnswer& a : answer.cones)
    if (!a.overlaps) forbidden.push_back(cone_in(panel.view(), a.cone, a.encounter.obstacle_velocity));
  panel.rings("velocity obstacles", forbidden, kForbidden);
  panel.boundaries("half-planes", f.half_planes);
  panel.arrow("velocity", {}, answer.question.velocity, "#444444");
  const std::string title =
      fmt::format("Free velocities: {:.4g} m²/s² are free, {:.4g} m²/s² are kept by the half-planes", f.free.area().low,
                  f.report ? f.report->area.low : 0.0);
  return {"free", data.text(), "The free velocities of a scene.", {960, 640}, panel.text(title)};
}

}  // namespace

Figure vo_figure(const VoAnswer& answer) {
  if (answer.free) return free_figure(answer);
  if (!answer.members.empty()) return family_figure(answer);
  return cone_figure(answer);
}

}  // namespace exactvo::tools
