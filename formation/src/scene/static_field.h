// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The static obstacles as one robot sees them: shapes for its method and goal, and the certified half-planes they
/// give. Shapes are bodies of one table, looked up by place; a step copies none.

#include <cstdint>
#include <tuple>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/geometry/enclosure.h"
#include "scene/decision_rules.h"
#include "scene/scene.h"

namespace exactvo::formation::detail {

/// A half-plane of a decision under the names that recordings use.
struct Constraint : vo::Constraint {
  std::size_t index = 0;   ///< of the enclosure, edge, robot or moving obstacle
  std::size_t piece = 0;   ///< 0: the enclosure itself; from 1 on: which convex piece it gave way to
  bool fell_back = false;  ///< of a pair of robots that fell back (liveness, rule R0)
  bool trap_free = false;  ///< the shape carries the certificate for this robot's goal
  double speed = 0.0;      ///< m/s, at most, of what it keeps clear of
};

/// The nearest first; of shapes equally near, the order of their names.
inline constexpr auto comes_before = [](const Constraint& a, const Constraint& b) {
  return std::tie(a.clearance, a.index, a.piece) < std::tie(b.clearance, b.index, b.piece);
};

struct WheelsNow;

/// How a half-plane is asked for: the point it is built at and the velocity it is built round.
struct Viewpoint {
  Vec2 position;                      ///< m
  Vec2 velocity;                      ///< m/s, v_opt
  double radius = 0.0;                ///< m
  double max_speed = 0;               ///< m/s
  double most = geometry::kInfinity;  ///< m/s: no velocity is longer, whatever max_speed
  double horizon = 0.0;               ///< s: instead of what the rules say; 0: none
  /// `velocity` is the one after a step of braking, and half-planes are those that it satisfies (braking.h): against
  /// pieces alone, as enclosures are fitted anew for each goal and may hold the way of a robot that brakes. There are
  /// only `StaticField::constraints` of these.
  bool brakes = false;
  // Which its own limits are named after:
  std::size_t robot = 0;              ///< its number
  const WheelsNow* wheels = nullptr;  ///< where it has some
  vo::BodyTable::Number body = 0;     ///< that stands for it
  /// s: the robot goes straight on so long, along a way that is clear, and turns then: horizons are not longer, unless
  /// the least one is.
  double turns_after = std::numeric_limits<double>::infinity();
};

/// Where a robot makes half-planes that braking satisfies. REQUIRES: rules with an acceleration.
inline Viewpoint after_braking(const DecisionRules& rules, Viewpoint here) {
  here.velocity = rules.braked(here.velocity);
  here.horizon = rules.braking_time;
  here.brakes = true;
  return here;
}

/// Which static shapes a decision needs: those within reach, and those whose half-plane may leave the robot's velocity
/// less room than asked.
struct Need {
  double within = -1.0;  ///< m, from the rim; negative: none for its distance
  double room = 0.0;     ///< m/s; 0: none for its room
};

/// m. Half-planes are built for a robot this much larger and certified for the robot as it is: a robot that presses
/// against a wall for minutes closes the gap by a constant factor a step, and without a skin it would end within
/// rounding of the wall, where nothing can be proven. Rounding moves it by about 1e-15 of the coordinates a step, so
/// 1e-6 m outlasts 10^7 steps at 100 m.
inline constexpr double kContactSkin = 1e-6;

/// What the literal paper does instead of clamping tau.
enum class HorizonRule { clamped, literal };

/// The shapes that obstacles are seen as.
enum class SeenAs {
  by_rule,  ///< pieces with guidance, else what encloses them for the robot's goal
  pieces    ///< of methods that have pieces
};

class StaticField {
 public:
  static constexpr double kEverywhere = std::numeric_limits<double>::infinity();

  /// Shapes for a robot of `radius` going from `start` to `goal`: with guidance the pieces of obstacles alone.
  /// Scene and rules must outlive the field.
  StaticField(Scene& scene, const DecisionRules& rules, double radius, Vec2 start, Vec2 goal, HorizonRule rule,
              SeenAs seen_as = SeenAs::by_rule);

  /// m: what a piece is kept away from beside the radius while there is room; that of the rules by default. Not between
  /// a look and the decision that is made of it.
  void set_margin(double margin) { margin_ = margin; }

  /// Half-planes of every shape that could matter to a robot of that speed, nearest first; of those farther than
  /// `reach` (m, from the rim) only some.
  void constraints(const Viewpoint& from, std::vector<Constraint>& out, double reach = kEverywhere) const;

  /// Whether the field knows what its half-planes leave a velocity: else there are only `constraints`.
  bool bounds_room() const { return rule_ == HorizonRule::clamped && !takes_edges(rules_->method); }
  bool is_empty() const { return is_small_ && all_.empty(); }

  /// A body of the field, under the names that recordings use.
  struct Shape {
    vo::BodyTable::Number body = 0;
    std::size_t index = 0;
    geometry::EnclosureGrade grade = geometry::EnclosureGrade::tight;
    std::size_t piece = 0;
  };
  /// A body that has been met from a viewpoint, and what is known of it from there.
  struct Met : Shape {
    double distance = 0.0;       ///< m, from the robot's centre to its box
    double room = -kEverywhere;  ///< m/s: less than n.v - c of its half-plane at v = from.velocity
    bool is_built = false;
  };
  /// What has been met from one viewpoint: all whose boxes meet the window, or all of a small field.
  struct Meetings {
    std::vector<Met> met;
    geometry::Box window;
    void clear() {
      met.clear();
      window = {};
    }
  };
  /// Adds the half-planes that are needed and not in `out`, in no order, each the same bits as `constraints` gives. Of
  /// what is left out, the unit normal n and offset c have n.v - c >= need.room at v = from.velocity, and a lower bound
  /// of that is certain beyond all rounding. `meetings`: from this viewpoint alone; none at first. REQUIRES:
  /// `bounds_room`.
  void add_needed(const Viewpoint& from, const Need& need, Meetings& meetings, std::vector<Constraint>& out) const;

  /// A body of the field as it is looked at again and again, from places near each other.
  struct NearBody : Shape {
    geometry::Box box;
    double largest_coordinate = 0.0;  ///< m, of the box
    bool is_segment = false;          ///< a piece that is one: from `a`, along `along`
    Vec2 a, along;                    ///< m
    double per_length2 = 0.0;         ///< 1/m2, 1 / |along|^2; 0 of a point
    double gathered = 0.0;            ///< m, from where it was looked for: no more than its distance
  };
  /// All whose box is within `reach` (m, from the rim) of a place at most `room_to_move` (m) away from the robot's,
  /// nearest first.
  void bodies_near(const Viewpoint& from, double reach, double room_to_move, std::vector<NearBody>& out) const;

  /// One body of the field as a robot sees it, before its half-plane is built. Rounded.
  struct Candidate : Shape {
    double nearest = 0.0;  ///< m, from the rim: no more than its clearance
    double room = 0.0;     ///< m/s: no more than n.v - c of its half-plane at v = from.velocity, where this is > 0
    bool is_segment = false;
    // For a segment:
    bool has_line = false;  ///< then its half-plane is this one but for rounding
    geometry::HalfPlane line;
    Vec2 away;              ///< m, from its nearest point to the robot
    double distance = 0.0;  ///< m, |away|
    double kept = 0.0;      ///< m, from the robot's centre: where less is left than this, nothing is known. Rounded up
    double tau = 0.0;       ///< s, its time horizon
    bool is_built = false;
  };
  /// What `constraints` would build within that reach, and its half-plane where it has one. The same REQUIRES. `near`:
  /// what `bodies_near` gave for that reach and a place `moved` (m) away, within its room to move.
  void candidates(const std::vector<NearBody>& near, double moved, const Viewpoint& from, double reach,
                  std::vector<Candidate>& out) const;
  /// Adds the half-plane of a shape.
  void build(const Shape& shape, const Viewpoint& from, std::vector<Constraint>& out) const;

  /// The shapes by their number in this field, as bodies: `Constraint::index` counts them.
  std::vector<vo::BodyTable::Number> shapes() const;
  /// The same with what they are.
  std::vector<geometry::Enclosure> enclosures() const;

 private:
  void take_enclosures(const std::vector<geometry::Enclosure>& enclosures);
  void list_if_small();
  template <class Visit>
  void for_each_shape(const Visit& visit) const;
  template <class Visit>
  void for_each_shape_within(Vec2 x, double reach, const Visit& visit) const;
  template <class Visit>
  void for_each_shape_meeting(const geometry::Box& window, const Visit& visit) const;
  double horizon(double distance, const Viewpoint& from) const;
  double farthest_that_matters(const Viewpoint& from) const;
  bool gives_way(const Shape& shape, const Viewpoint& from, double distance) const;
  double distance_to_box(const Shape& shape, const Viewpoint& from) const {
    return geometry::distance_below(scene_->bodies().box(shape.body), from.position);
  }
  void meet_shapes(const Viewpoint& from, const Need& need, const std::vector<Constraint>& built,
                   Meetings& meetings) const;
  template <class Visit>
  void for_each_piece_of(const Shape& shape, const Visit& visit) const;
  void add_shape(const Shape& shape, const Viewpoint& from, double reach, std::vector<Constraint>& out) const;
  void add_edges(const Viewpoint& from, double reach, std::vector<Constraint>& out) const;
  void add_edge(std::size_t chain, const vo::OrcaHalfPlane& found, const Viewpoint& from,
                std::vector<Constraint>& out) const;
  void add_unguarded(const std::vector<std::size_t>& near, const Viewpoint& from, std::vector<Constraint>& out) const;

  static constexpr std::uint32_t kEnclosed = static_cast<std::uint32_t>(-1);

  double distance_within(const Viewpoint& from, double reach) const;
  geometry::Box window_of(const Viewpoint& from, const Need& need) const;
  double room_below(const geometry::Box& box, const Viewpoint& from) const;
  double room_of(vo::BodyTable::Number body, const Viewpoint& from, double enough) const;
  NearBody near_body(const Shape& shape) const;
  struct Sight;
  bool see(const NearBody& b, const Sight& sight, Candidate& out) const;
  double distance_of_room(const Viewpoint& from, double room) const;

  Scene* scene_;
  const DecisionRules* rules_;
  HorizonRule rule_;
  double margin_;
  std::vector<Shape> enclosures_;           ///< fitted for this robot; method ivo_edge has the scene's
  std::vector<std::uint32_t> tight_index_;  ///< of each piece of the scene, its number here; kEnclosed: an enclosure's
  bool is_small_ = false;
  std::vector<Shape> all_;  ///< of a small field
};

template <class Visit>
void StaticField::for_each_shape(const Visit& visit) const {
  for (std::size_t k = 0; rules_->method == Method::ivo_edge && k < scene_->facade_ellipses_by_place().size(); ++k)
    visit(Shape{scene_->facade_ellipse(k), k, geometry::EnclosureGrade::containing});
  for (const Shape& e : enclosures_) visit(e);
  for (std::size_t k = 0; k < tight_index_.size(); ++k)
    if (tight_index_[k] != kEnclosed) visit(Shape{scene_->piece(k), tight_index_[k], geometry::EnclosureGrade::tight});
}

template <class Visit>
void StaticField::for_each_shape_within(Vec2 x, double reach, const Visit& visit) const {
  if (is_small_) {
    for (const Shape& s : all_)
      if (geometry::distance_below(scene_->bodies().box(s.body), x) <= reach) visit(s);
    return;
  }
  if (rules_->method == Method::ivo_edge) {
    scene_->facade_ellipses_by_place().for_each_within(x, reach, [&](std::size_t k) {
      visit(Shape{scene_->facade_ellipse(k), k, geometry::EnclosureGrade::containing});
    });
    return;
  }
  for (const Shape& e : enclosures_)
    if (geometry::distance_below(scene_->bodies().box(e.body), x) <= reach) visit(e);
  scene_->pieces_by_place().for_each_within(x, reach, [&](std::size_t k) {
    if (tight_index_[k] != kEnclosed) visit(Shape{scene_->piece(k), tight_index_[k], geometry::EnclosureGrade::tight});
  });
}

template <class Visit>
void StaticField::for_each_piece_of(const Shape& shape, const Visit& visit) const {
  std::size_t number = 0;
  for (const std::size_t obstacle : scene_->bodies()[shape.body].owners)
    for (std::size_t k = scene_->first_piece(obstacle); k < scene_->first_piece(obstacle + 1); ++k)
      visit(Shape{scene_->piece(k), shape.index, geometry::EnclosureGrade::tight, ++number});
}

}  // namespace exactvo::formation::detail
