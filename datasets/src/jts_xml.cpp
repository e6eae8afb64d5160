// SPDX-License-Identifier: GPL-3.0-or-later
// Test suites of JTS and GEOS: <run> <case> <a>WKT</a> <b>WKT</b>. Their geometries are read, what is said to come out
// of them is not. Geometry in hexadecimal WKB is refused case by case.
#include "line_reader.h"
#include "xml_file.h"

namespace exactvo::datasets {
namespace {

bool is_hexadecimal(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789abcdefABCDEF \t\r\n") == std::string_view::npos;
}

void add_argument(const XmlFile& xml, const pugi::xml_node& argument, std::size_t number, Collector& out) {
  const std::string_view text = trimmed(argument.child_value());
  const std::string place = xml.place_of(argument);
  if (text.empty()) return out.pass_over(place, "an empty argument passed over");
  if (is_hexadecimal(text)) {
    return out.reject({DataCode::format_syntax, out.file(), place, "a geometry in hexadecimal WKB",
                       "well-known text; ogr2ogr converts"});
  }
  read_wkt_text(text, place, std::to_string(number) + argument.name(), out);
}

}  // namespace

bool looks_like_jts_xml(const Glimpse& glimpse) {
  return first_element_is(glimpse.beginning, "run");
}

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
