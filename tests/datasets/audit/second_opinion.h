// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether a recording is true and safe, by a program that shares nothing with the audit but plain types: it reads the
/// lines itself, tries out times, places and velocities in doubles, and multiplies out in rationals of its own what is
/// claimed to hold exactly. What it finds wrong is wrong; it may overlook what is wrong by less than its tolerances.

#include <string>

#include "audit/edits.h"

namespace exactvo::datasets::test {

/// What is wrong with it as a recording of the scenario that `original` was made of; empty where nothing is. Says
/// nothing of words that prove nothing (mode, side, note, outcome and the like).
std::string second_opinion(const Lines& lines, const Lines& original);

}  // namespace exactvo::datasets::test
