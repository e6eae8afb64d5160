// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Words on the command line that mean nothing: said with what was expected and the nearest that means something.

#include <stdexcept>
#include <string>
#include <vector>

namespace exactvo::tools {

/// Ends the program with status 2 and its message on stderr.
class UsageError : public std::runtime_error {
 public:
  /// "WHERE: found 'FOUND', expected EXPECTED".
  UsageError(const std::string& where, const std::string& found, const std::string& expected);
  explicit UsageError(const std::string& message) : std::runtime_error(message) {}
};

/// What no verb works without, where the parser does not ask for it because something else may stand in its place:
/// "missing WHAT: DESCRIPTION (see 'exactvo VERB --help')". `what`: "option --out" or "argument kind".
UsageError missing_option(const std::string& verb, const std::string& what, const std::string& description);

/// "WHERE: found 'WORD', expected one of" the known ones, with the nearest.
UsageError unknown_word(const std::string& where, const std::string& word, const std::vector<std::string>& known);

/// Throws unknown_word unless the word is known.
void require_known(const std::string& where, const std::string& word, const std::vector<std::string>& known);

/// Throws UsageError unless it holds.
void require(bool holds, const std::string& where, const std::string& found, const std::string& expected);

/// Throws UsageError unless `value` is a finite length of 0 m or more.
void require_length(const std::string& option, double value);

/// "OPTION cannot be combined with OTHER: WHY".
UsageError conflict(const std::string& option, const std::string& other, const std::string& why);

/// Throws `conflict` where both are given.
void refuse_both(bool both, const std::string& option, const std::string& other,
                 const std::string& why = "give one of the two");

/// "OPTION needs NEEDED: WHY"; without a reason "OPTION needs NEEDED".
UsageError lacking(const std::string& option, const std::string& needed, const std::string& why = "");

/// "; did you mean 'simulate'?", the known word nearest to `word`, or nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// The value that `text` names, by one of the `parse` functions of formation/simulation.h. Throws UsageError.
template <class Value>
Value parse_choice(const std::string& option, const std::string& text, const std::vector<std::string>& names) {
  Value value{};
  if (parse(text, value)) return value;
  throw unknown_word(option, text, names);
}

}  // namespace exactvo::tools
