// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/joint_search.h"

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <cmath>
#include <deque>
#include <unordered_map>
#include <utility>

#include "liveness/distances.h"
#include "liveness/split_mix.h"

namespace exactvo::formation::detail {
namespace {

using Joint = std::vector<PlaceNumber>;

/// Robots at most that push each other within a joint step, since each takes some of the stack. More can still move, in
/// several steps: sequences of single moves need no chains at all, so that the search stays complete.
constexpr std::size_t kLongestChain = 256;
constexpr PlaceNumber kNowhere = static_cast<PlaceNumber>(-1);

/// Robots by where they are, in square cells.
class RobotGrid {
 public:
  RobotGrid(const Roadmap& map, double reach) : reach_(reach) {
    constexpr double kMostCells = 4.0;  // a place: cells are larger where places are far apart
    geometry::Box all;
    for (PlaceNumber p = 0; p < map.size(); ++p) all.add(map.place(p));
    low_ = all.low;
    const Vec2 size = all.high - all.low;
    const double most = kMostCells * static_cast<double>(map.size());
    side_ = std::max({reach, std::sqrt(size.x) * std::sqrt(size.y / most), std::max(size.x, size.y) / most});
    columns_ = static_cast<std::size_t>((all.high.x - all.low.x) / side_) + 1;
    rows_ = static_cast<std::size_t>((all.high.y - all.low.y) / side_) + 1;
    cells_.resize(columns_ * rows_);
  }
  void clear() {
    for (const std::size_t cell : used_) cells_[cell].clear();
    used_.clear();
  }
  void put(Vec2 at, std::size_t robot) {
    const std::size_t cell = row(at.y) * columns_ + column(at.x);
    cells_[cell].push_back(robot);
    used_.push_back(cell);
  }
  void take(Vec2 at, std::size_t robot) {
    auto& cell = cells_[row(at.y) * columns_ + column(at.x)];
    cell.erase(std::find(cell.begin(), cell.end(), robot));
  }
  /// All within reach of the box of the segment, and some more. Ends where visit gives false.
  template <class Visit>
  bool all_near(Vec2 a, Vec2 b, const Visit& visit) const {
    const std::size_t x0 = column(std::min(a.x, b.x) - reach_), x1 = column(std::max(a.x, b.x) + reach_);
    const std::size_t y0 = row(std::min(a.y, b.y) - reach_), y1 = row(std::max(a.y, b.y) + reach_);
    for (std::size_t y = y0; y <= y1; ++y)
      for (std::size_t x = x0; x <= x1; ++x)
        for (const std::size_t robot : cells_[y * columns_ + x])
          if (!visit(robot)) return false;
    return true;
  }

 private:
  std::size_t number(double from_low, std::size_t count) const {
    return static_cast<std::size_t>(std::clamp(from_low / side_, 0.0, static_cast<double>(count - 1)));
  }
  std::size_t column(double x) const { return number(x - low_.x, columns_); }
  std::size_t row(double y) const { return number(y - low_.y, rows_); }

  double reach_, side_;
  Vec2 low_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::size_t>> cells_;
  std::vector<std::size_t> used_;
};

/// A low-level node of LaCAM: where the first robots in a node's order must go.
using Constraints = std::vector<std::pair<std::size_t, PlaceNumber>>;

/// One joint step by PIBT.
class Generator {
 public:
  Generator(const JointProblem& problem, const std::vector<std::vector<float>>& distances)
      : problem_(problem),
        map_(*problem.map),
        distances_(distances),
        before_(map_, reach_of(problem)),
        after_(map_, reach_of(problem)) {}

  /// Whether there is a step that keeps the constraints; then `next` and `order` (who moves first) hold it.
  bool generate(const Joint& at, const std::vector<std::size_t>& priority, const Constraints& constraints,
                SplitMix64& random) {
    const std::size_t n = at.size();
    at_ = &at;
    next_.assign(n, kNowhere);
    state_.assign(n, State::open);
    must_go_to_.assign(n, kNowhere);
    order_.clear();
    before_.clear();
    after_.clear();
    for (std::size_t i = 0; i < n; ++i) before_.put(map_.place(at[i]), i);
    for (const auto& [robot, place] : constraints) must_go_to_[robot] = place;
    for (const auto& entry : constraints)
      if (state_[entry.first] == State::open && !moves(entry.first, random, true)) return false;
    for (const std::size_t i : priority)
      if (state_[i] == State::open && !moves(i, random, true)) settle(i, at[i]);  // and is in no other's way
    return true;
  }

  const Joint& next() const { return next_; }
  const std::vector<std::size_t>& order() const { return order_; }
  std::size_t calls() const { return calls_; }

 private:
  enum class State : char { open, asks, settled };

  static double reach_of(const JointProblem& problem) {
    return 2.0 * (1.0 + kPlannedGap) * *std::max_element(problem.radii.begin(), problem.radii.end());
  }

  Vec2 here(std::size_t i) const { return map_.place((*at_)[i]); }
  Vec2 there(std::size_t i) const { return map_.place(next_[i]); }

  /// Whether robot i keeps clear of a disc at `centre` while it goes from a to b.
  bool keeps_clear(std::size_t i, Vec2 a, Vec2 b, std::size_t other, Vec2 centre) const {
    const double radii = problem_.radii[i] + problem_.radii[other];
    return squared_distance(centre, a, b) >= squared_keep(radii, squared_norm(a - centre));
  }

  void settle(std::size_t i, PlaceNumber to) {
    next_[i] = to;
    state_[i] = State::settled;
    order_.push_back(i);
    after_.put(map_.place(to), i);
  }

  void unsettle_since(std::size_t mark) {
    while (order_.size() > mark) {
      const std::size_t i = order_.back();
      order_.pop_back();
      after_.take(there(i), i);
      next_[i] = kNowhere;
      state_[i] = State::open;
    }
  }

  std::vector<std::pair<float, PlaceNumber>> candidates(std::size_t i, SplitMix64& random) const {
    constexpr float kShuffle = 1e-3f;  // diameters: among places about as good
    const PlaceNumber at = (*at_)[i];
    if (must_go_to_[i] != kNowhere) return {{0.0f, must_go_to_[i]}};
    std::vector<std::pair<float, PlaceNumber>> all;
    const float shuffle = kShuffle * 2.0f * static_cast<float>(problem_.radii[i]);
    for (const PlaceNumber to : map_.ways(at))
      if (map_.room(to) >= problem_.body(i)) all.emplace_back(distances_[i][to] + shuffle * random.fraction(), to);
    all.emplace_back(distances_[i][at], at);
    std::stable_sort(all.begin(), all.end());
    return all;
  }

  /// Settles the robot and all that it pushes. `is_first`: no other robot pushed it.
  bool moves(std::size_t i, SplitMix64& random, bool is_first) {
    if (is_first) refused_.assign(at_->size(), 0);
    ++calls_;
    state_[i] = State::asks;
    for (const auto& candidate : candidates(i, random))
      if (moves_to(i, candidate.second, random)) return true;
    state_[i] = State::open;
    return false;
  }

  bool moves_to(std::size_t i, PlaceNumber to, SplitMix64& random) {
    const Vec2 a = here(i), b = map_.place(to);
    const bool clear_of_moved = after_.all_near(a, b, [&](std::size_t j) { return keeps_clear(i, a, b, j, there(j)); });
    if (!clear_of_moved || !leaves_askers_their_way(i, b)) return false;
    std::vector<std::size_t> in_the_way;
    const bool can_ask = before_.all_near(a, b, [&](std::size_t j) {
      if (j == i || state_[j] == State::settled || keeps_clear(i, a, b, j, here(j))) return true;
      in_the_way.push_back(j);
      return state_[j] == State::open && !refused_[j];
    });
    if (!can_ask) return false;
    const std::size_t mark = order_.size();
    if (!in_the_way.empty() && !pushes(i, to, in_the_way, random)) return false;
    for (std::size_t k = mark; k < order_.size(); ++k)
      if (!keeps_clear(i, a, b, order_[k], there(order_[k]))) {
        unsettle_since(mark);
        return false;
      }
    settle(i, to);
    return true;
  }

  /// They move after this one.
  bool leaves_askers_their_way(std::size_t i, Vec2 b) const {
    return std::all_of(askers_.begin(), askers_.end(),
                       [&](std::size_t j) { return keeps_clear(j, here(j), there(j), i, b); });
  }

  bool pushes(std::size_t i, PlaceNumber to, const std::vector<std::size_t>& others, SplitMix64& random) {
    if (askers_.size() >= kLongestChain) return false;
    const std::size_t mark = order_.size();
    next_[i] = to;
    askers_.push_back(i);
    bool all = true;
    for (const std::size_t j : others) {
      if (state_[j] != State::open) continue;  // pushed by another meanwhile
      if (!refused_[j] && moves(j, random, false)) continue;
      refused_[j] = 1;
      all = false;
      break;
    }
    askers_.pop_back();
    next_[i] = kNowhere;
    if (!all) unsettle_since(mark);
    return all;
  }

  const JointProblem& problem_;
  const Roadmap& map_;
  const std::vector<std::vector<float>>& distances_;
  RobotGrid before_, after_;
  const Joint* at_ = nullptr;
  Joint next_, must_go_to_;
  std::vector<State> state_;
  std::vector<char> refused_;
  std::vector<std::size_t> order_, askers_;
  std::size_t calls_ = 0;
};

struct Node {
  Joint at;
  std::size_t parent = 0;          ///< itself: the first
  std::vector<std::size_t> order;  ///< the robots by when they moved on the way here
  std::vector<std::size_t> priority;
  std::vector<double> waited;    ///< steps away from the goal, the more the sooner served
  std::deque<Constraints> open;  ///< to be tried, the least constrained first
};

}  // namespace

struct JointSearch::Data {
  explicit Data(JointProblem p) : problem(std::move(p)), distances(problem.goals.size()) {
    const auto length = [&](PlaceNumber a, PlaceNumber b) { return length_of_way(*problem.map, a, b); };
    for (std::size_t i = 0; i < distances.size() && !problem.asks_to_stop(); ++i)
      distances[i] = distances_to(*problem.map, problem.goals[i], problem.body(i), length);
  }
  /// Not where it was stopped.
  bool is_whole() const {
    return std::none_of(distances.begin(), distances.end(), [](const auto& d) { return d.empty(); });
  }
  bool can_each_alone() const {
    for (std::size_t i = 0; i < problem.starts.size(); ++i)
      if (distances[i][problem.starts[i]] == kFarAway) return false;
    return true;
  }
  /// With lanes; some have none where it was stopped. REQUIRES: can_each_alone().
  const std::vector<std::vector<float>>& lanes() {
    if (in_lanes.empty()) find_lanes();
    return in_lanes;
  }
  void find_lanes() {
    constexpr int kRounds = 2;  // the first robots chose before there was traffic
    in_lanes = distances;
    Traffic traffic(*problem.map);
    const auto cost = [&](PlaceNumber a, PlaceNumber b) { return traffic.cost(a, b); };
    std::vector<std::vector<PlaceNumber>> ways(distances.size());
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t i = 0; i < distances.size(); ++i) {
        if (problem.asks_to_stop()) return;
        traffic.add(ways[i], -1.0);
        in_lanes[i] = distances_to(*problem.map, problem.goals[i], problem.body(i), cost);
        ways[i] = traffic.way_from(problem.starts[i], in_lanes[i]);
        traffic.add(ways[i], 1.0);
      }
  }
  JointProblem problem;
  std::vector<std::vector<float>> distances, in_lanes;
};

namespace {

/// The tree of one search.
class Tree {
 public:
  Tree(const JointProblem& problem, const std::vector<std::vector<float>>& distances)
      : problem_(problem), distances_(distances) {}

  Node& operator[](std::size_t k) { return nodes_[k]; }
  std::size_t size() const { return nodes_.size(); }

  std::size_t find(const Joint& at) const {
    const auto found = known_.find(boost::hash<Joint>()(at));
    if (found != known_.end())
      for (const std::size_t k : found->second)
        if (nodes_[k].at == at) return k;
    return nodes_.size();
  }

  std::size_t add(Joint at, std::size_t parent, std::vector<std::size_t> order) {
    const std::size_t number = nodes_.size(), n = at.size();
    nodes_.emplace_back();
    Node& node = nodes_.back();
    node.parent = parent;
    node.order = std::move(order);
    node.open.emplace_back();
    node.waited.resize(n);
    node.priority.resize(n);
    constexpr double kFarFirst = 1e-4;  // of a step and a diameter: the far ones go before the near
    constexpr double kMostForFar = 0.999;
    for (std::size_t i = 0; i < n; ++i) {
      const double before = number == 0 ? 0.0 : nodes_[parent].waited[i];
      if (number == 0)
        node.waited[i] = std::min(kMostForFar, kFarFirst * distances_[i][at[i]] / (2.0 * problem_.radii[i]));
      else
        node.waited[i] = at[i] == problem_.goals[i] ? before - std::floor(before) : before + 1.0;
      node.priority[i] = i;
    }
    std::stable_sort(node.priority.begin(), node.priority.end(),
                     [&](std::size_t a, std::size_t b) { return node.waited[a] > node.waited[b]; });
    known_[boost::hash<Joint>()(at)].push_back(number);
    node.at = std::move(at);
    return number;
  }

  std::vector<JointMove> moves_to(std::size_t number) const {
    std::vector<std::size_t> way{number};
    while (nodes_[way.back()].parent != way.back()) way.push_back(nodes_[way.back()].parent);
    std::reverse(way.begin(), way.end());
    std::vector<JointMove> moves;
    for (std::size_t k = 1; k < way.size(); ++k) {
      const Node &from = nodes_[way[k - 1]], &to = nodes_[way[k]];
      for (const std::size_t i : to.order)
        if (from.at[i] != to.at[i]) moves.push_back({i, from.at[i], to.at[i]});
    }
    return moves;
  }

 private:
  const JointProblem& problem_;
  const std::vector<std::vector<float>>& distances_;
  std::deque<Node> nodes_;                                           // references stay
  std::unordered_map<std::size_t, std::vector<std::size_t>> known_;  // by their hash
};

/// What else can be constrained: every way of the next robot in order.
void add_constraints(Node& node, const Constraints& so_far, const JointProblem& problem, SplitMix64& random) {
  if (so_far.size() == node.at.size()) return;
  const std::size_t robot = node.priority[so_far.size()];
  std::vector<PlaceNumber> places;
  for (const PlaceNumber p : problem.map->ways(node.at[robot]))
    if (problem.map->room(p) >= problem.body(robot)) places.push_back(p);
  places.push_back(node.at[robot]);
  for (std::size_t k = places.size(); k > 1; --k) std::swap(places[k - 1], places[random.below(k)]);
  for (const PlaceNumber place : places) {
    node.open.push_back(so_far);
    node.open.back().emplace_back(robot, place);
  }
}

}  // namespace

JointSearch::JointSearch(JointProblem problem) : data_(std::make_unique<Data>(std::move(problem))) {}
JointSearch::~JointSearch() = default;

JointAnswer JointSearch::run(std::uint64_t seed, const SearchBudget& budget, GuidedBy guided_by) {
  JointAnswer answer;
  if (!data_->is_whole()) return answer;  // stopped
  if (!data_->can_each_alone()) {
    answer.end = SearchEnd::none_on_map;
    return answer;
  }
  const JointProblem& problem = data_->problem;
  SplitMix64 random(seed);
  const std::vector<std::vector<float>>& distances = guided_by == GuidedBy::lanes ? data_->lanes() : data_->distances;
  Generator generator(problem, distances);
  Tree tree(problem, distances);
  std::vector<std::size_t> open{tree.add(problem.starts, 0, {})};
  answer.end = SearchEnd::none_on_map;
  while (!open.empty()) {
    const std::size_t number = open.back();
    Node& node = tree[number];
    if (node.at == problem.goals) {
      answer.end = SearchEnd::found;
      answer.moves = tree.moves_to(number);
      break;
    }
    if (tree.size() > budget.nodes || generator.calls() > budget.calls || problem.asks_to_stop()) {
      answer.end = SearchEnd::out_of_budget;
      break;
    }
    if (node.open.empty()) {
      open.pop_back();
      continue;
    }
    const Constraints constraints = std::move(node.open.front());
    node.open.pop_front();
    add_constraints(node, constraints, problem, random);
    if (!generator.generate(node.at, node.priority, constraints, random)) continue;
    const std::size_t known = tree.find(generator.next());
    if (known == number) continue;
    open.push_back(known < tree.size() ? known : tree.add(generator.next(), number, generator.order()));
  }
  answer.calls = generator.calls();
  answer.nodes = tree.size();
  return answer;
}

}  // namespace exactvo::formation::detail
