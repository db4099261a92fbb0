// A log that is replayed in a deployment and logged again.
#include <gmock/gmock.h>

#include "components/framework/Deployment.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "components/logger/LoggerTask.hpp"
#include "components/replay/ReplayTask.hpp"
#include "tests/support/Bag.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::replay {
namespace {

const std::atomic<bool> never{false};

/** Writes poses every 0.1 s from 100 s on, and a ping for each, a little later in the file. */
void writeLog(const std::filesystem::path& path) {
    log::pocolog::Writer log(path);
    const size_t vehicle = log.addStream<types::Pose>("vehicle.pose");
    const size_t sonar = log.addStream<types::Sonar>("sonar.ping");
    for (int i = 0; i < 20; ++i) {
        types::Pose pose;
        pose.time = types::Time::fromSeconds(100 + 0.1 * i);
        pose.position.x = i;
        types::Sonar ping;
        ping.time = pose.time;
        ping.bins = {static_cast<float>(i)};
        log.write(vehicle, pose.time, pose);
        log.write(sonar, pose.time + types::Time{500}, ping);
    }
    log.close();
}

framework::RunResult runIn(const Folder& folder, const std::string& yaml) {
    framework::Registry registry;
    replay::registerTasks(registry);
    logger::registerTasks(registry);
    auto spec = framework::DeploymentSpec::parse(yaml, (folder / "replay.yml").string());
    framework::Deployment deployment(std::move(spec), registry, folder.path());
    deployment.configure();
    return deployment.run({}, never);
}

const char* again = R"(
tasks:
  replay: {type: replay::ReplayTask, properties: {file: a.0.log}}
  log: {type: logger::LoggerTask, properties: {file: b.0.log}}
connections:
  - {from: replay.vehicle.pose, to: log.pose, policy: {type: buffer, size: 8}}
  - {from: replay.sonar.ping, to: log.ping, policy: {type: buffer, size: 8}}
)";

TEST(ReplayDeploymentTest, AReplayedLogIsTheSameAndEndsTheRun) {
    Folder folder;
    writeLog(folder / "a.0.log");
    const framework::RunResult result = runIn(folder, again);
    EXPECT_FALSE(result.failed());
    EXPECT_NEAR(result.elapsed_s, 1.9, 1e-9);
    log::pocolog::Reader first(folder / "a.0.log"), second(folder / "b.0.log");
    ASSERT_EQ(second.samples().size(), 40u);
    for (size_t i = 0; i < 40; ++i) EXPECT_EQ(second.samples()[i].time, first.samples()[i].time);
    int count = 0;
    second.forEach<types::Sonar>("sonar.ping", [&](const types::Sonar& ping, const log::SampleRef& at) {
        EXPECT_EQ(ping.bins, std::vector<float>{static_cast<float>(count++)});
        EXPECT_EQ(at.received, ping.time) << "simulated time is the log's time";
    });
    second.forEach<types::Pose>(
        "vehicle.pose", [&](const types::Pose& pose, const log::SampleRef& at) { EXPECT_EQ(at.received, pose.time); });
}

TEST(ReplayDeploymentTest, OlderBeamsAndScansBecomePingsWithTheirNamesAndModels) {
    Folder folder;
    {
        log::pocolog::Writer log(folder / "a.0.log");
        types::SonarBeam beam;
        beam.time = {1'000'000};
        beam.bearing = {0.5};
        beam.sampling_interval = 1e-4;
        beam.speed_of_sound = 1500;
        beam.beam = {0, 255};
        types::SonarScan scan;
        scan.time = {1'000'000};
        scan.number_of_beams = 1;
        scan.number_of_bins = 2;
        scan.data = {0, 255};
        scan.start_bearing = {0.5};
        scan.angular_resolution = {0.25};
        scan.sampling_interval = 1e-4;
        scan.speed_of_sound = 1500;
        log.write(log.addStream<types::SonarBeam>("vehicle.pose", {{"rock_task_model", "old::Micron"}}), {1}, beam);
        log.write(log.addStream<types::SonarScan>("sonar.ping"), {1}, scan);
    }
    EXPECT_FALSE(runIn(folder, again).failed());
    log::pocolog::Reader log(folder / "b.0.log");
    for (const char* stream : {"vehicle.pose", "sonar.ping"})
        log.forEach<types::Sonar>(stream, [&](const types::Sonar& ping, const log::SampleRef&) {
            EXPECT_EQ(ping.bins, (std::vector<float>{0, 1})) << stream;
            EXPECT_EQ(ping.bearings.at(0).rad, 0.5);
        });
    EXPECT_EQ(log.samples().size(), 2u);
    EXPECT_EQ(log.find("vehicle.pose")->metadatum("rock_task_model"), "old::Micron");
    EXPECT_EQ(log.find("vehicle.pose")->metadatum("rock_task_name"), "vehicle");
    EXPECT_EQ(log.find("sonar.ping")->metadatum("rock_cxx_type_name"), "/base/samples/Sonar");
}

TEST(ReplayDeploymentTest, TwoReplaysGiveTheSameLogBitForBit) {
    Folder folder;
    writeLog(folder / "a.0.log");
    runIn(folder, again);
    const std::vector<char> first = toBytes(folder / "b.0.log");
    runIn(folder, again);
    EXPECT_EQ(toBytes(folder / "b.0.log"), first);
}

TEST(ReplayDeploymentTest, AMissingLogIsTheOnlyDiagnostic) {
    Folder folder;
    EXPECT_THAT(test::refused([&] { runIn(folder, again); }),
                testing::ElementsAre(testing::HasSubstr("a.0.log: cannot be read")))
        << "its streams are ports, so that connections cannot be made either";
}

/** A bag of another program: odometry and transforms of a body that moves to the east, stamped 30 ms before they
 *  arrived. */
test::Bag eastwards() {
    test::Bag bag;
    for (int i = 0; i < 10; ++i) {
        const ros::Time stamp{1'700'000'000 + i, 0};
        const types::Time received = ros::fromRos(stamp) + types::Time{30'000};
        ros::Odometry odometry;
        odometry.header = {stamp, "odom"};
        odometry.child_frame_id = "base_link";
        odometry.pose.pose.position.x = i;
        bag.add("/odom", received, odometry);
        ros::TransformStamped transform{{stamp, "odom"}, "base_link", {}};
        transform.transform.translation.x = 2 * i;
        bag.add("/tf", received, ros::TFMessage{{transform}});
    }
    return bag;
}

std::string posesFrom(const std::string& source) {
    return "tasks:\n  replay: {type: replay::ReplayTask, properties: {file: bag.mcap, poses: [{source: \"" + source +
           "\", stream: vehicle.pose}]}}\n  log: {type: logger::LoggerTask, properties: {file: b.0.log}}\n"
           "connections: [{from: replay.vehicle.pose, to: log.pose, policy: {type: buffer, size: 8}}]\n";
}

TEST(ReplayDeploymentTest, PosesOfAnotherProgramsBagAreAStreamOfTheDeployment) {
    const Folder folder;
    eastwards().writeMcap(folder / "bag.mcap");
    for (const auto& [source, factor] : {std::pair("/odom", 1.0), std::pair("odom->base_link", 2.0)}) {
        SCOPED_TRACE(source);
        EXPECT_FALSE(runIn(folder, posesFrom(source)).failed());
        log::pocolog::Reader logged(folder / "b.0.log");
        int i = 0;
        logged.forEach<types::Pose>("vehicle.pose", [&](const types::Pose& pose, const log::SampleRef& at) {
            EXPECT_EQ(pose.time, types::Time::fromSeconds(1'700'000'000 + i)) << "the stamp, not the arrival";
            EXPECT_EQ(at.time, pose.time);
            EXPECT_EQ(pose.position, glm::dvec3(0, -factor * i, 0)) << "east";
            EXPECT_EQ(pose.source_frame, "base_link");
            ++i;
        });
        EXPECT_EQ(i, 10);
    }
}

TEST(ReplayDeploymentTest, PosesOfASimulatorsClockRunOnThatClock) {
    test::Bag bag;
    for (int i = 0; i < 10; ++i) {
        const types::Time wall = types::Time::fromSeconds(1'700'000'000 + 0.1 * i);
        ros::Odometry odometry;
        odometry.header.stamp = {3 + i, 0};
        bag.add("/odom", wall, odometry);
        bag.add("/log", wall, ros::String{"ten times as fast"});
    }
    const Folder folder;
    bag.writeMcap(folder / "bag.mcap");
    const framework::RunResult result = runIn(folder, posesFrom("/odom"));
    EXPECT_NEAR(result.elapsed_s, 9, 1e-9);
    EXPECT_TRUE(result.warnings.empty());
    log::pocolog::Reader logged(folder / "b.0.log");
    EXPECT_EQ(logged.streams()[0].first, types::Time::fromSeconds(3));
    EXPECT_EQ(logged.streams()[0].last, types::Time::fromSeconds(12));
}

TEST(ReplayDeploymentTest, ASourceOfPosesThatCannotBeUsedIsReportedByCheck) {
    const Folder folder;
    eastwards().writeMcap(folder / "bag.mcap");
    for (const char* source : {"/odm", "odom->arm", "map->base_link"})
        EXPECT_THAT(test::computeError<types::ConfigError>([&] { runIn(folder, posesFrom(source)); }),
                    testing::HasSubstr("there are: /odom ("));
}

}  // namespace
}  // namespace insonify::replay
