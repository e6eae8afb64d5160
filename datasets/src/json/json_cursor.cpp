// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/json_cursor.h"

#include <limits>
#include <optional>

namespace exactvo::datasets {

namespace {

/// The pointer of a value that stands somewhere in `all`, searched by its address: only messages need it.
std::optional<std::string> pointer_to(const Json* value, const Json& all) {
  if (value == &all) return "";
  if (!all.is_structured()) return std::nullopt;
  std::size_t number = 0;
  for (auto entry = all.begin(); entry != all.end(); ++entry, ++number)
    if (const auto rest = pointer_to(value, *entry))
      return "/" + (all.is_object() ? pointer_token(entry.key()) : std::to_string(number)) + *rest;
  return std::nullopt;
}

}  // namespace

JsonCursor JsonCursor::child(const Json& value) const {
  JsonCursor cursor = *this;
  cursor.value_ = &value;
  return cursor;
}

JsonCursor JsonCursor::at(const std::string& key) const {
  if (!value_->is_object()) refuse("an object");
  const auto member = value_->find(key);
  if (member == value_->end()) refuse("the key \"" + key + "\"", DataCode::key_missing);
  return child(*member);
}

JsonCursor JsonCursor::at(std::size_t index) const {
  if (index >= size())
    refuse("at least " + std::to_string(index + 1) + (index == 0 ? " entry" : " entries"), DataCode::wrong_count);
  return child((*value_)[index]);
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
  const std::string pointer = pointer_to(value_, *root_).value_or("");
  const std::string place = place_.empty() || pointer.empty() ? place_ + pointer : place_ + ", " + pointer;
  throw DataError(code, *file_, place, described(*value_), expected);
}

}  // namespace exactvo::datasets
