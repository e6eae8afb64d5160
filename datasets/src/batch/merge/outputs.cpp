// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/merge/outputs.h"

#include "batch/formats/features.h"
#include "gdal/vector_library.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

/// The final folder, which goes unless .parts went with it.
std::shared_ptr<const fs::path> started_folder(const Journal& journal) {
  journal.start_final();
  return {&journal.final_folder(), [](const fs::path* folder) {
            std::error_code ignored;
            fs::remove_all(*folder, ignored);
          }};
}

}  // namespace

Outputs::Outputs(const Journal& journal, const BatchConfiguration& configuration, const std::string& provenance)
    : folder_(started_folder(journal)), measurements_(output_file(*folder_ / "measurements.jsonl")) {
  measurements_->write("{\"provenance\":" + provenance + "}\n");
  if (configuration.geojson) start_geojson(configuration.geojson_in_metres, provenance);
  if (configuration.geopackage) geopackage_ = vector_library().make_geopackage(*folder_ / "obstacles.gpkg", provenance);
}

void Outputs::start_geojson(bool in_metres, const std::string& provenance) {
  const std::string units = in_metres ? ",\"units\":\"m\"" : "";
  for (const Layer& layer : layers()) {
    geojson_.push_back({output_file(*folder_ / (std::string(layer.name) + ".geojson")), true});
    geojson_.back().first->write("{\"type\":\"FeatureCollection\",\"name\":\"" + std::string(layer.name) + "\"" +
                                 units + ",\"provenance\":" + provenance + ",\"features\":[\n");
  }
}

void Outputs::add(const PartView& part) {
  measurements_->write(part.measurements);
  for (std::size_t k = 0; k < geojson_.size(); ++k) {
    if (part.features[k].empty()) continue;
    auto& [file, is_empty] = geojson_[k];
    if (!std::exchange(is_empty, false)) file->write(",\n");
    file->write(part.features[k]);
  }
  if (geopackage_) geopackage_->add(part.rows);
  counts_ += part.counts;
}

void Outputs::finish() {
  measurements_->commit();
  for (const auto& [file, is_empty] : geojson_) {
    file->write("\n]}\n");
    file->commit();
  }
  if (geopackage_) geopackage_->finish();
}

std::unique_ptr<AtomicFile> output_file(const fs::path& path) {
  return std::make_unique<AtomicFile>(path, MissingFolder::is_refused);
}

}  // namespace exactvo::datasets::batch
