// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/run_info.h"

namespace exactvo::formation {

inline bool audits_clean(const Scenario& scenario, const Recording& run) {
  return datasets::audit({datasets::run_info(scenario, {}, {}), scenario, run}).clean();
}

}  // namespace exactvo::formation
