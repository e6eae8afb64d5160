// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/recording_file.h"

#include <initializer_list>
#include <memory>
#include <utility>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/geometry/require.h"
#include "files/sha256.h"
#include "files/text_file.h"
#include "recordings/codec.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {

namespace {

using formation::RobotStep;
using formation::Step;

void append_header(JsonWriter& json, const RecordingFile& file) {
  json.begin_object().member("kind", "exactvo-recording").member("format_version", kRecordingFormat);
  members(json, file.info);
  members(json, file.recording);
  Provenance timeless = file.info.provenance;
  timeless.written_at.clear();  // in the last line, which the digest leaves out: equal runs have equal digests
  json.key("provenance").raw(to_json(timeless));
  json.key("scenario");
  append_scenario(json, file.scenario);
  json.end_object();
}

void append_plan(JsonWriter& json, const formation::JointPlan& plan) {
  json.begin_object().member("row", plan.row).member("from_row", plan.from_row);
  json.key("robots").begin_array();
  for (std::size_t k = 0; k < plan.robots.size(); ++k)
    json.begin_object().member("robot", plan.robots[k]).member("start", plan.starts[k]).end_object();
  json.end_array().member("moves", plan.moves).end_object();
}

void append_row(JsonWriter& json, const Step& step, bool has_leader, const formation::LyapunovRow* lyapunov) {
  json.begin_object().member("time", step.time);
  if (has_leader) {
    json.key("leader").begin_object();
    json.member("position", step.leader_position).member("velocity", step.leader_velocity).end_object();
  }
  json.member_if(!step.moving.empty(), "moving", step.moving).member("robots", step.robots);
  if (lyapunov) json.member("lyapunov", *lyapunov);
  json.end_object();
}

struct CsvFile {
  explicit CsvFile(const std::filesystem::path& path) : out(path) {}
  AtomicFile out;
  GrowingText text;  ///< of a row, in memory that it leaves to the next
};

// --- The trajectory as CSV ---

void add_pair(GrowingText& row, geometry::Vec2 v) {
  row.add(',');
  row.add_number(v.x);
  row.add(',');
  row.add_number(v.y);
}

void add_csv_row(GrowingText& row, const formation::Step& step, const formation::RobotStep& robot,
                 std::string_view csv_id, bool has_leader, bool has_wheels) {
  row.add_number(step.time);
  row.add(',');
  row.add(csv_id);
  for (const geometry::Vec2 v : {robot.position, robot.velocity, robot.preferred, robot.chosen}) add_pair(row, v);
  for (const char* word : {word_for(robot.status), word_for(robot.mode)}) {
    row.add(',');
    row.add(word);
  }
  row.add(',');
  row.add(std::to_string(robot.side));
  if (has_leader) {
    add_pair(row, step.leader_position);
    add_pair(row, step.leader_velocity);
  }
  if (robot.wheels) {
    add_pair(row, robot.wheels->heading);
    add_pair(row, {robot.wheels->speeds.left, robot.wheels->speeds.right});
  } else if (has_wheels) {
    row.add(",,,,");
  }
  row.add('\n');
}

// --- Lyapunov functions as CSV ---

void add_csv_row(GrowingText& row, const formation::LyapunovRow& r) {
  const auto add = [&row](std::initializer_list<double> all) {
    for (const double number : all) {
      row.add(',');
      row.add_number(number);
    }
  };
  const auto add_rates = [&](std::initializer_list<double> all) {
    if (r.has_rates) return add(all);
    for (std::size_t k = 0; k < all.size(); ++k) row.add(',');
  };
  row.add_number(r.time);
  add({r.paper.kinetic, r.paper.consensus, r.paper.pinning, r.paper.integral});
  add_rates(
      {r.paper_rates.kinetic, r.paper_rates.consensus, r.paper_rates.pinning, r.paper_rates.integral, r.paper_rate});
  add({r.sound.kinetic, r.sound.consensus, r.sound.slots});
  add_rates({r.sound_rates.consensus, r.sound_rates.tracking, r.sound_rates.intervention, r.rate_bound});
  row.add('\n');
}

}  // namespace

struct RecordingWriter::State {
  explicit State(std::shared_ptr<AtomicFile> file) : out(std::move(file)) {}

  /// Writes {"name": what was appended}.
  template <class Append>
  void line(const char* name, const Append& append) {
    json.clear();
    json.begin_object().key(name);
    append();
    json.end_object().raw("\n");
    hash.add(json.text());
    out->write(json.text());
  }

  void name_body(std::size_t number, const std::vector<vo::Body>& bodies) {
    EXACTVO_REQUIRE(number < bodies.size(), "body " + std::to_string(number));
    if (number >= named.size()) named.resize(bodies.size());
    if (named[number]) return;
    named[number] = true;
    line("body", [&] {
      json.begin_object().member("number", number);
      members(json, bodies[number]);
      json.end_object();
    });
  }

  std::shared_ptr<AtomicFile> out;
  JsonWriter json{JsonWriter::Layout::compact};
  Sha256 hash;
  std::vector<bool> named;  ///< of the bodies
  std::size_t rows = 0;
  bool has_leader = false;
};

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const RecordingFile& about)
    : RecordingWriter(std::make_shared<AtomicFile>(path, MissingFolder::is_made, Unfinished::goes, Pipe::is_written),
                      about) {}

RecordingWriter::RecordingWriter(std::shared_ptr<AtomicFile> out, const RecordingFile& about)
    : state_(std::make_unique<State>(std::move(out))) {
  state_->has_leader = about.scenario.formation.has_value();
  state_->line("header", [&] { append_header(state_->json, about); });
}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::add(const formation::GoalBodies& of_goal, const std::vector<vo::Body>& bodies) {
  for (const std::size_t body : of_goal.bodies) state_->name_body(body, bodies);
  state_->line("goal_bodies", [&] {
    state_->json.begin_object().member("time", of_goal.time).member("robot", of_goal.robot);
    state_->json.member("goal", of_goal.goal).member("bodies", of_goal.bodies).end_object();
  });
}

void RecordingWriter::add(const formation::JointPlan& plan) {
  EXACTVO_REQUIRE(plan.row == state_->rows, "plan of row " + std::to_string(plan.row));
  state_->line("plan", [&] { append_plan(state_->json, plan); });
}

void RecordingWriter::add(const Step& row, const std::vector<vo::Body>& bodies,
                          const formation::LyapunovRow* lyapunov) {
  for (const RobotStep& robot : row.robots)
    for (const formation::DecisionConstraint& c : robot.constraints) state_->name_body(c.body, bodies);
  state_->line("row", [&] { append_row(state_->json, row, state_->has_leader, lyapunov); });
  ++state_->rows;
}

void RecordingWriter::finish(const RecordingFile& about, Durability durability) {
  const std::string digest = state_->hash.digest();
  state_->json.clear();
  state_->json.begin_object().key("end");
  state_->json.begin_object().member("rows", state_->rows);
  members(state_->json, about);
  state_->json.member("sha256", digest).end_object();
  state_->json.end_object().raw("\n");
  state_->out->write(state_->json.text());
  state_->out->commit(durability);
}

void write_recording(const std::filesystem::path& path, const RecordingFile& file) {
  RecordingWriter writer(path, file);
  const formation::Recording& recording = file.recording;
  std::size_t goal_bodies = 0, plans = 0;
  for (std::size_t k = 0; k < recording.steps.size(); ++k) {
    const bool last = k + 1 == recording.steps.size();
    for (; goal_bodies < recording.goal_bodies.size() &&
           (last || recording.goal_bodies[goal_bodies].time <= recording.steps[k].time);
         ++goal_bodies)
      writer.add(recording.goal_bodies[goal_bodies], recording.bodies);
    for (; plans < recording.plans.size() && recording.plans[plans].row == k; ++plans)
      writer.add(recording.plans[plans]);
    writer.add(recording.steps[k], recording.bodies, k < file.lyapunov.size() ? &file.lyapunov[k] : nullptr);
  }
  writer.finish(file);
}

struct TrajectoryWriter::State : CsvFile {
  State(const std::filesystem::path& path, const formation::Scenario& scenario)
      : CsvFile(path), has_leader(scenario.formation.has_value()) {
    for (const formation::Robot& robot : scenario.robots) {
      // Quoted where it must be.
      csv_ids.push_back(robot.id.find_first_of(",\"\r\n") == std::string::npos ? robot.id : csv_quoted(robot.id));
      has_wheels = has_wheels || robot.drive;
    }
  }

  std::vector<std::string> csv_ids;  ///< of the robots
  bool has_leader;
  bool has_wheels = false;  ///< some robot
};

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, const formation::Scenario& scenario)
    : state_(std::make_unique<State>(path, scenario)) {
  state_->out.write(
      "time_s,robot,x_m,y_m,vx_m_s,vy_m_s,preferred_vx_m_s,preferred_vy_m_s,chosen_vx_m_s,chosen_vy_m_s,status,mode,"
      "side");
  if (scenario.formation) state_->out.write(",leader_x_m,leader_y_m,leader_vx_m_s,leader_vy_m_s");
  if (state_->has_wheels) state_->out.write(",heading_x,heading_y,left_wheel_m_s,right_wheel_m_s");
  state_->out.write("\n");
}

TrajectoryWriter::~TrajectoryWriter() = default;

void TrajectoryWriter::add(const formation::Step& row) {
  GrowingText& text = state_->text;
  text.clear();
  for (std::size_t i = 0; i < row.robots.size(); ++i)
    add_csv_row(text, row, row.robots[i], state_->csv_ids.at(i), state_->has_leader, state_->has_wheels);
  state_->out.write(text.view());
}

void TrajectoryWriter::finish(Durability durability) {
  state_->out.commit(durability);
}

struct LyapunovWriter::State : CsvFile {
  using CsvFile::CsvFile;
};

LyapunovWriter::LyapunovWriter(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {
  state_->out.write(
      "time_s,paper_kinetic_m2_s2,paper_consensus_m2_s2,paper_pinning_m2_s2,paper_integral_m2_s2,"
      "paper_rate_kinetic_m2_s3,paper_rate_consensus_m2_s3,paper_rate_pinning_m2_s3,paper_rate_integral_m2_s3,"
      "paper_rate_claimed_m2_s3,sound_kinetic_m2_s2,sound_consensus_m2_s2,sound_slots_m2_s2,"
      "sound_rate_consensus_m2_s3,sound_rate_tracking_m2_s3,sound_rate_intervention_m2_s3,"
      "sound_rate_bound_m2_s3\n");
}

LyapunovWriter::~LyapunovWriter() = default;

void LyapunovWriter::add(const formation::LyapunovRow& row) {
  state_->text.clear();
  add_csv_row(state_->text, row);
  state_->out.write(state_->text.view());
}

void LyapunovWriter::finish(Durability durability) {
  state_->out.commit(durability);
}

}  // namespace exactvo::datasets
