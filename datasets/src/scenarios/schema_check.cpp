// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenarios/schema_check.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "exactvo/geometry/nearest_word.h"

namespace exactvo::datasets {
namespace {

class Checker {
 public:
  /// What a reference of the schema, "#/definitions/point", stands for.
  using Definitions = std::function<const Json&(const std::string& reference)>;

  /// Checks parts of `all`.
  Checker(const Definitions& definitions, const Json& all, const std::string& file)
      : definitions_(definitions), all_(all), file_(file) {}

  void check(const Json& value, const Json& schema) const {
    const Json& rules = resolved(schema);
    for (const auto& [keyword, rule] : rules.items()) apply(keyword, rule, value, rules);
  }

 private:
  using Rule = void (Checker::*)(const Json& rule, const Json& value, const Json& rules) const;
  using Keyword = std::pair<const char*, Rule>;
  static const std::vector<Keyword>& keywords();

  void apply(const std::string& keyword, const Json& rule, const Json& value, const Json& rules) const {
    for (const auto& [known, check] : keywords()) {
      if (keyword != known) continue;
      if (check != nullptr) (this->*check)(rule, value, rules);
      return;
    }
    throw std::logic_error("schema keyword not supported: " + keyword);
  }

  const Json& resolved(const Json& schema) const {
    const auto reference = schema.find("$ref");
    if (reference == schema.end()) return schema;
    const Json*& known = resolved_[&*reference];
    if (known == nullptr) known = &definitions_(reference->get_ref<const std::string&>());
    return *known;
  }

  [[noreturn]] void refuse(DataCode code, const Json& value, const std::string& found,
                           const std::string& expected) const {
    throw DataError(code, file_, pointer_to(value, all_), found, expected);
  }

  /// The unit or the shape that a description begins or ends with: "m" of "m; robots farther apart ignore each other.",
  /// "[x, y], m". The rest of it is for those who read the schema.
  static std::string unit_in(const std::string& description) {
    static const std::set<std::string> kUnits{"m", "s", "m/s", "m/s^2", "1/s", "1/s^2"};
    const std::string head = description.substr(0, description.find(';'));
    if (kUnits.count(head) > 0 || (head.front() == '[' && head.find("], ") != std::string::npos)) return head;
    const std::string tail = head.substr(head.find_last_of(" ,") + 1);
    return kUnits.count(tail) > 0 ? tail : "";
  }

  /// "a number (m)".
  static std::string with_unit(const std::string& text, const Json& rules) {
    const auto words = rules.find("description");
    if (words == rules.end()) return text;
    const std::string unit = unit_in(words->get<std::string>());
    return unit.empty() ? text : text + " (" + unit + ")";
  }

  struct Type {
    const char* name;
    bool (Json::*holds)() const noexcept;
    const char* words;
  };
  static const Type& type_named(const std::string& name) {
    static constexpr Type kTypes[] = {{"object", &Json::is_object, "an object"},
                                      {"array", &Json::is_array, "a list"},
                                      {"string", &Json::is_string, "text in quotes"},
                                      {"number", &Json::is_number, "a number"},
                                      {"integer", &Json::is_number_integer, "a whole number"},
                                      {"boolean", &Json::is_boolean, "true or false"},
                                      {"null", &Json::is_null, "null"}};
    for (const Type& type : kTypes)
      if (name == type.name) return type;
    throw std::logic_error("schema type not supported: " + name);
  }

  void type(const Json& rule, const Json& value, const Json& rules) const {
    std::string expected;
    const auto is_met = [&](const Json& alternative) {
      const Type& wanted = type_named(alternative.get_ref<const std::string&>());
      expected += std::string(expected.empty() ? "" : " or ") + wanted.words;
      return (value.*wanted.holds)();
    };
    if (rule.is_array() ? std::any_of(rule.begin(), rule.end(), is_met) : is_met(rule)) return;
    if (value.is_object() && rules.contains("items")) expected += of_entries(rules.at("items"));
    refuse(DataCode::wrong_type, value, described(value), with_unit(expected, rules));
  }

  /// The keys of each object of a list. An entry alone is often written in the place of the list.
  std::string of_entries(const Json& schema) const {
    const Json& entry = resolved(schema);
    std::string keys;
    if (entry.contains("oneOf")) {
      for (const Json& reference : entry.at("oneOf"))
        keys += (keys.empty() ? "" : ", or ") + listed_keys(resolved(reference));
    } else if (entry.contains("required")) {
      keys = listed_keys(entry);
    }
    return keys.empty() ? "" : " [{...}] of objects with " + keys;
  }

  void one_of_words(const Json& rule, const Json& value, const Json&) const {
    if (std::find(rule.begin(), rule.end(), value) != rule.end()) return;
    std::string options;
    for (const Json& option : rule) options += (options.empty() ? "" : ", ") + option.dump();
    refuse(DataCode::not_an_option, value, described(value), "one of " + options);
  }

  void required(const Json& rule, const Json& value, const Json& rules) const {
    if (!value.is_object()) return;
    for (const Json& key : rule) {
      const std::string name = key.get<std::string>();
      if (!value.contains(name)) refuse_missing(name, value, rules);
    }
  }

  /// A mistyped key leaves one key missing and one unknown; the unknown one tells the writer more.
  [[noreturn]] void refuse_missing(const std::string& name, const Json& value, const Json& rules) const {
    if (rules.contains("properties") && rules.contains("additionalProperties")) {
      only_known_keys(rules.at("additionalProperties"), value, rules);
    }
    refuse(DataCode::key_missing, value, "no key \"" + name + "\"", "the key \"" + name + "\"");
  }

  void properties(const Json& rule, const Json& value, const Json&) const {
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
      const auto known = rule.find(key);
      if (known != rule.end()) check(member, *known);
    }
  }

  void only_known_keys(const Json& rule, const Json& value, const Json& rules) const {
    if (rule != false) throw std::logic_error("schema: additionalProperties other than false is not supported");
    if (!value.is_object()) return;
    const Json& properties = rules.at("properties");
    for (const auto& [key, member] : value.items()) {
      if (properties.contains(key)) continue;
      std::vector<std::string> known;
      for (const auto& [name, property] : properties.items()) known.push_back(name);
      refuse_unknown(value, key, known);
    }
  }

  [[noreturn]] void refuse_unknown(const Json& value, const std::string& key,
                                   const std::vector<std::string>& known) const {
    std::vector<std::string> missing;  // a key that is there already was not meant
    std::copy_if(known.begin(), known.end(), std::back_inserter(missing),
                 [&](const std::string& name) { return !value.contains(name); });
    const std::string nearest = geometry::nearest_word(key, missing);
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
    refuse(DataCode::key_unknown, value.at(key), "an unknown key \"" + key + "\"",
           nearest.empty() ? "one of " + all : "a known key; did you mean \"" + nearest + "\"?");
  }

  void items(const Json& rule, const Json& value, const Json&) const {
    if (!value.is_array()) return;
    for (std::size_t i = 0; i < value.size(); ++i) check(value[i], rule);
  }

  /// "at least 1 entry", "at most 3 entries"
  static std::string counted(const std::string& limit, const Json& count, const char* one, const char* many) {
    return limit + " " + count.dump() + " " + (count == 1 ? one : many);
  }

  void min_items(const Json& rule, const Json& value, const Json& rules) const {
    if (!value.is_array() || value.size() >= rule.get<std::size_t>()) return;
    refuse(DataCode::wrong_count, value, described(value),
           with_unit(counted("at least", rule, "entry", "entries"), rules));
  }

  void max_items(const Json& rule, const Json& value, const Json& rules) const {
    if (!value.is_array() || value.size() <= rule.get<std::size_t>()) return;
    refuse(DataCode::wrong_count, value, described(value),
           with_unit(counted("at most", rule, "entry", "entries"), rules));
  }

  void min_length(const Json& rule, const Json& value, const Json&) const {
    if (!value.is_string() || characters(value) >= rule.get<std::size_t>()) return;
    refuse(DataCode::wrong_count, value, described(value), counted("at least", rule, "character", "characters"));
  }

  void max_length(const Json& rule, const Json& value, const Json&) const {
    if (!value.is_string() || characters(value) <= rule.get<std::size_t>()) return;
    refuse(DataCode::wrong_count, value, described(value), counted("at most", rule, "character", "characters"));
  }

  /// Code points, as JSON Schema counts: every byte of UTF-8 but the continuing ones.
  static std::size_t characters(const Json& value) {
    const std::string& text = value.get_ref<const std::string&>();
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  }

  void bound(bool holds, const char* relation, const Json& rule, const Json& value, const Json& rules) const {
    if (!holds) refuse(DataCode::out_of_range, value, described(value), with_unit(relation + rule.dump(), rules));
  }
  void minimum(const Json& rule, const Json& value, const Json& rules) const {
    if (value.is_number()) bound(value >= rule, "a number >= ", rule, value, rules);
  }
  void maximum(const Json& rule, const Json& value, const Json& rules) const {
    if (value.is_number()) bound(value <= rule, "a number <= ", rule, value, rules);
  }
  void above(const Json& rule, const Json& value, const Json& rules) const {
    if (value.is_number()) bound(value > rule, "a number > ", rule, value, rules);
  }

  void none_of(const Json& rule, const Json& value, const Json&) const {
    if (value.is_object() && !has_required_keys(value, rule)) return;
    try {
      check(value, rule);
    } catch (const DataError&) {
      return;
    }
    refuse(DataCode::no_alternative, value, all_of_keys(rule), rule.value("description", std::string()));
  }

  /// "both "goal" and "goals"": what a forbidden combination consists of.
  static std::string all_of_keys(const Json& rule) {
    std::string words = "both ";
    const Json& keys = rule.at("required");
    for (std::size_t i = 0; i < keys.size(); ++i) words += (i == 0 ? "" : " and ") + keys[i].dump();
    return words;
  }

  static bool is_list(const Json& schema) {
    const auto type = schema.find("type");
    return type != schema.end() && *type == "array";
  }

  /// Two alternatives: a list, and an entry of it alone.
  void list_or_entry(const Json& rule, const Json& value) const {
    const Json& list = resolved(rule.at(0));
    if (!value.is_array() && !value.is_object())
      refuse(DataCode::wrong_type, value, described(value), "a list" + of_entries(list.at("items")));
    check(value, value.is_array() ? list : rule.at(1));
  }

  /// The alternatives are told apart by their required keys; the one that is meant gives its own words.
  void one_of(const Json& rule, const Json& value, const Json&) const {
    if (is_list(resolved(rule.front()))) return list_or_entry(rule, value);
    if (!value.is_object()) refuse(DataCode::wrong_type, value, described(value), "an object");
    std::vector<const Json*> meant;
    for (const Json& reference : rule) {
      const Json& alternative = resolved(reference);
      if (has_required_keys(value, alternative)) meant.push_back(&alternative);
    }
    if (meant.empty())
      if (const Json* likely = likeliest(rule, value)) meant.push_back(likely);
    if (meant.empty()) refuse_mistyped(rule, value);
    if (meant.size() == 1) return check(value, *meant.front());
    std::string keys;
    for (const Json& reference : rule) keys += (keys.empty() ? "" : ", or ") + listed_keys(resolved(reference));
    refuse(DataCode::no_alternative, value,
           meant.empty() ? keys_of(value) : "keys of several kinds: " + telling_keys(meant), keys);
  }

  /// The first keys of an object that has none of those that tell what is meant.
  static std::string keys_of(const Json& value) {
    constexpr std::size_t kMost = 4;
    if (value.empty()) return "an empty object";
    std::string words = value.size() == 1 ? "only the key " : "only the keys ";
    std::size_t count = 0;
    for (const auto& [key, member] : value.items()) {
      if (count == kMost) return words + ", ...";
      words += (count++ == 0 ? "" : ", ") + Json(key).dump();
    }
    return words;
  }

  static std::string telling_keys(const std::vector<const Json*>& alternatives) {
    std::string words;
    for (const Json* alternative : alternatives) words += (words.empty() ? "" : ", ") + listed_keys(*alternative);
    return words;
  }

  /// Where no key tells what is meant: one that is nearly a key that would have told.
  void refuse_mistyped(const Json& rule, const Json& value) const {
    std::vector<std::string> telling;
    std::set<std::string> known;
    for (const Json& reference : rule) {
      const Json& alternative = resolved(reference);
      if (!alternative.contains("properties")) return;
      for (const Json& key : alternative.at("required")) telling.push_back(key.get<std::string>());
      for (const auto& [key, member] : alternative.at("properties").items()) known.insert(key);
    }
    for (const auto& [key, member] : value.items())
      if (known.count(key) == 0 && !geometry::nearest_word(key, telling).empty()) refuse_unknown(value, key, telling);
  }

  /// Where no alternative has its required keys: the one that knows most of the value's, if there is one.
  const Json* likeliest(const Json& rule, const Json& value) const {
    const Json* likely = nullptr;
    std::size_t most = 0;
    for (const Json& reference : rule) {
      const Json& alternative = resolved(reference);
      const auto known = alternative.find("properties");
      if (known == alternative.end()) return nullptr;
      std::size_t count = 0;
      for (const auto& [key, member] : value.items()) count += known->contains(key);
      if (count < most || count == 0) continue;
      likely = count > most ? &alternative : nullptr;
      most = count;
    }
    return likely;
  }

  /// "\"polyline\" with \"path\" and \"speed\"".
  static std::string listed_keys(const Json& alternative) {
    std::string words;
    const Json& keys = alternative.at("required");
    for (std::size_t i = 0; i < keys.size(); ++i) words += (i == 0 ? "" : i == 1 ? " with " : " and ") + keys[i].dump();
    return words;
  }

  static bool has_required_keys(const Json& value, const Json& alternative) {
    const Json& keys = alternative.at("required");
    return std::all_of(keys.begin(), keys.end(),
                       [&](const Json& key) { return value.contains(key.get<std::string>()); });
  }

  const Definitions& definitions_;
  const Json& all_;
  const std::string& file_;
  mutable std::map<const Json*, const Json*> resolved_;  ///< by the reference
};

const std::vector<Checker::Keyword>& Checker::keywords() {
  static const std::vector<Keyword> kKeywords{
      {"type", &Checker::type},
      {"enum", &Checker::one_of_words},
      {"required", &Checker::required},
      {"additionalProperties", &Checker::only_known_keys},
      {"properties", &Checker::properties},
      {"items", &Checker::items},
      {"minItems", &Checker::min_items},
      {"maxItems", &Checker::max_items},
      {"minLength", &Checker::min_length},
      {"maxLength", &Checker::max_length},
      {"minimum", &Checker::minimum},
      {"maximum", &Checker::maximum},
      {"exclusiveMinimum", &Checker::above},
      {"not", &Checker::none_of},
      {"oneOf", &Checker::one_of},
      {"$schema", nullptr},
      {"$id", nullptr},
      {"title", nullptr},
      {"description", nullptr},
      {"default", nullptr},
      {"definitions", nullptr},
  };
  return kKeywords;
}

/// The rules of scenarios, of which most need few: a definition is parsed where it is first referred to.
class RulesInParts {
 public:
  RulesInParts() {
    const std::string_view text = scenario_rules();
    const std::string before = R"(,"definitions": {)";
    const std::size_t end = text.find(before);
    root_ = parse_json(std::string(text.substr(0, end)) + "}", kName);
    for (std::size_t at = end + before.size(); text.at(at) != '}';) {
      const std::size_t name = text.find('"', at) + 1, after = text.find('"', name), from = text.find('{', after);
      int depth = 0;
      at = from;
      do depth += text[at] == '{' ? 1 : text[at] == '}' ? -1 : 0;  // no text of the rules has a brace
      while (depth > 0 && ++at);
      texts_["#/definitions/" + std::string(text.substr(name, after - name))] = text.substr(from, ++at - from);
    }
  }

  const Json& root() const { return root_; }
  const Json& definition(const std::string& reference) {
    const auto [known, is_new] = parsed_.try_emplace(reference);
    if (is_new) known->second = parse_json(texts_.at(reference), kName);
    return known->second;
  }

 private:
  static constexpr const char* kName = "scenario.schema.json";
  Json root_;
  std::map<std::string, std::string_view> texts_;
  std::map<std::string, Json> parsed_;
};

}  // namespace

void check_against_schema(const Json& value, const Json& schema, const std::string& file_name) {
  const Checker::Definitions within = [&](const std::string& reference) -> const Json& {
    return schema.at(Json::json_pointer(reference.substr(1)));
  };
  Checker(within, value, file_name).check(value, schema);
}

void check_against_scenario_rules(const Json& value, const std::string& file_name) {
  static thread_local RulesInParts rules;
  const Checker::Definitions parts = [](const std::string& reference) -> const Json& {
    return rules.definition(reference);
  };
  Checker(parts, value, file_name).check(value, rules.root());
}

}  // namespace exactvo::datasets
