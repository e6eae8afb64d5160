// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The answer of `exactvo check` in words and as JSON lines: events and findings as they come up, then the whole.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "support/checked_file.h"
#include "support/json_layout.h"
#include "support/terminal.h"

namespace exactvo::tools {

/// Which overlaps a check would miss that looks at each move at this many moments, evenly spaced from its row on.
class SampledMoves {
 public:
  SampledMoves(std::size_t samples, std::size_t agents) : samples_(samples), last_(agents) {}

  /// Pieces in the order in which the stream takes them, each before the stream does.
  void add(std::size_t agent, const geometry::Motion& piece);
  /// Whether a sample falls into the event, which was just reported.
  bool finds(const geometry::MotionEvent& event) const;

 private:
  std::size_t samples_;
  struct Span {
    double from = 0.0, to = 0.0;  ///< s
  };
  std::vector<std::array<Span, 2>> last_;  ///< of each agent, the later piece first
};

class CheckAnswer {
 public:
  CheckAnswer(const CheckedFile& asked, bool json) : asked_(asked), json_(json) {}

  /// A line of progress, which gives way to what is printed; null: none.
  void set_progress(ProgressLine* line) { progress_ = line; }

  /// Before the rest: what was read, and which motion between rows is assumed.
  void begin();
  void add(const geometry::MotionEvent& event);
  /// A jump, a gap, or neither.
  void look_at(const datasets::Move& move);
  /// Approaches and the whole. `missed`: overlaps that samples do not find.
  void finish(const geometry::MotionCheck& check, std::uint64_t missed);

  std::uint64_t jumps() const { return jumps_; }
  std::uint64_t gaps() const { return gaps_; }

 private:
  std::string name_of(std::size_t agent) const;
  std::string other_of(bool with_obstacle, std::size_t other) const;
  /// Prints in chunks.
  void put(const std::string& text);
  void print_waiting();
  void list_approaches(const std::vector<geometry::Approach>& approaches);
  OrderedJson bodies_json() const;
  OrderedJson summary_json(const geometry::MotionCheck& check, std::uint64_t missed) const;
  void put_greatest(const char* what, datasets::Extreme datasets::AgentSurvey::*member, const char* unit);
  void put_counts(const geometry::MotionCheck& check, std::uint64_t missed);

  const CheckedFile& asked_;
  bool json_;
  ProgressLine* progress_ = nullptr;
  std::string waiting_;  ///< to be printed
  std::uint64_t jumps_ = 0, gaps_ = 0;
};

}  // namespace exactvo::tools
