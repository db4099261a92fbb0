#include <gtest/gtest.h>

#include <cmath>

#include "components/sonar/Acoustics.hpp"

namespace insonify::sonar {
namespace {

WaterConfig water(double celsius, double psu, double depth, double ph = 8) { return {celsius, psu, depth, ph}; }

TEST(AcousticsTest, MackenzieMeetsItsPublishedCheckValues) {
    EXPECT_NEAR(mackenzieSpeed(water(25, 35, 1000)), 1550.744, 1e-3);
    EXPECT_NEAR(mackenzieSpeed(water(40, 40, 10000)), 1718.774, 1e-3);
}

TEST(AcousticsTest, LeroyAndMedwinAreNearUnescosEquation) {
    // Chen and Millero's equation (Fofonoff and Millard 1983) at the surface, computed apart from here to 0.01 m/s.
    struct Case {
        double celsius, psu, speed;
    };
    for (const Case& c : {Case{0, 35, 1449.14}, Case{10, 35, 1489.82}, Case{20, 35, 1521.46}, Case{30, 35, 1545.59},
                          Case{10, 25, 1477.68}, Case{20, 25, 1510.31}, Case{10, 40, 1495.93}, Case{30, 40, 1550.81}}) {
        EXPECT_NEAR(leroySpeed(water(c.celsius, c.psu, 0)), c.speed, 0.15) << c.celsius << ' ' << c.psu;
        EXPECT_NEAR(medwinSpeed(water(c.celsius, c.psu, 0)), c.speed, 0.3) << c.celsius << ' ' << c.psu;
    }
    for (const Case& c : {Case{0, 5, 1409.16}, Case{10, 5, 1453.45}, Case{20, 5, 1488.04}, Case{30, 5, 1514.46}})
        EXPECT_NEAR(leroySpeed(water(c.celsius, c.psu, 0)), c.speed, 0.15) << c.celsius << ' ' << c.psu;
}

TEST(AcousticsTest, SoundSpeedLawsAgreeInSeaWater) {
    for (double t : {2.0, 10.0, 25.0})
        for (double s : {32.0, 35.0, 38.0})
            for (double z : {0.0, 100.0, 1000.0}) {
                EXPECT_NEAR(leroySpeed(water(t, s, z)), mackenzieSpeed(water(t, s, z)), 0.35)
                    << t << ' ' << s << ' ' << z;
                EXPECT_NEAR(medwinSpeed(water(t, s, z)), mackenzieSpeed(water(t, s, z)), 0.8)
                    << t << ' ' << s << ' ' << z;
            }
}

TEST(AcousticsTest, LeroyHoldsInFreshWater) {
    // Pure water at atmospheric pressure: Bilaniuk and Wong 1993, 1447.27 m/s at 10 degC and 1482.34 at 20.
    EXPECT_NEAR(leroySpeed(water(10, 0, 0)), 1447.27, 0.3);
    EXPECT_NEAR(leroySpeed(water(20, 0, 0)), 1482.34, 0.3);
}

TEST(AcousticsTest, FrancoisGarrisonMeetsPublishedValues) {
    struct Case {
        double celsius, khz, db_per_km;
    };
    for (const Case& c : {Case{0, 1, 0.064}, Case{10, 10, 0.963}, Case{10, 100, 33.6}})
        EXPECT_NEAR(1000 * francoisGarrison(c.khz, water(c.celsius, 35, 0)), c.db_per_km, 0.006 * c.db_per_km + 5e-4)
            << c.khz << " kHz";
}

TEST(AcousticsTest, FrancoisGarrisonAtImagingFrequencies) {
    struct Case {
        double khz, sea, fresh;
    };
    for (const Case& c : {Case{100, 0.034, 0.003}, Case{300, 0.073, 0.028}, Case{700, 0.200, 0.152},
                          Case{1200, 0.495, 0.447}, Case{2250, 1.62, 1.57}}) {
        EXPECT_NEAR(francoisGarrison(c.khz, water(10, 35, 10, 8.1)), c.sea, 0.0006 + 0.003 * c.sea) << c.khz << " kHz";
        EXPECT_NEAR(francoisGarrison(c.khz, water(10, 0, 10, 8.1)), c.fresh, 0.0006 + 0.003 * c.fresh)
            << c.khz << " kHz";
    }
}

TEST(AcousticsTest, AinslieMccolmIsWithinTenPercentOfFrancoisGarrison) {
    for (double khz : {1.0, 10.0, 50.0, 100.0, 300.0, 700.0, 1000.0})
        for (double t : {4.0, 10.0, 18.0}) {
            const double reference = francoisGarrison(khz, water(t, 35, 10));
            EXPECT_NEAR(ainslieMccolm(khz, water(t, 35, 10)), reference, 0.1 * reference)
                << khz << " kHz, " << t << " degC";
        }
}

TEST(AcousticsTest, AbsorptionIsFiniteAtEveryEdgeOfItsBounds) {
    for (const auto law : {francoisGarrison, ainslieMccolm})
        for (double khz : {0.0, 1e-3, 1e4, 1e5})
            for (double t : {-6.0, 20.0, 50.0})
                for (double s : {0.0, 50.0})
                    for (double z : {0.0, 12000.0}) {
                        const double db_per_m = law(khz, water(t, s, z, 6));
                        EXPECT_TRUE(std::isfinite(db_per_m)) << khz << ' ' << t << ' ' << s << ' ' << z;
                        EXPECT_GE(db_per_m, 0) << khz << ' ' << t << ' ' << s << ' ' << z;
                    }
}

TEST(AcousticsTest, ValidityNamesWhatLiesOutside) {
    EXPECT_EQ(outsideValidity(AbsorptionLaw::FrancoisGarrison, 750, water(12, 35, 8, 8.1)), "");
    EXPECT_EQ(outsideValidity(AbsorptionLaw::FrancoisGarrison, 10000, water(12, 35, 8)), "10000 kHz (0.2 to 1000)");
    EXPECT_EQ(outsideValidity(AbsorptionLaw::AinslieMccolm, 500, water(12, 0, 8)), "0 psu (5 to 50)");
}

TEST(AcousticsTest, OneDecibelPerMetreInNepersAndIntensity) {
    const Absorption absorption{1.0};
    EXPECT_NEAR(absorption.amplitudeNepersPerMetre(), 1 / 8.685889638, 1e-10);
    // Two ways over 5 m are 10 dB: a tenth of the intensity.
    EXPECT_NEAR(std::exp(-absorption.intensityPerMetre() * 5), 0.1, 1e-12);
}

TEST(AcousticsTest, ConfiguredAbsorptionIsANumberOrALaw) {
    SonarConfig config;
    EXPECT_EQ(makeAbsorption(config).db_per_m, 0);
    config.absorption.emplace().db_per_m = 0.25;
    EXPECT_EQ(makeAbsorption(config).db_per_m, 0.25);
    config.water = water(12, 35, 8, 8.1);
    config.absorption = AbsorptionConfig{{}, AbsorptionLaw::AinslieMccolm, 750};
    EXPECT_EQ(makeAbsorption(config).db_per_m, ainslieMccolm(750, *config.water));
    config.absorption->law = AbsorptionLaw::FrancoisGarrison;
    EXPECT_EQ(makeAbsorption(config).db_per_m, francoisGarrison(750, *config.water));
}

TEST(AcousticsTest, SpeedIsConfiguredOrOfTheWaterOrTheDefault) {
    SonarConfig config;
    EXPECT_EQ(config.speedOfSound(), 1500);
    config.water = water(12, 35, 8);
    EXPECT_EQ(config.speedOfSound(), leroySpeed(*config.water));
    config.speed_of_sound = 1480;
    EXPECT_EQ(config.speedOfSound(), 1480);
}

TEST(AcousticsTest, TvgFollowsRangeUpToItsClamp) {
    const TvgConfig tvg{.log_coefficient = 40, .db_per_m = 0.5, .max_db = 100};
    EXPECT_DOUBLE_EQ(tvgDb(tvg, 1), 1);
    EXPECT_DOUBLE_EQ(tvgDb(tvg, 10), 50);
    EXPECT_DOUBLE_EQ(tvgDb(tvg, 100), 100);
    EXPECT_DOUBLE_EQ(unclampedTvgDb(tvg, 100), 180);
}

}  // namespace
}  // namespace insonify::sonar
