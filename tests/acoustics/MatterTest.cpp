#include <gtest/gtest.h>

#include <cmath>
#include <iterator>

#include "components/acoustics/Matter.hpp"

namespace insonify::acoustics {
namespace {

constexpr double water_impedance = 1025 * 1500.0;  ///< [Pa s/m]

TEST(MatterTest, TheTableHasTheNamesInTheirOrder) {
    ASSERT_EQ(matterCount(), std::size(types::EnumNames<Matter>::names));
    for (size_t i = 0; i < matterCount(); ++i) {
        const auto matter = static_cast<Matter>(i);
        EXPECT_EQ(getProperties(matter).matter, matter) << getName(matter);
        EXPECT_EQ(matterNamed(getName(matter)), matter);
    }
    for (const char* unknown : {"", "stel", "Steel", "steel "}) EXPECT_FALSE(matterNamed(unknown)) << unknown;
}

TEST(MatterTest, TheReflectionIsThatOfDensityAndSpeed) {
    for (size_t i = 0; i < matterCount(); ++i) {
        const MatterProperties& matter = getProperties(static_cast<Matter>(i));
        const double impedance = matter.density * matter.sound_speed;
        EXPECT_NEAR(matter.reflection, (impedance - water_impedance) / (impedance + water_impedance), 0.06)
            << getName(matter.matter);
    }
}

TEST(MatterTest, EachRowIsPhysicalAndHasItsSources) {
    for (size_t i = 0; i < matterCount(); ++i) {
        const MatterProperties& matter = getProperties(static_cast<Matter>(i));
        EXPECT_GT(matter.density, 0) << getName(matter.matter);
        EXPECT_LT(matter.shear_speed, 0.87 * matter.sound_speed) << getName(matter.matter);
        EXPECT_TRUE(matter.loss >= 0 && matter.loss < 0.1) << getName(matter.matter);
        EXPECT_EQ(matter.hasRoughness(), matter.length > 0) << getName(matter.matter);
        EXPECT_LE(matter.roughness, 0.45 * matter.length) << getName(matter.matter);
        EXPECT_FALSE(matter.source.empty() || matter.roughness_source.empty()) << getName(matter.matter);
    }
}

TEST(MatterTest, ReliefOfPipesIsAThirdOfTheirEquivalentSand) {
    EXPECT_NEAR(getProperties(Matter::Steel).roughness, 15e-6, 0.2e-6) << "0.046 mm, Moody 1944";
    EXPECT_NEAR(getProperties(Matter::CastIron).roughness, 84e-6, 0.5e-6) << "0.26 mm";
    // Rock of APL-UW TR 9407 up to a metre has a relief of centimetres, up to a tenth of it of millimetres.
    EXPECT_NEAR(getProperties(Matter::Rock).roughness, 0.0172, 2e-4);
    EXPECT_NEAR(getProperties(Matter::Granite).roughness, 0.0041, 1e-4);
    EXPECT_NEAR(getProperties(Matter::Fouling).sound_speed, 1449, 2) << "Wood's equation";
    EXPECT_NEAR(getProperties(Matter::Paper).sound_speed, 1723, 2) << "Wood's equation";
    EXPECT_NEAR(getProperties(Matter::PaintedMetal).roughness, 9.7e-6, 0.1e-6) << "0.03 mm, Schultz 2007";
}

}  // namespace
}  // namespace insonify::acoustics
