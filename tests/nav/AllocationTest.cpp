#include <gmock/gmock.h>

#include "components/nav/SensorTask.hpp"
#include "tests/nav/Paths.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::nav {
namespace {

template <class Task, class Out>
std::vector<std::string> countAllocations(Task& task, framework::OutputPort<Out> Task::*output) {
    test::Writer<types::Pose> poses;
    test::Reader<Out> reader;
    poses.port.connectTo(task.pose, framework::ConnPolicy::buffer(4));
    (task.*output).connectTo(reader.port, {});
    EXPECT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto cycle = [&](int64_t time) {
        types::Pose pose = circle(5, 0.4)(static_cast<double>(time) * 0.01);
        poses.port.write(pose);
        task.update();
        Out sample{};
        reader.port.readNew(sample);
    };
    for (int64_t time = -5; time < 0; ++time) cycle(time);  // three poses, then poses with measurements
    return test::allocationsAfterTheFirst(task, cycle);
}

TEST(AllocationTest, AnInertialUnitAllocatesNothing) {
    ImuTask task("imu");
    EXPECT_THAT(countAllocations(task, &ImuTask::imu), testing::IsEmpty());
}

TEST(AllocationTest, ADopplerLogOverASceneAllocatesNothing) {
    DvlTask task("dvl");
    test::Writer<types::SnapshotPtr> scene;
    scene.port.connectTo(task.snapshot, {});
    const auto snapshot = std::make_shared<types::Snapshot>(test::makeSnapshot(test::makeScene({test::ground(-17)})));
    scene.port.write(snapshot);
    EXPECT_THAT(countAllocations(task, &DvlTask::dvl), testing::IsEmpty());
}

TEST(AllocationTest, AReceiverOfSatellitesAllocatesNothing) {
    FixTask task("fix");
    task.config.set({.datum = types::Datum{54, 10, 0}, .water_surface = -100});
    if (!test::countRefusals(task).empty()) GTEST_SKIP() << "this build has no GeographicLib";
    EXPECT_THAT(countAllocations(task, &FixTask::fix), testing::IsEmpty());
}

TEST(AllocationTest, APressureGaugeAllocatesNothing) {
    PressureTask task("pressure");
    EXPECT_THAT(countAllocations(task, &PressureTask::pressure), testing::IsEmpty());
}

}  // namespace
}  // namespace insonify::nav
