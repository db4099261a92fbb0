// Places on the earth about a datum: both ways, and on the map of UTM.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/support/Refused.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/Datum.hpp"

namespace insonify::types {
namespace {

using testing::HasSubstr;

bool isPlaced() {
    return test::refused([] { eastNorthUp({0, 0, 0}, {0, 0, 0}); }).empty();
}

struct DatumTest : testing::Test {
    void SetUp() override {
        if (!isPlaced()) GTEST_SKIP() << "this build has no GeographicLib";
    }
    double draw(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    /** A place on all of the earth; every fourth at a pole, the date line, the equator or the edge of a zone. */
    Datum place() {
        Datum datum{draw(-90, 90), draw(-180, 180), draw(-11'000, 9'000)};
        switch (random_() % 8) {
            case 0: datum.latitude_deg = random_() % 2 ? 90 : -90; break;
            case 1: datum.longitude_deg = random_() % 2 ? 180 : -180; break;
            case 2: datum.latitude_deg = 0; break;
            case 3: datum.longitude_deg = 6 * std::round(datum.longitude_deg / 6); break;
        }
        return datum;
    }
    std::mt19937_64 random_{5};
};

TEST_F(DatumTest, PlacesAboutADatumComeBack) {
    double worst = 0;
    for (int round = 0; round < 20'000; ++round) {
        const Datum datum = place();
        const double reach = std::pow(10, draw(-3, 5));
        const glm::dvec3 enu(draw(-reach, reach), draw(-reach, reach), draw(-11'000, 1000));
        const Datum there = geodetic(datum, enu);
        EXPECT_LE(std::abs(there.latitude_deg), 90);
        EXPECT_LE(std::abs(there.longitude_deg), 180);
        worst = std::max(worst, glm::distance(eastNorthUp(datum, there), enu));
    }
    EXPECT_LT(worst, 1e-7) << "of 1e5 m";
    RecordProperty("worst_m", std::to_string(worst));
    EXPECT_LT(glm::length(eastNorthUp({54, 10, 20}, {54, 10, 20})), 1e-8);
}

TEST_F(DatumTest, TheDateLineIsNoEdge) {
    const glm::dvec3 enu = eastNorthUp({10, 179.9999, 0}, {10, -179.9999, 0});
    const double phi = radians(10), e2 = (2 - 1 / 298.257223563) / 298.257223563,
                 circle = 6'378'137 / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi)) * std::cos(phi);
    EXPECT_NEAR(enu.x, circle * radians(2e-4), 1e-6) << "of the parallel";
    EXPECT_NEAR(eastNorthUp({10, 190, 0}, {10, -170, 0}).x, 0, 1e-8);
    EXPECT_LT(geodetic({10, 179.9999, 0}, {100, 0, 0}).longitude_deg, -179.99);
}

TEST_F(DatumTest, WhatIsNotFiniteStaysSo) {
    const Datum there = geodetic({54, 10, 0}, {NAN, 0, 0});
    EXPECT_TRUE(std::isnan(there.latitude_deg) || std::isnan(there.longitude_deg) || std::isnan(there.height_m));
    const Datum far = geodetic({54, 10, 0}, {1e300, -1e300, 1e300});
    EXPECT_LE(std::abs(far.latitude_deg), 90);
    EXPECT_TRUE(std::isnan(gridPlace({54, 10, 0}, {NAN, 10, 0}).easting));
}

TEST_F(DatumTest, AMapIsThatOfTheDatumsZone) {
    EXPECT_EQ(gridPlace({54, 10, 0}, {54, 10, 0}).epsg, 32632);
    EXPECT_EQ(gridPlace({-54, 10, 0}, {-54, 10, 0}).epsg, 32732);
    EXPECT_EQ(gridPlace({60, 4, 0}, {60, 4, 0}).epsg, 32632) << "zone 32 is wider off Bergen";
    EXPECT_EQ(gridPlace({78, 20, 0}, {78, 20, 0}).epsg, 32633) << "and 33 about Svalbard";
    EXPECT_EQ(gridPlace({89, 10, 0}, {89, 10, 0}).epsg, 32661);
    EXPECT_EQ(gridPlace({-89, 10, 0}, {-89, 10, 0}).epsg, 32761);
    EXPECT_EQ(gridPlace({-1e-9, 9, 0}, {1e-9, 9, 0}).epsg, 32732);
    EXPECT_EQ(gridPlace({1, 180, 0}, {1, 180, 0}).epsg, 32601);
    // Snyder, Map Projections, p. 269 f. has Clarke's ellipsoid; on the central meridian the easting is exact anyway.
    EXPECT_NEAR(gridPlace({54, 9, 0}, {54, 9, 0}).easting, 500'000, 1e-8);
    EXPECT_NEAR(gridPlace({0, 9, 0}, {0, 9, 0}).northing, 0, 1e-8);
}

TEST_F(DatumTest, MapsHaveNoStepAtTheEdgeOfAZoneOrOfAHemisphere) {
    for (int round = 0; round < 2'000; ++round) {
        Datum datum{draw(-80, 84), draw(-180, 180), 0};
        if (round % 4 == 0) datum.longitude_deg = 6 * std::round(datum.longitude_deg / 6) + draw(-1e-4, 1e-4);
        if (round % 4 == 1) datum.latitude_deg = draw(-1e-4, 1e-4);
        const auto at = [&](glm::dvec3 enu) { return gridPlace(datum, geodetic(datum, enu)); };
        const GridPlace here = at({});
        const glm::dvec3 enu(draw(-500, 500), draw(-500, 500), 0);
        const GridPlace there = at(enu);
        ASSERT_EQ(there.epsg, here.epsg);
        const double scale =
            std::hypot(there.easting - here.easting, there.northing - here.northing) / glm::length(enu);
        ASSERT_GT(scale, 0.9994) << text(datum);
        ASSERT_LT(scale, 1.004) << text(datum) << ", of UPS and the edges of zones at the equator and off Norway";
    }
}

TEST_F(DatumTest, APlaceThatIsOffTheMapIsRefused) {
    EXPECT_THAT(test::refused([] {
                    gridPlace({10, 9, 0}, {10, -120, 0});
                }),
                testing::ElementsAre(HasSubstr("has no map for {latitude_deg: 10, longitude_deg: -120")));
}

TEST(DatumTextTest, ADatumIsWrittenAndComparedAsAPlace) {
    EXPECT_EQ(text(Datum{54.25, -10.5, 3}), "{latitude_deg: 54.25, longitude_deg: -10.5, height_m: 3}");
    EXPECT_TRUE(isSamePlace({54, 190, 3}, {54, -170, 3}));
    EXPECT_TRUE(isSamePlace({54, 10, 3}, {54 + 1e-10, 10, 3}));
    for (const Datum& other : {Datum{54.00001, 10, 3}, {54, 10.00001, 3}, {54, 10, 3.01}, {54, NAN, 3}})
        EXPECT_FALSE(isSamePlace({54, 10, 3}, other)) << text(other);
    EXPECT_THAT(test::countRefusals(Datum{}),
                testing::ElementsAre(HasSubstr("latitude_deg: is missing"), HasSubstr("longitude_deg: is missing")));
    EXPECT_THAT(test::countRefusals(Datum{54, NAN}), testing::ElementsAre(HasSubstr("longitude_deg: is missing")));
}

}  // namespace
}  // namespace insonify::types
