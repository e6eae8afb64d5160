// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/exact_motion.h"

#include <algorithm>

namespace exactvo::datasets::exact {

using formation::MotionLaw;

Chord operator-(const Chord& a, const Chord& b) {
  return {{a.way.from - b.way.from, a.way.to - b.way.to}, Rational(a.stray + b.stray)};
}

// --- The exponential law ---

ExponentialLaw::ExponentialLaw(const Rational& gain, const Rational& duration) : gain_(gain), duration_(duration) {
  settled_ = exactly_that(Rational(1)) - decay(gain * duration);
  // The decay is at most 2^-180 wide: below that nothing can be said, and nothing is.
  settled_.low = std::max(settled_.low, Rational(mpz_class(1), mpz_class(1) << 200));
  lag_ = (exactly_that(duration) - settled_ / exactly_that(gain)) / settled_;
}

const Interval& ExponentialLaw::decayed(const Rational& share) const {
  const auto [found, is_new] = decayed_.try_emplace(share);
  if (is_new) found->second = decay(gain_ * duration_ * share);
  return found->second;
}

const Interval& ExponentialLaw::bulge(const Rational& share) const {
  const auto [found, is_new] = bulges_.try_emplace(share, exactly_that(Rational(0)));
  if (!is_new || share == 0 || share == 1) return found->second;
  const Interval straight{Rational(share * settled_.low), Rational(share * settled_.high)};
  const Interval scale{Rational(gain_ * settled_.low), Rational(gain_ * settled_.high)};
  found->second = (exactly_that(Rational(1)) - decayed(share) - straight) / scale;
  return found->second;
}

Rational ExponentialLaw::bend(const Rational& share) const {
  return gain_ * duration_ * duration_ * decayed(share).high / settled_.low;
}

// --- Robots ---

StepMotion::StepMotion(MotionLaw kind, const ExponentialLaw* law, const Rational& duration, const State& from,
                       const State& to)
    : kind_(kind), law_(law), from_(exactly(from.position)), to_(exactly(to.position)) {
  const Point before = exactly(from.velocity), after = exactly(to.velocity);
  if (kind == MotionLaw::exponential) first_ = before - after;
  if (kind != MotionLaw::hermite) return;
  first_ = duration * before - (to_ - from_);
  second_ = duration * after - (to_ - from_);
}

StepMotion StepMotion::seen_from(const StepMotion& other) const {
  StepMotion out = *this;
  out.from_ = from_ - other.from_;
  out.to_ = to_ - other.to_;
  out.first_ = first_ - other.first_;
  out.second_ = second_ - other.second_;
  return out;
}

Point StepMotion::at(const Rational& s) const {
  const Point straight = from_ + s * (to_ - from_);
  if (kind_ == MotionLaw::straight) return straight;
  if (kind_ == MotionLaw::exponential) return straight + law_->bulge(s).middle() * first_;
  const Rational rest = 1 - s;
  return straight + Rational(s * rest * rest) * first_ - Rational(s * s * rest) * second_;
}

/// m: by how much `at` may be off.
Rational StepMotion::off(const Rational& s) const {
  if (kind_ != MotionLaw::exponential) return Rational(0);
  return law_->bulge(s).half_width() * length_at_most(first_);
}

/// m: at least the second derivative by the share, from `start` to `end`.
Rational StepMotion::bend(const Rational& start, const Rational& end) const {
  if (kind_ == MotionLaw::straight) return Rational(0);
  if (kind_ == MotionLaw::exponential) {
    const Rational change = length_at_most(first_);
    return sgn(change) == 0 ? Rational(0) : Rational(law_->bend(start) * change);
  }
  const auto second_derivative = [this](const Rational& s) {  // linear in s
    return length_at_most(Rational(6 * s - 4) * first_ + Rational(6 * s - 2) * second_);
  };
  return std::max(second_derivative(start), second_derivative(end));
}

Chord StepMotion::over(const Rational& start, const Rational& end) const {
  const Rational share = end - start;
  return {{at(start), at(end)}, Rational(bend(start, end) * share * share / 8 + std::max(off(start), off(end)))};
}

// --- Moving obstacles ---

Rational ExactWay::Stretch::distance(const Rational& time) const {
  const Rational passed = time - start;
  return covered + passed * (speed + rate * passed / 2);
}

void ExactWay::read_profile(const formation::TimedPath& motion) {
  if (motion.profile.empty()) {
    stretches_.push_back({Rational(0), std::nullopt, Rational(motion.speed), Rational(0), Rational(0)});
    return;
  }
  Stretch now{Rational(0), std::nullopt, Rational(motion.profile.front().speed), Rational(0), Rational(0)};
  for (std::size_t k = 0; k < motion.profile.size(); ++k) {
    const Rational time(motion.profile[k].time), speed(motion.profile[k].speed);
    if (time > now.start) {
      if (k > 0) now.rate = (speed - now.speed) / (time - now.start);
      now.end = time;
      stretches_.push_back(now);
      now.covered = now.distance(time);
    }
    now = {time, std::nullopt, speed, Rational(0), now.covered};
  }
  stretches_.push_back(now);
}

std::optional<Interval> ExactWay::time_at(const Rational& distance) const {
  for (const Stretch& s : stretches_) {
    if (s.covered >= distance) return exactly_that(s.start);
    const bool reaches = s.end ? s.distance(*s.end) >= distance : sgn(s.speed) > 0;
    if (!reaches) continue;
    if (sgn(s.rate) == 0) return exactly_that(Rational(s.start + (distance - s.covered) / s.speed));
    constexpr int kHalvings = 100;
    Interval time{s.start, *s.end};
    for (int k = 0; k < kHalvings; ++k) {
      const Rational middle = time.middle();
      const int side = cmp(s.distance(middle), distance);
      if (side == 0) return exactly_that(middle);
      (side < 0 ? time.low : time.high) = middle;
    }
    return time;
  }
  return std::nullopt;
}

void ExactWay::add_leg(const Piece& leg, const Rational& from, const std::optional<Rational>& to) {
  for (const Stretch& s : stretches_) {
    Piece piece = leg;
    piece.stretch = s;
    piece.from = std::max(from, s.start);
    piece.to = s.end;
    if (to && (!piece.to || *to < *piece.to)) piece.to = to;
    if (!piece.to || piece.from < *piece.to) pieces_.push_back(piece);
  }
}

ExactWay::ExactWay(const formation::TimedPath& motion) {
  read_profile(motion);
  const Interval none = exactly_that(Rational(0)), one = exactly_that(Rational(1));
  const Point start = exactly(motion.path.front());
  const auto standing = [&](const Point& vertex, const Rational& from, const std::optional<Rational>& to,
                            const Rational& stray) {
    pieces_.push_back({from, to, vertex, {}, one, none, stretches_.back(), stray});
  };
  Interval before = none;
  Rational from(0);
  for (std::size_t i = 1; i < motion.path.size(); ++i) {
    const Point leg = exactly(motion.path[i]) - exactly(motion.path[i - 1]);
    if (sgn(leg.x) == 0 && sgn(leg.y) == 0) continue;
    const Interval length = root(dot(leg, leg));
    const Interval reached = before + length;
    const std::optional<Interval> arrives = time_at(reached.low), leaves = time_at(reached.high);
    add_leg({from, {}, exactly(motion.path[i - 1]) - start, leg, length, before, stretches_.back(), Rational(0)}, from,
            arrives ? std::optional(arrives->low) : std::nullopt);
    if (!arrives) return;
    const Point corner = exactly(motion.path[i]) - start;
    const auto distance_at = [this](const Rational& time) {
      for (const Stretch& s : stretches_)
        if (!s.end || time <= *s.end) return s.distance(time);
      return stretches_.back().distance(time);
    };
    if (!leaves) {
      // It stops for good where it cannot be told from the corner.
      standing(corner, std::max(from, arrives->low), std::nullopt,
               std::max(reached.high, stretches_.back().covered) - distance_at(arrives->low));
      return;
    }
    const Rational passes = std::max(from, arrives->low);
    if (passes < leaves->high) {
      standing(corner, passes, leaves->high, distance_at(leaves->high) - distance_at(arrives->low));
      from = leaves->high;
    } else {
      from = passes;
    }
    before = reached;
  }
  standing(exactly(motion.path.back()) - start, from, std::nullopt, Rational(0));
}

bool ExactWay::rests_from(const Rational& time) const {
  const Piece& last = pieces_.back();
  const bool stands = sgn(last.leg.x) == 0 && sgn(last.leg.y) == 0;
  const bool has_no_speed = sgn(last.stretch.speed) == 0 && sgn(last.stretch.rate) == 0;
  return !last.to && (stands || has_no_speed) && last.from <= time;
}

std::size_t ExactWay::piece_at(const Rational& time) const {
  const auto found = std::upper_bound(pieces_.begin(), pieces_.end(), time,
                                      [](const Rational& t, const Piece& piece) { return !piece.to || t < *piece.to; });
  return static_cast<std::size_t>(found - pieces_.begin());
}

Chord ExactWay::chord(const Piece& piece, const Rational& start, const Rational& end) const {
  if (sgn(piece.leg.x) == 0 && sgn(piece.leg.y) == 0) return {{piece.vertex, piece.vertex}, piece.stray};
  const auto share_of_leg = [&](const Rational& time) {
    const Rational distance = piece.stretch.distance(time);
    return (exactly_that(distance) - piece.before) / piece.length;
  };
  const Interval from = share_of_leg(start), to = share_of_leg(end);
  const Rational passed = end - start;
  const Rational off = std::max(from.half_width(), to.half_width()) * length_at_most(piece.leg);
  return {{piece.vertex + from.middle() * piece.leg, piece.vertex + to.middle() * piece.leg},
          Rational(off + abs(piece.stretch.rate) * passed * passed / 8)};
}

std::vector<ExactWay::TimedChord> ExactWay::over(const Rational& start, const Rational& end) const {
  std::vector<TimedChord> out;
  for (std::size_t p = piece_at(start); p < pieces_.size() && pieces_[p].from < end; ++p) {
    const Rational from = std::max(start, pieces_[p].from);
    const Rational to = pieces_[p].to ? std::min(end, *pieces_[p].to) : end;
    out.push_back({from, to, chord(pieces_[p], from, to)});
  }
  return out;
}

Chord ExactWay::within(const Rational& start, const Rational& end) const {
  return chord(pieces_[piece_at(start)], start, end);
}

std::vector<Point> ExactWay::velocities(const Rational& time, const Rational& slack) const {
  std::vector<Point> all;
  for (const Piece& piece : pieces_) {
    if (piece.from > time + slack || (piece.to && *piece.to < time - slack)) continue;
    Rational at = std::max(time, piece.from);
    if (piece.to) at = std::min(at, *piece.to);
    const Rational speed = piece.stretch.speed + piece.stretch.rate * (at - piece.stretch.start);
    all.push_back(Rational(speed / piece.length.middle()) * piece.leg);
  }
  return all;
}

}  // namespace exactvo::datasets::exact
