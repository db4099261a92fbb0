// Scene files that cannot be read: exit code 2 and a message that names the file; nothing has run.
#include <gmock/gmock.h>

#include <limits>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

void expectRefused(const WallFolder& folder, const std::string& message) {
    EXPECT_THAT(folder.run(), isRefused(AllOf(HasSubstr("wall.gltf"), HasSubstr(message))));
    EXPECT_FALSE(fs::exists(folder / "out")) << "a run that did not start leaves no file";
}

}  // namespace

TEST(BadSceneTest, AMissingFileIsNamed) {
    const WallFolder folder;
    fs::remove(folder / "wall.gltf");
    expectRefused(folder, "");
}

TEST(BadSceneTest, ReportsAnIndexOutOfRangeWithItsPrimitive) {
    expectRefused(WallFolder(wall_deployment, makeGltf({10, -20, 20, 10, -20, -20, 10, 20, -20}, {0, 1, 3})), "mesh");
}

TEST(BadSceneTest, VerticesThatAreNaNAreDroppedWithANotice) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const WallFolder folder(wall_deployment,
                            makeGltf({10, -20, 20, 10, -20, -20, 10, 20, -20, nan, 20, 20}, {0, 1, 2, 0, 2, 3}));
    const Outcome outcome = folder.run();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("notice: scene: "));
}

TEST(BadSceneTest, ASceneWithoutATriangleIsAnEmptySea) {
    const WallFolder folder(wall_deployment, R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "scene": 0})");
    EXPECT_THAT(folder.run(), succeeds());
    ASSERT_EQ(
        callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "sonar.ping", "--to", "ping.npz"}).code,
        0);
    EXPECT_EQ(python(folder, "import numpy; print(abs(numpy.load('ping.npz')['bins']).max())").out, "0.0\n");
}
