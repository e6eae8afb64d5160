// SPDX-License-Identifier: GPL-3.0-or-later
// `exactvo vo --velocities`: many velocities in one call; and the legs of one obstacle in words.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "exactvo/vo/velocity_obstacle.h"
#include "support/seeded_random.h"
#include "vo/verb_vo.h"

namespace exactvo::test {
namespace {

using geometry::Vec2;
using testing::HasSubstr;

const std::string kSquareAhead = "vo --obstacle '" + kSquare + "' --position 0,0 --radius 0.3 --time-horizon 3 ";

std::vector<json> json_lines(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
  return lines;
}

std::string digits(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

TEST(VerbVo, WordsNameTheLegs) {
  const std::string arguments =
      "--obstacle '" + kSquare + "' --position 0,0 --velocity 1,0.2 --radius 0.3 --time-horizon 3";
  const std::string words = words_of(arguments);
  const json legs = json_of(arguments).at("legs");
  ASSERT_EQ(legs.size(), 2u);
  for (const json& leg : legs) {
    const std::size_t line = words.find(leg.at("side").get<std::string>() + " leg ");
    ASSERT_NE(line, std::string::npos) << words;
    Vec2 direction, touch;
    ASSERT_EQ(std::sscanf(words.c_str() + words.find('(', line), "(%lf, %lf), touches at (%lf, %lf) m from the robot",
                          &direction.x, &direction.y, &touch.x, &touch.y),
              4)
        << words;
    EXPECT_NEAR(direction.x, leg.at("direction")[0].get<double>(), 1e-5);
    EXPECT_NEAR(direction.y, leg.at("direction")[1].get<double>(), 1e-5);
    EXPECT_NEAR(touch.x, leg.at("touch")[0].get<double>(), 1e-4);
    EXPECT_NEAR(touch.y, leg.at("touch")[1].get<double>(), 1e-4);
  }
}

TEST(VerbVo, PointsMayBeTwoWords) {
  const auto answer = [](const std::string& points) {
    return Workplace().run("vo --obstacle '" + kSquare + "' --radius 0.3 --time-horizon 3 " + points);
  };
  const Outcome one = answer("--position=-1,0.5 --velocity 1,0.2");
  ASSERT_EQ(one.status, 0) << one.err;
  for (const char* points : {"--position -1 0.5 --velocity 1 0.2", "--position -1, 0.5 --velocity 1,0.2",
                             "--position=-1,0.5 --velocity 1e0 +0.2"}) {
    const Outcome two = answer(points);
    EXPECT_EQ(two.status, 0) << points << two.err;
    EXPECT_EQ(two.out, one.out) << points;
  }
  for (const char* points : {"--position 0 --velocity 1,0", "--position 0 0 0 --velocity 1,0",
                             "--position 0,0 0 --velocity 1,0", "--position 0 x --velocity 1,0"})
    EXPECT_EQ(answer(points).status, 2) << points;
}

TEST(VerbVo, ACrossingRingIsRefusedWithAHintAtRepair) {
  const Outcome outcome = Workplace().run(
      "vo --obstacle 'POLYGON ((3 0, 5 2, 5 0, 3 2, 3 0))' --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon "
      "3");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("expected a simple ring; exactvo repair cuts rings that cross [E_"));
}

TEST(VerbVo, WordsOfEveryPieceNameItsLegsAndThoseInContactNone) {
  const std::string words = words_of("--obstacle " + kCorner +
                                     " --position 20,20 --velocity 0,0 --radius 0.3 "
                                     "--time-horizon 3");
  std::size_t legs = 0;
  for (std::size_t at = 0; (at = words.find("left leg ", at)) != std::string::npos; ++at) ++legs;
  EXPECT_EQ(legs, 2u) << words;
  const std::string contact = words_of("--obstacle '" + kSquare +
                                       "' --position 3,0 --velocity 1,0 --radius 0.3 "
                                       "--time-horizon 3");
  EXPECT_EQ(contact.find(" leg "), std::string::npos) << contact;
}

/// Each answer against the library's own, for a square that moves: differences of velocities are rounded then.
TEST(VerbVo, VelocitiesAreAnsweredOneByOneAsAlone) {
  const Vec2 moves{0.1, -0.3};
  const vo::VelocityObstacle alone(geometry::ConvexPolygon{{{2, -1}, {4, -1}, {4, 1}, {2, 1}}}, {0, 0}, 0.3, 3.0);
  SeededRandom random(seed_of_run(20));
  std::vector<Vec2> velocities;
  std::string text;
  for (int k = 0; k < 3000; ++k) {
    velocities.push_back(random.in_box(3.0));
    text += digits(velocities.back().x) + "," + digits(velocities.back().y) + "\n";
  }
  const Workplace here;
  here.write("velocities.csv", text);
  const std::string arguments = kSquareAhead + "--obstacle-velocity=0.1,-0.3 --velocities velocities.csv";
  const Outcome run = here.run(arguments + " --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const std::vector<json> answers = json_lines(run.out);
  ASSERT_EQ(answers.size(), velocities.size());
  std::istringstream words(here.run(arguments).out);
  std::size_t collisions = 0;
  for (std::size_t k = 0; k < velocities.size(); ++k) {
    const bool collides = alone.contains_sum({{velocities[k], -moves}});
    collisions += collides;
    EXPECT_EQ(answers[k].at("line"), k + 1);
    EXPECT_EQ(answers[k].at("collides"), collides) << text;
    EXPECT_EQ(answers[k].at("velocity")[0].get<double>(), velocities[k].x);
    std::string line;
    ASSERT_TRUE(std::getline(words, line));
    EXPECT_EQ(line.substr(line.find(' ')), collides ? " collides" : " free");
  }
  EXPECT_GT(collisions, 50u);
  EXPECT_LT(collisions, velocities.size() - 50);
}

TEST(VerbVo, AVelocityOnTheBoundaryCollides) {
  // Straight on at 1.7 m / 3 s the rim touches the square at the horizon; a last digit less does not.
  const Outcome run = [] {
    const Workplace here;
    here.write("v.txt", "0.5,0\n0.49999999999999994,0\n");
    return here.run("vo --obstacle 'DISC(2 0, 1)' --position 0,0 --radius 0 --time-horizon 2 --velocities v.txt");
  }();
  EXPECT_EQ(run.out, "0.5,0 collides\n0.49999999999999994,0 free\n") << run.err;
}

TEST(VerbVo, VelocitiesComeAsCsvLinesAndJsonLines) {
  const std::string expected = "1,0.2 collides\n0,1 free\n-1.5,0 free\n";
  for (const std::string text : {"1,0.2\n0,1\n-1.5,0\n", "1 0.2\n0\t1\n-1.5   0", "vx,vy\n1,0.2\n0,1\n-1.5,0\n",
                                 "id,vy,vx\r\na,0.2,1\r\nb,1,0\r\nc,0,-1.5\r\n", "[1, 0.2]\n[0,1]\n[-1.5, 0]\n",
                                 "{\"velocity\": [1, 0.2]}\n{\"id\": 7, \"velocity\": [0, 1]}\n[-15e-1, 0]\n",
                                 "\xEF\xBB\xBF# of a robot\n\n1 , 0.2\n   \n+0,1\n# the last\n-1.5,0\n"}) {
    const Workplace here;
    here.write("v", text);
    const Outcome run = here.run(kSquareAhead + "--velocities v");
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out, expected) << text;
    EXPECT_EQ(here.run(kSquareAhead + "--velocities - < v").out, expected) << text;
  }
}

TEST(VerbVo, SeveralObstaclesSayWhichIsHit) {
  const Workplace here;
  here.write("v", "1,0\n0,1\n-1,0\n");
  const std::string two = kSquareAhead + "--obstacle 'DISC(0 3, 1)' --velocities v";
  EXPECT_EQ(here.run(two).out, "1,0 collides with obstacle 0\n0,1 collides with obstacle 1\n-1,0 free\n");
  const std::vector<json> answers = json_lines(here.run(two + " --json").out);
  ASSERT_EQ(answers.size(), 3u);
  EXPECT_EQ(answers[1], json::parse(R"({"line": 2, "velocity": [0, 1], "collides": true, "obstacle": 1, "cone": 0})"));
  EXPECT_EQ(answers[2], json::parse(R"({"line": 3, "velocity": [-1, 0], "collides": false})"));
}

TEST(VerbVo, InContactNoVelocityIsFree) {
  const Workplace here;
  here.write("v", "1,0\n");
  const std::string inside =
      "vo --obstacle '" + kSquare + "' --position 3,0 --radius 0.3 --time-horizon 3 --velocities v";
  EXPECT_EQ(here.run(inside).out, "1,0 contact\n");
  EXPECT_TRUE(json_lines(here.run(inside + " --json").out).at(0).at("collides").is_null());
}

TEST(VerbVo, AWrongLineIsNamed) {
  const struct {
    std::string text, code, place;
  } cases[] = {{"1,0\n0,x\n", "E_NUMBER", "line 2"},
               {"1,0\n\n0,1,2\n", "E_NUMBER", "line 3"},
               {"vx,vy\n1,0\n1\n", "E_NUMBER", "line 3"},
               {"1,0\nvx,vy\n", "E_NUMBER", "line 2"},
               {"1,0\n[1, 2\n", "E_JSON_SYNTAX", "line 2"},
               {"1,0\n[1, \"2\"]\n", "E_TYPE", "line 2"},
               {"1,0\n{\"v\": [1, 2]}\n", "E_FORMAT_SYNTAX", "line 2"},
               {"1,0\nnan,0\n", "E_RANGE", "line 2"},
               {"1,0\n1e300,0\n", "E_RANGE", "line 2"},
               {"1,0\n" + std::string(100000, ' ') + "\n", "E_SIZE", "line 2"}};
  for (const auto& [text, code, place] : cases) {
    const Workplace here;
    here.write("v", text);
    const Outcome run = here.run(kSquareAhead + "--velocities v");
    EXPECT_EQ(run.status, 2) << text.substr(0, 40);
    EXPECT_THAT(run.err, HasSubstr("v")) << run.err;
    EXPECT_THAT(run.err, HasSubstr(place)) << run.err;
    EXPECT_THAT(run.err, HasSubstr(code)) << run.err;
    EXPECT_EQ(run.out, "") << "a file is checked first";
    const Outcome stream = here.run(kSquareAhead + "--velocities - < v");
    EXPECT_EQ(stream.status, 2) << text.substr(0, 40);
    EXPECT_EQ(stream.out.substr(0, 13), "1,0 collides\n") << "what stood before it";
  }
  const Outcome empty = Workplace().run(kSquareAhead + "--velocities - < /dev/null");
  EXPECT_EQ(empty.status, 2);
  EXPECT_THAT(empty.err, HasSubstr("standard input: found no velocity, expected vx,vy on each line [E_FORMAT_SYNTAX]"));
  const Outcome missing = Workplace().run(kSquareAhead + "--velocities nowhere.csv");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("E_FILE_MISSING"));
}

TEST(VerbVo, VelocitiesGoWithNothingThatWouldBeIgnored) {
  const Workplace here;
  here.write("v", "1,0\n");
  for (const std::string other : {"--velocity 1,0", "--free --max-speed 2", "--exact-legs", "--variant all",
                                  "--responsibility 0.5", "--figure x.svg"}) {
    const Outcome run = here.run(kSquareAhead + "--velocities v " + other);
    EXPECT_EQ(run.status, 2) << other;
    EXPECT_THAT(run.err,
                HasSubstr("--velocities cannot be combined with " + other.substr(0, other.find(' ')) + ": give"));
  }
  const Outcome rule = here.run("vo --obstacle '" + kSquare +
                                "' --position 0,0 --radius 0.3 --time-horizon paper "
                                "--velocities v");
  EXPECT_EQ(rule.status, 2);
  EXPECT_THAT(rule.err, HasSubstr("--time-horizon"));
  const Outcome none = here.run(kSquareAhead);
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("--velocities"));
}

TEST(VerbVo, ASignalEndsTheWaitForAPipe) {
  const Workplace here;
  ASSERT_EQ(std::system(("mkfifo '" + (here.path() / "pipe").string() + "'").c_str()), 0);
  EXPECT_EQ(here.run(kSquareAhead + "--velocities pipe", "timeout --preserve-status -s TERM 0.5").status, 143);
}

}  // namespace
}  // namespace exactvo::test
