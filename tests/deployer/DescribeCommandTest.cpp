#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

json named(const json& list, const std::string& name) {
    for (const json& entry : list)
        if (entry["name"] == name) return entry;
    return nullptr;
}

}  // namespace

TEST(DescribeCommandTest, ListsEveryTask) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"describe"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* type : {"pose::TrajectoryTask", "scene::SceneTask", "sonar::SonarTask", "sonar::ScanningSonarTask",
                             "sonar::ProfilerTask", "sonar::SideScanTask", "sonar::AltimeterTask", "sonar::Sonar3dTask",
                             "noise::NoiseTask", "receiver::ReceiverTask", "output::FanImageTask", "logger::LoggerTask",
                             "replay::ReplayTask"})
        EXPECT_THAT(outcome.out, HasSubstr(type));
}

TEST(DescribeCommandTest, EveryListedTaskCanBeDescribedAndEveryPropertyIsDocumented) {
    const TestFolder folder;
    for (const json& entry : json::parse(callInsonify(folder, {"describe", "--json"}).out)) {
        const Outcome outcome = callInsonify(folder, {"describe", entry["type"], "--json"});
        ASSERT_EQ(outcome.code, 0) << entry["type"];
        const json task = json::parse(outcome.out);
        EXPECT_EQ(task["type"], entry["type"]);
        for (const json& property : task["properties"]) EXPECT_NE(property["doc"], "") << property["name"];
        for (const json& port : task["ports"]) EXPECT_NE(port["doc"], "") << port["name"];
    }
}

TEST(DescribeCommandTest, PrintsPortsPropertiesUnitsDefaultsAndBounds) {
    const TestFolder folder;
    const json sonar = json::parse(callInsonify(folder, {"describe", "sonar::SonarTask", "--json"}).out);
    EXPECT_EQ(named(sonar["ports"], "snapshot")["direction"], "in");
    EXPECT_EQ(named(sonar["ports"], "ping")["direction"], "out");
    EXPECT_EQ(named(sonar["ports"], "ping")["type"], "/base/samples/Sonar");
    const json range = named(sonar["properties"], "range");
    EXPECT_EQ(range["unit"], "m");
    EXPECT_EQ(range["default"], 50);
    EXPECT_TRUE(range["min"].is_number());
    EXPECT_TRUE(range["max"].is_number());
    EXPECT_TRUE(sonar["operations"].is_array());
}

TEST(DescribeCommandTest, EverySeedDocumentsThatItsDefaultIsAHash) {
    const TestFolder folder;
    int seeds = 0;
    for (const json& entry : json::parse(callInsonify(folder, {"describe", "--json"}).out)) {
        const json task = json::parse(callInsonify(folder, {"describe", entry["type"], "--json"}).out);
        const json seed = named(task["properties"], "seed");
        if (seed.is_null()) continue;
        ++seeds;
        EXPECT_EQ(seed["type"], "integer >= 0, optional") << entry["type"];
        EXPECT_TRUE(seed["default"].is_null()) << entry["type"];
        EXPECT_THAT(seed["doc"], HasSubstr("absent: a hash of the deployment's seed and the task's name"))
            << entry["type"];
    }
    EXPECT_GE(seeds, 4) << "noise and three sensors";
}

TEST(DescribeCommandTest, TheTextShowsTheSame) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"describe", "sonar::SonarTask"});
    EXPECT_THAT(outcome.out, HasSubstr("range: double, default 50, "));
    EXPECT_THAT(outcome.out, HasSubstr("[m]"));
    EXPECT_THAT(outcome.out, HasSubstr("RunTimeError"));
}

TEST(DescribeCommandTest, MaterialsAreListedByName) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"describe", "materials"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* name : {"medium_sand", "steel"}) EXPECT_THAT(outcome.out, HasSubstr(name));
}
