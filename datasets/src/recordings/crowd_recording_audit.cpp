// SPDX-License-Identifier: GPL-3.0-or-later
// The audit of recordings of crowds (crowd_recording.h): shares no decision code with the engine that made
// them, only the geometry library.
//
// Two robots must not overlap, whatever made them: contact is clear, less is a failed check. Of an edge or a body that
// is touched, or all but, a robot must not come nearer to it than it is, up to rounding: for an edge the half-plane is
// n.v >= 0 with n from its nearest point q to the robot, and the edge lies in n.(x - q) <= 0.
#include <algorithm>
#include <cmath>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/told_apart.h"
#include "generators/counter_random.h"
#include "recordings/exact_plane.h"

namespace exactvo::datasets {
namespace {

using geometry::Disc;
using geometry::GrownShape;
using geometry::Segment;
using geometry::Vec2;

/// Nearer than this share of the numbers involved, the engine may take a robot and an edge for touching
/// (formation/crowd.h: 40 u in float). Of such an edge it promises less: a robot comes no nearer to it, up to this
/// share again. There the normal of the half-plane is off by at most 2 u, and so is the distance of what is within a
/// length L.
constexpr double kTouches = 40.0 * 0x1p-24;

/// A limit of speed times a time, rounded twice, and a length, rounded four times.
constexpr double kSpeedRounding = 8.0 * 0x1p-53;

double one_norm(Vec2 v) {
  return std::fabs(v.x) + std::fabs(v.y);
}

class CrowdAuditor {
 public:
  CrowdAuditor(const CrowdRecordingHead& head, std::size_t one_of) : head_(head), one_of_(one_of) {
    std::vector<geometry::Box> boxes;
    for (const Segment& e : head.edges) {
      boxes.push_back(geometry::box_of(e));
    }
    edges_by_place_ = geometry::BoxGrid(std::move(boxes));
    for (const CrowdKindRecord& kind : head.kinds) {
      largest_ = std::max(largest_, kind.radius);
      fastest_ = std::max(fastest_, kind.max_speed);
    }
    report.robots = head.kind_of.size();
  }

  void check(const CrowdRow& from, const CrowdRow& to) {
    from_ = &from;
    to_ = &to;
    steps_ = to.step - from.step;
    time_ = steps_ * head_.time_step;
    lay_out();
    lay_out_bodies();
    for (std::size_t i = 0; i < from.x.size(); ++i) {
      if (one_of_ > 1 && mixed(to.step * kRandomStride + i) % one_of_ != 0) continue;
      ++report.motions;
      check_speed(i);
      check_edges(i);
      check_bodies(i);
      check_pairs(i);
    }
  }

  CrowdAuditReport report;

 private:
  const CrowdKindRecord& kind(std::size_t i) const { return head_.kinds[head_.kind_of[i]]; }
  /// Differences and products with the lattice step are exact.
  Vec2 place(const CrowdRow& row, std::size_t i) const {
    return {head_.position_step * row.x[i], head_.position_step * row.y[i]};
  }

  void find(std::size_t i, const std::string& words) {
    if (report.findings.size() < kMostCrowdFindings)
      report.findings.push_back("step " + std::to_string(to_->step) + ": " + name(i) + words);
  }
  std::string name(std::size_t i) const { return "robot " + head_.name_of(i); }

  /// Robots of the first row by cells as wide as two can be apart that could meet.
  void lay_out() {
    cell_ = (2.0 * largest_ + 2.0 * time_ * fastest_) * (1.0 + kTouches) + 2.0 * head_.position_step;
    std::vector<geometry::Box> boxes;
    boxes.reserve(from_->x.size());
    for (std::size_t i = 0; i < from_->x.size(); ++i) boxes.push_back({place(*from_, i), place(*from_, i)});
    robots_by_place_ = geometry::BoxGrid(std::move(boxes));
  }

  Vec2 displacement(const CrowdRow& row, std::size_t k) const {
    return head_.position_step * Vec2{static_cast<double>(row.body_x[k]), static_cast<double>(row.body_y[k])};
  }

  void lay_out_bodies() {
    std::vector<geometry::Box> boxes;
    fastest_body_ = 0.0;
    for (std::size_t k = 0; k < head_.bodies.size(); ++k) {
      const Vec2 by = displacement(*from_, k);
      geometry::Box box = geometry::box_of(head_.bodies[k].shape);
      const double rounding = kTouches * (one_norm(box.low) + one_norm(box.high) + one_norm(by));
      boxes.push_back({box.low + by - Vec2{rounding, rounding}, box.high + by + Vec2{rounding, rounding}});
      fastest_body_ = std::max(fastest_body_, norm(displacement(*to_, k) - by));
    }
    bodies_by_place_ = geometry::BoxGrid(std::move(boxes));
  }

  /// As the body sees the robot: where bodies are is exact.
  void check_bodies(std::size_t i) {
    if (head_.bodies.empty()) return;
    const Vec2 here = place(*from_, i);
    const double far = (kind(i).radius + norm(place(*to_, i) - here) + fastest_body_) * (1.0 + kTouches);
    bodies_by_place_.for_each_within(here, far, [&](std::size_t k) {
      const CrowdBodyRecord& body = head_.bodies[k];
      const Vec2 at = here - displacement(*from_, k), motion = place(*to_, i) - displacement(*to_, k) - at;
      const geometry::Box box = geometry::box_of(body.shape);
      const double radius = kind(i).radius;
      const double lengths = one_norm(box.low - at) + one_norm(box.high - at) + radius, rounding = kTouches * lengths;
      if (is_within(body.shape, at, radius + rounding)) return check_touching_body(i, k, at, motion, lengths);
      ++report.near_bodies;
      if (body.moves && !to_->kept[i]) return void(++report.bodies_open);
      if (!meets(body.shape, at, motion, radius)) return;
      ++report.bodies_met;
      find(i, ": meets body " + std::to_string(k));
    });
  }

  /// A kept robot is apart from a moving body at the end; none comes nearer to one at rest. What is nearer is asked
  /// with the robot's radius at which it touches now, found by halving.
  void check_touching_body(std::size_t i, std::size_t k, Vec2 at, Vec2 motion, double lengths) {
    const geometry::ConvexShape& shape = head_.bodies[k].shape;
    double radius = kind(i).radius;
    if (head_.bodies[k].moves) {
      if (!to_->kept[i]) return void(++report.bodies_open);
    } else {
      double least = 0.0;
      constexpr int kHalvings = 40;
      if (is_within(shape, at, radius))
        for (int n = 0; n < kHalvings; ++n)
          (is_within(shape, at, 0.5 * (least + radius)) ? radius : least) = 0.5 * (least + radius);
      radius = std::min(radius, kind(i).radius) - kTouches * steps_ * (lengths + 4.0 * time_ * kind(i).max_speed);
    }
    if (!(radius > 0.0)) return void(++report.bodies_open);
    ++report.touching_bodies;
    if (!is_within(shape, at + motion, radius)) return;
    ++report.bodies_not_parted;
    find(i, head_.bodies[k].moves ? " touched body " + std::to_string(k) + ", and still overlaps it"
                                  : ": comes nearer to body " + std::to_string(k) + ", which it touched");
  }

  /// On the way, of consecutive steps; else at the end of it.
  bool meets(const geometry::ConvexShape& shape, Vec2 at, Vec2 motion, double radius) const {
    return steps_ == 1 ? segment_meets({shape, at, radius}, motion, 1.0) : is_within(shape, at + motion, radius);
  }

  /// In the interior. Exact.
  static bool is_within(const geometry::ConvexShape& shape, Vec2 at, double radius) {
    return geometry::locate(GrownShape{shape, at, radius}, Vec2{}) == geometry::Place::inside;
  }

  void check_speed(std::size_t i) {
    const double way = norm(place(*to_, i) - place(*from_, i)), most = time_ * kind(i).max_speed;
    if (way <= most * (1.0 + kSpeedRounding)) return;
    ++report.too_fast;
    const auto [allowed, moved] = geometry::told_apart(most, way);
    find(i, ": moves " + moved + " m, farther than the " + allowed + " m that its speed allows");
  }

  void check_edges(std::size_t i) {
    const Vec2 at = place(*from_, i), motion = place(*to_, i) - at;
    const double radius = kind(i).radius, reach = radius + norm(motion) * (1.0 + kTouches);
    edges_by_place_.for_each_within(at, reach, [&](std::size_t k) {
      const Segment& edge = head_.edges[k];
      const double lengths = one_norm(edge.a - at) + one_norm(edge.b - at) + radius, rounding = kTouches * lengths;
      const double distance = geometry::distance(edge, at);
      if (distance > reach + rounding) return;
      if (distance < radius + rounding) return check_touching_edge(i, k, distance, lengths);
      ++report.near_edges;
      if (!meets(edge, at, motion, radius)) return;
      ++report.edges_met;
      find(i, ": meets edge " + std::to_string(k));
    });
  }

  /// No step leads nearer to an edge that is touched, kept or not: the half-plane is that of the nearest point, the
  /// edge lies behind it, and standing still satisfies it.
  void check_touching_edge(std::size_t i, std::size_t k, double distance, double lengths) {
    const double radius = kind(i).radius;
    const double rounding = kTouches * steps_ * (lengths + 4.0 * time_ * kind(i).max_speed);
    const double nearest = std::min(distance, radius) - rounding;
    if (!(nearest > 0.0)) {
      ++report.touching_edges_open;
      return;
    }
    ++report.touching_edges;
    const Vec2 at = place(*from_, i), motion = place(*to_, i) - at;
    if (!meets(head_.edges[k], at, motion, nearest)) return;
    ++report.edges_neared;
    find(i, ": comes nearer to edge " + std::to_string(k) + ", which it touched");
  }

  void check_pairs(std::size_t i) {
    const Vec2 at = place(*from_, i), motion = place(*to_, i) - at;
    robots_by_place_.for_each_within(at, cell_, [&](std::size_t j) {
      if (j == i || (one_of_ == 1 && j < i)) return;
      const Vec2 d = place(*from_, j) - at, relative = motion - (place(*to_, j) - place(*from_, j));
      const double sum = kind(i).radius + kind(j).radius;
      if (norm(d) > (sum + norm(relative)) * (1.0 + kTouches)) return;
      ++report.pairs;
      const Disc other{d, kind(j).radius};
      if (is_within(other, {}, kind(i).radius)) {
        ++report.pairs_overlapping;
        return find(i, " overlaps " + name(j) + " already at the row before");
      }
      if (!meets(other, {}, relative, kind(i).radius) || !overlap(d, relative, i, j)) return;
      ++report.pairs_met;
      find(i, " overlaps " + name(j));
    });
  }

  /// `meets` counts exact contact.
  bool overlap(Vec2 d, Vec2 relative, std::size_t i, std::size_t j) const {
    const exact::Point there = exact::exactly(d), to = exact::exactly(relative),
                       from = steps_ == 1 ? exact::Point{} : to;
    return exact::come_nearer_than({from, to}, {there, there},
                                   exact::Rational(exact::Rational(kind(i).radius) + exact::Rational(kind(j).radius)));
  }

  const CrowdRecordingHead& head_;
  std::size_t one_of_;
  geometry::BoxGrid edges_by_place_, robots_by_place_, bodies_by_place_;
  double fastest_body_ = 0.0;  ///< m, from row to row
  double largest_ = 0.0, fastest_ = 0.0, time_ = 0.0, cell_ = 0.0;
  std::uint32_t steps_ = 1;
  const CrowdRow *from_ = nullptr, *to_ = nullptr;
};

std::size_t motions_in(const std::filesystem::path& path) {
  CrowdRecordingReader reader(path);
  CrowdRow row;
  std::size_t rows = 0;
  while (reader.next(row)) ++rows;
  return rows > 0 ? (rows - 1) * reader.head().kind_of.size() : 0;
}

}  // namespace

void add(CrowdAuditReport& sum, const CrowdAuditReport& other) {
  for (const auto& [name, count] : kCrowdAuditCounts) sum.*count += other.*count;
  sum.cut_off = sum.cut_off || other.cut_off;
  sum.findings.insert(sum.findings.end(), other.findings.begin(), other.findings.end());
}

CrowdAuditReport audit_crowd_recording(const std::filesystem::path& path, std::size_t sample) {
  const std::size_t one_of = sample == 0 ? 1 : std::max<std::size_t>(1, motions_in(path) / sample);
  CrowdRecordingReader reader(path);
  CrowdAuditor auditor(reader.head(), one_of);
  CrowdRow rows[2];
  std::size_t count = 0;
  while (reader.next(rows[count % 2])) {
    const CrowdRow &before = rows[(count + 1) % 2], &now = rows[count % 2];
    if (count > 0 && now.step <= before.step)
      throw DataError(DataCode::format_syntax, path.string(), "step " + std::to_string(now.step),
                      "a row after that of step " + std::to_string(before.step), "rows in the order of time");
    if (count++ > 0) auditor.check(before, now);
  }
  auditor.report.rows = count;
  auditor.report.cut_off = reader.is_cut_off();
  return auditor.report;
}

}  // namespace exactvo::datasets
