// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "exactvo/formation/recording.h"

namespace exactvo::formation::detail {

/// A non-owning pointer; `row` must outlive it.
inline std::shared_ptr<const Step> borrowed(const Step& row) {
  return {std::shared_ptr<void>(), &row};
}

}  // namespace exactvo::formation::detail
