// XTF files: their bytes as another program reads them, and the task that writes them.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "components/output/tasks/XtfTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Python.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::output {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/** Returns a line in which starboard counts up from 100, port from 1000. */
types::Sonar pingLine(int64_t time, uint32_t bins = 5) {
    types::Sonar ping = test::makePing(2, bins, 0, time);
    ping.bearings = {types::Angle::fromDeg(-90), types::Angle::fromDeg(90)};
    ping.beam_width = types::Angle::fromDeg(0.5);
    ping.beam_height = types::Angle::fromDeg(50);
    ping.speed_of_sound = 1500;
    for (uint32_t k = 0; k < bins; ++k) {
        ping.bins[k] = static_cast<float>(100 + k);
        ping.bins[bins + k] = static_cast<float>(1000 + k);
    }
    return ping;
}

types::Pose towed(int64_t time, double yaw_deg = 0) {
    types::Pose pose;
    pose.time = {time};
    pose.position = {12.5, -3.25, -4};
    pose.orientation = glm::angleAxis(types::radians(yaw_deg), glm::dvec3(0, 0, 1)) *
                       glm::angleAxis(types::radians(10), glm::dvec3(0, 1, 0)) *
                       glm::angleAxis(types::radians(5), glm::dvec3(1, 0, 0));
    pose.velocity = {1.852 / 3.6, 0, 0};  // a knot
    return pose;
}

struct XtfTest : ::testing::Test {
    XtfTest() {
        auto environment = std::make_shared<framework::Environment>(task_.environment());
        environment->output_folder = folder_.path();
        task_.setEnvironment(environment);
        pings_.port.connectTo(task_.ping, framework::ConnPolicy::buffer(16));
        poses_.port.connectTo(task_.pose, framework::ConnPolicy::buffer(16));
        altitudes_.port.connectTo(task_.altitude, framework::ConnPolicy::buffer(16));
    }
    void start(recordings::XtfSamples samples = recordings::XtfSamples::Uint16) {
        XtfConfig config;
        config.file = "line.xtf";
        config.samples = samples;
        config.frequency_khz = 450;
        task_.config.set(config);
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    }
    void give(const types::Sonar& ping) {
        pings_.port.write(test::shared(ping));
        task_.update();
    }
    void give(const types::Pose& pose) {
        poses_.port.write(pose);
        task_.update();
    }
    /** Returns what PyPI's pyxtf reads from the file. */
    json readBack() {
        return json::parse(pythonSays(
            test::sourceFile("tests/recordings/read_xtf.py ") + (folder_ / "line.xtf").string(), folder_ / "answer"));
    }

    Folder folder_;
    XtfTask task_{"xtf"};
    test::Writer<types::SonarPtr> pings_;
    test::Writer<types::Pose> poses_;
    test::Writer<types::Range> altitudes_;
};

#define NEED_PYXTF() \
    if (!pythonHas("pyxtf")) GTEST_SKIP() << "SKIPPED: the Python package pyxtf is missing; scripts/setup installs it"

TEST_F(XtfTest, PyxtfReadsBackLinesAndTheirAttributes) {
    NEED_PYXTF();
    start();
    types::Range measured;
    measured.range = 6.5;
    altitudes_.port.write(measured);
    constexpr int64_t first = 1'700'000'000'250'000;  // 2023-11-14 22:13:20.25 UTC
    give(towed(first, 90));
    give(pingLine(first));
    give(towed(first + 500'000, -45));
    give(pingLine(first + 500'000, 7));
    task_.stop();
    const json file = readBack();
    EXPECT_EQ(file["channels"], json::parse(R"([["port", 450.0, 2, 3, 0.5, 50.0], ["stbd", 450.0, 2, 3, 0.5, 50.0]])"));
    EXPECT_EQ(file["program"], "Insonify");
    ASSERT_EQ(file["pings"].size(), 2u);
    const json& ping = file["pings"][0];
    EXPECT_EQ(ping["time"], "2023-11-14T22:13:20.250");
    EXPECT_EQ(ping["number"], 0);
    EXPECT_EQ(ping["sound_velocity"], 1500);
    EXPECT_EQ(ping["x_y"], json::parse("[3.25, 12.5]")) << "east, north";
    EXPECT_EQ(ping["depth"], 4);
    EXPECT_EQ(ping["altitude"], 6.5);
    EXPECT_NEAR(ping["heading"], 270, 1e-4) << "turned to port by 90: west";
    EXPECT_NEAR(ping["pitch"], -10, 1e-4) << "bow down";
    EXPECT_NEAR(ping["roll"], 5, 1e-4) << "to starboard";
    EXPECT_NEAR(ping["speed_knots"], 1, 1e-5);
    EXPECT_THAT(ping["port"], ElementsAre(1004, 1003, 1002, 1001, 1000)) << "from the far end";
    EXPECT_THAT(ping["stbd"], ElementsAre(100, 101, 102, 103, 104));
    EXPECT_NEAR(ping["slant_range"], 5 * 0.15, 1e-6);
    EXPECT_EQ(file["pings"][1]["number"], 1);
    EXPECT_NEAR(file["pings"][1]["seconds_per_ping"], 0.5, 1e-6);
    EXPECT_NEAR(file["pings"][1]["heading"], 45, 1e-4);
    EXPECT_EQ(file["pings"][1]["stbd"].size(), 7u) << "a ping of other bins";
    EXPECT_THAT(task_.notices(), testing::IsEmpty());
}

TEST_F(XtfTest, PyxtfReadsBackIntensitiesUnchanged) {
    NEED_PYXTF();
    start(recordings::XtfSamples::Float32);
    types::Sonar ping = pingLine(2'000'000);
    ping.bins[0] = 1.25e-7f;
    give(towed(2'000'000));
    give(ping);
    task_.stop();
    const json file = readBack();
    EXPECT_EQ(file["pings"][0]["time"], "1970-01-01T00:00:02.000");
    EXPECT_FLOAT_EQ(file["pings"][0]["stbd"][0].get<float>(), 1.25e-7f);
}

TEST_F(XtfTest, AFileIsAHeaderOf1024BytesAndRecordsOfWholeUnits) {
    start();
    give(towed(1'000'000));
    give(pingLine(1'000'000));
    task_.stop();
    const std::vector<char> bytes = toBytes(folder_ / "line.xtf");
    EXPECT_EQ(bytes.size(), 1024 + 448u) << "256 + 2 * (64 + 10), up to a multiple of 64";
    EXPECT_EQ(static_cast<uint8_t>(bytes[0]), 0x7B);
    EXPECT_EQ(static_cast<uint8_t>(bytes[1024]), 0xCE);
    EXPECT_EQ(static_cast<uint8_t>(bytes[1025]), 0xFA);
}

TEST_F(XtfTest, ABinThatIsNotACodeOrAPingWithoutSidesEndsTheFileWithAReason) {
    const auto getReason = [&](types::Sonar ping) {
        start();
        give(towed(ping.time.microseconds));
        give(ping);
        const std::string reason = task_.lastError();
        EXPECT_EQ(task_.state(), framework::TaskState::Exception);
        task_.recover();
        return reason;
    };
    types::Sonar intensities = pingLine(1'000'000), loud = pingLine(1'000'000), ahead = pingLine(1'000'000);
    intensities.bins[2] = 1e-6f;
    loud.bins[2] = 70000;
    ahead.bearings[1] = {-0.5};
    EXPECT_THAT(getReason(intensities),
                testing::AllOf(HasSubstr("a bin is 1e-06"), HasSubstr("output: code"), HasSubstr("samples: float32")));
    EXPECT_THAT(getReason(loud), HasSubstr("a bin is 70000"));
    EXPECT_THAT(getReason(ahead), HasSubstr("no beam to port"));
}

TEST_F(XtfTest, WritesAndReportsAPingBeforeAnyPose) {
    start();
    give(pingLine(1'000'000));
    task_.stop();
    EXPECT_GT(toBytes(folder_ / "line.xtf").size(), 1024u);
    EXPECT_THAT(task_.notices(), testing::Contains(HasSubstr("1 pings of line.xtf have no pose")));
}

TEST(XtfConfigTest, RequiresTheFileExtension) {
    XtfConfig config;
    EXPECT_THAT(test::countRefusals(config), testing::IsEmpty());
    config.file = "line.jsf";
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::HasSubstr("is line.jsf; must end in .xtf")));
    config.file = "LINE.Xtf";
    EXPECT_THAT(test::countRefusals(config), testing::IsEmpty());
}

TEST_F(XtfTest, EveryPingIsWrittenWhenTheClockIsSetOrARecordingRepeats) {
    start();
    constexpr int64_t first = 1'700'000'000'000'000, period = 100'000;
    size_t written = 0;
    for (const int64_t step :
         {int64_t{0}, int64_t{-600'000'000}, int64_t{600'000'000}, int64_t{-1'500'000'000'000'000}})
        for (int64_t i = 0; i < 20; ++i, ++written) {
            give(towed(first + step + i * period));
            give(pingLine(first + step + i * period));
        }
    ASSERT_TRUE(task_.stop());
    EXPECT_THAT(task_.notices(), ElementsAre(HasSubstr("stamps went back by more than 1 s 2 times")));
    const auto size = std::filesystem::file_size(folder_ / "line.xtf");
    EXPECT_EQ((size - 1024) % written, 0u) << "a header, and pings of one size";
    EXPECT_GT((size - 1024) / written, 256u);
}

}  // namespace
}  // namespace insonify::output
