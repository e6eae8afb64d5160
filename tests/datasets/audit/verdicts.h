// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the audit says of edited recordings, held beside the second opinion.

#include <map>
#include <string>
#include <vector>

#include "audit/edits.h"

namespace exactvo::datasets::test {

enum class Fate {
  refused,   ///< no recording: a DataError
  rejected,  ///< a recording that the audit refutes
  free,      ///< the edit changed only a word or number that no audit reads (`not_audited`)
  holds,     ///< the audit proves it, and it is true and safe by the second opinion
  wrong      ///< the audit proves it, and it is not
};

struct Judged {
  Fate fate;
  std::string why;  ///< what the audit, or where it is wrong the second opinion, has against it
};

/// The verdict on the edited lines as a recording of the run's scenario.
Judged judge(const ShortRun& run, const Lines& lines);

/// Edits of all runs in turn: how many of each field, and the wrong ones.
struct Campaign {
  struct Counts {
    std::size_t refused = 0, rejected = 0, free = 0, holds = 0, wrong = 0;
  };
  std::map<std::string, Counts> fields;
  std::vector<std::string> wrong;  ///< lines for tests/corpus/audit/edits.jsonl
  Counts sum;

  /// Edits number `first` to `first + count - 1` of the seed.
  void run(const std::vector<ShortRun>& runs, std::uint64_t seed, std::size_t first, std::size_t count);
  std::string table() const;
};

/// {"run": ..., "why": ..., "patch": [...]}, a JSON Patch (RFC 6902) of the list of lines.
std::string corpus_line(const ShortRun& run, const Lines& edited, const std::string& why);
Lines patched(const ShortRun& run, const nlohmann::json& line);

}  // namespace exactvo::datasets::test
