// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Proves a recording again, in rationals (GMP) and with none of the filters that made it: every certified half-plane
/// of an obstacle excludes the interior of its obstacle's velocity obstacle (vo/certificate.h), and every straight way
/// from one row to the next kept clear of obstacles and of the other robots' straight ways. Exact.
///
/// A robot's reciprocal half-plane promises nothing alone and is not counted. Where a run did not move in straight
/// lines (`formation::MotionLaw`), the straight way between two rows is still what is audited. Not asked: whether a
/// half-plane is of the scenario's obstacles and robots, whether any is missing, whether a choice keeps them and leads
/// to the next row. The seal has no key: it shows damage, not forgery.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::datasets {

struct AuditReport {
  std::size_t half_planes = 0;        ///< certified ones of obstacles
  std::size_t unsafe = 0;             ///< of these, not disjoint from the interior
  std::size_t steps = 0;              ///< a robot's way from one row to the next
  std::size_t collisions = 0;         ///< of these, nearer to an obstacle or another robot than the radii allow
  std::size_t inconsistencies = 0;    ///< rows that do not follow one another, a seal that does not fit the rows
  std::vector<std::string> findings;  ///< the first of each kind, in words; at most kMostFindings

  bool clean() const { return unsafe == 0 && collisions == 0 && inconsistencies == 0; }
};
inline constexpr std::size_t kMostFindings = 20;

/// REQUIRES: a recording that read_recording gave, or one like it.
AuditReport audit(const RecordingFile& file);

/// The same for a file, with its seal: the digest of its rows in its header (recording_file.h), so that a row that was
/// altered in a way that is still safe, an ulp inward, is found too. Throws DataError where it can't be read.
AuditReport audit_recording(const std::filesystem::path& path);

/// Counts added up, findings joined.
void add(AuditReport& sum, const AuditReport& other);

/// One JSON object: `half_planes`, `unsafe`, `steps`, `collisions`, `inconsistencies`, `findings`.
std::string to_json(const AuditReport& report);

}  // namespace exactvo::datasets
