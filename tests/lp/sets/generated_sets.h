// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Sets of problems by name and seed, the same on every machine. Every bench and every accuracy test of the linear
/// program draws on these (docs/guide/linear-program.md).
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
#include <string>
#include <vector>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

/// Problems number first .. first + count - 1 of a set. Problem k depends on the name, the seed and k alone.
/// A std::logic_error names a set that does not exist.
std::vector<Problem> generate(const std::string& set, std::size_t count, std::uint64_t seed, std::size_t first = 0);

/// The families of adversarial problems, without their ":E".
std::vector<std::string> adversarial_families();

/// The binary file of vo/lp/instances.h. Hard lines come first in it, otherwise in order. Rounds to float. REQUIRES: a
/// disc and no box.
void write_instances(std::ostream& out, const std::vector<Problem>& problems);

}  // namespace exactvo::lp
