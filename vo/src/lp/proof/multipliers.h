// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The multipliers with which what binds makes a velocity stationary (solution.h has the equations). Rounded; whether
/// they prove an answer is for rounded_gap.h and `check` to say.

#include <array>
#include <optional>
#include <vector>

#include "exactvo/vo/lp/certificate.h"
#include "lp/proof/rounded_gap.h"

namespace exactvo::lp {

// In the next two functions `m` says which are meant; its values are not read.

/// The multipliers of the at most two that bind at the optimum v, the disc's nu among them. Each is 0 or more; not
/// finite where the two are parallel.
Multipliers multipliers_of_optimum(const Problem& problem, Vec2 v, Multipliers m);

/// Weights of at most three lines (no disc) whose sum of normals vanishes or, `on_disc`, of two lines whose sum points
/// along v. Negative or not finite where these lines have none.
Multipliers weights_of_lines(const Problem& problem, Vec2 v, Multipliers m, bool on_disc);

/// For a line that touches the disc at v, so that no other velocity satisfies both: no multipliers make v stationary
/// there, and the larger they are, the smaller is the gap. These leave about u of its unit. Of the objective, with the
/// disc's nu for Objective::nearest; of the violation of `gives`, with the line between it and the disc.
Multipliers multipliers_where_touching(const Problem& problem, Vec2 v, Binding line);
Multipliers weights_where_touching(const Problem& problem, Binding line, Binding gives);

/// The normals of what is active in a solution, in its order; the entry of the disc is not read.
using Normals = std::array<Vec2, 3>;

/// Sets the multipliers of what `solution` says binds.
void set_multipliers(const Normals& normals, Objective objective, Vec2 preferred, Solution& solution);
void set_multipliers(const Problem& problem, Solution& solution);

/// The multipliers of a solution that count in (2), (3) or (4) of certificate.h, none of them 0; none at all where one
/// cannot be used.
Multipliers own_multipliers(const Problem& problem, const Solution& solution);

/// The terms as multipliers in double; nothing where one is a sum of several doubles, or where there are more than
/// three.
std::optional<Multipliers> in_doubles(const std::vector<Term>& terms);

/// Whether these are the solution's own multipliers, all of them.
bool has_multipliers_of(const Problem& problem, const Multipliers& proof, const Solution& solution);

/// Sets these multipliers, and that of a disc which they leave out.
void set_multipliers(const Problem& problem, const Multipliers& proof, Solution& solution);

}  // namespace exactvo::lp
