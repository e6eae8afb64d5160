// SPDX-License-Identifier: GPL-3.0-or-later
// Writes certificates, every second one forged, with the verdicts of the checkers in C++, for the proven checker to
// judge too: proof_cases COUNT SEED OUT. COUNT each are half-planes (half-planes.txt), containments (containments.txt),
// routes (routes.jsonl), bodies that never meet on straight ways (clear.jsonl), on curves (curved.jsonl) and while they
// turn (turning.jsonl), and choices (problems.jsonl, answers.jsonl). A file NAME.valid beside each has a 0 or 1 a line.
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/routes.h"
#include "exactvo/geometry/turning_motions.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/constraint.h"
#include "exactvo/vo/containment.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "geometry/motion_case.h"
#include "geometry/route_mutations.h"
#include "lp/problem_kinds.h"
#include "options/program_options.h"
#include "support/motion_certificates.h"
#include "support/route_certificates.h"
#include "support/run.h"

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

class Cases {
 public:
  Cases(const std::string& folder, const std::string& name, const std::string& extension)
      : text_(folder + "/" + name + extension), valid_(folder + "/" + name + ".valid") {
    text_.exceptions(std::ios::badbit | std::ios::failbit);
    valid_.exceptions(std::ios::badbit | std::ios::failbit);
  }
  void add(const std::string& line, bool valid) {
    text_ << line << "\n";
    valid_ << (valid ? "1\n" : "0\n");
  }

 private:
  std::ofstream text_, valid_;
};

// --- Half-planes and containments ---

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

vo::Certificate half_plane_at_random(SeededRandom& random) {
  for (;;) {
    vo::HalfPlaneClaim claim{shape_at_random(random),  random.in_box(3.0), random.uniform(0.0, 0.8),
                             random.uniform(0.3, 4.0), random.in_box(1.0), {}};
    if (random.integer(0, 9) == 0) claim.radius = 0.0;
    const vo::VelocityObstacle obstacle(claim.shape, claim.position, claim.radius, claim.time_horizon);
    if (obstacle.overlaps()) continue;
    const auto h = obstacle.half_plane(random.in_box(3.0));
    if (!h) continue;
    claim.half_plane = vo::shifted_by(*h, claim.shape_velocity);
    if (const auto c = vo::certify(claim)) return *c;
  }
}

/// Another claim with the margin and digest of the old one or, where it is true, with those that are its own.
void forge(vo::Certificate& c, SeededRandom& random) {
  double* const numbers[] = {&c.claim.half_plane.offset, &c.claim.half_plane.normal.x, &c.claim.half_plane.normal.y,
                             &c.claim.position.x,        &c.claim.position.y,          &c.claim.radius,
                             &c.claim.shape_velocity.x,  &c.claim.time_horizon,        &c.margin};
  double& number = *numbers[random.integer(0, 8)];
  number = slightly_off(number, random);
  if (random.integer(0, 1))
    if (const auto anew = vo::certify(c.claim)) c = *anew;
  if (random.integer(0, 19) == 0) c.digest ^= 1U << static_cast<unsigned>(random.integer(0, 30));
}

vo::Containment containment_at_random(SeededRandom& random) {
  for (;;) {
    const geometry::Ellipse e{random.in_box(6.0), random.uniform(0.1, 2.0), random.uniform(-1.0, 1.0),
                              random.uniform(0.1, 1.0)};
    std::vector<Vec2> points;
    for (int k = random.integer(1, 6); k > 0; --k) points.push_back(e.center + random.in_box(0.7));
    if (const auto c = vo::certify_containment(e, points)) return *c;
  }
}

void forge(vo::Containment& c, SeededRandom& random) {
  double* const numbers[] = {&c.ellipse.l11, &c.ellipse.l21,      &c.ellipse.l22,    &c.ellipse.center.x,
                             &c.margin,      &c.points.front().x, &c.points.back().y};
  double& number = *numbers[random.integer(0, 6)];
  number = slightly_off(number, random);
  if (random.integer(0, 1))
    if (const auto anew = vo::certify_containment(c.ellipse, c.points)) c = *anew;
}

void write_half_planes(std::size_t count, SeededRandom& random, const std::string& folder) {
  Cases cases(folder, "half-planes", ".txt");
  for (std::size_t k = 0; k < count; ++k) {
    vo::Certificate c = half_plane_at_random(random);
    if (k % 2) forge(c, random);
    cases.add(vo::write_certificate(c), check(c) == vo::Verdict::valid);
  }
}

void write_containments(std::size_t count, SeededRandom& random, const std::string& folder) {
  Cases cases(folder, "containments", ".txt");
  for (std::size_t k = 0; k < count; ++k) {
    vo::Containment c = containment_at_random(random);
    if (k % 2) forge(c, random);
    cases.add(vo::write_containment(c), check(c) == vo::Verdict::valid);
  }
}

// --- Routes, as their text is read by `audit --certificate` ---

std::string text_of(const test::Certificate& c, const std::vector<formation::SceneObstacle>& obstacles) {
  return tools::certificate_json(c.question, c.answer, &obstacles).dump();
}

bool is_valid(const std::string& text) {
  return tools::RouteChecker().check_one(tools::OrderedJson::parse(text)).valid;
}

void write_routes(std::size_t count, SeededRandom& random, const std::string& folder) {
  Cases cases(folder, "routes", ".jsonl");
  for (std::size_t world = 0, k = 0; k < count; ++world) {
    const test::RouteField f = route_field(random, test::kFieldKinds[world % std::size(test::kFieldKinds)]);
    std::vector<formation::SceneObstacle> obstacles;
    for (const geometry::Obstacle& o : f.obstacles) obstacles.push_back({std::to_string(obstacles.size()), o});
    const geometry::RouteMap map(f.obstacles);
    const double widest = map.widest_radius(f.start, f.goal);
    for (const double radius : {widest, std::nextafter(widest, 100.0), widest * random.uniform(0.2, 1.0),
                                widest + random.uniform(0.0, 1.0)}) {
      if (!(radius >= 0x1p-40) || k >= count) continue;  // what is proven here is of discs, not of points
      const test::Certificate real{{radius, f.start, f.goal}, geometry::RoutePlan(map, radius).query(f.start, f.goal)};
      const std::string text = text_of(real, obstacles);
      cases.add(text, is_valid(text));
      ++k;
      const test::Mutant mutant = mutated(f.obstacles, real, random);
      if (!(mutant.certificate.question.radius > 0.0) || k >= count) continue;
      const std::string forged = text_of(mutant.certificate, obstacles);
      cases.add(forged, is_valid(forged));
      ++k;
    }
  }
}

// --- Bodies that never meet, as `exactvo check --certificates` writes them ---

/// Every number of a tree.
void numbers_of(Json& json, std::vector<Json*>& numbers) {
  if (json.is_number()) numbers.push_back(&json);
  if (json.is_structured())
    for (Json& member : json) numbers_of(member, numbers);
}

void forge(Json& certificate, SeededRandom& random) {
  std::vector<Json*> numbers;
  numbers_of(certificate, numbers);
  Json& number = *numbers[static_cast<std::size_t>(random.integer(0, static_cast<int>(numbers.size()) - 1))];
  if (number.is_number_unsigned()) {
    number = number.get<unsigned>() + 1;
  } else {
    number = slightly_off(number.get<double>(), random);
  }
  Json& separations = certificate["separations"];
  if (random.integer(0, 9) == 0 && !separations.empty())
    separations.erase(static_cast<std::size_t>(random.integer(0, static_cast<int>(separations.size()) - 1)));
}

bool never_meet(const Json& certificate) {
  return tools::check_motion_certificate(tools::OrderedJson::parse(certificate.dump())).valid;
}

bool is_curved(const geometry::Motion& motion) {
  return std::holds_alternative<geometry::CurvedMotion>(motion);
}

std::optional<Json> clear_at_random(bool curved, SeededRandom& random) {
  using test::MotionKind;
  constexpr MotionKind kStraight[] = {MotionKind::discs, MotionKind::disc_and_edges, MotionKind::bodies};
  constexpr MotionKind kCurved[] = {MotionKind::curved_discs, MotionKind::curved_edges, MotionKind::bodies};
  const test::MotionCase c = test::random_motion_case(random, (curved ? kCurved : kStraight)[random.integer(0, 2)]);
  if (curved != (is_curved(c.a) || (c.b && is_curved(*c.b)))) return std::nullopt;
  const auto certificate =
      c.b ? geometry::certify(c.a, c.body_a, *c.b, c.body_b) : geometry::certify(c.a, c.body_a, *c.obstacle);
  if (!certificate || certificate->separations.size() > 60) return std::nullopt;  // few lines that take long
  const tools::BodyInMotion moving{c.a, &c.body_a};
  if (c.b) return Json::parse(tools::certificate_text(*certificate, moving, {*c.b, &c.body_b}));
  return Json::parse(tools::certificate_text(*certificate, moving, tools::obstacle_text({"0", *c.obstacle})));
}

void write_moving(bool curved, std::size_t count, SeededRandom& random, const std::string& folder) {
  Cases cases(folder, curved ? "curved" : "clear", ".jsonl");
  for (std::size_t k = 0; k < count;) {
    auto certificate = clear_at_random(curved, random);
    if (!certificate) continue;
    if (k % 2) forge(*certificate, random);
    cases.add(certificate->dump(), never_meet(*certificate));
    ++k;
  }
}

// --- Bodies that turn, as `exactvo monitor --certificates` writes them ---

geometry::RigidBody body_at_random(SeededRandom& random) {
  geometry::RigidBody body;
  for (int parts = random.integer(1, 2); parts > 0; --parts) {
    const Vec2 c = random.in_box(0.6);
    std::vector<Vec2> corners{c};
    if (random.integer(0, 1)) corners.push_back(c + Vec2{random.uniform(0.1, 0.6), 0.0});
    if (corners.size() == 2 && random.integer(0, 1)) corners.push_back(c + Vec2{0.1, random.uniform(0.1, 0.6)});
    const bool is_flat = corners.size() < 3;
    body.push_back({corners, is_flat || random.integer(0, 1) ? random.uniform(0.01, 0.3) : 0.0});
  }
  return body;
}

geometry::TurningMotion drive_at_random(SeededRandom& random) {
  constexpr double kTurns[] = {0.0, 1e-9, -1e-30, 15.0, -3.0};
  const int turn = random.integer(0, 14);
  const double start = random.uniform(-2.0, 2.0), time = random.integer(0, 9) ? random.uniform(0.0, 4.0) : 0.0;
  return {
      start, start + time, random.in_box(4.0), {random.in_box(2.0), turn < 5 ? kTurns[turn] : random.uniform(-2, 2)}};
}

/// A box round the centre: as a wall, and as a polygon with its inside.
geometry::Ring box_round(Vec2 centre, double half) {
  return {centre + Vec2{-half, -half}, centre + Vec2{half, -half}, centre + Vec2{half, half},
          centre + Vec2{-half, half}};
}

geometry::Obstacle standing_at_random(SeededRandom& random, Vec2 at) {
  const Vec2 c = random.in_box(6.0);
  const geometry::Ring ring = box_round(random.integer(0, 3) ? c : at, random.uniform(0.3, 8.0));
  switch (random.integer(0, 3)) {
    case 0:
      return geometry::Polyline{{c, c + random.in_box(3.0)}};
    case 1:
      return geometry::Polyline{{ring[0], ring[1], ring[2], ring[3], ring[0]}};
    case 2:
      return geometry::Polygon{{c, c + Vec2{random.uniform(0.5, 2.0), 0.0}, c + Vec2{0.3, random.uniform(0.5, 2.0)}},
                               {}};
    default:  // a wall of 1 m all round
      const geometry::Ring outer =
          box_round(0.5 * (ring[0] + ring[2]), ring[2].x - 0.5 * (ring[0].x + ring[2].x) + 1.0);
      return geometry::Polygon{outer, {{ring[3], ring[2], ring[1], ring[0]}}};
  }
}

std::optional<Json> turning_at_random(SeededRandom& random) {
  const geometry::TurningMotion motion = drive_at_random(random);
  const geometry::RigidBody body = body_at_random(random);
  const geometry::Obstacle obstacle = standing_at_random(random, motion.at);
  const auto certificate = geometry::certify(motion, body, obstacle);
  if (!certificate || certificate->separations.size() > 60) return std::nullopt;  // each takes the check in C++ a while
  return Json::parse(tools::certificate_text(*certificate, motion, body, tools::obstacle_text({"0", obstacle})));
}

/// The ring of a wall as a polygon: what is within it is inside, however clear of its edges.
bool fill(Json& obstacle) {
  if (!obstacle.contains("polyline") || obstacle["polyline"].size() != 5) return false;
  obstacle["polygon"] = obstacle["polyline"];
  obstacle["polygon"].erase(4);
  obstacle.erase("polyline");
  return true;
}

void write_turning(std::size_t count, SeededRandom& random, const std::string& folder) {
  Cases cases(folder, "turning", ".jsonl");
  for (std::size_t k = 0; k < count;) {
    auto certificate = turning_at_random(random);
    if (!certificate) continue;
    if (k % 2 && !(random.integer(0, 1) && fill((*certificate)["obstacle"]))) forge(*certificate, random);
    cases.add(certificate->dump(), never_meet(*certificate));
    ++k;
  }
}

// --- Choices, as `exactvo lp` reads and prints them ---

Json number_or_null(double bound) {
  return std::isfinite(bound) ? Json(bound) : Json(nullptr);
}

Json name_of(const lp::Binding& b) {
  return is_speed_bound(b) ? Json(name(b.kind)) : Json(b.index);
}

Json terms_json(const std::vector<lp::Term>& terms) {
  Json list = Json::array();
  for (const lp::Term& t : terms) list.push_back({{"constraint", name_of(t.binding)}, {"multiplier", t.multiplier}});
  return list;
}

Json problem_json(const lp::Problem& problem) {
  Json bound = Json::object(), constraints = Json::array();
  if (std::isfinite(problem.bound.disc)) bound["disc"] = problem.bound.disc;
  bound["box"] = {number_or_null(problem.bound.box_x), number_or_null(problem.bound.box_y)};
  for (const lp::Constraint& c : problem.constraints)
    constraints.push_back({{"normal", {c.half_plane.normal.x, c.half_plane.normal.y}},
                           {"offset", c.half_plane.offset},
                           {"priority", c.priority == lp::Priority::hard ? "hard" : "soft"}});
  return {{"bound", bound},
          {"preferred", {problem.preferred.x, problem.preferred.y}},
          {"objective", problem.objective == lp::Objective::nearest ? "nearest" : "farthest"},
          {"constraints", constraints}};
}

void forge(lp::Problem& problem, lp::Certificate& c, SeededRandom& random) {
  switch (random.integer(0, 6)) {
    case 0:
      c.velocity.x = slightly_off(c.velocity.x, random);
      break;
    case 1:
      problem.preferred.y = slightly_off(problem.preferred.y, random);
      break;
    case 2:
      if (!c.bound.empty()) c.bound[0].multiplier[0] = slightly_off(c.bound[0].multiplier[0], random);
      break;
    case 3:
      if (!problem.constraints.empty()) {
        double& offset = problem.constraints.back().half_plane.offset;
        offset = slightly_off(offset, random);
      }
      break;
    case 4:
      c.gap = random.integer(0, 1) ? 0.5 * c.gap : slightly_off(c.gap, random);
      break;
    case 5:
      c.violation = slightly_off(c.violation, random);
      break;
    default:
      if (!c.vertex.empty())
        c.vertex.pop_back();
      else if (!c.contradiction.empty())
        c.contradiction.pop_back();
      else if (!c.bound.empty())
        c.bound.pop_back();
  }
}

void write_choices(std::size_t count, SeededRandom& random, const std::string& folder) {
  Cases problems(folder, "problems", ".jsonl"), answers(folder, "answers", ".jsonl");
  const auto& kinds = lp::well_formed_kinds();
  for (std::size_t k = 0; k < count;) {
    const lp::ProblemKind& kind =
        kinds[static_cast<std::size_t>(random.integer(0, static_cast<int>(kinds.size()) - 1))];
    lp::Problem problem = random.integer(0, 3) ? random_problem(kind, random) : grid_problem(kind, random);
    const lp::Proven proven = lp::solve_certified(problem);
    if (!proven.certificate) continue;
    lp::Certificate c = *proven.certificate;
    if (k % 2) forge(problem, c, random);
    const bool valid = check(problem, c) == lp::CertificateError::none;
    problems.add(problem_json(problem).dump(), true);
    Json certificate{{"bound", terms_json(c.bound)}, {"contradiction", terms_json(c.contradiction)}, {"gap", c.gap}};
    if (c.status == lp::Status::no_interior) {
      certificate["vertex"] = Json::array();
      for (const lp::Binding& b : c.vertex) certificate["vertex"].push_back(name_of(b));
    }
    const Json answer{{"index", k},
                      {"status", name(c.status)},
                      {"velocity", {c.velocity.x, c.velocity.y}},
                      {"violation", c.violation},
                      {"certificate", certificate}};
    answers.add(answer.dump(), valid);
    ++k;
  }
}

}  // namespace
}  // namespace exactvo

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("proof_cases", [&] {
    std::uint64_t count = 2000, seed = 1;
    std::string out, only;
    tools::ProgramOptions options("proof_cases", "Writes certificates, real and forged, with the verdicts of C++.");
    options.whole_number("COUNT", count, 4, "Certificates of each kind");
    options.whole_number("SEED", seed, 0, "Of the random numbers");
    options.text("OUT", out, "A folder that exists", true);
    options.text("--only", only, "The file of one kind, without what follows the point");
    if (!options.parse(argc, argv)) return 0;
    const std::pair<const char*, std::function<void(SeededRandom&)>> kinds[] = {
        {"half-planes", [&](SeededRandom& random) { write_half_planes(count, random, out); }},
        {"containments", [&](SeededRandom& random) { write_containments(count, random, out); }},
        {"routes", [&](SeededRandom& random) { write_routes(count, random, out); }},
        {"clear", [&](SeededRandom& random) { write_moving(false, count, random, out); }},
        {"curved", [&](SeededRandom& random) { write_moving(true, count, random, out); }},
        {"turning", [&](SeededRandom& random) { write_turning(count, random, out); }},
        {"answers", [&](SeededRandom& random) { write_choices(count, random, out); }}};
    for (const auto& [name, write] : kinds) {
      SeededRandom random(seed);  // so that a kind alone is what it is among all
      if (only.empty() || only == name) write(random);
    }
    return 0;
  });
}
