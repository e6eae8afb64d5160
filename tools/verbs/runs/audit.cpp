// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo audit: verifies recordings in exact rational arithmetic.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/geometry/counted.h"
#include "support/certificates.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using geometry::counted;

namespace {

struct Flags {
  std::string path;
  std::string certificates;
  std::string scenario;
  std::size_t sample = 0;
  bool json = false;
};

// --- Recordings ---

/// The file itself, or every recording.jsonl below the folder, in the order of their names.
std::vector<fs::path> recordings_in(const std::string& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file() && entry.path().filename() == "recording.jsonl") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  if (found.empty()) throw UsageError("path", path, "a folder that contains a recording.jsonl");
  return found;
}

/// What is asked at each point, in words.
const char* in_words(datasets::AuditPoint point) {
  constexpr const char* kWords[] = {"the recording is of its scenario",
                                    "bodies contain the obstacles they stand for",
                                    "nothing within reach of a step lacks a half-plane",
                                    "half-planes exclude their velocity obstacles",
                                    "choices satisfy their half-planes and are the best",
                                    "rows follow from one another",
                                    "motions keep clear of everything"};
  return kWords[static_cast<std::size_t>(point)];
}

std::string unlisted_lines(const datasets::AuditReport& report) {
  std::string text;
  for (std::size_t p = 0; p < datasets::kAuditPoints; ++p) {
    if (report.points[p].unlisted == 0) continue;
    text += fmt::format(
        "  ... and {} more of \"{}\" (of a recording, the first {} refuted and the first {} open ones are listed)\n",
        report.points[p].unlisted, in_words(static_cast<datasets::AuditPoint>(p)), datasets::kMostAuditFindings,
        datasets::kMostAuditFindings);
  }
  return text;
}

std::string summary(const datasets::AuditReport& report) {
  std::string text;
  for (std::size_t p = 0; p < datasets::kAuditPoints; ++p) {
    const datasets::PointCount& n = report.points[p];
    text += fmt::format("{}: {} asked, {} proven", in_words(static_cast<datasets::AuditPoint>(p)), n.asked(), n.proven);
    if (n.refuted > 0) text += fmt::format(", {} refuted", n.refuted);
    if (n.open > 0) text += fmt::format(", {} left open", n.open);
    text += "\n";
  }
  text += fmt::format("{} of obstacles, {} unsafe; {}, {}\n", counted(report.half_planes, "half-plane"), report.unsafe,
                      counted(report.steps, "step"), counted(report.collisions, "collision"));
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

ExitCode audit_recordings(const Flags& flags) {
  std::optional<formation::Scenario> scenario;
  if (!flags.scenario.empty()) scenario = datasets::load_scenario(flags.scenario);
  datasets::AuditReport sum;
  for (const fs::path& file : recordings_in(flags.path)) {
    datasets::AuditReport report = datasets::audit_recording(file, scenario ? &*scenario : nullptr);
    for (std::string& finding : report.findings) finding = file.string() + ": " + finding;
    datasets::add(sum, report);
    if (interrupted()) throw Interrupted();
  }
  const std::string text = flags.json ? datasets::to_json(sum) + "\n" : summary(sum);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return sum.clean() ? ExitCode::success : ExitCode::negative;
}

// --- Recordings of crowds ---

bool is_crowd_recording(const std::string& path) {
  return fs::path(path).extension() == ".evr";
}

std::string in_words(const datasets::CrowdAuditReport& r) {
  std::string text = fmt::format(
      "{} of {}, {} judged: {} too fast\n"
      "pairs that were near, apart at the row before, and both kept: {}, {} overlapped; {} more not kept, nothing is "
      "promised of them\n"
      "robots near edges that they did not touch at the row before: {}, {} overlapped\n",
      counted(r.rows, "row"), counted(r.robots, "robot"), counted(r.motions, "motion"), r.too_fast, r.pairs,
      r.pairs_met, r.pairs_open, r.near_edges, r.edges_met);
  for (const std::string& finding : r.findings) text += "  " + finding + "\n";
  if (r.cut_off) text += "the file was cut off after the last row\n";
  return text;
}

std::string to_json(const datasets::CrowdAuditReport& r) {
  return fmt::format(
      "{{\"rows\": {}, \"robots\": {}, \"motions\": {}, \"too_fast\": {}, \"pairs\": {}, \"pairs_met\": {}, "
      "\"pairs_open\": {}, \"near_edges\": {}, \"edges_met\": {}, \"cut_off\": {}, \"clean\": {}}}\n",
      r.rows, r.robots, r.motions, r.too_fast, r.pairs, r.pairs_met, r.pairs_open, r.near_edges, r.edges_met, r.cut_off,
      r.clean());
}

ExitCode audit_crowd(const Flags& flags) {
  const datasets::CrowdAuditReport report = datasets::audit_crowd_recording(flags.path, flags.sample);
  print(flags.json ? to_json(report) : in_words(report));
  return report.clean() && !report.cut_off ? ExitCode::success : ExitCode::negative;
}

// --- Certificates ---

ExitCode audit_certificates(const Flags& flags) {
  const JudgedCertificates judged = judge_certificates(flags.certificates);
  const std::string text = flags.json ? to_json(judged) : in_words(judged);
  std::fwrite(text.data(), 1, text.size(), stdout);
  const bool all =
      std::all_of(judged.all.begin(), judged.all.end(), [](const JudgedCertificate& c) { return c.valid; });
  return all ? ExitCode::success : ExitCode::negative;
}

ExitCode audit(const Flags& flags) {
  if (flags.path.empty() == flags.certificates.empty())
    throw UsageError("audit", flags.path.empty() ? "neither a path nor --certificate" : "a path and --certificate",
                     "one of the two: a recording (or a folder of them), or --certificate FILE");
  if (!flags.certificates.empty() && !flags.scenario.empty())
    throw UsageError("--scenario", flags.scenario, "a recording to compare it with, not --certificate");
  const bool is_crowd = is_crowd_recording(flags.path);
  if (is_crowd && !flags.scenario.empty())
    throw UsageError("--scenario", flags.scenario, "a recording.jsonl to compare it with");
  if (!is_crowd && flags.sample > 0)
    throw UsageError("--sample", std::to_string(flags.sample), "a recording of a crowd, .evr");
  if (is_crowd) return audit_crowd(flags);
  return flags.path.empty() ? audit_certificates(flags) : audit_recordings(flags);
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("path", flags->path, "A recording.jsonl, a folder searched for them, or a crowd's FILE.evr");
  app.add_option("--sample", flags->sample, "Of a crowd: judge about so many motions; 0 for all");
  app.add_option("--scenario", flags->scenario, "FILE that the recordings must be of, with its obstacle files");
  app.add_option("--certificate", flags->certificates,
                 "FILE with one certificate per line, or the output of vo --json or route --json; - for stdin");
  app.add_flag("--json", flags->json, "Counts and findings, or one verdict per certificate, as JSON on stdout");
  return [flags] { return audit(*flags); };
}

}  // namespace

Verb audit_verb() {
  return {
      "audit",
      "Verify recordings in exact rational arithmetic: bodies, half-planes, choices, every step (exit status 1 if one "
      "fails)",
      "  exactvo audit out --json\n"
      "  exactvo audit out/A1 --scenario datasets/data/paper/A1.json\n"
      "  exactvo vo --obstacle 'DISC(4 0, 1)' --position 0,0 --velocity 1,0 --radius 0.5 --time-horizon 2 --json \\\n"
      "      | exactvo audit --certificate -\n",
      declare};
}

}  // namespace exactvo::tools
