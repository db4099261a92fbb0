// A Micron with bytes and a simulated clock, with the messages and checks of an open driver.
#include <gmock/gmock.h>

#include <map>

#include "components/device/micron/MicronEmulator.hpp"
#include "tests/support/MicronDriver.hpp"

namespace insonify::device {
namespace {

using test::MicronDriver;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct MicronEmulatorTest : ::testing::Test {
    MicronEmulatorTest() {
        emulator_.opened(client);
        advance(0);
        advance(1);
        sent_.clear();
    }

    void advance(double seconds) {
        now_ = now_ + types::Time::fromSeconds(seconds);
        emulator_.tick(now_);
    }
    void nextBytes() {
        ping_.time = now_;
        emulator_.setPing(ping_);
    }
    /** Advances to the next due time; the sonar answers at once. */
    void wait() {
        emulator_.tick(now_);
        if (answers_ && !requests_.empty()) {
            nextBytes();
            requests_.pop_back();
        }
        if (const auto due = emulator_.tick(now_)) now_ = std::max(now_, *due);
        emulator_.tick(now_);
    }
    /** Advances until there is something to read, as a driver waits. */
    Bytes readFor(Client whom) {
        for (int i = 0; i < 10 && sent_[whom].empty(); ++i) wait();
        if (sent_[whom].empty()) throw std::runtime_error("time out");
        Bytes bytes;
        std::swap(bytes, sent_[whom]);
        return bytes;
    }
    MicronDriver driver(Client whom) {
        return {[this, whom](const Bytes& bytes) { emulator_.received(whom, bytes, now_); },
                [this, whom] { return readFor(whom); }};
    }
    static types::Sonar makePing(std::vector<float> bins) {
        types::Sonar ping;
        ping.bins = std::move(bins);
        return ping;
    }

    const Client client{0, 1}, other{0, 2};
    types::Time now_{1'700'000'000'000'000};
    std::map<Client, Bytes> sent_;
    std::vector<types::SonarSettings> requests_, all_asked_;
    std::vector<std::string> warnings_;
    bool answers_ = true;
    types::Sonar ping_ = makePing(std::vector<float>(200, 65535));
    MicronEmulator emulator_{
        {.centring_time = 0},
        {[this](const types::SonarSettings& settings) {
             requests_.push_back(settings);
             all_asked_.push_back(settings);
         },
         [this](Client to, Bytes bytes) { sent_[to].insert(sent_[to].end(), bytes.begin(), bytes.end()); },
         [this](const std::string& text) { warnings_.push_back(text); }}};
    MicronDriver driver_ = driver(client);
};

TEST_F(MicronEmulatorTest, ADriverCompletesItsHandshakeAndScansAllRound) {
    driver_.reboot();
    EXPECT_EQ(driver_.serialNumber(), 1);
    EXPECT_TRUE(driver_.isFullDuplex());
    driver_.configure({});
    double before = 0;
    for (int i = 0; i < 430; ++i) {
        driver_.request();
        const auto beam = driver_.beam();
        EXPECT_EQ(beam.bins.size(), 200u);
        EXPECT_THAT(beam.bins, Each(255));
        const double turned = std::remainder(beam.bearing - before, 2 * M_PI);
        EXPECT_NEAR(turned, i == 0 ? 0 : -2 * M_PI * 15 / 6400, 1e-3) << "clockwise, by 15/16 gradian";
        before = beam.bearing;
        EXPECT_NEAR(std::remainder(all_asked_.back().bearing.rad - beam.bearing, 2 * M_PI), 0, 1e-3) << i;
    }
    EXPECT_EQ(all_asked_.size(), 430u);
    EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(MicronEmulatorTest, RequestsTheCommandedSettingsFromTheSonar) {
    SeaNetHeadCommand command;
    command.control = SeaNetControl::eight_bits;
    command.transmit[0] = 77846282;
    command.gain = 105;
    command.ad_interval = 100;
    command.bins = 250;
    command.right = 6399;
    emulator_.received(client, command.message().packet(), now_);
    driver_.request();
    advance(0);
    ASSERT_EQ(requests_.size(), 1u);
    EXPECT_EQ(requests_[0].time, now_);
    EXPECT_NEAR(requests_[0].range, 250 * 64e-6 * 1500 / 2, 1e-9);
    EXPECT_EQ(requests_[0].bin_count, 250u);
    EXPECT_NEAR(requests_[0].frequency_khz, 580, 1e-4);
    EXPECT_NEAR(requests_[0].gain_db, 8, 1e-9) << "50 % of 80 dB, relative to the usual 40 %";
    EXPECT_EQ(requests_[0].bearing.rad, 0) << "ahead";
    EXPECT_EQ(requests_[0].speed_of_sound, 1500);
}

TEST_F(MicronEmulatorTest, ALineIsAnsweredOnceSoundIsBackAndTheMotorHasArrived) {
    driver_.configure({.resolution = 0.1, .max_distance = 20, .step = 2 * M_PI / 100});
    const double listening = 200 * 208 * 640e-9, travel = 63 * 25 * 10e-6;
    types::Time asked_at = now_;
    driver_.request();
    advance(0);
    ASSERT_EQ(requests_.size(), 1u);
    nextBytes();
    advance(listening - 1e-4);
    EXPECT_TRUE(sent_[client].empty()) << "sound is not back";
    advance(1e-4);
    EXPECT_FALSE(sent_[client].empty());
    EXPECT_NEAR((now_ - asked_at).seconds(), listening, 2e-6);
    sent_.clear();
    driver_.request();
    advance(travel - 1e-4);
    EXPECT_EQ(requests_.size(), 1u) << "the motor turns";
    advance(1e-4);
    ASSERT_EQ(requests_.size(), 2u);
    advance(2 * listening);
    EXPECT_TRUE(sent_[client].empty()) << "the ping has not arrived";
    nextBytes();
    advance(0);
    EXPECT_FALSE(sent_[client].empty());
}

TEST_F(MicronEmulatorTest, ASectorIsScannedToAndFro) {
    driver_.configure({.left = M_PI / 4, .right = -M_PI / 4, .step = 2 * M_PI / 40, .continuous = false});
    std::vector<int> places;
    for (int i = 0; i < 20; ++i) {
        driver_.request();
        places.push_back(static_cast<int>(std::lround(driver_.beam().bearing / (2 * M_PI) * 6400)));
    }
    int turns = 0;
    for (size_t i = 2; i < places.size(); ++i) {
        EXPECT_LE(std::abs(places[i]), 802) << "within the limits";
        turns += (places[i] - places[i - 1]) * (places[i - 1] - places[i - 2]) < 0 ? 1 : 0;
    }
    EXPECT_GE(turns, 1);
    EXPECT_NEAR(*std::ranges::max_element(places), 800, 2);
    EXPECT_NEAR(*std::ranges::min_element(places), -800, 2);
}

TEST_F(MicronEmulatorTest, ASectorAcrossTheSternIsEnteredAtItsLimit) {
    SeaNetHeadCommand command;
    command.control = SeaNetControl::eight_bits;
    command.left = 6000;
    command.right = 400;
    command.step = 160;
    command.ad_interval = 10;
    command.bins = 10;
    emulator_.received(client, command.message().packet(), now_);
    sent_.clear();
    EXPECT_EQ(emulator_.bearing(), 6000) << "it turns there at once";
    std::vector<int> places;
    for (int i = 0; i < 9; ++i) {
        driver_.request();
        readFor(client);
        places.push_back(emulator_.bearing());
    }
    EXPECT_THAT(places, ElementsAre(6160, 6320, 80, 240, 400, 240, 80, 6320, 6160));
}

TEST_F(MicronEmulatorTest, FourBitsShowTheCommandedSpan) {
    driver_.configure({.resolution = 0.1, .max_distance = 0.8, .low_resolution = true});
    const auto code = [](double of_255) { return static_cast<float>(65535 * of_255 / 255); };
    ping_ = makePing({0, code(8), code(8 + 81 / 15.0), code(48.5), code(89), code(255), NAN});
    driver_.request();
    EXPECT_THAT(driver_.beam().bins, ElementsAre(0, 0, 17, 8 * 17, 255, 255, 0, 0));
    ping_ = makePing({code(9), code(10)});
    driver_.configure({.resolution = 0.1, .max_distance = 0.4});
    driver_.request();
    EXPECT_THAT(driver_.beam().bins, ElementsAre(9, 10, 0, 0)) << "8 bits: 255 for 80 dB; a bin that was not made is 0";
}

TEST_F(MicronEmulatorTest, AnInvertedHeadTurnsTheOtherWay) {
    SeaNetHeadCommand command;
    command.control = SeaNetControl::eight_bits | SeaNetControl::continuous | SeaNetControl::inverted;
    command.ad_interval = 10;
    command.bins = 10;
    command.step = 100;
    emulator_.received(client, command.message().packet(), now_);
    sent_.clear();
    for (int i = 0; i < 2; ++i) {
        driver_.request();
        readFor(client);
    }
    EXPECT_NEAR(all_asked_[1].bearing.rad, 2 * M_PI * 100 / 6400, 1e-9);
}

TEST_F(MicronEmulatorTest, RefusesImpossibleCommands) {
    const auto configured = [&](auto change) {
        SeaNetHeadCommand command;
        command.ad_interval = command.bins = 100;
        change(command);
        sent_.clear();
        emulator_.received(client, command.message().packet(), now_);
        SeaNetReader reader;
        reader.add(sent_[client]);
        return SeaNetAlive::in(*reader.next())->configured;
    };
    EXPECT_TRUE(configured([](auto&) {}));
    driver_.request();
    advance(0);
    ASSERT_EQ(requests_.size(), 1u);
    EXPECT_FALSE(configured([](auto& command) { command.bins = 0; }));
    sent_.clear();
    nextBytes();
    advance(0.5);
    EXPECT_TRUE(sent_[client].empty()) << "the earlier line is dropped";
    EXPECT_FALSE(configured([](auto& command) { command.bins = 1501; }));
    EXPECT_FALSE(configured([](auto& command) { command.ad_interval = 0; }));
    EXPECT_FALSE(configured([](auto& command) { command.ad_interval = 1501; }));
    EXPECT_FALSE(configured([](auto& command) { command.left = 6400; }));
    EXPECT_FALSE(configured([](auto& command) { command.right = 65535; }));
    EXPECT_EQ(warnings_.size(), 6u);
    EXPECT_THAT(warnings_.front(), HasSubstr("must have 1 to 1500 bins"));
    sent_.clear();
    driver_.request();
    SeaNetReader reader;
    reader.add(sent_[client]);
    EXPECT_TRUE(SeaNetAlive::in(*reader.next())->unconfigured) << "no parameters, no line";
}

TEST_F(MicronEmulatorTest, TwoClientsShareOneHead) {
    emulator_.opened(other);
    MicronDriver second = driver(other);
    driver_.configure({});
    second.configure({});
    driver_.request();
    second.request();
    const auto first = driver_.beam();
    EXPECT_EQ(all_asked_.size(), 1u) << "one ping for both";
    EXPECT_EQ(second.beam().bearing, first.bearing);
    driver_.request();
    advance(0);
    emulator_.closed(client);  // during a ping
    nextBytes();
    advance(1);
    EXPECT_TRUE(sent_[client].empty());
    second.request();
    EXPECT_EQ(second.beam().bins.size(), 200u) << "and the head continues for the other";
}

TEST_F(MicronEmulatorTest, ARebootDuringAPingRestartsTheHead) {
    driver_.configure({});
    driver_.request();
    advance(0);
    ASSERT_EQ(requests_.size(), 1u);
    driver_.reboot();
    nextBytes();
    advance(0.1);
    EXPECT_TRUE(sent_[client].empty()) << "the line is dropped";
    driver_.configure({});
    driver_.request();
    EXPECT_NEAR(driver_.beam().bearing, 0, 1e-3) << "ahead again";
}

TEST_F(MicronEmulatorTest, McGillsDriverOpensARecentringHeadAndScansLines) {
    MicronEmulator recentring(
        {}, {[this](const types::SonarSettings& settings) { requests_.push_back(settings); },
             [this](Client to, Bytes bytes) { sent_[to].insert(sent_[to].end(), bytes.begin(), bytes.end()); },
             [this](const std::string& text) { warnings_.push_back(text); }});
    std::swap(emulator_, recentring);
    emulator_.opened(client);
    emulator_.tick(now_);
    ASSERT_TRUE(driver_.openLikeMcGill({}));
    const types::Time opened = now_;
    for (int i = 0; i < 3; ++i) {
        driver_.request();
        EXPECT_EQ(driver_.beam().bins.size(), 200u) << "of head type 0x11";
    }
    EXPECT_GT((now_ - opened).seconds(), 1) << "no line before the motor is centred";
    EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(MicronEmulatorTest, AHeadReversesOnceForEachReversal) {
    driver_.configure({.step = 2 * M_PI / 100});
    const auto next = [&] {
        driver_.request();
        return driver_.beam().bearing;
    };
    next();
    const double clockwise = next(), further = next();
    EXPECT_LT(further, clockwise);
    driver_.reverse();
    next();  // its motor was turning
    const double turned = next(), back = next();
    EXPECT_GT(back, turned);
    EXPECT_THAT(warnings_, IsEmpty());
}

/** A driver that takes an earlier mtAlive for the answer to its mtReBoot continues at once. */
TEST_F(MicronEmulatorTest, ACommandDuringBootIsAcceptedAndItsLineWaits) {
    emulator_.received(client, seaNetRequest(SeaNetType::Reboot).packet(), now_);
    driver_.configure({});
    driver_.request();
    advance(0.4);
    EXPECT_TRUE(requests_.empty());
    advance(0.1);
    EXPECT_EQ(requests_.size(), 1u);
}

TEST_F(MicronEmulatorTest, RequestsAMissingPingAgainAndAnswersTheLineLate) {
    driver_.configure({});
    for (size_t outage = 1; outage <= 2; ++outage) {
        answers_ = false;
        requests_.clear();
        sent_.clear();
        driver_.request();
        for (int i = 0; i < 13; ++i) advance(0.5);
        EXPECT_EQ(requests_.size(), 3u) << "at once, and when two seconds have passed without a ping";
        for (const types::SonarSettings& each : requests_) EXPECT_EQ(each.bearing.rad, requests_.front().bearing.rad);
        EXPECT_EQ(sent_[client].size(), size_t{22} * 4) << "mtAlive at 3, 4, 5 and 6 s, since the first ping is late";
        ASSERT_EQ(warnings_.size(), outage);
        EXPECT_THAT(warnings_.back(), HasSubstr("a requested ping did not arrive"));
        sent_.clear();
        ping_.time = requests_.front().time - types::Time{1};
        emulator_.setPing(ping_);
        emulator_.tick(now_);
        EXPECT_THAT(sent_[client], IsEmpty()) << "an earlier ping has another bearing";
        ping_.time = requests_.front().time;
        emulator_.setPing(ping_);
        EXPECT_EQ(driver_.beam().bins.size(), 200u) << "the first requested ping, late";
        answers_ = true;
        driver_.request();
        EXPECT_EQ(driver_.beam().bins.size(), 200u);
    }
}

/** A head whose sonar gives no pings can still be commanded and rebooted. */
TEST_F(MicronEmulatorTest, ACommandEndsALineThatIsNotAnswered) {
    driver_.configure({});
    answers_ = false;
    driver_.request();
    for (int i = 0; i < 100; ++i) advance(2);
    driver_.configure({});
    sent_.clear();
    driver_.request();
    for (int i = 0; i < 3; ++i) advance(0.5);
    EXPECT_THAT(sent_[client], IsEmpty()) << "a head that scans and is not late sends no mtAlive";
    driver_.reboot();
    answers_ = true;
    requests_.clear();
    driver_.configure({});
    driver_.request();
    EXPECT_EQ(driver_.beam().bins.size(), 200u);
}

TEST_F(MicronEmulatorTest, SendsAliveUntilStopAlive) {
    const auto setPing = [&] {
        const size_t size = sent_[client].size();
        sent_.clear();
        return size / 22;
    };
    for (int i = 0; i < 3; ++i) advance(1);
    EXPECT_EQ(setPing(), 3u);
    emulator_.received(client, seaNetRequest(SeaNetType::StopAlive).packet(), now_);
    for (int i = 0; i < 3; ++i) advance(1);
    EXPECT_EQ(setPing(), 0u);
}

TEST_F(MicronEmulatorTest, IgnoresNoiseAndOtherNodes) {
    SeaNetMessage to_another = seaNetRequest(SeaNetType::Reboot);
    to_another.to = 20;
    emulator_.received(client, to_another.packet(), now_);
    emulator_.received(client, Bytes{'@', '0', '0', 0, 255, '@'}, now_);
    emulator_.received(client, SeaNetMessage{static_cast<SeaNetType>(99), 255, 2, Bytes(7)}.packet(), now_);
    emulator_.received(client, SeaNetMessage{SeaNetType::HeadCommand, 255, 2, Bytes(7)}.packet(), now_);
    EXPECT_THAT(warnings_, ElementsAre(HasSubstr("it is too short")));
    sent_.clear();
    EXPECT_EQ(driver_.serialNumber(), 1);
}

}  // namespace
}  // namespace insonify::device
