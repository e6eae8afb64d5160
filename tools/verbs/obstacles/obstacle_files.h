// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the verbs that take obstacle files share: the options that say how a file is to be read, and its findings as
/// lines and as JSON.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/formation/scenario.h"
#include "support/json_layout.h"
#include "verb.h"

namespace exactvo::tools {

struct ReadingFlags {
  std::string format;
  std::string units = "automatic";
  std::string unknown = "free";
  double cell_size = 0.0;
};

/// --format (or `format_name`), --units, --unknown and --cell-size.
void declare_reading_flags(CLI::App& app, ReadingFlags& flags, const std::string& format_name = "--format");

/// Throws UsageError with the nearest known word. Reading goes on past bad obstacles.
datasets::ReadOptions reading_options(const ReadingFlags& flags, const std::string& format_name = "--format");

/// Throws UsageError where `format` is neither empty nor among `known`.
void check_format(const std::string& option, const std::string& format, const std::vector<std::string>& known);

/// One file read, or why it could not be.
struct FileAnswer {
  std::string file;
  std::optional<datasets::ObstacleFile> content;
  std::optional<datasets::DataError> error;
  std::string guessed_format{};  ///< of a file that could not be read: as what, if that was a guess

  bool is_whole() const { return content && content->counts.rejected == 0; }
};

/// Throws UsageError if `out` is the file `in`, or one that is read with it (datasets/input_files.h), by whatever name
/// or link. `format` is that of `in`, empty if it is to be found out.
void refuse_input_as_output(const std::string& in, const std::string& format, const std::string& option,
                            const std::string& out);

/// Everything that is read with the files, and `out` unless that is empty: what a figure must not replace. `format` is
/// that of all files, empty if it is to be found out.
std::vector<std::filesystem::path> all_read_with(const std::vector<std::string>& files, const std::string& format,
                                                 const std::string& out = "");

/// --metres, of verbs that write GeoJSON.
void declare_metres(CLI::App& app, bool& metres);

/// Says so where GeoJSON is written in degrees and no place on earth is known.
void note_place_on_earth(const datasets::LocalPlane& plane);

/// Writes obstacles to a file, or to stdout where `out` is "-". Says what was lost. `options.format` as `output_format`
/// gives it.
void write_or_print(const std::string& out, const std::vector<formation::SceneObstacle>& obstacles,
                    const datasets::WriteOptions& options);

/// The format to write: `to`, or as the extension of `out` says; wkt for "-". Throws DataError.
std::string output_format(const std::string& out, const std::string& to);

/// "; read as pslg, which is guessed from its content and name: --format names another"; empty if the format was given
/// or is certain, or none was found. `option`: the one that would name it.
std::string guess_words(const FileAnswer& answer, const std::string& option = "--format");

/// The format that a file is taken for when none is named; empty if there is no doubt, none is found, or the file
/// cannot be read twice.
std::string guessed_format(const std::string& file);

/// Reads every file; a DataError of a file becomes its answer. Says the notes of each (say_notes).
std::vector<FileAnswer> read_each(const std::vector<std::string>& files, const datasets::ReadOptions& options);

/// bad_input where a file could not be read; negative where obstacles were rejected, or with `strict` where anything
/// was wrong, repaired or not.
ExitCode exit_code(const std::vector<FileAnswer>& answers, bool strict = false);

/// {"file", "format", "verdict" ("valid"; "repaired": every problem was; "invalid": some obstacles can't be used;
/// "unreadable"), "code" (of the first refusal), "counts", "problems": [{"code", "place", "feature",
/// "ring", "vertex", "x", "y", "in_file", "at_vertex", "found", "repaired"}], "origin", "notes"}: x and y in metres,
/// "in_file" the same place in the file's own numbers (longitude, latitude), "at_vertex" the vertex as it is written.
/// "origin" is round what place degrees were projected, or null; "distortion" {"length", "area", "certified"}, shares,
/// or null where no place on earth is known. What is no ring's has "code", "place", "found", "expected" and "repaired".
/// A number that is not finite is null.
OrderedJson json_of(const FileAnswer& answer);

/// One line per problem: "FILE: PLACE: words_of_place: what is wrong [E_CODE], would be repaired": on reading,
/// by any verb, for which it has one correct repair.
std::string lines_of(const FileAnswer& answer);

/// "FILE: wkt, 12 read: 10 valid, 1 repaired, 1 skipped, 0 rejected"; `repaired` is that word.
std::string counts_line(const FileAnswer& answer, const std::string& repaired = "repaired");

/// Which command can repair what is refused for its crossings; empty where nothing is.
std::string repair_hint(const FileAnswer& answer);

/// Text of `json`, whatever bytes are in its strings.
std::string text_of(const OrderedJson& json);

/// Degrees that became metres: what nobody may take for granted, since GeoJSON without units is one of degrees.
/// "FILE: projected from degrees to metres, centred on longitude X, latitude Y"; empty where nothing was projected.
std::string projection_line(const datasets::ObstacleFile& file);

/// Says the projection_line of a file that has one, and how to read it otherwise.
void say_projection(const datasets::ObstacleFile& file);

/// That, and what the notes say of the file as a whole: units that were assumed, unknown cells, its extent.
void say_notes(const datasets::ObstacleFile& file);

/// For a map: the notes, how many features are no obstacles, and that there is none where there is none.
void say_map(const datasets::ObstacleFile& file);

}  // namespace exactvo::tools
