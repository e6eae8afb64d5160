// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The page of `exactvo view`: one HTML file with its program, its style and its runs, which needs no network. Its
/// sources are in page/; cmake/EmbedExplorer.cmake joins them and puts them into the program.
///
/// See also: packed_run.h (how a run stands in it).

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "exactvo/formation/simulation.h"
#include "explorer/packed_run.h"

namespace exactvo::tools {

/// A run of a page. Title and words are shown as text, whatever they hold.
struct PageRun {
  std::string key;          ///< in the page's address: letters, digits, '-', '.' and '_' only
  std::string title;        ///< in the list of runs
  std::string description;  ///< what to look at, a few sentences; may be empty
  std::string packed;       ///< RunPacker::finish
};

/// A run with how it was made: what a run on from one of its moments is made with. Nothing for a recording of a crowd,
/// which has neither goals nor decisions to go on from.
struct MadeRun {
  PageRun shown;
  std::optional<formation::SimulationOptions> options;
};

/// Scenario, method, controller and guidance, as far as there are any.
std::string title_of(const datasets::RecordingFile& file);

/// A recording under its title. `metrics_json` as datasets::metrics_json writes it; empty where there is none.
PageRun recorded_run(const datasets::RecordingFile& file, const std::string& metrics_json, PackedRunLimits limits = {});

/// Puts a number behind key and title where the key is among `taken`.
void make_key_distinct(PageRun& run, const std::set<std::string>& taken);

/// Whole. `is_guide`: the runs are scenes to start from, listed with their words, rather than the user's own.
std::string explorer_page(const std::vector<PageRun>& runs, bool is_guide = false);

/// Bytes as text of 64 characters (RFC 4648).
std::string base64(const std::string& bytes);

/// The page's name beside other output.
inline constexpr const char* kPageName = "explorer.html";

/// `text` as a key: other characters become '-'.
std::string page_key(const std::string& text);

/// The page without runs, with __RUNS__ where they go. Made by cmake/EmbedExplorer.cmake.
extern const char* const kExplorerShell;
/// What asks a server, for the pages that one gives out (server.h). Made with it.
extern const char* const kServedScript;

}  // namespace exactvo::tools
