// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo monitor: commands and trajectories in, a line of JSON each; how much of each is proven clear comes out.
#include "exactvo/formation/monitor.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/turning_motions.h"
#include "figures/figure.h"
#include "figures/outlines.h"
#include "figures/plane.h"
#include "json/json_text.h"
#include "support/footprint.h"
#include "support/motion_certificates.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {
namespace {

using datasets::DataCode;
using datasets::Json;
using datasets::JsonCursor;
using formation::Command;
using formation::Monitor;
using formation::MonitorError;
using formation::MonitorProblem;
using formation::MonitorSetup;
using formation::MonitorVerdict;
using formation::Mover;

// The figure of `monitor`: the first lines, each with its way, what of it is proven clear, and what ends that.

/// One line and its answer.
struct JudgedLine {
  std::string title;  ///< of its panel
  std::vector<formation::MonitorArc> whole, proven;
  std::vector<formation::Mover> movers;
  formation::MonitorVerdict verdict;
};

class MonitorPicture {
 public:
  static constexpr std::size_t kMostPanels = 6;

  /// The setup with its obstacles.
  explicit MonitorPicture(formation::MonitorSetup setup) : setup_(std::move(setup)) {}

  bool is_empty() const { return lines_.empty(); }
  bool is_full() const { return lines_.size() == kMostPanels; }
  void add(JudgedLine line) { lines_.push_back(std::move(line)); }
  Figure figure(const std::string& title) const;

 private:
  formation::MonitorSetup setup_;
  std::vector<JudgedLine> lines_;
};

using geometry::Pose;

constexpr const char* kProvenColour = "#0072B2";
constexpr const char* kBeyondColour = "#D55E00";
constexpr const char* kMoverColour = "#E69F00";
constexpr const char* kWitnessStyle = "with points pt 6 ps 1.5 lw 2.5 lc rgb '#e00000'";

/// Poses of the robot that are drawn.
constexpr int kPoses = 16;

/// Where the robot is, at a share of a way's length.
Pose pose_on(const std::vector<formation::MonitorArc>& way, double share) {
  const double at = share * way.back().motion.end;
  std::size_t k = 0;
  while (k + 1 < way.size() && way[k].motion.end < at) ++k;
  const geometry::TurningMotion& m = way[k].motion;
  const geometry::Displacement d = displacement_after(m.twist, at - m.start);
  return {m.at + d.by, way[k].heading + m.twist.turn * (at - m.start)};
}

SheetPanel panel_of(const MonitorSetup& setup, const JudgedLine& line, char letter, DataFile& data) {
  std::vector<Points> first, proven, rest, beyond, seen, later;
  const auto add = [&](std::vector<Points>& rings, const Pose& pose) {
    for (const geometry::RoundedPolygon& part : setup.footprint) rings.push_back(hull_outline(part, pose));
  };
  const double length = line.whole.back().motion.end, cleared = line.proven.back().motion.end;
  add(first, pose_on(line.whole, 0.0));
  for (int k = 1; k <= kPoses; ++k) {
    const double share = static_cast<double>(k) / kPoses;
    add(share * length < cleared ? proven : beyond, pose_on(line.whole, share));
  }
  if (line.verdict.share == 1.0) beyond.clear();
  add(rest, pose_on(line.proven, 1.0));
  for (const formation::Mover& mover : line.movers) {
    seen.push_back(hull_outline(mover.shape, {}));
    later.push_back(hull_outline(mover.shape, {}, mover.position_error + mover.max_speed * cleared));
  }
  Box view;
  for (const auto* rings : {&first, &proven, &rest, &beyond, &seen})
    for (const Points& ring : *rings)
      for (const Vec2 p : ring) view.add(p);
  Panel panel(square_round(view, 0.58), data);
  panel.obstacles(setup.obstacles, 2.5, false);
  panel.rings("where movers may be when the robot rests", later, line_style(1.0, kMoverColour));
  panel.rings("movers", seen, clear_fill(kMoverColour, 0.5));
  panel.rings("not proven", beyond, line_style(0.8, kBeyondColour));
  panel.rings("proven", proven, line_style(0.8, kProvenColour));
  panel.rings("robot at rest", rest, clear_fill(kProvenColour, 0.45));
  panel.rings("robot now", first, clear_fill("#555555", 0.35));
  Points places;
  if (line.verdict.witness) places.push_back(line.verdict.witness->place);
  panel.points("too near", places, kWitnessStyle);
  return panel.on_sheet(quoted(fmt::format("({}) {}", letter, line.title) + panel.origin.in_title()));
}

Figure MonitorPicture::figure(const std::string& title) const {
  DataFile data;
  Sheet sheet;
  for (std::size_t k = 0; k < lines_.size(); ++k)
    sheet.panels.push_back(panel_of(setup_, lines_[k], static_cast<char>('a' + k), data));
  sheet.title = quoted(title);
  sheet.x_label = "'x [m]'";
  sheet.y_label = "'y [m]'";
  sheet.columns = lines_.size() == 1 ? 1 : lines_.size() == 2 || lines_.size() == 4 ? 2 : 3;
  sheet.panel_width = sheet.panel_height = lines_.size() == 1 ? 520.0 : 300.0;
  sheet.gap = 60.0;
  const auto box = [](const char* colour, double opacity) {
    return fmt::format("keyentry with boxes fs transparent solid {} noborder fc rgb '{}'", opacity, colour);
  };
  sheet.legend = {{box("#555555", 0.35), "robot now"},
                  {box(kProvenColour, 0.45), "at rest, after the share that is proven"},
                  {"keyentry " + line_style(0.8, kProvenColour), "proven clear"},
                  {"keyentry " + line_style(0.8, kBeyondColour), "the rest of the command"},
                  {box(kMoverColour, 0.5), "mover, and where it may come"},
                  {std::string("keyentry ") + kWitnessStyle, "too near"}};
  return sheet_figure("monitor", data.text(), "Commands of a robot, and how much of each is proven clear.", sheet);
}

/// Bytes: no line may be longer.
constexpr std::size_t kLongestQuestion = std::size_t{1} << 20;

struct MonitorFlags {
  std::string file = "-", map, footprint, figure, certificates;
  ReadingFlags reading;  ///< of the map
  std::optional<double> radius;
  MonitorSetup setup;
};

/// One line of input. `id` comes back as it is.
struct MonitorQuestion {
  Json id;
  geometry::Pose pose;
  std::optional<Command> command;
  std::vector<formation::TimedPose> trajectory;
  std::vector<Mover> movers;
  std::vector<std::string> names;  ///< of the movers
};

double finite_number(const JsonCursor& at) {
  const double x = at.number();
  if (!std::isfinite(x)) at.refuse("a finite number", DataCode::not_finite);
  return x;
}

void require_size(const JsonCursor& list, std::size_t size, const char* expected) {
  if (list.size() != size) list.refuse(expected, DataCode::wrong_count);
}

geometry::Vec2 point_in(const JsonCursor& at) {
  require_size(at, 2, "[x, y], m");
  return {finite_number(at.at(0)), finite_number(at.at(1))};
}

void refuse_unknown_keys(const JsonCursor& object, const std::vector<std::string>& known) {
  if (!object.json().is_object()) return;
  std::vector<std::string> missing;  // a key that is there already was not meant
  for (const std::string& name : known)
    if (!object.has(name)) missing.push_back(name);
  for (const auto& [key, value] : object.json().items())
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const std::string near = suggestion(key, missing);
      object.at(key).refuse(fmt::format("a known key, which \"{}\" is not{}", key,
                                        near.empty() ? fmt::format("; known are {}", fmt::join(known, ", ")) : near),
                            DataCode::key_unknown);
    }
}

/// From the place `first` of the list on: x, y, heading.
geometry::Pose pose_in(const JsonCursor& list, std::size_t first) {
  return {{finite_number(list.at(first)), finite_number(list.at(first + 1))}, finite_number(list.at(first + 2))};
}

Command command_in(const JsonCursor& line) {
  Command command;
  const JsonCursor velocity = line.at("velocity");
  require_size(velocity, 2, "[ahead, left], m/s");
  command.twist.velocity = {finite_number(velocity.at(0)), finite_number(velocity.at(1))};
  if (line.has("turn")) command.twist.turn = finite_number(line.at("turn"));
  if (!line.has("frame")) return command;
  const JsonCursor frame = line.at("frame");
  if (frame.text() != "body" && frame.text() != "world") frame.refuse("body or world", DataCode::not_an_option);
  command.in_world_axes = frame.text() == "world";
  return command;
}

void read_mover(const JsonCursor& at, MonitorQuestion& question) {
  Mover mover;
  refuse_unknown_keys(at, {"id", "position", "polygon", "radius", "max_speed", "position_error"});
  if (at.has("polygon") == at.has("position"))
    at.refuse("either \"position\" and \"radius\", or \"polygon\"", DataCode::no_alternative);
  mover.shape.corners.clear();
  if (at.has("position")) {
    mover.shape.corners.push_back(point_in(at.at("position")));
    mover.shape.radius = finite_number(at.at("radius"));
  } else {
    const JsonCursor polygon = at.at("polygon");
    for (std::size_t k = 0; k < polygon.size(); ++k) mover.shape.corners.push_back(point_in(polygon.at(k)));
    if (at.has("radius")) mover.shape.radius = finite_number(at.at("radius"));
  }
  mover.max_speed = finite_number(at.at("max_speed"));
  if (at.has("position_error")) mover.position_error = finite_number(at.at("position_error"));
  question.names.push_back(at.has("id") ? at.at("id").text() : std::to_string(question.movers.size()));
  question.movers.push_back(std::move(mover));
  at.end_of_object();
}

MonitorQuestion question_in(const JsonCursor& line) {
  MonitorQuestion question;
  refuse_unknown_keys(line, {"id", "pose", "velocity", "turn", "frame", "trajectory", "movers"});
  if (line.has("id")) question.id = line.at("id").json();
  if (line.has("trajectory")) {
    const JsonCursor list = line.at("trajectory");
    for (std::size_t k = 0; k < list.size(); ++k) {
      const JsonCursor row = list.at(k);
      require_size(row, 4, "[time, x, y, heading], s, m and rad");
      question.trajectory.push_back({finite_number(row.at(0)), pose_in(row, 1)});
    }
  } else {
    const JsonCursor pose = line.at("pose");
    require_size(pose, 3, "[x, y, heading], m and rad");
    question.pose = pose_in(pose, 0);
    question.command = command_in(line);
  }
  if (line.has("movers")) {
    const JsonCursor movers = line.at("movers");
    for (std::size_t k = 0; k < movers.size(); ++k) read_mover(movers.at(k), question);
  }
  line.end_of_object();
  return question;
}

/// Certificates that the proven ways are clear of the obstacles near them.
class ProofFile {
 public:
  ProofFile(const std::string& path, const MonitorSetup& setup)
      : out_(path, datasets::MissingFolder::is_made, datasets::Unfinished::goes, datasets::Pipe::is_written),
        setup_(setup) {
    for (const formation::SceneObstacle& obstacle : setup.obstacles) {
      geometry::Box box;
      for (const geometry::Vec2 v : geometry::vertices_of(obstacle.shape)) box.add(v);
      boxes_.push_back(box);
    }
  }

  void add(std::size_t line, const std::vector<formation::MonitorArc>& way) {
    for (const formation::MonitorArc& arc : way) {
      geometry::RigidBody body = setup_.footprint;
      double reach = 0.0;
      for (geometry::RoundedPolygon& part : body) {
        part.radius += setup_.margin;
        for (geometry::Vec2& corner : part.corners) {
          corner = geometry::rotated(corner, arc.heading);
          reach = std::max(reach, norm(corner) + part.radius);
        }
      }
      // What ends a share is as far away as that, up to rounding: its proof is wanted.
      reach += norm(arc.motion.twist.velocity) * (arc.motion.end - arc.motion.start) + formation::kMonitorSlack;
      for (std::size_t k = 0; k < boxes_.size(); ++k) {
        if (geometry::distance_below(boxes_[k], arc.motion.at) > reach * (1.0 + 0x1p-40)) continue;
        const formation::SceneObstacle& obstacle = setup_.obstacles[k];
        const auto proof = certify(arc.motion, body, obstacle.shape);
        ++(proof ? count_ : without_);
        if (!proof) {
          out_.write(json_line({{"line", line}, {"certificate", nullptr}, {"obstacle", obstacle.id}}));
          continue;
        }
        const std::string text = certificate_text(*proof, arc.motion, body, obstacle_text(obstacle));
        out_.write(fmt::format("{{\"line\":{},\"certificate\":{}}}\n", line, text));
      }
    }
  }
  void finish() {
    out_.write(json_line({{"summary", {{"certificates", count_}, {"without", without_}}}}));
    out_.commit();
  }

 private:
  datasets::AtomicFile out_;
  const MonitorSetup& setup_;
  std::vector<geometry::Box> boxes_;
  std::size_t count_ = 0, without_ = 0;
};

class Answers {
 public:
  /// `picture` and `proofs` may be null.
  Answers(const std::vector<std::string>& obstacles, const std::string& file, MonitorPicture* picture,
          ProofFile* proofs)
      : obstacles_(obstacles), file_(file), picture_(picture), proofs_(proofs) {}

  /// Prints the answer to line `number`; false where the line is wrong, which the answer then says.
  bool answer(Monitor& monitor, std::string_view text, std::size_t number) {
    json_.clear();
    json_.begin_object().member("line", number);
    bool is_right = true;
    try {
      const Json parsed = datasets::parse_json_line(text, file_, number);
      const JsonCursor line(parsed, file_, fmt::format("line {}", number), JsonCursor::OtherKeys::refused);
      if (!parsed.is_object()) line.refuse("an object");
      if (parsed.contains("id")) json_.key("id").raw(parsed["id"].dump());
      const MonitorQuestion question = question_in(line);
      const MonitorVerdict verdict = question.command ? monitor.judge(question.pose, *question.command, question.movers)
                                                      : monitor.judge(question.trajectory, question.movers);
      put(question, verdict);
      if (picture_ && !picture_->is_full())
        picture_->add(
            {title_of(question, verdict), monitor.way(1.0), monitor.way(verdict.share), question.movers, verdict});
      if (proofs_ && verdict.proven) proofs_->add(number, monitor.way(verdict.share));
    } catch (const datasets::DataError& error) {
      put_error(code_name(error.code()), error.place(), error.found(), error.expected());
      is_right = false;
    } catch (const MonitorError& error) {
      put_error(code_name(code_of(error.problem())), fmt::format("line {}, /{}", number, error.place()), error.found(),
                error.expected());
      is_right = false;
    }
    json_.end_object();
    print(std::string(json_.text()) + "\n");
    return is_right;
  }

 private:
  static DataCode code_of(MonitorProblem problem) {
    return problem == MonitorProblem::not_finite     ? DataCode::not_finite
           : problem == MonitorProblem::out_of_range ? DataCode::out_of_range
                                                     : DataCode::wrong_count;
  }

  static std::string title_of(const MonitorQuestion& question, const MonitorVerdict& verdict) {
    const std::string share = fmt::format("share {:.3g}", verdict.share);
    return question.id.is_string() ? question.id.get<std::string>() + ": " + share : share;
  }

  void put(const MonitorQuestion& question, const MonitorVerdict& v) {
    json_.member("share", v.share);
    if (question.command) {
      const geometry::Twist& twist = question.command->twist;
      json_.member("velocity", geometry::Vec2{v.share * twist.velocity.x + 0.0, v.share * twist.velocity.y + 0.0});
      json_.member("turn", v.share * twist.turn + 0.0);
    } else {
      const double from = question.trajectory.front().time, to = question.trajectory.back().time;
      json_.member("until", from + v.share * (to - from));
    }
    json_.member("not_above", v.not_above).member("proven", v.proven).member("in_contact", v.in_contact);
    json_.key("witness");
    if (!v.witness) {
      json_.null();
      return;
    }
    json_.begin_object();
    if (v.witness->is_mover)
      json_.member("mover", question.names[v.witness->index]);
    else
      json_.member("obstacle", obstacles_[v.witness->index]);
    json_.member("time", v.witness->time).member("place", v.witness->place).end_object();
  }

  void put_error(const char* code, const std::string& place, const std::string& found, const std::string& expected) {
    json_.key("error").begin_object().member("code", code).member("place", place).member("found", found);
    json_.member("expected", expected).end_object();
  }

  const std::vector<std::string>& obstacles_;
  const std::string& file_;
  MonitorPicture* picture_;
  ProofFile* proofs_;
  datasets::JsonWriter json_{datasets::JsonWriter::Layout::compact};
};

MonitorSetup setup_of(const MonitorFlags& flags, std::vector<std::string>& obstacles) {
  MonitorSetup setup = flags.setup;
  if (!flags.radius && flags.footprint.empty())
    throw missing_option("monitor", "option --radius or --footprint", "the size of the robot");
  if (flags.radius) require_length("--radius", *flags.radius);
  if (flags.footprint.empty() && *flags.radius == 0.0)
    throw UsageError("--radius", "0", "a radius above 0 m, of a robot that is a disc");
  setup.footprint = flags.footprint.empty()
                        ? geometry::disc_body(*flags.radius)
                        : footprint_body(footprint_shape(flags.footprint), flags.radius.value_or(0.0));
  if (!flags.map.empty()) {
    datasets::ReadOptions reading = reading_options(flags.reading, "--map-format");
    reading.keep_going = false;
    datasets::ObstacleFile content = datasets::read_obstacles(flags.map, reading);
    say_map(content);
    setup.obstacles = std::move(content.obstacles);
  }
  for (const formation::SceneObstacle& o : setup.obstacles) obstacles.push_back(o.id);
  return setup;
}

Monitor monitor_of(const MonitorSetup& setup) {
  try {
    return Monitor(setup);
  } catch (const MonitorError& error) {
    std::string option = error.place().substr(0, error.place().find('/'));  // "max_deceleration", "obstacles/3"
    if (option == "obstacles") option = "map";
    std::replace(option.begin(), option.end(), '_', '-');
    throw UsageError("--" + option, error.found(), error.expected());
  }
}

ExitCode monitor(const MonitorFlags& flags) {
  std::vector<std::filesystem::path> inputs{flags.file};
  if (!flags.map.empty()) inputs = all_read_with({flags.map}, flags.reading.format, flags.file);
  for (const std::string& file : {flags.footprint, flags.certificates})
    if (!file.empty()) inputs.emplace_back(file);
  if (!flags.certificates.empty()) {
    refuse_input_as_output(flags.file, "", "--certificates", flags.certificates);
    if (!flags.map.empty())
      refuse_input_as_output(flags.map, flags.reading.format, "--certificates", flags.certificates);
  }
  check_figure_name("--figure", flags.figure, inputs);
  std::vector<std::string> obstacles;
  const MonitorSetup setup = setup_of(flags, obstacles);
  Monitor monitor = monitor_of(setup);
  std::optional<MonitorPicture> picture;
  if (!flags.figure.empty()) picture.emplace(setup);
  const std::string name = datasets::name_of_input(flags.file);
  datasets::TextLines lines(flags.file, kLongestQuestion);
  std::optional<ProofFile> proofs;
  if (!flags.certificates.empty()) proofs.emplace(flags.certificates, setup);
  Answers answers(obstacles, name, picture ? &*picture : nullptr, proofs ? &*proofs : nullptr);
  std::size_t wrong = 0;
  for (std::string_view line; lines.next(line);) {
    throw_if_reader_left();
    if (interrupted()) throw Interrupted();
    wrong += !answers.answer(monitor, line, lines.number());
  }
  if (proofs) proofs->finish();
  if (picture && !picture->is_empty())
    write_figure(picture->figure("Commands, and how much of each is proven clear"), flags.figure);
  if (wrong == 0) return ExitCode::success;
  message(fmt::format("{}: {} without an answer", name, geometry::counted(wrong, "line")));
  return ExitCode::negative;
}

void declare_monitor(CLI::App& app, MonitorFlags& flags) {
  app.add_option(
         "file", flags.file,
         "Commands and trajectories, a line of JSON each; by default -, which is stdin. Each is answered at once")
      ->capture_default_str();
  app.add_option("--radius", flags.radius, "Radius of a robot that is a disc, m");
  app.add_option(
      "--footprint", flags.footprint,
      "WKT or FILE: a polygon in body axes: x ahead, origin at the pose; --radius grows it. Or with --radius a "
      "line with that half width");
  app.add_option("--map", flags.map, "Obstacle file of any readable format: what stands still");
  declare_reading_flags(app, flags.reading, "--map-format");
  MonitorSetup& setup = flags.setup;
  app.add_option("--max-deceleration", setup.max_deceleration, "Deceleration that the robot always reaches, m/s^2")
      ->capture_default_str();
  app.add_option("--max-turn-deceleration", setup.max_turn_deceleration,
                 "Angular deceleration that it always reaches, rad/s^2")
      ->capture_default_str();
  app.add_option("--latency", setup.latency, "From a decision to its effect, s")->capture_default_str();
  app.add_option("--period", setup.period, "From a decision to the next, s")->capture_default_str();
  app.add_option("--margin", setup.margin, "Largest total error of localisation, map and drive, m")
      ->capture_default_str();
  app.add_option("--certificates", flags.certificates,
                 "FILE: certificates that the proven ways are clear of what is near, for audit --certificate");
  app.add_option("--figure", flags.figure,
                 fmt::format("Draw the first {} lines. {}", MonitorPicture::kMostPanels, kFigureFileHelp));
}

}  // namespace

Verb monitor_verb() {
  return {"monitor", "Say for a control loop how much of each command is proven clear, line by line",
          "  echo '{\"pose\": [0, 0, 0], \"velocity\": [1.5, 0], \"turn\": 0.4}' | exactvo monitor --radius 0.3 --map "
          "datasets/data/crossing/corners.wkt\n"
          "  exactvo monitor commands.jsonl --footprint 'POLYGON ((-0.4 -0.3, 0.6 -0.3, 0.6 0.3, -0.4 0.3))' --map "
          "map.yaml --latency 0.15\n"
          "    (a line holds \"pose\" [x, y, heading] in m and rad, \"velocity\" [ahead, left] in m/s and \"turn\" in "
          "rad/s;\n"
          "    or \"trajectory\", a list of [time, x, y, heading]; and \"movers\". The answer's \"share\" says how "
          "much of the\n"
          "    command or trajectory, followed by braking, is proven clear. A line that is wrong is answered with an "
          "\"error\", and the next one is read; status 1 "
          "says\n"
          "    at the end that there were such lines. docs/guide/monitor.md)\n",
          with_flags(declare_monitor, monitor)};
}

}  // namespace exactvo::tools
