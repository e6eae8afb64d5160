// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/grey_image.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "exactvo/datasets/data_error.h"
#include "files/text_file.h"
#include "gdal/vector_library.h"
#include "readers/grid.h"

namespace exactvo::datasets {
namespace {

/// Netpbm's own rule: white space and comments (# to the end of the line) part the numbers of a header.
class PgmScanner {
 public:
  PgmScanner(const std::string& bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  std::size_t number(const char* what) {
    skip_to_number();
    std::size_t value = 0;
    const std::size_t start = at_;
    while (at_ < bytes_.size() && std::isdigit(static_cast<unsigned char>(bytes_[at_])) && at_ - start < 10) {
      value = 10 * value + static_cast<std::size_t>(bytes_[at_++] - '0');
    }
    if (at_ == start) refuse(DataCode::image, excerpt(bytes_, at_), std::string("the picture's ") + what);
    return value;
  }

  /// One or two bytes, the more significant first.
  std::size_t raw(bool wide) {
    std::size_t value = static_cast<unsigned char>(bytes_[at_++]);
    if (wide) value = value << 8 | static_cast<unsigned char>(bytes_[at_++]);
    return value;
  }

  void skip(std::size_t count) { at_ += count; }
  std::size_t left() const { return bytes_.size() - std::min(at_, bytes_.size()); }

  [[noreturn]] void refuse(DataCode code, const std::string& found, const std::string& expected) const {
    throw DataError(code, file_, "byte " + std::to_string(at_), found, expected);
  }

 private:
  void skip_to_number() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      } else if (std::isspace(static_cast<unsigned char>(bytes_[at_]))) {
        ++at_;
      } else {
        return;
      }
    }
  }

  const std::string& bytes_;
  const std::string& file_;
  std::size_t at_ = 2;  ///< after "P2" or "P5"
};

/// Asked before memory is taken: a header may claim anything.
bool fits(const GreyImage& image, std::size_t bytes, std::size_t bytes_a_pixel) {
  if (image.width == 0 || image.height == 0 || image.width > kMostCells) return false;
  if (image.height > kMostCells / image.width) return false;
  return image.width * image.height * bytes_a_pixel <= bytes;
}

bool is_pgm(const std::string& bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == '2' || bytes[1] == '5');
}

// ISO/IEC 15948, 5.2 and 5.3: a signature, then chunks of length, type, data and checksum.
constexpr char kPngSignature[] = "\x89PNG\r\n\x1a\n";
constexpr std::uintmax_t kPngSignatureSize = sizeof(kPngSignature) - 1;
constexpr std::uintmax_t kPngHeaderSize = 8;
constexpr std::uintmax_t kChecksumSize = 4;

using PngHeader = std::array<char, kPngHeaderSize>;

std::uintmax_t claimed_by(const PngHeader& header) {
  std::uintmax_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length = length << 8U | static_cast<unsigned char>(header[i]);
  return length;
}

bool is_png(std::istream& in) {
  PngHeader signature{};
  return in.read(signature.data(), signature.size()) &&
         std::memcmp(signature.data(), kPngSignature, kPngSignatureSize) == 0;
}

/// Refuses a PNG file one of whose chunks claims more bytes than the file has left (DataCode::size): decoders make room
/// for what is claimed before they read it. What is no PNG, or is cut between chunks, is left to the decoder.
void require_whole_png_chunks(const std::filesystem::path& path) {
  const std::uintmax_t size = std::filesystem::file_size(path);
  std::ifstream in(path, std::ios::binary);
  if (!is_png(in)) return;
  std::uintmax_t at = kPngSignatureSize;
  for (PngHeader header{}; in.read(header.data(), header.size());) {
    const std::uintmax_t left = size - at - kPngHeaderSize;
    const std::uintmax_t claimed = claimed_by(header) + kChecksumSize;
    if (claimed > left) {
      throw DataError(DataCode::size, path.string(), "byte " + std::to_string(at),
                      "a chunk of " + std::to_string(claimed) + " bytes",
                      "at most the " + std::to_string(left) + " left");
    }
    at += kPngHeaderSize + claimed;
    in.seekg(static_cast<std::streamoff>(at));
  }
}

}  // namespace

GreyImage read_pgm(const std::string& bytes, const std::string& file) {
  PgmScanner scan(bytes, file);
  const bool plain = bytes[1] == '2';
  GreyImage image;
  image.width = scan.number("width");
  image.height = scan.number("height");
  const std::size_t brightest = scan.number("greatest value");
  if (brightest < 1 || brightest > 65535) scan.refuse(DataCode::image, std::to_string(brightest), "1 to 65535");
  scan.skip(1);
  const bool wide = !plain && brightest > 255;
  if (!fits(image, scan.left(), wide ? 2 : 1)) {
    scan.refuse(DataCode::size, std::to_string(image.width) + " by " + std::to_string(image.height) + " pixels",
                "as many as the file holds, at most " + std::to_string(kMostCells));
  }
  image.brightness.resize(image.width * image.height);
  for (float& pixel : image.brightness) {
    const std::size_t value = plain ? scan.number("pixel") : scan.raw(wide);
    pixel = static_cast<float>(255.0 * static_cast<double>(value) / static_cast<double>(brightest));
  }
  return image;
}

GreyImage read_image(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw DataError(DataCode::image, path.string(), "", "no such picture", "the picture that the map names");
  }
  if (!is_pgm(read_beginning(path, 3))) {
    require_whole_png_chunks(path);
    return vector_library().read_gdal_image(path);
  }
  return read_pgm(read_text_file(path), path.string());
}

}  // namespace exactvo::datasets
