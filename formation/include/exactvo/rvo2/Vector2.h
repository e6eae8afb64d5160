// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// For programs that include "Vector2.h": put this folder on the include path.

#include "exactvo/rvo2.h"
