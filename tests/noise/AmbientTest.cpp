#include <gmock/gmock.h>

#include <cmath>

#include "components/acoustics/AmbientNoise.hpp"
#include "components/noise/Noise.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::noise {
namespace {

AmbientConfig windy(double wind_m_s) {
    AmbientConfig config;
    config.wind_m_s = wind_m_s;
    config.frequency_khz = 700;
    config.bandwidth_khz = 30;
    config.directivity_index_db = 25;
    config.source_level_db = 210;
    return config;
}

double levelDb(const AmbientConfig& config) { return 10 * std::log10(ambientIntensity(config)); }

TEST(AmbientTest, NoiseInABinIsThatOfTheBandMinusTheDirectivityRelativeToTheSource) {
    const double spectrum = acoustics::coatesSpectrumDb(700, 5, 0.5);
    EXPECT_NEAR(levelDb(windy(5)), spectrum + 10 * std::log10(30e3) - 25 - 210, 1e-9);
    AmbientConfig given;
    given.level_db = -112.5;
    EXPECT_NEAR(levelDb(given), -112.5, 1e-9);
}

TEST(AmbientTest, NeedsEitherALevelOrAllInputsOfTheFormula) {
    EXPECT_THAT(test::countRefusals(windy(0)), testing::IsEmpty());
    EXPECT_THAT(test::countRefusals(AmbientConfig{}),
                testing::ElementsAre("has no value; give level_db, or wind_m_s, bandwidth_khz and source_level_db"));
    AmbientConfig both = windy(3), half = windy(3);
    both.level_db = -100;
    EXPECT_THAT(test::countRefusals(both), testing::SizeIs(3));
    half.bandwidth_khz.reset();
    EXPECT_THAT(test::countRefusals(half),
                testing::ElementsAre("has no bandwidth_khz, which is needed without level_db"));
}

}  // namespace
}  // namespace insonify::noise
