// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How far the median of a few measurements can be trusted.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace exactvo::bench {

struct Interval {
  double low = 0.0, high = 0.0;
};

/// The interval between two measurements that holds the true median with a probability of 95 % or more, whatever the
/// distribution: below the k-th smallest of n it lies with that of fewer than k heads in n throws. Of five measurements
/// or fewer, their range (of five: 94 %). REQUIRES: 1 to 1,000 measurements.
inline Interval interval_of_median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  double heads = std::ldexp(1.0, -static_cast<int>(n)), fewer = heads;  // k throws of n; at most k
  std::size_t k = 0;
  for (; 2 * (k + 1) < n; ++k) {
    heads *= static_cast<double>(n - k) / static_cast<double>(k + 1);
    if (2.0 * (fewer + heads) > 0.05) break;
    fewer += heads;
  }
  return {values[k], values[n - 1 - k]};
}

}  // namespace exactvo::bench
