// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The page of `exactvo check`: the trajectories on the map, to be played, and every overlap with its witness. Keeps
/// the bends of all ways; of long ones so many that the page stays within its limits.

#include <string>
#include <vector>

#include "explorer/packed_run.h"
#include "support/checked_file.h"

namespace exactvo::tools {

class CheckPage {
 public:
  CheckPage(const CheckedFile& asked, const std::vector<geometry::RigidBody>& bodies);

  /// Pieces of one agent by time.
  void add(std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned);
  void add(const geometry::MotionEvent& event);
  /// The whole page.
  std::string page(const geometry::MotionCheck& check) const;

 private:
  struct Knot {
    double time = 0.0;     ///< s
    geometry::Vec2 at;     ///< m
    bool begins = false;   ///< the agent was not there just before
    double heading = 0.0;  ///< rad
  };

  void put(std::size_t agent, const Knot& knot);
  std::vector<std::vector<Knot>> whole_ways() const;
  std::vector<double> moments(const std::vector<std::vector<Knot>>& ways, bool& is_thinned) const;
  datasets::RecordingFile about(const geometry::MotionCheck& check, bool is_thinned) const;
  std::string packed(const geometry::MotionCheck& check) const;
  nlohmann::ordered_json body_json(std::size_t agent, const std::vector<Knot>& way) const;

  const CheckedFile& asked_;
  const std::vector<geometry::RigidBody>& bodies_;
  PackedRunLimits limits_;
  double least_step_ = 0.0;  ///< s, between knots of one way
  bool has_headings_ = false;
  std::vector<std::vector<Knot>> ways_;
  std::vector<Knot> last_;  ///< of each agent, not kept yet
  std::vector<bool> has_last_;
  std::vector<geometry::MotionEvent> overlaps_;
  std::size_t overlaps_left_out_ = 0;
};

}  // namespace exactvo::tools
