// Files of this program read by other programs, and the reverse.
#include <gmock/gmock.h>

#include "tests/log/mcap/SmallFile.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

namespace insonify::log::mcap {
namespace {

constexpr const char* missing = "SKIPPED: Python packages mcap, mcap_ros2 and rosbags; scripts/setup installs them";

struct PythonTest : testing::Test {
    void SetUp() override {
        if (!pythonHas("mcap, mcap_ros2, rosbags")) GTEST_SKIP() << missing;
    }
    std::string says(const std::string& script, const std::string& arguments) {
        return pythonSays(test::sourceFile("tests/log/mcap/") + script + " " + arguments, answers_ / "answer");
    }
    const Folder folder_, answers_;
};

TEST_F(PythonTest, McapAndRosbagsReadWrittenFiles) {
    smallFile(folder_ / "x.0.mcap");
    EXPECT_EQ(
        says("read_mcap.py", (folder_ / "x.0.mcap").string()),
        "profile ros2, by insonify, 10 messages, 1 chunks\n"
        "metadata insonify {'insonify_deployment': 'tasks:\\n  a: \"b\"\\n', 'insonify_seed': '7'}\n"
        "/sonar/ping marine_acoustic_msgs/msg/ProjectedSonarImage 10000001000 1000 [1.0, 4.0, 2.0, 5.0, 3.0, nan]\n"
        "/sonar/ping marine_acoustic_msgs/msg/ProjectedSonarImage 10000002000 2000 [1.0, 4.0, 2.0, 5.0, 3.0, nan]\n"
        "/sonar/ping marine_acoustic_msgs/msg/ProjectedSonarImage 10000003000 3000 [1.0, 4.0, 2.0, 5.0, 3.0, nan]\n"
        "/vehicle/pose nav_msgs/msg/Odometry 10000001000 1000 [0.1, -0.2, 0.3]\n"
        "/vehicle/pose nav_msgs/msg/Odometry 10000002000 2000 [0.1, -0.2, 0.3]\n"
        "rosbags: 10 messages of /clock, /sonar/ping, /tf, /vehicle/pose in 0.002001 ms\n"
        "rosbags: [1.0, 4.0, 2.0, 5.0, 3.0, nan] at 1000 ns\n");
}

TEST_F(PythonTest, RosbagsReadsALogOfSeveralFiles) {
    {
        SampleWriter log(folder_ / "x.0.mcap", {});
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", {});
        for (int64_t i = 1; i <= 3; ++i) {
            log.write(ping, {i}, smallPing(i));
            if (i < 3) log.next(folder_ / ("x." + std::to_string(i) + ".mcap"));
        }
    }
    EXPECT_THAT(says("read_mcap.py", (folder_ / "x.0.mcap").string()),
                testing::HasSubstr("rosbags: 6 messages of /clock, /sonar/ping in 0.002001 ms\n"));
}

TEST_F(PythonTest, ReadsFilesOfOtherProgramsCompressedOrNot) {
    for (const std::string compression : {"none", "lz4", "zstd"}) {
        const auto path = folder_ / (compression + ".mcap");
        ASSERT_EQ(says("write_mcap.py", path.string() + " " + compression), "");
        const auto log = openLog(path);
        EXPECT_TRUE(log->complete()) << compression << ": " << log->diagnostic();
        ASSERT_EQ(log->streams().size(), 2u);
        EXPECT_EQ(log->streams()[0].name, "nav.pose");
        EXPECT_EQ(log->streams()[1].type, "std_msgs/msg/ColorRGBA");
        types::Pose pose;
        size_t count = 0;
        for (const SampleRef& at : log->samples())
            if (at.stream == 0) {
                log->read(at, pose);  // (1, 2, 3) east, north, up
                EXPECT_EQ(pose.position, glm::dvec3(2, -1, 3 + static_cast<double>(count++)));
            }
        EXPECT_EQ(count, 50u);
        EXPECT_FALSE(check(path).diagnostic) << check(path).diagnostic->message;
    }
}

}  // namespace
}  // namespace insonify::log::mcap
