#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/sonar/bins/Truth.hpp"

namespace insonify::sonar {
namespace {

constexpr uint64_t unit = 1u << 30;

/** Returns the truth of one beam of three bins. */
types::SonarTruth reported(const TruthTable& table, std::span<const uint64_t> water = {}) {
    types::Sonar ping;
    ping.beam_count = 1;
    ping.bin_count = 3;
    ping.bearings.resize(1);
    types::SonarTruth truth;
    truth.copyGrid(ping);
    table.report(0, 0, truth, water);
    return truth;
}

TEST(TruthTableTest, ABinHasTheObjectWithMostEnergyAndItsMeanAngles) {
    TruthTable table(1, 3);
    table.add(0, 1, ObjectEcho::of(unit, 0.2, 0.5, 7, 1));
    table.add(0, 1, ObjectEcho::of(4 * unit, -1, 1, 3, 4));
    table.add(0, 1, ObjectEcho::of(4 * unit, 0.7, 0.75, 7, 2));
    const types::SonarTruth truth = reported(table);
    EXPECT_THAT(truth.object, testing::ElementsAre(-1, 7, -1));
    EXPECT_NEAR(truth.share[1], 5.0 / 9, 1e-6);
    EXPECT_EQ(truth.hits[1], 7u);
    EXPECT_NEAR(truth.elevation[1], std::asin((0.2 + 4 * 0.7) / 5), 1e-6);
    EXPECT_NEAR(truth.grazing[1], std::asin((0.5 + 4 * 0.75) / 5), 1e-6);
    EXPECT_TRUE(std::isnan(truth.elevation[0]) && std::isnan(truth.grazing[2]));
}

TEST(TruthTableTest, AnglesAreRecoveredFromTheirSines) {
    double maximum = 0;
    for (double angle = -1.4; angle <= 1.4; angle += 0.001) {
        TruthTable table(1, 3);
        table.add(0, 0, ObjectEcho::of(uint64_t{1} << 50, std::sin(angle), 1, 0, 1));
        const types::SonarTruth truth = reported(table);
        maximum = std::max(maximum, std::abs(static_cast<double>(truth.elevation[0]) - angle));
        EXPECT_FLOAT_EQ(truth.grazing[0], static_cast<float>(std::numbers::pi / 2));
    }
    EXPECT_LT(maximum, 1e-6);
    RecordProperty("largest_rad", std::to_string(maximum));
}

TEST(TruthTableTest, SilentBinsNearerThanTheLastEchoAreInShadow) {
    TruthTable table(1, 3);
    table.add(0, 1, ObjectEcho::of(unit, 0, 1, 0, 1));
    EXPECT_THAT(reported(table).shadow, testing::ElementsAre(1, 0, 0));
    table.clear();
    EXPECT_THAT(reported(table).shadow, testing::Each(0));
}

/** Seven objects in one bin, object k with (k + 1) units: four are distinguished, in any order. */
TEST(TruthTableTest, DistinguishesTheObjectsOfLowestIndexAndCountsAllEnergy) {
    std::vector<uint32_t> order = {0, 1, 2, 3, 4, 5, 6};
    for (int shuffle = 0; shuffle < 200; ++shuffle) {
        TruthTable table(1, 3), second(1, 3);
        for (const uint32_t k : order) {
            TruthTable& to = shuffle % 2 == 1 && k % 3 == 0 ? second : table;
            for (uint32_t n = 0; n <= k; ++n) to.add(0, 2, ObjectEcho::of(unit, 0, 1, k, 1));
        }
        table.merge(0, second, 0);
        const types::SonarTruth truth = reported(table);
        EXPECT_EQ(truth.object[2], 3);
        EXPECT_FLOAT_EQ(truth.share[2], 4.0f / 28);
        EXPECT_EQ(truth.hits[2], 28u);
        std::ranges::next_permutation(order);
        if (shuffle % 10 == 0) std::ranges::reverse(order);
    }
}

/** Six objects of 1 to 6 units, of which the first four are distinguished: the water must be louder than 4 units. */
TEST(TruthTableTest, TheWaterIsTheLabelWhereItIsLouderThanTheStrongestObject) {
    for (const uint64_t water : {1, 3, 4, 5, 40}) {
        TruthTable table(1, 3);
        for (uint32_t k = 0; k < 6; ++k) table.add(0, 1, ObjectEcho::of((k + 1) * unit, 0, 1, k, 1));
        const types::SonarTruth truth = reported(table, std::vector<uint64_t>{0, water * unit, 7});
        const bool is_water = water > 4;
        EXPECT_THAT(truth.object, testing::ElementsAre(-1, is_water ? -1 : 3, -1));
        EXPECT_THAT(truth.path, testing::ElementsAre(0, is_water ? 6 : 0, 6));
        EXPECT_FLOAT_EQ(truth.share[1], static_cast<float>(is_water ? water : 4) / static_cast<float>(21 + water));
        EXPECT_THAT(truth.hits, testing::ElementsAre(0, 6, 0));
        EXPECT_THAT(truth.shadow, testing::ElementsAre(1, 0, 0));
        EXPECT_EQ(truth.share[2], 1);
        EXPECT_EQ(std::isnan(truth.elevation[1]), is_water);
        EXPECT_EQ(std::isnan(truth.grazing[1]), is_water);
    }
}

}  // namespace
}  // namespace insonify::sonar
