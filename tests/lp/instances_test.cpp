// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/instances.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "exactvo/vo/lp/certificate.h"
#include "lp/sets/generated_sets.h"

namespace exactvo::lp {
namespace {

/// Sum over the first hundred problems of RI10, seed 1.
constexpr double kOffsetsAndNormals = -0x1.d8d5a244095d7p+6;

TEST(Instances, ProblemKDependsOnItsNumberAlone) {
  const auto all = generate("RF10", 10, 1);
  const auto later = generate("RF10", 5, 1, 5);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(all[k + 5].preferred, later[k].preferred);
  EXPECT_NE(generate("RF10", 1, 2)[0].preferred, all[0].preferred);
}

TEST(Instances, AreTheSameOnEveryMachine) {
  double sum = 0.0;
  for (const Problem& p : generate("RI10", 100, 1))
    for (const Constraint& c : p.constraints) sum += c.half_plane.offset + c.half_plane.normal.x;
  EXPECT_EQ(sum, kOffsetsAndNormals);
}

TEST(Instances, FeasibleAndInfeasibleSetsAreWhatTheySay) {
  for (const Problem& p : generate("RF10", 1000, 1)) EXPECT_EQ(solve_certified(p).solution.status, Status::optimal);
  for (const Problem& p : generate("RI10", 1000, 1)) EXPECT_EQ(solve_certified(p).solution.status, Status::relaxed);
}

TEST(Instances, UnknownSetsAreTheCallersMistake) {
  for (const char* set : {"", "RF", "RFx", "RI2", "RF10.5", "corridor", "corridor:", "nowhere:1"})
    EXPECT_THROW(generate(set, 1, 1), std::logic_error) << set;
}

TEST(Instances, AnUnknownSetIsRefusedWithTheNamesOfTheKnownOnes) {
  try {
    generate("RFx", 1, 1);
    FAIL() << "RFx is a set";
  } catch (const std::logic_error& e) {
    const std::string message = e.what();
    for (const char* part : {"no set \"RFx\"", "RFm", "RIm", "parallel:E", "far:E"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST(Instances, AFileReadsBackToTheFloatsThatWereWritten) {
  std::stringstream first, second;
  write_instances(first, generate("RF10", 20, 1));
  const auto once = read_instances(first);
  ASSERT_EQ(once.size(), 20u);
  EXPECT_EQ(once[3].constraints.size(), 10u);
  EXPECT_EQ(once[3].bound.disc, 2.0);
  const Vec2 n = generate("RF10", 20, 1)[3].constraints[4].half_plane.normal;
  EXPECT_EQ(once[3].constraints[4].half_plane.normal.x, static_cast<double>(static_cast<float>(n.x)));
}

TEST(Instances, ABrokenFileNamesThePlace) {
  std::stringstream whole;
  write_instances(whole, generate("RF10", 2, 1));
  std::stringstream cut(whole.str().substr(0, 50));
  try {
    read_instances(cut);
    FAIL() << "a file cut short was read";
  } catch (const InstanceError& e) {
    EXPECT_EQ(e.place, "byte 48, direction x");
    EXPECT_EQ(e.found, "the end of the file");
  }
  std::stringstream empty;
  EXPECT_THROW(read_instances(empty), InstanceError);
  std::string bytes = whole.str();
  bytes[8] = 99;  // m_hard of the first instance
  std::stringstream wrong(bytes);
  EXPECT_THROW(read_instances(wrong), InstanceError);
}

TEST(Instances, BytesAfterTheLastInstanceAreNoneOfTheFiles) {
  std::stringstream file;
  write_instances(file, generate("RF10", 2, 1));
  const std::size_t length = file.str().size();
  file << 'x';
  try {
    read_instances(file);
    FAIL() << "a byte too many was read";
  } catch (const InstanceError& e) {
    EXPECT_EQ(e.place, "byte " + std::to_string(length) + ", after the last instance");
    EXPECT_EQ(e.found, "more bytes");
  }
}

TEST(Instances, RecordedCircleProblemsAreCertified) {
  const std::filesystem::path file = std::filesystem::path(EXACTVO_SOURCE_DIR) / "../shared/data/lp/C10.bin";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recorded instances at " << file;
  std::ifstream in(file, std::ios::binary);
  const auto problems = read_instances(in);
  ASSERT_EQ(problems.size(), 32768u);
  std::size_t exact = 0;
  for (const Problem& problem : problems) {
    const Proven proven = solve_certified(problem);
    exact += proven.exact_stage;
    ASSERT_TRUE(proven.certificate.has_value());
  }
  EXPECT_LE(exact, problems.size() / 1000);
}

}  // namespace
}  // namespace exactvo::lp
