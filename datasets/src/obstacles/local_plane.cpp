// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/local_plane.h"

#include <cmath>
#include <utility>

#include "gdal/vector_library.h"

namespace exactvo::datasets {

MetresToDegrees::MetresToDegrees(LocalPlane plane, std::string file)
    : transform_(vector_library().make_plane_transform(std::move(plane), std::move(file))) {}

std::vector<geometry::Vec2> MetresToDegrees::operator()(std::vector<geometry::Vec2> points) const {
  return transform_(std::move(points));
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
