// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/obstacle_record.h"

#include <optional>

#include "json/json_text.h"
#include "obstacles/obstacle_record_json.h"

namespace exactvo::datasets {
namespace {

using geometry::ObstacleShapes;

void append_verdict(JsonWriter& json, const char* name, const geometry::Verdict& verdict) {
  json.key(name);
  if (verdict.certified) {
    json.value(true);
  } else {
    json.value(verdict.reason);
  }
}

void append_piece(JsonWriter& json, const geometry::ConvexShape& piece) {
  if (const auto* segment = std::get_if<geometry::Segment>(&piece))
    return append_points(json, {segment->a, segment->b});
  append_points(json, std::get<geometry::ConvexPolygon>(piece).vertices);
}

void append_ellipse(JsonWriter& json, const geometry::Ellipse& e, std::optional<double> clearance = {}) {
  json.begin_inline_object().member("center", e.center);
  json.member("l11", e.l11).member("l21", e.l21).member("l22", e.l22);
  if (clearance) json.member("clearance", *clearance);
  json.end_object();
}

void append_shapes(JsonWriter& json, const ObstacleShapes& shapes) {
  json.list("facades", shapes.facades.facades, [&](const geometry::Segment& s) { append_points(json, {s.a, s.b}); });
  json.list("pieces", shapes.pieces, [&](const geometry::ConvexShape& piece) { append_piece(json, piece); });
  json.key("hull");
  append_points(json, shapes.hull.vertices);
  json.key("smallest_ellipse");
  append_ellipse(json, shapes.smallest_ellipse);
  json.list("facade_ellipses", shapes.facade_ellipses,
            [&](const geometry::FacadeEnclosure& e) { append_ellipse(json, e.ellipse, e.clearance); });
  json.member("trap_free_ellipse", shapes.trap_free.ellipse, [&](const auto& e) { append_ellipse(json, e); });
}

}  // namespace

void append_measurements(JsonWriter& json, const ObstacleShapes& shapes) {
  const geometry::ShapeMeasurements& f = shapes.measurements;
  json.member("vertices", std::uint64_t{f.vertices}).member("holes", std::uint64_t{f.holes});
  json.member("facades_count", std::uint64_t{shapes.facades.facades.size()});
  json.member("pieces_count", std::uint64_t{shapes.pieces.size()});
  json.member("area", f.area).member("perimeter", f.perimeter).member("hull_area", f.hull_area);
  json.member("ellipse_area", f.ellipse_area).member("least_ellipse_area", f.least_ellipse_area);
  // The area of the smallest ellipse over that of the obstacle; walls have no area to compare with.
  json.member("inflation", f.area > 0.0 ? std::optional(f.ellipse_area / f.area) : std::nullopt);
  json.member("deviation", shapes.facades.deviation);
  json.member("trap_free_area", f.trap_free_area).member("trap_free_beyond", f.trap_free_beyond);
}

void append_verdicts(JsonWriter& json, const ObstacleShapes& shapes) {
  json.member("certified", shapes.certified());
  json.key("verdicts").begin_object();
  append_verdict(json, "facades", shapes.facades_follow);
  append_verdict(json, "pieces", shapes.pieces_cover);
  append_verdict(json, "hull", shapes.hull_contains);
  append_verdict(json, "smallest_ellipse", shapes.ellipse_contains);
  append_verdict(json, "facade_ellipses", shapes.facade_ellipses_contain);
  json.end_object();
  const geometry::TrapFreeEllipse& free = shapes.trap_free;
  json.key("trap_free").begin_object();
  json.member("grade", free.ellipse, [&](const auto&) { json.value(name(free.grade)); });
  json.member("for_every_goal", free.for_every_goal);
  append_verdict(json, "contains", shapes.trap_free_contains);
  json.end_object();
}

std::string to_json(const RecordHead& head, const ObstacleShapes& shapes, bool geometry) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object();
  if (!head.file.empty()) json.member("file", head.file);
  if (!head.id.empty()) json.member("id", head.id);
  if (!head.outcome.empty()) json.member("outcome", head.outcome);
  json.member("valid", shapes.valid);
  json.list("problems", shapes.problems, [&](const geometry::RingProblem& p) {
    json.begin_object().member("code", code_name(p.code)).member("ring", std::uint64_t{p.ring});
    json.member("vertex", std::uint64_t{p.vertex}).member("where", p.where).member("repaired", p.repaired).end_object();
  });
  if (shapes.valid) {
    append_measurements(json, shapes);
    append_verdicts(json, shapes);
    if (geometry) append_shapes(json, shapes);
  }
  return json.end_object().take();
}

}  // namespace exactvo::datasets
