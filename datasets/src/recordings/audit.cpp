// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/audit.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>

#include "exactvo/vo/certificate.h"
#include "json_text.h"
#include "sha256.h"
#include "text_file.h"

namespace exactvo::datasets {
namespace {

using formation::ConstraintSource;
using formation::RecordedConstraint;
using formation::Step;
using geometry::Vec2;
using Rational = mpq_class;

// --- Plane geometry in rationals: written out here though others have such lines (vo's exact legs, the benches'
// oracles), since who checks shares nothing with what is checked ---

struct Point {
  Rational x, y;
};
Point exactly(Vec2 v) {
  return {Rational(v.x), Rational(v.y)};
}
Point operator-(const Point& a, const Point& b) {
  return {Rational(a.x - b.x), Rational(a.y - b.y)};
}
Rational dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y;
}
Rational cross(const Point& a, const Point& b) {
  return a.x * b.y - a.y * b.x;
}

struct Way {
  Point from, to;
};

/// Squared distance of p to the segment.
Rational squared_distance(const Point& p, const Way& w) {
  const Point e = w.to - w.from, d = p - w.from;
  const Rational length2 = dot(e, e);
  Rational t = sgn(length2) > 0 ? Rational(dot(d, e) / length2) : Rational(0);
  t = std::min(std::max(t, Rational(0)), Rational(1));
  const Point rest{Rational(d.x - t * e.x), Rational(d.y - t * e.y)};
  return dot(rest, rest);
}

bool cross_properly(const Way& a, const Way& b) {
  const Point e = a.to - a.from, f = b.to - b.from;
  return sgn(cross(e, b.from - a.from)) * sgn(cross(e, b.to - a.from)) < 0 &&
         sgn(cross(f, a.from - b.from)) * sgn(cross(f, a.to - b.from)) < 0;
}

/// Whether the boxes of the two are at least r apart along x or y: then so are they.
bool boxes_are_apart(const Way& a, const Way& b, const Rational& r) {
  const auto apart = [&](const Rational& a0, const Rational& a1, const Rational& b0, const Rational& b1) {
    return std::max(a0, a1) + r <= std::min(b0, b1) || std::max(b0, b1) + r <= std::min(a0, a1);
  };
  return apart(a.from.x, a.to.x, b.from.x, b.to.x) || apart(a.from.y, a.to.y, b.from.y, b.to.y);
}

/// Whether some point of a is nearer than r to some point of b.
bool come_nearer_than(const Way& a, const Way& b, const Rational& r) {
  if (boxes_are_apart(a, b, r)) return false;
  if (cross_properly(a, b)) return true;
  const Rational r2 = r * r;
  return squared_distance(a.from, b) < r2 || squared_distance(a.to, b) < r2 || squared_distance(b.from, a) < r2 ||
         squared_distance(b.to, a) < r2;
}

bool crosses_ray(const Point& p, const Point& a, const Point& b) {
  if ((a.y > p.y) == (b.y > p.y)) return false;
  const int side = sgn(cross(b - a, p - a));
  return b.y > a.y ? side > 0 : side < 0;
}

bool is_inside(const Point& p, const geometry::Obstacle& obstacle) {
  if (!geometry::has_interior(obstacle)) return false;
  bool inside = false;
  for (const geometry::Segment& edge : edges_of(obstacle))
    if (crosses_ray(p, exactly(edge.a), exactly(edge.b))) inside = !inside;
  return inside;
}

/// The two move at the same time, each straight: their distance is that of their difference from 0.
bool meet_on_the_way(const Way& a, const Way& b, const Rational& reach) {
  const Way difference{b.from - a.from, b.to - a.to};
  return squared_distance({Rational(0), Rational(0)}, difference) < reach * reach;
}

// --- The audit ---

/// The obstacles' edges as rationals, once for all steps.
struct RationalObstacle {
  const geometry::Obstacle* obstacle;
  std::vector<Way> edges;
};

class Auditor {
 public:
  explicit Auditor(const RecordingFile& file) : file_(file) {
    for (const formation::SceneObstacle& o : file.scenario.obstacles) {
      RationalObstacle& out = obstacles_.emplace_back(RationalObstacle{&o.shape, {}});
      for (const geometry::Segment& edge : edges_of(o.shape)) out.edges.push_back({exactly(edge.a), exactly(edge.b)});
    }
  }

  AuditReport operator()() {
    const std::vector<Step>& rows = file_.recording.steps;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      check_half_planes(k);
      if (k + 1 == rows.size()) continue;
      check_sequence(k);
      check_ways(k);
    }
    return std::move(report_);
  }

 private:
  void find(std::size_t& counter, std::size_t row, const std::string& what) {
    if (counter++ == 0 || report_.findings.size() < kMostFindings)
      report_.findings.push_back("row " + std::to_string(row) + ": " + what);
  }

  const std::string& robot(std::size_t i) const { return file_.scenario.robots[i].id; }

  void check_half_planes(std::size_t row) {
    const Step& step = file_.recording.steps[row];
    for (std::size_t i = 0; i < step.robots.size(); ++i) {
      for (const RecordedConstraint& c : step.robots[i].constraints) {
        if (!c.certified || c.source == ConstraintSource::robot) continue;
        ++report_.half_planes;
        if (!vo::is_true({c.shape, c.position, c.radius, c.tau, c.shape_velocity, c.half_plane}))
          find(report_.unsafe, row, "a half-plane of " + robot(i) + " is not disjoint from its velocity obstacle");
      }
    }
  }

  /// Rows are a time step apart, up to the rounding of their times; the last one may be shorter.
  void check_sequence(std::size_t row) {
    const std::vector<Step>& rows = file_.recording.steps;
    const double dt = file_.recording.time_step;
    const double passed = rows[row + 1].time - rows[row].time;
    const double rounding = 0x1p-40 * (std::fabs(rows[row + 1].time) + dt);  // sums of up to 2^12 steps err by less
    const bool shorter_end = row + 2 == rows.size() && passed > 0.0 && passed <= dt + rounding;
    if (!(std::fabs(passed - dt) <= rounding) && !shorter_end)
      find(report_.inconsistencies, row, "the next row is not a time step later");
  }

  Way way(std::size_t row, std::size_t i) const {
    return {exactly(file_.recording.steps[row].robots[i].position),
            exactly(file_.recording.steps[row + 1].robots[i].position)};
  }

  void check_ways(std::size_t row) {
    std::vector<Way> ways;
    for (std::size_t i = 0; i < file_.scenario.robots.size(); ++i) ways.push_back(way(row, i));
    for (std::size_t i = 0; i < ways.size(); ++i) {
      ++report_.steps;
      const std::string what = obstacle_hit(ways[i], i) + robot_hit(ways, i);
      if (!what.empty()) find(report_.collisions, row, robot(i) + what);
    }
  }

  std::string obstacle_hit(const Way& w, std::size_t i) const {
    const Rational r(file_.scenario.robots[i].radius);
    for (std::size_t k = 0; k < obstacles_.size(); ++k) {
      const bool near = std::any_of(obstacles_[k].edges.begin(), obstacles_[k].edges.end(),
                                    [&](const Way& edge) { return come_nearer_than(w, edge, r); });
      if (near || is_inside(w.from, *obstacles_[k].obstacle))
        return " overlaps obstacle " + file_.scenario.obstacles[k].id;
    }
    return "";
  }

  std::string robot_hit(const std::vector<Way>& ways, std::size_t i) const {
    for (std::size_t j = 0; j < ways.size(); ++j) {
      if (j == i) continue;
      const Rational reach = Rational(file_.scenario.robots[i].radius) + Rational(file_.scenario.robots[j].radius);
      if (meet_on_the_way(ways[i], ways[j], reach)) return " overlaps robot " + robot(j);
    }
    return "";
  }

  const RecordingFile& file_;
  std::vector<RationalObstacle> obstacles_;
  AuditReport report_;
};

bool all_finite(const RecordingFile& file) {
  for (const Step& step : file.recording.steps) {
    for (const formation::RobotStep& robot : step.robots)
      if (!geometry::is_finite(robot.position)) return false;
  }
  return true;
}

/// The seal in the header against the rows below it.
void check_seal(const std::string& text, AuditReport& report) {
  const std::size_t end = text.find('\n');
  const Json header = Json::parse(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(end, text.size())));
  Sha256 hash;
  if (end != std::string::npos) hash.add(std::string_view(text).substr(end + 1));
  if (header.value("rows_sha256", "") == hash.digest()) return;
  ++report.inconsistencies;
  report.findings.push_back("the rows are not those that the header's rows_sha256 was made of");
}

}  // namespace

AuditReport audit(const RecordingFile& file) {
  if (all_finite(file)) return Auditor(file)();
  AuditReport report;
  report.inconsistencies = 1;
  report.findings.emplace_back("a robot's position is not finite");
  return report;
}

AuditReport audit_recording(const std::filesystem::path& path) {
  AuditReport report = audit(read_recording(path));
  check_seal(read_text_file(path), report);
  return report;
}

void add(AuditReport& sum, const AuditReport& other) {
  sum.half_planes += other.half_planes;
  sum.unsafe += other.unsafe;
  sum.steps += other.steps;
  sum.collisions += other.collisions;
  sum.inconsistencies += other.inconsistencies;
  sum.findings.insert(sum.findings.end(), other.findings.begin(), other.findings.end());
}

std::string to_json(const AuditReport& report) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object();
  json.member("half_planes", static_cast<std::uint64_t>(report.half_planes));
  json.member("unsafe", static_cast<std::uint64_t>(report.unsafe));
  json.member("steps", static_cast<std::uint64_t>(report.steps));
  json.member("collisions", static_cast<std::uint64_t>(report.collisions));
  json.member("inconsistencies", static_cast<std::uint64_t>(report.inconsistencies));
  json.key("findings").begin_array();
  for (const std::string& finding : report.findings) json.value(finding);
  json.end_array().end_object();
  return json.take();
}

}  // namespace exactvo::datasets
