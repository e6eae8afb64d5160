// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What `exactvo vo` answers, as JSON and in words.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/vo/certificate.h"
#include "exactvo/vo/free_velocities.h"
#include "verbs/vo_question.h"

namespace exactvo::tools {

/// About one obstacle. Velocities are absolute; the cone is for velocities relative to the obstacle's.
struct ConeAnswer {
  vo::Encounter encounter;
  vo::VelocityObstacle cone;
  bool overlaps = false;
  bool contains = false;
  std::optional<vo::NearestBoundary> nearest;
  std::optional<geometry::HalfPlane> half_plane;  ///< with the asked alpha
  std::optional<geometry::HalfPlane> full;        ///< with alpha = 1, which is what is certified
  std::optional<vo::Certificate> certificate;
};

ConeAnswer answer_of(const vo::Encounter& encounter, double alpha);

/// About all of them.
struct FreeAnswer {
  vo::FreeVelocities free;
  double max_speed = 0.0;
  std::vector<geometry::HalfPlane> half_planes;
  std::vector<std::size_t> obstacle_of;  ///< of each half-plane
  vo::RegionReport report;
};

FreeAnswer free_answer_of(const std::vector<ConeAnswer>& cones, const VoQuestion& question);

struct VoAnswer {
  VoQuestion question;
  std::vector<ConeAnswer> cones;
  std::vector<vo::Member> members;  ///< the variants asked for
  std::optional<FreeAnswer> free;
};

VoAnswer answer_of(const VoQuestion& question);

std::string to_json(const VoAnswer& answer);
std::string in_words(const VoAnswer& answer);

}  // namespace exactvo::tools
