// SPDX-License-Identifier: GPL-3.0-or-later
#include "published.h"

namespace exactvo::bench {
namespace {

const char* const kRorcal = "Gros-Lemesre, Revised ORCA Logic (RORCAL), 2026, abstract";
const char* const kNavground = "navground, tutorial \"Deadlocks and Collisions\", table of its output";
const char* const kDergachev =
    "Dergachev and Yakovlev, \"Distributed Multi-agent Navigation Based on Reciprocal Collision Avoidance and Locally "
    "Confined Multi-agent Path Finding\", CASE 2021 (arXiv 2107.00246), abstract";

}  // namespace

const std::vector<Published>& published() {
  static const std::vector<Published> all{
      {"circle", "2 to 30", "ORCA: a deadlock for every n from 2 to 30 where the symmetry is exact", kRorcal, true,
       "the same scene, exactly symmetric; radii, speeds and the program of ORCA differ"},
      {"circle", "2 to 30, 250", "a bias in direction resolves every deadlock that was tried; 23 % faster at 250",
       kRorcal, false, "faster than a method that is not in this table"},
      {"cross", "margin 0 to 0.25 m", "ok in 0.656 of 250 runs (safe 0.856, fluid 0.796)", kNavground, false,
       "the scene, numbers, margins and the definition of ok are the tutorial's. Its robots have two wheels, prefer "
       "0.12 "
       "m/s and use the method HL; here they drive in any direction and prefer 0.166 m/s, its limit. Starts are drawn "
       "apart here, there they are pushed apart"},
      {"cross", "margin 0 to 0.25 m", "ok in 0.551 of 5,000 runs (safe 0.599, fluid 0.952)", kNavground, false,
       "as above, with the method's barrier angle drawn for each run too"},
      {"narrow", "doorway", "Social-IMPC-DR: 2 of 2 robots, makespan 15.00 s", "SMGLib (CRAL-UVA), README", false,
       "starts, goals, radius, speed and walls are those of its StandardizedEnvironment; its robots accelerate, the "
       "method "
       "runs in coordinates of its own, and its makespan counts steps to the end of the run"},
      {"paper", "A1 to A15", "the textbook method stops at walls and clusters, the improved one passes",
       "the paper, Section V.A, with errata", false,
       "here all methods go along routes; `exactvo paper` compares the paper's methods as it does"},
      {"routes", "points", "lengths of shortest paths; 17 to 724 us per query, depending on the suite",
       "Polyanya (Cui, Harabor and Grastien, IJCAI 2017), its public implementation on Moving AI maps", false,
       "lengths are comparable: path is ours over theirs. Times are not: another machine, and its answers have no "
       "radius and "
       "no proof"},
      {"maps", "gap, rooms", "success rate raised \"from 15% to 99% in certain cases\"", kDergachev, false,
       "maps are rebuilt from a description, starts and goals are drawn anew, and the abstract names no cell"}};
  return all;
}

}  // namespace exactvo::bench
