// SPDX-License-Identifier: GPL-3.0-or-later
#include "explorer/packed_run.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <stdexcept>
#include <variant>

#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/waiting.h"
#include "exactvo/geometry/names.h"
#include "support/routes_of_run.h"

namespace exactvo::tools {

using formation::DecisionConstraint;
using formation::RobotStep;
using formation::Step;
using geometry::Vec2;
using Json = nlohmann::ordered_json;

// --- Columns of numbers, coded so that they deflate well; page/columns.js reads them ---

/// Columns one after the other, each beginning at a multiple of 8 bytes.
class PackedColumns {
 public:
  /// Each entry XORed with the one `stride` before it, which leaves few bits of what changes slowly; then the bytes of
  /// all entries by their place in the entry. `stride` 0: no XOR.
  void add(const char* name, const std::vector<double>& values, std::size_t stride) {
    std::vector<std::uint64_t> bits(values.size());
    if (!values.empty()) std::memcpy(bits.data(), values.data(), 8 * values.size());
    const std::vector<std::uint64_t> plain = bits;
    if (stride > 0)
      for (std::size_t k = stride; k < bits.size(); ++k) bits[k] ^= plain[k - stride];
    append(name, "f64", stride, bits);
  }
  /// The zigzag of each entry's second difference along `stride`: 0 of what moves evenly.
  void add(const char* name, const std::vector<std::int32_t>& values, std::size_t stride) {
    std::vector<std::uint32_t> coded(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto at = [&](std::size_t back) {
        return k < back * stride ? 0U : static_cast<std::uint32_t>(values[k - back * stride]);
      };
      const auto difference = static_cast<std::int32_t>(k < 2 * stride ? at(0) - at(1) : at(0) - 2 * at(1) + at(2));
      coded[k] = (static_cast<std::uint32_t>(difference) << 1) ^ static_cast<std::uint32_t>(difference >> 31);
    }
    append(name, "i32", stride, coded);
  }
  void add(const char* name, const std::vector<std::uint32_t>& values) { append(name, "u32", 0, values); }
  /// Each entry less the one `stride` before it. `stride` 0: as it is.
  void add(const char* name, const std::vector<std::uint8_t>& values, std::size_t stride) {
    std::vector<std::uint8_t> coded = values;
    for (std::size_t k = stride; k < values.size() && stride > 0; ++k)
      coded[k] = static_cast<std::uint8_t>(values[k] - values[k - stride]);
    append(name, "u8", stride, coded);
  }

  /// The name, type, number of entries and stride of each column.
  const Json& names() const { return names_; }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class Word>
  void append(const char* name, const char* type, std::size_t stride, const std::vector<Word>& words) {
    names_.push_back({{"name", name}, {"type", type}, {"count", words.size()}, {"stride", stride}});
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + words.size() * sizeof(Word));
    for (std::size_t plane = 0; plane < sizeof(Word); ++plane)
      for (std::size_t k = 0; k < words.size(); ++k)
        bytes_[begin + plane * words.size() + k] =
            static_cast<char>(static_cast<std::uint64_t>(words[k]) >> (8 * plane));
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
  }

  Json names_ = Json::array();
  std::string bytes_;
};

namespace {

Json to_json(Vec2 p) {
  return Json::array({p.x, p.y});
}

Json flat(const std::vector<Vec2>& points) {
  Json all = Json::array();
  for (const Vec2 p : points) {
    all.push_back(p.x);
    all.push_back(p.y);
  }
  return all;
}

Json to_json(const geometry::Disc& d) {
  return {{"disc", {d.center.x, d.center.y, d.radius}}};
}
Json to_json(const geometry::Segment& s) {
  return {{"segment", {s.a.x, s.a.y, s.b.x, s.b.y}}};
}
Json to_json(const geometry::ConvexPolygon& p) {
  return {{"polygon", flat(p.vertices)}};
}
Json to_json(const geometry::Ellipse& e) {
  return {{"ellipse", {e.center.x, e.center.y, e.l11, e.l21, e.l22}}};
}

Json to_json(const std::string& id, const geometry::Obstacle& shape) {
  Json rings = Json::array();
  if (const auto* line = std::get_if<geometry::Polyline>(&shape)) {
    rings.push_back(flat(line->points));
  } else {
    const auto& polygon = std::get<geometry::Polygon>(shape);
    rings.push_back(flat(polygon.outer));
    for (const geometry::Ring& hole : polygon.holes) rings.push_back(flat(hole));
  }
  return {{"id", id}, {"solid", geometry::has_interior(shape)}, {"rings", std::move(rings)}};
}

constexpr geometry::Names<vo::BodyKind, 4> kBodyKinds{{{vo::BodyKind::enclosure, "enclosure"},
                                                       {vo::BodyKind::obstacle_edge, "edge"},
                                                       {vo::BodyKind::robot, "robot"},
                                                       {vo::BodyKind::moving_obstacle, "moving"}}};

Json to_json(const vo::Body& body) {
  Json json = {{"kind", geometry::name_in(kBodyKinds, body.kind)}, {"owners", body.owners}};
  const bool is_placed = body.kind == vo::BodyKind::enclosure || body.kind == vo::BodyKind::obstacle_edge;
  if (is_placed) json["shape"] = std::visit([](const auto& shape) { return to_json(shape); }, body.shape);
  return json;
}

/// The discs of a footprint that keep clear of obstacles: how far ahead of the reference point, and the radius, m.
Json chain_json(const formation::DifferentialDrive& drive) {
  Json chain = Json::array();
  for (const geometry::Disc& disc : drive.chain) {
    chain.push_back(disc.center.x - drive.reference);
    chain.push_back(disc.radius);
  }
  return chain;
}

Json robots_json(const formation::Scenario& scenario) {
  Json robots = Json::array();
  for (const formation::Robot& robot : scenario.robots) {
    robots.push_back({{"id", robot.id},
                      {"radius", robot.radius},
                      {"obstacle_radius", obstacle_radius(robot)},
                      {"max_speed", robot.max_speed},
                      {"goals", flat(robot.goals)},
                      {"cooperates", robot.cooperates}});
    if (const std::optional<formation::DifferentialDrive>& drive = robot.drive)
      robots.back()["on_wheels"] = {{"reference", drive->reference},
                                    {"wheel_separation", drive->wheel_separation},
                                    {"max_wheel_speed", drive->max_wheel_speed},
                                    {"body_radius", drive->body_radius},
                                    {"footprint", flat(drive->footprint)},
                                    {"chain", chain_json(*drive)}};
    else if (robot.body_radius > 0.0)
      robots.back()["body_radius"] = robot.body_radius;
  }
  return robots;
}

Json scene_json(const formation::Scenario& scenario) {
  Json obstacles = Json::array(), moving = Json::array();
  for (const formation::SceneObstacle& o : scenario.obstacles) obstacles.push_back(to_json(o.id, o.shape));
  for (const formation::MovingObstacle& o : scenario.moving_obstacles) {
    moving.push_back(to_json(o.id, o.shape));
    if (!o.max_speed || !o.disc) continue;
    moving.back()["max_speed"] = *o.max_speed;
    moving.back().update(to_json(*o.disc));
  }
  return {{"robots", robots_json(scenario)}, {"obstacles", std::move(obstacles)}, {"moving", std::move(moving)}};
}

template <class Text>
Json or_null(const std::optional<Text>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json about_json(const datasets::RecordingFile& file) {
  const formation::Scenario& scenario = file.scenario;
  const formation::Recording& run = file.recording;
  Json json = {{"name", scenario.name},
               {"description", scenario.description},
               {"method", file.info.method},
               {"controller", or_null(file.info.controller)},
               {"guidance", or_null(file.info.guidance)},
               {"liveness", or_null(file.info.liveness)},
               {"time_step", run.time_step},
               {"straight", run.motion == formation::MotionLaw::straight},
               {"relative_frame", run.relative_frame},
               {"all_half_planes", run.all_half_planes},
               {"change", scenario.acceleration ? scenario.acceleration->max * scenario.time_step : 0.0},
               {"speed_bound", scenario.speed_bound == formation::SpeedBoundKind::disc ? "disc" : "box"},
               {"arrival_tolerance", scenario.arrival_tolerance},
               {"version", file.info.provenance.version},
               {"commit", file.info.provenance.commit},
               {"outcome", file.outcome.empty() ? run.outcome : file.outcome},
               {"assumed", formation::assumed_words(scenario)},
               {"warnings", run.warnings}};
  if (scenario.formation)
    json["formation"] = {{"offsets", flat(run.offsets)}, {"path", flat(scenario.formation->leader.path)}};
  json["stuck"] = Json::array();
  for (const formation::StuckReport& report : file.stuck)
    json["stuck"].push_back({{"robot", report.robot}, {"text", report.text}});
  json["collisions"] = Json::array();
  for (const formation::Collision& c : file.collisions)
    json["collisions"].push_back({{"robot", c.robot},
                                  {"kind", name(c.kind)},
                                  {"with", c.with},
                                  {"from", c.from},
                                  {"until", c.until},
                                  {"at", c.deepest_at},
                                  {"depth", c.depth},
                                  {"place", to_json(c.place)},
                                  {"standing", c.standing}});
  return json;
}

/// Places of all moves one after the other, as are those who make them.
Json plans_json(const formation::Recording& run) {
  Json plans = Json::array();
  for (const formation::JointPlan& plan : run.plans) {
    Json movers = Json::array();
    std::vector<Vec2> places;
    for (const formation::PlanMove& move : plan.moves) {
      movers.push_back(move.robot);
      places.push_back(move.to);
    }
    plans.push_back({{"time", static_cast<double>(plan.row) * run.time_step},
                     {"from", static_cast<double>(plan.from_row) * run.time_step},
                     {"robots", plan.robots},
                     {"starts", flat(plan.starts)},
                     {"movers", std::move(movers)},
                     {"places", flat(places)}});
  }
  return plans;
}

/// Planned again as the run did; null where it had none, or where that would take long.
Json routes_json(const datasets::RecordingFile& about, const PackedRunLimits& limits) {
  const auto planned = routes_of(about, limits.routed_robots, limits.routed_vertices);
  if (!planned) return nullptr;
  Json routes = Json::array();
  for (const formation::PlannedRoute& route : *planned)
    routes.push_back(
        {{"robot", route.robot}, {"goal", route.goal}, {"points", flat(route.points)}, {"why_not", route.why_not}});
  return routes;
}

/// Null where a name is no UTF-8.
Json scenario_json(const formation::Scenario& scenario) {
  Json json = Json::parse(datasets::write_scenario(scenario), nullptr, false);
  return json.is_discarded() ? Json(nullptr) : json;
}

constexpr const char* kMagic = "EXVIEW01";
constexpr std::size_t kMostEvents = 2000;
/// m and m/s: what a picture does not show.
constexpr double kFinestQuantum = 0x1p-13;
/// Radians, of a heading.
constexpr double kHeadingQuantum = 0x1p-16;
/// Doubles of a decision beside its half-planes, and of a half-plane.
constexpr std::size_t kNumbersOfDecision = 14, kNumbersOfHalfPlane = 6;

// --- Events ---

bool is_of_plan(formation::Mode mode) {
  return mode == formation::Mode::by_plan || mode == formation::Mode::going_back;
}

/// Notes are the simulation's words.
const char* kind_of_note(const std::string& note) {
  const auto has = [&](const char* words) { return note.find(words) != std::string::npos; };
  if (has("cannot reach")) return "unreachable";
  return has(" by plan: ") || has("waits for") ? "plan" : "note";
}

// --- Rounding ---

/// The finest power of two, at least kFinestQuantum, in which the values take 30 bits.
double quantum_for(double largest) {
  double quantum = kFinestQuantum;
  while (largest / quantum > 0x1p29) quantum *= 2.0;
  return quantum;
}

std::int32_t in_quanta(double value, double quantum) {
  return std::isfinite(value) ? static_cast<std::int32_t>(std::llround(value / quantum)) : 0;
}

/// For values that need not be finite: a run may have diverged.
double larger(double largest, double value) {
  return std::isfinite(value) ? std::max(largest, std::fabs(value)) : largest;
}

// --- Decisions ---

std::size_t numbers_in(const Step& row) {
  std::size_t count = 0;
  for (const RobotStep& robot : row.robots)
    count += kNumbersOfDecision + kNumbersOfHalfPlane * robot.constraints.size();
  return count;
}

void append(std::vector<double>& numbers, Vec2 v) {
  numbers.insert(numbers.end(), {v.x, v.y});
}

/// `of` applied to each entry; `of` is a member or a function.
template <class Number, class Entry, class Of>
std::vector<Number> each(const std::vector<const Entry*>& entries, const Of& of) {
  std::vector<Number> numbers;
  numbers.reserve(entries.size());
  for (const Entry* entry : entries) numbers.push_back(static_cast<Number>(std::invoke(of, *entry)));
  return numbers;
}

void add_decisions(const std::vector<Step>& rows, const formation::Scenario& scenario, PackedColumns& columns) {
  std::vector<double> time, moving, state, line;
  std::vector<std::uint32_t> waits;
  std::vector<std::uint8_t> flags;
  std::vector<const RobotStep*> robots;
  std::vector<const lp::ActiveConstraint*> parts;
  std::vector<const DecisionConstraint*> half_planes;
  for (const Step& row : rows) {
    time.push_back(row.time);
    // For each robot the one that holds it most, by its number from 1 on.
    for (const std::vector<std::size_t>& by : formation::waiting_in(scenario, row))
      waits.push_back(by.empty() ? 0 : static_cast<std::uint32_t>(by.front() + 1));
    for (std::size_t i = 0; i < row.robots.size(); ++i) {
      const RobotStep& r = row.robots[i];
      robots.push_back(&r);
      for (const Vec2 v : {r.anchor, r.anchor_velocity, r.position, r.velocity, r.preferred, r.chosen})
        append(state, v);
      for (const lp::ActiveConstraint& part : r.bound) parts.push_back(&part);
      for (const DecisionConstraint& c : r.constraints) {
        half_planes.push_back(&c);
        flags.push_back(static_cast<std::uint8_t>(c.certified | c.hard << 1 | c.active << 2 | c.fell_back << 3));
        append(line, c.half_plane.normal);
        line.push_back(c.half_plane.offset);
      }
    }
    for (const formation::MovedObstacle& o : row.moving)
      for (const Vec2 v : {o.displacement, o.velocity}) append(moving, v);
  }
  columns.add("decision.time", time, 0);
  columns.add("decision.state", state, rows.empty() ? 0 : 12 * rows.front().robots.size());
  columns.add("decision.violation", each<double>(robots, &RobotStep::violation), 0);
  columns.add("decision.status", each<std::uint8_t>(robots, &RobotStep::status), 0);
  columns.add("decision.exact_multipliers", each<std::uint8_t>(robots, &RobotStep::exact_multipliers), 0);
  columns.add("decision.own_stage", each<std::uint8_t>(robots, &RobotStep::own_stage), 0);
  columns.add("decision.half_planes",
              each<std::uint32_t>(robots, [](const RobotStep& r) { return r.constraints.size(); }));
  if (meets_movers(scenario))
    columns.add("decision.stopping_steps", each<std::uint32_t>(robots, &RobotStep::stopping_steps));
  columns.add("decision.parts", each<std::uint32_t>(robots, [](const RobotStep& r) { return r.bound.size(); }));
  columns.add("decision.moving", moving, 0);
  columns.add("decision.waits", waits);
  columns.add("part.kind", each<std::uint8_t>(parts, [](const auto& part) { return part.binding.kind; }), 0);
  columns.add("part.multiplier", each<double>(parts, &lp::ActiveConstraint::multiplier), 0);
  columns.add("half_plane.body", each<std::uint32_t>(half_planes, &DecisionConstraint::body));
  columns.add("half_plane.index", each<std::uint32_t>(half_planes, &DecisionConstraint::index));
  columns.add("half_plane.piece", each<std::uint32_t>(half_planes, &DecisionConstraint::piece));
  columns.add("half_plane.flags", flags, 0);
  columns.add("half_plane.line", line, 0);
  columns.add("half_plane.time_horizon", each<double>(half_planes, &DecisionConstraint::time_horizon), 0);
  columns.add("half_plane.clearance", each<double>(half_planes, &DecisionConstraint::clearance), 0);
  columns.add("half_plane.multiplier", each<double>(half_planes, &DecisionConstraint::multiplier), 0);
}

/// In zlib's format (RFC 1950), which ends in a checksum.
std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const int result =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  if (result != Z_OK) throw std::runtime_error("zlib: compress2 failed with " + std::to_string(result));
  out.resize(size);
  return out;
}

std::string whole(const Json& head, const std::string& columns) {
  // Names are what their files hold: bytes that are no UTF-8 become U+FFFD.
  const std::string text = head.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string all = kMagic;
  const auto length = static_cast<std::uint32_t>(text.size());
  for (int shift = 0; shift < 32; shift += 8) all.push_back(static_cast<char>(length >> shift));
  all += text;
  all.resize((all.size() + 7) / 8 * 8);
  return deflated(all + columns);
}

}  // namespace

void RunPacker::add_event(double time, std::size_t robot, const char* kind, const std::string& text) {
  if (events_.size() == kMostEvents) {
    ++events_left_out_;
    return;
  }
  events_.push_back({{"time", time}, {"robot", robot}, {"kind", kind}, {"text", text}});
}

void RunPacker::note_events(const Step& row) {
  const bool first = modes_.empty();
  modes_.resize(row.robots.size());
  is_relaxed_.resize(row.robots.size());
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    const RobotStep& r = row.robots[i];
    const bool relaxed = bodies_gave(r);
    if (!r.note.empty()) add_event(row.time, i, kind_of_note(r.note), r.note);
    if (!first && r.mode != modes_[i]) {
      if (is_of_plan(r.mode))
        add_event(row.time, i, "plan",
                  r.mode == formation::Mode::by_plan ? "goes by a joint plan" : "goes back to where its plan begins");
      else if (is_of_plan(modes_[i]))
        add_event(row.time, i, "plan", "goes by itself again");
    }
    if (relaxed && !is_relaxed_[i]) add_event(row.time, i, "relaxed", lp::name(r.status));
    if (!first && r.mode == formation::Mode::arrived && modes_[i] != r.mode)
      add_event(row.time, i, "arrived", "arrived");
    modes_[i] = r.mode;
    is_relaxed_[i] = relaxed;
  }
}

void RunPacker::keep_row(const Step& row) {
  if (last_row_is_extra_) rows_.pop_back();
  if ((rows_.size() + 1) * row.robots.size() > limits_.states && rows_.size() > 2) {
    keep_every_second(rows_);
    every_row_ *= 2;
  }
  Row& kept = rows_.emplace_back();
  kept.time = row.time;
  kept.leader = row.leader_position;
  // The final row has none: they stay where they were.
  kept.moving = row.moving.empty() && rows_.size() > 1 ? rows_[rows_.size() - 2].moving : row.moving;
  kept.states.reserve(row.robots.size());
  for (const RobotStep& r : row.robots) {
    has_wheels_ = has_wheels_ || r.wheels;
    kept.states.push_back({r.position.x, r.position.y, r.velocity.x, r.velocity.y,
                           r.wheels ? std::atan2(r.wheels->heading.y, r.wheels->heading.x) : 0.0,
                           static_cast<std::uint8_t>(r.mode), static_cast<std::uint8_t>(r.status),
                           static_cast<std::int8_t>(r.side)});
  }
  last_row_is_extra_ = count_ % every_row_ != 0;
}

/// The final row of a run has no decisions, and is kept all the same until it is known to be the final one.
void RunPacker::keep_decisions(const Step& row) {
  if (count_ % every_decision_ != 0) return;
  decisions_.push_back(row);
  decision_numbers_ += numbers_in(row);
  while (decision_numbers_ > limits_.decision_numbers && decisions_.size() > 1) {
    keep_every_second(decisions_);
    every_decision_ *= 2;
    decision_numbers_ = 0;
    for (const Step& kept : decisions_) decision_numbers_ += numbers_in(kept);
  }
}

void RunPacker::add(const Step& row) {
  note_events(row);
  keep_row(row);
  keep_decisions(row);
  ++count_;
}

void RunPacker::add_positions(const Step& row) {
  keep_row(row);
  ++count_;
}

/// Adds the columns of the rows; returns the quanta that they are rounded to.
Json RunPacker::add_rows(std::size_t robots, PackedColumns& columns) const {
  double reach = 0.0, speed = 0.0;
  for (const Row& row : rows_)
    for (const State& s : row.states) {
      reach = larger(larger(reach, s.x), s.y);
      speed = larger(larger(speed, s.vx), s.vy);
    }
  const double metres = quantum_for(reach), per_second = quantum_for(speed);
  std::vector<double> time, leader, moving;
  std::vector<const State*> states;
  for (const Row& row : rows_) {
    time.push_back(row.time);
    append(leader, row.leader);
    for (const formation::MovedObstacle& o : row.moving) append(moving, o.displacement);
    for (const State& s : row.states) states.push_back(&s);
  }
  const auto in_quanta_of = [&](double quantum, double State::*member) {
    return each<std::int32_t>(states, [&](const State& s) { return in_quanta(s.*member, quantum); });
  };
  columns.add("time", time, 0);
  columns.add("x", in_quanta_of(metres, &State::x), robots);
  columns.add("y", in_quanta_of(metres, &State::y), robots);
  columns.add("vx", in_quanta_of(per_second, &State::vx), robots);
  columns.add("vy", in_quanta_of(per_second, &State::vy), robots);
  if (has_wheels_) columns.add("heading", in_quanta_of(kHeadingQuantum, &State::heading), robots);
  columns.add("mode", each<std::uint8_t>(states, &State::mode), robots);
  columns.add("status", each<std::uint8_t>(states, &State::status), robots);
  columns.add("side", each<std::uint8_t>(states, [](const State& s) { return s.side + 1; }), robots);
  columns.add("leader", leader, 2);
  columns.add("moving", moving, 0);
  return {{"position", metres}, {"velocity", per_second}, {"heading", kHeadingQuantum}};
}

/// The final row of a run has no decisions.
std::vector<Step> RunPacker::decided() const {
  std::vector<Step> rows = decisions_;
  if (rows.size() > 1 && rows.back().time == rows_.back().time) rows.pop_back();
  return rows;
}

std::string RunPacker::finish(const datasets::RecordingFile& about, const std::string& metrics_json,
                              const std::vector<Json>& bodies) const {
  PackedColumns columns;
  const Json quantum = add_rows(about.scenario.robots.size(), columns);
  const std::vector<Step> decisions = decided();
  add_decisions(decisions, about.scenario, columns);
  Json head = packed_head(about, limits_);
  for (std::size_t k = 0; k < bodies.size(); ++k) head["scene"]["robots"][k].update(bodies[k]);
  head["events"] = events_;
  head["events_left_out"] = events_left_out_;
  head["metrics"] = shown_metrics(metrics_json);
  head["rows"] = {{"count", rows_.size()}, {"of", count_}, {"every", every_row_}};
  head["decisions"] = {{"count", decisions.size()}, {"every", every_decision_}};
  head["quantum"] = quantum;
  head["modes"] = Json::array();
  for (int k = 0; k <= static_cast<int>(formation::Mode::arrived); ++k)
    head["modes"].push_back(formation::name(static_cast<formation::Mode>(k)));
  head["statuses"] = Json::array();
  for (int k = 0; k <= static_cast<int>(lp::Status::no_interior); ++k)
    head["statuses"].push_back(lp::name(static_cast<lp::Status>(k)));
  head["columns"] = columns.names();
  return whole(head, columns.bytes());
}

std::string packed_run(const datasets::RecordingFile& file, const std::string& metrics_json, PackedRunLimits limits) {
  RunPacker packer(limits);
  for (const Step& row : file.recording.steps) packer.add(row);
  return packer.finish(file, metrics_json);
}

Json shown_metrics(const std::string& text) {
  Json metrics = Json::parse(text, nullptr, false);
  if (!metrics.is_object()) return nullptr;
  metrics.erase("wall_time");
  metrics.erase("provenance");
  return metrics;
}

Json packed_head(const datasets::RecordingFile& about, const PackedRunLimits& limits) {
  Json head = {{"run", about_json(about)}, {"scene", scene_json(about.scenario)}};
  if (limits.has_scenario) head["scenario"] = scenario_json(about.scenario);
  head["bodies"] = Json::array();
  for (const vo::Body& body : about.recording.bodies) head["bodies"].push_back(to_json(body));
  head["goal_bodies"] = Json::array();
  for (const formation::GoalBodies& o : about.recording.goal_bodies)
    head["goal_bodies"].push_back({{"time", o.time}, {"robot", o.robot}, {"goal", o.goal}, {"bodies", o.bodies}});
  head["plans"] = plans_json(about.recording);
  head["routes"] = routes_json(about, limits);
  return head;
}

}  // namespace exactvo::tools
