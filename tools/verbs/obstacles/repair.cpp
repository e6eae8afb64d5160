// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo repair: repairs obstacle files and says what was done: before, after, and what can't be repaired.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/geometry/counted.h"
#include "figures/figure.h"
#include "figures/plane.h"
#include "support/escape.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

using datasets::ObstacleFile;
using datasets::RepairFacts;
using datasets::RepairRecord;
using formation::SceneObstacle;

namespace {

struct RepairFlags {
  std::vector<std::string> files;
  ReadingFlags reading;
  std::string out, to, figure;
  bool json = false;
  bool metres = false;
};

// --- What comes out ---

/// What the ids of each file's obstacles begin with: of several files the name without its extension, and a number
/// where an earlier one has that already.
std::vector<std::string> prefixes_of(const std::vector<FileAnswer>& answers) {
  std::vector<std::string> prefixes;
  std::set<std::string> taken;
  for (const FileAnswer& answer : answers) {
    const std::string stem = std::filesystem::path(answer.file).stem().string();
    std::string name = stem;
    for (int number = 2; !taken.insert(name).second; ++number) name = stem + "-" + std::to_string(number);
    prefixes.push_back(answers.size() > 1 ? name + "/" : "");
  }
  return prefixes;
}

std::vector<SceneObstacle> all_obstacles(const std::vector<FileAnswer>& answers) {
  const std::vector<std::string> prefixes = prefixes_of(answers);
  std::vector<SceneObstacle> all;
  for (std::size_t k = 0; k < answers.size(); ++k) {
    if (!answers[k].content) continue;
    for (const SceneObstacle& o : answers[k].content->obstacles) all.push_back({prefixes[k] + o.id, o.shape});
  }
  return all;
}

/// Beside `all_obstacles`; none where no file has any.
std::vector<datasets::FeatureProperties> all_properties(const std::vector<FileAnswer>& answers) {
  std::vector<datasets::FeatureProperties> all;
  bool any = false;
  for (const FileAnswer& answer : answers) {
    if (!answer.content) continue;
    const ObstacleFile& file = *answer.content;
    any = any || !file.properties.empty();
    all.insert(all.end(), file.properties.begin(), file.properties.end());
    if (file.properties.empty()) all.resize(all.size() + file.obstacles.size());
  }
  if (!any) all.clear();
  return all;
}

bool same_origin(const ObstacleFile& a, const ObstacleFile& b) {
  if (!a.origin || !b.origin) return !a.origin && !b.origin;
  return a.origin->longitude == b.origin->longitude && a.origin->latitude == b.origin->latitude;
}

std::vector<const ObstacleFile*> with_obstacles(const std::vector<FileAnswer>& answers) {
  std::vector<const ObstacleFile*> files;
  for (const FileAnswer& answer : answers)
    if (answer.content && !answer.content->obstacles.empty()) files.push_back(&*answer.content);
  return files;
}

std::string words_of_origin(const ObstacleFile& file) {
  if (!file.origin) return file.file + " (metres as they stand)";
  return fmt::format("{} (round {:.9g}, {:.9g} degrees)", file.file, file.origin->longitude, file.origin->latitude);
}

/// Degrees are projected round the middle of their own file: what lies side by side on earth would lie on one heap.
void refuse_several_planes(const std::vector<FileAnswer>& answers) {
  const std::vector<const ObstacleFile*> files = with_obstacles(answers);
  for (const ObstacleFile* file : files)
    if (!same_origin(*files.front(), *file))
      throw UsageError("files", words_of_origin(*files.front()) + " and " + words_of_origin(*file),
                       "one projection: cannot write one output from files in different projections");
}

/// That of all files with obstacles; nowhere on earth where they lie on several.
datasets::LocalPlane common_plane(const std::vector<FileAnswer>& answers) {
  const std::vector<const ObstacleFile*> files = with_obstacles(answers);
  if (files.empty()) return {};
  const datasets::LocalPlane& first = files.front()->plane;
  for (const ObstacleFile* file : files)
    if (file->plane.reference_system != first.reference_system || file->plane.offset != first.offset) return {};
  return first;
}

// --- The report ---

OrderedJson json_of(const RepairFacts& facts) {
  return {{"polygons", facts.polygons},
          {"rings", facts.rings},
          {"vertices", facts.vertices},
          {"area", facts.area < 0.0 ? OrderedJson() : OrderedJson(unsigned_zero(facts.area))},
          {"outer_area", unsigned_zero(facts.outer_area)},
          {"hole_area", unsigned_zero(facts.hole_area)}};
}

OrderedJson json_of(const RepairRecord& r) {
  OrderedJson codes = OrderedJson::array();
  for (const datasets::DataCode code : r.codes) codes.push_back(datasets::code_name(code));
  return {{"feature", r.place},
          {"id", r.id},
          {"codes", codes},
          {"refused", r.refused ? OrderedJson(datasets::code_name(*r.refused)) : OrderedJson(nullptr)},
          {"recombined", r.recombined},
          {"moved", unsigned_zero(r.moved)},
          {"before", json_of(r.before)},
          {"after", r.refused ? OrderedJson(nullptr) : json_of(r.after)}};
}

std::string to_json(const std::vector<FileAnswer>& answers) {
  OrderedJson json;
  json["repaired"] = exit_code(answers) == ExitCode::success;
  json["files"] = OrderedJson::array();
  for (const FileAnswer& answer : answers) {
    OrderedJson file = tools::json_of(answer);
    file["repairs"] = OrderedJson::array();
    if (answer.content) {
      for (const RepairRecord& record : answer.content->repairs) file["repairs"].push_back(json_of(record));
    }
    json["files"].push_back(file);
  }
  return text_of(json);
}

std::string codes_of(const RepairRecord& r) {
  std::string text;
  for (const datasets::DataCode code : r.codes) text += (text.empty() ? "" : " ") + std::string(code_name(code));
  return text;
}

/// Where each feature's first problem is that has more than one right answer.
using FirstProblems = std::map<std::string, std::string>;

FirstProblems first_problems(const ObstacleFile& file) {
  using datasets::DataCode;
  FirstProblems first;
  for (const datasets::RingFinding& f : file.findings) {
    const bool is_plain =
        f.code == DataCode::unclosed || f.code == DataCode::repeated_vertex || f.code == DataCode::clockwise;
    if (is_plain || first.count(f.feature) > 0) continue;
    first[f.feature] = fmt::format("ring {}, vertex {}, {}", f.ring, f.vertex, words_of_place(f));
  }
  return first;
}

std::string words_of_holes(const RepairFacts& before, const RepairFacts& after) {
  const auto holes = [](const RepairFacts& facts) { return facts.rings - facts.polygons; };
  if (holes(before) + holes(after) == 0) return "";
  return fmt::format("; holes {} -> {}, within them {:.9g} -> {:.9g} m^2", holes(before), holes(after),
                     before.hole_area, after.hole_area);
}

std::string words_of(const std::string& file, const RepairRecord& r, const FirstProblems& problems) {
  const auto problem = problems.find(r.place);
  const std::string where = problem == problems.end() ? "" : problem->second;
  const std::string start = shown(file + ": " + r.place + ": " + codes_of(r) + ": " + where);
  return fmt::format("{}: polygons {} -> {}, vertices {} -> {}, within outer rings {:.9g} -> {:.9g} m^2{}{}\n", start,
                     r.before.polygons, r.after.polygons, r.before.vertices, r.after.vertices, r.before.outer_area,
                     r.after.outer_area, words_of_holes(r.before, r.after),
                     r.moved > 0.0 ? fmt::format("; crossings moved by {:.3g} m at most", r.moved) : "");
}

/// The codes of all repairs with the count of each: what most people want to know of a file with thousands.
std::string tally_of(const ObstacleFile& file) {
  std::map<datasets::DataCode, std::size_t> counts = file.unlisted;
  for (const datasets::RingFinding& f : file.findings) ++counts[f.code];
  std::string text;
  for (const auto& [code, count] : counts) text += fmt::format(" {} x {}", count, datasets::code_name(code));
  return text;
}

/// More than its winding, closure and repeated vertices: those are told by their number only.
bool is_told(const RepairRecord& r) {
  return !r.refused && (r.recombined || r.before.rings != r.after.rings);
}

void note_areas(const ObstacleFile& file) {
  const auto is_cut = [](const RepairRecord& r) { return is_told(r) && r.recombined; };
  if (std::any_of(file.repairs.begin(), file.repairs.end(), is_cut))
    message("note: areas before are by the shoelace formula, in which loops of opposite winding cancel");
}

void print_report(const std::vector<FileAnswer>& answers) {
  for (const FileAnswer& answer : answers) {
    if (!answer.content) continue;  // said as an error
    const FirstProblems problems = first_problems(*answer.content);
    for (const RepairRecord& record : answer.content->repairs) {
      if (is_told(record)) print(words_of(answer.content->file, record, problems));
    }
    for (const datasets::DataError& error : answer.content->rejected)
      print("not repaired: " + shown(error.what()) + "\n");
    note_areas(*answer.content);
    const std::string tally = tally_of(*answer.content);
    message(counts_line(answer) + (tally.empty() ? "" : ";" + tally));
  }
}

// --- The figure: polygons side by side, the rings as given with their problems marked, and the polygons that they
// became, a colour each ---

/// As many as go onto a sheet.
constexpr std::size_t kMostDrawn = 6;
constexpr double kSideOfPlot = 340.0;  // px of what the axes enclose
constexpr double kGapOfPlots = 60.0;   // px
/// "-1.2e+06", eight characters of 6 px, and a gap of two.
constexpr double kWidthOfTic = 60.0;  // px

constexpr const char* kProblemMark = "with points pt 6 ps 1.6 lw 2.5 lc rgb '#e00000'";

void add_panel(const std::string& title, const Panel& panel, Sheet& sheet) {
  const std::string from = panel.origin.in_title();
  const std::size_t room = characters_in(1.3 * (kSideOfPlot + 0.5 * kGapOfPlots));
  const std::string words = letter_of(sheet.panels.size()) + " " + title;
  sheet.panels.push_back(panel.on_sheet(quoted(shortened(words, room - std::min(from.size(), room / 2)) + from)));
  const double least = kWidthOfTic / kSideOfPlot * std::max(panel.view.width(), panel.view.height());
  sheet.panels.back().settings += fmt::format("\nset xtics {:.9g}", round_size(least));
}

/// Before and after. Each polygon with its own holes: what lies in a hole of another keeps its colour.
void add_row(const std::string& title, const std::vector<geometry::Ring>& given, const Points& problems,
             const std::vector<geometry::Polygon>& after, DataFile& data, Sheet& sheet) {
  Box box;
  for (const geometry::Ring& ring : given)
    for (const Vec2 p : ring) box.add(p);
  const Box view = square_round(box, 0.56);
  Panel as_given(view, data), repaired(view, data);
  as_given.rings("before: " + title, given, line_style(2, kObstacleLine));
  as_given.points("problems", problems, kProblemMark);
  add_panel("before: " + title, as_given, sheet);
  std::vector<Points> rings;
  for (std::size_t k = 0; k < after.size(); ++k) {
    repaired.rings(
        "polygon, its holes tied to it", {tied_together(after[k])},
        fmt::format("with filledcurves closed fs transparent solid 0.45 noborder fc rgb '{}'", series_colour(k)));
    rings.push_back(after[k].outer);
    rings.insert(rings.end(), after[k].holes.begin(), after[k].holes.end());
  }
  repaired.rings("rings after", rings, line_style(1.5, kObstacleLine));
  add_panel(after.empty() ? "after: cannot be repaired" : "after: " + geometry::counted(after.size(), "polygon"),
            repaired, sheet);
}

/// What became of one polygon: the obstacles "7", "7-2", "7-3".
std::vector<geometry::Polygon> outcome(const ObstacleFile& file, const RepairRecord& record) {
  std::vector<geometry::Polygon> polygons;
  if (record.refused) return polygons;
  const auto first = std::find_if(file.obstacles.begin(), file.obstacles.end(),
                                  [&](const SceneObstacle& o) { return o.id == record.id; });
  for (auto o = first; o != file.obstacles.end() && polygons.size() < record.after.polygons; ++o) {
    // A wall may bear the same id.
    if (const auto* polygon = std::get_if<geometry::Polygon>(&o->shape)) polygons.push_back(*polygon);
  }
  return polygons;
}

std::vector<geometry::Vec2> places_of_problems(const ObstacleFile& file, const RepairRecord& record) {
  std::vector<geometry::Vec2> places;
  for (const datasets::RingFinding& f : file.findings) {
    const bool is_grave = f.code == datasets::DataCode::self_intersection || f.code == datasets::DataCode::hole_outside;
    if (f.feature == record.place && is_grave) places.push_back(f.where);
  }
  return places;
}

void draw_figure(const std::vector<FileAnswer>& answers, const std::string& out) {
  DataFile data;
  Sheet sheet;
  std::size_t number = 0;
  for (const FileAnswer& answer : answers) {
    if (!answer.content) continue;
    for (const RepairRecord& r : answer.content->repairs) {
      // Only those that are drawn: each takes a look at all findings and obstacles.
      if (!r.recombined || ++number > kMostDrawn) continue;
      const std::string name = std::filesystem::path(answer.file).filename().string();
      add_row(name + ", " + r.place, r.given, places_of_problems(*answer.content, r), outcome(*answer.content, r), data,
              sheet);
    }
  }
  if (number == 0) return message("no figure: nothing had to be cut");
  if (number > kMostDrawn)
    message(fmt::format("the figure shows {} of {} that were cut", kMostDrawn, geometry::counted(number, "polygon")));
  sheet.title = "'Polygons before and after their repair'";
  sheet.x_label = "'x [m]'";
  sheet.y_label = "'y [m]'";
  sheet.columns = 2;
  sheet.panel_width = sheet.panel_height = kSideOfPlot;
  sheet.gap = kGapOfPlots;
  sheet.legend = {{"keyentry " + line_style(2, kObstacleLine), "outline"},
                  {std::string("keyentry ") + kProblemMark, "problem"},
                  {fmt::format("keyentry with boxes fs transparent solid 0.45 noborder fc rgb '{}'", series_colour(0)),
                   "polygon, a colour each"}};
  write_figure(sheet_figure("repair", data.text(), "Polygons before and after a repair.", sheet), out);
}

// --- The verb ---

ExitCode repair(const RepairFlags& flags) {
  datasets::ReadOptions options = reading_options(flags.reading);
  options.repair = true;
  options.keep_properties = true;
  if (!flags.figure.empty())
    check_figure_name("--figure", flags.figure, all_read_with(flags.files, flags.reading.format, flags.out));
  if (flags.out == "-") throw UsageError("--out", "-", "a file: stdout has the report");
  check_format("--to", flags.to, datasets::writable_formats());
  const std::string to = datasets::format_to_write(flags.out, flags.to);
  for (const std::string& file : flags.files) refuse_input_as_output(file, flags.reading.format, "--out", flags.out);
  const std::vector<FileAnswer> answers = read_each(flags.files, options);
  const ExitCode code = exit_code(answers);
  if (flags.json) {
    print(to_json(answers));
  } else {
    print_report(answers);
  }
  if (code == ExitCode::bad_input) {
    for (const FileAnswer& answer : answers) {
      if (answer.error) error_message(answer.error->what() + guess_words(answer));
    }
    return code;
  }
  refuse_several_planes(answers);
  write_or_print(flags.out, all_obstacles(answers), {to, common_plane(answers), flags.metres, all_properties(answers)});
  message("wrote " + flags.out);
  if (!flags.figure.empty()) draw_figure(answers, flags.figure);
  return code;
}

void declare_repair(CLI::App& app, RepairFlags& flags) {
  app.add_option("files", flags.files, "Obstacle files of any readable format")->required();
  app.add_option("--out", flags.out,
                 "Output file for the repaired obstacles of all inputs; its extension selects the format")
      ->required();
  app.add_option("--to", flags.to, "The format of --out, if its extension does not determine it");
  declare_reading_flags(app, flags.reading);
  declare_metres(app, flags.metres);
  app.add_flag("--json", flags.json, "The report as JSON on stdout");
  app.add_option("--figure", flags.figure, std::string("Every changed polygon before and after. ") + kFigureFileHelp);
}

}  // namespace

Verb repair_verb() {
  return {"repair", "Repair invalid obstacle files: winding, closure, spikes, self-crossings, overlaps",
          "  exactvo repair buildings.geojson --out repaired.geojson --figure repaired.svg\n"
          "    (status 1: some obstacles cannot be repaired; the others are written)\n",
          with_flags(declare_repair, repair)};
}

}  // namespace exactvo::tools
