// SPDX-License-Identifier: GPL-3.0-or-later
// How long does it take to decide whether agents on straight motions touch each other or edges, at any time, beside a
// loop that samples ten points of each motion?
//
//     bench_motions [AGENTS] [STEPS] [ROUNDS]      by default 1000 agents, 1000 steps: 10^6 motions, 10^4 edges
//
// The scene: 2500 square blocks, turned at random, 4 m from middle to middle. Agents of radius 0.3 m walk round blocks
// on circles of 2 m at 1.1 to 1.5 m/s, 5 cm from the corners, and change to a neighbour's circle where the two touch. A
// step lasts 0.1 s.
//
// Two textbook loops, both with doubles and the hashed grid of the check, adapted: `same boxes` has the grid hold the
// boxes of motions, as the check does, and samples each pair whose boxes meet at ten moments; `grid per sample` has it
// hold positions, ten times a step. Verdicts are compared before anything is timed: whatever a sample finds the check
// must find; what only the check finds is counted as missed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "clouds.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/motion_check.h"
#include "side_by_side.h"

namespace exactvo::bench {
namespace {

using geometry::Box;
using geometry::BoxGrid;
using geometry::MotionEvent;
using geometry::Obstacle;
using geometry::Segment;
using geometry::StraightMotion;
using geometry::Vec2;

constexpr double kRadius = 0.3, kStep = 0.1, kSpacing = 4.0, kCorner = 1.65;  // m, s
constexpr int kBlocksASide = 50;
constexpr int kSamples = 10;

struct Scene {
  std::vector<Obstacle> map;
  std::vector<Segment> edges;
  std::vector<std::size_t> owner;
  std::vector<std::vector<Vec2>> at;  ///< of each step, of each agent
};

/// Neighbouring circles turn in opposite directions, so that an agent can change from one to the other.
Scene scene_of(int agents, int steps) {
  constexpr double kQuarter = 0.5 * geometry::kPi;
  Scene scene;
  Stream stream(7);
  const auto middle = [](int x, int y) { return Vec2{kSpacing * x, kSpacing * y}; };
  for (int y = 0; y < kBlocksASide; ++y)
    for (int x = 0; x < kBlocksASide; ++x) {
      const double turn = kQuarter * stream.uniform();
      geometry::Polygon block;
      for (int k = 0; k < 4; ++k)
        block.outer.push_back(middle(x, y) + geometry::rotated({kCorner, 0.0}, turn + kQuarter * k));
      scene.map.emplace_back(block);
    }
  for (std::size_t k = 0; k < scene.map.size(); ++k)
    for (const Segment& edge : geometry::edges_of(scene.map[k])) {
      scene.edges.push_back(edge);
      scene.owner.push_back(k);
    }
  struct Walker {
    int x, y;               // its block
    double angle, turning;  // rad, rad a step
  };
  const auto below = [&](int n) { return static_cast<int>(stream.uniform() * n); };
  const auto sense = [](int x, int y) { return (x + y) % 2 == 0 ? 1.0 : -1.0; };
  std::vector<Walker> walkers;
  for (int a = 0; a < agents; ++a)
    walkers.push_back({below(kBlocksASide), below(kBlocksASide), 4.0 * kQuarter * stream.uniform(),
                       (1.1 + 0.4 * stream.uniform()) * kStep / (0.5 * kSpacing)});
  for (int k = 0; k <= steps; ++k) {
    std::vector<Vec2> row;
    for (Walker& w : walkers) {
      row.push_back(middle(w.x, w.y) + geometry::rotated({0.5 * kSpacing, 0.0}, w.angle));
      const double before = std::floor(w.angle / kQuarter);
      w.angle += sense(w.x, w.y) * w.turning;
      const double after = std::floor(w.angle / kQuarter);
      if (before == after || below(2) == 0) continue;
      const double passed = kQuarter * std::max(before, after);
      const int x = w.x + static_cast<int>(std::lround(std::cos(passed)));
      const int y = w.y + static_cast<int>(std::lround(std::sin(passed)));
      if (x < 0 || y < 0 || x >= kBlocksASide || y >= kBlocksASide) continue;
      w = {x, y, 2.0 * passed + 2.0 * kQuarter - w.angle, w.turning};
    }
    scene.at.push_back(row);
  }
  return scene;
}

/// body, with an obstacle, other
using Pair = std::tuple<std::size_t, bool, std::size_t>;
using Verdicts = std::set<Pair>;

Verdicts check(const Scene& scene, geometry::MotionCheck& counts) {
  Verdicts found;
  geometry::MotionStream stream(scene.map, {}, [&](const MotionEvent& e) {
    if (e.encounter == geometry::Encounter::overlap) found.insert({e.body, e.with_obstacle, e.other});
  });
  const geometry::RigidBody disc = geometry::disc_body(kRadius);
  for (std::size_t a = 0; a < scene.at[0].size(); ++a) stream.add_body(disc);
  for (std::size_t k = 0; k + 1 < scene.at.size(); ++k)
    for (std::size_t a = 0; a < scene.at[k].size(); ++a)
      stream.add(a, geometry::StraightMotion{{kStep * static_cast<double>(k), scene.at[k][a]},
                                             {kStep * static_cast<double>(k + 1), scene.at[k + 1][a]}});
  counts = stream.finish();
  return found;
}

double squared_distance(Vec2 p, const Segment& s) {
  const Vec2 e = s.b - s.a;
  const double share = std::clamp(dot(p - s.a, e) / squared_norm(e), 0.0, 1.0);
  return squared_norm(p - s.a - share * e);
}

Box grown_box(Vec2 a, Vec2 b) {
  Box box;
  box.add(a);
  box.add(b);
  return box.grown(kRadius);
}

/// Boxes of one moment or one step, hashed by cells of one side.
class Cells {
 public:
  explicit Cells(double side) : per_side_(1.0 / side), lists_(kLists) {}
  void clear() {
    for (const std::size_t list : used_) lists_[list].clear();
    used_.clear();
  }
  template <class Visit>
  void meet_and_add(std::size_t i, const std::vector<Box>& boxes, const Visit& visit) {
    const Box& box = boxes[i];
    const auto [x0, y0] = cell_of(box.low);
    const auto [x1, y1] = cell_of(box.high);
    for (std::int64_t y = y0; y <= y1; ++y)
      for (std::int64_t x = x0; x <= x1; ++x) {
        std::vector<std::size_t>& list = lists_[slot(x, y)];
        for (const std::size_t j : list) {
          const auto [ox, oy] = cell_of(boxes[j].low);
          if (x == std::max(x0, ox) && y == std::max(y0, oy) && meet(boxes[j], box)) visit(j);
        }
        if (list.empty()) used_.push_back(slot(x, y));
        list.push_back(i);
      }
  }

 private:
  static constexpr std::size_t kLists = 4096;
  std::pair<std::int64_t, std::int64_t> cell_of(Vec2 p) const {
    return {static_cast<std::int64_t>(std::floor(p.x * per_side_)),
            static_cast<std::int64_t>(std::floor(p.y * per_side_))};
  }
  static std::size_t slot(std::int64_t x, std::int64_t y) {
    const auto mixed =
        static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL;
    return static_cast<std::size_t>(mixed ^ (mixed >> 29)) % kLists;
  }
  double per_side_;
  std::vector<std::vector<std::size_t>> lists_;
  std::vector<std::size_t> used_;
};

BoxGrid grid_of(const std::vector<Segment>& edges) {
  std::vector<Box> boxes;
  for (const Segment& edge : edges) {
    Box box;
    box.add(edge.a);
    box.add(edge.b);
    boxes.push_back(box);
  }
  return BoxGrid(std::move(boxes));
}

/// Looks for pairs by the boxes of their motions in each step, and takes this number of samples of each pair that it
/// finds. With none it does what any check by these boxes has to do.
Verdicts sampled_with_same_boxes(const Scene& scene, int samples) {
  Verdicts found;
  const BoxGrid edges = grid_of(scene.edges);
  Cells cells(1.5);
  std::vector<Box> boxes(scene.at[0].size());
  for (std::size_t k = 0; k + 1 < scene.at.size(); ++k) {
    const std::vector<Vec2>&from = scene.at[k], &to = scene.at[k + 1];
    cells.clear();
    for (std::size_t a = 0; a < from.size(); ++a) {
      boxes[a] = grown_box(from[a], to[a]);
      const auto place = [&](std::size_t i, int s) { return from[i] + (s / double(kSamples)) * (to[i] - from[i]); };
      edges.for_each_meeting(boxes[a], [&](std::size_t e) {
        for (int s = 0; s < samples; ++s)
          if (squared_distance(place(a, s), scene.edges[e]) < kRadius * kRadius) {
            found.insert({a, true, scene.owner[e]});
            break;
          }
      });
      cells.meet_and_add(a, boxes, [&](std::size_t b) {
        for (int s = 0; s < samples; ++s)
          if (squared_norm(place(a, s) - place(b, s)) < 4.0 * kRadius * kRadius) {
            found.insert({std::min(a, b), false, std::max(a, b)});
            break;
          }
      });
    }
  }
  return found;
}

/// Positions ten times a step, each time with a grid of their own.
Verdicts sampled_with_a_grid_a_sample(const Scene& scene) {
  Verdicts found;
  const BoxGrid edges = grid_of(scene.edges);
  Cells cells(1.5);
  std::vector<Box> boxes(scene.at[0].size());
  std::vector<Vec2> at(scene.at[0].size());
  for (std::size_t k = 0; k + 1 < scene.at.size(); ++k)
    for (int s = 0; s < kSamples; ++s) {
      cells.clear();
      for (std::size_t a = 0; a < at.size(); ++a) {
        at[a] = scene.at[k][a] + (s / double(kSamples)) * (scene.at[k + 1][a] - scene.at[k][a]);
        boxes[a] = grown_box(at[a], at[a]);
        edges.for_each_meeting(boxes[a], [&](std::size_t e) {
          if (squared_distance(at[a], scene.edges[e]) < kRadius * kRadius) found.insert({a, true, scene.owner[e]});
        });
        cells.meet_and_add(a, boxes, [&](std::size_t b) {
          if (squared_norm(at[a] - at[b]) < 4.0 * kRadius * kRadius)
            found.insert({std::min(a, b), false, std::max(a, b)});
        });
      }
    }
  return found;
}

bool holds_all(const Verdicts& all, const Verdicts& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

int run(int agents, int steps, int rounds) {
  const Scene scene = scene_of(agents, steps);
  geometry::MotionCheck counts;
  const Verdicts exact = check(scene, counts), boxes = sampled_with_same_boxes(scene, kSamples),
                 grids = sampled_with_a_grid_a_sample(scene);
  std::printf("%zu motions of %d agents, %zu edges; %zu pairs of boxes, %zu of boxes and edges, %zu examined\n",
              counts.pieces, agents, scene.edges.size(), counts.pairs, counts.edge_pairs, counts.examined);
  std::printf("pairs that overlap: %zu; sampling finds %zu and %zu of them\n", exact.size(), boxes.size(),
              grids.size());
  if (!holds_all(exact, boxes) || !holds_all(exact, grids)) {
    std::printf("a sample found an overlap that the check did not\n");
    return 1;
  }
  std::vector<double> ours, same, each, alone;
  for (int round = 0; round < rounds; ++round) {
    const auto timed = [](const auto& work) {
      const double start = thread_seconds();
      benchmark::DoNotOptimize(work());
      return thread_seconds() - start;
    };
    ours.push_back(timed([&] { return check(scene, counts).size(); }));
    same.push_back(timed([&] { return sampled_with_same_boxes(scene, kSamples).size(); }));
    alone.push_back(timed([&] { return sampled_with_same_boxes(scene, 0).size(); }));
    each.push_back(timed([&] { return sampled_with_a_grid_a_sample(scene).size(); }));
  }
  const double own = median(ours), boxed = median(same), gridded = median(each);
  std::printf(
      "check: %.3f s; ten samples: %.3f s with the same boxes (%.2f times), %.3f s with a grid per sample (%.2f "
      "times)\n",
      own, boxed, boxed / own, gridded, gridded / own);
  const double boxes_alone = median(alone);
  std::printf("boxes alone: %.3f s; the loops take %.2f and %.2f times as long\n", boxes_alone, boxed / boxes_alone,
              gridded / boxes_alone);
  return 0;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  const auto number = [&](int k, int otherwise) { return argc > k ? std::max(1, std::atoi(argv[k])) : otherwise; };
  return exactvo::bench::run(number(1, 1000), number(2, 1000), number(3, 5));
}
