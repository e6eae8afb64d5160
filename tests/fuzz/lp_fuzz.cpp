// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a problem: each solver against the exact one, and every certificate against `check`.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "bytes.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/vo/lp/solvers.h"
#include "problem_kinds.h"
#include "problem_text.h"

namespace exactvo::lp {
namespace {

constexpr std::size_t kMostConstraints = 12;

using fuzz::Bytes;

Problem problem_from(Bytes bytes) {
  Problem p;
  const std::uint8_t kind = bytes.byte();
  if ((kind & 1U) != 0) p.bound.disc = std::abs(bytes.number());
  if ((kind & 2U) != 0) p.bound.box_x = std::abs(bytes.number());
  if ((kind & 4U) != 0) p.bound.box_y = std::abs(bytes.number());
  p.preferred = {bytes.number(), bytes.number()};
  const bool bounded = (kind & 1U) != 0 || (kind & 6U) == 6;
  if ((kind & 8U) != 0 && bounded && p.preferred != Vec2{}) p.objective = Objective::farthest;
  while (!bytes.empty() && p.constraints.size() < kMostConstraints) {
    const auto priority = bytes.byte() % 2 == 0 ? Priority::hard : Priority::soft;
    const Vec2 n = {bytes.number(), bytes.number()};
    const double offset = bytes.number();
    if (n != Vec2{}) p.constraints.push_back({{n, offset}, priority, -1});
  }
  return p;
}

/// Lines as velocity obstacles give them: normals of length 1 (of 255 directions, none opposite another) and moderate
/// numbers; every kind of bound, objective and priorities. Thin regions are rare, and
/// none is so thin that plain doubles may err by more than `kAlike`.
Problem plain_problem_from(Bytes bytes) {
  Problem p;
  const std::uint8_t kind = bytes.byte();
  if ((kind & 1U) == 0) p.bound.disc = 1.0 + (kind >> 4 & 3U);
  if ((kind & 2U) != 0) p.bound.box_x = 1.0 + (kind >> 5 & 3U);
  if ((kind & 4U) != 0) p.bound.box_y = 1.0 + (kind >> 6 & 3U);
  const bool bounded = (kind & 1U) == 0 || (kind & 6U) == 6;
  if ((kind & 8U) != 0 && bounded) p.objective = Objective::farthest;
  p.preferred = {bytes.byte() / 64.0 - 2.0, bytes.byte() / 64.0 - 2.0};
  if (p.objective == Objective::farthest && p.preferred == Vec2{}) p.preferred = {1.0, 0.0};
  while (!bytes.empty() && p.constraints.size() < kMostConstraints) {
    const double angle = bytes.byte() % 255 * (geometry::kPi / 127.5);
    const std::uint8_t kind = bytes.byte();
    const auto priority = kind % 2 == 0 ? Priority::hard : Priority::soft;
    p.constraints.push_back({{{std::cos(angle), std::sin(angle)}, kind / 64.0 - 2.0}, priority, -1});
  }
  return p;
}

[[noreturn]] void fail(const char* what, const Problem& problem) {
  std::fprintf(stderr, "%s\n%s", what, text_of(problem).c_str());
  std::abort();
}

/// no_interior with a contradiction: the hard ones can be held; without: all can.
Status verdict(const Proven& p) {
  if (p.solution.status != Status::no_interior) return p.solution.status;
  return p.certificate && !p.certificate->contradiction.empty() ? Status::relaxed : Status::optimal;
}

void examine(const Problem& problem) {
  const Proven exact = solve_exact(problem);
  for (const Solver solver : {Solver::batch, Solver::certified, Solver::exact}) {
    Proven answer = solve_all(solver, {problem}).front();
    prove(problem, answer);
    if (!answer.certificate) fail("no certificate", problem);
    if (check(problem, *answer.certificate) != CertificateError::none)
      fail("a certificate that does not hold", problem);
    if (verdict(answer) != verdict(exact)) fail("a wrong verdict", problem);
  }
}

/// Two lines of those directions, or one and a side of the box, meet at 0.35 degrees at least, or are parallel: an
/// error of 100 u V grows by 164, and by 164 again for a third.
constexpr double kAlike = 1e-8;

void examine_plain(const Problem& problem) {
  const Solution right = solve_exact(problem).solution;
  const Solution s = solve_all(Solver::batch, {problem}).front().solution;
  if (!why_worse(problem, s, right, kAlike, Compared::what_is_proven).empty())
    fail("a plain answer that is worse than the exact one", problem);
}

}  // namespace
}  // namespace exactvo::lp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  exactvo::lp::examine(exactvo::lp::problem_from({data, size}));
  const exactvo::lp::Problem plain = exactvo::lp::plain_problem_from({data, size});
  exactvo::lp::examine(plain);
  exactvo::lp::examine_plain(plain);
  return 0;
}
