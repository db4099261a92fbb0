// deploy/ros2_fls.yml, deploy/ros2_tf.yml and what is wrong with others, as a user sees it.
#include <gmock/gmock.h>

#include "components/dds/Endpoints.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/SonarMessages.hpp"
#include "tests/dds/Loopback.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::dds;
using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

class Ros2RunTest : public Loopback {
protected:
    TestFolder folder;
    const std::string fls = test::sourceFile("deploy/ros2_fls.yml");
    const std::string tf = test::sourceFile("deploy/ros2_tf.yml");

    Outcome check(const std::string& yaml) {
        writeFile(folder / "x.yml", yaml);
        return callInsonify(folder, {"check", "x.yml"});
    }
};

/** Of the harbour's task: a machine that stalls is not to look like a vehicle that has gone. */
const std::string patience = "scene.pose_timeout=60";

/** A vehicle that tells where it is, twenty times a second. */
const std::string vehicle =
    "schedule: realtime\ntasks:\n"
    "  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.05}, properties: {file: " +
    test::sourceFile("deploy/scenes/harbour_pass.csv") +
    "}}\n"
    "  ros: {type: dds::PublisherTask, properties: {topics: [{port: pose, topic: /auv/odometry, type: "
    "nav_msgs/Odometry}]}}\n"
    "connections:\n  - {from: vehicle.pose, to: ros.pose, policy: {type: buffer, size: 8}}\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_F(Ros2RunTest, PosesOfAVehicleBecomePingsOfTheSonar) {
    TestFolder elsewhere;
    writeFile(elsewhere / "vehicle.yml", vehicle);
    const Process poses(insonifyWords({"run", "vehicle.yml", "--out", "out"}), elsewhere.path());
    const Process sonar(
        insonifyWords({"run", fls, "--out", "out", "--pings", "40", "--summary", "summary.json", "--set", patience}),
        folder.path());
    Node node(domainId({}), "listener", 16);
    Reader reader(node, "rt/auv/sonar", ros::ProjectedSonarImage::type_name, "", {}, {});
    ros::ProjectedSonarImage message;
    Bytes bytes;
    uint64_t sender = 0;
    const bool heard = comesTrue([&] { return reader.take(bytes, sender); });
    for (const Process* process : {&poses, &sonar})
        if (!heard) process->signal(SIGKILL);
    ASSERT_TRUE(heard);
    ros::decode(std::span<const char>(bytes), message);
    EXPECT_EQ(message.image.beam_count, 256u);
    EXPECT_EQ(message.image.data.size(), 256u * 500);
    EXPECT_GT(std::ranges::count_if(message.image.data, [](uint8_t level) { return level > 0; }), 1000);
    const Outcome outcome = sonar.wait();
    poses.signal(SIGINT);
    EXPECT_EQ(poses.wait().code, 0);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GE(json::parse(readFile(folder / "summary.json"))["pings"], 40);
}

TEST_F(Ros2RunTest, PosesThatAreDroppedAreToldAtOnceAndAtTheEnd) {
    if (!Peer::available())
        GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    const Process sonar(insonifyWords({"run", fls, "--out", "out", "--pings", "10", "--set", patience}), folder.path());
    const Peer peer("odometry /auv/odometry 100000 20 nan");
    const Outcome outcome = sonar.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string why = "/auv/odometry: position and orientation are not finite";
    EXPECT_THAT(outcome.err, testing::ContainsRegex("warning: poses: [0-9]+ messages? dropped; the last: " + why));
    EXPECT_THAT(outcome.out + outcome.err, testing::ContainsRegex("messages? dropped: " + why));
}

TEST_F(Ros2RunTest, WithoutPosesItWaitsAndSaysSo) {
    Process waiting(insonifyWords({"run", fls, "--out", "out"}), folder.path());
    EXPECT_TRUE(comesTrue([&] {
        return readFile(folder / "stderr.txt").find("warning: scene: scene.pose: waits for the first pose") !=
               std::string::npos;
    })) << readFile(folder / "stderr.txt");
    waiting.signal(SIGINT);
    const Outcome outcome = waiting.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(Ros2RunTest, TransformsOfAPeerBecomePings) {
    if (!Peer::available())
        GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    const Process sonar(
        insonifyWords({"run", tf, "--out", "out", "--pings", "10", "--summary", "summary.json", "--set", patience}),
        folder.path());
    const Peer peer("transforms 0.5");
    if (!comesTrue([&] { return fs::exists(folder / "summary.json"); })) sonar.signal(SIGKILL);
    const Outcome outcome = sonar.wait();
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GE(json::parse(readFile(folder / "summary.json"))["pings"], 10);
}

TEST_F(Ros2RunTest, TheDeploymentsAreValid) {
    for (const std::string& deployment : {fls, tf}) EXPECT_EQ(callInsonify(folder, {"check", deployment}).code, 0);
}

TEST_F(Ros2RunTest, DiagnosticsAreToldWithTheirPlace) {
    Outcome outcome = check(replaced(vehicle, "type: nav_msgs/Odometry", "type: nav_msgs/Odometri"));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("x.yml:4:"));
    EXPECT_THAT(outcome.err, HasSubstr("tasks.ros.properties.topics[0].type: is nav_msgs/Odometri"));
    outcome = check(replaced(vehicle, "topic: /auv/odometry", "topic: /auv odometry"));
    EXPECT_THAT(outcome.err, HasSubstr("topics[0].topic: is \"/auv odometry\"; must be words of letters"));
    outcome = check(replaced(vehicle, "{port: pose,", "{port: pose, colour: red,"));
    EXPECT_THAT(outcome.err, HasSubstr("topics[0].colour"));
    outcome = check(replaced(vehicle, "nav_msgs/Odometry", "sensor_msgs/Image"));
    EXPECT_THAT(
        outcome.err,
        HasSubstr("topics[0].type: is sensor_msgs/Image; /base/samples/RigidBodyState can be nav_msgs/Odometry"));
    outcome = check(replaced(vehicle, "to: ros.pose", "to: ros.other"));
    EXPECT_THAT(outcome.err, HasSubstr("no topic of ros is for port other"));
}

TEST_F(Ros2RunTest, LockstepDoesNotReadPoses) {
    const Outcome outcome =
        check(replaced(replaced(readFile(fls), "realtime", "lockstep"), "scenes/", test::sourceFile("deploy/scenes/")));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("tasks.poses.properties: messages come on the wall clock's time"));
}

TEST_F(Ros2RunTest, ADomainThatCannotBeJoinedIsOneError) {
    writeFile(folder / "x.yml", vehicle);
    setenv("CYCLONEDDS_URI",
           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface "
           "name=\"nothere0\"/></Interfaces></General></Domain></CycloneDDS>",
           1);
    const Outcome outcome = callInsonify(folder, {"run", "x.yml", "--out", "out"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("cannot be joined"));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
}
