// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The options of a program that is not `exactvo`: a benchmark, an audit, a campaign. Parsed by CLI11, refused in the
/// words and with the exit statuses of `exactvo`:
///
///     int main(int argc, char** argv) {
///       return run_program("bench_lp", [&] {
///         Flags flags;
///         ProgramOptions options("bench_lp", "Which solver is right, and which is fast?");
///         options.whole_number("--rounds", flags.rounds, 1, "Timed passes over each set");
///         return options.parse(argc, argv) ? run(flags) : 0;
///       });
///     }

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace exactvo::tools {

class ProgramOptions {
 public:
  ProgramOptions(const std::string& program, const std::string& summary, const std::string& footer = "");
  ~ProgramOptions();
  ProgramOptions(const ProgramOptions&) = delete;
  ProgramOptions& operator=(const ProgramOptions&) = delete;

  // A name without dashes is a position: "FILE". Values that are there already are the defaults.
  void flag(const std::string& name, bool& value, const std::string& help);
  void text(const std::string& name, std::string& value, const std::string& help, bool required = false);
  void texts(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// One of `known`.
  void word(const std::string& name, std::string& value, const std::vector<std::string>& known, const std::string& help,
            bool required = false);

  /// A whole number from `least` on, within the range of its type.
  template <class Integer>
  void whole_number(const std::string& name, Integer& value, std::uint64_t least, const std::string& help) {
    static_assert(std::is_integral_v<Integer>);
    const auto most = static_cast<std::uint64_t>(std::numeric_limits<Integer>::max());
    add_number(name, std::to_string(value), least, most, help,
               [&value](std::uint64_t given) { value = static_cast<Integer>(given); });
  }

  /// Whether `name` was on the command line. REQUIRES: parsed.
  bool given(const std::string& name) const;

  /// False where help was asked for and printed. Throws UsageError for an unknown option.
  bool parse(int argc, const char* const* argv);

 private:
  using Put = std::function<void(std::uint64_t)>;
  void add_number(const std::string& name, const std::string& now, std::uint64_t least, std::uint64_t most,
                  const std::string& help, const Put& put);

  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// The status of `program`; an error becomes "PROGRAM: error: ..." on stderr and 2 (a bad option or file:
/// std::runtime_error) or 3 (a defect: anything else).
int run_program(const std::string& program, const std::function<int()>& run);

}  // namespace exactvo::tools
