// A world with a datum: fixes that become poses again, soundings on the earth, and datums that do not agree.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "tests/deployer/Wall.hpp"
#include "types/geometry/Datum.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

const types::Datum kiel{54.5, 10.25, 40};

/** A vehicle above a floor with a receiver of satellites and a profiler. */
const std::string earth_deployment = R"(datum: {latitude_deg: 54.5, longitude_deg: 10.25, height_m: 40}
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties: {waypoints: [{time: 1, position: [100, -50, 0.5]}, {time: 3, position: [110, -45, 0.7], yaw_deg: 40}]}
  scene: {type: scene::SceneTask, properties: {file: wall.gltf, mount: {pitch_deg: 90}}}
  sonar:
    type: sonar::ProfilerTask
    properties: {range: 20, beam_count: 16, bin_count: 100, field_of_view_deg: 60, beam_height_deg: 2,
                 quality: {rows: 16, columns_per_beam: 2}, detection: {threshold_db: -80}}
  fix: {type: nav::FixTask, properties: {water_surface: -5}}
  chart: {type: output::SoundingMapTask, properties: {every: 5, width: 600, file: chart_%06d.png}}
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: vehicle.pose, to: fix.pose, policy: {type: buffer, size: 64}}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.soundings, to: chart.soundings, policy: {type: buffer, size: 64}}
  - {from: sonar.soundings, to: log.soundings, policy: {type: buffer, size: 64}}
  - {from: vehicle.pose, to: log.pose, policy: {type: buffer, size: 64}}
  - {from: fix.fix, to: log.fix, policy: {type: buffer, size: 64}}
)";

/** A floor of 400 m, 10 m below the origin, in glTF's axes. */
std::string floorGltf() {
    return makeGltf({-200, -10, 200, -200, -10, -200, 200, -10, -200, 200, -10, 200}, {0, 2, 1, 0, 3, 2});
}

/** The lines of a CSV file, by the names of its columns. */
std::vector<std::map<std::string, double>> getRows(const std::string& csv) {
    const auto split = [](const std::string& line) {
        std::vector<std::string> words;
        std::istringstream stream(line);
        for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
        return words;
    };
    std::istringstream stream(csv);
    std::string line;
    std::getline(stream, line);
    const std::vector<std::string> names = split(line);
    std::vector<std::map<std::string, double>> rows;
    while (std::getline(stream, line)) {
        const std::vector<std::string> words = split(line);
        auto& row = rows.emplace_back();
        for (size_t i = 0; i < words.size(); ++i) row[names.at(i)] = std::strtod(words[i].c_str(), nullptr);
    }
    return rows;
}

struct EarthRunTest : testing::Test {
    void SetUp() override {
        try {
            geodetic(kiel, {});
        } catch (const std::exception&) {
            GTEST_SKIP() << "this build has no GeographicLib";
        }
    }
    Outcome call(std::vector<std::string> words) const { return callInsonify(folder_, std::move(words)); }
    void run(const std::string& log = "x.0.log", const std::string& out = "out") const {
        ASSERT_THAT(call({"run", "wall.yml", "--duration", "1.5", "--out", out, "--set", "log.file=" + log}),
                    succeeds());
    }
    std::vector<std::map<std::string, double>> exported(const std::string& log, const std::string& stream,
                                                        std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"log", "export", log, "--stream", stream, "--to", "export.csv"});
        EXPECT_THAT(call(more), succeeds());
        return getRows(readFile(folder_ / "export.csv"));
    }
    /** Returns the outcome of a check of the deployment with a part replaced. */
    Outcome checked(const std::string& what, const std::string& with) const {
        writeFile(folder_ / "other.yml", replaced(earth_deployment, what, with));
        return call({"check", "other.yml"});
    }
    const WallFolder folder_{earth_deployment, floorGltf()};
};

const std::string written_datum = "datum: {latitude_deg: 54.5, longitude_deg: 10.25, height_m: 40}";

}  // namespace

TEST_F(EarthRunTest, ADeploymentStatesItsDatum) {
    EXPECT_THAT(call({"check", "wall.yml"}), prints(HasSubstr("\n" + written_datum + "\n")));
    const json checked = json::parse(call({"check", "wall.yml", "--json"}).out);
    EXPECT_EQ(checked["datum"], json({{"latitude_deg", 54.5}, {"longitude_deg", 10.25}, {"height_m", 40}}));
    const json schema = json::parse(call({"schema"}).out);
    const json& datum = schema["properties"]["datum"];
    EXPECT_EQ(datum["properties"]["latitude_deg"]["maximum"], 90);
    EXPECT_FALSE(datum["properties"]["latitude_deg"].contains("default")) << "it must be given";
    EXPECT_EQ(schema["$defs"]["nav::FixTask"]["properties"]["datum"]["additionalProperties"], false);
}

TEST_F(EarthRunTest, FixesGiveThePosesBack) {
    for (const char* log : {"x.0.log", "x.0.mcap"}) {
        run(log);
        const std::string file = std::string("out/") + log;
        const auto poses = exported(file, "vehicle.pose"), fixes = exported(file, "fix.fix");
        ASSERT_EQ(fixes.size(), poses.size());
        for (size_t i = 0; i < fixes.size(); ++i) {
            EXPECT_EQ(fixes[i].at("time"), poses[i].at("time"));
            const types::Datum expected = geodetic(kiel, {-poses[i].at("y"), poses[i].at("x"), poses[i].at("z")});
            EXPECT_NEAR(fixes[i].at("latitude"), expected.latitude_deg, 1e-13);
            EXPECT_NEAR(fixes[i].at("longitude"), expected.longitude_deg, 1e-13);
            EXPECT_NEAR(fixes[i].at("altitude"), expected.height_m, 1e-8);
        }
        for (const std::vector<std::string>& datum : {std::vector<std::string>{}, {"--datum", "54.5,10.25,40"}}) {
            std::vector<std::string> words = {"replay",  file,    "wall.yml", "--rerender", "--pose",
                                              "fix.fix", "--out", "again_of", "--set",      "log.file=again.0.log"};
            words.insert(words.end(), datum.begin(), datum.end());
            ASSERT_THAT(call(words), succeeds());
            const auto again = exported("again_of/again.0.log", "vehicle.pose");
            ASSERT_EQ(again.size(), poses.size()) << log;
            for (size_t i = 0; i < again.size(); ++i)
                for (const char* axis : {"x", "y", "z"})
                    EXPECT_NEAR(again[i].at(axis), poses[i].at(axis), 1e-7) << axis << " of " << log;
            fs::remove_all(folder_ / "again_of");
        }
        EXPECT_THAT(call({"replay", file, "wall.yml", "--rerender", "--pose", "fix.fix", "--datum", "54.6,10.25,40"}),
                    isRefused(AllOf(HasSubstr("fix.fix: has the datum {latitude_deg: 54.6,"),
                                    HasSubstr("the deployment's is {latitude_deg: 54.5,"), HasSubstr("one origin"))));
        fs::remove_all(folder_ / "out");
    }
    for (const auto& [datum, why] : {std::pair("91,10", "latitude 91; may be -90 to 90"),
                                     {"54,nan", "longitude nan;"},
                                     {"54,361", "longitude 361; may be -360"},
                                     {"54,10,inf", "height inf; may be"}})
        EXPECT_THAT(call({"replay", "x.0.log", "wall.yml", "--datum", datum}),
                    isRefused(HasSubstr("--datum: has the " + std::string(why))));
}

TEST_F(EarthRunTest, SoundingsAsTextHaveTheirPlacesOnTheEarth) {
    run();
    const auto rows = exported("out/x.0.log", "sonar.soundings");
    const auto on_map = exported("out/x.0.log", "sonar.soundings", {"--utm"});
    ASSERT_GT(rows.size(), 100u);
    ASSERT_EQ(on_map.size(), rows.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        const auto& row = rows[i];
        const types::Datum at = geodetic(kiel, {-row.at("y"), row.at("x"), row.at("z")});
        EXPECT_EQ(row.at("latitude_deg"), at.latitude_deg) << "64 bits";
        EXPECT_EQ(row.at("longitude_deg"), at.longitude_deg);
        EXPECT_EQ(row.at("height_m"), at.height_m);
        const types::GridPlace expected = gridPlace(kiel, at);
        EXPECT_EQ(on_map[i].at("easting"), expected.easting);
        EXPECT_EQ(on_map[i].at("northing"), expected.northing);
        EXPECT_EQ(on_map[i].at("height_m"), at.height_m);
        EXPECT_EQ(on_map[i].at("epsg"), 32632);
        EXPECT_EQ(on_map[i].count("latitude_deg"), 0u);
        EXPECT_EQ(on_map[i].at("intensity"), row.at("intensity"));
    }
    EXPECT_TRUE(fs::exists(folder_ / "out/chart_000002.png"));
    for (const auto& [stream, to] : {std::pair("sonar.soundings", "x.npz"), std::pair("vehicle.pose", "x.csv"),
                                     std::pair("sonar.soundings", "folder")})
        EXPECT_THAT(call({"log", "export", "out/x.0.log", "--stream", stream, "--to", to, "--utm"}),
                    isRefused(HasSubstr("--utm: is for soundings as text")));
}

TEST_F(EarthRunTest, SoundingsOfAWorldWithoutADatumAreAsBefore) {
    const std::string bare = replaced(replaced(earth_deployment, written_datum + "\n", ""),
                                      "  fix: {type: nav::FixTask, properties: {water_surface: -5}}\n", "");
    const std::string unread =
        replaced(bare, "  - {from: vehicle.pose, to: fix.pose, policy: {type: buffer, size: 64}}\n", "");
    writeFile(folder_ / "wall.yml",
              replaced(unread, "  - {from: fix.fix, to: log.fix, policy: {type: buffer, size: 64}}\n", ""));
    run();
    exported("out/x.0.log", "sonar.soundings");
    EXPECT_THAT(readFile(folder_ / "export.csv"), testing::StartsWith("time,x,y,z,intensity\n"));
    EXPECT_THAT(call({"log", "export", "out/x.0.log", "--stream", "sonar.soundings", "--to", "x.csv", "--utm"}),
                isRefused(HasSubstr("--utm: needs a datum")));
    EXPECT_THAT(call({"check", "wall.yml"}), prints(Not(HasSubstr("datum"))));
}

TEST_F(EarthRunTest, PosesAboutAnotherDatumAreNotReplayed) {
    run();
    const std::string moved = "datum: {latitude_deg: 54.5001, longitude_deg: 10.25, height_m: 40}";
    writeFile(folder_ / "moved.yml", replaced(earth_deployment, written_datum, moved));
    const auto refused = isRefused(AllOf(HasSubstr("datum: is {latitude_deg: 54.5001,"),
                                         HasSubstr("of the log counts from {latitude_deg: 54.5,")));
    EXPECT_THAT(call({"replay", "out/x.0.log", "moved.yml", "--out", "a"}), refused);
    EXPECT_THAT(call({"replay", "out/x.0.log", "moved.yml", "--pose", "vehicle.pose", "--out", "b"}), refused);
    EXPECT_THAT(call({"replay", "out/x.0.log", "wall.yml", "--out", "c"}), succeeds());
    EXPECT_THAT(call({"replay", "out/x.0.log", "moved.yml", "--pose", "fix.fix", "--out", "d"}), refused)
        << "its soundings";
    EXPECT_THAT(call({"replay", "out/x.0.log", "moved.yml", "--rerender", "--pose", "fix.fix", "--out", "e"}),
                succeeds());
}

TEST_F(EarthRunTest, DatumsThatDoNotAgreeAreRefused) {
    EXPECT_THAT(checked("{water_surface: -5}", "{datum: {latitude_deg: 54.5, longitude_deg: 10.26, height_m: 40}}"),
                isRefused(AllOf(HasSubstr("other.yml:"),
                                HasSubstr("tasks.fix.properties.datum: is {latitude_deg: 54.5, "
                                          "longitude_deg: 10.26"),
                                HasSubstr("a world has one origin"))));
    EXPECT_THAT(checked("{water_surface: -5}", "{datum: {latitude_deg: 54.5, longitude_deg: -349.75, height_m: 40}}"),
                succeeds());
    EXPECT_THAT(checked(written_datum + "\n", ""),
                isRefused(HasSubstr("tasks.fix.properties.datum: is missing; give the deployment")));
    EXPECT_THAT(checked("mount: {pitch_deg: 90}",
                        "targets: [{name: a, strength_db: 0, geodetic: {latitude_deg: 10.25, "
                        "longitude_deg: 54.5}}]"),
                isRefused(AllOf(HasSubstr("tasks.scene.properties.targets[0].geodetic"), HasSubstr("exchanged?"))));
    EXPECT_THAT(checked("mount: {pitch_deg: 90}",
                        "targets: [{name: a, strength_db: 0, geodetic: {latitude_deg: 54.5, longitude_deg: 10.251}}]"),
                succeeds());
}
