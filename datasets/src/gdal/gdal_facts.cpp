// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/gdal_facts.h"

#include <string_view>

#include "exactvo/datasets/obstacle_file.h"

namespace exactvo::datasets {

std::string gdal_release() {
  return EXACTVO_GDAL_RELEASE;
}

bool built_with_gdal() {
  return std::string_view(EXACTVO_GDAL_RELEASE) != "none";
}

}  // namespace exactvo::datasets
