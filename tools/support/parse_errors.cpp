// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/parse_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <functional>
#include <iterator>

#include "exactvo/datasets/scenario_file.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace {

/// The options of the program, and of the verbs for which `is_meant` holds.
std::vector<const CLI::Option*> options_of(const CLI::App& app, const std::function<bool(const CLI::App*)>& is_meant) {
  std::vector<const CLI::Option*> all = app.get_options();
  for (const CLI::App* verb : app.get_subcommands(is_meant)) {
    const std::vector<const CLI::Option*> more = verb->get_options();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

bool is_parsed(const CLI::App* verb) {
  return verb->parsed();
}

std::vector<std::string> long_names(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options)
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

bool is_flag(const CLI::Option& option) {
  return !option.get_positional() && option.get_expected_max() == 0;
}

/// The option with this name, "--out" or "-o"; null where there is none.
const CLI::Option* option_named(const std::vector<const CLI::Option*>& options, const std::string& word) {
  for (const CLI::Option* option : options)
    if (word.size() > 1 && word[0] == '-' && option->check_name(word)) return option;
  return nullptr;
}

/// The option that the library's message is about: the longest name that stands in it as a word.
const CLI::Option* subject_of(const std::vector<const CLI::Option*>& options, const std::string& message) {
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-'; };
  const CLI::Option* found = nullptr;
  for (const CLI::Option* option : options) {
    const std::string name = option->get_name();
    const std::size_t at = message.find(name);
    if (name.empty() || at == std::string::npos || (at > 0 && is_part(message[at - 1]))) continue;
    if (at + name.size() < message.size() && is_part(message[at + name.size()])) continue;
    if (!found || name.size() > found->get_name().size()) found = option;
  }
  return found;
}

/// Where a verb takes a scenario, and a name is that of one of its keys: "; a scenario has the key "time_step" for it".
std::string key_words(const std::vector<const CLI::Option*>& options, const std::string& name) {
  std::string key = name.substr(std::min(name.find_first_not_of('-'), name.size()));
  std::replace(key.begin(), key.end(), '-', '_');
  const bool takes_scenario = std::any_of(options.begin(), options.end(), [](const CLI::Option* option) {
    return option->get_positional() && option->get_name() == "scenario";
  });
  const bool is_key = datasets::scenario_schema().find('"' + key + "\": {") != std::string::npos;
  return takes_scenario && is_key ? "; a scenario has the key \"" + key + "\" for it" : "";
}

/// An option whose name is not known: what it was, and the nearest one, or the key of a scenario.
std::string unknown_option(const std::vector<const CLI::Option*>& options, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    const bool is_long = name.rfind("--", 0) == 0 && name.size() > 2;
    const bool is_short = name.size() == 2 && name[0] == '-' && std::isalpha(static_cast<unsigned char>(name[1])) != 0;
    if ((is_long || is_short) && !option_named(options, name)) {
      const std::string key = key_words(options, name);
      return fmt::format("unknown option '{}'{}", name, key.empty() ? suggestion(name, long_names(options)) : key);
    }
  }
  return "";
}

/// The value without the option, as it was given. A check that also changes a value leaves a part of it behind, or
/// none.
std::string value_of(const CLI::Option& option, const std::vector<std::string>& words) {
  const std::string parsed = fmt::format("{}", fmt::join(option.results(), " "));
  if (option.results().size() > 1) return parsed;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    if (words[i].empty() || words[i][0] != '-' || !option.check_name(words[i].substr(0, equals))) continue;
    if (equals != std::string::npos) return words[i].substr(equals + 1);
    if (i + 1 < words.size()) return words[i + 1];
  }
  return parsed;
}

/// The range of an option with a CLI::Range of whole numbers, whose type is called "UINT:INT in [1 - 1000000]" or so;
/// empty for other options.
std::string range_words(const std::string& type) {
  const std::string before = " in [", between = " - ";
  const std::size_t at = type.find(before), end = type.find(']', at);
  const std::size_t middle = type.find(between, at);
  if (at == std::string::npos || end == std::string::npos || middle > end) return "";
  const std::size_t low = at + before.size(), high = middle + between.size();
  return fmt::format("a whole number from {} to {}", type.substr(low, middle - low), type.substr(high, end - high));
}

std::string kind_of_value(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (is_flag(option)) return "no value, since it is a switch";
  const std::string range = range_words(type);
  if (!range.empty()) return range;
  if (type.find("SIZE") != std::string::npos) return "a number of bytes, such as 2GB";
  if (type.rfind("FLOAT", 0) == 0) return "a number";
  if (type.rfind("UINT", 0) == 0) return "a whole number from 0 on";
  if (type.rfind("INT", 0) == 0) return "a whole number";
  return "a value: " + option.get_description();
}

bool is_number(const std::string& word) {
  char* end = nullptr;
  std::strtod(word.c_str(), &end);
  return !word.empty() && end == word.c_str() + word.size();
}

/// A point that was given as two words, "--position 0 0"; else empty.
std::string point_words(const std::vector<const CLI::Option*>& options, const std::vector<std::string>& words,
                        const std::string& surplus) {
  for (std::size_t k = 2; k < words.size(); ++k) {
    const CLI::Option* option = option_named(options, words[k - 2]);
    if (words[k] != surplus || !option || option->get_description().find("X,Y") == std::string::npos) continue;
    if (is_number(words[k - 1]) && is_number(surplus))
      return fmt::format("{0} {1} {2}: found two words, expected X,Y in one: {0}={1},{2}", words[k - 2], words[k - 1],
                         surplus);
  }
  return "";
}

std::string surplus_words(const std::vector<const CLI::Option*>& options, const std::vector<std::string>& words,
                          const std::vector<std::string>& surplus) {
  if (surplus.empty()) return "an argument was not expected";
  const std::string& word = surplus.front();
  const std::string point = point_words(options, words, word);
  if (!point.empty()) return point;
  if (word.size() > 1 && word[0] == '-')
    return fmt::format("unknown option '{}'{}", word, suggestion(word, long_names(options)));
  const auto at = std::find(words.begin(), words.end(), word);
  const CLI::Option* before = at == words.begin() || at == words.end() ? nullptr : option_named(options, *(at - 1));
  if (before && is_flag(*before)) return fmt::format("unexpected argument '{}': {} takes no value", word, *(at - 1));
  std::string text = fmt::format("unexpected argument '{}'", word);
  for (const CLI::Option* option : options)
    if (option->get_positional() && option->results().size() == 1)
      text += fmt::format(": the {} is '{}'", option->get_name(), option->results().front());
  if (option_named(options, "--scenario")) text += "; a scenario goes behind --scenario";
  if (option_named(options, "--out")) text += "; a place for results goes behind --out";
  return text;
}

std::string missing_words(const CLI::Option* option) {
  if (!option) return "no verb was given";
  return fmt::format("missing {} {}: {}", option->get_positional() ? "argument" : "option", option->get_name(),
                     option->get_description());
}

std::string words_of(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words) {
  const std::vector<const CLI::Option*> options = options_of(app, is_parsed);
  const std::string unknown = unknown_option(options, words);
  if (!unknown.empty()) return unknown;
  const std::string message = error.what();
  const CLI::Option* option = subject_of(options, message);
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) return surplus_words(options, words, app.remaining(true));
  if (dynamic_cast<const CLI::RequiredError*>(&error)) return missing_words(option);
  if (!option) return "the command line could not be understood";
  const std::string name = option->get_name();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) && option->results().size() > 1 &&
      option->get_expected_max() == 1)
    return fmt::format("{}: given {} times, expected once", name, option->results().size());
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) && option->results().empty() && !is_flag(*option))
    return fmt::format("{}: no value given, expected {}", name, kind_of_value(*option));
  // Checks of our own say what they found and what they expected.
  if (message.find("found '") != std::string::npos) return message;
  return fmt::format("{}: found '{}', expected {}", name, value_of(*option, words), kind_of_value(*option));
}

}  // namespace

std::string parse_error_text(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words) {
  const std::vector<const CLI::App*> verbs = app.get_subcommands(is_parsed);
  const std::string verb = verbs.empty() ? "" : verbs.front()->get_name() + " ";
  return words_of(app, error, words) + " (see 'exactvo " + verb + "--help')";
}

void check_switches(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<const CLI::Option*> options = options_of(app, [&](const CLI::App* verb) {
    return std::find(words.begin(), words.end(), verb->get_name()) != words.end();
  });
  for (const std::string& word : words) {
    if (word == "--") return;
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) continue;
    const CLI::Option* option = option_named(options, word.substr(0, equals));
    if (option && is_flag(*option))
      throw UsageError(option->get_name(), word.substr(equals + 1), kind_of_value(*option));
  }
}

void check_no_empty_values(const CLI::App& app) {
  for (const CLI::Option* option : options_of(app, is_parsed)) {
    const std::vector<std::string>& values = option->results();
    if (is_flag(*option) || std::find(values.begin(), values.end(), "") == values.end()) continue;
    throw UsageError(option->get_name(), "", kind_of_value(*option));
  }
}

CLI::Validator whole_number(unsigned long long least, unsigned long long most) {
  const auto fits = [=](const std::string& text) {
    char* end = nullptr;
    errno = 0;
    const unsigned long long number = std::strtoull(text.c_str(), &end, 10);
    const bool is_number = !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) != 0 && *end == '\0';
    const bool holds = is_number && errno == 0 && number >= least && number <= most;
    return holds ? std::string() : fmt::format("found '{}', expected a whole number from {} to {}", text, least, most);
  };
  return CLI::Validator(fits, "", "");
}

}  // namespace exactvo::tools
