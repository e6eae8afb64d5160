// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/velocity_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "figures/outlines.h"

namespace exactvo::tools {

using formation::ConstraintSource;
using formation::RecordedConstraint;
using geometry::HalfPlane;

namespace {

constexpr const char* kStaticColour = "#7a8290";
constexpr const char* kRobotColour = "#CC79A7";
constexpr const char* kActiveColour = "#D55E00";
constexpr const char* kSlackColour = "#9a9a9a";
constexpr const char* kAllowedColour = "#cdeccd";
constexpr const char* kPreferredColour = "#0072B2";
constexpr const char* kChosenColour = "#007a4d";
constexpr int kArcPoints = 200;
constexpr int kHatchesAcross = 45;  // over the width of the view

class VelocitySpace {
 public:
  explicit VelocitySpace(const Decision& decision) : d_(decision), view_(view()) {
    add_allowed();
    add_cones();
    add_slack_half_planes();
    add_active_half_planes();
    add_speed_bound();
    add_numbers();
    add_arrows();
  }

  std::string data() const { return data_.text(); }
  std::string plot() const { return plot_.text(); }
  const Box& box() const { return view_; }

 private:
  const std::vector<RecordedConstraint>& constraints() const { return d_.step.constraints; }
  double limit() const { return d_.who().max_speed; }

  Box view() const {
    Box box;
    for (const Vec2 corner : corners(Box{{-limit(), -limit()}, {limit(), limit()}})) box.add(1.35 * corner);
    for (const Vec2 v : {d_.step.preferred, d_.step.chosen, d_.step.velocity}) {
      if (is_finite(v)) box.add(1.1 * v);
    }
    const double reach = std::max({-box.low.x, -box.low.y, box.high.x, box.high.y});
    return {{-reach, -reach}, {reach, reach}};
  }

  void add_points(const Points& points) {
    for (const Vec2 p : points) data_.row({p.x, p.y});
    data_.gap();
  }
  void add_ring(Points ring) {
    if (ring.empty()) return;
    ring.push_back(ring.front());
    add_points(ring);
  }

  Points speed_bound_ring() const {
    const double v = limit();
    if (d_.scenario.speed_bound == formation::SpeedBoundKind::box) return corners(Box{{-v, -v}, {v, v}});
    return outline(geometry::Disc{{0.0, 0.0}, v});
  }

  void add_allowed() {
    Points ring = speed_bound_ring();
    for (const RecordedConstraint& c : constraints()) ring = clipped(ring, c.half_plane);
    if (ring.size() < 3) return;
    const int index = data_.begin("allowed velocities", "v_x [m/s], v_y [m/s]");
    add_ring(ring);
    plot_.data(index, fmt::format("using 1:2 with filledcurves closed fc rgb '{}' fs solid noborder", kAllowedColour),
               "allowed velocities");
  }

  void add_cones() {
    add_cones_of(false, kStaticColour, "velocity obstacle of an obstacle");
    add_cones_of(true, kRobotColour, "velocity obstacle of a robot");
  }

  std::vector<const RecordedConstraint*> of_kind(bool robots) const {
    std::vector<const RecordedConstraint*> result;
    for (const RecordedConstraint& c : constraints()) {
      if ((c.source == ConstraintSource::robot) == robots) result.push_back(&c);
    }
    return result;
  }

  void add_cones_of(bool robots, const char* colour, const std::string& title) {
    const std::vector<const RecordedConstraint*> all = of_kind(robots);
    if (all.empty()) return;
    const int inside = data_.begin(title, "v_x [m/s], v_y [m/s]");
    for (const RecordedConstraint* c : all)
      add_ring(velocity_obstacle_in(view_, grown_shape(*c), c->tau, c->shape_velocity));
    plot_.data(inside,
               fmt::format("using 1:2 with filledcurves closed fc rgb '{}' fs transparent solid 0.3 noborder", colour),
               title);
    add_cone_lines(all, colour);
  }

  void add_cone_lines(const std::vector<const RecordedConstraint*>& all, const char* colour) {
    const int legs = data_.begin("their legs", "v_x [m/s], v_y [m/s]");
    for (const RecordedConstraint* c : all) add_legs(*c);
    plot_.data(legs, fmt::format("using 1:2 with lines lw 1.5 lc rgb '{}'", colour), "  its legs");
    const int cut_offs = data_.begin("their cut-offs", "v_x [m/s], v_y [m/s]");
    for (const RecordedConstraint* c : all) add_cut_off(*c);
    plot_.data(cut_offs, fmt::format("using 1:2 with lines lw 3 lc rgb '{}'", colour), "  its cut-off");
    const int shapes = data_.begin("the shapes they come from, divided by tau", "v_x [m/s], v_y [m/s]");
    for (const RecordedConstraint* c : all) add_shape(*c);
    plot_.data(shapes, fmt::format("using 1:2 with lines lw 1 dt (2,3) lc rgb '{}'", colour), "  its shape / τ");
  }

  Vec2 tangent_point(const RecordedConstraint& c, Vec2 normal) const {
    return support_point(grown_shape(c), normal) / c.tau + c.shape_velocity;
  }

  void add_legs(const RecordedConstraint& c) {
    const std::optional<LegNormals> legs = leg_normals(grown_shape(c));
    if (!legs) return;
    // Beyond any corner of the view, wherever in it or near it the leg starts.
    const double length =
        4.0 * view_.diagonal() + norm(tangent_point(c, legs->left)) + norm(tangent_point(c, legs->right));
    const Vec2 left = tangent_point(c, legs->left);
    const Vec2 right = tangent_point(c, legs->right);
    add_points({left, left - length * perp(legs->left)});
    add_points({right, right + length * perp(legs->right)});
  }

  void add_cut_off(const RecordedConstraint& c) {
    const std::optional<LegNormals> legs = leg_normals(grown_shape(c));
    if (!legs) return;
    const double turn = std::atan2(cross(legs->left, legs->right), dot(legs->left, legs->right));
    Points arc;
    for (int i = 0; i <= kArcPoints; ++i) {
      arc.push_back(tangent_point(c, rotated(legs->left, turn * i / kArcPoints)));
    }
    add_points(arc);
  }

  void add_shape(const RecordedConstraint& c) {
    Points ring = scaled_outline(grown_shape(c), c.tau);
    for (Vec2& p : ring) p += c.shape_velocity;
    add_ring(ring);
  }

  /// The stretch of a half-plane's boundary that is in view; empty where none is.
  Points boundary_in_view(const HalfPlane& h) const {
    const Points kept = clipped(corners(view_), h);
    const double along = 4.0 * view_.diagonal();
    const Vec2 n = normalized(h.normal);
    const Vec2 foot = (h.offset / norm(h.normal)) * n;
    if (kept.empty() || !view_.grown(along).contains(foot)) return {};
    return segment_in_view(foot - along * perp(n), foot + along * perp(n));
  }

  /// Cut by the four sides of the view in turn.
  Points segment_in_view(Vec2 a, Vec2 b) const {
    const HalfPlane sides[] = {{{1.0, 0.0}, view_.low.x},
                               {{-1.0, 0.0}, -view_.high.x},
                               {{0.0, 1.0}, view_.low.y},
                               {{0.0, -1.0}, -view_.high.y}};
    for (const HalfPlane& side : sides) {
      const double out_a = violation(side, a);
      const double out_b = violation(side, b);
      if (out_a > 0.0 && out_b > 0.0) return {};
      const Vec2 cut = out_a == out_b ? a : a + (out_a / (out_a - out_b)) * (b - a);
      if (out_a > 0.0) a = cut;
      if (out_b > 0.0) b = cut;
    }
    return {a, b};
  }

  /// Strokes on the forbidden side, aslant.
  void add_hatching(const Points& line, Vec2 normal) {
    const double gap = view_.width() / kHatchesAcross;
    const Vec2 along = normalized(line[1] - line[0]);
    const Vec2 stroke = -0.9 * gap * normalized(normal) + 0.6 * gap * along;
    const double length = norm(line[1] - line[0]);
    const int count = static_cast<int>(length / gap);
    for (int i = 0; i < count; ++i) {
      const Vec2 foot = line[0] + (i + 0.5) * gap * along;
      add_points({foot, foot + stroke});
    }
  }

  void add_half_planes(bool active, const char* colour, double width, const std::string& title) {
    std::vector<std::pair<Points, Vec2>> lines;
    for (const RecordedConstraint& c : constraints()) {
      const Points line = c.active == active ? boundary_in_view(c.half_plane) : Points{};
      if (!line.empty()) lines.emplace_back(line, c.half_plane.normal);
    }
    if (lines.empty()) return;
    const int boundaries = data_.begin(title + ": boundaries", "v_x [m/s], v_y [m/s]");
    for (const auto& [line, normal] : lines) add_points(line);
    const int hatching = data_.begin(title + ": hatching on the forbidden side", "v_x [m/s], v_y [m/s]");
    for (const auto& [line, normal] : lines) add_hatching(line, normal);
    plot_.data(boundaries, fmt::format("using 1:2 with lines lw {} lc rgb '{}'", width, colour), title);
    plot_.data(hatching, fmt::format("using 1:2 with lines lw 1 lc rgb '{}'", colour));
  }

  void add_slack_half_planes() { add_half_planes(false, kSlackColour, 1.5, "half-plane, slack"); }
  void add_active_half_planes() { add_half_planes(true, kActiveColour, 3.0, "half-plane, binding"); }

  void add_speed_bound() {
    const int index = data_.begin("speed bound", "v_x [m/s], v_y [m/s]");
    add_ring(speed_bound_ring());
    plot_.data(index, "using 1:2 with lines lw 1.5 dt (6,4) lc rgb 'black'", "speed bound");
  }

  /// The numbers of the printed explanation, beside the middles of the lines.
  void add_numbers() {
    const int index = data_.begin("numbers of the half-planes", "v_x [m/s], v_y [m/s], number");
    const double beside = 0.035 * view_.width();
    bool any = false;
    for (std::size_t i = 0; i < constraints().size(); ++i) {
      const HalfPlane& h = constraints()[i].half_plane;
      const Points line = boundary_in_view(h);
      if (line.empty()) continue;
      const Vec2 at = line[0] + 0.12 * (line[1] - line[0]) + beside * normalized(h.normal);
      data_.labelled_row({at.x, at.y}, fmt::format("[{}]", i + 1));
      any = true;
    }
    if (any) plot_.data(index, "using 1:2:3 with labels font ',11' textcolor rgb '#222222'");
  }

  void add_arrow(const std::string& title, Vec2 v, const char* colour, double width) {
    const int index = data_.begin(title, "from v_x, v_y, by v_x, v_y [m/s]");
    data_.row({0.0, 0.0, v.x, v.y});
    const std::string style = fmt::format("lw {} lc rgb '{}'", width, colour);
    plot_.data(index, "using 1:2:3:4 with vectors head filled size screen 0.018,18 " + style, title);
    plot_.data(index, fmt::format("using ($1+$3):($2+$4) with points pt 7 ps 0.7 lc rgb '{}'", colour));
  }

  void add_arrows() {
    add_arrow("present velocity", d_.step.velocity, "#444444", 1.5);
    add_arrow("preferred velocity", d_.step.preferred, kPreferredColour, 2.5);
    add_arrow("chosen velocity", d_.step.chosen, kChosenColour, 3.5);
  }

  const Decision& d_;
  Box view_;
  DataFile data_;
  PlotCommand plot_;
};

}  // namespace

Figure velocity_space_figure(const Decision& decision, const std::string& name) {
  const VelocitySpace space(decision);
  const std::string title =
      fmt::format("{}: velocity space of {} at t = {:.2f} s", decision.scenario.name, decision.who().id, decision.time);
  const std::string body = fmt::format(
      "  set title {}\n"
      "  set size ratio -1\n"
      "  set clip two\n"
      "  set xrange [{:.6g}:{:.6g}]\n"
      "  set yrange [{:.6g}:{:.6g}]\n"
      "  set xlabel 'v_x [m/s]'\n"
      "  set ylabel 'v_y [m/s]'\n"
      "  set grid lc rgb '#e9e9e9'\n"
      "  set key outside right top reverse Left samplen 3\n"
      "{}",
      quoted(title), space.box().low.x, space.box().high.x, space.box().low.y, space.box().high.y, space.plot());
  return {name, space.data(), script_text(name, title + ", " + decision.method + ".", {1060, 740}, body)};
}

}  // namespace exactvo::tools
