// `cerqueira2017` with `published: true`, compared with a count of pixels by the description of the published simulator
// (ACOUSTICS.md 8.2).
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

SonarConfig publishedSonar() {
    SonarConfig config;
    config.model = Model::Cerqueira2017;
    config.published = true;
    config.speed_of_sound = 1000;
    config.range = 49.9;
    config.range_rounding = RangeRounding::Exact;
    config.bin_count = 500;
    config.beam_count = 48;
    config.field_of_view_deg = 130;
    config.beam_height_deg = 30;
    config.quality.rows = 96;
    config.quality.columns_per_beam = 3;
    return config;
}

std::vector<float> publishedBins(const SonarConfig& config, const types::GeometryPtr& geometry) {
    return test::makePing(config, test::makeSnapshot(geometry)).bins;
}

double sigmoid(double z) { return 1 / (1 + std::exp(-18 * (z - 2.0 / 3))); }

/** Level ground `height` below the sonar, counted pixel by pixel; `absorption` in Np/m. */
std::vector<double> counted(const SonarConfig& config, double height, double absorption = 0) {
    const int width = config.columnsPerBeam() * config.beam_count, rows = config.rows();
    const auto beams = static_cast<size_t>(config.beam_count), bins = static_cast<size_t>(config.bin_count);
    const double fov = types::radians(config.fieldOfViewDeg());
    const double scale = width / 2.0 / std::tan(fov / 2),
                 half_height = std::tan(types::radians(config.beam_height_deg) / 2);
    const auto column = [&](size_t beam) {
        const double bearing = -fov / 2 + fov * static_cast<double>(beam) / static_cast<double>(beams);
        return static_cast<int>(std::round(width / 2.0 + std::tan(bearing) * scale));
    };
    std::vector<double> sum(beams * bins), count(beams * bins);
    for (size_t beam = 0; beam < beams; ++beam)
        for (int c = column(beam); c < column(beam + 1); ++c)
            for (int r = 0; r < rows; ++r) {
                const double u = (c + 0.5 - width / 2.0) / scale, v = half_height * ((r + 0.5) * 2 / rows - 1);
                double y = v < 0 ? height / -v * std::sqrt(1 + u * u + v * v) / config.range : 2;
                double z = v < 0 ? height / (y * config.range) * std::exp(-2 * absorption * y * config.range) : 0;
                if (y > 1) y = z = 0;
                const size_t at = beam * bins + static_cast<size_t>(y * (config.bin_count - 1));
                sum[at] += sigmoid(z);
                count[at] += 1;
            }
    for (size_t i = 0; i < sum.size(); ++i) sum[i] = count[i] > 0 ? sum[i] / count[i] : 0;
    return sum;
}

void expectEqual(const std::vector<float>& got, const std::vector<double>& expected) {
    ASSERT_EQ(got.size(), expected.size());
    for (size_t i = 0; i < got.size(); ++i)
        EXPECT_NEAR(got[i], expected[i], 1e-6) << "beam " << i / 500 << ", bin " << i % 500;
}

}  // namespace

TEST(PublishedTest, BinsAreTheCountOfPixelsOfOneWideFrustum) {
    for (const Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        SonarConfig config = publishedSonar();
        config.deposit = deposit;
        expectEqual(publishedBins(config, test::makeScene({test::ground(-5)})), counted(config, 5));
    }
}

TEST(PublishedTest, AbsorptionActsBeforeTheSigmoid) {
    SonarConfig config = publishedSonar();
    config.beam_height_deg = 80;  // sees the ground at cosines up to 0.64
    config.absorption.emplace().db_per_m = 0.3;
    const auto got = publishedBins(config, test::makeScene({test::ground(-5)}));
    expectEqual(got, counted(config, 5, 0.3 / 8.685889638));
    double difference = 0;
    const auto without = counted(config, 5);
    for (size_t i = 0; i < got.size(); ++i) difference = std::max(difference, std::abs(got[i] - without[i]));
    EXPECT_GT(difference, 0.01) << "absorption changes nothing, so this test shows nothing";
}

TEST(PublishedTest, AnEmptySeaIsTheSigmoidOfZeroInBinZero) {
    const SonarConfig config = publishedSonar();
    const auto bins = publishedBins(config, test::makeScene({test::ground(500)}));
    for (size_t i = 0; i < bins.size(); ++i) EXPECT_NEAR(bins[i], i % 500 ? 0 : 6.1e-6, 1e-7) << i;
}

TEST(PublishedTest, FootprintsFillTheBinsThatThePublishedModelLeavesEmpty) {
    SonarConfig config = publishedSonar();
    const auto geometry = test::makeScene({test::ground(-5)});
    const auto empty = [](const std::vector<float>& bins) {
        int count = 0;
        for (size_t k = 200; k < 490; ++k) count += bins[24 * 500 + k] == 0;
        return count;
    };
    EXPECT_GT(empty(publishedBins(config, geometry)), 100);
    config.published = false;
    EXPECT_EQ(empty(publishedBins(config, geometry)), 0);
}

}  // namespace insonify::sonar
