// SPDX-License-Identifier: GPL-3.0-or-later
#include "motions/real_roots.h"

#include <algorithm>
#include <utility>

namespace exactvo::geometry::motions {
namespace {

/// Isolates the roots in (low, high] of a square-free polynomial.
class Isolation {
 public:
  explicit Isolation(const IntegerPolynomial& p) : p_(std::make_shared<const IntegerPolynomial>(p)), sturm_(p) {}

  std::vector<RealNumber> in_unit() {
    if (sign_at(*p_, 0) == 0) roots_.emplace_back(mpq_class(0));
    isolate(0, sturm_.changes_at(0), 1, sturm_.changes_at(1));
    return std::move(roots_);
  }

 private:
  void isolate(const mpq_class& low, int changes_low, const mpq_class& high, int changes_high) {
    const int count = changes_low - changes_high;
    if (count == 0) return;
    if (count == 1) {
      if (sign_at(*p_, high) == 0) {
        roots_.emplace_back(high);
        return;
      }
      if (sign_at(*p_, low) != 0) {
        roots_.emplace_back(p_, low, high);
        return;
      }
    }
    const mpq_class middle = (low + high) / 2;
    const int changes = sturm_.changes_at(middle);
    isolate(low, changes_low, middle, changes);
    isolate(middle, changes, high, changes_high);
  }

  std::shared_ptr<const IntegerPolynomial> p_;
  SturmChain sturm_;
  std::vector<RealNumber> roots_;
};

bool has_root(const IntegerPolynomial& p, const mpq_class& low, const mpq_class& high) {
  if (p.size() <= 1) return false;
  if (sign_at(p, low) == 0) return true;
  return SturmChain(p).count(low, high) != 0;
}

/// A point of each gap between 0, the roots and 1; a gap without length has its end.
std::vector<mpq_class> points_of_gaps(const std::vector<RealNumber>& roots) {
  std::vector<mpq_class> points{roots.front().low() / 2};
  for (std::size_t i = 0; i + 1 < roots.size(); ++i) points.emplace_back((roots[i].high() + roots[i + 1].low()) / 2);
  points.emplace_back((roots.back().high() + 1) / 2);
  return points;
}

}  // namespace

void RealNumber::refine() {
  if (is_rational()) return;
  mpq_class middle = (low_ + high_) / 2;
  const int sign = sign_at(*polynomial_, middle);
  if (sign == 0) {
    low_ = high_ = std::move(middle);
  } else if (sign == sign_at(*polynomial_, low_)) {
    low_ = std::move(middle);
  } else {
    high_ = std::move(middle);
  }
}

int compare(RealNumber& x, RealNumber& y) {
  bool equality_tried = false;
  for (;;) {
    if (x.high_ < y.low_) return -1;
    if (y.high_ < x.low_) return 1;
    if (x.is_rational() && y.is_rational()) return 0;
    if (!equality_tried) {
      equality_tried = true;
      // Ends of intervals are no roots, so a common root in both intervals is the root of each.
      if (x.is_rational() || y.is_rational()) {
        const RealNumber& rational = x.is_rational() ? x : y;
        const RealNumber& other = x.is_rational() ? y : x;
        if (sign_at(*other.polynomial_, rational.low_) == 0) return 0;
      } else if (x.polynomial_ == y.polynomial_) {
        if (x.low_ == y.low_ && x.high_ == y.high_) return 0;
        if (has_root(*x.polynomial_, std::max(x.low_, y.low_), std::min(x.high_, y.high_))) return 0;
      } else if (has_root(gcd(*x.polynomial_, *y.polynomial_), std::max(x.low_, y.low_), std::min(x.high_, y.high_))) {
        return 0;
      }
    }
    x.refine();
    y.refine();
  }
}

std::vector<RealNumber> roots_in_unit(const IntegerPolynomial& p) {
  if (p.size() <= 1) return {};
  std::vector<RealNumber> roots = Isolation(square_free(p)).in_unit();
  for (std::size_t i = 0; i + 1 < roots.size(); ++i) {
    while (roots[i].high() >= roots[i + 1].low()) {
      roots[i].refine();
      roots[i + 1].refine();
    }
  }
  return roots;
}

TimeSet times_below_zero(const IntegerPolynomial& p, Ends ends) {
  if (p.empty()) return ends == Ends::closed ? TimeSet{{mpq_class(0), mpq_class(1)}} : TimeSet{};
  const std::vector<RealNumber> roots = roots_in_unit(p);
  if (roots.empty()) return sgn(p.front()) < 0 ? TimeSet{{mpq_class(0), mpq_class(1)}} : TimeSet{};
  const std::vector<mpq_class> points = points_of_gaps(roots);
  const std::size_t gaps = points.size();
  TimeSet times;
  std::vector<bool> below(gaps, false);
  for (std::size_t i = 0; i < gaps; ++i) {
    const RealNumber from = i == 0 ? RealNumber(mpq_class(0)) : roots[i - 1];
    const RealNumber to = i + 1 == gaps ? RealNumber(mpq_class(1)) : roots[i];
    const bool has_length = !(from.is_rational() && to.is_rational() && from.low() == to.low());
    below[i] = has_length && sign_at(p, points[i]) < 0;
    if (below[i]) times.push_back({from, to});
    if (ends == Ends::closed && i > 0 && !below[i - 1] && !below[i]) times.push_back({from, from});
  }
  return times;
}

TimeSet common_times(TimeSet a, TimeSet b, Ends ends) {
  TimeSet both;
  for (TimeSpan& x : a) {
    for (TimeSpan& y : b) {
      const RealNumber& from = compare(x.from, y.from) >= 0 ? x.from : y.from;
      const RealNumber& to = compare(x.to, y.to) <= 0 ? x.to : y.to;
      TimeSpan common{from, to};
      const int order = compare(common.from, common.to);
      if (order < 0 || (order == 0 && ends == Ends::closed)) both.push_back(std::move(common));
    }
  }
  return both;
}

}  // namespace exactvo::geometry::motions
