#include <gtest/gtest.h>

#include "components/acoustics/SoundSpeed.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {
namespace {

acoustics::Water water(double celsius, double psu, double depth, double ph = 8) {
    acoustics::Water water;
    water.temperature_celsius = celsius;
    water.salinity_psu = psu;
    water.depth = depth;
    water.ph = ph;
    return water;
}

TEST(AcousticsTest, ConfiguredAbsorptionIsANumberOrALaw) {
    SonarConfig config;
    EXPECT_EQ(makeAbsorption(config).db_per_m, 0);
    config.absorption.emplace().db_per_m = 0.25;
    EXPECT_EQ(makeAbsorption(config).db_per_m, 0.25);
    config.water = water(12, 35, 8, 8.1);
    config.absorption = AbsorptionConfig{{}, acoustics::AbsorptionLaw::AinslieMccolm, 750};
    EXPECT_EQ(makeAbsorption(config).db_per_m, acoustics::ainslieMccolm(750, *config.water));
    config.absorption->law = acoustics::AbsorptionLaw::FrancoisGarrison;
    EXPECT_EQ(makeAbsorption(config).db_per_m, acoustics::francoisGarrison(750, *config.water));
    config.absorption->law = acoustics::AbsorptionLaw::FisherSimmons;
    EXPECT_EQ(makeAbsorption(config).db_per_m, acoustics::fisherSimmons(750, *config.water));
    config.absorption->law = acoustics::AbsorptionLaw::Thorp;
    EXPECT_EQ(makeAbsorption(config).db_per_m, acoustics::thorp(750));
}

TEST(AcousticsTest, AbsorptionUsesTheSonarsFrequencyByDefault) {
    SonarConfig config;
    config.water = water(12, 35, 8, 8.1);
    config.frequency_khz = 400;
    config.absorption.emplace();
    EXPECT_EQ(makeAbsorption(config).db_per_m, acoustics::francoisGarrison(400, *config.water));
    config.absorption->frequency_khz = 750;
    EXPECT_EQ(makeAbsorption(config).db_per_m, acoustics::francoisGarrison(750, *config.water));
    config.absorption.reset();
    EXPECT_EQ(makeAbsorption(config).db_per_m, 0);
}

TEST(AcousticsTest, SpeedIsConfiguredOrThatOfTheWaterOrTheDefault) {
    SonarConfig config;
    EXPECT_EQ(config.speedOfSound(), 1500);
    config.water = water(12, 35, 8);
    EXPECT_EQ(config.speedOfSound(), acoustics::leroySpeed(*config.water));
    config.water->sound_speed_law = acoustics::SoundSpeedLaw::DelGrosso;
    EXPECT_EQ(config.speedOfSound(), acoustics::delGrossoSpeed(*config.water));
    config.speed_of_sound = 1480;
    EXPECT_EQ(config.speedOfSound(), 1480);
}

}  // namespace
}  // namespace insonify::sonar
