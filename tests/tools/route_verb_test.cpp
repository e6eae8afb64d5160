// SPDX-License-Identifier: GPL-3.0-or-later
// The verb `route` as a user meets it: answers, certificates and the checkers that accept them, many questions, bad
// input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Two rooms with a door of 1 m between walls 7 and 9; a desk in the right one.
constexpr const char* kRooms = R"({"name": "rooms", "robots": [{"id": "R", "position": [1, 1], "goal": [2, 1]}],
 "obstacles": [{"id": "outer wall", "polyline": [[0, 0], [12, 0], [12, 8], [0, 8], [0, 0]]},
               {"id": "7", "polyline": [[6, 0], [6, 3]]}, {"id": "9", "polyline": [[6, 4], [6, 8]]},
               {"id": "desk", "polygon": [[8, 2], [10, 2], [10, 4], [8, 4]]}]})";

/// Three walls that cross each other in points that are no doubles, round (1, 0.9).
constexpr const char* kTriangle =
    "LINESTRING (-1 0, 3 0.1)\nLINESTRING (-0.5 -0.7, 1.5 2.9)\nLINESTRING (2.6 -0.5, 0.7 2.9)\n";

/// A room with thick walls, and two boxes with a common side.
constexpr const char* kThick =
    "POLYGON ((0 0, 6 0, 6 6, 0 6, 0 0), (1 1, 5 1, 5 5, 1 5, 1 1))\n"
    "POLYGON ((10 0, 12 0, 12 2, 10 2, 10 0))\nPOLYGON ((12 0, 14 0, 14 2, 12 2, 12 0))\n";

/// A block in the middle, corridors of one cell round it.
constexpr const char* kGrid = "type octile\nheight 3\nwidth 4\nmap\n....\n.@@.\n....\n";

class Rooms {
 public:
  Rooms() {
    here.write("rooms.json", kRooms);
    here.write("triangle.wkt", kTriangle);
    here.write("thick.wkt", kThick);
    here.write("grid.map", kGrid);
  }
  Outcome route(const std::string& arguments) const { return here.run("route rooms.json " + arguments); }

  Workplace here;
};

std::vector<json> json_lines(const std::string& text) {
  std::vector<json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

// --- Answers in words ---

TEST(RouteVerb, ARouteHasItsLengthItsBoundAndItsCorners) {
  const Rooms rooms;
  const Outcome outcome = rooms.route("--from 1,1 --to 3,1 --radius 0.4");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "route: 2 m, no route is shorter than 2 m, 0 corners\nLINESTRING (1 1, 3 1)\n");
  const Outcome bent = rooms.route("--from 1,1 --to 11,7 --radius 0.4");
  EXPECT_EQ(bent.status, 0);
  EXPECT_THAT(bent.out, AllOf(StartsWith("route: 11.6"), HasSubstr(" corner")));
}

TEST(RouteVerb, ASeparationNamesItsGapsAndWhatTheWidestNeeds) {
  const Rooms rooms;
  const Outcome outcome = rooms.route("--from 1,1 --to 11,7 --radius 0.6");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.out,
            "separated, the start is enclosed: closed by 1 gap, 1 m, between wall 7 and wall 9, which would have to be "
            "1.2 m\n"
            "  gap of 1 m between wall 7 and wall 9, from (6, 3) to (6, 4)\n");
  const Outcome two = rooms.here.run("route grid.map --from 0,0 --to 3,0 --radius 0.5");
  EXPECT_EQ(two.status, 0) << two.out;
  rooms.here.write(
      "posts.wkt",
      "LINESTRING (0 0, 1 0)\nLINESTRING (1.9 0, 1.9 1)\nLINESTRING (1.5 1.5, 0 1.8)\nLINESTRING (-0.5 1.5, "
      "-0.5 0.3)\n");
  const Outcome posts = rooms.here.run("route posts.wkt --from 0.7,0.8 --to 5,5 --radius 0.6");
  EXPECT_EQ(posts.status, 1);
  EXPECT_THAT(posts.out,
              StartsWith("separated, the start is enclosed: closed by 4 gaps; the widest, 0.9 m, between wall "));
  EXPECT_THAT(posts.out, HasSubstr("would have to be 1.2 m\n  gap of "));
}

TEST(RouteVerb, AGapTooNarrowByTheLastDigitIsPrintedWithThatDigit) {
  const Rooms rooms;
  EXPECT_EQ(rooms.route("--from 1,1 --to 11,7 --radius 0.5").status, 0) << "a gap of exactly two radii is passed";
  const Outcome outcome = rooms.route("--from 1,1 --to 11,7 --radius 0.50000000000000011");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out,
              HasSubstr("1 gap, 1 m, between wall 7 and wall 9, which would have to be 1.0000000000000002 m"));
}

TEST(RouteVerb, AWallWithoutAGapIsNamedAlone) {
  const Rooms rooms;
  const Outcome outcome = rooms.route("--from 1,1 --to 20,1 --radius 0.1");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.out, "separated, the start is enclosed: closed by outer wall alone\n");
}

TEST(RouteVerb, ABlockedEndIsPrintedWithWhatBlocksItAndHowNear) {
  const Rooms rooms;
  const Outcome inside = rooms.route("--from 1,1 --to 9,3 --radius 0.4");
  EXPECT_EQ(inside.status, 1);
  EXPECT_EQ(inside.out, "blocked: the goal is inside desk\n");
  const Outcome near = rooms.route("--from 5.75,1 --to 1,1 --radius 0.4");
  EXPECT_EQ(near.status, 1);
  EXPECT_EQ(near.out, "blocked: the start is 0.25 m from wall 7 and would have to be 0.4 m\n");
  EXPECT_EQ(rooms.route("--from 6,1 --to 1,1 --radius 0.4").out, "blocked: the start is on wall 7\n");
}

TEST(RouteVerb, ABlockedEndIsNeverPrintedAsFarEnough) {
  const Rooms rooms;
  // So far from (0, 0) the distance in doubles comes out larger than the radius that it is too small for.
  rooms.here.write("far.wkt",
                   "LINESTRING (5000009.014274576 6000000.305899831, 5000009.777650406 6000016.134149286)\n");
  const std::string question =
      "route far.wkt --units metres --from 4999997.797257831,6000004.1179422075 --to 4999947,6000004 --radius ";
  EXPECT_EQ(rooms.here.run(question + "11.387630414779485").out,
            "blocked: the start is less than 11.387630414779485 m from wall 1 and would have to be 11.387630414779485 "
            "m\n");
  EXPECT_EQ(rooms.here.run(question + "11.3").status, 0);
}

TEST(RouteVerb, TheWidestRadiusIsTheLargestDoubleWithARoute) {
  const Rooms rooms;
  rooms.here.write("door.wkt",
                   "LINESTRING (0 -5, 0.13 -0.31)\nLINESTRING (0.21 0.4, 0 5)\nLINESTRING (0 5, 9 5, 9 -5, 0 -5)\n");
  const Outcome widest = rooms.here.run("route door.wkt --from 4,1 --to -4,1 --widest --json");
  EXPECT_EQ(widest.status, 0);
  const double radius = json::parse(widest.out).at("widest_radius");
  EXPECT_NEAR(radius, 0.5 * std::hypot(0.08, 0.71), 1e-12);
  const auto status = [&](double r) {
    std::ostringstream text;
    text.precision(17);
    text << r;
    return rooms.here.run("route door.wkt --from 4,1 --to -4,1 --radius " + text.str()).status;
  };
  EXPECT_EQ(status(radius), 0);
  EXPECT_EQ(status(std::nextafter(radius, 1.0)), 1);
  EXPECT_EQ(rooms.route("--from 1,1 --to 11,7 --widest").out, "widest radius: 0.5 m\n");
  const Outcome none = rooms.route("--from 1,1 --to 9,3 --widest");
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.out, "blocked: the goal is inside desk\nwidest radius: 0 m\n");
}

TEST(RouteVerb, WhereNoDiscHasARouteAPointSaysWhyWithACertificate) {
  const Rooms rooms;
  rooms.here.write("box.wkt", "LINESTRING (0 0, 4 0, 4 4)\nLINESTRING (4 4, 0 4, 0 0)\n");
  rooms.here.write("q.csv", "start_x,start_y,goal_x,goal_y\n1,1,3,3\n1,1,6,6\n9,9,1,1\n");
  EXPECT_EQ(rooms.here.run("route box.wkt --queries q.csv --widest").out,
            "0: widest radius: 1 m\n"
            "1: separated, the start is enclosed: closed by 2 obstacles without a gap: wall 1, wall 2; widest radius: "
            "0 m\n"
            "2: separated, the goal is enclosed: closed by 2 obstacles without a gap: wall 1, wall 2; widest radius: "
            "0 m\n");
  rooms.here.write("answers.jsonl", rooms.here.run("route box.wkt --queries q.csv --widest --json").out);
  const Outcome audit = rooms.here.run("audit --certificate answers.jsonl");
  EXPECT_EQ(audit.status, 0) << audit.out;
  EXPECT_THAT(audit.out, HasSubstr("2 certificates, 2 valid"));
}

TEST(RouteVerb, TheWidestRadiusIsNotBoundByTheMap) {
  const Rooms rooms;
  // Only their distance from the room holds the disc back: 100 m, nine times the size of the map.
  EXPECT_EQ(rooms.route("--from=-100,0 --to=-100,8 --widest").out, "widest radius: 100 m\n");
  rooms.here.write("q.csv", "start_x,start_y,goal_x,goal_y\n-45,0,-45,8\n");
  EXPECT_EQ(rooms.route("--queries q.csv --widest").out, "0: widest radius: 45 m\n");
}

// Radius 0 was refused.
TEST(RouteVerb, APointPassesWhereSomeDiscDoesAndTouchesNothing) {
  const Rooms rooms;
  // The corners (1, 1) and (2, 2) lie on either side of the place where two blocked cells touch.
  rooms.here.write("open.map", "type octile\nheight 4\nwidth 4\nmap\n....\n..@.\n.@..\n....\n");
  const Outcome round = rooms.here.run("route open.map --from 1,1 --to 2,2 --radius 0 --cell-point corner --json");
  EXPECT_EQ(round.status, 0) << round.err;
  EXPECT_NEAR(json::parse(round.out).at("length"), 4.0, 1e-9);  // by (3, 1) and (3, 2), or (1, 3) and (2, 3)
  rooms.here.write("round.jsonl", round.out);
  EXPECT_EQ(rooms.here.run("audit --certificate round.jsonl").status, 0);
  rooms.here.write("shut.map", "type octile\nheight 4\nwidth 4\nmap\n..@@\n..@@\n@@..\n@@..\n");
  const Outcome shut = rooms.here.run("route shut.map --from 1,1 --to 2,2 --radius 0 --cell-point corner");
  EXPECT_EQ(shut.status, 1) << "a gap without width";
  EXPECT_THAT(shut.out, HasSubstr("without a gap"));
}

// An end on an edge or a corner was said to be blocked.
TEST(RouteVerb, APointMayStartAndEndInContact) {
  const Rooms rooms;
  EXPECT_THAT(rooms.route("--from 6,1 --to 1,1 --radius 0").out, StartsWith("route: 5 m, "));
  EXPECT_THAT(rooms.route("--from 6,1 --to 6,1 --radius 0").out, StartsWith("route: 0 m, "));
  EXPECT_THAT(rooms.route("--from 8,2 --to 10,4 --radius 0").out, StartsWith("route: 4 m, "));
  const auto thick = [&](const std::string& ends) { return rooms.here.run("route thick.wkt " + ends); };
  EXPECT_THAT(thick("--from 1,3 --to 6,3 --radius 0").out, StartsWith("separated, the start is enclosed: "));
  EXPECT_THAT(thick("--from 0.5,3 --to 6,3 --radius 0").out, StartsWith("blocked: the start is inside "));
  const Outcome shared = thick("--from 9,9 --to 12,1 --radius 0");
  EXPECT_EQ(shared.status, 1);
  EXPECT_EQ(shared.out, "blocked: the goal is on polygon 2, with obstacles on every side of it\n");
  // No disc gets away from a wall that its middle lies on: that is what --widest asks for.
  const Outcome widest = rooms.route("--from 6,1 --to 1,1 --widest --json");
  EXPECT_EQ(widest.status, 1);
  const json answer = json::parse(widest.out);
  EXPECT_EQ(answer.at("widest_radius"), 0.0);
  EXPECT_EQ(answer.at("status"), "route");
  rooms.here.write("widest.json", widest.out);
  EXPECT_EQ(rooms.here.run("audit --certificate widest.json").status, 0);
}

TEST(RouteVerb, TheEnclosedEndIsNamed) {
  const Rooms rooms;
  const Outcome outcome = rooms.route("--from 20,1 --to 1,1 --radius 0.1 --json");
  EXPECT_EQ(json::parse(outcome.out).at("enclosed"), "goal");
  EXPECT_THAT(rooms.route("--from 20,1 --to 1,1 --radius 0.1").out, StartsWith("separated, the goal is enclosed: "));
}

// --- Certificates: accepted as they are, rejected where they were changed ---

struct Case {
  std::string name, arguments;
};

const Case kCases[] = {{"route", "rooms.json --from 1,1 --to 11,7 --radius 0.45"},
                       {"separated", "rooms.json --from 1,1 --to 11,7 --radius 0.6"},
                       {"fractions", "triangle.wkt --from 1,0.9 --to 5,5 --radius 0.1"},
                       {"fractions in a route", "triangle.wkt --from 4,1 --to -1,1 --radius 0.1"},
                       {"blocked", "rooms.json --from 5.75,1 --to 1,1 --radius 0.4"},
                       {"inside", "rooms.json --from 1,1 --to 9,3 --radius 0.4"},
                       {"a point's route", "rooms.json --from 1,1 --to 11,7 --radius 0"},
                       {"a point that is separated", "triangle.wkt --from 1,0.9 --to 5,5 --radius 0"},
                       {"a point in contact", "rooms.json --from 6,1 --to 1,1 --radius 0"},
                       {"a point between corners in contact", "rooms.json --from 6,3 --to 10,4 --radius 0"},
                       {"a point in contact inside of a room", "thick.wkt --from 1,3 --to 6,3 --radius 0"},
                       {"a point between two boxes", "thick.wkt --from 12,1 --to 9,9 --radius 0"},
                       {"a disc in contact", "rooms.json --from 7.5,3 --to 6.5,1 --radius 0.5"}};

/// What was changed, and the certificate that came of it; each claims what is false or not shown.
using Mutants = std::vector<std::pair<std::string, json>>;

void add_mutants_of_route(const json& certificate, Mutants& mutants) {
  const auto change = [&](const std::string& what, const auto& edit) {
    mutants.emplace_back(what, certificate);
    edit(mutants.back().second);
  };
  for (std::size_t k = 0; k < certificate.at("points").size(); ++k) {
    const std::string at = "point " + std::to_string(k);
    change(at + " dropped", [&](json& c) { c["points"].erase(k); });
    change(at + " moved onto a wall", [&](json& c) { c["points"][k] = {6.0, 2.0}; });
  }
  change("the radius enlarged", [](json& c) { c["radius"] = 1.01 * c["radius"].get<double>() + 1e-6; });
  change("the length changed", [](json& c) { c["length"] = 1.001 * c["length"].get<double>(); });
  change("a bound above the length", [](json& c) { c["lower_bound"] = 2.0 * c["length"].get<double>(); });
  change("another goal", [](json& c) { c["goal"][0] = 10.75; });
  change("no points", [](json& c) { c["points"] = json::array(); });
}

void add_mutants_of_chain(const json& certificate, Mutants& mutants) {
  const auto change = [&](const std::string& what, const auto& edit) {
    mutants.emplace_back(what, certificate);
    edit(mutants.back().second);
  };
  for (std::size_t k = 0; k < certificate.at("chain").size(); ++k) {
    const std::string at = "point " + std::to_string(k);
    change(at + " dropped", [&](json& c) { c["chain"].erase(k); });
    change(at + " moved", [&](json& c) {
      c["chain"][k]["point"] = {c["chain"][k]["point"][0].get<double>() + 0.01,
                                c["chain"][k]["point"][1].get<double>() + 0.02};
    });
    change(at + " on another edge", [&](json& c) { c["chain"][k]["obstacle"] = 77; });
    if (certificate["chain"][k]["gap"]) change(at + " without its gap", [&](json& c) { c["chain"][k]["gap"] = false; });
    if (certificate["chain"][k]["point"].size() == 4)
      change(at + " with a fraction of another value", [&](json& c) { c["chain"][k]["point"][2] = "1/3"; });
  }
  change("the goal on the start's side", [](json& c) { c["goal"] = c["start"]; });
}

Mutants mutants_of(const json& certificate) {
  Mutants mutants;
  const std::string kind = certificate.at("kind");
  if (kind == "route") add_mutants_of_route(certificate, mutants);
  if (kind == "separated") add_mutants_of_chain(certificate, mutants);
  if (kind == "blocked") {
    json freed = certificate;
    freed["start"] = freed["goal"] = {3.0, 3.0};
    mutants.emplace_back("an end that is free", freed);
  }
  for (const char* key : {"radius", "start", "goal", "kind"}) {
    json without = certificate;
    without.erase(key);
    mutants.emplace_back(std::string("no ") + key, without);
  }
  return mutants;
}

json answer_to(const Rooms& rooms, const Case& c) {
  const Outcome outcome = rooms.here.run("route " + c.arguments + " --json");
  EXPECT_LE(outcome.status, 1) << c.name << outcome.err;
  return json::parse(outcome.out);
}

/// The answer of a case as it is, then every change of its certificate, a line each.
std::string lines_of(const json& answer, const Mutants& mutants) {
  std::string text = answer.dump() + "\n";
  for (const auto& [what, certificate] : mutants) text += json{{"certificate", certificate}}.dump() + "\n";
  return text;
}

TEST(RouteCertificates, AuditAcceptsEachKindAndRejectsEachChange) {
  const Rooms rooms;
  for (const Case& c : kCases) {
    const json answer = answer_to(rooms, c);
    const Mutants mutants = mutants_of(answer.at("certificate"));
    ASSERT_GE(mutants.size(), 5u);
    rooms.here.write("answers.jsonl", lines_of(answer, mutants));
    const Outcome outcome = rooms.here.run("audit --certificate answers.jsonl --json");
    EXPECT_EQ(outcome.status, 1);
    const json judged = json::parse(outcome.out);
    EXPECT_EQ(judged.at("verdicts").at(0), "valid") << c.name << ": " << answer;
    ASSERT_EQ(judged.at("verdicts").size(), mutants.size() + 1);
    for (std::size_t k = 0; k < mutants.size(); ++k)
      EXPECT_NE(judged.at("verdicts").at(k + 1), "valid") << c.name << ", " << mutants[k].first << mutants[k].second;
    rooms.here.write("answer.json", answer.dump());
    EXPECT_EQ(rooms.here.run("audit --certificate answer.json").status, 0);
    rooms.here.write("certificate.json", answer.at("certificate").dump(1));
    EXPECT_EQ(rooms.here.run("audit --certificate certificate.json").status, 0) << "without what stands beside it";
  }
}

bool has_python() {
  static const bool has = std::system("python3 -c 'import math; math.nextafter' >/dev/null 2>&1") == 0;
  return has;
}

/// Its verdicts, a line each, after a line feed.
std::string python_verdicts(const Workplace& here, const std::string& text) {
  here.write("answers.jsonl", text);
  const std::string command = "cd '" + here.path().string() + "' && python3 '" EXACTVO_CHECK_ROUTE "' answers.jsonl";
  EXPECT_NE(std::system((command + " >verdicts").c_str()), 0);
  return "\n" + here.read("verdicts");
}

TEST(RouteCertificates, ThePythonCheckerAcceptsEachKindAndRejectsEachChange) {
  if (!has_python()) GTEST_SKIP() << "no python3 with math.nextafter (3.9)";
  const Rooms rooms;
  for (const Case& c : kCases) {
    const json answer = answer_to(rooms, c);
    const Mutants mutants = mutants_of(answer.at("certificate"));
    const std::string verdicts = python_verdicts(rooms.here, lines_of(answer, mutants));
    EXPECT_THAT(verdicts, Not(HasSubstr("\n1: not proven"))) << c.name;
    for (std::size_t k = 0; k < mutants.size(); ++k)
      EXPECT_THAT(verdicts, HasSubstr("\n" + std::to_string(k + 2) + ": not proven"))
          << c.name << ", " << mutants[k].first << ": " << mutants[k].second;
    EXPECT_THAT(verdicts, HasSubstr("\n" + std::to_string(mutants.size() + 1) + " certificates, 1 proven\n"));
  }
}

TEST(RouteCertificates, ObstaclesThatCannotBeReadAreNotReplacedByThoseBefore) {
  const Rooms rooms;
  const json answer = answer_to(rooms, kCases[0]);
  json spoilt = answer, later = answer;
  spoilt["certificate"]["obstacles"][0] = {{"id", "outer wall"}};
  later["certificate"].erase("obstacles");
  const std::string text = answer.dump() + "\n" + spoilt.dump() + "\n" + later.dump() + "\n";
  rooms.here.write("answers.jsonl", text);
  const Outcome outcome = rooms.here.run("audit --certificate answers.jsonl");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("2: obstacles that cannot be read"), HasSubstr("3: no obstacles"),
                                 HasSubstr("3 certificates, 1 valid")));
  if (!has_python()) return;
  EXPECT_THAT(python_verdicts(rooms.here, text), HasSubstr("3 certificates, 1 proven"));
}

TEST(RouteCertificates, CrossingsThatAreNoDoublesStandAsFractions) {
  const Rooms rooms;
  const json answer = answer_to(rooms, kCases[2]);
  EXPECT_EQ(answer.at("status"), "separated");
  std::size_t fractions = 0;
  for (const json& point : answer.at("certificate").at("chain")) fractions += point.at("point").size() == 4 ? 1 : 0;
  EXPECT_GE(fractions, 3u);
}

TEST(RouteCertificates, ThePythonCheckerSaysThatAFileIsMissing) {
  if (!has_python()) GTEST_SKIP() << "no python3 with math.nextafter (3.9)";
  const Workplace here;
  const std::string command = "cd '" + here.path().string() + "' && python3 '" EXACTVO_CHECK_ROUTE "' missing.jsonl";
  EXPECT_EQ(WEXITSTATUS(std::system((command + " 2>said").c_str())), 2) << "1 would say that a certificate is wrong";
  EXPECT_THAT(here.read("said"), AllOf(HasSubstr("missing.jsonl"), Not(HasSubstr("Traceback"))));
}

/// The exit statuses of both checkers for a file; of the one in Python nothing where there is no Python.
struct Statuses {
  int audit;
  std::optional<int> python;
};
Statuses statuses_of(const Workplace& here, const std::string& text) {
  here.write("f.jsonl", text);
  Statuses out{here.run("audit --certificate f.jsonl").status, std::nullopt};
  if (!has_python()) return out;
  const std::string command = "cd '" + here.path().string() + "' && python3 '" EXACTVO_CHECK_ROUTE "' f.jsonl";
  out.python = WEXITSTATUS(std::system((command + " >/dev/null 2>&1").c_str()));
  return out;
}

void expect_of_both(const Workplace& here, const std::string& text, int status, const std::string& what) {
  const Statuses found = statuses_of(here, text);
  EXPECT_EQ(found.audit, status) << what;
  EXPECT_EQ(found.python.value_or(status), status) << what << ", in Python";
}

// The claim that is printed is the certificate's, whatever stands next to it.
TEST(RouteCertificates, TheVerdictIsOnTheCertificateAlone) {
  const Rooms rooms;
  json answer = answer_to(rooms, kCases[0]);
  rooms.here.write("true.jsonl", answer.dump());
  const std::string judged = rooms.here.run("audit --certificate true.jsonl").out;
  EXPECT_THAT(judged, HasSubstr("1: valid; a route of"));
  answer["radius"] = 5.0;
  answer["length"] = 1.0;
  rooms.here.write("lies.jsonl", answer.dump());
  EXPECT_EQ(rooms.here.run("audit --certificate lies.jsonl").out, judged);
  expect_of_both(rooms.here, answer.dump() + "\n", 0, "lies next to a certificate");
}

// Such an answer counted as nothing, and the exit status was 0.
TEST(RouteCertificates, AnAnswerWhoseCertificateWasRemovedIsNotProven) {
  const Rooms rooms;
  for (const Case& c : {kCases[0], kCases[1], kCases[4]}) {
    json without = answer_to(rooms, c), null = without;
    without.erase("certificate");
    null["certificate"] = nullptr;
    expect_of_both(rooms.here, without.dump() + "\n", 1, "without");
    expect_of_both(rooms.here, null.dump() + "\n", 1, "null");
    rooms.here.write("null.json", null.dump());
    EXPECT_THAT(rooms.here.run("audit --certificate null.json").out, HasSubstr("1: no certificate\n1 certificate, 0"));
  }
}

// Readers differ in which of two members of one name counts; the checkers differed in what else they took.
TEST(RouteCertificates, BothCheckersTakeAndRefuseTheSame) {
  const Rooms rooms;
  const json route = answer_to(rooms, kCases[0]);
  const std::string text = route.dump(), mark = "\xEF\xBB\xBF";
  const auto with_obstacles = [&](const json& obstacles) {
    json changed = route;
    changed["certificate"]["obstacles"] = obstacles;
    return changed.dump() + "\n";
  };
  expect_of_both(rooms.here, mark + text + "\n", 0, "a byte order mark");
  expect_of_both(rooms.here, route.dump(1), 0, "over several lines");
  expect_of_both(rooms.here, json::array({route}).dump(), 0, "a list");
  expect_of_both(rooms.here, "[]\n", 2, "an empty list");
  expect_of_both(rooms.here, text.substr(0, text.size() - 1) + ",\"status\":\"route\"}\n", 1, "a member twice");
  expect_of_both(rooms.here, text.substr(0, text.size() - 2) + ",\"obstacles\":[]}}\n", 1, "obstacles twice");
  expect_of_both(rooms.here, with_obstacles(json::object()), 1, "an object of obstacles");
  // Python reads NaN, and no comparison with it is true.
  const std::size_t length = text.find("\"length\":") + 9;
  expect_of_both(rooms.here, text.substr(0, length) + "NaN" + text.substr(text.find(',', length)) + "\n", 1,
                 "length NaN");
  expect_of_both(rooms.here, with_obstacles(nullptr), 1, "obstacles null");
  expect_of_both(rooms.here, with_obstacles(json::parse(R"([{"polyline": []}])")), 1, "a wall of no point");
  expect_of_both(rooms.here, with_obstacles(json::parse(R"([{"polyline": [[99, 99]]}])")), 1, "a wall of one point");
  expect_of_both(
      rooms.here,
      with_obstacles(json::parse(R"([{"polyline": [[99, 99], [98, 99]], "polygon": [[90, 90], [91, 90], [91, 91]]}])")),
      1, "a wall that is a polygon");
  expect_of_both(rooms.here, "{\"certificate\":" + std::string(100000, '[') + std::string(100000, ']') + "}\n", 1,
                 "deep");
  const json blocked = [&] {
    for (const Case& c : kCases)
      if (json answer = answer_to(rooms, c); answer.at("status") == "blocked") return answer;
    return json();
  }();
  for (const json& number : {json(-1), json(false), json(0.0)}) {
    json changed = blocked;
    changed["certificate"]["obstacle"] = number;
    expect_of_both(rooms.here, changed.dump() + "\n", 1, "obstacle " + number.dump());
  }
  // A fraction more than a place away from its double, and one with blanks.
  ASSERT_GE(route.at("certificate").at("points").size(), 3u);
  const json& corner = route.at("certificate").at("points").at(1);
  for (const char* fraction : {" 3 ", "3/0", "1e0", "+3"}) {
    json changed = route;
    changed["certificate"]["points"][1] = {corner[0], corner[1], fraction, ""};
    expect_of_both(rooms.here, changed.dump() + "\n", 1, fraction);
  }
}

TEST(RouteCertificates, ObstaclesStandInTheFirstOneOfAFile) {
  const Rooms rooms;
  rooms.here.write("q.csv", "start_x,start_y,goal_x,goal_y\n1,1,3,1\n1,1,11,7\n");
  const Outcome outcome = rooms.route("--queries q.csv --radius 0.6 --json");
  const std::vector<json> lines = json_lines(outcome.out);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].at("certificate").contains("obstacles"));
  EXPECT_FALSE(lines[1].at("certificate").contains("obstacles"));
  rooms.here.write("both.jsonl", outcome.out);
  EXPECT_EQ(rooms.here.run("audit --certificate both.jsonl --json").out,
            "{\"certificates\": 2, \"valid\": 2, \"none\": 0, \"verdicts\": [\"valid\", \"valid\"]}\n");
  rooms.here.write("second.jsonl", lines[1].dump());
  const Outcome second = rooms.here.run("audit --certificate second.jsonl");
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.out, HasSubstr("no obstacles: neither in it nor in one before it"));
  if (has_python()) {
    EXPECT_THAT(python_verdicts(rooms.here, lines[1].dump()), HasSubstr("no obstacles: neither in it nor"));
  }
  rooms.here.write("cut.jsonl", outcome.out.substr(0, outcome.out.size() - 9));
  EXPECT_THAT(rooms.here.run("audit --certificate cut.jsonl").out, HasSubstr("2: unreadable JSON"));
}

// --- Many questions ---

TEST(RouteQueries, EachLineOfATableIsAnsweredByALine) {
  const Rooms rooms;
  const std::string table =
      "name,goal_x,goal_y,start_x,start_y\n\n# a remark\nfar,11,7,1,1\nnear,3,1,1,1\ndesk,9,3,1,1\n";
  rooms.here.write("q.csv", table);
  const Outcome words = rooms.route("--queries q.csv --radius 0.6 --widest");
  EXPECT_EQ(words.status, 1) << "two of them are no route";
  EXPECT_EQ(words.out,
            "0: separated, the start is enclosed: closed by 1 gap, 1 m, between wall 7 and wall 9, which would have to "
            "be 1.2 m; widest radius: "
            "0.5 m\n"
            "1: route: 2 m, no route is shorter than 2 m, 0 corners; widest radius: 1 m\n"
            "2: blocked: the goal is inside desk; widest radius: 0 m\n");
  const std::vector<json> lines = json_lines(rooms.route("--queries - --radius 0.6 --json < q.csv").out);
  ASSERT_EQ(lines.size(), 3u);
  const char* const statuses[] = {"separated", "route", "blocked"};
  for (std::size_t k = 0; k < lines.size(); ++k) {
    EXPECT_EQ(lines[k].at("index"), k);
    EXPECT_EQ(lines[k].at("status"), statuses[k]);
    EXPECT_EQ(lines[k].at("length").is_null(), k != 1);
    EXPECT_EQ(lines[k].at("points").is_null(), k != 1);
  }
  EXPECT_EQ(lines[0].at("needed_width"), 1.2);
  EXPECT_EQ(lines[0].at("gaps"), json::parse(R"([{"width": 1.0, "from": [6.0, 3.0], "to": [6.0, 4.0],
                                                  "between": ["7", "9"]}])"));
  EXPECT_EQ(lines[1].at("length"), 2.0);
  EXPECT_EQ(lines[2].at("blocked").at("obstacle"), "desk");
  rooms.here.write("near.csv", "start_x,start_y,goal_x,goal_y\n1,1,3,1\n");
  EXPECT_EQ(rooms.route("--queries near.csv --radius 0.6").status, 0);
  rooms.here.write("none.csv", "start_x,start_y,goal_x,goal_y\n");
  EXPECT_EQ(rooms.route("--queries none.csv --radius 0.6").out, "");
}

TEST(RouteQueries, CellsOfAMovingAiMapAreCountedFromItsTopLeftCorner) {
  const Rooms rooms;
  rooms.here.write("grid.map.scen", "version 1\n0\tgrid.map\t4\t3\t0\t0\t3\t2\t5\n0\tgrid.map\t4\t3\t1\t0\t2\t0\t1\n");
  const Outcome outcome = rooms.here.run("route grid.map --queries grid.map.scen --radius 0.5 --json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("points are middles of cells"));
  const std::vector<json> lines = json_lines(outcome.out);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].at("start"), json({0.5, 2.5}));
  EXPECT_EQ(lines[0].at("goal"), json({3.5, 0.5}));
  EXPECT_EQ(lines[1].at("points").front(), json({1.5, 2.5}));
  EXPECT_EQ(lines[1].at("points").back(), json({2.5, 2.5}));
  EXPECT_NEAR(lines[1].at("length"), 1.0, 1e-12);
  const json same = json::parse(rooms.here.run("route grid.map --from 0,0 --to 3,2 --radius 0.5 --json").out);
  EXPECT_EQ(same.at("start"), lines[0].at("start"));
  EXPECT_EQ(same.at("length"), lines[0].at("length"));
  const json corner = json::parse(
      rooms.here.run("route grid.map --from 0.5,0.5 --to 3,0.5 --radius 0.5 --cell-point corner --json").out);
  EXPECT_EQ(corner.at("start"), json({0.5, 2.5}));
  EXPECT_EQ(corner.at("goal"), json({3.0, 2.5}));
  EXPECT_EQ(
      json::parse(rooms.here.run("route grid.map --from 0,0 --to 3,2 --radius 1 --cell-size 2 --json").out).at("goal"),
      json({7.0, 1.0}));
}

TEST(RouteQueries, WhatLiesOutsideOfAMovingAiMapIsOutOfBounds) {
  const Rooms rooms;
  const Outcome outcome = rooms.here.run("route grid.map --from 0,0 --to 3,2 --radius 0.51");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("blocked: the start is 0.5 m from the border of the map"));
  // The only other way would lead round the map.
  rooms.here.write("halves.map", "type octile\nheight 1\nwidth 3\nmap\n.@.\n");
  EXPECT_THAT(rooms.here.run("route halves.map --from 0,0 --to 2,0 --radius 0.25").out, StartsWith("separated, the "));
}

// --- Figures ---

TEST(RouteFigures, ShowTheAnswerWithStartAndGoal) {
  const Rooms rooms;
  const std::pair<const char*, const char*> cases[] = {{"0.4", "has a route of 11.6"}, {"0.6", "has no route"}};
  for (const auto& [radius, title] : cases) {
    const Outcome outcome = rooms.route(std::string("--from 1,1 --to 11,7 --figure out/f.svg --radius ") + radius);
    EXPECT_LE(outcome.status, 1) << outcome.err;
    EXPECT_THAT(rooms.here.read("out/f.gp"), AllOf(HasSubstr(title), HasSubstr("disc at the goal")));
    EXPECT_TRUE(rooms.here.has("out/f.png"));
  }
  EXPECT_THAT(rooms.here.read("out/f.dat"), HasSubstr("1 m"));
  EXPECT_EQ(rooms.route("--from 1,1 --to 9,3 --figure out/f.svg --radius 0.6").status, 1);
  EXPECT_THAT(rooms.here.read("out/f.gp"), HasSubstr("does not fit at the goal"));
}

// --- Bad input ---

TEST(RouteVerb, BadInputIsRefusedWithItsPlace) {
  const Rooms rooms;
  rooms.here.write("bow.wkt", "POLYGON ((0 0, 2 2, 2 0, 0 2, 0 0))\n");
  rooms.here.write("empty.wkt", "");
  rooms.here.write("empty.csv", "");
  rooms.here.write("words.csv", "a,b\n1,1,3,1\n");
  rooms.here.write("twice.csv", "start_x,start_y,goal_x,goal_y,start_x\n1,1,3,1,2\n");
  rooms.here.write("nan.csv", "start_x,start_y,goal_x,goal_y\n1,1,3,1\n1,1,nan,1\n");
  rooms.here.write("short.csv", "start_x,start_y,goal_x,goal_y\n1,1,3\n");
  rooms.here.write("far.csv", "start_x,start_y,goal_x,goal_y\n1,1,1e6,1\n");
  rooms.here.write("other.scen", "version 1\n0\tgrid.map\t4\t4\t0\t0\t3\t2\t5\n");
  rooms.here.write("beyond.scen", "version 1\n0\tgrid.map\t4\t3\t0\t0\t3\t3\t5\n");
  const std::pair<std::string, std::string> cases[] = {
      {"rooms.json --to 3,1 --radius 1", "--from: found 'nothing'"},
      {"rooms.json --from 3,1 --radius 1", "--to: found 'nothing'"},
      {"rooms.json --from 3,1 --to 4,1", "--radius: found 'nothing'"},
      {"rooms.json --from 3 --to 4,1 --radius 1", "--from: found '3', expected two numbers"},
      {"rooms.json --from nan,1 --to 4,1 --radius 1", "--from: found 'nan,1', expected two numbers"},
      {"rooms.json --from 3,1 --to 4,1e40 --radius 1", "--to: found '4,1e40', expected two numbers within 2^100"},
      {"rooms.json --from 3,1 --to 4,1 --radius=-1",
       "--radius: found '-1', expected 0 (a point), or a length from 2^-100 m"},
      {"rooms.json --from 3,1 --to 4,1 --radius=-1", "--radius: found '-1'"},
      {"rooms.json --from 3,1 --to 4,1 --radius nan", "--radius: found 'nan'"},
      {"rooms.json --from 3,1 --to 4,1 --radius inf", "--radius: found 'inf'"},
      {"rooms.json --from 3,1 --queries nan.csv --radius 1", "--queries cannot be combined with --from: give one"},
      {"rooms.json --queries nan.csv --radius 1 --figure f.svg",
       "--figure cannot be combined with --queries: a figure"},
      {"rooms.json --from 3,1 --to 4,1 --widest --figure f.svg", "--figure needs --radius: it draws the disc"},
      {"rooms.json --queries empty.csv --radius 1", "empty.csv: found an empty file, expected a header"},
      {"rooms.json --queries words.csv --radius 1",
       "words.csv: line 1: found no column \"start_x\", expected a header"},
      {"rooms.json --queries twice.csv --radius 1", "twice.csv: line 1: found column \"start_x\" a second time"},
      {"rooms.json --queries nan.csv --radius 1", "nan.csv: line 3: found nan, expected a number in the column goal_x"},
      {"rooms.json --queries short.csv --radius 1",
       "short.csv: line 2: found 3 fields, expected 4, as many as the header has [E_COUNT]"},
      {"rooms.json --queries far.csv --radius 1", "far.csv: line 2: found the goal 1000000,1, expected a point within"},
      {"rooms.json --queries other.scen --radius 1", "other.scen: line 1: found cells of a Moving AI map"},
      {"grid.map --queries other.scen --radius 0.2", "found a task for a map of 4 x 4 cells, expected 4 x 3 cells"},
      {"grid.map --queries beyond.scen --radius 0.2", "beyond.scen: line 2: found the goal 3,3, expected a cell"},
      {"grid.map --from 4,1 --to 0,0 --radius 0.2", "--from: found '4,1', expected a cell of the map"},
      {"grid.map --from 0,0 --to 3,2 --radius 0.2 --cell-point midle", "--cell-point: found 'midle'"},
      {"nowhere.wkt --from 3,1 --to 4,1 --radius 1", "nowhere.wkt: found no such file"},
      {"empty.wkt --from 3,1 --to 4,1 --radius 1", "[E_FORMAT_UNKNOWN]"},
      {"bow.wkt --from 3,1 --to 4,1 --radius 1", "bow.wkt: line 1, column 1, ring 0, vertex 0: found a ring that"}};
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = rooms.here.run("route " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << arguments;
  }
  EXPECT_EQ(rooms.here.run("route bow.wkt --from 3,1 --to 4,1 --radius 0.5 --repair").status, 0);
}

TEST(RouteVerb, PointsFarFromTheMapAreAnswered) {
  const Rooms rooms;
  EXPECT_EQ(rooms.route("--from 1e6,1 --to -1e9,7 --radius 0.4").status, 0);
  EXPECT_EQ(rooms.route("--from 1e6,1 --to 3,1 --radius 0.4").status, 1);
  EXPECT_EQ(rooms.route("--from 1e6,1 --to -1e6,7 --radius 500").status, 0);
}

TEST(RouteVerb, AMapWithoutObstaclesIsOneStraightLine) {
  const Rooms rooms;
  rooms.here.write("none.wkt", "GEOMETRYCOLLECTION EMPTY\n");
  const Outcome outcome = rooms.here.run("route none.wkt --from 0,0 --to 3,4 --radius 1");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("LINESTRING (0 0, 3 4)"));
  EXPECT_THAT(outcome.err, HasSubstr("none.wkt: no obstacle in it"));
}

// The widest radius was 20 m there, and queries refused points that --from took.
TEST(RouteVerb, WithoutObstaclesAnyRadiusAndAnyPointWillDo) {
  const Rooms rooms;
  rooms.here.write("none.wkt", "GEOMETRYCOLLECTION EMPTY\n");
  rooms.here.write("q.csv", "start_x,start_y,goal_x,goal_y\n0,0,3e6,4e6\n");
  EXPECT_EQ(rooms.here.run("route none.wkt --from 0,0 --to 3,4 --widest").out,
            "widest radius: any, there is no obstacle\n");
  const Outcome many = rooms.here.run("route none.wkt --queries q.csv --radius 1");
  EXPECT_EQ(many.status, 0) << many.err;
  EXPECT_THAT(many.out, HasSubstr("route: 5e+06 m"));
}

// The C library read them, which knows other numbers, and commas for points in some languages.
TEST(RouteVerb, PointsAreReadAsTheNumbersOfTables) {
  const Rooms rooms;
  for (const char* start : {"'1,1 '", "' 1, 1'", "+1,1e0"})
    EXPECT_EQ(rooms.route(std::string("--to 3,1 --radius 0.4 --from ") + start).status, 0) << start;
  for (const char* start : {"0x1p0,1", "'1 1'", "1,1,1", "1,", "1,1m"})
    EXPECT_EQ(rooms.route(std::string("--to 3,1 --radius 0.4 --from ") + start).status, 2) << start;
}

TEST(RouteVerb, DegreesAreProjectedAndItIsReported) {
  const Rooms rooms;
  rooms.here.write(
      "yard.geojson",
      R"({"type": "Polygon", "coordinates": [[[13, 52], [13.001, 52], [13.001, 52.001], [13, 52.001], [13, 52]]]})");
  const Outcome outcome = rooms.here.run("route yard.geojson --from=-60,0 --to 60,0 --radius 1");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("projected from degrees to metres, centred on longitude 13.0005"));
}

TEST(RouteVerb, MovingObstaclesAreLeftOutAloud) {
  const Rooms rooms;
  json scenario = json::parse(kRooms);
  scenario["moving_obstacles"] = json::parse(
      R"([{"id": "cart", "polygon": [[2, 2], [3, 2], [3, 3], [2, 3]], "path": [[0, 0], [1, 0]], "speed": 0.1}])");
  rooms.here.write("moving.json", scenario.dump());
  EXPECT_THAT(rooms.here.run("route moving.json --from 1,1 --to 3,1 --radius 0.1").err,
              HasSubstr("1 moving obstacle left out"));
}

}  // namespace
}  // namespace exactvo::test
