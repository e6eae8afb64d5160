// SPDX-License-Identifier: GPL-3.0-or-later
// Menge scenes: <Experiment> <ObstacleSet> <Obstacle closed="1"> <Vertex p_x p_y/>; rings unclosed, either winding.
#include "readers/xml_file.h"

namespace exactvo::datasets {

bool looks_like_menge_xml(const FormatProbe& probe) {
  return first_element_is(probe.beginning, "Experiment");
}

void read_menge_xml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  std::size_t number = 0;
  for (const pugi::xml_node set : xml.document().child("Experiment").children("ObstacleSet")) {
    for (const pugi::xml_node obstacle : set.children("Obstacle")) {
      RawGeometry raw;
      raw.id = std::to_string(number++);
      raw.place = xml.place_of(obstacle);
      raw.kind = obstacle.attribute("closed").as_bool(true) ? RawKind::polygon : RawKind::polyline;
      geometry::Ring& ring = raw.rings.emplace_back();
      for (const pugi::xml_node vertex : obstacle.children("Vertex")) {
        ring.push_back({xml.number(vertex, "p_x"), xml.number(vertex, "p_y")});
      }
      out.add(raw);
    }
  }
}

}  // namespace exactvo::datasets
