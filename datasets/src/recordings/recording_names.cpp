// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/recording_names.h"

namespace exactvo::datasets {

template <>
const std::vector<Word<lp::Status>>& words() {
  static const std::vector<Word<lp::Status>> kWords{{lp::Status::optimal, "optimal"},
                                                    {lp::Status::relaxed, "relaxed"},
                                                    {lp::Status::infeasible, "infeasible"},
                                                    {lp::Status::no_interior, "no-interior"}};
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
  static const std::vector<Word<Mode>> kWords{
      {Mode::direct, "direct"},           {Mode::guided, "guided"},         {Mode::boost, "boost"},
      {Mode::by_plan, "by-plan"},         {Mode::going_back, "going-back"}, {Mode::following, "following"},
      {Mode::pushing_out, "pushing-out"}, {Mode::staying, "staying"},       {Mode::arrived, "arrived"}};
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
