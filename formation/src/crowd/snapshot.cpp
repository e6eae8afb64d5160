// SPDX-License-Identifier: GPL-3.0-or-later
// A crowd as bytes, little-endian: a mark, the options, and behind them, in a checksum, kinds and robots in their
// order.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <istream>
#include <optional>
#include <ostream>

#include "crowd/body.h"
#include "exactvo/geometry/shape_numbers.h"
#include "snapshot_bytes.h"

namespace exactvo::formation::crowd {

template <>
inline constexpr std::size_t doubles_of<WheelState> = 7;

namespace {

constexpr char kMark[8] = {'E', 'V', 'O', 'C', 'R', 'O', 'W', '5'};

constexpr const char* kExpected = "what Crowd::snapshot has written";

void require(bool holds, const char* what) {
  if (!holds) refuse_snapshot(std::string(what) + " that no crowd has", kExpected);
}

/// As get_counted reads it.
template <class List>
void put_counted(SnapshotWriter& to, const List& list) {
  to.put(static_cast<std::uint32_t>(list.size()));
  to.put_all(list.data(), list.size());
}
template <class List>
void get_counted(SnapshotReader& from, List& list) {
  from.get_some(list, from.get<std::uint32_t>());
}

/// Writes or reads the fields: `Bytes` is a SnapshotWriter or a SnapshotReader.
template <class Bytes, class Kind>
void fields_of_kind(Bytes& bytes, Kind& k) {
  bytes.fields(k.radius, k.max_speed, k.time_horizon, k.neighbour_distance, k.edge_horizon, k.neighbours);
  CrowdWheels wheels = k.wheels.value_or(CrowdWheels{});
  std::uint8_t has_wheels = k.wheels.has_value();
  bytes.fields(has_wheels, wheels.reference, wheels.wheel_separation, wheels.max_wheel_acceleration,
               wheels.max_angular_speed, wheels.max_backward_speed);
  if constexpr (!std::is_const_v<Kind>) {
    require(has_wheels <= 1, "a kind");
    if (has_wheels) k.wheels = wheels;
  }
}

/// The numbers of a robot, field by field.
template <class Columns>
auto columns_of(Columns& r) {
  return std::array{&r.x, &r.y, &r.mx, &r.my, &r.id, &r.hint};
}

std::vector<geometry::Segment> get_edges(SnapshotReader& from) {
  std::vector<geometry::Segment> edges;
  get_counted(from, edges);
  for (const geometry::Segment& e : edges)
    for (const double v : {e.a.x, e.a.y, e.b.x, e.b.y}) require(std::fabs(v) < kFarthestEdge, "an edge");
  return edges;
}

void put(SnapshotWriter& to, const Body& b) {
  to.fields(b.id, b.moves, b.x, b.y, b.mx, b.my, static_cast<std::uint8_t>(b.shape.index()));
  put_counted(to, geometry::numbers_of(b.shape));
}

void get_body(SnapshotReader& from, ObstacleId end, const CrowdOptions& options, Bodies& bodies) {
  Body b;
  std::uint8_t moves = 0, kind = 0;
  std::vector<double> numbers;
  from.fields(b.id, moves, b.x, b.y, b.mx, b.my, kind);
  get_counted(from, numbers);
  require(b.id < end && (bodies.empty() || bodies.all().back().id < b.id), "a body");
  const std::optional<geometry::ConvexShape> shape = geometry::shape_of(kind, numbers);
  require(shape.has_value() && moves <= 1, "a body");
  require_valid(*shape);
  const double way = std::max(std::fabs(b.mx), std::fabs(b.my));
  const bool goes = way <= kLongestMotion && way * options.position_step / options.time_step <= 2.0 * kFastest;
  require(b.x > -2 * kFarthestBody && b.x < 2 * kFarthestBody && b.y > -2 * kFarthestBody && b.y < 2 * kFarthestBody &&
              goes,
          "the motion of a body");
  Body& added = bodies.add(b.id, *shape, moves == 1);
  added.x = b.x, added.y = b.y, added.mx = b.mx, added.my = b.my;
}

bool on_lattice(std::int32_t v) {
  return v > -kLatticeEnd && v < kLatticeEnd;
}

/// Ids name each robot once, the free ones are the rest.
void require_ids(const Robots& r, const std::vector<RobotId>& free_ids, RobotId id_end) {
  std::vector<bool> seen(id_end);
  const auto see = [&](std::int64_t id) {
    require(id >= 0 && id < id_end && !seen[static_cast<std::size_t>(id)], "an id");
    seen[static_cast<std::size_t>(id)] = true;
  };
  for (std::size_t i = 0; i < r.size(); ++i) see(r.id[i]);
  for (const RobotId id : free_ids) see(id);
}

void require_robots(const CrowdCore& core) {
  const Robots& r = core.robots;
  for (std::size_t i = 0; i < r.size(); ++i) {
    require(on_lattice(r.x[i]) && on_lattice(r.y[i]), "a position");
    const std::size_t kind = r.tag[i] & Robots::kKind;
    require(kind < core.kinds.size(), "a kind");
    const double speed = core.kinds[kind].max_speed * core.options.time_step / core.options.position_step;
    require(std::hypot(r.mx[i], r.my[i]) <= speed * (1.0 + 0x1p-40), "a motion");
    require(r.hint[i] >= 0 && r.hint[i] <= 1 << 30, "a distance");
    require(!core.kinds[kind].wheels || static_cast<std::size_t>(r.id[i]) < core.wheels.states().size(), "wheels");
  }
}

}  // namespace

void write_snapshot(const CrowdBody& body, std::ostream& to) {
  const CrowdCore& core = *body.core;
  const CrowdOptions& o = core.options;
  to.write(kMark, sizeof kMark);
  SnapshotWriter head(to);
  head.fields(o.time_step, o.position_step, static_cast<std::int32_t>(o.precision), std::int32_t{o.certified});
  head.finish();
  SnapshotWriter out(to);
  out.put(static_cast<std::uint32_t>(core.kinds.size()));
  for (const CrowdKind& k : core.kinds) fields_of_kind(out, k);
  const Robots& r = core.robots;
  out.fields(body.steps, r.strip(), body.id_end);
  put_counted(out, body.free_ids);
  out.put(static_cast<std::uint32_t>(r.size()));
  for (const auto* column : columns_of(r)) out.put_all(column->data(), r.size());
  out.put_all(r.tag.data(), r.size());
  put_counted(out, core.preferred());
  put_counted(out, core.reserved_ways.places());
  put_counted(out, core.reserved_ways.reserved());
  put_counted(out, core.wheels.states());
  out.fields(body.next_obstacle, static_cast<std::uint32_t>(body.obstacles.size()));
  for (const auto& [id, edges] : body.obstacles) {
    out.put(id);
    put_counted(out, edges);
  }
  out.put(static_cast<std::uint32_t>(core.bodies.all().size()));
  for (const Body& b : core.bodies.all()) put(out, b);
  out.finish();
}

CrowdOptions read_options(std::istream& from) {
  char mark[sizeof kMark] = {};
  from.read(mark, sizeof mark);
  if (!from || std::memcmp(mark, kMark, sizeof mark) != 0) refuse_snapshot("another beginning", kExpected);
  SnapshotReader in(from, kExpected);
  CrowdOptions o;
  std::int32_t precision = 0, certified = 0;
  in.fields(o.time_step, o.position_step, precision, certified);
  in.finish();
  require(precision == 0 || precision == 1, "a precision");
  o.precision = static_cast<CrowdPrecision>(precision);
  o.certified = certified != 0;
  return o;
}

void read_snapshot(CrowdBody& body, std::istream& from) {
  CrowdCore& core = *body.core;
  SnapshotReader in(from, kExpected);
  const auto kinds = in.get<std::uint32_t>();
  require(kinds <= kMostKinds, "a number of kinds");
  for (std::uint32_t k = 0; k < kinds; ++k) {
    fields_of_kind(in, core.kinds.emplace_back());
    require_valid(core.kinds.back(), core.options);
  }
  body.steps = in.get<std::uint64_t>();
  const double strip = in.get<double>();
  require(std::isfinite(strip) && strip > 0.0, "a strip");
  const auto id_end = in.get<std::uint32_t>();
  require(id_end <= kMostRobots, "a number of ids");
  get_counted(in, body.free_ids);
  const auto count = in.get<std::uint32_t>();
  require(std::uint64_t{count} + body.free_ids.size() == id_end, "a number of robots");
  Robots& r = core.robots;
  for (auto* column : columns_of(r)) in.get_some(*column, count);
  in.get_some(r.tag, count);
  r.resize(count);
  r.shrink();
  std::vector<Vec2> preferred, places;
  std::vector<std::uint8_t> reserved;
  get_counted(in, preferred);
  get_counted(in, places);
  get_counted(in, reserved);
  std::vector<WheelState> wheels;
  get_counted(in, wheels);
  require(core.wheels.set_states(std::move(wheels)), "wheels");
  require(places.size() == reserved.size(), "a number of reservations");
  for (std::size_t k = 0; k < places.size(); ++k)
    require(reserved[k] == 0 || geometry::is_finite(places[k]), "a place");
  std::map<ObstacleId, std::vector<geometry::Segment>> obstacles;
  const auto next_obstacle = in.get<std::uint32_t>();
  for (auto left = in.get<std::uint32_t>(); left > 0; --left) {
    const auto id = in.get<std::uint32_t>();
    require(id < next_obstacle && obstacles.count(id) == 0, "an obstacle");
    obstacles.emplace(id, get_edges(in));
  }
  for (auto left = in.get<std::uint32_t>(); left > 0; --left) get_body(in, next_obstacle, core.options, core.bodies);
  in.finish();
  require_ids(r, body.free_ids, id_end);
  require_robots(core);

  core.take_kinds();
  body.obstacles = std::move(obstacles);
  body.next_obstacle = next_obstacle;
  body.edges_changed = true;
  body.id_end = id_end;
  r.set_strip(strip);
  if (!preferred.empty()) {
    preferred.resize(std::max<std::size_t>(preferred.size(), id_end));
    core.set_preferred(preferred);
  }
  core.reserved_ways.set(places, reserved);
  body.unsorted = true;
  body.unchecked = false;
}

}  // namespace exactvo::formation::crowd
