// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/degree_box.h"

#include <algorithm>

namespace exactvo::datasets {
namespace {

constexpr std::size_t kBins = 3600;
constexpr double kBinsADegree = 10.0;

double west_of_bin(std::size_t bin) {
  return static_cast<double>(bin) / kBinsADegree - 180.0;
}

}  // namespace

std::size_t DegreeBox::bin_of(double longitude) {
  const double bin = (longitude + 180.0) * kBinsADegree;
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(kBins - 1)));
}

void DegreeBox::cover(double west, double east) {
  if (bins_.empty()) bins_.assign(kBins, {1.0, -1.0});
  const std::size_t first = bin_of(west), last = bin_of(east);
  for (std::size_t k = first; k <= last; ++k) {
    const Interval part{k == first ? west : west_of_bin(k), k == last ? east : west_of_bin(k + 1)};
    Interval& covered = bins_[k];
    const bool is_new = covered.west > covered.east;
    covered = is_new ? part : Interval{std::min(covered.west, part.west), std::max(covered.east, part.east)};
  }
}

void DegreeBox::add(const geometry::Ring& ring) {
  geometry::Box box;
  for (const geometry::Vec2 p : ring)
    if (geometry::is_finite(p)) box.add(p);
  if (box.is_empty()) return;
  numbers_.add(box);
  cover(box.low.x, box.high.x);
}

void DegreeBox::add(geometry::Vec2 place) {
  numbers_.add(place);
  cover(place.x, place.x);
}

geometry::Box DegreeBox::on_circle() const {
  geometry::Box box = numbers_;
  double widest = box.low.x + 360.0 - box.high.x;  // the gap that the antimeridian lies in
  const Interval* before = nullptr;
  for (const Interval& covered : bins_) {
    if (covered.west > covered.east) continue;
    if (before != nullptr && covered.west - before->east > widest) {
      widest = covered.west - before->east;
      box.low.x = covered.west;
      box.high.x = before->east + 360.0;
    }
    before = &covered;
  }
  return box;
}

geometry::Vec2 DegreeBox::middle() const {
  const geometry::Box box = on_circle();
  geometry::Vec2 middle{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
  const bool is_round_a_pole = box.high.x - box.low.x > 180.0 && (box.low.y > 0.0 || box.high.y < 0.0);
  if (is_round_a_pole) middle = {0.0, box.low.y > 0.0 ? 90.0 : -90.0};
  if (middle.x > 180.0) middle.x -= 360.0;
  return middle;
}

}  // namespace exactvo::datasets
