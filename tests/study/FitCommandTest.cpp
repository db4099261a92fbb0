// `insonify fit`, called as a user does.
#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <sstream>

#include "components/output/PictureFiles.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/SpeckleRecording.hpp"

using namespace insonify::deployer;
using insonify::test::OculusMessage;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

namespace {

/** A flat floor 0.6 m below the sonar, noise, and a receiver that outputs codes. */
std::string floorGltf() {
    return makeGltf({-50, -0.6f, 50, 50, -0.6f, 50, 50, -0.6f, -50, -50, -0.6f, -50}, {0, 1, 2, 0, 2, 3});
}

const std::string fit_deployment = R"(schedule: lockstep
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties: {waypoints: [{time: 0, position: [0, 0, 0]}]}
  scene:
    type: scene::SceneTask
    activity: {trigger: [pose]}
    properties: {file: wall.gltf, mount: {pitch_deg: 35}}
  sonar:
    type: sonar::SonarTask
    activity: {trigger: [snapshot]}
    properties:
      range: 2
      beam_count: 256
      bin_count: 700
      field_of_view_deg: 60
      beam_height_deg: 40
      frequency_khz: 2100
      quality: {rows: 128, columns_per_beam: 1}
  noise:
    type: noise::NoiseTask
    activity: {trigger: [clean]}
    properties: {ambient: {level_db: -60}}
  receiver:
    type: receiver::ReceiverTask
    activity: {trigger: [intensity]}
    properties: {output: code, code: {law: sqrt, gamma: 0.5}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping, to: noise.clean}
  - {from: noise.noisy, to: receiver.intensity}
)";

struct FitFolder : WallFolder {
    FitFolder() : WallFolder(fit_deployment, floorGltf()) {}
    Outcome fit(const std::string& real, std::vector<std::string> more = {"--out", "fitted.yml"}) const {
        std::vector<std::string> arguments = {"fit", "wall.yml", "--real", real};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return callInsonify(*this, std::move(arguments));
    }
    /** Records pings of one code throughout, of 64 beams by 128 bins. */
    void recordEven(const std::string& name, uint8_t code) const {
        const auto bytes =
            OculusMessage{.beams = 64, .bins = 128, .code = [code](size_t, size_t) { return code; }}.bytes();
        writeFile(*this / name, std::string(bytes.begin(), bytes.end()));
    }
};

/** Returns the folder of three pings of a real Oculus, or an empty name. */
std::string realPings() {
    const std::string file = insonify::test::sharedFile("sonar/oculus/three_pings_8bit.raw");
    return fs::exists(file) ? file : "";
}

}  // namespace

TEST(FitCommandTest, AFitToOnePingOfARealOculusPassesLikenessOnTheOthers) {
    if (realPings().empty()) GTEST_SKIP() << "NOT TESTED: the recordings of an Oculus are not next to the repository";
    const FitFolder folder;
    const std::string all = readFile(realPings());
    const size_t size = all.size() / 3;
    for (size_t i = 0; i < 3; ++i)
        writeFile(folder / ("ping_" + std::to_string(i) + ".raw"), all.substr(i * size, size));
    Outcome outcome = folder.fit("ping_0.raw", {"--scene-is", "rough", "--out", "fitted.yml"});
    ASSERT_THAT(outcome, prints(AllOf(HasSubstr("full scale"),
                                      HasSubstr("source level         not determined by this recording: "))));
    EXPECT_THAT(readFile(folder / "fitted.yml"),
                AllOf(HasSubstr("# Fitted by insonify fit"), HasSubstr("# beam width: ")));
    EXPECT_THAT(readFile(folder / "fitted.html"), AllOf(HasSubstr("fitted.png"), HasSubstr("Level over range")));
    EXPECT_THAT(readFile(folder / "fitted.png").substr(1, 3), "PNG");
    outcome = callInsonify(
        folder, {"study", "likeness", "fitted.yml", "--real", "ping_1.raw", "ping_2.raw", "--out", "report"});
    EXPECT_THAT(outcome, prints(Not(HasSubstr("FAIL")))) << outcome.out << outcome.err;
}

TEST(FitCommandTest, AFitToTheFirstHalfOfASideScansLogPassesLikenessOnTheSecond) {
    const std::string recording = insonify::test::sharedFile("sonar/xtf/scotsman-iver2.xtf");
    if (!fs::exists(recording))
        GTEST_SKIP() << "NOT TESTED: the recording of a side-scan is not next to the repository";
    const FitFolder folder;
    const auto call = [&](std::vector<std::string> arguments) { return callInsonify(folder, std::move(arguments)); };
    ASSERT_EQ(call({"log", "import", recording, "--to", "whole.0.log"}).code, 0);
    ASSERT_EQ(call({"log", "cut", "whole.0.log", "--until", "25.9", "--to", "first.0.log"}).code, 0);
    ASSERT_EQ(call({"log", "cut", "whole.0.log", "--from", "25.9", "--to", "second.0.log"}).code, 0);
    ASSERT_THAT(call({"fit", insonify::test::sourceFile("deploy/sidescan_recording.yml"), "--real", "first.0.log",
                      "--scene-is", "rough", "--out", "fitted.yml"}),
                prints(AllOf(HasSubstr("depression           25."), HasSubstr("transmitter          0.2342 "))));
    EXPECT_THAT(readFile(folder / "fitted.yml"), AllOf(HasSubstr("bits: 15"), HasSubstr("ring_down: ")));
    const auto failedClaims = [&](const std::string& side, std::vector<std::string> settings) {
        std::vector<std::string> words{"study",        "likeness", "fitted.yml", "--real",
                                       "second.0.log", "--lines",  "recorded",   "--side",
                                       side,           "--out",    side};
        words.insert(words.end(), settings.begin(), settings.end());
        const Outcome found = call(words);
        std::vector<std::string> failed;
        std::istringstream lines(found.out);
        for (std::string line; std::getline(lines, line);)
            if (line.starts_with("FAIL")) failed.push_back(line);
        EXPECT_EQ(found.code, failed.empty() ? 0 : 1) << found.err;
        EXPECT_THAT(found.out, HasSubstr("pass  share of code 0"));
        return failed;
    };
    EXPECT_THAT(failedClaims("port", {}), IsEmpty());
    const std::string wreck = insonify::test::sourceFile("deploy/scenes/sand_wreck.glb");
    EXPECT_THAT(failedClaims("starboard", {"--set", "scene.file=" + wreck}), IsEmpty());
    // A wreck covers half of these lines, and the fit's scene is a floor alone.
    EXPECT_THAT(failedClaims("starboard", {}), ElementsAre(StartsWith("FAIL  share of saturated codes")));
}

/** Speckle in a polar picture; the range is the deployment's. */
TEST(FitCommandTest, APictureIsFitted) {
    const FitFolder folder;
    insonify::types::Image picture;
    picture.size = {128, 256}, picture.row_size = 128, picture.pixel_size = 1;
    picture.frame_mode = insonify::types::ImageMode::Grayscale;
    std::mt19937 random(3);
    for (int row = 255; row >= 0; --row)
        for (int beam = 0; beam < 128; ++beam)
            picture.image.push_back(static_cast<uint8_t>(
                std::min(255.0, 40 * std::sqrt(std::exponential_distribution<double>()(random)) + 10)));
    insonify::output::writePng(folder / "ping.png", picture);
    EXPECT_THAT(folder.fit("ping.png"), isRefused(HasSubstr("give --field-of-view-deg")));
    const Outcome outcome = folder.fit(
        "ping.png", {"--shape", "polar", "--field-of-view-deg", "30", "--scene-is", "rough", "--out", "fitted.yml"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(readFile(folder / "fitted.yml"), AllOf(HasSubstr("range: 2"), HasSubstr("bin_count: 256")));
}

TEST(FitCommandTest, AFitIsReproducible) {
    const FitFolder folder;
    writeFile(folder / "speckle.raw", insonify::test::recordedSpeckle());
    ASSERT_EQ(folder.fit("speckle.raw").code, 0);
    const std::string first = readFile(folder / "fitted.yml");
    ASSERT_EQ(folder.fit("speckle.raw").code, 0);
    EXPECT_EQ(readFile(folder / "fitted.yml"), first);
}

TEST(FitCommandTest, RefusesWrongUseWithAReasonAndWritesNothing) {
    const FitFolder folder;
    writeFile(folder / "speckle.raw", insonify::test::recordedSpeckle());
    writeFile(folder / "text.raw", "no recording");
    writeFile(folder / "empty.raw", "");
    std::string without_noise = fit_deployment;
    for (const char* line : {"  noise:\n    type: noise::NoiseTask\n    activity: {trigger: [clean]}\n    properties: "
                             "{ambient: {level_db: -60}}\n",
                             "  - {from: noise.noisy, to: receiver.intensity}\n"})
        without_noise = replaced(without_noise, line, "");
    writeFile(folder / "without_noise.yml", replaced(without_noise, "noise.clean}", "receiver.intensity}"));
    folder.recordEven("zero.raw", 0);
    folder.recordEven("saturated.raw", 255);
    const auto small = OculusMessage{}.bytes();
    writeFile(folder / "small.raw", std::string(small.begin(), small.end()));
    const std::vector<std::string> out = {"--out", "fitted.yml"};
    struct Case {
        std::vector<std::string> arguments;
        std::string reason;
    };
    const std::vector<Case> cases = {
        {{"fit", "wall.yml", "--real", "speckle.raw"}, "--out is required"},
        {{"fit", "wall.yml", "--out", "fitted.yml"}, "--real is required"},
        {{"fit", "wall.yml", "--real", "speckle.raw", "--scene-is", "flat", "--out", "fitted.yml"}, "flat"},
        {{"fit", "wall.yml", "--real", "speckle.raw", "--out", "nowhere/fitted.yml"},
         "is in a folder that does not exist: nowhere"},
        {{"fit", "wall.yml", "--real", "speckle.raw", "--out", "fitted.txt"}, "must end in .yml or .yaml"},
        {{"fit", "wall.yml", "--real", "speckle.raw", "--out", "./wall.yml"},
         "--out: is the deployment that is fitted"},
        {{"fit", "wall.yml", "--real", "ping.png", "--out", "fitted.yml", "--range", "1e9"},
         "--range: is 1e9; must be a number from 0.001 to 100000"},
        {{"fit", "wall.yml", "--real", "ping.png", "--out", "fitted.yml", "--field-of-view-deg", "361"},
         "--field-of-view-deg: is 361; must be a number from 0.001 to 360"},
        {{"fit", "wall.yml", "--real", "nothing.raw", "speckle.raw", "--out", "fitted.txt"},
         "nothing.raw: --real: does not exist; may be a file or a folder of them\nfitted.txt: --out: must end"},
        {{"fit", "nothing.yml", "--real", "speckle.raw", "--out", "fitted.yml"}, "nothing.yml"},
        {{"fit", "without_noise.yml", "--real", "speckle.raw", "--out", "fitted.yml"},
         "has no noise::NoiseTask before it"},
        {{"fit", "wall.yml", "--real", "nothing.raw", "--out", "fitted.yml"}, "nothing.raw"},
        {{"fit", "wall.yml", "--real", "text.raw", "--out", "fitted.yml"}, "text.raw"},
        {{"fit", "wall.yml", "--real", "text.raw", "--out", "fitted.yml"}, "logs of pings, and .png pictures"},
        {{"fit", "wall.yml", "--real", "empty.raw", "--out", "fitted.yml"}, "empty.raw"},
        {{"fit", "wall.yml", "--real", "small.raw", "--out", "fitted.yml"},
         "pings of 3 beams and 2 bins; a fit needs at least 32 and 64"},
        {{"fit", "wall.yml", "--real", "zero.raw", "--out", "fitted.yml"}, "codes of 0 in 100 % of its bins"},
        {{"fit", "wall.yml", "--real", "saturated.raw", "--out", "fitted.yml"}, "it is saturated"},
        {{"fit", "wall.yml", "--real", "small.raw", "speckle.raw", "--out", "fitted.yml"}, "a fit needs"},
    };
    for (const Case& each : cases) {
        const Outcome outcome = callInsonify(folder, each.arguments);
        EXPECT_THAT(outcome, isRefused(HasSubstr(each.reason))) << each.reason << "\n" << outcome.out << outcome.err;
        EXPECT_FALSE(fs::exists(folder / "fitted.yml")) << each.reason;
    }
}
