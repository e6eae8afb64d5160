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
#include <optional>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/trajectory_file.h"
#include "support/parse_errors.h"
#include "support/run.h"
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

/// Words that users take for verbs, and the verbs that do what they mean.
const std::map<std::string, std::vector<std::string>> kOtherWords{
    {"run", {"simulate"}},        {"start", {"simulate"}},     {"verify", {"audit"}},       {"prove", {"audit"}},
    {"test", {"audit", "check"}}, {"plot", {"draw", "view"}},  {"figure", {"draw"}},        {"figures", {"draw"}},
    {"show", {"view", "serve"}},  {"open", {"view", "serve"}}, {"page", {"view", "serve"}}, {"why", {"explain"}},
    {"collide", {"check"}},       {"collisions", {"check"}},   {"path", {"route"}},         {"plan", {"route"}},
    {"lint", {"validate"}},       {"fix", {"repair"}},         {"export", {"convert"}},     {"import", {"convert"}}};

/// The verbs for a file or the folder of a run; none where it is neither.
std::vector<std::string> verbs_for(const std::string& path) {
  std::error_code error;
  const std::vector<std::string> for_runs = {"audit", "draw", "view"};
  try {
    const std::optional<std::filesystem::path> recording = recording_at(path);
    if (std::filesystem::is_directory(path, error))
      return recording && std::filesystem::is_regular_file(*recording, error) ? for_runs : std::vector<std::string>();
    if (!std::filesystem::is_regular_file(path, error)) return {};
    const std::string trajectories = datasets::recognised_trajectory_format(path);
    if (trajectories == "recording" || trajectories == "crowd-recording") return for_runs;
    if (!trajectories.empty()) return {"check"};
    return {datasets::format_of(path) == "scenario" ? "simulate" : "validate"};
  } catch (const datasets::DataError&) {
    return {};
  }
}

/// What was meant by a word that is no verb: "; did you mean 'exactvo simulate mine.json'?".
std::string meant_by(const std::string& word, const std::vector<std::string>& names) {
  std::vector<std::string> meant;
  if (const auto other = kOtherWords.find(word); other != kOtherWords.end()) meant = other->second;
  for (const std::string& name : names)
    if (word.size() > 1 && meant.empty() && name.rfind(word, 0) == 0) meant = {name};
  if (meant.empty() && suggestion(word, names).empty())
    for (const std::string& verb : verbs_for(word)) meant.push_back("exactvo " + verb + " " + word);
  if (meant.empty()) return suggestion(word, names);
  return fmt::format("; did you mean '{}'?", fmt::join(meant, "' or '"));
}

void require_verb(const std::string& where, const std::string& word, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), word) == names.end())
    throw UsageError(where, word, fmt::format("one of {}{}", fmt::join(names, " "), meant_by(word, names)));
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
    require_verb("verb", *verb, names);
    return words;
  }
  if (verb + 1 == words.end() || (verb + 1)->empty()) return {words.front(), "--help"};
  require_verb("help", *(verb + 1), names);
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
