// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Section V of the paper: every scenario, every method and controller, and the figures.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::tools {

struct SectionFiveOptions {
  std::filesystem::path scenarios;        ///< the folder that holds A1.json and so on
  std::vector<std::string> command_line;  ///< for provenance
  std::uint64_t seed = 0;                 ///< for provenance
  bool no_figures = false;
};

/// Runs all, writes summary.json, figures/ and explorer.html into `out`, and returns
/// the summary.
std::string run_section_five(const SectionFiveOptions& options, const std::filesystem::path& out);

}  // namespace exactvo::tools
