// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "files/system_error.h"
#include "files/text_file.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

constexpr std::array<const char*, 9> kGeometryWords{"POINT",           "LINESTRING",   "LINEARRING",
                                                    "POLYGON",         "MULTIPOINT",   "TRIANGLE",
                                                    "MULTILINESTRING", "MULTIPOLYGON", "GEOMETRYCOLLECTION"};

/// The words, numbers and signs of a text, with their places.
class WktScanner {
 public:
  /// `lines_before`: of the file, where the text is a piece of it.
  WktScanner(std::string_view text, const std::string& file, std::size_t lines_before = 0)
      : text_(text), file_(file), lines_before_(lines_before) {}

  /// Past white space and what may stand between geometries (a byte order mark, commas, semicolons).
  void skip_between_geometries() {
    if (at_ == 0 && text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
    while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == ',' || text_[at_] == ';')) ++at_;
  }

  bool at_end() {
    skip_space();
    return at_ >= text_.size();
  }

  /// The next word in upper case, or "" where none stands.
  std::string word() {
    skip_space();
    std::string letters;
    while (at_ < text_.size() && is_letter(text_[at_])) {
      letters += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_++])));
    }
    return letters;
  }

  std::string peek_word() {
    const std::size_t before = at_;
    std::string letters = word();
    at_ = before;
    return letters;
  }

  bool try_sign(char sign) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != sign) return false;
    ++at_;
    return true;
  }

  void need_sign(char sign) {
    if (!try_sign(sign)) refuse(std::string("'") + sign + "'");
  }

  bool number_ahead() {
    skip_space();
    return at_ < text_.size() && text_[at_] != ',' && text_[at_] != ')' && text_[at_] != '(';
  }

  /// Any C number; "nan" and "inf" are let through for the ring to be validated.
  double number() {
    skip_space();
    const std::size_t sign = text_.substr(at_, 1) == "+" && text_.substr(at_ + 1, 1) != "-" ? 1 : 0;
    const char* first = text_.data() + at_ + sign;
    const char* last = text_.data() + text_.size();
    double value = 0.0;
    const std::from_chars_result result = std::from_chars(first, last, value);
    if (result.ec == std::errc::invalid_argument) refuse("a number", DataCode::number);
    // Beyond any double: from_chars leaves `value` alone, strtod gives an infinity or a rounded near-zero.
    if (result.ec == std::errc::result_out_of_range)
      value = std::strtod(std::string(first, result.ptr).c_str(), nullptr);
    at_ += static_cast<std::size_t>(result.ptr - first) + sign;
    return value;
  }

  /// After an error in the geometry that began at `start`: to the next line that begins with a letter.
  void skip_to_next_geometry(std::size_t start) {
    const auto geometry_may_begin = [&] { return at_ > start && text_[at_ - 1] == '\n' && is_letter(text_[at_]); };
    while (at_ < text_.size() && !geometry_may_begin()) {
      const std::size_t newline = text_.find('\n', at_);
      at_ = newline == std::string_view::npos ? text_.size() : newline + 1;
    }
  }

  std::size_t position() const { return at_; }
  void back_to(std::size_t position) { at_ = position; }
  std::string place() const {
    const std::size_t here = std::min(at_, text_.size());
    if (here < counted_to_) counted_to_ = newlines_ = line_start_ = 0;
    for (; counted_to_ < here; ++counted_to_) {
      if (text_[counted_to_] != '\n') continue;
      ++newlines_;
      line_start_ = counted_to_ + 1;
    }
    return "line " + std::to_string(lines_before_ + newlines_ + 1) + ", column " +
           std::to_string(here - line_start_ + 1);
  }

  [[noreturn]] void refuse(const std::string& expected, DataCode code = DataCode::format_syntax) {
    skip_space();
    throw DataError(code, file_, place(), excerpt(text_, at_), expected);
  }

 private:
  static constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  static bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
  static bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t lines_before_;
  // Up to where newlines were counted, so that places along a long text do not count them all again and again.
  mutable std::size_t counted_to_ = 0;
  mutable std::size_t newlines_ = 0;
  mutable std::size_t line_start_ = 0;
};

/// Block after block; together they are the file. A block ends before a line that begins with a letter while no bracket
/// is open: there a geometry begins, and nothing else can. Text that never closes its brackets is cut before such a
/// line as well once kLargestOpenBlock is read: it is no well-known text, and a reader starts anew on just such lines.
class WktBlocks {
 public:
  static constexpr std::size_t kBlock = std::size_t{1} << 20;
  static constexpr std::size_t kLargestOpenBlock = std::size_t{64} << 20;

  /// Throws DataError (missing, unreadable, a folder), as `next` does.
  explicit WktBlocks(const std::filesystem::path& path) : path_(path) {
    read_beginning(path, 1);  // names what is missing or no file
    file_.open(path, std::ios::binary);
    if (!file_) throw cannot_read(path, errno);
    std::error_code unknown;
    size_ = std::filesystem::file_size(path, unknown);
  }

  /// Moves on; false at the end.
  bool next() {
    buffer_.erase(0, length_);
    length_ = cut_ = scanned_ = 0;
    depth_ = 0;
    while (read_more()) {
      length_ = place_to_cut();
      if (length_ > 0) return true;
    }
    length_ = buffer_.size();
    return length_ > 0;
  }

  std::string_view text() const { return std::string_view(buffer_).substr(0, length_); }
  double share_read() const { return size_ > 0 ? static_cast<double>(read_) / static_cast<double>(size_) : 1.0; }

 private:
  bool read_more() {
    const std::size_t before = buffer_.size();
    buffer_.resize(before + kBlock);
    file_.read(buffer_.data() + before, kBlock);
    if (file_.bad()) throw cannot_read(path_, errno);
    const auto got = static_cast<std::size_t>(file_.gcount());
    buffer_.resize(before + got);
    read_ += got;
    // No text holds one, and a file full of them would be taken for one geometry that does not end.
    const std::size_t zero = buffer_.find('\0', before);
    if (zero != std::string::npos)
      throw DataError(DataCode::format_syntax, path_.string(), "byte " + std::to_string(read_ - got + zero - before),
                      "a zero byte", "text");
    return got > 0;
  }

  /// The last newline that a letter follows outside all brackets.
  std::size_t place_to_cut() {
    const bool give_up = buffer_.size() >= kLargestOpenBlock;
    for (; scanned_ + 1 < buffer_.size(); ++scanned_) {
      const char c = buffer_[scanned_];
      if (c == '(') ++depth_;
      if (c == ')') --depth_;
      const bool line_of_letters = c == '\n' && std::isalpha(static_cast<unsigned char>(buffer_[scanned_ + 1])) != 0;
      if (line_of_letters && (depth_ == 0 || give_up)) cut_ = scanned_ + 1;
    }
    return cut_;
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t read_ = 0;
  std::string buffer_;
  std::size_t length_ = 0;   ///< of the current block
  std::size_t scanned_ = 0;  ///< of the buffer, for brackets
  long depth_ = 0;           ///< brackets open there
  std::size_t cut_ = 0;      ///< the last place between geometries; 0: none yet
};

/// "POLYGONZ" and "POLYGON Z" are the same; what follows the keyword is taken off it.
std::string without_dimension(std::string word) {
  const auto known = [&](const std::string& w) {
    return std::find(kGeometryWords.begin(), kGeometryWords.end(), w) != kGeometryWords.end();
  };
  for (const std::string suffix : {"ZM", "Z", "M"}) {
    if (known(word) || word.size() <= suffix.size()) break;
    const std::string shorter = word.substr(0, word.size() - suffix.size());
    if (word.compare(shorter.size(), suffix.size(), suffix) == 0 && known(shorter)) return shorter;
  }
  return word;
}

/// Where in its file a piece of text stands.
struct TextPlace {
  std::size_t lines = 0;       ///< before it
  std::size_t geometries = 0;  ///< before it
  std::string place;           ///< of text within another format: stands for its own
  std::string id;              ///< likewise, with a number where it holds several
};

class WktReader {
 public:
  /// What a polygon's inside is.
  enum class Inside { solid, walkable };

  WktReader(std::string_view text, Inside inside, Collector& out, TextPlace before = {})
      : scan_(text, out.file(), before.lines),
        inside_(inside),
        out_(out),
        before_(std::move(before)),
        geometry_(before_.geometries) {}

  std::size_t holes() const { return holes_; }
  /// Met so far, those before it included.
  std::size_t geometries() const { return geometry_; }

  void read_all() {
    for (scan_.skip_between_geometries(); !scan_.at_end(); scan_.skip_between_geometries()) read_one();
  }

 private:
  void read_one() {
    part_ = 0;
    ++geometry_;
    const std::size_t start = scan_.position();
    try {
      where_ = before_.place.empty() ? scan_.place() : before_.place;
      reference_system();
      geometry(0);
    } catch (const DataError& error) {
      // Collector::add throws for a bad ring as well; only what breaks the text itself is met again here.
      if (error.code() != DataCode::format_syntax && error.code() != DataCode::number &&
          error.code() != DataCode::nesting && error.code() != DataCode::projection) {
        throw;
      }
      out_.reject(before_.place.empty()
                      ? error
                      : DataError(error.code(), error.file(), before_.place, error.found(), error.expected()));
      scan_.skip_to_next_geometry(start);
    }
  }

  /// "SRID=28992;" as PostGIS prints it.
  void reference_system() {
    int srid = 0;
    if (scan_.peek_word() == "SRID") {
      scan_.word();
      scan_.need_sign('=');
      srid = this->srid();
      scan_.need_sign(';');
    }
    out_.reference_system(srid, where_);
  }

  /// 0, and -1 of old dumps: not known.
  int srid() {
    constexpr double kLargest = 1e9;
    const std::size_t start = scan_.position();
    const double number = scan_.number();
    if (!(number >= -1.0 && number <= kLargest && std::trunc(number) == number)) {
      scan_.back_to(start);
      scan_.refuse("SRID=N, the EPSG code of a reference system");
    }
    return std::max(0, static_cast<int>(number));
  }

  void geometry(int depth) {
    const std::string kind = keyword();
    if (try_empty()) return out_.pass_over(where_, "an empty " + kind + " skipped");
    if (kind == "POINT" || kind == "MULTIPOINT") return points(kind);
    if (kind == "LINESTRING" || kind == "LINEARRING") return line();
    if (kind == "POLYGON" || kind == "TRIANGLE") return polygon();
    if (kind == "MULTILINESTRING") return list([this] { line(); });
    if (kind == "MULTIPOLYGON") return list([this] { polygon(); });
    collection(depth);
  }

  std::string keyword() {
    const std::string kind = without_dimension(scan_.peek_word());
    if (std::find(kGeometryWords.begin(), kGeometryWords.end(), kind) == kGeometryWords.end()) {
      scan_.refuse("a geometry: POLYGON, LINESTRING, POINT, MULTI..., GEOMETRYCOLLECTION");
    }
    scan_.word();
    const std::string dimension = scan_.peek_word();
    if (dimension == "Z" || dimension == "M" || dimension == "ZM") scan_.word();
    return kind;
  }

  bool try_empty() {
    if (scan_.peek_word() != "EMPTY") return false;
    scan_.word();
    return true;
  }

  template <class Item>
  void list(Item item) {
    scan_.need_sign('(');
    do {
      if (try_empty()) {
        out_.pass_over(where_, "an empty part skipped");
      } else {
        item();
      }
    } while (scan_.try_sign(','));
    scan_.need_sign(')');
  }

  void collection(int depth) {
    if (depth >= kDeepestCollection) {
      scan_.refuse("collections at most " + std::to_string(kDeepestCollection) + " deep", DataCode::nesting);
    }
    list([this, depth] { geometry(depth + 1); });
  }

  void points(const std::string& kind) {
    list([this] {
      const bool wrapped = scan_.try_sign('(');
      coordinate();
      if (wrapped) scan_.need_sign(')');
    });
    out_.pass_over(where_, "a " + kind + " skipped: points are no obstacles");
  }

  void line() { hand_on(RawKind::polyline, {ring()}); }

  void polygon() {
    std::vector<geometry::Ring> rings;
    list([&] { rings.push_back(ring()); });
    holes_ += rings.empty() ? 0 : rings.size() - 1;
    if (inside_ == Inside::solid || rings.empty()) return hand_on(RawKind::polygon, std::move(rings));
    hand_on(RawKind::polyline, {rings.front()});
    for (std::size_t k = 1; k < rings.size(); ++k) hand_on(RawKind::polygon, {counter_clockwise(rings[k])});
  }

  /// A walkable area's holes are solid. Rounding may misjudge a sliver, which then counts as repaired.
  static geometry::Ring counter_clockwise(geometry::Ring ring) {
    double doubled_area = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      doubled_area += cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
    }
    if (doubled_area < 0.0) std::reverse(ring.begin(), ring.end());
    return ring;
  }

  geometry::Ring ring() {
    geometry::Ring points;
    list([&] { points.push_back(coordinate()); });
    return points;
  }

  /// x y, and at most two more that are dropped.
  geometry::Vec2 coordinate() {
    geometry::Vec2 p;
    p.x = scan_.number();
    p.y = scan_.number();
    for (int extra = 0; extra < 2 && scan_.number_ahead(); ++extra) scan_.number();
    return p;
  }

  std::string id() const {
    if (before_.id.empty()) return std::to_string(geometry_);
    return before_.id + (geometry_ > 1 ? "/" + std::to_string(geometry_) : "");
  }

  void hand_on(RawKind kind, std::vector<geometry::Ring> rings) {
    const RawGeometry raw = part_of_geometry(part_++, kind, id(), where_, std::move(rings));
    if (raw.rings.empty()) return out_.pass_over(raw.place, "an empty polygon skipped");
    out_.add(raw);
  }

  WktScanner scan_;
  Inside inside_;
  Collector& out_;
  TextPlace before_;
  std::string where_;     ///< the geometry's first character
  std::size_t geometry_;  ///< from 1
  std::size_t part_ = 0;  ///< obstacles of this geometry so far
  std::size_t holes_ = 0;
};

void refuse_degrees(const Collector& out) {
  if (out.options().units != Units::degrees) return;
  throw DataError(DataCode::projection, out.file(), "", "plain WKT said to be in degrees",
                  "metres, or a format with a reference system");
}

/// A block at a time, cut between geometries: memory does not grow with the file.
void read_in_blocks(const std::filesystem::path& path, WktReader::Inside inside, Collector& out) {
  refuse_degrees(out);
  WktBlocks blocks(path);
  TextPlace place;
  std::size_t holes = 0;
  while (blocks.next()) {
    WktReader reader(blocks.text(), inside, out, place);
    reader.read_all();
    place.geometries = reader.geometries();
    holes += reader.holes();
    place.lines += static_cast<std::size_t>(std::count(blocks.text().begin(), blocks.text().end(), '\n'));
    out.progress(blocks.share_read());
  }
  if (inside == WktReader::Inside::solid && place.geometries == 1 && holes > 0)
    out.note("", "its only geometry is read as solid, with " + geometry::counted(holes, "hole") +
                     "; if it is the walkable area of JuPedSim, name the format jupedsim-wkt");
}

}  // namespace

bool looks_like_wkt(const FormatProbe& probe) {
  const std::string name = "";
  WktScanner scan(probe.beginning, name);
  scan.skip_between_geometries();
  const std::string word = without_dimension(scan.word());
  return (word == "SRID" && scan.try_sign('=')) ||
         std::find(kGeometryWords.begin(), kGeometryWords.end(), word) != kGeometryWords.end();
}

void read_wkt_text(std::string_view text, const std::string& place, const std::string& id, Collector& out) {
  WktReader(text, WktReader::Inside::solid, out, {0, 0, place, id}).read_all();
}

void read_wkt(const std::filesystem::path& path, Collector& out) {
  read_in_blocks(path, WktReader::Inside::solid, out);
}

void read_jupedsim_wkt(const std::filesystem::path& path, Collector& out) {
  read_in_blocks(path, WktReader::Inside::walkable, out);
}

ObstacleFile parse_wkt(const std::string& text, const std::string& file_name, const ReadOptions& options) {
  return read_in_its_system(file_name, "wkt", options, nullptr, [&](Collector& out) {
    refuse_degrees(out);
    WktReader(text, WktReader::Inside::solid, out).read_all();
  });
}

}  // namespace exactvo::datasets
