// SPDX-License-Identifier: GPL-3.0-or-later
// How long the footprint stays clear of what is near its way. All is seen from where a stretch begins.
#include <algorithm>
#include <cmath>

#include "exactvo/formation/monitor.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/infinity.h"
#include "monitor/rounding.h"

namespace exactvo::formation {

using geometry::CornerView;
using geometry::Displacement;
using geometry::GapToKeep;
using geometry::KeptGap;
using geometry::kInfinity;
using geometry::norm;
using monitored::kUp;

namespace {

/// While the robot brakes, its way is looked at in as many parts: in each, time is bounded by a chord.
constexpr int kBrakingParts = 4;
/// m, of kMonitorSlack: a way that ends before an obstacle leaves this much, room for the directions of a certificate.
constexpr double kRoomAtTheEnd = 0.5 * kMonitorSlack;
/// A share of the way that is gone already: more than the rounding of its displacement (turning.cpp: 16 u).
constexpr double kOfWayGone = 0x1p-46;

/// A box along the chord of a way that holds the footprint all the time. What is on one side of it stays clear, which
/// costs next to nothing to see. Poses are taken at the ends of `kLooks` parts of the way; between them a corner leaves
/// its chord by no more than it strays.
class WayBox {
 public:
  /// `corners` of the footprint as the way begins; `reach`: of its parts, with what is to be kept.
  WayBox(const geometry::Twist& twist, double duration, const std::vector<Vec2>& corners, double reach) {
    const Vec2 chord = geometry::displacement_after(twist, duration).by;
    if (norm(chord) > 0.0) ahead_ = chord / norm(chord);
    double size = reach, stray = 0.0;
    for (int k = 0; k <= kLooks; ++k) {
      const Displacement d = geometry::displacement_after(twist, duration * k / kLooks);
      for (const Vec2 c : corners) {
        const Vec2 p = d.moved(c);
        size = std::max(size, std::fabs(p.x) + std::fabs(p.y));
        box_.add(Vec2{dot(ahead_, p), cross(ahead_, p)});
      }
    }
    for (const Vec2 c : corners) stray = std::max(stray, stray_of(twist, c, duration / kLooks));
    const double angle = std::fabs(twist.turn * duration);
    box_ = box_.grown(reach + stray + kRounding * (1.0 + angle) * size);
  }

  /// Whether the hull of the corners, seen from where the way begins, and grown by the radius, is on one side.
  bool is_beside(Vec2 at, const Vec2* corners, std::size_t size, double radius) const {
    geometry::Box seen;
    double most = radius;
    for (std::size_t i = 0; i < size; ++i) {
      const Vec2 p = at + corners[i];
      most = std::max(most, std::fabs(p.x) + std::fabs(p.y));
      seen.add(Vec2{dot(ahead_, p), cross(ahead_, p)});
    }
    const double room = radius + kRounding * most;
    return seen.low.x - room > box_.high.x || seen.high.x + room < box_.low.x || seen.low.y - room > box_.high.y ||
           seen.high.y + room < box_.low.y;
  }

 private:
  static constexpr int kLooks = 4;
  /// As a share of lengths: poses and products are rounded by less than 2^-46 of them, and `ahead_` is as long as 1 up
  /// to 2^-51.
  static constexpr double kRounding = 0x1p-44;
  Vec2 ahead_{1.0, 0.0};
  geometry::Box box_;
};

}  // namespace

/// As the stretch is at a moment of it; what `question` looks at.
void Monitor::turn_footprint(const Stretch& stretch, double time) {
  const double c = std::cos(stretch.start.heading), s = std::sin(stretch.start.heading);
  for (std::size_t i = 0; i < turned_.size(); ++i)
    turned_[i] = {c * part_corners_[i].x - s * part_corners_[i].y, s * part_corners_[i].x + c * part_corners_[i].y};
  if (time == 0.0) return;
  const Displacement d = geometry::displacement_after(stretch.twist, time);
  for (Vec2& corner : turned_) corner = d.turned(corner);
}

/// Whether a part of the footprint, as it stands turned, stays clear while it goes on along a stretch from a moment on.
GapToKeep Monitor::question(const Part& part, const Stretch& stretch, double time, const Standing& other,
                            const std::vector<Vec2>& corners, double duration, double reach) const {
  GapToKeep q{{{}, stretch.twist, CornerView{turned_.data() + part.first, part.size}},
              {other.at - stretch.start.at, {}, CornerView{corners.data() + other.first, other.size}},
              duration,
              reach,
              0.0,
              kRoomAtTheEnd - kMonitorSlack};
  if (time == 0.0) return q;
  const Displacement d = geometry::displacement_after(stretch.twist, time);
  q.a.at = d.by;
  q.a.twist.velocity = d.turned(stretch.twist.velocity);
  q.reach += kOfWayGone * norm(stretch.twist.velocity) * time;
  return q;
}

// --- Contact ---

double Monitor::gap_as_it_begins(const Stretch& stretch, const Part& part, const Standing& other,
                                 const std::vector<Vec2>& corners, double reach) {
  turn_footprint(stretch, 0.0);
  return keeper_.gap_at(question(part, stretch, 0.0, other, corners, 0.0, reach), 0.0);
}

/// When the two are seen to be apart, s of the stretch; infinite where they are not. No gap grows faster than the
/// fastest corner goes, so that longer steps are taken where they are deep.
double Monitor::left_within(const Stretch& stretch, const Part& part, const Standing& other,
                            const std::vector<Vec2>& corners, double reach) {
  turn_footprint(stretch, 0.0);
  const GapToKeep q = question(part, stretch, 0.0, other, corners, stretch.duration, reach);
  const double fastest = norm(stretch.twist.velocity) + std::fabs(stretch.twist.turn) * body_reach_;
  for (double time = 0.0; time < stretch.duration;) {
    const double gap = keeper_.gap_at(q, time);
    if (gap >= 0.0) return time;
    time += std::max(stretch.duration / kMonitorLooks, -gap / fastest);
  }
  return kInfinity;
}

/// The contact of a part and a piece that touch as the way begins; else null.
Monitor::Contact* Monitor::contact_of(std::size_t piece, std::size_t part, double reach) {
  for (Contact& contact : contacts_)
    if (contact.piece == piece && contact.part == part) return contact.gap < 0.0 ? &contact : nullptr;
  const double gap = gap_as_it_begins(way_.front(), parts_[part], pieces_[piece], corners_, reach);
  contacts_.push_back({piece, part, gap, 0, kInfinity});
  return gap < 0.0 ? &contacts_.back() : nullptr;
}

/// When the contact is seen to be left up to the end of a stretch, s of the way.
double Monitor::left_by(Contact& contact, std::size_t stretch, double reach) {
  double offset = 0.0;
  for (std::size_t k = 0; k < contact.looked; ++k) offset += way_[k].duration;
  for (; contact.looked <= stretch && contact.left_at == kInfinity; ++contact.looked) {
    const Stretch& next = way_[contact.looked];
    contact.left_at = offset + left_within(next, parts_[contact.part], pieces_[contact.piece], corners_, reach);
    offset += next.duration;
  }
  return contact.left_at;
}

// --- What stands still ---

/// Shortens `clear` where the footprint comes too near to a piece on a stretch, which begins at `offset`.
void Monitor::meet(std::size_t piece, std::size_t number, double offset, Clear& clear, bool& in_contact) {
  const Stretch& stretch = way_[number];
  const Piece& other = pieces_[piece];
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    const double reach = part.radius + other.radius + setup_.margin + kMonitorSlack;
    const double left = std::min(stretch.duration, clear.until - offset);
    double began = 0.0;
    GapToKeep asked = question(part, stretch, 0.0, other, corners_, left, reach);
    KeptGap kept = keeper_.keep(asked);
    if (kept.whole) continue;
    Contact* contact = offset > 0.0 || kept.kept_until == 0.0 ? contact_of(piece, k, reach) : nullptr;
    if (contact) {
      in_contact = true;
      const double left_at = std::max(0.0, left_by(*contact, number, reach) - offset);
      turn_footprint(stretch, 0.0);
      if (left_at > 0.0) {
        asked.required = contact->gap - kMonitorSlack;
        asked.duration = std::min(left, left_at);
        kept = keeper_.keep(asked);
        if (kept.whole && left_at < left) {
          began = left_at;
          turn_footprint(stretch, began);
          asked = question(part, stretch, began, other, corners_, left - began, reach);
          kept = keeper_.keep(asked);
          turn_footprint(stretch, 0.0);
        }
        if (kept.whole) continue;
      }
    }
    clear.until = offset + began + kept.kept_until;
    clear.lost = asked;
    clear.lost.required = std::min(asked.required, -kMonitorSlack);  // what is lost touches
    clear.kept = kept;
    clear.stretch = number;
    clear.began = began;
    clear.witness = MonitorWitness{false, other.obstacle, 0.0, {}};
  }
}

Monitor::Clear Monitor::clear_of_obstacles(double length, bool& in_contact) {
  Clear clear;
  clear.until = length;
  clear.lost_by = kInfinity;
  double offset = 0.0;
  for (std::size_t k = 0; k < way_.size(); ++k) {
    const Stretch& stretch = way_[k];
    const auto left = [&] { return std::min(stretch.duration, clear.until - offset); };
    if (offset > 0.0 && left() <= 0.0) break;
    turn_footprint(stretch, 0.0);
    const double speed = norm(stretch.twist.velocity);
    const auto reach = [&] { return (body_reach_ + speed * left()) * kUp; };
    const WayBox box(stretch.twist, left(), turned_, part_reach_);
    grid_.for_each_within(stretch.start.at, reach(), [&](std::size_t number) {
      // The way that is left may have become shorter.
      if (geometry::distance_below(grid_.box(number), stretch.start.at) > reach()) return;
      const Piece& piece = pieces_[number];
      if (box.is_beside(piece.at - stretch.start.at, corners_.data() + piece.first, piece.size, piece.radius)) return;
      meet(number, k, offset, clear, in_contact);
    });
    if (clear.witness && clear.stretch == k) {
      turn_footprint(stretch, clear.began);
      const geometry::LostGap lost = keeper_.lose(clear.lost, clear.kept);
      clear.lost_by = offset + clear.began + lost.lost_by;
      clear.witness->place = stretch.start.at + lost.place;
    }
    offset += stretch.duration;
  }
  return clear;
}

// --- Movers ---

/// The next moment of the way, after this one, at which braking begins or one of its parts does.
double Monitor::Pace::next_cut(double way) const {
  for (int k = 0; k <= kBrakingParts; ++k)
    if (const double cut = held + braked * k / kBrakingParts; cut > way) return cut;
  return kInfinity;
}

bool Monitor::is_far_from(const SeenMover& mover, const Pace& pace) const {
  const Vec2* corners = mover_corners_.data() + mover.first;
  double extent = 0.0, way = 0.0;
  for (std::size_t i = 0; i < mover.size; ++i) extent = std::max(extent, norm(corners[i]));
  for (const Stretch& stretch : way_) way += norm(stretch.twist.velocity) * stretch.duration;
  const double near =
      body_reach_ + extent + mover.radius + mover.position_error + way + mover.max_speed * pace.moment(pace.length());
  return norm(mover.at - way_.front().start.at) > near * kUp;
}

bool Monitor::clear_of_mover(std::size_t index, const Pace& pace, MonitorVerdict& verdict) {
  return std::all_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return part_clear_of_mover(part, index, pace, verdict); });
}

/// Where it is not, the mover becomes the witness.
bool Monitor::part_clear_of_mover(const Part& part, std::size_t index, const Pace& pace, MonitorVerdict& verdict) {
  const SeenMover& mover = movers_[index];
  const double reach = part.radius + mover.radius + mover.position_error + setup_.margin + kMonitorSlack;
  const double at_start = gap_as_it_begins(way_.front(), part, mover, mover_corners_, reach);
  bool in_contact = at_start < 0.0;
  verdict.in_contact |= in_contact;
  const double speed = in_contact ? 0.0 : mover.max_speed;
  double offset = 0.0;
  for (const Stretch& stretch : way_) {
    const double left_at = in_contact ? offset + left_within(stretch, part, mover, mover_corners_, reach) : offset;
    const double end = std::min(offset + stretch.duration, pace.length());
    for (double from = offset; from < end;) {
      in_contact = in_contact && from < left_at;
      const double to = std::min({end, pace.next_cut(from), in_contact ? left_at : kInfinity});
      const double then = pace.moment(from) * kUp, later = std::max(then, pace.moment(to) * kUp);
      turn_footprint(stretch, from - offset);
      GapToKeep asked = question(part, stretch, from - offset, mover, mover_corners_, to - from, reach);
      if (in_contact) asked.required = at_start - kMonitorSlack;
      asked.growth = speed * (later - then) / (to - from) * kUp;
      // In next to no time, all of it counts at once.
      const bool is_sudden = !(asked.growth < 0x1p100);
      if (is_sudden) asked.growth = 0.0;
      asked.reach += speed * (is_sudden ? later : then) * kUp;
      const KeptGap kept = keeper_.keep(asked);
      if (!kept.whole) {
        const Vec2 place = stretch.start.at + keeper_.lose(asked, kept).place;
        verdict.witness = MonitorWitness{true, index, pace.moment(from + kept.kept_until), place};
        return false;
      }
      from = to;
    }
    offset += stretch.duration;
  }
  return true;
}

}  // namespace exactvo::formation
