// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What stands on disk for an input of a batch that is through: its facts, a line of JSON, in a file in which an only
/// chunk stands as well; other chunks stand in files of their own.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "batch/plan/journal.h"
#include "batch/work/part.h"
#include "exactvo/datasets/batch.h"
#include "json/json_text.h"

namespace exactvo::datasets {

// Members of facts and summaries.

template <class Codec>
void members(Codec& json, For<Codec, ProjectionOrigin>& origin) {
  json.member("longitude", origin.longitude).member("latitude", origin.latitude);
}
template <class Codec>
void members(Codec& json, For<Codec, Extent>& extent) {
  json.member("low", extent.low).member("high", extent.high);
}
template <class Codec>
void members(Codec& json, For<Codec, Coverage>& c) {
  json.member("cells", c.cells).member("occupied", c.occupied).member("cell_area", c.cell_area);
}
template <class Codec>
void members(Codec& json, For<Codec, Distortion>& d) {
  json.member("length", d.length).member("area", d.area).member("certified", d.certified);
}

inline void append_value(JsonWriter& json, const std::map<std::string, std::uint64_t>& counts) {
  json.begin_object();
  for (const auto& [name, count] : counts) json.member(name, count);
  json.end_object();
}
inline void read_value(const JsonCursor& at, std::map<std::string, std::uint64_t>& counts) {
  for (const auto& [name, count] : at.json().items()) counts[name] = at.at(name).count();
}
template <>
inline constexpr bool kOnOneLine<BatchTally> = true;
template <class Codec>
void members(Codec& json, For<Codec, BatchTally>& tally) {
  json.member("read", tally.read).member("done", tally.done).member("repaired", tally.repaired);
  json.member("rejected", tally.rejected);
}

}  // namespace exactvo::datasets

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
template <class Codec>
void members(Codec& json, For<Codec, InputFacts>& facts) {
  const bool is_rejected = !facts.code.empty();
  json.member("outcome", facts.outcome).member_if(is_rejected, "code", facts.code);
  json.member_if(is_rejected, "message", facts.message).member_if(!facts.format.empty(), "format", facts.format);
  members(json, facts.tally);
  json.member("passed_over", facts.passed_over).member("chunks", facts.chunks).optional("origin", facts.origin);
  json.optional("extent", facts.extent).optional("coverage", facts.coverage).optional("distortion", facts.distortion);
  json.member("notes", facts.notes);
}

/// One JSON object on one line.
std::string to_json(const InputFacts& facts);

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
