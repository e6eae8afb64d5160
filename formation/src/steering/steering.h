// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Turning a preferred velocity so that static obstacles don't stop the robot: boost, side commitment, following after
/// a stall. None of it touches safety: whatever comes out goes through the half-planes.
///
/// Heuristic: may follow the longer side. Deterministic: ties go left.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "decision/needed_constraints.h"
#include "scene/static_field.h"

namespace exactvo::formation::detail {

/// The first direction at `start` or beyond, turning towards `side` (+1 left, -1 right), in which a velocity of `speed`
/// satisfies every static half-plane.
struct Sweep {
  Vec2 velocity;             ///< m/s
  double rotation = 0.0;     ///< rad, >= 0
  std::size_t last = kNone;  ///< the body of the constraint that stopped the turn last
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
};
std::optional<Sweep> sweep(const std::vector<Constraint>& lines, Vec2 start, double side, double speed);

/// Whether v violates a static half-plane.
bool blocked(const std::vector<Constraint>& lines, Vec2 v);

/// Boost: v turned at its own speed onto the tangent of the static half-plane it violates most, where that one's
/// enclosure is certified trap-free; nothing otherwise.
std::optional<Vec2> boosted(const std::vector<Constraint>& lines, Vec2 v);

/// rad: a preference that meets its most violated half-plane this nearly head-on is a tie between the sides.
inline constexpr double kTieAngle = 1e-3;

/// Ties go left: v turned left by `kTieAngle` where it meets the static half-plane it violates most within that angle
/// of head-on; v itself otherwise. Without it a robot in exact symmetry balances on an unstable point for ever.
///
/// What it costs the theorem of equation (12): the optimum w over a convex set that holds 0 has w.v >= |w|^2, so with
/// v straight for the goal |p - g| never grows. With v turned by e = kTieAngle it grows by at most
/// |w| sin e - |w|^2 / (2 |v|) <= |v| e^2 / 2, that is 1.5e-6 m/s at 3 m/s, and only while the tie lasts.
Vec2 with_tie_broken(const std::vector<Constraint>& lines, Vec2 v);

/// The same for one half-plane, given by its normal of any length. REQUIRES: v violates it.
Vec2 with_tie_broken(Vec2 normal, Vec2 v);

/// m: `Situation::reach` of a robot that is kept `margin` (m) from obstacles. Beyond that margin a half-plane stops
/// full speed within the least horizon; nearer than the margin the robot does not come.
double following_reach(const DecisionRules& rules, double max_speed);

/// Follows a boundary after a stall: state of one robot. The side is the one on which a trial run of the static scene
/// leaves the boundary with the shorter way to go; ties go left.
class BoundaryFollower {
 public:
  /// What began or ended, for the row's note.
  struct Note {
    enum class What { nothing, left, follows, circled };
    What what = What::nothing;
    // Where it follows:
    bool is_left = false;  ///< the side taken
    double taken = 0.0;    ///< s, to go that way; infinite where that has no end
    double other = 0.0;    ///< s, to go the other way, or what that takes at least
    bool other_is_at_least = false;
    /// Appends it in words.
    void add_to(std::string& note) const;
  };

  struct Answer {
    Vec2 preferred;
    Mode mode = Mode::direct;
    int side = 0;
    Note note = {};
  };

  /// What one robot's steering leaves to the next one's, so that it allocates nothing.
  struct Memory {
    NearConstraints near, on_left, on_right;
    void reserve(std::size_t bodies) {
      for (NearConstraints* some : {&near, &on_left, &on_right}) some->reserve(bodies);
    }
  };

  struct Situation {
    double time = 0.0;       ///< s
    double time_step = 0.0;  ///< s
    double moment = 1.0;     ///< s, `detail::moment`
    Viewpoint robot;         ///< where it is
    Vec2 goal;               ///< m
    /// m: shapes farther than this neither stop the robot nor are followed. A far shape's half-plane grazes every fast
    /// velocity towards it (tau = dist / |v|); only near ones block. More than the margin, at which the robot stops.
    double reach = 0.0;
    Vec2 preferred;  ///< m/s, straight for the goal
    const StaticField* field = nullptr;
  };
  Answer steer(const Situation& s, Memory& memory);

  /// A new goal: whatever was followed is forgotten.
  void reset();

  /// Whether it has come back to where it began to follow without a way to leave: it goes on circling.
  bool circled() const { return circled_; }

 private:
  class TrialRun;

  bool stalled(const Situation& s);
  Answer begin(const Situation& s, Memory& memory);
  Answer follow(const Situation& s, NearConstraints& near);
  void commit(const Situation& s, int side, std::size_t followed);
  bool may_leave(const Situation& s, NearConstraints& near) const;

  bool following_ = false;
  int side_ = 0;
  double hit_distance_ = 0.0;  ///< m, to the goal, where following began
  Vec2 hit_;                   ///< m
  double walked_ = 0.0;        ///< m since then
  Vec2 last_position_;
  bool circled_ = false;
  std::size_t followed_ = 0;     ///< the shape whose boundary is followed
  double best_distance_ = -1.0;  ///< m, least to the goal so far
  double best_time_ = 0.0;       ///< s, when that was first reached with a margin
};

/// Appends a note to those that a row has.
inline void add_note(std::string& notes, std::string_view note) {
  if (!notes.empty() && !note.empty()) notes += "; ";
  notes += note;
}

/// Chooses a side when blocked and keeps it while blocked (formations).
class SideCommitment {
 public:
  struct Answer {
    Vec2 preferred;
    int side = 0;
    std::string note;  ///< when a side is chosen or given up
  };
  Answer steer(Vec2 preferred, double speed, NeededConstraints& statics);

 private:
  int side_ = 0;
};

}  // namespace exactvo::formation::detail
