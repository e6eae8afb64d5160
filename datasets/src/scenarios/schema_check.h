// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Holds a JSON value against a JSON Schema and says where it does not fit, what stood there and what should have.
/// Covers the keywords that our schemas use (type, enum, required, properties, additionalProperties: false, items,
/// oneOf, not, $ref into definitions, the bounds of numbers, strings and lists); a keyword beyond these is a
/// std::logic_error when it is met, never skipped. Verdicts agree with valijson's (tests compare them); the words
/// are why this is here.

#include <string>
#include <string_view>

#include "json/json_text.h"

namespace exactvo::datasets {

/// Throws DataError for the first misfit in the order of the text.
void check_against_schema(const Json& value, const Json& schema, const std::string& file_name);

/// The same by `scenario_rules()`.
void check_against_scenario_rules(const Json& value, const std::string& file_name);

/// `scenario_schema()` without its descriptions: the same verdicts in fewer words.
std::string_view scenario_rules();

}  // namespace exactvo::datasets
