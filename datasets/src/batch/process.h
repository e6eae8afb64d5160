// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One input of a batch, from the file to its parts.

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batch/crew.h"
#include "batch/ledger.h"
#include "batch/part.h"
#include "exactvo/datasets/batch.h"

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
};
/// One JSON object on one line, and back.
std::string to_json(const InputFacts& facts);
InputFacts parse_facts(std::string_view json, const std::string& file);

/// What stands on disk for an input that is through; of one chunk, that chunk as well.
struct InputRecord {
  InputFacts facts;
  std::optional<Part> part;
};
InputRecord read_input_record(const std::filesystem::path& path);

/// Whether all of the input's parts and its facts are there.
bool is_through(const Ledger& ledger, std::size_t number);

/// What the jobs of a run count together.
struct Meter {
  std::atomic<std::uint64_t> obstacles{0};
  std::atomic<std::uint64_t> vertices{0};
  std::atomic<std::uint64_t> nanoseconds_of_jobs{0};
};

/// Leaves an input where it is when the batch is to stop.
struct Stopped {};

/// Asked while an input is read, with the share that is through; false stops: `process_input` throws Stopped.
using InputWatch = std::function<bool(double share)>;

/// Reads the input and has the crew make every part that is not there, then its facts: all is there when the crew has
/// finished. Throws DataError for what is wrong with the output, and where the input changed since it was listed
/// (E_OTHER_RUN); its parts are then gone. Whatever else is wrong with the input becomes its facts.
void process_input(const Input& input, std::size_t number, const BatchConfiguration& configuration,
                   const Ledger& ledger, Crew& crew, Meter& meter, const InputWatch& watch);

}  // namespace exactvo::datasets::batch
