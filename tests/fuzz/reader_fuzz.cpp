// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a file of one format (EXACTVO_FUZZ_FORMAT): what reader_case.h says or a DataError, nothing else. Every
// other input of obstacles is read with repairs.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "reader_case.h"

namespace {

std::filesystem::path folder() {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("exactvo_fuzz_" + std::to_string(::getpid()));
  std::filesystem::create_directories(path);
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path kFolder = folder();
  static const bool kCleansUp = std::atexit([] {
                                  std::error_code ignored;
                                  std::filesystem::remove_all(kFolder, ignored);
                                }) == 0;
  static_cast<void>(kCleansUp);
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::string wrong = exactvo::datasets::test::read_case(EXACTVO_FUZZ_FORMAT, bytes, kFolder);
  if (wrong.empty()) return 0;
  std::fprintf(stderr, "%s\n", wrong.c_str());
  std::abort();
}
