// SPDX-License-Identifier: GPL-3.0-or-later
// Trajectories in JSON and XML: TrajNet++ (a JSON object a line), SUMO's floating car data, and recordings of this
// program.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <variant>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/pi.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "readers/readers.h"
#include "recordings/crowd_headings.h"
#include "trajectories/trajectory_readers.h"

namespace exactvo::datasets {
namespace {

// --- XML, a tag at a time ---

/// No tag is longer, and no element deeper.
constexpr std::size_t kLongestTag = std::size_t{1} << 16, kDeepestElement = 64;

/// The tags of a text of XML, one after the other: neither content nor a tree is kept, only the names of the elements
/// that are open. Refuses tags, comments and elements that do not end.
class XmlTags {
 public:
  XmlTags(const std::filesystem::path& path, const TrajectorySink& out) : in_(path, std::ios::binary), out_(out) {}

  /// The next tag that opens an element, without its brackets; false at the end. Whatever else there is, is passed
  /// over.
  bool next() {
    if (is_new_open_) open_.push_back(name_);
    is_new_open_ = false;
    for (char c = '\0'; take(c);) {
      if (c != '<') continue;
      line_ = number_;
      if (!read_tag() || tag_.front() == '!') continue;
      name_ = tag_.substr(tag_.front() == '/' ? 1 : 0);
      name_.resize(std::min(name_.find_first_of(" \t\r\n/"), name_.size()));
      if (name_.empty()) refuse(excerpt("<" + tag_ + ">", 0), "the name of an element");
      if (tag_.front() == '/') {
        if (open_.empty() || open_.back() != name_)
          refuse(in_words("</", name_), open_.empty() ? "no end of an element" : in_words("</", open_.back()));
        open_.pop_back();
        continue;
      }
      if (open_.empty() && has_root_) refuse(in_words("<", name_), "nothing behind the first element");
      has_root_ = true;
      is_new_open_ = tag_.back() != '/';
      if (open_.size() >= kDeepestElement)
        out_.refuse(DataCode::nesting, line_, in_words("<", name_),
                    "at most " + std::to_string(kDeepestElement) + " elements within each other");
      return true;
    }
    line_ = number_;
    if (!open_.empty()) refuse("the end of the file", in_words("</", open_.back()));
    return false;
  }
  const std::string& tag() const { return tag_; }
  const std::string& name() const { return name_; }
  std::uint64_t line() const { return line_; }
  /// Whether the tag stands in an element of that name.
  bool is_within(std::string_view name) const { return std::find(open_.begin(), open_.end(), name) != open_.end(); }

 private:
  /// False for comments, instructions and quoted content, which are passed over.
  bool read_tag() {
    tag_.clear();
    char quote = '\0';
    for (char c = '\0';;) {
      if (!take(c))
        refuse("the end of the file", quote == '\0' ? "the end of the tag" : "the end of the tag's quotation");
      if (quote == '\0' && c == '>') break;
      if (c == '<')
        tag_.substr(0, 1) == "!" ? refuse("an entity or another declaration in one", "XML without entities of its own")
                                 : refuse(excerpt("<" + tag_, 0, 40), "the end of the tag before the next one");
      if (c == '"' || c == '\'') quote = quote == '\0' ? c : quote == c ? '\0' : quote;
      if (tag_.size() == kLongestTag)
        out_.refuse(DataCode::size, line_, "a tag of more than " + std::to_string(kLongestTag) + " bytes",
                    "shorter tags");
      tag_ += c;
      if (tag_ == "!--") return pass("-->", "the end of the comment");
      if (tag_ == "![CDATA[") return pass("]]>", "]]>");
      if (tag_ == "?") return pass("?>", "?>");
    }
    if (tag_.empty()) refuse("<>", "the name of an element");
    return true;
  }
  bool pass(std::string_view end, const char* expected) {
    std::string last;
    for (char c = '\0'; last != end;) {
      if (!take(c)) refuse("the end of the file", expected);
      if (last.size() == end.size()) last.erase(0, 1);
      last += c;
    }
    return false;
  }
  bool take(char& c) {
    if (at_ == block_.size()) {
      call_wait_hook();
      block_.resize(kWaitHookBytes);
      in_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
      block_.resize(static_cast<std::size_t>(in_.gcount()));
      at_ = 0;
      if (block_.empty()) return false;
    }
    c = block_[at_++];
    if (c == '\n') ++number_;
    return true;
  }
  /// A tag for messages: names may be long, or not printable.
  static std::string in_words(const char* bracket, const std::string& name) {
    return excerpt(bracket + name + ">", 0, 40);
  }
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    out_.refuse(DataCode::format_syntax, line_, found, expected);
  }

  std::ifstream in_;
  const TrajectorySink& out_;
  std::string block_, tag_, name_;
  std::vector<std::string> open_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 0, number_ = 1;
  bool is_new_open_ = false, has_root_ = false;
};

class TagAttributes {
 public:
  TagAttributes(const std::string& tag, std::uint64_t line, const TrajectorySink& out) : line_(line), out_(out) {
    const std::string text = "<" + tag + (tag.back() == '/' ? ">" : "/>");
    const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
    if (!result)
      out.refuse(DataCode::format_syntax, line, excerpt(text, 0, 40), std::string("XML: ") + result.description());
  }
  bool has(const char* name) const { return !document_.first_child().attribute(name).empty(); }
  std::string_view text(const char* name) const {
    const pugi::xml_attribute attribute = document_.first_child().attribute(name);
    if (attribute.empty())
      out_.refuse(DataCode::key_missing, line_, std::string("no attribute ") + name, std::string(name) + "=\"...\"");
    return attribute.value();
  }
  double number(const char* name) const { return out_.number(text(name), name, line_); }

 private:
  std::uint64_t line_;
  const TrajectorySink& out_;
  pugi::xml_document document_;
};

/// Robots and what stands still.
void begin(const formation::Scenario& scenario, TrajectorySink& out) {
  TrajectoryFile& file = out.file();
  file.row_word = "row";
  if (out.scale() != 1.0)
    throw DataError(DataCode::not_an_option, file.file, "", "the scale " + number_text(out.scale()),
                    "no scale for a recording, whose places, radii and obstacles are in m");
  for (const formation::Robot& robot : scenario.robots) {
    if (!out.options().at_axles && obstacle_radius(robot) < robot.radius)
      throw DataError(DataCode::scenario, file.file, "", "robot '" + robot.id + "', which has a footprint",
                      "robots that are discs, or --footprint with the body round the axle; audit proves such runs");
    out.agent(robot.id);
    file.radii.push_back(robot.radius);
    file.on_wheels += robot.drive ? 1 : 0;
  }
  if (out.options().at_axles && file.on_wheels > 0)
    file.notes.emplace_back("places of robots on wheels are the axle's centre");
  file.obstacles = scenario.obstacles;
  if (!scenario.moving_obstacles.empty())
    file.notes.push_back(geometry::counted(scenario.moving_obstacles.size(), "moving obstacle") + " left out");
}

/// A recorded robot with its axle's centre in place of the reference point, and its heading.
void put_at_axle(const formation::Robot& robot, const formation::RobotStep& state, std::size_t agent, double time,
                 std::uint64_t number, TrajectorySink& out) {
  if (!state.wheels)
    out.refuse(DataCode::key_missing, number, "no heading of robot '" + robot.id + "'", "that of a robot on wheels");
  constexpr double kUnit = 1e-6;
  const geometry::Vec2 heading = state.wheels->heading;
  if (!(std::fabs(norm(heading) - 1.0) <= kUnit))
    out.refuse(DataCode::out_of_range, number, "the heading of robot '" + robot.id + "'", "a vector of length 1");
  out.row(agent, time, state.position - robot.drive->reference * heading, number, std::atan2(heading.y, heading.x));
}

/// Recordings have ellipses that `scene_of` makes polygons round: too large to say that a body overlaps one.
void leave_out_ellipses(const CrowdRecordingHead& head, TrajectoryFile& file) {
  std::set<std::string> ellipses;
  for (std::size_t k = 0; k < head.bodies.size(); ++k)
    if (!head.bodies[k].moves && std::holds_alternative<geometry::Ellipse>(head.bodies[k].shape))
      ellipses.insert(head.body_name(k));
  if (ellipses.empty()) return;
  std::vector<formation::SceneObstacle>& obstacles = file.obstacles;
  obstacles.erase(std::remove_if(obstacles.begin(), obstacles.end(),
                                 [&](const formation::SceneObstacle& o) { return ellipses.count(o.id) > 0; }),
                  obstacles.end());
  file.notes.push_back(geometry::counted(ellipses.size(), "ellipse") + " left out");
}

}  // namespace

bool looks_like_trajnet(std::string_view beginning) {
  const std::size_t end = beginning.find('\n');
  const std::string_view line = beginning.substr(0, end);
  const std::size_t first = line.find_first_not_of(" \t\xEF\xBB\xBF");
  if (first == std::string_view::npos || line[first] != '{') return false;
  return line.find("\"scene\"") != std::string_view::npos || line.find("\"track\"") != std::string_view::npos;
}

void read_trajnet(const std::filesystem::path& path, TrajectorySink& out) {
  TextLines lines(path.string(), kLongestRow);
  std::size_t predictions = 0;
  const std::string& name = out.file().file;
  std::string id;
  for (std::string_view line; lines.next(line);) {
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const Json json = parse_json_line(line, name, lines.number());
    const JsonCursor cursor(json, name, "line " + std::to_string(lines.number()));
    if (!cursor.has("track")) continue;
    const JsonCursor track = cursor.at("track");
    if (track.has("prediction_number") && track.at("prediction_number").json() != 0) {
      ++predictions;
      continue;
    }
    id = track.at("p").json().is_string() ? track.at("p").text() : number_text(track.at("p").number());
    const double time = out.time_of_frame(track.at("f").number(), 0.0);
    out.row(out.agent(id), time, {track.at("x").number(), track.at("y").number()}, lines.number());
  }
  if (predictions > 0)
    out.file().notes.push_back(geometry::counted(predictions, "row") + " of further predictions left out");
}

bool looks_like_sumo_fcd(std::string_view beginning) {
  return first_element_is(std::string(beginning), "fcd-export");
}

/// What vehicles have gone, by the speeds that a file gives and by its places.
class GoneWays {
 public:
  void add(std::size_t agent, double time, geometry::Vec2 at, double speed) {
    if (agent >= last_.size()) last_.resize(agent + 1);
    auto& last = last_[agent];
    if (last) {
      by_speed_ += speed * std::min(time - last->time, kLongestStep);
      by_place_ += norm(at - last->at);
    }
    is_on_globe_ = is_on_globe_ && std::fabs(at.x) <= 180.0 && std::fabs(at.y) <= 90.0;
    last = geometry::TimedPoint{time, at};
  }
  /// A degree of latitude is 111 km long, one of longitude seldom less than 1 km; ways in metres agree to a few parts.
  bool are_in_degrees() const { return is_on_globe_ && by_speed_ > 10.0 && by_speed_ > 500.0 * by_place_; }

 private:
  /// s: in more, a vehicle may have come back to where it was.
  static constexpr double kLongestStep = 60.0;
  bool is_on_globe_ = true;
  std::vector<std::optional<geometry::TimedPoint>> last_;
  double by_speed_ = 0.0, by_place_ = 0.0;  ///< m, and units of length
};

void read_sumo_fcd(const std::filesystem::path& path, TrajectorySink& out) {
  XmlTags tags(path, out);
  GoneWays gone;
  double time = 0.0;
  bool has_headings = false;
  while (tags.next()) {
    if (tags.name() == "timestep") time = TagAttributes(tags.tag(), tags.line(), out).number("time");
    if (tags.name() != "vehicle" && tags.name() != "person") continue;
    if (!tags.is_within("timestep"))
      out.refuse(DataCode::format_syntax, tags.line(), excerpt(tags.tag(), 0), "a timestep round it");
    const TagAttributes vehicle(tags.tag(), tags.line(), out);
    double heading = std::numeric_limits<double>::quiet_NaN();
    if (vehicle.has("angle")) {
      // SUMO's: degrees clockwise from north.
      constexpr double kDegree = geometry::kPi / 180.0;
      heading = (90.0 - vehicle.number("angle")) * kDegree;
      has_headings = true;
    }
    const std::size_t agent = out.agent(vehicle.text("id"));
    const geometry::Vec2 at{vehicle.number("x"), vehicle.number("y")};
    if (vehicle.has("speed")) gone.add(agent, time, at, vehicle.number("speed"));
    out.row(agent, time, at, tags.line(), heading);
  }
  if (gone.are_in_degrees() && out.options().scale == 1.0)
    out.refuse(DataCode::projection, tags.line(), "places that agree with the speeds only if they are degrees",
               "places in metres, as SUMO writes them without --fcd-output.geo");
  if (has_headings)
    out.file().notes.emplace_back("places of vehicles are the middle of the front bumper, as SUMO has it");
}

bool looks_like_recording(std::string_view beginning) {
  return beginning.find("exactvo-recording") != std::string_view::npos;
}

void read_recorded_trajectories(const std::filesystem::path& path, TrajectorySink& out) {
  std::uint64_t number = 0;
  read_recording(path, [&](const RecordingFile& so_far, formation::Step row, const formation::LyapunovRow*) {
    if (number++ == 0) {
      begin(so_far.scenario, out);
      if (so_far.recording.motion != formation::MotionLaw::straight)
        out.file().notes.emplace_back(
            "robots of this formation moved on curves between rows, which exactvo audit judges; here they go straight");
    }
    for (std::size_t i = 0; i < row.robots.size(); ++i) {
      const formation::Robot& robot = so_far.scenario.robots[i];
      if (out.options().at_axles && robot.drive)
        put_at_axle(robot, row.robots[i], i, row.time, number, out);
      else
        out.row(i, row.time, row.robots[i].position, number, TrajectoryRow().heading, row.robots[i].velocity);
    }
  });
}

void read_crowd_trajectories(const std::filesystem::path& path, TrajectorySink& out) {
  CrowdRecordingReader reader(path);
  const CrowdRecordingHead& head = reader.head();
  for (const std::uint16_t kind : head.kind_of) out.file().on_wheels += head.kinds[kind].wheels ? 1 : 0;
  const bool at_axles = out.options().at_axles && out.file().on_wheels > 0;
  if (at_axles && head.every > 1)
    throw DataError(
        DataCode::not_an_option, out.file().file, "",
        "robots on wheels and a row every " + std::to_string(head.every) + " steps, from which headings do not follow",
        "a recording of every step, or neither --radius nor --footprint");
  begin(scene_of(head).scenario, out);
  leave_out_ellipses(head, out.file());
  CrowdHeadings headings(head);
  CrowdRow row;
  for (std::uint64_t number = 1; reader.next(row); ++number) {
    call_wait_hook();
    if (at_axles) headings.follow(row);
    for (std::size_t i = 0; i < row.x.size(); ++i) {
      const bool at_axle = at_axles && headings.has(i);
      const geometry::Vec2 e = at_axle ? headings.of(i).heading : geometry::Vec2{};
      const double reference = at_axle ? head.kinds[head.kind_of[i]].wheels->reference : 0.0;
      out.row(i, row.step * head.time_step, head.place(row, i) - reference * e, number,
              at_axle ? std::atan2(e.y, e.x) : TrajectoryRow().heading);
    }
  }
  std::vector<std::string>& notes = out.file().notes;
  if (reader.is_cut_off()) notes.emplace_back("the recording is cut off after its last row");
  if (head.every > 1)
    notes.push_back("the recording has every " + std::to_string(head.every) +
                    "th step only: between rows robots are taken to go straight");
}

}  // namespace exactvo::datasets
