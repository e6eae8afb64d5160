// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which files a batch reads, and what tells each from any other: the SHA-256 of its content, and of whatever is read
/// with it (the picture of a ROS map, the tables beside a Shapefile, the files that a scenario names).

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/batch.h"
#include "provenance_json.h"

namespace exactvo::datasets::batch {

/// SHA-256 of a file, and of every other that is read with it; empty where one can't be read.
struct InputHashes {
  std::string sha256;
  std::vector<InputFile> read_with;

  bool operator==(const InputHashes& other) const;
};

struct Input {
  std::string name;  ///< as the user named it, or the folder's name and what is below it
  std::filesystem::path path;
  InputHashes hashes;
  std::uint64_t size = 0;
};
/// Its name and hashes.
template <class Codec>
void members(Codec& json, For<Codec, Input>& input) {
  json.member("path", input.name).member("sha256", input.hashes.sha256);
  json.member_if(!input.hashes.read_with.empty(), "read_with", input.hashes.read_with);
}

struct Inputs {
  std::vector<Input> files;  ///< at least one
  std::vector<EarlierBatch> earlier;
};

/// Files as named, folders walked in order of names. In a folder, hidden files and folders, what belongs to another
/// file (`sidecar_files`), whatever is below `out` and whatever is below an earlier
/// batch's output (`EarlierBatch`) are no inputs; a file that is named is one in any case. Each file once. Links to
/// folders and what is no regular file are inputs without a hash, never opened here. `format` is that of all files, if
/// it is given. Throws DataError for a path that is not there or where there is nothing to read (E_FILE_MISSING) and a
/// folder that can't be walked (E_FILE_UNREADABLE).
Inputs list_inputs(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& out,
                   const std::string& format = {});

/// What `Input::hashes` are now.
InputHashes hashes_of_input(const std::filesystem::path& path, const std::string& format = {});

}  // namespace exactvo::datasets::batch

template <>
inline constexpr bool exactvo::datasets::kOnOneLine<exactvo::datasets::batch::Input> = true;
