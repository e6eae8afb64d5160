// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Small pictures of obstacles and the page that holds them.

#include <cstddef>
#include <string>

#include "exactvo/geometry/obstacle_shapes.h"

namespace exactvo::datasets::batch {

inline constexpr std::size_t kPicturesOfInput = 6;  ///< of an input's first obstacles
inline constexpr std::size_t kInputsOfPage = 250;

/// One `<figure>`: the obstacle, its hull, the facades' ellipses, the smallest and the trap-free ellipse.
std::string picture_of(const std::string& id, const geometry::ObstacleShapes& shapes);

/// What stands between the figures. Page `page` of `pages`, from 0.
std::string page_name(std::size_t page);
std::string page_head(std::size_t page, std::size_t pages, const std::string& summary);
std::string input_head(const std::string& file, const std::string& words);
std::string input_foot();
std::string page_foot(const std::string& provenance);

}  // namespace exactvo::datasets::batch
