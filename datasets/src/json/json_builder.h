// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Builds a JSON value from the events of nlohmann's parser, in time linear in the text: the library's own builders
/// compare each key with all keys before it, or look at all siblings at the end of each object.

#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "json/json_text.h"

namespace exactvo::datasets {

class JsonBuilder : public nlohmann::json_sax<Json> {
 public:
  Json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // no part of JSON

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool key(string_t& key) override {
    Open& object = open_.back();
    const std::size_t place = object.place_of(key);
    if (place < object.members().size()) {
      on_second(key);
      object.target = &object.members()[place].second;
      return true;
    }
    object.add_member(key);
    return true;
  }
  bool end_object() override { return close(); }

  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_array() override { return close(); }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 protected:
  /// Before an object or a list that `depth` others contain.
  virtual void on_open(std::size_t /*depth*/) {}
  /// At a key that the object has already. Unless this throws, the last value counts.
  virtual void on_second(const std::string& /*key*/) {}

 private:
  /// An object or a list whose end has not come yet. What contains it does not grow until then, so that it stays where
  /// it is.
  struct Open {
    Json* value;
    Json* target = nullptr;                                 ///< of an object: the value that comes next
    std::unordered_map<std::string, std::size_t> places{};  ///< of an object of many members: its keys

    using Members = Json::object_t::Container;
    Members& members() const { return value->get_ref<Json::object_t&>(); }

    /// The number of members where the key is new.
    std::size_t place_of(const std::string& key) {
      const Members& all = members();
      if (all.size() >= kFew) {
        if (places.empty())
          for (std::size_t k = 0; k < all.size(); ++k) places.emplace(all[k].first, k);
        const auto found = places.find(key);
        return found == places.end() ? all.size() : found->second;
      }
      std::size_t k = 0;
      while (k < all.size() && all[k].first != key) ++k;
      return k;
    }
    void add_member(const std::string& key) {
      Members& all = members();
      if (!places.empty()) places.emplace(key, all.size());
      all.emplace_back(key, Json());
      target = &all.back().second;
    }

    static constexpr std::size_t kFew = 16;  ///< members that are searched one by one
  };

  template <class Value>
  bool add(Value&& value) {
    place_for(Json(std::forward<Value>(value)));
    return true;
  }
  bool open(Json value) {
    on_open(open_.size());
    open_.push_back({place_for(std::move(value))});
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  Json* place_for(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back().value->is_array()) {
      auto& entries = open_.back().value->get_ref<Json::array_t&>();
      entries.push_back(std::move(value));
      return &entries.back();
    }
    *open_.back().target = std::move(value);
    return open_.back().target;
  }

  Json root_;
  std::vector<Open> open_;
};

}  // namespace exactvo::datasets
