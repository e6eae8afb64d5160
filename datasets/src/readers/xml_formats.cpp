// SPDX-License-Identifier: GPL-3.0-or-later
// The formats in XML whose elements are obstacles.
#include <utility>

#include "exactvo/geometry/counted.h"
#include "obstacles/courses.h"
#include "readers/line_reader.h"
#include "readers/xml_file.h"

namespace exactvo::datasets {
namespace {

/// <a> or <b> of a case of JTS.
void add_argument(const XmlFile& xml, const pugi::xml_node& argument, std::size_t number, Collector& out) {
  const std::string_view text = trimmed(argument.child_value());
  const std::string place = xml.place_of(argument);
  if (text.empty()) return out.pass_over(place, "an empty argument skipped");
  const std::string id = std::to_string(number) + argument.name();
  if (is_wkb_text(text)) return read_wkb_text(text, place, id, out);
  read_wkt_text(text, place, id, out);
}

/// The ring of a polygon of SUMO.
geometry::Ring to_ring(const XmlFile& xml, const pugi::xml_node& poly, const std::string& file) {
  geometry::Ring ring;
  for (const std::string_view pair : words_of(poly.attribute("shape").value())) {
    const std::vector<std::string_view> xy = fields_of(pair, ',');
    if (xy.size() < 2 || xy.size() > 3) {
      throw DataError(DataCode::wrong_count, file, xml.place_of(poly), "\"" + std::string(pair.substr(0, 40)) + "\"",
                      "x,y");
    }
    ring.push_back({xml.to_number(poly, xy[0]), xml.to_number(poly, xy[1])});
  }
  return ring;
}

RawGeometry to_raw(const XmlFile& xml, const pugi::xml_node& poly, const std::string& file) {
  if (poly.attribute("geo").as_bool(false)) {
    throw DataError(DataCode::projection, file, xml.place_of(poly), "geo=\"1\", degrees", "metres");
  }
  const std::string id = poly.attribute("id").value();
  const geometry::Ring ring = to_ring(xml, poly, file);
  const bool closed = ring.size() > 2 && ring.front() == ring.back();
  const bool solid = closed || poly.attribute("fill").as_bool(false);
  return {solid ? RawKind::polygon : RawKind::polyline, id, xml.place_of(poly) + ", poly " + id, {ring}};
}

/// Whether a ring of Menge runs clockwise. Rounding may misjudge a sliver.
bool runs_clockwise(const geometry::Ring& ring) {
  double doubled_area = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k)
    doubled_area += cross(ring[k] - ring[0], ring[(k + 1) % ring.size()] - ring[0]);
  return doubled_area < 0.0;
}

/// The position of a model of BARN.
geometry::Vec2 position_of(const XmlFile& xml, const pugi::xml_node& model) {
  const pugi::xml_node pose = model.child("pose");
  const std::vector<std::string_view> words = words_of(pose.child_value());
  if (words.size() < 2) return {};
  return {xml.to_number(pose, words[0]), xml.to_number(pose, words[1])};
}

void add_model(const XmlFile& xml, const pugi::xml_node& model, Collector& out) {
  const pugi::xml_node shape = model.child("link").child("collision").child("geometry");
  const pugi::xml_node radius = shape.child("cylinder").child("radius");
  if (!radius)
    return out.pass_over(xml.place_of(model),
                         std::string("model ") + model.attribute("name").value() + " skipped: no cylinder");
  const std::string id = model.attribute("name").value();
  const double r = xml.to_number(radius, radius.child_value());
  out.add({RawKind::polygon, id, xml.place_of(model) + ", model " + id, {polygon_round(position_of(xml, model), r)}});
}

}  // namespace

/// Menge scenes: <Experiment> <ObstacleSet> <Obstacle closed="1"> <Vertex p_x p_y/>; rings unclosed. What is closed and
/// runs counter-clockwise is solid; clockwise it is a wall round a room, whose inside is free.
void read_menge_xml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  std::size_t number = 0, rooms = 0;
  for (const pugi::xml_node set : xml.document().child("Experiment").children("ObstacleSet")) {
    for (const pugi::xml_node obstacle : set.children("Obstacle")) {
      const bool is_closed = obstacle.attribute("closed").as_bool(true);
      geometry::Ring points = xml.points(obstacle.children("Vertex"), "p_x", "p_y");
      const bool is_room = is_closed && runs_clockwise(points);
      if (is_room) points = closed(std::move(points));
      rooms += is_room ? 1 : 0;
      xml.add(is_closed && !is_room ? RawKind::polygon : RawKind::polyline, number++, obstacle, std::move(points), out);
    }
  }
  if (rooms > 0)
    out.note("", geometry::counted(rooms, "clockwise obstacle") +
                     " read as walls round rooms: in Menge the inside of a clockwise obstacle is free");
}

/// JuPedSim geometries: <geometry> <rooms> <room> <subroom> with <polygon> walls and <obstacle>s, vertices px, py in
/// metres.
void read_jupedsim_xml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  std::size_t number = 0;
  const auto add = [&](const pugi::xml_node& polygon, RawKind kind) {
    xml.add(kind, number++, polygon, xml.points(polygon.children("vertex"), "px", "py"), out);
  };
  for (const pugi::xml_node room : xml.document().child("geometry").child("rooms").children("room")) {
    for (const pugi::xml_node subroom : room.children("subroom")) {
      for (const pugi::xml_node wall : subroom.children("polygon")) add(wall, RawKind::polyline);
      for (const pugi::xml_node obstacle : subroom.children("obstacle"))
        for (const pugi::xml_node polygon : obstacle.children("polygon")) add(polygon, RawKind::polygon);
    }
  }
}

/// Test suites of JTS and GEOS: <run> <case> <a>WKT</a> <b>WKT</b>. Their geometries are read, also in
/// hexadecimal WKB; what is said to come out of them is not.
void read_jts_xml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  std::size_t number = 0;
  for (const pugi::xml_node each : xml.document().child("run").children("case")) {
    for (const char* name : {"a", "b"}) {
      if (const pugi::xml_node argument = each.child(name)) add_argument(xml, argument, number, out);
    }
    ++number;
  }
}

bool looks_like_sumo_poly(const FormatProbe& probe) {
  const bool by_name = probe.path.filename().string().find(".poly.xml") != std::string::npos;
  return by_name || first_element_is(probe.beginning, "shapes") || first_element_is(probe.beginning, "additional");
}

/// SUMO polygons: <poly id shape="x,y x,y ..." fill/>, in metres unless geo="1". Points of interest are no obstacles.
void read_sumo_poly(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  for (const pugi::xml_node shape : xml.document().document_element().children()) {
    if (std::string_view(shape.name()) == "poi") {
      out.pass_over(xml.place_of(shape), "a poi skipped: points are no obstacles");
    }
    if (std::string_view(shape.name()) != "poly") continue;
    try {
      out.add(to_raw(xml, shape, out.file()));
    } catch (const DataError& error) {
      if (error.code() != DataCode::wrong_count && error.code() != DataCode::number &&
          error.code() != DataCode::projection) {
        throw;
      }
      out.reject(error);
    }
  }
}

/// BARN worlds (Perille et al. 2020): Gazebo SDF with upright cylinders. Each stands in the world and again in its
/// recorded <state>; the first counts.
void read_barn_world(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  for (const pugi::xml_node model : xml.document().child("sdf").child("world").children("model"))
    add_model(xml, model, out);
  out.note("", "cylinders stand as polygons of 16 corners round them, 1.3 % larger in area");
}

}  // namespace exactvo::datasets
