// SPDX-License-Identifier: GPL-3.0-or-later
// What do both legs of an ellipse with a disc cost, each as a certified bracket, against CGAL's Algebraic_kernel_d_1,
// which isolates the roots of the legs' quartic? `ratio` = CGAL / ours.
#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/CORE_BigInt.h>
#include <CGAL/CORE_BigRat.h>

#include <cmath>

#include "exactvo/vo/velocity_obstacle.h"
#include "in_turns.h"
#include "instances.h"

namespace exactvo::bench {
namespace {

using Integer = CORE::BigInt;
using Kernel = CGAL::Algebraic_kernel_d_1<Integer>;
using geometry::Ellipse;
using geometry::Vec2;

constexpr std::size_t kInstances = 512;
constexpr double kGrid = 0x1p20;  // inputs are multiples of 2^-20, so that the kernel's integers stay short

double on_grid(double x) {
  return std::round(x * kGrid) / kGrid;
}

Instance on_grid(Instance i) {
  Ellipse& e = std::get<Ellipse>(i.s.shape);
  e = {{on_grid(e.center.x), on_grid(e.center.y)}, on_grid(e.l11), on_grid(e.l21), on_grid(e.l22)};
  i.s.origin = {on_grid(i.s.origin.x), on_grid(i.s.origin.y)};
  i.s.radius = on_grid(i.s.radius);
  return i;
}

Integer integer(double x) {
  return Integer(std::round(x * kGrid));
}

/// With n = (1 - s^2, 2 s): A + 2 B s + C s^2 = -|L^T n|, squared; coefficients from s^0 up.
struct Quartic {
  Integer A, B, C;
  Kernel::Polynomial_1 polynomial;

  explicit Quartic(const Instance& i) {
    const Ellipse& e = std::get<Ellipse>(i.s.shape);
    const Integer r = integer(i.s.radius);
    const Integer px = integer(e.center.x - i.s.origin.x), py = integer(e.center.y - i.s.origin.y);
    const Integer l11 = integer(e.l11), l21 = integer(e.l21), l22 = integer(e.l22);
    const Integer s11 = l11 * l11, s12 = l11 * l21, s22 = l21 * l21 + l22 * l22;
    A = px + r;
    B = py;
    C = r - px;
    const Integer two(2), four(4);
    const Integer c[5] = {A * A - s11, four * (A * B - s12), four * B * B + two * A * C + two * s11 - four * s22,
                          four * (B * C + s12), C * C - s11};
    polynomial = Kernel::Polynomial_1(c, c + 5);
  }
};

/// The normals' s = tan(theta / 2), ascending: the roots with A + 2 B s + C s^2 <= 0.
std::vector<double> algebraic_legs(const Instance& i) {
  const Quartic quartic(i);
  const Kernel kernel;
  std::vector<Kernel::Algebraic_real_1> roots;
  kernel.solve_1_object()(quartic.polynomial, true, std::back_inserter(roots));
  const Integer side[3] = {quartic.A, Integer(2) * quartic.B, quartic.C};
  const Kernel::Polynomial_1 outward(side, side + 3);
  std::vector<double> legs;
  for (const Kernel::Algebraic_real_1& root : roots)
    if (kernel.sign_at_1_object()(outward, root) != CGAL::POSITIVE) legs.push_back(CGAL::to_double(root));
  return legs;
}

double half_angle_tangent(Vec2 n) {
  return std::tan(0.5 * std::atan2(n.y, n.x));
}

std::optional<vo::Legs> certified_legs(const Instance& i) {
  return vo::VelocityObstacle(i.s.shape, i.s.origin, i.s.radius, i.time_horizon).legs();
}

bool same(const Instance& i) {
  const auto ours = certified_legs(i);
  const std::vector<double> theirs = algebraic_legs(i);
  if (!ours || theirs.size() != 2) return false;
  double s[2] = {half_angle_tangent(ours->left.normal), half_angle_tangent(ours->right.normal)};
  std::sort(s, s + 2);
  constexpr double kSame = 1e-9;  // relative to 1 + s^2, the derivative of the tangent
  return std::fabs(s[0] - theirs[0]) <= kSame * (1.0 + s[0] * s[0]) &&
         std::fabs(s[1] - theirs[1]) <= kSame * (1.0 + s[1] * s[1]);
}

void legs_against_algebraic_kernel(benchmark::State& state) {
  std::vector<Instance> instances = random_instances(Obstacle::ellipse, kInstances, 10);
  for (Instance& i : instances) {
    i = on_grid(i);
    if (!same(i)) return state.SkipWithError("the legs differ");
  }
  report_ratio(state, instances, certified_legs, algebraic_legs, certified_legs, 5);
}
BENCHMARK(legs_against_algebraic_kernel);

}  // namespace
}  // namespace exactvo::bench
