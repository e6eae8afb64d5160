// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Half a turn, rad: the double nearest to pi.

namespace exactvo::geometry {

/// rad.
inline constexpr double kPi = 3.14159265358979323846;

}  // namespace exactvo::geometry
