#include <gmock/gmock.h>

#include "tests/nav/Paths.hpp"

namespace insonify::nav {
namespace {

TEST(MotionTest, IsTheMotionAtTheMiddleOfThreePoses) {
    MotionTracker tracker;
    EXPECT_FALSE(tracker.take(poseAt(1, {0, 0, 0})));
    EXPECT_FALSE(tracker.take(poseAt(1.1, {1, 0, 0})));
    const auto motion = tracker.take(poseAt(1.2, {2, 0, 0}));
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->time, types::Time::fromSeconds(1.1));
    EXPECT_EQ(motion->position, glm::dvec3(1, 0, 0));
    EXPECT_LT(glm::distance(motion->velocity, {10, 0, 0}), 1e-12);
    EXPECT_LT(glm::length(motion->acceleration), 1e-10);
    EXPECT_DOUBLE_EQ(motion->interval, 0.1);
}

TEST(MotionTest, AParabolaIsExactAtAnySpacingOfPoses) {
    const glm::dvec3 start(1, 2, -3), velocity(0.5, -1, 0.25), acceleration(-0.2, 0.4, 0.1);
    MotionTracker tracker;
    std::optional<Motion> motion;
    for (const double t : {0.0, 0.125, 0.875})
        motion = tracker.take(poseAt(t, start + velocity * t + 0.5 * acceleration * t * t));
    ASSERT_TRUE(motion);
    EXPECT_LT(glm::distance(motion->velocity, velocity + 0.125 * acceleration), 1e-13);
    EXPECT_LT(glm::distance(motion->acceleration, acceleration), 1e-12);
}

TEST(MotionTest, AConstantRotationAboutAnyAxisIsExact) {
    const glm::dvec3 rate(0.3, -0.8, 0.5);
    const Path path = [&](double time) {
        return poseAt(time, {}, turned(30, 20, 10) * glm::angleAxis(glm::length(rate) * time, glm::normalize(rate)));
    };
    EXPECT_LT(glm::distance(motionAt(path, 3, 0.1).angular_rate, rate), 1e-12);
}

TEST(MotionTest, ErrorsAreOfSecondOrderInTheTimeBetweenPoses) {
    const double radius = 4, rate = 0.7, speed = radius * rate;
    const Path path = circle(radius, rate);
    for (const double step : {0.2, 0.1, 0.05, 0.01}) {
        const Motion motion = motionAt(path, 2, step);
        const glm::dvec3 ahead = motion.orientation * glm::dvec3(1, 0, 0),
                         port = motion.orientation * glm::dvec3(0, 1, 0);
        const double x = step * rate;  // 1 - x^2/6 and 1 - x^2/12, and higher orders
        EXPECT_NEAR(glm::dot(motion.velocity, ahead), speed * std::sin(x) / x, 1e-12);
        EXPECT_NEAR(glm::dot(motion.acceleration, port), speed * rate * 2 * (1 - std::cos(x)) / (x * x), 1e-9);
        EXPECT_LT(speed - glm::dot(motion.velocity, ahead), speed * x * x / 6);
        EXPECT_NEAR(glm::dot(motion.acceleration, ahead), 0, 1e-9);
    }
}

TEST(MotionTest, ALeverArmMovesWithTheRotationOfTheBody) {
    // The body rotates with increasing rate about a slanted axis: alpha x r + omega x (omega x r), in the world.
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
    const types::Mount mount{.position = {0.5, -0.25, 0.75}, .yaw_deg = 40};
    const Path path = [&](double time) { return poseAt(time, {2, 3, 4}, glm::angleAxis(0.2 * time * time, axis)); };
    const double time = 2, step = 1e-3;
    const Motion motion = motionAt(path, time, step, mount);
    const glm::dvec3 arm = path(time).orientation * mount.position, rate = axis * (0.4 * time), gain = axis * 0.4;
    EXPECT_LT(glm::distance(motion.position, glm::dvec3(2, 3, 4) + arm), 1e-12);
    EXPECT_LT(glm::distance(motion.velocity, glm::cross(rate, arm)), 1e-6);
    EXPECT_LT(glm::distance(motion.acceleration, glm::cross(gain, arm) + glm::cross(rate, glm::cross(rate, arm))),
              1e-6);
    EXPECT_LT(glm::distance(motion.orientation * motion.angular_rate, rate), 1e-9) << "in the axes of the sensor";
}

TEST(MotionTest, IgnoresAStampThatIsNotLater) {
    MotionTracker tracker;
    tracker.take(poseAt(1, {0, 0, 0}));
    tracker.take(poseAt(1.1, {1, 0, 0}));
    EXPECT_FALSE(tracker.take(poseAt(1.1, {50, 0, 0})));
    EXPECT_FALSE(tracker.take(poseAt(0.9, {50, 0, 0})));
    const auto motion = tracker.take(poseAt(1.2, {2, 0, 0}));
    ASSERT_TRUE(motion);
    EXPECT_LT(glm::distance(motion->velocity, {10, 0, 0}), 1e-12);
}

TEST(MotionTest, StartsAnewAfterAPauseOrARestart) {
    for (const double next : {3.0, -100.0}) {
        MotionTracker tracker;
        for (const double t : {0.0, 0.1, 0.2}) tracker.take(poseAt(t, {t, 0, 0}));
        EXPECT_FALSE(tracker.take(poseAt(next, {1000, 0, 0})));
        EXPECT_FALSE(tracker.take(poseAt(next + 0.1, {1000.1, 0, 0})));
        const auto motion = tracker.take(poseAt(next + 0.2, {1000.2, 0, 0}));
        ASSERT_TRUE(motion);
        EXPECT_LT(glm::distance(motion->velocity, {1, 0, 0}), 1e-9) << "no part of the thousand metres";
    }
}

TEST(MotionTest, WarnsOnceAboutPosesTooFarApartAndAgainAfterTenInTime) {
    MotionTracker tracker;
    double time = 0;
    const auto warningAfter = [&](double seconds) {
        tracker.take(poseAt(time += seconds, {}));
        return tracker.consumeWarning();
    };
    EXPECT_EQ(warningAfter(0), "") << "nothing lies before the first";
    EXPECT_THAT(warningAfter(2), testing::StartsWith("poses 2 s apart give no motion"));
    EXPECT_EQ(warningAfter(2), "");
    for (int i = 0; i < 10; ++i) EXPECT_EQ(warningAfter(1), "");
    EXPECT_THAT(warningAfter(-100), testing::StartsWith("poses 100 s apart"));
}

TEST(MotionTest, AJumpIsMotionAndAnOverflowIsNone) {
    MotionTracker tracker;
    for (const double t : {0.0, 0.1}) tracker.take(poseAt(t, {}));
    const auto jump = tracker.take(poseAt(0.2, {1000, 0, 0}));
    ASSERT_TRUE(jump);
    EXPECT_NEAR(jump->acceleration.x, 1e5, 1e-6);
    EXPECT_FALSE(tracker.take(poseAt(0.3, {1e308, 0, 0})));
    EXPECT_FALSE(tracker.take(poseAt(0.4, {-1e308, 0, 0})));
}

TEST(MotionTest, HalfATurnFromPoseToPoseIsFinite) {
    const Path path = [](double time) { return poseAt(time, {}, turned(std::round(time * 10) * 180)); };
    const Motion motion = motionAt(path, 1, 0.1);
    EXPECT_TRUE(std::isfinite(glm::length(motion.angular_rate)));
    EXPECT_LE(glm::length(motion.angular_rate), std::numbers::pi / 0.1 * 1.000001);
}

TEST(MotionTest, ACadenceFollowsTheMultiplesOfThePeriod) {
    Cadence cadence(0.125);
    std::vector<int64_t> due;
    for (int64_t us = 10'000; us <= 1'000'000; us += 10'000)
        if (cadence.isDue({us})) due.push_back(us / 1000);
    EXPECT_THAT(due, testing::ElementsAre(10, 130, 250, 380, 500, 630, 750, 880, 1000));
    Cadence each(0);
    EXPECT_TRUE(each.isDue({5}) && each.isDue({5}));
}

}  // namespace
}  // namespace insonify::nav
