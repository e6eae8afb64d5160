// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/one_robot.h"

#include <cmath>
#include <limits>

#include "crowd/packs.h"
#include "exactvo/vo/lp/batch.h"

namespace exactvo::formation {

using namespace crowd;

namespace {

/// Factor of a squared reach: more than squared distances in float are rounded by.
constexpr double kFarthest = 1.0 + 0x1p-16;

/// Everybody nearer than `reach` (lattice steps), and maybe some beyond, by the order of neighbours.
void everybody_near(const Robots& robots, std::size_t robot, double reach, std::vector<Near>& near) {
  const Window at{robots.x[robot], robots.x[robot], robots.y[robot], robots.y[robot]};
  const Cells cells = robots.cells_of(grown(at, reach));
  const auto farthest = static_cast<float>(reach * reach * kFarthest);
  near.clear();
  for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
    const Stretch stretch = robots.stretch(cells, row);
    for (std::size_t j = stretch.from; j < stretch.to; ++j) {
      if (j == robot) continue;
      const auto dx = static_cast<float>(robots.x[j] - robots.x[robot]),
                 dy = static_cast<float>(robots.y[j] - robots.y[robot]);
      const float squared = without_number(dx * dx + dy * dy);
      if (squared <= farthest) near.emplace_back(squared, static_cast<std::int32_t>(j));
    }
  }
  std::sort(near.begin(), near.end());
}

/// Into `near`, nearest first: the k nearest, k the number of neighbours of the robot's kind, and all that can be met
/// within the step, by the order that packs have (packs.h). `last`: the squared distance (lattice steps) of the k-th.
/// True where k or more can be met.
bool neighbours_of(const Robots& robots, const ReachTable& table, std::size_t robot, std::vector<Near>& near,
                   float& last) {
  const std::size_t kind = robots.kind(robot);
  const auto most = static_cast<std::size_t>(table.neighbours[kind]);
  double reach = std::min(table.window[kind], kFirstReach * robots.hint[robot] + table.nearby);
  reach = std::max(reach, std::sqrt(static_cast<double>(table.reach[kind])) * (1.0 + 0x1p-10));
  for (;; reach = std::min(table.window[kind], reach * kWiderReach)) {
    everybody_near(robots, robot, reach, near);
    const bool full = near.size() >= most && static_cast<double>(near[most - 1].first) <= reach * reach * kWholeKey;
    if (full || reach >= table.window[kind]) break;
  }
  last = near.size() >= most ? near[most - 1].first : table.none[kind];
  std::size_t count = 0;
  while (count < near.size() && near[count].first < table.none[kind] &&
         (count < most || near[count].first < table.reach[kind]))
    ++count;
  near.resize(count);
  return count > most || (count == most && last < table.reach[kind]);
}

/// Lattice steps, from the squared distance of the last neighbour: what the next step's search begins with.
std::int32_t hint_of(const ReachTable& table, float key, std::size_t kind) {
  const double most = table.window[kind];
  if (!(key < table.none[kind])) return static_cast<std::int32_t>(std::min(most, 0x1p30));
  const double distance = static_cast<double>(std::sqrt(float_of(bits_of(key) & ~kIndexBits)));
  return static_cast<std::int32_t>(std::min({distance, most, 0x1p30}));
}

// Motions near the answer of the linear program that keep half-planes which the nearest one, by rounding, does not.

/// Lattice steps: farther from the optimum no motion is tried.
constexpr int kNudge = 3;

/// Whether a motion of (mx, my) lattice steps keeps all lines of lane 0. In double, where a line is off by at most
/// 2^-48 max_speed (m/s).
template <class T>
bool keeps(const KindTable<T>& table, const Answers<T>& in, double mx, double my, double max_speed) {
  const double unit = table.velocity_step, allowed = table.spare - 0x1p-46 * max_speed;
  for (std::size_t k = 0; k < in.lines; ++k) {
    const std::size_t at = k * in.stride;
    const double met = unit * mx * static_cast<double>(in.x[at]) + unit * my * static_cast<double>(in.y[at]);
    if (static_cast<double>(in.c[at]) - met > allowed) return false;
  }
  return true;
}

/// Makes of (mx, my) the motion nearest to the answer, among those about it, that keeps all lines and is not faster
/// than max_speed (m/s); false, and no change, where there is none.
template <class T>
bool nudge(const KindTable<T>& table, const Answers<T>& in, double max_speed, std::int32_t& mx, std::int32_t& my) {
  const double unit = table.velocity_step;
  const double limit = max_speed * max_speed * (1.0 - 0x1p-46);
  const double x0 = static_cast<double>(in.vx[0]) / unit, y0 = static_cast<double>(in.vy[0]) / unit;
  double least = std::numeric_limits<double>::infinity();
  const std::int32_t from_x = mx, from_y = my;
  for (int j = -kNudge; j <= kNudge; ++j)
    for (int i = -kNudge; i <= kNudge; ++i) {
      const double x = from_x + i, y = from_y + j, away = (x - x0) * (x - x0) + (y - y0) * (y - y0);
      if (!(away < least) || (x * x + y * y) * unit * unit > limit || !keeps(table, in, x, y, max_speed)) continue;
      least = away;
      mx = from_x + i;
      my = from_y + j;
    }
  return least < std::numeric_limits<double>::infinity();
}

}  // namespace

template <class T>
CrowdDecision OneRobot<T>::decide(std::size_t robot, Vec2 preferred, Buffers& b, CrowdExplanation* words) const {
  CrowdDecision d{};
  StepReport& counts = d.counts;
  float last = 0;
  counts.widened = neighbours_of(crowd_.robots, table_, robot, b.near, last);
  d.hint = hint_of(table_, last, crowd_.robots.kind(robot));
  counts.edges = lines_of_edges(robot, b);
  b.body_lines.clear();
  b.capsule_lines.clear();
  b.still = 0;
  if (has_bodies()) lines_of_bodies(robot, b);
  counts.bodies = b.body_lines.size() - b.capsule_lines.size();
  counts.neighbours = b.near.size();
  const std::size_t most = counts.edges + b.body_lines.size() + counts.neighbours + kMostWheelRows;
  lay_out_rows(most, b);
  const std::size_t wheels = put_wheels(robot, counts.edges + b.still, b, words);
  const std::size_t hard = counts.edges + b.still + wheels, lines = most - kMostWheelRows + wheels;
  put_obstacles(robot, counts.edges, wheels + b.near.size(), b, words);
  bool touches = false;
  for (std::size_t k = 0; k < b.near.size(); k += kPack) touches |= put_neighbours(robot, k, hard + k, b, words);
  counts.touching = touches;
  if (is_reserved(robot)) {
    const Answers<T> rows{nullptr, nullptr, b.row_x.data(), b.row_y.data(), b.row_c.data(),
                          lines,   kPack,   nullptr,        nullptr};
    d.motion = straight(robot, preferred, rows, hard);
  } else {
    d.motion = solve(robot, preferred, lines, static_cast<std::int32_t>(hard), b);
  }
  return d;
}

template <class T>
void OneRobot<T>::lay_out_rows(std::size_t rows, Buffers& b) const {
  const std::size_t room = std::max<std::size_t>(1, rows) * kPack;
  b.row_x.assign(room, T(1));
  b.row_y.assign(room, T(0));
  b.row_c.assign(room, static_cast<T>(kNever));
}

template <class T>
std::size_t OneRobot<T>::put_obstacles(std::size_t robot, Buffers& b) const {
  const std::size_t edges = lines_of_edges(robot, b);
  b.near.clear();
  lines_of_bodies(robot, b);
  lay_out_rows(edges + b.body_lines.size(), b);
  put_obstacles(robot, edges, 0, b, nullptr);
  return edges + b.still;
}

template <class T>
bool OneRobot<T>::keeps_obstacles(std::size_t robot, std::size_t lines, const Buffers& b, double mx, double my) const {
  Answers<T> rows{nullptr, nullptr, b.row_x.data(), b.row_y.data(), b.row_c.data(), lines, kPack, nullptr, nullptr};
  return keeps(table_, rows, mx, my, kind_of(robot).max_speed);
}

template <class T>
CrowdMotion OneRobot<T>::straight(std::size_t robot, Vec2 preferred, Answers<T> in, std::size_t hard) const {
  constexpr double kShares[] = {1.0, 0.5, 0.25, 0.125, 0.0625};
  const double unit = table_.velocity_step, length = norm(preferred), speed = kind_of(robot).max_speed;
  const auto most = static_cast<double>(table_.disc[crowd_.robots.kind(robot)]);
  const double whole = length > most ? most / length : 1.0;
  CrowdMotion m{};
  m.reserved = true;
  in.lines = hard;
  for (const double share : kShares) {
    const double x = std::nearbyint(whole * share * preferred.x / unit),
                 y = std::nearbyint(whole * share * preferred.y / unit);
    const Motion tried{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
    if (!keeps(table_, in, x, y, speed) || !can_drive(robot, tried)) continue;
    m.mx = tried.x;
    m.my = tried.y;
    return m;
  }
  m.stopped = true;
  return m;
}

template <class T>
BodyQuery OneRobot<T>::query_of(std::size_t robot) const {
  const CrowdKind& kind = kind_of(robot);
  const Robots& robots = crowd_.robots;
  BodyQuery query;
  query.x = robots.x[robot];
  query.y = robots.y[robot];
  query.position = crowd_.position_of(robot);
  query.velocity = crowd_.velocity_of(robots.mx[robot], robots.my[robot]);
  query.radius = kind.radius;
  query.still_horizon = obstacle_horizon(robot);
  query.horizon = kind.time_horizon;
  query.max_speed = kind.max_speed;
  query.float_normals = sizeof(T) == 4;
  return query;
}

/// Into b.edge_x and so on; how many.
template <class T>
std::size_t OneRobot<T>::lines_of_edges(std::size_t robot, Buffers& b) const {
  if (crowd_.edges.empty()) return 0;
  std::fill(b.edge_query.count, b.edge_query.count + kPack, 0);
  ask_edges(robot, 0, b.edge_query);
  std::int32_t lines[kPack];
  for (std::size_t room = std::max(kMostEdges, b.edge.size() / kPack);; room *= 2) {
    for (auto* row : {&b.edge_x, &b.edge_y, &b.edge_c}) row->resize(room * kPack);
    b.edge.resize(room * kPack);
    b.edge_touching.resize(room * kPack);
    EdgePackLines<T> out{b.edge_x.data(), b.edge_y.data(), b.edge_c.data(), kPack, lines, room};
    out.edge = b.edge.data();
    out.touching = b.edge_touching.data();
    if (make_edge_lines(b.edge_query, b.edge_table, out) == 0) return static_cast<std::size_t>(lines[0]);
  }
}

template <class T>
void OneRobot<T>::lines_of_bodies(std::size_t robot, Buffers& b) const {
  b.still = crowd_.bodies.lines(query_of(robot), b.near_bodies, b.body_lines);
  b.capsule_lines.clear();
  if (crowd_.reserved_ways.empty() || is_reserved(robot)) return;
  const CrowdKind& kind = kind_of(robot);
  crowd_.reserved_ways.add_lines(crowd_.position_of(robot), kind.radius, kind.max_speed, crowd_.options.time_step,
                                 b.capsule_lines);
  b.body_lines.insert(b.body_lines.begin() + static_cast<std::ptrdiff_t>(b.still), b.capsule_lines.begin(),
                      b.capsule_lines.end());
  b.still += b.capsule_lines.size();
}

/// The half-plane of a row, without what covers the rounding to the lattice.
template <class T>
geometry::HalfPlane OneRobot<T>::half_plane(std::size_t row, const Buffers& b) const {
  const std::size_t at = row * kPack;
  return {{static_cast<double>(b.row_x[at]), static_cast<double>(b.row_y[at])},
          static_cast<double>(b.row_c[at]) - table_.spare};
}

/// Into the rows from `row` on; how many.
template <class T>
std::size_t OneRobot<T>::put_wheels(std::size_t robot, std::size_t row, Buffers& b, CrowdExplanation* words) const {
  geometry::HalfPlane lines[kMostWheelRows];
  const std::size_t count = crowd_.wheels.rows(crowd_.robots.kind(robot), crowd_.robots.id[robot], lines);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = (row + k) * kPack;
    put(lines[k], robot, b.row_x[at], b.row_y[at], b.row_c[at]);
    if (words) words->wheels.push_back(half_plane(row + k, b));
  }
  return count;
}

/// Those of bodies that move `between` rows after those at rest.
template <class T>
void OneRobot<T>::put_obstacles(std::size_t robot, std::size_t edges, std::size_t between, Buffers& b,
                                CrowdExplanation* words) const {
  for (std::size_t k = 0; k < edges; ++k) {
    const std::size_t at = k * kPack;
    b.row_x[at] = b.edge_x[at];
    b.row_y[at] = b.edge_y[at];
    b.row_c[at] = b.edge_c[at];
    if (words) words->edges.push_back({crowd_.edges.edges()[b.edge[at]], half_plane(k, b), b.edge_touching[at] != 0});
  }
  for (std::size_t k = 0; k < b.body_lines.size(); ++k) {
    const BodyLine& line = b.body_lines[k];
    const std::size_t row = edges + k + (k < b.still ? 0 : between), at = row * kPack;
    put(line, robot, b.row_x[at], b.row_y[at], b.row_c[at]);
    if (words && line.obstacle != ReservedWays::kCapsule)
      words->bodies.push_back({crowd_.bodies.all()[line.obstacle].id, half_plane(row, b), line.touching});
  }
}

/// The lines of neighbours `first` to `first` + 15, one per lane, into the rows from `row` on; whether one of them
/// touches.
template <class T>
bool OneRobot<T>::put_neighbours(std::size_t robot, std::size_t first, std::size_t row, Buffers& b,
                                 CrowdExplanation* words) const {
  const Robots& robots = crowd_.robots;
  const std::size_t count = std::min(kPack, b.near.size() - first);
  Candidates others;
  others.count = kPack;
  std::int32_t own[5][kPack];
  alignas(64) float none[kPack];
  Ranked ranked;
  for (std::size_t lane = 0; lane < kPack; ++lane) {
    const auto j = static_cast<std::size_t>(b.near[first + std::min(lane, count - 1)].second);
    others.x[lane] = robots.x[j];
    others.y[lane] = robots.y[j];
    others.mx[lane] = robots.mx[j];
    others.my[lane] = robots.my[j];
    others.kind[lane] = static_cast<std::int32_t>(robots.kind(j));
    own[0][lane] = robots.x[robot];
    own[1][lane] = robots.y[robot];
    own[2][lane] = robots.mx[robot];
    own[3][lane] = robots.my[robot];
    own[4][lane] = static_cast<std::int32_t>(robots.kind(robot));
    none[lane] = std::numeric_limits<float>::infinity();
    ranked.key[0][lane] = float_of(static_cast<std::int32_t>(lane));
  }
  const LineQuery query{&others, &ranked, none, 0, 1, own[0], own[1], own[2], own[3], own[4]};
  alignas(64) T x[kPack], y[kPack], c[kPack];
  const LineFlags flags = make_lines(table_, query, LineRows<T>{x, y, c, kPack});
  for (std::size_t lane = 0; lane < count; ++lane) {
    const auto other = static_cast<std::size_t>(b.near[first + lane].second);
    if (flags.coincident >> lane & 1U) part(robot, other, x[lane], y[lane], c[lane]);
    const std::size_t to = (row + lane) * kPack;
    b.row_x[to] = x[lane];
    b.row_y[to] = y[lane];
    b.row_c[to] = c[lane];
    if (words)
      words->neighbours.push_back(
          {static_cast<RobotId>(robots.id[other]), half_plane(row + lane, b), (flags.touching >> lane & 1U) != 0});
  }
  return (flags.touching & ((1U << count) - 1U)) != 0;
}

/// Two robots in one place, as fast as each other: the lower id leaves to the left (-x), the other to the right.
template <class T>
void OneRobot<T>::part(std::size_t robot, std::size_t other, T& x, T& y, T& c) const {
  const Robots& robots = crowd_.robots;
  x = robots.id[robot] < robots.id[other] ? T(-1) : T(1);
  y = T(0);
  const double radius = static_cast<double>(table_.radius[robots.kind(robot)]) + table_.radius[robots.kind(other)];
  const double own = static_cast<double>(x) * robots.mx[robot] * table_.velocity_step;
  const double half = radius / (2.0 * crowd_.options.time_step) * (1.0 + 0x1p-50);
  c = rounded_up<T>(own + half + static_cast<double>(table_.lattice_slack));
}

/// From the rows to a motion.
template <class T>
CrowdMotion OneRobot<T>::solve(std::size_t robot, Vec2 preferred, std::size_t lines, std::int32_t hard,
                               const Buffers& b) const {
  alignas(64) T vx[kPack] = {}, vy[kPack] = {}, violation[kPack] = {}, px[kPack], py[kPack], disc[kPack];
  std::uint8_t status[kPack] = {};
  std::fill(px, px + kPack, static_cast<T>(preferred.x));
  std::fill(py, py + kPack, static_cast<T>(preferred.y));
  std::fill(disc, disc + kPack, table_.disc[crowd_.robots.kind(robot)]);
  const std::int32_t hard_of_lane[kPack] = {hard};
  lp::BatchProblems<T> in;
  in.count = 1;
  in.lines = lines;
  in.block = kPack;
  in.hard = hard > 0 ? hard_of_lane : nullptr;
  in.normal_x = b.row_x.data();
  in.normal_y = b.row_y.data();
  in.offset = b.row_c.data();
  in.preferred_x = px;
  in.preferred_y = py;
  in.disc = disc;
  lp::BatchAnswers<T> out;
  out.velocity_x = vx;
  out.velocity_y = vy;
  out.violation = violation;
  out.status = status;
  out.stride = kPack;
  lp::solve_batch(in, out, 0, 1);
  alignas(64) T allowed[kPack];
  std::fill(allowed, allowed + kPack, table_.allowed[crowd_.robots.kind(robot)]);
  const Answers<T> answer{vx, vy, b.row_x.data(), b.row_y.data(), b.row_c.data(), lines, kPack, status, allowed};
  Rounded rounded;
  const bool kept = (round_to_lattice(table_, answer, rounded) & 1U) != 0;
  const CrowdMotion m{rounded.mx[0], rounded.my[0], kept};
  return kept && can_drive(robot, {m.mx, m.my}) ? m : settled(robot, answer, status[0], hard, m);
}

template <class T>
CrowdMotion OneRobot<T>::settled(std::size_t robot, const Answers<T>& in, std::uint8_t status, std::int32_t hard,
                                 CrowdMotion m) const {
  const auto first = static_cast<std::size_t>(hard);
  if (!crowd_.options.certified) return driven(robot, in, first, m);
  if (status == 0) m.kept = m.nudged = nudge(table_, in, kind_of(robot).max_speed, m.mx, m.my);
  return driven(robot, in, first, m.kept ? m : kept_off_edges(robot, in, first, m));
}

/// What wheels allow of a motion: the longest of some parts of it that keep the first `hard` lines, or none.
template <class T>
CrowdMotion OneRobot<T>::driven(std::size_t robot, Answers<T> in, std::size_t hard, CrowdMotion m) const {
  if (can_drive(robot, {m.mx, m.my})) return m;
  constexpr double kShares[] = {0.98, 0.9, 0.75, 0.5, 0.25, 0.1, 0.0};
  const double speed = kind_of(robot).max_speed;
  Answers<T> first = in;
  first.lines = hard;
  for (const double share : kShares) {
    const Motion part{static_cast<std::int32_t>(share * m.mx), static_cast<std::int32_t>(share * m.my)};
    if (part != Motion{} && !(can_drive(robot, part) && keeps(table_, first, part.x, part.y, speed))) continue;
    return {part.x, part.y, keeps(table_, in, part.x, part.y, speed)};
  }
  return {0, 0, false};
}

/// No velocity may lead onto an edge or a body at rest, also where half-planes against robots had to give: another
/// place of the lattice nearby, or none. REQUIRES: the first `hard` lines are theirs.
template <class T>
CrowdMotion OneRobot<T>::kept_off_edges(std::size_t robot, Answers<T> in, std::size_t hard, CrowdMotion m) const {
  if (hard == 0 || !crowd_.options.certified) return m;
  in.lines = hard;
  const double speed = kind_of(robot).max_speed;
  if (keeps(table_, in, m.mx, m.my, speed) || nudge(table_, in, speed, m.mx, m.my)) return m;
  m.mx = m.my = 0;
  m.stopped = true;
  return m;
}

template class OneRobot<float>;
template class OneRobot<double>;

}  // namespace exactvo::formation
