// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Degrees that became metres: what nobody may take for granted, since GeoJSON without units is one of degrees.

#include <string>

#include "exactvo/datasets/obstacle_file.h"

namespace exactvo::tools {

/// "FILE: degrees became metres round longitude X, latitude Y"; empty where nothing was projected.
std::string projection_line(const datasets::ObstacleFile& file);

/// Says the projection_line of a file that has one, and how to read it otherwise.
void say_projection(const datasets::ObstacleFile& file);

}  // namespace exactvo::tools
