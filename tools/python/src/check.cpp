// SPDX-License-Identifier: GPL-3.0-or-later
// Whether bodies on trajectories touch each other or a map: files and arrays.
#include <pybind11/stl.h>

#include <cmath>
#include <filesystem>

#include "exactvo/datasets/trajectory_pieces.h"
#include "module.h"
#include "shapes.h"

namespace exactvo::python {

namespace {

using namespace py::literals;
using datasets::Move;
using datasets::TrajectoryColumns;
using datasets::TrajectoryFile;
using datasets::TrajectoryReader;
using datasets::TrajectoryRow;
using datasets::TrajectorySurvey;
using geometry::Between;
using geometry::Bounds;
using geometry::MotionEvent;
using geometry::RigidBody;

const std::vector<std::string>& between_names() {
  static const std::vector<std::string> kNames{"straight", "hold", "cubic", "none"};
  return kNames;
}

bool parse_between(const std::string& text, Between& between) {
  for (std::size_t k = 0; k < between_names().size(); ++k) {
    if (text != between_names()[k]) continue;
    between = static_cast<Between>(k);
    return true;
  }
  return false;
}

std::vector<double> copied(py::handle object, const char* name, py::ssize_t count) {
  if (object.is_none()) return {};
  const Doubles array = doubles(object, name, {count});
  return {array.data(), array.data() + array.size()};
}

/// (names, agent, time, x, y, heading, vx, vy), arrays of one length, the last three or None.
TrajectoryColumns columns_of(const py::tuple& source) {
  TrajectoryColumns columns;
  columns.names = py::cast<std::vector<std::string>>(source[0]);
  columns.time = copied(source[2], "time", -1);
  const auto count = static_cast<py::ssize_t>(columns.time.size());
  const auto agents = array_of<std::int64_t>(source[1], "id", {count}, "an id for each row");
  columns.agent.assign(agents.data(), agents.data() + agents.size());
  columns.x = copied(source[3], "x", count);
  columns.y = copied(source[4], "y", count);
  columns.heading = copied(source[5], "theta", count);
  columns.vx = copied(source[6], "vx", count);
  columns.vy = copied(source[7], "vy", count);
  return columns;
}

struct Question {
  std::vector<RigidBody> bodies;
  double reach = 0.0;  ///< m, of the largest
  std::vector<geometry::Obstacle> map;
  std::vector<std::optional<geometry::Disc>> discs;
  Between between = Between::straight;
  double near = 0.0, jump_speed = 0.0, longest_gap = 0.0;
};

struct Answer {
  std::vector<MotionEvent> events;
  std::vector<Move> jumps, gaps;
  geometry::MotionCheck check;
};

double radius_of(py::handle radius, const TrajectoryFile& file, std::size_t agent) {
  if (radius.is_none()) {
    if (!file.radii.empty()) return file.radii[agent];
    throw ArgumentError("radius", "None", "a radius or a footprint, since the trajectories have no radii");
  }
  if (!py::isinstance<py::dict>(radius)) return at_least_zero(radius, "radius");
  const py::str id(file.agents[agent]);
  if (!radius.contains(id)) throw ArgumentError("radius", "no radius of " + file.agents[agent], "one for each id");
  return at_least_zero(radius[id], "radius");
}

RigidBody footprint_of(const Obstacles& footprint, double radius) {
  if (footprint.list.size() != 1)
    throw ArgumentError("footprint", std::to_string(footprint.list.size()) + " shapes", "one polygon or wall");
  const geometry::Obstacle& shape = footprint.list.front().shape;
  RigidBody body;
  if (const auto* wall = std::get_if<geometry::Polyline>(&shape)) {
    if (!(radius > 0.0)) throw ArgumentError("radius", "0", "half the width of the wall, above 0 m");
    for (std::size_t k = 1; k < wall->points.size(); ++k)
      body.push_back({{wall->points[k - 1], wall->points[k]}, radius});
    return body;
  }
  const auto& polygon = std::get<geometry::Polygon>(shape);
  if (!polygon.holes.empty()) throw ArgumentError("footprint", "a polygon with holes", "a polygon without holes");
  body = geometry::polygon_body(polygon);
  for (geometry::RoundedPolygon& part : body) part.radius = radius;
  return body;
}

void set_bodies(const TrajectoryReader& reader, const TrajectorySurvey& survey, py::handle radius,
                const std::optional<Obstacles>& footprint, Question& question) {
  const TrajectoryFile& file = reader.file();
  for (std::size_t k = 0; k < file.agents.size(); ++k) {
    const bool is_bare = footprint && radius.is_none();
    const double grown = is_bare ? 0.0 : radius_of(radius, file, k);
    if (!footprint) {
      question.bodies.push_back(geometry::disc_body(grown));
      question.reach = std::max(question.reach, grown);
      continue;
    }
    const datasets::AgentSurvey& agent = survey.agents()[k];
    if (agent.turns_at > 0 && question.between == Between::cubic)
      reader.refuse(datasets::DataCode::out_of_range, agent.turns_at,
                    "agent " + file.agents[k] + " at another heading than before",
                    "one heading of an agent: on cubics, a footprint that turns is not decided");
    const RigidBody body = footprint_of(*footprint, grown);
    for (const geometry::RoundedPolygon& part : body)
      for (const Vec2 c : part.corners) question.reach = std::max(question.reach, norm(c) + part.radius);
    question.bodies.push_back(body);
  }
}

Answer answer_of(TrajectoryReader& reader, const TrajectorySurvey& survey, const Question& question) {
  Answer answer;
  geometry::MotionCheckOptions options{question.between, question.near, {}, question.discs};
  geometry::MotionStream stream(question.map, options, [&](const MotionEvent& e) { answer.events.push_back(e); });
  for (const RigidBody& body : question.bodies) stream.add_body(body);
  datasets::Moves moves;
  for_each_piece(
      reader, survey, {question.between, question.longest_gap},
      [&](const TrajectoryRow& row) {
        Move move;
        if (!moves.next(row, move)) return;
        if (move.speed() > question.jump_speed) answer.jumps.push_back(move);
        if (move.interval() > survey.gap_of(move.agent)) answer.gaps.push_back(move);
      },
      [&](std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned) {
        stream.add(agent, piece, turned);
      });
  answer.check = stream.finish();
  return answer;
}

// --- Answers as Python objects ---

py::tuple as_tuple(const Bounds& b) {
  return py::make_tuple(b.low + 0.0, b.high + 0.0);  // -0.0 becomes 0.0
}

py::tuple as_tuple(const datasets::Extreme& e) {
  return py::make_tuple(e.value, e.time, e.line);
}

py::dict as_dict(const TrajectoryFile& file, const TrajectorySurvey& survey, const Question& question,
                 const Answer& answer) {
  py::list events, approaches, findings, bodies;
  for (const MotionEvent& e : answer.events)
    events.append(py::make_tuple(
        e.is_open                                     ? "close"
        : e.encounter == geometry::Encounter::overlap ? "overlap"
                                                      : "contact",
        file.agents[e.body], e.with_obstacle, e.with_obstacle ? py::cast(e.other) : py::cast(file.agents[e.other]),
        as_tuple(e.first), as_tuple(e.last), as_tuple(e.clearance), e.nearest_time, python::as_tuple(e.place)));
  for (const geometry::Approach& a : answer.check.approaches)
    approaches.append(py::make_tuple(file.agents[a.body], a.with_obstacle,
                                     a.with_obstacle ? py::cast(a.other) : py::cast(file.agents[a.other]),
                                     as_tuple(a.clearance), a.nearest_time, python::as_tuple(a.place)));
  const auto add_findings = [&](const char* kind, const std::vector<Move>& moves) {
    for (const Move& m : moves)
      findings.append(py::make_tuple(kind, file.agents[m.agent], m.to.line, m.from.time, m.to.time,
                                     norm(m.to.at - m.from.at), m.speed()));
  };
  add_findings("jump", answer.jumps);
  add_findings("gap", answer.gaps);
  for (std::size_t k = 0; k < survey.agents().size(); ++k) {
    const datasets::AgentSurvey& a = survey.agents()[k];
    bodies.append(py::make_tuple(file.agents[k], a.rows, a.first, a.last, as_tuple(a.speed), as_tuple(a.acceleration)));
  }
  return py::dict("file"_a = file.file, "format"_a = file.format, "rows"_a = survey.rows(),
                  "repeated_rows"_a = file.repeated, "overlaps"_a = answer.check.overlaps,
                  "contacts"_a = answer.check.contacts, "open"_a = answer.check.open, "pieces"_a = answer.check.pieces,
                  "pairs"_a = answer.check.pairs, "near"_a = question.near, "jump_speed"_a = question.jump_speed,
                  "between"_a = file.curves.empty() ? between_names()[static_cast<std::size_t>(question.between)]
                                                    : std::string("polynomials"),
                  "events"_a = events, "approaches"_a = approaches, "findings"_a = findings, "bodies"_a = bodies,
                  "notes"_a = file.notes);
}

/// `source`: paths, or columns as `columns_of` takes them.
py::dict check_trajectories(const py::object& source, const py::object& format, const py::object& frame_rate,
                            const py::object& scale, const std::optional<Obstacles>& map, const py::object& radius,
                            const std::optional<Obstacles>& footprint, const std::string& between,
                            const py::object& near, const py::object& max_speed, const py::object& max_gap) {
  datasets::TrajectoryOptions options;
  if (!format.is_none()) {
    options.format = py::str(format);
    require_word(options.format, "format", datasets::trajectory_formats());
  }
  if (!frame_rate.is_none()) options.frame_rate = positive(frame_rate, "frame_rate");
  options.scale = positive(scale, "scale");
  Question question;
  question.between = word<Between>(between, "between", between_names(), &parse_between);
  options.at_axles = !radius.is_none() || footprint.has_value();
  options.one_velocity = question.between == Between::cubic;
  question.longest_gap = max_gap.is_none() ? std::numeric_limits<double>::infinity() : positive(max_gap, "max_gap");
  const auto made_reader = [&] {
    if (py::isinstance<py::tuple>(source))
      return std::make_unique<TrajectoryReader>(columns_of(py::cast<py::tuple>(source)), "trajectories", options);
    auto files = py::cast<std::vector<std::string>>(source);
    std::error_code unknown;
    if (files.size() == 1 && std::filesystem::is_directory(files.front(), unknown))
      files = datasets::trajectory_files_in(files.front());
    return std::make_unique<TrajectoryReader>(files, options);
  };
  const std::unique_ptr<TrajectoryReader> reader = made_reader();
  TrajectorySurvey survey;
  without_gil([&] {
    reader->read([&](const TrajectoryRow& row) { survey.add(row); });
    return true;
  });
  const TrajectoryFile file = reader->file();
  if (map && file.in_cells)
    throw ArgumentError("map", "a map of a plan on cells",
                        "none: exactvo check places plans on Moving AI maps; places in m can be checked on any map");
  set_bodies(*reader, survey, radius, footprint, question);
  question.near = near.is_none() ? question.reach : at_least_zero(near, "near");
  question.jump_speed = max_speed.is_none() ? survey.jump_speed() : positive(max_speed, "max_speed");
  const std::vector<formation::SceneObstacle>& obstacles = map ? map->list : file.obstacles;
  for (const formation::SceneObstacle& o : obstacles) {
    question.map.push_back(o.shape);
    question.discs.push_back(o.disc);
  }
  const Answer answer = without_gil([&] { return answer_of(*reader, survey, question); });
  return as_dict(file, survey, question, answer);
}

}  // namespace

void bind_check(py::module_& module) {
  module.def("check_trajectories", &check_trajectories);
  module.def("trajectory_formats", &datasets::trajectory_formats);
}

}  // namespace exactvo::python
