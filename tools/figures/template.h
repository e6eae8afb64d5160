// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The gnuplot scripts of the figures as files to edit: tools/figures/templates/NAME.gp, embedded in the program when
/// it is built. `@place@` in them stands for what the program fills in.

#include <map>
#include <string>

namespace exactvo::tools {

/// Texts by place.
using Filling = std::map<std::string, std::string>;

/// The text of every template by its name, without ".gp".
const std::map<std::string, std::string>& embedded_templates();

/// `text` with every `@place@` replaced once: what is filled in is not searched for places.
/// Throws std::logic_error where a place is not filled, or nothing has that place.
std::string filled_text(const std::string& text, const Filling& filling);

/// The same of the template `name`.
std::string filled(const std::string& name, const Filling& filling);

}  // namespace exactvo::tools
