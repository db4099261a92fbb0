// Vehicles by PyPI's pymavlink, and the task that reads their poses.
#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <string>

#include "components/mavlink/PoseTask.hpp"
#include "tests/mavlink/Vehicle.hpp"
#include "tests/support/Listening.hpp"
#include "tests/support/Refused.hpp"
#include "types/samples/Pose.hpp"

using namespace insonify;
using namespace insonify::mavlink;
using test::becomesTrue;
using testing::HasSubstr;

namespace {

struct PoseTaskTest : testing::Test, protected test::Listening<PoseTask> {
    PoseTaskTest() : Listening("vehicle") {}
    void SetUp() override {
        if (!Vehicle::available())
            GTEST_SKIP() << "PyPI's pymavlink is not in " << python() << ": scripts/setup puts it there";
    }

    void startWith(const std::function<void(PoseConfig&)>& change = {}) {
        PoseConfig config;
        config.port = 0;
        config.bodies.resize(1);
        if (change) change(config);
        start(config, config.bodies);
    }
    /** A pose of vehicle.py, in our axes. */
    static void expectKnown(const types::Pose& pose) {
        const double k = std::round(50 * pose.position.x), pi = std::numbers::pi;
        EXPECT_LT(glm::distance(pose.position, {0.02 * k, -2, -3}), 1e-6);
        const types::Mount same{
            .roll_deg = 0.1 * 180 / pi, .pitch_deg = -0.2 * 180 / pi, .yaw_deg = -0.3 * k * 180 / pi};
        EXPECT_GT(std::abs(glm::dot(pose.orientation, same.orientation())), 1 - 1e-9) << k;
    }
    void expectPoses(int count, size_t reader = 0) {
        types::Time last;
        for (int i = 0; i < count; ++i) {
            const auto pose = next(reader);
            ASSERT_TRUE(pose) << i;
            expectKnown(*pose);
            EXPECT_GE(pose->time, last);
            EXPECT_LE(pose->time, framework::wallClock());
            last = pose->time;
        }
    }
};

}  // namespace

TEST_F(PoseTaskTest, PosesOfEveryVersionOfMavlinkAreRead) {
    startWith();
    for (const char* work : {"poses1", "poses2", "signed"}) {
        const Vehicle vehicle(task.port(), work);
        expectPoses(25);
    }
    EXPECT_THAT(task.notices(), testing::Contains(HasSubstr("listens on UDP 127.0.0.1:")));
}

TEST_F(PoseTaskTest, ReceivesAVehicleAndAnObjectOnOnePort) {
    startWith([](PoseConfig& config) {
        config.bodies = {{.port = "rov"}, {.port = "diver", .source = Source::Vision, .system_id = 2}};
    });
    const Vehicle rov(task.port(), "poses2"), diver(task.port(), "vision 2");
    expectPoses(25, 0);
    expectPoses(25, 1);
}

TEST_F(PoseTaskTest, RequestsPosesFromAVehicleThatOnlySendsHeartbeats) {
    startWith([](PoseConfig& config) { config.request = {.rate = 50}; });
    const Vehicle vehicle(task.port(), "heartbeat");
    expectPoses(25);
}

TEST_F(PoseTaskTest, AVehicleThatOnlySendsHeartbeatsIsReportedWithTheRemedy) {
    std::atomic<bool> is_reported{false};
    task.environment().warn = [&](const std::string& text) {
        is_reported =
            is_reported || text.find(
                               "system 1 sends HEARTBEAT, but neither ATTITUDE_QUATERNION nor LOCAL_POSITION_NED; set "
                               "`request`, or") != std::string::npos;
    };
    startWith();
    const Vehicle vehicle(task.port(), "heartbeat");
    EXPECT_TRUE(becomesTrue([&] { return is_reported.load(); }));
}

TEST_F(PoseTaskTest, ReportsDamageAndReadsTheFramesBetween) {
    startWith();
    const Vehicle vehicle(task.port(), "damaged");
    expectPoses(25);
    EXPECT_THAT(task.notices(), testing::Contains(HasSubstr("messages dropped: a frame with a wrong checksum")));
    EXPECT_THAT(task.notices(), testing::Contains(HasSubstr("messages dropped: a frame that is cut off")));
}

TEST_F(PoseTaskTest, ReportsMessagesOfAnotherSystemWithItsNumber) {
    startWith();
    const Vehicle vehicle(task.port(), "poses2 9");
    EXPECT_TRUE(becomesTrue([&] {
        const std::vector<std::string> all = types::lines(task.notices());
        return std::ranges::any_of(all, [](const std::string& line) {
            return line.find("of others ignored: ATTITUDE_QUATERNION of system 9, component 1") != std::string::npos;
        });
    }));
    types::Pose pose;
    EXPECT_FALSE(readers[0].port.readNew(pose));
}

TEST_F(PoseTaskTest, AnInvalidAddressAndAUsedPortAreErrors) {
    startWith();
    PoseTask other("other");
    PoseConfig config;
    config.port = task.port();
    other.config.set(config);
    EXPECT_THAT(other.configure().reason, HasSubstr("other.port: is 127.0.0.1:" + std::to_string(task.port())));
    PoseTask third("third");
    config.address = "nowhere";
    third.config.set(config);
    EXPECT_THAT(third.configure().reason, HasSubstr("third.address: is nowhere, which is no address"));
}

TEST_F(PoseTaskTest, LockstepIsRefusedWithAReason) {
    PoseTask other("other");
    PoseConfig config;
    config.bodies.resize(1);
    other.config.set(config);
    other.environment().lockstep = true;
    EXPECT_THAT(test::countRefusals(other), testing::ElementsAre(HasSubstr("set schedule: realtime"),
                                                                 HasSubstr("no connection leads from other.pose")));
}
