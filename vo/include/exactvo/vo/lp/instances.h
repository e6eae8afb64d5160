// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Instance sets by name and seed, the same on every machine, and the binary file they travel in. Every bench and every
/// accuracy test draws on these (docs/guide/linear-program.md).
///
/// - RFm: random feasible, m soft lines around a witness in a disc of 0.9 v_max, slack U(0, 1.5)
/// - RIm: random infeasible, three soft lines 120 degrees +- 0.35 rad apart exclude a centre by U(0.05, 0.5)
/// - parallel:E: neighbours tilted by E against each other
/// - corridor:E: antiparallel lines with a gap of +-E
/// - through:E: lines that pass v_pref at a distance of +-E
/// - tangent:E: lines that miss or touch the speed disc by +-E
/// - concurrent:E: three lines through a point, up to +-E
/// - far:E: as corridor, the offsets taken from points 100 m/s away along the line
///
/// The last six are the adversarial families: ten lines, of which the first two or three are as said and the rest
/// random.

#include <cstdint>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

/// Problems number first .. first + count - 1 of a set. Problem k depends on the name, the seed and k alone.
/// A std::logic_error names a set that does not exist.
std::vector<Problem> generate(const std::string& set, std::size_t count, std::uint64_t seed, std::size_t first = 0);

/// The families of adversarial problems, without their ":E".
std::vector<std::string> adversarial_families();

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

/// Hard lines come first in the file, otherwise in order. Rounds to float. REQUIRES: a disc and no box.
void write_instances(std::ostream& out, const std::vector<Problem>& problems);

}  // namespace exactvo::lp
