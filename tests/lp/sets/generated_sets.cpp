// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/sets/generated_sets.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace exactvo::lp {
namespace {

constexpr double kSpeed = 2.0;         ///< m/s, v_max of every set
constexpr double kWitnessReach = 0.9;  ///< of v_max
constexpr double kMostSlack = 1.5;     ///< m/s
constexpr double kSpread = 0.35;       ///< rad
constexpr double kFarPoint = 100.0;    ///< m/s
constexpr int kAdversarialLines = 10;

/// SplitMix64 over (seed, set, instance): number k of a stream is the same everywhere.
class Stream {
 public:
  Stream(std::uint64_t seed, std::uint64_t set, std::uint64_t instance)
      : state_(mix(mix(mix(seed) ^ set) ^ instance)) {}

  double uniform(double low, double high) {
    state_ += kGamma;
    return low + (high - low) * (static_cast<double>(mix(state_) >> 11) * 0x1p-53);
  }

  double sign() { return uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }

  std::size_t below(std::size_t n) { return static_cast<std::size_t>(uniform(0.0, static_cast<double>(n))); }

  Vec2 in_disc(double radius) {
    for (;;) {
      const Vec2 v = {uniform(-1.0, 1.0), uniform(-1.0, 1.0)};
      if (squared_norm(v) <= 1.0) return radius * v;
    }
  }

  Vec2 direction() {
    for (;;) {
      const Vec2 v = in_disc(1.0);
      const double squared = squared_norm(v);
      if (squared > 0.01) return v / std::sqrt(squared);
    }
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9E3779B97F4A7C15ULL;
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

/// Sine and cosine by their series, |angle| <= 0.35: the library's may differ between machines in the last digit.
Vec2 turned_slightly(Vec2 n, double angle) {
  const double s2 = angle * angle;
  const double sine = angle * (1.0 - s2 / 6.0 * (1.0 - s2 / 20.0 * (1.0 - s2 / 42.0 * (1.0 - s2 / 72.0))));
  const double cosine = 1.0 - s2 / 2.0 * (1.0 - s2 / 12.0 * (1.0 - s2 / 30.0 * (1.0 - s2 / 56.0 * (1.0 - s2 / 90.0))));
  return {cosine * n.x - sine * n.y, sine * n.x + cosine * n.y};
}

Vec2 turned_by_third(Vec2 n) {
  const double half_root_three = 0.86602540378443864676;
  return {-0.5 * n.x - half_root_three * n.y, half_root_three * n.x - 0.5 * n.y};
}

void add(Problem& problem, Vec2 normal, double offset) {
  problem.constraints.push_back({{normal, offset}, Priority::soft, static_cast<int>(problem.constraints.size())});
}

Problem empty_problem() {
  Problem problem;
  problem.bound.disc = kSpeed;
  return problem;
}

void add_around(Problem& problem, Stream& random, Vec2 centre, int count, double least, double most) {
  for (int k = 0; k < count; ++k) {
    const Vec2 n = random.direction();
    add(problem, n, dot(n, centre) - random.uniform(least, most));
  }
}

Problem random_feasible(Stream& random, int m) {
  Problem problem = empty_problem();
  add_around(problem, random, random.in_disc(kWitnessReach * kSpeed), m, 0.0, kMostSlack);
  problem.preferred = random.in_disc(kSpeed);
  return problem;
}

void shuffle(std::vector<Constraint>& constraints, Stream& random) {
  for (std::size_t k = constraints.size(); k > 1; --k) std::swap(constraints[k - 1], constraints[random.below(k)]);
}

Problem random_infeasible(Stream& random, int m) {
  Problem problem = empty_problem();
  const Vec2 centre = random.in_disc(0.5 * kSpeed);
  Vec2 n = random.direction();
  for (int k = 0; k < 3; ++k, n = turned_by_third(n)) {
    const Vec2 turned = turned_slightly(n, random.uniform(-kSpread, kSpread));
    add(problem, turned, dot(turned, centre) + random.uniform(0.05, 0.5));
  }
  add_around(problem, random, centre, m - 3, -0.5, 1.0);
  shuffle(problem.constraints, random);
  problem.preferred = random.in_disc(kSpeed);
  return problem;
}

/// What the families build on: a point inside the disc, a direction, and the perturbation.
struct Setting {
  Vec2 at;
  Vec2 n;
  double e;
};

void parallel(Problem& problem, Stream& random, const Setting& s) {
  for (int k = 0; k < 3; ++k) {
    const Vec2 n = turned_slightly(s.n, s.e * random.uniform(-1.0, 1.0));
    add(problem, n, dot(n, s.at) + s.e * random.uniform(-1.0, 1.0));
  }
}

void corridor(Problem& problem, Stream& random, const Setting& s) {
  const double offset = dot(s.n, s.at);
  add(problem, s.n, offset);
  add(problem, -s.n, -offset + random.sign() * s.e);
}

void through(Problem& problem, Stream& random, const Setting& s) {
  problem.preferred = s.at;
  for (int k = 0; k < 2; ++k) {
    const Vec2 n = random.direction();
    add(problem, n, dot(n, s.at) + random.sign() * s.e);
  }
}

void tangent(Problem& problem, Stream& random, const Setting& s) {
  add(problem, s.n, kSpeed + random.sign() * s.e);
  problem.preferred = random.in_disc(kSpeed);
}

void concurrent(Problem& problem, Stream& random, const Setting& s) {
  Vec2 n = s.n;
  for (int k = 0; k < 3; ++k, n = turned_by_third(n)) {
    const Vec2 turned = turned_slightly(n, random.uniform(-kSpread, kSpread));
    add(problem, turned, dot(turned, s.at) + s.e * random.uniform(-1.0, 1.0));
  }
}

void far(Problem& problem, Stream& random, const Setting& s) {
  const Vec2 along = perp(s.n);
  const Vec2 one = s.at + kFarPoint * along;
  const Vec2 other = s.at - kFarPoint * along + (random.sign() * s.e) * s.n;
  add(problem, s.n, dot(s.n, one));
  add(problem, -s.n, -dot(s.n, other));
}

using Family = void (*)(Problem&, Stream&, const Setting&);
struct NamedFamily {
  const char* name;
  Family build;
};
constexpr NamedFamily kFamilies[] = {{"parallel", parallel}, {"corridor", corridor},     {"through", through},
                                     {"tangent", tangent},   {"concurrent", concurrent}, {"far", far}};

Problem adversarial(Family build, Stream& random, double perturbation) {
  Problem problem = empty_problem();
  problem.preferred = random.in_disc(kSpeed);
  const Setting setting = {random.in_disc(kWitnessReach * kSpeed), random.direction(), perturbation};
  build(problem, random, setting);
  const int rest = kAdversarialLines - static_cast<int>(problem.constraints.size());
  add_around(problem, random, setting.at, rest, 0.1, kMostSlack);
  return problem;
}

std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return hash;
}

/// The number after `prefix`, or nothing where the name is not of this kind.
bool number_after(const std::string& name, const std::string& prefix, double& number) {
  if (name.compare(0, prefix.size(), prefix) != 0 || name.size() == prefix.size()) return false;
  std::size_t used = 0;
  try {
    number = std::stod(name.substr(prefix.size()), &used);
  } catch (const std::exception&) {
    return false;
  }
  return used == name.size() - prefix.size();
}

struct Recipe {
  double number = 0.0;
  int lines = 0;  ///< of RF and RI
  bool feasible = true;
  Family family = nullptr;
};

bool read_recipe(const std::string& set, Recipe& recipe) {
  for (const bool feasible : {true, false}) {
    if (!number_after(set, feasible ? "RF" : "RI", recipe.number)) continue;
    recipe.lines = static_cast<int>(recipe.number);
    recipe.feasible = feasible;
    return recipe.lines == recipe.number && recipe.lines >= (feasible ? 0 : 3);
  }
  for (const NamedFamily& family : kFamilies) {
    recipe.family = family.build;
    if (number_after(set, std::string(family.name) + ":", recipe.number)) return recipe.number >= 0.0;
  }
  return false;
}

/// For whoever named it: on a bench's command line, as a rule.
std::string no_such_set(const std::string& set) {
  std::string families;
  for (const NamedFamily& family : kFamilies) families += std::string(" ") + family.name + ":E";
  return "there is no set \"" + set +
         "\" of linear programs; expected RFm, m lines from 0 on; RIm, m from 3 on; or, with "
         "a perturbation E from 0 on, one of" +
         families + "; for example RF10, RI10, far:1e-6";
}

}  // namespace

std::vector<std::string> adversarial_families() {
  std::vector<std::string> names;
  for (const NamedFamily& family : kFamilies) names.emplace_back(family.name);
  return names;
}

std::vector<Problem> generate(const std::string& set, std::size_t count, std::uint64_t seed, std::size_t first) {
  Recipe recipe;
  if (!read_recipe(set, recipe)) throw std::logic_error(no_such_set(set));
  const std::uint64_t hash = hash_of(set);
  std::vector<Problem> problems;
  problems.reserve(count);
  for (std::size_t k = first; k < first + count; ++k) {
    Stream random(seed, hash, k);
    if (recipe.family)
      problems.push_back(adversarial(recipe.family, random, recipe.number));
    else
      problems.push_back(recipe.feasible ? random_feasible(random, recipe.lines)
                                         : random_infeasible(random, recipe.lines));
  }
  return problems;
}

}  // namespace exactvo::lp
