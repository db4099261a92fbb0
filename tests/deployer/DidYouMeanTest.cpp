// Answers to typing mistakes in a deployment or on the command line.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;
using testing::Not;

namespace {

/** Returns the output of `check` for the wall's deployment with a text replaced. */
std::string diagnosticsWith(const std::string& from, const std::string& to) {
    const WallFolder folder(replaced(wall_deployment, from, to));
    const Outcome outcome = callInsonify(folder, {"check", "wall.yml"});
    EXPECT_EQ(outcome.code, 2) << to;
    return outcome.err;
}

struct Case {
    const char *from, *to, *words;
};

void expectWords(std::initializer_list<Case> cases) {
    for (const Case& c : cases) EXPECT_THAT(diagnosticsWith(c.from, c.to), HasSubstr(c.words)) << c.to;
}

}  // namespace

TEST(DidYouMeanTest, NamesOfTasksPortsPropertiesEnumsAndMaterials) {
    expectWords({
        {"sonar::SonarTask", "sonar::SonarTsk", "did you mean sonar::SonarTask?"},
        {"sonar::SonarTask", "SonarTask", "did you mean sonar::SonarTask?"},
        {"{from: sonar.ping, to: noise.clean}", "{from: sonra.ping, to: noise.clean}", "did you mean sonar?"},
        {"{from: sonar.ping, to: noise.clean}", "{from: sonar.png, to: noise.clean}", "did you mean ping?"},
        {"{from: sonar.ping, to: noise.clean}", "{from: sonar.ping, to: noise.claen}", "did you mean clean?"},
        {"beam_count: 16", "beam_cuont: 16", "did you mean beam_count?"},
        {"beam_count: 16", "Beam_Count: 16", "did you mean beam_count?"},
        {"law: rayleigh", "law: raleigh", "did you mean rayleigh?"},
        {"file: wall.gltf", "file: wall.gltf, materials: {walls: {lambert_db: -10}}", "did you mean wall?"},
        {"file: wall.gltf", "file: wall.gltf, materials: {wall: {sediment: medum_sand}}", "did you mean medium_sand?"},
        {"file: wall.gltf", "file: wall.gltf, materials: {wall: {lamber_db: -10}}", "did you mean lambert_db?"},
        {"schedule: lockstep", "schedule: lock_step", "did you mean lockstep?"},
        {"beam_count: 16", "visibility: clu", "did you mean cpu?"},
        {"beam_count: 16", "visibility: gpu", "is gpu; may be auto, gl, cpu"},
    });
}

TEST(DidYouMeanTest, ASceneInPlaceOfADeploymentIsCalledOne) {
    const WallFolder folder;
    for (const char* scene : {"wall.gltf", "nowhere.GLB", "pool.sdf"})
        EXPECT_THAT(callInsonify(folder, {"run", scene}),
                    isRefused(HasSubstr(std::string(scene) + ": is a scene; must be a deployment")));
    EXPECT_THAT(callInsonify(folder, {"check", ""}),
                isRefused(HasSubstr("DEPLOYMENT: is empty; must be TEXT: a YAML file")));
}

TEST(DidYouMeanTest, OffersAFileOfTheCurrentFolder) {
    const WallFolder folder;
    fs::create_directory(folder / "dive");
    fs::copy(folder / "wall.yml", folder / "dive/wall.yml");
    const Outcome refused = callInsonify(folder, {"check", "dive", "--set", "scene.file=wall.gltf"});
    EXPECT_THAT(refused, isRefused(HasSubstr("dive/wall.gltf: does not exist; is the one of the current folder meant? "
                                             "write " +
                                             (folder / "wall.gltf").string() + "; looked for at")));
    EXPECT_THAT(callInsonify(folder, {"check", "wall.yml", "--set", "scene.file=no.gltf"}).err,
                Not(HasSubstr("meant")));
}

TEST(DidYouMeanTest, NamesTheTaskThatHasTheKey) {
    for (const char* key : {"tvg: {log_coefficient: 40}", "source_level_db: 210"})
        EXPECT_THAT(diagnosticsWith("range: 20", std::string("range: 20\n      ") + key),
                    AllOf(HasSubstr("is not a key here; "), HasSubstr("; receiver::ReceiverTask has it\n")));
    EXPECT_THAT(diagnosticsWith("law: rayleigh}", "law: rayleigh}, beam_count: 16"),
                HasSubstr("; sonar::SonarTask and sonar::ProfilerTask have it\n"));
    EXPECT_THAT(diagnosticsWith("law: rayleigh}", "law: rayleigh}, file: x.log"), Not(HasSubstr("it\n")))
        << "of many types";
    EXPECT_THAT(diagnosticsWith("law: rayleigh}", "law: rayleigh, tvg: {}}"), Not(HasSubstr("it\n"))) << "in a block";
}

TEST(DidYouMeanTest, ShowsTheRightFormOfANumberWithItsUnit) {
    expectWords({
        {"range: 20", "range: 20 m", "is 20 m; write 20 or 20.m; must be a finite number"},
        {"range: 20", "range: 20m", "write 20 or 20.m;"},
        {"range: 20", "range: 2000 cm", "write 20 or 2000.cm;"},
        {"range: 20", "range: 20,5", "write 20.5;"},
        {"speckle: {law: rayleigh}}", "speckle: {law: rayleigh}", "a { has no } to close it"},
        {"beam_height_deg: 10", "beam_height_deg: 10 deg", "write 10 or 10.deg;"},
        {"beam_height_deg: 10", "beam_height_deg: 10\n      speed_of_sound: 1500 m/s", "write 1500 or 1500.m.s^-1;"},
        {"beam_height_deg: 10", "beam_height_deg: 10\n      absorption: {db_per_m: 0.2 dB/m}", "write 0.2;"},
        {"beam_height_deg: 10", "beam_height_deg: 10\n      published: yes", "write true;"},
    });
    EXPECT_THAT(diagnosticsWith("range: 20", "range: 20 deg"), Not(HasSubstr("write")));
    EXPECT_THAT(diagnosticsWith("range: 20", "range: far"), Not(HasSubstr("write")));
}

TEST(DidYouMeanTest, NamesATabAndAWrongIndent) {
    expectWords({
        {"      range: 20", "\trange: 20", "is indented with a tab; indent with spaces"},
        {"      range: 20", "     \trange: 20", "is indented with a tab; indent with spaces"},
        {"      range: 20", "      range: 20\n     range_min: 1",
         "is indented by 5 spaces; after the lines above, it may be by 0 or 2 or 4 or 6"},
        {"      range: 20", "      range: 20\n        range_min: 1", "is indented by 8 spaces; after the lines above"},
    });
}

TEST(DidYouMeanTest, TheCauseIsBeforeItsConsequences) {
    // A task with another name: connections refer to a missing task, and its own port has no connection.
    const std::string diagnostics = diagnosticsWith("  noise:\n", "  nose:\n");
    const size_t cause = diagnostics.find("did you mean nose?"), consequence = diagnostics.find("input port clean");
    ASSERT_NE(cause, std::string::npos) << diagnostics;
    ASSERT_NE(consequence, std::string::npos) << diagnostics;
    EXPECT_LT(cause, consequence);
}

TEST(DidYouMeanTest, AMissingSceneIsReportedWithSearchedFoldersAndReadableFormats) {
    const WallFolder folder(replaced(wall_deployment, "wall.gltf", "wal.gltf"));
    const std::string diagnostics = callInsonify(folder, {"check", "wall.yml"}).err;
    EXPECT_THAT(diagnostics, HasSubstr("wall.yml:11:24: tasks.scene.properties.file: "));
    EXPECT_THAT(diagnostics, HasSubstr("did you mean wall.gltf?"));
    EXPECT_THAT(diagnostics, HasSubstr("looked for at " + (folder / "wal.gltf").string()));
    EXPECT_THAT(diagnostics, HasSubstr(".gltf, .glb, .world, .sdf, .urdf, .dae, .obj, .stl or .ply"));
}

TEST(DidYouMeanTest, AWordThatIsNoCommandIsReportedWithTheCommands) {
    const WallFolder folder;
    for (const std::vector<std::string>& words : {std::vector<std::string>{"exprot"}, {"log", "foo", "wall.0.log"}}) {
        const Outcome outcome = callInsonify(folder, words);
        const std::string wrong = words.size() == 1 ? words[0] : words[1];
        EXPECT_EQ(outcome.code, 2);
        EXPECT_TRUE(outcome.err.starts_with("there is no command " + wrong + "; ")) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(words.size() == 1 ? ", replay, " : ", export"));
        EXPECT_THAT(outcome.err, testing::Not(HasSubstr("subcommand")));
    }
}

TEST(DidYouMeanTest, CommandsOptionsAndTypesOnTheCommandLine) {
    const WallFolder folder;
    const std::pair<std::vector<std::string>, const char*> cases[] = {
        {{"rnu", "wall.yml"}, "did you mean run?"},
        {{"log", "inof", "x.log"}, "did you mean info?"},
        {{"run", "wall.yml", "--ping", "2"}, "did you mean --pings?"},
        {{"run", "wall.yml", "--ouy=x"}, "did you mean --out?"},
        {{"describe", "sonar::SonarTsk"}, "did you mean sonar::SonarTask?"},
        {{"describe", "SonarTask"}, "did you mean sonar::SonarTask?"},
        {{"init", "x", "--sonar", "gemini"}, "did you mean gemini_720is?"},
        {{"run", "wall.yml", "--set", "sonra.range=3"}, "did you mean sonar?"},
        {{"run", "wall.yml", "--set", "sonar.rnage=3"}, "did you mean range?"},
        {{"run", "wall.yml", "--set", "sonar.range=3", "noise.seed=1"}, "--set sonar.range=3 --set noise.seed=1"},
        {{"run", "wall.yml", "--set", "vehicle.activity.period=1"}, "is no property: an activity can only"},
        {{"run", "wall.yml", "--pings", "1.5"}, "--pings: is 1.5; must be a whole number"}};
    for (const auto& [words, answer] : cases) {
        EXPECT_THAT(callInsonify(folder, words), isRefused(HasSubstr(answer))) << answer;
    }
}
