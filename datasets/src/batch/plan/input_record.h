// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What stands on disk for an input of a batch that is through: its facts, a line of JSON, in a file in which an only
/// chunk stands as well; other chunks stand in files of their own.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batch/plan/journal.h"
#include "batch/work/part.h"
#include "exactvo/datasets/batch.h"
#include "json/json_text.h"

namespace exactvo::datasets::batch {

/// What is known of an input once it is through: its counts, and what concerns it as a whole.
struct InputFacts {
  std::string outcome;  ///< "done", "repaired", "rejected"
  std::string code;     ///< of a rejected one
  std::string message;  ///< the same in words
  std::string format;
  BatchTally tally;
  std::uint64_t passed_over = 0;
  std::uint64_t chunks = 0;
  std::vector<std::string> notes;
  std::optional<ProjectionOrigin> origin;
  std::optional<Extent> extent;
  std::optional<Coverage> coverage;
  std::optional<Distortion> distortion;
};
/// One JSON object on one line, and back.
std::string to_json(const InputFacts& facts);
/// Members of the object that is open, and back. The latter throws what nlohmann's accessors throw.
void append_tally(JsonWriter& json, const BatchTally& tally);
BatchTally tally_of(const Json& object);
InputFacts parse_facts(std::string_view json, const std::string& file);

// The following throw DataError: of the file (missing, unreadable), E_FORMAT_SYNTAX or E_WRONG_TYPE where it holds
// something else.

/// The facts alone; what follows them is not read.
InputFacts read_facts(const Journal& journal, std::size_t input);
/// Whether a chunk's part stands in a file of its own, whole.
bool is_part_there(const Journal& journal, std::size_t input, std::size_t chunk);
/// A chunk's part, wherever it stands.
std::string read_part_bytes(const Journal& journal, std::size_t input, std::size_t chunk);
/// The pictures of an input that has chunks; the rest of its first part is not read.
std::string read_pictures(const Journal& journal, std::size_t input);

/// Whether all of the input's parts and its facts are there, whole.
bool is_through(const Journal& journal, std::size_t input);

}  // namespace exactvo::datasets::batch
