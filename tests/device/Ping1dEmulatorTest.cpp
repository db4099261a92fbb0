#include "components/device/ping/Ping1dEmulator.hpp"
#include "tests/device/PingBench.hpp"
#include "tests/support/Draw.hpp"

namespace insonify::device {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Ping1dEmulatorTest : ::testing::Test {
    template <class Message>
    Message request() {
        bench_.say(PingGeneralRequest{Message::message});
        return bench_.only<Message>();
    }
    template <class Message>
    void set(const Message& message) {
        bench_.say(message);
        EXPECT_EQ(bench_.only<PingAck>().acked, Message::message);
    }
    /** Returns a ping with one echo at a range [m]. */
    std::shared_ptr<types::Sonar> pingWithEcho(const types::SonarSettings& request, double range, float code = 30000,
                                               float speed_of_sound = 1500) {
        auto ping = pingFor(request, speed_of_sound);
        std::ranges::fill(ping->bins, 100.0f);
        ping->bins.at(static_cast<size_t>(range / request.range * request.bin_count)) = code;
        return ping;
    }
    /** Requests a measurement of a scan that is set by hand. */
    template <class Message>
    Message measure(double range, float code = 30000) {
        bench_.say(PingGeneralRequest{Message::message});
        const auto request = bench_.request();
        EXPECT_TRUE(request.has_value());
        if (request) device_.setPing(pingWithEcho(*request, range, code), bench_.now());
        bench_.waitForNext();
        return bench_.only<Message>();
    }

    Ping1dEmulator device_{{}};
    PingBench bench_{device_};
};

TEST_F(Ping1dEmulatorTest, ReportsDeviceInformation) {
    EXPECT_EQ(request<PingDeviceInformation>().type, 1);
    EXPECT_EQ(request<PingProtocolVersion>().major, 1);
    EXPECT_EQ(request<Ping1dFirmwareVersion>().model, 1);
    EXPECT_EQ(request<Ping1dGeneralInfo>().voltage_5, 5000);
    EXPECT_EQ(request<Ping1dVoltage5>().value, 5000);
    EXPECT_EQ(request<Ping1dProcessorTemperature>().value, 2000);
    EXPECT_EQ(request<Ping1dPcbTemperature>().value, 2000);
    EXPECT_EQ(request<Ping1dTransmitDuration>().value, 0) << "nothing has been sent";
    bench_.say(PingGeneralRequest{1301});
    EXPECT_EQ(bench_.only<PingNack>().nacked, 1301);
}

TEST_F(Ping1dEmulatorTest, AMessageWithoutPayloadIsARequest) {
    for (const uint16_t message : {4, 5, 1200, 1204, 1210}) {
        bench_.give(PingFrame{message, 0, 0, {}}.bytes());
        const auto received = bench_.received();
        ASSERT_EQ(received.size(), 1u) << message;
        EXPECT_EQ(received[0].message, message);
        EXPECT_FALSE(received[0].payload.empty());
    }
    bench_.give(PingFrame{1300, 0, 0, {}}.bytes());
    EXPECT_TRUE(bench_.request());
}

TEST_F(Ping1dEmulatorTest, ReadsBackItsSettings) {
    set(Ping1dSetModeAuto{0});
    set(Ping1dSetRange{500, 12'000});
    set(Ping1dSetSpeedOfSound{1'450'000});
    set(Ping1dSetPingInterval{250});
    set(Ping1dSetGain{6});
    set(Ping1dSetPingEnable{0});
    set(Ping1dSetDeviceId{0});
    EXPECT_EQ(request<Ping1dModeAuto>().value, 0);
    EXPECT_EQ(request<Ping1dRange>().start, 500u);
    EXPECT_EQ(request<Ping1dRange>().length, 12'000u);
    EXPECT_EQ(request<Ping1dSpeedOfSound>().value, 1'450'000u);
    EXPECT_EQ(request<Ping1dPingInterval>().value, 250);
    EXPECT_EQ(request<Ping1dGain>().value, 6u);
    EXPECT_EQ(request<Ping1dPingEnable>().value, 0);
    EXPECT_EQ(request<Ping1dDeviceId>().value, 0);
    EXPECT_EQ(request<Ping1dGeneralInfo>().ping_interval, 250);
}

/** The order of the maker's own test of a device, ping-cpp's test-device-ping1d, by datagrams and over a line. */
TEST_F(Ping1dEmulatorTest, TheRangeIsSetInManualModeOnly) {
    for (const bool by_datagram : {true, false}) {
        const auto succeeds = [&](const auto& message) {
            bench_.give(pingBytes(message, 0, 0), 1, by_datagram);
            const auto answers = bench_.received();
            EXPECT_EQ(answers.size(), 1u);
            return !answers.empty() && answers[0].message == PingAck::message;
        };
        const Ping1dRange before = request<Ping1dRange>();
        EXPECT_TRUE(succeeds(Ping1dSetModeAuto{1}));
        EXPECT_FALSE(succeeds(Ping1dSetRange{100, 2000}));
        EXPECT_EQ(bench_.getRefusal(Ping1dSetRange{100, 2000}),
                  "mode_auto is 1, so the device sets the range; set mode_auto to 0");
        EXPECT_EQ(request<Ping1dRange>().length, before.length);
        EXPECT_TRUE(succeeds(Ping1dSetGain{1})) << "the firmware refuses nothing else";
        EXPECT_TRUE(succeeds(Ping1dSetPingInterval{200}));
        EXPECT_TRUE(succeeds(Ping1dSetSpeedOfSound{1'550'000}));
        EXPECT_TRUE(succeeds(Ping1dSetModeAuto{0}));
        EXPECT_TRUE(succeeds(Ping1dSetRange{100, 2000}));
        EXPECT_EQ(request<Ping1dRange>().start, 100u);
        EXPECT_TRUE(succeeds(Ping1dSetRange{0, 30'000}));
    }
}

TEST_F(Ping1dEmulatorTest, RefusesValuesOutOfBoundsWithNameAndBounds) {
    set(Ping1dSetModeAuto{0});
    EXPECT_EQ(bench_.getRefusal(Ping1dSetRange{0, 999}), "scan_length is 999; must be 1000 to 100000");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetRange{99'500, 1000}), "scan_start is 99500; must be 0 to 99000");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetRange{50'000, 50'001}), "scan_length is 50001; must be 1000 to 50000");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetRange{UINT32_MAX, UINT32_MAX}),
              "scan_start is 4294967295; must be 0 to 99000");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetSpeedOfSound{0}), "speed_of_sound is 0; must be 100000 to 10000000");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetModeAuto{2}), "mode_auto is 2; must be 0 to 1");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetPingInterval{0}), "ping_interval is 0; must be 1 to 65535");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetGain{7}), "gain_setting is 7; must be 0 to 6");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetPingEnable{2}), "ping_enabled is 2; must be 0 to 1");
    EXPECT_EQ(bench_.getRefusal(Ping1dSetDeviceId{255}), "id is 255; must be 0 to 254");
    EXPECT_EQ(bench_.getRefusal(Ping1dContinuousStart{6}), "message 6 is not sent continuously");
    bench_.give(PingFrame{Ping1dSetRange::message, 0, 0, Bytes(7)}.bytes());
    EXPECT_EQ(bench_.only<PingNack>().text, "the payload is too short");
    bench_.give(PingFrame{1100, 0, 0, {}}.bytes());
    EXPECT_EQ(bench_.only<PingNack>().nacked, 1100) << "there is no bootloader";
}

TEST_F(Ping1dEmulatorTest, AMeasurementRequestsAPingOfItsScanAndReportsItsTarget) {
    set(Ping1dSetModeAuto{0});
    set(Ping1dSetRange{5'000, 10'000});
    set(Ping1dSetGain{2});
    bench_.say(PingGeneralRequest{Ping1dProfile::message});
    const auto request = bench_.request();
    ASSERT_TRUE(request);
    EXPECT_NEAR(request->range, 15, 1e-6);
    EXPECT_EQ(request->bin_count, 300u) << "of which the last 200 are the scan";
    EXPECT_NEAR(request->gain_db, 20 * std::log10(5.5), 1e-12);
    device_.setPing(pingWithEcho(*request, 8.02), bench_.now());
    EXPECT_THAT(bench_.received(), IsEmpty()) << "the sound is not back yet";
    EXPECT_GE(bench_.waitForNext(), 2 * 15 / 1500.0);
    const auto profile = bench_.only<Ping1dProfile>();
    EXPECT_NEAR(profile.measurement.distance, 8020, 25) << "half a sample";
    EXPECT_GT(profile.measurement.confidence, 95);
    EXPECT_EQ(profile.measurement.start, 5'000u);
    EXPECT_EQ(profile.measurement.length, 10'000u);
    EXPECT_EQ(profile.measurement.gain, 2u);
    EXPECT_EQ(profile.measurement.ping_number, 1u);
    EXPECT_GT(profile.measurement.transmit_duration, 0);
    ASSERT_EQ(profile.data.size(), 200u);
    EXPECT_EQ(profile.data[60], 117) << "30000 of 65535";
}

TEST_F(Ping1dEmulatorTest, DistanceIsInThreeMessages) {
    set(Ping1dSetModeAuto{0});
    EXPECT_NEAR(measure<Ping1dDistance>(30.1).measurement.distance, 30'100, 250);
    EXPECT_NEAR(measure<Ping1dDistanceSimple>(30.1).distance, 30'100, 250);
    EXPECT_NEAR(measure<Ping1dProfile>(30.1).measurement.distance, 30'100, 250);
    EXPECT_EQ(measure<Ping1dDistance>(30.1).measurement.ping_number, 4u);
}

TEST_F(Ping1dEmulatorTest, SilenceHasNoDistance) {
    set(Ping1dSetModeAuto{0});
    bench_.say(PingGeneralRequest{Ping1dDistanceSimple::message});
    auto ping = pingFor(*bench_.request());
    std::ranges::fill(ping->bins, 0.0f);
    device_.setPing(ping, bench_.now());
    bench_.wait(1);
    const auto reported = bench_.only<Ping1dDistanceSimple>();
    EXPECT_EQ(reported.distance, 0u);
    EXPECT_EQ(reported.confidence, 0);
}

TEST_F(Ping1dEmulatorTest, AWrongSpeedOfSoundMakesDistancesWrongInItsRatio) {
    set(Ping1dSetModeAuto{0});
    set(Ping1dSetRange{0, 20'000});
    set(Ping1dSetSpeedOfSound{3'000'000});
    bench_.say(PingGeneralRequest{Ping1dDistanceSimple::message});
    const auto request = bench_.request();
    EXPECT_NEAR(request->range, 10, 1e-6) << "the true range is half of the device's";
    device_.setPing(pingWithEcho(*request, 5), bench_.now());
    bench_.wait(1);
    EXPECT_NEAR(bench_.only<Ping1dDistanceSimple>().distance, 10'000, 100);
}

/** The blanked range is one in the water, whatever speed of sound the driver has set. */
TEST_F(Ping1dEmulatorTest, NoReturnBeyondTheBlankedRangeIsLostAtAnySpeedOfSound) {
    const test::Seeds seeds(100);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        test::Draw draw(seed);
        const double nearest = draw.between(0.2, 2), slow = draw.between(100, 3000), scale = slow / 1500;
        Ping1dEmulator device({.nearest = nearest});
        PingBench bench(device);
        const auto length = static_cast<uint32_t>(std::max(1000.0, 4000 * nearest * scale));  // as reported [mm]
        bench.say(Ping1dSetModeAuto{0});
        bench.say(Ping1dSetRange{0, std::min(length, 100'000u)});
        bench.say(Ping1dSetSpeedOfSound{static_cast<uint32_t>(1000 * slow)});
        bench.received();
        bench.say(PingGeneralRequest{Ping1dDistanceSimple::message});
        const auto request = bench.request();
        ASSERT_TRUE(request);
        const double bin = request->range / request->bin_count;
        const double target = std::lerp(nearest, request->range, draw.between(0, 0.999) * draw.once(2));
        const auto ping = pingWithEcho(*request, std::max(0.0, nearest - 1.001 * bin), 60000);  // blanked
        if (nearest + 1e-6 < request->range) ping->bins.at(static_cast<size_t>(target / bin)) = 30000;
        device.setPing(ping, bench.now());
        bench.wait(1);
        const double reported = 1e-3 * bench.only<Ping1dDistanceSimple>().distance / scale;
        EXPECT_NEAR(reported, target, 0.5 * bin + 0.6e-3 / scale) << seed;
        EXPECT_GT(reported, nearest - 0.6e-3 / scale) << seed;
    }
}

TEST_F(Ping1dEmulatorTest, AStreamKeepsItsIntervalUntilStopped) {
    set(Ping1dSetModeAuto{0});
    set(Ping1dSetRange{0, 3'000});
    set(Ping1dSetPingInterval{200});
    bench_.say(Ping1dContinuousStart{Ping1dProfile::message});
    types::Time last;
    int profiles = 0;
    for (int i = 0; i < 40 && profiles < 5; ++i) {
        if (const auto request = bench_.request()) {
            const double since = (request->time - std::exchange(last, request->time)).seconds();
            EXPECT_TRUE(profiles == 0 || std::abs(since - 0.2) < 1e-6) << since;
            bench_.answer(*request);
        }
        bench_.waitForNext();
        for (const PingFrame& frame : bench_.received()) profiles += frame.message == Ping1dProfile::message;
    }
    EXPECT_EQ(profiles, 5);
    bench_.say(Ping1dContinuousStop{Ping1dProfile::message});
    bench_.received();
    if (const auto request = bench_.request()) bench_.answer(*request);
    bench_.wait(5);
    EXPECT_THAT(bench_.received(), IsEmpty());
    EXPECT_FALSE(device_.wakeAt());
}

TEST_F(Ping1dEmulatorTest, MessagesStreamedFromOnePingAreOnePiecePerClient) {
    const auto messages = {Ping1dDistanceSimple::message, Ping1dDistance::message, Ping1dProfile::message};
    for (const uint16_t message : messages)
        for (const PingClient client : {1, 2}) bench_.say(Ping1dContinuousStart{message}, client);
    device_.consumeOutgoing();
    const auto request = bench_.request();
    ASSERT_TRUE(request);
    bench_.answer(*request);
    bench_.waitForNext();
    const auto out = device_.consumeOutgoing();
    ASSERT_EQ(out.size(), 2u);
    for (const PingOutgoing& each : out) {
        EXPECT_TRUE(each.stream);
        std::vector<uint16_t> found;
        for (const PingFrame& frame : pingFrames(each.bytes, 4096)) found.push_back(frame.message);
        EXPECT_THAT(found, ::testing::ElementsAreArray(messages));
    }
}

TEST_F(Ping1dEmulatorTest, ALongScanIsSlowerThanTheInterval) {
    set(Ping1dSetModeAuto{0});
    set(Ping1dSetPingInterval{1});
    bench_.say(Ping1dContinuousStart{Ping1dDistanceSimple::message});
    const auto first = bench_.request();
    bench_.answer(*first);
    bench_.waitForNext();
    const auto second = bench_.request();
    ASSERT_TRUE(second);
    EXPECT_GE((second->time - first->time).seconds(), 2 * 100 / 1500.0);
}

TEST_F(Ping1dEmulatorTest, WhenOffItSendsNoSoundAndReportsTheLastDistance) {
    set(Ping1dSetModeAuto{0});
    measure<Ping1dDistance>(42);
    set(Ping1dSetPingEnable{0});
    bench_.say(Ping1dContinuousStart{Ping1dProfile::message});
    bench_.received();
    EXPECT_EQ(request<Ping1dDistance>().measurement.ping_number, 1u);
    EXPECT_FALSE(bench_.request());
    EXPECT_FALSE(device_.wakeAt());
}

TEST_F(Ping1dEmulatorTest, AutomaticModeFollowsItsTarget) {
    for (int i = 0; i < 3; ++i) measure<Ping1dDistance>(4, 65535);
    EXPECT_NEAR(request<Ping1dRange>().length, 8'000, 300) << "twice as far";
    EXPECT_EQ(request<Ping1dGain>().value, 0u) << "down from 3, as the echo is beyond the scale";
    measure<Ping1dDistance>(4, 2000);
    EXPECT_EQ(request<Ping1dGain>().value, 1u);
    bench_.say(PingGeneralRequest{Ping1dDistanceSimple::message});
    auto silent = pingFor(*bench_.request());
    std::ranges::fill(silent->bins, 0.0f);
    device_.setPing(silent, bench_.now());
    bench_.wait(1);
    EXPECT_EQ(bench_.only<Ping1dDistanceSimple>().confidence, 0);
    EXPECT_GT(request<Ping1dRange>().length, 15'000u) << "its scan is longer";
}

TEST_F(Ping1dEmulatorTest, OnePingServesTwoClientsAndALeavingClientLeavesNoState) {
    bench_.say(PingGeneralRequest{Ping1dDistance::message}, 1);
    bench_.say(PingGeneralRequest{Ping1dDistance::message}, 2);
    bench_.say(Ping1dContinuousStart{Ping1dProfile::message}, 3);
    device_.close(3);
    bench_.answer(*bench_.request());
    bench_.wait(1);
    EXPECT_EQ(bench_.only<Ping1dDistance>(1).measurement.ping_number, 1u);
    EXPECT_EQ(bench_.only<Ping1dDistance>(2).measurement.ping_number, 1u);
    EXPECT_FALSE(bench_.request());
}

TEST_F(Ping1dEmulatorTest, AMissingPingIsRefusedAndWarnedOfOnce) {
    for (int i = 0; i < 2; ++i) {
        bench_.say(PingGeneralRequest{Ping1dProfile::message});
        bench_.wait(3);
        EXPECT_EQ(bench_.only<PingNack>().nacked, 1300);
        EXPECT_EQ(device_.consumeWarnings().size(), i == 0 ? 1u : 0u);
    }
}

TEST_F(Ping1dEmulatorTest, RefusesTooManyRequests) {
    for (int i = 0; i < 64; ++i) bench_.say(PingGeneralRequest{Ping1dProfile::message});
    EXPECT_THAT(bench_.received(), IsEmpty());
    bench_.say(PingGeneralRequest{Ping1dProfile::message});
    EXPECT_EQ(bench_.only<PingNack>().text, "too many requests wait already");
}

TEST_F(Ping1dEmulatorTest, ReportsTheFirstStrongReturn) {
    std::vector<float> codes(100, 1.0f);
    codes[20] = 6;
    codes[21] = 9;
    codes[60] = 10;
    EXPECT_EQ(ping1dReturn(codes).bin, 21u);
    EXPECT_EQ(ping1dReturn(codes).confidence, 88) << "the mean is 1.22 of 10";
    EXPECT_EQ(ping1dReturn(std::vector<float>(10, 0.0f)).confidence, 0);
    EXPECT_EQ(ping1dReturn({}).confidence, 0);
    codes[0] = 1000;  // ring-down
    EXPECT_EQ(ping1dReturn(codes, 1).bin, 21u) << "blanked";
    EXPECT_EQ(ping1dReturn(codes, 200).confidence, 0);
}

TEST_F(Ping1dEmulatorTest, CodesAreScaledToBytes) {
    const std::vector<float> codes = {0, 257, 65535, 70000, -3, std::nanf("")};
    EXPECT_THAT(bytesOfCodes(codes, 65535), ElementsAre(0, 1, 255, 255, 0, 0));
    EXPECT_THAT(bytesOfCodes(std::vector<float>{0, 128, 255}, 255), ElementsAre(0, 128, 255));
}

}  // namespace
}  // namespace insonify::device
