// SPDX-License-Identifier: GPL-3.0-or-later
// What does the certificate of a half-plane cost? Certified against plain: `ratio` = certified / plain.
#include <cmath>

#include "exactvo/vo/certificate.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "half_plane/plain.h"
#include "in_turns.h"
#include "instances.h"

namespace exactvo::bench {
namespace {

using geometry::HalfPlane;

constexpr std::size_t kInstances = 16384;
constexpr double kSame = 1e-9;  // m/s and a direction's sine: tilts and slacks are of the order of 1e-14

bool same(const Instance& i, const HalfPlane& a, const HalfPlane& b) {
  return std::fabs(violation(a, i.velocity) - violation(b, i.velocity)) < kSame &&
         std::fabs(cross(a.normal, b.normal)) < kSame;
}

std::optional<HalfPlane> certified(const Instance& i) {
  return vo::half_plane(i.s, i.time_horizon, i.velocity);
}
std::optional<HalfPlane> plain(const Instance& i) {
  return plain_half_plane(i.s, i.time_horizon, i.velocity);
}

bool is_safe(const Instance& i, const HalfPlane& h) {
  return vo::is_true({i.s.shape, i.s.origin, i.s.radius, i.time_horizon, {}, h});
}

void certified_against_plain(benchmark::State& state, Obstacle kind) {
  const std::vector<Instance> instances = random_instances(kind, kInstances, 7);
  int unsafe_plain = 0;
  for (const Instance& i : instances) {
    const auto ours = certified(i), theirs = plain(i);
    if (!ours || !theirs || !same(i, *ours, *theirs)) return state.SkipWithError("the half-planes differ");
    if (!is_safe(i, *ours)) return state.SkipWithError("a certified half-plane is not safe");
    unsafe_plain += !is_safe(i, *theirs);
  }
  report_ratio(state, instances, certified, certified, plain);
  state.counters["plain_unsafe_share"] = static_cast<double>(unsafe_plain) / kInstances;
}
BENCHMARK_CAPTURE(certified_against_plain, disc, Obstacle::disc);
BENCHMARK_CAPTURE(certified_against_plain, ellipse, Obstacle::ellipse);
BENCHMARK_CAPTURE(certified_against_plain, segment, Obstacle::segment);
BENCHMARK_CAPTURE(certified_against_plain, polygon_8, Obstacle::polygon8);
BENCHMARK_CAPTURE(certified_against_plain, polygon_16, Obstacle::polygon16);

}  // namespace
}  // namespace exactvo::bench
