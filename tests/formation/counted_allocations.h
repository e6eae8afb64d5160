// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace exactvo::test {

/// Calls of operator new in this program so far.
std::size_t allocations();

}  // namespace exactvo::test
