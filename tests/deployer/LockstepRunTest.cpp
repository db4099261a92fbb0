// A lockstep run of one file and seed gives one log, bit for bit, for any load of the machine.
#include <gtest/gtest.h>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;

namespace {

/** A deployment of deploy/ in its own folder, with a text replaced. */
struct DeployFolder : TestFolder {
    DeployFolder(const std::string& name, const std::string& what, const std::string& with) {
        const fs::path deploy = fs::path(insonify::test::source_dir) / "deploy";
        fs::create_symlink(deploy / "scenes", *this / "scenes");
        writeFile(*this / "x.yml", replaced(readFile(deploy / name), what, with));
    }
    /** Returns the log `name` of a run, which must have more than `least` bytes. */
    std::string makeLog(const std::string& out, const std::string& name, size_t minimum,
                        const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"run", "x.yml", "--out", out, "--pings", "6"};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_THAT(callInsonify(*this, words), succeeds());
        const std::string log = readFile(path() / out / name);
        EXPECT_GT(log.size(), minimum);
        return log;
    }
};

}  // namespace

TEST(LockstepRunTest, TheShortestDeploymentTwiceGivesOneLogAndOnePicture) {
    const DeployFolder folder(
        "minimal.yml", "tasks:\n",
        "schedule: lockstep\ntasks:\n  log: {type: logger::LoggerTask, properties: {file: x.0.log}}\n");
    const std::string deployment = readFile(folder / "x.yml");
    writeFile(folder / "x.yml", deployment +
                                    "  - {from: sonar.ping, to: log.ping, policy: {type: buffer, size: 64}}\n"
                                    "  - {from: vehicle.pose, to: log.pose, policy: {type: buffer, size: 64}}\n");
    const size_t pings = 6 * 256 * 500 * sizeof(float);
    EXPECT_TRUE(folder.makeLog("first", "x.0.log", pings) == folder.makeLog("second", "x.0.log", pings));
    for (const char* picture : {"fan_000000.png", "fan_000005.png"}) {
        const std::string first = readFile(folder.path() / "first" / picture);
        EXPECT_GT(first.size(), 1000u);
        EXPECT_TRUE(first == readFile(folder.path() / "second" / picture)) << picture;
    }
}

TEST(LockstepRunTest, ANoisyFanOfTheHarbourTwiceGivesOneLogAndAnotherSeedAnother) {
    const DeployFolder folder("gemini_720i.yml", "file: fan_%06d.png, every: 10, ", "");
    const size_t pings = 6 * 256 * 500 * sizeof(float);
    const std::string first = folder.makeLog("first", "gemini.0.log", pings);
    EXPECT_TRUE(first == folder.makeLog("second", "gemini.0.log", pings));
    EXPECT_FALSE(first == folder.makeLog("third", "gemini.0.log", pings, {"--seed", "2"}));
}
