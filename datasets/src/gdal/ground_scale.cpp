// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/ground_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace exactvo::datasets {
namespace {

constexpr double kRadian = 3.14159265358979323846 / 180.0;

/// The lengths that a metre on the ground may have on the plane, and a square metre's area there.
struct LocalScale {
  double least = 1.0;
  double greatest = 1.0;
  double area = 1.0;
};

/// Singular values of the matrix with these columns: what a metre to the east and one to the north become.
LocalScale scale_of(geometry::Vec2 east, geometry::Vec2 north) {
  const double sum = dot(east, east) + dot(north, north);
  const double area = std::fabs(cross(east, north));
  const double root = std::sqrt(std::max(0.0, sum * sum - 4 * area * area));
  const double greatest = std::sqrt((sum + root) / 2);
  return {greatest > 0.0 ? area / greatest : 0.0, greatest, area};
}

/// The radii of the ellipsoid at a latitude, m: along the meridian, and of the parallel.
struct Radii {
  double meridian;
  double parallel;
};

Radii radii_at(double latitude, double a, double b) {
  const double sine = std::sin(latitude * kRadian), cosine = std::cos(latitude * kRadian);
  const double e2 = 1.0 - (b / a) * (b / a);
  const double w = std::sqrt(1.0 - e2 * sine * sine);
  return {a * (1.0 - e2) / (w * w * w), a / w * cosine};
}

}  // namespace

Distortion distortion_round_centre(double r, double b) {
  constexpr double kRoundedUp = 1.0 + 1e-9;
  const double x = r / b;
  // x / sin x - 1 = x^2/6 + 7x^4/360 + ... <= x^2/6 (1 + 0.12 x^2) for x <= 1/2.
  const double excess = x * x / 6 * (1.0 + 0.12 * x * x) * kRoundedUp;
  return {excess, excess, true};
}

Distortion measured_distortion(OGRCoordinateTransformation& to_units, const OGRSpatialReference& geographic,
                               double metres_a_unit, const std::vector<geometry::Vec2>& places) {
  constexpr double kStep = 50.0;           // m, to either side
  constexpr double kFarthestNorth = 89.9;  // where parallels are still longer than the steps
  const double a = geographic.GetSemiMajor(), b = geographic.GetSemiMinor();
  LocalScale all{std::numeric_limits<double>::infinity(), 0.0, 1.0};
  double least_area = std::numeric_limits<double>::infinity(), greatest_area = 0.0;
  for (const geometry::Vec2 place : places) {
    const double latitude = std::clamp(place.y, -kFarthestNorth, kFarthestNorth);
    const Radii radii = radii_at(latitude, a, b);
    const double to_east = kStep / radii.parallel / kRadian, to_north = kStep / radii.meridian / kRadian;
    double x[] = {place.x - to_east, place.x + to_east, place.x, place.x};
    double y[] = {latitude, latitude, latitude - to_north, latitude + to_north};
    int worked[4] = {};
    to_units.Transform(4, x, y, nullptr, worked);
    const double factor = metres_a_unit / (2 * kStep);
    const geometry::Vec2 east = factor * geometry::Vec2{x[1] - x[0], y[1] - y[0]};
    const geometry::Vec2 north = factor * geometry::Vec2{x[3] - x[2], y[3] - y[2]};
    const bool all_worked = std::all_of(std::begin(worked), std::end(worked), [](int flag) { return flag != 0; });
    if (!all_worked || !geometry::is_finite(east) || !geometry::is_finite(north))
      return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), false};
    const LocalScale here = scale_of(east, north);
    all.least = std::min(all.least, here.least);
    all.greatest = std::max(all.greatest, here.greatest);
    least_area = std::min(least_area, here.area);
    greatest_area = std::max(greatest_area, here.area);
  }
  // Scales are smooth: between places a sixteenth of the extent apart they exceed those there by less than a hundredth
  // of their range.
  constexpr double kBetween = 0.01;
  const auto farthest_from_one = [](double low, double high) {
    return std::max(std::fabs(low - 1.0), std::fabs(high - 1.0)) + kBetween * (high - low);
  };
  return {farthest_from_one(all.least, all.greatest), farthest_from_one(least_area, greatest_area), false};
}

std::string percent_text(double share) {
  if (!(share > 0.0)) return "0 %";
  const double percent = 100.0 * share;
  const double unit = std::pow(10.0, std::floor(std::log10(percent)) - 1.0);
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", std::ceil(percent / unit * (1.0 - 1e-12)) * unit);
  return text;
}

std::string words_of(const Distortion& distortion) {
  if (distortion.certified)
    return "lengths and areas are at most " + percent_text(distortion.length) + " larger than on the ground";
  return "lengths differ by at most " + percent_text(distortion.length) + " from those on the ground, areas by " +
         percent_text(distortion.area) + ": measured at 289 places of the extent";
}

}  // namespace exactvo::datasets
