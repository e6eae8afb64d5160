// SPDX-License-Identifier: GPL-3.0-or-later
// Test suites of JTS and GEOS: <run> <case> <a>WKT</a> <b>WKT</b>. Their geometries are read, also in
// hexadecimal WKB; what is said to come out of them is not.
#include "readers/line_reader.h"
#include "readers/xml_file.h"

namespace exactvo::datasets {
namespace {

void add_argument(const XmlFile& xml, const pugi::xml_node& argument, std::size_t number, Collector& out) {
  const std::string_view text = trimmed(argument.child_value());
  const std::string place = xml.place_of(argument);
  if (text.empty()) return out.pass_over(place, "an empty argument skipped");
  const std::string id = std::to_string(number) + argument.name();
  if (is_wkb_text(text)) return read_wkb_text(text, place, id, out);
  read_wkt_text(text, place, id, out);
}

}  // namespace

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

}  // namespace exactvo::datasets
