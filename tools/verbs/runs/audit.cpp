// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo audit: verifies recordings in exact rational arithmetic.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/geometry/counted.h"
#include "support/certificates.h"
#include "support/run.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using geometry::counted;

namespace {

struct AuditFlags {
  std::string path;
  std::string certificates;
  std::string scenario;
  std::size_t sample = 0;
  bool json = false;
};

// --- Recordings ---

/// The file itself, or every recording.jsonl and recording of a crowd below the folder, in the order of their names.
std::vector<fs::path> recordings_in(const std::string& path) {
  refuse_part_of_run(path);
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    const fs::path& file = entry.path();
    if (entry.is_regular_file() && (file.filename() == "recording.jsonl" || datasets::is_crowd_recording(file)))
      found.push_back(file);
  }
  std::sort(found.begin(), found.end());
  if (found.empty()) throw UsageError("path", path, "a folder that contains a recording.jsonl or a crowd's FILE.evr");
  return found;
}

/// What is asked at each point, in words.
const char* words_of(datasets::AuditPoint point) {
  constexpr const char* kWords[] = {"the recording is of its scenario",
                                    "bodies contain the obstacles they stand for",
                                    "nothing within reach of a step lacks a half-plane",
                                    "half-planes exclude their velocity obstacles",
                                    "choices satisfy their half-planes and are the best",
                                    "rows follow from one another",
                                    "motions keep clear of everything",
                                    "joint plans begin where their robots are, and their moves are clear",
                                    "robots could brake in every row, alone and together",
                                    "wheels and headings follow from choices"};
  return kWords[static_cast<std::size_t>(point)];
}

std::string unlisted_lines(const datasets::AuditReport& report) {
  std::string text;
  for (std::size_t p = 0; p < datasets::kAuditPoints; ++p) {
    if (report.points[p].unlisted == 0) continue;
    text += fmt::format(
        "  ... and {} more findings of \"{}\" (each recording lists its first {} refuted and first {} open ones)\n",
        report.points[p].unlisted, words_of(static_cast<datasets::AuditPoint>(p)), datasets::kMostAuditFindings,
        datasets::kMostAuditFindings);
  }
  return text;
}

std::string summary(const datasets::AuditReport& report) {
  std::string text = report.cut_off.empty() ? "" : "a recording ends early: what follows is of the rows there are\n";
  for (std::size_t p = 0; p < datasets::kAuditPoints; ++p) {
    const datasets::PointCount& n = report.points[p];
    const bool is_rare = report.has_places || p >= static_cast<std::size_t>(datasets::AuditPoint::braking);
    if (is_rare && n.asked() == 0) continue;
    text += fmt::format("{}: {} asked, {} proven", words_of(static_cast<datasets::AuditPoint>(p)), n.asked(), n.proven);
    if (n.refuted > 0) text += fmt::format(", {} refuted", n.refuted);
    if (n.open > 0) text += fmt::format(", {} left open", n.open);
    text += "\n";
  }
  text += fmt::format("{} of obstacles, {} unsafe; {}, {}\n", counted(report.half_planes, "half-plane"), report.unsafe,
                      counted(report.steps, "step"), counted(report.collisions, "collision"));
  if (report.has_movers)
    text += fmt::format("robots that stood were hit in {}, which nothing promises against\n",
                        counted(report.hits_standing, "step"));
  for (const std::string& pair : report.started_overlapping) text += fmt::format("started in overlap: {}\n", pair);
  if (report.largest_violation > 0.0)
    text += fmt::format("largest violation of a half-plane: {:.3g} m/s\n", report.largest_violation);
  if (report.curved_steps > 0)
    text += fmt::format("curved steps: {}, up to {:.2g} m off the straight way; the curves were checked\n",
                        report.curved_steps, report.largest_bulge);
  for (const std::string& finding : report.findings) text += "  " + finding + "\n";
  text += unlisted_lines(report);
  text += "not audited:\n";
  for (const std::string& words : not_audited(report)) text += "  " + words + "\n";
  return text;
}

datasets::AuditReport audited(const AuditFlags& flags, const std::vector<fs::path>& files,
                              const formation::Scenario* scenario) {
  datasets::AuditReport all;
  for (const fs::path& file : files) {
    datasets::AuditReport report = datasets::audit_recording(file, scenario, flags.sample);
    for (std::string& finding : report.findings) finding = file.string() + ": " + finding;
    add(all, report);
    if (interrupted()) throw Interrupted();
  }
  return all;
}

ExitCode audit_recordings(const AuditFlags& flags) {
  std::optional<formation::Scenario> scenario;
  if (!flags.scenario.empty()) scenario = datasets::load_scenario(flags.scenario);
  const std::vector<fs::path> files = recordings_in(flags.path);
  const bool has_crowds = std::any_of(files.begin(), files.end(), datasets::is_crowd_recording);
  if (has_crowds && !flags.scenario.empty())
    throw UsageError("--scenario", flags.scenario, "a recording.jsonl to compare it with, not one of a crowd");
  if (!has_crowds && flags.sample > 0)
    throw UsageError("--sample", std::to_string(flags.sample), "a recording of a crowd, .evr");
  const datasets::AuditReport all = audited(flags, files, scenario ? &*scenario : nullptr);
  print(flags.json ? datasets::to_json(all) + "\n" : summary(all));
  for (const std::string& words : all.cut_off) error_message(words);
  if (all.fails()) return ExitCode::negative;
  return all.cut_off.empty() ? ExitCode::success : ExitCode::bad_input;
}

// --- Certificates ---

ExitCode audit_certificates(const AuditFlags& flags) {
  const CheckedCertificates checked = check_certificates(flags.certificates);
  const std::string text = flags.json ? to_json(checked) : in_words(checked);
  print(text);
  const bool all =
      std::all_of(checked.all.begin(), checked.all.end(), [](const CheckedCertificate& c) { return c.valid; });
  return all ? ExitCode::success : ExitCode::negative;
}

ExitCode audit(const AuditFlags& flags) {
  if (flags.path.empty() && flags.certificates.empty())
    throw lacking("audit", "a recording (or a folder of them), or --certificate FILE");
  refuse_both(!flags.path.empty() && !flags.certificates.empty(), "a path", "--certificate");
  refuse_both(!flags.certificates.empty() && !flags.scenario.empty(), "--scenario", "--certificate",
              "a scenario is compared with a recording");
  if (!flags.path.empty()) return audit_recordings(flags);
  if (flags.sample > 0) throw UsageError("--sample", std::to_string(flags.sample), "a recording of a crowd, .evr");
  return audit_certificates(flags);
}

void declare_audit(CLI::App& app, AuditFlags& flags) {
  app.add_option("path", flags.path,
                 "A recording.jsonl, or - for stdin; a crowd's FILE.evr; or a folder searched for both");
  app.add_option("--sample", flags.sample, "Check about this many motions of a crowd's recording; 0: all");
  app.add_option("--scenario", flags.scenario,
                 "Scenario FILE that the recordings must belong to, with its obstacle files");
  app.add_option(
      "--certificate", flags.certificates,
      "FILE with one certificate per line, the output of vo --json or route --json, or what check --certificates "
      "wrote; - for stdin");
  app.add_flag("--json", flags.json, "Counts and findings, or one verdict per certificate, as JSON on stdout");
}

}  // namespace

Verb audit_verb() {
  return {
      "audit",
      "Verify recordings in exact rational arithmetic: bodies, half-planes, choices, every step (exit status 1 if one "
      "fails)",
      "  exactvo audit out --json\n"
      "  zstd -dc recording.jsonl.zst | exactvo audit -\n"
      "  exactvo audit out/A1 --scenario datasets/data/paper/A1.json\n"
      "  exactvo vo --obstacle 'DISC(4 0, 1)' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2 --json \\\n"
      "      | exactvo audit --certificate -\n",
      with_flags(declare_audit, audit)};
}

}  // namespace exactvo::tools
