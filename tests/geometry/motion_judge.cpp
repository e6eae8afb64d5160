// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/motion_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exactvo/geometry/predicates.h"
#include "geometry/motion_oracle.h"

namespace exactvo::test {
namespace {

using geometry::Bounds;
using geometry::Encounter;
using geometry::MotionVerdict;

/// What MotionVerdict promises, by the oracle.
class Judgement {
 public:
  Judgement(const MotionCase& c, MotionCampaign& campaign) : case_(c), oracle_(c), campaign_(campaign) {}

  void operator()(bool bounds_too) {
    geometry::reset_stage_counts();
    const Encounter found = encounter(case_);
    campaign_.by_filter += geometry::stage_counts().filter;
    campaign_.exactly += geometry::stage_counts().exact;
    const Encounter expected = oracle_.encounter();
    campaign_.count(expected);
    if (case_.known && *case_.known != expected) wrong("the oracle says otherwise than the construction");
    if (found != expected) {
      wrong(std::string("expected ") + word(expected) + ", found " + word(found));
      return;
    }
    if (!oracle_.concurrent()) ++campaign_.apart_in_time;
    if (!bounds_too) return;
    const MotionVerdict verdict = examine(case_);
    if (verdict.encounter != expected) wrong("examine says otherwise than encounter");
    if (!oracle_.concurrent()) {
      if (std::isfinite(verdict.clearance.low)) wrong("clearance without a common moment");
      return;
    }
    judge_clearance(verdict);
    if (expected != Encounter::clear) judge_moments(verdict);
  }

 private:
  void wrong(const std::string& text) { campaign_.failures.push_back(text + ":\n" + corpus_line(case_)); }

  void judge_clearance(const MotionVerdict& v) {
    ++campaign_.clearances;
    if (!(v.clearance.low <= v.clearance.high)) return wrong("clearance bounds in the wrong order");
    if (oracle_.compare_clearance(Q(v.clearance.low)) < 0 && !is_deepest(v.clearance.low))
      wrong("less clearance than the lower bound");
    if (oracle_.compare_clearance(Q(v.clearance.high)) > 0) wrong("more clearance than the upper bound");
    if (v.encounter == Encounter::clear ? v.clearance.low < 0.0 : v.clearance.high > 0.0)
      wrong("clearance of the wrong sign");
    if (v.clearance.high - v.clearance.low > 0x1p-36 * size()) ++campaign_.loose;
  }

  /// Inside counts as distance 0, so no clearance is below the negative of all reaches.
  bool is_deepest(double low) const {
    double most = 0.0;
    for (const auto& a : case_.body_a)
      for (const auto& b : case_.b ? case_.body_b : geometry::disc_body(0.0))
        most = std::max(most, a.radius + b.radius);
    return low <= -most;
  }

  double size() const {
    double most = 0.0;
    const auto add = [&](const geometry::Motion& m) {
      for (const double t : {geometry::start_of(m), geometry::end_of(m)}) {
        const geometry::Vec2 p = position_at(m, t);
        most = std::max({most, std::fabs(p.x), std::fabs(p.y)});
      }
    };
    add(case_.a);
    if (case_.b) add(*case_.b);
    return most;
  }

  void judge_moments(const MotionVerdict& v) {
    campaign_.moments += 2;
    const Q &from = oracle_.from(), &to = oracle_.to();
    const Q first_low(v.first.low), first_high(v.first.high), last_low(v.last.low), last_high(v.last.high);
    if (first_low < from || first_high > to || last_low < from || last_high > to) return wrong("moments not in common");
    if (first_low > from && oracle_.encounter(from, first_low) >= v.encounter) wrong("meets before `first`");
    if (oracle_.encounter(from, first_high) < v.encounter) wrong("does not meet by the end of `first`");
    if (last_high < to && oracle_.encounter(last_high, to) >= v.encounter) wrong("meets after `last`");
    if (oracle_.encounter(last_low, to) < v.encounter) wrong("does not meet from the begin of `last` on");
    const double wide = 0x1p-35 * (static_cast<double>(to) - static_cast<double>(from));
    const auto is_loose = [&](const Bounds& b) {
      return b.high - b.low > wide && std::nextafter(b.low, b.high) < b.high;
    };
    if (is_loose(v.first) || is_loose(v.last)) ++campaign_.loose;
  }

  const MotionCase& case_;
  const MotionOracle oracle_;
  MotionCampaign& campaign_;
};

}  // namespace

const char* word(Encounter e) {
  return e == Encounter::clear ? "clear" : e == Encounter::contact ? "contact" : "overlap";
}

void MotionCampaign::count(Encounter expected) {
  ++cases;
  ++(expected == Encounter::clear ? clear : expected == Encounter::contact ? contact : overlap);
}

MotionCampaign& MotionCampaign::operator+=(const MotionCampaign& other) {
  cases += other.cases;
  clear += other.clear;
  contact += other.contact;
  overlap += other.overlap;
  apart_in_time += other.apart_in_time;
  clearances += other.clearances;
  moments += other.moments;
  loose += other.loose;
  by_filter += other.by_filter;
  exactly += other.exactly;
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
  return *this;
}

std::string MotionCampaign::summary() const {
  char text[400];
  const double share = 100.0 * static_cast<double>(by_filter) / std::max(1.0, static_cast<double>(by_filter + exactly));
  std::snprintf(text, sizeof text,
                "%zu cases, %zu clear (%zu without a common moment), %zu in contact, %zu overlap; %zu clearances, %zu "
                "moments, %zu of them loose; %.3f %% by the filter; %zu wrong",
                cases, clear, apart_in_time, contact, overlap, clearances, moments, loose, share, failures.size());
  return text;
}

void judge_motion(const MotionCase& c, MotionCampaign& campaign, bool bounds_too) {
  Judgement{c, campaign}(bounds_too);
}

MotionCampaign judge_motions(MotionKind kind, std::size_t count, std::uint64_t seed, std::size_t bounds_of_each) {
  return judge_cases([&](SeededRandom& random) { return random_motion_case(random, kind); }, count, seed,
                     bounds_of_each, &judge_motion);
}

}  // namespace exactvo::test
