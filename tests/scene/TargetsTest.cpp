// Point targets of a scene: their places, the nodes they move with, and errors.
#include <gmock/gmock.h>

#include "components/scene/SceneTask.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Ports.hpp"
#include "types/Angle.hpp"

namespace insonify::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/** A boat, turned by 90 degrees and twice as large, with a mast that leans; a quay. */
struct TargetsTest : SceneFiles {
    TargetsTest() {
        config_.file = write("harbour.gltf", gltf(R"("scenes":[{"nodes":[0,2,3]}],
            "nodes":[{"mesh":0,"name":"boat","translation":[1,2,3],"rotation":[0,0.70710678118,0,0.70710678118],
                      "scale":[2,2,2],"children":[1]},
                     {"name":"mast","translation":[0,5,0]},{"name":"quay","translation":[10,0,0]},
                     {"name":"dot","scale":[0,0,0]}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
                                                  triangle()))
                           .string();
        vehicle_.port.connectTo(task_.pose, framework::ConnPolicy::buffer(8));
        task_.snapshot.connectTo(out_.port, framework::ConnPolicy::buffer(8));
    }
    void follow(test::Writer<types::Pose>& mover, const std::string& node) {
        mover.port.connectTo(*task_.makeInput(node + ".pose", mover.port), {});
    }
    void start() {
        task_.config.set(config_);
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    }
    static types::Pose at(double seconds, glm::dvec3 position, double yaw_deg = 0) {
        types::Pose pose;
        pose.time = types::Time::fromSeconds(seconds);
        pose.position = position;
        pose.orientation = glm::angleAxis(types::radians(yaw_deg), glm::dvec3(0, 0, 1));
        return pose;
    }
    types::SnapshotPtr ping(double seconds) {
        vehicle_.port.write(at(seconds, {0, 0, 0}));
        task_.update();
        types::SnapshotPtr snapshot;
        out_.port.readNew(snapshot);
        return snapshot;
    }
    std::string diagnostic() const {
        SceneTask task("scene");
        task.config.set(config_);
        return task.configure() ? "" : task.lastError();
    }

    SceneConfig config_;
    SceneTask task_{"scene"};
    test::Writer<types::Pose> vehicle_{"vehicle"}, boat_{"boat"}, mast_{"mast"};
    test::Reader<types::SnapshotPtr> out_;
};

void expectClose(glm::dvec3 a, glm::dvec3 b) {
    EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << " " << a.y << " " << a.z;
}

TEST_F(TargetsTest, ASnapshotHasNoTargetsByDefault) {
    start();
    EXPECT_TRUE(ping(1)->targets.empty());
}

TEST_F(TargetsTest, ATargetIsInTheWorldOrOnANodeWithAnOffset) {
    config_.targets = {{"buoy", glm::dvec3(4, 5, -6), "", -20},    {"keel", {}, "boat", -10},
                       {"bow", glm::dvec3(3, 0, 1), "boat", -30},  {"top", glm::dvec3(1, 0, 0), "mast", -40},
                       {"fender", glm::dvec3(0, 1, 0), "quay", 0}, {"dot", {}, "dot", 0}};
    start();
    const auto snapshot = ping(1);
    ASSERT_EQ(snapshot->targets.size(), 6u);
    EXPECT_EQ(snapshot->target_names->at(2), "bow");
    EXPECT_EQ(snapshot->targets[2].strength_db, -30);
    expectClose(snapshot->targets[0].position, {4, 5, -6});
    expectClose(snapshot->targets[1].position, {1, -3, 2});
    expectClose(snapshot->targets[2].position, {1, 0, 3});    // ahead is to port where a boat is turned by 90 degrees
    expectClose(snapshot->targets[3].position, {1, -2, 12});  // 10 m up, as the boat is twice as large
    expectClose(snapshot->targets[4].position, {10, 1, 0});
    expectClose(snapshot->targets[5].position, {0, 0, 0});
}

TEST_F(TargetsTest, ATargetMovesWithTheInnermostMovingNode) {
    follow(boat_, "boat");
    follow(mast_, "mast");
    config_.targets = {{"bow", glm::dvec3(3, 0, 1), "boat", 0},
                       {"top", glm::dvec3(1, 0, 0), "mast", 0},
                       {"buoy", glm::dvec3(4, 5, -6), "", 0}};
    start();
    expectClose(ping(1)->targets[0].position, {1, 0, 3});  // before its first pose it is at its place in the file
    boat_.port.write(at(2, {100, 0, 0}, 180));
    const auto moved = ping(2);
    expectClose(moved->targets[0].position, {97, 0, 1});
    expectClose(moved->targets[1].position, {99, 0, 10});
    expectClose(moved->targets[2].position, {4, 5, -6});
    mast_.port.write(at(3, {0, 0, 50}));
    const auto apart = ping(3);
    expectClose(apart->targets[0].position, {97, 0, 1});
    expectClose(apart->targets[1].position, {1, 0, 50});
}

TEST_F(TargetsTest, ReportsErrorsWithTheirPlace) {
    config_.targets = {{"buoy", glm::dvec3(0), "", 0}, {"bow", {}, "baot", 0}};
    EXPECT_THAT(diagnostic(), AllOf(HasSubstr("scene.targets[1].attached_to: is baot, which is no node of the scene"),
                                    HasSubstr("boat")));
    config_.targets = {{"on dot", glm::dvec3(1, 0, 0), "dot", 0}};
    EXPECT_THAT(diagnostic(), HasSubstr("scene.targets[0].attached_to: is dot, which is scaled to nothing"));
}

}  // namespace
}  // namespace insonify::scene
