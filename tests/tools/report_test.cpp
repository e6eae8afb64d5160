// SPDX-License-Identifier: GPL-3.0-or-later
// The reproduction report: every equation's place exists, verdicts follow the numbers, the page needs no other file.
#include "paper/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "paper/claims.h"
#include "paper/equations.h"
#include "run_program.h"

namespace exactvo::tools {
namespace {

using nlohmann::json;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

const std::filesystem::path kSources = EXACTVO_SOURCE_DIR;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(Equations, EveryPlaceExistsAndHoldsItsName) {
  for (const Equation& e : equations()) {
    EXPECT_FALSE(e.printed.empty()) << e.number;
    EXPECT_FALSE(e.implemented.empty()) << e.number;
    ASSERT_FALSE(e.places.empty()) << e.number;
    for (const EquationPlace& place : e.places)
      EXPECT_THAT(text_of(kSources / place.file), HasSubstr(place.symbol)) << e.number << " " << place.file;
  }
}

TEST(Equations, NoneOfThePapersIsMissing) {
  std::string numbers;
  for (const Equation& e : equations()) numbers += e.number + " ";
  for (int k = 1; k <= 21; ++k) EXPECT_THAT(numbers, HasSubstr("(" + std::to_string(k) + ")"));
}

json run_of(const std::string& scenario, const std::string& method, const json& controller) {
  return {{"scenario", scenario},
          {"method", method},
          {"controller", controller},
          {"all_arrived", true},
          {"last_arrival_time", 12.0},
          {"min_obstacle_clearance", 0.1},
          {"min_robot_clearance", 0.2},
          {"formation_position_error", controller.is_null() ? json() : json(1e-12)},
          {"formation_velocity_error", controller.is_null() ? json() : json(1e-12)},
          {"leader_arrival_time", 8.3},
          {"jitter", 100.0},
          {"relaxed_steps", 0},
          {"uncertified_half_planes", 0},
          {"lyapunov", nullptr}};
}

/// A summary in which everything went well.
json rosy_summary() {
  json all = json::array();
  for (int i = 0; i < 16; ++i)
    for (const char* method : {"orca", "ivo-edge", "ivo-cluster", "ivo"})
      all.push_back(run_of("A" + std::to_string(i), method, nullptr));
  for (const char* scene : {"B0", "B1", "B2", "B3"})
    for (const char* controller : {"paper-literal", "paper-signs", "default"})
      all.push_back(run_of(scene, "ivo", controller));
  return all;
}

Verdict verdict_on(const std::vector<Claim>& all, const std::string& where) {
  for (const Claim& c : all)
    if (c.where == where) return c.verdict;
  ADD_FAILURE() << where;
  return Verdict::not_run;
}

std::vector<Claim> claims_of(const json& summary) {
  const Workplace here;
  here.write("summary.json", summary.dump());
  return claims(ReportData(here.path(), here.path(), kSources / "datasets/data/paper"));
}

TEST(Claims, VerdictsFollowTheNumbers) {
  json summary = rosy_summary();
  EXPECT_EQ(verdict_on(claims_of(summary), "Fig. 6, Section V.A"), Verdict::holds);
  EXPECT_EQ(verdict_on(claims_of(summary), "Fig. 5, Section V.A"), Verdict::fails);  // nothing stopped
  EXPECT_EQ(verdict_on(claims_of(summary), "Theorem 1, Section IV.B"), Verdict::holds);
  EXPECT_EQ(verdict_on(claims_of(summary), "Section VI"), Verdict::fails);  // no less jitter
  for (json& run : summary) {
    if (run["method"] == "orca") run["all_arrived"] = false;
    if (run["scenario"] == "A3" && run["method"] == "ivo-edge") run["all_arrived"] = false;
    if (run["controller"] == "paper-signs") run["formation_position_error"] = 0.2, run["jitter"] = 1e6;
  }
  const std::vector<Claim> seen = claims_of(summary);
  EXPECT_EQ(verdict_on(seen, "Fig. 6, Section V.A"), Verdict::holds_in_part);
  EXPECT_EQ(verdict_on(seen, "Fig. 5, Section V.A"), Verdict::holds);
  EXPECT_EQ(verdict_on(seen, "Theorem 1, Section IV.B"), Verdict::fails);
  EXPECT_EQ(verdict_on(seen, "Section VI"), Verdict::holds);
  EXPECT_EQ(verdict_on(seen, "(18)-(20)"), Verdict::fails);  // the counterexample is run each time
}

TEST(Claims, EachNamesAFigure) {
  for (const Claim& c : claims_of(rosy_summary())) {
    EXPECT_THAT(c.figure, testing::EndsWith(".png")) << c.where;
    EXPECT_FALSE(c.evidence.empty()) << c.where;
  }
}

TEST(Report, IsOneFileWithThePicturesInIt) {
  const Workplace here;
  here.write("summary.json", rosy_summary().dump());
  std::filesystem::create_directories(here.path() / "figures");
  here.write("figures/all-ivo.png", "\x89PNG");
  write_report(ReportData(here.path(), here.path(), kSources / "datasets/data/paper"), here.path());
  const std::string page = here.read("report.html");
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,iVBORw=="));
  EXPECT_THAT(page, Not(HasSubstr("src=\"figures")));
  EXPECT_THAT(page, Not(HasSubstr("http")));
  for (const char* heading :
       {"Claims", "Equations", "Table I:", "Table II:", "Section V.A", "Section V.B", "Random fields", "ladder"})
    EXPECT_THAT(page, HasSubstr(heading));
  EXPECT_THAT(here.read("report.md"), HasSubstr("](figures/all-ivo.png)"));
}

TEST(Document, TextCannotBecomeMarkup) {
  Document d{"a < b", {Paragraph{"1 < 2 & `x<y>`"}, Table{{"a|b"}, {{"*c*"}}}}};
  EXPECT_THAT(html(d, "."), HasSubstr("1 &lt; 2 &amp; <code>x&lt;y&gt;</code>"));
  EXPECT_THAT(markdown(d), HasSubstr("| a\\|b |"));
  EXPECT_THAT(markdown(d), HasSubstr("\\*c\\*"));
}

TEST(Document, Base64OfTheStandard) {
  const std::pair<const char*, const char*> rfc[] = {{"", ""},
                                                     {"f", "Zg=="},
                                                     {"fo", "Zm8="},
                                                     {"foo", "Zm9v"},
                                                     {"foob", "Zm9vYg=="},
                                                     {"fooba", "Zm9vYmE="},
                                                     {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : rfc) EXPECT_EQ(base64(bytes), text);
}

}  // namespace
}  // namespace exactvo::tools
