// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Characters of figures that no font of this machine has: in PNG and PDF a box stands in their place.

#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::tools {

/// The characters in these scripts and in their data that no installed font has, in UTF-8, at most ten. None where the
/// fonts are not known, for lack of the program fc-list.
std::vector<std::string> characters_without_font(const std::vector<std::filesystem::path>& scripts);

}  // namespace exactvo::tools
