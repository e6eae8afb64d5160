// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/ear_clipping.h"

#include <algorithm>

#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry::detail {
namespace {

bool in_closed_triangle(Vec2 a, Vec2 b, Vec2 c, Vec2 x) {
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const auto [low, high] = std::minmax({a.y, b.y, c.y});
  if (x.x < left || x.x > right || x.y < low || x.y > high) return false;
  return orientation(a, b, x) != Sign::negative && orientation(b, c, x) != Sign::negative &&
         orientation(c, a, x) != Sign::negative;
}

/// What is left of the ring, as numbers of its vertices.
class Rest {
 public:
  explicit Rest(const Ring& ring) : ring_(ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) left_.push_back(i);
  }

  std::size_t size() const { return left_.size(); }

  Triangle corner(std::size_t at) const {
    const std::size_t n = left_.size();
    return {left_[(at + n - 1) % n], left_[at], left_[(at + 1) % n]};
  }

  bool is_ear(std::size_t at) const {
    const Triangle t = corner(at);
    const Vec2 a = ring_[t[0]], b = ring_[t[1]], c = ring_[t[2]];
    if (orientation(a, b, c) != Sign::positive) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::size_t i) {
      return i != t[0] && i != t[1] && i != t[2] && in_closed_triangle(a, b, c, ring_[i]);
    });
  }

  void cut(std::size_t at) { left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at)); }

 private:
  const Ring& ring_;
  std::vector<std::size_t> left_;
};

}  // namespace

std::vector<Triangle> ears_of(const Ring& ring) {
  std::vector<Triangle> triangles;
  triangles.reserve(ring.size() - 2);
  Rest rest(ring);
  // From where the last ear was on, skipping a vertex: triangles then do not all share one.
  std::size_t at = 0;
  while (rest.size() > 3) {
    std::size_t tried = 0;
    while (tried < rest.size() && !rest.is_ear(at % rest.size())) {
      ++at;
      ++tried;
    }
    if (tried == rest.size()) return {};
    at %= rest.size();
    triangles.push_back(rest.corner(at));
    rest.cut(at);
    ++at;
  }
  if (!rest.is_ear(0)) return {};
  triangles.push_back(rest.corner(0));
  return triangles;
}

}  // namespace exactvo::geometry::detail
