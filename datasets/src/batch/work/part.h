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

/// What was made of obstacles: of a part, of all outputs, or in a run.
struct Counts {
  std::uint64_t obstacles = 0;
  std::uint64_t certified = 0;
  std::uint64_t vertices = 0;
  std::uint64_t no_half_plane = 0;  ///< null among the half-planes of the robot
  std::uint64_t nanoseconds = 0;    ///< that it took, of all workers together; stands in no part

  Counts& operator+=(const Counts& more);
};

template <class Text>
struct PartOf {
  Counts counts;
  Text pictures;               ///< SVG
  Text measurements;           ///< JSON Lines
  std::vector<Text> features;  ///< a layer each: GeoJSON features, a comma and a newline between them
  Text rows;                   ///< features.h
};
using Part = PartOf<std::string>;
using PartView = PartOf<std::string_view>;  ///< looks into a part's bytes

/// Deterministic: depends on the chunk and the configuration only.
Part part_of(const Chunk& chunk, const BatchConfiguration& configuration);

/// They say how many they are.
std::string to_bytes(Part part);
/// Whether what `bytes` are about to give is a part, as long as it says: a power cut may cut off what was written last.
bool holds_whole_part(std::istream& bytes);

/// Throws DataError (E_FORMAT_SYNTAX) where the bytes are no part; `path` is where they came from.
PartView view_of_part(std::string_view bytes, const std::filesystem::path& path);
/// The pictures of the part that `bytes` are about to give, which stand in its beginning. Throws as `view_of_part`.
std::string pictures_at_start(std::istream& bytes, const std::filesystem::path& path);

}  // namespace exactvo::datasets::batch
