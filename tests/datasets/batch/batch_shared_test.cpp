// SPDX-License-Identifier: GPL-3.0-or-later
// Every public file through a batch, plain and with repairs: each ends as the table says, with the reason there, and
// nothing is left uncertified. (The whole with every output: exactvo batch ../shared/data --out DIR.)
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "batch_files.h"
#include "exactvo/datasets/batch.h"
#include "shared_data.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using Json = nlohmann::json;

struct Expected {
  std::string outcome, code;
  std::uint64_t read = 0, done = 0, repaired = 0, rejected = 0, passed_over = 0;
  std::string outcome_repaired, code_repaired, reason;
};

std::map<std::string, Expected> expectations() {
  std::map<std::string, Expected> table;
  std::ifstream file(EXACTVO_SOURCE_DIR "/tests/datasets/batch/shared_outcomes.tsv");
  std::string line;
  while (std::getline(file, line)) {
    if (line[0] == '#' || line.rfind("path\t", 0) == 0) continue;
    std::istringstream fields(line);
    const auto text = [&] {
      std::string field;
      std::getline(fields, field, '\t');
      return field;
    };
    const auto number = [&] { return std::strtoull(text().c_str(), nullptr, 10); };
    const std::string path = text();
    Expected& e = table[path];
    e.outcome = text();
    e.code = text();
    for (std::uint64_t* count : {&e.read, &e.done, &e.repaired, &e.rejected, &e.passed_over}) *count = number();
    e.outcome_repaired = text();
    e.code_repaired = text();
    e.reason = text();
  }
  return table;
}

std::uint64_t sum_of(const Json& rejected) {
  std::uint64_t sum = 0;
  for (const auto& [code, count] : rejected.items()) sum += count.get<std::uint64_t>();
  return sum;
}

class SharedBatch : public TemporaryFolder {
 protected:
  /// The facts of each file by its path below the public folder.
  std::map<std::string, Json> run(bool repair) {
    BatchConfiguration configuration;
    configuration.reading.repair = repair;
    configuration.geopackage = configuration.geojson = configuration.pictures = false;
    BatchRun how;
    how.paths = {shared_data()};
    how.out = folder_ / (repair ? "repaired" : "plain");
    summary_ = run_batch(configuration, how).summary;
    std::map<std::string, Json> facts;
    const Json summary = Json::parse(text_of(how.out / "summary.json"));
    for (const Json& input : summary.at("inputs")) {
      const std::string path = input.at("path").get<std::string>();
      facts[path.substr(shared_data().generic_string().size() + 1)] = input.at("facts");
    }
    return facts;
  }

  BatchSummary summary_;
};

void expect_counts_that_add_up(const BatchSummary& s) {
  EXPECT_EQ(s.files.read, s.files.done + s.files.repaired + s.files.rejected_in_all());
  EXPECT_EQ(s.obstacles.read, s.obstacles.done + s.obstacles.repaired + s.obstacles.rejected_in_all());
  EXPECT_EQ(s.uncertified, 0u);
  EXPECT_EQ(s.certified, s.obstacles_out);
}

TEST_F(SharedBatch, EveryFileEndsAsTheTableSays) {
  EXACTVO_NEEDS_SHARED_DATA();
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  const std::map<std::string, Expected> table = expectations();
  ASSERT_EQ(table.size(), manifest().size());
  const std::map<std::string, Json> plain = run(false);
  expect_counts_that_add_up(summary_);
  const std::map<std::string, Json> repaired = run(true);
  expect_counts_that_add_up(summary_);
  for (const auto& [path, expected] : table) {
    SCOPED_TRACE(path + ": " + expected.reason);
    EXPECT_FALSE(expected.reason.empty());
    const auto found = plain.find(path);
    ASSERT_EQ(found != plain.end(), expected.outcome != "companion");
    if (found == plain.end()) continue;
    const Json& facts = found->second;
    EXPECT_EQ(facts.at("outcome"), expected.outcome);
    EXPECT_EQ(facts.value("code", ""), expected.code);
    EXPECT_EQ(facts.at("read"), expected.read);
    EXPECT_EQ(facts.at("done"), expected.done);
    EXPECT_EQ(facts.at("repaired"), expected.repaired);
    EXPECT_EQ(sum_of(facts.at("rejected")), expected.rejected);
    EXPECT_EQ(facts.at("passed_over"), expected.passed_over);
    EXPECT_EQ(repaired.at(path).at("outcome"), expected.outcome_repaired);
    EXPECT_EQ(repaired.at(path).value("code", ""), expected.code_repaired);
  }
}

TEST_F(SharedBatch, CountsAgreeWithTheManifest) {
  EXACTVO_NEEDS_SHARED_DATA();
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  const std::map<std::string, Json> plain = run(false);
  // What the manifest counts of a format, by programs of others, where that is an obstacle or a refusal each. (Of grids
  // and scans it counts cells and beams; test suites in XML have other geometries beside the polygons.)
  const std::map<std::string, std::string> kCounted{
      {"barn-world", "cylinders"}, {"counted-rings", "poly"},   {"gdal", "poly"},
      {"menge-xml", "poly"},       {"ompl-circles", "circles"}, {"opentraj-xml", "lines"},
      {"rings-json", "poly"},      {"sumo-poly", "poly"},       {"wkt", "poly"}};
  std::map<std::string, int> compared;
  for (const ManifestRow& row : manifest()) {
    const auto found = plain.find(row.path);
    if (found == plain.end()) continue;
    const std::string format = found->second.value("format", "");
    const auto key = kCounted.find(format);
    if (key == kCounted.end() || !row.count(key->second)) continue;
    SCOPED_TRACE(row.path);
    EXPECT_EQ(found->second.at("read").get<long>(), *row.count(key->second));
    ++compared[format];
  }
  for (const auto& [format, key] : kCounted) EXPECT_GE(compared[format], 1) << format;
}

}  // namespace
}  // namespace exactvo::datasets::test
