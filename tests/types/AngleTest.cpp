#include <gtest/gtest.h>

#include <numbers>

#include "types/Angle.hpp"
#include "types/ConfigError.hpp"
#include "types/Sonar.hpp"

namespace insonify::types {
namespace {

TEST(AngleTest, IsNormalisedToTheHalfOpenTurn) {
    EXPECT_DOUBLE_EQ(Angle::fromDeg(190).deg(), -170);
    EXPECT_DOUBLE_EQ(Angle::fromDeg(-180).deg(), 180);
    EXPECT_NEAR(Angle::fromRad(5 * std::numbers::pi).rad, std::numbers::pi, 1e-12);
}

TEST(AngleTest, UnknownStaysUnknown) {
    EXPECT_TRUE(Angle{}.isUnknown());
    EXPECT_TRUE(Angle::fromRad(Angle{}.rad).isUnknown());
}

TEST(SonarTest, BinsStartAtOneWayTimeTimesSpeed) {
    Sonar ping;
    ping.bin_duration = {100};
    ping.speed_of_sound = 1500;
    EXPECT_NEAR(ping.binStart(10), 1.5, 1e-9);
}

TEST(ConfigErrorTest, TellsEveryPlaceAndFault) {
    const ConfigError error(
        {{"a.yml", 3, 7, "tasks.sonar.range", "is -1, must be above 0"}, {"", 0, 0, "", "no tasks"}});
    EXPECT_STREQ(error.what(), "a.yml:3:7: tasks.sonar.range: is -1, must be above 0\nno tasks");
}

}  // namespace
}  // namespace insonify::types
