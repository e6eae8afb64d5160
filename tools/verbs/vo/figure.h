// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The pictures of `exactvo vo`: one cone with its half-plane; the family side by side; the free velocities.

#include "figures/figure.h"
#include "verbs/vo/answer.h"

namespace exactvo::tools {

Figure vo_figure(const VoAnswer& answer);

}  // namespace exactvo::tools
