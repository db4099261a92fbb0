// The schema of deployments, tested with a general validator, Debian's python3-jsonschema.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace {

struct SchemaTest : testing::Test {
    void SetUp() override {
        if (python(folder_, "import jsonschema, yaml").code != 0)
            GTEST_SKIP() << "python3-jsonschema and python3-yaml are not installed; scripts/setup does that";
        const Outcome outcome = callInsonify(folder_, {"schema"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        writeFile(folder_ / "schema.json", outcome.out);
        schema_ = json::parse(outcome.out);
    }
    /** Returns the validator's errors, one per line. */
    std::string findDiagnostics(std::vector<std::string> files) {
        files.insert(files.begin(),
                     {"/usr/bin/python3", fs::path(insonify::test::source_dir) / "tests/deployer/check_schema.py",
                      "schema.json"});
        const Outcome outcome = Process(files, folder_.path()).wait();
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    }
    /** Returns the errors of the wall's deployment with a text replaced. */
    std::string diagnosticsWith(const std::string& from, const std::string& to) {
        writeFile(folder_ / "other.yml", replaced(wall_deployment, from, to));
        return findDiagnostics({"other.yml"});
    }
    const json& property(const std::string& type, const std::string& name) const {
        return schema_["$defs"][type]["properties"][name];
    }

    TestFolder folder_;
    json schema_;
};

}  // namespace

TEST_F(SchemaTest, EveryDeliveredDeploymentIsValid) {
    INSONIFY_NEEDS("gazebo");
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(fs::path(insonify::test::source_dir) / "deploy"))
        if (entry.path().extension() == ".yml") files.push_back(entry.path());
    ASSERT_GT(files.size(), 5u);
    for (const char* sonar : {"oculus_m750d", "micron"}) {
        ASSERT_EQ(callInsonify(folder_, {"init", sonar, "--sonar", sonar}).code, 0);
        files.push_back(std::string(sonar) + "/" + sonar + ".yml");
    }
    EXPECT_EQ(findDiagnostics(files), "");
}

TEST_F(SchemaTest, RefusesWrongValuesAtTheSamePlaceAsTheCommand) {
    EXPECT_EQ(diagnosticsWith("range: 20", "range: 30"), "");
    EXPECT_EQ(diagnosticsWith("range: 20", "range: 2000.cm"), "");
    EXPECT_EQ(diagnosticsWith("beam_height_deg: 10", "beam_height_deg: {rad: 0.2}"), "");
    struct Case {
        const char *from, *to, *place;
    };
    for (const Case& c : {Case{"range: 20", "rnage: 20", "tasks.sonar.properties: "},
                          Case{"range: 20", "range: -5", "tasks.sonar.properties.range: "},
                          Case{"range: 20", "range: 20 m", "tasks.sonar.properties.range: "},
                          Case{"range: 20", "range: [20]", "tasks.sonar.properties.range: "},
                          Case{"range: 20", "tvg: {log_coefficient: 40}", "tasks.sonar.properties: "},
                          Case{"bin_count: 50", "bin_count: 50.5", "tasks.sonar.properties.bin_count: "},
                          Case{"rows: 32", "rows: 0", "tasks.sonar.properties.quality.rows: "},
                          Case{"rows: 32", "lines: 32", "tasks.sonar.properties.quality: "},
                          Case{"law: rayleigh", "law: raleigh", "tasks.noise.properties.speckle.law: "},
                          Case{"position: [0, 0, 0]", "position: [0, 0]", "properties.waypoints.0.position: "},
                          Case{"sonar::SonarTask", "sonar::SonerTask", "tasks.sonar.type: "},
                          Case{"period: 0.1", "period: 0", "tasks.vehicle.activity.period: "},
                          Case{"schedule: lockstep", "schedule: lockstop", "schedule: "},
                          Case{"schedule: lockstep", "scheduler: lockstep", ": "},
                          Case{"from: vehicle.pose", "from: vehicle", "connections.0.from: "}}) {
        EXPECT_THAT(diagnosticsWith(c.from, c.to), HasSubstr(c.place)) << c.to;
        EXPECT_EQ(callInsonify(folder_, {"check", "other.yml"}).code, 2) << c.to;
    }
}

TEST_F(SchemaTest, HasEveryPropertyWithDocumentationUnitBoundsDefaultAndNames) {
    const json tasks = json::parse(callInsonify(folder_, {"describe", "--json"}).out);
    for (const json& task : tasks) {
        const std::string type = task["type"];
        ASSERT_TRUE(schema_["$defs"].contains(type)) << type;
        for (const json& described :
             json::parse(callInsonify(folder_, {"describe", type, "--json"}).out)["properties"]) {
            const std::string name = described["name"];
            if (name.find_first_of(".[") != std::string::npos) continue;
            EXPECT_THAT(property(type, name).value("description", ""), HasSubstr(described["doc"].get<std::string>()));
        }
    }
    const json& range = property("sonar::SonarTask", "range");
    EXPECT_EQ(range["minimum"], 0.001);
    EXPECT_EQ(range["maximum"], 1e5);
    EXPECT_EQ(range["default"], 50);
    EXPECT_THAT(range["description"].get<std::string>(), HasSubstr("[m]"));
    EXPECT_THAT(property("sonar::SonarTask", "model")["enum"], testing::ElementsAre("physical", "cerqueira2017"));
    EXPECT_EQ(property("sonar::SonarTask", "water")["properties"]["salinity_psu"]["maximum"], 50);
    EXPECT_EQ(property("scene::SceneTask", "materials")["additionalProperties"]["properties"]["lambert_db"]["minimum"],
              -200);
}

TEST_F(SchemaTest, AliasesAndLibrariesAllowOtherPropertiesAndTypes) {
    EXPECT_EQ(diagnosticsWith("    type: sonar::SonarTask\n",
                              "    type: sonar::SonarTask\n    aliases: {reach: sonar.range}\n"),
              "");
    EXPECT_EQ(diagnosticsWith("range: 20", "range: 20\n      reach: 30").find("reach") == std::string::npos, false);
    EXPECT_EQ(diagnosticsWith("schedule: lockstep", "libraries: [mine.so]\nschedule: lockstep"), "");
    writeFile(folder_ / "other.yml", replaced(replaced(wall_deployment, "noise::NoiseTask", "my::Task"),
                                              "schedule: lockstep", "libraries: [mine.so]"));
    EXPECT_EQ(findDiagnostics({"other.yml"}), "");
}
