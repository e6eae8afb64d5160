// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is wrong with a command line, in this program's words instead of those of the option library.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace exactvo::tools {

/// One line: what was found and what was expected, the nearest known option for a mistyped one, and where to find help.
/// `words` is the command line, the program's name first.
std::string parse_error_text(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words);

/// Refuses (UsageError) a value that is given to a switch, as in --json=2, which the parser would take. REQUIRES: all
/// verbs declared.
void check_switches(const CLI::App& app, const std::vector<std::string>& words);

/// Refuses (UsageError) an option or argument that was given an empty text. REQUIRES: a parsed command line.
void check_no_empty_values(const CLI::App& app);

/// A check for an option's value; its message is in the form "found 'X', expected a whole number from 1 to 9".
CLI::Validator whole_number(unsigned long long least, unsigned long long most);

}  // namespace exactvo::tools
