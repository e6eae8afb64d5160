// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/report.h"

namespace exactvo::tools {

const std::vector<Equation>& equations() {
  static const std::vector<Equation> all{
      // The model.
      {"(1)",
       "x_i' = v_i, v_i' = u_i",
       "",
       "the same, solved exactly while what is tracked is held over a step; Euler, Runge-Kutta, Dormand-Prince and "
       "Rosenbrock steps to compare",
       {{"formation/src/motion/integrators.cpp", "closed_form"}}},
      {"(2)",
       "x, v in R^(n x 2), stacked in one column",
       "a stacked column has the space R^(2n)",
       "one position and one velocity per robot",
       {{"formation/include/exactvo/formation/recording.h", "struct RobotStep"}}},
      {"(3)",
       "x_i - x_j -> Delta_i - Delta_j, v_i - v_j -> 0",
       "",
       "measured: the worst distance from a slot and the worst difference from the leader's velocity",
       {{"formation/src/metrics/metrics_accumulator.cpp", "write_formation"}}},
      {"(4)",
       "the mean of x_i tends to x_L",
       "contradicts Section V.B, whose offsets sum to (1, 1): the centroid would be 0.471 m off",
       "offsets less their mean, unless the scenario says `recentre: false`",
       {{"formation/src/control/consensus.cpp", "offsets_in_use"}}},
      {"(5)",
       "a_ij = 1 on edges, else 0; b_i > 0 where i hears the leader",
       "",
       "any weights a_ij = a_ji >= 0; refused where a robot hears the leader neither directly nor through others",
       {{"formation/src/scene/scenario.cpp", "reaches_leader"}}},
      // Velocity obstacles.
      {"(6), (7)",
       "VO = { v : some t in [0, tau] has t v in D(p_B - p_A, r_A + r_B) }",
       "t = 0 matters in contact only; v is the relative velocity where the obstacle moves",
       "0 < t <= tau, for every convex shape through its support function; shifted by the obstacle's velocity",
       {{"vo/include/exactvo/vo/velocity_obstacle.h", "class VelocityObstacle"},
        {"formation/src/scene/moving.cpp", "moving_constraints"}}},
      {"(8)",
       "d = min |l - O' (+) D(p_A, r_A)| > r_A",
       "literally 0, because l lies inside O' (+) D",
       "l inside the interior of O', by a margin: d = r + the least depth of l in O'",
       {{"geometry/include/exactvo/geometry/enclosure.h", "clearance_of_equation_8"}}},
      {"(9)",
       "IVO = { v : some t in [0, tau] has t v in O' (+) D(p_A, r_A) }",
       "shifted by +p_A",
       "S = (O' - p_A) (+) D(0, r_A)",
       {{"geometry/include/exactvo/geometry/support.h", "struct GrownShape"}}},
      {"tau",
       "tau = dist / v_opt",
       "divides by a vector; infinite at rest, where both tables start; 0 in contact",
       "clamp(dist / max(|v|, v_floor), tau_min, tau_max), tau_min >= 2 dt",
       {{"formation/src/scene/static_field.cpp", "StaticField::horizon"}}},
      {"(10)",
       "IVOA = { v : (v - (v_opt + alpha u)).n >= 0 }",
       "\"O = 1\", \"robot O\"; n is undefined at u = 0 and where v_opt is outside",
       "n: the outward unit normal of the velocity obstacle at its boundary point nearest v_opt; n.v >= h_S(n) / tau; "
       "alpha = 1 against obstacles and robots that do not cooperate, 1/2 between robots; each is certified to exclude "
       "the velocity obstacle",
       {{"vo/include/exactvo/vo/velocity_obstacle.h", "half_plane"},
        {"vo/include/exactvo/vo/reciprocal.h", "reciprocal_half_planes"}}},
      {"(11)",
       "the disc of |v| <= v_max cut by every IVOA",
       "the velocity limit is printed as [3, 3], which can be read as a box",
       "disc or box, as `speed_bound` says; always holds v = 0 where the obstacles are static",
       {{"formation/src/decision/decision.cpp", "speed_bound"}}},
      {"(12)",
       "v_new = argmin over IVOA of |v - v_pref|",
       "called a linear program; it is the closest point of a convex set, a small quadratic program",
       "solved in double precision by an active-set method, the constraints moved inward by the rounding; multipliers "
       "prove the answer, or exact arithmetic finds it",
       {{"vo/include/exactvo/vo/lp/solve.h", "solve"}}},
      {"(13)",
       "IVOA+ = IVOA cut by every ORCA half-plane against another robot",
       "can be infeasible",
       "static half-planes are hard; the largest violation of those of robots and moving obstacles is made as small as "
       "possible",
       {{"formation/src/decision/decision.cpp", "robot_constraints"}}},
      // The controller.
      {"(14)",
       "u_ci = -k1 { sum a_ij (x_i - x_j - Delta_i + Delta_j) + b_i (x_i - x_L - Delta_i) } "
       "- k2 [ sum a_ij (v_i - v_j) + b_i (v_i - v_L) ]",
       "",
       "the same",
       {{"formation/src/control/consensus.cpp", "consensus_input"}}},
      {"(15)",
       "u_i = +k1 [...] - k2 [...] - k3 (v^_i - V_IVO)",
       "+k1 contradicts (14) and pushes apart; a relative v^ less an absolute V_IVO steers to v_L + V_IVO",
       "u = -k3 (v - w): the consensus term goes into the preference, and what is tracked is the safe velocity w "
       "itself; "
       "half-planes at the brake point x + v / k3, which moves at exactly w",
       {{"formation/src/runs/formation_run.cpp", "tracked_velocity"},
        {"formation/src/control/controller_options.cpp", "controller_options_of"}}},
      {"(16)",
       "V_IVO = argmin over IVOA+ of |v - v_pref|",
       "",
       "the same",
       {{"formation/src/decision/decision.cpp", "decide"}}},
      {"(17)",
       "v_pref = v_max (x_i - x_L - Delta_i) / |x_i - x_L - Delta_i|",
       "points away from the slot, at full speed even there, 0/0 at the slot, without the leader's velocity",
       "v_L - min(kappa |x^|, v_s) x^ / |x^|",
       {{"formation/src/control/consensus.cpp", "preference"}}},
      {"(18)",
       "V = 1/2 sum v^_i^2 + k1/4 sum a_ij (x^_i - x^_j)^2 + k1/2 sum b_i x^_i^2 + k3 sum integral v^_i (v^_i - V_IVO) "
       "dt",
       "the integral is defined so that its derivative cancels whatever V_IVO does: no Lyapunov function, V falls "
       "below "
       "0",
       "both are recorded: (18), and V = 1/2 |v^|^2 + k1/2 x^T (L+B) x^ + k3 sum Phi(x^_i), Phi the Huber potential",
       {{"formation/src/control/lyapunov.cpp", "paper_terms"}, {"formation/src/control/lyapunov.cpp", "sound_terms"}}},
      {"(19)",
       "V' = sum v^_i u^_i + k1/2 sum a_ij (x^_i - x^_j)(v^_i - v^_j) + k1 sum b_i x^_i v^_i + k3 sum v^_i (v^_i - "
       "V_IVO)",
       "right, of (18)",
       "recorded term by term with the acceleration that the robots had",
       {{"formation/src/control/lyapunov.cpp", "paper_rates"}}},
      {"(20)",
       "V' = -k2/2 sum a_ij (v^_i - v^_j)^2 - k2 sum b_i v^_i^2",
       "needs (15) to be tracked with -k1; says nothing of x^",
       "V' = -k2 v^T (L+B) v^ - k3 |v^|^2 in free space, and <= -(k3/2) |v^|^2 + (k3/2) |e|^2 near obstacles",
       {{"formation/src/control/lyapunov.cpp", "add_rates"},
        {"examples/theorem_one.cpp", "theorem_one_counterexample"}}},
      {"(21)",
       "A: all three hear each other; B = (1, 1, 1)",
       "",
       "the same; the eigenvalues of L + B, the rate and the step limit are said before a run",
       {{"formation/src/control/stability.cpp", "stability_of"}}},
  };
  return all;
}

}  // namespace exactvo::tools
