// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One question of overlap: a moving body against another or against an obstacle, over any window of time. Whatever
/// motions.h promises is an answer of `decide` or `compare_clearance`.

#include <optional>
#include <vector>

#include "exactvo/geometry/motions.h"
#include "motions/path.h"
#include "motions/straight.h"

namespace exactvo::geometry::motions {

/// Throws std::logic_error where a motion is not as `encounter` requires it.
void require_motion(const Motion& motion);

/// A corner of the hull that the difference of two reference points must not enter: exactly plus - minus.
struct Corner {
  Vec2 plus;   ///< of the other body, from its reference point, or of the obstacle
  Vec2 minus;  ///< of the moving body, from its reference point
};

/// A pair of convex parts, one of each body, as one hull round the difference of the reference points.
struct Target {
  std::vector<Corner> corners;  ///< a point, a segment, or counter-clockwise without collinear corners; exact
  double reach = 0.0;           ///< of the moving body's part
  double other_reach = 0.0;     ///< of the other's
  bool thin = false;            ///< neither part has an interior: contact counts as overlap
};

/// The convex hull of the differences. Exact.
std::vector<Corner> hull_of_differences(const std::vector<Vec2>& plus, const std::vector<Vec2>& minus);

/// What may be inside an obstacle without meeting its edges: a point of a part, the mean of some of its corners.
struct Anchor {
  std::vector<Vec2> corners;  ///< one or three
  double reach = 0.0;         ///< m
};

class Question {
 public:
  Question(const Motion& a, const RigidBody& body_a, const Motion& b, const RigidBody& body_b);
  Question(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle);

  /// From > to where the two have no moment in common.
  Window window() const { return window_; }

  /// How the two fare over a part of the window. Exact.
  Encounter decide(Window w) const { return decide(w, 0.0, Thin::overlaps); }
  /// `decide` over the whole window, counted by stage.
  Encounter verdict() const;
  /// Compares the least distance over a part of the window, less the reaches, with `more`: `overlap` if it is less,
  /// `contact` if equal, `clear` if greater. The inside of an obstacle or of a hull counts as less. Exact.
  Encounter compare_clearance(Window w, double more) const { return decide(w, more, Thin::touches); }

  const Motion& motion() const { return *a_; }
  const Motion* other() const { return b_; }
  const std::vector<Target>& targets() const { return targets_; }
  const std::vector<Anchor>& anchors() const { return anchors_; }
  const std::vector<Segment>& edges() const { return edges_; }
  /// What corners are measured from: they are relative to a's origin when this is added.
  Vec2 other_origin() const { return b_ ? origin_of(*b_) : Vec2{}; }

 private:
  enum class Thin { overlaps, touches };

  Encounter decide(Window w, double more, Thin thin) const;
  std::optional<Encounter> by_filter(Window w, double more, Thin thin) const;
  Encounter exactly(Window w, double more, Thin thin) const;
  bool point_enters(Window w) const;

  const Motion* a_;
  const Motion* b_ = nullptr;
  std::vector<Target> targets_;
  std::vector<Anchor> anchors_;  ///< only against polygons
  std::vector<Segment> edges_;   ///< of a polygon that has an inside
  Window window_;
};

/// The targets' hull over any ring, in the scale of a path; `origin` is what `a` is measured from.
template <class T>
GrownHull<T> hull_over(const Target& target, Vec2 origin, Vec2 other_origin, const T& scale, double more) {
  GrownHull<T> hull;
  const bool scaled = sign_of(T(scale - T(1.0))) != Known::zero;
  const Vector<T> between = detail::difference<T>(other_origin, origin);
  for (const Corner& c : target.corners) {
    const bool at_reference = c.minus.x == 0.0 && c.minus.y == 0.0;
    const Vector<T> v = at_reference && other_origin == Vec2{} ? detail::difference<T>(c.plus, origin)
                                                               : between + detail::difference<T>(c.plus, c.minus);
    hull.vertices.push_back(scaled ? scale * v : v);
  }
  const T reach = T(target.reach) + T(target.other_reach) + T(more);
  hull.reach = scaled ? scale * reach : reach;
  return hull;
}

}  // namespace exactvo::geometry::motions
