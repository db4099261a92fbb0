#include <gmock/gmock.h>

#include <cmath>

#include "tests/deployer/Command.hpp"

using namespace insonify::deployer;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

json backscatter(std::vector<std::string> options) {
    options.insert(options.begin(), "backscatter");
    return makeJson(TestFolder(), options);
}

TEST(BackscatterCommandTest, ASeabedHasTheStrengthsOfTheReport) {
    const json sand = backscatter({"--sediment", "medium_sand", "--frequency-khz", "30", "--sound-speed", "1528",
                                   "--grazing-deg", "10", "--grazing-deg", "90"});
    EXPECT_EQ(sand["name"], "medium_sand");
    EXPECT_EQ(sand["law"], "apl_uw_tr_9407");
    EXPECT_NEAR(sand["parameters"]["density_ratio"], 1.845, 1e-3);
    EXPECT_NEAR(sand["parameters"]["grain_size_phi"], 1.5, 1e-12);
    EXPECT_THAT(sand["grazing_deg"], ElementsAre(10, 90));
    EXPECT_NEAR(sand["strength_db"][0], -35.4, 0.6);  // APL-UW TR 9407, table 3
    EXPECT_NEAR(sand["strength_db"][1], -3.1, 0.6);
    EXPECT_THAT(sand["warnings"], IsEmpty());
    const json grains = backscatter({"--grain-size-phi", "1.5", "--frequency-khz", "30", "--sound-speed", "1528",
                                     "--grazing-deg", "10", "--grazing-deg", "90"});
    EXPECT_EQ(grains["strength_db"], sand["strength_db"]);
}

TEST(BackscatterCommandTest, EveryNameOfASedimentHasAStrength) {
    for (const char* name : {"rough_rock", "rock", "cobble", "sandy_gravel", "coarse_sand", "medium_sand", "fine_sand",
                             "muddy_sand", "very_fine_sand", "coarse_silt", "sandy_silt", "silt", "medium_silt",
                             "fine_silt", "very_fine_silt", "clay", "mackenzie"}) {
        const json seabed = backscatter({"--sediment", name, "--frequency-khz", "100"});
        EXPECT_EQ(seabed["strength_db"].size(), seabed["grazing_deg"].size()) << name;
        EXPECT_GT(seabed["grazing_deg"].size(), 10u) << name;
        for (const json& strength : seabed["strength_db"]) EXPECT_TRUE(strength.is_number()) << name;
    }
}

TEST(BackscatterCommandTest, LambertAndMaterialsFollowTheCosine) {
    const json lambert = backscatter({"--lambert-db", "-20", "--frequency-khz", "700", "--grazing-deg", "30"});
    EXPECT_EQ(lambert["law"], "lambert");
    EXPECT_NEAR(lambert["strength_db"][0], -26.02, 0.01);
    const json steel = backscatter({"--material", "steel", "--frequency-khz", "700", "--grazing-deg", "90"});
    EXPECT_EQ(steel["name"], "steel");
    const json sand = backscatter({"--material", "sand", "--frequency-khz", "700", "--grazing-deg", "90"});
    EXPECT_EQ(sand["law"], "lambert") << "its relief is not known";
    EXPECT_NEAR(sand["parameters"]["reflection"], 0.355, 1e-9);
    EXPECT_NEAR(sand["strength_db"][0], -9.23 + 20 * std::log10(0.355), 1e-6);
}

TEST(BackscatterCommandTest, AMaterialIsARoughSolidWithItsSources) {
    const auto of = [](const char* name, const char* khz) {
        return backscatter({"--material", name, "--frequency-khz", khz, "--grazing-deg", "45", "--grazing-deg", "90"});
    };
    const json steel = of("steel", "900"), rock = of("rock", "900");
    EXPECT_EQ(steel["law"], "rough_solid");
    EXPECT_NEAR(steel["parameters"]["reflection"], 0.936, 1e-3);
    EXPECT_EQ(steel["parameters"]["density_kg_m3"], 7850);
    EXPECT_EQ(steel["parameters"]["shear_speed_m_s"], 3230);
    EXPECT_NEAR(steel["parameters"]["roughness_um"], 14.8, 0.1);
    EXPECT_EQ(steel["sources"]["density_and_speeds"], "ASTM E494 2015, density Haynes 2014");
    EXPECT_THAT(steel["sources"]["roughness"].get<std::string>(), HasSubstr("Moody 1944"));
    EXPECT_LT(steel["strength_db"][0], -25) << "off its specular highlight";
    EXPECT_GT(steel["strength_db"][1], 20) << "its highlight";
    EXPECT_LT(steel["diffuse_db"][1], -20);
    EXPECT_NEAR(rock["strength_db"][1], 20 * std::log10(0.724 / std::sqrt(M_PI)), 0.05) << "Lambert's law";
    EXPECT_NEAR(rock["strength_db"][1].get<double>() - rock["strength_db"][0].get<double>(), 3.01, 0.05);
    EXPECT_GT(of("steel", "3000")["diffuse_db"][0], steel["diffuse_db"][0].get<double>() + 3);
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"backscatter", "--material", "human_body", "--frequency-khz", "3000"}).out,
                AllOf(HasSubstr("human_body, by law rough_solid"), HasSubstr("correlation_length_um"),
                      HasSubstr("source of roughness"), HasSubstr("without the lobe [dB]")));
}

TEST(BackscatterCommandTest, AWallNearAHalfWaveIsNearlyTransparent) {
    const auto of = [](const char* mm, const char* fill) {
        return backscatter({"--material", "pvc", "--shell-mm", mm, "--fill", fill, "--frequency-khz", "3000",
                            "--grazing-deg", "30", "--grazing-deg", "90"});
    };
    const json half = of("0.4", "water"), quarter = of("0.2", "water"), air = of("0.4", "air");
    EXPECT_EQ(half["law"], "thin_wall");
    EXPECT_NEAR(half["parameters"]["half_waves"], 1, 1e-9);
    EXPECT_NEAR(half["parameters"]["half_wave_khz"], 3000, 1e-6);
    EXPECT_LT(half["reflected_db"][1], -30);
    EXPECT_GT(half["passed_db"][1], -0.5);
    EXPECT_GT(quarter["reflected_db"][1], -6);
    EXPECT_NEAR(quarter["strength_db"][1].get<double>(), -9.23 + quarter["reflected_db"][1].get<double>(), 0.01);
    EXPECT_GT(air["reflected_db"][1], -1.5);
    ASSERT_EQ(half["warnings"].size(), 1u);
    EXPECT_THAT(half["warnings"][0].get<std::string>(), HasSubstr("half-wave resonance"));
    EXPECT_THAT(quarter["warnings"], IsEmpty());
    EXPECT_THAT(air["warnings"], IsEmpty());
    const TestFolder folder;
    EXPECT_THAT(
        callInsonify(folder, {"backscatter", "--material", "pvc", "--shell-mm", "0.4", "--frequency-khz", "3000"}).out,
        AllOf(HasSubstr("pvc, by law thin_wall"), HasSubstr("wall reflects [dB]   passes [dB]")));
    EXPECT_THAT(
        callInsonify(folder, {"backscatter", "--material", "wood", "--shell-mm", "1", "--frequency-khz", "3000"}),
        isRefused(HasSubstr("--material: is 'wood'; may be steel, ")));
    EXPECT_THAT(callInsonify(folder, {"backscatter", "--sediment", "clay", "--shell-mm", "1", "--frequency-khz", "9"}),
                isRefused(HasSubstr("--shell-mm: is given without --material")));
}

TEST(BackscatterCommandTest, EveryMaterialIsFiniteAtEveryFrequency) {
    for (const char* name : {"steel", "glass", "acrylic", "pvc", "rubber", "wood", "concrete", "rock", "rope", "net",
                             "fouling", "human_body", "air", "closed_cell_foam", "natural_rubber"})
        for (const char* khz : {"10", "3000"})
            for (const json& strength : backscatter({"--material", name, "--frequency-khz", khz})["strength_db"])
                EXPECT_TRUE(strength.is_number() && std::isfinite(strength.get<double>())) << name << " " << khz;
}

TEST(BackscatterCommandTest, AboveAHundredKilohertzAWarningNamesTheRange) {
    const json sand = backscatter({"--sediment", "fine_sand", "--frequency-khz", "750", "--grazing-deg", "0"});
    ASSERT_EQ(sand["warnings"].size(), 1u);
    EXPECT_THAT(sand["warnings"][0].get<std::string>(), HasSubstr("750 kHz (10 to 100)"));
    EXPECT_TRUE(sand["strength_db"][0].is_number());
    const json coarse = backscatter({"--grain-size-phi", "-5", "--frequency-khz", "50"});
    EXPECT_THAT(coarse["warnings"][0].get<std::string>(), HasSubstr("-5 phi (-1 to 9)"));
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"backscatter", "--sediment", "clay", "--frequency-khz", "750"}).out,
                AllOf(HasSubstr("clay, by law apl_uw_tr_9407"), HasSubstr("grazing [deg]"),
                      HasSubstr("warning: apl_uw_tr_9407 is extrapolated: 750 kHz (10 to 100)")));
}

TEST(BackscatterCommandTest, RefusesUnknownNamesAndInvalidAngles) {
    const TestFolder folder;
    struct Case {
        std::vector<std::string> options;
        const char* words;
    };
    for (const Case& c :
         {Case{{"--sediment", "medium_snad", "--frequency-khz", "50"}, "did you mean medium_sand?"},
          Case{{"--material", "stel", "--frequency-khz", "50"}, "did you mean steel?"},
          Case{{"--material", "", "--frequency-khz", "50"}, "--material: is empty; must be TEXT: a material"},
          Case{{"--material", "Aluminum", "--frequency-khz", "50"}, "did you mean aluminium?"},
          Case{{"--frequency-khz", "50"}, "names 0 scatterers"},
          Case{{"--sediment", "clay", "--lambert-db", "-20", "--frequency-khz", "50"}, "names 2 scatterers"},
          Case{{"--lambert-db", "21", "--frequency-khz", "50"}, "--lambert-db: is 21; must be from -200 to 20"},
          Case{{"--sediment", "clay", "--frequency-khz", "50", "--sound-speed", "1.5"}, "must be from 100 to 20000"},
          Case{{"--sediment", "clay"}, "--frequency-khz"},
          Case{{"--sediment", "clay", "--frequency-khz", "nan"}, "--frequency-khz: is nan"},
          Case{{"--sediment", "clay", "--frequency-khz", "0"}, "--frequency-khz: is 0"},
          Case{{"--sediment", "clay", "--frequency-khz", "50", "--grazing-deg", "91"}, "--grazing-deg: is 91"},
          Case{{"--sediment", "clay", "--frequency-khz", "50", "--sound-speed", "0"}, "--sound-speed: is 0"},
          Case{{"--grain-size-phi", "inf", "--frequency-khz", "50"}, "--grain-size-phi: is inf"}}) {
        std::vector<std::string> words{"backscatter"};
        words.insert(words.end(), c.options.begin(), c.options.end());
        EXPECT_THAT(callInsonify(folder, words), isRefused(HasSubstr(c.words))) << c.words;
    }
}

}  // namespace
