// SPDX-License-Identifier: GPL-3.0-or-later
#include "xml_file.h"

#include <algorithm>
#include <cctype>

#include "line_reader.h"
#include "text_file.h"

namespace exactvo::datasets {

XmlFile::XmlFile(const std::filesystem::path& path, const std::string& file)
    : file_(file), text_(read_text_file(path)) {
  const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size());
  if (result) return;
  const auto byte = static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0));
  throw DataError(DataCode::format_syntax, file_, line_and_column(text_, byte), excerpt(text_, byte),
                  std::string("XML: ") + result.description());
}

std::string XmlFile::place_of(const pugi::xml_node& node) const {
  const std::ptrdiff_t byte = node.offset_debug();
  return byte < 0 ? std::string(node.name()) : line_and_column(text_, static_cast<std::size_t>(byte));
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
  const std::string place = place_of(node);
  try {
    return LineReader(text, file_).to_number(trimmed(text));
  } catch (const DataError& error) {
    throw DataError(error.code(), file_, place, error.found(), error.expected());
  }
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
