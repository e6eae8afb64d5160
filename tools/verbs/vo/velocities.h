// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Many velocities against the obstacles of one question (`exactvo vo --velocities`): a line of the answer for each
/// line of the input, in memory that does not grow with it. Exact.

#include <string>

#include "verbs/vo/question.h"

namespace exactvo::tools {

/// `file`: two numbers a line, "vx,vy" or "vx vy"; CSV with a first line that names columns `vx` and `vy`; JSON Lines,
/// [vx, vy] or {"velocity": [vx, vy]}. "-" is stdin. Blank lines, and those that begin with #, have no answer. Throws
/// DataError with the line that is wrong: before the first answer if `file` is a regular file, which is read twice;
/// otherwise, as a pipe is answered while it is read, with the number of answers that stand by then.
void answer_velocities(const VoQuestion& question, const std::string& file, bool json);

}  // namespace exactvo::tools
