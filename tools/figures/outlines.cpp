// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/outlines.h"

#include <cmath>
#include <numeric>

#include "exactvo/geometry/pi.h"

namespace exactvo::tools {

using geometry::GrownShape;
using geometry::HalfPlane;

namespace {

using geometry::kPi;
/// A chord of a circle of 500 px radius drawn with so many corners strays 0.04 px from the arc.
constexpr int kDirections = 256;

Vec2 direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Vec2 direction(int i) {
  return direction(2.0 * kPi * i / kDirections);
}

void add_unless_repeated(Points& ring, Vec2 p) {
  if (ring.empty() || ring.back() != p) ring.push_back(p);
}

Points support_ring(const GrownShape& s) {
  Points ring;
  for (int i = 0; i < kDirections; ++i) add_unless_repeated(ring, support_point(s, direction(i)));
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

double h(const GrownShape& s, double angle) {
  return support(s, direction(angle)).h;
}

/// The deepest direction: where h_S is least. Convexity of S makes h's negative stretch one arc round it.
std::optional<double> deepest_angle(const GrownShape& s) {
  double best = 0.0;
  for (int i = 1; i < kDirections; ++i) {
    const double angle = 2.0 * kPi * i / kDirections;
    if (h(s, angle) < h(s, best)) best = angle;
  }
  if (h(s, best) < 0.0) return best;
  return std::nullopt;
}

/// Between `inside` (h < 0) and `outside` (h >= 0) the sign changes once: halved down to the doubles.
double sign_change(const GrownShape& s, double inside, double outside) {
  const int halvings = 60;  // more than the 53 bits of an angle
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (h(s, middle) < 0.0 ? inside : outside) = middle;
  }
  return inside;
}

/// The first and the last of the angles at which h_S < 0; the normals of the legs are its ends. h is positive at right
/// angles beyond the nearest point's normal, so the ends lie within half a turn of the deepest direction.
std::optional<std::pair<double, double>> negative_arc(const GrownShape& s) {
  const std::optional<double> deepest = deepest_angle(s);
  if (!deepest) return std::nullopt;
  return std::pair(sign_change(s, *deepest, *deepest - kPi), sign_change(s, *deepest, *deepest + kPi));
}

std::array<HalfPlane, 4> sides_of(const Box& box) {
  return {{{{1.0, 0.0}, box.low.x}, {{-1.0, 0.0}, -box.high.x}, {{0.0, 1.0}, box.low.y}, {{0.0, -1.0}, -box.high.y}}};
}

/// Points looked at together: the time grows with their square where a curve is as jagged as can be.
constexpr std::size_t kStretch = 2048;

/// Marks the points between two that are kept.
void keep_between(const Points& curve, std::size_t first, std::size_t last, std::vector<bool>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    double most = kThinning;
    std::size_t farthest = from;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double distance = norm(curve[k] - nearest_on(curve[from], curve[to], curve[k]));
      if (distance > most) most = distance, farthest = k;
    }
    if (farthest == from) continue;
    kept[farthest] = true;
    open.emplace_back(from, farthest);
    open.emplace_back(farthest, to);
  }
}

}  // namespace

Points outline(const geometry::ConvexShape& shape) {
  if (const auto* polygon = std::get_if<geometry::ConvexPolygon>(&shape)) return polygon->vertices;
  if (const auto* segment = std::get_if<geometry::Segment>(&shape)) return {segment->a, segment->b};
  return support_ring({shape, {0.0, 0.0}, 0.0});
}

Points hull_outline(const geometry::RoundedPolygon& part, const geometry::Pose& pose, double grown) {
  constexpr int kSteps = 96;
  Points ring;
  for (int k = 0; k < kSteps; ++k) {
    const Vec2 n = geometry::rotated({1.0, 0.0}, 2.0 * geometry::kPi * k / kSteps);
    Vec2 best;
    double most = -INFINITY;
    for (const Vec2 corner : part.corners) {
      const Vec2 turned = geometry::rotated(corner, pose.heading);
      if (dot(n, turned) > most) {
        most = dot(n, turned);
        best = turned;
      }
    }
    ring.push_back(pose.at + best + (part.radius + grown) * n);
  }
  return ring;
}

Points scaled_outline(const GrownShape& s, double tau) {
  Points ring = support_ring(s);
  for (Vec2& p : ring) p = p / tau;
  return ring;
}

Points tied_together(const geometry::Polygon& polygon) {
  Points path = polygon.outer;
  path.push_back(path.front());
  for (const geometry::Ring& hole : polygon.holes) {
    path.insert(path.end(), hole.begin(), hole.end());
    path.push_back(hole.front());
    path.push_back(path.front());
  }
  return path;
}

Points corners(const Box& box) {
  return {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
}

Points clipped(const Points& ring, const HalfPlane& keep) {
  Points result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i];
    const Vec2 b = ring[(i + 1) % ring.size()];
    const double outside_a = violation(keep, a);
    const double outside_b = violation(keep, b);
    if (outside_a <= 0.0) add_unless_repeated(result, a);
    if ((outside_a < 0.0 && outside_b > 0.0) || (outside_a > 0.0 && outside_b < 0.0)) {
      add_unless_repeated(result, a + (outside_a / (outside_a - outside_b)) * (b - a));
    }
  }
  return result;
}

Points clipped_to(const Points& ring, const Box& keep) {
  Points kept = ring;
  for (const HalfPlane& side : sides_of(keep)) kept = clipped(kept, side);
  return kept;
}

/// Cut by the four sides of the box in turn.
Points segment_within(const Box& box, Vec2 a, Vec2 b) {
  for (const HalfPlane& side : sides_of(box)) {
    const double out_a = violation(side, a);
    const double out_b = violation(side, b);
    if (out_a > 0.0 && out_b > 0.0) return {};
    const Vec2 cut = out_a == out_b ? a : a + (out_a / (out_a - out_b)) * (b - a);
    if (out_a > 0.0) a = cut;
    if (out_b > 0.0) b = cut;
  }
  return {a, b};
}

Points boundary_within(const Box& box, const HalfPlane& half_plane) {
  const Points kept = clipped(corners(box), half_plane);
  const double along = 4.0 * box.diagonal();
  const Vec2 n = normalized(half_plane.normal);
  const Vec2 foot = (half_plane.offset / norm(half_plane.normal)) * n;
  if (kept.empty() || !box.grown(along).contains(foot)) return {};
  return segment_within(box, foot - along * perp(n), foot + along * perp(n));
}

Points stretch_within(const std::vector<geometry::HalfPlane>& all, const Points& line) {
  constexpr double kOn = 1e-9;
  if (line.empty()) return {};
  const Vec2 along = line[1] - line[0];
  double from = 0.0, to = 1.0;
  for (const geometry::HalfPlane& h : all) {
    const double start = dot(h.normal, line[0]) - h.offset + kOn, gained = dot(h.normal, along);
    if (start < 0.0 && start + gained < 0.0) return {};
    if (start < 0.0) from = std::max(from, -start / gained);
    if (start + gained < 0.0) to = std::min(to, -start / gained);
  }
  return from < to ? Points{line[0] + from * along, line[0] + to * along} : Points{};
}

std::vector<Points> hatching(const Points& boundary, Vec2 normal, double gap) {
  const Vec2 along = normalized(boundary[1] - boundary[0]);
  const Vec2 stroke = -0.9 * gap * normalized(normal) + 0.6 * gap * along;
  const int count = static_cast<int>(norm(boundary[1] - boundary[0]) / gap);
  std::vector<Points> strokes;
  for (int i = 0; i < count; ++i) {
    const Vec2 foot = boundary[0] + (i + 0.5) * gap * along;
    strokes.push_back({foot, foot + stroke});
  }
  return strokes;
}

std::optional<std::pair<Vec2, Vec2>> leg_normals(const GrownShape& s) {
  const auto arc = negative_arc(s);
  if (!arc) return std::nullopt;
  // The leg along t has the outward normal perp(t) on its left side, -perp(t) on its right.
  return std::pair(direction(arc->first), direction(arc->second));
}

Points velocity_obstacle_in(const Box& box, const GrownShape& s, double tau, Vec2 shift) {
  const auto arc = negative_arc(s);
  if (!arc) return {};
  Points ring = corners(box);
  for (int i = 0; i <= kDirections && !ring.empty(); ++i) {
    const Vec2 n = direction(arc->first + (arc->second - arc->first) * i / kDirections);
    const double reach = support(s, n).h / tau;
    ring = clipped(ring, {-n, -(reach + dot(n, shift))});
  }
  return ring;
}

std::vector<std::size_t> all_points(std::size_t count) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> drawn_points(const Points& curve) {
  if (curve.size() < 3) return all_points(curve.size());
  std::vector<bool> kept(curve.size());
  for (std::size_t from = 0; from + 1 < curve.size(); from += kStretch) {
    const std::size_t to = std::min(from + kStretch, curve.size() - 1);
    kept[from] = kept[to] = true;
    keep_between(curve, from, to, kept);
  }
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < curve.size(); ++k)
    if (kept[k]) drawn.push_back(k);
  return drawn;
}

}  // namespace exactvo::tools
