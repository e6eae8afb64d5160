// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Why an answer is right, as numbers that a reader can multiply out: multipliers for an optimum, a contradiction of at
/// most three constraints where they cannot all hold. `check` verifies in rationals, in O(m), and knows no solver.
///
/// With w = sum of lambda_i n_i, C = sum of lambda_i c_i, all lambda_i >= 0, and sigma(w) = max of w.v within the speed
/// bound (disc: |w| disc; box: box_x |w_x| + box_y |w_y|; either serves), every v within the bound and inside the
/// half-planes named has C <= w.v <= sigma(w). Hence
///  (1) C > sigma(w) is a contradiction: no v satisfies all of them;
///  (2) least violation: where v keeps the hard ones and violates soft ones by at most t, C - sigma(w) <= t (sum of
///      lambda over the soft ones);
///  (3) farthest along d: d.v <= sigma(d + w) - C;
///  (4) nearest p: with nu >= 0 for the disc, |v - p|^2 >= |p|^2 + 2C - |p + w|^2/(1 + nu) - nu disc^2 (weak duality).
/// The second objective of a relaxed answer (nearest among the least violating) is not part of the proof.

#include <optional>
#include <vector>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// A constraint, a side of the box or the disc, and its multiplier: the exact sum of `multiplier`, mostly one double.
struct Term {
  Binding binding;                 ///< what the multiplier belongs to
  std::vector<double> multiplier;  ///< dimensionless
};

/// The proof of one answer.
struct Certificate {
  Status status = Status::optimal;  ///< what is claimed
  geometry::Vec2 velocity;          ///< m/s, what the claim is about
  double violation = 0.0;           ///< as Solution::violation; no constraint that may give is violated by more
  std::vector<Term> contradiction;  ///< relaxed, infeasible: at most three terms, by (1)
  std::vector<Term> bound;          ///< why no velocity is better than by `gap`; at most three terms
  /// How much better a velocity could be at most, 0 or more: of |v - preferred|^2 in m^2/s^2 (nearest), of preferred.v
  /// in m/s |preferred| (farthest), of the violation in m/s |n|. A rounding error where `is_tight`.
  double gap = 0.0;
  /// no_interior: at most two constraints or sides of the box; the point of their boundaries that is nearest 0
  /// satisfies everything (the hard ones only, where there is a contradiction), exactly.
  std::vector<Binding> vertex;
};

/// Why a certificate proves nothing.
enum class CertificateError {
  none,           ///< the certificate proves its claim
  malformed,      ///< indices, counts, signs or numbers out of range
  velocity,       ///< the velocity violates what the status says it satisfies
  contradiction,  ///< (1) fails
  bound,          ///< (2), (3) or (4) fails for the gap stated
  vertex          ///< the vertex violates something that it must satisfy
};

/// "none", "malformed", "velocity", "contradiction", "bound", "vertex".
const char* name(CertificateError flaw);

/// Exact: rational arithmetic throughout, O(m). Any certificate is fine as input, also a broken one.
/// REQUIRES: a well-formed problem.
CertificateError check(const Problem& problem, const Certificate& certificate);

/// A certificate that `check` accepts for this solution, or nothing where the solution is not right, or is right and
/// its active set does not show why. REQUIRES: a well-formed problem.
std::optional<Certificate> certify(const Problem& problem, const Solution& solution);

/// The claim of a solution's multipliers, as a certificate: its terms are the active constraints, which for a relaxed
/// or infeasible answer are the contradiction too, and the gap is the widest that a double answer may have
/// (kWidestGap). `check` says whether it holds: it does for every answer that `certify` proves, so that a decision
/// recorded with its multipliers carries its proof. REQUIRES: a well-formed problem.
Certificate claim_of(const Problem& problem, const Solution& solution);

/// The gap up to which a double answer passes: this share of its unit, which is (V + |preferred|)^2 (nearest),
/// V |preferred| (farthest), or V times the longest |normal| of the constraints in `bound` that may be violated, at
/// least the violation itself. V is the speed bound or, where there is none, the largest speed of the data. The tables
/// ask for violations of at most 1e-12; 2^-40 is 9e-13.
inline constexpr double kWidestGap = 0x1p-40;

/// Whether the gap is small enough to call the answer proven: kWidestGap of its unit for violations, 2^-20 of it where
/// optimal, since in a region as sharp as a needle no double lies nearer to the best point; V is |velocity| where that
/// is more. REQUIRES: a certificate that `check` accepts.
bool is_tight(const Problem& problem, const Certificate& certificate);

/// An answer with its proof.
struct Proven {
  Solution solution;  ///< rounded inward; what it claims is what the certificate proves
  /// Absent only where multipliers leave the range of double (numbers in the problem beyond 2^+-300).
  std::optional<Certificate> certificate;
  bool exact_stage = false;  ///< the double answer could not be certified
};

/// The double answer with its certificate, or where it has none, the exact one with its. Never wrong.
/// REQUIRES: a well-formed problem.
Proven solve_certified(const Problem& problem);

/// The same for an answer that exists already, from `solve` for instance.
Proven certified(const Problem& problem, const Solution& solution);

/// Whether `certified` needs no exact stage: then the multipliers of `solution` are its proof (`claim_of`), and no
/// certificate is written out. They stay what they are where that shows by rounding, and else are those that
/// `certified` finds. Allocates only where signs are computed exactly. REQUIRES: a well-formed problem.
bool is_proven_by_multipliers(const Problem& problem, Solution& solution);

/// The exact answer: every branch decided in exact arithmetic, the optimum an algebraic point, rounded inward.
/// REQUIRES: a well-formed problem.
Proven solve_exact(const Problem& problem);

}  // namespace exactvo::lp
