// SPDX-License-Identifier: GPL-3.0-or-later
#include <string_view>

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
