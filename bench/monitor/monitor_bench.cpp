// SPDX-License-Identifier: GPL-3.0-or-later
// What a decision of the monitor costs among 200 edges, for a footprint of four corners; and how many of the commands
// that it cuts the textbook's loop lets pass, which looks at ten poses of the way. Processor time of one thread.
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "exactvo/formation/monitor.h"

namespace {

using namespace exactvo::formation;
using exactvo::geometry::Pose;
using exactvo::geometry::Segment;
using exactvo::geometry::Vec2;

constexpr int kEdges = 200, kCommands = 4000, kSamples = 10;

double microseconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

struct Question {
  Pose pose;
  Command command;
};

/// Edges of 0.1 m within `half` m, none of them in the robot.
std::vector<Segment> edges_within(double half, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Segment> edges;
  while (edges.size() < kEdges) {
    const Vec2 a{half * unit(random), half * unit(random)};
    const Vec2 b = a + Vec2{0.07 * unit(random), 0.07 * unit(random)};
    if (norm(a) > 0.8) edges.push_back({a, b});
  }
  return edges;
}

bool crosses(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return cross(b - a, c - a) * cross(b - a, d - a) <= 0.0 && cross(d - c, a - c) * cross(d - c, b - c) <= 0.0;
}

/// Whether ten poses of the whole way, braking included, are clear of the edges.
bool passes_by_samples(const Question& q, const MonitorSetup& setup, const std::vector<Segment>& edges) {
  const auto& twist = q.command.twist;
  const double brake =
      std::max(norm(twist.velocity) / setup.max_deceleration, std::fabs(twist.turn) / setup.max_turn_deceleration);
  const double length = setup.period + setup.latency + 0.5 * brake;
  for (int k = 1; k <= kSamples; ++k) {
    const Pose at = pose_after(q.pose, twist, length * k / kSamples);
    std::array<Vec2, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
      corners[i] = at.at + exactvo::geometry::rotated(setup.footprint[0].corners[i], at.heading);
    for (const Segment& e : edges) {
      bool is_inside = true;
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % 4];
        if (crosses(a, b, e.a, e.b)) return false;
        is_inside = is_inside && cross(b - a, e.a - a) > 0.0;
      }
      if (is_inside) return false;
    }
  }
  return true;
}

}  // namespace

int main() {
  std::printf("%d edges, %d commands of up to 1.5 m/s and 2 rad/s, held 0.2 s, then braking\n", kEdges, kCommands);
  for (const double half : {1.5, 3.0, 6.0}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const std::vector<Segment> edges = edges_within(half, random);
    MonitorSetup setup;
    setup.footprint = {{{{-0.3, -0.2}, {0.5, -0.2}, {0.5, 0.2}, {-0.3, 0.2}}, 0.0}};
    for (const Segment& e : edges) setup.obstacles.push_back({"", exactvo::geometry::Polyline{{e.a, e.b}}});
    std::vector<Question> questions;
    for (int k = 0; k < kCommands; ++k)
      questions.push_back({{{0.1 * unit(random), 0.1 * unit(random)}, 3.0 * unit(random)},
                           {{{1.5 * unit(random), 0.0}, 2.0 * unit(random)}, false}});
    std::vector<Mover> movers;
    for (int k = 0; k < 10; ++k) movers.push_back({{{{3.0 * unit(random), 3.0 * unit(random)}}, 0.3}, 1.0, 0.05});
    Monitor monitor(setup);
    std::vector<MonitorVerdict> verdicts;
    double start = microseconds();
    for (const Question& q : questions) verdicts.push_back(monitor.judge(q.pose, q.command));
    const double alone = (microseconds() - start) / kCommands;
    start = microseconds();
    double sum = 0.0;
    for (const Question& q : questions) sum += monitor.judge(q.pose, q.command, movers).share;
    const double with_movers = (microseconds() - start) / kCommands;
    std::vector<bool> passed;
    start = microseconds();
    for (const Question& q : questions) passed.push_back(passes_by_samples(q, setup, edges));
    const double sampled = (microseconds() - start) / kCommands;
    int cut = 0, missed = 0;
    for (std::size_t k = 0; k < verdicts.size(); ++k) {
      const bool is_cut = verdicts[k].share < 1.0;
      if (!is_cut && !passed[k]) {
        std::printf("command %zu: cut by samples alone\n", k);
        return EXIT_FAILURE;
      }
      cut += is_cut;
      missed += is_cut && passed[k];
    }
    std::printf(
        "within %.1f m: %.1f us a decision, %.1f us beside ten movers; %.1f us for ten samples, which say only\n"
        "  yes or no; %d commands cut, of which samples let %d pass\n",
        half, alone, with_movers, sampled, cut, missed);
    if (!(sum > 0.0)) return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
