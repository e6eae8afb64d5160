// SPDX-License-Identifier: GPL-3.0-or-later
// JuPedSim geometries: <geometry> <rooms> <room> <subroom> with <polygon> walls and <obstacle>s, vertices px, py in
// metres.
#include "readers/xml_file.h"

namespace exactvo::datasets {

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

}  // namespace exactvo::datasets
