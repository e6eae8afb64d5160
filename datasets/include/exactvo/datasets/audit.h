// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Verifies a recording in exact rational arithmetic (GMP), with none of the filters that made it and sharing no code
/// with the run but plain types:
///  (1) every certified half-plane of an obstacle excludes the interior of its obstacle's velocity obstacle
///      (vo/certificate.h);
///  (2) every motion from one row to the next keeps clear of obstacles, of moving obstacles where they are meanwhile
///      (round the corners of their paths and through the changes of their speed), and of the other robots;
///  (3) rows are a time step apart, and follow from one another by the law of motion up to rounding: x + T v of
///  straight
///      motions, v' = -k3 (v - w) in closed form.
///
/// The motion of (2) is the one that was driven (`formation::MotionLaw`): straight, the exponential curve, or the cubic
/// through both rows. Curves are cut into chords with a proven bound of how far they stray, finer and finer until each
/// is proven clear or a collision is. Straight motions and those of obstacles whose legs have rational lengths are
/// decided exactly; elsewhere what touches to within some 1e-7 of its bulge may be neither, and is `unproven`.
///
/// A robot's reciprocal half-plane promises nothing alone and is not counted. `not_audited` lists what is not asked.
/// The seal has no key: it shows damage, not forgery.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::datasets {

struct AuditReport {
  std::size_t half_planes = 0;        ///< certified ones of obstacles
  std::size_t unsafe = 0;             ///< of these, not disjoint from the interior
  std::size_t steps = 0;              ///< a robot's motion from one row to the next
  std::size_t collisions = 0;         ///< of these, nearer to an obstacle or another robot than the radii allow
  std::size_t unproven = 0;           ///< of these, neither a collision nor proven to be none
  std::size_t inconsistencies = 0;    ///< rows that do not follow one another, a seal that does not fit the rows
  std::vector<std::string> findings;  ///< the first of each kind, in words; at most kMostAuditFindings

  std::size_t curved_steps = 0;        ///< of the steps, those that were not driven in a straight line
  std::size_t obstacle_questions = 0;  ///< pairs of a step and an obstacle, a moving obstacle, another robot
  std::size_t moving_questions = 0;
  std::size_t robot_questions = 0;
  double largest_bulge = 0.0;  ///< m: no curve strays farther from the straight way between its rows

  bool clean() const { return unsafe == 0 && collisions == 0 && unproven == 0 && inconsistencies == 0; }
};
inline constexpr std::size_t kMostAuditFindings = 20;

/// REQUIRES: a recording that read_recording gave, or one like it.
AuditReport audit(const RecordingFile& file);

/// The same for a file, with its seal: the digest of all lines in the last one (recording_file.h), so that a row that was
/// altered in a way that is still safe, an ulp inward, is found too. Throws DataError where it can't be read.
AuditReport audit_recording(const std::filesystem::path& path);

/// Counts added up, findings joined.
void add(AuditReport& sum, const AuditReport& other);

/// What no audit of a recording asks, a sentence each.
const std::vector<std::string>& not_audited();

/// One JSON object: `half_planes`, `unsafe`, `steps`, `collisions`, `unproven`, `inconsistencies`, `proved` (how much
/// of what was proven), `not_audited`, `findings`.
std::string to_json(const AuditReport& report);

}  // namespace exactvo::datasets
