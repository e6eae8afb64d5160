// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where a result comes from: enough to make it again. Every output carries one.
///
/// Property (1): two runs of the same program on the same inputs with the same command line differ in `written_at`
/// only.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace exactvo::datasets {

/// A file that a result depends on.
struct InputFile {
  std::string path;    ///< as named on the command line
  std::string sha256;  ///< 64 lower-case hexadecimal digits
};

/// The program, the command and the inputs that made a result.
struct Provenance {
  std::string version;                    ///< of ExactVO
  std::string commit;                     ///< "unknown" outside a repository; ends in "-dirty" where files had changed
  std::string compiler;                   ///< "GNU 12.2.0"
  std::string build_type;                 ///< "Release"
  std::string cgal;                       ///< version of CGAL
  std::string gmp;                        ///< version of GMP
  std::string gdal;                       ///< "none" where built without
  std::uint64_t seed = 0;                 ///< of what is drawn at random
  std::vector<std::string> command_line;  ///< the program and its arguments
  std::vector<InputFile> inputs;          ///< in the order of the command line
  /// The only field that is not the same from run to run: UTC, "2024-05-01T12:00:00Z"; SOURCE_DATE_EPOCH is obeyed.
  /// Left out of the JSON where empty.
  std::string written_at;
};

/// What this build knows of itself, the clock, and the hashes of `inputs`. Throws DataError for an unreadable input.
Provenance make_provenance(std::vector<std::string> command_line, std::uint64_t seed,
                           const std::vector<std::filesystem::path>& inputs = {});

/// One JSON object on one line.
std::string to_json(const Provenance& provenance);

/// Reads what `to_json` wrote. Throws DataError; `file_name` is used in its message.
Provenance parse_provenance(const std::string& json, const std::string& file_name);

/// FIPS 180-4.
std::string sha256_of(std::string_view bytes);
/// Streams: memory does not grow with the file. Throws DataError.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace exactvo::datasets
