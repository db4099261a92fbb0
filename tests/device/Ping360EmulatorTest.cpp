#include "components/device/ping/Ping360Emulator.hpp"
#include "tests/device/PingBench.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::device {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr Ping360Acoustics acoustics{1, 50, 100, 750, 600};
constexpr double listened = 600 * 100 * 25e-9;  ///< [s]

Ping360Transducer transmitAt(uint16_t angle) { return {1, angle, acoustics, 1, 0}; }

struct Ping360EmulatorTest : ::testing::Test {
    /** Returns the angles of a scan's next pings. */
    std::vector<int> computeAngles(int pings) {
        std::vector<int> angles;
        for (int i = 0; i < 4 * pings && static_cast<int>(angles.size()) < pings; ++i) {
            if (const auto request = bench_.request()) bench_.answer(*request);
            bench_.waitForNext();
            for (const PingFrame& frame : bench_.received())
                if (const auto data = pingMessage<Ping360AutoDeviceData>(frame)) angles.push_back(data->angle);
        }
        return angles;
    }
    std::vector<int> makeScan(const Ping360Sector& sector, int pings) {
        bench_.say(Ping360AutoTransmit{1, acoustics, sector});
        const auto angles = computeAngles(pings);
        bench_.say(Ping360MotorOff{});
        bench_.received();
        return angles;
    }

    Ping360Emulator device_{{}};
    PingBench bench_{device_};
};

TEST_F(Ping360EmulatorTest, GeneralRequestsAreAnsweredAtOnce) {
    bench_.say(PingGeneralRequest{PingProtocolVersion::message});
    EXPECT_EQ(bench_.only<PingProtocolVersion>().minor, 1) << "1.1 has auto_transmit";
    bench_.say(PingGeneralRequest{PingDeviceInformation::message});
    EXPECT_EQ(bench_.only<PingDeviceInformation>().type, 2);
    bench_.say(PingGeneralRequest{Ping360DeviceData::message});
    const auto state = bench_.only<Ping360DeviceData>();
    EXPECT_EQ(state.acoustics, (Ping360Acoustics{0, 32, 80, 740, 1024})) << "of a device at boot";
    EXPECT_EQ(state.angle, 0);
    EXPECT_THAT(state.data, IsEmpty());
    bench_.say(PingGeneralRequest{4711});
    EXPECT_EQ(bench_.only<PingNack>().nacked, 4711);
}

TEST_F(Ping360EmulatorTest, RequestsPingsWithTheDriversSettings) {
    bench_.say(transmitAt(0));
    const auto request = bench_.request();
    ASSERT_TRUE(request);
    EXPECT_EQ(request->time, bench_.now());
    EXPECT_NEAR(request->range, 600 * 100 * 25e-9 * 1500 / 2, 1e-9);
    EXPECT_EQ(request->bin_count, 600u);
    EXPECT_EQ(request->frequency_khz, 750);
    EXPECT_EQ(request->gain_db, 10) << "the gain of setting 1";
    EXPECT_TRUE(std::isnan(request->speed_of_sound));
    EXPECT_NEAR(std::abs(request->bearing.deg()), 180, 1e-9) << "the device's 0 is aft";
}

TEST_F(Ping360EmulatorTest, TheHeadTurnsClockwiseFromAft) {
    EXPECT_NEAR(ping360Bearing(200, 200).deg(), 0, 1e-9);
    EXPECT_NEAR(ping360Bearing(250, 200).deg(), -45, 1e-9) << "to starboard";
    EXPECT_NEAR(ping360Bearing(100, 200).deg(), 90, 1e-9) << "to port";
    EXPECT_NEAR(ping360Bearing(100, 0).deg(), -90, 1e-9) << "a head whose 0 is ahead";
}

TEST_F(Ping360EmulatorTest, AnAnswerTakesTheTimeOfHeadSoundAndDevice) {
    const Ping360Config config;
    bench_.say(transmitAt(300));
    EXPECT_FALSE(bench_.request()) << "the head has not arrived yet";
    bench_.wait(100 * config.seconds_per_gradian - 1e-6);
    EXPECT_FALSE(bench_.request()) << "100 gradians is the shorter way to 300";
    bench_.wait(1e-6);
    const auto request = bench_.request();
    ASSERT_TRUE(request);
    bench_.answer(*request);
    EXPECT_THAT(bench_.received(), IsEmpty()) << "even if the sonar's ping is early";
    const double takes = 50e-6 + listened + config.overhead;
    bench_.wait(takes - 1e-6);
    EXPECT_THAT(bench_.received(), IsEmpty());
    bench_.wait(1e-6);
    const auto data = bench_.only<Ping360DeviceData>();
    EXPECT_EQ(data.angle, 300);
    EXPECT_EQ(data.mode, 1);
    EXPECT_EQ(data.acoustics, acoustics);
    ASSERT_EQ(data.data.size(), 600u);
    EXPECT_EQ(data.data[0], 0);
    EXPECT_EQ(data.data[100], 100) << "255 steps of 257 codes";
    EXPECT_EQ(data.data[599], 255);
}

TEST_F(Ping360EmulatorTest, ALatePingIsSentOnArrival) {
    bench_.say(transmitAt(0));
    const auto request = bench_.request();
    bench_.wait(1);
    EXPECT_THAT(bench_.received(), IsEmpty());
    bench_.answer(*request);
    EXPECT_EQ(bench_.only<Ping360DeviceData>().data.size(), 600u);
}

TEST_F(Ping360EmulatorTest, WithoutTransmitTheAnswerHasNoData) {
    Ping360Transducer turn = transmitAt(50);
    turn.transmit = 0;
    bench_.say(turn);
    EXPECT_THAT(bench_.received(), IsEmpty()) << "the head turns";
    bench_.waitForNext();
    const auto data = bench_.only<Ping360DeviceData>();
    EXPECT_EQ(data.angle, 50);
    EXPECT_THAT(data.data, IsEmpty());
    EXPECT_FALSE(bench_.request());
    bench_.say(PingGeneralRequest{Ping360DeviceData::message});
    EXPECT_EQ(bench_.only<Ping360DeviceData>().acoustics, acoustics) << "of this and later pings";
}

TEST_F(Ping360EmulatorTest, Mode0IsAcceptedAndReportedAs1) {
    Ping360Transducer request = transmitAt(0);
    request.mode = 0;
    bench_.say(request);
    bench_.answer(*bench_.request());
    bench_.wait(1);
    EXPECT_EQ(bench_.only<Ping360DeviceData>().mode, 1);
}

TEST_F(Ping360EmulatorTest, RefusesValuesOutOfBoundsWithNameAndBounds) {
    const auto refusal = [&](auto change) {
        Ping360Transducer request = transmitAt(0);
        change(request);
        return bench_.getRefusal(request);
    };
    EXPECT_EQ(refusal([](auto& m) { m.angle = 400; }), "angle is 400; must be 0 to 399");
    EXPECT_EQ(refusal([](auto& m) { m.mode = 2; }), "mode is 2; must be 0 to 1");
    EXPECT_EQ(refusal([](auto& m) { m.transmit = 2; }), "transmit is 2; must be 0 to 1");
    EXPECT_EQ(refusal([](auto& m) { m.acoustics.gain = 3; }), "gain_setting is 3; must be 0 to 2");
    EXPECT_EQ(refusal([](auto& m) { m.acoustics.transmit_duration = 0; }), "transmit_duration is 0; must be 1 to 1000");
    EXPECT_EQ(refusal([](auto& m) { m.acoustics.sample_period = 79; }), "sample_period is 79; must be 80 to 40000");
    EXPECT_EQ(refusal([](auto& m) { m.acoustics.frequency_khz = 1001; }),
              "transmit_frequency is 1001; must be 500 to 1000");
    EXPECT_EQ(refusal([](auto& m) { m.acoustics.samples = 1201; }), "number_of_samples is 1201; must be 200 to 1200");
    EXPECT_FALSE(bench_.request());
    const auto scan = [&](const Ping360Sector& sector) {
        return bench_.getRefusal(Ping360AutoTransmit{1, acoustics, sector});
    };
    EXPECT_EQ(scan({400, 0, 1, 0}), "start_angle is 400; must be 0 to 399");
    EXPECT_EQ(scan({0, 400, 1, 0}), "stop_angle is 400; must be 0 to 399");
    EXPECT_EQ(scan({0, 399, 0, 0}), "num_steps is 0; must be 1 to 10");
    EXPECT_EQ(scan({0, 399, 1, 101}), "delay is 101; must be 0 to 100");
    EXPECT_EQ(bench_.getRefusal(Ping360SetDeviceId{0, 0}), "id is 0; must be 1 to 254");
    EXPECT_EQ(bench_.getRefusal(Ping360SetDeviceId{255, 0}), "id is 255; must be 1 to 254");
    bench_.give(PingFrame{Ping360Transducer::message, 0, 0, Bytes(5)}.bytes());
    EXPECT_EQ(bench_.only<PingNack>().text, "the payload is too short");
    bench_.give(PingFrame{4711, 0, 0, {}}.bytes());
    EXPECT_EQ(bench_.only<PingNack>().nacked, 4711);
}

TEST_F(Ping360EmulatorTest, AcceptsTheBounds) {
    for (const Ping360Acoustics& bound :
         {Ping360Acoustics{0, 1, 80, 500, 200}, Ping360Acoustics{2, 1000, 40000, 1000, 1200}}) {
        bench_.say(Ping360Transducer{1, 399, bound, 0, 0});
        bench_.wait(2);
        EXPECT_EQ(bench_.only<Ping360DeviceData>().acoustics, bound);
    }
}

TEST_F(Ping360EmulatorTest, AScanAllRoundContinues) {
    EXPECT_THAT(makeScan({398, 397, 1, 0}, 4), ElementsAre(398, 399, 0, 1));
    EXPECT_THAT(makeScan({0, 399, 10, 0}, 42).back(), 10);
}

TEST_F(Ping360EmulatorTest, AScanOfAtMostHalfATurnReverses) {
    EXPECT_THAT(makeScan({390, 10, 10, 0}, 6), ElementsAre(390, 0, 10, 0, 390, 0));
    EXPECT_THAT(makeScan({100, 100, 1, 0}, 2), ElementsAre(100, 100));
}

TEST_F(Ping360EmulatorTest, AScanOfMoreThanHalfATurnRestarts) {
    EXPECT_THAT(makeScan({0, 210, 10, 0}, 23).at(21), 210);
    EXPECT_THAT(makeScan({0, 205, 10, 0}, 22), ::testing::Contains(200));
    EXPECT_THAT(makeScan({0, 205, 10, 0}, 22).at(21), 0);
}

TEST_F(Ping360EmulatorTest, AScanReportsItsSectorAndKeepsItsDelay) {
    bench_.say(Ping360AutoTransmit{1, acoustics, {0, 399, 1, 100}});
    bench_.answer(*bench_.request());
    bench_.wait(1);
    const auto data = bench_.only<Ping360AutoDeviceData>();
    EXPECT_EQ(data.sector, (Ping360Sector{0, 399, 1, 100}));
    EXPECT_EQ(data.data.size(), 600u);
    EXPECT_FALSE(bench_.request());
    EXPECT_NEAR(bench_.waitForNext(), 0.1, 1e-6);
    EXPECT_NEAR(bench_.waitForNext(), 0.006, 1e-6) << "then the head turns";
    EXPECT_TRUE(bench_.request());
}

TEST_F(Ping360EmulatorTest, MotorOffEndsAScanAndIsAcknowledged) {
    bench_.say(Ping360AutoTransmit{1, acoustics, {0, 399, 1, 0}});
    const auto request = bench_.request();
    bench_.say(Ping360MotorOff{});
    EXPECT_EQ(bench_.only<PingAck>().acked, 2903);
    bench_.answer(*request);
    bench_.wait(1);
    EXPECT_THAT(bench_.received(), IsEmpty());
    EXPECT_FALSE(bench_.request());
    EXPECT_FALSE(device_.wakeAt());
}

TEST_F(Ping360EmulatorTest, ANewScanReplacesOneDuringAPing) {
    bench_.say(Ping360AutoTransmit{1, acoustics, {0, 399, 1, 0}});
    bench_.answer(*bench_.request());
    bench_.say(Ping360AutoTransmit{1, acoustics, {100, 150, 10, 0}});
    EXPECT_THAT(computeAngles(2), ElementsAre(100, 110)) << "the ping of the old scan is sent to no client";
    bench_.say(transmitAt(0));
    EXPECT_FALSE(device_.scans()) << "a command by itself ends a scan";
}

TEST_F(Ping360EmulatorTest, TwoClientsGetTheirOwnAnswersOneAfterTheOther) {
    bench_.say(transmitAt(0), 1);
    bench_.say(transmitAt(10), 2);
    const auto first = bench_.request();
    bench_.answer(*first);
    bench_.wait(0.05);
    EXPECT_EQ(bench_.only<Ping360DeviceData>(1).angle, 0);
    EXPECT_THAT(bench_.received(2), IsEmpty());
    bench_.waitForNext();
    const auto second = bench_.request();
    ASSERT_TRUE(second);
    EXPECT_GT(second->time, first->time);
    bench_.answer(*second);
    bench_.wait(0.05);
    EXPECT_EQ(bench_.only<Ping360DeviceData>(2).angle, 10);
    EXPECT_THAT(bench_.received(1), IsEmpty());
}

TEST_F(Ping360EmulatorTest, RefusesTooManyCommands) {
    for (int i = 0; i < 16; ++i) bench_.say(transmitAt(0));
    EXPECT_THAT(bench_.received(), IsEmpty());
    EXPECT_EQ(bench_.getRefusal(transmitAt(0)), "too many commands wait already");
}

TEST_F(Ping360EmulatorTest, ADisconnectDuringAPingLeavesNoState) {
    bench_.say(transmitAt(0), 1);
    const auto request = bench_.request();
    bench_.say(transmitAt(1), 1);
    device_.close(1);
    bench_.answer(*request);
    bench_.wait(1);
    EXPECT_THAT(bench_.received(1), IsEmpty());
    EXPECT_FALSE(bench_.request()) << "its second command is gone as well";
    EXPECT_FALSE(device_.wakeAt());
    bench_.say(Ping360AutoTransmit{1, acoustics, {0, 399, 1, 0}}, 2);
    device_.close(2);
    EXPECT_FALSE(device_.scans());
}

TEST_F(Ping360EmulatorTest, AMissingPingIsRefusedAndWarnedOfOnce) {
    for (int i = 0; i < 2; ++i) {
        bench_.say(transmitAt(0));
        EXPECT_TRUE(bench_.request());
        bench_.wait(1.9);
        EXPECT_THAT(bench_.received(), IsEmpty());
        bench_.wait(0.2);
        EXPECT_EQ(bench_.only<PingNack>().nacked, 2601);
        EXPECT_EQ(device_.consumeWarnings().size(), i == 0 ? 1u : 0u);
    }
}

TEST_F(Ping360EmulatorTest, IgnoresPingsOfEarlierRequestsOrOfOtherBins) {
    bench_.say(transmitAt(0));
    auto request = *bench_.request();
    request.time = request.time - types::Time{1};
    bench_.answer(request);
    request.time = request.time + types::Time{1};
    request.bin_count = 500;
    bench_.answer(request);
    bench_.wait(1);
    EXPECT_THAT(bench_.received(), IsEmpty());
    EXPECT_THAT(device_.consumeWarnings(),
                ElementsAre(HasSubstr("1 beams of 500 bins where the driver asked for one of 600")));
    request.bin_count = 600;
    bench_.answer(request);
    EXPECT_EQ(bench_.only<Ping360DeviceData>().data.size(), 600u);
}

TEST_F(Ping360EmulatorTest, SamplesAreByTimeForAnySpeedOfSound) {
    bench_.say(transmitAt(0));
    const auto request = bench_.request();
    bench_.answer(*request, 1450);
    const auto again = bench_.request();
    ASSERT_TRUE(again) << "the range was for 1500 m/s";
    EXPECT_NEAR(again->range, listened * 1450 / 2, 1e-9);
    bench_.answer(*again, 1450);
    bench_.wait(1);
    EXPECT_EQ(bench_.only<Ping360DeviceData>().data.size(), 600u);
    bench_.say(transmitAt(0));
    EXPECT_NEAR(bench_.request()->range, listened * 1450 / 2, 1e-9) << "for later pings";
}

TEST_F(Ping360EmulatorTest, AnswersHaveANewIdAndFramesForOthersAreIgnored) {
    bench_.say(Ping360SetDeviceId{9, 0});
    EXPECT_EQ(bench_.only<PingAck>().acked, 2000);
    const PingGeneralRequest request{PingProtocolVersion::message};
    bench_.say(request, 1, 9);
    EXPECT_EQ(bench_.received().at(0).source, 9);
    bench_.say(request, 1, 8);
    EXPECT_THAT(bench_.received(), IsEmpty());
    bench_.say(PingNack{5, "no"});
    bench_.say(PingAck{5});
    EXPECT_THAT(bench_.received(), IsEmpty()) << "answers are not answered";
}

TEST_F(Ping360EmulatorTest, AResetRestoresTheBootState) {
    bench_.say(transmitAt(100));
    bench_.say(Ping360Reset{0, 0});
    EXPECT_EQ(bench_.only<PingAck>().acked, 2600);
    bench_.wait(1);
    EXPECT_THAT(bench_.received(), IsEmpty()) << "the command in progress is dropped";
    bench_.say(PingGeneralRequest{Ping360DeviceData::message});
    EXPECT_EQ(bench_.only<Ping360DeviceData>().angle, 0);
    bench_.say(Ping360Reset{1, 0});
    bench_.received();
    bench_.say(PingGeneralRequest{Ping360DeviceData::message});
    EXPECT_THAT(bench_.received(), IsEmpty()) << "the bootloader waits five seconds";
    bench_.wait(5);
    bench_.say(PingGeneralRequest{Ping360DeviceData::message});
    EXPECT_EQ(bench_.received().size(), 1u);
}

TEST_F(Ping360EmulatorTest, ANoisySerialLineLosesOnlyDamagedFrames) {
    Bytes line = {0, 'U', 'B', 'R', 20, 0};
    const auto add = [&](const Bytes& bytes) { line.insert(line.end(), bytes.begin(), bytes.end()); };
    Bytes damaged = pingBytes(PingGeneralRequest{PingDeviceInformation::message});
    damaged[8] ^= 1;
    add(damaged);
    add(pingBytes(PingGeneralRequest{PingProtocolVersion::message}));
    for (const uint8_t byte : line) bench_.give({byte}, 1, false);
    EXPECT_EQ(bench_.only<PingProtocolVersion>().major, 1);
}

TEST_F(Ping360EmulatorTest, DiscoveryHasTheTextOfFinders) {
    const uint8_t mac[] = {0x54, 0x10, 0xEC, 0x79, 0x7D, 0xD1}, ip[] = {192, 168, 0, 197};
    EXPECT_EQ(ping360Discovery(mac, ip),
              "SONAR PING360\r\nBlue Robotics\r\nMAC Address:- 54-10-EC-79-7D-D1\r\nIP Address:- 192.168.000.197\r\n");
}

TEST_F(Ping360EmulatorTest, RequiresThreeGains) {
    Ping360Config config;
    EXPECT_THAT(test::countRefusals(config), IsEmpty());
    config.gain_db = {1, 2};
    EXPECT_THAT(test::countRefusals(config), testing::SizeIs(1));
}

}  // namespace
}  // namespace insonify::device
