// What goes wrong with what a run writes.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

TEST(RunFailureTest, AnOutputFolderThatCannotBeWrittenIsExitCode2) {
    const WallFolder folder;
    writeFile(folder / "out", "a file where a folder should be");
    for (const char* out : {"out", "out/below", "/proc/insonify"}) {
        const Outcome outcome = callInsonify(folder, {"run", "wall.yml", "--out", out});
        EXPECT_EQ(outcome.code, 2) << out;
        EXPECT_THAT(outcome.err, HasSubstr(out));
        EXPECT_EQ(outcome.out, "");
    }
}

TEST(RunFailureTest, ASummaryThatCannotBeWrittenIsExitCode2BeforeTheRun) {
    const WallFolder folder;
    const Outcome outcome = folder.run({"--pings", "1", "--summary", "nowhere/summary.json"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("nowhere/summary.json"));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(RunFailureTest, AFullDiskIsExitCode1AndWhatWasFlushedIsKept) {
    const WallFolder folder;
    const std::string run = std::string(INSONIFY_BIN_DIR) + "/insonify run wall.yml --out out --pings 400 --quiet";
    const Outcome outcome = Process({"bash", "-c", "ulimit -f 1536; exec " + run}, folder.path()).wait();
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("log: "));
    const Outcome told = callInsonify(folder, {"log", "info", "out/wall.0.log", "--json"});
    EXPECT_EQ(told.code, 0) << told.err;
    EXPECT_GT(json::parse(told.out)["streams"][0]["count"], 100);
}
