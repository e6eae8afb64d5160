// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/xml_file.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

#include "files/text_file.h"
#include "readers/line_reader.h"

namespace exactvo::datasets {

XmlFile::XmlFile(const std::filesystem::path& path, const std::string& file)
    : file_(file), text_(read_text_file(path)) {
  refuse_entities(text_, file_);
  refuse_zero_bytes();
  const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size());
  if (result) return;
  const auto byte = static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0));
  throw DataError(DataCode::format_syntax, file_, line_and_column(text_, byte), excerpt(text_, byte),
                  std::string("XML: ") + result.description());
}

/// pugixml takes one for the end, whatever follows.
void XmlFile::refuse_zero_bytes() const {
  const std::size_t at = text_.find('\0');
  if (at == std::string::npos) return;
  throw DataError(DataCode::format_syntax, file_, line_and_column(text_, at), "a zero byte", "XML, which has none");
}

std::string XmlFile::place_of(const pugi::xml_node& node) const {
  const std::ptrdiff_t offset = node.offset_debug();
  if (offset < 0) return node.name();
  const auto byte = static_cast<std::size_t>(offset);
  if (line_starts_.empty()) {
    line_starts_.push_back(0);
    for (std::size_t at = text_.find('\n'); at != std::string::npos; at = text_.find('\n', at + 1))
      line_starts_.push_back(at + 1);
  }
  const auto line = std::prev(std::upper_bound(line_starts_.begin(), line_starts_.end(), byte));
  return "line " + std::to_string(line - line_starts_.begin() + 1) + ", column " + std::to_string(byte - *line + 1);
}

double XmlFile::number(const pugi::xml_node& node, const char* attribute) const {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found) {
    throw DataError(DataCode::key_missing, file_, place_of(node), std::string("no attribute ") + attribute,
                    std::string(attribute) + "=\"a number\"");
  }
  return to_number(node, found.value());
}

double XmlFile::to_number(const pugi::xml_node& node, std::string_view text) const {
  try {
    return LineReader(std::string(), file_).to_number(trimmed(text));
  } catch (const DataError& error) {
    throw DataError(error.code(), file_, place_of(node), error.found(), error.expected());
  }
}

geometry::Ring XmlFile::points(const pugi::xml_object_range<pugi::xml_named_node_iterator>& nodes, const char* x,
                               const char* y) const {
  geometry::Ring ring;
  for (const pugi::xml_node node : nodes) ring.push_back({number(node, x), number(node, y)});
  return ring;
}

void XmlFile::add(RawKind kind, std::size_t number, const pugi::xml_node& node, geometry::Ring points,
                  Collector& out) const {
  out.add({kind, std::to_string(number), place_of(node), {std::move(points)}});
}

bool first_element_is(const std::string& text, const std::string& element) {
  std::size_t at = text.find('<');
  while (at != std::string::npos && at + 1 < text.size() && (text[at + 1] == '?' || text[at + 1] == '!')) {
    const bool comment = text.compare(at, 4, "<!--") == 0;
    at = text.find(comment ? "-->" : ">", at);
    if (at != std::string::npos) at = text.find('<', at);
  }
  if (at == std::string::npos || text.compare(at + 1, element.size(), element) != 0) return false;
  const std::size_t end = at + 1 + element.size();
  return end < text.size() && std::isalnum(static_cast<unsigned char>(text[end])) == 0;
}

}  // namespace exactvo::datasets
