// SPDX-License-Identifier: GPL-3.0-or-later
// JuPedSim geometries: <geometry> <rooms> <room> <subroom> with <polygon> walls and <obstacle>s, vertices px, py in
// metres.
#include "readers/xml_file.h"

namespace exactvo::datasets {
namespace {

class RoomReader {
 public:
  RoomReader(const XmlFile& xml, Collector& out) : xml_(xml), out_(out) {}

  void read(const pugi::xml_node& subroom) {
    for (const pugi::xml_node wall : subroom.children("polygon")) add(wall, RawKind::polyline);
    for (const pugi::xml_node obstacle : subroom.children("obstacle")) {
      for (const pugi::xml_node polygon : obstacle.children("polygon")) add(polygon, RawKind::polygon);
    }
  }

 private:
  void add(const pugi::xml_node& polygon, RawKind kind) {
    RawGeometry raw;
    raw.id = std::to_string(number_++);
    raw.place = xml_.place_of(polygon);
    raw.kind = kind;
    geometry::Ring& ring = raw.rings.emplace_back();
    for (const pugi::xml_node vertex : polygon.children("vertex")) {
      ring.push_back({xml_.number(vertex, "px"), xml_.number(vertex, "py")});
    }
    out_.add(raw);
  }

  const XmlFile& xml_;
  Collector& out_;
  std::size_t number_ = 0;
};

}  // namespace

bool looks_like_jupedsim_xml(const FormatProbe& probe) {
  return first_element_is(probe.beginning, "geometry");
}

void read_jupedsim_xml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  RoomReader reader(xml, out);
  for (const pugi::xml_node room : xml.document().child("geometry").child("rooms").children("room")) {
    for (const pugi::xml_node subroom : room.children("subroom")) reader.read(subroom);
  }
}

}  // namespace exactvo::datasets
