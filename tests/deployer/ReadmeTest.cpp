// What the README shows works as it stands there.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const fs::path root = INSONIFY_SOURCE_DIR;

/** The first block of code in this language. */
std::string codeOf(const std::string& language) {
    const std::string readme = readFile(root / "README.md"), fence = "```" + language + "\n";
    const size_t start = readme.find(fence) + fence.size();
    return readme.substr(start, readme.find("```", start) - start);
}

}  // namespace

TEST(ReadmeTest, TheComponentBuildsAndRunsInADeployment) {
    std::string deployment =
        replaced(wall_deployment, "tasks:\n",
                 "libraries: [mean_echo.so]\ntasks:\n  mean: {type: example::MeanEchoTask, properties: {beyond: 2}}\n");
    deployment +=
        "  - {from: sonar.ping, to: mean.ping}\n  - {from: mean.mean, to: log.mean, policy: {type: buffer, size: "
        "64}}\n";
    const WallFolder folder(deployment);
    writeFile(folder / "mean_echo.cpp", codeOf("cpp"));
    const Outcome built =
        Process({"g++", "-std=c++20", "-shared", "-fPIC", "-I" + root.string(), "mean_echo.cpp", "-o", "mean_echo.so"},
                folder.path())
            .wait();
    ASSERT_EQ(built.code, 0) << built.err;

    const Outcome outcome = folder.run({"--pings", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_EQ(
        callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "mean.mean", "--to", "mean.csv"}).code, 0);
    EXPECT_TRUE(readFile(folder / "mean.csv").starts_with("time,value\n"));
    EXPECT_THAT(callInsonify(folder, {"run", "wall.yml", "--set", "mean.beyond=-1"}).err,
                HasSubstr("tasks.mean.properties.beyond"));
}

TEST(ReadmeTest, TheFirstDeploymentIsTheMinimalOne) {
    EXPECT_THAT(readFile(root / "deploy/minimal.yml"), HasSubstr(codeOf("yaml")));
}
