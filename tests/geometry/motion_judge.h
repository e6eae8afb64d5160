// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The library's answers about bodies in motion against the oracle's, with the count of what was judged.

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/motion_case.h"

namespace exactvo::test {

struct MotionCampaign {
  std::size_t cases = 0, clear = 0, contact = 0, overlap = 0;
  std::size_t apart_in_time = 0;            ///< of the clear ones: nothing had to be decided
  std::size_t clearances = 0, moments = 0;  ///< bounds that were judged
  std::size_t loose = 0;                    ///< bounds wider than promised
  std::uint64_t by_filter = 0, exactly = 0;
  std::vector<std::string> failures;

  /// Counts a case by what is expected.
  void count(geometry::Encounter expected);
  MotionCampaign& operator+=(const MotionCampaign& other);
  std::string summary() const;
};

/// "clear", "contact", "overlap".
const char* word(geometry::Encounter encounter);

/// Judges `count` cases of a seed, one after the other; every `each`th in full.
template <class Case, class Judge>
MotionCampaign judge_cases(const Case& next_case, std::size_t count, std::uint64_t seed, std::size_t each,
                           const Judge& judge) {
  SeededRandom random(seed);
  MotionCampaign campaign;
  for (std::size_t i = 0; i < count; ++i) judge(next_case(random), campaign, i % each == 0);
  return campaign;
}

/// The case's verdict, clearance and moments, or the verdict alone; what is wrong is added to the failures, with the
/// case's line.
void judge_motion(const MotionCase& c, MotionCampaign& campaign, bool bounds_too = true);

/// `count` random and constructed cases of a kind; the bounds of one in `bounds_of_each`.
MotionCampaign judge_motions(MotionKind kind, std::size_t count, std::uint64_t seed, std::size_t bounds_of_each);

}  // namespace exactvo::test
