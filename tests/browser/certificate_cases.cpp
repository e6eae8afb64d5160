// SPDX-License-Identifier: GPL-3.0-or-later
// Writes claims with the verdicts of lp/certificate.h and vo/certificate.h, one JSON object a line, for the checker
// that runs in the browser: certificate_cases COUNT SEED > FILE. Every second claim is altered, most of them by little,
// so that both verdicts are near.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "exactvo/vo/certificate.h"
#include "exactvo/vo/constraint.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "lp/problem_kinds.h"

namespace exactvo {
namespace {

using geometry::Vec2;
using Json = nlohmann::ordered_json;
using test::SeededRandom;

double slightly_off(double x, SeededRandom& random) {
  switch (random.integer(0, 3)) {
    case 0:
      return std::nextafter(x, random.integer(0, 1) ? 1e9 : -1e9);
    case 1:
      return x + random.uniform(-1e-9, 1e-9);
    case 2:
      return x * (1.0 + random.uniform(-1e-3, 1e-3));
    default:
      return x + random.uniform(-0.5, 0.5);
  }
}

// --- Choices ---

const lp::ProblemKind& kind_at_random(SeededRandom& random) {
  const auto& kinds = lp::well_formed_kinds();
  for (;;) {
    const lp::ProblemKind& kind =
        kinds[static_cast<std::size_t>(random.integer(0, static_cast<int>(kinds.size()) - 1))];
    const bool bounded =
        kind.bound == lp::BoundKind::disc || kind.bound == lp::BoundKind::box || kind.bound == lp::BoundKind::disc_box;
    if (bounded && kind.objective == lp::Objective::nearest) return kind;
  }
}

void alter(lp::Problem& problem, lp::Solution& s, SeededRandom& random) {
  switch (random.integer(0, 4)) {
    case 0:
      s.velocity.x = slightly_off(s.velocity.x, random);
      break;
    case 1:
      problem.preferred.y = slightly_off(problem.preferred.y, random);
      break;
    case 2:
      if (s.active_count > 0) s.active[0].multiplier = slightly_off(s.active[0].multiplier, random);
      break;
    case 3:
      if (!problem.constraints.empty()) {
        double& offset = problem.constraints.back().half_plane.offset;
        offset = slightly_off(offset, random);
      }
      break;
    default:
      if (s.active_count > 0) --s.active_count;
  }
}

Json or_null(double bound) {
  return std::isfinite(bound) ? Json(bound) : Json(nullptr);
}

const char* word(lp::BindingKind kind) {
  constexpr const char* kWords[] = {"line", "disc", "right", "left", "top", "bottom"};
  return kWords[static_cast<int>(kind)];
}

Json choice(SeededRandom& random, bool altered) {
  lp::Problem problem;
  lp::Solution s;
  do {
    problem = random.integer(0, 3) ? random_problem(kind_at_random(random), random)
                                   : grid_problem(kind_at_random(random), random);
    s = random.integer(0, 1) ? lp::solve_certified(problem).solution : lp::solve(problem);
  } while (s.status == lp::Status::no_interior);
  if (altered) alter(problem, s, random);
  bool holds = true;
  Json lines = Json::array(), terms = Json::array();
  for (const lp::Constraint& c : problem.constraints)
    lines.push_back({{"x", c.half_plane.normal.x},
                     {"y", c.half_plane.normal.y},
                     {"c", c.half_plane.offset},
                     {"hard", c.priority == lp::Priority::hard}});
  for (std::size_t k = 0; k < s.active_count; ++k) {
    holds = holds && s.active[k].multiplier >= 0.0;  // what an audit asks; claim_of leaves the others out
    terms.push_back({{"kind", word(s.active[k].binding.kind)},
                     {"index", s.active[k].binding.index},
                     {"multiplier", s.active[k].multiplier}});
  }
  holds = holds && check(problem, claim_of(problem, s)) == lp::CertificateError::none;
  return {{"problem",
           {{"lines", lines},
            {"disc", or_null(problem.bound.disc)},
            {"boxX", or_null(problem.bound.box_x)},
            {"boxY", or_null(problem.bound.box_y)},
            {"px", problem.preferred.x},
            {"py", problem.preferred.y}}},
          {"answer",
           {{"vx", s.velocity.x},
            {"vy", s.velocity.y},
            {"status", lp::name(s.status)},
            {"violation", s.violation},
            {"terms", terms}}},
          {"holds", holds}};
}

// --- Half-planes ---

geometry::ConvexShape shape_at_random(SeededRandom& random) {
  const Vec2 c = random.in_box(6.0);
  switch (random.integer(0, 3)) {
    case 0:
      return geometry::Disc{c, random.uniform(0.0, 1.0)};
    case 1:
      return geometry::Segment{c, c + random.in_box(2.0)};
    case 2:
      return geometry::Ellipse{c, random.uniform(0.1, 2.0), random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0)};
    default:
      return geometry::ConvexPolygon{
          {c, c + Vec2{random.uniform(0.5, 2.0), 0.0}, c + Vec2{0.3, random.uniform(0.5, 2.0)}}};
  }
}

struct ShapeToJson {
  Json operator()(const geometry::Disc& d) const { return {{"disc", {d.center.x, d.center.y, d.radius}}}; }
  Json operator()(const geometry::Segment& s) const { return {{"segment", {s.a.x, s.a.y, s.b.x, s.b.y}}}; }
  Json operator()(const geometry::Ellipse& e) const {
    return {{"ellipse", {e.center.x, e.center.y, e.l11, e.l21, e.l22}}};
  }
  Json operator()(const geometry::ConvexPolygon& p) const {
    Json points = Json::array();
    for (const Vec2 v : p.vertices) {
      points.push_back(v.x);
      points.push_back(v.y);
    }
    return {{"polygon", points}};
  }
};

vo::HalfPlaneClaim claim_at_random(SeededRandom& random) {
  for (;;) {
    vo::HalfPlaneClaim claim{shape_at_random(random),  random.in_box(3.0), random.uniform(0.0, 0.8),
                             random.uniform(0.3, 4.0), random.in_box(1.0), {}};
    const vo::VelocityObstacle obstacle(claim.shape, claim.position, claim.radius, claim.time_horizon);
    if (obstacle.overlaps()) continue;
    const auto h = obstacle.half_plane(random.in_box(3.0));
    if (!h) continue;
    claim.half_plane = vo::shifted_by(*h, claim.shape_velocity);
    return claim;
  }
}

void alter(vo::HalfPlaneClaim& claim, SeededRandom& random) {
  switch (random.integer(0, 4)) {
    case 0:
      claim.half_plane.offset = slightly_off(claim.half_plane.offset, random);
      break;
    case 1:
      claim.half_plane.normal.x = slightly_off(claim.half_plane.normal.x, random);
      break;
    case 2:
      claim.position.x = slightly_off(claim.position.x, random);
      break;
    case 3:
      claim.radius = std::fabs(slightly_off(claim.radius, random));
      break;
    default:
      claim.shape_velocity.y = slightly_off(claim.shape_velocity.y, random);
  }
}

Json half_plane(SeededRandom& random, bool altered) {
  vo::HalfPlaneClaim claim = claim_at_random(random);
  if (altered) alter(claim, random);
  return {{"claim",
           {{"shape", std::visit(ShapeToJson{}, claim.shape)},
            {"x", claim.position.x},
            {"y", claim.position.y},
            {"radius", claim.radius},
            {"timeHorizon", claim.time_horizon},
            {"ux", claim.shape_velocity.x},
            {"uy", claim.shape_velocity.y},
            {"nx", claim.half_plane.normal.x},
            {"ny", claim.half_plane.normal.y},
            {"c", claim.half_plane.offset}}},
          {"holds", vo::is_true(claim)}};
}

}  // namespace
}  // namespace exactvo

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "certificate_cases COUNT SEED\n");
    return 2;
  }
  const long count = std::strtol(argv[1], nullptr, 10);
  exactvo::test::SeededRandom random(std::strtoull(argv[2], nullptr, 10));
  for (long k = 0; k < count; ++k) {
    const auto json = k % 2 ? exactvo::half_plane(random, k % 4 == 3) : exactvo::choice(random, k % 4 == 2);
    std::puts(json.dump().c_str());
  }
}
