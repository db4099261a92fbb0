// The library of Gazebo Fortress as the other side: its services, its default partition, and how it reads our
// datagrams.
#include <gmock/gmock.h>
#include <ignition/msgs/discovery.pb.h>

#include <algorithm>
#include <ignition/transport/NetUtils.hh>
#include <ignition/transport/TopicUtils.hh>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/World.hpp"
#include "components/sdf/Sdf.hpp"
#include "tests/gazebo/FortressScene.hpp"
#include "tests/gazebo/FortressWorld.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::gazebo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class FortressTest : public OwnPartition {};

/** A crate on a floor, as Fortress's scene broadcaster describes them. */
bool fillScene(ignition::msgs::Scene& scene) {
    for (const char* name : {"floor", "crate"}) {
        ignition::msgs::Model& model = *scene.add_model();
        model.set_name(name);
        setPose(*model.mutable_pose(), "", 1, 2, std::string(name) == "floor" ? -10 : -9, 0);
        ignition::msgs::Link& link = *model.add_link();
        link.set_name("link");
        ignition::msgs::Visual& visual = *link.add_visual();
        visual.set_name("visual");
        ignition::msgs::Geometry& geometry = *visual.mutable_geometry();
        if (std::string(name) == "floor") {
            geometry.set_type(ignition::msgs::Geometry::PLANE);
            geometry.mutable_plane()->mutable_normal()->set_z(1);
            geometry.mutable_plane()->mutable_size()->set_x(40);
            geometry.mutable_plane()->mutable_size()->set_y(40);
        } else {
            geometry.set_type(ignition::msgs::Geometry::BOX);
            geometry.mutable_box()->mutable_size()->set_x(2);
            geometry.mutable_box()->mutable_size()->set_y(2);
            geometry.mutable_box()->mutable_size()->set_z(2);
            visual.mutable_material()->mutable_script()->set_name("Steel");
        }
    }
    return true;
}

TEST_F(FortressTest, TheModelsOfAWorldAreTakenFromItsService) {
    FortressWorld world;
    ASSERT_TRUE(world.serve("/world/sea/scene/info", fillScene));
    const scene::Scene scene = readWorld({"sea", "", 30}, "/");
    ASSERT_EQ(scene.geometry->objects.size(), 2u);
    EXPECT_THAT(scene.geometry->notices, testing::IsEmpty());
    EXPECT_GE(scene::findNode(scene, "crate::link"), 0);
    EXPECT_EQ(glm::dvec3(scene.geometry->objects[1].world_from_object[3]), glm::dvec3(1, 2, -9));
    const auto names = namesTaken("sea", partition);
    ASSERT_TRUE(names);
    EXPECT_THAT(*names, ElementsAre("crate", "floor", "link", "visual"));
}

/** Each node's place, and each object's node, mesh and place. */
void expectSameScene(const scene::Scene& a, const scene::Scene& b) {
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    ASSERT_EQ(a.geometry->objects.size(), b.geometry->objects.size());
    const auto findDifference = [](const glm::dmat4& left, const glm::dmat4& right) {
        double maximum = 0;
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) maximum = std::max(maximum, std::abs(left[c][r] - right[c][r]));
        return maximum;
    };
    for (const scene::Node& node : a.nodes) EXPECT_GE(scene::findNode(b, node.name), 0) << node.name;
    for (size_t i = 0; i < a.geometry->objects.size(); ++i) {
        const types::Object& object = a.geometry->objects[i];
        const auto other = std::ranges::find(b.geometry->objects, object.name, &types::Object::name);
        ASSERT_NE(other, b.geometry->objects.end()) << object.name;
        EXPECT_LT(findDifference(object.world_from_object, other->world_from_object), 1e-12) << object.name;
        EXPECT_EQ(a.geometry->meshes[size_t(object.mesh)].positions, b.geometry->meshes[size_t(other->mesh)].positions);
        const size_t k = size_t(other - b.geometry->objects.begin());
        EXPECT_EQ(a.nodes[size_t(a.object_nodes[i])].name, b.nodes[size_t(b.object_nodes[k])].name);
    }
}

TEST_F(FortressTest, AWorldIsTheSameSceneByItsServiceAsByItsFile) {
    const std::string file = test::sourceFile("deploy/scenes/two_vehicles.world");
    FortressWorld world;
    ASSERT_TRUE(world.serve("/world/two_vehicles/scene/info",
                            [&](ignition::msgs::Scene& scene) { return scene = makeScene(file), true; }));
    expectSameScene(sdf::readSdf(file), readWorld({"two_vehicles", "", 30}, "/"));
}

TEST_F(FortressTest, AServiceCanBeCalledRepeatedly) {
    FortressWorld world;
    std::atomic<int> asked = 0;
    ASSERT_TRUE(world.serve("/world/sea/scene/info", [&](ignition::msgs::Scene& scene) {
        ++asked;
        return fillScene(scene);
    }));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(readWorld({"sea", "", 30}, "/").nodes.size(), 4u);
    EXPECT_EQ(asked, 3);
}

TEST_F(FortressTest, ReportsTheFailureOfAService) {
    FortressWorld world;
    ASSERT_TRUE(world.serve("/world/sea/scene/info", [](ignition::msgs::Scene&) { return false; }));
    const Reply reply = request(TransportOptions::fromEnvironment(""), {"/world/sea/scene/info", "Empty", "Scene"}, "",
                                std::chrono::seconds(30));
    EXPECT_EQ(reply.failure, "reports a failure");
}

TEST_F(FortressTest, TheDefaultPartitionMatchesTheLibrary) {
    for (const char* name : {"GZ_PARTITION", "IGN_PARTITION"}) unsetenv(name);
    EXPECT_EQ(TransportOptions::fromEnvironment("").partition, ignition::transport::NodeOptions().Partition());
    EXPECT_EQ(TransportOptions::fromEnvironment("").partition,
              ignition::transport::hostname() + ":" + ignition::transport::username());
    for (const char* name : {"IGN_PARTITION", "GZ_PARTITION"}) setenv(name, "", 1);
    EXPECT_EQ(TransportOptions::fromEnvironment("").partition, ignition::transport::NodeOptions().Partition())
        << "given, and empty";
}

TEST_F(FortressTest, NamesMatchTheLibrary) {
    for (const std::string given : {"auv", "/auv", "auv/", "", "host:user"})
        for (const std::string topic :
             {"/world/sea/pose/info", "pose", "pose/", "/a b", "/a//b", "", "/", "~a", "a@"}) {
            std::string name;
            const bool is_taken = ignition::transport::TopicUtils::FullyQualifiedName(given, "", topic, name);
            const auto ours = qualifiedName(given, topic);
            EXPECT_EQ(ours.has_value(), is_taken) << given << " " << topic;
            EXPECT_EQ(ours.value_or(""), is_taken ? name : "");
        }
}

TEST_F(FortressTest, TheLibraryReadsOurDatagrams) {
    const auto read = [](const std::string& datagram) {
        ignition::msgs::Discovery message;
        EXPECT_EQ(datagram.size() - 2, uint8_t(datagram[0]) + 256u * uint8_t(datagram[1]));
        EXPECT_TRUE(message.ParseFromString(datagram.substr(2)));
        EXPECT_EQ(message.version(), 10u);
        EXPECT_EQ(message.process_uuid(), "ours");
        return message;
    };
    EXPECT_EQ(read(aliveDatagram("ours")).type(), ignition::msgs::Discovery::HEARTBEAT);
    EXPECT_EQ(read(goodbyeDatagram("ours")).type(), ignition::msgs::Discovery::BYE);
    const auto ask = read(askDatagram("ours", "@/auv@/pose"));
    EXPECT_EQ(ask.type(), ignition::msgs::Discovery::SUBSCRIBE);
    EXPECT_EQ(ask.sub().topic(), "@/auv@/pose");
    Publication publication;
    publication.topic = "@/auv@/pose";
    publication.address = "tcp://127.0.0.1:1";
    publication.process = "theirs";
    publication.type = "ignition.msgs.Pose_V";
    const auto connection = read(connectionDatagram("ours", "node", publication, true));
    EXPECT_EQ(connection.type(), ignition::msgs::Discovery::NEW_CONNECTION);
    EXPECT_EQ(connection.pub().topic(), "@/auv@/pose");
    EXPECT_EQ(connection.pub().process_uuid(), "ours");
    EXPECT_EQ(connection.pub().node_uuid(), "node");
    EXPECT_EQ(connection.pub().msg_pub().ctrl(), "theirs");
    EXPECT_EQ(connection.pub().msg_pub().msg_type(), "ignition.msgs.Pose_V");
    EXPECT_EQ(read(connectionDatagram("ours", "node", publication, false)).type(),
              ignition::msgs::Discovery::END_CONNECTION);
}

}  // namespace
}  // namespace insonify::gazebo
