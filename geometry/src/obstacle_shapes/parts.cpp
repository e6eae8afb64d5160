// SPDX-License-Identifier: GPL-3.0-or-later
// Facades and pieces of an obstacle, each certified to follow it.
#include <algorithm>
#include <utility>

#include "division/chain_fit.h"
#include "obstacle_shapes/steps.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

/// Certified: the bound is rounded up.
bool lies_within(const Segment& facade, Vec2 x, double distance) {
  if (x == facade.a || x == facade.b) return true;
  return distance_upper_bound(facade, x, largest_coordinate({facade.a, facade.b, x})) <= distance;
}

/// Follows one course along its facades, which start at `next` of the list and end where the course does.
class CourseWalk {
 public:
  CourseWalk(const std::vector<Vec2>& course, bool closed, const FacadeSet& set) : course_(course), set_(set) {
    steps_ = closed ? course.size() : course.size() - 1;
  }

  /// Whether every vertex keeps to its facade; moves `next` past the facades of this course.
  bool keeps(std::size_t& next) const {
    if (next >= set_.facades.size()) return false;
    const auto start = std::find(course_.begin(), course_.end(), set_.facades[next].a);
    if (start == course_.end()) return false;
    std::size_t at = static_cast<std::size_t>(start - course_.begin());
    for (std::size_t step = 0; step < steps_; ++step) {
      if (next >= set_.facades.size()) return false;
      const Segment& facade = set_.facades[next];
      at = (at + 1) % course_.size();
      if (course_[at] != facade.b) {
        if (!is_near(facade, course_[at])) return false;
        continue;
      }
      ++next;
      const bool last = step + 1 == steps_;
      if (!last && (next >= set_.facades.size() || set_.facades[next].a != facade.b)) return false;
      if (last) return true;
    }
    return steps_ == 0 && course_.size() == 1 && set_.facades[next++].b == course_[0];
  }

 private:
  bool is_near(const Segment& facade, Vec2 x) const {
    if (set_.deviation == 0.0) return lies_on(facade, x);
    return lies_within(facade, x, set_.deviation);
  }

  const std::vector<Vec2>& course_;
  const FacadeSet& set_;
  std::size_t steps_ = 0;
};

bool facades_follow(const FacadeSet& set, const Obstacle& obstacle) {
  std::size_t next = 0;
  for (const std::vector<Vec2>* course : courses_of(obstacle)) {
    if (!CourseWalk(*course, has_interior(obstacle), set).keeps(next)) return false;
  }
  return next == set.facades.size();
}

/// A wall's own edges, straight runs merged: what half-planes of pieces keep clear of must not be simplified.
void split_wall(ObstacleShapes& out) {
  const FacadeSet edges = out.facades.deviation > 0.0 ? divide_into_facades(out.obstacle) : out.facades;
  out.pieces.assign(edges.facades.begin(), edges.facades.end());
  out.pieces_cover = verdict(edges.deviation == 0.0 && facades_follow(edges, out.obstacle), "an edge is not covered");
}

}  // namespace

void divide(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.facades_follow, [&] {
    out.facades = divide_into_facades(out.obstacle, options.facades);
    const bool within = out.facades.deviation <= options.facades.tolerance;
    out.facades_follow = verdict(within && facades_follow(out.facades, out.obstacle), "a facade leaves the boundary");
  });
}

void split(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.pieces_cover, [&] {
    if (const auto* polygon = std::get_if<Polygon>(&out.obstacle)) {
      for (ConvexPolygon& piece : convex_pieces(*polygon, options.partition)) out.pieces.emplace_back(std::move(piece));
      out.pieces_cover = {true, {}};  // convex_pieces gives no partition that it has not proved
    } else {
      split_wall(out);
    }
  });
}

}  // namespace exactvo::geometry::detail
