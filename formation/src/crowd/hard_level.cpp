// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/hard_level.h"

#include <algorithm>
#include <cmath>

#include "exactvo/vo/lp/solve.h"

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

/// std::nearbyint, which is a call on targets before SSE4.1. |value| < 2^51.
double nearest_whole(double value) {
  constexpr double kWholeOnly = 0x1.8p52;
  return (value + kWholeOnly) - kWholeOnly;
}

Motion whole(double x, double y) {
  return {static_cast<std::int32_t>(nearest_whole(x)), static_cast<std::int32_t>(nearest_whole(y))};
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
  double largest = 0.0, fastest = 0.0;
  for (const CrowdKind& kind : crowd_.kinds) {
    largest = std::max(largest, kind.radius);
    fastest = std::max(fastest, kind.max_speed);
  }
  kinds_.clear();
  for (const CrowdKind& kind : crowd_.kinds) {
    StepsOfKind steps;
    steps.radius = static_cast<std::int64_t>(std::ceil(kind.radius / q));  // q is a power of two: exact
    steps.reach = reach_of_pairs(kind, crowd_.options, largest, fastest);
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
void HardLevel<T>::decide(std::size_t first, std::size_t last, int round, NearLists& lists, HardBuffers& b,
                          OneRobotBuffers<T>& one, StepReport& counts, Robots& robots, std::int32_t* to_x,
                          std::int32_t* to_y) const {
  const std::int32_t *wish_x = robots.wish_mx.data(), *wish_y = robots.wish_my.data();
  const std::int32_t *safe_x = robots.safe_mx.data(), *safe_y = robots.safe_my.data();
  const std::uint8_t* const listed = lists.count.data();
  b.asked.resize(kTogether);
  std::size_t list = 0, asked = 0;
  for (std::size_t i = first; i < last; ++i) {
    to_x[i] = wish_x[i];
    to_y[i] = wish_y[i];
    if (round == 0 || safe_x[i] != wish_x[i] || safe_y[i] != wish_y[i]) b.asked[asked++] = {i, list};
    if (listed[i - first] != NearLists::kUnknown) list += listed[i - first];
    if (asked < kTogether && i + 1 < last) continue;
    b.asked.resize(asked);
    decide_asked(first, round, lists, b, one, counts, robots, to_x, to_y);
    b.asked.resize(kTogether);
    asked = 0;
  }
}

template <class T>
void HardLevel<T>::decide_asked(std::size_t first, int round, NearLists& lists, HardBuffers& b, OneRobotBuffers<T>& one,
                                StepReport& counts, Robots& robots, std::int32_t* to_x, std::int32_t* to_y) const {
  find_near_pairs(robots, kinds_, first, b.asked, round == 0, lists, b.near);
  put_pairs(round, b);
  make_pair_rows(b.pairs);
  std::size_t from = 0;
  for (std::size_t k = 0; k < b.asked.size(); from = b.near.end[k++]) {
    const std::size_t robot = b.asked[k].robot;
    const std::uint8_t state = b.near.state[k];
    if (round == 0) {
      counts.overlapping += (state & NearPairs::kOverlaps) != 0;
      if (state & NearPairs::kMeets) robots.next_kept[robot] |= Robots::kHasMet;
    }
    if ((state & NearPairs::kHindered) == 0) continue;
    const Motion m = within_rows(robot, safe_of(robot, round), from, b.near.end[k], b, one);
    to_x[robot] = m.x;
    to_y[robot] = m.y;
  }
}

/// The pairs of all robots that are hindered.
template <class T>
void HardLevel<T>::put_pairs(int round, HardBuffers& b) const {
  const Robots& robots = crowd_.robots;
  const std::size_t count = b.near.pairs();
  MotionColumns columns{robots.id.data(),      robots.x.data(), robots.y.data(), robots.wish_mx.data(),
                        robots.wish_my.data(), nullptr,         nullptr};
  if (round > 0) columns.safe_x = robots.safe_mx.data(), columns.safe_y = robots.safe_my.data();
  gather_pairs(columns, b.near.robot.data(), b.near.other.data(), count, b.pairs);
  PairBlock* const blocks = b.pairs.blocks();
  if (kinds_.size() == 1) {
    for (std::size_t k = 0; k < count; k += kPack)
      std::fill(blocks[k / kPack].radius, blocks[k / kPack].radius + kPack,
                2.0 * static_cast<double>(kinds_[0].radius));
    return;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t own = robots.kind(static_cast<std::size_t>(b.near.robot[k])),
                      its = robots.kind(static_cast<std::size_t>(b.near.other[k]));
    blocks[k / kPack].radius[k % kPack] = static_cast<double>(kinds_[own].radius + kinds_[its].radius);
  }
}

/// The motion nearest to the wish that a robot's rows allow; those of pairs `first` to `last`.
template <class T>
Motion HardLevel<T>::within_rows(std::size_t robot, Motion safe, std::size_t first, std::size_t last, HardBuffers& b,
                                 OneRobotBuffers<T>& one) const {
  bool found = true, grants = true;
  for (std::size_t k = first; k < last; ++k) {
    found &= b.pairs.found(k);
    grants &= b.pairs.grants(k);
  }
  if (!found) return safe;
  const Motion wish = wish_of(robot);
  if (grants) return wish;
  b.rows.resize(last - first);
  for (std::size_t k = first; k < last; ++k) b.rows[k - first] = b.pairs.row(k);
  if (violated(b.rows, wish) == nullptr) return wish;
  if (crowd_.reserved_ways.holds(crowd_.robots.id[robot])) return shortened(robot, safe, b, one);
  return nearest(robot, safe, first, b, one);
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

/// `first`: of the robot's pairs, whose rows are b.rows.
template <class T>
Motion HardLevel<T>::nearest(std::size_t robot, Motion safe, std::size_t first, HardBuffers& b,
                             OneRobotBuffers<T>& one) const {
  const double unit = table_.velocity_step, inward = kHalfDiagonal * unit;
  const bool has_obstacles = !crowd_.edges.empty() || one_.has_bodies();
  const std::size_t obstacles = has_obstacles ? one_.put_obstacles(robot, one) : 0, hard = obstacles + b.rows.size();
  const std::size_t moving = has_obstacles ? one.body_lines.size() - one.still : 0, lines = hard + moving;
  const std::size_t room = (lines / lp::kSinglePadding + 1) * lp::kSinglePadding;
  for (auto* column : {&b.x, &b.y, &b.offset})
    if (column->size() < room) column->resize(2 * room);
  for (std::size_t k = 0; k < obstacles; ++k) {
    b.x[k] = static_cast<double>(one.row_x[k * kPack]);
    b.y[k] = static_cast<double>(one.row_y[k * kPack]);
    b.offset[k] = static_cast<double>(one.row_c[k * kPack]);
  }
  for (std::size_t k = 0; k < b.rows.size(); ++k) {
    const UnitRow row = b.pairs.unit_row(first + k);
    b.x[obstacles + k] = row.x;
    b.y[obstacles + k] = row.y;
    b.offset[obstacles + k] = row.least * unit + inward;
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
  lp::solve(problem, b.answer);
  return rounded(robot, safe, obstacles, b, one);
}

/// The answer of the linear program as a motion that satisfies all rows, or one on the way back to `safe`.
template <class T>
Motion HardLevel<T>::rounded(std::size_t robot, Motion safe, std::size_t obstacles, const HardBuffers& b,
                             const OneRobotBuffers<T>& one) const {
  const double fastest = kinds_[crowd_.robots.kind(robot)].squared_speed;
  const Motion wish = wish_of(robot);
  const std::int64_t longest = longest_way(wish.x, wish.y);
  const auto holds = [&](Motion m) {
    return squared_length(m) <= std::min(fastest, static_cast<double>(longest * longest)) &&
           violated(b.rows, m) == nullptr && (obstacles == 0 || one_.keeps_obstacles(robot, obstacles, one, m.x, m.y));
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
