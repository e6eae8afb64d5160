// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Axes of a plane that lies far from (0, 0): their numbers count from a round point nearby, which the labels name,
/// since six digits a tick cannot tell metres at 5.5e6 apart. Data files keep the coordinates as they are, with all
/// digits; the scripts subtract. Exact enough for drawing: a difference of doubles that are near each other.

#include <string>
#include <utility>

#include "figures/figure.h"
#include "figures/outlines.h"

namespace exactvo::tools {

/// Sets the ranges of both axes.
std::string axis_ranges(const Box& view);

class LocalOrigin {
 public:
  /// (0, 0) where the numbers in view can be read as they are: below 10^5 and a hundred times the view.
  explicit LocalOrigin(const Box& view);

  bool is_far() const { return x_.first != 0.0 || y_.first != 0.0; }
  Vec2 place() const { return {x_.first, y_.first}; }

  /// "using 1:2" or the same with x0 and y0 subtracted; `more` are further columns: ":3".
  std::string using_columns(int x = 1, int y = 2, const std::string& more = "") const;
  /// Sets x0 and y0, and the ranges of the axes.
  std::string ranges(const Box& view) const;
  /// "x [m]" or "x - 5500000 [m]".
  std::string x_label() const { return label("x", x_); }
  std::string y_label() const { return label("y", y_); }
  /// " - (500000, 5500000)" for titles of panels without labels; empty where not far.
  std::string in_title() const;
  /// Has `data` write all digits where they are needed.
  void prepare(DataFile& data) const {
    if (is_far()) data.write_all_digits();
  }

 private:
  /// A number, and its text.
  using Coordinate = std::pair<double, std::string>;
  static Coordinate round_number_near(double low, double high, double extent);
  static std::string label(const char* axis, const Coordinate& c);

  Coordinate x_{0.0, "0"}, y_{0.0, "0"};
};

}  // namespace exactvo::tools
