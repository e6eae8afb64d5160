// SPDX-License-Identifier: GPL-3.0-or-later
// SUMO polygons: <poly id shape="x,y x,y ..." fill/>, in metres unless geo="1". Points of interest are no obstacles.
#include "readers/line_reader.h"
#include "readers/xml_file.h"

namespace exactvo::datasets {
namespace {

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

}  // namespace

bool looks_like_sumo_poly(const FormatProbe& probe) {
  const bool by_name = probe.path.filename().string().find(".poly.xml") != std::string::npos;
  return by_name || first_element_is(probe.beginning, "shapes") || first_element_is(probe.beginning, "additional");
}

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

}  // namespace exactvo::datasets
