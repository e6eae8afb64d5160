// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The words that stand for enumerators in recordings, the same both ways.

#include <string>
#include <vector>

#include "exactvo/formation/recording.h"

namespace exactvo::datasets {

template <class E>
struct Word {
  E value;
  const char* word;
};

/// Specialised for the enumerators of a recording.
template <class E>
const std::vector<Word<E>>& words();

template <>
const std::vector<Word<lp::Status>>& words();
template <>
const std::vector<Word<formation::Mode>>& words();
template <>
const std::vector<Word<formation::ConstraintSource>>& words();
template <>
const std::vector<Word<formation::MotionLaw>>& words();

template <class E>
const char* word_for(E value) {
  for (const Word<E>& known : words<E>()) {
    if (known.value == value) return known.word;
  }
  return "unknown";
}

}  // namespace exactvo::datasets
