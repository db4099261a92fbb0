// A Ping360 on real lines of this machine: UDP, TCP and a pseudo terminal.
#include <gmock/gmock.h>

#include <random>

#include "components/device/DriverLine.hpp"
#include "components/device/Probe.hpp"
#include "components/device/ping/PingDeviceTask.hpp"
#include "tests/device/PingBench.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::device {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr Ping360Acoustics own_acoustics{1, 50, 100, 750, 600};

Ping360TaskConfig quickConfig() {
    Ping360TaskConfig config;
    config.ends.port = 0;
    config.ends.serial = "line";
    config.discovery = Ping360Discovery{0, "192.168.2.10", "02-00-00-00-03-60"};
    config.device.seconds_per_gradian = config.device.overhead = 0;
    return config;
}

/** A driver that reads frames. */
class Driver {
public:
    explicit Driver(DriverLine line) : line_(std::move(line)) {}
    void give(const Bytes& bytes) const { line_.send(bytes); }
    void say(const auto& message) const { give(pingBytes(message)); }
    std::vector<PingFrame> received() {
        reader_.add(line_.receive(std::chrono::milliseconds(1)));
        std::vector<PingFrame> frames;
        while (auto frame = reader_.next()) frames.push_back(std::move(*frame));
        return frames;
    }

private:
    DriverLine line_;
    PingFrameReader reader_{4096};
};

struct Ping360TaskTest : ::testing::Test {
    void SetUp() override {
        task_.environment().output_folder = folder_.path();
        task_.config.set(quickConfig());
        task_.settings.connectTo(requests_.port, framework::ConnPolicy::buffer(4));
        pings_.port.connectTo(task_.ping, framework::ConnPolicy::buffer(4));
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    }
    DriverLine udp() const { return DriverLine::udp("127.0.0.1", task_.getPort(PingDeviceTask::udp)); }
    DriverLine tcp() const {
        return DriverLine::tcp("127.0.0.1", task_.getPort(PingDeviceTask::tcp), std::chrono::seconds(10));
    }
    DriverLine serial() const { return DriverLine::serial(folder_ / "line"); }
    /** Runs a cycle of the task and of a sonar that answers at once. */
    void cycle() {
        task_.update();
        for (types::SonarSettings request; requests_.port.readNew(request);) {
            auto ping = pingFor(request);
            std::ranges::fill(ping->bins, static_cast<float>(std::lround(std::abs(request.bearing.deg()))) * 257);
            pings_.port.write(ping);
        }
    }
    /** Returns the next message of a kind that a driver receives; skips messages of other kinds. */
    template <class Message>
    Message next(Driver& driver) {
        std::optional<Message> found;
        EXPECT_TRUE(test::becomesTrue([&] {
            cycle();
            for (const PingFrame& frame : driver.received())
                if (!found) found = pingMessage<Message>(frame);
            return found.has_value();
        })) << Message::message;
        return found.value_or(Message{});
    }
    uint8_t getEcho(const Ping360DeviceData& data) { return data.data.empty() ? 0 : data.data[0]; }

    Folder folder_;
    Ping360Task task_{"ping360"};
    test::Reader<types::SonarSettings> requests_{"asked"};
    test::Writer<types::SonarPtr> pings_{"pings"};
};

TEST_F(Ping360TaskTest, AnswersByDatagramConnectionAndLine) {
    Driver drivers[] = {Driver(udp()), Driver(tcp()), Driver(serial())};
    for (Driver& driver : drivers) {
        driver.say(PingGeneralRequest{PingDeviceInformation::message});
        EXPECT_EQ(next<PingDeviceInformation>(driver).type, 2);
        driver.say(Ping360Transducer{0, 250, own_acoustics, 1, 0});
        const auto data = next<Ping360DeviceData>(driver);
        EXPECT_EQ(data.angle, 250);
        EXPECT_EQ(data.data.size(), 600u);
        EXPECT_EQ(getEcho(data), 45) << "the sonar's echo there";
        driver.say(Ping360Transducer{0, 400, own_acoustics, 1, 0});
        EXPECT_EQ(next<PingNack>(driver).text, "angle is 400; must be 0 to 399");
    }
}

TEST_F(Ping360TaskTest, TwoDriversGetTheirOwnEchoes) {
    Driver a(tcp()), b(tcp());
    for (int i = 0; i < 20; ++i) {
        a.say(Ping360Transducer{1, 250, own_acoustics, 1, 0});
        b.say(Ping360Transducer{1, 300, own_acoustics, 1, 0});
        EXPECT_EQ(getEcho(next<Ping360DeviceData>(a)), 45);
        EXPECT_EQ(getEcho(next<Ping360DeviceData>(b)), 90);
    }
}

TEST_F(Ping360TaskTest, ADriverThatLeavesDuringAPingHarmsNoOther) {
    for (int i = 0; i < 50; ++i) {
        Driver gone(tcp());
        gone.say(Ping360Transducer{1, 300, own_acoustics, 1, 0});
        cycle();
    }
    Driver stays(tcp());
    stays.say(Ping360Transducer{1, 250, own_acoustics, 1, 0});
    EXPECT_EQ(getEcho(next<Ping360DeviceData>(stays)), 45);
}

TEST_F(Ping360TaskTest, ANoisyLineLosesNoIntactFrame) {
    Driver driver(serial());
    std::mt19937 random(3);
    std::uniform_int_distribution<int> byte(0, 255), length(0, 30);
    for (uint16_t i = 0; i < 100; ++i) {
        Bytes noise(static_cast<size_t>(length(random)));
        for (uint8_t& each : noise) each = static_cast<uint8_t>(byte(random));
        if (!noise.empty()) driver.give(noise);
        driver.say(Ping360Transducer{1, i, own_acoustics, 0, 0});
        ASSERT_EQ(next<Ping360DeviceData>(driver).angle, i);
    }
}

TEST_F(Ping360TaskTest, ADriverThatDoesNotReadDelaysNoOther) {
    Driver deaf(tcp()), other(udp());
    deaf.say(Ping360AutoTransmit{1, {0, 1, 80, 750, 1200}, {0, 399, 1, 0}});
    for (int i = 0; i < 300; ++i) {
        other.say(PingGeneralRequest{PingProtocolVersion::message});
        ASSERT_EQ(next<PingProtocolVersion>(other).major, 1);
    }
    other.say(Ping360MotorOff{});
    EXPECT_EQ(next<PingAck>(other).acked, 2903);
}

TEST_F(Ping360TaskTest, AnswersDiscovery) {
    const DriverLine finder = DriverLine::udp("127.0.0.1", task_.getPort(3));
    const std::string question = "Discovery";
    finder.send({reinterpret_cast<const uint8_t*>(question.data()), question.size()});
    Bytes answer;
    EXPECT_TRUE(test::becomesTrue([&] {
        cycle();
        answer = finder.receive(std::chrono::milliseconds(1));
        return !answer.empty();
    }));
    EXPECT_THAT(std::string(answer.begin(), answer.end()),
                StartsWith("SONAR PING360\r\nBlue Robotics\r\nMAC Address:- 02-00-00-00-03-60\r\nIP Address:- "
                           "192.168.002.010"));
}

TEST_F(Ping360TaskTest, EndsThatCannotBeOpenedAreOneClearDiagnostic) {
    Ping360Task second("second");
    Ping360TaskConfig config;
    config.ends.port = task_.getPort(PingDeviceTask::udp);
    second.config.set(config);
    EXPECT_FALSE(second.configure());
    ASSERT_NE(second.configError(), nullptr);
    EXPECT_THAT(second.configError()->what(), HasSubstr("second.port: is 127.0.0.1:"));
    EXPECT_THAT(test::countRefusals(Ping360Discovery{30303, "300.1.2.3", "02-00"}),
                testing::ElementsAre("ip: is '300.1.2.3'; write it as 192.168.2.10",
                                     "mac: is '02-00'; write it as 02-00-00-00-03-60"));
}

TEST_F(Ping360TaskTest, TheCommandRecognisesIt) {
    std::vector<ProbeOutcome> outcomes;
    std::atomic<bool> done{false};
    std::thread asking([&] {
        ProbeAddress address;
        address.host = "127.0.0.1";
        address.port = task_.getPort(PingDeviceTask::udp);
        outcomes = probe(address, std::chrono::seconds(20));
        done = true;
    });
    EXPECT_TRUE(test::becomesTrue([&] {
        cycle();
        return done.load();
    }));
    asking.join();
    ASSERT_FALSE(outcomes.empty());
    EXPECT_EQ(outcomes[0].device, "Blue Robotics Ping360, id 2, revision 1, firmware 3.3.8, protocol 1.1.0");
}

TEST(Ping1dTaskTest, AnswersByDatagram) {
    Ping1dTask task("ping1d");
    Ping1dTaskConfig config;
    config.ends.port = 0;
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    Driver driver(DriverLine::udp("127.0.0.1", task.getPort(PingDeviceTask::udp)));
    driver.say(PingGeneralRequest{PingDeviceInformation::message});
    std::optional<PingDeviceInformation> about;
    EXPECT_TRUE(test::becomesTrue([&] {
        task.update();
        for (const PingFrame& frame : driver.received()) about = pingMessage<PingDeviceInformation>(frame);
        return about.has_value();
    }));
    EXPECT_EQ(about->type, 1);
}

}  // namespace
}  // namespace insonify::device
