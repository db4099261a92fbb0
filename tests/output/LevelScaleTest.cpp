#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "components/output/pictures/LevelScale.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::output {
namespace {

DisplayConfig fixed(double reference_db, double dynamic_range_db) {
    DisplayConfig config;
    config.reference_db = reference_db;
    config.dynamic_range_db = dynamic_range_db;
    return config;
}

int computeLevel(const DisplayConfig& config, double bin) {
    LevelScale scale(config);
    cv::Mat levels;
    scale.apply(cv::Mat(1, 1, CV_32F, cv::Scalar(bin)), levels);
    return levels.at<uint8_t>(0);
}

TEST(LevelScaleTest, LevelsAreProportionalToDecibelsBelowTheReference) {
    const DisplayConfig config = fixed(-20, 51);  // five levels a decibel
    EXPECT_EQ(computeLevel(config, std::pow(10, -2.0)), 255);
    EXPECT_EQ(computeLevel(config, std::pow(10, -3.0)), 205);
    EXPECT_EQ(computeLevel(config, std::pow(10, -6.0)), 55);
    EXPECT_EQ(computeLevel(config, std::pow(10, -7.2)), 0);
}

TEST(LevelScaleTest, ClipsLevelsOutsideAndShowsUnknownBinsDark) {
    const DisplayConfig config = fixed(0, 40);
    EXPECT_EQ(computeLevel(config, 1e30), 255);
    for (const double bin : {0.0, -1.0, 1e-30, std::nan("")}) EXPECT_EQ(computeLevel(config, bin), 0) << bin;
    EXPECT_EQ(computeLevel(config, std::numeric_limits<float>::infinity()), 255);
}

TEST(LevelScaleTest, ShowsCodesUnchanged) {
    DisplayConfig config;
    config.scale = BinScale::Code;
    for (const int code : {0, 1, 64, 128, 255}) EXPECT_EQ(computeLevel(config, code), code);
    EXPECT_EQ(computeLevel(config, std::nan("")), 0);
    EXPECT_EQ(computeLevel(config, 256), 255);
    config.code_bits = 16;
    EXPECT_EQ(computeLevel(config, 65535), 255);
    EXPECT_EQ(computeLevel(config, 257 * 100), 100);
    EXPECT_EQ(computeLevel(config, 0), 0);
}

TEST(LevelScaleTest, CodesHaveNoReferenceLevel) {
    PictureConfig config;
    config.scale = BinScale::Code;
    EXPECT_THAT(test::countRefusals(config), testing::IsEmpty());
    config.reference_db = 255;
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::StartsWith("reference_db: ")));
}

TEST(LevelScaleTest, ShowsBinsInDecibelsUnchanged) {
    DisplayConfig config = fixed(100, 51);
    config.scale = BinScale::Decibel;
    EXPECT_EQ(computeLevel(config, 90), 205);
    EXPECT_EQ(computeLevel(config, -3000), 0);
    EXPECT_EQ(computeLevel(config, std::nan("")), 0);
}

TEST(LevelScaleTest, WithoutAReferenceFollowsTheStrongestEchoesSmoothed) {
    LevelScale scale({});
    cv::Mat bins(100, 100, CV_32F, cv::Scalar(1e-3)), levels;
    bins.rowRange(0, 1) = 1;   // one in a hundred
    bins.at<float>(0) = 1e6f;  // a single bright bin does not count
    scale.apply(bins, levels);
    EXPECT_NEAR(scale.referenceDb(), 0, 0.2);
    scale.apply(bins * 100, levels);
    EXPECT_NEAR(scale.referenceDb(), 2, 0.2);
}

TEST(LevelScaleTest, AnEmptyPingKeepsTheReference) {
    LevelScale scale({});
    cv::Mat levels;
    scale.apply(cv::Mat(10, 10, CV_32F, cv::Scalar(10)), levels);
    const double before = scale.referenceDb();
    scale.apply(cv::Mat(10, 10, CV_32F, cv::Scalar(0)), levels);
    EXPECT_EQ(scale.referenceDb(), before);
}

}  // namespace
}  // namespace insonify::output
