// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/program_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>

#include "support/usage.h"

namespace exactvo::tools {
namespace {

bool is_option(const std::string& word) {
  return word.rfind("--", 0) == 0;
}

std::string name_of(const std::string& word) {
  return word.substr(0, word.find('='));
}

std::string expected_number(std::uint64_t least, std::uint64_t most) {
  std::string text = "a whole number from " + std::to_string(least);
  return text + (most == std::numeric_limits<std::uint64_t>::max() ? " on" : " to " + std::to_string(most));
}

std::uint64_t whole_number_of(const std::string& name, const std::string& text, std::uint64_t least,
                              std::uint64_t most) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || number < least || number > most)
    throw UsageError(name, text, expected_number(least, most));
  return number;
}

}  // namespace

struct ProgramOptions::Parser {
  Parser(const std::string& program, const std::string& summary) : app(summary, program) {}

  CLI::Option* add(const std::string& name, const std::function<void(const std::string&)>& put,
                   const std::string& help) {
    CLI::Option* option = app.add_option_function<std::string>(name, put, help);
    if (is_option(name)) with_value.push_back(name);
    return option;
  }

  std::vector<std::string> option_names() const {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
  }

  /// Before the parser looks: what it would refuse in its own words.
  void check_words(const std::vector<std::string>& words) const {
    const std::vector<std::string> names = option_names();
    for (std::size_t k = 0; k < words.size(); ++k) {
      if (!is_option(words[k]) || words[k] == "--") continue;
      const std::string name = name_of(words[k]);
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw std::runtime_error("unknown option '" + name + "'" + suggestion(name, names));
      if (name != words[k] && std::find(switches.begin(), switches.end(), name) != switches.end())
        throw std::runtime_error(name + " takes no value");
      if (std::find(with_value.begin(), with_value.end(), words[k]) == with_value.end()) continue;
      if (k + 1 == words.size() || is_option(words[k + 1])) throw std::runtime_error(name + " takes a value");
      ++k;
    }
  }

  CLI::App app;
  std::vector<std::string> with_value;
  std::vector<std::string> switches;
};

ProgramOptions::ProgramOptions(const std::string& program, const std::string& summary, const std::string& footer)
    : parser_(new Parser(program, summary)) {
  parser_->app.footer(footer);
}

ProgramOptions::~ProgramOptions() = default;

void ProgramOptions::flag(const std::string& name, bool& value, const std::string& help) {
  parser_->app.add_flag(name, value, help);
  parser_->switches.push_back(name);
}

void ProgramOptions::text(const std::string& name, std::string& value, const std::string& help, bool required) {
  CLI::Option* option = parser_->add(
      name, [&value](const std::string& given) { value = given; }, help);
  option->required(required);
  if (!value.empty()) option->default_str(value);
}

void ProgramOptions::texts(const std::string& name, std::vector<std::string>& values, const std::string& help) {
  parser_->app.add_option(name, values, help);
}

void ProgramOptions::word(const std::string& name, std::string& value, const std::vector<std::string>& known,
                          const std::string& help, bool required) {
  const auto put = [&value, name, known](const std::string& given) {
    std::string expected = "one of";
    for (const std::string& choice : known) expected += " " + choice;
    if (std::find(known.begin(), known.end(), given) == known.end())
      throw UsageError(name, given, expected + suggestion(given, known));
    value = given;
  };
  CLI::Option* option = parser_->add(name, put, help);
  option->required(required);
  if (!value.empty()) option->default_str(value);
}

void ProgramOptions::add_number(const std::string& name, const std::string& now, std::uint64_t least,
                                std::uint64_t most, const std::string& help, const Put& put) {
  const auto parse_and_put = [=](const std::string& given) { put(whole_number_of(name, given, least, most)); };
  parser_->add(name, parse_and_put, help)->default_str(now)->type_name("N");
}

bool ProgramOptions::given(const std::string& name) const {
  return parser_->app.get_option(name)->count() > 0;
}

bool ProgramOptions::parse(int argc, const char* const* argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (std::any_of(words.begin(), words.end(), [](const auto& word) { return word == "--help" || word == "-h"; })) {
    std::fputs(parser_->app.help().c_str(), stdout);
    return false;
  }
  parser_->check_words(words);
  try {
    parser_->app.parse(argc, argv);
  } catch (const CLI::RequiredError& missing) {
    const std::string text = missing.what();
    throw std::runtime_error(text.substr(0, text.find(' ')) + " is missing");
  } catch (const CLI::ExtrasError&) {
    throw std::runtime_error("'" + parser_->app.remaining().front() + "' is one word too many");
  } catch (const CLI::ParseError& other) {
    throw std::runtime_error(other.what());
  }
  return true;
}

int run_program(const std::string& program, const std::function<int()>& run) {
  const auto refused = [&](const std::string& what, int status) {
    std::fprintf(stderr, "%s: error: %s (%s --help)\n", program.c_str(), what.c_str(), program.c_str());
    return status;
  };
  try {
    return run();
  } catch (const std::runtime_error& error) {
    return refused(error.what(), 2);
  } catch (const std::exception& error) {
    return refused(std::string("internal: ") + error.what(), 3);
  }
}

}  // namespace exactvo::tools
