// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/hard_level.h"

#include <algorithm>
#include <cmath>

#include "exactvo/vo/lp/single.h"

namespace exactvo::formation {

using namespace crowd;

namespace {

/// Robots that are decided together.
constexpr std::size_t kTogether = 64;

/// Half a lattice step in both coordinates, sqrt(1/2), rounded up: half-planes are moved inward by it before the linear
/// program, so that its answer can be rounded.
constexpr double kHalfDiagonal = 0.7072;

/// Motions that are tried after the rounded answer: each goes back over the row that the last one violates.
constexpr int kCorrections = 6;

/// Shares of the way back to the safe motion.
constexpr double kShares[] = {0x1p-12, 0x1p-8, 0x1p-4, 0.25, 0.5, 0.75};

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
  steps_.clear();
  for (std::size_t k = 0; k < crowd_.kinds.size(); ++k) {
    const CrowdKind& kind = crowd_.kinds[k];
    StepsOfKind steps;
    steps.radius = static_cast<std::int64_t>(std::ceil(kind.radius / q));  // q is a power of two: exact
    steps.reach = std::sqrt(static_cast<double>(table_.reach[k])) * (1.0 + 0x1p-10);
    const double speed = kind.max_speed * dt / q;
    steps.squared_speed = speed * speed * (1.0 - 0x1p-46);
    steps_.add(steps);
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
void HardLevel<T>::decide(std::size_t first, std::size_t last, int round, HardBuffers& b, OneRobotBuffers<T>& one,
                          StepReport& counts, Robots& robots, std::int32_t* to_x, std::int32_t* to_y) const {
  b.asked.clear();
  for (std::size_t i = first; i < last; ++i) {
    const Motion wish = wish_of(i);
    if (round == 0 || safe_of(i, round) != wish) b.asked.push_back(static_cast<std::int32_t>(i));
    to_x[i] = wish.x;
    to_y[i] = wish.y;
    if (b.asked.size() < kTogether && i + 1 < last) continue;
    decide_asked(round, b, one, counts, robots, to_x, to_y);
    b.asked.clear();
  }
}

template <class T>
void HardLevel<T>::decide_asked(int round, HardBuffers& b, OneRobotBuffers<T>& one, StepReport& counts, Robots& robots,
                                std::int32_t* to_x, std::int32_t* to_y) const {
  find_near_pairs(robots, steps_, b.asked, round == 0, b.near);
  put_pairs(round, b);
  make_pair_rows(b.pairs);
  std::size_t pair = 0, from = 0;
  for (std::size_t k = 0; k < b.asked.size(); from = b.near.end[k++]) {
    const auto robot = static_cast<std::size_t>(b.asked[k]);
    const std::uint8_t state = b.near.state[k];
    if (round == 0) {
      counts.overlapping += (state & NearPairs::kOverlaps) != 0;
      if (state & NearPairs::kMeets) robots.next_kept[robot] |= Robots::kHasMet;
    }
    if ((state & NearPairs::kHindered) == 0) continue;
    const Motion safe = safe_of(robot, round);
    const bool found = take_rows(robot, from, b.near.end[k], pair, b);
    pair += b.near.end[k] - from;
    const Motion m = found ? within_rows(robot, safe, b, one) : safe;
    to_x[robot] = m.x;
    to_y[robot] = m.y;
  }
}

/// The pairs of all robots that are hindered.
template <class T>
void HardLevel<T>::put_pairs(int round, HardBuffers& b) const {
  const Robots& robots = crowd_.robots;
  b.pairs.clear(round == 0);
  std::size_t from = 0;
  for (std::size_t k = 0; k < b.asked.size(); ++k)
    for (; from < b.near.end[k]; ++from) {
      const auto robot = static_cast<std::size_t>(b.asked[k]), other = static_cast<std::size_t>(b.near.other[from]);
      const bool first = robots.id[robot] < robots.id[other];
      const std::size_t i = first ? robot : other, j = first ? other : robot;
      PairInStep pair;
      pair.dx = std::int64_t{robots.x[i]} - robots.x[j];
      pair.dy = std::int64_t{robots.y[i]} - robots.y[j];
      pair.radius = steps_.kinds[robots.kind(i)].radius + steps_.kinds[robots.kind(j)].radius;
      pair.wish_a = wish_of(i);
      pair.wish_b = wish_of(j);
      pair.safe_a = safe_of(i, round);
      pair.safe_b = safe_of(j, round);
      b.pairs.add(pair);
    }
}

/// Into b.rows those of a robot: its pairs begin at `pair`, its others stand from `first` to `last` in b.near. False
/// where it has to keep its safe motion.
template <class T>
bool HardLevel<T>::take_rows(std::size_t robot, std::size_t first, std::size_t last, std::size_t pair,
                             HardBuffers& b) const {
  const auto& id = crowd_.robots.id;
  bool found = true;
  b.rows.clear();
  for (std::size_t k = first; k < last; ++k, ++pair) {
    found = found && b.pairs.found(pair);
    const bool is_first = id[robot] < id[static_cast<std::size_t>(b.near.other[k])];
    b.rows.push_back(is_first ? b.pairs.row_a(pair) : b.pairs.row_b(pair));
  }
  return found;
}

/// The motion nearest to the wish that b.rows allow.
template <class T>
Motion HardLevel<T>::within_rows(std::size_t robot, Motion safe, HardBuffers& b, OneRobotBuffers<T>& one) const {
  const Motion wish = wish_of(robot);
  if (violated(b.rows, wish) == nullptr) return wish;
  if (crowd_.reserved_ways.holds(crowd_.robots.id[robot])) return shortened(robot, safe, b, one);
  return nearest(robot, safe, b, one);
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
    if (squared_length(m) <= steps_.kinds[crowd_.robots.kind(robot)].squared_speed && violated(b.rows, m) == nullptr &&
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
  const double fastest = steps_.kinds[crowd_.robots.kind(robot)].squared_speed;
  const Motion wish = wish_of(robot);
  const std::int64_t longest = longest_way(wish.x, wish.y);
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
