// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Names for files on their way that no other process takes, be it of this machine or another on the same disk: process
/// numbers repeat from machine to machine.

#include <string>

namespace exactvo::datasets {

/// 16 hexadecimal digits from the system's source of randomness, other ones at each call. Goes into names of temporary
/// files only, never into a result.
std::string unique_word();

}  // namespace exactvo::datasets
