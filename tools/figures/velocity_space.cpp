// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/velocity_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>

#include "exactvo/geometry/pi.h"
#include "figures/plane.h"

namespace exactvo::tools {

using formation::DecisionConstraint;

namespace {

constexpr const char* kStaticColour = "#7a8290";
constexpr const char* kRobotColour = "#CC79A7";
constexpr const char* kBindingColour = "#D55E00";
constexpr const char* kViolatedColour = "#a50026";  // and dashed
constexpr const char* kSlackColour = "#9a9a9a";
constexpr const char* kSlackNumber = "#6a6a6a";  // the same, readable as text
constexpr const char* kAllowedColour = "#cdeccd";
constexpr const char* kAllowedRim = "#4c9a4c";
constexpr const char* kWheelsColour = "#7b5ea7";
constexpr const char* kPreferredColour = "#1030ff";
constexpr const char* kChosenColour = "#2aa56f";
constexpr std::size_t kNameLength = 24;  // characters of a name in the title
constexpr double kTitleRoom = 800.0;     // px over the axes and a little beyond
constexpr const char* kPartly =
    "Recorded are half-planes that bind or are violated, and of what is near. Others may forbid more.";
constexpr int kArcPoints = 200;
/// More velocity obstacles than this are drawn paler and thinner.
constexpr int kFewCones = 4;

class VelocitySpace {
 public:
  explicit VelocitySpace(const Decision& decision) : d_(decision), panel_(Panel::of_velocities(view(), data_)) {
    add_allowed();
    add_cones_of(false, kStaticColour, "velocity obstacle of an obstacle");
    add_cones_of(true, kRobotColour, "velocity obstacle of a robot");
    // What its acceleration or its wheels allow, as one polygon: their lines beyond it would hide all else.
    panel_.half_planes("the robot's own limits", own_limits_,
                       fmt::format("with lines lw 1.5 lc rgb '{}'", kSlackColour), line_style(1, kSlackColour),
                       "its own limits", own_limits_);
    add_half_planes(Effect::slack, "lw 1.5", kSlackColour);
    add_half_planes(Effect::binding, "lw 3", kBindingColour);
    add_half_planes(Effect::violated, "lw 3 dt (8,4)", kViolatedColour);
    if (!constraints().empty())
      panel_.plot.item("keyentry with lines lw 1 lc rgb '#555555'", "hatched side: forbidden");
    panel_.rings("speed bound", {speed_bound_ring()}, line_style(1.5, "black", " dt (6,4)"), "speed bound");
    add_wheels();
    // The numbers of the printed explanation, beside the lines and in their colours; what is slack chooses last.
    add_numbers_of(Effect::binding, kBindingColour);
    add_numbers_of(Effect::violated, kViolatedColour);
    add_numbers_of(Effect::slack, kSlackNumber);
    add_arrows();
    // Where a step changes the velocity by little, the rim is what is seen of what it allows: nothing lies upon it.
    if (allowed_.size() >= 3) panel_.rings("rim of the allowed velocities", {allowed_}, line_style(2.5, kAllowedRim));
  }

  std::string data() const { return data_.text(); }
  const Panel& panel() const { return panel_; }

 private:
  /// A velocity obstacle.
  struct Cone {
    geometry::GrownShape shape;  ///< seen from the robot
    double time_horizon = 0.0;   ///< s
    Vec2 velocity;               ///< m/s
  };

  const std::vector<DecisionConstraint>& constraints() const { return d_.step.constraints; }
  double limit() const { return d_.who().max_speed; }

  Box view() const {
    Box box;
    for (const Vec2 corner : corners(Box{{-limit(), -limit()}, {limit(), limit()}})) box.add(1.35 * corner);
    for (const Vec2 v : {d_.step.preferred, d_.step.chosen, d_.step.velocity}) {
      if (is_finite(v)) box.add(1.1 * v);
    }
    // The line of a half-plane that the chosen velocity violates: without it all that is seen is forbidden.
    constexpr double kFarthestLine = 40.0;  // of the speed bound
    for (const DecisionConstraint& c : constraints()) {
      if (effect_of(d_, c) != Effect::violated) continue;
      const Vec2 foot = (c.half_plane.offset / squared_norm(c.half_plane.normal)) * c.half_plane.normal;
      if (norm(foot) <= kFarthestLine * limit()) box.add(1.1 * foot);
    }
    const double reach = std::max({-box.low.x, -box.low.y, box.high.x, box.high.y});
    return {{-reach, -reach}, {reach, reach}};
  }

  Points speed_bound_ring() const {
    const double v = limit();
    if (d_.scenario.speed_bound == formation::SpeedBoundKind::box) return corners(Box{{-v, -v}, {v, v}});
    return outline(geometry::Disc{{0.0, 0.0}, v});
  }

  void add_allowed() {
    allowed_ = speed_bound_ring();
    for (const DecisionConstraint& c : constraints()) allowed_ = clipped(allowed_, c.half_plane);
    for (const geometry::HalfPlane& h : own_limits_) allowed_ = clipped(allowed_, h);
    for (const formation::OwnConstraint& c : d_.step.own)
      if (c.hard && d_.step.own_stage == formation::OwnStage::held) allowed_ = clipped(allowed_, c.half_plane);
    if (allowed_.size() < 3) return;
    panel_.rings("allowed velocities", {allowed_}, solid_fill(kAllowedColour),
                 d_.has_all_half_planes ? "allowed velocities" : "allowed by the half-planes recorded");
  }

  /// What wheels can hold for ever at their present heading, whatever they do now: the hull of a disc about 0 and a
  /// point ahead (docs/guide/wheels.md, theorem 1).
  void add_wheels() {
    const std::optional<formation::DifferentialDrive>& drive = d_.who().drive;
    if (!drive || !d_.step.wheels) return;
    const double alpha = std::atan(drive->wheel_separation / (2.0 * drive->reference));
    const Vec2 ahead = drive->max_wheel_speed * d_.step.wheels->heading;
    Points ring{ahead};
    for (int i = 0; i <= kArcPoints; ++i)
      ring.push_back(std::cos(alpha) * rotated(ahead, alpha + (2.0 * geometry::kPi - 2.0 * alpha) * i / kArcPoints));
    panel_.rings("what its wheels can hold, theorem 1", {ring}, line_style(2, kWheelsColour, " dt (2,2)"),
                 "what its wheels can hold");
  }

  /// Those that have a cone: what the robot overlaps has none.
  std::vector<Cone> of_kind(bool robots) const {
    std::vector<Cone> result;
    for (std::size_t i = 0; i < constraints().size(); ++i) {
      const DecisionConstraint& c = constraints()[i];
      const Cone cone{grown_shape(d_.seen[i]), c.time_horizon, d_.seen[i].velocity};
      if ((c.source == formation::ConstraintSource::robot) == robots && leg_normals(cone.shape)) result.push_back(cone);
    }
    return result;
  }

  void add_cones_of(bool robots, const char* colour, const std::string& title) {
    const std::vector<Cone> all = of_kind(robots);
    if (all.empty()) return;
    std::vector<Points> rings;
    for (const Cone& c : all) rings.push_back(velocity_obstacle_in(panel_.view, c.shape, c.time_horizon, c.velocity));
    // Many on top of each other would hide what lies below.
    const double opacity = 0.3 * std::min(1.0, kFewCones / static_cast<double>(all.size()));
    add_curves(
        rings, title,
        fmt::format("with filledcurves closed fc rgb '{}' fs transparent solid {:.2f} noborder", colour, opacity),
        title);
    add_cone_lines(all, colour);
  }

  bool is_in_view(const Points& curve) const {
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      if (!segment_within(panel_.view, curve[i], curve[i + 1]).empty()) return true;
    }
    return false;
  }

  /// One data set of the curves that are in view; nothing, not even in the legend, where none is.
  void add_curves(const std::vector<Points>& curves, const std::string& what, const std::string& style,
                  const std::string& title) {
    std::vector<Points> seen;
    std::copy_if(curves.begin(), curves.end(), std::back_inserter(seen),
                 [&](const Points& c) { return is_in_view(c); });
    if (seen.empty()) return;
    panel_.curves(what, seen, style, title);
  }

  void add_cone_lines(const std::vector<Cone>& all, const char* colour) {
    std::vector<Points> legs;
    std::vector<Points> cut_offs;
    std::vector<Points> shapes;
    for (const Cone& c : all) {
      add_legs(c, legs);
      add_cut_off(c, cut_offs);
      add_shape(c, shapes);
    }
    const double thinner = all.size() > kFewCones ? 0.6 : 1.0;
    const auto lines = [&](double width, const char* dash) {
      return fmt::format("with lines lw {:.2g} {}lc rgb '{}'", thinner * width, dash, colour);
    };
    add_curves(legs, "their legs", lines(1.5, ""), "  its legs");
    add_curves(cut_offs, "their cut-offs", lines(3.0, ""), "  its cut-off");
    add_curves(shapes, "the shapes they come from, divided by tau", lines(1.0, "dt (2,3) "),
               "  its shape divided by τ");
  }

  Vec2 tangent_point(const Cone& c, Vec2 normal) const {
    return support_point(c.shape, normal) / c.time_horizon + c.velocity;
  }

  void add_legs(const Cone& c, std::vector<Points>& curves) const {
    const auto legs = leg_normals(c.shape);
    const Vec2 left = tangent_point(c, legs->first), right = tangent_point(c, legs->second);
    // Beyond any corner of the view, wherever in it or near it the leg starts.
    const double length = 4.0 * panel_.view.diagonal() + norm(left) + norm(right);
    curves.push_back({left, left - length * perp(legs->first)});
    curves.push_back({right, right + length * perp(legs->second)});
  }

  void add_cut_off(const Cone& c, std::vector<Points>& curves) const {
    const auto [from, to] = *leg_normals(c.shape);
    const double turn = std::atan2(cross(from, to), dot(from, to));
    Points arc;
    for (int i = 0; i <= kArcPoints; ++i) arc.push_back(tangent_point(c, rotated(from, turn * i / kArcPoints)));
    curves.push_back(arc);
  }

  void add_shape(const Cone& c, std::vector<Points>& curves) const {
    Points ring = scaled_outline(c.shape, c.time_horizon);
    for (Vec2& p : ring) p += c.velocity;
    if (!ring.empty()) ring.push_back(ring.front());
    curves.push_back(ring);
  }

  void add_half_planes(Effect effect, const std::string& style, const char* colour) {
    std::vector<geometry::HalfPlane> all, own;
    for (const DecisionConstraint& c : constraints())
      if (effect_of(d_, c) == effect) (is_own_limit(c) ? own : all).push_back(c.half_plane);
    const std::string title = "half-plane, " + name(effect);
    const std::string lines = fmt::format("with lines {} lc rgb '{}'", style, colour);
    panel_.half_planes(title, all, lines, line_style(1, colour), title);
    if (effect != Effect::slack)
      panel_.half_planes("its own limit, " + name(effect), own, lines, line_style(1, colour), all.empty() ? title : "",
                         own_limits_);
  }

  void add_numbers_of(Effect effect, const char* colour) {
    std::vector<Label> numbers;
    for (std::size_t i = 0; i < constraints().size(); ++i) {
      if (effect_of(d_, constraints()[i]) != effect) continue;
      const bool is_own = is_own_limit(constraints()[i]);
      if (is_own && effect == Effect::slack) continue;
      const Points line = stretch_within(is_own ? own_limits_ : std::vector<geometry::HalfPlane>(),
                                         boundary_within(panel_.view, constraints()[i].half_plane));
      if (line.empty()) continue;
      numbers.push_back({free_place(line, constraints()[i].half_plane.normal), fmt::format("[{}]", i + 1)});
    }
    panel_.labels("numbers of the half-planes", numbers,
                  fmt::format("with labels boxed font ',11' textcolor rgb '{}'", colour));
  }

  /// On the allowed side of the line, in view, as far as possible from the numbers that are there: the first place
  /// that is far enough, else the farthest.
  Vec2 free_place(const Points& line, Vec2 normal) {
    const Vec2 aside = 0.03 * panel_.view.width() * normalized(normal);
    const Box inner = panel_.view.grown(-0.02 * panel_.view.width());
    Vec2 best = line[0] + 0.5 * (line[1] - line[0]) + aside;
    double room = -1.0;
    for (const double along : {0.12, 0.88, 0.25, 0.75, 0.06, 0.94, 0.35, 0.65, 0.5}) {
      const Vec2 place = line[0] + along * (line[1] - line[0]) + aside;
      const double here = inner.contains(place) ? distance_to_numbers(place) : 0.0;
      if (here > room) {
        room = here;
        best = place;
      }
      if (room > 0.07 * panel_.view.width()) break;
    }
    numbers_.push_back(best);
    return best;
  }

  double distance_to_numbers(Vec2 place) const {
    double least = panel_.view.diagonal();
    for (const Vec2 other : numbers_) least = std::min(least, norm(place - other));
    return least;
  }

  /// `tip`: the size of the point at its end.
  void add_arrow(const std::string& title, Vec2 v, const std::string& shaft, double tip, const char* colour) {
    panel_.arrow(title, {}, v, fmt::format("{} lc rgb '{}'", shaft, colour), title);
    panel_.points(title + ": tip", {v}, fmt::format("with points pt 7 ps {} lc rgb '{}'", tip, colour));
  }

  void add_arrows() {
    // Thinner and thinner: where they are the same, each is seen on those before.
    add_arrow("chosen velocity", d_.step.chosen, "head filled size screen 0.018,18 lw 4.5", 0.702, kChosenColour);
    add_arrow("present velocity", d_.step.velocity, "head filled size screen 0.01,18 lw 1.5", 0.39, "#444444");
    // Without a head, which gnuplot would dash too.
    add_arrow("preferred velocity", d_.step.preferred, "nohead lw 2 dt (8,8)", 1.1, kPreferredColour);
  }

  const Decision& d_;
  DataFile data_;
  Panel panel_;
  std::vector<geometry::HalfPlane> own_limits_ = formation::own_limits(d_.scenario, d_.step, d_.robot);
  Points allowed_;  ///< a ring
  Points numbers_;  ///< where numbers stand
};

}  // namespace

Figure velocity_space_figure(const Decision& decision) {
  const VelocitySpace space(decision);
  const std::string what =
      fmt::format("{}: velocity space of {} at t = {:.2f} s", shortened(decision.scenario.name, kNameLength),
                  shortened(decision.who().id, kNameLength), decision.time);
  const std::string title = what + ", " + decision.method;
  std::string titles = title.size() <= characters_in(kTitleRoom)
                           ? quoted(title)
                           : quoted(what) + ".\"\\n\"." + quoted(shortened(decision.method, characters_in(kTitleRoom)));
  if (!decision.has_all_half_planes) titles += ".\"\\n\"." + quoted(kPartly);
  return {"velocity_space",
          space.data(),
          title + ".",
          {1060, 740},
          velocity_plane(titles, space.panel().view, space.panel().plot.text())};
}

}  // namespace exactvo::tools
