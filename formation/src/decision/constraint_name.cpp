// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/constraint_name.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "exactvo/geometry/predicates.h"

namespace exactvo::formation {
namespace {

using geometry::ConvexShape;
using geometry::Ellipse;
using geometry::Segment;

/// m: a point this near a shape lies on it; far above rounding, far below any gap between obstacles that matters.
constexpr double kSamePlace = 1e-5;
constexpr std::size_t kMostNames = 3;

/// How much of an obstacle an ellipse shows to be its own, from little to much.
enum class Share { none, vertex, edge, whole, facade };

/// Whether the ellipse has its centre halfway between two of the points and its major axis along them.
bool is_built_on(const Ellipse& ellipse, const std::vector<Vec2>& points) {
  const geometry::EllipseAxes axes = geometry::axes_of(ellipse);
  const Vec2 along = geometry::rotated({1.0, 0.0}, axes.angle);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2 chord = points[i] - points[j];
      const Vec2 off = 0.5 * (points[i] + points[j]) - ellipse.center;
      if (norm(off) <= kSamePlace && std::fabs(cross(chord, along)) <= kSamePlace && norm(chord) > kSamePlace)
        return true;
    }
  }
  return false;
}

Share share_in(const Ellipse& ellipse, const geometry::Obstacle& obstacle) {
  const std::vector<Vec2> all = geometry::vertices_of(obstacle);
  std::vector<Vec2> inside;
  for (Vec2 p : all)
    if (contains(ellipse, p)) inside.push_back(p);
  if (inside.empty()) return Share::none;
  if (is_built_on(ellipse, inside)) return Share::facade;
  if (inside.size() == all.size()) return Share::whole;
  for (const Segment& edge : geometry::edges_of(obstacle))
    if (contains(ellipse, edge.a) && contains(ellipse, edge.b)) return Share::edge;
  return Share::vertex;
}

bool has_edge(const geometry::Obstacle& obstacle, const Segment& edge) {
  const auto edges = geometry::edges_of(obstacle);
  return std::any_of(edges.begin(), edges.end(), [&](const Segment& e) {
    return (e.a == edge.a && e.b == edge.b) || (e.a == edge.b && e.b == edge.a);
  });
}

bool touches(const ConvexShape& shape, const geometry::Obstacle& obstacle) {
  const auto vertices = geometry::vertices_of(obstacle);
  return std::any_of(vertices.begin(), vertices.end(), [&](Vec2 p) {
    return geometry::locate(geometry::GrownShape{shape, {}, kSamePlace}, p) != geometry::Place::outside;
  });
}

std::vector<std::string> behind_ellipse(const Ellipse& ellipse, const Scenario& scenario) {
  std::vector<std::string> ids;
  Share most = Share::vertex;
  for (const SceneObstacle& obstacle : scenario.obstacles) {
    const Share share = share_in(ellipse, obstacle.shape);
    if (share < most || share == Share::none) continue;
    if (share > most) ids.clear();
    most = share;
    ids.push_back(obstacle.id);
  }
  return ids;
}

std::string ends_of(const Segment& s) {
  char text[160];
  std::snprintf(text, sizeof text, "(%.3g, %.3g)-(%.3g, %.3g)", s.a.x, s.a.y, s.b.x, s.b.y);
  return text;
}

/// "enclosures", "4" and "5" of "obstacle U".
struct Named {
  std::string kind, kinds;  ///< one of them, several
  std::vector<std::string> which;
  std::string owner;  ///< empty where there is none
};

/// The ids of the obstacles that a shape stands for, in the order of the scenario: those with a facade that the ellipse
/// was built on, else those wholly inside it, else those with an edge inside it; the owner of an edge; what a convex
/// piece touches.
std::vector<std::string> obstacles_behind(const ConvexShape& shape, const Scenario& scenario) {
  if (const auto* ellipse = std::get_if<Ellipse>(&shape)) return behind_ellipse(*ellipse, scenario);
  std::vector<std::string> ids;
  if (const auto* edge = std::get_if<Segment>(&shape))
    for (const SceneObstacle& o : scenario.obstacles)
      if (has_edge(o.shape, *edge)) ids.push_back(o.id);
  if (!ids.empty()) return ids;
  for (const SceneObstacle& o : scenario.obstacles)
    if (touches(shape, o.shape)) ids.push_back(o.id);
  return ids;
}

std::string owner_of(const ConvexShape& shape, const Scenario& scenario) {
  const std::vector<std::string> ids = obstacles_behind(shape, scenario);
  if (ids.empty()) return "";
  return (ids.size() > 1 ? "obstacles " : "obstacle ") + abridged(ids);
}

template <typename Items>
std::string id_at(const Items& items, std::size_t index) {
  return index < items.size() ? items[index].id : std::to_string(index);
}

Named named(const RecordedConstraint& c, const Scenario& scenario) {
  if (c.source == ConstraintSource::robot) return {"robot", "robots", {id_at(scenario.robots, c.index)}, ""};
  if (c.source == ConstraintSource::moving_obstacle)
    return {"moving obstacle", "moving obstacles", {id_at(scenario.moving_obstacles, c.index)}, ""};
  const std::string owner = owner_of(c.shape, scenario);
  if (c.source == ConstraintSource::enclosure) {
    const std::string piece = c.piece > 0 ? ", piece " + std::to_string(c.piece) + "," : "";
    return {"enclosure", "enclosures", {std::to_string(c.index) + piece}, owner};
  }
  const auto* edge = std::get_if<Segment>(&c.shape);
  return {"the edge", "the edges", {edge ? ends_of(*edge) : std::to_string(c.index)}, owner};
}

}  // namespace

std::string name_of(const std::vector<RecordedConstraint>& constraints, const Scenario& scenario) {
  std::vector<Named> groups;  // of one kind and owner each
  for (const RecordedConstraint& c : constraints) {
    Named item = named(c, scenario);
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const Named& g) { return g.kind == item.kind && g.owner == item.owner; });
    if (same == groups.end())
      groups.push_back(std::move(item));
    else
      same->which.push_back(item.which.front());
  }
  std::vector<std::string> words;
  for (const Named& g : groups)
    words.push_back((g.which.size() > 1 ? g.kinds : g.kind) + " " + enumerated(g.which) +
                    (g.owner.empty() ? "" : " of " + g.owner));
  return enumerated(words);
}

std::string name_of(const RecordedConstraint& constraint, const Scenario& scenario) {
  return name_of(std::vector<RecordedConstraint>{constraint}, scenario);
}

std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
  return text;
}

std::string abridged(std::vector<std::string> words) {
  if (words.size() > kMostNames) {
    const std::size_t more = words.size() - kMostNames;
    words.resize(kMostNames);
    words.push_back(std::to_string(more) + " more");
  }
  return enumerated(words);
}

}  // namespace exactvo::formation
