// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// XML for this room, by pugixml: it expands no entities of a file's own and follows no links.

#include <pugixml.hpp>
#include <string>

#include "readers.h"

namespace exactvo::datasets {

class XmlFile {
 public:
  /// Throws DataError with line and column.
  XmlFile(const std::filesystem::path& path, const std::string& file);

  const pugi::xml_document& document() const { return document_; }
  std::string place_of(const pugi::xml_node& node) const;
  /// The attribute as a number. Throws DataError naming the node's place and the attribute.
  double number(const pugi::xml_node& node, const char* attribute) const;
  double to_number(const pugi::xml_node& node, std::string_view text) const;

 private:
  const std::string& file_;
  std::string text_;
  pugi::xml_document document_;
};

/// Whether `element` is the first element of the text, comments and declarations passed over.
bool first_element_is(const std::string& text, const std::string& element);

}  // namespace exactvo::datasets
