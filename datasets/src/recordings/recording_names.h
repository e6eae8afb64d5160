// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The words that stand for enumerators in recordings, the same both ways.

#include <string>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/recording.h"
#include "exactvo/geometry/names.h"
#include "json/json_text.h"

namespace exactvo::datasets {

/// Each with the name that the library has for it.
template <class E, std::size_t N>
geometry::Names<E, N> named(const E (&values)[N]) {
  geometry::Names<E, N> words;
  for (std::size_t k = 0; k < N; ++k) words[k] = {values[k], name(values[k])};
  return words;
}

// The words of an enumeration, by any of its values.

inline const auto& words(lp::Status) {
  using E = lp::Status;
  static const auto kWords = named({E::optimal, E::relaxed, E::infeasible, E::no_interior});
  return kWords;
}

inline const auto& words(formation::Mode) {
  using E = formation::Mode;
  static const auto kWords = named({E::direct, E::guided, E::boost, E::by_plan, E::going_back, E::following,
                                    E::pushing_out, E::steered, E::staying, E::arrived});
  return kWords;
}

inline const auto& words(formation::OwnStage) {
  using E = formation::OwnStage;
  static const auto kWords = named({E::none, E::held, E::gave, E::left_out});
  return kWords;
}

/// The names of the parts of the speed bound.
inline const auto& words(lp::BindingKind) {
  using E = lp::BindingKind;
  static constexpr geometry::Names<E, 5> kWords{{{E::disc, "disc"},
                                                 {E::box_right, "right"},
                                                 {E::box_left, "left"},
                                                 {E::box_top, "top"},
                                                 {E::box_bottom, "bottom"}}};
  return kWords;
}

inline const auto& words(formation::ConstraintSource) {
  using E = formation::ConstraintSource;
  static constexpr geometry::Names<E, 4> kWords{{{E::enclosure, "enclosure"},
                                                 {E::obstacle_edge, "obstacle-edge"},
                                                 {E::robot, "robot"},
                                                 {E::moving_obstacle, "moving-obstacle"}}};
  return kWords;
}

inline const auto& words(formation::MotionLaw) {
  using E = formation::MotionLaw;
  static constexpr geometry::Names<E, 3> kWords{
      {{E::straight, "straight"}, {E::exponential, "exponential"}, {E::hermite, "hermite"}}};
  return kWords;
}

inline const auto& words(formation::CollisionKind) {
  using E = formation::CollisionKind;
  static constexpr geometry::Names<E, 3> kWords{
      {{E::obstacle, "obstacle"}, {E::moving_obstacle, "moving-obstacle"}, {E::robot, "robot"}}};
  return kWords;
}

template <class E>
const char* word_for(E value) {
  return geometry::name_in(words(value), value);
}

/// Refuses words that stand for no enumerator.
template <class E>
auto read_value(const JsonCursor& at, E& value) -> decltype(words(value), void()) {
  if (geometry::parse_in(words(value), at.text(), value)) return;
  std::string options;
  for (const std::string& word : geometry::words_in(words(value))) options += (options.empty() ? "" : ", ") + word;
  at.refuse("one of " + options, DataCode::not_an_option);
}

template <class E>
auto append_value(JsonWriter& json, const E& value) -> decltype(words(value), void()) {
  json.value(word_for(value));
}

}  // namespace exactvo::datasets
