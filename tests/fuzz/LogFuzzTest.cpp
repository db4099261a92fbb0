#include <gtest/gtest.h>

#include "components/log/Copy.hpp"
#include "components/log/Files.hpp"
#include "components/log/PoseSources.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

/** Calls, and ignores the exceptions that a reader of logs may throw. */
void allowed(auto call) try { call(); } catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

void readLog(const Input& input) {
    allowed([&] { log::check(input.file()); });
    allowed([&] {
        const auto log = log::openLog(input.file());
        for (const log::SampleRef& at : log->samples())
            allowed([&] {
                EXPECT_LE(log->toBytes(at).size(), size_t{1} << 30);
                log->verify(at);
            });
    });
}

/** Makes poses of what could be poses in a log. */
void readPoses(const Input& input) {
    allowed([&] {
        std::vector<log::FoundPoses> found = log::findPoses(*log::openLog(input.file()));
        found.resize(std::min<size_t>(found.size(), 5));
        for (const log::FoundPoses& each : found)
            allowed([&] {
                const auto log = log::openLog(input.file());
                EXPECT_FALSE(each.text().empty());
                log::addPoses(*log, {each.source, "body.pose", types::Datum{54, 10, 0}}, types::WorldFrame::Enu);
                log->forEach<types::Pose>("body.pose", [](const types::Pose& pose, const log::SampleRef&) {
                    EXPECT_TRUE(types::isUsable(pose)) << pose.position.x;
                });
            });
    });
}

void readAndRepair(const Input& input) {
    readLog(input);
    allowed([&] {
        const auto folder = input.file().parent_path() / "repaired";
        std::filesystem::create_directory(folder);
        const auto to = folder / input.file().filename();
        log::copyLog({input.file()}, to, {log::AtDamage::Skip});
        EXPECT_TRUE(log::openLog(to)->complete());
    });
}

TEST(LogFuzzTest, EveryPocologFileIsReadUpToItsDamage) {
    push({"pocolog",
          "damaged.0.log",
          {"POCOSIM", "/base/samples/Sonar", "<typelib>", "</typelib>", "insonify_seed: 7\n"},
          readAndRepair});
}

TEST(LogFuzzTest, EveryMcapFileIsReadUpToItsDamage) {
    push({"mcap",
          "damaged.0.mcap",
          {"\x89MCAP0\r\n", "lz4", "zstd", "cdr", "ros2msg", "sensor_msgs/msg/Image", "nav_msgs/msg/Odometry"},
          [](const Input& input) { readAndRepair(input), readPoses(input); }});
}

TEST(LogFuzzTest, EveryDatabaseIsABagOrAnError) {
    push({"db3",
          "damaged.db3",
          {std::string("SQLite format 3\0", 16), "topics", "messages", "CREATE TABLE", "CREATE VIEW", "cdr",
           "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage", "/tf_static", "\x28\xb5\x2f\xfd"},
          [](const Input& input) { readLog(input), readPoses(input); }});
}

}  // namespace
}  // namespace insonify::fuzz
