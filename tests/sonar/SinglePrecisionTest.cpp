// The compute shader, which has no doubles, compared with the processor's deposit of the same pictures, for random
// sonars.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

/** A sonar and a scene before it. */
struct RandomSonar {
    explicit RandomSonar(uint32_t seed) : random(seed) {
        do {
            setFan();
            setModel();
            diagnostics = {};
            config.check(diagnostics);
        } while (!diagnostics.empty());
        setScene();
    }

    SonarConfig config;
    RenderOptions options;
    types::Snapshot snapshot;
    double bins_to_the_end = 0;

    types::Sonar ping(Deposit deposit) {
        config.deposit = deposit;
        return test::makePing(config, snapshot, options);
    }

private:
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
    double scaleBetween(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    bool chance(double p) { return between(0, 1) < p; }

    void setFan() {
        range = scaleBetween(2, 300);
        bins_to_the_end = chance(0.4) ? range / 0.01 : scaleBetween(30, 6000);
        const int bins = static_cast<int>(std::min(bins_to_the_end, 30000.0));
        const int beams = static_cast<int>(between(1, 65));
        const double width = chance(0.2) ? 180 : between(10, 140);
        config = test::getSonar({.beams = beams,
                                 .width_deg = width,
                                 .height_deg = chance(0.2) ? between(80, 150) : between(1, 60),
                                 .bins = bins,
                                 .bin = range / bins,
                                 .rows = static_cast<int>(scaleBetween(8, 200)),
                                 .columns = static_cast<int>(between(1, 9))});
        config.visibility = Visibility::Gl;
        config.device = "software";
        config.range_rounding = RangeRounding::Exact;
        if (chance(0.35)) config.beam_geometry = BeamGeometry::Conical;
        if (chance(0.3)) config.range_min = chance(0.3) ? 0 : between(0, range / 4);
        if (chance(0.3)) config.beam_width_deg = width / beams * (chance(0.5) ? 0.6 : 1.7);
    }
    void setModel() {
        const bool physical = chance(0.6);
        config.model = physical ? Model::Physical : Model::Cerqueira2017;
        options = {};
        if (chance(0.4)) config.absorption.emplace().db_per_m = scaleBetween(0.001, 0.3);
        if (!physical) {
            config.published = chance(0.3);
            return;
        }
        if (chance(0.4))
            config.volume = chance(0.5) ? std::vector<VolumeLayer>{{{}, {}, -60}}
                                        : std::vector<VolumeLayer>{{1, 5, -60}, {5, 20, -65}};
        if (chance(0.3)) config.beam_pattern.emplace().receive.elevation.emplace().width_deg = between(3, 30);
        if (chance(0.1)) options.estimator = Estimator::Nearest;
    }
    void setScene() {
        const auto geometry = test::surfaces();
        const double scale = chance(0.5) ? 1 : scaleBetween(0.1, 10);
        if (chance(0.3)) {
            geometry->materials[0].reflection = 0.5F;
            geometry->materials[0].roughness_slope = static_cast<float>(between(0, 0.3));
        }
        if (chance(0.2)) geometry->materials[1].measured = {{0, -40}, {30, -20}, {90, -10}};
        geometry->materials[chance(0.4) ? 0 : 1].normal_map = -1;
        for (auto& object : geometry->objects)
            object.world_from_object = glm::scale(glm::dmat4(1), glm::dvec3(scale)) * object.world_from_object;
        if (chance(0.4))
            geometry->objects.push_back(
                {"far wall", 3,
                 glm::scale(glm::translate(glm::dmat4(1), {range * between(0.5, 1), 0, 0}), {1., 200., 200.})});
        glm::dvec3 position(between(-2, 2) * scale, between(-2, 2) * scale, between(-2, 2) * scale);
        if (chance(0.2)) position = {between(-0.3, 0.3), between(-0.3, 0.3), -4 * scale + scaleBetween(0.1, 1)};
        const glm::dvec3 away = !config.volume.empty() ? glm::dvec3(0, 0, -8 * scale)
                                : chance(0.3)          ? glm::dvec3(500000, 4500000, -10)
                                                       : glm::dvec3(0);
        for (auto& object : geometry->objects) object.world_from_object[3] += glm::dvec4(away, 0);
        snapshot =
            test::makeSnapshot(geometry, position + away, between(-3.1, 3.1), between(-0.4, 0.4), between(-0.5, 0.5));
    }

    std::mt19937 random;
    types::Diagnostics diagnostics;
    double range = 0;
};

TEST(SinglePrecisionDepositTest, BinsMatchTheProcessor) {
    double max_bins = 0;
    int with_echoes = 0;
    for (uint32_t seed = 1; seed <= 24; ++seed) {
        RandomSonar sonar(seed);
        const types::Sonar expected = sonar.ping(Deposit::Cpu), got = sonar.ping(Deposit::Gpu);
        double error = 0, norm = 0;
        for (size_t i = 0; i < expected.bins.size(); ++i) {
            const double right = static_cast<double>(expected.bins[i]);
            error += std::pow(static_cast<double>(got.bins[i]) - right, 2);
            norm += right * right;
        }
        EXPECT_LE(std::sqrt(error), 1e-4 * std::sqrt(norm)) << "seed " << seed;
        if (norm > 0) {
            ++with_echoes;
            max_bins = std::max(max_bins, sonar.bins_to_the_end);
        }
    }
    EXPECT_GT(with_echoes, 16);
    EXPECT_GT(max_bins, 10000) << "single precision without an origin has steps of 1e-3 bins there";
}

}  // namespace
}  // namespace insonify::sonar
