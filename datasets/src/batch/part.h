// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is made of one chunk of obstacles, ready to be put together with its neighbours: text and rows, no shapes.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "batch/features.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// An obstacle, or why there is none.
struct ChunkItem {
  formation::SceneObstacle obstacle;
  bool repaired = false;
  std::optional<DataError> rejected;  ///< then there is no obstacle
};

struct Chunk {
  std::string file;  ///< the input's name
  std::size_t number = 0;
  std::uint64_t first = 0;  ///< number of its first item in the input
  std::vector<ChunkItem> items;
  std::size_t vertices = 0;
};

struct Part {
  std::uint64_t obstacles = 0;
  std::uint64_t certified = 0;
  std::uint64_t vertices = 0;
  std::string figures;                ///< JSON Lines
  std::vector<std::string> features;  ///< a layer each: GeoJSON features, a comma and a newline between them
  std::string rows;                   ///< features.h
  std::string pictures;               ///< SVG
};

/// Deterministic: depends on the chunk and the configuration only.
Part part_of(const Chunk& chunk, const BatchConfiguration& configuration);

std::string to_bytes(Part part);
/// Throws DataError (E_FORMAT_SYNTAX) where the bytes are no part.
Part parse_part(std::string_view bytes, const std::filesystem::path& path);
Part read_part(const std::filesystem::path& path);

}  // namespace exactvo::datasets::batch
