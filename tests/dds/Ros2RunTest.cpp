// deploy/ros2_fls.yml, deploy/ros2_tf.yml and the errors of faulty deployments, as a user sees them.
#include <gmock/gmock.h>

#include <random>
#include <set>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Node.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/NodeMessages.hpp"
#include "components/ros/Samples.hpp"
#include "components/ros/Schema.hpp"
#include "tests/dds/Loopback.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::dds;
using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

struct Ros2RunTest : Loopback {
    TestFolder folder;
    const std::string fls = test::sourceFile("deploy/ros2_fls.yml");
    const std::string tf = test::sourceFile("deploy/ros2_tf.yml");

    /** Returns the commands that a launch file would run, with its arguments: "one_vehicle.launch.py
     *  deployment:=x.yml". */
    std::vector<std::vector<std::string>> launched(const std::string& words) {
        const std::string script = test::sourceFile("tests/dds/launch_commands.py ") + folder.path().string() + " ";
        const std::string answer =
            pythonSays(script + test::sourceFile("ros2/insonify_bringup/launch/" + words), folder / "answer");
        auto commands = json::parse(answer, nullptr, false);
        EXPECT_FALSE(commands.is_discarded()) << answer;
        if (commands.is_discarded()) return {};
        return commands.get<std::vector<std::vector<std::string>>>();
    }
    /** Returns the first message that arrives on a topic. */
    template <class Message>
    Message received(const std::string& topic) {
        Node node(domainId({}), "listener", 16);
        Reader reader(node, ddsTopic(topic), Message::type_name, "", {}, {});
        Bytes bytes;
        uint64_t sender = 0;
        Message message;
        const bool came = becomesTrue([&] { return reader.take(bytes, sender); });
        EXPECT_TRUE(came) << topic;
        if (came) ros::decode(std::span<const char>(bytes), message);
        return message;
    }
    Outcome check(const std::string& yaml) {
        writeFile(folder / "x.yml", yaml);
        return callInsonify(folder, {"check", "x.yml"});
    }
};

/** Setting of the harbour's task, so that a stalled machine does not count as a lost vehicle. */
const std::string patience = "scene.pose_timeout=60";

/** A vehicle that sends its pose twenty times a second. */
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
    const bool received = becomesTrue([&] { return reader.take(bytes, sender); });
    for (const Process* process : {&poses, &sonar})
        if (!received) process->signal(SIGKILL);
    ASSERT_TRUE(received);
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

TEST_F(Ros2RunTest, ReportsDroppedPosesAtOnceAndAtTheEnd) {
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

TEST_F(Ros2RunTest, ReportsThatItWaitsForPoses) {
    Process waiting(insonifyWords({"run", fls, "--out", "out"}), folder.path());
    EXPECT_TRUE(becomesTrue([&] {
        return readFile(folder / "stderr.txt").find("warning: scene: scene.pose: waits for the first pose") !=
               std::string::npos;
    })) << readFile(folder / "stderr.txt");
    waiting.signal(SIGINT);
    EXPECT_THAT(waiting.wait(), succeeds());
}

TEST_F(Ros2RunTest, TransformsOfAPeerBecomePings) {
    if (!Peer::available())
        GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    const Process sonar(
        insonifyWords({"run", tf, "--out", "out", "--pings", "10", "--summary", "summary.json", "--set", patience}),
        folder.path());
    const Peer peer("transforms 0.5");
    if (!becomesTrue([&] { return fs::exists(folder / "summary.json"); })) sonar.signal(SIGKILL);
    ASSERT_THAT(sonar.wait(), succeeds());
    EXPECT_GE(json::parse(readFile(folder / "summary.json"))["pings"], 10);
}

TEST_F(Ros2RunTest, TheDeploymentsAreValid) {
    for (const std::string& deployment : {fls, tf}) EXPECT_EQ(callInsonify(folder, {"check", deployment}).code, 0);
}

TEST_F(Ros2RunTest, ReportsDiagnosticsWithTheirPlace) {
    Outcome outcome = check(replaced(vehicle, "type: nav_msgs/Odometry", "type: nav_msgs/Odometri"));
    EXPECT_THAT(outcome, isRefused(AllOf(HasSubstr("x.yml:4:"),
                                         HasSubstr("tasks.ros.properties.topics[0].type: is nav_msgs/Odometri"))));
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

TEST_F(Ros2RunTest, RefusesToReadPosesInLockstep) {
    EXPECT_THAT(
        check(replaced(replaced(readFile(fls), "realtime", "lockstep"), "scenes/", test::sourceFile("deploy/scenes/"))),
        isRefused(HasSubstr("tasks.poses.properties: messages arrive by the wall clock")));
}

TEST_F(Ros2RunTest, ReportsOneErrorForADomainThatCannotBeJoined) {
    writeFile(folder / "x.yml", vehicle);
    setenv("CYCLONEDDS_URI",
           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface "
           "name=\"nothere0\"/></Interfaces></General></Domain></CycloneDDS>",
           1);
    const Outcome outcome = callInsonify(folder, {"run", "x.yml", "--out", "out"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("cannot be joined")));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
}

TEST_F(Ros2RunTest, VehiclesOfALaunchFileHaveSeparateTopicsAndFrames) {
    const auto commands = launched("two_vehicles.launch.py auv1:=" + fls);
    ASSERT_EQ(commands.size(), 2u);
    std::vector<TestFolder> folders(4);
    std::vector<Process> running;
    for (size_t i = 0; i < 2; ++i) {
        const std::string name = "/auv" + std::to_string(i + 1);
        writeFile(folders[2 * i] / "vehicle.yml", vehicle);
        running.emplace_back(insonifyWords({"run", "vehicle.yml", "--out", "out", "--ros-args", "-r",
                                            "/auv/odometry:=" + name + "/odometry"}),
                             folders[2 * i].path());
        std::vector<std::string> words(commands[i].begin() + 1, commands[i].end());
        ASSERT_EQ(commands[i][0], "insonify");
        words.insert(words.begin() + 1, {"--set", patience});
        running.emplace_back(insonifyWords(words), folders[2 * i + 1].path());
    }
    for (const std::string name : {"auv1", "auv2"}) {
        EXPECT_EQ(received<ros::ProjectedSonarImage>("/" + name + "/sonar").header.frame_id, name + "/sonar_z_forward");
        EXPECT_EQ(received<ros::LaserScan>("/" + name + "/sonar/scan").header.frame_id, name + "/sonar");
    }
    received<ros::Clock>("/clock");
    received<ros::Clock>("/auv2/clock");
    for (const Process& process : running) process.signal(SIGINT);
    for (const Process& process : running) {
        EXPECT_THAT(process.wait(), succeeds());
    }
}

TEST_F(Ros2RunTest, ALaunchFileReplaysALogToTheTopics) {
    writeFile(folder / "record.yml",
              "tasks:\n"
              "  poses: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {file: " +
                  test::sourceFile("deploy/scenes/harbour_pass.csv") +
                  "}}\n"
                  "  scene: {type: scene::SceneTask, properties: {file: " +
                  test::sourceFile("deploy/scenes/harbour.glb") +
                  "}}\n"
                  "  receiver: {type: sonar::SonarTask, properties: {range: 20, beam_count: 16, bin_count: 50, "
                  "quality: {rows: 16}}}\n"
                  "  log: {type: logger::LoggerTask, properties: {file: x.0.log}}\n"
                  "connections:\n"
                  "  - {from: poses.pose, to: scene.pose}\n"
                  "  - {from: scene.snapshot, to: receiver.snapshot}\n"
                  "  - {from: poses.pose, to: log.pose, policy: {type: buffer, size: 8}}\n"
                  "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 8}}\n");
    ASSERT_THAT(callInsonify(folder, {"run", "record.yml", "--out", "out", "--pings", "100"}), succeeds());
    auto commands = launched("replay.launch.py log:=out/x.0.log deployment:=" + fls + " namespace:=auv3");
    ASSERT_EQ(commands.size(), 1u);
    commands[0].erase(commands[0].begin());
    const Process replay(insonifyWords(commands[0]), folder.path());
    const auto image = received<ros::ProjectedSonarImage>("/auv3/sonar");
    EXPECT_EQ(image.image.beam_count, 16u);
    replay.signal(SIGINT);
    EXPECT_THAT(replay.wait(), succeeds());
}

TEST_F(Ros2RunTest, NamesNodesByTheArguments) {
    const Process sonar(insonifyWords({"run", fls, "--out", "out", "--ros-args", "-r", "__ns:=/auv7", "-r", "__node:=x",
                                       "-r", "odometry:=/pose"}),
                        folder.path());
    using Info = ParticipantEntitiesInfo<16>;
    Node node(domainId({}), "listener", 16);
    Reader reader(node, "ros_discovery_info", Info::type_name, "",
                  {.reliability = Reliability::Reliable, .depth = 100, .transient_local = true}, {});
    std::set<std::string> names;
    Bytes bytes;
    uint64_t sender = 0;
    EXPECT_TRUE(becomesTrue([&] {
        Info info;
        while (reader.take(bytes, sender)) {
            ros::decode(std::span<const char>(bytes), info);
            for (const auto& each : info.node_entities_info_seq)
                names.insert(each.node_namespace + "/" + each.node_name);
        }
        return names.contains("/auv7/x") && names.contains("/auv7/x_poses");
    })) << testing::PrintToString(names);
    EXPECT_TRUE(says(folder, "/pose")) << "it waits for poses there";
    sonar.signal(SIGINT);
    EXPECT_EQ(sonar.wait().code, 0);
}

TEST_F(Ros2RunTest, AppliesParameterFilesToTheNodesThatTheyName) {
    const auto errorWith = [&](const std::string& node) {
        writeFile(folder / "p.yaml", node + ":\n  ros__parameters: {sonar: {range: -1}}\n");
        const Outcome outcome = callInsonify(folder, {"run", fls, "--ros-args", "--params-file", "p.yaml"});
        EXPECT_EQ(outcome.code, 2);
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
        return outcome.err;
    };
    for (const char* fits : {"/**", "/auv/insonify", "/auv/insonify_poses", "/auv/*", "/auv/**", "/*/insonify",
                             "/**/insonify", "auv/insonify"})
        EXPECT_THAT(errorWith(fits), HasSubstr("p.yaml:2:36: sonar.range: is -1 m")) << fits;
    for (const char* other : {"/*", "/insonify", "insonify", "/auv2/*", "/auv/insonify/x", "/auv/insonif", "/*/*/*"})
        EXPECT_THAT(errorWith(other),
                    HasSubstr("p.yaml: is of no node of the deployment, but of " + std::string(other) +
                              "; nodes: /auv/insonify_poses, /auv/insonify; /** fits all"));
    writeFile(folder / "p.yaml", "/auv:\n  insonify:\n    ros__parameters: {sonar: {range: -1}}\n");
    EXPECT_THAT(callInsonify(folder, {"run", fls, "--ros-args", "--params-file", "p.yaml"}).err,
                HasSubstr("p.yaml:3:38: sonar.range: is -1 m"));
    for (const auto& [words, message] :
         {std::pair("-p insonify:sonar.range:=-1", "-p sonar.range: is -1 m"),
          std::pair("-p other:sonar.range:=-1", "there is no node other; nodes: /auv/insonify_poses, /auv/insonify"),
          std::pair("-r other:__node:=x", "there is no such node; nodes: /auv/insonify_poses, /auv/insonify")}) {
        const std::string both = words;
        const size_t space = both.find(' ');
        EXPECT_THAT(callInsonify(folder, {"run", fls, "--ros-args", both.substr(0, space), both.substr(space + 1)}),
                    isRefused(HasSubstr(message)));
    }
}

TEST_F(Ros2RunTest, ParametersAndRvizOfTheBringupFitTheExample) {
    const auto commands = launched("one_vehicle.launch.py rviz:=true deployment:=" + fls);
    ASSERT_EQ(commands.size(), 2u);
    std::vector<std::string> words(commands[0].begin() + 1, commands[0].end());
    words.insert(words.begin() + 1, {"--out", "out", "--duration", "0.1"});
    EXPECT_THAT(callInsonify(folder, words), succeeds());
    const std::string rviz = readFile(test::sourceFile("ros2/insonify_bringup/config/insonify.rviz"));
    const std::string deployment = readFile(fls);
    EXPECT_THAT(deployment, HasSubstr("namespace: auv "));
    for (const char* topic : {"odometry", "sonar/scan", "sonar/image"}) {
        EXPECT_THAT(rviz, HasSubstr("Value: /auv/" + std::string(topic) + ","));
        EXPECT_THAT(deployment, HasSubstr("topic: " + std::string(topic) + ","));
        EXPECT_THAT(commands[1], testing::Contains("/auv/" + std::string(topic) + ":=" + topic));
    }
}

namespace {

/** A sonar of the harbour, and a publisher with more properties. */
std::string servingNode(const std::string& properties) {
    return "schedule: realtime\nnamespace: auv\ntasks:\n"
           "  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {loop: true, file: " +
           test::sourceFile("deploy/scenes/harbour_pass.csv") + "}}\n" +
           "  scene: {type: scene::SceneTask, properties: {pose_timeout: 60, file: " +
           test::sourceFile("deploy/scenes/harbour.glb") + "}}\n" +
           "  sonar: {type: sonar::SonarTask, properties: {range: 20, range_min: 0, beam_count: 16, bin_count: 50, "
           "quality: {rows: 16}}}\n"
           "  ros: {type: dds::PublisherTask, properties: {" +
           properties +
           ", topics: [{port: ping, topic: ~/sonar, type: sensor_msgs/PointCloud2}]}}\n"
           "connections:\n"
           "  - {from: vehicle.pose, to: scene.pose}\n"
           "  - {from: scene.snapshot, to: sonar.snapshot}\n"
           "  - {from: sonar.ping, to: ros.ping}\n";
}

/** Sends requests of random bytes to a service. */
void sendNonsense(const std::string& service, const std::string& type) {
    Node node(domainId({}), "stranger", 16);
    Writer writer(node, "rq/auv/ros/" + service + "Request", type + "_Request", "", {});
    EXPECT_TRUE(becomesTrue([&] { return writer.hasReaders(); })) << service;
    std::mt19937 random(1);
    for (size_t size = 4; size < 200; ++size) {
        Bytes bytes{0, 1, 0, 0};
        while (bytes.size() < size) bytes.push_back(static_cast<char>(random() % 4 == 0 ? random() % 256 : 0));
        writer.write(bytes);
    }
}

/** Expects that both ends of a service announce their type, its hash, and the same identity. */
template <class Request, class Response>
void expectAnnounced(const json& found, const ros::Service<Request, Response>& service) {
    const std::string name = std::string("/auv/ros/") + service.name;
    const json &asked = found["rq" + name + "Request"], &said = found["rr" + name + "Reply"];
    ASSERT_TRUE(asked.is_array() && said.is_array()) << name << found;
    EXPECT_EQ(asked[0], ddsType(Request::type_name));
    EXPECT_EQ(said[0], ddsType(Response::type_name));
    const auto id = [](const json& end) {
        const std::string text = end[1];
        EXPECT_TRUE(text.starts_with("serviceid=")) << text;
        return text.substr(0, text.find(';') + 1);
    };
    EXPECT_EQ(asked[1], id(asked) + "typehash=" + ros::typeHash<Request>() + ";");
    EXPECT_EQ(said[1], id(asked) + "typehash=" + ros::typeHash<Response>() + ";");
}

void expectDescribed(const json& found) {
    EXPECT_EQ(found["list"][1], json({"sonar"}));
    for (const std::string name : found["list"][0]) EXPECT_TRUE(name.starts_with("sonar.")) << name;
    EXPECT_THAT(found["list"][0].get<std::vector<std::string>>(),
                testing::IsSupersetOf({"sonar.range", "sonar.quality"}));
    EXPECT_EQ(found["types"][0], json({3}));
    const json& range = found["descriptors"][0][0];
    EXPECT_EQ(range["name"], "sonar.range");
    EXPECT_EQ(range["type"], 3);
    EXPECT_THAT(range["description"].get<std::string>(), HasSubstr("[m]"));
    EXPECT_FALSE(range["read_only"]);
    EXPECT_LT(range["floating_point_range"][0]["from_value"], range["floating_point_range"][0]["to_value"]);
    EXPECT_EQ(found["descriptors"][0][1]["type"], 0);
    EXPECT_EQ(found["descriptors"][0][2]["type"], 1);
    EXPECT_TRUE(found["descriptors"][0][2]["read_only"]);
}

}  // namespace

TEST_F(Ros2RunTest, AClientThatWaitsForAllSixServicesHasTheParameters) {
    if (!Peer::available())
        GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    writeFile(folder / "x.yml", servingNode("parameter_services: true"));
    const Process run(insonifyWords({"run", "x.yml", "--out", "out"}), folder.path());
    for (const auto& [service, type] :
         {std::pair("set_parameters", "rcl_interfaces/srv/SetParameters"),
          std::pair("set_parameters_atomically", "rcl_interfaces/srv/SetParametersAtomically")})
        sendNonsense(service, type);  // gets no response and stops nothing
    Peer peer("parameters /auv/ros sonar.range 15 sonar.range_min vehicle.file");
    const json found = peer.result();
    run.signal(SIGINT);
    EXPECT_THAT(run.wait(), succeeds());
    ASSERT_FALSE(found.is_null());
    expectDescribed(found);
    EXPECT_EQ(found["before"][0]["double_value"], 20);
    EXPECT_EQ(found["before"][3]["type"], 0);
    EXPECT_EQ(found["results"][0][0], json({{"successful", true}, {"reason", ""}}));
    EXPECT_THAT(found["results"][0][1]["reason"].get<std::string>(), HasSubstr("must be a finite number"));
    EXPECT_EQ(found["results"][0][2],
              json({{"successful", false}, {"reason", "nobody.at_home: is not a property of any task"}}));
    EXPECT_EQ(found["after"][0]["double_value"], 15);
    const char* const reasons[] = {"tasks.sonar.properties.bin_count: ",
                                   "nobody.at_home: is not a property of any task",
                                   "vehicle is Running; it can when it is stopped",
                                   "sonar.range_min: a parameter has no type 99",
                                   "sonar.range: is given twice",
                                   "use_sim_time: is false, by the deployment's schedule and tasks"};
    ASSERT_EQ(found["refused"].size(), std::size(reasons));
    for (size_t i = 0; i < std::size(reasons); ++i) {
        EXPECT_FALSE(found["refused"][i]["successful"]) << reasons[i];
        EXPECT_THAT(found["refused"][i]["reason"].get<std::string>(), HasSubstr(reasons[i]));
    }
    EXPECT_EQ(found["still"], found["after"]) << "one bad, none set";
    EXPECT_EQ(found["together"], json({{"successful", true}, {"reason", ""}}));
    EXPECT_EQ(found["finally"][0]["double_value"], 16);
    EXPECT_EQ(found["finally"][1]["double_value"], 0.5);
    ASSERT_EQ(found["events"].size(), 1u) << found["events"];
    const json& event = found["events"][0];
    EXPECT_EQ(event["node"], "/auv/ros");
    EXPECT_EQ(event["changed_parameters"].size(), 2u);
    EXPECT_EQ(event["changed_parameters"][0]["name"], "sonar.range");
    EXPECT_EQ(event["changed_parameters"][0]["value"]["double_value"], 16);
    EXPECT_EQ(event["new_parameters"].size() + event["deleted_parameters"].size(), 0u);
    EXPECT_GT(found["loaded"][0], 20);
    EXPECT_EQ(found["loaded"][1], json::array()) << "what was dumped can be loaded";
    std::apply([&](const auto&... service) { (expectAnnounced(found["endpoints"], service), ...); },
               std::tuple(ros::list_parameters, ros::get_parameters, ros::get_parameter_types, ros::describe_parameters,
                          ros::set_parameters, ros::set_parameters_atomically));
}

TEST_F(Ros2RunTest, ALifecycleNodeMakesTheTransitionsOfItsTaskAndRefusesOthers) {
    if (!Peer::available())
        GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    writeFile(folder / "x.yml", servingNode("lifecycle: sonar, rosout: true"));
    const Process run(insonifyWords({"run", "x.yml", "--out", "out"}), folder.path());
    sendNonsense("change_state", "lifecycle_msgs/srv/ChangeState");
    Peer peer("lifecycle /auv/ros");
    const json found = peer.result();
    run.signal(SIGINT);
    EXPECT_THAT(run.wait(), succeeds());
    ASSERT_FALSE(found.is_null());
    EXPECT_EQ(found["states"].size(), 11u);
    EXPECT_EQ(found["states"][3], json({{"id", 3}, {"label", "active"}}));
    EXPECT_EQ(found["graph"].size(), 25u);
    const json in_active{"deactivate", "shutdown"}, in_inactive{"cleanup", "activate", "shutdown"},
        in_unconfigured{"configure", "shutdown"}, none = json::array();
    const json expected = {{nullptr, "", nullptr, "active", in_active},
                           {1, "", false, "active", in_active},
                           {0, "deactivate", true, "inactive", in_inactive},
                           {4, "", false, "inactive", in_inactive},
                           {99, "", false, "inactive", in_inactive},
                           {0, "no such", false, "inactive", in_inactive},
                           {2, "", true, "unconfigured", in_unconfigured},
                           {3, "", false, "unconfigured", in_unconfigured},
                           {1, "activate", false, "unconfigured", in_unconfigured},
                           {1, "", true, "inactive", in_inactive},
                           {3, "", true, "active", in_active},
                           {7, "", true, "finalized", none},
                           {1, "", false, "finalized", none}};
    EXPECT_EQ(found["steps"], expected);
    json events = found["events"];
    if (events[0]["transition"]["id"] == 0) {  // the run's own start, where the peer was there in time to hear of it
        EXPECT_EQ(events[0]["start_state"]["label"], "inactive");
        EXPECT_EQ(events[0]["goal_state"]["label"], "active");
        events.erase(0);
    }
    std::vector<std::string> goals;
    for (const json& event : events) goals.push_back(event["goal_state"]["label"]);
    EXPECT_THAT(goals, testing::ElementsAre("deactivating", "inactive", "cleaningup", "unconfigured", "configuring",
                                            "inactive", "activating", "active", "shuttingdown", "finalized"));
    EXPECT_EQ(events[0]["transition"], json({{"id", 4}, {"label", "deactivate"}}));
    EXPECT_EQ(events[0]["start_state"]["label"], "active");
    EXPECT_GT(events[0]["timestamp"], 1'600'000'000'000'000'000);
    std::apply([&](const auto&... service) { (expectAnnounced(found["endpoints"], service), ...); },
               std::tuple(ros::change_state, ros::get_state, ros::get_available_states, ros::get_available_transitions,
                          ros::get_transition_graph));
}

TEST_F(Ros2RunTest, TheLifecycleIsThatOfAnotherTask) {
    for (const char* name : {"sonr", "ros", "\"\""}) {
        writeFile(folder / "x.yml", servingNode(std::string("lifecycle: ") + name));
        for (const std::string command : {"run", "check"})
            EXPECT_THAT(callInsonify(folder, {command, "x.yml"}),
                        isRefused(HasSubstr("tasks.ros.properties.lifecycle: is ")));
    }
}

TEST_F(Ros2RunTest, DiagnosticsAndTheLogReportEachTask) {
    if (!Peer::available())
        GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    writeFile(folder / "x.yml", servingNode("diagnostics: true, rosout: true, parameter_services: true"));
    const Process run(insonifyWords({"run", "x.yml", "--out", "out"}), folder.path());
    Peer peer("reports");
    const json found = peer.result();
    run.signal(SIGINT);
    EXPECT_THAT(run.wait(), succeeds());
    ASSERT_FALSE(found.is_null());
    ASSERT_GE(found["rt/diagnostics"].size(), 4u);
    const json& status = found["rt/diagnostics"].back()["status"];
    ASSERT_EQ(status.size(), 4u);
    const auto getValue = [&](const json& task, const std::string& key) {
        for (const json& value : task["values"])
            if (value["key"] == key) return std::stod(value["value"].get<std::string>());
        ADD_FAILURE() << key << task;
        return 0.0;
    };
    EXPECT_EQ(status[0]["name"], "auv/ros: vehicle");
    EXPECT_EQ(status[0]["hardware_id"], "pose::TrajectoryTask");
    EXPECT_NEAR(getValue(status[0], "pose rate [1/s]"), 10, 9);  // of a busy machine
    EXPECT_EQ(status[2]["name"], "auv/ros: sonar");
    EXPECT_GT(getValue(status[2], "ping rate [1/s]"), 0);
    EXPECT_GT(getValue(status[2], "last cycle [ms]"), 0);
    EXPECT_GE(getValue(status[2], "missed periods"), 0);
    EXPECT_EQ(status[3]["message"], "Running") << status[3];
    EXPECT_EQ(status[3]["level"], 0);
    std::string texts;
    for (const json& line : found["rt/rosout"]) {
        EXPECT_THAT(line["name"].get<std::string>(), testing::StartsWith("auv.ros"));
        EXPECT_GE(line["level"], 20);
        texts += line["name"].get<std::string>() + " " + line["msg"].get<std::string>() + "\n";
    }
    EXPECT_THAT(texts, HasSubstr("auv.ros.sonar sonar: is Running")) << "also for those that come later";
    EXPECT_THAT(texts, HasSubstr("auv.ros.sonar sonar: range reached is ")) << "a notice of the start";
}
