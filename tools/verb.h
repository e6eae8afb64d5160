// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a verb of the program is: a name, words for --help, and a function that declares its options and returns what
/// to do once they are parsed. To add one: write verbs/ROOM/NAME.cpp, and declare and list it in verbs.cpp.

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace exactvo::tools {

/// What the program answers with; listed in --help.
enum class ExitCode : int {
  success = 0,         ///< done
  negative = 1,        ///< completed; the check failed
  bad_input = 2,       ///< a file, an option or a place to write to is wrong; nothing was written
  internal_error = 3,  ///< a defect of the program
  interrupted = 130    ///< by the user (143: by SIGTERM); no file is left half-written
};

using Action = std::function<ExitCode()>;

struct Verb {
  std::string name;
  std::string summary;   ///< one line
  std::string examples;  ///< lines under "Examples:"
  std::function<Action(CLI::App&)> declare;
};

/// The `declare` of a verb whose options are put into `Flags`, with which it is run.
template <class Flags>
std::function<Action(CLI::App&)> with_flags(void (*declare)(CLI::App&, Flags&), ExitCode (*run)(const Flags&)) {
  return [=](CLI::App& app) -> Action {
    const auto flags = std::make_shared<Flags>();
    declare(app, *flags);
    return [=] { return run(*flags); };
  };
}

/// In the order of --help.
const std::vector<Verb>& verbs();

/// The words on the command line, for provenance.
const std::vector<std::string>& command_line();

}  // namespace exactvo::tools
