// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/label_places.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/pi.h"

namespace exactvo::tools {

namespace {

using geometry::kPi;
/// px: half of what six characters in 10 points take.
constexpr double kHalfWidth = 22.0;
constexpr double kHalfHeight = 8.0;
/// px between points of a curve: less than a label's height.
constexpr double kSpacing = 4.0;
/// px: nobody takes a line this far off for the label's.
constexpr double kEnough = 5.0;

}  // namespace

void LabelPlaces::keep_off(const Points& curve, bool closed) {
  if (curve.size() == 1) lines_.push_back(curve.front());
  for (std::size_t i = 0; i + (closed ? 0 : 1) < curve.size(); ++i) {
    const Vec2 a = curve[i], b = curve[(i + 1) % curve.size()];
    const int count = static_cast<int>(std::clamp(norm(b - a) * scale_ / kSpacing, 1.0, 1000.0));
    for (int k = 0; k <= count; ++k) lines_.push_back(a + (static_cast<double>(k) / count) * (b - a));
  }
}

/// px: how far the nearest line or label is from the box of a label round `p`; negative outside the view.
double LabelPlaces::room_round(Vec2 p) const {
  if (!view_.grown(-kHalfWidth / scale_).contains(p)) return -1.0;
  double room = 1e9;
  const auto beside = [&](Vec2 q, double width, double height) {
    const double x = std::max(0.0, scale_ * std::fabs(q.x - p.x) - width);
    const double y = std::max(0.0, scale_ * std::fabs(q.y - p.y) - height);
    room = std::min(room, std::max(x, y));
  };
  for (const Vec2 q : lines_) beside(q, kHalfWidth, kHalfHeight);
  for (const Vec2 q : labels_) beside(q, 2.0 * kHalfWidth, 2.0 * kHalfHeight);
  return room;
}

/// The first with room enough, else the one with the most.
std::optional<Vec2> LabelPlaces::best_of(const Points& places, bool must) {
  Vec2 best = places.front();
  double most = -2.0;
  for (const Vec2 place : places) {
    const double room = most >= kEnough ? -2.0 : room_round(place);
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
      const double angle = 0.25 * kPi * turn, away = radius + out / scale_;
      places.push_back(p + Vec2{1.2 * away * std::cos(angle), away * std::sin(angle)});
    }
  }
  return best_of(places, must);
}

std::optional<Vec2> LabelPlaces::place_at_side(Vec2 p, double half_width, bool must) {
  const double away = half_width + (kHalfWidth + kEnough + 1.0) / scale_;
  const double below = 2.0 * kHalfHeight / scale_;
  return best_of({p + Vec2{away, 0.0}, p - Vec2{away, 0.0}, p + Vec2{0.0, below}, p - Vec2{0.0, below}}, must);
}

}  // namespace exactvo::tools
