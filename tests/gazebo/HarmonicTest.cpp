// Poses and worlds over the wire, with a replacement of Gazebo Harmonic.
#include <gmock/gmock.h>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/Multicast.hpp"
#include "components/gazebo/PoseTask.hpp"
#include "components/gazebo/Publisher.hpp"
#include "components/gazebo/Subscriptions.hpp"
#include "components/gazebo/World.hpp"
#include "components/scene/SceneTask.hpp"
#include "tests/gazebo/HarmonicWorld.hpp"
#include "tests/gazebo/Partition.hpp"
#include "tests/gazebo/Recordings.hpp"
#include "tests/support/Listening.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using Settings = HarmonicWorld::Settings;

struct HarmonicTest : OwnPartition, protected test::Listening<PoseTask> {
    HarmonicTest() : Listening("world", true) {
        task.environment().warn = [this](const std::string& text) { warnings += text + "\n"; };
    }

    void follow(const std::string& entity) {
        PoseConfig config;
        config.world = "sea";
        config.bodies = {{"rov", entity, ""}};
        start(config, config.bodies);
    }
    static std::string poses(double seconds, const std::vector<std::string>& names, double x) {
        wire::PoseV message;
        message.mutable_header()->mutable_stamp()->set_sec(static_cast<int64_t>(seconds));
        message.mutable_header()->mutable_stamp()->set_nsec(static_cast<int32_t>((seconds - int64_t(seconds)) * 1e9));
        for (const std::string& name : names) {
            wire::Pose& pose = *message.add_pose();
            pose.set_name(name);
            pose.mutable_position()->set_x(x);
        }
        return message.SerializeAsString();
    }
    /** Returns the error of the scene's task. */
    static std::string findDiagnostic(const scene::GazeboConfig& config) {
        scene::SceneTask task("scene");
        scene::SceneConfig scene;
        scene.gazebo = config;
        task.config.set(scene);
        types::Diagnostics diagnostics;
        task.check(diagnostics);
        EXPECT_EQ(diagnostics.size(), 1u);
        return diagnostics.empty() ? "" : diagnostics[0].path + ": " + diagnostics[0].message;
    }
    bool isDropped(const std::string& why) {
        task.update();
        const std::vector<std::string> all = types::lines(task.notices());
        return std::ranges::any_of(all, [&](const auto& line) { return line.find("dropped: " + why) != line.npos; });
    }
    bool isWarned(const std::string& text) const { return warnings.find(text) != std::string::npos; }
    static scene::GazeboConfig world(const std::string& name, double timeout = 5) { return {name, "", timeout}; }

    std::string warnings;
};

TEST_F(HarmonicTest, PosesOfAWorldAreRead) {
    follow("rov");
    HarmonicWorld world({});
    types::Pose read;
    ASSERT_TRUE(becomesTrue([&] {  // the first may be sent before its receiver is connected
        world.publish(recording("poses"));
        task.update();
        return readers[0].port.readNew(read);
    }));
    const types::Pose* const pose = &read;
    EXPECT_EQ(pose->position, glm::dvec3(1.5, 0, -5));
    EXPECT_NEAR(2 * std::atan2(pose->orientation.z, pose->orientation.w), 1.5707963, 1e-6);
}

TEST_F(HarmonicTest, TopicsHaveTheTypesOfTheGazeboThatIsThere) {
    const TransportOptions options = TransportOptions::fromEnvironment("");
    const std::string name = *qualifiedName(options.partition, "/rov/scan");
    for (const auto& [type, wanted] :
         {std::pair("gz.msgs.Pose_V", "gz.msgs.LaserScan"),
          std::pair("ignition.msgs.Pose_V", "ignition.msgs.LaserScan"), std::pair("", "gz.msgs.LaserScan")}) {
        SCOPED_TRACE(type);
        const Multicast listener(options, options.topic_port);
        // The Gazebo of another partition is of another version, and speaks first.
        HarmonicWorld::Settings other;
        other.type = wanted == std::string("gz.msgs.LaserScan") ? "ignition.msgs.Pose_V" : "gz.msgs.Pose_V";
        other.partition = partition + "-other";
        const HarmonicWorld neighbour(other);
        std::unique_ptr<HarmonicWorld> world;
        if (*type) {
            HarmonicWorld::Settings settings;
            settings.type = type;
            world = std::make_unique<HarmonicWorld>(settings);
        }
        std::string offered, address;
        bool withdrawn = false, gone = false;
        Received others("/scan");
        const auto listen = [&] {
            while (const auto datagram = listener.receive()) {
                const auto news = readDatagram(datagram->bytes, "listener", others);
                if (!news || (news->kind != Announcement::Kind::Goodbye && news->publication.topic != name)) continue;
                if (news->kind == Announcement::Kind::Offer)
                    offered = news->publication.type, address = news->publication.address;
                withdrawn |= news->kind == Announcement::Kind::Withdrawal;
                gone |= news->kind == Announcement::Kind::Goodbye;
            }
        };
        {
            Publisher publisher(options, {{"/rov/scan", "LaserScan"}});
            EXPECT_FALSE(publisher.hasReaders(0));
            ASSERT_TRUE(becomesTrue([&] { return listen(), !offered.empty(); }));
            EXPECT_EQ(offered, wanted);
            EXPECT_THAT(address, testing::StartsWith("tcp://127.0.0.1:"));
            std::mutex mutex;
            std::vector<std::string> taken;
            {
                const Subscriber reader(options, {{"/rov/scan", [&](const std::string& read, std::string_view message) {
                                                       const std::lock_guard lock(mutex);
                                                       taken.push_back(read + ":" + std::string(message));
                                                   }}});
                ASSERT_TRUE(becomesTrue([&] { return publisher.hasReaders(0); }));
                for (int i = 0; i < 10; ++i) publisher.publish(0, std::to_string(i));
                EXPECT_TRUE(becomesTrue([&] {
                    const std::lock_guard lock(mutex);
                    return taken.size() == 10;
                }));
                EXPECT_EQ(taken.back(), "LaserScan:9");
            }
            EXPECT_TRUE(becomesTrue([&] { return !publisher.hasReaders(0); })) << "after the reader's end";
            EXPECT_EQ(publisher.lost(), 0u);
        }
        EXPECT_TRUE(becomesTrue([&] { return listen(), withdrawn && gone; }));
    }
    EXPECT_THROW(Publisher(options, {{"/a b", "Image"}}), types::ConfigError);
}

TEST_F(HarmonicTest, FindsARestartedWorld) {
    follow("rov");
    for (const double x : {1.0, 2.0}) {
        HarmonicWorld world({});
        double seconds = x;
        types::Pose pose;
        ASSERT_TRUE(becomesTrue([&] {
            world.publish(poses(seconds += 0.02, {"rov"}, x));
            task.update();
            return readers[0].port.readNew(pose) && pose.position.x == x;
        })) << x;
    }
}

TEST_F(HarmonicTest, InformsAPublisherWhenItsMessagesAreNoLongerReceived) {
    HarmonicWorld world({});
    {
        const Subscriber subscriber(TransportOptions::fromEnvironment(""),
                                    {{"/world/sea/pose/info", [](const std::string&, std::string_view) {}}});
        EXPECT_TRUE(becomesTrue([&] { return world.takers() == 1; }));
        EXPECT_TRUE(becomesTrue([&] { return subscriber.hasPublisher(0); }));
    }
    EXPECT_TRUE(becomesTrue([&] { return world.takers() == 0; }));
}

TEST_F(HarmonicTest, DropsAndReportsDamagedMessagesAndWrongTypes) {
    follow("rov");
    {
        HarmonicWorld world({.type = "gz.msgs.Image"});
        EXPECT_TRUE(becomesTrue([&] {
            world.publish("x");
            return isDropped("/world/sea/pose/info: messages of type Image, not Pose_V");
        }));
    }
    HarmonicWorld world({});
    EXPECT_TRUE(becomesTrue([&] {
        world.publish("no message");
        return isDropped("/world/sea/pose/info: bytes that are no Pose_V");
    }));
}

TEST_F(HarmonicTest, ListsAvailableTopicsWhenATopicIsMissing) {
    HarmonicWorld other({.world = "harbour"});
    follow("rov");
    EXPECT_TRUE(becomesTrue([&] {
        task.update();
        return isWarned("nobody publishes /world/sea/pose/info in partition " + partition + "; available are ") &&
               isWarned("/world/harbour/pose/info in partition " + partition);
    })) << warnings;
}

TEST_F(HarmonicTest, ReportsModelsThatAppearOrDisappear) {
    HarmonicWorld gazebo({.scene = recording("scene")});
    scene::SceneTask scene("scene");
    scene::SceneConfig config;
    config.gazebo = world("sea");
    scene.config.set(config);
    types::Diagnostics diagnostics;
    scene.check(diagnostics);
    ASSERT_TRUE(diagnostics.empty()) << diagnostics[0].text();
    types::Time clock{1'000'000'000};
    task.environment().now = [&] { return clock; };
    follow("rov");
    double seconds = 1;
    const auto update = [&](const std::vector<std::string>& names) {
        gazebo.publish(poses(seconds += 0.02, names, 1));
        task.update();
    };
    const auto isSaid = [&](const std::vector<std::string>& names, const std::string& text) {
        return becomesTrue([&] { return update(names), isWarned(text); });
    };
    EXPECT_TRUE(isSaid({"rov", "link", "crate", "barrel"},
                       "world sea has entities that the scene does not have: barrel; restart"));
    const std::string lost = "world sea has lost entities that the scene still has: crate";
    clock = clock + types::Time::fromSeconds(59.9);
    for (int i = 0; i < 200; ++i) update({"rov", "link"});
    EXPECT_FALSE(isWarned(lost)) << "within a minute of the last report";
    clock = clock + types::Time::fromSeconds(0.1);
    EXPECT_TRUE(isSaid({"rov", "link"}, lost)) << warnings;
}

TEST_F(HarmonicTest, AWorldIsTheSceneOfATask) {
    HarmonicWorld gazebo({.scene = recording("scene")});
    scene::SceneTask scene_task("scene");
    scene::SceneConfig config;
    config.gazebo = world("sea");
    config.materials_by_name = false;
    scene_task.config.set(config);
    framework::OutputPort<types::Pose> source(&scene_task, "source", "");
    EXPECT_NE(scene_task.makeInput("rov.pose", source), nullptr);
    EXPECT_EQ(scene_task.makeInput("auv.pose", source), nullptr) << "the world has no such model";
    ASSERT_TRUE(scene_task.configure() && scene_task.start()) << scene_task.lastError();
    EXPECT_THAT(scene_task.notices(), Contains(HasSubstr("hull.obj is not found")));
    EXPECT_THAT(scene_task.indivisible(), HasSubstr("gazebo: is the world as it is when it is asked for"));
}

TEST_F(HarmonicTest, TasksShareAWorld) {
    HarmonicWorld gazebo({.scene = recording("scene")});
    const auto first = scene::sharedWorld(world("sea"), "/"), second = scene::sharedWorld(world("sea"), "/");
    EXPECT_EQ(first, second);
    EXPECT_FALSE(first->nodes.empty());
}

TEST_F(HarmonicTest, TheErrorForAMissingWorldListsTheAvailableWorlds) {
    EXPECT_THAT(findDiagnostic(world("sea", 0.3)),  // other tests may run on this machine
                testing::StartsWith("gazebo.world: is sea; its service /world/sea/scene/info is not offered in "
                                    "partition " +
                                    partition + " within 0.3 s (timeout); "));
    HarmonicWorld other({.world = "harbour"});
    EXPECT_THAT(findDiagnostic(world("sea", 2)), HasSubstr("/world/harbour/scene/info in partition " + partition));
    HarmonicWorld silent({.version = statistics_version});
    EXPECT_THAT(findDiagnostic(world("sea", 2)), HasSubstr("GZ_TRANSPORT_TOPIC_STATISTICS"));
}

TEST_F(HarmonicTest, FailingSilentAndWrongServicesHaveTheirOwnErrors) {
    {
        HarmonicWorld gazebo({.succeeds = false});
        EXPECT_THAT(findDiagnostic(world("sea")), HasSubstr("/world/sea/scene/info reports a failure"));
    }
    {
        HarmonicWorld gazebo({.answers = false});
        EXPECT_THAT(findDiagnostic(world("sea", 2)), HasSubstr("/world/sea/scene/info is offered at tcp://127.0.0.1:"));
    }
    {
        HarmonicWorld gazebo({.reply_type = "gz.msgs.StringMsg"});
        EXPECT_THAT(findDiagnostic(world("sea", 2)),
                    HasSubstr("takes gz.msgs.Empty and returns gz.msgs.StringMsg, not Empty and Scene"));
    }
    HarmonicWorld gazebo({.scene = "no message"});
    EXPECT_THAT(findDiagnostic(world("sea")), HasSubstr("gazebo.world: has a service that answers bytes"));
}

TEST_F(HarmonicTest, AFailureIsCachedUntilTheTaskIsConfigured) {
    scene::SceneTask scene_task("scene");
    scene::SceneConfig config;
    config.gazebo = world("sea", 0.5);
    scene_task.config.set(config);
    const auto begin = std::chrono::steady_clock::now();
    framework::OutputPort<types::Pose> source(&scene_task, "source", "");
    for (int i = 0; i < 50; ++i) EXPECT_NE(scene_task.makeInput("rov.pose", source), nullptr) << "it may be right";
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
    EXPECT_THAT(scene_task.configure().reason, HasSubstr("scene.gazebo.world: is sea"));
    ASSERT_TRUE(scene_task.recover());
    HarmonicWorld gazebo({.scene = recording("scene")});
    config.gazebo->timeout = 30;
    scene_task.config.set(config);
    EXPECT_TRUE(scene_task.configure()) << scene_task.lastError();
}

TEST_F(HarmonicTest, AWorldWithoutANameOrTogetherWithAFileIsAnError) {
    types::Diagnostics diagnostics;
    scene::GazeboConfig{}.check(diagnostics);
    scene::SceneConfig both;
    both.file = "a.glb";
    both.gazebo = world("sea");
    both.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 2u);
    EXPECT_EQ(diagnostics[0].text(), "world: is missing; give the name of a world that Gazebo runs");
    EXPECT_EQ(diagnostics[1].text(), "gazebo: is given, and file as well; give one of both, which holds the models");
    EXPECT_THAT(findDiagnostic(world("two words")), HasSubstr("is two words, which Gazebo's transport does not take"));
}

TEST_F(HarmonicTest, AWorldThatSpawnsModelsAllTheTimeIsReportedOnceInTenSeconds) {
    HarmonicWorld world({});
    follow("red");
    types::Pose pose;
    double seconds = 1;
    ASSERT_TRUE(becomesTrue([&] {
        world.publish(poses(seconds += 0.01, {"red"}, 0));
        task.update();
        return readers[0].port.readNew(pose);
    }));
    for (int i = 0; i < 200; ++i) {
        world.publish(poses(seconds += 0.01, {"red", "bubble" + std::to_string(i)}, 0));
        task.update();
    }
    ASSERT_TRUE(becomesTrue([&] { return task.update(), isWarned("has entities that the scene does not have"); }));
    size_t lines = 0;
    for (size_t at = 0; (at = warnings.find("has entities", at)) != warnings.npos; ++at) ++lines;
    EXPECT_EQ(lines, 1u) << warnings;
}

TEST_F(HarmonicTest, AMessageThatTheMemoryCannotHoldEndsNothing) {
    HarmonicWorld world({});
    std::atomic<int> taken{0};
    const Topic topic{"/world/sea/pose/info", [&](const std::string&, std::string_view) {
                          if (++taken == 1) throw std::bad_alloc();
                      }};
    const Subscriber subscriber(TransportOptions::fromEnvironment(""), {topic});
    EXPECT_TRUE(becomesTrue([&] { return world.publish(poses(1, {"red"}, 0)), taken > 3; }));
}

}  // namespace
}  // namespace insonify::gazebo
