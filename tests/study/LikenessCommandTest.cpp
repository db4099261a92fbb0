#include <gmock/gmock.h>

#include "components/output/PictureFiles.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/SpeckleRecording.hpp"

using namespace insonify::deployer;
using insonify::test::OculusMessage;
using testing::AnyOf;
using testing::HasSubstr;

namespace {

void record(const fs::path& file) { writeFile(file, insonify::test::recordedSpeckle()); }

/** Returns a deployment with a wall and a receiver that outputs codes. */
std::string codedWall() {
    std::string text =
        replaced(replaced(wall_deployment, "beam_count: 16", "beam_count: 64"), "bin_count: 50", "bin_count: 128");
    const std::string receiver =
        "  receiver:\n    type: receiver::ReceiverTask\n    activity: {trigger: [intensity]}\n    properties: {output: "
        "code, "
        "code: {law: sqrt, gamma: 0.5}}\n";
    text.insert(text.find("connections:"), receiver);
    return text + "  - {from: sonar.ping, to: receiver.intensity}\n";
}

}  // namespace

TEST(LikenessCommandTest, WritesTablesJsonDiagramAndPictureAndVerdicts) {
    const WallFolder folder;
    record(folder / "pings.raw");
    writeFile(folder / "coded.yml", codedWall());
    const Outcome outcome =
        callInsonify(folder, {"study", "likeness", "coded.yml", "--real", "pings.raw", "--out", "report"});
    EXPECT_EQ(outcome.code, 1) << "a wall without noise looks like no recording\n" << outcome.out << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("FAIL  speckle contrast, apart by: "));
    EXPECT_THAT(outcome.out, HasSubstr("recorded_5"));
    const json report = json::parse(readFile(folder / "report/likeness.json"));
    ASSERT_EQ(report["pings"].size(), 5u) << "two recorded, the simulated one, two wrong forms";
    EXPECT_EQ(report["pings"][2]["name"], "simulated");
    EXPECT_EQ(report["pings"][2]["histogram"].size(), 256u);
    EXPECT_NEAR(report["pings"][0]["contrast"], 0.52, 0.03) << "codes are quantised";
    EXPECT_EQ(report["verdicts"].size(), 10u);
    for (const json& verdict : report["verdicts"]) EXPECT_THAT(verdict["verdict"], AnyOf("pass", "FAIL", "open"));
    EXPECT_THAT(readFile(folder / "report/likeness.csv"), HasSubstr("\nsimulated,"));
    EXPECT_THAT(readFile(folder / "report/profiles.csv"), HasSubstr("ping,range_share,mean_code,level_db"));
    EXPECT_THAT(readFile(folder / "report/fans.png").substr(1, 3), "PNG");
}

TEST(LikenessCommandTest, WithoutADeploymentDescribesTheRecordings) {
    const WallFolder folder;
    fs::create_directory(folder / "recordings");
    record(folder / "recordings/pings.raw");
    EXPECT_THAT(callInsonify(folder, {"study", "likeness", "--real", "recordings", "--out", "report"}), succeeds());
    EXPECT_EQ(json::parse(readFile(folder / "report/likeness.json"))["pings"].size(), 4u);
}

/** Returns the speckle contrast of the amplitudes of a recording's first ping. */
double contrastOf(const WallFolder& folder, const std::string& log) {
    EXPECT_THAT(callInsonify(folder, {"study", "likeness", "--real", log, "--out", "report"}), succeeds());
    const json contrast = json::parse(readFile(folder / "report/likeness.json"))["pings"][0]["contrast"];
    return contrast.is_number() ? contrast.get<double>() : -1;
}

TEST(LikenessCommandTest, TheLawOfALogIsThatOfItsRunWithWhatWasSetFromOutside) {
    constexpr double rayleigh = 0.5227;  // sqrt(4 / pi - 1), of amplitudes
    const WallFolder folder;
    std::string text =
        replaced(codedWall(), "from: sonar.ping, to: receiver.intensity", "from: noise.noisy, to: receiver.intensity") +
        "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}\n";
    writeFile(folder / "coded.yml",
              replaced(text, "code: {law: sqrt, gamma: 0.5}", "code: {law: sqrt, gamma: 0.5, bits: 16}"));
    for (const std::string gamma : {"0.5", "1"}) {
        ASSERT_THAT(callInsonify(folder, {"run", "coded.yml", "--pings", "1", "--out", "run" + gamma, "--set",
                                          "receiver.code.gamma=" + gamma, "--set", "noise.ambient={level_db: -40}"}),
                    succeeds());
        EXPECT_NEAR(contrastOf(folder, "run" + gamma + "/wall.0.log"), rayleigh, 0.05);
    }
    EXPECT_NEAR(contrastOf(folder, "run1"), rayleigh, 0.05) << "its pictures and other files are no recordings";
    fs::remove(folder / "run1/properties.0.log");  // the deployment's text has 0.5
    EXPECT_GT(std::abs(contrastOf(folder, "run1/wall.0.log") - rayleigh), 0.15);
}

TEST(LikenessCommandTest, ReadsALogOfCodesLikeARecording) {
    const WallFolder folder;
    writeFile(folder / "coded.yml",
              codedWall() + "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}\n");
    ASSERT_EQ(callInsonify(folder, {"run", "coded.yml", "--pings", "2", "--out", "run"}).code, 0);
    Outcome outcome =
        callInsonify(folder, {"study", "likeness", "coded.yml", "--real", "run/wall.0.log", "--out", "report"});
    EXPECT_EQ(outcome.code, 1) << "without speckle there is no contrast to compare\n" << outcome.out << outcome.err;
    const json report = json::parse(readFile(folder / "report/likeness.json"));
    EXPECT_EQ(report["pings"][0]["name"], "recorded_0");
    EXPECT_NEAR(report["pings"][1]["emd_codes"].get<double>(), 0, 1e-6)
        << "the wall is still: the same ping, the law from the log";
    ASSERT_EQ(callInsonify(folder, {"run", "wall.yml", "--pings", "1", "--out", "plain"}).code, 0);
    outcome = callInsonify(folder, {"study", "likeness", "--real", "plain/wall.0.log", "--out", "report"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("has no stream of pings of codes")));
}

TEST(LikenessCommandTest, ASideScanIsAPictureOfItsLines) {
    const std::string recording = insonify::test::sharedFile("sonar/xtf/scotsman-iver2.xtf");
    if (!fs::exists(recording))
        GTEST_SKIP() << "NOT TESTED: the recording of a side-scan is not next to the repository";
    const std::string floor =
        makeGltf({-200, -8, 200, 200, -8, 200, 200, -8, -200, -200, -8, -200}, {0, 1, 2, 0, 2, 3});
    std::string text = replaced(replaced(codedWall(), ", gamma: 0.5", ""), "sonar::SonarTask", "sonar::SideScanTask");
    text = replaced(replaced(text, "beam_count: 64\n", "frequency_khz: 600\n"), "      field_of_view_deg: 60\n", "");
    text = replaced(replaced(text, "beam_height_deg: 10\n", "beam_height_deg: 60\n"), "range: 20", "range: 30");
    const WallFolder folder(replaced(text, "bin_count: 128", "bin_count: 1024"), floor);
    const Outcome outcome =
        callInsonify(folder, {"study", "likeness", "wall.yml", "--real", recording, "--out", "report"});
    EXPECT_EQ(outcome.code, 1) << "without noise it looks like no recording\n" << outcome.out << outcome.err;
    const json report = json::parse(readFile(folder / "report/likeness.json"));
    ASSERT_EQ(report["pings"].size(), 4u) << "starboard, the simulated one, two wrong forms";
    EXPECT_EQ(report["pings"][0]["name"], "recorded_starboard");
    EXPECT_EQ(report["pings"][1]["name"], "simulated");
    EXPECT_NEAR(report["pings"][0]["contrast"].get<double>(), 0.35, 0.1)
        << "of codes that go as amplitude, measured elsewhere";
    EXPECT_NEAR(report["pings"][0]["range_correlation"].get<double>(), 0.13, 0.08);
    EXPECT_NEAR(report["pings"][0]["saturated"].get<double>(), 0.03, 0.01);
}

/** All 72 pictures of the sweep meet the tolerances of these figures, and 40 of them 1.05 times these. The preset of an
 *  ARIS is as `init` writes it, over a tank of bottles, cans, tires, a propeller and a chain: figures of
 * its background are those of real pictures. Those of the objects themselves are in the table of components/study. */
TEST(LikenessTankTest, ThePresetOfAnArisHasTheBackgroundOfRealPictures) {
    const WallFolder folder;
    if (callInsonify(folder, {"scene", "make", "--list"}).code != 0)
        GTEST_SKIP() << "NOT TESTED: the Python of recipes is not here; scripts/setup worlds installs it";
    ASSERT_THAT(callInsonify(folder, {"init", "aris", "--sonar", "aris_3000"}), succeeds());
    const std::string sweep = insonify::test::sourceFile("deploy/sweeps/objects.yml");
    ASSERT_THAT(callInsonify(
                    folder, {"dataset", "aris", "--sweep", sweep, "--out", "set", "--format", "mask", "--count", "40"}),
                succeeds());
    const Outcome outcome = callInsonify(folder, {"study", "likeness", "--objects", "set", "--out", "report"});
    const json report = json::parse(readFile(folder / "report/objects.json"));
    EXPECT_GE(report["crops"].get<int>(), 20) << outcome.err;
    for (const char* name :
         {"correlation_across_1", "correlation_across_2", "correlation_across_3", "correlation_along_1",
          "background_skew", "step_over_deviation", "background_minus_darkest"}) {
        const json& figure = report["figures"][name];
        EXPECT_NEAR(figure["median"].get<double>(), figure["real"].get<double>(),
                    1.05 * figure["tolerance"].get<double>())
            << name << "\n"
            << outcome.out;
    }
}

TEST(LikenessCommandTest, ReadsCropsOfObjectsAndRefusesWhatHasNone) {
    const WallFolder folder;
    fs::create_directory(folder / "crops");
    EXPECT_THAT(callInsonify(folder, {"study", "likeness", "--objects", "crops"}),
                isRefused(HasSubstr("crops: --objects: has no picture; it may be a data set of fans")));
    EXPECT_THAT(callInsonify(folder, {"study", "likeness", "--objects", "nowhere"}),
                isRefused(HasSubstr("nowhere: --objects: cannot be read")));
    EXPECT_THAT(callInsonify(folder, {"study", "likeness", "--objects", "crops", "--real", "crops"}),
                isRefused(HasSubstr("excludes")));
    EXPECT_THAT(callInsonify(folder, {"study", "likeness"}), isRefused(HasSubstr("--real or --objects is required")));
    insonify::types::Image grey;
    grey.size = {96, 96};
    grey.pixel_size = 1;
    grey.row_size = 96;
    grey.frame_mode = insonify::types::ImageMode::Grayscale;
    grey.frame_status = insonify::types::ImageStatus::Valid;
    for (int i = 0; i < 96 * 96; ++i) grey.image.push_back(static_cast<uint8_t>(90 + i * 7919 % 13));
    for (int i = 0; i < 10; ++i) insonify::output::writePng(folder / ("crops/" + std::to_string(i) + ".png"), grey);
    const Outcome outcome = callInsonify(folder, {"study", "likeness", "--objects", "crops", "--out", "report"});
    EXPECT_EQ(outcome.code, 1) << "grey dots look like no object\n" << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("10 crops; the median of each figure"));
    EXPECT_THAT(outcome.out, HasSubstr("FAIL  highlight_run_across"));
    EXPECT_EQ(json::parse(readFile(folder / "report/objects.json"))["verdicts"].size(), 11u);
    EXPECT_THAT(readFile(folder / "report/objects.csv"), HasSubstr("\nreal,0.57,0.21,0.06,0.44,0.13,-0.01,4.5,7.5"));
    writeFile(folder / "crops/no.png", "no picture");
    EXPECT_THAT(callInsonify(folder, {"study", "likeness", "--objects", "crops"}), isRefused(HasSubstr("no.png")));
}

TEST(LikenessCommandTest, RefusesWhatCannotBeCompared) {
    const WallFolder folder;
    record(folder / "pings.raw");
    Outcome outcome = callInsonify(folder, {"study", "likeness", "wall.yml", "--real", "pings.raw", "--out", "report"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("has no receiver that outputs codes")));
    outcome = callInsonify(folder, {"study", "likeness", "--real", "wall.yml", "--out", "report"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("wall.yml: --real: holds no ping of an Oculus")));
    fs::create_directory(folder / "empty");
    outcome = callInsonify(folder, {"study", "likeness", "--real", "empty", "--out", "report"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("is a folder without a recording")));
    const auto small = OculusMessage{}.bytes();
    writeFile(folder / "small.raw", std::string(small.begin(), small.end()));
    outcome = callInsonify(folder, {"study", "likeness", "--real", "small.raw", "--out", "report"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("bins; these statistics need at least 32 x 64")));
    EXPECT_FALSE(fs::exists(folder / "report")) << "nothing is written";
}
