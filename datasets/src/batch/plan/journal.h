// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What of a batch is already there, on disk, so that a killed one can go on: OUT/.parts with
///
///     run.json          what the batch is: version, configuration, inputs; written first
///     NNNNNN/KKKKKK     what was made of chunk K of input N
///     NNNNNN.input      the input's facts, written when all its chunks are there; an only chunk stands in it
///     final.WORD/       the outputs on their way; each process has a folder of its own
///     lock              locked by the one process that merges parts
///
/// Every file appears whole; what a power cut has cut off counts as missing (`is_through`). When the outputs stand in
/// OUT, summary.json last, .parts is renamed to .parts.old in one step and removed; what a kill leaves of that, the
/// next look removes.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "batch/plan/inputs.h"
#include "exactvo/datasets/part_folder.h"

namespace exactvo::datasets::batch {

/// What must agree for a batch to go on with what another process began.
struct Identity {
  std::string version;
  std::string commit;
  std::string configuration;  ///< JSON on one line
  std::vector<Input> inputs;
};
std::string to_json(const Identity& identity);

/// Whether the file is a batch's run.json or summary.json, by its beginning: other programs write files of these names.
bool is_of_a_batch(const std::filesystem::path& file);

class Journal {
 public:
  explicit Journal(std::filesystem::path out);
  /// Lets go of the lock.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  enum class State {
    fresh,       ///< nothing is there, or a complete output that is to be replaced
    unfinished,  ///< some parts are
    complete     ///< an output of just this batch
  };
  /// What stands in OUT. Throws DataError: E_OTHER_RUN where it is of another batch and `resume` wants to go on with
  /// it, or an unfinished one and it does not; E_FILE_UNWRITABLE where OUT holds what is no batch's.
  State look(const Identity& identity, bool resume) const;

  /// Writes run.json, unless another process of the same batch was quicker.
  void begin(const Identity& identity) const;

  /// Throws DataError: E_OTHER_RUN where run.json is of another batch, E_FILE_MISSING where this process sees none.
  void require_same(const Identity& identity) const;

  std::filesystem::path part(std::size_t input, std::size_t chunk) const;
  std::filesystem::path input_facts(std::size_t input) const;
  const std::filesystem::path& final_folder() const { return final_; }
  const std::filesystem::path& out() const { return out_; }

  bool is_there(const std::filesystem::path& path) const { return parts_.has(path); }
  /// Writes one of the files above. Throws DataError (E_FILE_UNWRITABLE), also where .parts was removed meanwhile.
  void write(const std::filesystem::path& path, const std::string& bytes) const { parts_.write(path, bytes); }

  enum class Lock {
    held,       ///< by this process, from now on and until the journal goes or the process ends, however it ends
    taken,      ///< by another process, when waiting ended
    unlockable  ///< the file system has no locks: no process holds one
  };
  /// Asks for the right to merge parts, many times a second as long as `keep_waiting` says so. On a file system without
  /// locks no process waits: several processes may merge all parts at the end, each in its own folder, and what they
  /// move to OUT is the same but for the times; the last of them finds .parts gone (`is_open`), and must not make it
  /// anew. Throws DataError (E_FILE_UNWRITABLE) where the file can't be made in a journal that is open.
  Lock lock(const std::function<bool()>& keep_waiting);

  /// Whether run.json still stands: no other process has put the parts together meanwhile.
  bool is_open() const { return is_there(run_file()); }
  /// Whether an output of just this batch stands in OUT and nothing is under way there.
  bool another_finished(const Identity& identity) const;

  /// Makes `final_folder`, where .parts still stands; else throws DataError (E_FILE_UNWRITABLE). Where this process has
  /// the lock, the folders of killed processes are removed.
  void start_final() const;
  /// Moves the files of `final_folder` to OUT, takes away those of an earlier output (`is_output` knows their names)
  /// that this one does not have, moves `last`, and takes .parts away.
  void publish(const std::string& last, const std::function<bool(const std::string& name)>& is_output) const;

 private:
  std::filesystem::path run_file() const { return parts_.path() / "run.json"; }
  std::filesystem::path stale_parts() const { return out_ / ".parts.old"; }

  std::filesystem::path out_;
  PartFolder parts_;
  std::filesystem::path final_;
  int lock_file_ = -1;  ///< where the lock is held
};

}  // namespace exactvo::datasets::batch
