// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Motions near the answer of the linear program that keep half-planes which the nearest one, by rounding, does not.

#include <cstdint>

#include "crowd/kinds.h"
#include "crowd/lines.h"

namespace exactvo::formation::crowd {

/// Whether a motion of (mx, my) lattice steps keeps all lines of lane 0. In double, where a line is off by at most
/// 2^-48 max_speed (m/s).
template <class T>
bool keeps(const KindTable<T>& table, const Answers<T>& in, double mx, double my, double max_speed);

/// Makes of (mx, my) the motion nearest to the answer, among those about it, that keeps all lines and is not faster
/// than max_speed (m/s); false, and no change, where there is none.
template <class T>
bool nudge(const KindTable<T>& table, const Answers<T>& in, double max_speed, std::int32_t& mx, std::int32_t& my);

}  // namespace exactvo::formation::crowd
