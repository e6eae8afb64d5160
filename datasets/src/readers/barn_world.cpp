// SPDX-License-Identifier: GPL-3.0-or-later
// BARN worlds (Perille et al. 2020): Gazebo SDF with upright cylinders. Each stands in the world and again in its
// recorded <state>; the first counts.
#include "readers/line_reader.h"
#include "readers/xml_file.h"

namespace exactvo::datasets {
namespace {

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

void read_barn_world(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  for (const pugi::xml_node model : xml.document().child("sdf").child("world").children("model"))
    add_model(xml, model, out);
  out.note("", "cylinders stand as polygons of 16 corners round them, 1.3 % larger in area");
}

}  // namespace exactvo::datasets
