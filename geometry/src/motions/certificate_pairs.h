// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What both checks of motion certificates share. Like them it uses nothing of what decides motions.

#include <gmpxx.h>

#include <vector>

#include "exactvo/geometry/motion_certificate.h"

namespace exactvo::geometry::motion_check {

/// Whether the separations are those of all pairs of parts in turn, each pair's over the whole time without a gap, and
/// `holds(separation)` is true of each.
template <class Holds>
bool all_hold(const MotionCertificate& certificate, std::size_t parts, std::size_t others, double from, double to,
              const Holds& holds) {
  if (from > to) return certificate.separations.empty();
  std::size_t next = 0;
  for (std::size_t part = 0; part < parts; ++part)
    for (std::size_t other = 0; other < others; ++other) {
      double reached = from;
      bool some = false;
      for (; next < certificate.separations.size() && !(some && reached == to); ++next) {
        const Separation& s = certificate.separations[next];
        if (s.part != part || s.other != other || s.from != reached || !(s.to >= s.from && s.to <= to)) break;
        if (!holds(s)) return false;
        reached = s.to;
        some = true;
      }
      if (!some || reached != to) return false;
    }
  return next == certificate.separations.size();
}

/// Whether the point is inside, by the even-odd rule.
inline bool is_inside(const mpq_class& x, const mpq_class& y, const std::vector<Segment>& edges) {
  bool inside = false;
  for (const Segment& e : edges) {
    const mpq_class ax(e.a.x), ay(e.a.y), bx(e.b.x), by(e.b.y);
    if ((ay > y) == (by > y)) continue;
    if (x < ax + (y - ay) / (by - ay) * (bx - ax)) inside = !inside;
  }
  return inside;
}

}  // namespace exactvo::geometry::motion_check
