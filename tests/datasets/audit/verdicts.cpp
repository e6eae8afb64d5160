// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/verdicts.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "audit/second_opinion.h"
#include "exactvo/datasets/audit.h"

namespace exactvo::datasets::test {

using nlohmann::json;

namespace {

/// What `not_audited` lists: words and numbers that prove nothing. (The end's digest is made anew.)
bool is_free(const std::string& field) {
  for (const char* free : {"row.robots.mode", "row.robots.side", "row.robots.note", "row.robots.constraints.clearance",
                           "row.robots.constraints.fell_back", "row.lyapunov", "header.method", "header.controller",
                           "header.provenance", "header.all_half_planes", "end."})
    if (field.rfind(free, 0) == 0) return true;
  return false;
}

}  // namespace

Judged judge(const ShortRun& run, const Lines& lines) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("exactvo_edited_" + std::to_string(getpid()) + ".jsonl");
  std::ofstream(path) << sealed(lines);
  Judged judged{Fate::refused, ""};
  try {
    const AuditReport report = audit_recording(path, &run.scenario);
    judged = {report.clean() ? Fate::holds : Fate::rejected, report.findings.empty() ? "" : report.findings.front()};
  } catch (const DataError& e) {
    judged.why = e.what();
  }
  std::filesystem::remove(path);
  if (judged.fate != Fate::holds) return judged;
  const std::string against = second_opinion(lines, run.lines);
  return against.empty() ? judged : Judged{Fate::wrong, against};
}

void Campaign::run(const std::vector<ShortRun>& runs, std::uint64_t seed, std::size_t first, std::size_t count) {
  for (std::size_t n = first; n < first + count; ++n) {
    exactvo::test::SeededRandom random(seed * 1000003 + n);
    const ShortRun& run = runs[n % runs.size()];
    Lines lines = run.lines;
    const Edit done = edit(lines, random);
    if (lines == run.lines) continue;
    Judged judged = judge(run, lines);
    if (judged.fate == Fate::holds && is_free(done.field)) judged.fate = Fate::free;
    for (Counts* c : {&fields[done.field], &sum}) {
      c->refused += judged.fate == Fate::refused;
      c->rejected += judged.fate == Fate::rejected;
      c->free += judged.fate == Fate::free;
      c->holds += judged.fate == Fate::holds;
      c->wrong += judged.fate == Fate::wrong;
    }
    if (judged.fate == Fate::wrong)
      wrong.push_back(corpus_line(run, lines, done.field + ", " + done.how + ", " + done.place + ": " + judged.why));
  }
}

std::string Campaign::table() const {
  std::string text;
  char line[200];
  const auto add = [&](const std::string& name, const Counts& c) {
    std::snprintf(line, sizeof line, "%-46s %8zu %8zu %8zu %8zu %8zu\n", name.empty() ? "(a whole line)" : name.c_str(),
                  c.refused, c.rejected, c.free, c.holds, c.wrong);
    text += line;
  };
  std::snprintf(line, sizeof line, "%-46s %8s %8s %8s %8s %8s\n", "field", "refused", "rejected", "free", "true",
                "WRONG");
  text += line;
  for (const auto& [name, counts] : fields) add(name, counts);
  add("sum", sum);
  return text;
}

std::string corpus_line(const ShortRun& run, const Lines& edited, const std::string& why) {
  return json{{"run", run.name}, {"why", why}, {"patch", json::diff(json(run.lines), json(edited))}}.dump();
}

Lines patched(const ShortRun& run, const json& line) {
  const json lines = json(run.lines).patch(line.at("patch"));
  return Lines(lines.begin(), lines.end());
}

}  // namespace exactvo::datasets::test
