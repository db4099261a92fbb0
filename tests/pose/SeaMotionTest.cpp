// Motion of a carrier on waves: its root mean square, spectrum, derivative and seed.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "components/pose/SeaMotion.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "tests/support/Refused.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::pose {
namespace {

using std::numbers::pi;

constexpr SeaSpectrum spectra[] = {SeaSpectrum::PiersonMoskowitz, SeaSpectrum::Jonswap};

types::Pose still() { return Trajectory(std::vector<Waypoint>{{0, {1, 2, -5}, 0, 0, 30}}).at(0); }

types::Pose moved(const SeaMotion& motion, double time) {
    types::Pose pose = still();
    motion.move(time, pose);
    return pose;
}

TEST(SeaMotionTest, HasTheConfiguredRootMeanSquare) {
    for (const SeaSpectrum spectrum : spectra)
        for (uint64_t seed = 1; seed <= 5; ++seed) {
            const WaveSum waves(0.5, 6, spectrum, seed);
            double sum = 0, square = 0;
            constexpr int count = 40000;
            for (int i = 0; i < count; ++i) {
                const double value = waves.at(0.71 * i).value;
                sum += value / count, square += value * value / count;
            }
            EXPECT_NEAR(std::sqrt(square), 0.5, 0.01) << seed;
            EXPECT_NEAR(sum, 0, 0.01) << seed;
        }
}

/** S(x) of the two spectra over x = frequency / peak, not to scale. */
double density(SeaSpectrum spectrum, double x) {
    const double pm = std::pow(x, -5) * std::exp(-1.25 * std::pow(x, -4));
    const double width = x <= 1 ? 0.07 : 0.09;
    return spectrum == SeaSpectrum::PiersonMoskowitz
               ? pm
               : pm * std::pow(3.3, std::exp(-0.5 * std::pow((x - 1) / width, 2)));
}

TEST(SeaMotionTest, SharesOfTheEnergyMatchThePublishedSpectrum) {
    for (const SeaSpectrum spectrum : spectra) {
        double all = 0;
        for (double x = 5e-4; x < 60; x += 1e-3) all += 1e-3 * density(spectrum, x);
        double below = 0, x = 5e-4;
        for (const double share : {0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99}) {
            for (; below < share * all; x += 1e-3) below += 1e-3 * density(spectrum, x);
            EXPECT_NEAR(frequencyOfShare(spectrum, 2, share), 2 * x, 0.003 * 2 * x) << share;
        }
    }
}

TEST(SeaMotionTest, TheEnergyPeaksAtThePeriod) {
    for (const SeaSpectrum spectrum : spectra)
        for (const double period : {3.0, 8.0}) {
            std::vector<int> counts(40);  // of frequencies over the peak's, a tenth wide: equal energy each
            for (uint64_t seed = 0; seed < 400; ++seed) {
                const WaveSum waves(1, period, spectrum, seed);
                for (const double frequency : waves.frequencies())
                    if (const double x = frequency * period / (2 * pi) + 0.05; x < 4)
                        ++counts[static_cast<size_t>(10 * x)];
            }
            const auto peak = std::ranges::max_element(counts) - counts.begin();
            EXPECT_EQ(peak, 10) << period;
            double part = 0, all = 0;
            for (double x = 5e-4; x < 60; x += 1e-3) {
                all += density(spectrum, x);
                if (x > 0.95 && x < 1.05) part += density(spectrum, x);
            }
            EXPECT_NEAR(counts[10] / (400.0 * WaveSum::components), part / all, 0.02) << period;
        }
}

TEST(SeaMotionTest, VelocitiesAreTheDerivativesOfPlaceAndAttitude) {
    const SeaMotion motion({.heave_m = 0.4, .roll_deg = 8, .pitch_deg = 5, .period_s = 4});
    for (double time = -3; time < 60; time += 0.77) {
        constexpr double step = 1e-5;
        const types::Pose before = moved(motion, time - step), now = moved(motion, time),
                          after = moved(motion, time + step);
        EXPECT_LT(glm::length((after.position - before.position) / (2 * step) - now.velocity), 1e-6) << time;
        const glm::dquat rate = (after.orientation - before.orientation) / (2 * step);
        const glm::dquat turn = glm::conjugate(now.orientation) * rate;
        EXPECT_LT(glm::length(2.0 * glm::dvec3(turn.x, turn.y, turn.z) - now.angular_velocity), 1e-6) << time;
    }
}

TEST(SeaMotionTest, AMovingBodyKeepsItsOwnVelocities) {
    const SeaMotion motion({.roll_deg = 20, .pitch_deg = 10, .period_s = 4});
    const Trajectory turning(std::vector<Waypoint>{{0, {0, 0, 0}, 0, 0, 0}, {10, {20, 0, 3}, 0, 0, 120}});
    const auto at = [&](double time) {
        types::Pose pose = turning.at(time);
        motion.move(time, pose);
        return pose;
    };
    for (double time = 0.5; time < 9.5; time += 0.31) {
        constexpr double step = 1e-5;
        const types::Pose before = at(time - step), now = at(time), after = at(time + step);
        EXPECT_LT(glm::length((after.position - before.position) / (2 * step) - now.velocity), 1e-6) << time;
        const glm::dquat turn =
            glm::conjugate(now.orientation) * ((after.orientation - before.orientation) / (2 * step));
        EXPECT_LT(glm::length(2.0 * glm::dvec3(turn.x, turn.y, turn.z) - now.angular_velocity), 1e-5) << time;
    }
}

TEST(SeaMotionTest, EachSeedGivesItsOwnMotion) {
    const SeaMotionConfig config{.heave_m = 1, .roll_deg = 3, .seed = 7};
    SeaMotionConfig other = config;
    other.seed = 8;
    const types::Pose one = moved(SeaMotion(config), 12.3), again = moved(SeaMotion(config), 12.3);
    EXPECT_EQ(one.position, again.position);
    EXPECT_EQ(one.orientation, again.orientation);
    EXPECT_NE(one.position, moved(SeaMotion(other), 12.3).position);
    double product = 0;
    const WaveSum a(1, 6, SeaSpectrum::Jonswap, 1), b(1, 6, SeaSpectrum::Jonswap, 2);
    for (int i = 0; i < 20000; ++i) product += a.at(0.9 * i).value * b.at(0.9 * i).value / 20000;
    EXPECT_NEAR(product, 0, 0.1) << "of two narrow spectra";
}

TEST(SeaMotionTest, ExtremesAreFinite) {
    for (const SeaSpectrum spectrum : spectra)
        for (const double period : {0.1, 1000.0})
            for (const double time : {-1e9, 0.0, 1e9}) {
                const types::Pose pose = moved(SeaMotion({100, 90, 45, period, spectrum, 4294967295u}), time);
                EXPECT_TRUE(std::isfinite(pose.position.z) && std::isfinite(glm::length(pose.angular_velocity)));
                EXPECT_NEAR(glm::length(pose.orientation), 1, 1e-9);
            }
}

TEST(SeaMotionTest, RejectsAMotionWithoutAmplitudes) {
    EXPECT_THAT(test::countRefusals(SeaMotionConfig{}),
                testing::ElementsAre("moves nothing; give heave_m, roll_deg or pitch_deg"));
    EXPECT_THAT(test::countRefusals(SeaMotionConfig{.heave_m = 1}), testing::IsEmpty());
}

}  // namespace
}  // namespace insonify::pose
