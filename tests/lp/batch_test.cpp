// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "exactvo/vo/lp/certificate.h"
#include "lp/sets/generated_sets.h"
#include "lp/sets/target.h"
#include "problem_text.h"
#include "support/seeded_random.h"

namespace exactvo::lp {
namespace {

constexpr std::size_t kBlock = 16;

/// Problems as arrays; a block is kBlock problems, or all of them where `plain`.
template <class T>
class Batch {
 public:
  explicit Batch(std::vector<Problem> problems, bool plain = false) : problems_(std::move(problems)) {
    count_ = problems_.size();
    stride_ = (count_ + kBlock - 1) / kBlock * kBlock;
    block_ = plain ? stride_ : kBlock;
    for (Problem& p : problems_) {
      std::stable_sort(p.constraints.begin(), p.constraints.end(), [](const Constraint& a, const Constraint& b) {
        return a.priority == Priority::hard && b.priority == Priority::soft;
      });
      lines_ = std::max(lines_, p.constraints.size());
    }
    fill();
  }

  BatchProblems<T> in() const {
    return {count_,    lines_,     block_,     nx_.data(),   ny_.data(),
            c_.data(), px_.data(), py_.data(), disc_.data(), hard_.data()};
  }
  BatchAnswers<T> out() {
    return {vx.data(), vy.data(), violation.data(), status.data(), active.data(), stride_, nullptr};
  }
  const std::vector<Problem>& problems() const { return problems_; }

  Solution solution(std::size_t i) const {
    Solution s;
    s.velocity = {static_cast<double>(vx[i]), static_cast<double>(vy[i])};
    s.status = static_cast<Status>(status[i]);
    s.violation = static_cast<double>(violation[i]);
    for (std::size_t slot = 0; slot < 3; ++slot)
      if (active[slot * stride_ + i] != kNoLine)
        s.active[s.active_count++].binding = constraint_at(static_cast<std::size_t>(active[slot * stride_ + i]));
    if (s.active_count < 3) s.active[s.active_count++].binding = kDisc;
    return s;
  }

  std::vector<T> vx, vy, violation;
  std::vector<std::uint8_t> status;
  std::vector<std::int32_t> active;

 private:
  void fill() {
    const std::size_t all = lines_ * stride_;
    nx_.assign(all, T(1));
    ny_.assign(all, T(0));
    c_.assign(all, T(-1e30));
    for (auto* array : {&px_, &py_, &disc_, &vx, &vy, &violation}) array->assign(stride_, T(1));
    hard_.assign(stride_, 0);
    status.assign(stride_, 0);
    active.assign(3 * stride_, 0);
    for (std::size_t i = 0; i < count_; ++i) fill(i, problems_[i]);
  }

  void fill(std::size_t i, const Problem& p) {
    px_[i] = static_cast<T>(p.preferred.x);
    py_[i] = static_cast<T>(p.preferred.y);
    disc_[i] = static_cast<T>(p.bound.disc);
    for (std::size_t k = 0; k < p.constraints.size(); ++k) {
      const std::size_t at = i / block_ * block_ * lines_ + k * block_ + i % block_;
      nx_[at] = static_cast<T>(p.constraints[k].half_plane.normal.x);
      ny_[at] = static_cast<T>(p.constraints[k].half_plane.normal.y);
      c_[at] = static_cast<T>(p.constraints[k].half_plane.offset);
      hard_[i] += p.constraints[k].priority == Priority::hard;
    }
  }

  std::vector<Problem> problems_;
  std::size_t count_ = 0, lines_ = 0, stride_ = 0, block_ = 0;
  std::vector<T> nx_, ny_, c_, px_, py_, disc_;
  std::vector<std::int32_t> hard_;
};

std::vector<Problem> mixture(bool hard) {
  std::vector<Problem> problems;
  for (const char* set : {"RF10", "RI10", "RF3", "RI20", "RF60", "RI60"}) {
    const auto more = generate(set, 1003, 21);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  for (std::size_t k = 0; hard && k < problems.size(); k += 2)
    for (std::size_t j = 0; j < problems[k].constraints.size(); j += 3)
      problems[k].constraints[j].priority = Priority::hard;
  return problems;
}

class Kinds : public testing::TestWithParam<bool> {};

TEST_P(Kinds, VerdictsAndCertificatesAreThoseOfTheCertifiedSolver) {
  Batch<double> batch(mixture(GetParam()));
  solve_batch(batch.in(), batch.out(), 0, batch.problems().size());
  for (std::size_t i = 0; i < batch.problems().size(); ++i) {
    const Problem& problem = batch.problems()[i];
    const Solution s = batch.solution(i);
    ASSERT_STREQ(name(s.status), name(solve_certified(problem).solution.status)) << text_of(problem);
    const auto certificate = certify(problem, s);
    ASSERT_TRUE(certificate.has_value()) << i << ' ' << name(s.status) << " active " << s.active[0].binding.index << ' '
                                         << s.active[1].binding.index << ' ' << s.active[2].binding.index << '\n'
                                         << text_of(problem);
    ASSERT_EQ(check(problem, *certificate), CertificateError::none);
  }
}

TEST_P(Kinds, EveryTargetLayoutAndThreadCountGivesTheSameBits) {
  Batch<double> widest(mixture(GetParam()));
  solve_batch(widest.in(), widest.out(), 0, widest.problems().size());
  const auto expect_equal = [&](const Batch<double>& other) {
    EXPECT_EQ(widest.vx, other.vx);
    EXPECT_EQ(widest.vy, other.vy);
    EXPECT_EQ(widest.violation, other.violation);
    EXPECT_EQ(widest.status, other.status);
    EXPECT_EQ(widest.active, other.active);
  };
  for (const char* target : {"AVX2", "SSE4", "SSE2"}) {
    if (!limit_batch_target(target)) continue;
    Batch<double> narrow(mixture(GetParam()));
    solve_batch(narrow.in(), narrow.out(), 0, narrow.problems().size());
    expect_equal(narrow);
  }
  ASSERT_TRUE(limit_batch_target(""));
  Batch<double> threads(mixture(GetParam()));
  solve_batch_parallel(threads.in(), threads.out());
  expect_equal(threads);
  Batch<double> singly(mixture(GetParam()), true);
  for (std::size_t i = 0; i < singly.problems().size(); ++i) solve_batch(singly.in(), singly.out(), i, i + 1);
  expect_equal(singly);
}

/// With as few arrays as a caller may give: a kernel of its own.
template <class T>
void expect_same_bits_of_the_barest(const std::vector<Problem>& problems, bool some_hard, bool prove) {
  const auto solved = [&](bool bare) {
    Batch<T> batch(problems);
    std::vector<std::uint8_t> proven(batch.status.size());
    BatchProblems<T> in = batch.in();
    BatchAnswers<T> out = batch.out();
    if (bare) out.active = nullptr;
    if (bare && !some_hard) in.hard = nullptr;
    if (prove) out.proven = proven.data();
    solve_batch(in, out, 0, in.count);
    return batch;
  };
  const Batch<T> full = solved(false);
  for (const char* target : {"", "AVX2", "SSE4"}) {
    if (!limit_batch_target(target)) continue;
    const Batch<T> bare = solved(true);
    EXPECT_EQ(bare.vx, full.vx);
    EXPECT_EQ(bare.vy, full.vy);
    EXPECT_EQ(bare.violation, full.violation);
    EXPECT_EQ(bare.status, full.status);
  }
  ASSERT_TRUE(limit_batch_target(""));
}

TEST_P(Kinds, UnusedInputsChangeNoBit) {
  expect_same_bits_of_the_barest<double>(mixture(GetParam()), GetParam(), false);
  expect_same_bits_of_the_barest<double>(mixture(GetParam()), GetParam(), true);
  expect_same_bits_of_the_barest<float>(mixture(GetParam()), GetParam(), false);
}

TEST(Batch, UnusedInputsChangeNoBitOfAdversarialAnswers) {
  for (const std::string& family : adversarial_families())
    for (const char* perturbation : {"1e-3", "1e-9", "1e-15", "0"}) {
      const std::vector<Problem> problems = generate(family + ":" + perturbation, 500, 9);
      expect_same_bits_of_the_barest<double>(problems, false, false);
      expect_same_bits_of_the_barest<double>(problems, false, true);
      expect_same_bits_of_the_barest<float>(problems, false, false);
    }
}

/// How many packs go together depends on their lines.
TEST(Batch, AnyNumberOfLinesIsProven) {
  for (const char* set : {"RF1", "RI15", "RF25", "RI40", "RI100", "RF200"}) {
    Batch<double> batch(generate(set, 331, 5));
    std::vector<std::uint8_t> proven(batch.status.size());
    BatchAnswers<double> out = batch.out();
    out.proven = proven.data();
    solve_batch(batch.in(), out, 0, 331);
    EXPECT_EQ(std::count(proven.begin(), proven.end(), 1), 331) << set;
    for (std::size_t i = 0; i < 331; ++i)
      ASSERT_TRUE(certify(batch.problems()[i], batch.solution(i)).has_value()) << text_of(batch.problems()[i]);
  }
}

TEST_P(Kinds, LanesAreProvenInTheSamePass) {
  Batch<double> batch(mixture(GetParam()));
  std::vector<std::uint8_t> proven(batch.status.size());
  BatchAnswers<double> out = batch.out();
  out.proven = proven.data();
  const BatchCounts counts = solve_batch(batch.in(), out, 0, batch.problems().size());
  const auto contradicting = std::count(batch.status.begin(), batch.status.end(), 2);  // hard lines: scalar by design
  EXPECT_LE(counts.scalar, static_cast<std::size_t>(contradicting) + batch.problems().size() / 100);
  for (std::size_t i = 0; i < batch.problems().size(); ++i) {
    const Problem& problem = batch.problems()[i];
    EXPECT_EQ(proven[i], 1);
    const auto certificate = certify(problem, batch.solution(i));
    ASSERT_TRUE(certificate.has_value()) << text_of(problem);
  }
}

TEST(Batch, AdversarialVerdictsAreRightWhereProofIsAskedFor) {
  for (const std::string& family : adversarial_families()) {
    for (const char* perturbation : {"1e-6", "1e-9", "1e-12", "1e-15", "1e-17", "0"}) {
      Batch<double> batch(generate(family + ":" + perturbation, 500, 8));
      std::vector<std::uint8_t> proven(batch.status.size());
      BatchAnswers<double> out = batch.out();
      out.proven = proven.data();
      solve_batch(batch.in(), out, 0, batch.problems().size());
      for (std::size_t i = 0; i < batch.problems().size(); ++i)
        EXPECT_EQ(batch.solution(i).status == Status::relaxed,
                  solve_exact(batch.problems()[i]).solution.status == Status::relaxed)
            << text_of(batch.problems()[i]);  // all soft: optimal and no_interior both say feasible
    }
  }
}

TEST_P(Kinds, FloatVerdictsAreNearlyAlwaysRight) {
  Batch<float> batch(mixture(GetParam()));
  solve_batch(batch.in(), batch.out(), 0, batch.problems().size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < batch.problems().size(); ++i)
    wrong += batch.solution(i).status != solve_certified(batch.problems()[i]).solution.status;
  EXPECT_LE(wrong, batch.problems().size() / 500);
}

INSTANTIATE_TEST_SUITE_P(Lines, Kinds, testing::Values(false, true),
                         [](const auto& kind) { return kind.param ? "SomeHard" : "AllSoft"; });

/// The numbers of a counter, mixed: the same everywhere.
double uniform(std::uint64_t& counter, double least, double most) {
  std::uint64_t z = counter += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return least + (most - least) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// Walls that pass within some units in the last place of one point, and a robot that asks for what lies far outside
/// the disc: the violation, up to 2^`most_level` times the speed, is many roundings of the walls wide.
/// Out of line, since GCC 12 drops such conversions where it sees two side by side.
template <class T>
[[gnu::noinline]] double as_given(double x) {
  return static_cast<double>(static_cast<T>(x));
}

template <class T>
Problem crowded_wall(std::uint64_t& counter, double most_level) {
  const double u = static_cast<double>(std::numeric_limits<T>::epsilon()) / 2.0;
  Problem p;
  p.bound.disc = 1.0;
  p.preferred = {0.0, as_given<T>(uniform(counter, -0.6, 0.6))};
  p.constraints.push_back({{{1.0, 0.0}, 0.5}, Priority::hard, -1});
  const int more = uniform(counter, 0.0, 1.0) < 0.6 ? 1 : 2;
  for (int k = 0; k < more; ++k) {
    const double angle = uniform(counter, -1.2, 1.2), x = as_given<T>(std::cos(angle)),
                 y = as_given<T>(std::sin(angle));
    const double offset = 0.5 * x + p.preferred.y * y + uniform(counter, 15.0, 60.0) * u;
    p.constraints.push_back({{{x, y}, as_given<T>(offset)}, Priority::hard, -1});
  }
  const double far = as_given<T>(std::exp2(uniform(counter, 1.0, most_level)));
  p.constraints.push_back({{{-1.0, 0.0}, far}, Priority::soft, -1});
  return p;
}

template <class T>
std::vector<Problem> crowded_walls(double most_level) {
  std::vector<Problem> problems;
  std::uint64_t counter = 5;
  for (int k = 0; k < 6000; ++k) problems.push_back(crowded_wall<T>(counter, most_level));
  return problems;
}

/// Exact: `check` looks at the velocity before it looks for a proof.
bool keeps_hard_lines(const Problem& problem, Vec2 velocity) {
  Problem hard = problem;
  hard.constraints.erase(std::remove_if(hard.constraints.begin(), hard.constraints.end(),
                                        [](const Constraint& c) { return c.priority == Priority::soft; }),
                         hard.constraints.end());
  Certificate claim;
  claim.velocity = velocity;
  return check(hard, claim) != CertificateError::velocity;
}

template <class T>
std::size_t broken_walls(const Batch<T>& batch) {
  std::size_t broken = 0;
  for (std::size_t i = 0; i < batch.problems().size(); ++i) {
    const Solution s = batch.solution(i);
    const bool must = s.status == Status::optimal || s.status == Status::relaxed;
    broken += must && !keeps_hard_lines(batch.problems()[i], s.velocity);
  }
  return broken;
}

template <class T>
void expect_walls_kept(double most_level) {
  Batch<T> batch(crowded_walls<T>(most_level));
  solve_batch(batch.in(), batch.out(), 0, batch.problems().size());
  EXPECT_EQ(broken_walls(batch), 0u);
  EXPECT_GT(std::count(batch.status.begin(), batch.status.end(), 1), 3000);
}

TEST(Batch, HardLinesHoldHoweverFarSoftOnesGive) {
  for (const double most_level : {6.0, 30.0}) {
    expect_walls_kept<double>(most_level);
    expect_walls_kept<float>(most_level);
  }
}

TEST(Batch, WhatIsProvenKeepsTheHardLines) {
  Batch<double> batch(crowded_walls<double>(6.0));
  std::vector<std::uint8_t> proven(batch.status.size());
  BatchAnswers<double> out = batch.out();
  out.proven = proven.data();
  solve_batch(batch.in(), out, 0, batch.problems().size());
  EXPECT_EQ(broken_walls(batch), 0u);
  EXPECT_EQ(std::count(proven.begin(), proven.begin() + 6000, 1), 6000);
}

/// Random contradictions of which up to four lines, anywhere, are hard.
std::vector<Problem> contradictions_with_walls(std::size_t count) {
  test::SeededRandom random(test::seed_of_run(2027));
  std::vector<Problem> problems = generate("RI10", count, 31);
  for (Problem& p : problems)
    for (int walls = random.integer(0, 4); walls > 0; --walls)
      p.constraints[static_cast<std::size_t>(random.integer(0, 9))].priority = Priority::hard;
  return problems;
}

// One in a thousand was wrong where a hard line contradicted last.
TEST(Batch, AmongWallsNothingViolatesTheSoftLinesLess) {
  Batch<double> batch(contradictions_with_walls(20000));
  solve_batch(batch.in(), batch.out(), 0, batch.problems().size());
  std::size_t relaxed = 0;
  for (std::size_t i = 0; i < batch.problems().size(); ++i) {
    const Problem& problem = batch.problems()[i];
    const Solution s = batch.solution(i), right = solve_certified(problem).solution;
    ASSERT_STREQ(name(s.status), name(right.status)) << text_of(problem);
    if (s.status != Status::relaxed) continue;
    ++relaxed;
    ASSERT_NEAR(s.violation, right.violation, 1e-11) << text_of(problem);
  }
  EXPECT_GT(relaxed, 15000u);
}

/// Without numbers of lines, so that only as many lines as may be hard have them.
Batch<double> answered_barely(std::vector<Problem> problems) {
  Batch<double> batch(std::move(problems));
  BatchAnswers<double> out = batch.out();
  out.active = nullptr;
  solve_batch(batch.in(), out, 0, batch.problems().size());
  return batch;
}

// The memory of a thread still held the hard lines of larger problems, and lanes without a problem counted them.
TEST(Batch, LargerProblemsBeforeChangeNoBit) {
  const std::vector<Problem> few = contradictions_with_walls(2000);
  std::vector<Problem> many = generate("RI60", 2000, 31);
  for (Problem& p : many)
    for (std::size_t k = 0; k < 40; ++k) p.constraints[k].priority = Priority::hard;
  for (const char* target : {"", "AVX2", "SSE4", "SSE2"}) {
    if (!limit_batch_target(target)) continue;
    std::vector<Batch<double>> fresh;
    std::thread([&] { fresh.push_back(answered_barely(few)); }).join();  // with a memory of its own
    answered_barely(many);
    const Batch<double> after = answered_barely(few);
    EXPECT_EQ(after.vx, fresh[0].vx) << target;
    EXPECT_EQ(after.vy, fresh[0].vy) << target;
    EXPECT_EQ(after.violation, fresh[0].violation) << target;
    EXPECT_EQ(after.status, fresh[0].status) << target;
    EXPECT_GT(std::count(after.status.begin(), after.status.end(), 1), 1500) << target;
  }
  ASSERT_TRUE(limit_batch_target(""));
}

template <class T>
void expect_aim(double preferred, double disc) {
  Problem p;
  p.bound.disc = disc;
  p.preferred = {preferred, preferred};
  p.constraints.push_back({{{1.0, 0.0}, -0.9 * disc}, Priority::soft, -1});
  Batch<T> batch(std::vector<Problem>(21, p));
  EXPECT_EQ(solve_batch(batch.in(), batch.out(), 0, 21).scalar, 21u);
  const double u = static_cast<double>(std::numeric_limits<T>::epsilon());
  for (std::size_t i = 0; i < 21; ++i) {
    EXPECT_EQ(batch.status[i], 0);
    EXPECT_NEAR(static_cast<double>(batch.vx[i]) / disc, std::sqrt(0.5), 32.0 * u);
    EXPECT_NEAR(static_cast<double>(batch.vy[i]) / disc, std::sqrt(0.5), 32.0 * u);
  }
}

TEST(Batch, SpeedsWhoseSquaresLeaveTheRangeOfANumberAreAnswered) {
  expect_aim<double>(1e200, 1.0);
  expect_aim<double>(1e-60, 1e-70);
  expect_aim<float>(1e30, 1.0);
  expect_aim<float>(1e-21, 1e-25);
}

TEST(Batch, NamesTheCallersMistakes) {
  Batch<double> batch(generate("RF10", 4, 1));
  EXPECT_THROW(solve_batch(batch.in(), batch.out(), 0, 5), std::logic_error);
  BatchProblems<double> in = batch.in();
  in.normal_x = nullptr;
  EXPECT_THROW(solve_batch(in, batch.out(), 0, 4), std::logic_error);
  EXPECT_FALSE(limit_batch_target("no such target"));
  ASSERT_TRUE(limit_batch_target(""));
}

TEST(Batch, NothingToDoIsDone) {
  Batch<double> batch(generate("RF0", 5, 1));
  EXPECT_EQ(solve_batch(batch.in(), batch.out(), 0, 5).scalar, 0u);
  EXPECT_NEAR(batch.vx[3], batch.problems()[3].preferred.x, 1e-14);
  EXPECT_EQ(solve_batch(batch.in(), batch.out(), 2, 2).scalar, 0u);
}

}  // namespace
}  // namespace exactvo::lp
