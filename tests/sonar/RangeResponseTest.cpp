#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "components/sonar/beams/BinGrid.hpp"

namespace insonify::sonar {
namespace {

BinGrid getBins(double width, int count = 200) { return {count, 1, width, 0, width * count, 1500}; }

acoustics::Pulse chirp(double bandwidth_khz) {
    acoustics::PulseConfig config;
    config.bandwidth_khz = bandwidth_khz;
    config.window = acoustics::PulseWindow::Hann;
    return {config, 1500};
}

acoustics::Pulse tone(double duration_us) {
    acoustics::PulseConfig config;
    config.duration_us = duration_us;
    return {config, 1500};
}

std::vector<float> spread(const RangeResponse& response, const std::vector<float>& echoes) {
    std::vector<float> padded(response.margin()), bins(echoes.size());
    padded.insert(padded.end(), echoes.begin(), echoes.end());
    padded.resize(padded.size() + response.margin());
    response.spread(padded, bins);
    return bins;
}

TEST(RangeResponseTest, AToneOfOneBinChangesNoBit) {
    const RangeResponse response(tone(100), getBins(0.075));  // 0.15 m there and back
    EXPECT_THAT(response.taps(), testing::ElementsAre(1.0f));
    const std::vector<float> echoes{0, 1e-9f, 3.3f, 0.1f, 7e-20f};
    EXPECT_EQ(spread(response, echoes), echoes);
}

TEST(RangeResponseTest, AToneOfThreeBinsFillsThreeBins) {
    const RangeResponse response(tone(300), getBins(0.075));
    EXPECT_THAT(response.taps(), testing::ElementsAre(1.0f, 1.0f, 1.0f));
    EXPECT_THAT(spread(response, {0, 0, 5, 0, 0, 0}), testing::ElementsAre(0, 5, 5, 5, 0, 0));
}

TEST(RangeResponseTest, UniformReverberationScalesWithTheLengthOfACell) {
    const acoustics::Pulse pulse = chirp(20);
    const RangeResponse response(pulse, getBins(0.01, 500));
    const double sum = std::accumulate(response.taps().begin(), response.taps().end(), 0.0);
    EXPECT_NEAR(sum * 0.01, pulse.cellLength(), 1e-3 * pulse.cellLength());
    EXPECT_NE(response.taps()[response.margin() + 1], response.taps()[response.margin()]);
    EXPECT_EQ(response.taps().front(), response.taps().back()) << "centred";
}

TEST(RangeResponseTest, NoEchoIsBeforeTheFirstBinOrAfterTheLast) {
    const RangeResponse response(chirp(20), getBins(0.01, 8));
    std::vector<float> echoes(8);
    echoes[0] = 1;
    const std::vector<float> bins = spread(response, echoes);
    EXPECT_FLOAT_EQ(bins[0], response.taps()[response.margin()]);
    EXPECT_FLOAT_EQ(bins[7], response.taps()[response.margin() + 7]);
}

TEST(RangeResponseTest, APulseUnderHalfABinIsShort) {
    EXPECT_TRUE(isShort(tone(49), getBins(0.075)));
    EXPECT_FALSE(isShort(tone(51), getBins(0.075)));
}

}  // namespace
}  // namespace insonify::sonar
