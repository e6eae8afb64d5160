// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// XML for this room, by pugixml: it expands no entities and follows no links; a file that declares entities is
/// refused.

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "readers/readers.h"

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
  /// Those of two attributes.
  geometry::Ring points(const pugi::xml_object_range<pugi::xml_named_node_iterator>& nodes, const char* x,
                        const char* y) const;
  /// Hands it on as what stands at `node`, with its number for an id.
  void add(RawKind kind, std::size_t number, const pugi::xml_node& node, geometry::Ring points, Collector& out) const;

 private:
  void refuse_zero_bytes() const;

  const std::string& file_;
  std::string text_;
  pugi::xml_document document_;
  mutable std::vector<std::size_t> line_starts_;  ///< made when the first place is asked for
};

}  // namespace exactvo::datasets
