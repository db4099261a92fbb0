// What goes wrong with what a run writes.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"

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
    const std::string run = insonify::test::program("insonify") + " run wall.yml --out out --pings 400 --quiet";
    const Outcome outcome = Process({"bash", "-c", "ulimit -f 1536; exec " + run}, folder.path()).wait();
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("log: "));
    const Outcome told = callInsonify(folder, {"log", "info", "out/wall.0.log", "--json"});
    EXPECT_EQ(told.code, 0) << told.err;
    EXPECT_GT(json::parse(told.out)["streams"][0]["count"], 100);
}

namespace {

/** A path of ten poses, 0.1 s apart, that leaves the wall for `far` after three of them, and is back after three more.
 */
std::string jumpingPath(const std::string& far) {
    std::string csv = "time,x,y,z,qw,qx,qy,qz\n";
    for (int i = 0; i < 10; ++i)
        csv += "0." + std::to_string(i) + "," + (i >= 3 && i < 6 ? far : "0") + ",0,0,1,0,0,0\n";
    return csv;
}

/** The wall's deployment with more properties of the sonar, along that path. */
class JumpingRun : public WallFolder {
public:
    JumpingRun(const std::string& far, const std::string& more) : WallFolder(deployment(more)) {
        writeFile(*this / "path.csv", jumpingPath(far));
        writeFile(*this / "profile.csv", "depth_m,sound_speed_m_s\n0,1500\n20,1480\n");
    }

private:
    static std::string deployment(const std::string& more) {
        const std::string text = replaced(
            wall_deployment, "waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]",
            "file: path.csv");
        return replaced(text, "      range: 20\n", "      range: 20\n      " + more + "\n");
    }
};

}  // namespace

TEST(RunFailureTest, AJumpOfThePoseEndsNoRun) {
    for (const std::string more : {"visibility: cpu", "motion_in_ping: true", "water: {profile: profile.csv}",
                                   "speckle: {coherent: true}\n      frequency_khz: 500", "multipath: {surface: {}}",
                                   "volume: {strength_db: -70}", "pulse: {bandwidth_khz: 25, window: hann}"})
        for (const std::string far : {"4000", "-1e9", "1e30", "1e300"}) {
            const JumpingRun folder(far, more);
            const Outcome outcome = folder.run({"--pings", "12", "--summary", "summary.json"});
            ASSERT_EQ(outcome.code, 0) << more << ", " << far << ": " << outcome.err;
            EXPECT_EQ(json::parse(readFile(folder / "summary.json"))["pings"], 12) << more << ", " << far;
            const std::string warning = "warning: sonar: the sonar has moved ";
            EXPECT_EQ(outcome.err.find(warning), outcome.err.rfind(warning)) << outcome.err;
            EXPECT_THAT(outcome.err, HasSubstr(warning)) << more << ", " << far;
        }
}
