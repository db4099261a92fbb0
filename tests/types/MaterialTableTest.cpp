#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "types/MaterialTable.hpp"

namespace insonify::types {
namespace {

TEST(MaterialTableTest, MediumSandIsTheDefault) {
    Material material;
    ASSERT_TRUE(applySediment("medium_sand", material));
    EXPECT_EQ(material.lambert_db, Material{}.lambert_db);
    EXPECT_TRUE(material.has_acoustics);
}

TEST(MaterialTableTest, AMaterialGivesReflectionAndTheLambertParameterOfASmoothSphere) {
    Material material;
    ASSERT_TRUE(applyMaterial("steel", material));
    EXPECT_FLOAT_EQ(material.reflection, 0.936f);
    EXPECT_NEAR(material.lambert_db, -9.23 + 20 * std::log10(0.936), 1e-5);
    // A Lambert sphere of radius a scatters mu 2 pi a^2 / 3; a smooth one |R|^2 a^2 / 4.
    EXPECT_NEAR(std::pow(10, material.lambert_db / 10) * 2 * std::numbers::pi / 3, 0.936 * 0.936 / 4, 1e-4);
    ASSERT_TRUE(applyMaterial("air", material));
    EXPECT_LT(material.reflection, 0);
}

TEST(MaterialTableTest, UnknownNamesChangeNothing) {
    Material material;
    EXPECT_FALSE(applySediment("steel", material));
    EXPECT_FALSE(applyMaterial("medium_sand", material));
    EXPECT_FALSE(material.has_acoustics);
}

TEST(MaterialTableTest, EveryNameHasAValueAndNoSedimentCreatesEnergy) {
    for (const std::string& name : sedimentNames()) {
        Material material;
        ASSERT_TRUE(applySediment(name, material)) << name;
        EXPECT_LE(std::pow(10, material.lambert_db / 10), 1 / std::numbers::pi) << name;
    }
    for (const std::string& name : materialNames()) {
        Material material;
        ASSERT_TRUE(applyMaterial(name, material)) << name;
        EXPECT_LE(std::abs(material.reflection), 1) << name;
        EXPECT_TRUE(std::isfinite(material.lambert_db)) << name;
    }
}

}  // namespace
}  // namespace insonify::types
