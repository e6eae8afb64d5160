// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Differential tests against CGAL's exact parts: each topic compares random and constructed (tangent,
/// degenerate) cases and prints what differs, losslessly.

#include <cstdio>
#include <string>

#include "support/seeded_random.h"

namespace exactvo::test {

/// How many cases are asked for.
struct Asked {
  long random = 0;
  long constructed = 0;
  std::uint64_t seed = 1;
};

/// How many were compared, and how many differed.
class Tally {
 public:
  void random(bool same, const std::string& text) { count(random_, same, text); }
  void constructed(bool same, const std::string& text) { count(constructed_, same, text); }
  void at_a_contact() { ++contacts_; }
  /// CGAL refused the case with an assertion of its own: it is not compared.
  void oracle_gave_up() { ++given_up_; }

  long random_cases() const { return random_; }
  long constructed_cases() const { return constructed_; }
  long contacts() const { return contacts_; }  ///< of the compared, those whose exact answer is a touch or a tie
  long given_up() const { return given_up_; }
  long mismatches() const { return mismatches_; }

 private:
  void count(long& cases, bool same, const std::string& text) {
    ++cases;
    if (same) return;
    ++mismatches_;
    constexpr long kShown = 10;
    if (mismatches_ <= kShown) std::fprintf(stderr, "differs: %s\n", text.c_str());
  }
  long random_ = 0, constructed_ = 0, contacts_ = 0, given_up_ = 0, mismatches_ = 0;
};

/// `locate` and `segment_meets` of discs, segments and polygons against squared distances in CGAL's EPECK.
Tally compare_distances(const Asked& asked);
/// `locate` of polygon (+) disc against the conic arrangement of `offset_polygon_2`.
Tally compare_offsets(const Asked& asked);
/// `locate` of ellipse (+) disc against intersections of conic arcs (Arr_conic_traits_2).
Tally compare_conics(const Asked& asked);
/// The legs of ellipse (+) disc against the roots of their quartic (Algebraic_kernel_d_1).
Tally compare_legs(const Asked& asked);
/// Smallest ellipses against Min_ellipse_2 in rationals.
Tally compare_ellipses(const Asked& asked);
/// Sums of polygons against minkowski_sum_2, by convolution and by decomposition.
Tally compare_sums(const Asked& asked);

}  // namespace exactvo::test
