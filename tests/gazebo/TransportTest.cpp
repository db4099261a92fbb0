// Names, variables and datagrams of Gazebo's transport.
#include <gmock/gmock.h>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/TransportOptions.hpp"
#include "tests/gazebo/Recordings.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/** Removes the machine's variables of the transport, and restores them. */
struct TransportTest : testing::Test {
    TransportTest() {
        for (const char* name : names_) unsetenv(name);
    }
    ~TransportTest() override {
        for (const char* name : names_) unsetenv(name);
    }
    const char* names_[8] = {"GZ_PARTITION",
                             "IGN_PARTITION",
                             "GZ_IP",
                             "IGN_IP",
                             "GZ_DISCOVERY_MSG_PORT",
                             "IGN_DISCOVERY_MSG_PORT",
                             "GZ_DISCOVERY_SRV_PORT",
                             "GZ_DISCOVERY_MULTICAST_IP"};
};

TEST_F(TransportTest, ThePropertyHasPrecedenceOverHarmonicsVariablesAndTheseOverFortresss) {
    EXPECT_THAT(TransportOptions::fromEnvironment("").partition, testing::ContainsRegex("^.+:.+$")) << "host:user";
    setenv("IGN_PARTITION", "fortress", 1);
    EXPECT_EQ(TransportOptions::fromEnvironment("").partition, "fortress");
    setenv("GZ_PARTITION", "harmonic", 1);
    EXPECT_EQ(TransportOptions::fromEnvironment("").partition, "harmonic");
    EXPECT_EQ(TransportOptions::fromEnvironment("ours").partition, "ours");
    setenv("IGN_IP", "127.0.0.1", 1);
    setenv("GZ_DISCOVERY_MSG_PORT", "11000", 1);
    setenv("GZ_DISCOVERY_SRV_PORT", "11001", 1);
    setenv("GZ_DISCOVERY_MULTICAST_IP", "239.255.0.8", 1);
    const TransportOptions options = TransportOptions::fromEnvironment("");
    EXPECT_EQ(options.ip, "127.0.0.1");
    EXPECT_EQ(options.topic_port, 11000);
    EXPECT_EQ(options.service_port, 11001);
    EXPECT_EQ(options.group, "239.255.0.8");
}

TEST_F(TransportTest, InvalidVariablesAreAnError) {
    const auto findDiagnostic = [](const std::string& partition) -> std::string {
        return test::computeError<types::ConfigError>([&] { TransportOptions::fromEnvironment(partition); });
    };
    EXPECT_THAT(findDiagnostic("a@b"), HasSubstr("partition: is a@b, which Gazebo's transport does not take"));
    for (const char* port : {"0", "65536", "x", "80x"}) {
        setenv("GZ_DISCOVERY_MSG_PORT", port, 1);
        EXPECT_THAT(findDiagnostic(""),
                    HasSubstr("DISCOVERY_MSG_PORT is \"" + std::string(port) + "\"; must be a port"));
    }
}

TEST_F(TransportTest, ATopicIsNamedWithItsPartition) {
    EXPECT_EQ(qualifiedName("auv", "/world/sea/pose/info"), "@/auv@/world/sea/pose/info");
    EXPECT_EQ(qualifiedName("/auv/", "pose/"), "@/auv@/pose");
    EXPECT_EQ(qualifiedName("", "/pose"), "@@/pose");
    for (const char* name : {"", "/", "/with a space", "/a//b", "/a@b", "~/a"})
        EXPECT_EQ(qualifiedName("auv", name), std::nullopt) << name;
    EXPECT_EQ(TopicName::of("@/auv@/pose")->partition, "auv");
    EXPECT_EQ(TopicName::of("@/auv@/pose")->topic, "/pose");
    EXPECT_EQ(TopicName::of("@@/pose")->partition, "");
    for (const char* name : {"", "@", "@@", "pose", "@/auv", "@/auv@"})
        EXPECT_FALSE(TopicName::of(name).has_value()) << name;
}

TEST_F(TransportTest, TypesAreTheSameByBothNames) {
    EXPECT_EQ(messageName("ignition.msgs.Pose_V"), "Pose_V");
    EXPECT_EQ(messageName("gz.msgs.Pose_V"), "Pose_V");
    EXPECT_EQ(messageName("acme.Pose_V"), "acme.Pose_V");
}

TEST_F(TransportTest, DatagramsOfHarmonicAreRead) {
    Received received("/pose/info");
    const auto topic = readDatagram(recording("offer_topic"), "ours", received);
    ASSERT_TRUE(topic);
    EXPECT_EQ(topic->kind, Announcement::Kind::Offer);
    EXPECT_EQ(topic->process, "11111111-2222-3333-4444-555555555555");
    EXPECT_EQ(topic->publication.process, topic->process);
    EXPECT_EQ(topic->publication.topic, "@/auv@/world/sea/pose/info");
    EXPECT_EQ(topic->publication.address, "tcp://127.0.0.1:40123");
    EXPECT_EQ(topic->publication.type, "gz.msgs.Pose_V");
    EXPECT_FALSE(topic->publication.is_service);
    const auto service = readDatagram(recording("offer_service"), "ours", received);
    ASSERT_TRUE(service);
    EXPECT_TRUE(service->publication.is_service);
    EXPECT_EQ(service->publication.type, "gz.msgs.Empty");
    EXPECT_EQ(service->publication.reply_type, "gz.msgs.Scene");
    EXPECT_EQ(service->publication.socket, "99999999-8888-7777-6666-555555555555");
    EXPECT_EQ(readDatagram(recording("alive"), "ours", received)->kind, Announcement::Kind::Alive);
    EXPECT_EQ(readDatagram(recording("goodbye"), "ours", received)->kind, Announcement::Kind::Goodbye);
    EXPECT_EQ(received.text(), "available are /world/sea/pose/info in partition auv");
}

TEST_F(TransportTest, DatagramsOfOtherVersionsAreNotReadAndAreReported) {
    Received received("/pose/info");
    EXPECT_THAT(received.text(), StartsWith("no program of Gazebo is found"));
    EXPECT_FALSE(readDatagram(recording("alive_with_statistics"), "ours", received).has_value());
    EXPECT_THAT(received.text(), StartsWith("programs with GZ_TRANSPORT_TOPIC_STATISTICS are running"));
    EXPECT_TRUE(readDatagram(recording("offer_topic"), "ours", received).has_value());
    EXPECT_THAT(received.text(),
                StartsWith("available are /world/sea/pose/info in partition auv; programs with GZ_TRANSPORT"));
    Received other("/pose/info");
    std::string datagram = recording("alive");
    datagram[3] = 77;  // after the key of the field
    EXPECT_FALSE(readDatagram(datagram, "ours", other).has_value());
    EXPECT_EQ(other.text(), "programs with version 77 of Gazebo's discovery are running; version 10 is supported");
    Received nothing("/pose/info");
    EXPECT_TRUE(readDatagram(recording("alive"), "ours", nothing).has_value());
    EXPECT_EQ(nothing.text(), "no name that ends in /pose/info is offered");
    Received own("/pose/info");
    EXPECT_FALSE(readDatagram(aliveDatagram("ours"), "ours", own).has_value());
    EXPECT_THAT(own.text(), StartsWith("no program of Gazebo is found")) << "except this program";
}

TEST_F(TransportTest, DamagedDatagramsAreDropped) {
    Received received("/pose/info");
    const std::string whole = recording("offer_topic");
    for (size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(readDatagram(whole.substr(0, size), "ours", received).has_value()) << size;
    EXPECT_FALSE(readDatagram(whole + "x", "ours", received).has_value());
    std::string other = whole;
    other.replace(other.find("tcp://"), 6, "ipc://");
    EXPECT_FALSE(readDatagram(other, "ours", received).has_value()) << "an address of another kind";
    EXPECT_FALSE(readDatagram(std::string(2, '\0'), "ours", received).has_value()) << "nobody's";
}

}  // namespace
}  // namespace insonify::gazebo
