// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/assemble.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <utility>

#include "batch/geopackage.h"
#include "batch/part.h"
#include "batch/picture.h"
#include "batch/process.h"
#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/provenance.h"
#include "json_text.h"
#include "text_file.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

/// The same in every output and at any time.
std::string provenance_json(const Identity& identity, const BatchRun& run) {
  Provenance provenance = make_provenance(run.command_line, 0);
  for (const Input& input : identity.inputs) provenance.inputs.push_back({input.name, input.sha256});
  provenance.written_at = "see summary.json";
  return to_json(provenance);
}

void add(BatchTally& sum, const BatchTally& one) {
  sum.read += one.read;
  sum.done += one.done;
  sum.repaired += one.repaired;
  for (const auto& [code, count] : one.rejected) sum.rejected[code] += count;
}

constexpr const char* kRejected = "rejected";

void count_file(BatchTally& files, const InputFacts& facts) {
  ++files.read;
  if (facts.outcome == kRejected) {
    ++files.rejected[facts.code];
  } else {
    ++(facts.outcome == "repaired" ? files.repaired : files.done);
  }
}

// --- Outputs that take parts one by one ---

/// On a file system without locks another process may be through first and take the folder away. Made anew it would
/// hold some of the outputs only, and `publish` takes the others for an earlier batch's.
std::unique_ptr<AtomicFile> output_file(const fs::path& path) {
  return std::make_unique<AtomicFile>(path, MissingFolder::is_refused);
}

/// obstacles.geojson and so on.
class GeoJsonLayers {
 public:
  GeoJsonLayers(const fs::path& folder, const std::string& provenance) {
    for (const Layer& layer : layers()) {
      files_.push_back({output_file(folder / (std::string(layer.name) + ".geojson")), true});
      files_.back().file->write("{\"type\":\"FeatureCollection\",\"name\":\"" + std::string(layer.name) +
                                "\",\"units\":\"m\",\"provenance\":" + provenance + ",\"features\":[\n");
    }
  }

  void add(const Part& part) {
    for (std::size_t k = 0; k < files_.size(); ++k) {
      if (part.features[k].empty()) continue;
      if (!std::exchange(files_[k].empty, false)) files_[k].file->write(",\n");
      files_[k].file->write(part.features[k]);
    }
  }

  void finish() {
    for (Open& open : files_) {
      open.file->write("\n]}\n");
      open.file->commit();
    }
  }

 private:
  struct Open {
    std::unique_ptr<AtomicFile> file;
    bool empty = true;
  };
  std::vector<Open> files_;
};

/// index.html and the pages after it.
class PicturePages {
 public:
  PicturePages(fs::path folder, std::size_t inputs, std::string provenance, std::string words)
      : folder_(std::move(folder)),
        pages_(std::max<std::size_t>(1, (inputs + kInputsOfPage - 1) / kInputsOfPage)),
        provenance_(std::move(provenance)),
        words_(std::move(words)) {
    start_page();
  }

  void start_input(const std::string& file, const std::string& words) {
    if (inputs_ > 0 && inputs_ % kInputsOfPage == 0) {
      finish();
      ++page_;
      start_page();
    }
    ++inputs_;
    file_->write(input_head(file, words));
  }
  void add(const Part& part) { file_->write(part.pictures); }
  void finish_input() { file_->write(input_foot()); }

  void finish() {
    file_->write(page_foot(provenance_));
    file_->commit();
  }

 private:
  void start_page() {
    file_ = output_file(folder_ / page_name(page_));
    file_->write(page_head(page_, pages_, words_));
  }

  fs::path folder_;
  std::size_t pages_;
  std::string provenance_;
  std::string words_;
  std::size_t page_ = 0;
  std::size_t inputs_ = 0;
  std::unique_ptr<AtomicFile> file_;
};

/// All that are wanted.
class Outputs {
 public:
  Outputs(const fs::path& folder, const BatchConfiguration& configuration, const std::string& provenance,
          std::size_t inputs, const std::string& words)
      : figures_(output_file(folder / "figures.jsonl")) {
    figures_->write("{\"provenance\":" + provenance + "}\n");
    if (configuration.geojson) geojson_.emplace(folder, provenance);
    if (configuration.pictures) pictures_.emplace(folder, inputs, provenance, words);
    if (configuration.geopackage) geopackage_ = std::make_unique<GeoPackage>(folder / "obstacles.gpkg", provenance);
  }

  void start_input(const std::string& file, const std::string& words) {
    if (pictures_) pictures_->start_input(file, words);
  }
  void add(const Part& part) {
    figures_->write(part.figures);
    if (geojson_) geojson_->add(part);
    if (pictures_) pictures_->add(part);
    if (geopackage_) geopackage_->add(part.rows);
  }
  void finish_input() {
    if (pictures_) pictures_->finish_input();
  }
  void finish() {
    figures_->commit();
    if (geojson_) geojson_->finish();
    if (pictures_) pictures_->finish();
    if (geopackage_) geopackage_->finish();
  }

 private:
  std::unique_ptr<AtomicFile> figures_;
  std::optional<GeoJsonLayers> geojson_;
  std::optional<PicturePages> pictures_;
  std::unique_ptr<GeoPackage> geopackage_;
};

// --- The summary ---

void append_tally(JsonWriter& json, const BatchTally& tally) {
  json.member("read", tally.read).member("done", tally.done).member("repaired", tally.repaired);
  json.key("rejected").begin_object();
  for (const auto& [code, count] : tally.rejected) json.member(code, count);
  json.end_object();
}

std::optional<double> rate(std::uint64_t count, const Times& times) {
  if (!times.has_rates || count == 0 || !(times.seconds > 0.0)) return std::nullopt;
  return static_cast<double>(count) / times.seconds;
}

void append_times(JsonWriter& json, const Times& times) {
  json.key("times").begin_inline_object().member("written_at", times.written_at);
  json.member("seconds", times.seconds).member("seconds_of_jobs", times.seconds_of_jobs);
  json.member("workers", times.workers).member("obstacles", times.obstacles).member("vertices", times.vertices);
  json.member("obstacles_per_second", rate(times.obstacles, times));
  json.member("vertices_per_second", rate(times.vertices, times)).end_object();
}

std::string summary_json(const BatchSummary& summary, const Identity& identity, const std::string& provenance,
                         const std::vector<std::string>& facts, const Times& times) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object();
  append_tally(json, summary.obstacles);
  json.member("passed_over", summary.passed_over).member("obstacles", summary.obstacles_out);
  json.member("certified", summary.certified).member("uncertified", summary.uncertified);
  json.member("vertices", summary.vertices);
  json.key("files").begin_inline_object();
  append_tally(json, summary.files);
  json.end_object();
  json.member("version", identity.version).member("commit", identity.commit);
  json.member("configuration_sha256", sha256_of(identity.configuration));
  json.key("configuration").raw(identity.configuration);
  json.key("inputs").begin_array();
  for (std::size_t k = 0; k < facts.size(); ++k) {
    json.begin_inline_object().member("path", identity.inputs[k].name).member("sha256", identity.inputs[k].sha256);
    json.key("facts").raw(facts[k]).end_object();
  }
  json.end_array();
  json.key("provenance").raw(provenance);
  append_times(json, times);
  return json.end_object().take() + "\n";
}

std::string words_of(const BatchTally& tally, const char* what) {
  std::string text = std::to_string(tally.read) + " " + what + ": " + std::to_string(tally.done) + " done, " +
                     std::to_string(tally.repaired) + " repaired, " + std::to_string(tally.rejected_in_all()) +
                     " rejected";
  for (const auto& [code, count] : tally.rejected) text += ", " + code + " " + std::to_string(count);
  return text;
}

std::string words_of(const InputFacts& facts) {
  if (!facts.message.empty()) return facts.message;
  return facts.outcome + "; " + words_of(facts.tally, "obstacles");
}

std::vector<InputFacts> all_facts(const Ledger& ledger, std::size_t inputs) {
  std::vector<InputFacts> facts;
  facts.reserve(inputs);
  for (std::size_t k = 0; k < inputs; ++k) {
    const fs::path path = ledger.input_facts(k);
    facts.push_back(read_input_record(path).facts);
  }
  return facts;
}

/// The only chunk of an input stands beside its facts.
Part part_at(const Ledger& ledger, std::size_t input, std::size_t chunk, std::uint64_t chunks) {
  if (chunks == 1) {
    InputRecord record = read_input_record(ledger.input_facts(input));
    if (record.part) return *std::move(record.part);
  }
  return read_part(ledger.part(input, chunk));
}

/// Whatever a batch may write to OUT, of this configuration or another.
bool is_output(const std::string& name) {
  if (name == "figures.jsonl" || name == "obstacles.gpkg" || name == page_name(0)) return true;
  for (const Layer& layer : layers()) {
    if (name == std::string(layer.name) + ".geojson") return true;
  }
  const std::size_t number = std::strtoull(name.c_str() + std::min<std::size_t>(name.size(), 5), nullptr, 10);
  return number > 1 && name == page_name(number - 1);
}

std::uint64_t sum_of(const Json& rejected, std::map<std::string, std::uint64_t>& out) {
  std::uint64_t sum = 0;
  for (const auto& [code, count] : rejected.items()) sum += out[code] = count.get<std::uint64_t>();
  return sum;
}

void parse_tally(const Json& json, BatchTally& tally) {
  json.at("read").get_to(tally.read);
  json.at("done").get_to(tally.done);
  json.at("repaired").get_to(tally.repaired);
  sum_of(json.at("rejected"), tally.rejected);
}

}  // namespace

bool all_there(const Ledger& ledger, std::size_t inputs) {
  for (std::size_t k = 0; k < inputs; ++k) {
    if (!ledger.is_there(ledger.input_facts(k))) return false;
  }
  return true;
}

BatchSummary assemble(const Ledger& ledger, const Identity& identity, const BatchConfiguration& configuration,
                      const BatchRun& run, Times times) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<InputFacts> facts = all_facts(ledger, identity.inputs.size());
  BatchSummary summary;
  for (std::size_t k = 0; k < facts.size(); ++k) {
    const InputFacts& one = facts[k];
    count_file(summary.files, one);
    if (one.outcome == kRejected) summary.rejected_files.push_back({identity.inputs[k].name, one.code});
    add(summary.obstacles, one.tally);
    summary.passed_over += one.passed_over;
  }
  const std::string provenance = provenance_json(identity, run);
  const std::string words = words_of(summary.files, "files") + ". " + words_of(summary.obstacles, "obstacles") + ".";
  Outputs outputs(ledger.final_folder(), configuration, provenance, facts.size(), words);
  std::vector<std::string> facts_json;
  for (std::size_t k = 0; k < facts.size(); ++k) {
    outputs.start_input(identity.inputs[k].name, words_of(facts[k]));
    for (std::size_t chunk = 0; chunk < facts[k].chunks; ++chunk) {
      const Part part = part_at(ledger, k, chunk, facts[k].chunks);
      summary.obstacles_out += part.obstacles;
      summary.certified += part.certified;
      summary.uncertified += part.obstacles - part.certified;
      summary.vertices += part.vertices;
      outputs.add(part);
    }
    outputs.finish_input();
    facts_json.push_back(to_json(facts[k]));
  }
  outputs.finish();
  times.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  times.written_at = make_provenance({}, 0).written_at;
  const auto last = output_file(ledger.final_folder() / "summary.json");
  last->write(summary_json(summary, identity, provenance, facts_json, times));
  last->commit();
  ledger.publish("summary.json", is_output);
  summary.seconds = times.seconds;
  summary.obstacles_now = times.obstacles;
  summary.vertices_now = times.vertices;
  return summary;
}

BatchSummary read_summary(const fs::path& out) {
  const fs::path path = out / "summary.json";
  const Json json = parse_json(read_text_file(path), path.string());
  BatchSummary summary;
  try {
    parse_tally(json, summary.obstacles);
    parse_tally(json.at("files"), summary.files);
    json.at("passed_over").get_to(summary.passed_over);
    json.at("obstacles").get_to(summary.obstacles_out);
    json.at("certified").get_to(summary.certified);
    json.at("uncertified").get_to(summary.uncertified);
    json.at("vertices").get_to(summary.vertices);
    for (const Json& input : json.at("inputs")) {
      const Json& facts = input.at("facts");
      if (facts.at("outcome") == kRejected)
        summary.rejected_files.push_back({input.at("path").get<std::string>(), facts.at("code").get<std::string>()});
    }
  } catch (const nlohmann::detail::exception& error) {
    throw DataError(DataCode::wrong_type, path.string(), "", error.what(), "a summary as a batch writes it");
  }
  return summary;
}

}  // namespace exactvo::datasets::batch
