#include <gmock/gmock.h>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Node.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Messages.hpp"
#include "tests/dds/Loopback.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

using namespace insonify;
using namespace insonify::dds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

/** Leaves the environment as it was. */
struct DomainTest : Loopback {
    ~DomainTest() override {
        for (const char* name : {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "ROS_LOCALHOST_ONLY"})
            unsetenv(name);
    }
};

}  // namespace

TEST_F(DomainTest, UsesTheNamesOfRos) {
    EXPECT_EQ(ddsTopic("/auv/sonar"), "rt/auv/sonar");
    EXPECT_EQ(ddsTopic("clock"), "rt/clock");
    EXPECT_EQ(ddsType("sensor_msgs/msg/Image"), "sensor_msgs::msg::dds_::Image_");
}

TEST_F(DomainTest, RefusesNamesThatRosRefuses) {
    for (const char* good : {"/auv/sonar", "sonar", "/a_1/B2", "~/sonar"})
        EXPECT_EQ(diagnosticOfTopic(good), "") << good;
    for (const char* bad : {"", "/", "//a", "/a/", "/1a", "/a b", "/a-b", "/a//b", "~", "~a", "~/", "a/~/b"})
        EXPECT_THAT(diagnosticOfTopic(bad), HasSubstr("must be words of letters")) << bad;
    EXPECT_EQ(diagnosticOfTopic(std::string(252, 'a')), "");
    EXPECT_THAT(diagnosticOfTopic(std::string(253, 'a')), HasSubstr("has 253 characters; at most 252"));
    EXPECT_THAT(diagnosticOfTopic("/" + std::string(70'000, 'a')), HasSubstr("at most 252"));
    for (const char* good : {"sonar_1", "/sonar", "/auv/sonar", "auv/sonar"})
        EXPECT_EQ(diagnosticOfNode(good), "") << good;
    for (const char* bad : {"", "/", "//a", "a/", "1a", "a b"}) EXPECT_NE(diagnosticOfNode(bad), "") << bad;
}

TEST_F(DomainTest, TakesTheGivenDomainOrThatOfTheEnvironment) {
    setenv("ROS_DOMAIN_ID", "17", 1);
    EXPECT_EQ(domainId(3), 3u);
    EXPECT_EQ(domainId({}), 17u);
    unsetenv("ROS_DOMAIN_ID");
    EXPECT_EQ(domainId({}), 0u);
    for (const char* bad : {"x", "-1", "233", "1 ", "99999999999999"}) {
        setenv("ROS_DOMAIN_ID", bad, 1);
        EXPECT_THAT(test::computeError<types::ConfigError>([] { domainId({}); }),
                    HasSubstr("ROS_DOMAIN_ID is " + std::string(bad)))
            << bad;
    }
}

TEST_F(DomainTest, ReportsWhyADomainCannotBeJoined) {
    setenv("CYCLONEDDS_URI",
           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"nothere0\"/></Interfaces></General>"
           "</Domain></CycloneDDS>",
           1);
    const std::string text = test::computeError<types::ConfigError>([] { joinDomain(domainId({}), ""); });
    EXPECT_THAT(text, HasSubstr("DDS domain " + std::to_string(domainId({})) + " cannot be joined"));
    EXPECT_THAT(text, HasSubstr("nothere0"));
    setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><Nonsense/></Domain></CycloneDDS>", 1);
    EXPECT_THAT(test::computeError<types::ConfigError>([] { joinDomain(domainId({}), ""); }), HasSubstr("Nonsense"));
}

TEST_F(DomainTest, TheEnvironmentOfRosSetsTheDiscovery) {
    const auto settings = [](const char* range, const char* peers, const char* localhost_only) {
        setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", range, 1);
        setenv("ROS_STATIC_PEERS", peers, 1);
        setenv("ROS_LOCALHOST_ONLY", localhost_only, 1);
        return discoverySettings();
    };
    const std::string no_multicast = "<General><AllowMulticast>false</AllowMulticast></General>";
    for (const char* cyclones : {"", "SUBNET", "SYSTEM_DEFAULT"})
        for (const char* off : {"", "0"}) EXPECT_EQ(settings(cyclones, "", off), "");
    EXPECT_EQ(settings("SYSTEM_DEFAULT", "10.0.0.2", ""), "") << "as rmw_cyclonedds_cpp, which passes over them";
    const std::string peers = settings("", "10.0.0.2;;auv.local", "");
    EXPECT_THAT(peers, HasSubstr("<Peers><Peer address=\"10.0.0.2\"/><Peer address=\"auv.local\"/></Peers>"));
    EXPECT_THAT(peers, Not(HasSubstr("AllowMulticast")));
    EXPECT_THAT(settings("LOCALHOST", "10.0.0.2", ""),
                AllOf(HasSubstr(no_multicast), HasSubstr("<Peer address=\"localhost\"/><Peer address=\"10.0.0.2\"/>")));
    EXPECT_THAT(settings("SUBNET", "10.0.0.2", "1"),
                AllOf(HasSubstr(no_multicast), HasSubstr("<Peers><Peer address=\"localhost\"/></Peers>")));
    EXPECT_THAT(settings("OFF", "10.0.0.2", ""),
                AllOf(HasSubstr(no_multicast), HasSubstr("<Tag>ros_discovery_off_"), Not(HasSubstr("Peer address"))));
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { settings("LOCAL", "", ""); }),
                HasSubstr("ROS_AUTOMATIC_DISCOVERY_RANGE is LOCAL; must be SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT"));
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { settings("", "\"/><x", ""); }),
                HasSubstr("ROS_STATIC_PEERS is \"/><x"));
}

TEST_F(DomainTest, ANodeIsFoundOnItsMachineAndNowhereWithoutDiscovery) {
    if (!Peer::available())
        GTEST_SKIP() << "PyPI's cyclonedds is not in " << python() << ": scripts/setup puts it there";
    setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST", 1);
    const std::string of_peer = discoverySettings();
    const auto foundBy = [&](const std::string& peer_words, const char* range) {
        unsetenv("CYCLONEDDS_URI");
        setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", range, 1);
        Node node(domainId({}), "/auv/found", 16);
        const Writer writer(node, "rt/topic", ros::PoseStamped::type_name, "", Quality{});
        node.addWriter(writer.handle());
        node.announce();
        setenv("CYCLONEDDS_URI", of_peer.c_str(), 1);
        Peer peer(peer_words);
        return peer.result()["infos"].size();
    };
    EXPECT_EQ(foundBy("node 60 1", "LOCALHOST"), 1u);
    EXPECT_EQ(foundBy("node 3 1", "OFF"), 0u);
}

TEST_F(DomainTest, LeavesAndJoinsADomainAgain) {
    for (int i = 0; i < 3; ++i) EXPECT_GT(joinDomain(domainId({}), "").handle(), 0);
}

TEST_F(DomainTest, AnnouncesANodeWithIdentifiersOf16Or24Bytes) {
    using Info = ParticipantEntitiesInfo<24>;
    Node listener(domainId({}), "listener", 16), humble(domainId({}), "/auv/old/humble", 24);
    const Quality latched{.reliability = Reliability::Reliable, .depth = 1, .transient_local = true};
    Reader reader(listener, "ros_discovery_info", Info::type_name, "", latched, {});
    const Writer writer(humble, "rt/topic", ros::PoseStamped::type_name, "", Quality{});
    humble.addWriter(writer.handle());
    humble.announce();
    Bytes bytes;
    uint64_t sender = 0;
    ASSERT_TRUE(becomesTrue([&] { return reader.take(bytes, sender); }));
    Info info;
    ros::decode(std::span<const char>(bytes), info);
    ASSERT_EQ(info.node_entities_info_seq.size(), 1u);
    EXPECT_EQ(info.node_entities_info_seq[0].node_namespace, "/auv/old");
    EXPECT_EQ(info.node_entities_info_seq[0].node_name, "humble");
    ASSERT_EQ(info.node_entities_info_seq[0].writer_gid_seq.size(), 1u);
    const auto& gid = info.node_entities_info_seq[0].writer_gid_seq[0].data;
    EXPECT_TRUE(std::all_of(gid.begin() + 16, gid.end(), [](uint8_t byte) { return byte == 0; }));
    EXPECT_TRUE(std::any_of(gid.begin(), gid.begin() + 16, [](uint8_t byte) { return byte != 0; }));
}
