// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/outcome_words.h"

#include <algorithm>

#include "scene/number_text.h"

namespace exactvo::formation::detail {
namespace {

/// "R1 overlapped moving obstacle 'cart' by 1.4 m at 2.5 s".
std::string sentence(const Collision& c) {
  return c.robot + " overlapped " + name(c.kind) + " '" + c.with + "' by " + number_text(c.depth, 3) + " m at " +
         number_text(c.deepest_at, 3) + " s";
}

std::string of_collisions(const Metrics& m) {
  if (m.collisions.empty()) return "";
  const auto deepest = std::max_element(m.collisions.begin(), m.collisions.end(),
                                        [](const Collision& a, const Collision& b) { return a.depth < b.depth; });
  std::string text = "COLLISION: " + sentence(*deepest);
  const auto relaxed = static_cast<std::size_t>(
      std::count_if(m.collisions.begin(), m.collisions.end(), [](const Collision& c) { return c.relaxed; }));
  const std::size_t all = m.collisions.size();
  if (all > 1) text += ", the deepest of " + std::to_string(all) + " collisions";
  if (relaxed > 0) {
    text += all == 1 ? ", in a relaxed decision" : ", " + std::to_string(relaxed) + " of them in relaxed decisions";
    text += " (no velocity kept every half-plane)";
  }
  return text + "; ";
}

std::string of_detours(const Metrics& m) {
  if (!m.formation_course) return "";
  std::string text;
  for (const RobotMetrics& r : m.robots) {
    const double detour = r.detour.value_or(0.0);
    if (!(detour > 1.0 && detour > kLongDetour * (r.path_length - detour))) continue;
    text += "; " + r.id + " went a detour of " + number_text(detour, 3) + " m, up to " +
            number_text(r.largest_slot_error.value_or(0.0), 3) + " m from its slot";
  }
  if (!text.empty() && m.formation_course->formed_since)
    text += "; the formation holds since " + number_text(*m.formation_course->formed_since, 3) + " s";
  return text;
}

}  // namespace

std::string outcome_words(const Metrics& m, const std::string& end) {
  return of_collisions(m) + end + of_detours(m);
}

}  // namespace exactvo::formation::detail

namespace exactvo::formation {

const char* name(CollisionKind kind) {
  constexpr const char* kNames[] = {"obstacle", "moving obstacle", "robot"};
  return kNames[static_cast<int>(kind)];
}

}  // namespace exactvo::formation
