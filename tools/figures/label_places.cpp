// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/label_places.h"

#include <algorithm>

#include "exactvo/geometry/pi.h"

namespace exactvo::tools {

namespace {

/// px: half of what six characters in 10 points take.
constexpr double kHalfWidth = 22.0;
constexpr double kHalfHeight = 8.0;
/// px between points of a curve: less than a label's height.
constexpr double kSpacing = 4.0;
/// px: a line this far off is not taken for the label's.
constexpr double kEnough = 5.0;
/// px: of the cells by which points are looked up, about what a label needs.
constexpr double kCellWidth = 32.0, kCellHeight = 16.0;

}  // namespace

LabelPlaces::LabelPlaces(const Box& view, double scale)
    : view_(view),
      scale_(scale),
      columns_(cell_of(scale * view.width(), kCellWidth) + 1),
      rows_(cell_of(scale * view.height(), kCellHeight) + 1),
      lines_(static_cast<std::size_t>(columns_ * rows_)) {}

/// A label lies within the view, so that lines farther outside than a cell are never near it.
void LabelPlaces::add_point(Vec2 p) {
  const Vec2 px = scale_ * (p - view_.low);
  if (!(px.x > -kCellWidth && px.y > -kCellHeight && px.x < kCellWidth * static_cast<double>(columns_ + 1) &&
        px.y < kCellHeight * static_cast<double>(rows_ + 1)))
    return;
  const long column = std::clamp(cell_of(px.x, kCellWidth), 0L, columns_ - 1);
  const long row = std::clamp(cell_of(px.y, kCellHeight), 0L, rows_ - 1);
  lines_[static_cast<std::size_t>(row * columns_ + column)].push_back(p);
}

void LabelPlaces::keep_off(const Points& curve, bool closed) {
  if (curve.size() == 1) add_point(curve.front());
  for (std::size_t i = 0; i + (closed ? 0 : 1) < curve.size(); ++i) {
    const Vec2 a = curve[i], b = curve[(i + 1) % curve.size()];
    const int count = static_cast<int>(std::clamp(norm(b - a) * scale_ / kSpacing, 1.0, 1000.0));
    for (int k = 0; k <= count; ++k) add_point(a + (static_cast<double>(k) / count) * (b - a));
  }
}

/// px: how far the nearest line or label is from the box of a label round `p`, kEnough at most; negative outside the
/// view. Any number up to `floor` where it is not more than that.
double LabelPlaces::room_round(Vec2 p, double floor) const {
  if (!view_.grown(-kHalfWidth / scale_).contains(p)) return -1.0;
  double room = kEnough;
  const auto beside = [&](Vec2 q, double width, double height) {
    const double x = std::max(0.0, scale_ * std::fabs(q.x - p.x) - width);
    const double y = std::max(0.0, scale_ * std::fabs(q.y - p.y) - height);
    room = std::min(room, std::max(x, y));
  };
  for (const Vec2 q : labels_) beside(q, 2.0 * kHalfWidth, 2.0 * kHalfHeight);
  const Vec2 px = scale_ * (p - view_.low), reach{kHalfWidth + kEnough, kHalfHeight + kEnough};
  const auto column = [&](double x) { return std::clamp(cell_of(x, kCellWidth), 0L, columns_ - 1); };
  const auto row = [&](double y) { return std::clamp(cell_of(y, kCellHeight), 0L, rows_ - 1); };
  for (long r = row(px.y - reach.y); r <= row(px.y + reach.y); ++r)
    for (long c = column(px.x - reach.x); c <= column(px.x + reach.x); ++c)
      for (const Vec2 q : lines_[static_cast<std::size_t>(r * columns_ + c)]) {
        beside(q, kHalfWidth, kHalfHeight);
        if (room <= floor) return room;
      }
  return room;
}

/// The first with room enough, else the one with the most.
std::optional<Vec2> LabelPlaces::best_of(const Points& places, bool must) {
  Vec2 best = places.front();
  double most = -2.0;
  for (const Vec2 place : places) {
    const double room = most >= kEnough ? -2.0 : room_round(place, most);
    if (room <= most) continue;
    best = place;
    most = room;
  }
  if (!must && most <= 0.0) return std::nullopt;
  labels_.push_back(best);
  return best;
}

std::optional<Vec2> LabelPlaces::place_beside(Vec2 p, double radius, bool must) {
  Points places;
  for (const double out : {18.0, 30.0, 44.0}) {
    if (out > 30.0 && !must) break;  // so far off a time seems to be another robot's
    for (const int turn : {1, 7, 3, 5, 0, 4, 2, 6}) {
      const double angle = 0.25 * geometry::kPi * turn, away = radius + out / scale_;
      places.push_back(p + Vec2{1.2 * away * std::cos(angle), away * std::sin(angle)});
    }
  }
  return best_of(places, must);
}

std::optional<Vec2> LabelPlaces::place_at_side(Vec2 p, Vec2 half, bool must) {
  const Vec2 label{(kHalfWidth + kEnough + 1.0) / scale_, (kHalfHeight + kEnough + 1.0) / scale_};
  const double inside = 2.0 * kHalfHeight / scale_;
  Points places;
  for (const double round : {0.71, 1.0})  // at a corner that is round, and at one that is none
    for (const double x : {1.0, -1.0}) {
      if (round < 1.0) places.push_back(p + Vec2{x * (half.x + label.x), 0.0});
      for (const double y : {1.0, -1.0})
        places.push_back(p + Vec2{x * (round * half.x + label.x), y * (round * half.y + label.y)});
    }
  for (const double y : {half.y + label.y, -half.y - label.y, inside, -inside}) places.push_back(p + Vec2{0.0, y});
  return best_of(places, must);
}

}  // namespace exactvo::tools
