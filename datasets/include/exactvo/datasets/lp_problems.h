// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Problems of the linear program from files: lines of JSON, CSV, or the binary instance file (vo/lp/instances.h).
///
///   {"bound": {"disc": 2, "box": [1, 1]}, "preferred": [1, 0], "objective": "nearest",
///    "constraints": [{"normal": [1, 0], "offset": 0.5, "priority": "soft", "label": 3}]}
///
/// `bound`, `disc`, `box`, `objective`, `priority` ("hard") and `label` (-1) may be left out; null in `box` leaves a
/// coordinate unbounded. A line is held against
/// the published schema, datasets/schema/lp.schema.json: an unknown key, a number beyond 1e90 and the like are refused
/// with the line and the JSON pointer of what is wrong, as in scenarios.
///
/// CSV has a row per half-plane, and a header with the columns problem, disc (may be empty), preferred_x, preferred_y,
/// normal_x, normal_y, offset and, where wanted, priority, in any order. Rows with the same `problem` that follow each
/// other are one problem; a problem without half-planes has one row with empty fields.

#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/vo/lp/problem.h"

namespace exactvo::datasets {

/// Blank lines are skipped. Throws DataError, E_FORMAT_UNKNOWN where the bytes are none of these, or nothing but blank;
/// `file_name` is used in its words. Every problem returned passes lp::require_well_formed. `names`, where given,
/// becomes what CSV calls each of them; empty for the other formats, which have no names.
std::vector<lp::Problem> parse_lp_problems(const std::string& bytes, const std::string& file_name,
                                           std::vector<std::string>* names = nullptr);

/// The JSON Schema that a line is held against.
const std::string& lp_schema();

}  // namespace exactvo::datasets
