// Two vehicles in one world, each with its own SceneTask: each sees the other at the other's pose.
#include "components/scene/SceneTask.hpp"
#include "tests/sdf/SdfFiles.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

types::Pose at(double seconds, glm::dvec3 position, double yaw) {
    types::Pose pose;
    pose.time = types::Time::fromSeconds(seconds);
    pose.position = position;
    pose.orientation = glm::angleAxis(yaw, glm::dvec3(0, 0, 1));
    return pose;
}

struct TwoVehiclesTest : SdfFiles {
    /** The scene of one vehicle, with the poses of both. */
    struct Eye {
        SceneTask task;
        test::Writer<types::Pose> own, red, blue;
        test::Reader<types::SnapshotPtr> out;

        Eye(const std::string& name, const std::filesystem::path& file) : task(name) {
            SceneConfig config;
            config.file = file.string();
            task.config.set(config);
            own.port.connectTo(task.pose, {});
            red.port.connectTo(*task.makeInput("red.pose", red.port), {});
            blue.port.connectTo(*task.makeInput("blue.pose", blue.port), {});
            task.snapshot.connectTo(out.port, {});
            EXPECT_TRUE(task.configure() && task.start()) << task.lastError();
        }
        /** Bounds of a model's hull in the frame of the sonar. */
        Bounds see(const std::string& model, const types::Pose& body, const types::Pose& red_pose,
                   const types::Pose& blue_pose) {
            red.port.write(red_pose);
            blue.port.write(blue_pose);
            own.port.write(body);
            task.update();
            types::SnapshotPtr snapshot;
            out.port.readNew(snapshot);
            Bounds bounds;
            for (const types::MovedObject& moved : snapshot->moved) {
                types::Object object = snapshot->geometry->objects.at(moved.object);
                if (!object.name.starts_with(model + "::")) continue;
                object.world_from_object = glm::inverse(snapshot->sonar.worldFromBody()) * moved.world_from_object;
                bounds = getBounds(*snapshot->geometry, object);
            }
            return bounds;
        }
    };
};

TEST_F(TwoVehiclesTest, EachSeesTheOtherAtItsPose) {
    const auto file = writeWorld(model("red", box_) + model("blue", box_, pose("50 0 0 0 0 0")));
    Eye of_red("red_scene", file), of_blue("blue_scene", file);
    // hulls are 2 x 4 x 6; blue is 20 m north of red and looks back at it
    const types::Pose red = at(1, {0, 0, 0}, 0), blue = at(1, {20, 0, 1}, std::acos(-1.0));
    expectBounds(of_red.see("blue", red, red, blue), {19, -2, -2}, {21, 2, 4}, 1e-5);
    expectBounds(of_blue.see("red", blue, red, blue), {19, -2, -4}, {21, 2, 2}, 1e-5);
    expectBounds(of_red.see("red", red, red, blue), {-1, -2, -3}, {1, 2, 3}, 1e-5);
    // red turns to port and swims on: blue, 30 m ahead of the origin and turned back, is now to starboard
    const types::Pose turned = at(2, {20, -10, 0}, std::acos(0.0));
    expectBounds(of_red.see("blue", turned, turned, at(2, {30, -10, 0}, 0)), {-2, -11, -3}, {2, -9, 3}, 1e-5);
}

TEST_F(TwoVehiclesTest, ALinkOfAVehicleHasAPortOfItsOwn) {
    const auto file = writeWorld("<model name='red'><link name='base'/><link name='arm'>" + visual("v", box_) +
                                 "</link><joint name='j' type='revolute'><parent>base</parent><child>arm</child><axis>"
                                 "<xyz>0 0 1</xyz></axis></joint></model>");
    SceneTask task("scene");
    SceneConfig config;
    config.file = file.string();
    task.config.set(config);
    test::Writer<types::Pose> arm;
    EXPECT_NE(task.makeInput("red.pose", arm.port), nullptr);
    EXPECT_NE(task.makeInput("red::arm.pose", arm.port), nullptr);
    EXPECT_EQ(task.makeInput("red::leg.pose", arm.port), nullptr);
}

}  // namespace
}  // namespace insonify::sdf
