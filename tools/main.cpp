// SPDX-License-Identifier: GPL-3.0-or-later
// The program `exactvo`: finds the verb, runs it, and turns what went wrong into a message and an exit status.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <new>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/provenance.h"
#include "support/parse_errors.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace {

std::vector<std::string> words;

constexpr const char* kHelp = "help";  // a word in the place of a verb

constexpr const char* kExitCodes =
    "Exit status:\n"
    "  0    completed\n"
    "  1    completed; the check failed (verbs that check something)\n"
    "  2    a file, an option or an output location is wrong; nothing was written\n"
    "  3    a defect of the program\n"
    "  130  interrupted by Ctrl-C, 143 by SIGTERM; no file is left half-written (a batch keeps its progress for "
    "--resume)\n"
    "\n"
    "Results go to stdout, messages to stderr. SI units: metres, seconds, radians.";

std::string version_text() {
  const datasets::Provenance p = datasets::make_provenance({}, 0);
  return fmt::format("exactvo {}\ncommit {}\nbuilt by {}, {}\nCGAL {}, GMP {}, GDAL {}\nlicence GPL-3.0-or-later",
                     p.version, p.commit, p.compiler, p.build_type, p.cgal, p.gmp, p.gdal);
}

std::string all_examples() {
  std::string text = "Examples:\n";
  for (const Verb& verb : verbs()) text += verb.examples;
  return text;
}

/// What the parser is given: `help VERB` is `VERB --help`. Refuses an unknown verb before the parser does, to suggest a
/// known one.
std::vector<std::string> parsed_words() {
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) names.push_back(verb.name);
  const auto verb = std::find_if(words.begin() + 1, words.end(), [](const auto& w) { return w.rfind('-', 0) != 0; });
  if (verb == words.end()) return words;
  if (*verb != kHelp) {
    names.push_back(kHelp);
    require_known("verb", *verb, names);
    return words;
  }
  if (verb + 1 == words.end() || (verb + 1)->empty()) return {words.front(), "--help"};
  require_known("help", *(verb + 1), names);
  return {words.front(), *(verb + 1), "--help"};
}

ExitCode parse_and_run() {
  CLI::App app("Velocity obstacles with exact geometry; formations among polyhedral obstacles.", "exactvo");
  bool quiet = false;
  app.add_flag("--quiet,-q", quiet, "Only errors on stderr");
  app.set_version_flag("--version,-V", version_text, "Version and how it was built");
  app.footer(all_examples() + "\n" + kExitCodes);
  app.require_subcommand(1);

  std::vector<std::string> given = parsed_words();
  std::map<const CLI::App*, Action> actions;
  for (const Verb& verb : verbs()) {
    CLI::App* sub = app.add_subcommand(verb.name, verb.summary);
    // The options of all verbs would take a tenth of a short run.
    if (std::find(given.begin(), given.end(), verb.name) == given.end()) continue;
    sub->fallthrough();
    sub->footer("Examples:\n" + verb.examples + "\n" + kExitCodes);
    actions[sub] = verb.declare(*sub);
  }
  if (given.size() == 1) {
    std::fputs(app.help().c_str(), stderr);
    return ExitCode::bad_input;
  }
  given.erase(given.begin());
  check_switches(app, given);
  std::reverse(given.begin(), given.end());  // as the parser takes them
  try {
    app.parse(given);
    check_no_empty_values(app);
  } catch (const CLI::Success& help_or_version) {
    const auto code = static_cast<ExitCode>(app.exit(help_or_version));
    check_stdout();
    return code;
  } catch (const CLI::ParseError& error) {
    error_message(parse_error_text(app, error, words));
    return ExitCode::bad_input;
  }
  set_quiet(quiet);
  const ExitCode code = actions.at(app.get_subcommands().front())();
  check_stdout();
  return code;
}

ExitCode say_interrupted() {
  error_message("interrupted; what was not finished is not written");
  return ExitCode::interrupted;
}

ExitCode guarded() {
  try {
    return parse_and_run();
  } catch (const UsageError& error) {
    error_message(error.what());
    return ExitCode::bad_input;
  } catch (const datasets::DataError& error) {
    if (interrupted()) return say_interrupted();  // what a library made of a call that the signal ended
    error_message(error.what());
    return ExitCode::bad_input;
  } catch (const ReaderLeft&) {
    return ExitCode::success;
  } catch (const Interrupted&) {
    return say_interrupted();
  } catch (const std::filesystem::filesystem_error& error) {
    error_message(error.path1().string() + ": " + error.code().message() + " [E_FILE_UNREADABLE]");
    return ExitCode::bad_input;
  } catch (const std::bad_alloc&) {
    error_message("more memory wanted than there is [E_SIZE]");
    return ExitCode::bad_input;
  } catch (const std::exception& error) {
    error_message(std::string("internal: ") + error.what());
    return ExitCode::internal_error;
  }
}

}  // namespace

const std::vector<std::string>& command_line() {
  return words;
}

}  // namespace exactvo::tools

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // A reader that leaves early must not kill the run that writes files.
  exactvo::tools::words.assign(argv, argv + argc);
  exactvo::tools::note_interrupts();
  const exactvo::tools::ExitCode code = exactvo::tools::guarded();
  return code == exactvo::tools::ExitCode::interrupted ? exactvo::tools::interrupted_status() : static_cast<int>(code);
}
