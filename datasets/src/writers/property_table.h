// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The properties of features as a table, for formats that have columns: one for every name, in the order in which they
/// are met, with the narrowest type that holds all values.

#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "json/json_text.h"

namespace exactvo::datasets {

class PropertyTable {
 public:
  enum class Type { boolean, integer, real, text };
  struct Column {
    std::string key;   ///< of the property
    std::string name;  ///< of the column: the key, unless another column is called so, whatever the case
    Type type = Type::text;
  };

  /// `taken`: columns that are there already. The property "id", where there is one, fills the column `id`.
  PropertyTable(const std::vector<FeatureProperties>& properties, std::vector<std::string> taken);

  const std::vector<Column>& columns() const { return columns_; }
  /// The properties of obstacle number `k`: an object, empty where it has none.
  Json row(std::size_t k) const;
  /// Null where the row has none, or null.
  static const Json* value_in(const Json& row, const Column& column);
  /// What a string says; of anything else its JSON.
  static std::string text_of(const Json& value);
  /// The property "id", else `otherwise`.
  static std::string id_of(const Json& row, const std::string& otherwise);
  /// "property Name is column Name_2": a line for each that has another name.
  std::vector<std::string> renamed() const;

 private:
  void name_columns(std::vector<std::string> taken);

  const std::vector<FeatureProperties>& properties_;
  std::vector<Column> columns_;
};

}  // namespace exactvo::datasets
