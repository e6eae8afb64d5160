// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Long work in parts: each part is a file that appears whole or not at all, so that what was killed goes on where it
/// stopped. Which part is done by which thread, and when, leaves no trace in the results.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace exactvo::tools {

struct PartTask {
  std::string name;                   ///< of its file; unique
  std::function<std::string()> work;  ///< gives the part's text; called from any thread
};

/// Does every part that is not in the folder yet, which is created where missing, on so many threads. `key`: what a
/// part depends on beside its name; one made under another key is done again. Returns the texts of all, in the tasks'
/// order. Throws Interrupted after a request to stop, with the parts kept that are done; what a task throws goes
/// through.
std::vector<std::string> run_parts(const std::vector<PartTask>& tasks, const std::filesystem::path& folder,
                                   const std::string& key, unsigned jobs);

/// The key of everything that this very program computes: the digest of its own file where the system shows it, else
/// its version, commit and compiler.
std::string program_key();

}  // namespace exactvo::tools
