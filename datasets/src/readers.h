// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The readers of this room, one file each: how each knows its own, and how it hands a file to the collector.

#include <filesystem>
#include <string>
#include <vector>

#include "raw_geometry.h"

namespace exactvo::datasets {

/// What a reader may look at to know its own: the name and the first bytes.
struct Glimpse {
  std::filesystem::path path;
  std::string extension;  ///< lower case, with its dot
  std::string beginning;  ///< the first kGlimpseLength bytes
};
inline constexpr std::size_t kGlimpseLength = 4096;

struct Reader {
  const char* name;
  bool (*recognises)(const Glimpse& glimpse);
  void (*read)(const std::filesystem::path& path, Collector& out);
};

/// In order of preference: the surest marks first.
const std::vector<Reader>& readers();

// wkt_reader.cpp
bool looks_like_wkt(const Glimpse& glimpse);
void read_wkt(const std::filesystem::path& path, Collector& out);

// gdal_reader.cpp, or gdal_absent.cpp in a build without GDAL
bool looks_like_vector_file(const Glimpse& glimpse);
void read_vector_file(const std::filesystem::path& path, Collector& out);

}  // namespace exactvo::datasets
