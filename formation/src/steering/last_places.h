// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// Where robots are to stand in the end, m: their last goals, or where these are nearer to each other than radii and
/// margin take, places within their tolerance that are farther apart. Heuristic: what is too near to each other after
/// some rounds stays so. REQUIRES: robots with goals.
std::vector<Vec2> last_places(const Scenario& scenario);

/// Whether two robots that stand so far apart, m, leave each other less than radii and margin take.
bool leave_no_room(const Scenario& scenario, std::size_t i, std::size_t j, double apart);

}  // namespace exactvo::formation::detail
