// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Factors that bound roundings.

namespace exactvo::formation::monitored {

/// More than the few roundings of a formula of quotients and roots.
inline constexpr double kDown = 1.0 - 0x1p-48, kUp = 1.0 + 0x1p-48;

}  // namespace exactvo::formation::monitored
