// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The half-planes of up to sixteen robots, in the layout that the linear program reads, and its answers on the
/// lattice.

#include "crowd/kinds.h"
#include "crowd/layout.h"

namespace exactvo::formation::crowd {

/// Half-planes of the ranks of the query; lanes without a neighbour at a rank get (1, 0), kNever. Certified: satisfied
/// with `lattice_slack` to spare they are safe.
LineFlags make_lines(const KindTable<float>& table, const LineQuery& query, const LineRows<float>& out);
LineFlags make_lines(const KindTable<double>& table, const LineQuery& query, const LineRows<double>& out);

/// Answers of the linear program, by lane.
template <class T>
struct Answers {
  const T *vx = nullptr, *vy = nullptr;              ///< m/s
  const T *x = nullptr, *y = nullptr, *c = nullptr;  ///< rows of lines
  std::size_t lines = 0, stride = 0;
  const std::uint8_t* status = nullptr;  ///< 0: all lines are kept
  const T* allowed = nullptr;            ///< m/s, by how much a rounded velocity may violate its lines
};

/// Whole motions, lattice steps.
struct Rounded {
  alignas(64) std::int32_t mx[kPack], my[kPack];
};

/// Velocities rounded to whole motions. Bit `lane`: kept, max c - n.v, computed in T, is not above what is allowed; of
/// lines that are not certified: the status is 0.
std::uint32_t round_to_lattice(const KindTable<float>& table, const Answers<float>& answers, Rounded& out);
std::uint32_t round_to_lattice(const KindTable<double>& table, const Answers<double>& answers, Rounded& out);

}  // namespace exactvo::formation::crowd
