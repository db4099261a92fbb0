#include <gtest/gtest.h>

#include <cmath>

#include "components/scene/Acoustics.hpp"

namespace insonify::scene {
namespace {

TEST(AcousticsTest, SedimentsHaveTheLambertParametersOfTheTable) {
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::MediumSand), -16.7);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::Rock), -3.7);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::RoughRock), -5);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::Clay), -23.7);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::Mackenzie), -27);
}

TEST(AcousticsTest, MatterHasTheReflectionOfTheTable) {
    EXPECT_DOUBLE_EQ(reflection(Matter::Steel), 0.936);
    EXPECT_DOUBLE_EQ(reflection(Matter::CarbonSteel), 0.936);
    EXPECT_DOUBLE_EQ(reflection(Matter::Air), -0.9995);
    EXPECT_DOUBLE_EQ(reflection(Matter::Ice), 0.39);
    EXPECT_NEAR(lambertDb(Matter::Granite), -9.23 - 1.83, 0.01);
}

TEST(AcousticsTest, NoSurfaceOfTheTablesCreatesEnergy) {
    const double most = 10 * std::log10(1 / M_PI) + 0.03;  // mu <= 1/pi; the table clips rough rock to -5 dB
    for (size_t i = 0; i < std::size(types::EnumNames<Matter>::names); ++i) EXPECT_LT(lambertDb(Matter(i)), most);
    for (size_t i = 0; i < std::size(types::EnumNames<Sediment>::names); ++i) {
        if (Sediment(i) == Sediment::Rock) continue;  // -3.7 dB in the table: its Lambert fit is not physical
        EXPECT_LT(lambertDb(Sediment(i)), most);
    }
}

TEST(AcousticsTest, WhatIsAbsentStaysAsItWas) {
    types::Material material;
    material.reflection = 0.3f;
    Acoustics acoustics;
    acoustics.reflectivity = 0.5;
    acoustics.applyTo(material);
    EXPECT_FLOAT_EQ(material.reflection, 0.3f);
    EXPECT_FLOAT_EQ(material.lambert_db, -16.7f);
    EXPECT_FLOAT_EQ(material.reflectivity, 0.5f);
    EXPECT_TRUE(material.has_acoustics);
}

}  // namespace
}  // namespace insonify::scene
