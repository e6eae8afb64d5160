// SPDX-License-Identifier: GPL-3.0-or-later
// Whether bodies on trajectories touch each other or a map: files and arrays.
#include <pybind11/stl.h>

#include <filesystem>

#include "exactvo/datasets/trajectory_pieces.h"
#include "module.h"
#include "shapes.h"
#include "support/check_certificates.h"
#include "support/check_page.h"
#include "support/footprint.h"

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
using geometry::MotionEvent;
using geometry::RigidBody;
using tools::between_names;

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

/// (names, agent, time, x, y, heading, vx, vy, in_frames): arrays of one length, the last three of them or None, and
/// whether `time` counts frames.
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
  columns.in_frames = py::cast<bool>(source[8]);
  return columns;
}

struct Question {
  std::vector<RigidBody> bodies;
  std::string words;                      ///< what they are
  double reach = 0.0;                     ///< m, of the largest
  bool has_rims = true, on_arcs = false;  ///< as in tools::CheckedFile
  std::vector<geometry::Obstacle> map;
  std::vector<std::optional<geometry::Disc>> discs;
  Between between = Between::straight;
  double near = 0.0, jump_speed = 0.0, longest_gap = 0.0;
};

struct Answer {
  std::vector<MotionEvent> events;
  std::vector<Move> jumps, gaps;
  geometry::MotionCheck check;
  std::optional<std::string> page, proofs;  ///< the page; how many proofs there are, in words
};

/// What is made beside the answer.
struct Wanted {
  bool page = false;
  std::string certificates;  ///< a file; empty: none
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
    question.has_rims = question.has_rims && grown > 0.0;
    question.on_arcs |= agent.turns_at > 0 && question.between == Between::straight;
    question.bodies.push_back(footprint_of(*footprint, grown));
    question.reach = std::max(question.reach, tools::reach_of(question.bodies.back()));
  }
  question.words = footprint ? "the footprint at its heading" : "discs";
}

Answer answer_of(TrajectoryReader& reader, TrajectorySurvey& survey, const tools::CheckedFile& asked,
                 const Question& question, const Wanted& wanted) {
  Answer answer;
  std::optional<tools::CheckPage> page;
  std::optional<tools::CheckCertificates> proofs;
  if (wanted.page) page.emplace(asked, question.bodies);
  if (!wanted.certificates.empty()) proofs.emplace(wanted.certificates, asked, question.bodies);
  geometry::MotionCheckOptions options{question.between, question.near, {}, question.discs};
  if (proofs) options.met = [&](const geometry::MetPair& pair) { proofs->add(pair); };
  geometry::MotionStream stream(question.map, options, [&](const MotionEvent& e) {
    answer.events.push_back(e);
    if (page) page->add(e);
  });
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
        survey.add(agent, piece);
        if (page) page->add(agent, piece, turned);
        stream.add(agent, piece, turned);
      });
  answer.check = stream.finish();
  if (page) answer.page = page->page(answer.check);
  if (proofs) answer.proofs = proofs->finish();
  return answer;
}

// --- Answers as Python objects ---

py::tuple as_tuple(const geometry::Bounds& b) {
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
                  "notes"_a = file.notes, "page"_a = answer.page, "proofs"_a = answer.proofs);
}

/// `source`: paths, or columns as `columns_of` takes them.
py::dict check_trajectories(const py::object& source, const py::object& format, const py::object& frame_rate,
                            const py::object& scale, const std::optional<Obstacles>& map, const py::object& radius,
                            const std::optional<Obstacles>& footprint, const std::string& between,
                            const py::object& near, const py::object& max_speed, const py::object& max_gap, bool page,
                            const std::string& certificates) {
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
  const tools::CheckedFile asked{file,
                                 survey,
                                 map                      ? "the map"
                                 : file.obstacles.empty() ? ""
                                                          : file.file,
                                 obstacles,
                                 question.between,
                                 !file.curves.empty(),
                                 question.words,
                                 question.near,
                                 question.jump_speed,
                                 question.longest_gap,
                                 0,
                                 question.has_rims,
                                 question.on_arcs};
  const Answer answer = without_gil([&] { return answer_of(*reader, survey, asked, question, {page, certificates}); });
  return as_dict(file, survey, question, answer);
}

}  // namespace

void bind_check(py::module_& module) {
  module.def("trajectory_header", [](const std::vector<std::string>& names, const py::object& scale) {
    const datasets::TrajectoryHeader header = datasets::read_trajectory_header(names, positive(scale, "scale"));
    py::dict columns;
    for (const auto& column : header.columns)
      columns[py::str(column.meaning)] = py::make_tuple(column.at, column.in_si);
    return py::make_tuple(columns, header.notes);
  });
  module.def("check_trajectories", &check_trajectories);
  module.def("trajectory_formats", &datasets::trajectory_formats);
}

}  // namespace exactvo::python
