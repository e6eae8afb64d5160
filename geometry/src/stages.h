// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Counts which stage of a predicate answered. A counter a thread, since a shared one would cost more than the filters.

namespace exactvo::geometry::detail {

void count_filter();
void count_exact();

}  // namespace exactvo::geometry::detail
