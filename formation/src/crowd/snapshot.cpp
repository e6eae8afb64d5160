// SPDX-License-Identifier: GPL-3.0-or-later
// A crowd as bytes, little-endian: a mark, the options, and behind them, in a checksum, kinds and robots in their
// order.
#include <cmath>
#include <cstring>
#include <istream>
#include <optional>
#include <ostream>

#include "crowd/body.h"
#include "crowd/snapshot_bytes.h"
#include "exactvo/geometry/shape_numbers.h"

namespace exactvo::formation::crowd {
namespace {

constexpr char kMark[8] = {'E', 'V', 'O', 'C', 'R', 'O', 'W', '3'};

constexpr const char* kExpected = "what Crowd::snapshot has written";

void require(bool holds, const char* what) {
  if (!holds) refuse_snapshot(std::string(what) + " that no crowd has", kExpected);
}

void put(SnapshotWriter& to, const CrowdKind& k) {
  for (const double field : {k.radius, k.max_speed, k.time_horizon, k.neighbour_distance, k.edge_horizon})
    to.put(field);
  to.put(std::int32_t{k.neighbours});
}

CrowdKind get_kind(SnapshotReader& from) {
  CrowdKind k;
  for (double* field : {&k.radius, &k.max_speed, &k.time_horizon, &k.neighbour_distance, &k.edge_horizon})
    *field = from.get<double>();
  k.neighbours = from.get<std::int32_t>();
  return k;
}

std::vector<geometry::Segment> get_edges(SnapshotReader& from) {
  const auto count = from.get<std::uint32_t>();
  std::vector<double> numbers;
  from.get_some(numbers, 4 * std::size_t{count});
  std::vector<geometry::Segment> edges;
  for (std::size_t k = 0; k < numbers.size(); k += 4) {
    edges.push_back({{numbers[k], numbers[k + 1]}, {numbers[k + 2], numbers[k + 3]}});
    for (std::size_t j = k; j < k + 4; ++j) require(std::fabs(numbers[j]) < kFarthestEdge, "an edge");
  }
  return edges;
}

void put(SnapshotWriter& to, const Body& b) {
  to.put(std::uint32_t{b.id});
  to.put(std::uint8_t{b.moves});
  for (const std::int64_t v : {b.x, b.y}) to.put(v);
  for (const std::int32_t v : {b.mx, b.my}) to.put(v);
  to.put(static_cast<std::uint8_t>(b.shape.index()));
  const std::vector<double> numbers = geometry::numbers_of(b.shape);
  to.put(static_cast<std::uint32_t>(numbers.size()));
  to.put_all(numbers.data(), numbers.size());
}

void get_body(SnapshotReader& from, ObstacleId end, const CrowdOptions& options, Bodies& bodies) {
  const auto id = from.get<std::uint32_t>();
  require(id < end && (bodies.empty() || bodies.all().back().id < id), "a body");
  const auto moves = from.get<std::uint8_t>();
  const auto x = from.get<std::int64_t>(), y = from.get<std::int64_t>();
  const auto mx = from.get<std::int32_t>(), my = from.get<std::int32_t>();
  const auto kind = from.get<std::uint8_t>();
  std::vector<double> numbers;
  from.get_some(numbers, from.get<std::uint32_t>());
  const std::optional<geometry::ConvexShape> shape = geometry::shape_of(kind, numbers);
  require(shape.has_value() && moves <= 1, "a body");
  require_valid(*shape);
  const std::int64_t way = std::int64_t{1} << 22U;
  const bool goes = std::abs(std::int64_t{mx}) <= way && std::abs(std::int64_t{my}) <= way &&
                    static_cast<double>(std::max(std::abs(std::int64_t{mx}), std::abs(std::int64_t{my}))) *
                            options.position_step / options.time_step <=
                        2.0 * kFastest;
  require(x > -2 * kFarthestBody && x < 2 * kFarthestBody && y > -2 * kFarthestBody && y < 2 * kFarthestBody && goes,
          "the motion of a body");
  bodies.add(id, *shape, moves == 1);
  Body& body = *bodies.find(id);
  body.x = x, body.y = y, body.mx = mx, body.my = my;
}

bool on_lattice(std::int32_t v) {
  return v > -kLatticeEnd && v < kLatticeEnd;
}

struct Columns {
  std::vector<std::int32_t> x, y, mx, my, id, hint;
  std::vector<std::uint16_t> tag;
};

/// Ids name each robot once, the free ones are the rest.
void require_ids(const Columns& c, const std::vector<RobotId>& free_ids, RobotId id_end) {
  std::vector<bool> seen(id_end);
  const auto see = [&](std::int64_t id) {
    require(id >= 0 && id < id_end && !seen[static_cast<std::size_t>(id)], "an id");
    seen[static_cast<std::size_t>(id)] = true;
  };
  for (const std::int32_t id : c.id) see(id);
  for (const RobotId id : free_ids) see(id);
}

void require_robots(const Columns& c, const CrowdCore& core) {
  for (std::size_t i = 0; i < c.x.size(); ++i) {
    require(on_lattice(c.x[i]) && on_lattice(c.y[i]), "a position");
    const std::size_t kind = c.tag[i] & Robots::kKind;
    require(kind < core.kinds.size(), "a kind");
    const double speed = core.kinds[kind].max_speed * core.options.time_step / core.options.position_step;
    require(std::hypot(c.mx[i], c.my[i]) <= speed * (1.0 + 0x1p-40), "a motion");
    require(c.hint[i] >= 0 && c.hint[i] <= 1 << 30, "a distance");
  }
}

}  // namespace

void write_snapshot(const CrowdBody& body, std::ostream& to) {
  const CrowdCore& core = *body.core;
  const CrowdOptions& o = core.options;
  to.write(kMark, sizeof kMark);
  SnapshotWriter head(to);
  head.put(o.time_step);
  head.put(o.position_step);
  head.put(static_cast<std::int32_t>(o.precision));
  head.put(std::int32_t{o.certified});
  head.finish();
  SnapshotWriter out(to);
  out.put(static_cast<std::uint32_t>(core.kinds.size()));
  for (const CrowdKind& k : core.kinds) put(out, k);
  const Robots& r = core.robots;
  out.put(body.steps);
  out.put(r.strip());
  out.put(std::uint32_t{body.id_end});
  out.put(static_cast<std::uint32_t>(body.free_ids.size()));
  out.put_all(body.free_ids.data(), body.free_ids.size());
  out.put(static_cast<std::uint32_t>(r.size()));
  for (const auto* field : {&r.x, &r.y, &r.mx, &r.my, &r.id, &r.hint}) out.put_all(field->data(), r.size());
  out.put_all(r.tag.data(), r.size());
  const std::vector<Vec2> preferred = core.preferred();
  out.put(static_cast<std::uint32_t>(preferred.size()));
  for (const Vec2 v : preferred) out.put(v.x), out.put(v.y);
  out.put(std::uint32_t{body.next_obstacle});
  out.put(static_cast<std::uint32_t>(body.obstacles.size()));
  for (const auto& [id, edges] : body.obstacles) {
    out.put(std::uint32_t{id});
    out.put(static_cast<std::uint32_t>(edges.size()));
    for (const geometry::Segment& e : edges)
      for (const double v : {e.a.x, e.a.y, e.b.x, e.b.y}) out.put(v);
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
  o.time_step = in.get<double>();
  o.position_step = in.get<double>();
  const auto precision = in.get<std::int32_t>();
  o.certified = in.get<std::int32_t>() != 0;
  in.finish();
  require(precision == 0 || precision == 1, "a precision");
  o.precision = static_cast<CrowdPrecision>(precision);
  return o;
}

void read_snapshot(CrowdBody& body, std::istream& from) {
  CrowdCore& core = *body.core;
  SnapshotReader in(from, kExpected);
  const auto kinds = in.get<std::uint32_t>();
  require(kinds <= kMostKinds, "a number of kinds");
  for (std::uint32_t k = 0; k < kinds; ++k) {
    const CrowdKind kind = get_kind(in);
    require_valid(kind, core.options);
    core.kinds.push_back(kind);
  }
  body.steps = in.get<std::uint64_t>();
  const double strip = in.get<double>();
  require(std::isfinite(strip) && strip > 0.0, "a strip");
  const auto id_end = in.get<std::uint32_t>();
  require(id_end <= kMostRobots, "a number of ids");
  in.get_some(body.free_ids, in.get<std::uint32_t>());
  const auto count = in.get<std::uint32_t>();
  require(std::uint64_t{count} + body.free_ids.size() == id_end, "a number of robots");
  Columns c;
  for (auto* field : {&c.x, &c.y, &c.mx, &c.my, &c.id, &c.hint}) in.get_some(*field, count);
  in.get_some(c.tag, count);
  const auto preferences = in.get<std::uint32_t>();
  std::vector<double> numbers;
  in.get_some(numbers, 2 * std::size_t{preferences});
  std::map<ObstacleId, std::vector<geometry::Segment>> obstacles;
  const auto next_obstacle = in.get<std::uint32_t>();
  for (auto left = in.get<std::uint32_t>(); left > 0; --left) {
    const auto id = in.get<std::uint32_t>();
    require(id < next_obstacle && obstacles.count(id) == 0, "an obstacle");
    obstacles.emplace(id, get_edges(in));
  }
  for (auto left = in.get<std::uint32_t>(); left > 0; --left) get_body(in, next_obstacle, core.options, core.bodies);
  in.finish();
  require_ids(c, body.free_ids, id_end);
  require_robots(c, core);

  core.take_kinds();
  body.obstacles = std::move(obstacles);
  body.next_obstacle = next_obstacle;
  body.edges_changed = true;
  body.id_end = id_end;
  Robots& r = core.robots;
  r.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    r.append(c.x[i], c.y[i], c.id[i], 0);
    r.mx[i] = c.mx[i];
    r.my[i] = c.my[i];
    r.hint[i] = c.hint[i];
    r.tag[i] = c.tag[i];
  }
  r.set_strip(strip);
  if (preferences >= id_end && preferences > 0) {
    std::vector<Vec2> by_id(preferences);
    for (std::size_t k = 0; k < preferences; ++k) by_id[k] = {numbers[2 * k], numbers[2 * k + 1]};
    core.set_preferred(by_id);
  }
  body.unsorted = true;
  body.unchecked = false;
}

}  // namespace exactvo::formation::crowd
