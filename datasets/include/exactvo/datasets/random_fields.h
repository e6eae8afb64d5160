// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random fields: scenes for counts, drawn by a counter-based generator of the project's own. Field k of a kind and
/// seed is the same on every machine: corners lie on a grid of 2^-10 m, far coarser than what mathematical libraries
/// differ by.
///
/// Properties (tests quote the numbers):
///  (1) field k does not depend on which fields were drawn before;
///  (2) every field passes formation::validate;
///  (3) circumcircles keep the distances below, up to the grid.

#include <cstdint>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// What is drawn.
enum class FieldKind {
  /// One robot, (0,0) -> (25,13): up to 5 regular polygons of 3-6 corners, circumradius 0.8-3.0 m, centres in
  /// [3,22] x [-1,14], circumcircles 1.4 m apart and 0.8 m clear of start and goal. 60 s.
  convex,
  /// The same with open walls, L and U shapes of the same extent.
  open,
  /// Three robots and a leader (0,0) -> (25,25): 6 regular polygons of 3-6 corners, circumradius 0.6-2.0 m, centres up
  /// to 4 m off the diagonal, circumcircles 1.6 m apart and 0.8 m clear of where robots start and end. 25 s.
  formation
};

/// "convex", "open", "formation".
const char* name(FieldKind kind);
/// Every name.
std::vector<std::string> field_kind_names();
/// False for an unknown name; `out` is then unchanged.
bool parse(const std::string& text, FieldKind& out);

/// Seed of the published counts.
inline constexpr std::uint64_t kFieldSeed = 2024;

/// Field number `k`; its name is "convex-2024-17".
formation::Scenario random_field(FieldKind kind, std::uint64_t k, std::uint64_t seed = kFieldSeed);

}  // namespace exactvo::datasets
