#include <gmock/gmock.h>

#include "components/ros/Stamps.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Bag.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;

namespace {

/** Odometry, and transforms if wanted, of a body that comes 1 m nearer to the wall in each second, from 10 m. */
insonify::test::Bag approach(bool with_transforms) {
    insonify::test::Bag bag;
    for (int i = 0; i < 5; ++i) {
        const insonify::ros::Time stamp{1'700'000'000 + i, 0};
        insonify::ros::Odometry odometry;
        odometry.header = {stamp, "odom"};
        odometry.child_frame_id = "base_link";
        odometry.pose.pose.position.y = i;
        odometry.pose.pose.orientation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // bow to the north
        const insonify::types::Time received = insonify::ros::fromRos(stamp) + insonify::types::Time{20'000};
        bag.add("/odom", received, odometry);
        if (!with_transforms) continue;
        insonify::ros::TransformStamped transform{{stamp, "odom"}, "base_link", {}};
        transform.transform.translation.y = i;
        transform.transform.rotation = odometry.pose.pose.orientation;
        bag.add("/tf", received, insonify::ros::TFMessage{{transform}});
    }
    return bag;
}

/** Returns the range of the strongest bin of the middle beam of each ping [m]. */
std::string wallRanges(const TestFolder& folder, const std::string& log) {
    callInsonify(folder, {"log", "export", log, "--stream", "sonar.ping", "--to", "pings.npz"});
    return python(folder,
                  "import numpy\na = numpy.load('pings.npz')\nprint([round(float(r)) for r in "
                  "a['range_m'].ravel()[a['bins'][:, 8].argmax(1)]])")
        .out;
}

json getInfo(const TestFolder& folder, const std::string& log) {
    return json::parse(callInsonify(folder, {"log", "info", log, "--json"}).out);
}

}  // namespace

TEST(ReplayCommandTest, AStreamReplacesItsPortAndItsTaskIsNotStarted) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "3"}).code, 0);
    ASSERT_THAT(
        callInsonify(folder, {"replay", "out/wall.0.log", "wall.yml", "--out", "again", "--summary", "summary.json"}),
        succeeds());
    const json tasks = json::parse(readFile(folder / "summary.json"))["tasks"];
    for (const char* replaced_task : {"vehicle", "sonar", "noise"}) EXPECT_FALSE(tasks.contains(replaced_task));
    EXPECT_TRUE(tasks.contains("log"));
    for (const json& stream : getInfo(folder, "again/wall.0.log")["streams"]) EXPECT_EQ(stream["count"], 3) << stream;
}

TEST(ReplayCommandTest, LoggedPosesGiveTheSamePings) {
    const std::string pose_only = replaced(
        replaced(wall_deployment, "  - {from: sonar.ping, to: log.clean, policy: {type: buffer, size: 64}}\n", ""),
        "  - {from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}\n", "");
    const WallFolder folder(pose_only);
    ASSERT_EQ(folder.run({"--pings", "3"}).code, 0);
    writeFile(folder / "full.yml", wall_deployment);
    ASSERT_EQ(callInsonify(folder, {"run", "full.yml", "--pings", "3", "--out", "direct"}).code, 0);
    ASSERT_THAT(callInsonify(folder, {"replay", "out/wall.0.log", "full.yml", "--out", "again"}), succeeds());
    for (const char* run : {"direct", "again"})
        ASSERT_EQ(callInsonify(folder, {"log", "export", std::string(run) + "/wall.0.log", "--stream", "noise.noisy",
                                        "--to", std::string(run) + ".npz"})
                      .code,
                  0);
    EXPECT_EQ(python(folder,
                     "import numpy\na, b = numpy.load('direct.npz'), numpy.load('again.npz')\n"
                     "print(all((a[k] == b[k]).all() for k in a))")
                  .out,
              "True\n");
}

TEST(ReplayCommandTest, TheOnlyPosesOfAForeignBagDriveTheSonar) {
    const WallFolder folder;
    approach(false).writeMcap(folder / "bag.mcap");
    ASSERT_EQ(approach(false).writeDb3(folder / "bag.db3"), "");
    for (const std::string bag : {"bag.mcap", "bag.db3"}) {
        const Outcome outcome = callInsonify(folder, {"replay", bag, "wall.yml", "--out", "again"});
        ASSERT_THAT(outcome, succeeds());
        EXPECT_THAT(
            outcome.err,
            HasSubstr("notice: the poses are those of /odom (nav_msgs/msg/Odometry, odom -> base_link, 5 in 4 s)"));
        EXPECT_EQ(wallRanges(folder, "again/wall.0.log"), "[10, 9, 8, 7, 6]\n") << bag;
    }
}

TEST(ReplayCommandTest, APoseThatCannotBeDecodedIsOmittedAndTheOthersDriveTheSonar) {
    const WallFolder folder;
    insonify::test::Bag bag = approach(false);
    bag.cut(2, 40);
    bag.writeMcap(folder / "bag.mcap");
    const Outcome outcome = callInsonify(folder, {"replay", "bag.mcap", "wall.yml", "--out", "again"});
    ASSERT_THAT(outcome, succeeds());
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("messages of /odom are omitted: 1, "), HasSubstr("cannot be decoded")));
    EXPECT_EQ(wallRanges(folder, "again/wall.0.log"), "[10, 9, 7, 6]\n");
    const Outcome exported =
        callInsonify(folder, {"log", "export", "bag.mcap", "--stream", "/odom", "--to", "again/poses.csv"});
    ASSERT_THAT(exported, succeeds());
    EXPECT_THAT(exported.err, AllOf(HasSubstr("lost: "), HasSubstr("cannot be decoded")));
    EXPECT_EQ(std::ranges::count(readFile(folder / "again/poses.csv"), '\n'), 1 + 4);
    for (size_t i = 0; i < 5; ++i) bag.cut(i, 40);
    bag.writeMcap(folder / "all.mcap");
    EXPECT_THAT(callInsonify(folder, {"replay", "all.mcap", "wall.yml", "--out", "none"}),
                isRefused(HasSubstr("the message ends within")));
}

TEST(ReplayCommandTest, OneOfSeveralSourcesOfPosesIsChosen) {
    const WallFolder folder;
    approach(true).writeMcap(folder / "bag.mcap");
    EXPECT_THAT(
        callInsonify(folder, {"replay", "bag.mcap", "wall.yml", "--out", "again"}),
        isRefused(AllOf(HasSubstr("bag.mcap: --pose: is missing"), HasSubstr("--pose '/odom' (nav_msgs/msg/Odometry"),
                        HasSubstr("--pose 'odom->base_link' (tf2_msgs/msg/TFMessage, 5 in 4 s)"))));
    for (const char* source : {"/odom", "odom->base_link", "odom=vehicle.pose"}) {
        ASSERT_THAT(
            callInsonify(folder, {"replay", "bag.mcap", "wall.yml", "--rerender", "--pose", source, "--out", "again"}),
            succeeds());
        EXPECT_EQ(wallRanges(folder, "again/wall.0.log"), "[10, 9, 8, 7, 6]\n") << source;
    }
    const auto refusal = [&](const std::string& pose) {
        return callInsonify(folder, {"replay", "bag.mcap", "wall.yml", "--pose", pose, "--out", "again"});
    };
    EXPECT_THAT(refusal("/odm"), isRefused(HasSubstr("did you mean /odom? there are: /odom (")));
    EXPECT_THAT(refusal("/odom=diver.pose"),
                isRefused(HasSubstr("the deployment takes poses from vehicle.pose: give --pose SOURCE=vehicle.pose")));
}

TEST(ReplayCommandTest, WithoutADeploymentTheSourcesOfPosesAreListed) {
    const WallFolder folder;
    approach(true).writeMcap(folder / "bag.mcap");
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"replay", "bag.mcap"}, {"log", "info", "bag.mcap"}})
        EXPECT_THAT(
            callInsonify(folder, command),
            prints(AllOf(testing::ContainsRegex("/odom +nav_msgs/msg/Odometry +odom -> base_link +5 "),
                         testing::ContainsRegex("odom->base_link +tf2_msgs/msg/TFMessage +odom -> base_link +5 "))));
    const json poses = getInfo(folder, "bag.mcap")["poses"];
    ASSERT_EQ(poses.size(), 2u);
    EXPECT_EQ(poses[1]["source"], "odom->base_link");
    ASSERT_EQ(folder.run().code, 0);
    EXPECT_THAT(callInsonify(folder, {"log", "info", "out/wall.0.log"}).out,
                testing::Not(HasSubstr("could be the poses")));
}

TEST(ReplayCommandTest, StreamsThatMatchNothingAreListed) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "2"}).code, 0);
    std::string other = replaced(wall_deployment, "  noise:\n", "  speckle:\n");
    for (int i = 0; i < 2; ++i)
        other = replaced(other, i ? "from: noise.noisy" : "to: noise.clean",
                         i ? "from: speckle.noisy" : "to: speckle.clean");
    writeFile(folder / "other.yml", other);
    const Outcome outcome = callInsonify(folder, {"replay", "out/wall.0.log", "other.yml", "--out", "again"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("noise.noisy"));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("vehicle.pose")));
}

TEST(ReplayCommandTest, ALogThatMatchesNothingIsRefused) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "2"}).code, 0);
    std::string other = wall_deployment;
    for (const char* name : {"vehicle", "sonar", "noise"})
        for (const auto& [before, after] : {std::pair{"  ", ":\n"}, {"from: ", "."}, {"to: ", "."}})
            for (const std::string key = before + std::string(name) + after; other.find(key) != std::string::npos;)
                other = replaced(other, key, before + std::string("my_") + name + after);
    writeFile(folder / "other.yml", other);
    const Outcome outcome = callInsonify(folder, {"replay", "out/wall.0.log", "other.yml", "--out", "again"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "again"));
}

TEST(ReplayCommandTest, ATruncatedLogIsReplayedUpToItsLastCompleteBlock) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "3"}).code, 0);
    fs::resize_file(folder / "out/wall.0.log", fs::file_size(folder / "out/wall.0.log") - 5);
    EXPECT_THAT(callInsonify(folder, {"replay", "out/wall.0.log", "wall.yml", "--out", "again"}), succeeds());
    EXPECT_TRUE(getInfo(folder, "again/wall.0.log")["complete"]);
}

TEST(ReplayCommandTest, ALogThatEndsBeforeItsFirstSampleIsRefused) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "2"}).code, 0);
    const std::string whole = readFile(folder / "out/wall.0.log");
    int without = 0;
    for (size_t part = 1; part <= 12; ++part) {
        writeFile(folder / "out/wall.0.log", whole.substr(0, whole.size() * part / 12));
        for (const bool rerender : {false, true}) {
            std::vector<std::string> words = {"replay", "out/wall.0.log", "wall.yml", "--out", "again"};
            if (rerender) words.push_back("--rerender");
            const auto result = callInsonify(folder, words);
            EXPECT_THAT(result.code, testing::AnyOf(0, 2)) << part << result.err;
            if (result.err.find("holds no sample; there is nothing to replay") != std::string::npos) ++without;
        }
        const auto picture = callInsonify(
            folder, {"log", "export", "out/wall.0.log", "--stream", "sonar.ping", "--to", "again/fan.png"});
        EXPECT_EQ(picture.code == 0, picture.out.find("fan") != std::string::npos) << part << picture.err;
    }
    EXPECT_GE(without, 2) << "some cuts are before the first sample";
}

TEST(ReplayCommandTest, ALogIsNotReplacedByItsReplay) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "3"}).code, 0);
    const std::string before = readFile(folder / "out/wall.0.log");
    const Outcome same = callInsonify(folder, {"replay", "out/wall.0.log", "wall.yml", "--out", "out"});
    EXPECT_EQ(same.code, 2);
    EXPECT_THAT(same.err, HasSubstr("out: --out: is the folder of the log"));
    writeFile(folder / "inside.yml", R"(schedule: lockstep
tasks:
  replay: {type: replay::ReplayTask, properties: {file: out/wall.0.log}}
  log: {type: logger::LoggerTask, properties: {file: wall.0.log}}
connections: [{from: replay.noise.noisy, to: log.noisy}]
)");
    const Outcome inside = callInsonify(folder, {"run", "inside.yml", "--out", "out"});
    EXPECT_NE(inside.code, 0);
    EXPECT_THAT(inside.err, HasSubstr("the log cannot be written: it is the log that is read"));
    EXPECT_EQ(readFile(folder / "out/wall.0.log"), before);
    for (const char* option : {"--summary", "--health"})
        EXPECT_THAT(folder.run({option, "wall.yml"}),
                    isRefused(HasSubstr(option + std::string(": is the deployment itself"))));
}

TEST(ReplayCommandTest, ATaskOfAnotherTypeThanInTheLogIsRefused) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "2"}).code, 0);
    std::string other = replaced(wall_deployment, "sonar::SonarTask", "sonar::ScanningSonarTask");
    for (const char* line : {"      beam_count: 16\n", "      field_of_view_deg: 60\n"})
        other = replaced(other, line, "");
    writeFile(folder / "other.yml", other);
    const Outcome outcome =
        callInsonify(folder, {"replay", "out/wall.0.log", "other.yml", "--rerender", "--out", "again"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, testing::StartsWith("out/wall.0.log: sonar: is a sonar::SonarTask in the log and a "
                                                 "sonar::ScanningSonarTask in "));
}
