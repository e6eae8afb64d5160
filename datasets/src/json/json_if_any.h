// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "json/json_text.h"

namespace exactvo::datasets {

/// For text that another parser has accepted: a discarded value where it is no JSON; repeated keys are no error, the
/// last one counts. A signal ends a long parse (the wait hook is called).
Json parse_json_if_any(std::string_view text);

}  // namespace exactvo::datasets
