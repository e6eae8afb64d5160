// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One input of a batch, from the file to pieces of work: chunks of its obstacles, and what is known of it at its end.

#include <cstdint>
#include <functional>
#include <optional>

#include "batch/plan/input_record.h"
#include "batch/plan/journal.h"
#include "batch/work/allowance.h"
#include "batch/work/part.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// A chunk on its way from the reader to the outputs, the end of an input, or both.
struct Piece {
  std::size_t input = 0;
  std::size_t number = 0;             ///< of the chunk
  bool has_part = false;              ///< of a chunk: its part is on disk, or will be
  std::optional<Chunk> chunk{};       ///< to be processed; none where the part is on disk
  std::optional<InputFacts> facts{};  ///< this is the last piece of its input
  bool is_whole_input = false;        ///< its only chunk: facts and part stand in one file
  bool has_changed = false;           ///< the input, since it was listed: what was given of it is worth nothing
  Allowance::Taken memory{};          ///< of a chunk that is to be processed
};

/// What a chunk takes until its part is made.
std::uint64_t memory_of(const Chunk& chunk);

/// Asked while an input is read, with the share that is through; false stops: `read_input` throws Stopped.
using InputWatch = std::function<bool(double share)>;
using GivePiece = std::function<void(Piece)>;

/// Gives the pieces of the input in order. What is wrong with it becomes its facts; of one that turns out to be broken
/// after some of its chunks, these have no chunks. What `give` throws is thrown.
void read_input(const Input& input, std::size_t number, const BatchConfiguration& configuration, const Journal& journal,
                const InputWatch& watch, const GivePiece& give);

}  // namespace exactvo::datasets::batch
