// Four samples per pixel: the cells of twice the rows and columns, sampled at places that no row or column shares.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {
namespace {

/** A sonar and its samples per pixel. */
struct Sampled {
    SonarConfig config;
    RenderOptions options = {};
};

Sampled sampledSonar(int rows, int columns, int samples) {
    SonarConfig config =
        test::getSonar({.beams = 8, .width_deg = 80, .height_deg = 40, .bins = 300, .rows = rows, .columns = columns});
    config.device = "software";
    return {config, {.samples_per_pixel = samples}};
}

std::vector<float> sampledBins(const Sampled& sonar, const types::GeometryPtr& geometry) {
    return test::makePing(sonar.config, test::makeSnapshot(geometry), sonar.options).bins;
}

double sumEnergy(const Sampled& sonar, const types::GeometryPtr& geometry) {
    double sum = 0;
    for (float bin : sampledBins(sonar, geometry)) sum += bin;
    return sum;
}

/** A wall 10 m ahead that ends at height `top`. */
types::GeometryPtr screen(float top) {
    return test::makeScene({test::quad({10, -50, -50}, {0, 100, 0}, {0, 0, 50 + top})});
}

TEST(SamplesTest, SamplesOnAPlaneMatchPixelsOfTwiceTheRowsAndColumns) {
    const auto bottom = test::makeScene({test::ground(-5)});
    const auto four = sampledBins(sampledSonar(64, 4, 4), bottom), finer = sampledBins(sampledSonar(128, 8, 1), bottom);
    ASSERT_EQ(four.size(), finer.size());
    double difference = 0, sum = 0;
    for (size_t i = 0; i < four.size(); ++i) {
        difference += std::abs(four[i] - finer[i]);
        sum += finer[i];
    }
    EXPECT_GT(sum, 0);
    EXPECT_LT(difference, 1e-5 * sum);
}

TEST(SamplesTest, FourSamplesHalveTheErrorAtAnEdgeAlongTheRows) {
    double four = 0, finer = 0;
    for (float top = 0.5f; top < 2.5f; top += 0.13f) {
        const double truth = sumEnergy(sampledSonar(2048, 4, 1), screen(top));
        four += std::pow(sumEnergy(sampledSonar(32, 8, 4), screen(top)) / truth - 1, 2);
        finer += std::pow(sumEnergy(sampledSonar(64, 16, 1), screen(top)) / truth - 1, 2);
    }
    EXPECT_LT(four, finer / 2) << "mean squares";
}

}  // namespace
}  // namespace insonify::sonar
