// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo convert: obstacles from one format to another, with what is lost said.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/geometry/counted.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

using geometry::counted;

namespace {

struct ConvertFlags {
  std::string in, out, to;
  ReadingFlags reading;
  bool repair = false;
  bool skip = false;
  bool metres = false;
};

void say_what_was_read(const datasets::ObstacleFile& file) {
  if (file.coverage) {
    message(fmt::format("{}: occupied cells: {} of {}; they became {}, exactly those", file.file,
                        file.coverage->occupied, file.coverage->cells, counted(file.obstacles.size(), "polygon")));
  }
  say_notes(file);
  if (file.counts.repaired > 0)
    message(fmt::format("{}: {} repaired", file.file, counted(file.counts.repaired, "obstacle")));
  if (file.counts.passed_over > 0)
    message(fmt::format("{}: lost {} (points, empty geometries): no obstacle", file.file,
                        counted(file.counts.passed_over, "input")));
}

/// Nothing where it cannot be read, which is reported then.
std::optional<datasets::ObstacleFile> read(const ConvertFlags& flags) {
  datasets::ReadOptions options = reading_options(flags.reading, "--from");
  options.repair = flags.repair;
  options.keep_going = flags.skip;
  options.keep_properties = true;
  try {
    return datasets::read_obstacles(flags.in, options);
  } catch (const datasets::DataError& error) {
    const std::string place = error.place();
    if (place.find("ring") != std::string::npos && !flags.repair)
      message("--repair repairs most such problems, --skip omits such obstacles");
    if (interrupted()) throw;
    const std::string guessed = options.format.empty() ? guessed_format(flags.in) : "";
    error_message(error.what() + guess_words({flags.in, std::nullopt, error, guessed}, "--from"));
    return std::nullopt;
  }
}

ExitCode convert_crowd(const ConvertFlags& flags) {
  if (std::filesystem::path(flags.out).extension() != ".csv")
    throw UsageError("out", flags.out, "FILE.csv, for a recording of a crowd");
  datasets::AtomicFile table(flags.out);
  const datasets::CrowdTable written = datasets::write_crowd_csv(flags.in, table);
  table.commit();
  message(fmt::format("{} -> {}: {}", flags.in, flags.out, counted(written.rows, "row")));
  if (!written.cut_off) return ExitCode::success;
  message(flags.in + ": the file was cut off after the last of these rows");
  return ExitCode::negative;
}

ExitCode convert(const ConvertFlags& flags) {
  if (std::filesystem::path(flags.in).extension() == ".evr") return convert_crowd(flags);
  check_format("--to", flags.to, datasets::writable_formats());
  const std::string to = output_format(flags.out, flags.to);
  refuse_input_as_output(flags.in, flags.reading.format, "out", flags.out);
  std::optional<datasets::ObstacleFile> content = read(flags);
  if (!content) return ExitCode::bad_input;
  datasets::ObstacleFile& file = *content;
  for (const datasets::DataError& error : file.rejected) message(std::string("left out: ") + error.what());
  say_what_was_read(file);
  write_or_print(flags.out, file.obstacles, {to, file.plane, flags.metres, std::move(file.properties)});
  message(fmt::format("{} ({}) -> {} ({}): {}", file.file, file.format, flags.out, to,
                      counted(file.obstacles.size(), "obstacle")));
  return file.rejected.empty() ? ExitCode::success : ExitCode::negative;
}

void declare_convert(CLI::App& app, ConvertFlags& flags) {
  app.add_option("in", flags.in, "An obstacle file of any readable format, or a crowd's recording, .evr, for FILE.csv")
      ->required();
  app.add_option("out", flags.out,
                 "The file to write; its extension selects the format. - is stdout (wkt, or the format of --to)")
      ->required();
  declare_reading_flags(app, flags.reading, "--from");
  app.add_option("--to", flags.to, fmt::format("What to write: {}", fmt::join(datasets::writable_formats(), " ")));
  declare_metres(app, flags.metres);
  app.add_flag("--repair", flags.repair, "Repair invalid geometry (exactvo repair lists the changes)");
  app.add_flag("--skip", flags.skip, "Omit invalid obstacles, and end with status 1");
}

}  // namespace

Verb convert_verb() {
  return {"convert", "Convert obstacles from one file format to another",
          "  exactvo convert map.yaml map.geojson\n"
          "  exactvo convert city.osm city.gpkg --repair --skip\n",
          with_flags(declare_convert, convert)};
}

}  // namespace exactvo::tools
