// SPDX-License-Identifier: GPL-3.0-or-later
// Two implementations of JSON Schema must agree: ours, for its words, and valijson.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "exactvo/datasets/scenario_file.h"
#include "scenarios/schema_check.h"
#include "support/seeded_random.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;
using valijson::adapters::NlohmannJsonAdapter;

const std::filesystem::path kPaper = std::filesystem::path(EXACTVO_SOURCE_DIR) / "datasets" / "data" / "paper";

class Oracle {
 public:
  Oracle() : text_(nlohmann::json::parse(scenario_schema())) {
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(NlohmannJsonAdapter(text_), schema_);
  }
  bool accepts(const nlohmann::json& value) const {
    return valijson::Validator().validate(schema_, NlohmannJsonAdapter(value), nullptr);
  }

 private:
  nlohmann::json text_;
  valijson::Schema schema_;
};

/// What the schema check alone says: what comes after it has codes of its own.
bool ours_accepts(const nlohmann::json& value) {
  try {
    parse_scenario(value.dump(), "t", {});
  } catch (const DataError& error) {
    switch (error.code()) {
      case DataCode::key_missing:
      case DataCode::key_unknown:
      case DataCode::wrong_type:
      case DataCode::out_of_range:
      case DataCode::not_an_option:
      case DataCode::wrong_count:
      case DataCode::no_alternative:
        return false;
      default:
        return true;
    }
  }
  return true;
}

nlohmann::json any_value(SeededRandom& random) {
  static const std::vector<nlohmann::json> kValues{nullptr,
                                                   true,
                                                   0,
                                                   -1,
                                                   1e300,
                                                   0.5,
                                                   2,
                                                   "",
                                                   "disc",
                                                   "word",
                                                   nlohmann::json::array(),
                                                   nlohmann::json::object(),
                                                   {1, 2},
                                                   {1, "2"},
                                                   {{1, 2}, {3, 4}, {5, 6}},
                                                   nlohmann::json{{"polyline", {{0, 0}, {1, 1}}}}};
  return kValues[static_cast<std::size_t>(random.integer(0, static_cast<int>(kValues.size()) - 1))];
}

/// One value somewhere in the tree replaced, removed, renamed or doubled.
void mutate(nlohmann::json& tree, SeededRandom& random) {
  nlohmann::json* at = &tree;
  while (at->is_structured() && !at->empty() && random.integer(0, 4) != 0) {
    at = &*std::next(at->begin(), random.integer(0, static_cast<int>(at->size()) - 1));
  }
  const int kind = random.integer(0, 3);
  if (kind == 0 && at->is_structured() && !at->empty()) {
    at->erase(std::next(at->begin(), random.integer(0, static_cast<int>(at->size()) - 1)));
  } else if (kind == 1 && at->is_object()) {
    (*at)["stray"] = any_value(random);
  } else if (kind == 2 && at->is_array()) {
    at->push_back(any_value(random));
  } else {
    *at = any_value(random);
  }
}

void remove_descriptions(nlohmann::json& schema) {
  if (schema.is_object() && schema.contains("description") && schema.at("description").is_string())
    schema.erase("description");
  for (nlohmann::json& part : schema)
    if (part.is_structured()) remove_descriptions(part);
}

TEST(SchemaAgreement, RulesAreTheSchemaWithoutDescriptions) {
  nlohmann::json schema = nlohmann::json::parse(scenario_schema());
  remove_descriptions(schema);
  EXPECT_EQ(nlohmann::json::parse(scenario_rules()), schema);
}

TEST(SchemaAgreement, ScenariosOfPaperAndRobotsFitBoth) {
  const Oracle oracle;
  int judged = 0;
  for (const auto& folder : {kPaper, kPaper.parent_path() / "robots"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".json") continue;
      const nlohmann::json tree = nlohmann::json::parse(std::ifstream(entry.path()));
      EXPECT_TRUE(oracle.accepts(tree)) << entry.path();
      EXPECT_TRUE(ours_accepts(tree)) << entry.path();
      ++judged;
    }
  }
  EXPECT_GE(judged, 24);
}

/// Wheels: each key renamed, removed or with another value.
TEST(SchemaAgreement, MutatedWheelsGetTheSameVerdict) {
  const Oracle oracle;
  SeededRandom random(exactvo::test::seed_of_run(12));
  const nlohmann::json whole = nlohmann::json::parse(std::ifstream(kPaper.parent_path() / "robots" / "burgers4.json"));
  int refused = 0;
  for (int k = 0; k < 600; ++k) {
    nlohmann::json tree = whole;
    nlohmann::json& robot = tree["robots"][static_cast<std::size_t>(random.integer(0, 3))];
    mutate(k % 3 == 0 ? robot : robot["kinematics"], random);
    const bool expected = oracle.accepts(tree);
    bool is_incomplete = false;  // which keys a differential drive needs is said after the schema, by name
    for (const nlohmann::json& one : tree["robots"])
      if (one.is_object() && one.contains("kinematics") && one["kinematics"].is_object() &&
          one["kinematics"].value("type", nlohmann::json()) == "differential")
        for (const char* key : {"wheel_separation", "max_wheel_speed", "max_wheel_acceleration"})
          is_incomplete = is_incomplete || !one["kinematics"].contains(key);
    ASSERT_EQ(ours_accepts(tree), expected && !is_incomplete) << tree.dump(1);
    refused += expected ? 0 : 1;
  }
  EXPECT_GT(refused, 200);
  EXPECT_LT(refused, 600);
}

TEST(SchemaAgreement, RobotsMayBeAListOrAnEntryAlone) {
  const Oracle oracle;
  int accepted = 0;
  for (const char* robots : {R"({"circle": {"count": 4}})", R"({"id": "R", "position": [0, 0], "goal": [9, 0]})",
                             R"([{"circle": {"count": 4}}])", R"({"circle": {"count": 0}})", R"({"circle": 4})",
                             R"({"circle": {"count": 4}, "grid": {}})", "{}", "[]", "[[]]", "4", "null"}) {
    const nlohmann::json tree = nlohmann::json::parse(R"({"name": "n", "robots": )" + std::string(robots) + "}");
    EXPECT_EQ(ours_accepts(tree), oracle.accepts(tree)) << robots;
    accepted += oracle.accepts(tree);
  }
  EXPECT_EQ(accepted, 3);
}

TEST(SchemaAgreement, MutatedScenariosGetTheSameVerdict) {
  const Oracle oracle;
  SeededRandom random(exactvo::test::seed_of_run(11));
  int refused = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::string name = k % 2 == 0 ? "B3.json" : "A7.json";
    nlohmann::json tree = nlohmann::json::parse(std::ifstream(kPaper / name));
    for (int m = random.integer(1, 3); m > 0; --m) mutate(tree, random);
    const bool expected = oracle.accepts(tree);
    ASSERT_EQ(ours_accepts(tree), expected) << tree.dump(1);
    refused += expected ? 0 : 1;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 3000);
}

}  // namespace
}  // namespace exactvo::datasets::test
