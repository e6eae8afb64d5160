// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo audit: verifies recordings in exact rational arithmetic.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
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

bool is_crowd_recording(const fs::path& path) {
  return path.extension() == ".evr";
}

/// The file itself, or every recording.jsonl and recording of a crowd below the folder, in the order of their names.
std::vector<fs::path> recordings_in(const std::string& path) {
  refuse_part_of_run(path);
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    const fs::path& file = entry.path();
    if (entry.is_regular_file() && (file.filename() == "recording.jsonl" || is_crowd_recording(file)))
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
        "  ... and {} more of \"{}\" (of a recording, the first {} refuted and the first {} open ones are listed)\n",
        report.points[p].unlisted, words_of(static_cast<datasets::AuditPoint>(p)), datasets::kMostAuditFindings,
        datasets::kMostAuditFindings);
  }
  return text;
}

std::string summary(const datasets::AuditReport& report) {
  std::string text = report.cut_off.empty() ? "" : "a recording ends early: what follows is of the rows there are\n";
  for (std::size_t p = 0; p < datasets::kAuditPoints; ++p) {
    const datasets::PointCount& n = report.points[p];
    if (p >= static_cast<std::size_t>(datasets::AuditPoint::braking) && n.asked() == 0) continue;
    text += fmt::format("{}: {} asked, {} proven", words_of(static_cast<datasets::AuditPoint>(p)), n.asked(), n.proven);
    if (n.refuted > 0) text += fmt::format(", {} refuted", n.refuted);
    if (n.open > 0) text += fmt::format(", {} left open", n.open);
    text += "\n";
  }
  text += fmt::format("{} of obstacles, {} unsafe; {}, {}\n", counted(report.half_planes, "half-plane"), report.unsafe,
                      counted(report.steps, "step"), counted(report.collisions, "collision"));
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

// --- Recordings of crowds ---

std::string summary(const datasets::CrowdAuditReport& r) {
  std::string text = fmt::format(
      "{} of {}, {} checked: {} too fast\n"
      "pairs of robots near each other: {}, {} came to overlap, {} overlapped already at the row before\n"
      "robots near edges that they did not touch at the row before: {}, {} overlapped\n"
      "robots that touched an edge at the row before: {}, {} came nearer; {} more stand on the edge, not proven\n"
      "robots near bodies that they did not touch at the row before: {}, {} overlapped; of those that touched {}, {} "
      "still overlap or came nearer; {} more did not satisfy their half-planes or were inside (no guarantee)\n",
      counted(r.rows, "row"), counted(r.robots, "robot"), counted(r.motions, "motion"), r.too_fast, r.pairs,
      r.pairs_met, r.pairs_overlapping, r.near_edges, r.edges_met, r.touching_edges, r.edges_neared,
      r.touching_edges_open, r.near_bodies, r.bodies_met, r.touching_bodies, r.bodies_not_parted, r.bodies_open);
  for (const std::string& finding : r.findings) text += "  " + finding + "\n";
  return text;
}

nlohmann::ordered_json as_json(const datasets::CrowdAuditReport& r) {
  nlohmann::ordered_json json;
  for (const auto& [name, count] : datasets::kCrowdAuditCounts) json[name] = r.*count;
  json["cut_off"] = r.cut_off;
  json["clean"] = r.clean();
  json["findings"] = r.findings;
  return json;
}

// --- All of them ---

struct Audited {
  std::optional<datasets::AuditReport> runs;
  std::optional<datasets::CrowdAuditReport> crowds;
  std::vector<std::string> cut_off;  ///< recordings of crowds
};

template <class Report>
void take(std::optional<Report>& sum, Report report, const std::string& file) {
  for (std::string& finding : report.findings) finding = file + ": " + finding;
  if (!sum) sum.emplace();
  add(*sum, report);
}

Audited audited(const AuditFlags& flags, const std::vector<fs::path>& files, const formation::Scenario* scenario) {
  Audited all;
  for (const fs::path& file : files) {
    if (is_crowd_recording(file)) {
      const datasets::CrowdAuditReport report = datasets::audit_crowd_recording(file, flags.sample);
      if (report.cut_off) all.cut_off.push_back(file.string());
      take(all.crowds, report, file.string());
    } else {
      take(all.runs, datasets::audit_recording(file, scenario), file.string());
    }
    if (interrupted()) throw Interrupted();
  }
  return all;
}

std::string summary(const Audited& all) {
  std::string text;
  if (all.runs) text += summary(*all.runs);
  if (all.crowds) text += summary(*all.crowds);
  for (const std::string& file : all.cut_off) text += file + ": the file was cut off after the last row\n";
  return text;
}

/// Names of files are bytes, and JSON is UTF-8.
std::string text_of(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// The object of recordings, of crowds, or of recordings with a member "crowds".
std::string to_json(const Audited& all) {
  if (!all.crowds) return datasets::to_json(*all.runs) + "\n";
  if (!all.runs) return text_of(as_json(*all.crowds), -1);
  auto both = nlohmann::ordered_json::parse(datasets::to_json(*all.runs));
  both["crowds"] = as_json(*all.crowds);
  return text_of(both, 2);
}

ExitCode audit_recordings(const AuditFlags& flags) {
  std::optional<formation::Scenario> scenario;
  if (!flags.scenario.empty()) scenario = datasets::load_scenario(flags.scenario);
  const std::vector<fs::path> files = recordings_in(flags.path);
  const auto crowds = static_cast<std::size_t>(std::count_if(files.begin(), files.end(), is_crowd_recording));
  if (crowds > 0 && !flags.scenario.empty())
    throw UsageError("--scenario", flags.scenario, "a recording.jsonl to compare it with, not one of a crowd");
  if (crowds == 0 && flags.sample > 0)
    throw UsageError("--sample", std::to_string(flags.sample), "a recording of a crowd, .evr");
  const Audited all = audited(flags, files, scenario ? &*scenario : nullptr);
  print(flags.json ? to_json(all) : summary(all));
  if (all.runs && !all.runs->cut_off.empty()) {
    for (const std::string& words : all.runs->cut_off) error_message(words);
    const bool is_refuted = std::any_of(all.runs->points.begin(), all.runs->points.end(),
                                        [](const datasets::PointCount& n) { return n.refuted > 0; });
    return is_refuted ? ExitCode::negative : ExitCode::bad_input;
  }
  const bool clean = (!all.runs || all.runs->clean()) && (!all.crowds || all.crowds->clean()) && all.cut_off.empty();
  return clean ? ExitCode::success : ExitCode::negative;
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
