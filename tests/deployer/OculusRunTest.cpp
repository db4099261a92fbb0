// deploy/hil_oculus.yml with open drivers.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/deployer/Command.hpp"
#include "tests/support/OculusDriver.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

struct OculusRunTest : testing::Test {
    ~OculusRunTest() override {
        if (!ended_) end(SIGKILL);
    }
    int end(int signal) {
        ended_ = true;
        run_.signal(signal);
        return run_.wait().code;
    }
    /** Returns the TCP port in the notice. */
    uint16_t port() const {
        const std::string words = "listens on TCP 127.0.0.1:";
        if (!says(folder_, words)) throw std::runtime_error("it does not listen");
        const std::string reported = readFile(folder_ / "stderr.txt");
        return static_cast<uint16_t>(std::stoi(reported.substr(reported.find(words) + words.size())));
    }
    /** Returns the max code of a bin. */
    static int loudest(const device::OculusResult& ping, size_t bin) {
        const auto row = ping.image.begin() + static_cast<std::ptrdiff_t>(bin * ping.rowBytes());
        return *std::max_element(row, row + static_cast<std::ptrdiff_t>(ping.rowBytes()));
    }

    const TestFolder folder_;
    const test::OculusListener listener_;
    const Process run_{
        insonifyWords({"run", test::sourceFile("deploy/hil_oculus.yml"), "--out", "out", "--set", "device.port=0",
                       "--set", "device.status_port=" + std::to_string(listener_.port()), "--set",
                       "scene.pose_timeout=60"}),
        folder_.path()};
    bool ended_ = false;
};

}  // namespace

TEST_F(OculusRunTest, DriversGetEchoesWithTheirOwnSettings) {
    const uint16_t at = port();
    {
        test::EnstaDriver driver(listener_.next(), at);
        device::OculusFire fire{.mode = 1, .gamma = 0xFF, .flags = 0x59, .range = 30};
        EXPECT_LT(driver.request(fire), 100);
        const device::OculusResult low = driver.nextPing();
        EXPECT_EQ(low.frequency_hz, 750e3);
        EXPECT_EQ(low.beam_count, 512);
        EXPECT_EQ(low.bin_count, 1000);
        fire.mode = 2;
        fire.range = 15;
        EXPECT_LT(driver.request(fire), 100);
        const device::OculusResult high = driver.nextPing();
        EXPECT_EQ(high.frequency_hz, 1200e3);
        EXPECT_NEAR(high.bearings.back() - high.bearings.front(), 7000, 30) << "hundredths of a degree";
        fire.rate = device::OculusFire::standby;
        EXPECT_LT(driver.request(fire), 100);
    }
    test::RockDriver rock(at);
    rock.fire({.range = 30});
    device::OculusResult ping = rock.nextPing();
    while (ping.fire.range != 30) ping = rock.nextPing();  // pings in progress for the other driver
    int near = 0, far = 0;                                 // the floor is some metres below: there is no nearer echo
    for (size_t bin = 10; bin < 60; ++bin) near = std::max(near, loudest(ping, bin));
    for (size_t bin = 300; bin < 1000; ++bin) far = std::max(far, loudest(ping, bin));
    EXPECT_GT(far, 2 * near) << near << " within 1.8 m";
    EXPECT_EQ(end(SIGINT), 0);
}

TEST(OculusLockstepTest, ADeploymentInLockstepIsRefused) {
    const TestFolder folder;
    std::string text = readFile(test::sourceFile("deploy/hil_oculus.yml"));
    text.replace(text.find("schedule: realtime"), 18, "schedule: lockstep");
    writeFile(folder / "x.yml", text);
    EXPECT_THAT(callInsonify(folder, {"check", "x.yml"}).err, HasSubstr("set schedule: realtime"));
}
