// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What `normalize` (validity.h) throws where rings touch or cross so often that finding every misplaced hole would
/// take minutes: edges whose boxes meet in more than 2^26 pairs, or 2^29 tests of a hole's vertex against an edge of
/// another ring. Equal holes do not count: they are found by sorting.

#include <stdexcept>

namespace exactvo::geometry {

/// Thrown by `normalize`; its text says what is too much.
class TooManyContacts : public std::runtime_error {
 public:
  /// With a fixed text.
  TooManyContacts() : std::runtime_error("rings that touch or cross too often") {}
};

}  // namespace exactvo::geometry
