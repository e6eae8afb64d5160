// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/hard_level.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "exactvo/vo/lp/single.h"

namespace exactvo::formation {

using namespace crowd;

namespace {

/// Lattice steps by which a motion may be longer than the wish: what rounding to the lattice adds, and some.
constexpr std::int64_t kRoundingRoom = 4;

/// Lattice steps by which two robots in contact may overlap, as places and radii were rounded: they keep their
/// distance. Two that overlap by more have come from elsewhere, and the first level leads them apart.
constexpr std::int64_t kRoundedContact = 8;

/// Half a lattice step in both coordinates, sqrt(1/2), rounded up: half-planes are moved inward by it before the linear
/// program, so that its answer can be rounded.
constexpr double kHalfDiagonal = 0.7072;

/// Motions that are tried after the rounded answer: each goes back over the row that the last one violates.
constexpr int kCorrections = 6;

/// Shares of the way back to the safe motion.
constexpr double kShares[] = {0x1p-12, 0x1p-8, 0x1p-4, 0.25, 0.5, 0.75};

/// At least |m|, by at most an eighth too much; no root.
std::int64_t length_bound(Motion m) {
  const std::int64_t x = std::abs(m.x), y = std::abs(m.y);
  return std::max(x, y) + std::min(x, y) / 2 + 1;
}

/// How far a robot with this wish can get in the step, lattice steps.
std::int64_t longest_way(Motion wish) {
  return length_bound(wish) + kRoundingRoom;
}

double squared_length(Motion m) {
  const double x = m.x, y = m.y;
  return x * x + y * y;
}

Motion whole(double x, double y) {
  return {static_cast<std::int32_t>(std::nearbyint(x)), static_cast<std::int32_t>(std::nearbyint(y))};
}

Motion between(Motion from, Motion to, double share) {
  return whole(from.x + share * (to.x - from.x), from.y + share * (to.y - from.y));
}

/// The first row that does not allow the motion, or null.
const MotionRow* violated(const std::vector<MotionRow>& rows, Motion m) {
  for (const MotionRow& row : rows)
    if (!row.allows(m)) return &row;
  return nullptr;
}

}  // namespace

template <class T>
void HardLevel<T>::take_kinds() {
  const double q = crowd_.options.position_step, dt = crowd_.options.time_step;
  kinds_.clear();
  for (std::size_t k = 0; k < crowd_.kinds.size(); ++k) {
    const CrowdKind& kind = crowd_.kinds[k];
    StepsOfKind steps;
    steps.radius = static_cast<std::int64_t>(std::ceil(kind.radius / q));  // q is a power of two: exact
    steps.reach = std::sqrt(static_cast<double>(table_.reach[k])) * (1.0 + 0x1p-10);
    const double speed = kind.max_speed * dt / q;
    steps.squared_speed = speed * speed * (1.0 - 0x1p-46);
    kinds_.push_back(steps);
  }
}

template <class T>
Motion HardLevel<T>::wish_of(std::size_t robot) const {
  return {crowd_.robots.wish_mx[robot], crowd_.robots.wish_my[robot]};
}

template <class T>
Motion HardLevel<T>::safe_of(std::size_t robot, int round) const {
  if (round == 0) return {};
  return {crowd_.robots.safe_mx[robot], crowd_.robots.safe_my[robot]};
}

template <class T>
Motion HardLevel<T>::decide(std::size_t robot, int round, HardBuffers& b, OneRobotBuffers<T>& one,
                            StepReport& counts) const {
  const Motion wish = wish_of(robot), safe = safe_of(robot, round);
  if (round > 0 && safe == wish) return safe;
  if (!put_rows(robot, round, b, counts)) return safe;
  if (violated(b.rows, wish) == nullptr) return wish;
  if (crowd_.reserved_ways.holds(crowd_.robots.id[robot])) return shortened(robot, safe, b, one);
  return nearest(robot, safe, b, one);
}

/// The rows of a robot; false where it has to keep its safe motion.
template <class T>
bool HardLevel<T>::put_rows(std::size_t robot, int round, HardBuffers& b, StepReport& counts) const {
  const Robots& robots = crowd_.robots;
  const StepsOfKind& kind = kinds_[robots.kind(robot)];
  const std::int64_t own = kind.radius + longest_way(wish_of(robot));
  const Window at{robots.x[robot], robots.x[robot], robots.y[robot], robots.y[robot]};
  const Cells cells = robots.cells_of(grown(at, kind.reach));
  b.rows.clear();
  bool found = true, overlaps = false;
  for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
    const Stretch stretch = robots.stretch(cells, row);
    for (std::size_t j = stretch.from; j < stretch.to; ++j) {
      const std::int64_t dx = std::int64_t{robots.x[robot]} - robots.x[j],
                         dy = std::int64_t{robots.y[robot]} - robots.y[j];
      const std::int64_t radius = kinds_[robots.kind(j)].radius, together = own + radius + longest_way(wish_of(j));
      const std::int64_t squared = dx * dx + dy * dy;
      if (j == robot || squared >= together * together) continue;
      const std::int64_t apart = std::max<std::int64_t>(1, kind.radius + radius - kRoundedContact);
      if (squared >= apart * apart)
        put_row(robot, j, round, b, found);
      else
        overlaps = true;
    }
  }
  if (round == 0) counts.overlapping += overlaps;
  return found;
}

template <class T>
void HardLevel<T>::put_row(std::size_t robot, std::size_t other, int round, HardBuffers& b, bool& found) const {
  const Robots& robots = crowd_.robots;
  const bool first = robots.id[robot] < robots.id[other];
  const std::size_t i = first ? robot : other, j = first ? other : robot;
  PairInStep pair;
  pair.dx = std::int64_t{robots.x[i]} - robots.x[j];
  pair.dy = std::int64_t{robots.y[i]} - robots.y[j];
  pair.radius = kinds_[robots.kind(i)].radius + kinds_[robots.kind(j)].radius;
  pair.wish_a = wish_of(i);
  pair.wish_b = wish_of(j);
  pair.safe_a = safe_of(i, round);
  pair.safe_b = safe_of(j, round);
  const PairRows rows = pair_rows(pair);
  found = found && rows.found;
  b.rows.push_back(first ? rows.a : rows.b);
}

/// Towards the reserved place, as far as the rows let it: such a robot is slowed down but never turned.
template <class T>
Motion HardLevel<T>::shortened(std::size_t robot, Motion safe, const HardBuffers& b, OneRobotBuffers<T>& one) const {
  const std::size_t obstacles = one_.put_obstacles(robot, one);
  const Motion wish = wish_of(robot);
  double share = 1.0;
  for (const MotionRow& row : b.rows) {
    const double has = static_cast<double>(row.at(safe) - row.least),
                 takes = static_cast<double>(row.at(safe) - row.at(wish));
    if (takes > has) share = std::min(share, has / takes);
  }
  for (int k = 0; k < kCorrections; ++k, share *= 1.0 - 0x1p-10) {
    const Motion m = between(safe, wish, share);
    if (squared_length(m) <= kinds_[crowd_.robots.kind(robot)].squared_speed && violated(b.rows, m) == nullptr &&
        one_.keeps_obstacles(robot, obstacles, one, m.x, m.y))
      return m;
    if (share == 0.0) break;
  }
  return safe;
}

template <class T>
Motion HardLevel<T>::nearest(std::size_t robot, Motion safe, HardBuffers& b, OneRobotBuffers<T>& one) const {
  const double unit = table_.velocity_step, inward = kHalfDiagonal * unit;
  const std::size_t obstacles = one_.put_obstacles(robot, one), hard = obstacles + b.rows.size();
  const std::size_t moving = one.body_lines.size() - one.still, lines = hard + moving;
  const std::size_t room = (lines / lp::kSinglePadding + 1) * lp::kSinglePadding;
  for (auto* column : {&b.x, &b.y, &b.offset}) column->assign(room, 0.0);
  for (std::size_t k = 0; k < obstacles; ++k) {
    b.x[k] = static_cast<double>(one.row_x[k * kPack]);
    b.y[k] = static_cast<double>(one.row_y[k * kPack]);
    b.offset[k] = static_cast<double>(one.row_c[k * kPack]);
  }
  for (std::size_t k = 0; k < b.rows.size(); ++k) {
    const MotionRow& row = b.rows[k];
    const double nx = static_cast<double>(row.nx), ny = static_cast<double>(row.ny),
                 length = std::sqrt(nx * nx + ny * ny);
    b.x[obstacles + k] = nx / length;
    b.y[obstacles + k] = ny / length;
    b.offset[obstacles + k] = static_cast<double>(row.least) / length * unit + inward;
  }
  for (std::size_t k = 0; k < moving; ++k) {
    const BodyLine& line = one.body_lines[one.still + k];
    b.x[hard + k] = line.normal.x;
    b.y[hard + k] = line.normal.y;
    b.offset[hard + k] = line.offset + inward;
  }
  lp::SingleProblem problem;
  problem.normal_x = b.x.data();
  problem.normal_y = b.y.data();
  problem.offset = b.offset.data();
  problem.count = lines;
  problem.hard = hard;
  const Motion wish = wish_of(robot);
  problem.preferred = {unit * wish.x, unit * wish.y};
  problem.disc = static_cast<double>(table_.disc[crowd_.robots.kind(robot)]);
  lp::solve_single(problem, b.answer);
  return rounded(robot, safe, obstacles, b, one);
}

/// The answer of the linear program as a motion that satisfies all rows, or one on the way back to `safe`.
template <class T>
Motion HardLevel<T>::rounded(std::size_t robot, Motion safe, std::size_t obstacles, const HardBuffers& b,
                             const OneRobotBuffers<T>& one) const {
  const double fastest = kinds_[crowd_.robots.kind(robot)].squared_speed;
  const std::int64_t longest = longest_way(wish_of(robot));
  const auto holds = [&](Motion m) {
    return squared_length(m) <= std::min(fastest, static_cast<double>(longest * longest)) &&
           violated(b.rows, m) == nullptr && one_.keeps_obstacles(robot, obstacles, one, m.x, m.y);
  };
  const double per_step = 1.0 / table_.velocity_step;
  const Motion first = whole(b.answer.velocity.x * per_step, b.answer.velocity.y * per_step);
  Motion m = first;
  for (int k = 0; k < kCorrections; ++k) {
    if (holds(m)) return m;
    const MotionRow* row = violated(b.rows, m);
    if (row == nullptr) break;
    const double nx = static_cast<double>(row->nx), ny = static_cast<double>(row->ny),
                 length = std::sqrt(nx * nx + ny * ny);
    const double missing = static_cast<double>(row->least - row->at(m)) / length + kHalfDiagonal;
    m = whole(m.x + missing * nx / length, m.y + missing * ny / length);
  }
  for (const double share : kShares) {
    m = between(first, safe, share);
    if (holds(m)) return m;
  }
  return safe;
}

template class HardLevel<float>;
template class HardLevel<double>;

}  // namespace exactvo::formation
