// Poses from the messages of a body: axes, times, and dropped messages.
#include <gmock/gmock.h>

#include <numbers>

#include "components/mavlink/Body.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::mavlink {
namespace {

using testing::HasSubstr;
using types::Time;

constexpr double pi = std::numbers::pi;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/** Returns a rotation about an axis of the body in MAVLink's axes: forward, right, down. */
AttitudeQuaternion turned(double radians, glm::vec3 axis, uint32_t ms = 0) {
    const auto s = static_cast<float>(std::sin(radians / 2));
    return {.time_boot_ms = ms,
            .w = static_cast<float>(std::cos(radians / 2)),
            .x = s * axis.x,
            .y = s * axis.y,
            .z = s * axis.z};
}

void expectNear(glm::dvec3 a, glm::dvec3 b) { EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << " " << a.y << " " << a.z; }

struct BodyTest : testing::Test {
    Body::Taken take(const auto& message, double seconds, uint8_t component = 1, uint64_t way = 1) {
        return body.take(getFrame(message, 1, component), way, Time::fromSeconds(seconds));
    }
    Body body{{}, {0, 0, 0}};
    Body eye{{.source = Source::Vision}, {100, 0, 0}};

    Body::Taken see(const VisionPositionEstimate& estimate, double seconds) {
        return eye.take(getFrame(estimate, 1, 197), 1, Time::fromSeconds(seconds));
    }
};

TEST_F(BodyTest, AVehicleThatIsLevelAndLooksNorthIsNotTurned) {
    const types::Pose pose = getPose(AttitudeQuaternion{}, LocalPositionNed{.x = 1, .y = 2, .z = 3});
    expectNear(pose.position, {1, -2, -3});  // north, west, up
    EXPECT_EQ(pose.orientation, glm::dquat(1, 0, 0, 0));
}

TEST_F(BodyTest, EastIsToStarboardOfNorth) {
    const types::Pose pose = getPose(turned(pi / 2, {0, 0, 1}), {});
    expectNear(pose.orientation * glm::dvec3(1, 0, 0), {0, -1, 0});  // ahead
    expectNear(pose.orientation * glm::dvec3(0, 1, 0), {1, 0, 0});   // to port
    expectNear(pose.orientation * glm::dvec3(0, 0, 1), {0, 0, 1});
}

TEST_F(BodyTest, ThirtyDegreesOfPitchRaiseTheBow) {
    const types::Pose pose = getPose(turned(pi / 6, {0, 1, 0}), {});
    expectNear(pose.orientation * glm::dvec3(1, 0, 0), {std::cos(pi / 6), 0, 0.5});
    expectNear(pose.orientation * glm::dvec3(0, 1, 0), {0, 1, 0});
}

TEST_F(BodyTest, ThirtyDegreesOfRollLowerStarboard) {
    const types::Pose pose = getPose(turned(pi / 6, {1, 0, 0}), {});
    expectNear(pose.orientation * glm::dvec3(0, 1, 0), {0, std::cos(pi / 6), 0.5});
    expectNear(pose.orientation * glm::dvec3(1, 0, 0), {1, 0, 0});
}

TEST_F(BodyTest, AnglesOfAVisionEstimateAreOursWithPitchAndYawNegated) {
    const types::Pose pose =
        getPose(VisionPositionEstimate{.x = 1, .y = 2, .z = 3, .roll = 0.1f, .pitch = 0.2f, .yaw = 2});
    const types::Mount same{.roll_deg = 0.1 * 180 / pi, .pitch_deg = -0.2 * 180 / pi, .yaw_deg = -2 * 180 / pi};
    EXPECT_GT(std::abs(glm::dot(pose.orientation, same.orientation())), 1 - 1e-12);
    expectNear(pose.position, {1, -2, -3});
}

TEST_F(BodyTest, VelocitiesAreThoseOfTheWorldAndRatesThoseOfTheBody) {
    AttitudeQuaternion attitude = turned(pi / 2, {0, 0, 1});
    attitude.roll_speed = 0.1f;
    attitude.pitch_speed = 0.2f;
    attitude.yaw_speed = 0.3f;
    const types::Pose pose = getPose(attitude, LocalPositionNed{.vx = 1, .vy = 2, .vz = 3});
    expectNear(pose.velocity, {1, -2, -3});
    expectNear(pose.angular_velocity, {0.1, -0.2, -0.3});
}

TEST_F(BodyTest, APositionIsExtrapolatedToTheTimeOfTheAttitude) {
    take(LocalPositionNed{.time_boot_ms = 1000, .x = 5, .vx = 2}, 50);
    const auto [pose, diagnostic] = take(AttitudeQuaternion{.time_boot_ms = 1100}, 50.1);
    ASSERT_TRUE(pose) << diagnostic;
    expectNear(pose->position, {5.2, 0, 0});
    EXPECT_EQ(pose->time, Time::fromSeconds(50.1));
    take(LocalPositionNed{.time_boot_ms = 1200, .x = 5, .vx = unknown}, 50.2);
    expectNear(take(AttitudeQuaternion{.time_boot_ms = 1150}, 50.2).pose.value().position, {5, 0, 0});
}

TEST_F(BodyTest, AnAttitudeWithoutAPositionIsNoPose) {
    EXPECT_FALSE(take(AttitudeQuaternion{.time_boot_ms = 1000}, 50).pose);
    take(LocalPositionNed{.time_boot_ms = 1000}, 50);
    EXPECT_TRUE(take(AttitudeQuaternion{.time_boot_ms = 1500}, 50.5).pose);
    EXPECT_FALSE(take(AttitudeQuaternion{.time_boot_ms = 1501}, 50.501).pose) << "of more than half a second ago";
}

TEST_F(BodyTest, ReportsAMissingHalfAfterAWhile) {
    std::string reported;
    for (int i = 0; i < 30; ++i) {
        const auto taken = take(AttitudeQuaternion{.time_boot_ms = static_cast<uint32_t>(100 * i)}, 50 + 0.1 * i);
        EXPECT_EQ(taken.diagnostic.empty(), i < 20) << i;
        reported = taken.diagnostic;
    }
    EXPECT_EQ(reported, "ATTITUDE_QUATERNION arrives without LOCAL_POSITION_NED: the vehicle must stream both");
    EXPECT_THAT(body.missing(Time::fromSeconds(53)), testing::ElementsAre(LocalPositionNed::kind.message));
}

TEST_F(BodyTest, ReportsPositionsWithoutAnAttitudeToo) {
    std::string reported;
    for (int i = 0; i < 50; ++i)
        reported = take(LocalPositionNed{.time_boot_ms = static_cast<uint32_t>(100 * i)}, 50 + 0.1 * i).diagnostic;
    EXPECT_EQ(reported, "LOCAL_POSITION_NED arrives without ATTITUDE_QUATERNION: the vehicle must stream both");
    EXPECT_THAT(body.missing(Time::fromSeconds(55)), testing::ElementsAre(AttitudeQuaternion::kind.message));
}

TEST_F(BodyTest, NormalisesQuaternionsAndDropsThoseWithoutLength) {
    take(LocalPositionNed{}, 50);
    const auto taken = take(AttitudeQuaternion{.time_boot_ms = 1, .w = 3, .z = 3}, 50);
    ASSERT_TRUE(taken.pose);
    EXPECT_DOUBLE_EQ(glm::length(taken.pose->orientation), 1);
    expectNear(taken.pose->orientation * glm::dvec3(1, 0, 0), {0, -1, 0});
    for (const AttitudeQuaternion& bad :
         {AttitudeQuaternion{.w = 0}, AttitudeQuaternion{.w = unknown}, AttitudeQuaternion{.x = unknown},
          AttitudeQuaternion{.z = std::numeric_limits<float>::infinity()}})
        EXPECT_THAT(take(bad, 50.1).diagnostic, HasSubstr("not finite"));
}

TEST_F(BodyTest, DropsPositionsThatAreNotFiniteAndKeepsThePreviousPosition) {
    take(LocalPositionNed{.x = 7}, 50);
    EXPECT_THAT(take(LocalPositionNed{.time_boot_ms = 1, .y = unknown}, 50).diagnostic, HasSubstr("not finite"));
    expectNear(take(AttitudeQuaternion{.time_boot_ms = 2}, 50).pose.value().position, {7, 0, 0});
    EXPECT_THAT(see({.usec = 1, .yaw = unknown}, 50).diagnostic, HasSubstr("not finite"));
}

TEST_F(BodyTest, AcceptsAJump) {
    take(LocalPositionNed{.time_boot_ms = 1000, .x = 7}, 50);
    take(AttitudeQuaternion{.time_boot_ms = 1000}, 50);
    take(LocalPositionNed{.time_boot_ms = 1100, .x = -900}, 50.1);  // an estimator that was reset
    expectNear(take(AttitudeQuaternion{.time_boot_ms = 1100}, 50.1).pose.value().position, {-900, 0, 0});
}

TEST_F(BodyTest, MillisecondsContinueAcrossTheirWrapAround) {
    for (int i = -5; i < 5; ++i) {  // 100 ms apart, over 2^32
        const auto ms = static_cast<uint32_t>(i * 100);
        take(LocalPositionNed{.time_boot_ms = ms - 50, .x = 1, .vx = 1}, 50 + 0.1 * i);
        const auto [pose, diagnostic] = take(AttitudeQuaternion{.time_boot_ms = ms}, 50 + 0.1 * i);
        ASSERT_TRUE(pose) << i << diagnostic;
        EXPECT_EQ(pose->time, Time::fromSeconds(50 + 0.1 * i)) << i;
        expectNear(pose->position, {1.05, 0, 0});
    }
}

TEST_F(BodyTest, DropsEarlierStampsUnlessTheVehicleHasRebooted) {
    take(LocalPositionNed{.time_boot_ms = 600'000, .x = 7}, 50);
    take(AttitudeQuaternion{.time_boot_ms = 600'000}, 50);
    EXPECT_THAT(take(AttitudeQuaternion{.time_boot_ms = 599'900}, 50.1).diagnostic, HasSubstr("is before"));
    EXPECT_THAT(take(LocalPositionNed{.time_boot_ms = 599'900}, 50.1).diagnostic, HasSubstr("is before"));
    EXPECT_FALSE(take(AttitudeQuaternion{.time_boot_ms = 100}, 50.2).pose) << "with a position from before the restart";
    take(LocalPositionNed{.time_boot_ms = 200, .x = 1}, 50.3);
    expectNear(take(AttitudeQuaternion{.time_boot_ms = 200}, 50.3).pose.value().position, {1, 0, 0});
}

TEST_F(BodyTest, ARepeatedMessageIsOnePose) {
    take(LocalPositionNed{.time_boot_ms = 1000}, 50);
    EXPECT_TRUE(take(AttitudeQuaternion{.time_boot_ms = 1000}, 50).pose);
    const auto again = take(AttitudeQuaternion{.time_boot_ms = 1000}, 50.001);
    EXPECT_FALSE(again.pose);
    EXPECT_EQ(again.diagnostic, "");
}

TEST_F(BodyTest, OneOfTwoSendersCountsUntilItIsSilent) {
    take(LocalPositionNed{.time_boot_ms = 1000, .x = 1}, 50);
    EXPECT_TRUE(take(AttitudeQuaternion{.time_boot_ms = 1000}, 50).pose);
    for (const auto& [component, way] : {std::pair{2, 1}, {1, 2}}) {
        const auto other =
            take(AttitudeQuaternion{.time_boot_ms = 1010}, 50.5, static_cast<uint8_t>(component), uint64_t(way));
        EXPECT_FALSE(other.pose);
        EXPECT_EQ(other.diagnostic, "from another sender while the first is still sending");
    }
    take(LocalPositionNed{.time_boot_ms = 77, .x = 2}, 51.5, 2);
    expectNear(take(AttitudeQuaternion{.time_boot_ms = 77}, 51.5, 2).pose.value().position, {2, 0, 0});
}

TEST_F(BodyTest, SystemAndComponentIdentifyTheBody) {
    const Frame of_one = getFrame(AttitudeQuaternion{}, 1, 1), of_two = getFrame(AttitudeQuaternion{}, 2, 1);
    EXPECT_TRUE(body.isInPart(of_one));
    EXPECT_FALSE(body.isInPart(of_two));
    EXPECT_FALSE(body.isInPart(getFrame(VisionPositionEstimate{}, 1, 1)));
    const Body particular({.component_id = 1}, {0, 0, 0});
    EXPECT_TRUE(particular.isInPart(of_one));
    EXPECT_FALSE(particular.isInPart(getFrame(AttitudeQuaternion{}, 1, 2)));
}

TEST_F(BodyTest, EveryVisionEstimateIsAPoseRelativeToTheOrigin) {
    const auto [pose, diagnostic] = see({.usec = 1700000000123456, .x = 1}, 50);
    ASSERT_TRUE(pose) << diagnostic;
    expectNear(pose->position, {101, 0, 0});
    EXPECT_EQ(pose->time, Time::fromSeconds(50)) << "any origin of its clock";
    EXPECT_EQ(see({.usec = 1700000000223456}, 50.1).pose.value().time, Time::fromSeconds(50.1));
    EXPECT_THAT(see({.usec = 1700000000200000}, 50.1).diagnostic, HasSubstr("is before"));
    EXPECT_THAT(see({.usec = ~uint64_t{0}}, 50.2).diagnostic, HasSubstr("out of bounds"));
    EXPECT_TRUE(see({.usec = 5}, 50.3).pose) << "booted again";
}

TEST_F(BodyTest, AMissingMessageIsReportedAfterTheClockIsSetBack) {
    take(turned(0, {1, 0, 0}, 100), 1000);
    std::string reported;
    for (int i = 1; i <= 100 && reported.empty(); ++i)
        reported = take(turned(0, {1, 0, 0}, static_cast<uint32_t>(100 + 100 * i)), 400 + 0.1 * i).diagnostic;
    EXPECT_THAT(reported, HasSubstr("arrives without"));
}

/** Our clock, the vehicle's, or both are set by ten minutes while poses arrive 50 times a second. */
TEST_F(BodyTest, PosesGoOnWhenAClockIsSetByTenMinutes) {
    for (const double ours : {-600.0, 0.0, 600.0})
        for (const double theirs : {-600.0, 0.0, 600.0}) {
            Body vehicle{{}, {0, 0, 0}};
            double last = 0, longest = 0;
            for (int i = 0; i < 500; ++i) {
                const double now = 0.02 * i;
                const auto ms = static_cast<uint32_t>(std::lround(1000 * (1000 + now + (now >= 4 ? theirs : 0))));
                const Time clock = Time::fromSeconds(1e9 + now + (now >= 6 ? ours : 0));
                const auto give = [&](const auto& message) { return vehicle.take(getFrame(message, 1, 1), 1, clock); };
                give(LocalPositionNed{.time_boot_ms = ms, .x = 1});
                const auto pose = give(turned(0.1, {1, 0, 0}, ms)).pose;
                if (!pose) continue;
                EXPECT_LE(pose->time, clock);
                EXPECT_GE(pose->time, clock - Time::fromSeconds(0.7)) << ours << ", " << theirs << " at " << now;
                expectNear(pose->position, {1, 0, 0});
                longest = std::max(longest, now - last);
                last = now;
            }
            EXPECT_LE(longest, 0.05) << ours << ", " << theirs;
            EXPECT_NEAR(last, 9.98, 0.03) << ours << ", " << theirs;
        }
}

}  // namespace
}  // namespace insonify::mavlink
