// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How robots and moving obstacles move between two rows, in rationals: any stretch of time as a straight chord and a
/// proven bound of how far the motion strays from it. Bounds shrink with the stretch, so that halving it decides
/// whether two motions meet, up to contact itself.

#include <map>
#include <optional>
#include <vector>

#include "exactvo/formation/recording.h"
#include "recordings/exact_plane.h"

namespace exactvo::datasets::exact {

/// At every moment of the stretch the motion is within `stray` of the point that goes uniformly from one end to the
/// other.
struct Chord {
  Straight way;
  Rational stray;  ///< m
};
Chord operator-(const Chord& a, const Chord& b);

/// v' = -k (v - w), the law of robots that are integrated in closed form: over a step of T the path is
///   x0 + s (x1 - x0) + g(s) (v0 - v1),  g(s) = ((1 - e^{-k s T}) - s (1 - e^{-k T})) / (k (1 - e^{-k T})),
/// s from 0 to 1. (w is eliminated by v1 = w + e^{-k T} (v0 - w).)
class ExponentialLaw {
 public:
  /// REQUIRES: gain and duration above 0.
  ExponentialLaw(const Rational& gain, const Rational& duration);
  /// g(s), s.
  const Interval& bulge(const Rational& share) const;
  /// At least |g''| from this share on, s.
  Rational bend(const Rational& share) const;
  /// What the law moves a robot by: T v0 - lag (v0 - v1); the factor lag, s.
  const Interval& lag() const { return lag_; }
  /// 1 - e^{-k T}: the share of a velocity's gap that a step closes.
  const Interval& settled() const { return settled_; }

 private:
  const Interval& decayed(const Rational& share) const;

  Rational gain_, duration_;
  Interval settled_;
  Interval lag_;  ///< (T - (1 - e^{-k T}) / k) / (1 - e^{-k T})
  mutable std::map<Rational, Interval> decayed_, bulges_;
};

/// A robot in a row.
struct State {
  geometry::Vec2 position;  ///< m
  geometry::Vec2 velocity;  ///< m/s
};

/// A robot over one step, or one robot as seen from another.
class StepMotion {
 public:
  /// REQUIRES: `law` where the motion is exponential.
  StepMotion(formation::MotionLaw kind, const ExponentialLaw* law, const Rational& duration, const State& from,
             const State& to);

  /// From one share of the step to another.
  Chord over(const Rational& start, const Rational& end) const;
  /// This as seen from the other: every law is linear in the states. REQUIRES: the same law and duration.
  StepMotion seen_from(const StepMotion& other) const;

 private:
  Point at(const Rational& share) const;
  Rational off(const Rational& share) const;
  Rational bend(const Rational& start, const Rational& end) const;

  formation::MotionLaw kind_;
  const ExponentialLaw* law_;
  Point from_, to_;
  Point first_, second_;  ///< of the cubic T v0 - (x1 - x0) and T v1 - (x1 - x0); of the exponential v0 - v1 and 0
};

/// A moving obstacle: its displacement along its path with its speed profile. Lengths of legs are square roots; where
/// they are rational the corners' times are exact, else they are enclosed.
class ExactWay {
 public:
  /// REQUIRES: at least one point in the path, profile times that do not fall.
  explicit ExactWay(const formation::TimedPath& motion);

  /// The displacement over [start, end] piece by piece; s.
  struct TimedChord {
    Rational start, end;
    Chord chord;
  };
  std::vector<TimedChord> over(const Rational& start, const Rational& end) const;
  /// The same for a stretch of time within one piece.
  Chord within(const Rational& start, const Rational& end) const;
  /// The velocities that it has at some time within `slack` (s) of this one, up to 2^-180 of them: several at a corner
  /// or a jump of its speed.
  std::vector<Point> velocities(const Rational& time, const Rational& slack) const;
  /// Whether it stands from this time on, for ever.
  bool rests_from(const Rational& time) const;

 private:
  struct Stretch {
    Rational start;
    std::optional<Rational> end;                    ///< none: for ever
    Rational speed, rate, covered;                  ///< at its start
    Rational distance(const Rational& time) const;  ///< from t = 0 on
  };
  struct Piece {
    Rational from;
    std::optional<Rational> to;
    Point vertex;             ///< displacement at the leg's start; in a corner's piece at the corner
    Point leg;                ///< (0, 0) at rest and in a corner's piece
    Interval length, before;  ///< of the leg, and of the legs before it
    Stretch stretch;
    Rational stray;  ///< in a corner's piece: what it goes while the corner is passed
  };

  void read_profile(const formation::TimedPath& motion);
  /// From the last time at which no more than `distance` is known to be covered to the first at which no less is.
  std::optional<Interval> time_at(const Rational& distance) const;
  void add_leg(const Piece& leg, const Rational& from, const std::optional<Rational>& to);
  Chord chord(const Piece& piece, const Rational& start, const Rational& end) const;
  std::size_t piece_at(const Rational& time) const;

  std::vector<Stretch> stretches_;
  std::vector<Piece> pieces_;
};

enum class Verdict { clear, meets, unknown };

/// The most chords that one question is cut into, and how often one part is halved, before it is given up as unknown;
/// and how many parts are, before the whole is: at a moment of contact it is a few.
inline constexpr int kMostChords = 4096;
inline constexpr int kMostHalvings = 48;
inline constexpr int kMostGivenUp = 16;

/// Halves [start, end] until `test(chord)` has answered for every part. `over(start, end)` gives the chords. A part
/// that is given up hides no other one that meets.
template <typename Over, typename Test>
Verdict decide(const Over& over, const Test& test, const Rational& start, const Rational& end) {
  struct Part {
    Rational from, to;
    int halvings;
  };
  std::vector<Part> open{{start, end, 0}};
  int given_up = 0;
  for (int used = 0; !open.empty(); ++used) {
    const Part part = open.back();
    open.pop_back();
    const Verdict verdict = test(over(part.from, part.to));
    if (verdict == Verdict::meets) return verdict;
    if (verdict == Verdict::clear) continue;
    if (part.halvings == kMostHalvings) ++given_up;
    if (used >= kMostChords || given_up == kMostGivenUp) return Verdict::unknown;
    if (part.halvings == kMostHalvings) continue;
    const Rational middle = (part.from + part.to) / 2;
    open.push_back({middle, part.to, part.halvings + 1});
    open.push_back({part.from, middle, part.halvings + 1});
  }
  return given_up > 0 ? Verdict::unknown : Verdict::clear;
}

}  // namespace exactvo::datasets::exact
