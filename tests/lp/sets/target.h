// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which SIMD target the lanes run on, for tests and benches that compare targets.

namespace exactvo::lp {

/// Runs on targets no wider than `name` from now on ("AVX2", "SSE4", "" for the best again). Not thread-safe. False
/// where no such target is compiled in and supported.
bool limit_batch_target(const char* name);

}  // namespace exactvo::lp
