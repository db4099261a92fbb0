#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;

TEST(DeviceCommandTest, ListPrintsTheReplacedDevicesAndTheirPorts) {
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"device", "list"}),
                prints(AllOf(HasSubstr("device::Ping360Task"), HasSubstr("Blue Robotics Ping360"),
                             HasSubstr("port 12345"), HasSubstr("device::Ping1dTask"), HasSubstr("port 9090"))));
    const json devices = json::parse(callInsonify(folder, {"device", "list", "--json"}).out);
    const auto ping360 =
        std::ranges::find_if(devices, [](const json& d) { return d["type"] == "device::Ping360Task"; });
    ASSERT_NE(ping360, devices.end());
    EXPECT_EQ((*ping360)["ports"]["port"], 12345);
    EXPECT_EQ((*ping360)["ports"]["discovery.port"], 30303);
}

TEST(DeviceCommandTest, CheckRefusesAnAddressAsRunDoes) {
    const TestFolder folder;
    const std::pair<const char*, const char*> tasks[] = {{"hil_oculus", "device"},  {"hil_ping360", "ping360"},
                                                         {"hil_ping360", "ping1d"}, {"hil_3d15", "device"},
                                                         {"hil_micron", "device"},  {"mavlink_poses", "vehicles"}};
    for (const auto& [deployment, task] : tasks)
        for (const char* address : {"localhost", "0.0.0"})
            EXPECT_THAT(
                callInsonify(folder, {"check", insonify::test::sourceFile(std::string("deploy/") + deployment + ".yml"),
                                      "--set", std::string(task) + ".address=" + address}),
                isRefused(HasSubstr("--set: tasks." + std::string(task) + ".properties.address: is " + address +
                                    ", which is no address; write one as 127.0.0.1 or ::1\n")));
}

TEST(DeviceCommandTest, AProbeIdentifiesTheDevice) {
    const TestFolder folder, asking;
    writeFile(
        folder / "x.yml",
        "schedule: realtime\ntasks:\n  ping360: {type: device::Ping360Task, properties: {port: 0, serial: line}}\n"
        "  sonar: {type: sonar::ScanningSonarTask}\n  scene: {type: scene::SceneTask, properties: {file: " +
            insonify::test::sourceFile("deploy/scenes/wall.glb") +
            ", pose_timeout: 600}}\n"
            "  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, "
            "position: [0, 0, 0]}]}}\n"
            "  receiver: {type: receiver::ReceiverTask, properties: {output: code, code: {bits: 16}}}\n"
            "connections:\n  - {from: vehicle.pose, to: scene.pose}\n  - {from: scene.snapshot, to: sonar.snapshot}\n"
            "  - {from: ping360.settings, to: sonar.settings, policy: {type: buffer, size: 4}}\n"
            "  - {from: sonar.ping, to: receiver.intensity}\n  - {from: receiver.ping, to: ping360.ping}\n");
    const Process run(insonifyWords({"run", "x.yml", "--out", "out"}), folder.path());
    EXPECT_TRUE(says(folder, "listens on serial line"));
    const std::string line = folder / "out/line";
    Outcome outcome;
    insonify::test::becomesTrue([&] {  // as soon as the task runs
        outcome = callInsonify(asking, {"device", "probe", line, "--timeout", "5"});
        return outcome.code == 0;
    });
    run.signal(SIGINT);
    EXPECT_EQ(run.wait().code, 0);
    EXPECT_THAT(outcome, prints(HasSubstr("serial line " + line + ": Blue Robotics Ping360, id 2, revision 1")))
        << outcome.out << outcome.err;
}

TEST(DeviceCommandTest, NoAnswerIsReportedWithReasonsAndCode1) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"device", "probe", "/nowhere/line", "--timeout", "0.05"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.out, HasSubstr("serial line /nowhere/line: ping protocol (Ping360, Ping1D)\nserial line "
                                       "/nowhere/line: SeaNet (Micron)\n  No such file"))
        << "one reason for both";
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("/dev/serial/by-id"), testing::Not(HasSubstr("127.0.0.1"))));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("--timeout"))) << "waiting does not help";
    EXPECT_THAT(outcome.err, HasSubstr("nothing answers at /nowhere/line"));
    const json all =
        json::parse(callInsonify(folder, {"device", "probe", "/nowhere/line", "--timeout", "0.05", "--json"}).out);
    EXPECT_EQ(all[0]["device"], "");
    EXPECT_NE(all[0]["advice"], "");
}

TEST(DeviceCommandTest, ABadAddressIsOneClearErrorAndCode2) {
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"device", "probe", "127.0.0.1:70000"}),
                isRefused(HasSubstr("ADDRESS: is '127.0.0.1:70000', whose port '70000' is not from 1 to 65535")));
    EXPECT_EQ(callInsonify(folder, {"device", "probe", ""}).code, 2);
    EXPECT_THAT(callInsonify(folder, {"device", "probe", "./"}),
                isRefused(HasSubstr("is './', which is no serial line")));
    EXPECT_EQ(callInsonify(folder, {"device", "probe"}).code, 2);
    EXPECT_EQ(callInsonify(folder, {"device"}).code, 2);
    EXPECT_EQ(callInsonify(folder, {"device", "probe", "127.0.0.1", "--timeout", "0"}).code, 2);
}
