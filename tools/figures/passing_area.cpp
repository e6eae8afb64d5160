// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/passing_area.h"

#include <algorithm>
#include <cstddef>

#include "exactvo/formation/passing.h"

namespace exactvo::tools {
namespace {

bool all_arrived(const datasets::RecordingFile& run) {
  const std::vector<formation::RobotStep>& last = run.recording.steps.back().robots;
  return std::all_of(last.begin(), last.end(),
                     [](const formation::RobotStep& r) { return r.mode == formation::Mode::arrived; });
}

}  // namespace

std::vector<Points> passing_area(const datasets::RecordingFile& run) {
  if (run.recording.steps.empty() || all_arrived(run)) return {};
  const std::vector<formation::NoPassing> proofs = formation::robots_without_passing(run.scenario);
  if (proofs.empty()) return {};
  const double side = proofs[0].side;
  std::vector<geometry::Vec2> corners = proofs[0].squares;
  std::sort(corners.begin(), corners.end(),
            [](geometry::Vec2 a, geometry::Vec2 b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  std::vector<Points> rectangles;  // squares side by side are one
  for (std::size_t from = 0, to = 0; from < corners.size(); from = to) {
    for (to = from + 1;
         to < corners.size() && corners[to].y == corners[from].y && corners[to].x == corners[to - 1].x + side;)
      ++to;
    const geometry::Vec2 low = corners[from], high{corners[to - 1].x + side, low.y + side};
    rectangles.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
  }
  return rectangles;
}

}  // namespace exactvo::tools
