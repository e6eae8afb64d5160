// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/hard_level.h"

#include <algorithm>
#include <cmath>

#include "exactvo/vo/lp/solve.h"

namespace exactvo::formation {

using namespace crowd;

namespace {

/// Motions that are tried after the rounded answer: each goes back over the row that the last one violates.
constexpr int kCorrections = 6;

/// Shares of the way back to the safe motion.
constexpr double kShares[] = {0x1p-12, 0x1p-8, 0x1p-4, 0.25, 0.5, 0.75};

double squared_length(Motion m) {
  const double x = m.x, y = m.y;
  return x * x + y * y;
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

/// A share of the squared speed: a velocity within it is inside the disc, whatever is rounded.
constexpr double kWithinDisc = 1.0 - 0x1p-40;

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
  std::copy(&robots.wish_mx[first], &robots.wish_mx[last], to_x + first);
  std::copy(&robots.wish_my[first], &robots.wish_my[last], to_y + first);
  find_cut(first, last, round, lists, b, robots);
  counts.overlapping += round == 0 ? b.near.overlapping : 0;
  const bool has_obstacles = !crowd_.edges.empty() || one_.has_bodies();
  const auto take = [&](std::size_t robot, Motion m) {
    to_x[robot] = m.x;
    to_y[robot] = m.y;
    if (round == 0 || m == wish_of(robot)) return;
    ++counts.cut_short;
    robots.next_kept[robot] &= static_cast<std::uint8_t>(~Robots::kIsKept);
  };
  const auto take_few = [&] {
    const std::size_t count = b.few.robots;
    Few found[FewRows::kLanes];
    Motion m[FewRows::kLanes];
    nearest_of_few(b.few, found, m);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t robot = b.robots_of_few[k];
      if (found[k] != Few::not_found && !one_.can_drive(robot, m[k])) found[k] = Few::not_found;
      take(robot, found[k] == Few::allowed ? m[k] : within_rows(robot, safe_of(robot, round), found[k], m[k], b, one));
    }
  };
  for (const std::int32_t cut : b.near.cut) {
    const auto robot = static_cast<std::size_t>(cut);
    const Motion safe = safe_of(robot, round);
    if ((b.near.state[robot - first] & NearPairs::kStays) != 0)
      take(robot, safe);
    else if (has_obstacles || !add_few(robot, b))
      take(robot, within_rows(robot, safe, Few::not_found, {}, b, one));
    if (b.few.robots == FewRows::kLanes) take_few();
  }
  if (b.few.robots > 0) take_few();
}

/// Into b.near the robots whose rows may not allow their wishes, with all their rows.
template <class T>
void HardLevel<T>::find_cut(std::size_t first, std::size_t last, int round, NearLists& lists, HardBuffers& b,
                            Robots& robots) const {
  MotionColumns columns{robots.x.data(),       robots.y.data(), robots.wish_mx.data(),
                        robots.wish_my.data(), nullptr,         nullptr};
  if (round > 0) {
    columns.safe_x = robots.safe_mx.data(), columns.safe_y = robots.safe_my.data();
    b.near.find_again(robots, kinds_, first, last, lists);
  } else {
    b.near.find(robots, kinds_, first, last, lists);
  }
  make_pair_rows(columns, b.near.pairs, 0);
  b.near.judge_rows();
  if (round > 0) return;
  const std::size_t open = b.near.pairs.size();
  b.near.add_clear(robots, kinds_, lists);
  make_pair_rows(columns, b.near.pairs, open);
}

/// The motion nearest to the wish that a robot's rows allow, which are put into b.rows by the places of the others.
/// `few`: of nearest_of_few, which found it `found`.
template <class T>
Motion HardLevel<T>::within_rows(std::size_t robot, Motion safe, Few found, Motion few, HardBuffers& b,
                                 OneRobotBuffers<T>& one) const {
  b.order.clear();
  b.near.for_pairs_of(robot, [&](std::size_t pair, bool is_a, std::int32_t other) {
    b.order.push_back(static_cast<std::uint64_t>(other) << 32U | 2 * pair | std::uint64_t{!is_a});
  });
  std::sort(b.order.begin(), b.order.end());
  b.rows.clear();
  for (const std::uint64_t entry : b.order)
    b.rows.push_back(b.near.pairs.row((entry & 0xFFFFFFFFU) / 2, entry % 2 == 0));
  const Motion wish = wish_of(robot);
  if (violated(b.rows, wish) == nullptr) return wish;
  if (found == Few::not_allowed) return rounded(robot, safe, few, 0, b, one);
  if (crowd_.reserved_ways.holds(crowd_.robots.id[robot])) return shortened(robot, safe, b, one);
  const double per_step = 1.0 / table_.velocity_step;
  const std::size_t obstacles = solve(robot, b, one);
  return rounded(robot, safe, whole(b.answer.velocity.x * per_step, b.answer.velocity.y * per_step), obstacles, b, one);
}

/// The rows of a robot without obstacles, of which nearly always one binds, or two. False where they are too many.
template <class T>
bool HardLevel<T>::add_few(std::size_t robot, HardBuffers& b) const {
  const PairTable& p = b.near.pairs;
  bool has_room = true;
  b.near.for_pairs_of(robot, [&](std::size_t pair, bool is_a, std::int32_t) {
    const double* const least = is_a ? p.least_a.data() : p.least_b.data();
    has_room = has_room && b.few.add(is_a ? 1.0 : -1.0, p.normal_x[pair], p.normal_y[pair], least[pair]);
  });
  if (!has_room) {
    b.few.drop();
    return false;
  }
  const double disc = static_cast<double>(table_.disc[crowd_.robots.kind(robot)]) / table_.velocity_step;
  b.robots_of_few[b.few.robots] = robot;
  b.few.finish(wish_of(robot), disc * disc * kWithinDisc, squared_way(robot));
  return true;
}

/// The square of the longest way that its kind and longest_way allow.
template <class T>
double HardLevel<T>::squared_way(std::size_t robot) const {
  const Motion wish = wish_of(robot);
  const std::int64_t longest = longest_way(wish.x, wish.y);
  return std::min(kinds_[crowd_.robots.kind(robot)].squared_speed, static_cast<double>(longest * longest));
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
    if (squared_length(m) <= kinds_[crowd_.robots.kind(robot)].squared_speed && one_.can_drive(robot, m) &&
        violated(b.rows, m) == nullptr && one_.keeps_obstacles(robot, obstacles, one, m.x, m.y))
      return m;
    if (share == 0.0) break;
  }
  return safe;
}

/// Into b.answer the nearest velocity; how many half-planes of obstacles it keeps.
template <class T>
std::size_t HardLevel<T>::solve(std::size_t robot, HardBuffers& b, OneRobotBuffers<T>& one) const {
  const double unit = table_.velocity_step, inward = kHalfDiagonal * unit;
  const bool has_obstacles = !crowd_.edges.empty() || one_.has_bodies();
  const std::size_t obstacles = has_obstacles ? one_.put_obstacles(robot, one) : 0, rows = obstacles + b.rows.size();
  geometry::HalfPlane of_wheels[kMostWheelRows];
  const std::size_t wheels = crowd_.wheels.rows(crowd_.robots.kind(robot), crowd_.robots.id[robot], of_wheels);
  const std::size_t hard = rows + wheels;
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
    const MotionRow& row = b.rows[k];
    const double x = static_cast<double>(row.nx), y = static_cast<double>(row.ny), length = std::sqrt(x * x + y * y);
    b.x[obstacles + k] = x / length;
    b.y[obstacles + k] = y / length;
    b.offset[obstacles + k] = static_cast<double>(row.least) / length * unit + inward;
  }
  for (std::size_t k = 0; k < wheels; ++k) {
    b.x[rows + k] = of_wheels[k].normal.x;
    b.y[rows + k] = of_wheels[k].normal.y;
    b.offset[rows + k] = of_wheels[k].offset + inward;
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
  // Rows that leave no room once they are moved inward give way, as little as they must.
  problem.hard = moving == 0 ? obstacles : hard;
  const Motion wish = wish_of(robot);
  problem.preferred = {unit * wish.x, unit * wish.y};
  problem.disc = static_cast<double>(table_.disc[crowd_.robots.kind(robot)]);
  lp::solve(problem, b.answer);
  return obstacles;
}

/// Beside `first` a motion that satisfies all rows, or one on the way back to `safe`.
template <class T>
Motion HardLevel<T>::rounded(std::size_t robot, Motion safe, Motion first, std::size_t obstacles, const HardBuffers& b,
                             const OneRobotBuffers<T>& one) const {
  const double longest = squared_way(robot);
  const auto holds = [&](Motion m) {
    return squared_length(m) <= longest && one_.can_drive(robot, m) && violated(b.rows, m) == nullptr &&
           (obstacles == 0 || one_.keeps_obstacles(robot, obstacles, one, m.x, m.y));
  };
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
