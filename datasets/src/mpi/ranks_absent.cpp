// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/ranks.h"

namespace exactvo::datasets {

std::unique_ptr<formation::Ranks> join_ranks() {
  return nullptr;
}

int ranks_started() {
  return 1;
}

}  // namespace exactvo::datasets
