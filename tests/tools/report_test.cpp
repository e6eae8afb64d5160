// SPDX-License-Identifier: GPL-3.0-or-later
// The reproduction report: every equation's place exists, verdicts follow the numbers, the page needs no other file.
#include "paper/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "explorer/page.h"
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
          {"decisions", {{"relaxed", 0}, {"uncertified_half_planes", 0}}},
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

Claim claim_at(const std::vector<Claim>& all, const std::string& where) {
  for (const Claim& c : all)
    if (c.where == where) return c;
  ADD_FAILURE() << where;
  return {};
}

std::vector<Claim> claims_of(const json& summary, const json& ablations = nullptr) {
  const Workplace here;
  here.write("summary.json", summary.dump());
  if (!ablations.is_null()) {
    std::filesystem::create_directories(here.path() / "ablations");
    here.write("ablations/ablations.json", ablations.dump());
  }
  return claims(ReportData(here.path(), here.path(), kSources / "datasets/data/paper"));
}

/// A claim, a change that turns its verdict, and a run without which there is none.
struct Turn {
  const char* where;
  Verdict rosy;
  Verdict turned;
  const char* scenario;  ///< of the run that is changed or taken away
  const char* judged;    ///< its method, or controller
  const char* key;       ///< "decisions/relaxed" of an object in it
  json value;
};

bool is_of(const json& run, const Turn& t) {
  const json& word = run["controller"].is_null() ? run["method"] : run["controller"];
  return run["scenario"] == t.scenario && word == t.judged;
}

const std::vector<Turn>& turns() {
  static const std::vector<Turn> all{
      {"Fig. 5, Section V.A", Verdict::fails, Verdict::holds_in_part, "A4", "orca", "all_arrived", false},
      {"Fig. 6, Section V.A", Verdict::holds, Verdict::holds_in_part, "A3", "ivo-edge", "all_arrived", false},
      {"Fig. 6(b), (c)", Verdict::holds, Verdict::holds_in_part, "A9", "ivo-edge", "min_obstacle_clearance", -0.1},
      {"Section V.A", Verdict::holds, Verdict::fails, "A7", "ivo-edge", "min_robot_clearance", -0.1},
      {"Section III.B, (11)-(13)", Verdict::holds, Verdict::holds_in_part, "A7", "ivo-edge", "decisions/relaxed", 3},
      {"Theorem 1, Section IV.B", Verdict::holds, Verdict::holds_in_part, "B1", "paper-signs",
       "formation_position_error", 0.2},
      {"Fig. 8(c)", Verdict::holds, Verdict::holds_in_part, "B2", "paper-signs", "formation_velocity_error", 0.2},
      {"Fig. 8(d)", Verdict::holds, Verdict::holds_in_part, "B0", "paper-signs", "min_robot_clearance", -0.1},
      {"Fig. 8(e), Section VI", Verdict::holds, Verdict::holds_in_part, "B3", "paper-signs", "all_arrived", false}};
  return all;
}

TEST(Claims, EachVerdictFollowsItsOwnNumbersBothWays) {
  const std::vector<Claim> rosy = claims_of(rosy_summary());
  for (const Turn& t : turns()) {
    EXPECT_EQ(claim_at(rosy, t.where).verdict, t.rosy) << t.where;
    json summary = rosy_summary();
    for (json& run : summary)
      if (is_of(run, t)) run[json::json_pointer(std::string("/") + t.key)] = t.value;
    EXPECT_EQ(claim_at(claims_of(summary), t.where).verdict, t.turned) << t.where;
  }
}

TEST(Claims, AMissingRunGivesNoVerdictAndNoNumber) {
  for (const Turn& t : turns()) {
    json summary = json::array();
    for (const json& run : rosy_summary())
      if (!is_of(run, t)) summary.push_back(run);
    const Claim claim = claim_at(claims_of(summary), t.where);
    EXPECT_EQ(claim.verdict, Verdict::not_run) << t.where;
    EXPECT_THAT(claim.evidence, HasSubstr("-")) << t.where;
  }
  // Nothing but one run: no sentinel of an empty list gets into a sentence.
  for (const Claim& c : claims_of(json::array({run_of("A1", "orca", nullptr)}))) {
    EXPECT_THAT(c.evidence, Not(HasSubstr("e+300"))) << c.where;
    EXPECT_THAT(c.evidence, Not(testing::ContainsRegex("[0-9]{20}"))) << c.where;
  }
}

TEST(Claims, ARunWithoutAClearanceShowsNoSafety) {
  json summary = rosy_summary();
  for (json& run : summary)
    if (run["scenario"] == "A9") run["min_obstacle_clearance"] = run["min_robot_clearance"] = nullptr;
  EXPECT_EQ(claim_at(claims_of(summary), "Fig. 6(b), (c)").verdict, Verdict::holds_in_part);
}

TEST(Claims, TheDefaultDoesNotSpeakForThePapersMethod) {
  json summary = rosy_summary();
  for (json& run : summary)
    if (run["method"] == "ivo" && run["controller"].is_null()) run["decisions"]["relaxed"] = 5;
  EXPECT_EQ(claim_at(claims_of(summary), "Section III.B, (11)-(13)").verdict, Verdict::holds);
}

TEST(Claims, TheOpenProblemIsSolvedOrNot) {
  json summary = rosy_summary();
  const Claim before = claim_at(claims_of(summary), "Section VI");
  EXPECT_EQ(before.verdict, Verdict::not_solved);
  EXPECT_THAT(before.evidence, HasSubstr("1 times the default's in B1"));
  for (json& run : summary)
    if (run["controller"] == "paper-signs") run["jitter"] = 1e6;
  EXPECT_EQ(claim_at(claims_of(summary), "Section VI").verdict, Verdict::solved);
  summary.erase(summary.end() - 1);  // B3 default
  EXPECT_EQ(claim_at(claims_of(summary), "Section VI").verdict, Verdict::not_run);
}

TEST(Claims, TheCauseOfJitterIsReadFromTheAblations) {
  const auto jitter_claim = [](const std::vector<Claim>& all) {
    for (const Claim& c : all)
      if (c.text.find("jitter is caused") != std::string::npos) return c;
    return Claim{};
  };
  EXPECT_THAT(jitter_claim(claims_of(rosy_summary())).evidence, HasSubstr("were not run"));
  const auto row = [](const char* variant, double j) {
    return json{{"variant", variant},
                {"fields", 1},
                {"reached_and_safe", 1},
                {"reached", 1},
                {"median_jitter", j},
                {"kind", "formation"},
                {"scenes", {{{"scenario", "B0"}, {"jitter", j}}}}};
  };
  const json ablations{{"kind", "exactvo-ablations"},
                       {"seed", 1},
                       {"fields", 1},
                       {"program", {{"version", "1"}, {"commit", "c"}, {"compiler", "g"}}},
                       {"rows", {row("default", 2.0), row("constant |v_pref|", 84.0)}}};
  EXPECT_THAT(jitter_claim(claims_of(rosy_summary(), ablations)).evidence, HasSubstr("42 times as much"));
  json summary = rosy_summary();
  EXPECT_EQ(jitter_claim(claims_of(summary)).verdict, Verdict::fails);
  for (json& run : summary)
    if (run["scenario"] == "B0") run["jitter"] = 1.0;
  EXPECT_EQ(jitter_claim(claims_of(summary)).verdict, Verdict::holds);
}

TEST(Claims, TheCounterexampleIsRunEachTime) {
  EXPECT_EQ(claim_at(claims_of(rosy_summary()), "(18)-(20)").verdict, Verdict::fails);
}

TEST(Claims, EachFigureShowsWhatIsJudged) {
  for (const Claim& c : claims_of(rosy_summary())) {
    EXPECT_FALSE(c.evidence.empty()) << c.where;
    EXPECT_THAT(c.figure, testing::EndsWith(".png")) << c.where;
    // Two sheets have several controllers side by side.
    if (c.figure == "figures/all-formation.png" || c.figure == "figures/jitter.png") continue;
    const std::string folder = c.subject == "orca"       ? "figures/fig5-orca/"
                               : c.subject == "ivo-edge" ? "figures/fig6-ivo-edge/"
                                                         : "figures/fig8-paper-signs/";
    EXPECT_TRUE(c.figure.rfind(folder, 0) == 0 || c.figure == "figures/all-" + c.subject + ".png")
        << c.where << ": " << c.subject << " is judged, " << c.figure << " is shown";
  }
}

TEST(ReportFiles, ADamagedOrForeignOneIsNamedBeforeTheWork) {
  struct Bad {
    const char* file;
    std::string text;
    const char* words;
  };
  json run = rosy_summary();
  run[3]["all_arrived"] = "yes";
  const std::vector<Bad> all{
      {"summary.json", "[{", "[E_JSON_SYNTAX]"},
      {"summary.json", "{\"a\": 1}", "expected a list"},
      {"summary.json", run.dump(), "/3/all_arrived: found \"yes\", expected true or false [E_TYPE]"},
      {"summary.json", "[{\"scenario\": \"A1\"}]", "/0: found no 'method'"},
      {"random/random.json", "[]", "expected an object"},
      {"random/random.json", "{\"kind\": \"exactvo-ablations\"}", "/kind: found \"exactvo-ablations\""},
      {"ablations/ablations.json", "{\"kind\": \"exactvo-ablations\", \"seed\": -1}",
       "/seed: found -1, expected a count"}};
  for (const Bad& bad : all) {
    const Workplace here;
    for (const char* folder : {"out/random", "out/ablations"})
      std::filesystem::create_directories(here.path() / folder);
    here.write("out/summary.json", "[]");
    here.write(std::string("out/") + bad.file, bad.text);
    const test::Outcome outcome = here.run("paper --out out --random 1000000");
    EXPECT_EQ(outcome.status, 2) << bad.text;
    EXPECT_THAT(outcome.err, HasSubstr(bad.file));
    EXPECT_THAT(outcome.err, HasSubstr(bad.words));
    EXPECT_FALSE(here.has("out/random/parts"));
  }
}

std::string markdown_of(const std::filesystem::path& folder, const std::filesystem::path& scenarios) {
  return reproduction_report(ReportData(folder, folder, scenarios), folder).markdown();
}

std::string report_of(const json& summary) {
  const Workplace here;
  here.write("summary.json", summary.dump());
  return markdown_of(here.path(), kSources / "datasets/data/paper");
}

TEST(Report, NamesTheProgramOfEachFile) {
  json summary = rosy_summary();
  const json input{{"path", "/x/A1.json"}, {"sha256", "0123456789abcdef0123"}};
  for (json& run : summary)
    run["provenance"] = {{"version", "1.2.3"}, {"commit", "abcdef"}, {"inputs", json::array({input})}};
  const std::string one = report_of(summary);
  EXPECT_THAT(one, HasSubstr("1.2.3, commit abcdef |"));
  EXPECT_THAT(one, HasSubstr("| A1.json 0123456789ab |"));
  EXPECT_THAT(one, Not(HasSubstr("not all written by one program")));
  summary[5]["provenance"]["commit"] = "012345";
  EXPECT_THAT(report_of(summary), HasSubstr("not all written by one program"));
}

TEST(Report, SaysWhereAPromiseIsNotKept) {
  json summary = rosy_summary();  // all robots arrive after 12 s
  const auto row = [&](const std::string& scenario) {
    const std::string text = report_of(summary), head = "| " + scenario + " | ";
    const std::size_t at = text.find(head, text.find("Section V.A: robots"));
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_THAT(row("A1"), HasSubstr("| 12.0 / X DIFFERS | 12.0 / arrives | 12.0 / arrives | 12.0 / below 18 |"));
  EXPECT_THAT(row("A6"), HasSubstr("| 12.0 / 11.1 +- 0.5 DIFFERS |"));
  EXPECT_THAT(row("A13"), HasSubstr("| 12.0 / 11.5 +- 0.5 |"));
  EXPECT_THAT(row("A3"), HasSubstr("| 12.0 / X DIFFERS | 12.0 / X DIFFERS | 12.0 / arrives |"));
  for (json& run : summary) run["all_arrived"] = false;
  EXPECT_THAT(row("A1"), HasSubstr("| X / X | X / arrives DIFFERS | X / arrives DIFFERS | X / below 18 DIFFERS |"));
}

/// The lines of the report that begin a table's row with these cells.
std::string line_of(const std::string& report, const std::string& head, const std::string& after) {
  const std::size_t at = report.find(head, report.find(after));
  return at == std::string::npos ? "" : report.substr(at, report.find('\n', at) - at);
}

json& run_in(json& summary, const std::string& scenario, const std::string& word) {
  for (json& run : summary)
    if (run["scenario"] == scenario && (run["controller"] == word || run["method"] == word)) return run;
  throw std::logic_error(scenario + " " + word);
}

TEST(Report, EveryRowOfSectionBIsCompared) {
  json summary = rosy_summary();
  const auto row = [&](const std::string& scene, const std::string& controller) {
    return line_of(report_of(summary), "| " + scene + " | " + controller + " |", "Section V.B: three");
  };
  run_in(summary, "B3", "paper-signs")["formation_position_error"] = 0.093;
  run_in(summary, "B2", "paper-signs")["formation_position_error"] = 0.2;
  run_in(summary, "B1", "paper-literal")["formation_position_error"] = 1e7;
  run_in(summary, "B2", "paper-literal")["formation_position_error"] = "inf";
  run_in(summary, "B1", "default")["formation_velocity_error"] = 1e-3;
  run_in(summary, "B2", "default")["min_obstacle_clearance"] = -0.5;
  run_in(summary, "B3", "default")["formation_position_error"] = nullptr;
  EXPECT_THAT(row("B3", "paper-signs"), HasSubstr("| 0.093 | 0.1 to 0.4 DIFFERS | 1e-12 | - |"));
  EXPECT_THAT(row("B2", "paper-signs"), HasSubstr("| 0.2 | 0.1 to 0.4 | 1e-12 | - |"));
  EXPECT_THAT(row("B0", "paper-literal"), HasSubstr("| above 100 (diverges) DIFFERS |"));
  EXPECT_THAT(row("B1", "paper-literal"), HasSubstr("| 1e+07 | above 100 (diverges) |"));
  EXPECT_THAT(row("B2", "paper-literal"), HasSubstr("| above 100 (diverges) |"));
  EXPECT_THAT(row("B0", "default"), HasSubstr("| 1e-12 | below 1e-9 | 1e-12 | below 1e-09 | 0.100 | 0.200 |"));
  EXPECT_THAT(row("B1", "default"), HasSubstr("| 1e-12 | below 1e-9 | 0.001 | below 1e-09 DIFFERS |"));
  EXPECT_THAT(row("B2", "default"), HasSubstr("| -0.500 DIFFERS | 0.200 |"));
  EXPECT_THAT(row("B3", "default"), HasSubstr("| - | below 1e-9 DIFFERS |"));
}

TEST(Report, ARunThatTouchedSomethingIsNotAsExpected) {
  json summary = rosy_summary();
  for (const char* method : {"orca", "ivo-edge", "ivo-cluster", "ivo"})
    run_in(summary, "A13", method)["min_obstacle_clearance"] = -0.1;
  EXPECT_THAT(line_of(report_of(summary), "| A13 |", "Section V.A: robots"),
              HasSubstr("| 12.0! / 11.5 +- 0.5 | 12.0! / arrives DIFFERS | 12.0! / arrives DIFFERS | "
                        "12.0! / below 18 DIFFERS |"));
}

TEST(Report, NoCertificateOfAnOptimumIsClaimed) {
  const std::string row = line_of(report_of(rosy_summary()), "| (12) |", "Equations");
  EXPECT_THAT(row, HasSubstr("no certificate of optimality is recorded"));
  EXPECT_THAT(row, Not(HasSubstr("with a certificate for every optimum")));
}

TEST(Report, CountsOfHalfPlanesAreThoseOfTheRuns) {
  json summary = rosy_summary();
  summary[2]["decisions"]["uncertified_half_planes"] = 5;
  summary[4]["decisions"]["relaxed"] = 6;
  EXPECT_THAT(line_of(report_of(summary), "| (10) |", "Equations"), HasSubstr("5 half-planes are not certified"));
  EXPECT_THAT(line_of(report_of(summary), "| (13) |", "Equations"), HasSubstr("6 decisions gave way"));
}

TEST(Report, RandomFieldsOfTheDefaultAreCompared) {
  const auto row = [](int reached) {
    const Workplace here;
    here.write("summary.json", rosy_summary().dump());
    std::filesystem::create_directories(here.path() / "random");
    json rows = json::array();
    for (const char* variant : {"orca", "ivo-edge", "ivo-cluster", "ivo"})
      rows.push_back(
          {{"kind", "convex"}, {"variant", variant}, {"fields", 10}, {"reached_and_safe", reached}, {"reached", 10}});
    const json random{{"kind", "exactvo-random-fields"},
                      {"seed", 1},
                      {"fields", 10},
                      {"program", {{"version", "1"}, {"commit", "c"}, {"compiler", "g"}}},
                      {"rows", rows}};
    here.write("random/random.json", random.dump());
    return line_of(markdown_of(here.path(), kSources / "datasets/data/paper"), "| convex |", "Random fields");
  };
  EXPECT_THAT(row(10), HasSubstr("| 10 of 10 | 10 of 10 | 10 of 10 | 10 of 10 |"));
  EXPECT_THAT(row(9), HasSubstr("| 9 of 10 | 9 of 10 | 9 of 10 | 9 of 10 DIFFERS |"));
}

TEST(Report, InitialStatesAreComparedWithThePapers) {
  const Workplace here;
  here.write("summary.json", rosy_summary().dump());
  const auto report = [&](const std::filesystem::path& scenarios) {
    const std::string text = markdown_of(here.path(), scenarios);
    const std::size_t from = text.find("Table I:");
    return text.substr(from, text.find("Section V.A: robots") - from);
  };
  EXPECT_THAT(report(kSources / "datasets/data/paper"), Not(HasSubstr("DIFFERS")));
  for (const char* name : {"A1.json", "B1.json"}) {
    json scenario = json::parse(text_of(kSources / "datasets/data/paper" / name));
    scenario["robots"][0]["radius"] = 0.4;
    scenario["robots"][1]["position"] = {24, 13};
    if (scenario.contains("formation")) {
      scenario["formation"]["leader"]["speed"] = 3.0;
      scenario["formation"]["gains"]["k1"] = 0.5;
    }
    here.write(name, scenario.dump());
  }
  const std::string changed = report(here.path());
  for (const char* words :
       {"| 0.4 DIFFERS |", "| (24, 13) DIFFERS |", "0.5, 0.45, 37.5 DIFFERS", "at 3.0000 m/s = \\|(3, 3)\\| DIFFERS"})
    EXPECT_THAT(changed, HasSubstr(words)) << changed;
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
       {"Claims", "Equations", "Table I:", "Table II:", "Section V.A", "Section V.B", "Random fields", "Ablations"})
    EXPECT_THAT(page, HasSubstr(heading));
  EXPECT_THAT(here.read("report.md"), HasSubstr("](figures/all-ivo.png)"));
}

/// What stands in elements of the page, such as <th>.
std::vector<std::string> elements_of(const std::string& page, const std::string& tag) {
  const std::regex pattern("<" + tag + ">([^<]*)</" + tag + ">");
  std::vector<std::string> all;
  for (std::sregex_iterator at(page.begin(), page.end(), pattern), end; at != end; ++at) all.push_back((*at)[1]);
  return all;
}

TEST(Report, CaptionsAreWholeSentencesInPlainWords) {
  const Workplace here;
  here.write("summary.json", rosy_summary().dump());
  write_report(ReportData(here.path(), here.path(), kSources / "datasets/data/paper"), here.path());
  const std::string page = here.read("report.html");
  const std::vector<std::string> captions = elements_of(page, "figcaption");
  for (const std::string& caption : captions) {
    EXPECT_THAT(caption, Not(testing::ContainsRegex("[_^{}*\\\\]"))) << caption;
    EXPECT_THAT(caption, testing::EndsWith("."));
    EXPECT_GE(caption.size(), 20u) << caption;
  }
  EXPECT_GE(captions.size(), 10u);
  const std::vector<std::string> heads = elements_of(page, "th");
  EXPECT_GE(heads.size(), 20u);
  EXPECT_THAT(heads, testing::Each(Not(HasSubstr("^"))));
}

TEST(Document, PicturesNameTheirPdfAndSvg) {
  const Workplace here;
  for (const char* file : {"a.png", "a.pdf", "a.svg", "b.png"}) here.write(file, "x");
  Document document("d", here.path());
  document.picture("a.png", "What it shows.");
  document.picture("b.png", "More.");
  EXPECT_THAT(document.markdown(), HasSubstr("What it shows. [PDF](a.pdf) [SVG](a.svg)"));
  const std::string page = document.html();
  EXPECT_THAT(page, HasSubstr("What it shows. <a href=\"a.pdf\">PDF</a> <a href=\"a.svg\">SVG</a></figcaption>"));
  EXPECT_THAT(page, HasSubstr("<figcaption>More.</figcaption>"));
}

TEST(Document, TextCannotBecomeMarkup) {
  Document d("a < b", ".");
  d.paragraph("1 < 2 & `x<y>`");
  d.table({"a|b"}, {{"*c*"}});
  EXPECT_THAT(d.html(), HasSubstr("1 &lt; 2 &amp; <code>x&lt;y&gt;</code>"));
  EXPECT_THAT(d.markdown(), HasSubstr("| a\\|b |"));
  EXPECT_THAT(d.markdown(), HasSubstr("\\*c\\*"));
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
