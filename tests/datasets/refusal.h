// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets::test {

/// The DataError that `action` throws; a failure of the test where it throws none.
template <class Action>
DataError refusal_of(Action action) {
  try {
    action();
  } catch (const DataError& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was refused";
  return {DataCode::scenario, "", "", "nothing", "a refusal"};
}

inline void expect_refusal(const DataError& error, DataCode code, const std::string& place) {
  EXPECT_STREQ(code_name(error.code()), code_name(code)) << error.what();
  EXPECT_EQ(error.place(), place) << error.what();
}

}  // namespace exactvo::datasets::test
