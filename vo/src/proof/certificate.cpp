// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of half-planes, made and checked in rationals: no filter, and no line shared with the construction in
// cone/. With S as in velocity_obstacle.h, the margin of { v : n.v >= c } against an obstacle of velocity u is min(0,
// tau (c - n.u)) - h_S(n); `excess` is minus that, as k + sqrt(b) + sqrt(d).
#include "exactvo/vo/certificate.h"

#include <gmpxx.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/shape_numbers.h"
#include "exactvo/geometry/vec2.h"
#include "exactvo/vo/containment.h"

namespace exactvo::vo::detail {
namespace {

// --- What the texts of certificates share: words with single blanks between them, hex floats, the digest ---

using geometry::Vec2;

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
  /// The same behind a word.
  void read(std::string_view name, double& x) {
    expect(name);
    x = number();
  }
  void read(std::string_view name, Vec2& v) {
    expect(name);
    v = point();
  }
  template <typename Integer>
  Integer integer(int base) {
    const std::string_view word = next();
    Integer value = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value, base);
    ok_ = ok_ && result.ec == std::errc() && result.ptr == word.data() + word.size();
    return value;
  }
  std::uint64_t digest() {
    expect("digest");
    return integer<std::uint64_t>(16);
  }
  bool ok() const { return ok_; }
  bool finished() const { return ok_ && at_end_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
  bool at_end_ = false;
};

std::string digest_text(std::uint64_t digest) {
  char buffer[17];
  std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(digest));
  return buffer;
}

std::uint64_t bits_of(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// FNV-1a, 64 bits, of 8-byte words, low byte first.
class Fnv {
 public:
  void add(double x) { add(bits_of(x)); }
  void add(Vec2 v) {
    add(v.x);
    add(v.y);
  }
  void add(std::uint64_t word) {
    for (int i = 0; i < 8; ++i) {
      hash_ ^= (word >> (8 * i)) & 0xFF;
      hash_ *= 0x100000001B3ULL;
    }
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

}  // namespace
}  // namespace exactvo::vo::detail

namespace exactvo::vo {
namespace {

using detail::bits_of;
using detail::Fnv;
using detail::Reader;
using geometry::Disc;
using geometry::Ellipse;
using geometry::hex_text;
using geometry::Vec2;
using Rational = mpq_class;

using geometry::kInfinity;

bool is_well_formed(const HalfPlaneClaim& c) {
  return geometry::is_valid(c.shape) && is_finite(c.position) && c.radius >= 0.0 && std::isfinite(c.radius) &&
         c.time_horizon > 0.0 && is_finite(c.shape_velocity) && is_finite(c.half_plane.normal) &&
         c.half_plane.normal != Vec2{} && std::isfinite(c.half_plane.offset);
}

// --- The support function, as k + sqrt(b) + sqrt(d) in rationals ---

struct RootSum {
  Rational k, b, d;
};

Rational square(const Rational& x) {
  return x * x;
}

RootSum support(const HalfPlaneClaim& c) {
  const Rational nx(c.half_plane.normal.x), ny(c.half_plane.normal.y), length2 = square(nx) + square(ny);
  const auto at = [&](Vec2 x) -> Rational {
    return nx * (Rational(x.x) - Rational(c.position.x)) + ny * (Rational(x.y) - Rational(c.position.y));
  };
  const Rational grown = square(Rational(c.radius)) * length2;
  if (const auto* disc = std::get_if<Disc>(&c.shape))
    return {at(disc->center), 0, square(Rational(disc->radius) + Rational(c.radius)) * length2};
  if (const auto* e = std::get_if<Ellipse>(&c.shape)) {
    const Rational x = Rational(e->l11) * nx + Rational(e->l21) * ny;
    return {at(e->center), square(x) + square(Rational(e->l22) * ny), grown};
  }
  const std::vector<Vec2> corners = corners_of(c.shape);
  Rational most = at(corners.front());
  for (const Vec2 v : corners) most = std::max(most, at(v));
  return {most, 0, grown};
}

/// h_S(normal) - min(0, tau (offset - normal.u)): minus the margin.
RootSum excess(const HalfPlaneClaim& c) {
  RootSum h = support(c);
  const Vec2 n = c.half_plane.normal;
  const Rational moved = Rational(n.x) * Rational(c.shape_velocity.x) + Rational(n.y) * Rational(c.shape_velocity.y);
  const Rational beyond = Rational(c.half_plane.offset) - moved;
  if (sgn(beyond) >= 0) return h;
  if (!std::isfinite(c.time_horizon)) return {1, 0, 0};  // the apex itself is cut into: no shape makes that true
  h.k -= Rational(c.time_horizon) * beyond;
  return h;
}

/// Sign of k + sqrt(b) + sqrt(d): for k < 0, |k| is compared with the sum of the roots by squaring twice.
int sign(const RootSum& s) {
  if (sgn(s.k) >= 0) return sgn(s.k) > 0 || sgn(s.b) > 0 || sgn(s.d) > 0 ? 1 : 0;
  const Rational rest = square(s.k) - s.b - s.d;  // against 2 sqrt(b d)
  if (sgn(rest) < 0) return 1;
  return cmp(4 * s.b * s.d, square(rest));
}

/// Whether margin <= the exact margin.
bool margin_holds(const RootSum& excess, double margin) {
  return sign({excess.k + Rational(margin), excess.b, excess.d}) <= 0;
}

/// A double near the exact margin: exact but for the roots, which are refined once in rationals (Newton's step squares
/// the relative error of 2^-52).
double approximate_margin(const RootSum& excess) {
  const auto refined = [](const Rational& x) {
    const Rational r(std::sqrt(x.get_d()));
    return sgn(r) > 0 ? Rational((r + x / r) / 2) : Rational(0);
  };
  const Rational sum = -(excess.k + refined(excess.b) + refined(excess.d));
  return sum.get_d();
}

/// Doubles that are not negative, in order: 0, 1, 2 ... as whole numbers.
double double_of(std::uint64_t bits) {
  double x = 0.0;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// The largest double <= the exact margin, which is not negative. From a guess, however wrong (a root may underflow),
/// by ever longer strides until it lies between two doubles, then by halves.
double exact_margin(const RootSum& excess) {
  const auto holds = [&](std::uint64_t bits) { return margin_holds(excess, double_of(bits)); };
  const double guess = std::clamp(approximate_margin(excess), 0.0, std::numeric_limits<double>::max());
  std::uint64_t low = 0, high = bits_of(kInfinity), stride = 1;
  if (holds(bits_of(guess))) {
    low = bits_of(guess);
    for (; stride < high - low && holds(low + stride); stride *= 2) low += stride;
    high = std::min(high, low + stride);
  } else {
    high = bits_of(guess);
    for (; stride < high && !holds(high - stride); stride *= 2) high -= stride;
    low = high - std::min(high, stride);
  }
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return double_of(low);
}

// --- Digest and text ---

/// The numbers that follow the shape, each with its word, in the order that text and digest share.
template <class Claim, class Visit>
void for_each_number(Claim& c, Visit visit) {
  visit("position", c.position);
  visit("radius", c.radius);
  visit("horizon", c.time_horizon);
  visit("velocity", c.shape_velocity);
  visit("normal", c.half_plane.normal);
  visit("offset", c.half_plane.offset);
}

std::uint64_t digest_of(const HalfPlaneClaim& c, double margin) {
  Fnv hash;
  hash.add(static_cast<std::uint64_t>(c.shape.index()));
  if (const auto* p = std::get_if<geometry::ConvexPolygon>(&c.shape))
    hash.add(static_cast<std::uint64_t>(p->vertices.size()));
  for (const double x : geometry::numbers_of(c.shape)) hash.add(x);
  for_each_number(c, [&](const char*, const auto& x) { hash.add(x); });
  hash.add(margin);
  return hash.value();
}

std::string text(double x) {
  return hex_text(x);
}
std::string text(Vec2 v) {
  return hex_text(v.x) + " " + hex_text(v.y);
}

geometry::ConvexShape read_shape(Reader& in) {
  constexpr std::string_view kKinds[] = {"disc", "segment", "convex_polygon", "ellipse"};
  constexpr std::size_t kCounts[] = {3, 4, 0, 5};
  const auto kind = static_cast<std::size_t>(std::find(std::begin(kKinds), std::end(kKinds), in.next()) - kKinds);
  if (kind == std::size(kKinds)) in.expect("a shape");
  std::vector<double> numbers;
  const auto read = [&](std::size_t count) {
    for (std::size_t i = 0; i < count && in.ok(); ++i) numbers.push_back(in.number());
  };
  if (kind == 2)
    for (auto left = in.integer<std::size_t>(10); left > 0 && in.ok(); --left) read(2);
  else if (in.ok())
    read(kCounts[kind]);
  return geometry::shape_of(kind, numbers).value_or(geometry::Disc{});
}

}  // namespace

bool is_true(const HalfPlaneClaim& claim) {
  return is_well_formed(claim) && sign(excess(claim)) <= 0;
}

std::optional<Certificate> certify(const HalfPlaneClaim& claim) {
  if (!is_well_formed(claim)) return std::nullopt;
  const RootSum e = excess(claim);
  if (sign(e) > 0) return std::nullopt;
  const double margin = exact_margin(e);
  return Certificate{claim, margin, digest_of(claim, margin)};
}

Verdict check(const Certificate& c) {
  if (!is_well_formed(c.claim) || !std::isfinite(c.margin)) return Verdict::malformed;
  const RootSum e = excess(c.claim);
  const bool holds = c.margin >= 0.0 && margin_holds(e, c.margin);
  if (!holds || margin_holds(e, std::nextafter(c.margin, kInfinity))) return Verdict::wrong_margin;
  return digest_of(c.claim, c.margin) == c.digest ? Verdict::valid : Verdict::altered;
}

const char* name(Verdict verdict) {
  constexpr const char* kNames[] = {"valid", "malformed", "altered", "wrong margin"};
  return kNames[static_cast<int>(verdict)];
}

std::optional<geometry::ConvexShape> read_shape(const std::string& text) {
  Reader in(text);
  geometry::ConvexShape shape = read_shape(in);
  if (!in.finished() || to_string(shape) != text) return std::nullopt;
  return shape;
}

std::string write_certificate(const Certificate& c) {
  std::string out = "half-plane-certificate 1 " + to_string(c.claim.shape);
  const auto add = [&](const char* word, const auto& x) { out.append(" ").append(word).append(" ").append(text(x)); };
  for_each_number(c.claim, add);
  add("margin", c.margin);
  return out + " digest " + detail::digest_text(c.digest);
}

std::optional<Certificate> read_certificate(const std::string& text) {
  Reader in(text);
  Certificate c;
  in.expect("half-plane-certificate");
  in.expect("1");
  c.claim.shape = read_shape(in);
  for_each_number(c.claim, [&](const char* word, auto& x) { in.read(word, x); });
  in.read("margin", c.margin);
  c.digest = in.digest();
  if (!in.finished() || write_certificate(c) != text) return std::nullopt;
  return c;
}

// --- Ellipses that hold points ---

namespace {

bool is_well_formed(const Ellipse& e, const std::vector<Vec2>& points) {
  const auto finite = [](Vec2 x) { return is_finite(x); };
  return is_finite(e.center) && std::isfinite(e.l11) && std::isfinite(e.l21) && std::isfinite(e.l22) && e.l11 != 0.0 &&
         e.l22 != 0.0 && !points.empty() && std::all_of(points.begin(), points.end(), finite);
}

/// 1 - |L^-1 (x - c)|^2 by forward substitution.
Rational room(const Ellipse& e, Vec2 x) {
  const Rational first = (Rational(x.x) - Rational(e.center.x)) / Rational(e.l11);
  const Rational second = (Rational(x.y) - Rational(e.center.y) - Rational(e.l21) * first) / Rational(e.l22);
  return 1 - first * first - second * second;
}

Rational least_room(const Ellipse& e, const std::vector<Vec2>& points) {
  Rational least = room(e, points.front());
  for (const Vec2 x : points) least = std::min(least, room(e, x));
  return least;
}

std::uint64_t digest_of(const Containment& c) {
  detail::Fnv hash;
  for (const double x : geometry::numbers_of(c.ellipse)) hash.add(x);
  hash.add(static_cast<std::uint64_t>(c.points.size()));
  for (const Vec2 x : c.points) hash.add(x);
  hash.add(c.margin);
  return hash.value();
}

}  // namespace

std::optional<Containment> certify_containment(const Ellipse& ellipse, std::vector<Vec2> points) {
  if (!is_well_formed(ellipse, points)) return std::nullopt;
  const Rational least = least_room(ellipse, points);
  if (sgn(least) < 0) return std::nullopt;
  Containment c{ellipse, std::move(points), least.get_d(), 0};  // get_d truncates: down, as it is not negative
  c.digest = digest_of(c);
  return c;
}

Verdict check(const Containment& c) {
  if (!is_well_formed(c.ellipse, c.points) || !std::isfinite(c.margin)) return Verdict::malformed;
  const Rational least = least_room(c.ellipse, c.points);
  if (c.margin < 0.0 || sgn(least) < 0 || least.get_d() != c.margin) return Verdict::wrong_margin;
  return digest_of(c) == c.digest ? Verdict::valid : Verdict::altered;
}

std::string write_containment(const Containment& c) {
  std::string text = "containment-certificate 1 " + to_string(geometry::ConvexShape{c.ellipse}) + " points " +
                     geometry::to_string(c.points);
  return text + " margin " + hex_text(c.margin) + " digest " + detail::digest_text(c.digest);
}

std::optional<Containment> read_containment(const std::string& text) {
  detail::Reader in(text);
  Containment c;
  for (const char* word : {"containment-certificate", "1", "ellipse"}) in.expect(word);
  c.ellipse.center = in.point();
  for (double* number : {&c.ellipse.l11, &c.ellipse.l21, &c.ellipse.l22}) *number = in.number();
  in.expect("points");
  const auto count = in.integer<std::size_t>(10);
  for (std::size_t k = 0; k < count && in.ok(); ++k) c.points.push_back(in.point());
  in.read("margin", c.margin);
  c.digest = in.digest();
  if (!in.finished() || write_containment(c) != text) return std::nullopt;
  return c;
}

}  // namespace exactvo::vo
