// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "exactvo/geometry/infinity.h"
#include "lp/proof/certify.h"
#include "lp/proof/duality.h"

namespace exactvo::lp {
namespace {

struct Weighted {
  Binding binding;
  Exact multiplier;
};

/// Multipliers may share any positive factor: a power of two that brings the largest near 1.
void normalise(std::vector<Weighted>& terms) {
  const auto largest = [&] {
    double most = 0.0;
    for (const Weighted& t : terms) most = std::max(most, t.multiplier.to_double());
    return most;
  };
  const auto scale = [&](double factor) {
    for (Weighted& t : terms) t.multiplier = t.multiplier * Exact(factor);
  };
  constexpr int kMostScalings = 40;  // numbers of degree four in doubles lie within 2^+-4400
  for (int k = 0; k < kMostScalings && largest() > 0x1p200; ++k) scale(0x1p-200);
  for (int k = 0; k < kMostScalings && largest() < 0x1p-200; ++k) scale(0x1p200);
}

std::vector<double> parts_of(Exact x) {
  std::vector<double> parts;
  while (sign_of(x) != 0) {
    const double part = x.to_double();
    if (part == 0.0 || std::abs(part) == geometry::kInfinity) break;
    parts.push_back(part);
    x = x - Exact(part);
  }
  return parts;
}

/// Empty where they are not all of one sign.
std::vector<Term> terms_of(const std::vector<Weighted>& weights) {
  std::vector<Term> terms;
  for (const Weighted& w : weights) {
    if (sign_of(w.multiplier) < 0) return {};
    if (sign_of(w.multiplier) > 0) terms.push_back({w.binding, parts_of(w.multiplier)});
  }
  return terms;
}

/// The multipliers, rounded to one double each where that still contradicts.
std::vector<Term> proven(const Problem& problem, std::vector<Weighted> weights) {
  normalise(weights);
  const std::vector<Term> whole = terms_of(weights);
  std::vector<Term> rounded = whole;
  for (Term& term : rounded) term.multiplier.resize(1);
  for (const std::vector<Term>& terms : {rounded, whole}) {
    const Combination sum = combine(problem, terms, Scope::soft_may_give);
    if (sum.well_formed && contradicts(problem, sum)) return terms;
  }
  return {};
}

/// Two opposite lines: the sum of normals cancels.
std::vector<Weighted> of_opposite(const Problem& problem, Binding a, Binding b) {
  const Vec2 na = half_plane_at(problem, a).normal;
  const Vec2 nb = half_plane_at(problem, b).normal;
  const bool by_x = std::abs(na.x) > std::abs(na.y);
  return {{a, Exact(std::abs(by_x ? nb.x : nb.y))}, {b, Exact(std::abs(by_x ? na.x : na.y))}};
}

/// Two lines and the disc: the multipliers that make their sum point from 0 to where they cross.
std::vector<Weighted> of_crossing(const Problem& problem, Binding a, Binding b) {
  const ExactLine la = exact(half_plane_at(problem, a));
  const ExactLine lb = exact(half_plane_at(problem, b));
  const Exact between = dot(la.normal, lb.normal);
  return {{a, la.offset * dot(lb.normal, lb.normal) - lb.offset * between},
          {b, lb.offset * dot(la.normal, la.normal) - la.offset * between}};
}

/// Three lines: the sum of normals cancels.
std::vector<Weighted> of_three(const Problem& problem, Binding a, Binding b, Binding c) {
  const ExactVector na = exact(half_plane_at(problem, a).normal);
  const ExactVector nb = exact(half_plane_at(problem, b).normal);
  const ExactVector nc = exact(half_plane_at(problem, c).normal);
  const Exact wa = cross(nb, nc), wb = cross(nc, na), wc = cross(na, nb);
  const Exact sign(sign_of(wa) + sign_of(wb) + sign_of(wc) < 0 ? -1 : 1);
  return {{a, sign * wa}, {b, sign * wb}, {c, sign * wc}};
}

}  // namespace

std::vector<Term> contradiction_of(const Problem& problem, const std::vector<Binding>& bindings) {
  std::vector<Binding> lines;
  for (const Binding b : bindings)
    if (b != kDisc) lines.push_back(b);
  std::vector<std::vector<Weighted>> choices;
  for (const Binding a : lines) choices.push_back({{a, Exact(1)}});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      choices.push_back(of_opposite(problem, lines[i], lines[j]));
      choices.push_back(of_crossing(problem, lines[i], lines[j]));
    }
  }
  if (lines.size() == 3) choices.push_back(of_three(problem, lines[0], lines[1], lines[2]));
  for (const std::vector<Weighted>& weights : choices) {
    std::vector<Term> terms = proven(problem, weights);
    if (!terms.empty()) return terms;
  }
  return {};
}

std::vector<Term> cancelling_terms(const Problem& problem, const std::vector<Binding>& lines) {
  std::vector<Weighted> weights =
      lines.size() == 3 ? of_three(problem, lines[0], lines[1], lines[2]) : of_opposite(problem, lines[0], lines[1]);
  normalise(weights);
  return terms_of(weights);
}

}  // namespace exactvo::lp
