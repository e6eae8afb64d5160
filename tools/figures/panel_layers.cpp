// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/panel_layers.h"

#include <algorithm>
#include <variant>

#include "exactvo/formation/speed_profile.h"
#include "figures/paths_figure.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::Step;

namespace {

constexpr std::size_t kTimeMarks = 6;
/// m: what is so far beyond the view leaves the picture anyway; larger numbers would only upset gnuplot.
constexpr double kFarAway = 1e6;

}  // namespace

PanelLayers::PanelLayers(const RecordingFile& shown, const Box& box, DataFile& file, bool with_details)
    : run(shown), data(file), detailed(with_details), view(box), origin(box) {
  origin.prepare(data);
}

bool PanelLayers::is_drawable(Vec2 p) const {
  return is_finite(p) && view.grown(kFarAway).contains(p);
}

double scale_of(const Box& view) {
  return std::min(760.0 / view.width(), 620.0 / view.height());
}

std::vector<const Step*> time_marks(const RecordingFile& run) {
  std::vector<const Step*> marks;
  const double end = end_of_motion(run);
  for (const Step& step : run.recording.steps) {
    const double due = end * static_cast<double>(marks.size()) / (kTimeMarks - 1);
    if (marks.size() < kTimeMarks && step.time >= due) marks.push_back(&step);
  }
  return marks;
}

Points vertices_at(const formation::MovingObstacle& obstacle, double time) {
  Points points = vertices_of(obstacle.shape);
  for (Vec2& p : points) p += displacement_at(obstacle, time);
  return points;
}

Vec2 middle_at(const formation::MovingObstacle& obstacle, double time) {
  const Points points = vertices_at(obstacle, time);
  Vec2 middle{};
  for (const Vec2 p : points) middle += p / static_cast<double>(points.size());
  return middle;
}

void add_ellipses(const RecordingFile& run, const formation::Outlook& outlook, std::vector<Points>& rings) {
  for (const std::size_t body : outlook.bodies) {
    const geometry::ConvexShape& shape = run.recording.bodies[body].shape;
    if (std::holds_alternative<geometry::Ellipse>(shape)) rings.push_back(outline(shape));
  }
}

}  // namespace exactvo::tools
