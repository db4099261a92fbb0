// A Micron over TCP and over a serial line, with the messages and checks of an open driver, and a sonar behind it.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "tests/deployer/HilRun.hpp"
#include "tests/support/MicronDriver.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Wire.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::device {
namespace {

using test::MicronDriver;

/** The sonar at the origin looks north at a wall 6 m away. */
std::string deployment(const TestFolder& folder) {
    writeFile(folder / "wall.world", wallAndBall(6, "-30 0 0", 1));
    writeFile(folder / "x.yml", R"(schedule: realtime
tasks:
  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.05}, properties: {waypoints: [{time: 0, position: [0, 0, 0]}]}}
  scene: {type: scene::SceneTask, properties: {file: wall.world}}
  sonar:
    type: sonar::ScanningSonarTask
    properties: {range: 10, range_rounding: exact, bin_count: 100, beam_width_deg: 3, beam_height_deg: 35, speed_of_sound: 1500}
  receiver:
    type: receiver::ReceiverTask
    properties: {tvg: {log_coefficient: 40}, output: code, code: {bits: 16, law: log, full_scale_db: 20, dynamic_range_db: 80}}
  device: {type: device::MicronTask, properties: {serial: line, boot_time: 0.05, centring_time: 0.1}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: device.settings, to: sonar.settings, policy: {type: buffer, size: 4}}
  - {from: device.settings, to: receiver.settings}
  - {from: sonar.ping, to: receiver.intensity}
  - {from: receiver.ping, to: device.ping, policy: {type: buffer, size: 4}}
)");
    return folder / "x.yml";
}

double strongestRange(const MicronDriver::Beam& beam) {
    const auto bin = std::ranges::max_element(beam.bins) - beam.bins.begin();
    return (static_cast<double>(bin) + 0.5) * beam.sampling_interval * 1500 / 2;
}

MicronDriver driverOn(const Wire& wire) {
    return {[&wire](const Bytes& bytes) { wire.say(bytes); }, [&wire] { return wire.receive(); }};
}

struct MicronDriverTest : ::testing::Test {
    void expectAWallAt6Metres(MicronDriver driver, bool low_resolution) {
        driver.reboot();
        EXPECT_EQ(driver.serialNumber(), 1);
        EXPECT_TRUE(driver.isFullDuplex());
        const double limit = types::radians(30);
        driver.configure({.resolution = 0.05,
                          .max_distance = 10,
                          .left = limit,
                          .right = -limit,
                          .step = 2 * std::numbers::pi / 100,
                          .low_resolution = low_resolution,
                          .continuous = false});
        double worst = 0, minimum = 0, maximum = 0;
        for (int i = 0; i < 40; ++i) {
            driver.request();
            const MicronDriver::Beam beam = driver.beam();
            EXPECT_EQ(beam.bins.size(), 200u);
            const int unit = low_resolution ? 17 : 1;
            EXPECT_TRUE(std::ranges::all_of(beam.bins, [&](uint8_t bin) { return bin % unit == 0; }));
            worst = std::max(worst, std::abs(strongestRange(beam) * std::cos(beam.bearing) - 6));
            minimum = std::min(minimum, beam.bearing);
            maximum = std::max(maximum, beam.bearing);
        }
        std::cout << "a wall at 6 m is at most " << worst << " m off, bins of 0.05 m\n";
        EXPECT_LT(worst, 0.2) << "the width of the beam slants it";
        EXPECT_NEAR(maximum, limit, 0.003);
        EXPECT_NEAR(minimum, -limit, 0.003);
    }

    const TestFolder folder_;
    HilRun run_{deployment(folder_), {}};
};

TEST_F(MicronDriverTest, ADriverScansASectorOverTcpAndASerialLine) {
    INSONIFY_NEEDS("sdf");
    const int port = run_.port();
    ASSERT_GT(port, 0) << readFile(run_.folder() / "stderr.txt");
    const Wire tcp(Wire::connected(port)), line(Wire::line(run_.folder() / "out" / "line"));
    expectAWallAt6Metres(driverOn(tcp), false);
    expectAWallAt6Metres(driverOn(line), true);
}

/** Clients that connect and disconnect, also during a ping, and one that asks and never reads, delay no other
 *  client. */
TEST_F(MicronDriverTest, SurvivesAThousandReconnectsAndAClientThatDoesNotRead) {
    INSONIFY_NEEDS("sdf");
    const int port = run_.port();
    ASSERT_GT(port, 0) << readFile(run_.folder() / "stderr.txt");
    const Wire deaf(Wire::connected(port));
    MicronDriver never_reads = driverOn(deaf);
    for (int i = 0; i < 1000; ++i) {
        never_reads.request();
        const Wire wire(Wire::connected(port));
        MicronDriver driver = driverOn(wire);
        if (i % 100 == 0) driver.configure({.resolution = 0.05, .max_distance = 10, .step = 0.1});
        driver.request();  // gone before its line arrives
    }
    const Wire last(Wire::connected(port));
    MicronDriver driver = driverOn(last);
    driver.configure({.resolution = 0.05, .max_distance = 10});
    driver.request();
    EXPECT_EQ(driver.beam().bins.size(), 200u);
    EXPECT_THAT(run_.stop(), deployer::succeeds());
}

/** As on a machine with too few processors, or whose clock is set forward: the line is late, but is sent. */
TEST_F(MicronDriverTest, AnswersALineAfterAPauseOfTheSimulation) {
    INSONIFY_NEEDS("sdf");
    const int port = run_.port();
    ASSERT_GT(port, 0) << readFile(run_.folder() / "stderr.txt");
    const Wire wire(Wire::connected(port));
    MicronDriver driver = driverOn(wire);
    driver.configure({.resolution = 0.05, .max_distance = 10});
    for (int i = 0; i < 3; ++i) {
        driver.request();
        std::this_thread::sleep_for(std::chrono::milliseconds(4 * i));  // before the ping, during it, after it
        run_.signal(SIGSTOP);
        std::this_thread::sleep_for(std::chrono::milliseconds(2500));
        run_.signal(SIGCONT);
        EXPECT_EQ(driver.beam().bins.size(), 200u) << i;
    }
}

}  // namespace
}  // namespace insonify::device
