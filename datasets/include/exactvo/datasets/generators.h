// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles by seed, in any number: for counts, for timing and for tests that try to break programs. Drawn by the
/// project's counter-based generator with whole numbers and the four operations only, so item k of a kind and seed is
/// the same on every machine, bit for bit. (CGAL's own generators follow the C library and the standard library's
/// distributions.) The kinds `field-...` are those of random_fields.h, whose corners lie on a grid far coarser than
/// what libraries differ by.
///
/// Items stand side by side, each in a square of its own: 4 in two rows, 16 in four, whatever the number asked for.
///
/// Properties (tests quote the numbers):
///  (1) item k does not depend on which items were drawn before, nor on how many are asked for;
///  (2) every obstacle is valid: `geometry::normalize` repairs nothing of it but closure;
///  (3) obstacles of different items do not meet.

#include <cstdint>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// A kind of obstacles to generate.
struct GeneratorKind {
  std::string name;  ///< "polygon", "maze" and so on
  std::string what;  ///< one line, with sizes in metres
};

/// In the order of the documentation.
const std::vector<GeneratorKind>& generator_kinds();
/// The names alone, in the same order.
std::vector<std::string> generator_kind_names();

/// The obstacles of item k, ids "maze-17/0" and so on. REQUIRES: a name of `generator_kinds()`.
std::vector<formation::SceneObstacle> generated_item(const std::string& kind, std::uint64_t k, std::uint64_t seed);

}  // namespace exactvo::datasets
