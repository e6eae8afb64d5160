// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo draw: the figures of a recorded run.
#include <fmt/format.h>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/recording_file.h"
#include "support/files.h"
#include "support/run.h"
#include "support/run_recorder.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/runs/simulate_crowd.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

struct DrawFlags {
  std::string recording;
  std::string out;
};

/// With the rows of a long run that `simulate` would have shown; no others are kept.
datasets::RecordingFile read_shown(const fs::path& recording) {
  ProgressLine line(0.0, "");
  line.say("reading " + recording.string());
  ShownRows shown;
  datasets::RecordingFile file =
      datasets::read_recording(recording, [&](const datasets::RecordingFile&, const formation::Step& row,
                                              const formation::LyapunovRow* lyapunov) { shown.add(row, lyapunov); });
  shown.move_to(file);
  return file;
}

/// figures/ beside the recording, unless --out names another folder.
fs::path folder_for(const DrawFlags& flags, const fs::path& recording) {
  if (!flags.out.empty()) return flags.out;
  std::error_code unknown;
  const std::string name = recording.string();
  const bool is_device = name.rfind("/dev/", 0) == 0 || name.rfind("/proc/", 0) == 0;
  if (is_device || (fs::exists(recording, unknown) && !fs::is_regular_file(recording, unknown)))
    throw lacking("draw " + recording.string(), "--out FOLDER", "a pipe has no folder for the figures");
  return recording.parent_path() / "figures";
}

ExitCode draw_figures(const DrawFlags& flags) {
  const fs::path recording = recording_at(flags.recording).value_or(flags.recording);
  const fs::path out = folder_for(flags, recording);
  check_figure_folder(out);
  StagedFolder folder(out);
  bool is_cut_off = false;
  {
    const TerminateOnSignal terminate_on_signal;
    if (datasets::is_crowd_recording(recording))
      is_cut_off = draw_crowd_figures(recording, folder.path());
    else
      draw_figures_of(read_shown(recording), folder.path());
  }
  if (interrupted()) throw Interrupted();
  folder.publish();
  message("wrote " + out.string());
  if (!is_cut_off) return ExitCode::success;
  message(recording.string() + ": the file was cut off after the last of the rows drawn");
  return ExitCode::negative;
}

void declare_draw(CLI::App& app, DrawFlags& flags) {
  app.add_option("recording", flags.recording, "recording.jsonl, the folder of a run, or a crowd's FILE.evr")
      ->required();
  declare_out(app, flags.out, "Folder for the figures; by default figures/ next to the recording");
}

}  // namespace

Verb draw_verb() {
  return {"draw", "Draw the figures of a recorded run",
          "  exactvo simulate datasets/data/paper/A2.json --no-figures --out out/A2\n"
          "  exactvo draw out/A2\n"
          "  exactvo draw out/crowd.evr --out out/crowd_figures\n",
          with_flags(declare_draw, draw_figures)};
}

}  // namespace exactvo::tools
