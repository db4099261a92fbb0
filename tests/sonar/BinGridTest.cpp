#include <gtest/gtest.h>

#include "components/sonar/beams/BinGrid.hpp"

namespace insonify::sonar {
namespace {

SonarConfig makeGrid(double range, int bins, double speed = 1500) {
    SonarConfig config;
    config.range = range;
    config.bin_count = bins;
    config.speed_of_sound = speed;
    return config;
}

TEST(BinGridTest, BinDurationsAreWholeMicrosecondsRoundedUp) {
    struct Case {
        double range;
        int bins;
        int64_t us;
        double reached;
    };
    for (const Case& c :
         {Case{5, 1000, 4, 6.0}, Case{5, 500, 7, 5.25}, Case{10, 1000, 7, 10.5}, Case{10, 500, 14, 10.5},
          Case{50, 1000, 34, 51.0}, Case{50, 500, 67, 50.25}, Case{100, 1000, 67, 100.5}}) {
        const BinGrid grid = makeBinGrid(makeGrid(c.range, c.bins));
        EXPECT_EQ(grid.bin_duration_us, c.us) << c.range << " m, " << c.bins << " bins";
        EXPECT_NEAR(grid.range_max, c.reached, 1e-9);
        EXPECT_DOUBLE_EQ(grid.bin_width, static_cast<double>(c.us) * 1e-6 * 1500);
        EXPECT_DOUBLE_EQ(grid.edge(c.bins), grid.range_max);
    }
}

TEST(BinGridTest, ADurationWithinAMillionthOfAWholeNumberIsThatNumber) {
    EXPECT_EQ(makeBinGrid(makeGrid(75, 1000)).bin_duration_us, 50);
    EXPECT_EQ(makeBinGrid(makeGrid(75 * (1 + 1e-9), 1000)).bin_duration_us, 50);
    EXPECT_EQ(makeBinGrid(makeGrid(75 * (1 + 1e-7), 1000)).bin_duration_us, 51);
}

TEST(BinGridTest, ABinLastsAtLeastOneMicrosecond) {
    EXPECT_EQ(makeBinGrid(makeGrid(0.01, 1000)).bin_duration_us, 1);
    SonarConfig exact = makeGrid(0.01, 1000);
    exact.range_rounding = RangeRounding::Exact;
    EXPECT_EQ(makeBinGrid(exact).bin_duration_us, 1);
}

TEST(BinGridTest, ExactRoundingKeepsTheRequestedEdges) {
    SonarConfig config = makeGrid(5, 1000);
    config.range_rounding = RangeRounding::Exact;
    const BinGrid grid = makeBinGrid(config);
    EXPECT_DOUBLE_EQ(grid.range_max, 5);
    EXPECT_DOUBLE_EQ(grid.bin_width, 0.005);
    EXPECT_EQ(grid.bin_duration_us, 3);
}

TEST(BinGridTest, TheEdgesMatchThoseComputedFromTheSample) {
    const BinGrid grid = makeBinGrid(makeGrid(50, 500, 1487.123456789));
    const auto c = static_cast<double>(static_cast<float>(1487.123456789));
    EXPECT_EQ(grid.speed_of_sound, c);
    for (int k : {1, 250, 500})
        EXPECT_NEAR(grid.edge(k), k * static_cast<double>(grid.bin_duration_us) * 1e-6 * c, 1e-12);
}

TEST(BinGridTest, ThePublishedModelHasOneBinLess) {
    SonarConfig config = makeGrid(75, 501);
    config.model = Model::Cerqueira2017;
    config.published = true;
    const BinGrid grid = makeBinGrid(config);
    EXPECT_EQ(grid.bin_count, 501);
    EXPECT_DOUBLE_EQ(grid.range_max, 75);
    EXPECT_DOUBLE_EQ(grid.edge(500), 75);
}

}  // namespace
}  // namespace insonify::sonar
