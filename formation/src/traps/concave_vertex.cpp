// SPDX-License-Identifier: GPL-3.0-or-later
#include "traps/concave_vertex.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "steering/steering.h"
#include "traps/boundary.h"

namespace exactvo::formation::detail {
namespace {

using geometry::GrownShape;

constexpr double kMostTurn = 0.1;  // rad, of one stretch of a curved boundary
/// An arc that turns by less than kMostTurn is at most this many times as long as its chord: 1 / cos(turn / 2).
constexpr double kArcToChord = 1.002;
/// A share of the robot's radius: shorter stretches are not divided further.
constexpr double kFinestShare = 0.01;
/// Normals this near to parallel: the boundaries run along each other, and no vertex is there.
constexpr double kParallel = 1e-3;

vo::VelocityObstacle::Nearest nearest_of(const GrownShape& s, Vec2 p) {
  return vo::VelocityObstacle(s.shape, p + s.origin, s.radius, 1.0).nearest();
}

/// A stretch of the boundary: straight, or the part whose normals turn from one angle to another.
struct Stretch {
  bool straight = false;
  Vec2 from, to;                  ///< m, where straight
  Vec2 normal;                    ///< where straight
  double begin = 0.0, end = 0.0;  ///< rad, where curved
  std::optional<Vec2> corner;     ///< m, where curved about a corner of the shape
};

void add_arc(double begin, double end, std::optional<Vec2> corner, std::vector<Stretch>& out) {
  const int parts = std::max(1, static_cast<int>(std::ceil((end - begin) / kMostTurn)));
  for (int k = 0; k < parts; ++k) {
    Stretch s;
    s.begin = begin + (end - begin) * k / parts;
    s.end = begin + (end - begin) * (k + 1) / parts;
    s.corner = corner;
    out.push_back(s);
  }
}

/// Once round the boundary, counter-clockwise: the flat edges moved outward, and the arcs between them.
std::vector<Stretch> stretches_of(const Boundary& boundary, double radius) {
  std::vector<Stretch> out;
  const std::vector<geometry::Segment>& edges = boundary.flat_edges();
  if (edges.empty()) add_arc(0.0, kFullTurn, std::nullopt, out);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec2 normal = outward(edges[i]), turned = outward(edges[(i + 1) % edges.size()]);
    out.push_back({true, edges[i].a + radius * normal, edges[i].b + radius * normal, normal, 0.0, 0.0, {}});
    const double begin = std::atan2(normal.y, normal.x);
    double turn = std::atan2(turned.y, turned.x) - begin;
    if (turn < 0.0) turn += kFullTurn;
    if (turn > 0.0) add_arc(begin, begin + turn, edges[i].b, out);
  }
  return out;
}

class CrossingSearch {
 public:
  CrossingSearch(const GrownShape& a, const GrownShape& b)
      : boundary_(a.shape, a.radius), b_(b), radius_(a.radius), finest_(kFinestShare * a.radius) {
    for (const Stretch& s : stretches_of(boundary_, a.radius)) {
      const Sample first = sample(s, 0.0), last = sample(s, 1.0);
      search(s, first, last);
    }
  }

  std::vector<Crossing> found;

 private:
  struct Sample {
    double share = 0.0;     ///< of the stretch
    Vec2 position;          ///< m
    double distance = 0.0;  ///< m, to the other shape
    bool inside() const { return distance <= 0.0; }
  };

  Sample sample(const Stretch& s, double share) const {
    const Vec2 p = s.straight ? s.from + share * (s.to - s.from) : on_arc(s, s.begin + share * (s.end - s.begin));
    return {share, p, distance_to(b_, p)};
  }

  /// Round a corner it is the corner's circle: where an end's angle is rounded past the normal of the edge beside it,
  /// the support point in that direction is at the far end of the edge.
  Vec2 on_arc(const Stretch& s, double angle) const {
    return s.corner ? *s.corner + radius_ * Vec2{std::cos(angle), std::sin(angle)} : boundary_.at(angle).position;
  }

  Sample between(const Stretch& s, const Sample& a, const Sample& b) const {
    return sample(s, 0.5 * (a.share + b.share));
  }

  /// The distance changes by no more than the way along the boundary, so that far from the other one nothing crosses.
  void search(const Stretch& s, const Sample& first, const Sample& last) {
    const double chord = norm(last.position - first.position);
    const bool changes = first.inside() != last.inside();
    if (!changes && std::fabs(first.distance) + std::fabs(last.distance) > kArcToChord * chord) return;
    if (chord <= finest_) {
      if (changes) add(s, first, last);
      return;
    }
    const Sample middle = between(s, first, last);
    if (!(first.share < middle.share && middle.share < last.share)) return search_chord(s, first, last);
    search(s, first, middle);
    search(s, middle, last);
  }

  /// The boundary of a thin ellipse runs straight between the points of neighbouring directions, for all that doubles
  /// tell.
  void search_chord(const Stretch& s, const Sample& first, const Sample& last) {
    if (s.straight) return;  // its points lie too far from 0 to be told apart
    const Stretch chord = chord_of(s, first, last);
    search(chord, sample(chord, 0.0), sample(chord, 1.0));
  }

  static Stretch chord_of(const Stretch& s, const Sample& first, const Sample& last) {
    return {true, first.position, last.position, normal_at(s, first.share), 0.0, 0.0, {}};
  }

  static Vec2 normal_at(const Stretch& s, double share) {
    const double angle = s.begin + share * (s.end - s.begin);
    return s.straight ? s.normal : Vec2{std::cos(angle), std::sin(angle)};
  }

  void bisect(const Stretch& s, Sample& first, Sample& last) const {
    constexpr int kBisections = 40;  // of a centimetre: far below rounding
    for (int k = 0; k < kBisections; ++k) {
      const Sample middle = between(s, first, last);
      (middle.inside() == first.inside() ? first : last) = middle;
    }
  }

  void add(const Stretch& s, Sample first, Sample last) {
    bisect(s, first, last);
    const Vec2 normal = normal_at(s, first.share);
    if (!s.straight) {
      const Stretch chord = chord_of(s, first, last);
      first = sample(chord, 0.0);
      last = sample(chord, 1.0);
      bisect(chord, first, last);
    }
    const Vec2 other = nearest_of(b_, first.position).normal;
    if (std::fabs(cross(normal, other)) < kParallel) return;
    found.push_back({first.position, normal, other});
  }

  Boundary boundary_;
  GrownShape b_;
  double radius_;  ///< m
  double finest_;  ///< m
};

/// Whether no free velocity has a component along `ahead`: it lies in the cone of -n_a and -n_b.
bool holds_back(const Crossing& c, Vec2 ahead) {
  const double turn = cross(c.normal_a, c.normal_b);
  return -cross(ahead, c.normal_b) / turn >= 0.0 && -cross(c.normal_a, ahead) / turn >= 0.0;
}

/// What a robot at the crossing prefers that heads along `ahead`: of the two half-planes, whose lines go through 0, it
/// is turned at the one it violates most (steering.h).
Vec2 preferred_at(const Crossing& c, Vec2 ahead) {
  const Vec2 worst = dot(c.normal_a, ahead) < dot(c.normal_b, ahead) ? c.normal_a : c.normal_b;
  return dot(worst, ahead) < 0.0 ? with_tie_broken(worst, ahead) : ahead;
}

geometry::Box box_of(const GrownShape& s) {
  const geometry::Box bare = geometry::box_of(s.shape);
  return geometry::Box{bare.low - s.origin, bare.high - s.origin}.grown(s.radius);
}

}  // namespace

double distance_to(const GrownShape& shape, Vec2 p) {
  return nearest_of(shape, p).distance;
}

bool boxes_meet(const GrownShape& a, const GrownShape& b) {
  return meet(box_of(a), box_of(b));
}

std::vector<Crossing> crossings(const GrownShape& a, const GrownShape& b) {
  return CrossingSearch(a, b).found;
}

std::optional<VertexRest> rest_at(const Crossing& c, Vec2 goal) {
  const Vec2 way = goal - c.position, ahead = geometry::normalized(way);
  if (way == Vec2{}) return std::nullopt;
  if (!holds_back(c, preferred_at(c, ahead))) return std::nullopt;
  const Vec2 out = geometry::normalized(c.normal_a + c.normal_b);
  const double depth = std::min(std::fabs(cross(ahead, c.normal_a)), std::fabs(cross(ahead, c.normal_b)));
  return VertexRest{{c.position, out, geometry::kInfinity, norm(way), true}, holds_back(c, ahead) ? depth : 0.0};
}

}  // namespace exactvo::formation::detail
