// SPDX-License-Identifier: GPL-3.0-or-later
// `exactvo vo`: rings that cross, the legs of one obstacle in words.
#include <gmock/gmock.h>

#include <string>

#include "exactvo/geometry/vec2.h"
#include "vo/verb_vo.h"

namespace exactvo::test {
namespace {

using geometry::Vec2;
using testing::HasSubstr;

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

}  // namespace
}  // namespace exactvo::test
