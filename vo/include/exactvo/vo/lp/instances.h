// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The binary file that sets of problems travel in.

#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

/// A file that is not what it says: where, what was found, what was expected.
class InstanceError : public std::runtime_error {
 public:
  /// `what()` joins the three.
  InstanceError(std::string place, std::string found, std::string expected);
  const std::string place;     ///< where in the file
  const std::string found;     ///< what stands there
  const std::string expected;  ///< what should
};

/// The binary file (little endian): int32 count; then per instance int32 m, int32 m_hard (the first m_hard lines are
/// hard), float32 v_max, v_pref x, v_pref y, and m times float32 point x, point y, direction x, direction y; allowed is
/// the left side of the direction. The normal is the direction turned left, the offset normal . point rounded to
/// double. Throws InstanceError, also where bytes follow the last instance.
std::vector<Problem> read_instances(std::istream& in);

}  // namespace exactvo::lp
