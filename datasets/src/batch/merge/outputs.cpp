// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/merge/outputs.h"

#include <optional>
#include <utility>
#include <vector>

#include "batch/formats/features.h"
#include "gdal/vector_library.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

/// obstacles.geojson and so on.
class GeoJsonLayers {
 public:
  GeoJsonLayers(const fs::path& folder, bool in_metres, const std::string& provenance) {
    const std::string units = in_metres ? ",\"units\":\"m\"" : "";
    for (const Layer& layer : layers()) {
      files_.push_back({output_file(folder / (std::string(layer.name) + ".geojson")), true});
      files_.back().first->write("{\"type\":\"FeatureCollection\",\"name\":\"" + std::string(layer.name) + "\"" +
                                 units + ",\"provenance\":" + provenance + ",\"features\":[\n");
    }
  }

  void add(const PartView& part) {
    for (std::size_t k = 0; k < files_.size(); ++k) {
      if (part.features[k].empty()) continue;
      auto& [file, is_empty] = files_[k];
      if (!std::exchange(is_empty, false)) file->write(",\n");
      file->write(part.features[k]);
    }
  }

  void finish() {
    for (auto& [file, is_empty] : files_) {
      file->write("\n]}\n");
      file->commit();
    }
  }

 private:
  std::vector<std::pair<std::unique_ptr<AtomicFile>, bool>> files_;  ///< with whether nothing was added yet
};

/// The final folder, which goes unless .parts went with it.
struct StartedFolder {
  explicit StartedFolder(const Journal& journal) : path(journal.final_folder()) { journal.start_final(); }
  ~StartedFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  StartedFolder(const StartedFolder&) = delete;
  StartedFolder& operator=(const StartedFolder&) = delete;

  const fs::path& path;
};

}  // namespace

struct Outputs::Inside {
  Inside(const Journal& journal, const BatchConfiguration& configuration, const std::string& provenance)
      : folder(journal), figures(output_file(folder.path / "figures.jsonl")) {
    figures->write("{\"provenance\":" + provenance + "}\n");
    if (configuration.geojson) geojson.emplace(folder.path, configuration.geojson_in_metres, provenance);
    if (configuration.geopackage)
      geopackage = vector_library().make_geopackage(folder.path / "obstacles.gpkg", provenance);
  }

  Counts counts;
  StartedFolder folder;  ///< before the files, which are closed first
  std::unique_ptr<AtomicFile> figures;
  std::optional<GeoJsonLayers> geojson;
  std::unique_ptr<GeoPackage> geopackage;
};

Outputs::Outputs(const Journal& journal, const BatchConfiguration& configuration, const std::string& provenance)
    : inside_(std::make_unique<Inside>(journal, configuration, provenance)) {}

Outputs::~Outputs() = default;

void Outputs::add(const PartView& part) {
  inside_->figures->write(part.figures);
  if (inside_->geojson) inside_->geojson->add(part);
  if (inside_->geopackage) inside_->geopackage->add(part.rows);
  inside_->counts += part.counts;
}

void Outputs::finish() {
  inside_->figures->commit();
  if (inside_->geojson) inside_->geojson->finish();
  if (inside_->geopackage) inside_->geopackage->finish();
}

const Counts& Outputs::counts() const {
  return inside_->counts;
}

std::unique_ptr<AtomicFile> output_file(const fs::path& path) {
  return std::make_unique<AtomicFile>(path, MissingFolder::is_refused);
}

}  // namespace exactvo::datasets::batch
