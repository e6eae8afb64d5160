// SPDX-License-Identifier: GPL-3.0-or-later
#include "route_mutations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace exactvo::test {
namespace {

using geometry::Blocked;
using geometry::ChainPoint;
using geometry::EdgeName;
using geometry::ExactPoint;
using geometry::Route;
using geometry::Separated;

/// Draws the changes. Each function changes its argument, or leaves it as it is where there is nothing to change.
class Mutator {
 public:
  Mutator(const std::vector<Obstacle>& obstacles, SeededRandom& random) : obstacles_(obstacles), random_(random) {}

  std::string change(Certificate& c) {
    if (one_of(4)) return change_question(c.question);
    if (one_of(20)) return claim_anything(c);
    if (auto* route = std::get_if<Route>(&c.answer)) return change_route(*route);
    if (auto* separated = std::get_if<Separated>(&c.answer)) return change_chain(separated->chain);
    return change_blocked(std::get<Blocked>(c.answer));
  }

 private:
  bool one_of(int n) { return random_.integer(1, n) == 1; }
  std::size_t index(std::size_t size) {
    return static_cast<std::size_t>(random_.integer(0, static_cast<int>(size) - 1));
  }
  /// A size from 1e-17 to 10.
  double any_size() { return std::pow(10.0, random_.uniform(-17.0, 1.0)); }

  double moved(double x) {
    if (one_of(4)) return std::nextafter(x, one_of(2) ? HUGE_VAL : -HUGE_VAL);
    if (one_of(30)) return one_of(2) ? std::numeric_limits<double>::quiet_NaN() : HUGE_VAL;
    return x + (one_of(2) ? any_size() : -any_size());
  }
  Vec2 moved(Vec2 p) {
    if (one_of(3)) return {moved(p.x), p.y};
    if (one_of(2)) return {p.x, moved(p.y)};
    return {moved(p.x), moved(p.y)};
  }
  Vec2 moved_but_finite(Vec2 p) {
    const Vec2 q = moved(p);
    return is_finite(q) ? q : p;
  }

  std::string change_question(geometry::RouteQuestion& q) {
    switch (random_.integer(0, 4)) {
      case 0:
        q.start = moved_but_finite(q.start);
        return "start moved";
      case 1:
        q.goal = moved_but_finite(q.goal);
        return "goal moved";
      case 2:
        std::swap(q.start, q.goal);
        return "ends swapped";
      default:
        q.radius = one_of(3) ? std::nextafter(q.radius, one_of(2) ? HUGE_VAL : 0.0)
                             : q.radius * (1.0 + (one_of(2) ? any_size() : -std::min(1.0, any_size())));
        return "radius changed";
    }
  }

  /// An answer that has nothing to do with the one that was given.
  std::string claim_anything(Certificate& c) {
    switch (random_.integer(0, 2)) {
      case 0: {
        const double length = norm(c.question.goal - c.question.start);
        c.answer = Route{{{c.question.start, {}, {}}, {c.question.goal, {}, {}}}, length, length};
        return "straight claimed";
      }
      case 1: {
        Separated round;
        const std::size_t obstacle = index(obstacles_.size());
        for (const Vec2 p : vertices_of(obstacles_[obstacle]))
          round.chain.push_back({{p, {}, {}}, {obstacle, round.chain.size()}, false});
        c.answer = round;
        return "ring claimed";
      }
      default:
        c.answer = Blocked{one_of(2) ? Blocked::End::start : Blocked::End::goal, one_of(2), any_edge()};
        return "block claimed";
    }
  }

  std::string change_route(Route& route) {
    std::vector<ExactPoint>& points = route.points;
    switch (random_.integer(0, 6)) {
      case 0: {
        static constexpr double kFactors[] = {1e-15, -1e-15, 1e-11, -1e-11, 1e-6, -1e-3, 1.0, -1.0, -2.0};
        route.length *= 1.0 + kFactors[index(std::size(kFactors))];
        return "length changed";
      }
      case 1:
        route.lower_bound = one_of(3)   ? -route.lower_bound - 1e-3
                            : one_of(2) ? std::numeric_limits<double>::quiet_NaN()
                                        : route.length * (1.0 + 1e-8 + any_size()) + 1e-300;
        return "bound changed";
      case 2:
        if (points.size() > 1) std::swap(points[index(points.size())], points[index(points.size())]);
        return "points swapped";
      case 3:
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(index(points.size())));
        return "point erased";
      case 4:
        points.insert(points.begin() + static_cast<std::ptrdiff_t>(index(points.size())), {any_vertex(), {}, {}});
        return "vertex inserted";
      default:
        return change_point(points[index(points.size())]);
    }
  }

  std::string change_chain(std::vector<ChainPoint>& chain) {
    const std::size_t at = index(chain.size());
    switch (random_.integer(0, 7)) {
      case 0:
        chain[at].gap_follows = !chain[at].gap_follows;
        return "gap flipped";
      case 1:
        chain[at].on =
            one_of(2) ? any_edge() : EdgeName{chain[at].on.obstacle, chain[at].on.edge + (one_of(2) ? 1 : -1)};
        return "edge changed";
      case 2:
        std::swap(chain[at], chain[index(chain.size())]);
        return "points swapped";
      case 3:
        chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(at));
        return "point erased";
      case 4: {
        const EdgeName edge = any_edge();
        const geometry::Segment s = edges_of(obstacles_[edge.obstacle])[edge.edge];
        chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(at), {{s.a, {}, {}}, edge, one_of(2)});
        return "corner inserted";
      }
      case 5:
        if (one_of(2))
          std::reverse(chain.begin(), chain.end());
        else
          std::rotate(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(at), chain.end());
        return "chain turned";
      default:
        return change_point(chain[at].point);
    }
  }

  std::string change_blocked(Blocked& blocked) {
    switch (random_.integer(0, 2)) {
      case 0:
        blocked.end = blocked.end == Blocked::End::start ? Blocked::End::goal : Blocked::End::start;
        return "end flipped";
      case 1:
        blocked.inside = !blocked.inside;
        return "inside flipped";
      default:
        blocked.by = any_edge();
        return "edge changed";
    }
  }

  std::string change_point(ExactPoint& p) {
    std::string& text = one_of(2) ? p.x : p.y;
    if (!text.empty() && one_of(2)) {
      change_digits(text);
      return "fraction changed";
    }
    if (text.empty() && one_of(5)) {
      static const char* const kTexts[] = {"0", "1/0", "1/", "/1", "-1/2", "1/-2", "--1", "0x1", "1e0", " 1", "1 /2"};
      text = kTexts[index(std::size(kTexts))];
      return "fraction added";
    }
    if (one_of(6)) {
      p = {any_vertex(), {}, {}};
      return "point onto vertex";
    }
    const Vec2 to = moved(p.rounded);
    if (!p.x.empty() || !p.y.empty()) {
      if (one_of(2)) {
        p.rounded = to;
        return "rounded moved";
      }
      p = {p.rounded, {}, {}};
      return "fractions dropped";
    }
    p.rounded = to;
    return "point moved";
  }

  void change_digits(std::string& text) {
    static const std::string kLetters = "0123456789/-";
    const std::size_t at = index(text.size());
    const char letter = kLetters[index(kLetters.size())];
    switch (random_.integer(0, 2)) {
      case 0:
        text[at] = letter;
        break;
      case 1:
        text.insert(at, 1, letter);
        break;
      default:
        text.erase(at, 1);
    }
  }

  EdgeName any_edge() {
    const std::size_t obstacle = index(obstacles_.size());
    return {obstacle, index(edges_of(obstacles_[obstacle]).size())};
  }
  Vec2 any_vertex() {
    const std::vector<Vec2> all = vertices_of(obstacles_[index(obstacles_.size())]);
    return all[index(all.size())];
  }

  const std::vector<Obstacle>& obstacles_;
  SeededRandom& random_;
};

}  // namespace

std::string to_string(const Certificate& c) {
  using geometry::hex_text;
  std::string text = "radius " + hex_text(c.question.radius);
  text += " ends " + geometry::to_string({c.question.start, c.question.goal});
  const auto add_point = [&](const ExactPoint& p) {
    text += " (" + hex_text(p.rounded.x) + " " + hex_text(p.rounded.y) + " '" + p.x + "' '" + p.y + "')";
  };
  const auto add_edge = [&](const EdgeName& e) {
    text += " on " + std::to_string(e.obstacle) + ":" + std::to_string(e.edge);
  };
  if (const auto* route = std::get_if<Route>(&c.answer)) {
    text += " route " + hex_text(route->length) + " " + hex_text(route->lower_bound);
    for (const ExactPoint& p : route->points) add_point(p);
  } else if (const auto* separated = std::get_if<Separated>(&c.answer)) {
    text += " separated";
    for (const ChainPoint& p : separated->chain) {
      add_point(p.point);
      add_edge(p.on);
      if (p.gap_follows) text += " gap";
    }
  } else {
    const Blocked& blocked = std::get<Blocked>(c.answer);
    text += blocked.end == Blocked::End::start ? " blocked start" : " blocked goal";
    if (blocked.inside) text += " inside";
    add_edge(blocked.by);
  }
  return text;
}

Mutant mutated(const std::vector<Obstacle>& obstacles, const Certificate& original, SeededRandom& random) {
  Mutator mutator(obstacles, random);
  const std::string before = to_string(original);
  for (;;) {
    Mutant out{original, ""};
    out.change = mutator.change(out.certificate);
    if (to_string(out.certificate) != before) return out;
  }
}

}  // namespace exactvo::test
