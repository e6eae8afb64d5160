// SPDX-License-Identifier: GPL-3.0-or-later
#include "writers/property_table.h"

#include <boost/algorithm/string/join.hpp>
#include <map>
#include <set>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "files/file_names.h"
#include "writers/writers.h"

namespace exactvo::datasets {
namespace {

using Type = PropertyTable::Type;

Json parsed(const std::string& members) {
  Json row = members.empty() ? Json::object() : Json::parse(members, nullptr, false);
  return row.is_object() ? row : Json::object();
}

Type type_of(const Json& value) {
  if (value.is_boolean()) return Type::boolean;
  // What is beyond 64 bits with a sign is no integer that a column holds.
  const bool fits = value.is_number_integer() && !(value.is_number_unsigned() && value.get<std::uint64_t>() >> 63 != 0);
  if (fits) return Type::integer;
  return value.is_number() ? Type::real : Type::text;
}

/// The narrowest that holds both.
Type wider(Type a, Type b) {
  if (a == b) return a;
  const auto is_number = [](Type t) { return t == Type::integer || t == Type::real; };
  return is_number(a) && is_number(b) ? Type::real : Type::text;
}

constexpr const char* kId = "id";

}  // namespace

PropertyTable::PropertyTable(const std::vector<FeatureProperties>& properties, std::vector<std::string> taken)
    : properties_(properties) {
  std::map<std::string, std::size_t> number_of;
  std::vector<bool> is_typed;
  for (const FeatureProperties& of_one : properties) {
    const Json row = parsed(of_one.members);
    for (const auto& [key, value] : row.items()) {
      if (key == kId) continue;
      const auto [at, is_new] = number_of.emplace(key, columns_.size());
      if (is_new) {
        columns_.push_back({key, key, Type::text});
        is_typed.push_back(false);
      }
      if (value.is_null()) continue;
      Type& type = columns_[at->second].type;
      type = is_typed[at->second] ? wider(type, type_of(value)) : type_of(value);
      is_typed[at->second] = true;
    }
  }
  name_columns(std::move(taken));
}

void PropertyTable::name_columns(std::vector<std::string> taken) {
  std::set<std::string> names;
  for (const std::string& name : taken) names.insert(lower_case(name));
  for (Column& column : columns_) {
    if (column.name.empty()) column.name = "property";
    const std::string wanted = column.name;
    for (int number = 2; !names.insert(lower_case(column.name)).second; ++number)
      column.name = wanted + "_" + std::to_string(number);
  }
}

Json PropertyTable::row(std::size_t k) const {
  return k < properties_.size() ? parsed(properties_[k].members) : Json::object();
}

const Json* PropertyTable::value_in(const Json& row, const Column& column) {
  const auto found = row.find(column.key);
  return found == row.end() || found->is_null() ? nullptr : &*found;
}

std::string PropertyTable::text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string PropertyTable::id_of(const Json& row, const std::string& otherwise) {
  const auto found = row.find(kId);
  return found == row.end() || found->is_null() ? otherwise : text_of(*found);
}

std::vector<std::string> PropertyTable::renamed() const {
  std::vector<std::string> lines;
  for (const Column& column : columns_) {
    if (column.name != column.key)
      lines.push_back("the name of property \"" + column.key + "\": its column is called \"" + column.name + "\"");
  }
  return lines;
}

void add_losses(const WriteOptions& options, const char* format, std::vector<std::string>& losses) {
  constexpr std::size_t kMostNamed = 8;
  std::set<std::string> known;
  std::vector<std::string> names;
  std::size_t features = 0;
  std::size_t ids = 0;
  for (const FeatureProperties& of_one : options.properties) {
    const Json row = parsed(of_one.members);
    features += row.empty() ? 0 : 1;
    ids += of_one.id.empty() ? 0 : 1;
    for (const auto& [key, value] : row.items()) {
      if (known.insert(key).second) names.push_back(key);
    }
  }
  const std::string reason = std::string(": ") + format + " has no place for them";
  if (!names.empty()) {
    const std::size_t count = names.size();
    if (count > kMostNamed) {
      names.resize(kMostNamed);
      names.push_back("and " + std::to_string(count - kMostNamed) + " more");
    }
    losses.push_back(geometry::counted(count, "property", "properties") + " (" + boost::join(names, ", ") + ") of " +
                     geometry::counted(features, "obstacle") + reason);
  }
  if (ids > 0) losses.push_back(geometry::counted(ids, "feature id") + reason);
  add_plane_losses(options, format, losses);
}

void add_plane_losses(const WriteOptions& options, const char* format, std::vector<std::string>& losses) {
  const LocalPlane& plane = options.plane;
  if (!plane.is_placed()) return;
  std::string where = "a reference system";
  if (plane.origin)
    where = "longitude " + number_text(plane.origin->longitude) + ", latitude " + number_text(plane.origin->latitude);
  losses.push_back("where (0, 0) lies on earth (" + where + "): " + format + " has no place for it");
}

}  // namespace exactvo::datasets
