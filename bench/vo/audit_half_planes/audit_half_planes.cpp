// SPDX-License-Identifier: GPL-3.0-or-later
// Audits N half-planes in rationals: `audit_half_planes [N = 10000000] [SEED = 1]`. Prints how many were audited and
// how many were unsafe, certified and plain; exit status 1 where a certified one is unsafe.
// `audit_half_planes ulps N [SEED]` prints for N discs by how many ulps the two cut-offs clear the velocity obstacle
// (below 0: they cut into it): the data of docs/images/plain-is-unsafe.gp.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "exactvo/geometry/hull.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "half_plane/plain.h"
#include "instances.h"
#include "options/program_options.h"

namespace exactvo::bench {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::Segment;
using geometry::Vec2;

struct Counts {
  unsigned long audited = 0, unsafe = 0, plain_unsafe = 0, refused = 0, overlapping = 0;
};

/// x about `pivot`, scaled, then moved.
struct Placement {
  double scale;
  Vec2 to, pivot;
  Vec2 operator()(Vec2 x) const { return to + scale * (x - pivot); }
};

struct Placed {
  const Placement& place;
  geometry::ConvexShape operator()(const Disc& d) const { return Disc{place(d.center), place.scale * d.radius}; }
  geometry::ConvexShape operator()(const Segment& g) const { return Segment{place(g.a), place(g.b)}; }
  geometry::ConvexShape operator()(ConvexPolygon p) const {
    for (Vec2& v : p.vertices) v = place(v);
    return geometry::convex_hull(p.vertices);  // rounded places need not be convex
  }
  geometry::ConvexShape operator()(const Ellipse& e) const {
    return Ellipse{place(e.center), place.scale * e.l11, place.scale * e.l21, place.scale * e.l22};
  }
};

/// The instances of the benchmarks, some tiny, some huge, some far from the origin, some a hair from contact.
Instance nasty_instance(Stream& random, Obstacle kind) {
  Instance i = random_instance(random, kind);
  const double which = random.uniform(0.0, 1.0);
  const double scale = which < 0.2 ? std::pow(10.0, random.uniform(-6.0, 6.0)) : 1.0;
  const Vec2 to = which > 0.7 ? std::pow(10.0, random.uniform(0.0, 7.0)) * random.direction() : i.s.origin;
  const Placement place{scale, to, i.s.origin};
  i.s.shape = std::visit(Placed{place}, i.s.shape);
  i.s.origin = to;
  i.s.radius *= scale;
  i.velocity = scale * i.velocity;
  if (random.uniform(0.0, 1.0) < 0.15) {
    const vo::VelocityObstacle obstacle(i.s.shape, i.s.origin, i.s.radius, i.time_horizon);
    i.s.radius += obstacle.nearest().distance * (1.0 - std::pow(10.0, random.uniform(-14.0, -1.0)));
  }
  return i;
}

void audit_one(Stream& random, Obstacle kind, Counts& counts) {
  const Instance i = nasty_instance(random, kind);
  if (vo::VelocityObstacle(i.s.shape, i.s.origin, i.s.radius, i.time_horizon).overlaps()) {
    ++counts.overlapping;
    return;
  }
  const auto is_unsafe = [&](const geometry::HalfPlane& h) {
    return !vo::is_true({i.s.shape, i.s.origin, i.s.radius, i.time_horizon, {}, h});
  };
  const auto certified = vo::half_plane(i.s, i.time_horizon, i.velocity);
  const auto plain = plain_half_plane(i.s, i.time_horizon, i.velocity);
  if (!certified) {
    ++counts.refused;
    return;
  }
  ++counts.audited;
  if (is_unsafe(*certified)) ++counts.unsafe;
  if (plain && is_unsafe(*plain)) ++counts.plain_unsafe;
}

int run(unsigned long wanted, unsigned long seed) {
  constexpr Obstacle kKinds[] = {Obstacle::disc, Obstacle::ellipse, Obstacle::segment, Obstacle::polygon8};
  Stream random(seed);
  Counts counts;
  for (unsigned long k = 0; counts.audited < wanted; ++k) {
    audit_one(random, kKinds[k % 4], counts);
    if ((k + 1) % 1000000 == 0) std::fprintf(stderr, "%lu audited, %lu unsafe\n", counts.audited, counts.unsafe);
  }
  std::printf("audited %lu\nunsafe %lu\nplain_unsafe %lu\nrefused %lu\noverlapping %lu\n", counts.audited,
              counts.unsafe, counts.plain_unsafe, counts.refused, counts.overlapping);
  return counts.unsafe == 0 ? 0 : 1;
}

/// offset - h_S(n) / tau in ulps of the offset, by numbers of 64 bits: right to a thousandth of an ulp.
double clear_by_ulps(const Instance& i, const geometry::HalfPlane& h) {
  using Long = long double;
  const auto& disc = std::get<Disc>(i.s.shape);
  const Long nx = h.normal.x, ny = h.normal.y;
  const Long along = nx * (Long(disc.center.x) - i.s.origin.x) + ny * (Long(disc.center.y) - i.s.origin.y);
  const Long support = along + (Long(disc.radius) + i.s.radius) * std::sqrt(nx * nx + ny * ny);
  const double ulp = std::nextafter(std::fabs(h.offset), 1e300) - std::fabs(h.offset);
  return static_cast<double>((Long(h.offset) - support / i.time_horizon) / ulp);
}

int print_ulps(unsigned long wanted, unsigned long seed) {
  Stream random(seed);
  std::printf("# number, ulps by which the plain and the certified cut-off clear the velocity obstacle\n");
  for (unsigned long k = 0; k < wanted;) {
    const Instance i = random_instance(random, Obstacle::disc);
    const auto certified = vo::half_plane(i.s, i.time_horizon, i.velocity);
    const auto plain = plain_half_plane(i.s, i.time_horizon, i.velocity);
    if (!certified || !plain || certified->offset == 0.0 || plain->offset == 0.0) continue;  // a leg
    std::printf("%lu %.3f %.3f\n", k++, clear_by_ulps(i, *plain), clear_by_ulps(i, *certified));
  }
  return 0;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("audit_half_planes", [&] {
    std::uint64_t count = 0, seed = 1;
    const bool ulps = argc > 1 && std::strcmp(argv[1], "ulps") == 0;
    count = ulps ? 800 : 10000000;
    tools::ProgramOptions options(
        "audit_half_planes",
        "Audits half-planes in rationals. `audit_half_planes ulps [N] [SEED]` says instead by "
        "how many ulps cut-offs of discs clear their obstacle.");
    options.whole_number("N", count, 1, "Half-planes");
    options.whole_number("SEED", seed, 1, "Of the half-planes");
    if (!options.parse(argc - ulps, argv + ulps)) return 0;
    return ulps ? bench::print_ulps(count, seed) : bench::run(count, seed);
  });
}
