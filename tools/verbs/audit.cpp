// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo audit: proves recordings again, in rationals.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "exactvo/datasets/audit.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

struct Flags {
  std::string path;
  bool json = false;
};

/// The file itself, or every recording.jsonl below the folder, in the order of their names.
std::vector<fs::path> recordings_in(const std::string& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file() && entry.path().filename() == "recording.jsonl") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  if (found.empty()) throw UsageError("DIR", path, "a folder with a recording.jsonl in it or below");
  return found;
}

std::string summary(const datasets::AuditReport& report) {
  std::string text =
      fmt::format("{} half-planes, {} unsafe\n{} steps, {} collisions\n{} inconsistencies\n", report.half_planes,
                  report.unsafe, report.steps, report.collisions, report.inconsistencies);
  for (const std::string& finding : report.findings) text += "  " + finding + "\n";
  return text;
}

ExitCode audit(const Flags& flags) {
  datasets::AuditReport sum;
  for (const fs::path& file : recordings_in(flags.path)) {
    datasets::AuditReport report = datasets::audit_recording(file);
    for (std::string& finding : report.findings) finding = file.string() + ": " + finding;
    datasets::add(sum, report);
    if (interrupted()) throw Interrupted();
  }
  const std::string text = flags.json ? datasets::to_json(sum) + "\n" : summary(sum);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return sum.clean() ? ExitCode::success : ExitCode::negative;
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("path", flags->path, "A recording.jsonl, or a folder with some in it or below")->required();
  app.add_flag("--json", flags->json, "The counts and findings as JSON on stdout");
  return [flags] { return audit(*flags); };
}

}  // namespace

Verb audit_verb() {
  return {"audit", "Prove recordings again in rationals: every half-plane, every step (exit status 1 where one fails)",
          "  exactvo audit out --json\n", declare};
}

}  // namespace exactvo::tools
