// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the scenarios that come with the program are.

#include <filesystem>
#include <string>

namespace exactvo::tools {

/// `asked` where not empty; else the installed folder beside the program; else the one in the sources it was built
/// from. Throws UsageError where `name` (a folder in it) is in none of them.
std::filesystem::path data_folder(const std::string& asked, const std::string& name);

}  // namespace exactvo::tools
