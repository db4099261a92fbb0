// The device that a sonar draws on: none to be had, unknown, or chosen.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;

namespace {

/** `insonify run wall.yml` with `variables` (NAME=value) in its environment. */
Outcome runWith(const WallFolder& folder, std::vector<std::string> variables, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"env"};
    words.insert(words.end(), variables.begin(), variables.end());
    more.insert(more.begin(), {"run", "wall.yml", "--out", "out", "--pings", "2"});
    const auto command = insonifyWords(std::move(more));
    words.insert(words.end(), command.begin(), command.end());
    return Process(words, folder.path()).wait();
}

}  // namespace

TEST(DeviceTest, WithoutAnyOpenGlTheMessageSaysWhatToInstallAndSet) {
    const WallFolder folder;
    const Outcome outcome =
        runWith(folder, {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"}, {"--set", "sonar.visibility=gl"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("sonar: "), HasSubstr("no OpenGL 4.5 core context"), HasSubstr("install"),
                                   HasSubstr("libegl-mesa0"), HasSubstr("INSONIFY_EGL_DEVICE")));
}

TEST(DeviceTest, WithoutAnyOpenGlRaysNeedNone) {
    const WallFolder folder;
    const Outcome outcome = runWith(folder, {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST(DeviceTest, AnUnknownDeviceIsNamedWithWhatItMayBe) {
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

TEST(DeviceTest, ThePropertyGoesBeforeTheVariable) {
    const WallFolder folder;
    const Outcome outcome = runWith(folder, {"INSONIFY_EGL_DEVICE=quantum"}, {"--set", "sonar.device=software"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
}
