// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/sets/target.h"

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

#include "exactvo/vo/lp/batch.h"

namespace exactvo::lp {
namespace {

void run_on(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace

bool limit_batch_target(const char* name) {
  run_on(0);
  if (std::strlen(name) == 0) return true;
  const std::int64_t supported = hwy::SupportedTargets();
  for (std::int64_t left = supported; left != 0; left &= left - 1) {
    const std::int64_t bit = left & -left;  // the lowest bit is the best target
    if (std::strcmp(hwy::TargetName(bit), name) != 0) continue;
    run_on(supported & ~(bit - 1));
    if (std::strcmp(batch_target(), name) == 0) return true;
  }
  run_on(0);
  return false;
}

}  // namespace exactvo::lp
