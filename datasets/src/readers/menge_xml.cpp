// SPDX-License-Identifier: GPL-3.0-or-later
// Menge scenes: <Experiment> <ObstacleSet> <Obstacle closed="1"> <Vertex p_x p_y/>; rings unclosed, either winding.
#include "readers/xml_file.h"

namespace exactvo::datasets {

void read_menge_xml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  std::size_t number = 0;
  for (const pugi::xml_node set : xml.document().child("Experiment").children("ObstacleSet")) {
    for (const pugi::xml_node obstacle : set.children("Obstacle")) {
      const RawKind kind = obstacle.attribute("closed").as_bool(true) ? RawKind::polygon : RawKind::polyline;
      xml.add(kind, number++, obstacle, xml.points(obstacle.children("Vertex"), "p_x", "p_y"), out);
    }
  }
}

}  // namespace exactvo::datasets
