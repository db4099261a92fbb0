// The device of a sonar's rasterisation: unavailable, unknown, or chosen.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;

namespace {

/** The output of a command for wall.yml where EGL has one vendor, and whether the command has called EGL. */
std::pair<Outcome, bool> witnessed(const WallFolder& folder, std::vector<std::string> arguments) {
    const fs::path vendor = folder / "vendor.json", mark = folder / "asked";
    fs::remove(mark);
    std::ofstream(vendor) << R"({"file_format_version": "1.0.0", "ICD": {"library_path": ")"
                          << insonify::test::program("libinsonify_egl_witness.so") << "\"}}";
    std::vector<std::string> words = {"env", "__EGL_VENDOR_LIBRARY_FILENAMES=" + vendor.string(),
                                      "INSONIFY_EGL_WITNESS=" + mark.string()};
    const auto command = insonifyWords(std::move(arguments));
    words.insert(words.end(), command.begin(), command.end());
    Outcome outcome = Process(words, folder.path()).wait();
    return {std::move(outcome), fs::exists(mark)};
}

/** `insonify run wall.yml` with `variables` (NAME=value) in its environment. */
Outcome runWith(const WallFolder& folder, std::vector<std::string> variables, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"env"};
    words.insert(words.end(), variables.begin(), variables.end());
    more.insert(more.begin(), {"run", "wall.yml", "--out", "out", "--pings", "2"});
    const auto command = insonifyWords(std::move(more));
    words.insert(words.end(), command.begin(), command.end());
    return Process(words, folder.path()).wait();
}

/** Variables that hide all devices from EGL, and all of EGL from the system. */
const std::string ways_without_gl[] = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent",
                                       "LD_PRELOAD=" + insonify::test::program("libinsonify_no_egl.so")};

}  // namespace

TEST(DeviceTest, WithoutOpenGlTheMessageNamesPackagesAndSettings) {
    for (const std::string& way : ways_without_gl) {
        const WallFolder folder;
        const Outcome outcome = runWith(folder, {way}, {"--set", "sonar.visibility=gl"});
        EXPECT_EQ(outcome.code, 1) << way;
        EXPECT_THAT(outcome.err,
                    AllOf(HasSubstr("sonar: "), HasSubstr("no OpenGL 4.5 core context"), HasSubstr("install"),
                          HasSubstr("libegl-mesa0"), HasSubstr("INSONIFY_EGL_DEVICE")));
    }
}

TEST(DeviceTest, RayTracingWorksWithoutOpenGl) {
    for (const std::string& way : ways_without_gl) {
        const WallFolder folder;
        EXPECT_THAT(runWith(folder, {way}), succeeds()) << way;
    }
}

TEST(DeviceTest, AnUnknownDeviceIsNamedWithTheAlternatives) {
    for (const std::string device : {"quantum", "4000000000"}) {
        const WallFolder folder;
        for (const Outcome& outcome : {runWith(folder, {"INSONIFY_EGL_DEVICE=" + device}),
                                       runWith(folder, {}, {"--set", "sonar.device=" + device})}) {
            EXPECT_EQ(outcome.code, 2);
            EXPECT_FALSE(fs::exists(folder / "out/wall.0.log")) << "nothing has started";
            EXPECT_THAT(outcome.err,
                        AllOf(HasSubstr("'" + device + "'"), HasSubstr("auto, software or a number below ")));
        }
    }
}

TEST(DeviceTest, ThePropertyOverridesTheVariable) {
    const WallFolder folder;
    EXPECT_THAT(runWith(folder, {"INSONIFY_EGL_DEVICE=quantum"}, {"--set", "sonar.device=software"}), succeeds());
}

TEST(DeviceTest, RequestsNoDeviceForRayTracingOrWithoutAGraphicsCard) {
    const bool may_have_card = fs::exists("/dev/dri") || fs::exists("/dev/nvidiactl") || fs::exists("/dev/dxg");
    for (const std::string choice : {"visibility: cpu", "motion_in_ping: true", "visibility: auto"}) {
        const WallFolder folder(replaced(wall_deployment, "range: 20", choice + "\n      range: 20"));
        const auto [outcome, asked] = witnessed(folder, {"run", "wall.yml", "--pings", "1"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(asked, choice == "visibility: auto" && may_have_card) << choice;
    }
}

TEST(DeviceTest, ChecksADeploymentWithoutRequestingADevice) {
    for (const std::string visibility : {"auto", "gl", "cpu"}) {
        const auto with = [&](const std::string& more) {
            return WallFolder(
                replaced(wall_deployment, "range: 20", "visibility: " + visibility + "\n      range: " + more));
        };
        const auto [good, asked_for_good] = witnessed(with("20"), {"check", "wall.yml"});
        EXPECT_EQ(good.code, 0) << good.err;
        EXPECT_FALSE(asked_for_good) << visibility;
        const auto [bad, asked_for_bad] = witnessed(with("-20"), {"check", "wall.yml"});
        EXPECT_THAT(bad, isRefused(HasSubstr("range")));
        EXPECT_FALSE(asked_for_bad) << visibility;
        const auto [refused, asked_for_refused] = witnessed(with("-20"), {"run", "wall.yml", "--pings", "1"});
        EXPECT_EQ(refused.code, 2);
        EXPECT_FALSE(asked_for_refused) << "the error is found before";
    }
    const WallFolder rasterised(replaced(wall_deployment, "range: 20", "visibility: gl\n      range: 20"));
    const auto [outcome, asked] = witnessed(rasterised, {"run", "wall.yml", "--pings", "1"});
    EXPECT_TRUE(asked) << "the witness works";
    EXPECT_EQ(outcome.code, 1) << "it is not a device";
}
