// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Problems and answers of `exactvo lp` as lines of JSON.
///
///   {"bound": {"disc": 2, "box": [1, 1]}, "preferred": [1, 0], "objective": "nearest",
///    "constraints": [{"normal": [1, 0], "offset": 0.5, "priority": "soft", "label": 3}]}
///
/// `bound`, `disc`, `box`, `objective`, `priority` ("hard") and `label` (-1) may be left out.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::tools {

/// Either the binary instance file (vo/lp/instances.h) or lines of JSON. Throws DataError; `file` is used in its words.
std::vector<lp::Problem> read_problems(const std::string& bytes, const std::string& file);

/// One result; numbers read back to the same doubles.
nlohmann::ordered_json result_line(std::size_t index, const lp::Proven& answer);

}  // namespace exactvo::tools
