// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo draw: the figures of a recorded run.
#include <fmt/format.h>

#include <memory>

#include "exactvo/datasets/recording_file.h"
#include "support/files.h"
#include "support/run.h"
#include "support/run_recorder.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "verb.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

struct Flags {
  std::string recording;
  std::string out;
};

/// Of a long run those that `simulate` would have shown.
void keep_shown_rows(datasets::RecordingFile& file) {
  ShownRows shown;
  const std::vector<formation::LyapunovRow>& lyapunov = file.lyapunov;
  for (std::size_t k = 0; k < file.recording.steps.size(); ++k)
    shown.add(file.recording.steps[k], k < lyapunov.size() ? &lyapunov[k] : nullptr);
  shown.move_to(file);
}

ExitCode draw_figures(const Flags& flags) {
  const fs::path recording = recording_at(flags.recording).value_or(flags.recording);
  const fs::path out = flags.out.empty() ? recording.parent_path() / "figures" : fs::path(flags.out);
  if (!flags.out.empty()) check_output_folder(out);
  const EndsAtOnce nothing_is_published;
  datasets::RecordingFile file = datasets::read_recording(recording);
  keep_shown_rows(file);
  StagedFolder folder(out);
  draw(write_figures(file, folder.path()));
  if (interrupted()) throw Interrupted();
  folder.publish();
  message("wrote " + out.string());
  return ExitCode::success;
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("recording", flags->recording, "recording.jsonl, or the folder of a run")->required();
  declare_out(app, flags->out, "Folder for the figures; by default figures/ beside the recording");
  return [flags] { return draw_figures(*flags); };
}

}  // namespace

Verb draw_verb() {
  return {"draw", "Draw the figures of a recorded run",
          "  exactvo simulate datasets/data/paper/A2.json --no-figures --out out/A2\n"
          "  exactvo draw out/A2\n",
          declare};
}

}  // namespace exactvo::tools
