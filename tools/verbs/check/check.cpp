// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo check: whether bodies on recorded or planned trajectories touch each other or a map, in continuous time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/moving_ai.h"
#include "exactvo/datasets/trajectory_pieces.h"
#include "exactvo/geometry/counted.h"
#include "figures/figure.h"
#include "support/check_certificates.h"
#include "support/check_page.h"
#include "support/footprint.h"
#include "support/parse_errors.h"
#include "support/run.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/check/answer.h"
#include "verbs/check/figure.h"
#include "verbs/obstacles/obstacle_files.h"
#include "verbs/runs/view.h"

namespace exactvo::tools {

using datasets::DataError;
using datasets::TrajectoryFile;
using datasets::TrajectoryReader;
using datasets::TrajectoryRow;
using datasets::TrajectorySurvey;
using geometry::Between;
using geometry::MetPair;
using geometry::RigidBody;

namespace {

struct CheckFlags {
  std::vector<std::string> files;
  std::string format, map, footprint, certificates, figure, page;
  std::string between = "straight";
  ReadingFlags reading;  ///< of the map
  std::optional<double> radius, near, max_speed, max_gap, frame_rate;
  double scale = 1.0;
  std::size_t samples = 0;
  bool json = false;
};

void require_positive(const std::string& option, double value, const std::string& what) {
  require(value > 0.0 && std::isfinite(value), option, fmt::format("{}", value), what);
}

void check_flags(const CheckFlags& flags) {
  check_format("--format", flags.format, datasets::trajectory_formats());
  require_known("--between", flags.between, between_names());
  reading_options(flags.reading, "--map-format");
  require_positive("--scale", flags.scale, "metres of one unit of length, above 0");
  if (flags.frame_rate) require_positive("--frame-rate", *flags.frame_rate, "frames a second, above 0");
  if (flags.radius) require_length("--radius", *flags.radius);
  if (flags.near) require_length("--near", *flags.near);
  if (flags.max_speed) require_positive("--max-speed", *flags.max_speed, "a speed in m/s, above 0");
  if (flags.max_gap) require_positive("--max-gap", *flags.max_gap, "a time in s, above 0");
  std::vector<std::filesystem::path> others;
  if (!flags.map.empty()) others = all_read_with({flags.map}, flags.reading.format);
  others.insert(others.end(), flags.files.begin(), flags.files.end());
  for (const std::string& file : {flags.certificates, flags.footprint})
    if (!file.empty()) others.emplace_back(file);
  check_figure_name("--figure", flags.figure, others);
  if (!flags.page.empty()) check_page_name("--page", flags.page, others);
  if (!flags.page.empty() && std::filesystem::path(flags.page).lexically_normal() ==
                                 std::filesystem::path(flags.certificates).lexically_normal())
    throw UsageError("--page", flags.page, "another file than --certificates writes");
  if (flags.certificates.empty()) return;
  for (const std::string& file : flags.files) refuse_input_as_output(file, "", "--certificates", flags.certificates);
  if (!flags.map.empty()) refuse_input_as_output(flags.map, flags.reading.format, "--certificates", flags.certificates);
}

// --- What moves ---

struct Bodies {
  std::vector<RigidBody> of_agent;
  double reach = 0.0;  ///< m, of the largest
  std::string words;
  bool has_rims = true;  ///< they have a radius
  bool on_arcs = false;  ///< some turn between rows
};

Bodies discs(const CheckFlags& flags, const TrajectoryFile& file, const TrajectorySurvey& survey) {
  Bodies bodies;
  if (!flags.radius && file.radii.empty())
    throw missing_option("check", "option --radius or --footprint", "the size of the bodies, which the file lacks");
  for (std::size_t k = 0; k < file.agents.size(); ++k) {
    const double radius = flags.radius ? *flags.radius : file.radii[k];
    bodies.of_agent.push_back(geometry::disc_body(radius));
    bodies.reach = std::max(bodies.reach, radius);
  }
  bodies.words = flags.radius ? fmt::format("discs of radius {:.6g} m", *flags.radius) : "discs of the file's radii";
  if (file.on_wheels > 0)
    bodies.words +=
        fmt::format(", of robots on wheels round the {}", flags.radius ? "axle's centre" : "reference point");
  else if (survey.has_headings())
    bodies.words += ", which have no heading";
  return bodies;
}

Bodies footprints(const CheckFlags& flags, const TrajectoryReader& reader, const TrajectorySurvey& survey) {
  const RigidBody footprint = footprint_body(footprint_shape(flags.footprint), flags.radius.value_or(0.0));
  Bodies bodies{{}, reach_of(footprint), "the footprint at its heading"};
  bodies.has_rims = flags.radius.value_or(0.0) > 0.0;
  bool some_turn = false;
  for (std::size_t k = 0; k < survey.agents().size(); ++k) {
    const datasets::AgentSurvey& agent = survey.agents()[k];
    some_turn |= agent.turns_at > 0;
    if (agent.turns_at > 0 && flags.between == "cubic")
      reader.refuse(datasets::DataCode::out_of_range, agent.turns_at,
                    fmt::format("agent {} at another heading than before", reader.file().agents[k]),
                    "one heading of an agent: on cubics, a footprint that turns is not decided");
    bodies.of_agent.push_back(footprint);
  }
  bodies.on_arcs = survey.has_headings() && some_turn && flags.between == "straight";
  if (!survey.has_headings())
    bodies.words += " as given, since the file has no headings";
  else if (bodies.on_arcs)
    bodies.words += ", which turns evenly from row to row, on the arc of a constant twist (corners rounded)";
  else
    bodies.words += some_turn ? " (corners rounded)" : ", which no agent changes (corners rounded)";
  if (flags.radius) bodies.words += fmt::format(", grown by {:.6g} m", *flags.radius);
  if (reader.file().on_wheels > 0) bodies.words += ", of robots on wheels at the axle's centre";
  const bool some_lack_one = std::any_of(survey.agents().begin(), survey.agents().end(),
                                         [](const datasets::AgentSurvey& a) { return std::isnan(a.heading); });
  if (survey.has_headings() && some_lack_one) bodies.words += ", as given for agents without a heading";
  if (!bodies.has_rims) bodies.words += "; the depth of polygons is not measured";
  return bodies;
}

// --- Where it moves ---

struct CheckMap {
  std::string name;
  std::vector<formation::SceneObstacle> obstacles;
  std::vector<geometry::Obstacle> shapes;
  std::vector<std::optional<geometry::Disc>> discs;  ///< of each obstacle, where it is one
  std::optional<datasets::MapSize> cells;            ///< of a Moving AI map
  double cell_side = 1.0;                            ///< m
};

CheckMap map_of(const CheckFlags& flags, const TrajectoryFile& file) {
  CheckMap map;
  if (flags.map.empty()) {
    map.name = file.obstacles.empty() ? "" : file.file;
    map.obstacles = file.obstacles;
  } else {
    datasets::ReadOptions reading = reading_options(flags.reading, "--map-format");
    reading.keep_going = false;
    datasets::ObstacleFile content = datasets::read_obstacles(flags.map, reading);
    say_map(content);
    map.name = flags.map;
    map.obstacles = std::move(content.obstacles);
    std::error_code error;
    if (content.format == "movingai-map" && std::filesystem::is_regular_file(flags.map, error)) {
      map.cells = datasets::read_map_size(flags.map);
      if (reading.cell_size > 0.0) map.cell_side = reading.cell_size;
    }
  }
  for (const formation::SceneObstacle& o : map.obstacles) {
    map.shapes.push_back(o.shape);
    map.discs.push_back(o.disc);
  }
  return map;
}

/// Cells of a plan to the middle of the map's cells, whose rows count from the top.
class Placing {
 public:
  Placing(const TrajectoryFile& file, const CheckMap& map, double scale) : side_(map.cell_side) {
    if (!file.in_cells || !map.cells) return;
    require(scale == side_, "--scale", fmt::format("{}", scale),
            fmt::format("the side of the map's cells, {} m (--cell-size changes it)", side_));
    top_ = side_ * static_cast<double>(map.cells->rows);
  }
  void place(TrajectoryRow& row) const {
    if (top_) row.at = {row.at.x + 0.5 * side_, *top_ - (row.at.y + 0.5 * side_)};
  }

 private:
  double side_;                ///< m
  std::optional<double> top_;  ///< m, of the map
};

// --- The check ---

TrajectorySurvey survey_of(TrajectoryReader& reader) {
  ProgressLine progress(0.0, "rows");
  TrajectorySurvey survey;
  reader.read([&](const TrajectoryRow& row) {
    survey.add(row);
    if ((survey.rows() & 0xfff) == 0) {
      if (interrupted()) throw Interrupted();
      if (progress.is_due()) progress.say(fmt::format("reading, {} rows", survey.rows()));
    }
  });
  return survey;
}

void say_what_was_read(const TrajectoryFile& file, const TrajectorySurvey& survey) {
  for (const std::string& note : file.notes) message(file.file + ": " + note);
  if (file.repeated > 0)
    message(fmt::format("{}: {} left out", file.file,
                        geometry::counted(file.repeated, "row that repeats the one before was",
                                          "rows that repeat the one before were")));
  if (!survey.is_in_order())
    message(file.file + ": rows are not in the order of time, so all of them are kept in memory");
}

CheckedFile asked_of(const CheckFlags& flags, const TrajectoryFile& file, const TrajectorySurvey& survey,
                     const Bodies& bodies, const CheckMap& map) {
  const bool has_curves = !file.curves.empty();
  const auto& names = between_names();
  const auto between = static_cast<Between>(std::find(names.begin(), names.end(), flags.between) - names.begin());
  if (has_curves && between != Between::straight)
    throw UsageError("--between", flags.between, "no such option for polynomials, which say how agents move");
  if (has_curves && flags.max_gap)
    throw UsageError("--max-gap", fmt::format("{}", *flags.max_gap),
                     "no such option for polynomials, which say when agents are there");
  return {file,
          survey,
          map.name,
          map.obstacles,
          between,
          has_curves,
          bodies.words,
          flags.near.value_or(bodies.reach),
          flags.max_speed.value_or(survey.jump_speed()),
          flags.max_gap.value_or(std::numeric_limits<double>::infinity()),
          flags.samples,
          bodies.has_rims,
          bodies.on_arcs};
}

/// What a check makes besides its answer: proofs, a figure, a page, and what samples miss.
class Byproducts {
 public:
  Byproducts(const CheckFlags& flags, const CheckedFile& asked, const Bodies& bodies)
      : flags_(flags), sampled_(flags.samples, bodies.of_agent.size()) {
    if (!flags.certificates.empty()) certificates_.emplace(flags.certificates, asked, bodies.of_agent);
    if (!flags.figure.empty()) picture_.emplace(asked, bodies.of_agent);
    if (!flags.page.empty()) page_.emplace(asked, bodies.of_agent);
  }

  /// What gets the pairs that come near; empty where nothing wants them.
  std::function<void(const MetPair&)> met() {
    if (!certificates_) return {};
    return [this](const MetPair& pair) { certificates_->add(pair); };
  }
  void add(const TrajectoryRow& row) {
    if (picture_) picture_->add(row);
  }
  void add(std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned) {
    if (flags_.samples > 0) sampled_.add(agent, piece);
    if (page_) page_->add(agent, piece, turned);
  }
  void add(const geometry::MotionEvent& event) {
    if (flags_.samples > 0 && event.encounter == geometry::Encounter::overlap && !sampled_.finds(event)) ++missed_;
    if (picture_) picture_->add(event);
    if (page_) page_->add(event);
  }
  /// Overlaps that samples do not find.
  std::uint64_t missed() const { return missed_; }

  void write(const geometry::MotionCheck& result) {
    if (certificates_) message(certificates_->finish());
    if (picture_) write_figure(picture_->figure(result), flags_.figure);
    if (!page_) return;
    publish_page(flags_.page, page_->page(result));
  }

 private:
  const CheckFlags& flags_;
  std::optional<CheckCertificates> certificates_;
  std::optional<CheckPicture> picture_;
  std::optional<CheckPage> page_;
  SampledMoves sampled_;
  std::uint64_t missed_ = 0;
};

/// One file, or several files of polynomials together.
ExitCode check_together(const CheckFlags& flags, const std::vector<std::string>& files) {
  TrajectoryReader reader(files, {flags.format, flags.frame_rate.value_or(0.0), flags.scale,
                                  flags.radius || !flags.footprint.empty(), flags.between == "cubic"});
  TrajectorySurvey survey = survey_of(reader);
  const TrajectoryFile file = reader.file();
  say_what_was_read(file, survey);
  const Bodies bodies = flags.footprint.empty() ? discs(flags, file, survey) : footprints(flags, reader, survey);
  const CheckMap map = map_of(flags, file);
  const Placing placing(file, map, flags.scale);
  const CheckedFile asked = asked_of(flags, file, survey, bodies, map);
  CheckAnswer answer(asked, flags.json);
  answer.begin();

  Byproducts byproducts(flags, asked, bodies);
  const geometry::MotionCheckOptions options{asked.between, asked.near, byproducts.met(), map.discs};
  geometry::MotionStream stream(map.shapes, options, [&](const geometry::MotionEvent& event) {
    answer.add(event);
    byproducts.add(event);
  });
  for (const RigidBody& body : bodies.of_agent) stream.add_body(body);
  datasets::Moves moves;
  std::uint64_t done = 0;
  ProgressLine progress(static_cast<double>(survey.rows()), "rows");
  answer.set_progress(&progress);
  for_each_piece(
      reader, survey, {asked.between, asked.longest_gap},
      [&](TrajectoryRow& row) {
        placing.place(row);
        datasets::Move move;
        if (moves.next(row, move)) answer.look_at(move);
        byproducts.add(row);
        if ((++done & 0xff) != 0) return;
        if (interrupted()) throw Interrupted();
        if (progress.is_due()) progress.show(static_cast<double>(done), "checking");
      },
      [&](std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned) {
        survey.add(agent, piece);
        byproducts.add(agent, piece, turned);
        stream.add(agent, piece, turned);
      });
  progress.clear();
  answer.set_progress(nullptr);
  const geometry::MotionCheck result = stream.finish();
  answer.finish(result, byproducts.missed());
  byproducts.write(result);
  return result.overlaps > 0 ? ExitCode::negative : ExitCode::success;
}

// --- Which files ---

std::vector<std::string> listed_files(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    std::error_code error;
    if (argument == "-" || !std::filesystem::is_directory(argument, error)) {
      files.push_back(argument);
      continue;
    }
    for (std::string& file : datasets::trajectory_files_in(argument)) files.push_back(std::move(file));
  }
  return files;
}

/// What is checked together: all files of polynomials, which are one fleet; every other file alone.
std::vector<std::vector<std::string>> checks_of(const CheckFlags& flags, const std::vector<std::string>& files) {
  constexpr const char* kPolynomials = "polynomials";
  const auto has_polynomials = [&](const std::string& file) {
    try {
      return (flags.format.empty() ? datasets::recognised_trajectory_format(file) : flags.format) == kPolynomials;
    } catch (const DataError&) {
      return false;  // for its own check to say
    }
  };
  std::vector<std::vector<std::string>> checks;
  std::optional<std::size_t> fleet;
  for (const std::string& file : files) {
    if (files.size() > 1 && has_polynomials(file)) {
      if (fleet) {
        checks[*fleet].push_back(file);
        continue;
      }
      fleet = checks.size();
    }
    checks.push_back({file});
  }
  return checks;
}

ExitCode check(const CheckFlags& flags) {
  check_flags(flags);
  const std::vector<std::vector<std::string>> checks = checks_of(flags, listed_files(flags.files));
  if (checks.size() == 1) return check_together(flags, checks.front());
  refuse_both(!flags.figure.empty(), "--figure", "several files", "a figure shows one check");
  refuse_both(!flags.page.empty(), "--page", "several files", "a page shows one check");
  refuse_both(!flags.certificates.empty(), "--certificates", "several files", "a file of proofs is about one check");
  ExitCode worst = ExitCode::success;
  for (const std::vector<std::string>& files : checks) {
    ExitCode status = ExitCode::bad_input;
    try {
      status = check_together(flags, files);
    } catch (const DataError& error) {
      error_message(error.what());
    }
    worst = std::max(worst, status);
  }
  return worst;
}

void declare_check(CLI::App& app, CheckFlags& flags) {
  app.add_option(
         "trajectories", flags.files,
         "Files or folders: CSV with the columns t,id,x,y and theta, vx, vy, text or SQLite of JuPedSim, PedPy, "
         "obsmat.txt, frame-id-x-y in four columns, TrajNet++, SUMO's FCD, a plan of libMultiRobotPlanning or "
         "paths of cells, polynomials (all files together), curves in JSON, a recording of this program; - for stdin")
      ->required();
  app.add_option("--format", flags.format,
                 fmt::format("Format of the trajectories: {}; by default detected from content",
                             fmt::join(datasets::trajectory_formats(), " ")));
  app.add_option("--radius", flags.radius,
                 "Radius of every body, m; by default that of a recording. Of recorded robots on wheels that of a disc "
                 "round the axle's centre");
  app.add_option(
      "--footprint", flags.footprint,
      "WKT or FILE: a polygon round the agent's place, or with --radius a line with that half width. --radius "
      "grows a polygon. It turns with the agent's heading (theta). Of recorded robots on wheels the place is the "
      "axle's centre");
  app.add_option("--map", flags.map, "Obstacle file of any readable format; by default the obstacles of a recording");
  declare_reading_flags(app, flags.reading, "--map-format");
  app.add_option("--between", flags.between,
                 "How bodies move between two rows: straight (and uniform), hold (at rest until the next row), cubic "
                 "(with the file's velocities, else Catmull-Rom), none (only the rows count)")
      ->capture_default_str();
  app.add_option("--scale", flags.scale, "Metres of one unit of length in the trajectories")->capture_default_str();
  app.add_option("--frame-rate", flags.frame_rate,
                 "Frames a second, for files that count frames; before what they say");
  app.add_option(
      "--near", flags.near,
      "List pairs that come nearer than this, m, with the least clearance; 0: none. By default the radius, or "
      "the reach of the footprint");
  app.add_option("--max-speed", flags.max_speed,
                 "A faster move is a jump, m/s; by default three times what 95 of 100 moves do not exceed");
  app.add_option(
      "--max-gap", flags.max_gap,
      "An agent without a row for more than this many s counts as absent; by default it goes on to its next row");
  app.add_option("--samples", flags.samples,
                 "Count the overlaps that sampling would miss with this many samples of each move, from its row on")
      ->check(whole_number(1, 1000000));
  app.add_flag("--json", flags.json, "One line of JSON for each event, finding and approach, then a summary");
  app.add_option("--certificates", flags.certificates,
                 "FILE for a proof of each pair of motions that come near and stay clear, for audit --certificate");
  app.add_option("--figure", flags.figure, kFigureFileHelp);
  app.add_option("--page", flags.page,
                 "FILE.html: a page for a browser that plays the trajectories on the map and leads to each overlap");
}

}  // namespace

Verb check_verb() {
  return {
      "check", "Decide whether moving bodies touch each other or a map at any time, not only at samples",
      "  exactvo check runs.csv --radius 0.3 --map office.geojson --figure out/check.svg --page out/check.html\n"
      "  exactvo check obsmat.txt --radius 0.2 --frame-rate 15 --json\n"
      "  exactvo check plan.yaml --footprint 'POLYGON ((-0.4 -0.3, 0.4 -0.3, 0.4 0.3, -0.4 0.3))'\n"
      "  exactvo check cars.csv --radius 1 --between cubic --map lab.yaml --unknown blocked\n"
      "  exactvo check out/recording.jsonl --certificates proofs.jsonl && exactvo audit --certificate proofs.jsonl\n"
      "    (status 0: no overlap, contact included; 1: an overlap; 2: a file or an option is wrong)\n",
      with_flags(declare_check, check)};
}

}  // namespace exactvo::tools
