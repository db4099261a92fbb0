// Messages from Gazebo by UDP and TCP: datagrams, poses, scenes.
#include <cmath>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/Subscriptions.hpp"
#include "components/gazebo/World.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void enterScene(const std::string& bytes, const std::filesystem::path& folder) try {
    const gazebo::World world = gazebo::getWorld(bytes, folder);
    scene::expectSound(*world.scene.geometry);
    for (const scene::Node& node : world.scene.nodes) EXPECT_TRUE(scene::isFinite(node.parent_from_node)) << node.name;
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

void enterGazebo(const Input& input) {
    gazebo::Received received("/pose/info");
    const auto announcement = gazebo::readDatagram(input.bytes(), "ours", received);
    EXPECT_FALSE(announcement && announcement->process.empty());
    EXPECT_FALSE(received.text().empty());
    gazebo::WorldWatch watch({});
    for (const auto frame : {types::WorldFrame::AsIs, types::WorldFrame::Enu}) {
        if (const auto message = gazebo::readPoses(input.bytes(), frame)) {
            watch.take(*message);
            for (const auto& entity : message->entities)
                EXPECT_TRUE(gazebo::findEntity(*message, entity.name).pose ||
                            !gazebo::findEntity(*message, entity.name).diagnostic.empty());
        }
        const auto odometry = gazebo::readOdometry(input.bytes(), frame);
        const bool is_placed = odometry && types::isUsable(odometry->pose);
        EXPECT_TRUE(!odometry || is_placed || std::isnan(odometry->pose.velocity.x)) << "in the world, by no turn";
    }
    enterScene(input.bytes(), input.file().parent_path());
}

TEST(GazeboFuzzTest, EveryMessageIsReadOrNone) {
    push({"gazebo",
          "message.bin",
          {"@/auv@/world/sea/pose/info", "tcp://127.0.0.1:40123", "gz.msgs.Pose_V", "ignition.msgs.Scene",
           std::string("\x12\x00", 2), "\x4a", "\x62", "file:///", "model://a"},
          enterGazebo});
}

}  // namespace
}  // namespace insonify::fuzz
