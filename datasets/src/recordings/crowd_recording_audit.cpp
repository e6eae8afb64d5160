// SPDX-License-Identifier: GPL-3.0-or-later
// The audit of recordings of crowds (crowd_recording.h): shares nothing with the engine that made them.
#include <algorithm>
#include <cmath>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/predicates.h"
#include "generators/counter_random.h"

namespace exactvo::datasets {
namespace {

using geometry::Disc;
using geometry::GrownShape;
using geometry::Segment;
using geometry::Vec2;

/// Nothing is promised of what is nearer than this share of the numbers involved (formation/crowd.h: 40 u in float).
constexpr double kTouches = 40.0 * 0x1p-24;

/// A limit of speed times a time, rounded twice, and a length, rounded four times.
constexpr double kSpeedRounding = 8.0 * 0x1p-53;

constexpr std::size_t kMostFindings = 20;

class CrowdAuditor {
 public:
  CrowdAuditor(const CrowdRecordingHead& head, std::size_t one_of) : head_(head), one_of_(one_of) {
    std::vector<geometry::Box> boxes;
    for (const Segment& e : head.edges) {
      boxes.emplace_back();
      boxes.back().add(e.a);
      boxes.back().add(e.b);
    }
    edges_by_place_ = geometry::BoxGrid(std::move(boxes));
    for (const CrowdKindRecord& kind : head.kinds) {
      largest_ = std::max(largest_, kind.radius);
      fastest_ = std::max(fastest_, kind.max_speed);
    }
    report.robots = head.kind_of.size();
  }

  void judge(const CrowdRow& from, const CrowdRow& to) {
    from_ = &from;
    to_ = &to;
    steps_ = to.step - from.step;
    time_ = steps_ * head_.time_step;
    lay_out();
    for (std::size_t i = 0; i < from.x.size(); ++i) {
      if (one_of_ > 1 && mixed(to.step * kRandomStride + i) % one_of_ != 0) continue;
      ++report.motions;
      judge_speed(i);
      judge_edges(i);
      judge_pairs(i);
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
    if (report.findings.size() < kMostFindings)
      report.findings.push_back("step " + std::to_string(to_->step) + ": robot " + std::to_string(i) + words);
  }

  /// Robots of the first row by cells as wide as two can be apart that could meet.
  void lay_out() {
    cell_ = (2.0 * largest_ + 2.0 * time_ * fastest_) * (1.0 + kTouches) + 2.0 * head_.position_step;
    std::vector<geometry::Box> boxes;
    boxes.reserve(from_->x.size());
    for (std::size_t i = 0; i < from_->x.size(); ++i) boxes.push_back({place(*from_, i), place(*from_, i)});
    robots_by_place_ = geometry::BoxGrid(std::move(boxes));
  }

  void judge_speed(std::size_t i) {
    const double way = norm(place(*to_, i) - place(*from_, i));
    if (way <= time_ * kind(i).max_speed * (1.0 + kSpeedRounding)) return;
    ++report.too_fast;
    find(i, ": moves " + std::to_string(way) + " m, farther than its speed allows");
  }

  void judge_edges(std::size_t i) {
    const Vec2 at = place(*from_, i), motion = place(*to_, i) - at;
    const double radius = kind(i).radius, reach = radius + norm(motion) * (1.0 + kTouches);
    edges_by_place_.for_each_within(at, reach, [&](std::size_t k) {
      const Segment& edge = head_.edges[k];
      const double rounding = kTouches * (std::fabs(at.x) + std::fabs(at.y) + std::fabs(edge.a.x - at.x) +
                                          std::fabs(edge.a.y - at.y) + radius);
      const double distance = geometry::distance(edge, at);
      if (distance < radius + rounding || distance > reach + rounding) return;
      ++report.near_edges;
      const bool met = steps_ == 1
                           ? segment_meets({edge, at, radius}, motion, 1.0)
                           : geometry::locate(GrownShape{edge, at + motion, radius}, Vec2{}) == geometry::Place::inside;
      if (!met) return;
      ++report.edges_met;
      find(i, ": meets edge " + std::to_string(k));
    });
  }

  void judge_pairs(std::size_t i) {
    const Vec2 at = place(*from_, i), motion = place(*to_, i) - at;
    robots_by_place_.for_each_within(at, cell_, [&](std::size_t j) {
      if (j == i || (one_of_ == 1 && j < i)) return;
      const Vec2 d = place(*from_, j) - at, relative = motion - (place(*to_, j) - place(*from_, j));
      const double sum = kind(i).radius + kind(j).radius;
      const double rounding = kTouches * (std::fabs(d.x) + std::fabs(d.y) + sum), distance = norm(d);
      if (distance < sum + rounding || distance > sum + norm(relative) + rounding) return;
      if (!to_->kept[i] || !to_->kept[j]) {
        ++report.pairs_open;
        return;
      }
      ++report.pairs;
      const bool met = steps_ == 1
                           ? segment_meets({Disc{d, kind(j).radius}, {}, kind(i).radius}, relative, 1.0)
                           : geometry::locate(GrownShape{Disc{d - relative, kind(j).radius}, {}, kind(i).radius},
                                              Vec2{}) == geometry::Place::inside;
      if (!met) return;
      ++report.pairs_met;
      find(i, " overlaps robot " + std::to_string(j));
    });
  }

  const CrowdRecordingHead& head_;
  std::size_t one_of_;
  geometry::BoxGrid edges_by_place_, robots_by_place_;
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
    if (count++ > 0) auditor.judge(before, now);
  }
  auditor.report.rows = count;
  auditor.report.cut_off = reader.is_cut_off();
  return auditor.report;
}

}  // namespace exactvo::datasets
