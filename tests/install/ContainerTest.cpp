// deploy/Dockerfile. People build it; this test compares it with its parts.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const fs::path root = insonify::test::source_dir;

}  // namespace

TEST(ContainerTest, ItIsMadeOfTheDebianPackagesAndRunsAsAUserOfItsOwn) {
    const std::string recipe = readFile(root / "deploy/Dockerfile");
    EXPECT_THAT(recipe, HasSubstr("COPY build/packages/*.deb "));
    EXPECT_THAT(readFile(root / "scripts/package"), HasSubstr("cpack -G DEB -B packages"));
    EXPECT_THAT(recipe, HasSubstr("\nUSER insonify\n"));
    EXPECT_THAT(recipe, HasSubstr("ENTRYPOINT [\"insonify\"]"));
    EXPECT_THAT(readFile(root / "deploy/Dockerfile.dockerignore"), HasSubstr("\n!build/packages"));
}

TEST(ContainerTest, AUserWithoutAHomeRunsTheCommand) {
    const TestFolder folder;
    install(folder);
    EXPECT_THAT(call(folder, {"env", "--ignore-environment", "HOME=/nowhere", "XDG_CACHE_HOME=/tmp",
                              folder / "prefix/bin/insonify", "run",
                              folder / "prefix/share/insonify/deploy/minimal.yml", "--out", "out"}),
                succeeds());
    EXPECT_TRUE(fs::exists(folder / "out/fan_000000.png"));
}
