// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The static half-planes of one decision, built as far as it needs them: what is left out changes no bit of it, unless
/// three lines meet there up to rounding (obstacles that share an edge). Then it is optimal too, a rounding error away.

#include <vector>

#include "scene/static_field.h"

namespace exactvo::formation::detail {

/// Share of the largest speed: what is left out has this much room to spare, far above any rounding of a half-plane.
inline constexpr double kSpareRoom = 1e-3;

/// Whether v violates the half-plane beyond what counts as lying on its line.
bool violates(const geometry::HalfPlane& h, Vec2 v);

/// Grows on demand; each half-plane is the same bits as StaticField::constraints gives, in the same order.
class NeededConstraints {
 public:
  /// Room for this many half-planes.
  void reserve(std::size_t lines) {
    lines_.reserve(lines);
    meetings_.met.reserve(lines);
  }

  /// Begins with what lies within `reach` (m, from the rim), or with all where `field` bounds no room. `field` must
  /// outlive the questions.
  void look(const StaticField& field, const Viewpoint& from, double reach);

  /// Nearest first.
  const std::vector<Constraint>& lines() const { return lines_; }

  // What is asked for is there afterwards. True where half-planes were added.

  /// The one that v violates most, and any that it might violate as much; with a normal of unit length or as it is.
  bool need_at(Vec2 v);
  bool need_all();

 private:
  bool need_within(double reach) { return reach > have_.within && need({reach, have_.room}); }
  bool need(const Need& need);

  const StaticField* field_ = nullptr;
  Viewpoint from_;
  Need have_;
  bool has_all_ = false;
  StaticField::Meetings meetings_;
  std::vector<Constraint> lines_;
};

/// The static half-planes within reach, one after the other as a turning velocity meets them. Answers as if all were
/// there, nearest first.
class NearConstraints {
 public:
  /// Room for this many bodies.
  void reserve(std::size_t bodies) {
    bodies_.reserve(bodies);
    candidates_.reserve(bodies);
    lines_.reserve(bodies);
  }

  /// From here on of another robot or field.
  void forget() { gathered_reach_ = -1.0; }

  /// Begins anew. `field` must outlive the questions, and be the same one until `forget`; `reach` in m, from the rim.
  void look(const StaticField& field, const Viewpoint& from, double reach);

  /// The first that v violates, or null. Valid until the next question.
  const Constraint* first_violated(Vec2 v);
  bool any_violated(Vec2 v);
  /// That of a body, or null. Valid until the next question.
  const Constraint* of_body(vo::BodyTable::Number body);

 private:
  struct Asked;  ///< a velocity
  const Constraint* build(StaticField::Candidate& c);
  StaticField::Candidate* next_for(const Asked& asked, double nearer);

  const StaticField* field_ = nullptr;
  Viewpoint from_;
  double reach_ = 0.0;
  std::vector<StaticField::NearBody> bodies_;  ///< near `gathered_at_`
  Vec2 gathered_at_;
  double gathered_reach_ = -1.0;
  std::vector<StaticField::Candidate> candidates_;
  std::vector<Constraint> lines_;  ///< in the order in which they were built
};

}  // namespace exactvo::formation::detail
