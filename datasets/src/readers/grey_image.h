// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Pictures of maps as brightness. PGM is read here; PNG, BMP and JPEG through GDAL.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::datasets {

struct GreyImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<float> brightness;     ///< 0 to 255, the mean of the colour channels, top row first
  std::vector<bool> is_transparent;  ///< empty where the picture has no alpha channel
};

/// Throws DataError: E_IMAGE, or E_SIZE for more pixels than kMostCells or than the file holds.
GreyImage read_image(const std::filesystem::path& path);

// One per kind, for read_image.
GreyImage read_pgm(const std::string& bytes, const std::string& file);
/// gdal_image.cpp, or gdal_absent.cpp; called through vector_library.h.
GreyImage read_gdal_image(const std::filesystem::path& path);

}  // namespace exactvo::datasets
