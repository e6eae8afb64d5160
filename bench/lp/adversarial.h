// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The adversarial families against every solver that knows the disc and the relaxation: how often its verdict is not
/// that of the exact one, and how far its velocities stray.

#include <cstdint>
#include <nlohmann/json.hpp>

namespace exactvo::bench {

/// Prints a table, `count` problems a family and perturbation, and gives it as JSON. `wrong` is told whether a
/// certified solver had a wrong verdict.
nlohmann::json run_adversarial(std::size_t count, std::uint64_t seed, bool& wrong);

}  // namespace exactvo::bench
