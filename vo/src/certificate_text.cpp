// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>
#include <cstdio>
#include <limits>
#include <string_view>

#include "exactvo/vo/certificate.h"

namespace exactvo::vo {
namespace {

using geometry::hex_text;
using geometry::Vec2;

std::string text(Vec2 v) {
  return hex_text(v.x) + " " + hex_text(v.y);
}

/// Words separated by single spaces; the first that is not as expected makes everything after it fail.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  void expect(std::string_view word) { ok_ = ok_ && next() == word; }
  std::string_view next() {
    const std::size_t end = rest_.find(' ');
    const std::string_view word = rest_.substr(0, end);
    at_end_ = end == std::string_view::npos;
    rest_.remove_prefix(at_end_ ? rest_.size() : end + 1);
    return word;
  }
  double number() {
    std::string_view word = next();
    const bool negative = !word.empty() && word[0] == '-';
    if (negative) word.remove_prefix(1);
    double value = 0.0;
    if (ok_ && word == "inf" && !negative) return std::numeric_limits<double>::infinity();
    if (word.substr(0, 2) != "0x") ok_ = false;
    if (!ok_) return value;
    const char* const last = word.data() + word.size();
    const auto result = std::from_chars(word.data() + 2, last, value, std::chars_format::hex);
    ok_ = result.ec == std::errc() && result.ptr == last;
    return negative ? -value : value;
  }
  Vec2 point() {
    const double x = number();
    return {x, number()};
  }
  template <typename Integer>
  Integer integer(int base) {
    const std::string_view word = next();
    Integer value = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value, base);
    ok_ = ok_ && result.ec == std::errc() && result.ptr == word.data() + word.size();
    return value;
  }
  bool ok() const { return ok_; }
  bool finished() const { return ok_ && at_end_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
  bool at_end_ = false;
};

geometry::ConvexShape read_shape(Reader& in) {
  const std::string_view kind = in.next();
  if (kind == "disc") {
    const Vec2 center = in.point();
    return geometry::Disc{center, in.number()};
  }
  if (kind == "segment") {
    const Vec2 a = in.point();
    return geometry::Segment{a, in.point()};
  }
  if (kind == "ellipse") {
    geometry::Ellipse e;
    e.center = in.point();
    e.l11 = in.number();
    e.l21 = in.number();
    e.l22 = in.number();
    return e;
  }
  geometry::ConvexPolygon polygon;
  if (kind != "convex_polygon") in.expect("convex_polygon");
  const auto count = in.integer<std::size_t>(10);
  for (std::size_t i = 0; i < count && in.ok(); ++i) polygon.vertices.push_back(in.point());
  return polygon;
}

std::string digest_text(std::uint64_t digest) {
  char buffer[17];
  std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(digest));
  return buffer;
}

}  // namespace

std::string write_certificate(const Certificate& c) {
  const HalfPlaneClaim& claim = c.claim;
  return "half-plane-certificate 1 " + to_string(claim.shape) + " position " + text(claim.position) + " radius " +
         hex_text(claim.radius) + " horizon " + hex_text(claim.time_horizon) + " velocity " +
         text(claim.shape_velocity) + " normal " + text(claim.half_plane.normal) + " offset " +
         hex_text(claim.half_plane.offset) + " margin " + hex_text(c.margin) + " digest " + digest_text(c.digest);
}

std::optional<Certificate> read_certificate(const std::string& text) {
  Reader in(text);
  Certificate c;
  in.expect("half-plane-certificate");
  in.expect("1");
  c.claim.shape = read_shape(in);
  in.expect("position");
  c.claim.position = in.point();
  in.expect("radius");
  c.claim.radius = in.number();
  in.expect("horizon");
  c.claim.time_horizon = in.number();
  in.expect("velocity");
  c.claim.shape_velocity = in.point();
  in.expect("normal");
  c.claim.half_plane.normal = in.point();
  in.expect("offset");
  c.claim.half_plane.offset = in.number();
  in.expect("margin");
  c.margin = in.number();
  in.expect("digest");
  c.digest = in.integer<std::uint64_t>(16);
  if (!in.finished() || write_certificate(c) != text) return std::nullopt;
  return c;
}

}  // namespace exactvo::vo
