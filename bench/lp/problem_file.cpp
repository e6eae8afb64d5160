// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem_file.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "exactvo/vo/lp/instances.h"
#ifdef EXACTVO_HAVE_DATASETS
#include "exactvo/datasets/lp_problems.h"
#endif

namespace exactvo::bench {
namespace {

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad()) throw std::runtime_error(file + ": found no file that can be read, expected one");
  return bytes;
}

/// What keeps a problem from being compared; empty where nothing does.
std::string obstacle_to_comparing(const lp::Problem& p) {
  if (p.objective != lp::Objective::nearest) return "the objective farthest";
  if (std::isfinite(p.bound.box_x) || std::isfinite(p.bound.box_y)) return "a box";
  if (!std::isfinite(p.bound.disc)) return "no disc";
  return p.bound.disc > 0.0 ? "" : "a disc of 0 m/s";
}

}  // namespace

std::vector<lp::Problem> read_problems(const std::string& file) {
  const std::string bytes = bytes_of(file);
#ifdef EXACTVO_HAVE_DATASETS
  return datasets::parse_lp_problems(bytes, file);
#else
  std::istringstream in(bytes);
  try {
    return lp::read_instances(in);
  } catch (const lp::InstanceError& error) {
    throw std::runtime_error(file + ": " + error.what() + " (lines of JSON are read where datasets is built)");
  }
#endif
}

void make_comparable(std::vector<lp::Problem>& problems, const std::string& file) {
  for (std::size_t k = 0; k < problems.size(); ++k) {
    const std::string found = obstacle_to_comparing(problems[k]);
    if (!found.empty())
      throw std::runtime_error(file + ": problem " + std::to_string(k + 1) + ": found " + found +
                               ", expected a disc, no box and the objective nearest, which every solver here takes");
    for (lp::Constraint& c : problems[k].constraints) {
      const double length = norm(c.half_plane.normal);
      if (std::abs(length - 1.0) <= 0x1p-20) continue;  // recorded in float
      c.half_plane.normal = c.half_plane.normal / length;
      c.half_plane.offset /= length;
    }
  }
}

}  // namespace exactvo::bench
