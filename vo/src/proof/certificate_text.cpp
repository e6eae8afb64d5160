// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "exactvo/geometry/shape_numbers.h"
#include "exactvo/vo/certificate.h"
#include "proof/certificate_words.h"

namespace exactvo::vo {
namespace {

using detail::digest_text;
using detail::Reader;
using geometry::hex_text;
using geometry::Vec2;

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

std::optional<geometry::ConvexShape> read_shape(const std::string& text) {
  Reader in(text);
  geometry::ConvexShape shape = read_shape(in);
  if (!in.finished() || to_string(shape) != text) return std::nullopt;
  return shape;
}

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
  c.claim.position = in.point("position");
  c.claim.radius = in.number("radius");
  c.claim.time_horizon = in.number("horizon");
  c.claim.shape_velocity = in.point("velocity");
  c.claim.half_plane.normal = in.point("normal");
  c.claim.half_plane.offset = in.number("offset");
  c.margin = in.number("margin");
  c.digest = in.digest();
  if (!in.finished() || write_certificate(c) != text) return std::nullopt;
  return c;
}

}  // namespace exactvo::vo
