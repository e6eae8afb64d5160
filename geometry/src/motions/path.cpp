// SPDX-License-Identifier: GPL-3.0-or-later
#include "motions/path.h"

#include <algorithm>

namespace exactvo::geometry::motions {

Window common_window(const Motion& a, const Motion* b) {
  Window w{start_of(a), end_of(a)};
  if (b) w = {std::max(w.from, start_of(*b)), std::min(w.to, end_of(*b))};
  return w;
}

Vec2 origin_of(const Motion& motion) {
  if (const auto* straight = std::get_if<StraightMotion>(&motion)) return straight->from.at;
  return std::get<CurvedMotion>(motion).points.front();
}

std::vector<std::vector<double>> b_spline_weights(std::size_t degree) {
  // d w_j^d(u) = (u + d - j) w_{j-1}^{d-1}(u) + (1 + j - u) w_j^{d-1}(u), w_0^0 = 1 (de Boor's recursion on uniform
  // knots), each times d!.
  std::vector<std::vector<double>> weights{{1.0}};
  for (std::size_t d = 1; d <= degree; ++d) {
    std::vector<std::vector<double>> next(d + 1, std::vector<double>(d + 1, 0.0));
    const auto add = [](std::vector<double>& sum, const std::vector<double>& of, double constant, double slope) {
      for (std::size_t k = 0; k < of.size(); ++k) {
        sum[k] += constant * of[k];
        sum[k + 1] += slope * of[k];
      }
    };
    for (std::size_t j = 0; j <= d; ++j) {
      if (j > 0) add(next[j], weights[j - 1], static_cast<double>(d - j), 1.0);
      if (j < d) add(next[j], weights[j], static_cast<double>(1 + j), -1.0);
    }
    weights = std::move(next);
  }
  return weights;
}

}  // namespace exactvo::geometry::motions
