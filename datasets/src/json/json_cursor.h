// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A place in a JSON value that can find out how it was reached: what it can't give it names, with file, line and
/// pointer.

#include <string>
#include <utility>
#include <vector>

#include "json/json_text.h"

namespace exactvo::datasets {

class JsonCursor {
 public:
  /// `line` is put before the pointer in messages: "line 3" in JSON Lines, "" elsewhere.
  JsonCursor(const Json& value, const std::string& file, std::string line)
      : root_(&value), value_(&value), file_(&file), place_(std::move(line)) {}

  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  bool is_null() const { return value_->is_null(); }
  JsonCursor at(const std::string& key) const;
  JsonCursor at(std::size_t index) const;
  std::size_t size() const;  ///< of a list

  double number() const;  ///< also "nan", "inf", "-inf"
  geometry::Vec2 point() const;
  std::vector<geometry::Vec2> points() const;
  const std::string& text() const;
  bool truth() const;
  std::uint64_t count() const;
  int integer() const;
  const Json& json() const { return *value_; }

  [[noreturn]] void refuse(const std::string& expected, DataCode code = DataCode::wrong_type) const;

 private:
  JsonCursor child(const Json& value) const;

  const Json* root_;
  const Json* value_;
  const std::string* file_;
  std::string place_;
};

}  // namespace exactvo::datasets
