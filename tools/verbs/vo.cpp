// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo vo: one velocity obstacle, its answers and their certificates.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "figures/figure.h"
#include "figures/outlines.h"
#include "support/files.h"
#include "support/run.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using geometry::ConvexShape;
using geometry::HalfPlane;
using geometry::Vec2;
using vo::VelocityObstacle;

namespace {

struct Flags {
  std::string obstacle;
  std::string enclose = "none";
  std::string position, velocity, goal;
  double radius = 0.0;
  double time_horizon = 0.0;
  double alpha = 1.0;
  bool json = false;
  std::string figure;
};

Vec2 parse_point(const std::string& option, const std::string& text) {
  Vec2 v;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf%c", &v.x, &v.y, &rest) != 2 || !is_finite(v))
    throw UsageError(option, text, "two finite numbers, X,Y");
  return v;
}

std::vector<Vec2> obstacle_points(const std::string& text) {
  const bool is_file = fs::exists(text);
  const datasets::ObstacleFile file =
      is_file ? datasets::read_obstacles(text) : datasets::parse_wkt(text, "--obstacle", {});
  if (file.obstacles.size() != 1)
    throw UsageError("--obstacle", fmt::format("{} obstacles", file.obstacles.size()), "one obstacle");
  return vertices_of(file.obstacles[0].shape);
}

ConvexShape hull_of(const std::vector<Vec2>& points) {
  geometry::ConvexPolygon hull = geometry::convex_hull(points);
  if (hull.vertices.size() > 2) return hull;
  return geometry::Segment{hull.vertices.front(), hull.vertices.back()};
}

ConvexShape trap_free(const std::vector<Vec2>& points, const Flags& flags) {
  if (flags.goal.empty()) throw UsageError("--enclose", "trap-free without --goal", "a goal, X,Y");
  const auto fitted = geometry::fit_trap_free(points, flags.radius, parse_point("--position", flags.position),
                                              parse_point("--goal", flags.goal));
  if (!fitted) throw UsageError("--enclose", "trap-free", "a robot and a goal farther from the obstacle");
  return fitted->ellipse;
}

/// A velocity obstacle is built of a convex shape: the hull of the obstacle, or an ellipse round it.
ConvexShape convex_shape(const Flags& flags) {
  const std::vector<Vec2> points = obstacle_points(flags.obstacle);
  if (flags.enclose == "none") return hull_of(points);
  if (flags.enclose == "ellipse") return geometry::smallest_ellipse(points);
  if (flags.enclose == "trap-free") return trap_free(points, flags);
  throw UsageError("--enclose", flags.enclose, "one of none ellipse trap-free");
}

// --- JSON ---

std::string json(double x) {
  return std::isfinite(x) ? fmt::format("{}", x) : "null";
}
std::string json(Vec2 v) {
  return fmt::format("[{}, {}]", json(v.x), json(v.y));
}
std::string json(bool b) {
  return b ? "true" : "false";
}

std::string leg_json(const char* side, const vo::Leg& leg) {
  return fmt::format(
      "{{\"side\": \"{}\", \"direction\": {}, \"touch\": {}, \"bracket\": {{\"inside\": {}, \"outside\": {}}}}}", side,
      json(leg.direction), json(leg.touch), json(leg.normal), json(leg.normal_outside));
}

std::string legs_json(const VelocityObstacle& obstacle) {
  const auto legs = obstacle.legs();
  if (!legs) return "null";
  return fmt::format("[{},\n           {}]", leg_json("left", legs->left), leg_json("right", legs->right));
}

const char* name(vo::BoundaryPart part) {
  if (part == vo::BoundaryPart::cut_off) return "cut-off";
  return part == vo::BoundaryPart::left_leg ? "left leg" : "right leg";
}

struct Answer {
  VelocityObstacle obstacle;
  Vec2 velocity;
  bool overlaps;
  std::optional<HalfPlane> half_plane;  ///< with the asked alpha
  std::optional<vo::Certificate> certificate;
};

/// alpha < 1 is safe only together with somebody else's half: what can be certified is the half-plane of alpha = 1.
Answer answer(const Flags& flags) {
  Answer a{VelocityObstacle(convex_shape(flags), parse_point("--position", flags.position), flags.radius,
                            flags.time_horizon),
           parse_point("--velocity", flags.velocity),
           false,
           {},
           {}};
  a.overlaps = a.obstacle.overlaps();
  if (a.overlaps) return a;
  a.half_plane = a.obstacle.half_plane(a.velocity, flags.alpha);
  if (const auto full = a.obstacle.half_plane(a.velocity)) {
    const geometry::GrownShape& s = a.obstacle.grown();
    a.certificate = vo::certify({s.shape, s.origin, s.radius, a.obstacle.time_horizon(), {}, *full});
  }
  return a;
}

std::string boundary_json(const Answer& a) {
  if (a.overlaps) return "\"nearest_boundary\": null,\n  \"u\": null";
  const vo::NearestBoundary nearest = a.obstacle.nearest_boundary(a.velocity);
  return fmt::format(
      "\"nearest_boundary\": {{\"part\": \"{}\", \"normal\": {}, \"signed_distance\": {}, \"point\": {}}},\n"
      "  \"u\": {}",
      name(nearest.part), json(nearest.normal), json(nearest.signed_distance), json(a.velocity + nearest.u),
      json(nearest.u));
}

std::string half_plane_json(const Answer& a) {
  if (!a.half_plane) return "null";
  return fmt::format("{{\"normal\": {}, \"offset\": {}}}", json(a.half_plane->normal), json(a.half_plane->offset));
}

std::string certificate_json(const Answer& a) {
  if (!a.certificate) return "null";
  return fmt::format("{{\"verdict\": \"{}\", \"margin\": {}, \"text\": \"{}\"}}", name(check(*a.certificate)),
                     json(a.certificate->margin), write_certificate(*a.certificate));
}

std::string to_json(const Answer& a) {
  const std::string contains = a.overlaps ? "null" : json(a.obstacle.contains(a.velocity));
  const std::string legs = a.overlaps ? "null" : legs_json(a.obstacle);
  const std::string boundary = boundary_json(a);
  const geometry::StageCounts counts = geometry::stage_counts();
  return fmt::format(
      "{{\n  \"shape\": \"{}\",\n  \"overlaps\": {},\n  \"contains_velocity\": {},\n  \"legs\": {},\n  {},\n"
      "  \"half_plane\": {},\n  \"certificate\": {},\n  \"stage_counts\": {{\"filter\": {}, \"exact\": {}}}\n}}\n",
      to_string(a.obstacle.grown().shape), json(a.overlaps), contains, legs, boundary, half_plane_json(a),
      certificate_json(a), counts.filter, counts.exact);
}

// --- The figure ---

Box view_of(const Answer& a) {
  Box box;
  box.add(Vec2{});
  box.add(a.velocity);
  for (const Vec2 p : scaled_outline(a.obstacle.grown(), a.obstacle.time_horizon())) box.add(p);
  const double half = 0.65 * std::max(box.width(), box.height());
  const Vec2 middle = 0.5 * (box.low + box.high);
  return {{middle.x - half, middle.y - half}, {middle.x + half, middle.y + half}};
}

class VelocityObstacleFigure {
 public:
  explicit VelocityObstacleFigure(const Answer& a) : a_(a), view_(view_of(a)) {
    const geometry::GrownShape& s = a.obstacle.grown();
    ring("velocity obstacle", velocity_obstacle_in(view_, s, a.obstacle.time_horizon(), {}),
         "with filledcurves closed fc rgb '#7a8290' fs transparent solid 0.35 noborder");
    ring("S / tau", scaled_outline(s, a.obstacle.time_horizon()), "with lines lw 1.5 dt (2,3) lc rgb '#3f444d'");
    if (a.half_plane) boundary(*a.half_plane);
    arrow("velocity", {}, a.velocity, "#444444");
    if (!a.overlaps) arrow("least change u", a.velocity, a.obstacle.nearest_boundary(a.velocity).u, "#D55E00");
  }

  Figure figure(const std::string& name) const {
    const std::string title = "Velocity obstacle, tau = " + fmt::format("{:g} s", a_.obstacle.time_horizon());
    const std::string body = fmt::format(
        "  set title {}\n  set size ratio -1\n  set clip two\n  set xrange [{:.6g}:{:.6g}]\n  set yrange "
        "[{:.6g}:{:.6g}]\n"
        "  set xlabel 'v_x [m/s]'\n  set ylabel 'v_y [m/s]'\n  set grid lc rgb '#e9e9e9'\n"
        "  set key outside right top reverse Left samplen 3\n{}",
        quoted(title), view_.low.x, view_.high.x, view_.low.y, view_.high.y, plot_.text());
    return {name, data_.text(), script_text(name, title + ".", {900, 640}, body)};
  }

 private:
  void ring(const std::string& title, Points points, const std::string& style) {
    if (points.empty()) return;
    points.push_back(points.front());
    const int index = data_.begin(title, "v_x [m/s], v_y [m/s]");
    for (const Vec2 p : points) data_.row({p.x, p.y});
    plot_.data(index, "using 1:2 " + style, title);
  }
  void boundary(const HalfPlane& h) {
    const double length = norm(h.normal);
    const Vec2 foot = (h.offset / (length * length)) * h.normal;
    const Vec2 along = (2.0 * view_.diagonal() / length) * perp(h.normal);
    const int index = data_.begin("half-plane", "v_x [m/s], v_y [m/s]");
    data_.row({foot.x - along.x, foot.y - along.y});
    data_.row({foot.x + along.x, foot.y + along.y});
    plot_.data(index, "using 1:2 with lines lw 2.5 lc rgb '#009E73'", "boundary of the half-plane");
  }
  void arrow(const std::string& title, Vec2 from, Vec2 by, const char* colour) {
    const int index = data_.begin(title, "from v_x, v_y, by v_x, v_y [m/s]");
    data_.row({from.x, from.y, by.x, by.y});
    plot_.data(index,
               fmt::format("using 1:2:3:4 with vectors head filled size screen 0.018,18 lw 2.5 lc rgb '{}'", colour),
               title);
  }

  const Answer& a_;
  Box view_;
  DataFile data_;
  PlotCommand plot_;
};

void write_figure(const Answer& a, const fs::path& out) {
  const fs::path parent = fs::absolute(out).parent_path();
  make_folder(parent);
  const std::string stem = out.stem().string();
  StagedFolder folder(parent / ("." + stem + ".figure"));
  draw({write_sources(VelocityObstacleFigure(a).figure(stem), folder.path())});
  for (const char* extension : {".dat", ".gp", ".png", ".svg"}) {
    if (fs::exists(folder.path() / (stem + extension)))
      fs::rename(folder.path() / (stem + extension), parent / (stem + extension));
  }
  message("wrote " + out.string());
}

// --- The verb ---

std::string in_words(const Answer& a) {
  if (a.overlaps) return "The robot touches or overlaps the obstacle: there is no cone.\n";
  std::string text = a.obstacle.contains(a.velocity) ? "The velocity collides within the horizon.\n"
                                                     : "The velocity is free within the horizon.\n";
  const vo::NearestBoundary nearest = a.obstacle.nearest_boundary(a.velocity);
  text +=
      fmt::format("nearest boundary  {}, {:.6g} m/s away\n", name(nearest.part), std::fabs(nearest.signed_distance));
  text += fmt::format("u                 ({:.6g}, {:.6g}) m/s\n", nearest.u.x, nearest.u.y);
  if (a.half_plane)
    text += fmt::format("half-plane        {:+.6g} v_x {:+.6g} v_y >= {:.6g} m/s\n", a.half_plane->normal.x,
                        a.half_plane->normal.y, a.half_plane->offset);
  return text + fmt::format("certificate       {}\n", a.certificate ? name(check(*a.certificate)) : "none");
}

void check_flags(const Flags& flags) {
  const auto require = [](bool ok, const char* option, double found, const char* expected) {
    if (!ok) throw UsageError(option, fmt::format("{}", found), expected);
  };
  require(flags.radius >= 0.0 && std::isfinite(flags.radius), "--radius", flags.radius, "a length from 0 m on");
  require(flags.time_horizon > 0.0 && std::isfinite(flags.time_horizon), "--time-horizon", flags.time_horizon,
          "a time above 0 s");
  require(flags.alpha > 0.0 && flags.alpha <= 1.0, "--alpha", flags.alpha, "a number in (0, 1]");
  if (!flags.figure.empty() && fs::path(flags.figure).extension() != ".svg")
    throw UsageError("--figure", flags.figure, "a name that ends in .svg");
}

ExitCode show(const Flags& flags) {
  check_flags(flags);
  const Answer a = answer(flags);
  if (!flags.figure.empty()) write_figure(a, flags.figure);
  const std::string text = flags.json ? to_json(a) : in_words(a);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return ExitCode::success;
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("--obstacle", flags->obstacle, "WKT, or a file with one obstacle; its convex hull is taken")
      ->required();
  app.add_option("--enclose", flags->enclose, "none, ellipse (the smallest) or trap-free (needs --goal)");
  app.add_option("--position", flags->position, "Of the robot, X,Y in m")->required();
  app.add_option("--velocity", flags->velocity, "X,Y in m/s")->required();
  app.add_option("--radius", flags->radius, "Of the robot, m")->required();
  app.add_option("--time-horizon", flags->time_horizon, "s")->required();
  app.add_option("--alpha", flags->alpha, "The share of the change that the robot takes; 1 is certified");
  app.add_option("--goal", flags->goal, "X,Y in m, for --enclose trap-free");
  app.add_flag("--json", flags->json, "Everything as JSON on stdout");
  app.add_option("--figure", flags->figure, "FILE.svg; FILE.png, FILE.dat and FILE.gp (gnuplot) appear beside it");
  return [flags] { return show(*flags); };
}

}  // namespace

Verb vo_verb() {
  return {"vo", "One velocity obstacle: its legs, nearest boundary and certified half-plane",
          "  exactvo vo --obstacle 'POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))' --enclose ellipse --position 0,0 \\\n"
          "      --velocity 1,0.2 --radius 0.5 --time-horizon 2 --json --figure out/cone.svg\n",
          declare};
}

}  // namespace exactvo::tools
