// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The files of a batch that grow part by part: measurements.jsonl, the GeoJSON layers, the GeoPackage. The same parts
/// in the same order give the same bytes. (What tells how all ended, the pictures' pages and the summary, comes last:
/// session.cpp, summary.h.)

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "batch/formats/geopackage.h"
#include "batch/plan/journal.h"
#include "batch/work/part.h"
#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

class Outputs {
 public:
  /// Starts them in `journal.final_folder()`. Throws DataError (E_FILE_UNWRITABLE), as the others do.
  /// The folder is removed with the object, unless it was published.
  Outputs(const Journal& journal, const BatchConfiguration& configuration, const std::string& provenance);

  /// From one thread at a time.
  void add(const PartView& part);
  /// Syncs and names them.
  void finish();

  /// Sums over the parts added.
  const Counts& counts() const { return counts_; }

 private:
  void start_geojson(bool in_metres, const std::string& provenance);

  Counts counts_;
  std::shared_ptr<const std::filesystem::path> folder_;  ///< before the files, which are closed first
  std::unique_ptr<AtomicFile> measurements_;
  std::vector<std::pair<std::unique_ptr<AtomicFile>, bool>> geojson_;  ///< with whether nothing was added yet
  std::unique_ptr<GeoPackage> geopackage_;
};

/// On a file system without locks another process may be through first and take the folder away. Made anew it would
/// hold some of the outputs only, and `Journal::publish` takes the others for an earlier batch's.
std::unique_ptr<AtomicFile> output_file(const std::filesystem::path& path);

}  // namespace exactvo::datasets::batch
