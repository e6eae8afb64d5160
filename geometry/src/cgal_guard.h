// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The airlock: no CGAL failure reaches a user.
///
/// Every function here validates its input exactly before it calls CGAL, so that a CGAL precondition should never fail.
/// What fails none the less becomes a CgalFailure with the values. CGAL's failure handlers are plain process-wide
/// variables: saving and restoring them would race between threads and with the user's own CGAL, so they are left
/// alone. Under their default (throw) they print nothing with g++, and warnings are compiled out (CGAL_NO_WARNINGS in
/// cmake/ExactVOTargets.cmake).

#include <CGAL/exceptions.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace exactvo::geometry::detail {

/// What CGAL refused; all other std::logic_errors are broken requirements of ours.
class CgalFailure : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Runs `work`; a CGAL failure becomes a CgalFailure that names `where` and the text of `values()`.
template <class Work, class Values>
auto without_cgal_failures(const char* where, const Values& values, Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const CGAL::Failure_exception& failure) {
    throw CgalFailure(std::string(where) + ": CGAL refused the input (" + failure.expression() + "); found " +
                      values());
  }
}

}  // namespace exactvo::geometry::detail
