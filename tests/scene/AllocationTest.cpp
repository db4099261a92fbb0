#include <gmock/gmock.h>

#include "components/scene/SceneTask.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::scene {
namespace {

class AllocationTest : public SceneFiles {};

TEST_F(AllocationTest, AllocatesNothingAfterTheFirstPosesEvenWhenObjectsBeginToMove) {
    SceneTask task("scene");
    SceneConfig config;
    config.file = write("boats.gltf", gltf(R"("scenes":[{"nodes":[0,2]}],
        "nodes":[{"mesh":0,"name":"boat","children":[1]},{"mesh":0,"name":"mast"},{"mesh":0,"name":"quay"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
                                           triangle()))
                      .string();
    task.config.set(config);
    test::Writer<types::Pose> vehicle("vehicle"), boat("boat");
    test::Reader<types::SnapshotPtr> out;
    vehicle.port.connectTo(task.pose, framework::ConnPolicy::buffer(8));
    boat.port.connectTo(*task.makeInput("boat.pose", boat.port), {});
    task.snapshot.connectTo(out.port, {});
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto cycle = [&](int64_t i) {
        types::Pose pose;
        pose.time = {1'000'000 + 100'000 * i};
        pose.position.x = 0.1 * static_cast<double>(i);
        pose.orientation = {1, 0, 0, 0};
        if (i > 10) boat.port.write(pose);
        vehicle.port.write(pose);
        task.update();
    };
    EXPECT_THAT(test::allocationsAfterTheFirst(task, cycle), testing::IsEmpty());
    types::SnapshotPtr last;
    ASSERT_TRUE(out.port.readNew(last));
    EXPECT_EQ(last->moved.size(), 2u);
    EXPECT_EQ(task.snapshot.written(), 99u);
}

}  // namespace
}  // namespace insonify::scene
