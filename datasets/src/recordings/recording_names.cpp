// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/recording_names.h"

#include <initializer_list>

namespace exactvo::datasets {

namespace {

/// Each with the name that the library has for it.
template <class E>
std::vector<Word<E>> named(std::initializer_list<E> values) {
  std::vector<Word<E>> words;
  for (const E value : values) words.push_back({value, name(value)});
  return words;
}

}  // namespace

template <>
const std::vector<Word<lp::Status>>& words() {
  using lp::Status;
  static const auto kWords = named({Status::optimal, Status::relaxed, Status::infeasible, Status::no_interior});
  return kWords;
}

template <>
const std::vector<Word<lp::BindingKind>>& words() {
  using lp::BindingKind;
  static const std::vector<Word<BindingKind>> kWords{{BindingKind::disc, "disc"},
                                                     {BindingKind::box_right, "right"},
                                                     {BindingKind::box_left, "left"},
                                                     {BindingKind::box_top, "top"},
                                                     {BindingKind::box_bottom, "bottom"}};
  return kWords;
}

template <>
const std::vector<Word<formation::Mode>>& words() {
  using formation::Mode;
  static const auto kWords = named({Mode::direct, Mode::guided, Mode::boost, Mode::by_plan, Mode::going_back,
                                    Mode::following, Mode::pushing_out, Mode::staying, Mode::arrived});
  return kWords;
}

template <>
const std::vector<Word<formation::ConstraintSource>>& words() {
  using formation::ConstraintSource;
  static const std::vector<Word<ConstraintSource>> kWords{{ConstraintSource::enclosure, "enclosure"},
                                                          {ConstraintSource::obstacle_edge, "obstacle-edge"},
                                                          {ConstraintSource::robot, "robot"},
                                                          {ConstraintSource::moving_obstacle, "moving-obstacle"}};
  return kWords;
}

template <>
const std::vector<Word<formation::MotionLaw>>& words() {
  using formation::MotionLaw;
  static const std::vector<Word<MotionLaw>> kWords{
      {MotionLaw::straight, "straight"}, {MotionLaw::exponential, "exponential"}, {MotionLaw::hermite, "hermite"}};
  return kWords;
}

template <>
const std::vector<Word<formation::CollisionKind>>& words() {
  using formation::CollisionKind;
  static const std::vector<Word<CollisionKind>> table = {{CollisionKind::obstacle, "obstacle"},
                                                         {CollisionKind::moving_obstacle, "moving-obstacle"},
                                                         {CollisionKind::robot, "robot"}};
  return table;
}

}  // namespace exactvo::datasets
