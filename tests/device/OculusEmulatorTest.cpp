// An emulated Oculus seen by a driver, with bytes and a simulated clock.
#include <gmock/gmock.h>

#include <cmath>

#include "components/device/OculusPing.hpp"
#include "components/device/oculus/OculusEmulator.hpp"

namespace insonify::device {
namespace {

using types::degrees;
using types::Time;

OculusFire metres(double range, uint8_t rate = 0, uint8_t mode = 1) {
    return {.mode = mode, .rate = rate, .range = range};
}

struct OculusEmulatorTest : ::testing::Test {
    using Due = OculusEmulator::Due;

    explicit OculusEmulatorTest(OculusConfig config = {}) : emulator_(config, now_) {}

    /** Advances time. */
    Due after(double seconds) {
        now_ = now_ + Time::fromSeconds(seconds);
        return emulator_.tick(now_);
    }
    void connect() { emulator_.opened(1); }
    void fire(const OculusFire& settings) { emulator_.received(1, toBytes(settings)); }
    /** Returns the sonar's answer to a request. */
    types::Sonar echoes(const types::SonarSettings& request) const {
        types::Sonar ping;
        ping.time = request.time + Time{20'000};
        ping.speed_of_sound = !(request.speed_of_sound > 0) ? 1480.f : static_cast<float>(request.speed_of_sound);
        ping.bin_count = request.bin_count;
        ping.beam_count = request.beam_count;
        const double step = request.field_of_view.rad / request.beam_count;
        for (uint32_t beam = 0; beam < request.beam_count; ++beam)
            ping.bearings.push_back({-request.field_of_view.rad / 2 + (beam + 0.5) * step});
        ping.bins.assign(size_t{ping.bin_count} * ping.beam_count, 13107);
        return ping;
    }
    /** Returns the ping of these settings as a driver receives it. */
    OculusResult pinged(const OculusFire& settings) {
        fire(settings);
        const Due due = after(1);
        if (!due.ask) return {};
        return oculusResult(emulator_.ping(echoes(*due.ask))).value();
    }
    types::SonarSettings request(const OculusFire& settings) {
        fire(settings);
        const auto ask = after(10).ask;
        EXPECT_TRUE(ask);
        return ask.value_or(types::SonarSettings{});
    }

    Time now_{1'000'000'000};
    OculusEmulator emulator_;
};

TEST_F(OculusEmulatorTest, AStatusIsSentEachSecondWithTheSourceOfThePings) {
    const auto status = oculusStatus(after(0).status);
    ASSERT_TRUE(status);
    EXPECT_EQ(status->part, 1032);
    EXPECT_EQ(status->status & 7, OculusStatus::running);
    EXPECT_TRUE(after(0.9).status.empty());
    EXPECT_FALSE(after(0.1).status.empty());
    connect();
    EXPECT_EQ(pinged(metres(10)).fire.header.source, status->header.source);
    EXPECT_EQ(oculusHeader(oculusDummy(7700, 1032))->source, status->header.source);
}

TEST_F(OculusEmulatorTest, TheStatusHasTheAddress) {
    const auto findAddress = [&](const std::string& text) {
        OculusEmulator emulator({.device_address = text}, now_);
        return oculusStatus(emulator.tick(now_).status).value().address;
    };
    EXPECT_EQ(findAddress("192.168.2.3"), (std::array<uint8_t, 4>{192, 168, 2, 3}));
    for (const char* wrong : {"", "192.168.2", "192.168.2.300", "192.168.2.3.", "host", "1.2.3.4x"})
        EXPECT_EQ(findAddress(wrong), (std::array<uint8_t, 4>{})) << wrong;
}

TEST_F(OculusEmulatorTest, IsInStandbyUntilAFireMessageAndOnRequest) {
    EXPECT_TRUE(after(1).dummy.empty()) << "there is no client";
    connect();
    EXPECT_EQ(after(1).dummy.size(), 16u);
    EXPECT_FALSE(after(1).ask);
    fire(metres(10));
    EXPECT_TRUE(after(1).ask);
    fire(metres(10, OculusFire::standby));
    const Due due = after(5);
    EXPECT_FALSE(due.ask);
    EXPECT_FALSE(due.dummy.empty());
    fire(metres(10));
    EXPECT_TRUE(after(5).ask);
    emulator_.closed(1);
    EXPECT_TRUE(emulator_.inStandby());
    connect();
    EXPECT_FALSE(after(5).ask) << "a new client must send a fire message again";
}

TEST_F(OculusEmulatorTest, EveryRateIsKept) {
    connect();
    const double rates[] = {10, 15, 40, 5, 2};
    for (uint8_t rate = 0; rate < 5; ++rate) {
        pinged(metres(1, rate));
        int pings = 0;
        for (int i = 0; i < 4000; ++i)  // the task runs every millisecond, up to a millisecond late
            if (const Due due = after(0.001); due.ask) {
                ++pings;
                EXPECT_FALSE(emulator_.ping(echoes(*due.ask)).empty());
            }
        EXPECT_NEAR(pings, 4 * rates[rate], 1.01) << int(rate);
    }
}

TEST_F(OculusEmulatorTest, RequestsTheNextCycleWhenSomethingIsDue) {
    connect();
    fire(metres(1, 2));
    Due due = after(0);
    for (int i = 0; i < 40; ++i) {
        if (due.ask) emulator_.ping(echoes(*due.ask));
        due = after(0);
        ASSERT_GT(due.next, now_);
        ASSERT_LE((due.next - now_).seconds(), 0.025);
        due = after((due.next - now_).seconds());
    }
    EXPECT_NEAR((now_ - Time{1'000'000'000}).seconds(), 1, 0.03);
}

TEST_F(OculusEmulatorTest, RequestsTheDriversSettingsFromTheSonar) {
    connect();
    const types::SonarSettings low = request(metres(20));
    EXPECT_EQ(low.time, now_);
    EXPECT_EQ(low.range, 20);
    EXPECT_EQ(low.frequency_khz, 750);
    EXPECT_NEAR(degrees(low.field_of_view.rad), 130, 1e-9);
    EXPECT_NEAR(degrees(low.beam_height.rad), 20, 1e-9);
    EXPECT_EQ(low.bin_count, 1000u);
    EXPECT_EQ(low.beam_count, 256u);
    EXPECT_NEAR(low.gain_db, 0, 1e-12) << "50 %";
    EXPECT_TRUE(std::isnan(low.speed_of_sound)) << "the sonar's own";
    const types::SonarSettings high =
        request({.mode = 2, .flags = OculusFire::beams_512, .range = 5, .gain_percent = 100, .speed_of_sound = 1500});
    EXPECT_EQ(high.range, 2) << "5 % of 40 m";
    EXPECT_EQ(request({.flags = 0, .range = 0}).range, 0.1) << "exactly the min range";
    EXPECT_EQ(high.frequency_khz, 1200);
    EXPECT_NEAR(degrees(high.field_of_view.rad), 70, 1e-9);
    EXPECT_NEAR(degrees(high.beam_height.rad), 12, 1e-9);
    EXPECT_EQ(high.bin_count, 800u) << "of 2.5 mm";
    EXPECT_EQ(high.beam_count, 512u);
    EXPECT_NEAR(high.gain_db, 20, 1e-12);
    EXPECT_EQ(high.speed_of_sound, 1500);
}

TEST_F(OculusEmulatorTest, ClampsValuesAndReportsTheClampedValues) {
    connect();
    for (const auto& [range, made] : {std::pair{500.0, 120.0}, {0.0, 0.1}, {-3.0, 0.1}})
        EXPECT_EQ(pinged(metres(range)).fire.range, made);
    OculusFire wild{.mode = 9, .rate = 77, .range = 10, .gain_percent = 900, .speed_of_sound = 1e9, .salinity = -4};
    const OculusResult result = pinged(wild);
    EXPECT_EQ(result.fire.mode, 1);
    EXPECT_EQ(result.fire.gain_percent, 100);
    EXPECT_EQ(result.fire.speed_of_sound, 1700);
    EXPECT_EQ(result.speed_of_sound, 1700);
    const OculusFire before = emulator_.fire();
    for (double OculusFire::*number :
         {&OculusFire::range, &OculusFire::gain_percent, &OculusFire::speed_of_sound, &OculusFire::salinity}) {
        OculusFire none = metres(33);
        none.*number = std::nan("");
        fire(none);
    }
    EXPECT_EQ(toBytes(emulator_.fire()), toBytes(before)) << "values that are not numbers change nothing";
    EXPECT_EQ(emulator_.refused(), 4u);
}

TEST_F(OculusEmulatorTest, APingHasTheSettingsThatItWasMadeWith) {
    connect();
    for (const uint16_t version : {0, 1, 2}) {
        OculusFire sent{.rate = 3, .gamma = 127, .flags = 0x5D, .range = 7.123, .gain_percent = 33, .salinity = 31};
        sent.header.version = version;
        const OculusResult result = pinged(sent);
        EXPECT_EQ(result.fire.header.version, version);
        EXPECT_EQ(result.fire.range, 7.123);
        EXPECT_EQ(result.fire.gain_percent, 33);
        EXPECT_EQ(result.fire.flags, 0x5D);
        EXPECT_EQ(result.fire.gamma, 127);
        EXPECT_EQ(result.beam_count, 512);
        EXPECT_EQ(result.bin_count, 1000);
        EXPECT_NEAR(result.range_resolution, 7.123e-3, 1e-12);
        EXPECT_EQ(result.frequency_hz, 750e3);
        EXPECT_EQ(result.speed_of_sound, 1480);
        EXPECT_EQ(result.message_size, toBytes(result).size());
        EXPECT_EQ(result.fixedSize(), version == 2 ? 202u : 122u);
        EXPECT_EQ(result.bearings.front(), -6487) << "port first, degrees positive to starboard";
    }
}

TEST_F(OculusEmulatorTest, InHighFrequencyTheGainIsBetween40And100Percent) {
    connect();
    for (const double gain : {0.0, 50.0, 100.0}) {
        OculusFire sent = metres(5, 0, 2);
        sent.gain_percent = gain;
        const double echoed = pinged(sent).fire.gain_percent;
        EXPECT_NEAR((echoed - 40) * 100 / 60, gain, 1e-9) << "as drivers convert it back";
    }
}

TEST_F(OculusEmulatorTest, PingsAreNumberedAndTimedByTheDevicesClock) {
    connect();
    const OculusResult first = pinged(metres(5)), second = pinged(metres(5));
    EXPECT_EQ(second.number, first.number + 1);
    EXPECT_NEAR(static_cast<double>(second.start_ticks - first.start_ticks) / oculus_ticks_per_second, 1, 1e-6);
    OculusFire modern = metres(5);
    modern.header.version = 2;
    EXPECT_NEAR(pinged(modern).start_s, 3, 1e-6);
}

TEST_F(OculusEmulatorTest, SendsOnlyRequestedPings) {
    connect();
    EXPECT_TRUE(emulator_.ping(echoes(request(metres(5)))).size() > 256 * 1000u);
    const types::SonarSettings before = request(metres(6));
    EXPECT_FALSE(after(1).ask) << "one is in progress";
    types::Sonar early = echoes(before);
    early.time = before.time - Time{1};
    EXPECT_TRUE(emulator_.ping(early).empty()) << "older than the request";
    types::Sonar shapeless = echoes(before);
    shapeless.bins.pop_back();
    EXPECT_TRUE(emulator_.ping(shapeless).empty());
    EXPECT_FALSE(emulator_.ping(echoes(before)).empty());
    EXPECT_TRUE(emulator_.ping(echoes(before)).empty()) << "once";
}

TEST_F(OculusEmulatorTest, RequestsAMissingPingAgainAndSendsALatePing) {
    connect();
    const types::SonarSettings first = request(metres(120));
    EXPECT_FALSE(after(2.1).ask) << "its sound may not be back yet";
    fire(metres(60));
    const auto second = after(0.2).ask;
    ASSERT_TRUE(second);
    EXPECT_EQ(emulator_.lost(), 1u);
    EXPECT_FALSE(after(3.9).ask) << "with more patience";
    types::Sonar late = echoes(first);
    EXPECT_EQ(oculusResult(emulator_.ping(late)).value().fire.range, 120) << "with its own settings";
    EXPECT_EQ(oculusResult(emulator_.ping(echoes(*second))).value().fire.range, 60);
    EXPECT_TRUE(after(0).ask);
    for (int i = 0; i < 10; ++i) after(100);
    EXPECT_EQ(emulator_.lost(), 11u) << "it continues to request";
}

TEST_F(OculusEmulatorTest, AClientThatLeavesDuringAPingLeavesNoState) {
    connect();
    const types::SonarSettings ask = request(metres(5));
    emulator_.closed(1);
    EXPECT_TRUE(emulator_.ping(echoes(ask)).empty());
    emulator_.received(1, toBytes(metres(5)));
    EXPECT_TRUE(emulator_.inStandby()) << "bytes of a client that is gone";
    for (int i = 0; i < 1000; ++i) {
        emulator_.opened(static_cast<uint64_t>(i));
        emulator_.received(static_cast<uint64_t>(i), toBytes(metres(5)));
        emulator_.closed(static_cast<uint64_t>(i));
    }
    EXPECT_FALSE(after(1).ask);
}

TEST_F(OculusEmulatorTest, TheLastFireMessageOfAllClientsApplies) {
    connect();
    emulator_.opened(2);
    fire(metres(5));
    emulator_.received(2, toBytes(metres(8)));
    EXPECT_EQ(after(1).ask.value().range, 8);
    emulator_.closed(2);
    EXPECT_FALSE(emulator_.inStandby()) << "the other is still connected";
    Bytes half = toBytes(metres(9)), rest(half.begin() + 20, half.end());
    half.resize(20);
    emulator_.received(1, half);
    emulator_.opened(3);
    emulator_.received(3, toBytes(metres(11)));
    emulator_.received(1, rest);
    EXPECT_EQ(emulator_.fire().range, 9) << "bytes of clients do not mix";
}

TEST_F(OculusEmulatorTest, NetworkSettingsAreNotCountedAsRefused) {
    connect();
    emulator_.received(1, toBytes(OculusUserConfig{.address = {192, 168, 2, 4}}));
    EXPECT_EQ(emulator_.refused(), 0u);
    emulator_.received(1, oculusDummy(1, 1032));
    EXPECT_EQ(emulator_.refused(), 1u) << "which is neither";
}

TEST_F(OculusEmulatorTest, TheSpeedOfSoundReturnsToTheSonarsOwn) {
    connect();
    pinged(metres(5));
    OculusFire salt = metres(5);
    salt.speed_of_sound = 1520;
    EXPECT_EQ(pinged(salt).speed_of_sound, 1520);
    EXPECT_EQ(request(metres(5)).speed_of_sound, 0);
}

TEST_F(OculusEmulatorTest, ADriverThatLeavesTheSpeedOfSoundToTheDeviceNeverAsksForOne) {
    connect();
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(pinged(metres(5)).speed_of_sound, 1480);
        const types::SonarSettings ask = request(metres(6));
        EXPECT_TRUE(std::isnan(ask.speed_of_sound));
        emulator_.ping(echoes(ask));
    }
}

TEST(OculusModelTest, EveryModelHasItsPartNumberAndModes) {
    const auto part = [](OculusModel model) { return figures(model).part; };
    EXPECT_EQ(part(OculusModel::M370s), 1041);
    EXPECT_EQ(part(OculusModel::M750d), 1032);
    EXPECT_EQ(part(OculusModel::M1200d), 1042);
    EXPECT_EQ(part(OculusModel::M3000d), 2203);
    EXPECT_EQ(oculusMode(figures(OculusModel::M3000d), 2).frequency_khz, 3000);
    EXPECT_EQ(oculusMode(figures(OculusModel::M3000d), 2).range_max, 5);
    EXPECT_EQ(oculusMode(figures(OculusModel::M370s), 2).frequency_khz, 375) << "it has no second mode";
}

}  // namespace
}  // namespace insonify::device
