#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/YamlText.hpp"

namespace insonify::framework {
namespace {

double inUnit(const char* text, const char* unit) {
    const auto quantity = Quantity::parse(text);
    const auto wanted = findUnit(unit);
    return quantity && wanted ? quantity->in(*wanted).value_or(NAN) : NAN;
}

TEST(QuantityTest, RocksUnitsPrefixesAndPowersAreUnderstood) {
    EXPECT_EQ(inUnit("20.deg", "deg"), 20);
    EXPECT_EQ(inUnit("1.8.deg", "deg"), 1.8);
    EXPECT_EQ(inUnit("-360.deg", "deg"), -360);
    EXPECT_DOUBLE_EQ(inUnit("180.deg", "rad"), std::numbers::pi);
    EXPECT_DOUBLE_EQ(inUnit("5.cm", "m"), 0.05);
    EXPECT_DOUBLE_EQ(inUnit("2.km", "m"), 2000);
    EXPECT_DOUBLE_EQ(inUnit("3.m.s^-1", "m/s"), 3);
    EXPECT_DOUBLE_EQ(inUnit("90.deg.s^-1", "deg/s"), 90);
    EXPECT_DOUBLE_EQ(inUnit("10.kPa", "bar"), 0.1);
    EXPECT_DOUBLE_EQ(inUnit("6.N.m^-2", "Pa"), 6);
    EXPECT_DOUBLE_EQ(inUnit("7.mus", "us"), 7);
    EXPECT_DOUBLE_EQ(inUnit("0.7.MHz", "kHz"), 700);
    EXPECT_NEAR(inUnit("293.15.K", "degC"), 20, 1e-12);
    EXPECT_EQ(inUnit("7.6.m.floor", "m"), 7);
    EXPECT_EQ(inUnit("7.5.m.round", "m"), 8);
    EXPECT_EQ(inUnit("701.2.cm.ceil", "m"), 8);
}

TEST(QuantityTest, RejectsOtherDimensionsAndTexts) {
    for (const char* unit : {"m", "m/s", "s", "1", "dB", "psu"})
        EXPECT_TRUE(std::isnan(inUnit("20.deg", unit))) << unit;
    for (const char* text : {"20", "20.", ".deg", "deg", "20deg", "20.furlong", "20.m.s^", "20.m^x", "20.m^99", "nan.m",
                             "1e999.m", "20..m", "20.floor.m", "", "a.txt", "harbour.0.log"})
        EXPECT_FALSE(Quantity::parse(text)) << text;
}

struct Head {
    double step_deg = 1;
    int turns = 1;
    double temperature_celsius = 10;
    double level_db = 0;
    static void describe(auto& self, auto& visit) {
        visit({"step_deg", "deg", "turn", 0, 360}, self.step_deg);
        visit({"turns", "1", "how often", 0, 9}, self.turns);
        visit({"temperature_celsius", "degC", "of the water", -6, 50}, self.temperature_celsius);
        visit({"level_db", "dB", "of something"}, self.level_db);
    }
};

TEST(QuantityTest, APropertyTakesANumberWithAUnitOrRocksBlockOfOne) {
    Head head;
    ConfigReader reader("a.yml");
    EXPECT_TRUE(reader.read(YAML::Load("{step_deg: 360.deg, temperature_celsius: {kelvin: 285.15}}"), "", head));
    EXPECT_EQ(head.step_deg, 360);
    EXPECT_NEAR(head.temperature_celsius, 12, 1e-12);
    EXPECT_TRUE(reader.read(YAML::Load("{step_deg: {rad: 20.deg}, turns: 7.5.floor}"), "", head));
    EXPECT_EQ(head.step_deg, 20);
    EXPECT_EQ(head.turns, 7);
    EXPECT_TRUE(reader.read(YAML::Load("{step_deg: {rad: 1.5707963267948966}}"), "", head));
    EXPECT_DOUBLE_EQ(head.step_deg, 90);
}

TEST(QuantityTest, NamesAQuantityThatDoesNotFit) {
    Head head;
    ConfigReader reader("a.yml");
    reader.read(YAML::Load("{step_deg: 3.m, turns: 2.5.ceil.m, temperature_celsius: {rad: 1}, level_db: 3.m}"), "",
                head);
    reader.read(YAML::Load("{step_deg: {rad: 400.deg}, turns: {rad: 1}}"), "", head);
    std::vector<std::string> texts;
    for (const auto& diagnostic : reader.diagnostics()) texts.push_back(diagnostic.text());
    EXPECT_EQ(texts, (std::vector<std::string>{"a.yml:1:12: step_deg: is 3.m; must be in deg",
                                               "a.yml:1:24: turns: is 2.5.ceil.m; must be a whole number",
                                               "a.yml:1:57: temperature_celsius: is {rad: 1}; must be in degC",
                                               "a.yml:1:77: level_db: is 3.m; must be in dB",
                                               "a.yml:1:12: step_deg: is 400 deg; may be 0 to 360 deg",
                                               "a.yml:1:35: turns: is {rad: 1}; must be a number without a unit"}));
}

}  // namespace
}  // namespace insonify::framework
