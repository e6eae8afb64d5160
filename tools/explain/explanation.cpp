// SPDX-License-Identifier: GPL-3.0-or-later
#include "explain/decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exactvo/formation/balance.h"
#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/waiting.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::tools {

using formation::Balance;
using formation::DecisionConstraint;
using geometry::GrownShape;

namespace {

// --- Numbers ---

using geometry::kPi;
constexpr int kDirections = 4096;  // an arc between two of them strays from its chord by 3e-7 of the radius

Vec2 direction(int i) {
  const double angle = 2.0 * kPi * i / kDirections;
  return {std::cos(angle), std::sin(angle)};
}

// --- Words ---

/// m/s: a difference that two decimals do not show.
constexpr double kNotSeen = 0.005;
/// m/s: a velocity this near a line lies on it, whatever a solver rounded.
constexpr double kOnLine = 1e-6;
/// A share of the greatest speed: slower than this while wanting more, a robot is being held.
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

/// A violation in words: what two decimals do not show has one digit that counts.
std::string amount(double violation) {
  return violation < kNotSeen ? fmt::format("{:.1g}", violation) : number(violation);
}

std::string numbered(const std::vector<std::size_t>& constraints) {
  std::vector<std::string> numbers;
  for (const std::size_t i : constraints) numbers.push_back(fmt::format("[{}]", i + 1));
  return formation::enumerated(numbers);
}

std::string violated_words(const Decision& d) {
  std::vector<DecisionConstraint> violated;
  for (const DecisionConstraint& c : d.step.constraints)
    if (effect_of(d, c) == Effect::violated) violated.push_back(c);
  return violated.empty() ? "" : ": " + formation::name_of(violated, d.scenario, d.bodies);
}

std::string status_words(const Decision& d) {
  const std::string by = amount(d.step.violation);
  switch (d.step.status) {
    case lp::Status::optimal:
      return "every constraint is satisfied";
    case lp::Status::relaxed:
      return fmt::format(
          "the constraints contradict each other; the soft ones are violated by at most {} m/s, the least possible{}",
          by, violated_words(d));
    case lp::Status::infeasible:
      return fmt::format("the hard constraints contradict each other or the speed bound by {} m/s{}", by,
                         violated_words(d));
    case lp::Status::no_interior:
      return "the hard constraints leave no room for rounding";
  }
  return "";
}

std::string mode_words(const Decision& d) {
  const std::string side = d.step.side > 0 ? ", keeping left" : d.step.side < 0 ? ", keeping right" : "";
  const std::string note = d.step.note.empty() ? "" : " (" + d.step.note + ")";
  return name(d.step.mode) + side + note;
}

/// A line, of a robot on wheels.
std::string wheel_words(const Decision& d) {
  if (!d.step.wheels || !d.who().drive) return "";
  constexpr double kDegree = 180.0 / geometry::kPi;
  const formation::OnWheels& now = *d.step.wheels;
  return fmt::format(
      "  wheels     heading {} degrees, left wheel {} m/s, right wheel {} m/s; the position is {:g} m ahead of the "
      "axle\n",
      number(kDegree * std::atan2(now.heading.y, now.heading.x)), number(now.speeds.left), number(now.speeds.right),
      d.who().drive->reference);
}

/// A line, beside movers.
std::string stopping_words(const Decision& d) {
  if (!meets_movers(d.scenario)) return "";
  const std::size_t steps = d.step.stopping_steps;
  if (steps == 0) return "  stands     nothing is promised to it against moving obstacles\n";
  return fmt::format("  stands     after {} s if it brakes: proven to touch no moving obstacle before\n",
                     number(static_cast<double>(steps) * d.scenario.time_step));
}

std::string head(const Decision& d) {
  const double shift = norm(d.step.chosen - d.step.preferred);
  const std::string assumed = formation::assumed_words(d.scenario);
  return fmt::format(
      "{} of {} at t = {} s, {}\n"
      "  position   {} m, moving at {}\n"
      "{}"
      "  mode       {}\n"
      "{}"
      "  preferred  {}\n"
      "  chosen     {}: {}\n"
      "{}"
      "  status     {}\n"
      "{}",
      d.who().id, d.scenario.name, number(d.time), d.method, vector(d.step.position), velocity(d.step.velocity),
      wheel_words(d), mode_words(d), d.waiting.empty() ? "" : "  waiting    " + d.waiting + "\n",
      velocity(d.step.preferred), velocity(d.step.chosen),
      shift < kNotSeen ? "the preferred one itself" : number(shift) + " m/s from the preferred one", stopping_words(d),
      status_words(d), assumed.empty() ? "" : "  " + assumed + "\n");
}

bool takes_preferred(const Decision& d) {
  return norm(d.step.chosen - d.step.preferred) < kNotSeen;
}

/// Its own limit.
std::string limit_words(const Decision& d) {
  const auto change = [&] {
    return fmt::format("at most {:g} m/s^2, {:.3g} m/s in a time step", d.scenario.acceleration->max,
                       d.scenario.acceleration->max * d.scenario.time_step);
  };
  const std::optional<formation::DifferentialDrive>& drive = d.who().drive;
  if (!drive) return change();
  return fmt::format("wheels: at most {:g} m/s and {:g} m/s^2", drive->max_wheel_speed, drive->max_wheel_acceleration) +
         (measures_others(d.scenario) ? "; reference point: " + change() : "");
}

/// Against what moves in any way, lemma 8.
bool is_of_mover(const Decision& d, const DecisionConstraint& c) {
  return meets_movers(d.scenario) && c.source == formation::ConstraintSource::moving_obstacle;
}

std::string contact_words(const Decision& d, std::size_t i) {
  const DecisionConstraint& c = d.step.constraints[i];
  if (formation::is_own_limit(c)) return limit_words(d);
  if (is_of_mover(d, c))
    return fmt::format("{} m from the robot's rim, comes {} m nearer at most until the robot stands",
                       number(c.clearance),
                       number(*d.scenario.moving_obstacles[c.index].max_speed *
                              static_cast<double>(d.step.stopping_steps) * d.scenario.time_step));
  const Vec2 preferred = d.step.preferred;
  const geometry::GrownShape s = grown_shape(d.seen[i]);
  const double distance = distance_to(s);
  if (distance < 0.0) return fmt::format("the robot overlaps it by {} m: no cone exists", number(-distance));
  const std::optional<double> contact = time_to_contact(s, preferred - d.seen[i].velocity);
  const std::string away = fmt::format("{} m from the robot's rim", number(distance));
  // A velocity on the line of a half-plane just misses: boost and following aim there.
  if (!contact && takes_preferred(d) && effect_of(d, c) == Effect::binding)
    return away + ", passed closely at the chosen velocity";
  if (!contact) return away + ", not touched at the preferred velocity";
  constexpr double kLong = 3600.0;  // s
  const std::string in = *contact > kLong ? "more than an hour" : number(*contact) + " s";
  return fmt::format("{}, reached in {} at the preferred velocity, horizon {} s", away, in, number(c.time_horizon));
}

std::string proof_words(const Decision& d, const DecisionConstraint& c) {
  if (!c.certified) return "not certified";
  if (is_of_mover(d, c)) return "proven to keep it off until the robot stands";
  if (formation::is_own_limit(c)) return "a side of the polygon within what its acceleration, or its wheels, allow";
  if (c.source != formation::ConstraintSource::robot) return "proven to exclude the velocity obstacle";
  return measures_others(d.scenario) ? "keeps to its own side of a line that may be between the ways of braking"
                                     : "proven safe together with the other robot's half";
}

std::string constraint_words(const Decision& d, std::size_t i) {
  const DecisionConstraint& c = d.step.constraints[i];
  const Effect effect = effect_of(d, c);
  return fmt::format(
      "  [{}] {}{}, {}: {}\n      {:+.3f} v_x {:+.3f} v_y >= {:+.3f} m/s; {}, {}\n", i + 1,
      name_of(c, d.scenario, d.bodies), c.fell_back ? " (the pair fell back)" : "",
      effect == Effect::violated ? "violated by " + amount(violation_of(c, d.step.chosen)) + " m/s" : name(effect),
      contact_words(d, i), c.half_plane.normal.x, c.half_plane.normal.y, c.half_plane.offset, c.hard ? "hard" : "soft",
      proof_words(d, c));
}

std::string constraints_words(const Decision& d) {
  const auto& all = d.step.constraints;
  const auto count = [&](Effect effect) {
    return std::count_if(all.begin(), all.end(), [&](const auto& c) { return effect_of(d, c) == effect; });
  };
  const auto binding = count(Effect::binding), violated = count(Effect::violated);
  std::string text = fmt::format("{} half-plane{}: {} binding", all.size(), all.size() == 1 ? "" : "s", binding);
  if (binding > 0) text += fmt::format(" (the chosen velocity lies on {})", binding == 1 ? "its line" : "their lines");
  if (violated > 0) text += fmt::format(", {} violated", violated);
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
    if (force.factor < kNotSeen) continue;
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
  std::vector<DecisionConstraint> by;
  for (const auto& force : b.forces)
    if (force.constraint && force.factor >= kNotSeen) by.push_back(d.step.constraints[*force.constraint]);
  if (by.empty()) return "";
  return fmt::format("The robot is held by {}: no allowed velocity has a component towards the preferred one.\n",
                     formation::name_of(by, d.scenario, d.bodies));
}

std::string way_words(const Decision& d) {
  switch (d.step.mode) {
    case formation::Mode::guided:
      return "the preferred velocity leads along a proven route";
    case formation::Mode::by_plan:
      return "the preferred velocity follows a joint plan of several robots";
    case formation::Mode::going_back:
      return "the robot goes back the way it came, to where its plan begins";
    case formation::Mode::staying:
      return d.scenario.formation ? "the robot stays, since its slot cannot be filled"
                                  : "the robot stays, since its goal is out of reach or taken";
    case formation::Mode::boost:
      return "boost turned the preferred velocity onto the tangent of the enclosure in the way";
    case formation::Mode::following:
      return "the preferred velocity follows the boundary, after a stall";
    case formation::Mode::pushing_out:
      return "the robot is in contact, and the preferred velocity leads away from it";
    case formation::Mode::steered:
      return "the preferred velocity was set by the user";
    default:
      return "";
  }
}

/// Rule R1 of liveness.
std::string keep_right_words(const Decision& d) {
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  const double angle = kDegrees * d.step.turned_right;
  if (number(angle) == number(0.0)) return "";
  return fmt::format("it is turned {} degrees to the right, to pass other robots on the same side as they do",
                     number(angle));
}

/// How the preferred velocity came about, where it is not simply straight for the goal.
std::string turned_words(const Decision& d) {
  const std::string way = way_words(d), right = keep_right_words(d);
  if (right.empty()) return way;
  return way.empty() ? "the preferred velocity leads to the goal; " + right : way + "; " + right;
}

/// Those that are binding, but push nothing.
std::string idle_words(const Decision& d, const Balance& b) {
  std::vector<std::size_t> idle;
  for (std::size_t i = 0; i < d.step.constraints.size(); ++i) {
    const bool binds = effect_of(d, d.step.constraints[i]) == Effect::binding;
    if (binds && b.factor_of(i) < kNotSeen) idle.push_back(i);
  }
  if (idle.empty()) return "";
  return fmt::format("     It lies on the line{} of {}, which {} not change it.\n", idle.size() == 1 ? "" : "s",
                     numbered(idle), idle.size() == 1 ? "does" : "do");
}

std::string unmoved_words(const Decision& d) {
  // Moving obstacles leave it nothing but to stand: its preferred velocity is then 0, whatever led to it.
  if (meets_movers(d.scenario) && d.step.stopping_steps == 0)
    return "Why: it stands, since a moving obstacle could reach it while it moves, at any velocity from which it "
           "stands "
           "again after a time step.\n";
  const std::string turned = turned_words(d);
  if (turned.empty() && idle_words(d, {}).empty()) return "Why: no constraint forbids the preferred velocity.\n";
  const std::string reason = turned.empty() ? "the preferred velocity" : turned + "; it";
  return "Why: " + reason + " is allowed.\n" + idle_words(d, {});
}

std::string moved_words(const Decision& d) {
  const Balance b = balance_of(d.step);
  if (b.remainder > kBalanced) return "";
  const std::string turned = turned_words(d);
  return balance_words(b) + idle_words(d, b) + (turned.empty() ? "" : "     Before that, " + turned + ".\n") +
         (is_held(d) ? held_words(d, b) : "");
}

/// Which half-planes have the greatest violation, which is the least possible, and which are violated by less.
std::string relaxed_words(const Decision& d) {
  std::vector<std::size_t> violated, most, less;
  double greatest = 0.0;
  for (std::size_t i = 0; i < d.step.constraints.size(); ++i) {
    if (effect_of(d, d.step.constraints[i]) != Effect::violated) continue;
    violated.push_back(i);
    greatest = std::max(greatest, violation_of(d.step.constraints[i], d.step.chosen));
  }
  for (const std::size_t i : violated)
    (violation_of(d.step.constraints[i], d.step.chosen) > greatest - kOnLine ? most : less).push_back(i);
  std::string text = "Why: no velocity satisfies all half-planes; the chosen one has the least greatest violation";
  if (!most.empty()) text += ", that of " + numbered(most);
  if (!less.empty()) text += fmt::format("; {} {} violated by less", numbered(less), less.size() == 1 ? "is" : "are");
  return text + ".\n";
}

std::string fallen_words(const Decision& d) {
  const std::vector<DecisionConstraint>& all = d.step.constraints;
  const auto fallen = std::find_if(all.begin(), all.end(), [](const DecisionConstraint& c) { return c.fell_back; });
  if (fallen == all.end()) return "";
  if (formation::braking_time_of(d.scenario) > 0.0)
    return fmt::format(
        "Fell back: half-planes of one robot of the pair contradicted each other. Both have those of two robots that "
        "brake,\n"
        "     looking {:g} s ahead, which braking satisfies.\n",
        fallen->time_horizon);
  return fmt::format(
      "Fell back: half-planes of one robot of the pair contradicted each other. Both have those of two robots at "
      "rest,\n"
      "     looking {:g} s ahead, which standing still satisfies.\n",
      fallen->time_horizon);
}

/// What the user has asked for in this step.
std::string own_words(const Decision& d) {
  std::string text;
  for (const formation::OwnConstraint& c : d.step.own) {
    const double violation = geometry::violation(c.half_plane, d.step.chosen) / norm(c.half_plane.normal);
    const std::string effect = violation > kOnLine ? "violated by " + amount(violation) + " m/s"
                               : c.active          ? "binding"
                                                   : "slack";
    text += fmt::format("Asked by the user, {}: {:+.3f} v_x {:+.3f} v_y >= {:+.3f} m/s, {}\n", c.hard ? "hard" : "soft",
                        c.half_plane.normal.x, c.half_plane.normal.y, c.half_plane.offset, effect);
  }
  if (d.step.own_stage == formation::OwnStage::left_out)
    text += "     Left out: half-planes against obstacles and robots leave no room by themselves.\n";
  return text;
}

std::string why(const Decision& d) {
  if (d.step.status == lp::Status::relaxed) return relaxed_words(d);
  if (d.step.status != lp::Status::optimal) return "";
  return takes_preferred(d) ? unmoved_words(d) : moved_words(d);
}

}  // namespace

Decision decision_of(const formation::Scenario& scenario, const std::string& method, std::size_t robot,
                     const formation::Step& row, const std::vector<vo::Body>& bodies, bool has_all_half_planes) {
  Decision d{scenario, method, robot, row.time, row.robots.at(robot), bodies, has_all_half_planes};
  const formation::WaitForGraph waits = formation::waiting_in(scenario, row);
  d.waits_for = waits[robot];
  d.waiting = formation::waiting_words(scenario, row, waits, robot);
  for (const DecisionConstraint& c : d.step.constraints)
    d.seen.push_back(formation::seen_body(scenario, bodies, row, robot, c));
  return d;
}

double violation_of(const DecisionConstraint& constraint, Vec2 v) {
  return geometry::violation(constraint.half_plane, v) / norm(constraint.half_plane.normal);
}

Effect effect_of(const Decision& decision, const DecisionConstraint& constraint) {
  const double violation = violation_of(constraint, decision.step.chosen);
  if (violation > kOnLine) return Effect::violated;
  return constraint.active && violation >= -kNotSeen ? Effect::binding : Effect::slack;
}

std::string name(Effect effect) {
  return effect == Effect::slack ? "slack" : effect == Effect::binding ? "binding" : "violated";
}

GrownShape grown_shape(const formation::SeenBody& seen) {
  return {seen.shape, seen.position, seen.radius};
}

double distance_to(const GrownShape& s) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) least = std::min(least, support(s, direction(i)).h);
  return -least;
}

std::optional<double> time_to_contact(const GrownShape& s, Vec2 v) {
  // t v lies in S iff t n.v <= h_S(n) for every n: each direction bounds t from one side.
  double first = 0.0;
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const Vec2 n = direction(i);
    const double h = support(s, n).h;
    const double speed = dot(n, v);
    if (speed > 0.0) last = std::min(last, h / speed);
    if (speed < 0.0) first = std::max(first, h / speed);
    if (speed == 0.0 && h < 0.0) return std::nullopt;
  }
  if (first > last) return std::nullopt;
  return first;
}

std::string explanation(const Decision& decision) {
  return head(decision) + constraints_words(decision) + why(decision) + own_words(decision) + fallen_words(decision);
}

}  // namespace exactvo::tools
