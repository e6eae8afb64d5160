// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/recording_file.h"
#include "json/json_text.h"
#include "recordings/recording_names.h"

namespace exactvo::datasets {
namespace {

/// RFC 4180: quoted where it must be.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

void append_pair(std::string& row, geometry::Vec2 v) {
  row += ',';
  append_number(row, v.x);
  row += ',';
  append_number(row, v.y);
}

void append_csv_row(std::string& row, const formation::Step& step, const formation::RobotStep& robot,
                    const std::string& id, bool has_leader) {
  append_number(row, step.time);
  row += ',';
  row += csv_text(id);
  for (const geometry::Vec2 v : {robot.position, robot.velocity, robot.preferred, robot.chosen}) append_pair(row, v);
  row += ',';
  row += word_for(robot.status);
  row += ',';
  row += word_for(robot.mode);
  row += ',';
  row += std::to_string(robot.side);
  if (has_leader) {
    append_pair(row, step.leader_position);
    append_pair(row, step.leader_velocity);
  }
  row += '\n';
}

}  // namespace

struct TrajectoryWriter::State {
  AtomicFile out;
  const formation::Scenario& scenario;
  std::string text;  ///< of a row, in memory that it leaves to the next
};

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, const formation::Scenario& scenario)
    : state_(new State{AtomicFile(path), scenario, {}}) {
  state_->out.write(
      "time_s,robot,x_m,y_m,vx_m_s,vy_m_s,preferred_vx_m_s,preferred_vy_m_s,chosen_vx_m_s,chosen_vy_m_s,status,mode,"
      "side");
  state_->out.write(scenario.formation ? ",leader_x_m,leader_y_m,leader_vx_m_s,leader_vy_m_s\n" : "\n");
}

TrajectoryWriter::~TrajectoryWriter() = default;

void TrajectoryWriter::add(const formation::Step& row) {
  std::string& text = state_->text;
  text.clear();
  for (std::size_t i = 0; i < row.robots.size(); ++i)
    append_csv_row(text, row, row.robots[i], state_->scenario.robots.at(i).id, state_->scenario.formation.has_value());
  state_->out.write(text);
}

void TrajectoryWriter::finish() {
  state_->out.commit();
}

}  // namespace exactvo::datasets
