// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/json_cursor.h"

#include <limits>

namespace exactvo::datasets {

JsonCursor JsonCursor::child(const Json& value, const std::string& token) const {
  JsonCursor cursor = *this;
  cursor.value_ = &value;
  cursor.pointer_ += "/" + token;
  return cursor;
}

JsonCursor JsonCursor::at(const std::string& key) const {
  if (!value_->is_object()) refuse("an object");
  const auto member = value_->find(key);
  if (member == value_->end()) refuse("the key \"" + key + "\"", DataCode::key_missing);
  return child(*member, pointer_token(key));
}

JsonCursor JsonCursor::at(std::size_t index) const {
  if (index >= size())
    refuse("at least " + std::to_string(index + 1) + (index == 0 ? " entry" : " entries"), DataCode::wrong_count);
  return child((*value_)[index], std::to_string(index));
}

std::size_t JsonCursor::size() const {
  if (!value_->is_array()) refuse("a list");
  return value_->size();
}

double JsonCursor::number() const {
  if (value_->is_number()) return value_->get<double>();
  if (*value_ == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (*value_ == "inf") return std::numeric_limits<double>::infinity();
  if (*value_ == "-inf") return -std::numeric_limits<double>::infinity();
  refuse("a number");
}

geometry::Vec2 JsonCursor::point() const {
  if (size() != 2) refuse("[x, y]", DataCode::wrong_count);
  return {at(std::size_t{0}).number(), at(std::size_t{1}).number()};
}

std::vector<geometry::Vec2> JsonCursor::points() const {
  std::vector<geometry::Vec2> list;
  for (std::size_t i = 0; i < size(); ++i) list.push_back(at(i).point());
  return list;
}

const std::string& JsonCursor::text() const {
  if (!value_->is_string()) refuse("text in quotes");
  return value_->get_ref<const std::string&>();
}

bool JsonCursor::truth() const {
  if (!value_->is_boolean()) refuse("true or false");
  return value_->get<bool>();
}

std::uint64_t JsonCursor::count() const {
  if (!value_->is_number_unsigned()) refuse("a whole number, not negative");
  return value_->get<std::uint64_t>();
}

int JsonCursor::integer() const {
  if (!value_->is_number_integer()) refuse("a whole number");
  return value_->get<int>();
}

void JsonCursor::refuse(const std::string& expected, DataCode code) const {
  const std::string place = place_.empty() || pointer_.empty() ? place_ + pointer_ : place_ + ", " + pointer_;
  throw DataError(code, *file_, place, described(*value_), expected);
}

}  // namespace exactvo::datasets
