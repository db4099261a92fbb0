// What materials give back between the entries of their tables, and when a material follows Lambert's law.
#include <gtest/gtest.h>

#include <cmath>

#include "components/acoustics/Seabed.hpp"
#include "components/acoustics/SeabedBackscatter.hpp"
#include "components/sonar/echo/MaterialLaws.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

MaterialLaws lawsOf(types::Material material) {
    SonarConfig config;
    config.frequency_khz = 100;
    types::Geometry geometry;
    geometry.materials = {std::move(material)};
    return makeMaterialLaws(config, geometry);
}

TEST(MaterialLawsTest, ATableIsItsLawBetweenItsEntriesToo) {
    const MaterialLaws laws = lawsOf({.name = "floor", .seabed = "medium_sand"});
    const acoustics::SeabedBackscatter sand(acoustics::seabedNamed("medium_sand").value(), 100, 1500);
    for (double grazing_deg = 3; grazing_deg <= 90; grazing_deg += 0.37) {
        const double grazing = types::radians(grazing_deg), cosine = std::sin(grazing);
        const double exact = sand.crossSection(grazing) / cosine, given = laws.overCosine(0, cosine);
        EXPECT_NEAR(10 * std::log10(given / exact), 0, grazing_deg < 6 ? 0.5 : 0.1) << grazing_deg;
    }
    EXPECT_EQ(laws.overCosine(0, 2), laws.overCosine(0, 1)) << "no cosine is above 1";
}

TEST(MaterialLawsTest, LambertsLawIsThatOfNeitherTableNorLobe) {
    const MaterialLaws lambert = lawsOf({.name = "mud", .lambert_db = -16.7f});
    EXPECT_TRUE(lambert.followsLambert(0));
    for (const double cosine : {0.001, 0.2, 0.7071, 1.0})
        EXPECT_NEAR(lambert.overCosine(0, cosine), std::pow(10, -1.67) * cosine, 1e-6) << cosine;
    EXPECT_FALSE(lawsOf({.name = "floor", .seabed = "silt"}).followsLambert(0));
    EXPECT_FALSE(lawsOf({.name = "measured", .measured = {{10, -30}, {90, -10}}}).followsLambert(0));
    EXPECT_FALSE(lawsOf({.name = "steel", .reflection = 0.9f, .roughness_slope = 0.1f}).followsLambert(0));
}

}  // namespace
}  // namespace insonify::sonar
