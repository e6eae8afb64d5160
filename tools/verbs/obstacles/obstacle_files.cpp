// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/obstacles/obstacle_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "exactvo/datasets/input_files.h"
#include "exactvo/geometry/counted.h"
#include "support/escape.h"
#include "support/files.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

using datasets::DataError;
using datasets::ObstacleFile;
using datasets::RingFinding;

namespace {

FileAnswer read_one(const std::string& file, const datasets::ReadOptions& options) {
  try {
    FileAnswer answer{file, datasets::read_obstacles(file, options), std::nullopt};
    say_notes(*answer.content);
    return answer;
  } catch (const DataError& error) {
    return {file, std::nullopt, error, options.format.empty() ? guessed_format(file) : ""};
  }
}

OrderedJson problem_json(const RingFinding& f) {
  const geometry::Vec2 in_file = f.in_file ? f.in_file->where : f.where;  // the file's numbers are metres unless said
  return {{"code", datasets::code_name(f.code)},
          {"place", f.place},
          {"feature", f.feature},
          {"ring", f.ring},
          {"vertex", f.vertex},
          {"x", unsigned_zero(f.where.x)},
          {"y", unsigned_zero(f.where.y)},
          {"in_file", json_point(unsigned_zero(in_file))},
          {"at_vertex", json_point(unsigned_zero(f.at_vertex))},
          {"found", datasets::words_of(f)},
          {"repaired", f.repaired}};
}

/// A refusal that is no ring's finding: of the text, or of the file.
OrderedJson problem_json(const DataError& error) {
  return {{"code", datasets::code_name(error.code())},
          {"place", error.place()},
          {"found", error.found()},
          {"expected", error.expected()},
          {"repaired", false}};
}

/// What was refused and is no ring's finding.
std::vector<const DataError*> other_refusals(const ObstacleFile& content) {
  std::set<std::pair<datasets::DataCode, std::string_view>> of_rings;
  for (const RingFinding& f : content.findings) {
    if (!f.repaired) of_rings.emplace(f.code, f.place);
  }
  std::vector<const DataError*> others;
  for (const DataError& error : content.rejected) {
    if (of_rings.count({error.code(), error.place()}) == 0) others.push_back(&error);
  }
  return others;
}

}  // namespace

void declare_reading_flags(CLI::App& app, ReadingFlags& flags, const std::string& format_name) {
  app.add_option(format_name, flags.format,
                 fmt::format("Input format: {}; by default detected from content, then name",
                             fmt::join(datasets::readable_formats(), " ")));
  app.add_option("--units", flags.units, "Units of coordinates: automatic, metres or degrees");
  app.add_option("--unknown", flags.unknown, "Unknown cells of ROS maps: free or blocked");
  app.add_option("--cell-size", flags.cell_size, "Cell size of scans, point lists and grids without a scale, m");
}

void check_format(const std::string& option, const std::string& format, const std::vector<std::string>& known) {
  if (!format.empty()) require_known(option, format, known);
}

datasets::ReadOptions reading_options(const ReadingFlags& flags, const std::string& format_name) {
  check_format(format_name, flags.format, datasets::readable_formats());
  require_known("--units", flags.units, datasets::unit_names());
  require_known("--unknown", flags.unknown, datasets::unknown_cells_names());
  if (!(flags.cell_size >= 0.0) || std::isinf(flags.cell_size))
    throw UsageError("--cell-size", fmt::format("{}", flags.cell_size), "a length in m, or 0 for the default");
  datasets::ReadOptions options;
  options.format = flags.format;
  parse(flags.units, options.units);
  parse(flags.unknown, options.unknown);
  options.cell_size = flags.cell_size;
  options.keep_going = true;
  return options;
}

void refuse_input_as_output(const std::string& in, const std::string& format, const std::string& option,
                            const std::string& out) {
  for (const std::filesystem::path& file : datasets::files_read_with(in, format)) {
    std::error_code error;
    if (std::filesystem::equivalent(file, out, error))
      throw UsageError(option, out, "another file than the input " + file.string());
  }
}

std::vector<std::filesystem::path> all_read_with(const std::vector<std::string>& files, const std::string& format,
                                                 const std::string& out) {
  std::vector<std::filesystem::path> all;
  for (const std::string& file : files)
    for (std::filesystem::path& read : datasets::files_read_with(file, format)) all.push_back(std::move(read));
  if (!out.empty()) all.emplace_back(out);
  return all;
}

void declare_metres(CLI::App& app, bool& metres) {
  app.add_flag("--metres", metres,
               "GeoJSON in metres, which other programs take for degrees; without it longitude and latitude");
}

void note_place_on_earth(const datasets::LocalPlane& plane) {
  if (plane.is_placed()) return;
  message("note: no place on earth is known: the GeoJSON lies round longitude 0, latitude 0; --metres writes metres");
}

std::string output_format(const std::string& out, const std::string& to) {
  return datasets::format_to_write(out == "-" ? "stdout.wkt" : out, to);
}

void write_or_print(const std::string& out, const std::vector<formation::SceneObstacle>& obstacles,
                    const datasets::WriteOptions& options) {
  if (options.format == "geojson" && !options.metres) note_place_on_earth(options.plane);
  const auto write = [&](const std::filesystem::path& file) {
    for (const std::string& loss : datasets::write_obstacles(file, obstacles, options)) message("lost: " + loss);
  };
  if (out != "-") return write(out);
  const StagedFolder folder(std::filesystem::temp_directory_path() / "exactvo");
  const std::filesystem::path file = folder.path() / ("obstacles." + options.format);
  write(file);
  std::ifstream written(file, std::ios::binary);
  print({std::istreambuf_iterator<char>(written), std::istreambuf_iterator<char>()});
}

std::string guessed_format(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return "";  // a pipe is empty by now
  try {
    return datasets::may_be_another_format(file) ? datasets::format_of(file) : "";
  } catch (const DataError&) {
    return "";
  }
}

std::string guess_words(const FileAnswer& answer, const std::string& option) {
  using datasets::DataCode;
  const DataCode code = answer.error ? answer.error->code() : DataCode::size;
  // Another format would not help; an empty file has none.
  const bool is_no_guess =
      code == DataCode::size || code == DataCode::file_unreadable || code == DataCode::format_unknown;
  if (is_no_guess || answer.guessed_format.empty()) return "";
  return fmt::format("; read as {}, which is guessed from its content and name: {} names another format",
                     answer.guessed_format, option);
}

std::vector<FileAnswer> read_each(const std::vector<std::string>& files, const datasets::ReadOptions& options) {
  std::vector<FileAnswer> answers;
  for (const std::string& file : files) {
    if (interrupted()) throw Interrupted();
    answers.push_back(read_one(file, options));
  }
  if (interrupted()) throw Interrupted();
  return answers;
}

ExitCode exit_code(const std::vector<FileAnswer>& answers, bool strict) {
  const auto is_unread = [](const FileAnswer& a) { return a.error.has_value(); };
  if (std::any_of(answers.begin(), answers.end(), is_unread)) return ExitCode::bad_input;
  const auto passes = [&](const FileAnswer& a) { return a.is_whole() && (!strict || a.content->findings.empty()); };
  return std::all_of(answers.begin(), answers.end(), passes) ? ExitCode::success : ExitCode::negative;
}

OrderedJson json_of(const FileAnswer& answer) {
  const auto empty = OrderedJson::array();
  OrderedJson json{
      {"file", answer.file},   {"format", nullptr}, {"verdict", "unreadable"},           {"code", nullptr},
      {"counts", nullptr},     {"problems", empty}, {"unlisted", OrderedJson::object()}, {"origin", nullptr},
      {"distortion", nullptr}, {"notes", empty}};
  if (answer.error) {
    json["code"] = datasets::code_name(answer.error->code());
    json["problems"].push_back(problem_json(*answer.error));
  }
  if (!answer.content) return json;
  const ObstacleFile& content = *answer.content;
  const datasets::ReadCounts& n = content.counts;
  json["format"] = content.format;
  json["verdict"] = n.rejected > 0 ? "invalid" : n.repaired > 0 ? "repaired" : "valid";
  if (n.rejected > 0) json["code"] = datasets::code_name(content.rejected.front().code());
  json["counts"] = {{"read", n.read},
                    {"done", n.done},
                    {"repaired", n.repaired},
                    {"passed_over", n.passed_over},
                    {"rejected", n.rejected}};
  for (const RingFinding& f : content.findings) json["problems"].push_back(problem_json(f));
  for (const DataError* error : other_refusals(content)) json["problems"].push_back(problem_json(*error));
  for (const auto& [code, count] : content.unlisted) json["unlisted"][datasets::code_name(code)] = count;
  if (content.origin)
    json["origin"] = {{"longitude", unsigned_zero(content.origin->longitude)},
                      {"latitude", unsigned_zero(content.origin->latitude)}};
  if (content.distortion)
    json["distortion"] = {{"length", content.distortion->length},
                          {"area", content.distortion->area},
                          {"certified", content.distortion->certified}};
  for (const datasets::DataNote& note : content.notes)
    if (!note.code) json["notes"].push_back(note.place.empty() ? note.text : note.place + ": " + note.text);
  return json;
}

std::string lines_of(const FileAnswer& answer) {
  if (answer.error) return shown(answer.error->what() + guess_words(answer)) + "\n";
  std::string text;
  for (const RingFinding& f : answer.content->findings) {
    text += shown(fmt::format("{}: {}: {}: {} [{}]{}", answer.file, f.place, datasets::words_of_place(f),
                              datasets::words_of(f), datasets::code_name(f.code),
                              f.repaired ? ", would be repaired" : "")) +
            "\n";
  }
  for (const DataError* error : other_refusals(*answer.content)) text += shown(error->what()) + "\n";
  for (const auto& [code, count] : answer.content->unlisted)
    text += shown(fmt::format("{}: {} more, not listed [{}]", answer.file, count, datasets::code_name(code))) + "\n";
  return text;
}

std::string counts_line(const FileAnswer& answer, const std::string& repaired) {
  if (!answer.content) return shown(answer.file) + ": refused";
  const datasets::ReadCounts& n = answer.content->counts;
  return fmt::format("{}: {}, {} read: {} valid, {} {}, {} skipped, {} rejected", shown(answer.file),
                     answer.content->format, n.read, n.done, n.repaired, repaired, n.passed_over, n.rejected);
}

std::string repair_hint(const FileAnswer& answer) {
  using datasets::DataCode;
  if (!answer.content) return "";
  const auto& all = answer.content->findings;
  const bool any = std::any_of(all.begin(), all.end(), [](const RingFinding& f) {
    return !f.repaired && (f.code == DataCode::self_intersection || f.code == DataCode::hole_outside);
  });
  return any ? "exactvo repair " + shown(answer.file) + " --out FILE can cut its rings at their crossings" : "";
}

std::string text_of(const OrderedJson& json) {
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string projection_line(const datasets::ObstacleFile& file) {
  if (!file.origin) return "";
  return fmt::format("{}: projected from {} to metres, centred on longitude {}, latitude {}", file.file,
                     file.projected_from, file.origin->longitude, file.origin->latitude);
}

void say_projection(const datasets::ObstacleFile& file) {
  if (const std::string line = projection_line(file); !line.empty())
    message(line + "; --units metres takes them as they stand");
}

void say_notes(const datasets::ObstacleFile& file) {
  say_projection(file);
  for (const datasets::DataNote& note : file.notes) {
    const bool is_said = file.origin && note.text.find("; brought to metres round ") != std::string::npos;
    if (note.of_feature || is_said) continue;
    message(shown(file.file + ": " + (note.place.empty() ? "" : note.place + ": ") + note.text));
  }
}

void say_map(const datasets::ObstacleFile& file) {
  say_notes(file);
  if (file.counts.passed_over > 0)
    message(shown(fmt::format("{}: {} skipped: points and empty geometries are no obstacles", file.file,
                              geometry::counted(file.counts.passed_over, "feature"))));
  if (file.obstacles.empty()) message(shown(file.file + ": no obstacle in it"));
}

}  // namespace exactvo::tools
