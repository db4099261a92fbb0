#include <gtest/gtest.h>

#include <cmath>
#include <iterator>

#include "components/acoustics/SoundSpeed.hpp"

namespace insonify::acoustics {
namespace {

Water waterAt(double celsius, double psu, double depth) {
    Water water;
    water.temperature_celsius = celsius;
    water.salinity_psu = psu;
    water.depth = depth;
    return water;
}

Water equatorial(double celsius, double psu, double depth) {
    Water at = waterAt(celsius, psu, depth);
    at.latitude_deg = 0;
    return at;
}

/** Returns the speed by Del Grosso's equation in the fit of Wong and Zhu (1995) for ITS-90, with an S^2 term [m/s]. */
double wongZhuSpeed(double t, double s, double p, double c_s2 = 1.288598e-4) {
    return 1402.392 + 5.012285 * t - 5.51184e-2 * t * t + 2.21649e-4 * t * t * t + 1.329530 * s + c_s2 * s * s +
           0.1560592 * p + 2.449993e-5 * p * p - 8.833959e-9 * p * p * p - 1.275936e-2 * s * t + 6.353509e-3 * t * p +
           2.656174e-8 * t * t * p * p - 1.593895e-6 * t * p * p + 5.222483e-10 * t * p * p * p -
           4.383615e-7 * t * t * t * p - 1.616745e-9 * s * s * p * p + 9.688441e-5 * s * t * t +
           4.857614e-6 * s * s * t * p - 3.406824e-4 * s * t * p;
}

TEST(SoundSpeedTest, MackenzieMatchesItsPublishedCheckValues) {
    EXPECT_NEAR(mackenzieSpeed(waterAt(25, 35, 1000)), 1550.744, 1e-3);
    EXPECT_NEAR(mackenzieSpeed(waterAt(40, 40, 10000)), 1718.774, 1e-3);
}

TEST(SoundSpeedTest, ChenAndMilleroMatchUnescosCheckValue) {
    EXPECT_NEAR(chenMilleroSpeed(40, 40, 1000), 1731.995, 1e-3);  // Fofonoff and Millard 1983, page 48
    // Pressure in decibars, which many programs use, gives another number.
    EXPECT_GT(std::abs(chenMilleroSpeed(40, 40, 10000) - 1731.995), 100);
    // With two terms of Wong and Zhu's refit, as in a public program, the error is larger than the check allows.
    const double mixed = chenMilleroSpeed(40, 40, 1000) + 40 * (2e-8 * 40 * 40 + 2e-9 * 40 * 40 * 40);
    EXPECT_GT(std::abs(mixed - 1731.995), 1e-3);
}

TEST(SoundSpeedTest, DelGrossoMatchesTheFitOfWongAndZhu) {
    for (double t : {0.0, 5.0, 15.0, 30.0})
        for (double s : {30.0, 35.0, 40.0})
            for (double p : {0.0, 10.0, 100.0, 1000.0}) {
                if (p > 500 && t > 15) continue;  // not in any sea
                EXPECT_NEAR(delGrossoSpeed(celsius68(t), s, p), wongZhuSpeed(t, s, p), 0.01)
                    << t << ' ' << s << ' ' << p;
            }
    // NPL's technical guide, at 5 degC, 35 psu and 100 kPa above the air.
    EXPECT_NEAR(delGrossoSpeed(celsius68(5), 35, 1.019716), 1470.8075, 0.01);
}

TEST(SoundSpeedTest, DelGrossoWithTheMisprintedTermIsAnotherEquation) {
    // A public program has 1.98955756844e-4 for the term in S^2, 0.08 m/s at 35 psu.
    const double misprinted = wongZhuSpeed(5, 35, 0, 1.98955756844e-4);
    EXPECT_GT(std::abs(misprinted - delGrossoSpeed(celsius68(5), 35, 0)), 0.08);
    EXPECT_LT(std::abs(wongZhuSpeed(5, 35, 0) - delGrossoSpeed(celsius68(5), 35, 0)), 0.01);
}

TEST(SoundSpeedTest, PressureMatchesLeroyAndParthiot) {
    EXPECT_NEAR(gaugePressureBar(1000, 27), 100.75, 0.02);  // for the common oceans
    EXPECT_EQ(gaugePressureBar(0, 45), 0);
    EXPECT_GT(gaugePressureBar(1000, 90), gaugePressureBar(1000, 0) + 0.4);
    EXPECT_EQ(gaugePressureBar(1000, -60), gaugePressureBar(1000, 60));
}

TEST(SoundSpeedTest, LeroyMatchesTheTableOfItsPublishedProgram) {
    // At 30 psu and the equator, as the open documentation of sonar formulas SonarDocs tabulates it.
    struct Case {
        double celsius, depth, speed;
    };
    for (const Case& c : {Case{0, 10, 1442.56}, Case{10, 10, 1483.90}, Case{30, 1000, 1556.85}, Case{40, 5000, 1641.20},
                          Case{20, 2000, 1548.98}})
        EXPECT_NEAR(leroySpeed(equatorial(c.celsius, 30, c.depth)), c.speed, 0.0051) << c.celsius << ' ' << c.depth;
    // At 45 deg of latitude sound is faster in deep water.
    EXPECT_GT(leroySpeed(waterAt(40, 30, 5000)), 1641.20 + 0.2);
}

TEST(SoundSpeedTest, LatitudeChangesTheSpeedInTheDeepAsPressureDoes) {
    Water pole = waterAt(2, 35, 9000), equator = pole;
    pole.latitude_deg = -90;
    equator.latitude_deg = 0;
    EXPECT_NEAR(leroySpeed(pole) - leroySpeed(equator), 0.97, 0.01);
    EXPECT_NEAR(leroySpeed(pole) - leroySpeed(equator), chenMilleroSpeed(pole) - chenMilleroSpeed(equator), 0.2);
    equator.depth = pole.depth = 0;
    EXPECT_EQ(leroySpeed(pole), leroySpeed(equator));
}

TEST(SoundSpeedTest, EveryLawIsNearUnescosEquation) {
    // Chen and Millero's equation (Fofonoff and Millard 1983) at the surface, computed independently to 0.01 m/s.
    struct Case {
        double celsius, psu, speed;
    };
    for (const Case& c : {Case{0, 35, 1449.14}, Case{10, 35, 1489.82}, Case{20, 35, 1521.46}, Case{30, 35, 1545.59},
                          Case{10, 25, 1477.68}, Case{20, 25, 1510.31}, Case{10, 40, 1495.93}, Case{30, 40, 1550.81}}) {
        const Water at = waterAt(c.celsius, c.psu, 0);
        EXPECT_NEAR(chenMilleroSpeed(c.celsius, c.psu, 0), c.speed, 0.01) << c.celsius << ' ' << c.psu;
        EXPECT_NEAR(leroySpeed(at), c.speed, 0.15) << c.celsius << ' ' << c.psu;
        EXPECT_NEAR(medwinSpeed(at), c.speed, 0.3) << c.celsius << ' ' << c.psu;
        EXPECT_NEAR(coppensSpeed(at), c.speed, 0.2) << c.celsius << ' ' << c.psu;
        if (c.psu < 30) continue;
        EXPECT_NEAR(delGrossoSpeed(at), c.speed, 0.12) << c.celsius << ' ' << c.psu;
    }
    for (const Case& c : {Case{0, 5, 1409.16}, Case{10, 5, 1453.45}, Case{20, 5, 1488.04}, Case{30, 5, 1514.46}})
        EXPECT_NEAR(leroySpeed(waterAt(c.celsius, c.psu, 0)), c.speed, 0.15) << c.celsius << ' ' << c.psu;
}

TEST(SoundSpeedTest, AllLawsAgreeInSeaWater) {
    for (double t : {2.0, 10.0, 25.0})
        for (double s : {32.0, 35.0, 38.0})
            for (double z : {0.0, 100.0, 1000.0}) {
                const Water at = waterAt(t, s, z);
                for (const auto law : {SoundSpeedLaw::Leroy, SoundSpeedLaw::Coppens, SoundSpeedLaw::ChenMillero,
                                       SoundSpeedLaw::DelGrosso})
                    EXPECT_NEAR(soundSpeed(law, at), mackenzieSpeed(at), 0.7)
                        << static_cast<int>(law) << ' ' << t << ' ' << s << ' ' << z;
                EXPECT_NEAR(medwinSpeed(at), mackenzieSpeed(at), 0.8) << t << ' ' << s << ' ' << z;
            }
}

TEST(SoundSpeedTest, LeroyHoldsInFreshWater) {
    // Pure water at atmospheric pressure: Bilaniuk and Wong 1993, 1447.27 m/s at 10 degC and 1482.34 at 20.
    EXPECT_NEAR(leroySpeed(waterAt(10, 0, 0)), 1447.27, 0.3);
    EXPECT_NEAR(leroySpeed(waterAt(20, 0, 0)), 1482.34, 0.3);
}

TEST(SoundSpeedTest, ValidityNamesTheRangeOfEachLaw) {
    EXPECT_EQ(outsideValidity(SoundSpeedLaw::Leroy, waterAt(12, 0, 8)), "");
    EXPECT_EQ(outsideValidity(SoundSpeedLaw::Leroy, waterAt(12, 45, 8)), "45 psu (0 to 42)");
    EXPECT_EQ(outsideValidity(SoundSpeedLaw::Mackenzie, waterAt(31, 20, 8)), "31 degC (-2 to 30), 20 psu (25 to 40)");
    EXPECT_EQ(outsideValidity(SoundSpeedLaw::Medwin, waterAt(12, 35, 2000)), "2000 m depth (0 to 1000)");
    EXPECT_EQ(outsideValidity(SoundSpeedLaw::Coppens, waterAt(12, 35, 5000)), "5000 m depth (0 to 4000)");
    EXPECT_EQ(outsideValidity(SoundSpeedLaw::ChenMillero, waterAt(12, 41, 10)), "41 psu (0 to 40)");
    EXPECT_EQ(outsideValidity(SoundSpeedLaw::DelGrosso, waterAt(12, 5, 10)), "5 psu (30 to 40)");
}

TEST(SoundSpeedTest, EveryLawIsFiniteAtEveryEdgeOfItsBounds) {
    for (size_t law = 0; law < std::size(types::EnumNames<SoundSpeedLaw>::names); ++law)
        for (double t : {-6.0, 50.0})
            for (double s : {0.0, 50.0})
                for (double z : {0.0, 12000.0})
                    EXPECT_TRUE(std::isfinite(soundSpeed(static_cast<SoundSpeedLaw>(law), waterAt(t, s, z))))
                        << law << ' ' << t << ' ' << s << ' ' << z;
}

}  // namespace
}  // namespace insonify::acoustics
