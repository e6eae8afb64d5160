// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/local_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace exactvo::tools {

namespace {

/// gnuplot writes six digits a tick, and from 10^6 on with an exponent.
constexpr double kReadable = 1e5;
/// Two digits of the six go where neighbouring ticks are a fifth of the view apart; one is kept to spare.
constexpr double kMostViews = 100.0;

}  // namespace

std::string axis_ranges(const Box& view) {
  return fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]", view.low.x, view.high.x, view.low.y,
                     view.high.y);
}

LocalOrigin::LocalOrigin(const Box& view) {
  const double extent = std::max(view.width(), view.height());
  if (view.is_empty() || !(extent > 0.0) || !std::isfinite(extent)) return;
  x_ = round_number_near(view.low.x, view.high.x, extent);
  y_ = round_number_near(view.low.y, view.high.y, extent);
}

/// A multiple of the power of ten above the view, so that the subtraction can be done in one's head.
LocalOrigin::Coordinate LocalOrigin::round_number_near(double low, double high, double extent) {
  const double farthest = std::max(std::abs(low), std::abs(high));
  const bool is_near = farthest <= 2.0 * extent || (farthest < kReadable && farthest <= kMostViews * extent);
  if (is_near) return {0.0, "0"};
  const int exponent = static_cast<int>(std::ceil(std::log10(extent)));
  const std::string text =
      fmt::format("{:.{}f}", std::round(0.5 * (low + high) / std::pow(10.0, exponent)) * std::pow(10.0, exponent),
                  std::max(0, -exponent));
  return {std::stod(text), text};
}

std::string LocalOrigin::using_columns(int x, int y, const std::string& more) const {
  return is_far() ? fmt::format("using (${} - x0):(${} - y0){}", x, y, more) : fmt::format("using {}:{}{}", x, y, more);
}

std::string LocalOrigin::ranges(const Box& view) const {
  const std::string settings = is_far() ? fmt::format("x0 = {:#}\ny0 = {:#}\n", x_.first, y_.first) : "";
  return settings + axis_ranges({view.low - place(), view.high - place()});
}

std::string LocalOrigin::in_title() const {
  return is_far() ? fmt::format(" - ({}, {})", x_.second, y_.second) : "";
}

std::string LocalOrigin::label(const char* axis, const Coordinate& c) {
  if (c.first == 0.0) return fmt::format("{} [m]", axis);
  return c.first < 0.0 ? fmt::format("{} + {} [m]", axis, c.second.substr(1))
                       : fmt::format("{} - {} [m]", axis, c.second);
}

}  // namespace exactvo::tools
