#include <gmock/gmock.h>

#include "components/pose/TrajectoryTask.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::pose {
namespace {

TEST(AllocationTest, ATrajectoryAllocatesNothingAfterItsFirstPose) {
    TrajectoryTask task("vehicle");
    types::Time time = types::Time::fromSeconds(1);
    auto environment = std::make_shared<framework::Environment>();
    environment->now = [&time] { return time; };
    environment->start_time = [] { return types::Time::fromSeconds(1); };
    task.setEnvironment(environment);
    test::Reader<types::Pose> newest, all;
    task.pose.connectTo(newest.port, {});
    task.pose.connectTo(all.port, framework::ConnPolicy::buffer(200));
    task.config.set({.file = {}, .waypoints = {{.time = 0}, {.time = 5, .position = {4, 0, 0}, .yaw_deg = 90}}});
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto cycle = [&](int64_t) {
        time = time + types::Time::fromSeconds(0.1);
        task.update();
    };
    EXPECT_THAT(test::allocationsAfterTheFirst(task, cycle), testing::IsEmpty());
    EXPECT_EQ(task.pose.written(), 99u);
}

}  // namespace
}  // namespace insonify::pose
