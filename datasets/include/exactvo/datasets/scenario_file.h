// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Scenarios as JSON. The published schema is datasets/schema/scenario.schema.json (draft-07, a unit at every number);
/// it is compiled into the library, so that a scenario is judged the same wherever it is read.
///
/// Properties (tests quote the numbers):
///  (1) parse_scenario(write_scenario(s)) == s, bit for bit in every number;
///  (2) a refused text yields a DataError whose place is the JSON pointer of the offending value (line and column where
///      the text is not JSON at all), and nothing else happens;
///  (3) a key that the schema does not know is refused, with the nearest known key suggested;
///  (4) what is returned passes formation::validate.

#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// A scenario with notes for people, one line per fact. For each obstacle file that it names they say how the units
/// were decided, the projection's centre and the extent, how many repairs were made and what was skipped.
struct LoadedScenario {
  formation::Scenario scenario;    ///< valid: it can be run
  std::vector<std::string> notes;  ///< "floor.geojson: metres: by its member "units""; empty without obstacle files
  /// What a run depends on: the scenario file (unless it was parsed from text), then every obstacle file it names, each
  /// followed by the files that are read with it (input_files.h), such as the picture of a ROS map.
  std::vector<std::filesystem::path> files = {};
};

/// Reads a scenario; obstacle files it names are looked up in its folder. Throws DataError: if such a
/// file has invalid content, the error names that file; if it cannot be opened or its format is unknown, the error
/// names the scenario and the JSON pointer of the reference.
LoadedScenario load_scenario_with_notes(const std::filesystem::path& path);

/// The same without the notes.
formation::Scenario load_scenario(const std::filesystem::path& path);

/// The same from text. `file_name` is used in messages, `base_dir` to find obstacle files. Throws DataError.
LoadedScenario parse_scenario_with_notes(const std::string& text, const std::string& file_name,
                                         const std::filesystem::path& base_dir);
/// The same without the notes.
formation::Scenario parse_scenario(const std::string& text, const std::string& file_name,
                                   const std::filesystem::path& base_dir);

/// The scenario file and the obstacle files it names, without what is read with those. Reads the file, which
/// empties a pipe. Throws DataError.
std::vector<std::filesystem::path> files_of_scenario(const std::filesystem::path& path);

/// Canonical JSON: every field written, keys in the schema's order, obstacles inline, shortest numbers that read back
/// to the same doubles.
std::string write_scenario(const formation::Scenario& scenario);

/// The JSON Schema that scenarios are held against.
const std::string& scenario_schema();

}  // namespace exactvo::datasets
