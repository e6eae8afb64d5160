// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/exact_legs.h"

#include <fmt/format.h>

#include <algorithm>

namespace exactvo::tools {
namespace {

using geometry::Sign;
using vo::AlgebraicDirection;

/// Of the slope: narrower than a double of it.
constexpr double kWidth = 0x1p-60;

std::string joined(const std::vector<std::string>& items, const char* between) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : between) + item;
  return text;
}

std::string leg_json(const char* side, const AlgebraicDirection& leg) {
  const AlgebraicDirection fine = leg.refined(kWidth);
  const geometry::Vec2 d = fine.rounded();
  return fmt::format(
      "{{\"side\": \"{}\", \"polynomial\": [\"{}\"], \"slope\": [\"{}\", \"{}\"], \"quarter_turns\": {}, "
      "\"direction\": [{}, {}]}}",
      side, joined(fine.polynomial(), "\", \""), fine.low(), fine.high(), fine.quarter_turns(), d.x, d.y);
}

std::string polynomial_words(const std::vector<std::string>& coefficients) {
  std::string text;
  for (std::size_t i = coefficients.size(); i-- > 0;) {
    const std::string& c = coefficients[i];
    if (c == "0") continue;
    const bool minus = c.front() == '-';
    text += text.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
    text += minus ? c.substr(1) : c;
    if (i > 0) text += i == 1 ? " t" : fmt::format(" t^{}", i);
  }
  return text;
}

std::string leg_words(const char* side, const AlgebraicDirection& leg) {
  const geometry::Vec2 d = leg.rounded();
  return fmt::format("{:<17} ({:.6g}, {:.6g}): (1, t) turned by {} quarters, {} = 0\n", side, d.x, d.y,
                     leg.quarter_turns(), polynomial_words(leg.polynomial()));
}

struct NamedLeg {
  const LegsOfCone* of;
  const char* side;
  const AlgebraicDirection* leg;
};

std::vector<NamedLeg> in_order(const std::vector<LegsOfCone>& legs) {
  std::vector<NamedLeg> all;
  for (const LegsOfCone& of : legs) {
    all.push_back({&of, "left", &of.legs->left});
    all.push_back({&of, "right", &of.legs->right});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const NamedLeg& a, const NamedLeg& b) { return compare(*a.leg, *b.leg) == Sign::negative; });
  return all;
}

}  // namespace

std::string exact_legs_json(const vo::ExactLegs& legs) {
  return fmt::format("[{},\n           {}]", leg_json("left", legs.left), leg_json("right", legs.right));
}

std::string legs_by_angle_json(const std::vector<LegsOfCone>& legs) {
  const std::vector<NamedLeg> all = in_order(legs);
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool equal = i > 0 && compare(*all[i - 1].leg, *all[i].leg) == Sign::zero;
    text += i == 0 ? "[" : equal ? ", " : "], [";
    text += fmt::format("{{\"obstacle\": {}, \"cone\": {}, \"side\": \"{}\"}}", all[i].of->obstacle, all[i].of->cone,
                        all[i].side);
  }
  return "[" + text + (all.empty() ? "]" : "]]");
}

std::string exact_legs_words(const vo::ExactLegs& legs) {
  return leg_words("left leg", legs.left) + leg_words("right leg", legs.right);
}

}  // namespace exactvo::tools
