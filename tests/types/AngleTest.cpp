#include <gtest/gtest.h>

#include <numbers>

#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

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

TEST(ConfigErrorTest, HasEveryPlaceAndMessage) {
    const ConfigError error({{"tasks.sonar.range", "is -1, must be above 0", "a.yml", 3, 7}, {"", "no tasks"}});
    EXPECT_STREQ(error.what(), "a.yml:3:7: tasks.sonar.range: is -1, must be above 0\nno tasks");
}

}  // namespace
}  // namespace insonify::types
