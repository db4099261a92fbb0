// OpenCV may allocate (the contract excepts it): calls of operator new from its libraries are not counted, calls from
// this project's code are. Another thread writes picture files.
#include <gmock/gmock.h>

#include "components/output/tasks/PairPictureTask.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::output {
namespace {

types::SonarPtr pingAt(int i, uint32_t beams) {
    types::Sonar ping = test::withEcho(test::emptyPing(2.0 * beams, beams), static_cast<uint32_t>(i) % beams, 50);
    ping.time = types::Time::fromSeconds(1 + 0.1 * i);
    if (beams == 1) ping.bearings[0] = types::Angle::fromDeg(2 * i);  // the head of a scanning sonar turns
    return std::make_shared<const types::Sonar>(ping);
}

types::Pose poseAt(int i) {
    types::Pose pose;
    pose.time = types::Time::fromSeconds(1 + 0.1 * i);
    pose.position.x = 0.3 * i;
    return pose;
}

/** Returns the allocations that OpenCV's libraries did not make. */
std::vector<std::string> ours(std::vector<std::string> places) {
    std::erase_if(places, [](const std::string& place) { return place.starts_with("libopencv_"); });
    return places;
}

template <class Task>
void expectNoAllocation(uint32_t beams) {
    Task task("picture");
    test::Writer<types::SonarPtr> in;
    test::Writer<types::Pose> poses;
    test::Reader<types::ImagePtr> out;
    in.port.connectTo(task.ping, {});
    if (auto* pose = task.input("pose")) poses.port.connectTo(*pose, {});
    task.image.connectTo(out.port, {});
    auto config = *task.config;
    config.width = 640;
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto cycle = [&](int i) {
        in.port.write(pingAt(i, beams));
        poses.port.write(poseAt(i));
        task.update();
    };
    cycle(0);
    EXPECT_THAT(ours(test::allocationsOn(task,
                                         [&] {
                                             for (int i = 1; i < 50; ++i) cycle(i);
                                         })),
                testing::IsEmpty());
    EXPECT_EQ(task.image.written(), 50u) << task.lastError();
}

TEST(AllocationTest, AFanPictureAllocatesNothingOfOurs) { expectNoAllocation<FanImageTask>(60); }
TEST(AllocationTest, AWaterfallAllocatesNothingOfOurs) { expectNoAllocation<WaterfallImageTask>(60); }
TEST(AllocationTest, ADiscAllocatesNothingOfOurs) { expectNoAllocation<DiscImageTask>(1); }
TEST(AllocationTest, AMosaicAllocatesNothingOfOurs) { expectNoAllocation<ScanMosaicTask>(1); }

}  // namespace
}  // namespace insonify::output
