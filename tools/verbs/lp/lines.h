// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Answers of `exactvo lp` as lines of JSON. Neighbours: datasets/lp_problems.h reads the problems.

#include <nlohmann/json.hpp>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::tools {

/// One result; numbers read back to the same doubles. `certificate` is null where there is none.
nlohmann::ordered_json result_line(std::size_t index, const lp::Proven& answer);

}  // namespace exactvo::tools
