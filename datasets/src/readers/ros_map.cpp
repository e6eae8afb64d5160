// SPDX-License-Identifier: GPL-3.0-or-later
// ROS maps: a yaml that names a picture, its scale and thresholds (map_server). Occupied cells are obstacles; unknown
// ones are counted, and are free or obstacles as the reader's options say. And the pictures: PGM here, others by GDAL.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <boost/endian/conversion.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "exactvo/datasets/data_error.h"
#include "exactvo/geometry/counted.h"
#include "files/text_file.h"
#include "gdal/vector_library.h"
#include "readers/grid.h"
#include "readers/readers.h"

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

// ISO/IEC 15948, 5.2 and 5.3: a signature, then chunks of length, type, data and checksum.
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr std::uintmax_t kChecksumSize = 4;

/// Refuses a PNG file one of whose chunks claims more bytes than the file has left (DataCode::size): decoders make room
/// for what is claimed before they read it. What is no PNG, or is cut between chunks, is left to the decoder.
void require_whole_png_chunks(const std::filesystem::path& path) {
  const std::uintmax_t size = std::filesystem::file_size(path);
  std::ifstream in(path, std::ios::binary);
  std::array<char, 8> head{};  // the signature is as long as the length and type of a chunk
  if (!in.read(head.data(), head.size()) || std::string_view(head.data(), head.size()) != kPngSignature) return;
  std::uintmax_t at = head.size();
  while (in.read(head.data(), head.size())) {
    const std::uintmax_t left = size - at - head.size();
    const std::uintmax_t claimed =
        boost::endian::load_big_u32(reinterpret_cast<const unsigned char*>(head.data())) + kChecksumSize;
    if (claimed > left) {
      throw DataError(DataCode::size, path.string(), "byte " + std::to_string(at),
                      "a chunk of " + std::to_string(claimed) + " bytes",
                      "at most the " + std::to_string(left) + " left");
    }
    at += head.size() + claimed;
    in.seekg(static_cast<std::streamoff>(at));
  }
}

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

/// Throws DataError: E_IMAGE, or E_SIZE for more pixels than kMostCells or than the file holds.
GreyImage read_image(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw DataError(DataCode::image, path.string(), "", "no such picture", "the picture that the map names");
  }
  const std::string mark = read_beginning(path, 3).substr(0, 2);
  if (mark != "P2" && mark != "P5") {
    require_whole_png_chunks(path);
    return vector_library().read_gdal_image(path);
  }
  return read_pgm(read_text_file(path), path.string());
}

enum class MapMode { trinary, scale, raw };

struct MapFacts {
  std::string image;
  double resolution = 0.0;
  std::array<double, 3> origin{};  ///< x, y (m), yaw (rad) of the picture's lower left corner
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
  MapMode mode = MapMode::trinary;
};

/// The yaml's values, with the key in every refusal.
class MapYaml {
 public:
  MapYaml(const std::string& text, const std::string& file) : file_(file) {
    try {
      root_ = YAML::Load(text);
    } catch (const YAML::Exception& error) {
      throw DataError(
          DataCode::format_syntax, file_,
          "line " + std::to_string(error.mark.line + 1) + ", column " + std::to_string(error.mark.column + 1),
          error.msg, "YAML");
    }
    if (!root_.IsMap()) throw DataError(DataCode::format_syntax, file_, "", "no keys", "the keys of a map");
  }

  std::string image() const { return required<std::string>("image", "the name of a picture"); }

  MapFacts facts() const {
    MapFacts m;
    m.image = image();
    m.resolution = finite(required<double>("resolution", "metres a cell"), "resolution");
    if (!(m.resolution > 0.0))
      refuse("resolution", DataCode::out_of_range, std::to_string(m.resolution), "a number > 0");
    const auto origin = required<std::vector<double>>("origin", "[x, y, yaw]");
    if (origin.size() != 3)
      refuse("origin", DataCode::wrong_count, geometry::counted(origin.size(), "number"), "[x, y, yaw]");
    for (std::size_t i = 0; i < 3; ++i) m.origin[i] = finite(origin[i], "origin");
    m.negate = negate();
    m.occupied_thresh = threshold("occupied_thresh", m.occupied_thresh);
    m.free_thresh = threshold("free_thresh", std::min(m.free_thresh, m.occupied_thresh));
    if (m.free_thresh > m.occupied_thresh) refuse_order();
    m.mode = mode();
    return m;
  }

 private:
  template <class T>
  T required(const char* key, const char* expected) const {
    if (!root_[key]) throw DataError(DataCode::key_missing, file_, "", "no key \"" + std::string(key) + "\"", expected);
    return value<T>(key, {}, expected);
  }

  template <class T>
  T value(const char* key, const T& otherwise, const char* expected) const {
    const YAML::Node node = root_[key];
    if (!node) return otherwise;
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      refuse(key, DataCode::wrong_type, words_of(node), expected);
    }
  }

  /// What stands there; of a list the first entry that is no number.
  static std::string words_of(const YAML::Node& node) {
    if (node.IsScalar()) return "\"" + node.Scalar() + "\"";
    if (node.IsMap()) return "keys";
    if (!node.IsSequence()) return "nothing";
    for (std::size_t k = 0; k < node.size(); ++k) {
      double number = 0.0;
      const YAML::Node entry = node[k];
      if (!YAML::convert<double>::decode(entry, number))
        return (entry.IsSequence() ? "a list" : words_of(entry)) + " as number " + std::to_string(k + 1) + " of a list";
    }
    return "a list";
  }

  double finite(double number, const char* key) const {
    if (!std::isfinite(number)) refuse(key, DataCode::number, std::to_string(number), "a finite number");
    return number;
  }

  /// A share of darkness: 65 where 0.65 was meant would leave no cell occupied, and no wall.
  double threshold(const char* key, double otherwise) const {
    const double number = value<double>(key, otherwise, "a number from 0 to 1");
    if (!(number >= 0.0 && number <= 1.0)) refuse(key, DataCode::out_of_range, word(key), "a number from 0 to 1");
    return number;
  }

  /// Only what is written can be at fault: free_thresh, left out, is no higher than the other.
  [[noreturn]] void refuse_order() const {
    const std::string occupied = root_["occupied_thresh"] ? word("occupied_thresh") : "0.65 where it is left out";
    refuse("free_thresh", DataCode::out_of_range, word("free_thresh"), "at most occupied_thresh, " + occupied);
  }

  std::string word(const char* key) const { return root_[key].Scalar(); }

  bool negate() const {
    const std::string word = value<std::string>("negate", "0", "0 or 1");
    if (word == "0" || word == "false") return false;
    if (word == "1" || word == "true") return true;
    refuse("negate", DataCode::not_an_option, "\"" + word + "\"", "0 or 1");
  }

  MapMode mode() const {
    const std::string word = value<std::string>("mode", "trinary", "trinary, scale or raw");
    if (word == "trinary") return MapMode::trinary;
    if (word == "scale") return MapMode::scale;
    if (word == "raw") return MapMode::raw;
    refuse("mode", DataCode::not_an_option, "\"" + word + "\"", "trinary, scale or raw");
  }

  [[noreturn]] void refuse(const char* key, DataCode code, const std::string& found,
                           const std::string& expected) const {
    throw DataError(code, file_, "line " + std::to_string(root_[key].Mark().line + 1) + ", key " + key, found,
                    expected);
  }

  const std::string& file_;
  YAML::Node root_;
};

/// A map's description is a few lines; beyond this it is something else.
constexpr std::size_t kLongestDescription = 1 << 20;

std::string description_of(const std::filesystem::path& map) {
  std::string text = read_beginning(map, kLongestDescription + 1);
  if (text.size() > kLongestDescription) {
    throw DataError(DataCode::size, map.string(), "", "more than a megabyte", "the few lines of a map's description");
  }
  return text;
}

/// A map is a folder's business: its picture lies in the same folder or below.
std::filesystem::path image_path(const std::filesystem::path& map, const std::string& image) {
  const std::filesystem::path folder = std::filesystem::weakly_canonical(map).parent_path();
  const std::filesystem::path picture = std::filesystem::weakly_canonical(folder / image);
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), picture.begin(), picture.end());
  if (end != folder.end()) {
    throw DataError(DataCode::path_escape, map.string(), "key image", "\"" + image + "\"",
                    "a picture in the map's folder");
  }
  if (!std::filesystem::is_regular_file(picture)) {
    throw DataError(DataCode::image, map.string(), "key image", "\"" + image + "\", which is not there", "a picture");
  }
  return picture;
}

enum class Occupancy { free, occupied, unknown };

/// map_server's rule; comparisons are strict. In mode scale only what is above the threshold is an obstacle; the
/// levels between are costs. In mode raw the pixel is the occupancy in per cent, and above 100 unknown.
Occupancy occupancy_of(double brightness, const MapFacts& map) {
  if (map.mode == MapMode::raw) {
    if (brightness > 100.0) return Occupancy::unknown;
    return brightness > 100.0 * map.occupied_thresh ? Occupancy::occupied : Occupancy::free;
  }
  const double occ = map.negate ? brightness / 255.0 : (255.0 - brightness) / 255.0;
  if (occ > map.occupied_thresh) return Occupancy::occupied;
  return occ < map.free_thresh ? Occupancy::free : Occupancy::unknown;
}

Grid to_grid(const GreyImage& image, const MapFacts& map, Collector& out) {
  Grid grid{image.width, image.height, std::vector<std::uint8_t>(image.width * image.height, 0)};
  const bool blocks_unknown = out.options().unknown == UnknownCells::blocked;
  std::size_t unknown = 0;
  for (std::size_t row = 0; row < image.height; ++row) {
    for (std::size_t x = 0; x < image.width; ++x) {
      const std::size_t pixel = row * image.width + x;
      const bool clear = !image.is_transparent.empty() && image.is_transparent[pixel];
      const Occupancy is = clear ? Occupancy::unknown : occupancy_of(static_cast<double>(image.brightness[pixel]), map);
      const bool is_blocked = is == Occupancy::occupied || (is == Occupancy::unknown && blocks_unknown);
      if (is_blocked) grid.occupied[(image.height - 1 - row) * image.width + x] = 1;
      unknown += is == Occupancy::unknown ? 1 : 0;
    }
  }
  if (unknown > 0)
    out.note("", geometry::counted(unknown, "unknown cell") + " taken as " + name(out.options().unknown) +
                     " (option unknown: free or blocked)");
  return grid;
}

}  // namespace

bool looks_like_ros_map(const FormatProbe& probe) {
  return (probe.extension == ".yaml" || probe.extension == ".yml") &&
         probe.beginning.find("image:") != std::string::npos;
}

std::filesystem::path picture_of_ros_map(const std::filesystem::path& map) {
  const std::string file = map.string();
  return image_path(map, MapYaml(description_of(map), file).image());
}

void read_ros_map(const std::filesystem::path& path, Collector& out) {
  const MapFacts map = MapYaml(description_of(path), out.file()).facts();
  const Grid grid = to_grid(read_image(image_path(path, map.image)), map, out);
  add_grid(grid, {{map.origin[0], map.origin[1]}, map.resolution, map.origin[2], 0, 0}, out);
}

}  // namespace exactvo::datasets
