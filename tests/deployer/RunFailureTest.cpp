// Failures of a run's output.
#include <gmock/gmock.h>

#include <csignal>
#include <regex>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Waiting.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

TEST(RunFailureTest, AnOutputFolderThatCannotBeWrittenIsExitCode2) {
    const WallFolder folder;
    writeFile(folder / "out", "a file where a folder should be");
    for (const char* out : {"out", "out/below", "/proc/insonify"}) {
        const Outcome outcome = callInsonify(folder, {"run", "wall.yml", "--out", out});
        EXPECT_THAT(outcome, isRefused(HasSubstr(out))) << out;
        EXPECT_EQ(outcome.out, "");
    }
}

TEST(RunFailureTest, ASummaryThatCannotBeWrittenIsExitCode2BeforeTheRun) {
    const WallFolder folder;
    EXPECT_THAT(folder.run({"--pings", "1", "--summary", "nowhere/summary.json"}),
                isRefused(HasSubstr("nowhere/summary.json")));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(RunFailureTest, AFullDiskIsExitCode1AndFlushedSamplesAreKept) {
    const WallFolder folder;
    const std::string run = insonify::test::program("insonify") + " run wall.yml --out out --pings 400";
    const Outcome outcome = Process({"bash", "-c", "ulimit -f 1536; exec " + run}, folder.path()).wait();
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("log: "));
    EXPECT_THAT(outcome.out, HasSubstr("log: Exception\n"));
    const Outcome reported = callInsonify(folder, {"log", "info", "out/wall.0.log", "--json"});
    EXPECT_EQ(reported.code, 0) << reported.err;
    EXPECT_GT(json::parse(reported.out)["streams"][0]["count"], 100);
}

/** Log and pictures are written to a disk that is full until the log and two pictures have failed. */
TEST(RunFailureTest, InRealtimeAFullDiskStopsNeitherTheSonarNorTheRun) {
    const std::string text = replaced(
        realtimeWall(), "  log:\n", "  fan: {type: output::FanImageTask, properties: {file: fan_%06d.png}}\n  log:\n");
    const WallFolder folder(text + "  - {from: noise.noisy, to: fan.ping}\n");
    fs::create_directory(folder / "out");
    const std::vector<fs::path> full{folder / "out/wall.0.log", folder / "out/fan_000000.png",
                                     folder / "out/fan_000001.png"};
    for (const fs::path& file : full) fs::create_symlink("/dev/full", file);
    const Process run(insonifyWords({"run", "wall.yml", "--out", "out", "--summary", "summary.json"}), folder.path());
    const auto appears = [&](const char* file) {
        return insonify::test::becomesTrue([&] { return fs::exists(folder / file); });
    };
    EXPECT_TRUE(says(folder, "samples are lost until a file can be written"));
    EXPECT_TRUE(appears("out/fan_000002.png"));
    for (const fs::path& file : full) fs::remove(file);
    EXPECT_TRUE(says(folder, "log: records again, in "));
    EXPECT_TRUE(appears("out/fan_000030.png"));
    run.signal(SIGINT);
    const Outcome outcome = run.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("No space left on device; samples are lost until a file can be written"));
    EXPECT_THAT(outcome.err, HasSubstr("warning: fan: 2 pictures are in no file; the last reason: cannot write "));
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_GE(summary["pings"], 30);
    const json info = json::parse(callInsonify(folder, {"log", "info", "out/wall.0.log", "--json"}).out);
    std::smatch lost;
    ASSERT_TRUE(std::regex_search(outcome.err, lost, std::regex("log: ([0-9]+) samples are in no file")));
    uint64_t in_file = 0;
    for (const json& stream : info["streams"]) in_file += stream["count"].get<uint64_t>();
    EXPECT_GT(in_file, 10u);
    EXPECT_GE(in_file + std::stoul(lost[1]), 3 * summary["pings"].get<uint64_t>());  // clean, noisy and pose
}

namespace {

/** A path of ten poses, 0.1 s apart: after three poses it jumps from the wall to `far`, after three more it returns. */
std::string jumpingPath(const std::string& far) {
    std::string csv = "time,x,y,z,qw,qx,qy,qz\n";
    for (int i = 0; i < 10; ++i)
        csv += "0." + std::to_string(i) + "," + (i >= 3 && i < 6 ? far : "0") + ",0,0,1,0,0,0\n";
    return csv;
}

/** The wall's deployment with additional properties of the sonar, along that path. */
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

TEST(RunFailureTest, AJumpOfThePoseDoesNotEndTheRun) {
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

/** Runs a deployment with a limited number of threads besides the first. */
Outcome runWithThreads(const WallFolder& folder, int threads, const std::string& deployment, int pings = 2) {
    const std::string limited = "INSONIFY_THREADS=" + std::to_string(threads) +
                                " LD_PRELOAD=" + insonify::test::program("libinsonify_thread_limit.so") + " ";
    const std::string run =
        insonify::test::program("insonify") + " run " + deployment + " --out out --pings " + std::to_string(pings);
    return Process({"bash", "-c", limited + run}, folder.path()).wait();
}

/** A sonar that crosses a border of cells makes trees ahead, on a thread that only it can do without. */
TEST(RunFailureTest, ARunWithoutAThreadForWhatIsMadeAheadHasTheSamePings) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer must be the first library";
#endif
    const WallFolder folder("", makeGltf({270, -20, 20, 270, -20, -20, 270, 20, -20, 270, 20, 20}, {0, 1, 2, 0, 2, 3}));
    std::string text =
        replaced(wall_deployment, "{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}",
                 "{time: 0, position: [252, 0, -1]}, {time: 2, position: [262, 0, -1]}");
    writeFile(folder / "wall.yml", replaced(text, "      range: 20\n", "      range: 20\n      visibility: cpu\n"));
    constexpr int most = 60, pings = 20;
    const auto getBins = [&](int threads) {
        fs::remove_all(folder / "out");
        const Outcome outcome = runWithThreads(folder, threads, "wall.yml", pings);
        if (outcome.code != 0) return std::string();
        const Outcome out =
            callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "sonar.ping", "--to", "x.npz"});
        EXPECT_EQ(out.code, 0) << out.err;
        return readFile(folder / "x.npz");
    };
    int threads = 0;
    std::string fewest;
    for (; threads < most && fewest.empty(); ++threads) fewest = getBins(threads);
    EXPECT_LT(threads, most);
    EXPECT_EQ(fewest, getBins(threads)) << "with one thread more";
    EXPECT_EQ(fewest, getBins(1000)) << "with all threads";
}

TEST(RunFailureTest, EveryThreadThatIsRefusedIsAnErrorOfTheRun) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer must be the first library";
#endif
    const WallFolder folder;
    std::string more = replaced(wall_deployment, "connections:\n", R"(  fan:
    type: output::FanImageTask
    properties: {file: fan_%02d.png, width: 256}
connections:
  - {from: noise.noisy, to: fan.ping, policy: {type: buffer, size: 8}}
)");
    writeFile(folder / "lockstep.yml", more);
    writeFile(folder / "realtime.yml", replaced(more, "schedule: lockstep", "schedule: realtime"));
    for (const std::string deployment : {"lockstep.yml", "realtime.yml"}) {
        constexpr int most = 60;
        int threads = 0;
        for (; threads < most; ++threads) {
            fs::remove_all(folder / "out");
            const Outcome outcome = runWithThreads(folder, threads, deployment);
            if (outcome.code == 0) break;
            EXPECT_THAT(outcome.code, testing::AnyOf(1, 2)) << deployment << " with " << threads << ": " << outcome;
            EXPECT_THAT(outcome.err + outcome.out, HasSubstr("no thread for ")) << deployment << " with " << threads;
        }
        EXPECT_GE(threads, 6) << "the tasks have a thread each";
        EXPECT_LT(threads, most);
    }
}
