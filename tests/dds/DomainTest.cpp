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
using testing::HasSubstr;

namespace {

class DomainTest : public Loopback {};

}  // namespace

TEST_F(DomainTest, UsesTheNamesOfRos) {
    EXPECT_EQ(ddsTopic("/auv/sonar"), "rt/auv/sonar");
    EXPECT_EQ(ddsTopic("clock"), "rt/clock");
    EXPECT_EQ(ddsType("sensor_msgs/msg/Image"), "sensor_msgs::msg::dds_::Image_");
}

TEST_F(DomainTest, RefusesNamesThatRosRefuses) {
    for (const char* good : {"/auv/sonar", "sonar", "/a_1/B2"}) EXPECT_EQ(diagnosticOfTopic(good), "") << good;
    for (const char* bad : {"", "/", "//a", "/a/", "/1a", "/a b", "/a-b", "/a//b", "~/a"})
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
        EXPECT_THAT(test::errorOf<types::ConfigError>([] { domainId({}); }),
                    HasSubstr("ROS_DOMAIN_ID is " + std::string(bad)))
            << bad;
    }
}

TEST_F(DomainTest, ReportsWhyADomainCannotBeJoined) {
    setenv("CYCLONEDDS_URI",
           "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"nothere0\"/></Interfaces></General>"
           "</Domain></CycloneDDS>",
           1);
    const std::string text = test::errorOf<types::ConfigError>([] { joinDomain(domainId({}), ""); });
    EXPECT_THAT(text, HasSubstr("DDS domain " + std::to_string(domainId({})) + " cannot be joined"));
    EXPECT_THAT(text, HasSubstr("nothere0"));
    setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><Nonsense/></Domain></CycloneDDS>", 1);
    EXPECT_THAT(test::errorOf<types::ConfigError>([] { joinDomain(domainId({}), ""); }), HasSubstr("Nonsense"));
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
