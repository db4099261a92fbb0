// A Doppler velocity log, compared with the closed forms of its geometry.
#include <gmock/gmock.h>

#include "components/nav/Dvl.hpp"
#include "tests/nav/Paths.hpp"

namespace insonify::nav {
namespace {

types::Dvl ping(const Dvl& log, const Motion& motion, const Bottom& bottom) {
    types::Dvl reported;
    log.measure(motion, bottom, reported);
    return reported;
}

Motion moving(glm::dvec3 velocity, glm::dquat orientation = {1, 0, 0, 0}, double height = 0) {
    Motion motion;
    motion.time = {1'000'000};
    motion.position = {3, -2, height};
    motion.orientation = orientation;
    motion.velocity = velocity;
    return motion;
}

TEST(DvlTest, BeamsLookDownAndOutAtFourSides) {
    const BeamDirections beams = janusBeams(30, 45);
    for (const glm::dvec3& beam : beams) {
        EXPECT_NEAR(glm::length(beam), 1, 1e-15);
        EXPECT_NEAR(beam.z, -std::cos(types::radians(30)), 1e-15);
    }
    EXPECT_GT(beams[0].x, 0);
    EXPECT_GT(beams[0].y, 0) << "ahead to port";
    EXPECT_LT(glm::length(glm::dvec2(beams[0]) + glm::dvec2(beams[2])), 1e-15) << "opposite";
}

TEST(DvlTest, IsExactWithoutErrorsOverALevelBottomInAnyAttitude) {
    const Bottom bottom(-12.0);
    for (const glm::dquat& orientation : {turned(0), turned(40, 10, -15), turned(-160, -20, 5)})
        for (const DvlConfig& config : {DvlConfig{}, DvlConfig{.slant_deg = 22.5, .beam_azimuth_deg = 0}}) {
            const glm::dvec3 velocity(1.2, -0.4, 0.3);
            const types::Dvl reported = ping(Dvl(config), moving(velocity, orientation), bottom);
            EXPECT_LT(glm::distance(orientation * reported.velocity, velocity), 1e-9);
            EXPECT_EQ(reported.goodBeams(), 4u);
            for (size_t i = 0; i < beam_count; ++i) {
                const glm::dvec3 beam = orientation * reported.beam_directions[i];
                EXPECT_NEAR(reported.beam_ranges[i], -12 / beam.z, 1e-9);
                EXPECT_NEAR(reported.beam_velocities[i], glm::dot(beam, velocity), 1e-12)
                    << "positive towards the bottom";
            }
        }
}

TEST(DvlTest, TheAltitudeOfALevelLogIsItsHeight) {
    const types::Dvl reported = ping(Dvl({}), moving({}, turned(30)), Bottom(-12.0));
    EXPECT_NEAR(reported.altitude, 12, 1e-12);
    EXPECT_EQ(reported.diagnostic(), nullptr);
}

/** Returns the covariance of the velocities of many pings. */
glm::dmat3 spread(const Dvl& log, Motion motion, int count) {
    glm::dmat3 sum{0};
    const Bottom bottom(-12.0);
    for (int i = 0; i < count; ++i) {
        motion.time = motion.time + types::Time{125'000};
        const glm::dvec3 error = ping(log, motion, bottom).velocity - motion.velocity;
        sum += glm::outerProduct(error, error) / static_cast<double>(count);
    }
    return sum;
}

TEST(DvlTest, NoiseHasTheCovarianceOfJanus) {
    constexpr double noise = 0.01;
    constexpr int count = 20'000;
    for (const double slant : {20.0, 30.0}) {
        const double sine = std::sin(types::radians(slant)), cosine = std::cos(types::radians(slant));
        const double across = noise * noise / (2 * sine * sine), along = noise * noise / (4 * cosine * cosine);
        const Dvl log({.slant_deg = slant, .errors = {.velocity_noise = noise}});
        const Motion motion = moving({1, 0.5, -0.1});
        const glm::dmat3 reported = ping(log, motion, Bottom(-12.0)).cov_velocity, found = spread(log, motion, count);
        EXPECT_NEAR(reported[0][0] / across, 1, 1e-12);
        EXPECT_NEAR(reported[1][1] / across, 1, 1e-12);
        EXPECT_NEAR(reported[2][2] / along, 1, 1e-12);
        EXPECT_NEAR(reported[0][1], 0, 1e-18);
        const double bound = 5 * std::sqrt(2.0 / count);
        EXPECT_NEAR(found[0][0] / across, 1, bound);
        EXPECT_NEAR(found[1][1] / across, 1, bound);
        EXPECT_NEAR(found[2][2] / along, 1, bound);
        EXPECT_NEAR(found[0][1] / across, 0, bound);
        EXPECT_NEAR(found[0][2] / across, 0, bound);
    }
}

TEST(DvlTest, ThreeBeamsAreEnoughAndTwoAreNot) {
    const BeamDirections beams = janusBeams(30, 45);
    const glm::dvec3 velocity(0.7, -0.3, 0.2);
    std::array<double, beam_count> along, variances;
    for (size_t i = 0; i < beam_count; ++i) along[i] = glm::dot(beams[i], velocity), variances[i] = 1e-4;
    const auto four = solveVelocity(beams, along, variances);
    along[1] = types::Pose::unknown;
    const auto three = solveVelocity(beams, along, variances);
    ASSERT_TRUE(four && three);
    EXPECT_LT(glm::distance(three->velocity, velocity), 1e-14);
    EXPECT_GT(three->covariance[0][0], four->covariance[0][0]);
    along[2] = types::Pose::unknown;
    EXPECT_FALSE(solveVelocity(beams, along, variances));
}

TEST(DvlTest, ThreeBeamsOverALevelBottomAreExact) {
    // Rolled until the bottom is out of reach for one beam.
    const DvlConfig config{.beam_azimuth_deg = 0, .max_altitude = 14};
    const glm::dquat orientation = turned(0, 0, 25);
    const types::Dvl reported = ping(Dvl(config), moving({1, 0.5, 0}, orientation), Bottom(-10.0));
    EXPECT_EQ(reported.goodBeams(), 3u);
    EXPECT_LT(glm::distance(orientation * reported.velocity, {1, 0.5, 0}), 1e-9);
}

TEST(DvlTest, HasNoBottomLockOutOfReach) {
    const Dvl log({.min_altitude = 0.5, .max_altitude = 50});
    const auto at = [&](double height, glm::dquat orientation = {1, 0, 0, 0}) {
        return ping(log, moving({1, 0, 0}, orientation, height), Bottom(-10.0));
    };
    EXPECT_TRUE(at(39.9).hasBottomLock());
    EXPECT_TRUE(at(-9.4).hasBottomLock());
    for (const types::Dvl& lost : {at(40.1), at(-9.6), at(0, turned(0, 0, 180)), at(1e300)}) {
        EXPECT_FALSE(lost.hasBottomLock());
        EXPECT_EQ(lost.goodBeams(), 0u);
        EXPECT_TRUE(std::isnan(lost.altitude) && std::isnan(lost.cov_velocity[0][0]));
        EXPECT_THAT(lost.beam_velocities, testing::Each(testing::IsNan()));
        EXPECT_EQ(lost.diagnostic(), nullptr);
    }
}

TEST(DvlTest, RangesHaveTheirNoiseAndAreNeverNegative) {
    Motion motion = moving({});
    const Dvl noisy({.errors = {.range_noise = 0.05}}), wild({.errors = {.range_noise = 1000}});
    constexpr int count = 20'000;
    double squares = 0, minimum = 1;
    for (int i = 0; i < count; ++i) {
        motion.time = motion.time + types::Time{125'000};
        squares += std::pow(ping(noisy, motion, Bottom(-10.0)).beam_ranges[2] - 10 / std::cos(types::radians(30)), 2);
        minimum = std::min(minimum, ping(wild, motion, Bottom(-10.0)).beam_ranges[2]);
    }
    EXPECT_NEAR(squares / count / (0.05 * 0.05), 1, 5 * std::sqrt(2.0 / count));
    EXPECT_EQ(minimum, 0);
}

TEST(DvlTest, AShareOfBeamsIsLost) {
    const Dvl log({.errors = {.dropout = 0.2}});
    Motion motion = moving({1, 0, 0});
    constexpr int count = 20'000;
    int good = 0, locked = 0;
    for (int i = 0; i < count; ++i) {
        motion.time = motion.time + types::Time{125'000};
        const types::Dvl reported = ping(log, motion, Bottom(-10.0));
        good += static_cast<int>(reported.goodBeams());
        locked += reported.hasBottomLock();
    }
    EXPECT_NEAR(good / (4.0 * count), 0.8, 5 * std::sqrt(0.16 / (4 * count)));
    EXPECT_NEAR(locked / double{count}, std::pow(0.8, 4) + 4 * 0.2 * std::pow(0.8, 3), 5 * std::sqrt(0.15 / count));
}

TEST(DvlTest, ConstantErrorsStayAndHaveTheirDeviation) {
    constexpr int logs = 4000;
    double scale = 0, bias = 0;
    for (uint64_t seed = 0; seed < logs; ++seed) {
        const Dvl log({.sensor = {.seed = seed}, .errors = {.scale_error = 0.002, .velocity_bias = 0.001}});
        const Bottom bottom(-12.0);
        const double still = ping(log, moving({}), bottom).beam_velocities[0];
        const types::Dvl fast = ping(log, moving({0, 0, -10}), bottom);
        const double along = 10 * std::cos(types::radians(30));
        bias += still * still / logs;
        scale += std::pow((fast.beam_velocities[0] - still) / along - 1, 2) / logs;
        Motion later = moving({});
        later.time = {99'000'000};
        EXPECT_EQ(ping(log, later, bottom).beam_velocities[0], still);
        EXPECT_NEAR(fast.beam_velocity_variances[0], 1e-6 + 4e-6 * along * along, 1e-12);
    }
    EXPECT_NEAR(bias / 1e-6, 1, 5 * std::sqrt(2.0 / logs));
    EXPECT_NEAR(scale / 4e-6, 1, 5 * std::sqrt(2.0 / logs));
}

}  // namespace
}  // namespace insonify::nav
