// Backscatter of materials between the entries of their tables, and materials that follow Lambert's law.
#include <gtest/gtest.h>

#include <cmath>

#include "components/acoustics/Matter.hpp"
#include "components/acoustics/RoughSurface.hpp"
#include "components/acoustics/Seabed.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

MaterialLaws makeLaws(types::Material material, std::optional<double> frequency_khz = 100) {
    SonarConfig config;
    config.frequency_khz = frequency_khz;
    types::Geometry geometry;
    geometry.materials = {std::move(material)};
    return makeMaterialLaws(config, geometry);
}

TEST(MaterialLawsTest, ATableMatchesItsLawBetweenItsEntriesToo) {
    const MaterialLaws laws = makeLaws({.name = "floor", .seabed = "medium_sand"});
    const acoustics::SeabedBackscatter sand(acoustics::seabedNamed("medium_sand").value(), 100, 1500);
    for (double grazing_deg = 3; grazing_deg <= 90; grazing_deg += 0.37) {
        const double grazing = types::radians(grazing_deg), cosine = std::sin(grazing);
        const double exact = sand.crossSection(grazing) / cosine, given = laws.overCosine(0, cosine);
        EXPECT_NEAR(10 * std::log10(given / exact), 0, grazing_deg < 6 ? 0.5 : 0.1) << grazing_deg;
    }
    EXPECT_EQ(laws.overCosine(0, 2), laws.overCosine(0, 1)) << "no cosine is above 1";
}

TEST(MaterialLawsTest, LambertsLawAppliesWithoutTableAndLobe) {
    const MaterialLaws lambert = makeLaws({.name = "mud", .lambert_db = -16.7f});
    EXPECT_TRUE(lambert.followsLambert(0));
    for (const double cosine : {0.001, 0.2, 0.7071, 1.0})
        EXPECT_NEAR(lambert.overCosine(0, cosine), std::pow(10, -1.67) * cosine, 1e-6) << cosine;
    EXPECT_FALSE(makeLaws({.name = "floor", .seabed = "silt"}).followsLambert(0));
    EXPECT_FALSE(makeLaws({.name = "measured", .measured = {{10, -30}, {90, -10}}}).followsLambert(0));
    EXPECT_FALSE(makeLaws({.name = "steel", .reflection = 0.9f, .roughness_slope = 0.1f}).followsLambert(0));
}

TEST(MaterialLawsTest, MatterIsARoughSolidAtTheSonarsFrequency) {
    for (const double frequency_khz : {100.0, 900.0, 3000.0})
        for (const acoustics::Matter matter : {acoustics::Matter::Steel, acoustics::Matter::Concrete}) {
            const MaterialLaws laws =
                makeLaws({.name = "m", .matter = std::string(acoustics::getName(matter))}, frequency_khz);
            const acoustics::RoughSurface surface =
                acoustics::makeRoughSurface(acoustics::getProperties(matter), frequency_khz, 1025, 1500);
            EXPECT_TRUE(laws.has_matter && laws.hasLobes());
            const double power = std::pow(surface.reflection(), 2) * surface.lobeShare() / (4 * M_PI);
            EXPECT_NEAR(double{laws.records[0].law.y} / power, 1, 1e-6);
            EXPECT_NEAR(double{laws.records[0].law.z} / surface.squareSlope(), 1, 1e-6);
            // Beyond the lobe: small perturbations, between two entries of the table to 0.5 dB.
            const LobeSlopes far{1, 0, 1e-6, 1e-6, 0, 0, 0};
            for (double grazing_deg = 20; grazing_deg < 75; grazing_deg += 1.7) {
                const double cosine = std::sin(types::radians(grazing_deg));
                const double exact = surface.diffuse(types::radians(grazing_deg)) / cosine;
                EXPECT_NEAR(10 * std::log10(laws.overCosine(0, cosine, far) / exact), 0, 0.5) << grazing_deg;
            }
        }
}

TEST(MaterialLawsTest, MatterWithoutALobeIsOnlyATable) {
    const MaterialLaws rock = makeLaws({.name = "m", .matter = "rock"}, 900);
    EXPECT_FALSE(rock.hasLobes());
    EXPECT_FALSE(rock.followsLambert(0));
    const double r =
        acoustics::makeRoughSurface(acoustics::getProperties(acoustics::Matter::Rock), 900, 1025, 1500).reflection();
    EXPECT_NEAR(rock.overCosine(0, 0.6), r * r / M_PI * 0.6, 1e-4) << "Lambert's law of all that is reflected";
}

TEST(MaterialLawsTest, WithoutAFrequencyMatterFollowsLambertsLaw) {
    const types::Material steel{.name = "m", .lambert_db = -9.8f, .matter = "steel", .reflection = 0.936f};
    types::Material plain = steel;
    plain.matter.clear();
    const MaterialLaws laws = makeLaws(steel, {}), as_before = makeLaws(plain, {});
    EXPECT_TRUE(laws.followsLambert(0));
    EXPECT_FALSE(laws.has_matter || laws.hasLobes());
    for (const double cosine : {0.1, 0.5, 1.0}) EXPECT_EQ(laws.overCosine(0, cosine), as_before.overCosine(0, cosine));
}

}  // namespace
}  // namespace insonify::sonar
