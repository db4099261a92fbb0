// Pressures, compared with the tables of UNESCO 44 and Saunders' formula.
#include <gmock/gmock.h>

#include "components/nav/ErrorModel.hpp"
#include "components/nav/Pressure.hpp"
#include "tests/nav/Paths.hpp"

namespace insonify::nav {
namespace {

constexpr double decibar = 1e4;

TEST(PressureTest, DepthsMatchUnescosTable) {
    // Fofonoff and Millard 1983, table of depth by pressure [dbar] and latitude [deg], and their check value.
    const struct {
        double pressure, latitude, depth;
    } table[] = {{500, 0, 496.65},     {500, 45, 495.34},   {500, 90, 494.03},   {1000, 0, 992.12},
                 {1000, 60, 988.19},   {5000, 30, 4908.56}, {5000, 90, 4889.13}, {10000, 0, 9725.47},
                 {10000, 45, 9699.84}, {10000, 90, 9674.23}};
    for (const auto& row : table)
        EXPECT_NEAR(depthOfOcean(row.pressure * decibar, row.latitude), row.depth, 0.006) << row.pressure;
    EXPECT_NEAR(depthOfOcean(10000 * decibar, 30), 9712.653, 6e-4);
}

TEST(PressureTest, DepthsAreNearSaunders) {
    // P. Saunders, "Practical conversion of pressure to depth", J. Phys. Oceanogr. 11, 1981: within a metre.
    for (const double latitude : {0.0, 30.0, 60.0})
        for (const double p : {10.0, 1000.0, 5000.0}) {
            const double sine = std::sin(types::radians(latitude));
            const double depth = (1 - (5.92 + 5.25 * sine * sine) * 1e-3) * p - 2.21e-6 * p * p;
            EXPECT_NEAR(depthOfOcean(p * decibar, latitude), depth, 1);
        }
}

TEST(PressureTest, PressureAndDepthAreEachOthersInverse) {
    for (const PressureConfig& config : {PressureConfig{.latitude_deg = 60}, PressureConfig{.density = 1000}})
        for (const double depth : {0.001, 1.0, 10.0, 300.0, 6000.0, 11999.0})
            EXPECT_NEAR(depthAt(pressureAt(depth, config), config), depth, 1e-9 * (1 + depth));
}

TEST(PressureTest, PressureInWaterOfConstantDensityIsItsWeight) {
    const PressureConfig lake{.latitude_deg = 47, .density = 999.7, .atmosphere = 96000};
    EXPECT_NEAR(pressureAt(30, lake), 96000 + 999.7 * normalGravity(47) * 30, 1e-6);
}

TEST(PressureTest, TenMetresOfSeaAreAboutABar) { EXPECT_NEAR(pressureAt(10, {}), 101325 + 100800, 200); }

TEST(PressureTest, PressureIsThatOfAirAboveTheSurfaceAndClampedAtMaxDepth) {
    EXPECT_EQ(pressureAt(0, {}), 101325);
    EXPECT_NEAR(pressureAt(-100, {}), 101325 * std::exp(-100 / 8434.0), 1e-6);
    EXPECT_EQ(pressureAt(-1e300, {}), 0);
    EXPECT_EQ(pressureAt(1e300, {}), pressureAt(deepest, {}));
    EXPECT_EQ(depthAt(0, {}), 0);
    EXPECT_EQ(depthAt(1e12, {}), deepest);
}

/** Mean and standard deviation of readings at rest [Pa]. */
std::pair<double, double> statistics(const PressureConfig& config, int count) {
    PressureGauge gauge(config);
    double sum = 0, squares = 0;
    for (int i = 1; i <= count; ++i) {
        const auto reading = static_cast<double>(gauge.measure(poseAt(i, {0, 0, -10})).pascal) - pressureAt(10, config);
        sum += reading, squares += reading * reading;
    }
    return {sum / count, std::sqrt(squares / count - sum / count * sum / count)};
}

TEST(PressureTest, ErrorsHaveTheirDeviations) {
    constexpr int count = 20'000;
    const auto [noisy_mean, noise] = statistics({.errors = {.noise = 50, .offset = 300}}, count);
    EXPECT_NEAR(noisy_mean, 300, 5 * 50 / std::sqrt(double{count}));
    EXPECT_NEAR(noise / 50, 1, 5 / std::sqrt(2.0 * count));
    const auto [drifting_mean, drift] = statistics({.errors = {.drift_deviation = 200, .drift_time = 0.1}}, count);
    EXPECT_NEAR(drifting_mean, 0, 5 * 200 / std::sqrt(double{count}));
    EXPECT_NEAR(drift / 200, 1, 5 / std::sqrt(2.0 * count));
}

TEST(PressureTest, ReadingsAreWholeStepsWithinTheRange) {
    const auto reading = [](PressureConfig config, double height) {
        return PressureGauge(config).measure(poseAt(1, {0, 0, height})).pascal;
    };
    EXPECT_EQ(reading({.errors = {.resolution = 20}}, 0), 101320.0f);
    EXPECT_EQ(reading({.max_pressure = 3e6}, -1000), 3e6f);
    EXPECT_EQ(reading({.max_pressure = 110000, .errors = {.resolution = 20000}}, -1000), 100000.0f);
    EXPECT_EQ(reading({.errors = {.offset = -1e6}}, 0), 0.0f) << "never below 0";
    EXPECT_EQ(reading({.water_surface = 2, .density = 1000}, -8),
              static_cast<float>(pressureAt(10, {.density = 1000})));
}

TEST(PressureTest, TheDepthOfAReadingIsTheDepthOfTheGauge) {
    const PressureConfig config{.water_surface = 2, .errors = {.noise = 100}};
    const types::Pose sample = depthSample({static_cast<float>(pressureAt(30, config)), {5}}, config);
    EXPECT_NEAR(sample.position.z, -28, 1e-3) << "of 32 bits of pressure";
    EXPECT_TRUE(std::isnan(sample.position.x) && std::isnan(sample.velocity.x));
    EXPECT_NEAR(std::sqrt(sample.cov_position[2][2]), 100 / 1.008e4, 1e-5);
    EXPECT_EQ(sample.time, types::Time{5});
}

}  // namespace
}  // namespace insonify::nav
