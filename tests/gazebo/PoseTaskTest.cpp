// A world by the publisher of Gazebo's transport, and the task that reads its poses.
#include <gmock/gmock.h>

#include <limits>

#include "components/framework/execution/Activity.hpp"
#include "components/gazebo/PoseTask.hpp"
#include "components/scene/SceneTask.hpp"
#include "tests/gazebo/FortressWorld.hpp"
#include "tests/support/Listening.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Refused.hpp"

using namespace insonify;
using namespace insonify::gazebo;
using testing::Contains;
using testing::HasSubstr;

namespace {

struct PoseTaskTest : OwnPartition, protected test::Listening<PoseTask> {
    PoseTaskTest() : Listening("world", true) {}

    static BodyConfig entity(const std::string& port, const std::string& name) { return {port, name, ""}; }
    void startWith(std::vector<BodyConfig> bodies) {
        PoseConfig config;
        config.world = "sea";
        config.bodies = std::move(bodies);
        start(config, config.bodies);
    }
    /** Waits until a message has arrived, and discards it. */
    void meet(double seconds = 1) {
        ASSERT_TRUE(becomesTrue([&] {
            world.publish(seconds, 0);
            task.update();
            types::Pose pose;
            return readers[0].port.readNew(pose);
        }));
        task.update();
        for (auto& reader : readers) reader.port.clear();
    }

    FortressWorld world;
};

}  // namespace

TEST_F(PoseTaskTest, AVehicleAndAnObjectOfTheWorldAreFollowed) {
    startWith({entity("rov", "red"), entity("other", "blue")});
    meet();
    types::Time last;
    for (int i = 1; i <= 20; ++i) {
        world.publish(1 + 0.02 * i, i);
        const auto red = next(0), blue = next(1);
        ASSERT_TRUE(red && blue) << i;
        EXPECT_EQ(red->position, glm::dvec3(i, 2, -5));
        EXPECT_NEAR(2 * std::atan2(red->orientation.z, red->orientation.w), 0.5, 1e-12);
        EXPECT_EQ(blue->position, glm::dvec3(i + 12, 4, -5));
        EXPECT_EQ(red->time, blue->time);
        EXPECT_GE(red->time, last);
        EXPECT_LE(red->time, framework::wallClock());
        last = red->time;
    }
}

TEST_F(PoseTaskTest, AnObjectOfTheSceneMovesWithItsModelInGazebo) {
    scene::SceneTask scene("scene");
    scene::SceneConfig config;
    config.file = test::sourceFile("deploy/scenes/two_vehicles.world");
    scene.config.set(config);
    PoseConfig poses;
    poses.world = "sea";
    poses.bodies = {entity("rov", "red"), entity("other", "blue")};
    task.config.set(poses);
    auto* rov = task.makeOutput("rov");
    auto* other = task.makeOutput("other");
    rov->connectTo(scene.pose, {});
    rov->connectTo(readers[0].port, {});
    other->connectTo(*scene.makeInput("blue.pose", *other), {});
    test::Reader<types::SnapshotPtr> shown;
    scene.snapshot.connectTo(shown.port, {});
    for (framework::TaskContext* each :
         {static_cast<framework::TaskContext*>(&task), static_cast<framework::TaskContext*>(&scene)})
        ASSERT_TRUE(each->configure() && each->start()) << each->lastError();
    meet();
    glm::dvec3 first{0};
    for (const double x : {3.0, 5.5}) {
        world.publish(1 + x, x);
        ASSERT_TRUE(next());
        scene.update();
        types::SnapshotPtr snapshot;
        ASSERT_TRUE(shown.port.readNew(snapshot));
        EXPECT_EQ(snapshot->sonar.position, glm::dvec3(x, 2, -5));
        ASSERT_FALSE(snapshot->moved.empty());
        const glm::dvec3 place = snapshot->moved[0].world_from_object[3];
        EXPECT_LT(glm::distance(place, {x + 12, 4, -5}), 3) << "a part of blue";
        EXPECT_TRUE(x == 3 || glm::distance(place - first, {2.5, 0, 0}) < 1e-9);
        first = place;
    }
}

TEST_F(PoseTaskTest, AModelIsFoundByItsNumberThenByItsNameAndElseStaysWhereItWas) {
    world.serve("/world/sea/scene/info", [](ignition::msgs::Scene& scene) {
        uint32_t number = 10;
        for (const char* name : {"red", "blue"}) {
            ignition::msgs::Model& model = *scene.add_model();
            model.set_name(name);
            model.set_id(number++);
            ignition::msgs::Link& link = *model.add_link();
            link.set_name("hull");
            link.set_id(number++);
        }
        return true;
    });
    startWith({entity("hull", "red::hull"), entity("other", "blue")});
    meet();
    double stamp = 1;
    const auto placeOther = [&](const std::vector<std::pair<std::string, uint32_t>>& entities) {
        ignition::msgs::Pose_V message;
        setStamp(*message.mutable_header(), stamp += 0.1);
        for (const auto& [name, number] : entities) {
            setPose(*message.add_pose(), name, number, 0, 0, 0);
            message.mutable_pose(message.pose_size() - 1)->set_id(number);
        }
        world.send(message);
        return next(1).value_or(types::Pose{}).position.x;
    };
    EXPECT_EQ(placeOther({{"red", 10}, {"blue", 12}, {"hull", 11}, {"blue", 50}}), 12) << "50 is a light";
    EXPECT_EQ(placeOther({{"red", 10}, {"hull", 11}}), 12) << "removed";
    EXPECT_EQ(placeOther({{"red", 10}, {"hull", 11}, {"blue", 70}}), 70) << "inserted again";
    EXPECT_EQ(next(0).value_or(types::Pose{}).position.x, 21) << "the link is in its model";
}

TEST_F(PoseTaskTest, AMessageWakesTheTask) {
    startWith({entity("rov", "red")});
    task.activity().release();
    int sent = 0;
    types::Pose pose;
    EXPECT_TRUE(becomesTrue([&] {
        ++sent;
        world.publish(1 + 0.01 * sent, sent);
        return readers[0].port.readNew(pose);
    }));
}

TEST_F(PoseTaskTest, OdometryIsFollowedWithItsVelocities) {
    startWith({{"rov", "", "/model/rov/odometry"}});
    ignition::msgs::Odometry message;
    setPose(*message.mutable_pose(), "", 1, 2, 3, 0);
    message.mutable_twist()->mutable_linear()->set_x(0.5);
    std::optional<types::Pose> pose;
    double seconds = 5;
    ASSERT_TRUE(becomesTrue([&] {
        setStamp(*message.mutable_header(), seconds += 0.02);
        world.send(message);
        task.update();
        types::Pose came;
        if (readers[0].port.readNew(came)) pose = came;
        return pose.has_value();
    }));
    EXPECT_EQ(pose->position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(pose->velocity, glm::dvec3(0.5, 0, 0));
}

TEST_F(PoseTaskTest, APausedWorldGivesNoPoseAndAResetWorldBeginsAnew) {
    startWith({entity("rov", "red")});
    meet(100);
    for (int i = 0; i < 5; ++i) world.publish(100, 1);  // paused
    world.publish(100.02, 2);
    EXPECT_EQ(next().value_or(types::Pose{}).position.x, 2);
    double stamp = 100.02;
    const auto is_known = [&] {  // in pairs, because any stamp is valid after a second of silence
        world.publish(stamp += 0.1, 2);
        world.publish(stamp - 0.05, 3);  // from another publisher, or out of order
        task.update();
        const std::vector<std::string> all = types::lines(task.notices());
        return std::ranges::any_of(all, [](const auto& line) {
            return line.find("dropped: /world/sea/pose/info: the stamp is before") != std::string::npos;
        });
    };
    EXPECT_TRUE(becomesTrue(is_known));
    world.publish(0, 4);
    auto pose = next();
    while (pose && pose->position.x != 4) pose = next();
    EXPECT_EQ(pose.value_or(types::Pose{}).position.x, 4);
    EXPECT_GT(pose.value_or(types::Pose{}).time, types::Time::fromSeconds(1e9)) << "on our clock";
}

/** A live world whose time jumps, as when its user rewinds it or seeks: each pose comes, at its arrival on our clock.
 */
TEST_F(PoseTaskTest, StepsOfTheWorldsClockInBothDirectionsLoseNoPose) {
    startWith({entity("rov", "red")});
    double stamp = 10'000;
    meet(stamp);
    int sent = 100;
    types::Time last;
    for (const double step : {600.0, -600.0, 7200.0, -1.5, -9000.0, 2.0, -600.0, 600.0}) {
        stamp += step;
        for (int i = 0; i < 10; ++i) {
            world.publish(stamp += 0.02, ++sent);
            const auto pose = next();
            ASSERT_TRUE(pose) << i << " after a step of " << step << " s";
            EXPECT_EQ(pose->position.x, sent) << i << " after a step of " << step << " s";
            EXPECT_GE(pose->time, last) << i << " after a step of " << step << " s";
            const double age = (framework::wallClock() - pose->time).seconds();
            EXPECT_TRUE(age >= 0 && age < 30) << age << " s, " << i << " after a step of " << step << " s";
            last = pose->time;
        }
    }
    const std::vector<std::string> all = types::lines(task.notices());
    EXPECT_THAT(all, testing::Not(Contains(HasSubstr("the stamp is before")))) << testing::PrintToString(all);
}

TEST_F(PoseTaskTest, DropsAndReportsPosesThatAreNotFiniteAndMissingEntities) {
    startWith({entity("rov", "red"), entity("other", "auv")});
    meet();
    ignition::msgs::Pose_V message;
    setStamp(*message.mutable_header(), 2);
    setPose(*message.add_pose(), "red", std::numeric_limits<double>::quiet_NaN(), 0, 0, 0);
    world.send(message);
    EXPECT_TRUE(reports("dropped: red: position and orientation are not finite"));
    EXPECT_TRUE(reports("dropped: auv: no entity of that name"));
    setStamp(*message.mutable_header(), 2.1);
    setPose(*message.mutable_pose(0), "red", 1, 0, 0, 0);
    message.mutable_pose(0)->mutable_orientation()->set_w(0);
    world.send(message);
    message.mutable_pose(0)->mutable_orientation()->set_w(7);  // of another length
    setStamp(*message.mutable_header(), 2.2);
    world.send(message);
    const auto pose = next();
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->position.x, 1);
    EXPECT_EQ(pose->orientation, glm::dquat(1, 0, 0, 0));
}

TEST_F(PoseTaskTest, AMessageWithoutAStampGetsItsTimeOfArrival) {
    startWith({entity("rov", "red")});
    meet();
    ignition::msgs::Pose_V message;
    setPose(*message.add_pose(), "red", 9, 0, 0, 0);
    const types::Time before = framework::wallClock();
    world.send(message);
    EXPECT_GE(next().value_or(types::Pose{}).time, before);
}

TEST_F(PoseTaskTest, UnreadMessagesDoNotFillTheMemory) {
    int woken = 0;
    Inbox inbox([&] { ++woken; });
    for (size_t i = 0; i < Inbox::capacity + 5; ++i) inbox.put({i, {}, {}, {}, ""});
    EXPECT_EQ(inbox.lost(), 5u);
    const std::vector<Arrived> taken = inbox.take();
    ASSERT_EQ(taken.size(), Inbox::capacity);
    EXPECT_EQ(taken.front().topic, 5u);
    EXPECT_EQ(woken, int(Inbox::capacity) + 5);
}

TEST_F(PoseTaskTest, AnInvalidNameForTheTransportIsAnErrorOfItsProperty) {
    PoseConfig config;
    config.pose_topic = "/with a space";
    config.bodies = {entity("rov", "red")};
    PoseTask other("other");
    other.config.set(config);
    EXPECT_THAT(other.configure().reason, HasSubstr("other.pose_topic: is /with a space, which"));
    config.pose_topic = "/poses";
    config.partition = "a@b";
    PoseTask third("third");
    third.config.set(config);
    EXPECT_THAT(third.configure().reason, HasSubstr("third.partition: is a@b, which"));
}

TEST_F(PoseTaskTest, LockstepIsRefusedWithAReason) {
    PoseTask other("other");
    other.environment().lockstep = true;
    EXPECT_THAT(test::countRefusals(other), testing::ElementsAre(HasSubstr("set schedule: realtime")));
}
