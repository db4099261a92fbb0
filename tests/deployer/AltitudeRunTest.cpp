// Each line of a side-scan's recording is drawn along the ground by its own altitude, in a replay and in an export.
#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "components/output/pictures/SideScanImage.hpp"
#include "components/recordings/Xtf.hpp"
#include "components/recordings/XtfFile.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/support/Folder.hpp"

using namespace insonify::deployer;
using namespace insonify;
using testing::HasSubstr;

namespace {

constexpr double ground_range = 12;  ///< Ground distance of a wire along the track [m].
constexpr int lines = output::WaterfallImage::history;

double computeAltitude(int line) { return 7 + 3 * std::sin(line / 40.0); }

/** A vehicle that rises and sinks by 3 m above a wire. Lines begin with the outgoing pulse, the strongest sample. */
std::vector<char> wireXtf() {
    types::Sonar ping;
    ping.bin_duration = {40};
    ping.speed_of_sound = 1500;
    ping.bearings = {types::Angle::fromDeg(-90), types::Angle::fromDeg(90)};
    ping.beam_count = 2;
    ping.bin_count = 500;
    const recordings::XtfFormat format{.frequency_khz = 450, .name = "wire.xtf"};
    std::vector<char> bytes = recordings::xtfHeader(format, ping);
    for (int i = 0; i < lines; ++i) {
        recordings::XtfPing record;
        record.altitude = computeAltitude(i);
        record.number = static_cast<uint32_t>(i);
        record.sonar.position = {0.1 * i, 0, -2};  // so that the log has the sonar's poses
        ping.time = {1'700'000'000'000'000 + i * 100'000};
        ping.bins.assign(1000, 10);
        for (const size_t bin : {0, 500}) ping.bins[bin] = 60000;
        ping.bins[static_cast<size_t>(std::hypot(ground_range, record.altitude) / ping.binStart(1))] = 50000;
        recordings::appendXtfPing(format, ping, record, bytes);
    }
    return bytes;
}

const std::string above_ground = R"(schedule: lockstep
tasks:
  sonar: {type: sonar::SideScanTask, properties: {range: 30, bin_count: 500}}
  receiver: {type: receiver::ReceiverTask, properties: {output: code, code: {bits: 16}}}
  ground:
    type: output::SideScanImageTask
    properties: {file: ground_%06d.png, every: 479, scale: code, code_bits: 16, ground_range: {}}
  other: {type: output::SideScanImageTask, properties: {file: fixed_%06d.png, every: 479, scale: code, code_bits: 16, ground_range: {altitude: 7}}}
  xtf: {type: output::XtfTask, properties: {file: again.xtf}}
connections:
  - {from: sonar.ping, to: receiver.intensity}
  - {from: receiver.ping, to: xtf.ping, policy: {type: buffer, size: 64}}
  - {from: sonar.pose, to: xtf.pose, policy: {type: buffer, size: 64}}
  - {from: receiver.ping, to: ground.ping, policy: {type: buffer, size: 8}}
  - {from: receiver.ping, to: other.ping, policy: {type: buffer, size: 8}}
)";

/** Returns the min and max column to starboard of the middle at which the rows are brightest. */
std::pair<int, int> brightestColumns(const fs::path& picture, const output::SideScanPictureConfig& config) {
    const cv::Mat image = cv::imread(picture, cv::IMREAD_GRAYSCALE);
    const cv::Rect water = output::SideScanImage(config).water();
    const int middle = water.x + water.width / 2;
    std::pair<int, int> found{10000, 0};
    for (int row = 1; row < lines - 1; ++row) {
        const cv::Mat side = image(cv::Rect(middle + 20, water.y + row, water.br().x - middle - 20, 1));
        cv::Point brightest;
        cv::minMaxLoc(side, nullptr, nullptr, nullptr, &brightest);
        found = {std::min(found.first, brightest.x + 20), std::max(found.second, brightest.x + 20)};
    }
    return found;
}

struct AltitudeRunTest : testing::Test {
    void SetUp() override {
        writeBytes(folder_ / "wire.xtf", wireXtf());
        writeFile(folder_ / "side.yml", above_ground);
        ASSERT_THAT(callInsonify(folder_, {"log", "import", "wire.xtf", "--to", "wire.0.log"}), succeeds());
    }
    void expectStraight(const std::string& picture) const {
        output::SideScanPictureConfig config;  // as above_ground: labels of codes of 16 bits are wide
        config.scale = output::BinScale::Code;
        config.code_bits = 16;
        const auto [minimum, greatest] = brightestColumns(folder_ / picture, config);
        const double column = output::SideScanImage(config).water().width / 2.0 * ground_range / 30;
        EXPECT_NEAR(minimum, column, 3);
        EXPECT_NEAR(greatest, column, 3);
    }

    const TestFolder folder_;
};

}  // namespace

TEST_F(AltitudeRunTest, AReplayHasTheAltitudesOfTheRecording) {
    ASSERT_THAT(callInsonify(folder_, {"replay", "wire.0.log", "side.yml", "--out", "out"}), succeeds());
    expectStraight("out/ground_000001.png");
    const auto [minimum, greatest] = brightestColumns(folder_ / "out/fixed_000001.png", {});
    EXPECT_GT(greatest - minimum, 30) << "a fixed altitude bends the wire";
}

TEST_F(AltitudeRunTest, AnXtfFileOfAReplayHasTheAltitudesOfTheRecording) {
    ASSERT_EQ(callInsonify(folder_, {"replay", "wire.0.log", "side.yml", "--out", "out"}).code, 0);
    recordings::XtfFile file(folder_ / "out/again.xtf");
    int count = 0;
    for (auto line = file.next(); line; line = file.next(), ++count)
        EXPECT_NEAR(line->altitude, computeAltitude(count), 1e-6) << count;
    EXPECT_EQ(count, lines);
}

TEST_F(AltitudeRunTest, AnExportAlongTheGroundHasTheAltitudesOfTheRecording) {
    const auto to = [&](const std::string& file, const std::string& option) {
        std::vector<std::string> arguments{"log", "export", "wire.0.log", "--stream", "receiver.ping", "--to", file};
        if (!option.empty()) arguments.push_back(option);
        return callInsonify(folder_, arguments);
    };
    EXPECT_EQ(to("ground.png", "--ground").out, "ground_000000.png\n");
    expectStraight("ground_000000.png");
    ASSERT_EQ(to("slant.png", "").code, 0);
    const auto [minimum, greatest] = brightestColumns(folder_ / "slant_000000.png", {});
    EXPECT_GT(greatest - minimum, 30) << "slant ranges";
    EXPECT_THAT(to("ground.npz", "--ground").err, HasSubstr("--ground: is for pictures"));
}
