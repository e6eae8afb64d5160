// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/merge/assemble.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

#include "batch/formats/features.h"
#include "batch/formats/picture.h"
#include "batch/plan/input_record.h"
#include "exactvo/datasets/provenance.h"

namespace exactvo::datasets::batch {
namespace {

std::vector<InputFacts> all_facts(const Journal& journal, std::size_t inputs) {
  std::vector<InputFacts> facts;
  facts.reserve(inputs);
  for (std::size_t k = 0; k < inputs; ++k) facts.push_back(read_facts(journal, k));
  return facts;
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

/// Writes index.html and the pages after it, small pictures of every input's first obstacles, to
/// `journal.final_folder()`, from the parts on disk. `facts` are those of every input, `words` stand at the head of
/// each page. Throws DataError (E_FILE_UNWRITABLE; E_FORMAT_SYNTAX for a part that is none).
void write_pages(const Journal& journal, const Identity& identity, const std::vector<InputFacts>& facts,
                 const std::string& words, const std::string& provenance) {
  const std::size_t pages = std::max<std::size_t>(1, (facts.size() + kInputsOfPage - 1) / kInputsOfPage);
  for (std::size_t page = 0; page < pages; ++page) {
    const std::unique_ptr<AtomicFile> file = output_file(journal.final_folder() / page_name(page));
    file->write(page_head(page, pages, words));
    const std::size_t end = std::min(facts.size(), (page + 1) * kInputsOfPage);
    for (std::size_t input = page * kInputsOfPage; input < end; ++input) {
      file->write(input_head(identity.inputs[input].name, words_of(facts[input])));
      if (facts[input].chunks > 0) file->write(read_pictures(journal, input));
      file->write(input_foot());
    }
    file->write(page_foot(provenance));
    file->commit();
  }
}

}  // namespace

std::string provenance_of(const Identity& identity, const BatchRun& run) {
  Provenance provenance = make_provenance(run.command_line, 0);
  for (const Input& input : identity.inputs) provenance.inputs.push_back({input.name, input.sha256});
  provenance.written_at = "see summary.json";
  return to_json(provenance);
}

bool all_there(const Journal& journal, std::size_t inputs) {
  for (std::size_t k = 0; k < inputs; ++k) {
    if (!journal.is_there(journal.input_facts(k))) return false;
  }
  return true;
}

std::unique_ptr<Outputs> merge_all(const Journal& journal, std::size_t inputs, const BatchConfiguration& configuration,
                                   const std::string& provenance, const std::function<void()>& before_each) {
  auto outputs = std::make_unique<Outputs>(journal, configuration, provenance);
  for (std::size_t input = 0; input < inputs; ++input) {
    const std::uint64_t chunks = read_facts(journal, input).chunks;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      before_each();
      const std::string bytes = read_part_bytes(journal, input, chunk);
      outputs->add(view_of_part(bytes, journal.part(input, chunk)));
    }
  }
  return outputs;
}

BatchSummary publish(Outputs& outputs, const Journal& journal, const Identity& identity,
                     const BatchConfiguration& configuration, const std::string& provenance, Times times) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<InputFacts> facts = all_facts(journal, identity.inputs.size());
  BatchSummary summary = summary_of(identity, facts);
  summary.obstacles_out = outputs.counts().obstacles;
  summary.certified = outputs.counts().certified;
  summary.uncertified = outputs.counts().obstacles - outputs.counts().certified;
  summary.vertices = outputs.counts().vertices;
  summary.no_half_plane = outputs.counts().no_half_plane;
  outputs.finish();
  if (configuration.pictures) {
    const std::string words = words_of(summary.files, "files") + ". " + words_of(summary.obstacles, "obstacles") + ".";
    write_pages(journal, identity, facts, words, provenance);
  }
  times.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  times.written_at = make_provenance({}, 0).written_at;
  const auto last = output_file(journal.final_folder() / "summary.json");
  last->write(to_json(summary, identity, provenance, facts, times));
  last->commit();
  journal.publish("summary.json", is_output);
  summary.seconds = times.seconds;
  summary.obstacles_now = times.obstacles;
  summary.vertices_now = times.vertices;
  return summary;
}

}  // namespace exactvo::datasets::batch
