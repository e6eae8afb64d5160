// SPDX-License-Identifier: GPL-3.0-or-later
// Well-known binary in hexadecimal digits, as databases and test suites print it: both byte orders, Z and M by either
// convention (ISO's thousands, PostGIS's flags), SRID.
#include <algorithm>
#include <boost/algorithm/hex.hpp>
#include <boost/endian/conversion.hpp>
#include <cctype>
#include <iterator>
#include <utility>

#include "readers/line_reader.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

/// Pairs of digits; a byte that lacks its half is dropped, and missed by the reader. REQUIRES: digits and white space.
std::string bytes_of(std::string_view text) {
  std::string digits, bytes;
  std::copy_if(text.begin(), text.end(), std::back_inserter(digits), [](unsigned char c) { return std::isxdigit(c); });
  digits.resize(digits.size() / 2 * 2);
  boost::algorithm::unhex(digits, std::back_inserter(bytes));
  return bytes;
}

class WkbReader {
 public:
  WkbReader(std::string bytes, std::string place, std::string id, Collector& out)
      : bytes_(std::move(bytes)), place_(std::move(place)), id_(std::move(id)), out_(out) {}

  void geometry(int depth = 0) {
    if (depth > kDeepestCollection) refuse(DataCode::nesting, "deeper nesting", "collections at most 64 deep");
    const Head head = this->head();
    switch (head.kind) {
      case 1:
        point(head);
        return out_.pass_over(place_, "a point skipped: points are no obstacles");
      case 2:
        return hand_on(RawKind::polyline, {points(head)});
      case 3:
        return hand_on(RawKind::polygon, rings(head));
      case 4:
      case 5:
      case 6:
      case 7:
        return parts(depth);
      default:
        refuse(DataCode::format_syntax, "geometry of type " + std::to_string(head.kind), "types 1 to 7");
    }
  }

 private:
  struct Head {
    std::uint32_t kind;
    std::size_t extra;  ///< coordinates beyond x and y
  };

  Head head() {
    little_endian_ = take(1)[0] != 0;
    const std::uint32_t word = integer();
    constexpr std::uint32_t kZ = 0x80000000U, kM = 0x40000000U, kSrid = 0x20000000U;
    const std::uint32_t srid = (word & kSrid) != 0 ? integer() : 0;
    if (is_first_) out_.reference_system(static_cast<int>(srid), place_);
    is_first_ = false;
    const std::uint32_t iso = word & 0x1fffffffU;
    const std::uint32_t dimension = iso / 1000;  // 1: Z, 2: M, 3: both
    const std::size_t by_iso = dimension == 3 ? 2 : dimension == 0 ? 0 : 1;
    const std::size_t by_flags = ((word & kZ) != 0 ? 1U : 0U) + ((word & kM) != 0 ? 1U : 0U);
    return {iso % 1000, std::max(by_iso, by_flags)};
  }

  void parts(int depth) {
    constexpr std::size_t kLeastGeometry = 5;  // byte order and type
    for (std::size_t n = count(kLeastGeometry); n > 0; --n) geometry(depth + 1);
  }

  std::vector<geometry::Ring> rings(const Head& head) {
    std::vector<geometry::Ring> all;
    for (std::size_t n = count(4); n > 0; --n) all.push_back(points(head));
    return all;
  }

  geometry::Ring points(const Head& head) {
    geometry::Ring ring(count(8 * (2 + head.extra)));
    for (geometry::Vec2& p : ring) p = point(head);
    return ring;
  }

  geometry::Vec2 point(const Head& head) {
    const double x = number();
    const geometry::Vec2 p{x, number()};
    for (std::size_t k = 0; k < head.extra; ++k) number();
    return p;
  }

  /// Reads how many things follow, each of at least `bytes_each` bytes; refuses more than the rest of the bytes can
  /// hold.
  std::size_t count(std::size_t bytes_each) {
    const std::size_t n = integer();
    if (n > (bytes_.size() - at_) / bytes_each)
      refuse(DataCode::size, std::to_string(n) + " parts", "no more than the bytes hold");
    return n;
  }

  std::uint32_t integer() { return in_order<std::uint32_t>(); }
  double number() { return in_order<double>(); }

  template <class T>
  T in_order() {
    using boost::endian::order;
    const auto* bytes = reinterpret_cast<const unsigned char*>(take(sizeof(T)).data());
    return little_endian_ ? boost::endian::endian_load<T, sizeof(T), order::little>(bytes)
                          : boost::endian::endian_load<T, sizeof(T), order::big>(bytes);
  }

  std::string_view take(std::size_t n) {
    if (bytes_.size() - at_ < n) refuse(DataCode::format_syntax, "the end of the bytes", "more of the geometry");
    at_ += n;
    return std::string_view(bytes_).substr(at_ - n, n);
  }

  [[noreturn]] void refuse(DataCode code, const std::string& found, const std::string& expected) const {
    throw DataError(code, out_.file(), place_, found, expected);
  }

  void hand_on(RawKind kind, std::vector<geometry::Ring> rings) {
    const RawGeometry raw = part_of_geometry(part_++, kind, id_, place_, std::move(rings));
    if (raw.rings.empty() || raw.rings.front().empty()) return out_.pass_over(raw.place, "an empty geometry skipped");
    out_.add(raw);
  }

  std::string bytes_;
  std::string place_;
  std::string id_;
  Collector& out_;
  std::size_t at_ = 0;
  std::size_t part_ = 0;
  bool little_endian_ = true;
  bool is_first_ = true;  ///< the parts of a geometry have no system of their own
};

}  // namespace

bool is_wkb_text(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const bool has_byte_order = text.substr(0, 2) == "00" || text.substr(0, 2) == "01";
  return has_byte_order && text.find_first_not_of("0123456789abcdefABCDEF \t\r\n") == std::string_view::npos;
}

int srid_of_wkb_text(std::string_view text) {
  constexpr std::size_t kHead = 9, kDigits = 2 * kHead;  // byte order, type, SRID
  constexpr std::uint32_t kSrid = 0x20000000U;
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const std::string bytes = bytes_of(text.substr(0, kDigits));
  if (bytes.size() < kHead) return 0;
  const auto number_at = [&](std::size_t at) {
    const auto* place = reinterpret_cast<const unsigned char*>(bytes.data() + at);
    return bytes[0] != 0 ? boost::endian::load_little_u32(place) : boost::endian::load_big_u32(place);
  };
  return (number_at(1) & kSrid) != 0 ? static_cast<int>(number_at(5)) : 0;
}

void read_wkb_text(std::string_view text, const std::string& place, const std::string& id, Collector& out) {
  try {
    WkbReader(bytes_of(text), place, id, out).geometry();
  } catch (const DataError& error) {
    // Collector::add throws for a bad ring as well; only what breaks the bytes themselves is met again here.
    if (error.code() != DataCode::format_syntax && error.code() != DataCode::size &&
        error.code() != DataCode::nesting && error.code() != DataCode::projection)
      throw;
    out.reject(error);
  }
}

}  // namespace exactvo::datasets
