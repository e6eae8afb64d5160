// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/reserved_ways.h"

#include <algorithm>

namespace exactvo::formation::crowd {
namespace {

/// m: by how much more than its radius a robot keeps off the capsules of others, where it has that room.
constexpr double kCapsuleMargin = 0.0015;

}  // namespace

void ReservedWays::set(const std::vector<Vec2>& place, const std::vector<std::uint8_t>& reserved) {
  place_ = place;
  reserved_ = reserved;
  holders_ = static_cast<std::size_t>(std::count_if(reserved.begin(), reserved.end(), [](auto r) { return r != 0; }));
}

void ReservedWays::forget(std::int32_t id) {
  if (!holds(id)) return;
  reserved_[static_cast<std::size_t>(id)] = 0;
  --holders_;
}

void ReservedWays::lay_out(std::vector<Capsule> capsules) {
  capsules_ = std::move(capsules);
  std::vector<geometry::Box> boxes;
  boxes.reserve(capsules_.size());
  widest_ = 0.0;
  for (const Capsule& c : capsules_) {
    geometry::Box box;
    box.low = {std::min(c.way.a.x, c.way.b.x), std::min(c.way.a.y, c.way.b.y)};
    box.high = {std::max(c.way.a.x, c.way.b.x), std::max(c.way.a.y, c.way.b.y)};
    boxes.push_back(box);
    widest_ = std::max(widest_, c.radius);
  }
  grid_ = geometry::BoxGrid(std::move(boxes));
}

void ReservedWays::add_lines(Vec2 at, double radius, double max_speed, double horizon,
                             std::vector<BodyLine>& out) const {
  if (capsules_.empty()) return;
  const double reach = radius + widest_ + kCapsuleMargin + max_speed * horizon;
  grid_.for_each_within(at, reach, [&](std::size_t k) {
    const Capsule& capsule = capsules_[k];
    const Vec2 away = at - nearest_on(capsule.way.a, capsule.way.b, at);
    const double distance = norm(away), together = radius + capsule.radius;
    if (distance < together || distance > together + kCapsuleMargin + max_speed * horizon) return;
    const double gap = std::max(0.0, distance - together - kCapsuleMargin);
    out.push_back({away / distance, -gap / horizon, kCapsule, false});
  });
}

}  // namespace exactvo::formation::crowd
