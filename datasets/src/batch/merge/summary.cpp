// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/merge/summary.h"

#include <algorithm>
#include <optional>

#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/counted.h"
#include "files/text_file.h"
#include "json/json_text.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

// --- Counting ---

void add(BatchTally& sum, const BatchTally& one) {
  sum.read += one.read;
  sum.done += one.done;
  sum.repaired += one.repaired;
  for (const auto& [code, count] : one.rejected) sum.rejected[code] += count;
}

/// Numbers of one file alone, which stand in its facts.
bool is_measured(const std::string& note) {
  return note.rfind("extent ", 0) == 0 || note.rfind("lengths ", 0) == 0 ||
         note.find("; brought to metres ") != std::string::npos;
}

void add_note(std::vector<BatchNote>& notes, const std::string& text, const std::string& file) {
  constexpr std::size_t kMostTexts = 1000;
  const auto known = std::find_if(notes.begin(), notes.end(), [&](const BatchNote& n) { return n.text == text; });
  if (known != notes.end()) {
    ++known->files;
  } else if (notes.size() < kMostTexts) {
    notes.push_back({text, file, 1});
  }
}

void add_notes(std::vector<BatchNote>& notes, const std::vector<std::string>& texts, const std::string& file) {
  for (const std::string& text : texts)
    if (!is_measured(text)) add_note(notes, text, file);
}

// --- Writing ---

/// The counts of obstacles, and of files.
template <class Codec>
void members(Codec& json, For<Codec, BatchSummary>& s) {
  datasets::members(json, s.obstacles);
  json.member("passed_over", s.passed_over).member("obstacles", s.obstacles_out).member("certified", s.certified);
  json.member("uncertified", s.uncertified).member("vertices", s.vertices).member("no_half_plane", s.no_half_plane);
  json.member("files", s.files);
}

std::optional<double> rate(std::uint64_t count, const Times& times) {
  if (!times.has_rates || count == 0 || !(times.seconds > 0.0)) return std::nullopt;
  return static_cast<double>(count) / times.seconds;
}

void append_times(JsonWriter& json, const Times& times) {
  json.key("times").begin_inline_object().member("written_at", times.written_at);
  json.member("seconds", times.seconds).member("seconds_of_jobs", 1e-9 * static_cast<double>(times.made.nanoseconds));
  json.member("workers", times.workers)
      .member("obstacles", times.made.obstacles)
      .member("vertices", times.made.vertices);
  json.member("obstacles_per_second", rate(times.made.obstacles, times));
  json.member("vertices_per_second", rate(times.made.vertices, times)).end_object();
}

}  // namespace

BatchSummary summary_of(const Identity& identity, const std::vector<InputFacts>& facts) {
  BatchSummary summary;
  for (std::size_t k = 0; k < facts.size(); ++k) {
    const InputFacts& one = facts[k];
    ++summary.files.read;
    if (one.outcome == "rejected") {
      ++summary.files.rejected[one.code];
      summary.rejected_files.push_back({identity.inputs[k].name, one.code});
    } else {
      ++(one.outcome == "repaired" ? summary.files.repaired : summary.files.done);
    }
    add(summary.obstacles, one.tally);
    add_notes(summary.notes, one.notes, identity.inputs[k].name);
    summary.passed_over += one.passed_over;
  }
  return summary;
}

std::string to_json(const BatchSummary& summary, const Identity& identity, const std::string& provenance,
                    const std::vector<InputFacts>& facts, const Times& times) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object();
  members(json, summary);
  json.member("version", identity.version).member("commit", identity.commit);
  json.member("configuration_sha256", sha256_of(identity.configuration));
  json.key("configuration").raw(identity.configuration);
  json.key("inputs").begin_array();
  for (std::size_t k = 0; k < facts.size(); ++k) {
    json.begin_inline_object();
    members(json, identity.inputs[k]);
    json.key("facts").raw(to_json(facts[k])).end_object();
  }
  json.end_array();
  json.key("provenance").raw(provenance);
  append_times(json, times);
  return json.end_object().take() + "\n";
}

std::string words_of(const BatchTally& tally, const char* what) {
  std::string text = geometry::counted(tally.read, what) + ": " + std::to_string(tally.done) + " done, " +
                     std::to_string(tally.repaired) + " repaired, " + std::to_string(tally.rejected_in_all()) +
                     " rejected";
  for (const auto& [code, count] : tally.rejected) text += ", " + code + " " + std::to_string(count);
  return text;
}

std::string words_of(const InputFacts& facts) {
  if (!facts.message.empty()) return facts.message;
  return facts.outcome + "; " + words_of(facts.tally, "obstacle");
}

BatchSummary read_summary(const fs::path& out) {
  const std::string path = (out / "summary.json").string();
  const Json json = parse_json(read_text_file(path), path);
  const JsonCursor at(json, path, "");
  Identity identity;
  std::vector<InputFacts> facts;
  const JsonCursor inputs = at.at("inputs");
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const JsonCursor input = inputs.at(k);
    members(input, identity.inputs.emplace_back());
    input.member("facts", facts.emplace_back());
  }
  BatchSummary summary = summary_of(identity, facts);
  members(at, summary);
  return summary;
}

}  // namespace exactvo::datasets::batch
