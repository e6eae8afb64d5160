// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem_file.h"

#include <cmath>
#include <filesystem>
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
  if (std::filesystem::is_directory(file)) throw std::runtime_error(file + ": found a folder, expected a file");
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad()) throw std::runtime_error(file + ": found no file that can be read, expected one");
  return bytes;
}

/// Solvers that work in float take speeds whose squares are floats, and lines that hold however far away they are.
constexpr double kMost = 1e18, kFarthest = -1e37;

bool has_square(double number) {
  return std::abs(number) < kMost;
}

std::string text_of(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

/// What keeps a problem from being compared; empty where nothing does.
std::string obstacle_to_comparing(const lp::Problem& p) {
  if (p.objective != lp::Objective::nearest) return "the objective farthest";
  if (std::isfinite(p.bound.box_x) || std::isfinite(p.bound.box_y)) return "a box";
  if (!std::isfinite(p.bound.disc)) return "no disc";
  if (!(p.bound.disc > 1.0 / kMost && has_square(p.bound.disc))) return "a disc of " + text_of(p.bound.disc) + " m/s";
  for (const double v : {p.preferred.x, p.preferred.y})
    if (!has_square(v)) return "a preferred velocity of " + text_of(v) + " m/s";
  for (const lp::Constraint& c : p.constraints)
    if (!(c.half_plane.offset < kMost && c.half_plane.offset > kFarthest))
      return "an offset of " + text_of(c.half_plane.offset) + " m/s";
  return "";
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
    for (lp::Constraint& c : problems[k].constraints) {
      const double length = std::hypot(c.half_plane.normal.x, c.half_plane.normal.y);
      if (std::abs(length - 1.0) <= 0x1p-20) continue;  // recorded in float
      c.half_plane.normal = c.half_plane.normal / length;
      c.half_plane.offset /= length;
    }
    const std::string found = obstacle_to_comparing(problems[k]);
    if (!found.empty())
      throw std::runtime_error(file + ": problem " + std::to_string(k + 1) + ": found " + found +
                               ", expected a disc above 1e-18, no box, the objective nearest and numbers below 1e18 "
                               "with normals of length 1, which every solver here takes");
  }
}

}  // namespace exactvo::bench
