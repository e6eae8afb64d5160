// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What `exactvo vo` answers, as JSON, in words and drawn.
///
/// The unrounded answers (exact_answer.cpp): free velocities (--free), and why there are none to show where an ellipse
/// takes part, where the curves are too many, and in contact; the algebraic legs (--exact-legs).

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/vo/algebraic_direction.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/containment.h"
#include "exactvo/vo/free_arrangement.h"
#include "exactvo/vo/free_velocities.h"
#include "figures/figure.h"
#include "support/json_layout.h"
#include "verbs/vo/question.h"

namespace exactvo::tools {

struct ExactFree {
  std::optional<vo::FreeArrangement> free;
  std::optional<bool> region_inside;  ///< whether all that the half-planes keep is free; without half-planes nothing
  std::string why_not;                ///< where `free` is nothing
};

/// The cones are those of the question's encounters. `half_planes` is null where a cone has none.
ExactFree exact_free_of(const std::vector<vo::ShiftedCone>& cones, const VoQuestion& question,
                        const std::vector<geometry::HalfPlane>* half_planes);

/// Null where there is none.
OrderedJson exact_free_json(const ExactFree& exact, const VoQuestion& question);

/// One line or two.
std::string exact_free_words(const ExactFree& exact);

/// Two objects with `side`, `polynomial`, `slope`, `quarter_turns`, `direction`.
OrderedJson exact_legs_json(const vo::ExactLegs& legs);

std::string exact_legs_words(const vo::ExactLegs& legs);

/// About one obstacle. Velocities are absolute; the cone is for velocities relative to the obstacle's.
struct ConeAnswer {
  vo::Encounter encounter;
  vo::VelocityObstacle cone;
  bool overlaps = false;
  bool contains = false;
  std::optional<vo::NearestBoundary> nearest;
  std::optional<geometry::HalfPlane> half_plane;  ///< with responsibility 1: it holds whatever the obstacle's side does
  std::optional<geometry::HalfPlane>
      shared;  ///< with the asked responsibility < 1: holds only if the other side does its part
  std::optional<geometry::HalfPlane> contact;  ///< away from the nearest point, where there is no other
  std::optional<vo::Certificate> certificate;  ///< of `half_plane`, or of `contact`
  std::optional<vo::ExactLegs> exact_legs;     ///< where they are asked for, and there is a cone
};

/// About all of them. Nothing is compared with half-planes where a cone has none.
struct FreeAnswer {
  vo::FreeVelocities free;
  double max_speed = 0.0;
  std::vector<geometry::HalfPlane> half_planes;
  std::vector<std::size_t> cone_of;  ///< of each half-plane
  std::optional<vo::RegionReport> report;
  ExactFree exact;
};

/// Whether the ellipse round an obstacle contains it: asked of every vertex by the exact predicate.
struct Enclosed {
  std::size_t vertices = 0;
  std::size_t contained = 0;
  std::optional<vo::Containment> certificate;  ///< of the vertices; nothing for a flat ellipse
};
std::optional<Enclosed> enclosed_of(const VoQuestion& question, const AskedObstacle& obstacle);

struct VoAnswer {
  VoQuestion question;
  std::vector<ConeAnswer> cones;
  std::vector<vo::Member> members;  ///< the variants asked for
  std::optional<FreeAnswer> free;
};

VoAnswer answer_of(const VoQuestion& question);

/// The exact legs counter-clockwise from just after (-1, 0) on, which is itself the last; groups of equal ones: which
/// cones share a leg.
OrderedJson legs_by_angle_json(const VoAnswer& answer);

bool any_overlaps(const VoAnswer& answer);
bool any_contains(const VoAnswer& answer);

/// What a rule says of a velocity (`Member::allows`): "allows", "forbids" or "no cone".
const char* word_of_allowed(const std::optional<bool>& allowed);

/// Why there is no certificate: "contact" or "rounding"; nothing where there is one.
const char* why_no_certificate(const ConeAnswer& answer);

/// Whose half-plane excludes the piece.
Place place_of(const VoAnswer& answer, const vo::LostPiece& piece);

/// "its 3 convex pieces", "the smallest ellipse round it".
std::string in_words(const AskedObstacle& obstacle);

std::string to_json(const VoAnswer& answer);
std::string in_words(const VoAnswer& answer);
/// One cone with its half-plane; or the family side by side; or the free velocities.
Figure vo_figure(const VoAnswer& answer);

}  // namespace exactvo::tools
