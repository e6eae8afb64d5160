// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/codec.h"

namespace exactvo::datasets {

void append_value(JsonWriter& json, const geometry::ConvexShape& shape) {
  json.begin_object();
  if (const auto* disc = std::get_if<geometry::Disc>(&shape)) json.member("disc", *disc);
  if (const auto* segment = std::get_if<geometry::Segment>(&shape))
    json.member("segment", std::vector{segment->a, segment->b});
  if (const auto* polygon = std::get_if<geometry::ConvexPolygon>(&shape)) json.member("polygon", polygon->vertices);
  if (const auto* ellipse = std::get_if<geometry::Ellipse>(&shape)) json.member("ellipse", *ellipse);
  json.end_object();
}

void read_value(const JsonCursor& at, geometry::ConvexShape& shape) {
  if (at.has("disc")) {
    at.member("disc", shape.emplace<geometry::Disc>());
  } else if (at.has("segment")) {
    std::vector<geometry::Vec2> ends;
    at.member("segment", ends);
    if (ends.size() != 2) at.at("segment").refuse("two points", DataCode::wrong_count);
    shape = geometry::Segment{ends[0], ends[1]};
  } else if (at.has("polygon")) {
    at.member("polygon", shape.emplace<geometry::ConvexPolygon>().vertices);
  } else {
    at.member("ellipse", shape.emplace<geometry::Ellipse>());
  }
  at.end_of_object();
}

}  // namespace exactvo::datasets
