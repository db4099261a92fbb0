#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"

using namespace insonify::deployer;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

namespace {

json getWater(std::vector<std::string> options) {
    options.insert(options.begin(), "water");
    return makeJson(TestFolder(), options);
}

std::vector<std::string> getKeys(const json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

TEST(WaterCommandTest, PrintsEverySpeedAndAbsorptionByTheNameOfItsLaw) {
    const json water = getWater({"--temperature-celsius", "10", "--frequency-khz", "100", "--frequency-khz", "10"});
    EXPECT_THAT(getKeys(water), ElementsAre("absorption_db_per_m", "frequency_khz", "sound_speed_m_s", "warnings"));
    const json& speeds = water["sound_speed_m_s"];
    EXPECT_THAT(getKeys(speeds), ElementsAre("chen_millero", "coppens", "del_grosso", "leroy", "mackenzie", "medwin"));
    for (const auto& [law, speed] : speeds.items()) EXPECT_NEAR(speed, 1489.82, 0.4) << law;
    const json& absorptions = water["absorption_db_per_m"];
    EXPECT_THAT(getKeys(absorptions), ElementsAre("ainslie_mccolm", "fisher_simmons", "francois_garrison", "thorp"));
    EXPECT_NEAR(absorptions["francois_garrison"][0], 0.0336, 2e-4);
    EXPECT_NEAR(absorptions["francois_garrison"][1], 0.000963, 1e-5);
    EXPECT_THAT(water["frequency_khz"], ElementsAre(100, 10));
}

TEST(WaterCommandTest, TakesTemperatureSalinityDepthAcidityAndLatitude) {
    const json water = getWater({"--temperature-celsius", "25", "--salinity-psu", "35", "--depth", "1000"});
    EXPECT_NEAR(water["sound_speed_m_s"]["mackenzie"], 1550.744, 1e-3);
    EXPECT_THAT(water["frequency_khz"], IsEmpty());
    EXPECT_THAT(water["warnings"], IsEmpty());
    const json pole = getWater({"--depth", "5000", "--latitude-deg", "-90"}), middle = getWater({"--depth", "5000"});
    EXPECT_GT(pole["sound_speed_m_s"]["leroy"], middle["sound_speed_m_s"]["leroy"]);
    const json sour = getWater({"--frequency-khz", "1", "--ph", "7.7"}), plain = getWater({"--frequency-khz", "1"});
    EXPECT_LT(sour["absorption_db_per_m"]["francois_garrison"][0],
              plain["absorption_db_per_m"]["francois_garrison"][0]);
}

TEST(WaterCommandTest, OutsideAFormulasValidityWarnsOfTheRangeWithAFiniteResult) {
    const json water = getWater(
        {"--temperature-celsius", "45", "--salinity-psu", "50", "--depth", "11000", "--frequency-khz", "5000"});
    EXPECT_THAT(water["warnings"], Contains(AllOf(HasSubstr("mackenzie"), HasSubstr("45 degC (-2 to 30)"),
                                                  HasSubstr("50 psu (25 to 40)"))));
    EXPECT_THAT(water["warnings"], Contains(AllOf(HasSubstr("thorp at 5000 kHz"), HasSubstr("(0.1 to 50)"))));
    for (const auto& [law, speed] : water["sound_speed_m_s"].items()) EXPECT_TRUE(speed.is_number()) << law;
    for (const auto& [law, values] : water["absorption_db_per_m"].items()) EXPECT_TRUE(values[0].is_number()) << law;
}

TEST(WaterCommandTest, PrintsATableForReaders) {
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"water", "--frequency-khz", "750"}),
                prints(AllOf(HasSubstr("leroy"), HasSubstr("1489."), HasSubstr("750 kHz"), HasSubstr("0.22"),
                             HasSubstr("warning: thorp at 750 kHz is extrapolated: 750 kHz (0.1 to 50)"))));
}

TEST(WaterCommandTest, RefusesInvalidOrInfiniteNumbers) {
    const TestFolder folder;
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--temperature-celsius", "warm"},
                                               {"--temperature-celsius", "nan"},
                                               {"--temperature-celsius", "-300"},
                                               {"--salinity-psu", "-1"},
                                               {"--salinity-psu", "inf"},
                                               {"--depth", "-5"},
                                               {"--depth", "1e300"},
                                               {"--ph", "15"},
                                               {"--latitude-deg", "91"},
                                               {"--frequency-khz", "-1"},
                                               {"--frequency-khz", "nan"}}) {
        std::vector<std::string> words{"water"};
        words.insert(words.end(), options.begin(), options.end());
        const Outcome outcome = callInsonify(folder, words);
        EXPECT_THAT(outcome, isRefused(HasSubstr(options[0]))) << options[0] << ' ' << options[1] << options[1];
        EXPECT_THAT(outcome.out, Not(HasSubstr("m/s"))) << options[1];
    }
}

}  // namespace
