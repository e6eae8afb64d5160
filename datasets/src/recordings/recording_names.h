// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The words that stand for enumerators in recordings, the same both ways.

#include <string>
#include <utility>
#include <vector>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/recording.h"
#include "json/json_cursor.h"

namespace exactvo::datasets {

template <class E>
using Word = std::pair<E, const char*>;

/// Specialised for the enumerators of a recording.
template <class E>
const std::vector<Word<E>>& words();

template <>
const std::vector<Word<lp::Status>>& words();
template <>
const std::vector<Word<lp::BindingKind>>& words();
template <>
const std::vector<Word<formation::Mode>>& words();
template <>
const std::vector<Word<formation::ConstraintSource>>& words();
template <>
const std::vector<Word<formation::MotionLaw>>& words();
template <>
const std::vector<Word<formation::CollisionKind>>& words();

template <class E>
const char* word_for(E value) {
  for (const auto& [known, word] : words<E>())
    if (known == value) return word;
  return "unknown";
}

/// The enumerator that the text at hand stands for; refuses other words.
template <class E>
E enumerator(const JsonCursor& at) {
  std::string options;
  for (const auto& [known, word] : words<E>()) {
    if (at.text() == word) return known;
    options += (options.empty() ? "" : ", ") + std::string(word);
  }
  at.refuse("one of " + options, DataCode::not_an_option);
}

}  // namespace exactvo::datasets
