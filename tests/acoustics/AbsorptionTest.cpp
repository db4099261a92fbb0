#include <gtest/gtest.h>

#include <cmath>
#include <iterator>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/SoundSpeed.hpp"

namespace insonify::acoustics {
namespace {

Water getWater(double celsius, double psu, double depth, double ph = 8) {
    Water water;
    water.temperature_celsius = celsius;
    water.salinity_psu = psu;
    water.depth = depth;
    water.ph = ph;
    return water;
}

TEST(AbsorptionTest, FrancoisGarrisonMatchesPublishedValues) {
    struct Case {
        double celsius, khz, db_per_km;
    };
    for (const Case& c : {Case{0, 1, 0.064}, Case{10, 10, 0.963}, Case{10, 100, 33.6}})
        EXPECT_NEAR(1000 * francoisGarrison(c.khz, getWater(c.celsius, 35, 0)), c.db_per_km, 0.006 * c.db_per_km + 5e-4)
            << c.khz << " kHz";
}

TEST(AbsorptionTest, FrancoisGarrisonAtImagingFrequencies) {
    struct Case {
        double khz, sea, fresh;
    };
    for (const Case& c : {Case{100, 0.034, 0.003}, Case{300, 0.073, 0.028}, Case{700, 0.200, 0.152},
                          Case{1200, 0.495, 0.447}, Case{2250, 1.62, 1.57}}) {
        EXPECT_NEAR(francoisGarrison(c.khz, getWater(10, 35, 10, 8.1)), c.sea, 0.0006 + 0.003 * c.sea)
            << c.khz << " kHz";
        EXPECT_NEAR(francoisGarrison(c.khz, getWater(10, 0, 10, 8.1)), c.fresh, 0.0006 + 0.003 * c.fresh)
            << c.khz << " kHz";
    }
}

TEST(AbsorptionTest, TheMisprintedPureWaterConstantIsAnotherLaw) {
    // A public manual prints 4.397e-4 instead of 4.937e-4 for pure water: 0.054 dB/m less at 1 MHz and 0 degC.
    const double right = francoisGarrison(1000, getWater(0, 0, 0));
    EXPECT_NEAR(right, 0.4937, 1e-6);
    EXPECT_GT(right - 0.4397, 0.05);
}

TEST(AbsorptionTest, AinslieMccolmIsWithinTenPercentOfFrancoisGarrison) {
    for (double khz : {1.0, 10.0, 50.0, 100.0, 300.0, 700.0, 1000.0})
        for (double t : {4.0, 10.0, 18.0}) {
            const double reference = francoisGarrison(khz, getWater(t, 35, 10));
            EXPECT_NEAR(ainslieMccolm(khz, getWater(t, 35, 10)), reference, 0.1 * reference)
                << khz << " kHz, " << t << " degC";
        }
}

TEST(AbsorptionTest, AinslieMccolmTakesDepthInKilometres) {
    // At 100 kHz magnesium sulphate dominates, and 1 km of depth reduces it to e^(-1/6). Depth in metres would give 0.
    const double shallow = ainslieMccolm(100, getWater(4, 35, 0)), deep = ainslieMccolm(100, getWater(4, 35, 1000));
    EXPECT_NEAR(deep / shallow, std::exp(-1.0 / 6), 0.03);
}

TEST(AbsorptionTest, FisherAndSimmonsMatchTheirPublishedTable) {
    // Their table IV: 10 kHz at 4 degC and 1 atm, and 100 kHz at 500 atm, which is at 4970 m.
    EXPECT_NEAR(fisherSimmons(10, getWater(4, 35, 0)), 0.00083, 0.01 * 0.00083);
    EXPECT_NEAR(gaugePressureBar(4970, 45), 500 * 1.01325, 1);
    EXPECT_NEAR(fisherSimmons(100, getWater(4, 35, 4970)), 0.0175, 0.01 * 0.0175);
    // Pressure in decibars would give another number.
    EXPECT_GT(std::abs(fisherSimmons(100, getWater(4, 35, 497)) - 0.0175), 0.005);
}

TEST(AbsorptionTest, FisherAndSimmonsIsTheSumOfItsThreeTerms) {
    // At 10 degC and the surface, by hand: relaxations of boric acid at 0.921 kHz and of magnesium sulphate at 91.3
    // kHz. The three terms at 100 kHz are 0.097, 27.56 and 3.18 dB/km.
    EXPECT_NEAR(1000 * fisherSimmons(100, getWater(10, 35, 0)), 0.097 + 27.56 + 3.18, 0.02);
    // Salinity and acidity do not change it.
    EXPECT_EQ(fisherSimmons(100, getWater(10, 20, 0, 7)), fisherSimmons(100, getWater(10, 35, 0, 8)));
}

TEST(AbsorptionTest, ThorpHasTheValuesOfItsFormula) {
    EXPECT_NEAR(1000 * thorp(1), 0.06933, 1e-5);
    EXPECT_NEAR(1000 * thorp(10), 1.190, 1e-3);
    EXPECT_NEAR(1000 * thorp(50), 17.53, 1e-2);
    const double reference = francoisGarrison(10, getWater(4, 35, 1000));
    EXPECT_NEAR(thorp(10), reference, 0.2 * reference);
}

TEST(AbsorptionTest, EveryLawIsFiniteAtEveryEdgeOfItsBounds) {
    for (size_t law = 0; law < std::size(types::EnumNames<AbsorptionLaw>::names); ++law)
        for (double khz : {0.0, 1e-3, 1e4, 1e5})
            for (double t : {-6.0, 20.0, 50.0})
                for (double s : {0.0, 50.0})
                    for (double z : {0.0, 12000.0}) {
                        const double db_per_m =
                            absorptionDbPerM(static_cast<AbsorptionLaw>(law), khz, getWater(t, s, z, 6));
                        EXPECT_TRUE(std::isfinite(db_per_m)) << law << ' ' << khz << ' ' << t << ' ' << s << ' ' << z;
                        EXPECT_GE(db_per_m, 0) << law << ' ' << khz << ' ' << t << ' ' << s << ' ' << z;
                    }
}

TEST(AbsorptionTest, ValidityNamesTheInputsOutside) {
    EXPECT_EQ(outsideValidity(AbsorptionLaw::FrancoisGarrison, 750, getWater(12, 35, 8, 8.1)), "");
    EXPECT_EQ(outsideValidity(AbsorptionLaw::FrancoisGarrison, 10000, getWater(12, 35, 8)), "10000 kHz (0.2 to 1000)");
    EXPECT_EQ(outsideValidity(AbsorptionLaw::AinslieMccolm, 500, getWater(12, 0, 8)), "0 psu (5 to 50)");
    EXPECT_EQ(outsideValidity(AbsorptionLaw::FisherSimmons, 750, getWater(12, 35, 8)), "750 kHz (10 to 400)");
    EXPECT_EQ(outsideValidity(AbsorptionLaw::Thorp, 100, getWater(10, 35, 8)), "100 kHz (0.1 to 50), 10 degC (2 to 6)");
}

TEST(AbsorptionTest, OneDecibelPerMetreInNepersAndIntensity) {
    const Absorption absorption{1.0};
    EXPECT_NEAR(absorption.amplitudeNepersPerMetre(), 1 / 8.685889638, 1e-10);
    // Two ways over 5 m are 10 dB: a tenth of the intensity.
    EXPECT_NEAR(std::exp(-absorption.intensityPerMetre() * 5), 0.1, 1e-12);
}

}  // namespace
}  // namespace insonify::acoustics
