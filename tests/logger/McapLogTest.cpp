// The logger with a file that ends in .mcap.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "components/log/Files.hpp"
#include "components/log/Reader.hpp"
#include "components/logger/LoggerTask.hpp"
#include "tests/logger/LimitedDisk.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::logger {
namespace {

using framework::ConnPolicy;

types::SonarPtr pingAt(int64_t time) {
    types::Sonar ping;
    ping.time = {time};
    ping.bin_duration = {100};
    ping.resize(200, 8);
    ping.bins.assign(1600, 0.5f);
    return std::make_shared<const types::Sonar>(ping);
}

struct McapLogTest : testing::Test {
    McapLogTest() {
        config.file = "x.0.mcap";
        task.environment().output_folder = folder.path();
        task.environment().now = [] { return types::Time{5'000'000}; };
        sonar.port.connectTo(*task.makeInput("ping", sonar.port), ConnPolicy::buffer(8));
        vehicle.port.connectTo(*task.makeInput("pose", vehicle.port), ConnPolicy::buffer(8));
    }
    void start() {
        task.config.set(config);
        ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    }
    void cycle(const types::SonarPtr& ping) {
        sonar.port.write(ping);
        vehicle.port.write(types::Pose{});
        task.update();
    }
    void finish() {
        ASSERT_TRUE(task.stop());
        ASSERT_TRUE(task.cleanup());
    }

    const Folder folder;
    LoggerConfig config;
    LoggerTask task{"log"};
    test::Writer<types::SonarPtr> sonar{"sonar"};
    test::Writer<types::Pose> vehicle{"vehicle"};
};

TEST_F(McapLogTest, HasTheStreamsAndMetadataOfAPocologFile) {
    task.environment().deployment_text = "tasks: {}\n";
    task.environment().seed = 9;
    start();
    cycle(pingAt(3'000'000));
    cycle(pingAt(4'000'000));
    finish();
    EXPECT_FALSE(log::check(folder / "x.0.mcap").diagnostic);
    const auto log = log::openLog(folder / "x.0.mcap");
    ASSERT_EQ(log->samples().size(), 4u);
    const log::Stream* const stream = log->find("sonar.port");
    ASSERT_NE(stream, nullptr);
    EXPECT_TRUE(stream->holds<types::Sonar>());
    EXPECT_EQ(stream->metadata.at("insonify_deployment"), "tasks: {}\n");
    EXPECT_EQ(stream->metadata.at("insonify_seed"), "9");
    EXPECT_EQ(log->samples()[0].time.microseconds, 3'000'000);
    EXPECT_EQ(log->samples()[0].received.microseconds, 5'000'000);
    log->forEach<types::Sonar>("sonar.port", [&](const types::Sonar& ping, const log::SampleRef&) {
        EXPECT_EQ(ping.bins, std::vector<float>(1600, 0.5f));
    });
}

TEST_F(McapLogTest, TheTasksThreadAllocatesNothingOnceItRuns) {
    start();
    const auto ping = pingAt(1);
    cycle(ping);
    EXPECT_THAT(test::allocationsOn(task,
                                    [&] {
                                        for (int i = 0; i < 200; ++i) cycle(ping);
                                    }),
                testing::IsEmpty());
    finish();
    EXPECT_EQ(log::openLog(folder / "x.0.mcap")->samples().size(), 402u);
}

TEST_F(McapLogTest, ALogContinuesInTheNextFileWithoutLoss) {
    config.max_file_size = 1e6;
    start();
    for (int i = 1; i <= 400; ++i) cycle(pingAt(i));
    finish();
    size_t samples = 0;
    int files = 0;
    for (std::filesystem::path file = folder / "x.0.mcap"; std::filesystem::exists(file);
         file = folder / ("x." + std::to_string(++files) + ".mcap")) {
        EXPECT_FALSE(log::check(file).diagnostic) << file;
        samples += log::openLog(file)->samples().size();
    }
    EXPECT_GE(files, 3);
    EXPECT_EQ(samples, 800u);
}

/** 1000 bytes that cannot be compressed. */
std::string noise(std::minstd_rand& random) {
    std::string text(1000, '\0');
    std::ranges::generate(text, [&] { return static_cast<char>(random() >> 8); });
    return text;
}

TEST(McapLogFailureTest, KeepsFlushedSamplesOnAFullDisk) {
    const Folder folder;
    std::minstd_rand random(1);
    const auto noisy = [&] { return noise(random); };
    EXPECT_EXIT(fillLimitedDisk(folder / "x.0.mcap", noisy, "did not reach it"), testing::ExitedWithCode(0), "");
    const auto log = log::openLog(folder / "x.0.mcap");
    EXPECT_FALSE(log->complete());
    EXPECT_GT(log->samples().size(), 5u);
    log->forEach<std::string>("writer.port",
                              [](const std::string& text, const log::SampleRef&) { EXPECT_EQ(text.size(), 1000u); });
}

TEST_F(McapLogTest, PingsMayBecomeEightBits) {
    config.mcap.dtype = ros::ImageType::Uint8;
    start();
    cycle(pingAt(1));
    finish();
    log::openLog(folder / "x.0.mcap")
        ->forEach<types::Sonar>("sonar.port", [&](const types::Sonar& ping, const log::SampleRef&) {
            EXPECT_EQ(ping.bins, std::vector<float>(1600, 1));
        });
}

/** The parts of a sonar and its scene that a logger reads. */
struct Mounted {
    types::Mount mount;
    static void describe(auto& self, auto& visit) { visit({"mount"}, self.mount); }
};
struct MountedSonar : framework::TaskContext {
    MountedSonar(const std::string& name, const types::Mount& mount) : TaskContext(name) {
        config.set({mount});
        refreshRecord();
    }
    framework::Properties<Mounted> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", ""};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", ""};
};

TEST_F(McapLogTest, PingsHaveTheirSonarsMountAndSharedFramesAreReported) {
    MountedSonar left("left", {{0.1, 2, -3.5}, 0, 12.25, 90}), right("right", {{0.1, -2, -3.5}, 0, 0, 0});
    for (MountedSonar* each : {&left, &right}) {
        vehicle.port.connectTo(each->pose, ConnPolicy::buffer(8));
        each->ping.connectTo(*task.makeInput(each->name(), each->ping), ConnPolicy::buffer(8));
    }
    for (const bool is_named : {false, true}) {
        if (is_named) config.mcap.streams["right.ping"].frame_id = "right";
        start();
        vehicle.port.write(types::Pose{});
        left.ping.write(pingAt(1));
        right.ping.write(pingAt(1));
        task.update();
        finish();
        const auto log = log::openLog(folder / "x.0.mcap");
        EXPECT_EQ(log->find("left.ping")->metadata.at("insonify_mount"),
                  R"({"position": [0.1, 2, -3.5], "roll_deg": 0, "pitch_deg": 12.25, "yaw_deg": 90})");
        EXPECT_EQ(log->find("right.ping")->metadata.at("insonify_body"), "vehicle.port");
        EXPECT_FALSE(log->find("vehicle.port")->metadata.contains("insonify_body"));
        if (is_named)
            EXPECT_THAT(task.notices(), testing::IsEmpty());
        else
            EXPECT_THAT(task.notices(), testing::ElementsAre(testing::HasSubstr(
                                            "frame_id sonar is the place of left.ping in /tf_static, not that of "
                                            "right.ping; give right.ping another under mcap.streams")));
    }
}

TEST_F(McapLogTest, ValidatesTheNameOfTheFile) {
    for (const auto& [file, right] :
         {std::pair{"x.mcap", true}, {"a/x.0.mcap", true}, {".mcap", false}, {"x.bag", false}}) {
        config.file = file;
        EXPECT_EQ(test::countRefusals(config).empty(), right) << file;
    }
}

}  // namespace
}  // namespace insonify::logger
