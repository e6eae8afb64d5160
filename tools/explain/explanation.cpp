// SPDX-License-Identifier: GPL-3.0-or-later
#include "explain/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactvo/formation/simulation.h"

namespace exactvo::tools {

using formation::RecordedConstraint;

namespace {

/// m/s: a difference that two decimals do not show.
constexpr double kNotSeen = 0.005;
/// Of the greatest speed: slower than this while wanting more, a robot is being held.
constexpr double kHeld = 0.05;
/// m/s: what the balance may leave over before it explains nothing; solvers keep far below it.
constexpr double kBalanced = 1e-3;

/// Two decimals, and no "-0.00".
std::string number(double x) {
  return fmt::format("{:.2f}", std::abs(x) < kNotSeen ? 0.0 : x);
}

std::string vector(Vec2 v) {
  return fmt::format("({}, {})", number(v.x), number(v.y));
}

std::string velocity(Vec2 v) {
  return fmt::format("{} m/s, speed {}", vector(v), number(norm(v)));
}

std::string status_words(const Decision& d) {
  switch (d.step.status) {
    case lp::Status::optimal:
      return "every constraint holds";
    case lp::Status::relaxed:
      return fmt::format("the constraints contradict each other; those of robots give by {} m/s, the least possible",
                         number(d.step.violation));
    case lp::Status::infeasible:
      return fmt::format("the constraints of obstacles contradict each other or the speed bound by {} m/s",
                         number(d.step.violation));
    case lp::Status::pinched:
      return "what must hold leaves no room for rounding";
  }
  return "";
}

std::string mode_words(const Decision& d) {
  const std::string side = d.step.side > 0 ? ", keeping left" : d.step.side < 0 ? ", keeping right" : "";
  const std::string note = d.step.note.empty() ? "" : " (" + d.step.note + ")";
  return name(d.step.mode) + side + note;
}

std::string head(const Decision& d) {
  const double shift = norm(d.step.chosen - d.step.preferred);
  return fmt::format(
      "{} of {} at t = {} s, {}\n"
      "  position   {} m, moving at {}\n"
      "  mode       {}\n"
      "  preferred  {}\n"
      "  chosen     {}: {}\n"
      "  status     {}\n",
      d.who().id, d.scenario.name, number(d.time), d.method, vector(d.step.position), velocity(d.step.velocity),
      mode_words(d), velocity(d.step.preferred), velocity(d.step.chosen),
      shift < kNotSeen ? "the preferred one itself" : number(shift) + " m/s from the preferred one", status_words(d));
}

std::string contact_words(const RecordedConstraint& c, Vec2 preferred) {
  const geometry::GrownShape s = grown_shape(c);
  const double distance = distance_to(s);
  if (distance < 0.0) return fmt::format("the robot is {} m inside it: no cone exists", number(-distance));
  const std::optional<double> contact = time_to_contact(s, preferred - c.shape_velocity);
  const std::string away = fmt::format("{} m from the robot's rim", number(distance));
  if (!contact) return away + ", missed at the preferred velocity";
  return fmt::format("{}, reached in {} s at the preferred velocity, horizon {} s", away, number(*contact),
                     number(c.tau));
}

std::string proof_words(const RecordedConstraint& c) {
  if (!c.certified) return "not certified";
  return c.source == formation::ConstraintSource::robot ? "proven safe together with the other robot's half"
                                                        : "proven to exclude the velocity obstacle";
}

std::string line_words(const RecordedConstraint& c) {
  return fmt::format("{:+.3f} v_x {:+.3f} v_y >= {:+.3f} m/s; {}, {}", c.half_plane.normal.x, c.half_plane.normal.y,
                     c.half_plane.offset, c.hard ? "hard" : "soft", proof_words(c));
}

std::string constraint_words(const Decision& d, std::size_t i) {
  const RecordedConstraint& c = d.step.constraints[i];
  return fmt::format("  [{}] {} {}: {}\n      {}\n", i + 1, c.active ? "binds " : "slack ", name_of(c, d.scenario),
                     contact_words(c, d.step.preferred), line_words(c));
}

std::string constraints_words(const Decision& d) {
  const auto& all = d.step.constraints;
  const auto active = std::count_if(all.begin(), all.end(), [](const RecordedConstraint& c) { return c.active; });
  const bool one = active == 1;
  std::string text = fmt::format("{} half-plane{}, of which {} bind{}", all.size(), all.size() == 1 ? "" : "s", active,
                                 one ? "s" : "");
  if (active > 0) text += fmt::format(" (the chosen velocity lies on {})", one ? "its line" : "their lines");
  text += "\n";
  for (std::size_t i = 0; i < all.size(); ++i) text += constraint_words(d, i);
  return text;
}

std::string force_name(const Balance::Force& force) {
  return force.constraint ? fmt::format("n[{}]", *force.constraint + 1) : "n[speed bound]";
}

std::string balance_words(const Balance& b) {
  std::string sum;
  for (const auto& force : b.forces) {
    sum += fmt::format("{}{} {}", sum.empty() ? "" : " + ", number(force.factor), force_name(force));
  }
  return "Why: chosen - preferred = " + sum +
         ", with the n the constraints' normals and no factor negative,\n"
         "     so no allowed velocity lies nearer to the preferred one (Karush-Kuhn-Tucker).\n";
}

bool is_held(const Decision& d) {
  const double visible = kHeld * d.who().max_speed;
  return norm(d.step.chosen) < visible && norm(d.step.preferred) > visible;
}

std::string held_words(const Decision& d, const Balance& b) {
  std::string by;
  for (const auto& force : b.forces) {
    if (!force.constraint) continue;
    by += (by.empty() ? "" : " and ") + name_of(d.step.constraints[*force.constraint], d.scenario);
  }
  if (by.empty()) return "";
  return fmt::format("The robot is held by {}: no allowed velocity has a component towards the preferred one.\n", by);
}

/// How the preferred velocity came about, where it is not simply straight for the goal.
std::string turned_words(const Decision& d) {
  switch (d.step.mode) {
    case formation::Mode::boost:
      return "boost had turned the preferred velocity onto the tangent of what is in the way";
    case formation::Mode::following:
      return "following the boundary after a stall had given the preferred velocity";
    case formation::Mode::pushing_out:
      return "the robot is in contact, and the preferred velocity leads away from it";
    default:
      return "";
  }
}

/// "[1]", "[1] and [3]": those that bind, but push nothing.
std::string idle_words(const Decision& d, const Balance& b) {
  std::vector<std::string> idle;
  for (std::size_t i = 0; i < d.step.constraints.size(); ++i) {
    const bool pushes = std::any_of(b.forces.begin(), b.forces.end(),
                                    [&](const Balance::Force& f) { return f.constraint == i && f.factor >= kNotSeen; });
    if (d.step.constraints[i].active && !pushes) idle.push_back(fmt::format("[{}]", i + 1));
  }
  if (idle.empty()) return "";
  return fmt::format("     It lies on the line{} of {}, which need{} not push it.\n", idle.size() == 1 ? "" : "s",
                     fmt::join(idle, " and "), idle.size() == 1 ? "s" : "");
}

std::string unmoved_words(const Decision& d) {
  const std::string turned = turned_words(d);
  if (turned.empty() && idle_words(d, {}).empty()) return "Why: nothing stands in the way.\n";
  const std::string reason = turned.empty() ? "the preferred velocity" : turned + "; it";
  return "Why: " + reason + " is allowed as it stands.\n" + idle_words(d, {});
}

std::string moved_words(const Decision& d) {
  const Balance b = balance(d);
  if (b.remainder > kBalanced) return "";
  const std::string turned = turned_words(d);
  return balance_words(b) + idle_words(d, b) + (turned.empty() ? "" : "     Before that, " + turned + ".\n") +
         (is_held(d) ? held_words(d, b) : "");
}

std::string why(const Decision& d) {
  if (d.step.status != lp::Status::optimal) return "";
  return norm(d.step.chosen - d.step.preferred) < kNotSeen ? unmoved_words(d) : moved_words(d);
}

}  // namespace

std::string explanation(const Decision& decision) {
  return head(decision) + constraints_words(decision) + why(decision);
}

}  // namespace exactvo::tools
