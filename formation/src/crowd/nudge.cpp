// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/nudge.h"

#include <limits>

namespace exactvo::formation::crowd {
namespace {

/// Lattice steps: farther from the optimum no motion is tried.
constexpr int kNudge = 3;

}  // namespace

template <class T>
bool keeps(const KindTable<T>& table, const Answers<T>& in, double mx, double my, double max_speed) {
  const double unit = table.velocity_step, allowed = table.spare - 0x1p-46 * max_speed;
  for (std::size_t k = 0; k < in.lines; ++k) {
    const std::size_t at = k * in.stride;
    const double met = unit * mx * static_cast<double>(in.x[at]) + unit * my * static_cast<double>(in.y[at]);
    if (static_cast<double>(in.c[at]) - met > allowed) return false;
  }
  return true;
}

template <class T>
bool nudge(const KindTable<T>& table, const Answers<T>& in, double max_speed, std::int32_t& mx, std::int32_t& my) {
  const double unit = table.velocity_step;
  const double limit = max_speed * max_speed * (1.0 - 0x1p-46);
  const double x0 = static_cast<double>(in.vx[0]) / unit, y0 = static_cast<double>(in.vy[0]) / unit;
  double least = std::numeric_limits<double>::infinity();
  const std::int32_t from_x = mx, from_y = my;
  for (int j = -kNudge; j <= kNudge; ++j)
    for (int i = -kNudge; i <= kNudge; ++i) {
      const double x = from_x + i, y = from_y + j, away = (x - x0) * (x - x0) + (y - y0) * (y - y0);
      if (!(away < least) || (x * x + y * y) * unit * unit > limit || !keeps(table, in, x, y, max_speed)) continue;
      least = away;
      mx = from_x + i;
      my = from_y + j;
    }
  return least < std::numeric_limits<double>::infinity();
}

template bool keeps(const KindTable<float>&, const Answers<float>&, double, double, double);
template bool nudge(const KindTable<float>&, const Answers<float>&, double, std::int32_t&, std::int32_t&);
template bool keeps(const KindTable<double>&, const Answers<double>&, double, double, double);
template bool nudge(const KindTable<double>&, const Answers<double>&, double, std::int32_t&, std::int32_t&);

}  // namespace exactvo::formation::crowd
