// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// `fit_trap_free` written down plainly: every candidate is asked in full, one after the other, and nothing is
/// remembered. The oracle of what the library rules out by bounds and estimates.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::test {

using geometry::Ellipse;
using geometry::Vec2;

class PlainFit {
 public:
  PlainFit(const std::vector<Vec2>& points, double radius, Vec2 start, Vec2 goal,
           const geometry::EnclosureOptions& options)
      : hull_(geometry::convex_hull(points).vertices), radius_(radius), start_(start), goal_(goal), options_(options) {
    for (const Vec2 p : hull_) points_.push_back(p - hull_.front());
    for (const Vec2 p : points_) size_ = std::max(size_, norm(p - points_.front()));
    size_ = std::max(size_, 0.1);
  }

  std::optional<geometry::FittedEllipse> run() {
    using geometry::EnclosureGrade;
    const double r = radius_ + options_.margin;
    double twice_area = 0.0, perimeter = 0.0;
    for (std::size_t i = 0; i < hull_.size(); ++i) {
      const Vec2 a = hull_[i], b = hull_[(i + 1) % hull_.size()];
      twice_area += cross(a - hull_[0], b - hull_[0]);
      perimeter += norm(b - a);
    }
    most_ = options_.most_inflation * (0.5 * twice_area + perimeter * r + geometry::kPi * r * r) / geometry::kPi;
    if (auto e = fit(options_.margin, options_.slack)) return {{*e, EnclosureGrade::trap_free}};
    if (auto e = fit(options_.least_margin, options_.least_slack)) return {{*e, EnclosureGrade::trap_free_thin}};
    if (auto e = fit(options_.least_margin, std::nullopt)) return {{*e, EnclosureGrade::containing}};
    return std::nullopt;
  }

 private:
  struct Candidate {
    double angle = 0.0, offset = 0.0, minor = 0.0;
  };
  struct Best {
    Candidate candidate;
    Ellipse ellipse;
    double area = std::numeric_limits<double>::infinity();
  };

  std::optional<Ellipse> fit(double margin, std::optional<double> slack) {
    best_ = {};
    std::vector<double> angles;
    for (int i = 0; i < 18; ++i) angles.push_back(geometry::kPi * i / 18);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec2 e = points_[(i + 1) % points_.size()] - points_[i];
      if (e != Vec2{}) angles.push_back(std::atan2(e.y, e.x));
    }
    for (const double angle : angles) {
      turn(angle);
      for (const double share : {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8})
        for (const double aside : {0.0, -0.25, 0.25, -0.5, 0.5, -0.9, 0.9})
          ask({angle, aside * (share * size_), half_height_ + share * size_}, margin, slack);
    }
    if (!std::isfinite(best_.area)) return std::nullopt;
    refine(margin, slack);
    Ellipse e = best_.ellipse;
    e.center = e.center + hull_.front();
    const auto holds_all = [&] {
      return std::all_of(hull_.begin(), hull_.end(), [&](Vec2 p) { return geometry::contains(e, p); });
    };
    for (double step = 0x1p-50; !holds_all(); step *= 2.0)
      e = {e.center, e.l11 * (1.0 + step), e.l21 * (1.0 + step), e.l22 * (1.0 + step)};
    if (!admissible(e, start_, goal_, slack)) return std::nullopt;
    return e;
  }

  void refine(double margin, std::optional<double> slack) {
    double turned = geometry::kPi / 36.0, moved = 0.1 * size_;
    for (int round = 0; round < 60 && moved > 1e-3 * size_; ++round) {
      const Candidate c = best_.candidate;
      const Candidate moves[] = {
          {c.angle + turned, c.offset, c.minor},        {c.angle - turned, c.offset, c.minor},
          {c.angle, c.offset + moved, c.minor},         {c.angle, c.offset - moved, c.minor},
          {c.angle, c.offset, c.minor + moved},         {c.angle, c.offset, c.minor - moved},
          {c.angle, c.offset + moved, c.minor + moved}, {c.angle, c.offset - moved, c.minor + moved}};
      bool better = false;
      for (const Candidate& move : moves) {
        if (!(move.minor > 0.0)) continue;
        turn(move.angle);
        better = ask(move, margin, slack) || better;
      }
      if (better) continue;
      turned *= 0.5;
      moved *= 0.5;
    }
  }

  void turn(double angle) {
    const double c = std::cos(-angle), s = std::sin(-angle);
    x_.clear();
    y_.clear();
    for (const Vec2 p : points_) {
      x_.push_back(c * p.x - s * p.y);
      y_.push_back(s * p.x + c * p.y);
    }
    const auto [low, high] = std::minmax_element(y_.begin(), y_.end());
    middle_ = 0.5 * (*low + *high);
    half_height_ = 0.5 * (*high - *low);
  }

  /// Whether the candidate is smaller than the best so far and will do: then it is the best.
  bool ask(const Candidate& c, double margin, std::optional<double> slack) {
    const double centre_y = middle_ + c.offset;
    double narrowest = 1.0, extent = 0.0;
    std::vector<double> width;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      const double t = (y_[i] - centre_y) / c.minor;
      if (!(std::fabs(t) < 1.0)) return false;
      width.push_back(std::sqrt(1.0 - t * t));
      narrowest = std::min(narrowest, width.back());
      extent = std::max(extent, std::fabs(x_[i] - x_.front()));
    }
    double low = 0.0, high = extent / narrowest;
    for (int i = 0; i < 40; ++i) {
      const double mid = 0.5 * (low + high);
      const auto [first, last] = centres(mid, width);
      (first <= last ? high : low) = mid;
    }
    const auto [first, last] = centres(high, width);
    const double a = high + margin, b = c.minor + margin;
    if (!(a * b <= most_ && a * b < best_.area)) return false;
    const Vec2 centre = geometry::rotated({0.5 * (first + last), centre_y}, c.angle);
    const Ellipse e = geometry::ellipse_from_axes(
        centre, {std::max(a, b), std::min(a, b), a >= b ? c.angle : c.angle + 0.5 * geometry::kPi});
    if (!admissible(e, start_ - hull_.front(), goal_ - hull_.front(), slack)) return false;
    best_ = {c, e, a * b};
    return true;
  }

  std::pair<double, double> centres(double major, const std::vector<double>& width) const {
    double first = -std::numeric_limits<double>::infinity(), last = -first;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      first = std::max(first, x_[i] - major * width[i]);
      last = std::min(last, x_[i] + major * width[i]);
    }
    return {first, last};
  }

  bool admissible(const Ellipse& e, Vec2 start, Vec2 goal, std::optional<double> slack) const {
    const geometry::GrownShape kept_clear{e, {}, radius_ + options_.clear_of_ends};
    return locate(kept_clear, goal) == geometry::Place::outside &&
           locate(kept_clear, start) == geometry::Place::outside &&
           (!slack || geometry::goal_outside_evolute(e, goal, *slack));
  }

  std::vector<Vec2> hull_, points_;
  double radius_;
  Vec2 start_, goal_;
  geometry::EnclosureOptions options_;
  double size_ = 0.0, most_ = 0.0;
  std::vector<double> x_, y_;  ///< turned
  double middle_ = 0.0, half_height_ = 0.0;
  Best best_;
};

}  // namespace exactvo::test
