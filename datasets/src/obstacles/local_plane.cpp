// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/local_plane.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gdal/vector_library.h"

namespace exactvo::datasets {
namespace {

/// As MetresToDegrees rounds.
double rounded(double degrees) {
  constexpr double kDecimals = 1e13;
  return std::round(degrees * kDecimals) / kDecimals + 0.0;
}

/// Longitudes of one shape: from each to the next the short way, and all turned such that their middle is within 180.
void keep_together(std::vector<geometry::Vec2>& points) {
  double turn = 0.0, west = 180.0, east = -180.0, before = points.empty() ? 0.0 : points.front().x;
  std::vector<double> turns;
  for (const geometry::Vec2 p : points) {
    if (p.x - before > 180.0) turn -= 360.0;
    if (p.x - before < -180.0) turn += 360.0;
    before = p.x;
    turns.push_back(turn);
    west = turns.size() == 1 ? p.x : std::min(west, p.x + turn);
    east = turns.size() == 1 ? p.x : std::max(east, p.x + turn);
  }
  const double middle = (west + east) / 2;
  const double back = middle > 180.0 ? -360.0 : middle < -180.0 ? 360.0 : 0.0;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (turns[k] + back != 0.0) points[k].x = rounded(points[k].x + turns[k] + back);
}

}  // namespace

MetresToDegrees::MetresToDegrees(LocalPlane plane, std::string file)
    : transform_(vector_library().make_plane_transform(std::move(plane), std::move(file))) {}

std::vector<geometry::Vec2> MetresToDegrees::operator()(std::vector<geometry::Vec2> points) const {
  points = transform_(std::move(points));
  keep_together(points);
  return points;
}

geometry::Vec2 offset_for(geometry::Vec2 low, geometry::Vec2 high) {
  constexpr double kNear = 1e5;  // m; there a plane and the earth differ by 0.04 mm a metre
  const auto offset = [](double from, double to) {
    const double middle = from / 2 + to / 2;
    return std::fabs(middle) <= kNear ? 0.0 : std::round(middle / kNear) * kNear;
  };
  return {offset(low.x, high.x), offset(low.y, high.y)};
}

}  // namespace exactvo::datasets
