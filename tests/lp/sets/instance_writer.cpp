// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ostream>

#include "exactvo/geometry/require.h"
#include "lp/sets/generated_sets.h"

namespace exactvo::lp {
namespace {

void write_word(std::ostream& out, std::uint32_t word) {
  const char bytes[4] = {static_cast<char>(word & 255U), static_cast<char>(word >> 8 & 255U),
                         static_cast<char>(word >> 16 & 255U), static_cast<char>(word >> 24)};
  out.write(bytes, 4);
}

void write_number(std::ostream& out, double value) {
  const auto rounded = static_cast<float>(value);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &rounded, sizeof bits);
  write_word(out, bits);
}

void write_line(std::ostream& out, const HalfPlane& h) {
  const Vec2 foot = (h.offset / squared_norm(h.normal)) * h.normal;
  for (const double x : {foot.x, foot.y, h.normal.y, -h.normal.x}) write_number(out, x);
}

void write_instance(std::ostream& out, const Problem& problem) {
  std::uint32_t hard = 0;
  for (const Constraint& c : problem.constraints) hard += c.priority == Priority::hard;
  write_word(out, static_cast<std::uint32_t>(problem.constraints.size()));
  write_word(out, hard);
  for (const double x : {problem.bound.disc, problem.preferred.x, problem.preferred.y}) write_number(out, x);
  for (const Priority priority : {Priority::hard, Priority::soft})
    for (const Constraint& c : problem.constraints)
      if (c.priority == priority) write_line(out, c.half_plane);
}

}  // namespace

void write_instances(std::ostream& out, const std::vector<Problem>& problems) {
  write_word(out, static_cast<std::uint32_t>(problems.size()));
  for (const Problem& problem : problems) {
    EXACTVO_REQUIRE(std::isfinite(problem.bound.disc) && std::isinf(problem.bound.box_x) &&
                        std::isinf(problem.bound.box_y) && problem.objective == Objective::nearest,
                    "a problem that the file format cannot hold");
    write_instance(out, problem);
  }
}

}  // namespace exactvo::lp
