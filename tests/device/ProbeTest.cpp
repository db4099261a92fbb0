#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "components/device/DriverLine.hpp"
#include "components/device/Probe.hpp"
#include "components/device/micron/SeaNet.hpp"
#include "components/device/oculus/OculusMessages.hpp"
#include "components/device/ping/PingProtocol.hpp"
#include "components/device/wire/Network.hpp"
#include "tests/device/ByteStrings.hpp"
#include "tests/support/OculusDriver.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;

TEST(ProbeTest, AnAddressIsAHostAPortOrALine) {
    EXPECT_EQ(probeAddress("127.0.0.1").host, "127.0.0.1");
    EXPECT_EQ(probeAddress("127.0.0.1").port, 0);
    EXPECT_EQ(probeAddress("127.0.0.1:9092").port, 9092);
    EXPECT_EQ(probeAddress("[::1]:12345").host, "::1");
    EXPECT_EQ(probeAddress("[::1]:12345").port, 12345);
    EXPECT_EQ(probeAddress("::1").host, "::1");
    EXPECT_EQ(probeAddress("/dev/ttyUSB0").serial, "/dev/ttyUSB0");
    const auto why = [](const std::string& text) -> std::string {
        return test::computeError<types::ConfigError>([&] { probeAddress(text); });
    };
    EXPECT_THAT(why(""), HasSubstr("names no host"));
    EXPECT_THAT(why(":5"), HasSubstr("names no host"));
    for (const char* port : {"0", "65536", "x", "", "12 "})
        EXPECT_THAT(why(std::string("127.0.0.1:") + port), HasSubstr("is not from 1 to 65535")) << port;
    EXPECT_THAT(why("no.such.host.invalid"), HasSubstr("a host that this machine does not know"));
}

TEST(ProbeTest, DevicesAreIdentified) {
    const Bytes information = pingBytes(PingDeviceInformation{1, 2, 3, 29, 0, 0}, 7),
                version = pingBytes(PingProtocolVersion{});
    EXPECT_EQ(pingDeviceIn(information + version),
              "Blue Robotics Ping1D, id 7, revision 2, firmware 3.29.0, protocol 1.0.0");
    EXPECT_FALSE(pingDeviceIn(information)) << "the rest has not arrived";
    EXPECT_THAT(*pingDeviceIn(pingBytes(PingDeviceInformation{9, 0, 0, 0, 0, 0}) + version), HasSubstr("of type 9"));
    EXPECT_EQ(ping360DiscoveryIn(toBytes("SONAR PING360\r\nBlue Robotics\r\nMAC Address:- 02-00\r\n")),
              "SONAR PING360, Blue Robotics, MAC Address:- 02-00");
    OculusStatus status{.part = 1032, .address = {192, 168, 2, 3}};
    EXPECT_EQ(oculusIn(toBytes(status)), "Blueprint Subsea Oculus M750d, at 192.168.2.3, running");
    status.status = 1;
    EXPECT_THAT(*oculusIn(toBytes(status)), HasSubstr("not ready"));
    status.part = 9;
    EXPECT_THAT(*oculusIn(toBytes(status)), HasSubstr("Oculus of part 9,"));
    EXPECT_EQ(oculusIn(oculusDummy(1, 1032)), "Blueprint Subsea Oculus M750d, alive");
    EXPECT_EQ(oculusIn(oculusLog(1, 1032, "")), "Blueprint Subsea Oculus M750d, message 0x80");
    EXPECT_EQ(seaNetIn(SeaNetAlive{}.message().packet()), "Tritech SeaNet device, node 2, alive");
    EXPECT_EQ(seaNetIn(Bytes{'@', '0'} + SeaNetVersion{.software = 3, .serial = 1234}.message().packet()),
              "Tritech SeaNet device, node 2, software 3, serial number 1234");
    EXPECT_EQ(sonar3dIn(toBytes("HTTP/1.1 200 OK\r\n\r\n{\"version_short\": \"1.7.1\"}")),
              "Water Linked Sonar 3D-15, version 1.7.1");
}

TEST(ProbeTest, RejectsBytesThatOnlyResembleSeaNet) {
    const Bytes alive = SeaNetAlive{}.message().packet();
    EXPECT_FALSE(seaNetIn(std::span(alive).first(alive.size() - 1))) << "the rest has not arrived";
    Bytes damaged = alive;
    damaged.back() = 0;
    EXPECT_FALSE(seaNetIn(damaged)) << "no line feed at its end";
    damaged = alive;
    damaged[5] += 1;
    EXPECT_FALSE(seaNetIn(damaged)) << "two lengths that differ";
    EXPECT_FALSE(seaNetIn(seaNetRequest(SeaNetType::SendVersion).packet())) << "an echo of the question";
}

TEST(ProbeTest, ForeignBytesAreNotADevice) {
    for (const Bytes& bytes : {Bytes{}, Bytes{0}, Bytes(200, 'B'), toBytes("HTTP/1.1 404 Not Found\r\n\r\n{}"),
                               toBytes("SONAR"), toBytes("SONAR PING360\x01"), Bytes(200, '@')}) {
        EXPECT_FALSE(pingDeviceIn(bytes));
        EXPECT_FALSE(ping360DiscoveryIn(bytes));
        EXPECT_FALSE(oculusIn(bytes));
        EXPECT_FALSE(seaNetIn(bytes));
        EXPECT_FALSE(sonar3dIn(bytes));
    }
}

TEST(ProbeTest, ReportsNoAnswerWithPossibleCauses) {
    Network network([] {});
    const End end = network.listenTcp("127.0.0.1", 0);
    ProbeAddress address{"127.0.0.1", "", network.getPort(end)};
    for (const ProbeOutcome& outcome : probe(address, std::chrono::milliseconds(20))) {
        EXPECT_EQ(outcome.device, "");
        EXPECT_NE(outcome.failure, "") << outcome.request;
        EXPECT_NE(outcome.advice, "") << outcome.request;
    }
    const ProbeAddress line{"", "/nowhere/line", 0};
    const auto outcomes = probe(line, std::chrono::milliseconds(20));
    ASSERT_EQ(outcomes.size(), 2u) << "ping protocol and SeaNet";
    for (const ProbeOutcome& outcome : outcomes) EXPECT_EQ(outcome.failure, "No such file or directory");
}

/** Sends a status to a port of this machine repeatedly, from its own address. */
class StatusSender {
public:
    StatusSender(const char* from, uint16_t port, const OculusStatus& status) {
        const sockaddr_in here = test::Socket::address(inet_addr(from), 0);
        EXPECT_EQ(bind(socket_.file(), reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
        thread_ = std::thread([this, port, bytes = toBytes(status)] {
            const sockaddr_in to = test::Socket::address(htonl(INADDR_LOOPBACK), port);
            while (!stop_) {
                sendto(socket_.file(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                       sizeof to);
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        });
    }
    ~StatusSender() {
        stop_ = true;
        thread_.join();
    }

private:
    const test::Socket socket_{SOCK_DGRAM};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST(ProbeTest, AcceptsBroadcastsOfTheProbedDeviceOnly) {
    const uint16_t port = test::OculusListener().port();
    const Probe question{"Oculus status", Probe::Line::Broadcast, port, {}, oculusIn, "silence"};
    const auto computeReceived = [&](const char* host, int patience_ms) {
        return ask(question, {host, "", 0}, std::chrono::milliseconds(patience_ms)).device;
    };
    const StatusSender other("127.0.0.2", port, {.part = 1042, .address = {192, 168, 2, 3}});
    EXPECT_THAT(computeReceived("127.0.0.2", 10000), HasSubstr("M1200d")) << "by its sender";
    EXPECT_THAT(computeReceived("192.168.2.3", 10000), HasSubstr("M1200d")) << "by its own address";
    EXPECT_EQ(computeReceived("127.0.0.1", 100), "");
    EXPECT_EQ(computeReceived("::1", 100), "");
    EXPECT_EQ(computeReceived("192.168.2.4", 100), "");
    const StatusSender own("127.0.0.1", port, {.part = 1032});
    EXPECT_THAT(computeReceived("127.0.0.1", 10000), HasSubstr("M750d"));
    EXPECT_THAT(computeReceived("::1", 10000), HasSubstr("M750d"));
}

TEST(ProbeTest, ANegativePatienceDoesNotWait) {
    EXPECT_TRUE(DriverLine::broadcasts(0).receive(std::chrono::milliseconds(-5)).empty());
    EXPECT_TRUE(DriverLine::broadcasts(0).receiveDatagram(std::chrono::milliseconds(-5)).bytes.empty());
}

/** A peer that closes a connection after having accepted it. */
TEST(ProbeTest, ALineThatThePeerHasClosedIsAnErrorAndNoSignal) {
    std::signal(SIGPIPE, SIG_DFL);
    const int listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(bind(listening, reinterpret_cast<const sockaddr*>(&address), size), 0);
    ASSERT_EQ(listen(listening, 1), 0);
    getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size);
    const DriverLine line = DriverLine::tcp("127.0.0.1", ntohs(address.sin_port), std::chrono::milliseconds(1000));
    close(accept(listening, nullptr, nullptr));
    close(listening);
    EXPECT_THROW(
        {
            for (int i = 0; i < 1000; ++i) line.send(Bytes(100, 0));
        },
        LineError);
}

TEST(ProbeTest, APeerThatDoesNotReadIsAnErrorWithinItsTime) {
    const int listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(bind(listening, reinterpret_cast<const sockaddr*>(&address), size), 0);
    ASSERT_EQ(listen(listening, 1), 0);
    getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size);
    const DriverLine line = DriverLine::tcp("127.0.0.1", ntohs(address.sin_port), std::chrono::milliseconds(1000));
    try {
        line.send(Bytes(64 << 20, 0));
        FAIL() << "64 MiB fit nowhere";
    } catch (const LineError& error) {
        EXPECT_THAT(error.what(), HasSubstr("timed out"));
    }
    close(listening);
}

TEST(ProbeTest, EveryProbeExplainsSilence) {
    for (const Probe& each : allProbes()) {
        EXPECT_NE(each.silence, "") << each.protocol;
        EXPECT_TRUE(each.read) << each.protocol;
        EXPECT_TRUE(each.port != 0 || each.line == Probe::Line::Serial) << each.protocol;
    }
}

}  // namespace
}  // namespace insonify::device
