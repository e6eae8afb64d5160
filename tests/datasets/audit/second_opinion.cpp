// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/second_opinion.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace exactvo::datasets::test {
namespace {

using geometry::Vec2;
using nlohmann::json;

constexpr double kClose = 1e-9;      // m, m/s: what sampling in doubles can tell
constexpr double kPlanClose = 2e-8;  // m: plans are rounded by a share of 1e-8 of the radii, here below a metre
constexpr double kSame = 1e-6;       // of laws of motion that are integrated here in another way

// --- Plain values out of JSON ---

double number(const json& j) {
  if (j.is_number()) return j.get<double>();
  return std::nan("");
}
Vec2 point(const json& j) {
  return {number(j.at(0)), number(j.at(1))};
}
std::vector<Vec2> points(const json& j) {
  std::vector<Vec2> all;
  for (const json& p : j) all.push_back(point(p));
  return all;
}

/// A chain of points, closed or not, and whether it has an inside.
struct Outline {
  std::vector<std::pair<Vec2, Vec2>> edges;
  bool solid = false;
};

void add_ring(const std::vector<Vec2>& ring, Outline& outline) {
  for (std::size_t k = 0; k < ring.size(); ++k) outline.edges.emplace_back(ring[k], ring[(k + 1) % ring.size()]);
}

Outline outline_of(const json& obstacle) {
  Outline outline;
  if (obstacle.contains("polyline")) {
    const std::vector<Vec2> p = points(obstacle["polyline"]);
    for (std::size_t k = 0; k + 1 < p.size(); ++k) outline.edges.emplace_back(p[k], p[k + 1]);
    return outline;
  }
  outline.solid = true;
  add_ring(points(obstacle.at("polygon")), outline);
  if (obstacle.contains("holes"))
    for (const json& hole : obstacle["holes"]) add_ring(points(hole), outline);
  return outline;
}

Vec2 nearest_on(const std::pair<Vec2, Vec2>& edge, Vec2 p) {
  const Vec2 e = edge.second - edge.first;
  const double l2 = dot(e, e);
  const double t = l2 > 0.0 ? std::clamp(dot(p - edge.first, e) / l2, 0.0, 1.0) : 0.0;
  return edge.first + t * e;
}

/// Ends may be as far away as doubles go: by long doubles, and without the nearest point.
long double distance_from_edge(const std::pair<Vec2, Vec2>& edge, Vec2 p) {
  const auto [a, b] = edge;
  const long double ex = static_cast<long double>(b.x) - a.x, ey = static_cast<long double>(b.y) - a.y;
  const long double ax = static_cast<long double>(p.x) - a.x, ay = static_cast<long double>(p.y) - a.y;
  const long double bx = static_cast<long double>(p.x) - b.x, by = static_cast<long double>(p.y) - b.y;
  if (ax * ex + ay * ey <= 0.0L) return std::hypot(ax, ay);
  if (bx * ex + by * ey >= 0.0L) return std::hypot(bx, by);
  return std::fabs(ex * ay - ey * ax) / std::hypot(ex, ey);
}

bool inside(const Outline& o, Vec2 p) {
  bool in = false;
  for (const auto& [a, b] : o.edges)
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  return in;
}

double distance(const Outline& o, Vec2 p) {
  double least = 1e300;
  for (const auto& edge : o.edges) least = std::min(least, norm(p - nearest_on(edge, p)));
  return o.solid && inside(o, p) ? -least : least;
}

/// The distance of two segments: of an end from the other segment, unless they cross.
double distance(const std::pair<Vec2, Vec2>& one, const std::pair<Vec2, Vec2>& other) {
  const auto side = [](const std::pair<Vec2, Vec2>& s, Vec2 p) { return cross(s.second - s.first, p - s.first); };
  if (side(one, other.first) * side(one, other.second) < 0.0 && side(other, one.first) * side(other, one.second) < 0.0)
    return 0.0;
  return std::min({norm(one.first - nearest_on(other, one.first)), norm(one.second - nearest_on(other, one.second)),
                   norm(other.first - nearest_on(one, other.first)),
                   norm(other.second - nearest_on(one, other.second))});
}

// --- Scenarios ---

/// What the scenario's schema gives a member that is left out.
const json& defaults() {
  static const json all = json::parse(R"({"description": "", "velocity": [0, 0], "radius": 0.5, "max_speed": 3,
    "cooperates": true, "goals": [], "obstacles": [], "moving_obstacles": [], "speed_bound": "disc", "least": 0.3,
    "most": 3, "speed_floor": 0.5, "orca": 2, "robots": 2, "obstacle": 0.08, "robot": 0.04, "time_step": 0.05,
    "time_limit": 120, "arrival_tolerance": 0.1, "neighbour_distance": 15, "k1": 0.25, "k2": 0.45, "k3": 37.5,
    "kappa": 1.5, "recentre": true, "catch_up_speed": 1.5, "guidance": "route", "unreachable": "stay",
    "liveness": "plan"})");
  return all;
}

bool is_default(const std::string& key, const json& value) {
  if (defaults().contains(key)) return defaults()[key] == value;
  if (!value.is_object()) return false;
  for (const auto& [member, inner] : value.items())
    if (!is_default(member, inner)) return false;
  return true;
}

/// A vertex that is given twice in a row changes no curve.
json without_repeated_vertices(const json& curve) {
  json kept = json::array();
  for (const json& vertex : curve)
    if (kept.empty() || kept.back() != vertex) kept.push_back(vertex);
  return kept;
}

/// From its least vertex on, towards the lesser of that one's neighbours: a ring begins anywhere and goes either way.
json ring_in_order(const json& ring) {
  json vertices = without_repeated_vertices(ring);
  if (vertices.size() > 1 && vertices.front() == vertices.back()) vertices.erase(vertices.size() - 1);
  std::rotate(vertices.begin(), std::min_element(vertices.begin(), vertices.end()), vertices.end());
  if (vertices.size() > 2 && vertices.back() < vertices[1]) std::reverse(vertices.begin() + 1, vertices.end());
  return vertices;
}

bool is_same_scenario(const json& a, const json& b);

bool is_same_member(const std::string& key, const json& a, const json& b) {
  if (key == "polygon") return ring_in_order(a) == ring_in_order(b);
  if (key == "polyline" || key == "path") return without_repeated_vertices(a) == without_repeated_vertices(b);
  if (key != "holes") return is_same_scenario(a, b);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const json& c, const json& d) { return is_same_member("polygon", c, d); });
}

/// The same, or less by what is a default.
bool is_same_scenario(const json& a, const json& b) {
  if (a.is_array() && b.is_array() && a.size() == b.size())
    return std::equal(a.begin(), a.end(), b.begin(), is_same_scenario);
  if (!a.is_object() || !b.is_object()) return a == b;
  for (const auto& [key, value] : a.items())
    if (!b.contains(key)) return false;
  for (const auto& [key, value] : b.items())
    if (a.contains(key) ? !is_same_member(key, a.at(key), value) : !is_default(key, value)) return false;
  return true;
}

// --- A path with a speed profile ---

struct Mover {
  std::vector<Vec2> path;
  std::vector<std::pair<double, double>> knots;  ///< time, speed

  double covered(double time) const {
    double sum = 0.0, t = 0.0, v = knots.front().second;
    for (const auto& [at, speed] : knots) {
      if (at >= time) {
        const double share = at > t ? (time - t) / (at - t) : 0.0;
        return sum + (time - t) * (v + 0.5 * share * (speed - v));
      }
      sum += (at - t) * 0.5 * (v + speed);
      t = at;
      v = speed;
    }
    return sum + (time - t) * v;
  }
  Vec2 at(double time) const {
    double left = covered(time);
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const double length = norm(path[k + 1] - path[k]);
      if (left < length) return path[k] + (left / length) * (path[k + 1] - path[k]);
      left -= length;
    }
    return path.back();
  }
};

Mover mover(const json& j) {
  Mover m{points(j.at("path")), {}};
  if (j.contains("profile")) {
    for (const Vec2 knot : points(j["profile"].at("knots"))) m.knots.emplace_back(knot.x, knot.y);
    // Before the first knot its speed is held.
    m.knots.insert(m.knots.begin(), {0.0, m.knots.front().second});
  } else {
    m.knots = {{0.0, number(j.at("speed"))}};
  }
  return m;
}

// --- Shapes of bodies ---

struct Shape {
  std::vector<Vec2> corners;  ///< the hull of them, grown by
  double radius = 0.0;
  Vec2 center;
  double l11 = 0.0, l21 = 0.0, l22 = 0.0;
  bool ellipse = false;

  /// Points of the boundary and of the inside.
  std::vector<Vec2> samples() const {
    std::vector<Vec2> all;
    for (int k = 0; k < 24; ++k) {
      const Vec2 w{std::cos(k * 0.2617993877991494), std::sin(k * 0.2617993877991494)};
      if (ellipse) all.push_back(center + Vec2{l11 * w.x, l21 * w.x + l22 * w.y});
      if (radius > 0.0) all.push_back(corners[0] + radius * w);
    }
    for (std::size_t k = 0; k < corners.size(); ++k)
      for (const double s : {0.0, 0.25, 0.5, 0.75})
        all.push_back(corners[k] + s * (corners[(k + 1) % corners.size()] - corners[k]));
    return all;
  }
  /// How far p is from the shape; 0 inside. Of an ellipse up to a share of its size.
  double away(Vec2 p) const {
    if (contains(p)) return 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; ellipse && k < 720; ++k) {
      const Vec2 w{std::cos(k * 0.008726646259971648), std::sin(k * 0.008726646259971648)};
      least = std::min(least, norm(p - center - Vec2{l11 * w.x, l21 * w.x + l22 * w.y}));
    }
    for (std::size_t k = 0; k < corners.size(); ++k)
      least =
          std::min(least, static_cast<double>(distance_from_edge({corners[k], corners[(k + 1) % corners.size()]}, p)));
    return std::max(0.0, least - radius);
  }
  bool contains(Vec2 p) const {
    if (ellipse) {
      const Vec2 d = p - center;
      const double x = l22 * d.x, y = l11 * d.y - l21 * d.x, det = l11 * l22;
      return x * x + y * y <= det * det * (1.0 + 1e-9);
    }
    if (radius > 0.0) return norm(p - corners[0]) <= radius + kClose;
    if (corners.size() < 3) return distance_from_edge({corners.front(), corners.back()}, p) <= kClose;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec2 e = corners[(k + 1) % corners.size()] - corners[k];
      if (cross(e, p - corners[k]) < -kClose * (norm(e) + 1.0)) return false;
    }
    return true;
  }
};

Shape shape_of(const json& j) {
  Shape s;
  if (j.contains("disc")) {
    s.corners = {point(j["disc"].at("center"))};
    s.radius = number(j["disc"].at("radius"));
  } else if (j.contains("segment")) {
    s.corners = points(j["segment"]);
  } else if (j.contains("polygon")) {
    s.corners = points(j["polygon"]);
  } else {
    const json& e = j.at("ellipse");
    s.ellipse = true;
    s.center = point(e.at("center"));
    s.l11 = number(e.at("l11"));
    s.l21 = number(e.at("l21"));
    s.l22 = number(e.at("l22"));
  }
  return s;
}

// --- The recording ---

struct Line {
  Vec2 normal;
  double offset = 0.0, tau = 0.0, multiplier = 0.0;
  bool certified = false, hard = false, active = false;
  std::size_t body = 0, index = 0;

  double slack(Vec2 v) const { return dot(normal, v) - offset; }
  bool keeps_exactly(Vec2 v) const {
    return mpq_class(normal.x) * mpq_class(v.x) + mpq_class(normal.y) * mpq_class(v.y) >= mpq_class(offset);
  }
};

/// The two wheels of a robot.
struct Wheels {
  Vec2 heading;
  double left = 0.0, right = 0.0;
};

struct State {
  Vec2 position, velocity, anchor, anchor_velocity, preferred, chosen;
  std::optional<Wheels> wheels;
  std::string status;
  double violation = 0.0;
  bool exact_multipliers = false;  ///< they are not written: no doubles prove the choice
  std::vector<Line> lines;
  std::vector<std::pair<std::string, double>> bound;
};

struct Row {
  double time = 0.0;
  std::vector<State> robots;
  std::vector<std::pair<Vec2, Vec2>> moving;  ///< displacement, velocity
  Vec2 leader, leader_velocity;
};

struct BodyOf {
  std::string kind;
  Shape shape;
  std::vector<std::size_t> owners;
};

State state_of(const json& j) {
  State s;
  s.position = point(j.at("position"));
  s.velocity = point(j.at("velocity"));
  s.anchor = j.contains("anchor") ? point(j["anchor"]) : s.position;
  s.anchor_velocity = j.contains("anchor_velocity") ? point(j["anchor_velocity"]) : s.velocity;
  if (j.contains("wheels"))
    s.wheels =
        Wheels{point(j["wheels"].at("heading")), number(j["wheels"].at("left")), number(j["wheels"].at("right"))};
  s.preferred = point(j.at("preferred"));
  s.chosen = point(j.at("chosen"));
  s.status = j.at("status");
  s.violation = j.value("violation", 0.0);
  s.exact_multipliers = j.contains("multipliers");
  if (j.contains("bound"))
    for (const json& b : j["bound"]) s.bound.emplace_back(b.at("part"), number(b.at("multiplier")));
  if (j.contains("constraints"))
    for (const json& c : j["constraints"])
      s.lines.push_back({point(c.at("normal")), number(c.at("offset")), number(c.at("time_horizon")),
                         c.value("multiplier", 0.0), c.at("certified"), c.at("hard"), c.at("active"), c.at("body"),
                         c.at("index")});
  return s;
}

class Opinion {
 public:
  Opinion(const Lines& lines, const Lines& original) {
    header_ = lines.front().at("header");
    scenario_ = original.front().at("header").at("scenario");
    is_baseline_ = original.front()["header"].at("method") == "orca";
    if (!is_same_scenario(header_.at("scenario"), scenario_)) wrong("another scenario");
    dt_ = number(scenario_.at("time_step"));
    for (const json& o : scenario_.value("obstacles", json::array())) obstacles_.push_back(outline_of(o));
    for (const json& o : scenario_.value("moving_obstacles", json::array())) {
      moving_.push_back(outline_of(o));
      movers_.push_back(mover(o));
    }
    if (scenario_.contains("formation")) leader_ = mover(scenario_["formation"].at("leader"));
    for (const json& r : scenario_.at("robots")) {
      radius_.push_back(r.value("radius", 0.5));
      speed_.push_back(r.value("max_speed", 3.0));
      cooperates_.push_back(r.value("cooperates", true));
      if (!has_wheels(r)) continue;
      const json& drive = r["kinematics"];
      const double ahead = number(drive.at("reference")), most = number(drive.at("max_wheel_speed")), way = most * dt_;
      radius_.back() += ahead + way * way / (4.0 * (2.0 * ahead - way));
      speed_.back() = most;
      tau_ = scenario_.at("braking_time");
    }
    if (scenario_.contains("acceleration")) {
      most_change_ = number(scenario_["acceleration"].at("max")) * dt_;
      const double fastest = *std::max_element(speed_.begin(), speed_.end());
      tau_ = scenario_.value("braking_time", 1.1 * fastest / number(scenario_["acceleration"]["max"]));
    }
    for (const json& line : lines) read(line);
  }

  std::string operator()() {
    for (std::size_t k = 0; k < rows_.size() && why_.empty(); ++k) {
      state(k);
      if (k + 1 < rows_.size() && why_.empty()) {
        step(k);
        motion(k);
        if (tau_ > 0.0) braking(k);
        for (std::size_t i = 0; i < rows_[k].robots.size(); ++i) follow_wheels(k, i);
        for (std::size_t i = 0; i < rows_[k].robots.size(); ++i) decision(k, i);
      }
    }
    bodies();
    for (const json& plan : plans_) check_plan(plan);
    return why_;
  }

 private:
  void wrong(const std::string& what) {
    if (why_.empty()) why_ = what;
  }
  void wrong(std::size_t row, std::size_t robot, const std::string& what) {
    wrong("row " + std::to_string(row) + " robot " + std::to_string(robot) + ": " + what);
  }
  static bool has_wheels(const json& robot) { return robot.contains("kinematics"); }
  bool is_formation() const { return scenario_.contains("formation"); }
  bool option(const char* name) const { return header_.at("controller_options").at(name); }
  bool tracks_choice() const {
    return option("filter_last") && option("absolute_frame") &&
           number(header_["controller_options"]["acceleration_bound"]) <= 0.0;
  }

  void read(const json& line) {
    if (line.contains("body")) {
      const json& b = line["body"];
      BodyOf body{b.at("kind"), {}, b.at("owners")};
      if (b.contains("shape")) body.shape = shape_of(b["shape"]);
      bodies_[b.at("number")] = body;
    } else if (line.contains("goal_bodies")) {
      goal_bodies_.push_back(line["goal_bodies"]);
    } else if (line.contains("plan")) {
      plans_.push_back(line["plan"]);
      if (plans_.back().at("row") != rows_.size()) wrong("a plan of another row");
    } else if (line.contains("row")) {
      const json& r = line["row"];
      Row row;
      row.time = number(r.at("time"));
      for (const json& robot : r.at("robots")) row.robots.push_back(state_of(robot));
      if (r.contains("moving"))
        for (const json& m : r["moving"]) row.moving.emplace_back(point(m.at("displacement")), point(m.at("velocity")));
      if (r.contains("leader")) {
        row.leader = point(r["leader"].at("position"));
        row.leader_velocity = point(r["leader"].at("velocity"));
      }
      rows_.push_back(std::move(row));
    }
  }

  /// Whether v is the speed of the mover shortly before or after.
  static bool moves_so(const Mover& m, double time, Vec2 v) {
    constexpr double h = 1e-6;
    const Vec2 after = (m.at(time + h) - m.at(time)) / h, before = (m.at(time) - m.at(std::max(time - h, 0.0))) / h;
    return norm(v - after) < 1e-4 || norm(v - before) < 1e-4;
  }

  void state(std::size_t k) {
    const Row& row = rows_[k];
    if (row.time != static_cast<double>(k) * dt_) wrong("row " + std::to_string(k) + ": time");
    if (is_formation() &&
        (norm(row.leader - leader_.at(row.time)) > kClose || !moves_so(leader_, row.time, row.leader_velocity)))
      wrong("row " + std::to_string(k) + ": the leader");
    const bool is_last = k + 1 == rows_.size();
    if (row.moving.size() != moving_.size() && !(is_last && row.moving.empty()))
      return wrong("row " + std::to_string(k) + ": the number of moving obstacles");
    for (std::size_t m = 0; m < row.moving.size(); ++m)
      if (norm(row.moving[m].first - (movers_[m].at(row.time) - movers_[m].path.front())) > kClose ||
          !moves_so(movers_[m], row.time, row.moving[m].second))
        wrong("row " + std::to_string(k) + ": moving obstacle");
    for (std::size_t i = 0; i < row.robots.size() && k == 0; ++i) {
      const json& r = scenario_["robots"][i];
      const Vec2 v = r.contains("velocity") ? point(r["velocity"]) : Vec2{};
      Vec2 place = point(r.at("position"));
      if (const std::optional<Wheels>& wheels = row.robots[i].wheels; has_wheels(r)) {
        const double angle = 0.017453292519943295 * number(r.at("heading"));
        const Vec2 heading{std::cos(angle), std::sin(angle)};
        place += number(r["kinematics"].at("reference")) * heading;
        if (!wheels || norm(wheels->heading - heading) > kClose || wheels->left != 0.0 || wheels->right != 0.0)
          wrong(k, i, "the start of its wheels");
        if (norm(row.robots[i].position - place) <= kClose) place = row.robots[i].position;
      }
      if (row.robots[i].position != place || row.robots[i].velocity != v) wrong(k, i, "the start");
    }
    for (std::size_t i = 0; i < row.robots.size(); ++i) {
      const State& s = row.robots[i];
      const bool brakes = is_formation() && option("brake_point") && k + 1 < rows_.size();
      const Vec2 at = brakes ? s.position + s.velocity / k3() : s.position;
      if (norm(s.anchor - at) > kClose) wrong(k, i, "the anchor");
    }
  }

  double k3() const {
    const json& f = scenario_["formation"];
    return f.contains("gains") ? f["gains"].value("k3", 37.5) : 37.5;
  }

  /// Integrated here with a hundred small steps of rk4, or as the integrator has it; w where it is known, else fitted.
  void step(std::size_t k) {
    for (std::size_t i = 0; i < rows_[k].robots.size(); ++i) {
      const State &a = rows_[k].robots[i], &b = rows_[k + 1].robots[i];
      if (!is_formation()) {
        if (b.velocity != a.chosen || b.position != a.position + dt_ * a.chosen) wrong(k, i, "the next row");
        continue;
      }
      const std::string integrator = header_.value("integrator", "exact");
      const int parts = integrator == "rk4" || integrator == "euler" ? 1 : 100;
      const auto drive = [&](Vec2 w) {
        Vec2 x = a.position, v = a.velocity;
        const double h = dt_ / parts;
        const auto rate = [&](Vec2 u) { return -k3() * (u - w); };
        for (int p = 0; p < parts; ++p) {
          const Vec2 v1 = v, a1 = rate(v1), v2 = v + 0.5 * h * a1, a2 = rate(v2), v3 = v + 0.5 * h * a2, a3 = rate(v3),
                     v4 = v + h * a3, a4 = rate(v4);
          if (integrator == "euler") {
            x += h * v1;
            v += h * a1;
          } else {
            x += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
          }
        }
        return std::pair(x, v);
      };
      Vec2 w = a.chosen;
      if (!tracks_choice()) {
        // v1 is affine in w: v1(w) = v1(0) + c w.
        const Vec2 none = drive({}).second;
        const double c = drive({1.0, 0.0}).second.x - none.x;
        w = (b.velocity - none) / c;
      }
      const auto [x, v] = drive(w);
      if (norm(x - b.position) > kSame || norm(v - b.velocity) > kSame * (1.0 + norm(v))) wrong(k, i, "the next row");
    }
  }

  /// Where a robot is between two rows.
  Vec2 between(std::size_t k, std::size_t i, double s) const {
    const State &a = rows_[k].robots[i], &b = rows_[k + 1].robots[i];
    const std::string motion = header_.at("motion");
    if (motion == "straight") return a.position + s * (b.position - a.position);
    if (motion == "hermite") {
      const Vec2 d = b.position - a.position;
      return a.position + s * d + s * (1 - s) * (1 - s) * (dt_ * a.velocity - d) -
             s * s * (1 - s) * (dt_ * b.velocity - d);
    }
    const double z = k3() * dt_;
    const Vec2 w = (b.velocity - std::exp(-z) * a.velocity) / -std::expm1(-z);
    return a.position + s * dt_ * w - std::expm1(-z * s) / k3() * (a.velocity - w);
  }

  void motion(std::size_t k) {
    constexpr int kSamples = 32;
    for (int m = 0; m <= kSamples; ++m) {
      const double s = static_cast<double>(m) / kSamples, time = rows_[k].time + s * dt_;
      std::vector<Vec2> at;
      for (std::size_t i = 0; i < rows_[k].robots.size(); ++i) at.push_back(between(k, i, s));
      for (std::size_t i = 0; i < at.size(); ++i) {
        for (const Outline& o : obstacles_)
          if (distance(o, at[i]) < radius_[i] - kClose) wrong(k, i, "meets an obstacle");
        for (std::size_t j = 0; j < moving_.size(); ++j)
          if (distance(moving_[j], at[i] - (movers_[j].at(time) - movers_[j].path.front())) < radius_[i] - kClose)
            wrong(k, i, "meets a moving obstacle");
        for (std::size_t j = 0; j < i; ++j)
          if (norm(at[i] - at[j]) < radius_[i] + radius_[j] - kClose) wrong(k, i, "meets a robot");
      }
    }
  }

  /// The axle drives as the next row says its wheels ran: does that lead to the next row, within the limits?
  void follow_wheels(std::size_t k, std::size_t i) {
    const json& robot = scenario_["robots"][i];
    const std::optional<Wheels>&from = rows_[k].robots[i].wheels, &to = rows_[k + 1].robots[i].wheels;
    if (from.has_value() != has_wheels(robot) || to.has_value() != has_wheels(robot)) return wrong(k, i, "wheels");
    if (!from) return;
    const json& limits = robot["kinematics"];
    const double apart = number(limits.at("wheel_separation")), ahead = number(limits.at("reference"));
    const double speed = 0.5 * (to->left + to->right), turn = (to->right - to->left) / apart;
    const int parts = 200;
    const double h = dt_ / parts;
    double angle = std::atan2(from->heading.y, from->heading.x);
    Vec2 axle = rows_[k].robots[i].position - ahead * from->heading;
    for (int p = 0; p < parts; ++p) {
      const double middle = angle + 0.5 * h * turn;
      axle += h * speed * Vec2{std::cos(middle), std::sin(middle)};
      angle += h * turn;
    }
    const Vec2 heading{std::cos(angle), std::sin(angle)};
    if (norm(heading - to->heading) > kClose) wrong(k, i, "the next heading");
    if (norm(axle + ahead * heading - rows_[k + 1].robots[i].position) > kClose)
      wrong(k, i, "its wheels lead elsewhere");
    const double most = number(limits.at("max_wheel_speed")) + kClose;
    if (std::fabs(to->left) > most || std::fabs(to->right) > most) wrong(k, i, "the speed of a wheel");
    const double change = number(limits.at("max_wheel_acceleration")) * dt_ + kClose;
    if (std::fabs(to->left - from->left) > change || std::fabs(to->right - from->right) > change)
      wrong(k, i, "the acceleration of a wheel");
    if (std::fabs(turn) > number(limits.at("max_angular_speed")) + kClose) wrong(k, i, "turns too fast");
    if (speed < -number(limits.at("max_backward_speed")) - kClose) wrong(k, i, "drives back too fast");
  }

  /// Changes of velocity, and ways to brake, alone and together.
  void braking(std::size_t k) {
    constexpr int kSamples = 64;
    const std::vector<State>& robots = rows_[k].robots;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const mpq_class x = mpq_class(robots[i].chosen.x) - mpq_class(robots[i].velocity.x),
                      y = mpq_class(robots[i].chosen.y) - mpq_class(robots[i].velocity.y);
      const double most = most_change_ * (1.0 + 1e-15);
      if (most > 0.0 && x * x + y * y > mpq_class(most) * mpq_class(most))
        wrong(k, i, "changes its velocity by too much");
      if (robots[i].status != "optimal") wrong(k, i, "relaxes");
    }
    for (int m = 0; m <= kSamples; ++m) {
      std::vector<Vec2> at;
      for (const State& r : robots) at.push_back(r.position + (tau_ * m / kSamples) * r.chosen);
      for (std::size_t i = 0; i < at.size(); ++i) {
        for (const Outline& o : obstacles_)
          if (distance(o, at[i]) < radius_[i] - kClose) wrong(k, i, "cannot brake before an obstacle");
        for (std::size_t j = 0; j < i; ++j)
          if (norm(at[i] - at[j]) < radius_[i] + radius_[j] - kClose) wrong(k, i, "cannot brake beside a robot");
      }
    }
  }

  bool within_bound(std::size_t i, Vec2 v) const {
    if (scenario_.value("speed_bound", "disc") == "disc") {
      const mpq_class x(v.x), y(v.y), most(speed_[i]);
      return x * x + y * y <= most * most;
    }
    return std::fabs(v.x) <= speed_[i] && std::fabs(v.y) <= speed_[i];
  }

  void decision(std::size_t k, std::size_t i) {
    const State& s = rows_[k].robots[i];
    if (!geometry::is_finite(s.chosen) || !within_bound(i, s.chosen)) return wrong(k, i, "faster than it may be");
    double worst = 0.0;
    for (const Line& line : s.lines) {
      half_plane(k, i, line);
      const bool gives = s.status == "infeasible" || (s.status == "relaxed" && !line.hard);
      if (s.status == "no-interior" && line.hard && line.slack(s.chosen) < -kClose) wrong(k, i, "breaks a half-plane");
      if (gives)
        worst = std::max(worst, -line.slack(s.chosen));
      else if (s.status != "no-interior" && !line.keeps_exactly(s.chosen))
        wrong(k, i, "breaks a half-plane");
      const auto body = bodies_.find(line.body);
      const bool stands =
          body != bodies_.end() && (body->second.kind == "enclosure" || body->second.kind == "obstacle-edge");
      const bool is_own = tau_ > 0.0 && line.hard && body != bodies_.end() && body->second.kind == "robot";
      if (line.hard != stands && !is_own) wrong(k, i, "a priority");
    }
    if (s.status != "no-interior" && std::fabs(worst - s.violation) > kClose) wrong(k, i, "the violation");
    optimum(k, i, worst);
    balance(k, i);
    completeness(k, i);
  }

  /// Velocities beside the chosen one that are allowed and better.
  void optimum(std::size_t k, std::size_t i, double worst) {
    const State& s = rows_[k].robots[i];
    if (s.status == "no-interior") return no_room(k, i);
    const bool gives = s.status != "optimal";
    const Vec2 to = s.preferred - s.chosen;
    for (int m = 0; m < 360; ++m) {
      const double angle = m * 0.10471975511965977, size = std::pow(10.0, 0.5 - 0.9 * (m / 60));
      Vec2 v = s.chosen + size * Vec2{std::cos(angle), std::sin(angle)};
      if (m % 60 == 0) v = s.chosen + 0.1 * (1 + m / 60) * to;
      if (!within_bound(i, v)) continue;
      double most = 0.0;
      bool keeps = true;
      for (const Line& line : s.lines) {
        const bool may = s.status == "infeasible" || (gives && !line.hard);
        if (may && (s.status != "infeasible" || line.hard)) most = std::max(most, -line.slack(v));
        if (!may) keeps = keeps && line.slack(v) >= 0.0;
      }
      if (!keeps) continue;
      if (gives ? most < worst - kClose : squared_norm(v - s.preferred) < squared_norm(to) - kClose)
        return wrong(k, i, "a better velocity was allowed");
    }
  }

  /// No velocity satisfies everything with room to spare.
  void no_room(std::size_t k, std::size_t i) {
    const State& s = rows_[k].robots[i];
    for (int m = 0; m < 720; ++m) {
      const double angle = m * 0.10471975511965977, size = std::pow(10.0, 0.5 - 0.5 * (m / 60));
      const Vec2 v = s.chosen + size * Vec2{std::cos(angle), std::sin(angle)};
      const auto has_room = [&](const Line& line) { return line.slack(v) >= kClose; };
      if (within_bound(i, v) && std::all_of(s.lines.begin(), s.lines.end(), has_room))
        return wrong(k, i, "there was room");
    }
  }

  /// The multipliers' sum.
  void balance(std::size_t k, std::size_t i) {
    const State& s = rows_[k].robots[i];
    if (s.status == "no-interior") return;
    Vec2 sum{};
    double weight = 0.0;
    for (const Line& line : s.lines) {
      if (line.multiplier < 0.0 || (line.multiplier > 0.0 && !line.active)) return wrong(k, i, "a multiplier");
      if (line.active && s.status == "optimal" && std::fabs(line.slack(s.chosen)) > kClose)
        return wrong(k, i, "what binds does not touch");
      sum += line.multiplier * line.normal;
      weight += line.multiplier;
    }
    for (const auto& [part, multiplier] : s.bound) {
      Vec2 n{-s.chosen.x, -s.chosen.y};
      if (part == "right") n = {-1, 0};
      if (part == "left") n = {1, 0};
      if (part == "top") n = {0, -1};
      if (part == "bottom") n = {0, 1};
      if (multiplier < 0.0) return wrong(k, i, "a multiplier");
      sum += multiplier * n;
      weight += multiplier;
    }
    if (s.exact_multipliers && weight > 0.0) return wrong(k, i, "a multiplier beside exact ones");
    if (s.exact_multipliers) return;
    const Vec2 left = s.status == "optimal" ? sum - (s.chosen - s.preferred) : sum;
    if (norm(left) > 1e-4 * (1.0 + (s.status == "optimal" ? norm(s.preferred) : weight)))
      wrong(k, i, "multipliers do not balance");
  }

  /// The offset of the half-plane of robot j against robot i, with the opposite normal; -infinity where there is none.
  double offset_of_other(const Row& row, std::size_t i, std::size_t j, const Line& line) const {
    for (const Line& theirs : row.robots[j].lines) {
      const auto body = bodies_.find(theirs.body);
      if (body == bodies_.end() || body->second.kind != "robot" || theirs.hard) continue;
      if (body->second.owners.at(0) != i) continue;
      if (theirs.normal == -line.normal) return theirs.offset;
    }
    return -std::numeric_limits<double>::infinity();
  }

  /// What a constraint is against, seen in the row: points of it, and how much it is grown.
  void half_plane(std::size_t k, std::size_t i, const Line& line) {
    const Row& row = rows_[k];
    const State& s = row.robots[i];
    const auto found = bodies_.find(line.body);
    if (found == bodies_.end()) return wrong(k, i, "no body");
    const BodyOf& body = found->second;
    std::vector<Vec2> all;
    double grown = radius_[i];
    Vec2 u{};
    double share = 1.0;  // a robot's half: of the relative velocity
    double away = 0.0;   // m, of the body from the anchor
    if (body.kind == "robot" && line.hard) {
      // Its own limit: a side of the polygon in the disc of its changes.
      const double left = dot(line.normal, s.velocity) - line.offset;
      const bool is_of_wheels = has_wheels(scenario_["robots"][i]);  // which may cut off more: not audited
      if (body.owners.at(0) != i || line.index != i ||
          (!is_of_wheels && left < (0.99144 * most_change_ - kClose) * norm(line.normal)))
        wrong(k, i, "a limit that leaves too little");
      return;
    }
    if (body.kind == "robot") {
      const std::size_t j = body.owners.at(0);
      all = {row.robots[j].anchor};
      away = norm(all[0] - s.anchor);
      grown += radius_[j];
      u = row.robots[j].anchor_velocity;
      if (cooperates_[j]) {
        u = 0.5 * (u + s.anchor_velocity);
        share = 2.0;
      }
    } else if (body.kind == "moving-obstacle") {
      const std::size_t m = body.owners.at(0);
      for (const auto& edge : moving_[m].edges) all.push_back(edge.first + row.moving[m].first);
      all.push_back(moving_[m].edges.back().second + row.moving[m].first);
      u = row.moving[m].second;
      away = distance(moving_[m], s.anchor - row.moving[m].first);
    } else {
      all = body.shape.samples();
      away = body.shape.away(s.anchor);
    }
    // What overlaps may be uncertified.
    constexpr double kSampled = 0.01;  // m
    if (!line.certified && away <= grown + kSampled) return;
    for (const Vec2 p : all)
      for (const double share_of_tau : {0.1, 0.3, 1.0}) {
        // The velocity with which the robot's rim just reaches p, on the side of the half-plane.
        const double t = share_of_tau * line.tau;
        const Vec2 v = (p + grown * geometry::normalized(line.normal) - s.anchor) / t;
        const double at = dot(line.normal, v) / share + dot(line.normal, u);
        const double close = kClose * (1.0 + norm(v));
        if (at <= line.offset + close) continue;
        // The two of a pair may also share otherwise: then their sum decides.
        if (share == 2.0 &&
            dot(line.normal, v) <= line.offset + offset_of_other(row, i, body.owners.at(0), line) + close)
          continue;
        return wrong(k, i, "a half-plane cuts into its velocity obstacle");
      }
  }

  /// Velocities that hit something within the step and that nothing forbids.
  void completeness(std::size_t k, std::size_t i) {
    const Row& row = rows_[k];
    const State& s = row.robots[i];
    if (is_formation() && !option("horizon_clamp")) return;
    const auto allowed = [](const State& r, Vec2 v, bool hard_only) {
      return std::all_of(r.lines.begin(), r.lines.end(),
                         [&](const Line& line) { return (hard_only && !line.hard) || line.slack(v) >= kClose; });
    };
    std::vector<Vec2> some;
    for (int m = 0; m < 48; ++m)
      for (const double share : {1.0, 0.6, 0.25})
        some.push_back(share * speed_[i] * Vec2{std::cos(m * 0.1308996938995747), std::sin(m * 0.1308996938995747)});
    for (const Vec2 v : some) {
      for (const Outline& o : obstacles_)
        if (distance(o, s.anchor) >= radius_[i] && distance(o, s.anchor + dt_ * v) < radius_[i] - kClose &&
            allowed(s, v, true))
          return wrong(k, i, "nothing keeps it from an obstacle");
      for (std::size_t m = 0; m < moving_.size(); ++m) {
        const Vec2 seen = s.anchor - row.moving[m].first;
        if (distance(moving_[m], seen) >= radius_[i] &&
            distance(moving_[m], seen + dt_ * (v - row.moving[m].second)) < radius_[i] - kClose && allowed(s, v, false))
          return wrong(k, i, "nothing keeps it from a moving obstacle");
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      const State& o = row.robots[j];
      const double reach = radius_[i] + radius_[j];
      if ((!cooperates_[i] && !cooperates_[j]) || norm(s.anchor - o.anchor) < reach) continue;
      for (std::size_t m = 0; m < some.size(); m += 5)
        for (std::size_t n = 0; n < some.size(); n += 5) {
          const Vec2 v = cooperates_[i] ? some[m] : s.anchor_velocity;
          const Vec2 w = cooperates_[j] ? some[n] : o.anchor_velocity;
          if (norm(s.anchor + dt_ * v - o.anchor - dt_ * w) >= reach - kClose) continue;
          if ((!cooperates_[i] || allowed(s, v, false)) && (!cooperates_[j] || allowed(o, w, false)))
            return wrong(k, i, "nothing keeps it from a robot");
        }
    }
  }

  /// It begins where its robots were; no move ends in an obstacle, or is nearer to one or to a robot of the plan than
  /// it begins and radii allow.
  void check_plan(const json& plan) {
    const std::size_t from = plan.at("from_row");
    if (from > plan.at("row").get<std::size_t>()) return wrong("a plan from a row to come");
    std::map<std::size_t, Vec2> at;
    for (const json& robot : plan.at("robots")) {
      const std::size_t i = robot.at("robot");
      at[i] = point(robot.at("start"));
      if (rows_.at(from).robots.at(i).position != at[i]) return wrong("a plan that begins elsewhere");
    }
    for (const json& move : plan.at("moves")) {
      const std::size_t i = move.at("robot");
      const std::pair<Vec2, Vec2> way{at.at(i), point(move.at("to"))};
      for (const Outline& o : obstacles_) {
        if (distance(o, way.first) < radius_[i] - kPlanClose) continue;
        if (distance(o, way.second) < radius_[i] - kPlanClose) wrong("a plan's move into an obstacle");
        for (const auto& edge : o.edges)
          if (distance(way, edge) < radius_[i] - kPlanClose) wrong("a plan's move along an obstacle");
      }
      for (const auto& [j, other] : at) {
        const double reach = radius_[i] + radius_.at(j);
        if (j == i || norm(way.first - other) < reach - kPlanClose) continue;
        if (norm(other - nearest_on(way, other)) < reach - kPlanClose) wrong("a plan's move too near to a robot");
      }
      at[i] = way.second;
    }
  }

  /// Every edge lies in some body of every goal; edges are edges.
  void bodies() {
    for (const auto& [number, body] : bodies_) {
      if (body.kind != "obstacle-edge") continue;
      const Outline& o = obstacles_.at(body.owners.at(0));
      const bool is_edge = std::any_of(o.edges.begin(), o.edges.end(), [&](const auto& e) {
        return (e.first == body.shape.corners[0] && e.second == body.shape.corners[1]) ||
               (e.second == body.shape.corners[0] && e.first == body.shape.corners[1]);
      });
      if (!is_edge) wrong("body " + std::to_string(number) + " is no edge");
    }
    for (const json& of_goal : goal_bodies_) {
      const json& list = of_goal.at("bodies");
      if (is_baseline_ && list.empty()) continue;
      for (std::size_t k = 0; k < obstacles_.size(); ++k)
        for (const auto& edge : obstacles_[k].edges) {
          const bool covered = std::any_of(list.begin(), list.end(), [&](const json& number) {
            const BodyOf& body = bodies_[number];
            return std::find(body.owners.begin(), body.owners.end(), k) != body.owners.end() &&
                   body.shape.contains(edge.first) && body.shape.contains(edge.second);
          });
          if (!covered) wrong("goal_bodies leave out an edge");
        }
    }
  }

  json header_, scenario_;
  double dt_ = 0.0;
  double most_change_ = 0.0, tau_ = 0.0;  ///< m/s and s, of robots with an acceleration; else 0
  bool is_baseline_ = false;              ///< has edges and no enclosures
  std::vector<Outline> obstacles_, moving_;
  std::vector<Mover> movers_;
  Mover leader_;
  std::vector<double> radius_, speed_;
  std::vector<bool> cooperates_;
  std::vector<Row> rows_;
  std::map<std::size_t, BodyOf> bodies_;
  std::vector<json> goal_bodies_, plans_;
  std::string why_;
};

}  // namespace

std::string second_opinion(const Lines& lines, const Lines& original) {
  try {
    return Opinion(lines, original)();
  } catch (const json::exception& e) {
    return std::string("unreadable: ") + e.what();
  } catch (const std::exception& e) {
    return std::string("out of range: ") + e.what();
  }
}

}  // namespace exactvo::datasets::test
