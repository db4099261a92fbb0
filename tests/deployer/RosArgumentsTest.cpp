// `--ros-args` and the names of a fleet in runs of the command: effects, logs, errors.
#include <gmock/gmock.h>

#include "components/log/Reader.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Samples.hpp"
#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using insonify::log::openLog;
using testing::ElementsAre;
using testing::HasSubstr;
namespace ros = insonify::ros;

namespace {

/** Runs a deployment for two pings, logged as MCAP. */
struct RosArgumentsTest : testing::Test {
    Outcome run(std::vector<std::string> ros_args, const std::string& deployment = "wall.yml") {
        std::vector<std::string> words = {"run", deployment, "--out",           "out",       "--pings",
                                          "2",   "--set",    "log.file=x.mcap", "--ros-args"};
        words.insert(words.end(), ros_args.begin(), ros_args.end());
        return callInsonify(folder, words);
    }
    json info() { return makeJson(folder, {"log", "info", "out/x.mcap"}); }
    std::vector<std::string> topics() {
        const auto log = openLog(folder / "out/x.mcap");
        std::vector<std::string> all;
        for (const auto& stream : log->streams()) all.push_back(stream.topic);
        return all;
    }
    /** The first message of a stream. */
    template <class Message>
    Message first(const std::string& stream) {
        const auto log = openLog(folder / "out/x.mcap");
        std::optional<Message> found;
        log->forEachRef(stream, [&](const insonify::log::SampleRef& at) {
            if (!found) ros::decode(log->toBytes(at), found.emplace());
        });
        return found.value();
    }
    uint32_t beams() { return first<ros::ProjectedSonarImage>("sonar.ping").image.beam_count; }

    const WallFolder folder;
};

/** The wall in a namespace with a frame prefix. */
const std::string fleet = "namespace: auv1\nframe_prefix: auv1\n" + wall_deployment;

}  // namespace

TEST_F(RosArgumentsTest, ALogHasTheNamespaceAndFramePrefixOfRos) {
    writeFile(folder / "fleet.yml", fleet);
    ASSERT_THAT(run({}, "fleet.yml"), succeeds());
    EXPECT_THAT(topics(), ElementsAre("/auv1/sonar/ping", "/auv1/noise/noisy", "/auv1/vehicle/pose"));
    EXPECT_EQ(first<ros::ProjectedSonarImage>("sonar.ping").header.frame_id, "auv1/sonar");
    EXPECT_EQ(first<ros::Odometry>("vehicle.pose").child_frame_id, "auv1/body");
    EXPECT_EQ(first<ros::Odometry>("vehicle.pose").header.frame_id, "world") << "vehicles share the world's frame";
    ASSERT_EQ(run({"-r", "__ns:=/auv2", "-p", "frame_prefix:=auv2"}, "fleet.yml").code, 0);
    EXPECT_EQ(topics()[0], "/auv2/sonar/ping");
    EXPECT_EQ(first<ros::ProjectedSonarImage>("sonar.ping").header.frame_id, "auv2/sonar");
    ASSERT_EQ(callInsonify(folder, {"run", "fleet.yml", "--out", "out", "--pings", "2", "--set", "log.file=x.mcap",
                                    "--set", "namespace=/", "--set", "frame_prefix=null"})
                  .code,
              0);
    EXPECT_EQ(topics()[0], "/sonar/ping");
    EXPECT_EQ(first<ros::ProjectedSonarImage>("sonar.ping").header.frame_id, "sonar");
}

TEST_F(RosArgumentsTest, ReplaysALogInANamespace) {
    ASSERT_EQ(run({"-r", "__ns:=/auv2", "-p", "frame_prefix:=auv2"}).code, 0);
    EXPECT_THAT(callInsonify(folder, {"replay", "out/x.mcap", "wall.yml", "--rerender", "--score", "--out", "again"}),
                prints(HasSubstr("sonar.ping")));
}

TEST_F(RosArgumentsTest, WithoutNamesTheLogIsTheSameBitForBit) {
    ASSERT_EQ(folder.run().code, 0);
    const std::string before = readFile(folder / "out/wall.0.log");
    ASSERT_EQ(folder.run({"--pings", "2", "--ros-args"}).code, 0);
    EXPECT_EQ(readFile(folder / "out/wall.0.log"), before);
    EXPECT_GT(before.size(), 1000u);
}

TEST_F(RosArgumentsTest, ParametersAreProperties) {
    ASSERT_EQ(run({"-p", "sonar.beam_count:=8"}).code, 0);
    EXPECT_EQ(beams(), 8u);
    ASSERT_EQ(run({"--param", "sonar.beam_count:=8", "--", "--set", "sonar.bin_count=25"}).code, 0);
    EXPECT_EQ(beams(), 8u);
    EXPECT_EQ(first<ros::ProjectedSonarImage>("sonar.ping").ranges.size(), 25u);
    ASSERT_EQ(
        run({"-p", "sonar.quality:={rows: 16}", "-p", "use_sim_time:=true", "-r", "/a:=/b", "-r", "__node:=x"}).code,
        0);
}

TEST_F(RosArgumentsTest, ParameterFilesApplyToTheNodesThatTheyName) {
    const auto holds = [&](const std::string& node, std::vector<std::string> more = {}) {
        writeFile(folder / "p.yaml", node +
                                         ":\n  ros__parameters:\n    use_sim_time: false\n    sonar: {beam_count: 8}\n"
                                         "    sonar.bin_count: 25\n");
        more.insert(more.end(), {"--params-file", "p.yaml"});
        const Outcome outcome = run(more);
        if (outcome.code == 0) {
            EXPECT_EQ(beams(), 8u);
            return true;
        }
        EXPECT_THAT(outcome.err, HasSubstr("p.yaml: is of no node of the deployment, but of "));
        return false;
    };
    EXPECT_TRUE(holds("/**"));
    EXPECT_FALSE(holds("/other"));
    ASSERT_EQ(run({"--params-file", "p.yaml", "-p", "sonar.beam_count:=4"}).code, 2);
    writeFile(folder / "p.yaml", "/**: {ros__parameters: {sonar: {beam_count: 8}}}\n");
    ASSERT_EQ(run({"--params-file", "p.yaml", "-p", "sonar.beam_count:=4"}).code, 0);
    EXPECT_EQ(beams(), 4u) << "the last one applies";
    ASSERT_EQ(run({"-p", "sonar.beam_count:=4", "--params-file", "p.yaml"}).code, 0);
    EXPECT_EQ(beams(), 8u) << "the last one applies";
}

TEST_F(RosArgumentsTest, WrongArgumentsAreOneErrorEach) {
    writeFile(folder / "list.yaml", "[1, 2]\n");
    writeFile(folder / "broken.yaml", "/**: [\n");
    writeFile(folder / "task.yaml", "/**:\n  ros__parameters:\n    sonr: {range: 3}\n");
    writeFile(folder / "value.yaml", "/**:\n  ros__parameters:\n    sonar:\n      range: -3\n");
    writeFile(folder / "key.yaml", "/**:\n  ros__parameters:\n    sonar:\n      rang: 3\n");
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{"a:=b"}, "--ros-args: is a:=b; may be -r FROM:=TO, -p TASK.PROPERTY:=VALUE, --params-file FILE"},
        {{"--log-level", "info"}, "--ros-args: is --log-level; may be"},
        {{"-r"}, "--ros-args: -r has no value"},
        {{"-r", "a=b"}, "--ros-args: -r a=b: must be NAME:=VALUE or NODE:NAME:=VALUE"},
        {{"-r", ":=b"}, "must be NAME:=VALUE"},
        {{"-r", "a:="}, "must be NAME:=VALUE"},
        {{"-r", ":a:=b"}, "must be NAME:=VALUE"},
        {{"-r", ""}, "must be NAME:=VALUE"},
        {{""}, "--ros-args: is ''; may be"},
        {{"-r", "/a b:=/c"}, "/a b is no topic; must be words of letters, digits and _"},
        {{"-r", "/a:=/1c"}, "/1c is no topic"},
        {{"-r", "__ns:=1a"}, "--ros-args: -r __ns: is 1a; must be words of letters"},
        {{"-r", "x:__ns:=/a"}, "is for one node; the namespace is that of all"},
        {{"-r", "__node:=/a"}, "-r __node: is /a; must be a word"},
        {{"-r", "x:__node:=a"}, "there is no such node; the deployment has no node"},
        {{"-p", "sonar.range"}, "-p sonar.range: must be NAME:=VALUE"},
        {{"-p", "sonar.range:=-3"}, "--ros-args: -p sonar.range: is -3 m; may be"},
        {{"-p", "sonar.range:=[1"}, "-p sonar.range:=[1: is not YAML"},
        {{"-p", "sonr.range:=3"}, "--ros-args: -p sonr.range: there is no task sonr; did you mean sonar?"},
        {{"-p", "range:=3"}, "--ros-args: -p range: must be task.property"},
        {{"-p", "x:sonar.range:=3"}, "there is no node x; the deployment has no node"},
        {{"-p", "frame_prefix:=a b"}, "--ros-args: -p frame_prefix: is a b; must be words"},
        {{"--params-file", "nowhere.yaml"}, "nowhere.yaml"},
        {{"--params-file", "list.yaml"}, "list.yaml: must be a block of nodes"},
        {{"--params-file", "broken.yaml"}, "broken.yaml:"},
        {{"--params-file", "task.yaml"}, "task.yaml:3:12: sonr.range: there is no task sonr"},
        {{"--params-file", "value.yaml"}, "value.yaml:4:14: sonar.range: is -3 m; may be"},
        {{"--params-file", "key.yaml"}, "key.yaml:4:7: sonar.rang: is not a key here; did you mean range?"}};
    for (const auto& [words, message] : wrong) {
        const Outcome outcome = run(words);
        EXPECT_THAT(outcome, isRefused(HasSubstr(message))) << message;
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
        EXPECT_EQ(outcome.out, "");
    }
    EXPECT_EQ(callInsonify(folder, {"check", "wall.yml", "--ros-args", "-r", "a:=b"}).code, 2);
}

TEST_F(RosArgumentsTest, ReportsWrongNamesInADeploymentWithTheirPlace) {
    writeFile(folder / "fleet.yml", "namespace: 1auv\nframe_prefix: /auv\n" + wall_deployment);
    const Outcome outcome = callInsonify(folder, {"check", "fleet.yml"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(
        outcome.err,
        "fleet.yml:1:12: namespace: is 1auv; must be words of letters, digits and _, none beginning with a digit, "
        "as auv1\n"
        "fleet.yml:2:15: frame_prefix: is /auv; must be words of letters, digits and _ without a leading slash, as "
        "auv1\n");
}
