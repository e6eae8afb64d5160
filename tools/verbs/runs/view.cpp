// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo view: runs as a page for a browser.
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "exactvo/datasets/atomic_file.h"
#include "support/run.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/runs/page_runs.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

struct ViewFlags {
  PageFlags page;
  std::string out;
};

/// Before any work: the page must not replace what it is made from.
void check_out(const ViewFlags& flags) {
  const fs::path out(flags.out);
  if (out.extension() != ".html" && out.extension() != ".htm")
    throw UsageError("--out", flags.out, "a name that ends in .html");
  std::error_code unknown;
  if (fs::is_directory(out, unknown)) throw UsageError("--out", flags.out, "a file, not a folder");
  for (const std::string& path : flags.page.runs) {
    const fs::path file = recording_at(path).value_or(path);
    if (fs::equivalent(file, out, unknown)) throw UsageError("--out", flags.out, "another file than the run's own");
  }
}

ExitCode view(const ViewFlags& flags) {
  check_out(flags);
  std::vector<PageRun> runs;
  for (MadeRun& made : page_runs(flags.page)) runs.push_back(std::move(made.shown));
  const std::string page = explorer_page(runs, flags.page.runs.empty());
  if (interrupted()) throw Interrupted();
  datasets::write_file_atomically(flags.out, page);
  message(
      fmt::format("wrote {} ({:.1f} MB): open it in a browser", flags.out, 1e-6 * static_cast<double>(page.size())));
  return ExitCode::success;
}

void declare_view(CLI::App& app, ViewFlags& flags) {
  declare_page_flags(app, flags.page, CLI::detail::expected_max_vector_size,
                     "Folders of runs, recordings (.jsonl, of crowds .evr), or scenarios, which are run with every "
                     "half-plane; none: three scenes to start from");
  declare_out(app, flags.out, "The page: one file, FILE.html, that needs no network")->required();
}

}  // namespace

Verb view_verb() {
  return {"view", "Make a page to explore runs in a browser: the world, velocity space, the proofs",
          "  exactvo view --out start.html\n"
          "  exactvo simulate datasets/data/paper/A7.json --record-all --out out/A7\n"
          "  exactvo view out/A7 --out a7.html\n"
          "  exactvo view datasets/data/paper/A1.json --method orca --out a1.html\n",
          with_flags(declare_view, view)};
}

}  // namespace exactvo::tools
