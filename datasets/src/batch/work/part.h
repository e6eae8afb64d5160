// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is made of one chunk of obstacles, ready to be merged with its neighbours: text and rows, no shapes.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "batch/formats/features.h"
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
  LocalPlane plane;  ///< of all items
};

struct PartCounts {
  std::uint64_t obstacles = 0;
  std::uint64_t certified = 0;
  std::uint64_t vertices = 0;
  std::uint64_t no_half_plane = 0;  ///< null among the half-planes of the robot
};

struct Part {
  PartCounts counts;
  std::string pictures;               ///< SVG
  std::string figures;                ///< JSON Lines
  std::vector<std::string> features;  ///< a layer each: GeoJSON features, a comma and a newline between them
  std::string rows;                   ///< features.h
};

/// Deterministic: depends on the chunk and the configuration only.
Part part_of(const Chunk& chunk, const BatchConfiguration& configuration);

std::string to_bytes(Part part);

/// A part as it stands in its bytes, which it looks into.
struct PartView {
  PartCounts counts;
  std::string_view pictures;
  std::string_view figures;
  std::vector<std::string_view> features;
  std::string_view rows;
};
/// Throws DataError (E_FORMAT_SYNTAX) where the bytes are no part; `path` is where they came from.
PartView view_of_part(std::string_view bytes, const std::filesystem::path& path);
/// The pictures of the part that `bytes` are about to give, which stand in its beginning. Throws as `view_of_part`.
std::string pictures_at_start(std::istream& bytes, const std::filesystem::path& path);

}  // namespace exactvo::datasets::batch
