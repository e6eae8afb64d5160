// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The usual implementation of reciprocal collision avoidance, written afresh for comparison: an array of agents, a k-d
/// tree that is built anew in every step, a sorted list of neighbours an agent, half-planes and an incremental linear
/// program in float (van den Berg, Guy, Lin, Manocha 2011; de Berg et al., chapter 4). One translation unit, so that
/// all of it can be inlined. Nothing is certified.

#include <cstddef>
#include <memory>

namespace exactvo::bench {

struct TextbookAgent {
  float x = 0, y = 0, vx = 0, vy = 0;      ///< m, m/s
  float preferred_x = 0, preferred_y = 0;  ///< m/s
  float radius = 0.5F, max_speed = 1.5F;   ///< m, m/s
  float time_horizon = 5.0F;               ///< s
  float neighbour_distance = 15.0F;        ///< m
  int neighbours = 10;
};

class TextbookCrowd {
 public:
  explicit TextbookCrowd(float time_step);
  ~TextbookCrowd();
  TextbookCrowd(TextbookCrowd&&) noexcept;
  void reserve(std::size_t agents);
  void add(const TextbookAgent& agent);
  std::size_t size() const;
  /// As it was read or written last.
  TextbookAgent& operator[](std::size_t agent);
  void read();   ///< takes what was changed
  void step();   ///< what is timed
  void write();  ///< gives positions and velocities
  std::size_t bytes() const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace exactvo::bench
