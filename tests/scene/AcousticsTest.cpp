#include <gtest/gtest.h>

#include <cmath>

#include "components/acoustics/Backscatter.hpp"
#include "components/scene/Acoustics.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::scene {
namespace {

TEST(AcousticsTest, SedimentsHaveTheLambertParametersOfTheTable) {
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::MediumSand), -16.7);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::Rock), -5);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::RoughRock), -5);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::Clay), -23.7);
    EXPECT_DOUBLE_EQ(lambertDb(Sediment::Mackenzie), -27);
}

TEST(AcousticsTest, AMirrorIsTrueOrFalse) {
    const auto read = [](const AcousticValue& value, types::Diagnostics& diagnostics) {
        types::Material material;
        readAcoustics({{"mirror", value}}, ".", diagnostics).applyTo(material);
        return material.mirror;
    };
    types::Diagnostics diagnostics;
    EXPECT_TRUE(read(true, diagnostics));
    EXPECT_FALSE(read(false, diagnostics));
    EXPECT_TRUE(diagnostics.empty());
    read(1.0, diagnostics);
    read(std::string("maybe"), diagnostics);
    ASSERT_EQ(diagnostics.size(), 2u);
    EXPECT_EQ(diagnostics[0].text(), "mirror: is 1; must be true or false");
    EXPECT_EQ(diagnostics[1].text(), "mirror: is \"maybe\"; must be true or false");
}

TEST(AcousticsTest, LambertsLawFollowsTheReportsSeabeds) {
    struct Case {
        Sediment sediment;
        double strength[5];  ///< By the model of APL-UW TR 9407 at 100 kHz and 1528 m/s, computed independently [dB].
    };
    constexpr double grazing_deg[] = {10, 20, 30, 45, 60};
    for (const Case& c : {Case{Sediment::Cobble, {-21.3, -16.2, -13.8, -12.4, -11.8}},
                          {Sediment::SandyGravel, {-24.2, -19.3, -17.5, -16.4, -15.5}},
                          {Sediment::CoarseSand, {-27.2, -21.8, -20.1, -18.9, -17.1}},
                          {Sediment::MediumSand, {-29.8, -24.2, -22.6, -21.3, -19.5}},
                          {Sediment::FineSand, {-33.5, -27.2, -24.6, -23.6, -22.0}},
                          {Sediment::MuddySand, {-34.7, -27.4, -25.2, -24.1, -22.9}},
                          {Sediment::VeryFineSand, {-34.0, -27.0, -25.6, -24.5, -23.5}},
                          {Sediment::CoarseSilt, {-31.9, -27.8, -26.4, -25.0, -24.1}},
                          {Sediment::SandySilt, {-31.8, -28.4, -26.7, -25.2, -24.3}},
                          {Sediment::MediumSilt, {-35.6, -31.7, -29.9, -28.3, -27.3}},
                          {Sediment::FineSilt, {-35.8, -31.8, -29.9, -28.3, -27.4}},
                          {Sediment::VeryFineSilt, {-36.0, -31.9, -30.0, -28.4, -27.4}},
                          {Sediment::Clay, {-36.4, -32.0, -30.1, -28.4, -27.4}}}) {
        double sum = 0, squares = 0;
        for (size_t i = 0; i < 5; ++i) {
            const double lambert = lambertDb(c.sediment) + 20 * std::log10(std::sin(grazing_deg[i] * M_PI / 180));
            sum += (lambert - c.strength[i]) / 5;
            squares += std::pow(lambert - c.strength[i], 2) / 5;
        }
        const auto name = types::EnumNames<Sediment>::names[static_cast<size_t>(c.sediment)];
        EXPECT_NEAR(sum, 0, 0.5) << name;
        EXPECT_LT(std::sqrt(squares), 2.5) << name;
    }
}

TEST(AcousticsTest, MatterHasTheReflectionOfTheTable) {
    EXPECT_DOUBLE_EQ(reflection(Matter::Steel), 0.936);
    EXPECT_DOUBLE_EQ(reflection(Matter::CarbonSteel), 0.936);
    EXPECT_DOUBLE_EQ(reflection(Matter::Air), -0.9995);
    EXPECT_DOUBLE_EQ(reflection(Matter::Ice), 0.39);
    EXPECT_NEAR(lambertDb(Matter::Granite), -9.23 - 1.83, 0.01);
}

TEST(AcousticsTest, ReflectionIsThatOfTypicalImpedancesAgainstSeaWater) {
    struct Case {
        Matter matter;
        double softest, hardest;  ///< Specific impedance [MRayl].
    };
    const auto against_water = [](double z) { return (z - 1.5375) / (z + 1.5375); };  // 1025 kg/m^3 x 1500 m/s
    for (const Case& c : {Case{Matter::Steel, 46.3, 46.3},
                          {Matter::CarbonSteel, 46.3, 46.3},
                          {Matter::Aluminium, 17.1, 17.1},
                          {Matter::CastIron, 33, 33},
                          {Matter::Bronze, 40, 40},
                          {Matter::Granite, 14, 14.6},
                          {Matter::Basalt, 14, 14.6},
                          {Matter::Concrete, 7, 10},
                          {Matter::Limestone, 7.2, 7.2},
                          {Matter::Gravel, 3.6, 3.6},
                          {Matter::Sand, 3.1, 3.3},
                          {Matter::Mud, 1.7, 1.8},
                          {Matter::Pvc, 3.33, 3.33},
                          {Matter::Acrylic, 3.22, 3.22},
                          {Matter::Hdpe, 2.34, 2.34},
                          {Matter::Neoprene, 2.1, 2.1},
                          {Matter::NaturalRubber, 1.47, 1.47},
                          {Matter::WaterloggedWood, 1.05, 1.7},
                          {Matter::DryWood, 0.05, 0.5},
                          {Matter::ClosedCellFoam, 0.05, 0.5},
                          {Matter::Ice, 3.5, 3.5},
                          {Matter::Air, 0.0004, 0.0004}}) {
        const auto name = types::EnumNames<Matter>::names[static_cast<size_t>(c.matter)];
        EXPECT_GE(reflection(c.matter), against_water(c.softest) - 0.01) << name;
        EXPECT_LE(reflection(c.matter), against_water(c.hardest) + 0.01) << name;
    }
}

TEST(AcousticsTest, ALambertSphereOfMatterHasTheTargetStrengthOfItsReflection) {
    // The echo is the integral of mu cos^2 over the visible half, 2 pi a^2 mu / 3; that of a rigid sphere is a^2 / 4.
    for (const Matter matter : {Matter::Steel, Matter::Concrete, Matter::Air}) {
        const double echo = 2 * M_PI / 3 * std::pow(10, lambertDb(matter) / 10);
        EXPECT_NEAR(echo, std::pow(reflection(matter), 2) / 4, 1e-3 * echo);
    }
}

TEST(AcousticsTest, NoSurfaceOfTheTablesCreatesEnergy) {
    const double maximum = 10 * std::log10(1 / M_PI);  // mu <= 1/pi
    for (size_t i = 0; i < std::size(types::EnumNames<Matter>::names); ++i) EXPECT_LT(lambertDb(Matter(i)), maximum);
    for (size_t i = 0; i < std::size(types::EnumNames<Sediment>::names); ++i)
        EXPECT_LT(lambertDb(Sediment(i)), maximum);
    EXPECT_NEAR(acoustics::max_lambert_db, maximum, 0.005) << "of what users may give";
}

TEST(AcousticsTest, TheHarbourKeepsTheLevelsOfItsMaterials) {
    const auto geometry = loadScene(std::filesystem::path(test::source_dir) / "deploy/scenes/harbour.glb");
    const std::pair<size_t, Matter> cases[] = {
        {1, Matter::Granite}, {2, Matter::Concrete}, {3, Matter::CarbonSteel}, {4, Matter::Neoprene}};
    for (const auto& [index, matter] : cases) {
        EXPECT_EQ(geometry->materials.at(index).lambert_db, static_cast<float>(lambertDb(matter)));
        EXPECT_EQ(geometry->materials[index].reflection, static_cast<float>(reflection(matter)));
        EXPECT_EQ(geometry->materials[index].matter, "") << "weathered: Lambert's law at every frequency";
    }
}

TEST(AcousticsTest, NumbersFromOutsideReplaceTheLawOfMatter) {
    Acoustics steel, slope, mirror;
    steel.material = Matter::Steel;
    slope.roughness_slope = 0.05;
    mirror.mirror = true;
    types::Material material;
    steel.applyTo(material);
    mirror.applyTo(material);
    EXPECT_EQ(material.matter, "steel");
    slope.applyTo(material);
    EXPECT_EQ(material.matter, "");
    EXPECT_FLOAT_EQ(material.reflection, 0.936f);
    steel.applyTo(material);
    EXPECT_EQ(material.matter, "steel");
}

TEST(AcousticsTest, AbsentValuesChangeNothing) {
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
