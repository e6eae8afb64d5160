// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <utility>

#include "readers/readers.h"
#include "readers/wkt_scanner.h"

namespace exactvo::datasets {
namespace {

constexpr std::array<const char*, 9> kGeometryWords{"POINT",           "LINESTRING",   "LINEARRING",
                                                    "POLYGON",         "MULTIPOINT",   "TRIANGLE",
                                                    "MULTILINESTRING", "MULTIPOLYGON", "GEOMETRYCOLLECTION"};

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
      skip_reference_system();
      geometry(0);
    } catch (const DataError& error) {
      // Collector::add throws for a bad ring as well; only what breaks the text itself is met again here.
      if (error.code() != DataCode::format_syntax && error.code() != DataCode::number &&
          error.code() != DataCode::nesting) {
        throw;
      }
      out_.reject(before_.place.empty()
                      ? error
                      : DataError(error.code(), error.file(), before_.place, error.found(), error.expected()));
      scan_.skip_to_next_geometry(start);
    }
  }

  /// "SRID=28992;" as PostGIS prints it. Units are the caller's to tell.
  void skip_reference_system() {
    if (scan_.peek_word() != "SRID") return;
    scan_.word();
    scan_.need_sign('=');
    scan_.number();
    scan_.need_sign(';');
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
  while (blocks.next()) {
    WktReader reader(blocks.text(), inside, out, place);
    reader.read_all();
    place.geometries = reader.geometries();
    place.lines += static_cast<std::size_t>(std::count(blocks.text().begin(), blocks.text().end(), '\n'));
    out.progress(blocks.share_read());
  }
}

}  // namespace

bool looks_like_wkt(const FormatProbe& probe) {
  const std::string name = "";
  WktScanner scan(probe.beginning, name);
  scan.skip_between_geometries();
  const std::string word = without_dimension(scan.peek_word());
  return word == "SRID" || std::find(kGeometryWords.begin(), kGeometryWords.end(), word) != kGeometryWords.end();
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
  Collector out(file_name, "wkt", options);
  refuse_degrees(out);
  WktReader(text, WktReader::Inside::solid, out).read_all();
  return out.take();
}

}  // namespace exactvo::datasets
