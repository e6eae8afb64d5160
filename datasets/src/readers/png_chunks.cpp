// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/png_chunks.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {
namespace {

// ISO/IEC 15948, 5.2 and 5.3: a signature, then chunks of length, type, data and checksum.
constexpr char kSignature[] = "\x89PNG\r\n\x1a\n";
constexpr std::uintmax_t kSignatureSize = sizeof(kSignature) - 1;
constexpr std::uintmax_t kHeaderSize = 8;
constexpr std::uintmax_t kChecksumSize = 4;

using Header = std::array<char, kHeaderSize>;

std::uintmax_t claimed_by(const Header& header) {
  std::uintmax_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length = length << 8U | static_cast<unsigned char>(header[i]);
  return length;
}

bool is_png(std::istream& in) {
  Header signature{};
  return in.read(signature.data(), signature.size()) && std::memcmp(signature.data(), kSignature, kSignatureSize) == 0;
}

}  // namespace

void require_whole_png_chunks(const std::filesystem::path& path) {
  const std::uintmax_t size = std::filesystem::file_size(path);
  std::ifstream in(path, std::ios::binary);
  if (!is_png(in)) return;
  std::uintmax_t at = kSignatureSize;
  for (Header header{}; in.read(header.data(), header.size());) {
    const std::uintmax_t left = size - at - kHeaderSize;
    const std::uintmax_t claimed = claimed_by(header) + kChecksumSize;
    if (claimed > left) {
      throw DataError(DataCode::size, path.string(), "byte " + std::to_string(at),
                      "a chunk of " + std::to_string(claimed) + " bytes",
                      "at most the " + std::to_string(left) + " left");
    }
    at += kHeaderSize + claimed;
    in.seekg(static_cast<std::streamoff>(at));
  }
}

}  // namespace exactvo::datasets
