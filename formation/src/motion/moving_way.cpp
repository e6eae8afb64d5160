// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/moving_way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "motion/speed_stretches.h"

namespace exactvo::formation::detail {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

// How far WayPiece::at is off, in units of u D, u = 2^-53, D the distance covered plus the length of the path so far
// plus the coordinates; to first order.
//
// A stretch's distance t (v + r t / 2), r = (v' - v) / t': t and r carry 3 u, their products 3 u more, the sum cancels
// at most its own terms, which are at most twice the distance: 16 u of it. A leg's length (hypot of two differences)
// carries 3 u, its direction 5 u in each entry. Both sums are compensated: 2 u of the sum. offset is their difference,
// `along` one sum more, the vertex two differences: 8 u in all. 16 + 3 + 2 * 2 + 5 sqrt(2) + 8 < 40; 64 leaves room for
// the terms of second order.
//
// At a corner the computed time is off, which `along` shows: below 0 at a piece's start or beyond the leg at its end.
// That much of the true way lies on the other leg, and no farther from the vertex than the piece: twice that.
constexpr double kRoundingOfWay = 64 * 0x1p-53;

/// A sum whose error is 2 u of the sum of magnitudes, however many terms (Neumaier).
class CompensatedSum {
 public:
  void add(double x) {
    const double sum = sum_ + x;
    rest_ += std::fabs(sum_) >= std::fabs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + rest_; }
  /// this - other, without rounding both first.
  double minus(const CompensatedSum& other) const { return (sum_ - other.sum_) + (rest_ - other.rest_); }

 private:
  double sum_ = 0.0, rest_ = 0.0;
};

/// Walks the stretches of speed along the legs of the path.
class Walk {
 public:
  Walk(const TimedPath& motion, double end) : path_(motion.path), end_(end) {
    for (Vec2 p : path_) largest_ = std::max({largest_, std::fabs(p.x), std::fabs(p.y)});
    skip_empty_legs();
    const auto take = [this](const SpeedStretch& s) { return follow(s); };
    if (motion.profile.empty()) {
      take({0.0, kForever, motion.speed, 0.0});
    } else {
      for_each_stretch(motion.profile, take);
    }
  }

  std::vector<WayPiece> pieces() && { return std::move(pieces_); }

 private:
  bool at_end() const { return leg_ + 1 >= path_.size(); }
  Vec2 step_of_leg() const { return path_[leg_ + 1] - path_[leg_]; }

  void skip_empty_legs() {
    while (!at_end() && step_of_leg() == Vec2{}) ++leg_;
  }

  /// Whether no more is wanted.
  bool follow(const SpeedStretch& s) {
    double time = pieces_.empty() ? s.start : std::max(s.start, pieces_.back().to);
    while (!at_end()) {
      const double length = std::hypot(step_of_leg().x, step_of_leg().y);
      const double left = length - covered_.minus(before_);
      const double reached = time_to_go(s, left);
      const double until = std::max(time, s.start + std::min(reached, s.duration));
      append(s, time, until, length);
      time = until;
      if (time > end_) return true;
      if (!(reached <= s.duration)) {
        covered_.add(s.distance(s.duration));
        return false;
      }
      before_.add(length);
      ++leg_;
      skip_empty_legs();
    }
    append({time, kForever, 0.0, 0.0}, time, kForever, 0.0);
    return true;
  }

  /// s into the stretch, when it has gone `left` (m); infinite where it does not.
  static double time_to_go(const SpeedStretch& s, double left) {
    if (!(left > 0.0)) return 0.0;
    if (std::isfinite(s.duration) && s.distance(s.duration) < left) return kForever;
    const double root = std::sqrt(std::max(0.0, s.speed * s.speed + 2.0 * s.rate * left));
    return s.speed + root > 0.0 ? std::min(2.0 * left / (s.speed + root), s.duration) : kForever;
  }

  void append(const SpeedStretch& s, double from, double until, double length) {
    const Vec2 direction = length > 0.0 ? step_of_leg() / length : Vec2{};
    WayPiece piece{
        from, until, path_[leg_] - path_.front(), direction, s.start, covered_.minus(before_), s.speed, s.rate,
        0.0,  length};
    piece.error = kRoundingOfWay * (covered_.value() + before_.value() + length + 2.0 * largest_) + mismatch(piece);
    if (length > 0.0 && std::isfinite(until)) short_of_end_ = std::max(0.0, length - piece.along(until));
    pieces_.push_back(piece);
  }

  /// m: what rounding of the times at which a piece begins and ends is worth.
  double mismatch(const WayPiece& p) const {
    if (!(p.length > 0.0)) return short_of_end_;
    const double early = std::max(0.0, -p.along(p.from));
    const double late = std::isfinite(p.to) ? std::max(0.0, p.along(p.to) - p.length) : 0.0;
    return 2.0 * (early + late);
  }

  const std::vector<Vec2>& path_;
  double end_;
  double largest_ = 0.0;
  std::size_t leg_ = 0;
  CompensatedSum covered_;     ///< m, at the start of the stretch
  CompensatedSum before_;      ///< m, the length of the legs before this one
  double short_of_end_ = 0.0;  ///< m, that the last piece on a leg ended before its end
  std::vector<WayPiece> pieces_;
};

}  // namespace

double WayPiece::speed_bound(double until) const {
  if (direction == Vec2{}) return 0.0;
  return std::max(std::fabs(speed + rate * (from - origin)), std::fabs(speed + rate * (until - origin)));
}

std::vector<WayPiece> way_of(const TimedPath& motion, double end) {
  return Walk(motion, end).pieces();
}

std::size_t piece_at(const std::vector<WayPiece>& way, double time) {
  const auto found =
      std::upper_bound(way.begin(), way.end(), time, [](double t, const WayPiece& piece) { return t < piece.to; });
  return static_cast<std::size_t>(found - way.begin());
}

}  // namespace exactvo::formation::detail
