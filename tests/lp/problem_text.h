// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A problem as lossless text, in the form that tests/corpus/lp/ holds.

#include <string>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

/// "disc D", "box X Y", "preferred X Y" or "farthest X Y", then "hard|soft NX NY C", one a line, numbers in hex.
std::string text_of(const Problem& problem);

}  // namespace exactvo::lp
