// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What `exactvo vo` answers, as JSON, in words and drawn.
///
/// The unrounded answers: free velocities (--free), and why there are none to show where an ellipse
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

struct VoAnswer {
  VoQuestion question;
  std::vector<ConeAnswer> cones;
  std::optional<FreeAnswer> free;
};

VoAnswer answer_of(const VoQuestion& question);

std::string to_json(const VoAnswer& answer);
std::string in_words(const VoAnswer& answer);
/// One cone with its half-plane, or the free velocities.
Figure vo_figure(const VoAnswer& answer);

}  // namespace exactvo::tools
