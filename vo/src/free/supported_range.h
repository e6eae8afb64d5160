// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether numbers as they were given are 0 or of a size from kLeastArrangedNumber to kMostArrangedNumber: towards the
/// ends of the doubles' range CORE's expressions take minutes or divide by an exponent that is none.

#include "exactvo/vo/free_arrangement.h"

namespace exactvo::vo::detail {

bool is_in_supported_range(double x);
bool is_in_supported_range(Vec2 v);
/// All numbers of the cone: obstacle, robot, horizon (which may be infinite) and apex.
bool is_in_supported_range(const ShiftedCone& cone);

}  // namespace exactvo::vo::detail
