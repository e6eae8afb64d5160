// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/passing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <initializer_list>
#include <map>
#include <optional>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "preflight/open_way.h"
#include "preflight/open_window.h"
#include "preflight/reachability.h"
#include "preflight/strip.h"
#include "scene/edges_by_place.h"
#include "steering/goals.h"

namespace exactvo::formation {
namespace {

using geometry::Segment;

constexpr std::size_t kMostSquares = 4000;  ///< of a robot: about 250 squares of its radius
constexpr std::size_t kMostLooks = 200000;  ///< at squares, in all: 0.1 s
constexpr std::size_t kMostLooksOfCover = 8 * (kMostSquares + 1);
constexpr std::size_t kMostPairs = 8000000;           ///< that are gone to, in all: half a second
constexpr std::size_t kMostLooksOfStrips = 20000000;  ///< at walls and squares of strips, in all: 0.2 s
constexpr double kCoarsestSquare = 0.25;              ///< side of a square, of the smaller radius
constexpr double kFinestSquare = 1.0 / 16.0;          ///< the same
constexpr double kRoundedDown = 1.0 - 0x1p-40;        ///< of a product of a few factors
constexpr double kHalfDiagonal = 0.70711;             ///< of a square, rounded up

/// x and y times the side are the coordinates of its lower left corner, without rounding: the side is a power of two.
struct Square {
  std::int32_t x, y;
};

std::uint64_t key(Square q) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(q.x)) << 32 | static_cast<std::uint32_t>(q.y);
}

/// The numbers of squares, by place. Most of the time of a cover goes into looking squares up: open addressing, in
/// memory of one piece that is never more than half full.
class SquareNumbers {
 public:
  static constexpr std::uint32_t kUnknown = 0xffffffff;

  SquareNumbers() : slots_(kSlots) {}

  std::uint32_t find(Square q) const { return slot(q).number; }
  /// REQUIRES: the square is unknown.
  void add(Square q, std::uint32_t number) { slots_[place(q)] = {q, number}; }

 private:
  struct Slot {
    Square square{};
    std::uint32_t number = kUnknown;
  };
  static constexpr std::size_t kSlots = 16384;
  static_assert(kSlots >= 2 * (kMostSquares + 2) && (kSlots & (kSlots - 1)) == 0, "a power of two, half of it empty");

  const Slot& slot(Square q) const { return slots_[place(q)]; }
  /// Where the square stands, or would.
  std::size_t place(Square q) const {
    std::size_t at = static_cast<std::size_t>(key(q) * 0x9e3779b97f4a7c15u >> 50);
    while (slots_[at].number != kUnknown && key(slots_[at].square) != key(q)) at = (at + 1) % kSlots;
    return at;
  }

  std::vector<Slot> slots_;
};

/// The squares that share a side or a corner with one.
struct Beside {
  std::uint32_t count = 0;
  std::uint32_t number[8] = {};

  const std::uint32_t* begin() const { return number; }
  const std::uint32_t* end() const { return number + count; }
};

/// The squares that cover where a disc can get from its start.
struct Cover {
  double radius = 0.0, side = 0.0;
  bool is_whole = false;  ///< else there are more squares than are looked at
  std::vector<Square> squares;
  std::vector<Beside> beside;  ///< of each square; of none where the cover is not whole
  SquareNumbers number;
};

class Walls {
 public:
  explicit Walls(const std::vector<SceneObstacle>& obstacles) : edges_(obstacles) {}

  const detail::EdgesByPlace& edges() const { return edges_; }

  /// Whether some edge is nearer than the radius to every point of the square; false where rounding leaves it open. The
  /// distance to an edge is convex, so that it is largest at a corner.
  bool exclude(Square q, double side, double radius) const {
    const Vec2 low{side * q.x, side * q.y}, high{side * (q.x + 1.0), side * (q.y + 1.0)};
    return exclude_hull({low, {high.x, low.y}, high, {low.x, high.y}}, radius);
  }

  /// The same of a single point.
  bool exclude(Vec2 p, double radius) const { return exclude_hull({p}, radius); }

  /// Whether a disc that starts in the square has more than `kMostSquares` to go to, none of which is excluded; false
  /// where that takes a closer look.
  bool leave_open(Square start, double side, double radius) const {
    // Beyond it a coordinate of an edge could be off by a thousandth of a square.
    constexpr double kMost = 0x1p40;
    if (edges_.largest_with({}) > kMost * side) return false;
    constexpr int kColumn = detail::OpenWindow::kColumns / 2, kRow = detail::OpenWindow::kRows / 2;
    detail::OpenWindow window(start.x - kColumn, start.y - kRow, side);
    const geometry::Box box = window.box();
    const double margin = radius + 2.0 * side;
    edges_.grid().for_each_meeting({box.low - Vec2{margin, margin}, box.high + Vec2{margin, margin}},
                                   [&](std::size_t k) { window.take_away(edges_[k], radius); });
    return window.has_more_than(kMostSquares + 1, kColumn, kRow);
  }

 private:
  bool exclude_hull(std::initializer_list<Vec2> corners, double radius) const {
    double largest = 0.0;
    for (const Vec2 p : corners) largest = std::max(largest, edges_.largest_with(p));
    const double near = radius - 2.0 * geometry::rounding_of_distance(largest);
    bool found = false;
    edges_.grid().for_each_within(*corners.begin(), radius, [&](std::size_t k) {
      found = found || std::all_of(corners.begin(), corners.end(),
                                   [&](Vec2 p) { return geometry::distance(edges_[k], p) < near; });
    });
    return found;
  }

  detail::EdgesByPlace edges_;
};

bool fits_grid(Vec2 p, double side) {
  constexpr double kMost = 0x1p30;
  return std::fabs(p.x) < kMost * side && std::fabs(p.y) < kMost * side;
}

/// One that contains the place.
Square square_at(Vec2 p, double side) {
  return {static_cast<std::int32_t>(std::floor(p.x / side)), static_cast<std::int32_t>(std::floor(p.y / side))};
}

std::array<Square, 8> squares_beside(Square q) {
  return {{{q.x - 1, q.y - 1},
           {q.x, q.y - 1},
           {q.x + 1, q.y - 1},
           {q.x - 1, q.y},
           {q.x + 1, q.y},
           {q.x - 1, q.y + 1},
           {q.x, q.y + 1},
           {q.x + 1, q.y + 1}}};
}

Cover cover_from(Vec2 start, double radius, double side, const Walls& walls, std::size_t& looks) {
  Cover cover;
  cover.radius = radius;
  cover.side = side;
  std::vector<Square>& squares = cover.squares;
  squares.push_back(square_at(start, side));
  cover.number.add(squares[0], 0);
  for (std::size_t k = 0; k < squares.size(); ++k)
    for (const Square q : squares_beside(squares[k])) {
      if (cover.number.find(q) != SquareNumbers::kUnknown) continue;
      if (squares.size() > kMostSquares || looks == 0) return cover;
      --looks;
      if (walls.exclude(q, side, radius)) continue;
      cover.number.add(q, static_cast<std::uint32_t>(squares.size()));
      squares.push_back(q);
    }
  cover.is_whole = true;
  for (const Square middle : squares) {
    Beside& beside = cover.beside.emplace_back();
    for (const Square q : squares_beside(middle))
      if (const std::uint32_t known = cover.number.find(q); known != SquareNumbers::kUnknown)
        beside.number[beside.count++] = known;
  }
  return cover;
}

/// Of each square, whether a point of it is within `reach` of the goal.
std::vector<char> squares_at(Vec2 goal, double reach, const Cover& cover) {
  std::vector<char> is_at(cover.squares.size());
  for (std::size_t k = 0; k < is_at.size(); ++k) {
    const Vec2 middle{cover.side * (cover.squares[k].x + 0.5), cover.side * (cover.squares[k].y + 0.5)};
    is_at[k] = norm(middle - goal) * kRoundedDown <= reach + kHalfDiagonal * cover.side;
  }
  return is_at;
}

/// Whether what is covered comes within reach of the goal: else the walls alone keep the disc from it.
bool holds_goal(const std::vector<char>& is_at) {
  return std::find(is_at.begin(), is_at.end(), char{1}) != is_at.end();
}

/// What a search over pairs of squares comes to.
struct PairSearch {
  enum class End { reaches_goals, proven, out_of_budget } end = End::out_of_budget;
  std::size_t pairs = 0;
};

struct Traveller {
  const Cover* cover = nullptr;
  std::uint32_t start = 0;
  std::vector<char> is_goal;
};

PairSearch search(const Traveller& a, const Traveller& b, std::size_t most) {
  const double radii = (a.cover->radius + b.cover->radius) / a.cover->side;
  const double least = radii * radii * kRoundedDown;
  // Two points of the squares are at most this far from each other.
  const auto can_be_apart = [&](std::uint32_t i, std::uint32_t j) {
    const Square p = a.cover->squares[i], q = b.cover->squares[j];
    const double x = std::fabs(double(p.x) - double(q.x)) + 1.0, y = std::fabs(double(p.y) - double(q.y)) + 1.0;
    return x * x + y * y >= least;
  };
  const std::size_t width = b.cover->squares.size();
  std::vector<bool> seen(a.cover->squares.size() * width);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
  PairSearch found;
  const auto visit = [&](std::uint32_t i, std::uint32_t j) {
    if (seen[i * width + j] || !can_be_apart(i, j)) return;
    seen[i * width + j] = true;
    open.emplace_back(i, j);
    ++found.pairs;
    if (a.is_goal[i] && b.is_goal[j]) found.end = PairSearch::End::reaches_goals;
  };
  visit(a.start, b.start);
  while (!open.empty() && found.end != PairSearch::End::reaches_goals) {
    if (found.pairs > most) return found;
    const auto [i, j] = open.back();
    open.pop_back();
    for (const std::uint32_t next : a.cover->beside[i]) visit(next, j);
    for (const std::uint32_t next : b.cover->beside[j]) visit(i, next);
  }
  if (found.end != PairSearch::End::reaches_goals) found.end = PairSearch::End::proven;
  return found;
}

class Proofs {
 public:
  /// `spares`: makes no cover of a robot that stands in the open.
  Proofs(const Scenario& scenario, bool spares)
      : scenario_(scenario),
        walls_(scenario.obstacles),
        open_(scenario.obstacles),
        reach_(scenario, 0.0, false),
        spares_(spares) {}

  /// Whether the covers that were spared could not have used up the looks: without sparing the same is found.
  bool is_sure() const { return looks_left_ > spared_; }

  /// Where a robot gets to that proofs are looked for about; else null. Who starts in a wall is pushed out of it:
  /// nothing holds it in its cover. Whose goal is out of reach has no use of passing.
  const Cover* little_room(std::size_t i) {
    const Robot& r = scenario_.robots[i];
    if (r.goals.size() != 1 || !(r.radius > 0.0) || walls_.exclude(r.position, r.radius)) return nullptr;
    const Cover* cover = cover_of(i, coarsest_side(r.radius));
    return cover && holds_goal(squares_at_goal(i, *cover)) ? cover : nullptr;
  }

  bool is_in(const Cover& cover, std::size_t robot) const {
    const Vec2 p = scenario_.robots[robot].position;
    return fits_grid(p, cover.side) && cover.number.find(square_at(p, cover.side)) != SquareNumbers::kUnknown;
  }

  /// That the two cannot pass, where each of them could reach its goal if the other were not there. REQUIRES: both have
  /// little room.
  std::optional<NoPassing> of(std::size_t i, std::size_t j) {
    if (overlap_at_start(i, j) || detail::are_too_near(scenario_, i, j)) return std::nullopt;
    std::optional<NoPassing> proof = by_walls(i, j);
    return proof && !is_out_of_reach(i) && !is_out_of_reach(j) ? std::move(proof) : std::nullopt;
  }

 private:
  std::optional<NoPassing> by_walls(std::size_t i, std::size_t j) {
    if (std::optional<NoPassing> proof = in_a_strip(i, j)) return proof;
    const double smaller = std::min(scenario_.robots[i].radius, scenario_.robots[j].radius);
    for (double side = coarsest_side(smaller); side >= kFinestSquare * smaller; side *= 0.5) {
      const Cover* of_i = cover_of(i, side);
      const Cover* of_j = of_i ? cover_of(j, side) : nullptr;
      if (!of_j || !(is_in(*of_i, j) || is_in(*of_j, i))) return std::nullopt;
      const Traveller first = traveller(i, *of_i), second = traveller(j, *of_j);
      if (!holds_goal(first.is_goal) || !holds_goal(second.is_goal)) return std::nullopt;
      const PairSearch found = search(first, second, pairs_left_);
      pairs_left_ -= std::min(pairs_left_, found.pairs);
      if (found.end == PairSearch::End::out_of_budget) return std::nullopt;
      if (found.end == PairSearch::End::proven) return NoPassing{i, j, side, corners_of(*of_i), found.pairs, 0.0};
    }
    return std::nullopt;
  }

  /// Squares cover more than what can be reached: a goal behind a gap just too narrow may lie in them.
  bool is_out_of_reach(std::size_t robot) {
    const auto [known, is_new] = is_out_of_reach_.try_emplace(robot, false);
    if (is_new)
      known->second = !open_.is_found(scenario_.robots[robot].position, scenario_.robots[robot].goals[0],
                                      scenario_.robots[robot].radius) &&
                      is_proven_out_of_reach(robot);
    return known->second;
  }

  bool is_proven_out_of_reach(std::size_t robot) {
    const Robot& r = scenario_.robots[robot];
    const detail::Destination goal{r.goals[0], detail::reach_of(scenario_, r, 0)};
    return !reach_.reachable_place(r.radius, r.position, goal) &&
           reach_.is_proven_out_of_reach(r.radius, r.position, goal);
  }

  static double coarsest_side(double radius) { return std::exp2(std::floor(std::log2(kCoarsestSquare * radius))); }

  /// Such robots push each other apart, to any side.
  bool overlap_at_start(std::size_t i, std::size_t j) const {
    const Robot &a = scenario_.robots[i], &b = scenario_.robots[j];
    return norm(a.position - b.position) < a.radius + b.radius;
  }

  std::optional<NoPassing> in_a_strip(std::size_t i, std::size_t j) {
    // Wherever the larger one gets to, the smaller one has room too.
    const auto [smaller, larger] =
        scenario_.robots[i].radius <= scenario_.robots[j].radius ? std::pair(i, j) : std::pair(j, i);
    const Cover* cover = cover_of(smaller, coarsest_side(scenario_.robots[smaller].radius));
    if (!cover || !is_in(*cover, larger)) return std::nullopt;
    if (!holds_goal(squares_at_goal(i, *cover)) || !holds_goal(squares_at_goal(j, *cover))) return std::nullopt;
    std::vector<Vec2> squares = corners_of(*cover);
    const std::optional<double> width =
        detail::strip_that_keeps_order(disc(i), disc(j), squares, cover->side, walls_.edges(), looks_left_of_strips_);
    if (!width) return std::nullopt;
    return NoPassing{i, j, cover->side, std::move(squares), 0, *width};
  }

  detail::DiscWithGoal disc(std::size_t i) const {
    const Robot& r = scenario_.robots[i];
    return {r.position, r.goals[0], detail::reach_of(scenario_, r, 0), r.radius};
  }

  /// Null where it is not whole. Robots in one another's cover share it.
  const Cover* cover_of(std::size_t robot, double side) {
    const Robot& r = scenario_.robots[robot];
    if (!fits_grid(r.position, side) || !fits_grid(r.goals[0], side)) return nullptr;
    for (const Cover& c : covers_)
      if (c.radius == r.radius && c.side == side && is_in(c, robot)) return c.is_whole ? &c : nullptr;
    if (looks_left_ == 0) return nullptr;
    if (spares_ && walls_.leave_open(square_at(r.position, side), side, r.radius)) {
      spared_ += kMostLooksOfCover;
      return nullptr;
    }
    covers_.push_back(cover_from(r.position, r.radius, side, walls_, looks_left_));
    return covers_.back().is_whole ? &covers_.back() : nullptr;
  }

  Traveller traveller(std::size_t robot, const Cover& cover) const {
    return {&cover, cover.number.find(square_at(scenario_.robots[robot].position, cover.side)),
            squares_at_goal(robot, cover)};
  }

  std::vector<char> squares_at_goal(std::size_t robot, const Cover& cover) const {
    const Robot& r = scenario_.robots[robot];
    return squares_at(r.goals[0], detail::reach_of(scenario_, r, 0), cover);
  }

  static std::vector<Vec2> corners_of(const Cover& cover) {
    std::vector<Vec2> corners;
    for (const Square q : cover.squares) corners.push_back(cover.side * Vec2{double(q.x), double(q.y)});
    return corners;
  }

  const Scenario& scenario_;
  Walls walls_;
  detail::OpenWay open_;
  detail::Reachability reach_;                   ///< makes its map where it is asked
  std::map<std::size_t, bool> is_out_of_reach_;  ///< of robots that were asked for
  std::deque<Cover> covers_;
  std::size_t looks_left_ = kMostLooks, pairs_left_ = kMostPairs, looks_left_of_strips_ = kMostLooksOfStrips;
  bool spares_;
  std::size_t spared_ = 0;  ///< looks, at most
};

/// Nothing where sparing could change what is found.
std::optional<std::vector<NoPassing>> without_passing(const Scenario& scenario, bool spares) {
  Proofs proofs(scenario, spares);
  const auto is_sure = [&] { return !spares || proofs.is_sure(); };
  struct Asked {
    std::size_t robot;
    const Cover* room;
  };
  std::vector<Asked> asked;
  for (std::size_t i = 0; i < scenario.robots.size() && is_sure(); ++i)
    if (const Cover* room = proofs.little_room(i)) asked.push_back({i, room});
  // Finer squares cover less: who is in neither's coarsest ones is in none.
  const auto may_meet = [&](const Asked& a, const Asked& b) {
    return proofs.is_in(*a.room, b.robot) || proofs.is_in(*b.room, a.robot);
  };
  std::vector<NoPassing> all;
  for (std::size_t k = 0; k < asked.size() && is_sure(); ++k)
    for (std::size_t l = k + 1; l < asked.size(); ++l)
      if (may_meet(asked[k], asked[l]))
        if (std::optional<NoPassing> proof = proofs.of(asked[k].robot, asked[l].robot))
          all.push_back(std::move(*proof));
  if (!is_sure()) return std::nullopt;
  return all;
}

}  // namespace

std::vector<NoPassing> robots_without_passing(const Scenario& scenario) {
  if (scenario.formation || scenario.obstacles.empty() || scenario.robots.size() < 2) return {};
  if (std::optional<std::vector<NoPassing>> all = without_passing(scenario, true)) return std::move(*all);
  return *without_passing(scenario, false);
}

std::string words_of(const Scenario& scenario, const NoPassing& proof) {
  char text[160];
  if (proof.strip > 0.0)
    std::snprintf(text, sizeof text, " (proven: they are in a strip %g m wide, and side by side they take %g m)",
                  proof.strip, 2.0 * (scenario.robots[proof.first].radius + scenario.robots[proof.second].radius));
  else
    std::snprintf(text, sizeof text, " (proven: none of %zu pairs of squares of %g m leads there)", proof.pairs,
                  proof.side);
  return scenario.robots[proof.first].id + " and " + scenario.robots[proof.second].id +
         " cannot both reach their goals: they have no room to pass each other" + text;
}

}  // namespace exactvo::formation
