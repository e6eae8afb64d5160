// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/pair_row.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/vec2.h"

namespace exactvo::formation::crowd {
namespace {

using geometry::Vec2;

/// Length of normals in lattice steps. D is below 2^31, so N.D is below 2^52: whole in double too.
constexpr double kNormalLength = 0x1p20;

/// Halvings between the normal that hinders least and one that separates.
constexpr int kBends = 5;

Vec2 number(Motion m) {
  return {static_cast<double>(m.x), static_cast<double>(m.y)};
}

/// The point nearest to 0 of the segment ab.
Vec2 nearest_of_segment(Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const double length = squared_norm(along);
  if (!(length > 0.0)) return a;
  return a + std::clamp(-dot(a, along) / length, 0.0, 1.0) * along;
}

/// The point nearest to 0 of { from + s a - t b : s, t in [0, 1] }, 0 where 0 is inside.
Vec2 nearest_of_parallelogram(Vec2 from, Vec2 a, Vec2 b) {
  const Vec2 corners[4] = {from, from + a, from + a - b, from - b};
  Vec2 nearest = from;
  int left = 0, right = 0;
  for (int k = 0; k < 4; ++k) {
    const Vec2 p = corners[k], q = corners[(k + 1) % 4], x = nearest_of_segment(p, q);
    if (squared_norm(x) < squared_norm(nearest)) nearest = x;
    const double side = cross(p, q);
    left += side > 0.0;
    right += side < 0.0;
  }
  const bool inside = cross(a, b) != 0.0 && (left == 0 || right == 0);
  return inside ? Vec2{} : nearest;
}

/// ORCA's normal for the relative motion m with the step as horizon: the boundary of the velocity obstacle nearest to
/// m.
Vec2 reciprocal_normal(Vec2 d, Vec2 m, double radius) {
  const Vec2 end = d + m;
  const double along = dot(end, d), squared_end = squared_norm(end), squared = squared_norm(d);
  if (along > 0.0 && along * along >= radius * radius * squared_end) return end;
  const double leg = std::sqrt(std::max(0.0, squared - radius * radius));
  const double turn = cross(d, end) >= 0.0 ? leg : -leg;
  return {radius * d.x - turn * d.y, radius * d.y + turn * d.x};
}

/// Searches the normal of a pair, and shares its room out.
class PairSearch {
 public:
  explicit PairSearch(const PairInStep& pair)
      : pair_(pair),
        d_{static_cast<double>(pair.dx), static_cast<double>(pair.dy)},
        safe_end_(d_ + number(pair.safe_a) - number(pair.safe_b)),
        more_a_(number(pair.wish_a) - number(pair.safe_a)),
        more_b_(number(pair.wish_b) - number(pair.safe_b)),
        radius_(static_cast<double>(pair.radius)),
        at_rest_(pair.safe_a == Motion{} && pair.safe_b == Motion{}) {}

  PairRows rows() const {
    if (overlaps()) return at_rest_ ? not_nearer() : PairRows{{}, {}, false};
    const Vec2 centre = at_rest_ ? d_ : nearest_of_segment(d_, safe_end_);
    Split across;
    const bool separates = try_normal(centre, across);
    if (separates && across.contents_both()) return rows_of(across);
    Split best;
    if (try_bent(centre, best)) return rows_of(best);
    if (separates) return rows_of(across);
    return at_rest_ ? not_nearer() : PairRows{{}, {}, false};
  }

 private:
  /// A normal that separates, and what is left between the two along it.
  struct Split {
    std::int64_t nx = 0, ny = 0;
    std::int64_t bar = 0;                 ///< >= R |N|
    std::int64_t across = 0;              ///< N.D
    std::int64_t room = 0;                ///< N.(D + u_a - u_b) - bar, >= 0
    std::int64_t need_a = 0, need_b = 0;  ///< of it, for the wishes

    bool contents_both() const { return need_a + need_b <= room; }
  };

  bool overlaps() const { return pair_.dx * pair_.dx + pair_.dy * pair_.dy < pair_.radius * pair_.radius; }

  /// Lemma 3. In one place: the lower id leaves to the left.
  PairRows not_nearer() const {
    const bool together = pair_.dx == 0 && pair_.dy == 0;
    const std::int64_t nx = together ? -1 : pair_.dx, ny = pair_.dy;
    return {{nx, ny, 0}, {-nx, -ny, 0}, true};
  }

  /// The whole normal along `direction`; false where it does not separate the two, or has no length.
  bool try_normal(Vec2 direction, Split& out) const {
    const double length = std::sqrt(squared_norm(direction));
    if (!(length > 0.0)) return false;
    const Vec2 whole{std::nearbyint(kNormalLength / length * direction.x),
                     std::nearbyint(kNormalLength / length * direction.y)};
    // R |N| in double is off by at most 2^-52 of less than 2^52: by less than 2.
    const double bar = std::floor(radius_ * std::sqrt(squared_norm(whole))) + 2.0;
    const double across = dot(whole, d_), at_end = dot(whole, safe_end_);
    if (!(across >= bar && at_end >= bar)) return false;
    out.nx = static_cast<std::int64_t>(whole.x);
    out.ny = static_cast<std::int64_t>(whole.y);
    out.bar = static_cast<std::int64_t>(bar);
    out.across = static_cast<std::int64_t>(across);
    out.room = static_cast<std::int64_t>(at_end) - out.bar;
    out.need_a = static_cast<std::int64_t>(std::max(0.0, -dot(whole, more_a_)));
    out.need_b = static_cast<std::int64_t>(std::max(0.0, dot(whole, more_b_)));
    return true;
  }

  /// The normal that hinders the wishes least, bent towards `centre` until it separates.
  bool try_bent(Vec2 centre, Split& out) const {
    Vec2 wanted = nearest_of_parallelogram(safe_end_, more_a_, more_b_);
    if (squared_norm(wanted) < 1.0) {
      const Vec2 relative = number(pair_.wish_a) - number(pair_.wish_b);
      wanted = reciprocal_normal(d_, relative, radius_);
    }
    if (try_normal(wanted, out)) return true;
    const double far = std::sqrt(squared_norm(wanted)), near = std::sqrt(squared_norm(centre));
    if (!(far > 0.0 && near > 0.0)) return false;
    const Vec2 from = 1.0 / near * centre, to = 1.0 / far * wanted;
    double low = 0.0, high = 1.0;  // low separates, if `centre` does
    bool found = false;
    for (int k = 0; k < kBends; ++k) {
      const double share = (low + high) / 2.0;
      Split bent;
      if (try_normal((1.0 - share) * from + share * to, bent)) {
        out = bent;
        found = true;
        low = share;
      } else {
        high = share;
      }
    }
    return found;
  }

  /// Lemma 2. A robot whose wish has room gets what it needs; what is left is halved, what is missing shared in
  /// proportion.
  PairRows rows_of(const Split& s) const {
    std::int64_t part = s.need_a;
    if (s.contents_both())
      part += (s.room - s.need_a - s.need_b) / 2;
    else
      part = static_cast<std::int64_t>(static_cast<double>(s.room) * static_cast<double>(s.need_a) /
                                       static_cast<double>(s.need_a + s.need_b));
    part = std::clamp<std::int64_t>(part, 0, s.room);
    PairRows rows;
    rows.a = {s.nx, s.ny, 0};
    rows.b = {-s.nx, -s.ny, 0};
    rows.a.least = rows.a.at(pair_.safe_a) - part;
    rows.b.least = rows.b.at(pair_.safe_b) - (s.room - part);
    return rows;
  }

  const PairInStep& pair_;
  Vec2 d_, safe_end_, more_a_, more_b_;
  double radius_;
  bool at_rest_;
};

}  // namespace

PairRows pair_rows(const PairInStep& pair) {
  return PairSearch(pair).rows();
}

}  // namespace exactvo::formation::crowd
