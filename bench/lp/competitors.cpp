// SPDX-License-Identifier: GPL-3.0-or-later
#include "competitor.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"

namespace exactvo::bench {
namespace {

class Textbook : public Competitor {
 public:
  explicit Textbook(const std::vector<lp::Problem>& problems) : set_(problems), answers_(problems.size()) {}
  std::size_t count() const override { return answers_.size(); }
  Answer answer(std::size_t i) const override {
    return {{static_cast<double>(answers_[i].x), static_cast<double>(answers_[i].y)}, answers_[i].feasible};
  }
  void run() override {
    for (std::size_t i = 0; i < answers_.size(); ++i)
      answers_[i] =
          solve_textbook(set_.lines.data() + set_.first[i], static_cast<int>(set_.first[i + 1] - set_.first[i]),
                         set_.hard[i], set_.speed[i], set_.preferred_x[i], set_.preferred_y[i]);
  }

 private:
  TextbookSet set_;
  std::vector<TextbookVelocity> answers_;
};

template <class T>
class Batch : public Competitor {
 public:
  Batch(const std::vector<lp::Problem>& problems, bool prove) : arrays_(problems), prove_(prove) {}
  std::size_t count() const override { return arrays_.count; }
  Answer answer(std::size_t i) const override {
    return {{static_cast<double>(arrays_.velocity_x[i]), static_cast<double>(arrays_.velocity_y[i])},
            arrays_.status[i] == static_cast<std::uint8_t>(lp::Status::optimal) ||
                arrays_.status[i] == static_cast<std::uint8_t>(lp::Status::no_interior)};
  }
  void run() override { lp::solve_batch(arrays_.problems(), arrays_.answers(prove_), 0, arrays_.count); }

 private:
  Arrays<T> arrays_;
  bool prove_;
};

bool feasible(const lp::Solution& s) {
  return s.status == lp::Status::optimal || s.status == lp::Status::no_interior;
}

/// One problem after the other, each as arrays.
template <bool kProve>
class Single : public Competitor {
 public:
  explicit Single(const std::vector<lp::Problem>& problems) : answers_(problems.size()) {
    std::size_t lines = 0;
    for (const lp::Problem& p : problems) lines += padded(p.constraints.size());
    for (auto* array : {&x_, &y_, &offset_}) array->assign(lines, 0.0);
    std::size_t at = 0;
    for (const lp::Problem& p : problems) {
      problems_.push_back({&x_[at], &y_[at], &offset_[at], p.constraints.size(), 0, p.preferred, p.bound.disc});
      for (std::size_t k = 0; k < p.constraints.size(); ++k) {
        x_[at + k] = p.constraints[k].half_plane.normal.x;
        y_[at + k] = p.constraints[k].half_plane.normal.y;
        offset_[at + k] = p.constraints[k].half_plane.offset;
        problems_.back().hard += p.constraints[k].priority == lp::Priority::hard;
      }
      at += padded(p.constraints.size());
    }
  }
  std::size_t count() const override { return answers_.size(); }
  Answer answer(std::size_t i) const override { return {answers_[i].velocity, feasible(answers_[i])}; }
  void run() override {
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      if (kProve)
        lp::solve_certified(problems_[i], answers_[i]);
      else
        lp::solve(problems_[i], answers_[i]);
    }
  }

 private:
  static std::size_t padded(std::size_t lines) {
    return std::max<std::size_t>(1, (lines + lp::kSinglePadding - 1) / lp::kSinglePadding) * lp::kSinglePadding;
  }

  AlignedVector<double> x_, y_, offset_;
  std::vector<lp::SingleProblem> problems_;
  std::vector<lp::Solution> answers_;
};

/// The solvers that take a Problem; `Solve` gives an Answer.
template <class Solve>
class OneByOne : public Competitor {
 public:
  OneByOne(const std::vector<lp::Problem>& problems, Solve solve) : answers_(problems.size()), solve_(solve) {
    // The first copy fills the gaps of the heap: the second lies in memory in order, as arrays do.
    const std::vector<lp::Problem> in_gaps(problems);
    problems_ = in_gaps;
  }
  std::size_t count() const override { return answers_.size(); }
  Answer answer(std::size_t i) const override { return answers_[i]; }
  void run() override {
    for (std::size_t i = 0; i < problems_.size(); ++i) answers_[i] = solve_(problems_[i]);
  }

 private:
  std::vector<lp::Problem> problems_;
  std::vector<Answer> answers_;
  Solve solve_;
};

template <class Solve>
Entry one_by_one(std::string name, Rules rules, Solve solve) {
  return {std::move(name), rules, "", [solve](const std::vector<lp::Problem>& problems) {
            return std::make_unique<OneByOne<Solve>>(problems, solve);
          }};
}

template <class Kind>
Entry own_entry(std::string name, Rules rules) {
  return {std::move(name), rules, "", [](const std::vector<lp::Problem>& p) { return std::make_unique<Kind>(p); }};
}

/// Problems at most for a solver that takes microseconds each.
constexpr std::size_t kSlow = 4096;

template <class T>
Entry batch_entry(std::string name, std::string target, bool prove = false) {
  return {std::move(name), {false, prove}, std::move(target), [prove](const std::vector<lp::Problem>& p) {
            return std::make_unique<Batch<T>>(p, prove);
          }};
}

/// The textbook's solver for a caller that has a Problem, as `solve` gets it: lines are converted first.
Answer textbook_of_problem(const lp::Problem& p) {
  TextbookLine lines[kMostTextbookLines];
  int count = 0, hard = 0;
  for (const lp::Constraint& c : p.constraints) {
    const lp::Vec2 n = c.half_plane.normal;
    const lp::Vec2 foot = c.half_plane.offset * n;
    lines[count++] = {static_cast<float>(foot.x), static_cast<float>(foot.y), static_cast<float>(n.y),
                      static_cast<float>(-n.x)};
    hard += c.priority == lp::Priority::hard;
  }
  const TextbookVelocity v = solve_textbook(lines, count, hard, static_cast<float>(p.bound.disc),
                                            static_cast<float>(p.preferred.x), static_cast<float>(p.preferred.y));
  return {{static_cast<double>(v.x), static_cast<double>(v.y)}, v.feasible};
}

Answer answer_of(const lp::Solution& s) {
  return {s.velocity, feasible(s)};
}

void require_sound(const std::vector<Entry>& all) {
  std::set<std::string> names;
  for (const Entry& entry : all) {
    if (entry.name.empty() || entry.name.find('/') != std::string::npos)
      throw std::runtime_error("the solver \"" + entry.name + "\": expected a name, without a slash");
    if (!names.insert(entry.name).second)
      throw std::runtime_error("the solver \"" + entry.name + "\": found twice, expected a name of its own");
    if (entry.rules.most == 0)
      throw std::runtime_error("the solver \"" + entry.name + "\": takes 0 problems at most, expected 1 or more");
  }
}

std::vector<Entry>& joined() {
  static std::vector<Entry> all;
  return all;
}

}  // namespace

Join::Join(std::string name, Answer (*solve)(const lp::Problem&), Rules rules) {
  joined().push_back(one_by_one(std::move(name), rules, solve));
}

std::vector<Entry> entries() {
  std::vector<Entry> all;
  all.push_back(own_entry<Textbook>("textbook", {}));
  all.push_back(one_by_one("textbook-of-problem", {}, textbook_of_problem));
  all.push_back(batch_entry<double>("batch-double", ""));
  all.push_back(batch_entry<double>("batch-certified", "", true));
  all.push_back(batch_entry<float>("batch-float", ""));
  all.push_back(batch_entry<double>("batch-double-AVX2", "AVX2"));
  all.push_back(batch_entry<float>("batch-float-AVX2", "AVX2"));
  all.push_back(own_entry<Single<false>>("single", {}));
  all.push_back(own_entry<Single<true>>("single-certified", {false, true}));
  all.push_back(one_by_one("solve", {false, true}, [](const lp::Problem& p) { return answer_of(lp::solve(p)); }));
  all.push_back(one_by_one("certified", {false, true, kSlow},
                           [](const lp::Problem& p) { return answer_of(lp::solve_certified(p).solution); }));
  all.push_back(one_by_one("exact", {false, true, kSlow},
                           [](const lp::Problem& p) { return answer_of(lp::solve_exact(p).solution); }));
  std::vector<Entry> others = joined();
  std::sort(others.begin(), others.end(), [](const Entry& a, const Entry& b) { return a.name < b.name; });
  all.insert(all.end(), others.begin(), others.end());
  require_sound(all);
  return all;
}

}  // namespace exactvo::bench
