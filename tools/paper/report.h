// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The reproduction report: every equation, table and claim of the paper beside what was seen, from the files that the
/// runs left: summary.json and figures/ of Section V, random/random.json, ablations/ablations.json. Verdicts are
/// computed from those files; what was not run is said to be missing.

#include <filesystem>

#include "paper/document.h"
#include "paper/report_data.h"

namespace exactvo::tools {

/// Pictures are looked for in `folder`.
Document reproduction_report(const ReportData& data, const std::filesystem::path& folder);

/// report.html and report.md in `folder`, each whole or not at all.
void write_report(const ReportData& data, const std::filesystem::path& folder);

}  // namespace exactvo::tools
