// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Text from files, pipes and standard input, and how a program stops a reader that waits for the other end of a pipe
/// or reads a long file.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace exactvo::datasets {

/// `hook` is called at least ten times a second while a reader waits, for every geometry and every 64 KiB
/// of JSON that it reads; what it throws ends the reading and comes out of it. One hook for the whole process, called
/// from whatever thread reads; null takes it away.
void set_wait_hook(void (*hook)());

/// Calls the hook, if there is one.
void call_wait_hook();

/// Between two of its calls.
inline constexpr std::size_t kWaitHookBytes = std::size_t{1} << 16;

/// Bytes: what is read whole must fit into memory several times.
inline constexpr std::uint64_t kLargestWholeFile = std::uint64_t{1} << 31;

/// The bytes of a regular file or a pipe; a pipe is waited for. Throws DataError: E_FILE_MISSING, E_FILE_UNREADABLE
/// (also a directory, a device, a socket), E_SIZE beyond kLargestWholeFile.
std::string read_text_file(const std::filesystem::path& path);

/// The same; "-" is standard input, whatever that is.
std::string read_file_or_input(const std::string& file);

/// What messages call that: "standard input" or the file.
std::string name_of_input(const std::string& file);

/// The lines of a file or a pipe, one after the other, as they come: memory does not grow with the input.
class TextLines {
 public:
  /// Throws DataError as `read_text_file` does.
  explicit TextLines(const std::filesystem::path& path);
  /// The same; "-" is standard input. No line may have more than `longest` bytes.
  TextLines(const std::string& file, std::size_t longest);
  ~TextLines();

  /// The next line without its \n, valid until the next call; false at the end. Throws DataError (E_SIZE) for one that
  /// is too long.
  bool next(std::string_view& line);

  /// The number of the last line given, from 1.
  std::size_t number() const;
  /// As messages name it.
  const std::string& file() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace exactvo::datasets
