// A ROS 2 peer with another version of Cyclone: PyPI's.
#include <gmock/gmock.h>

#include "components/dds/Endpoints.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Schema.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/dds/Ends.hpp"

using namespace insonify;
using namespace insonify::dds;
using nlohmann::json;
using testing::HasSubstr;

namespace {

class PeerTest : public WithPeer {};

/** Returns a topic of images of 1 MB of float32, as in scripts/bench. */
TopicOut floats(const std::string& topic) {
    TopicOut made = topicOut("in", topic, message_type<ros::ProjectedSonarImage>);
    made.sonar.dtype = ros::ImageType::Float32;
    return made;
}

/** Sends pings at a rate. */
void sendAll(int count, double hertz, auto&& send) {
    auto due = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) {
        std::this_thread::sleep_until(due);
        due += std::chrono::microseconds(static_cast<int64_t>(1e6 / hertz));
        send();
    }
}

}  // namespace

TEST_F(PeerTest, ReceivesEveryPingOfAMegabyteAt40Hertz) {
    Publishing<types::SonarPtr> publishing({floats("/auv/sonar")},
                                           [](PublisherConfig& config) { config.depth = 200; });  // a busy machine
    Peer peer("listen ProjectedSonarImage /auv/sonar 240 200");
    ASSERT_TRUE(peer.meets([&] { publishing.send(greeting()); }));
    constexpr int count = 200;  // 5 s
    auto ping = std::make_shared<types::Sonar>(*makePing(256, 1000));
    sendAll(count, 40, [&] {
        ping->time = framework::wallClock();
        publishing.send(ping);
    });
    const json found = peer.result();
    EXPECT_EQ(found["count"], count);
    EXPECT_EQ(found["first"]["image"]["data"]["size"], 256 * 1000 * 4);
    EXPECT_EQ(found["first"]["image"]["beam_count"], 256);
    EXPECT_EQ(found["first"]["header"]["frame_id"], "sonar");
    EXPECT_GT(found["median_ms"], 0);  // the latency depends on the machine's other load
    std::cout << "1 MB at 40 Hz: median " << found["median_ms"] << " ms, p99 " << found["p99_ms"] << " ms\n";
    EXPECT_THAT(publishing.task.notices(), testing::IsEmpty());
}

TEST_F(PeerTest, SendsImagesOfAMegabyteAt40HertzWithoutLoss) {
    using Image = ros::ProjectedSonarImage;
    Node node(domainId({}), "listener", 16);
    Reader reader(node, ddsTopic("/peer/sonar"), Image::type_name, ros::typeHash<Image>(), Quality{.depth = 200}, {});
    Peer peer("image /peer/sonar 200 40 --greet");
    std::vector<double> latencies;  // [ms]
    Bytes bytes;
    uint64_t sender = 0;
    Image image;
    const auto receive = [&] {
        const bool came = becomesTrue([&] { return reader.take(bytes, sender); });
        if (came) ros::decode(std::span<const char>(bytes), image);
        return came;
    };
    ASSERT_TRUE(receive()) << "a greeting";
    peer.begin();
    while (image.header.stamp == ros::Time{}) ASSERT_TRUE(receive());
    for (int i = 0; i < 200; ++i) {
        ASSERT_TRUE(i == 0 || receive()) << i;
        latencies.push_back((framework::wallClock() - ros::fromRos(image.header.stamp)).seconds() * 1e3);
        ASSERT_EQ(image.image.data.size(), 1'024'000u);
        ASSERT_EQ(image.ranges.size(), 1000u);
    }
    std::ranges::sort(latencies);
    std::cout << "1 MB from the peer at 40 Hz: median " << latencies[100] << " ms, p99 " << latencies[198] << " ms\n";
    EXPECT_EQ(peer.result()["count"], 200);
}

TEST_F(PeerTest, SendsPosesWithoutLoss) {
    Subscribing subscribing("/auv/odometry", PoseType::Odometry, [](SubscriberConfig& config) {
        config.reliability = Reliability::Reliable;
        config.depth = 200;
    });
    Peer peer("odometry /auv/odometry 200 40 --greet");
    std::vector<double> latencies;  // [ms]
    for (int i = 0; i < 200; ++i) {
        const auto pose = i == 0 ? subscribing.findFirst(peer) : subscribing.next();
        ASSERT_TRUE(pose) << i;
        latencies.push_back((framework::wallClock() - pose->time).seconds() * 1e3);
        EXPECT_EQ(pose->position, glm::dvec3(2, -i, -3));  // from east, north, up
        EXPECT_NEAR(pose->velocity.y, -1.5, 1e-12);
        EXPECT_EQ(pose->target_frame, "map");
    }
    std::ranges::sort(latencies);
    std::cout << "Odometry at 40 Hz: median " << latencies[100] << " ms, p99 " << latencies[198] << " ms\n";
    EXPECT_GT(latencies[100], 0);
}

TEST_F(PeerTest, FindsTheNodeItsWritersTheirTypesAndHashes) {
    Publishing<types::SonarPtr> publishing({topicOut("in", "/auv/sonar", message_type<ros::ProjectedSonarImage>),
                                            topicOut("in", "/clock", message_type<ros::Clock>)},
                                           [](PublisherConfig& config) { config.node.node_name = "insonify"; });
    Peer peer("node 60 2");
    const json found = peer.result();
    ASSERT_EQ(found["infos"].size(), 1u) << found;
    ASSERT_EQ(found["writers"].count("rt/auv/sonar") + found["writers"].count("rt/clock"), 2u) << found;
    const json& node = found["infos"][0]["node_entities_info_seq"][0];
    EXPECT_EQ(node["node_name"], "insonify");
    EXPECT_EQ(node["node_namespace"], "/");
    EXPECT_EQ(node["writer_gid_seq"].size(), 2u);
    EXPECT_EQ(node["reader_gid_seq"].size(), 0u);
    const json& writer = found["writers"]["rt/auv/sonar"];
    EXPECT_EQ(writer["type"], "marine_acoustic_msgs::msg::dds_::ProjectedSonarImage_");
    EXPECT_EQ(writer["user_data"], "typehash=RIHS01_e9d0b934ee8332c9f79e04c361de0793c165b2dee14f2c0d25c3227cd50d46f1;");
    EXPECT_EQ(writer["key"], node["writer_gid_seq"][0]["data"]);
    EXPECT_EQ(found["writers"]["rt/clock"]["type"], "rosgraph_msgs::msg::dds_::Clock_");
}

TEST_F(PeerTest, ReadsEveryTypeThatIsSent) {
    const std::pair<const char*, MessageType> types[] = {{"RawSonarImage", message_type<ros::RawSonarImage>},
                                                         {"SonarRanges", message_type<ros::SonarRanges>},
                                                         {"SonarDetections", message_type<ros::SonarDetections>},
                                                         {"PointCloud2", message_type<ros::PointCloud2>},
                                                         {"LaserScan", message_type<ros::LaserScan>},
                                                         {"Clock", message_type<ros::Clock>}};
    std::vector<TopicOut> topics;
    std::vector<std::unique_ptr<Peer>> peers;
    for (const auto& [name, type] : types) topics.push_back(topicOut("in", std::string("/") + name, type));
    Publishing<types::SonarPtr> publishing(topics);
    for (const auto& [name, type] : types)
        peers.push_back(std::make_unique<Peer>(std::string("listen ") + name + " /" + name + " 240 1"));
    const types::SonarPtr ping = makePing(16, 50);
    ASSERT_TRUE(becomesTrue([&] {
        publishing.send(ping);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return std::ranges::all_of(peers, &Peer::hasEnded);
    }));
    const json raw = peers[0]->result(), ranges = peers[1]->result(), detections = peers[2]->result(),
               points = peers[3]->result(), scan = peers[4]->result(), clock = peers[5]->result();
    EXPECT_EQ(raw["first"]["samples_per_beam"], 50);
    EXPECT_EQ(ranges["first"]["ranges"].size(), 16u);
    EXPECT_EQ(detections["first"]["two_way_travel_times"].size(), 16u);
    EXPECT_NEAR(detections["first"]["rx_angles"][0], -ping->bearings[0].rad, 1e-6) << "to starboard";
    EXPECT_EQ(points["first"]["fields"].size(), 4u);
    EXPECT_EQ(scan["first"]["ranges"].size(), 16u);
    EXPECT_EQ(clock["first"]["clock"]["sec"], ping->time.microseconds / 1'000'000);
}

TEST_F(PeerTest, ReadsTheMeasurementsOfNavigationSensors) {
    types::Imu imu;
    imu.time = framework::wallClock();
    imu.orientation = {1, 0, 0, 0};
    imu.angular_velocity = {0.125, -0.25, 0.5};
    imu.linear_acceleration = {0.25, -0.5, 9.75};
    imu.cov_linear_acceleration = glm::dmat3(0.25);
    const types::Pressure pressure{201'325.5f, imu.time};
    auto dvl = std::make_shared<types::Dvl>();
    dvl->time = imu.time;
    dvl->velocity = {0.5, -0.25, 0.125};
    dvl->altitude = 12.5;
    dvl->beam_directions = {{0.5, 0, -1}, {0, 0.5, -1}, {-0.5, 0, -1}, {0, -0.5, -1}};
    dvl->beam_ranges = {14, 14.5, types::Pose::unknown, 13.5};
    dvl->beam_velocities = {0.125, -0.25, types::Pose::unknown, 0};
    dvl->beam_velocity_variances = {0.5, 0.5, types::Pose::unknown, 0.5};
    Publishing<types::Imu> imus({topicOut("in", "/imu", message_type<ros::Imu>)});
    Publishing<types::Pressure> pressures({topicOut("in", "/pressure", message_type<ros::FluidPressure>)});
    types::Fix fix;
    fix.time = imu.time;
    fix.kind = types::FixKind::Autonomous;
    fix.latitude = 54.5, fix.longitude = -10.25, fix.altitude = 41;
    fix.deviation_latitude = 2, fix.deviation_longitude = 3, fix.deviation_altitude = 5;
    Publishing<types::Fix> fixes({topicOut("in", "/fix", message_type<ros::NavSatFix>)});
    Publishing<types::DvlPtr> dvls({topicOut("in", "/dvl", message_type<ros::Dvl>)});
    Peer imu_peer("listen Imu /imu 240 1"), pressure_peer("listen FluidPressure /pressure 240 1"),
        dvl_peer("listen Dvl /dvl 240 1"), fix_peer("listen NavSatFix /fix 240 1");
    ASSERT_TRUE(becomesTrue([&] {
        imus.send(imu);
        pressures.send(pressure);
        dvls.send(dvl);
        fixes.send(fix);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return imu_peer.hasEnded() && pressure_peer.hasEnded() && dvl_peer.hasEnded() && fix_peer.hasEnded();
    }));
    const json felt = imu_peer.result()["first"], reported = dvl_peer.result()["first"];
    EXPECT_EQ(felt["linear_acceleration"]["z"], 9.75);
    EXPECT_EQ(felt["angular_velocity"]["y"], -0.25);
    EXPECT_EQ(felt["linear_acceleration_covariance"][4], 0.25);
    EXPECT_NEAR(felt["orientation"]["z"], std::sqrt(0.5), 1e-12) << "north, in a world of x east";
    EXPECT_EQ(pressure_peer.result()["first"]["fluid_pressure"], 201'325.5);
    const json place = fix_peer.result()["first"];
    EXPECT_EQ(place["longitude"], -10.25);
    EXPECT_EQ(place["status"]["status"], 0);
    EXPECT_EQ(place["position_covariance"], json({9, 0, 0, 0, 4, 0, 0, 0, 25}));
    EXPECT_EQ(reported["velocity"]["y"], 0.25) << "to starboard";
    EXPECT_EQ(reported["num_good_beams"], 3);
    EXPECT_EQ(reported["beam_velocities_valid"], true);
    EXPECT_EQ(reported["beam_unit_vec"][1]["y"], -0.5);
    EXPECT_EQ(reported["range"][3], 13.5);
    EXPECT_TRUE(reported["range"][2].is_null()) << "NaN";
    EXPECT_EQ(reported["beam_velocity_covar"][2], -1);
}

TEST_F(PeerTest, ReadsSoundingsAsPointsInTheWorldAndTheRangeOfAnAltimeter) {
    auto soundings = std::make_shared<types::PointCloud>();
    soundings->time = framework::wallClock();
    soundings->add({12.5, -3.25, -8}, 0.5);
    soundings->add({12.5, 4, -7.5}, 0.25);
    types::Range range;
    range.time = soundings->time;
    range.range = 6.5;
    range.range_max = 30;
    Publishing<types::PointCloudPtr> points({topicOut("in", "/soundings", message_type<ros::PointCloud2>)});
    Publishing<types::Range> ranges({topicOut("in", "/altitude", message_type<ros::Range>)});
    Peer point_peer("listen PointCloud2 /soundings 240 1"), range_peer("listen Range /altitude 240 1");
    ASSERT_TRUE(becomesTrue([&] {
        points.send(soundings);
        ranges.send(range);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return point_peer.hasEnded() && range_peer.hasEnded();
    }));
    const json cloud = point_peer.result()["first"], altitude = range_peer.result()["first"];
    EXPECT_EQ(cloud["width"], 2);
    EXPECT_EQ(cloud["header"]["frame_id"], "map");
    EXPECT_EQ(cloud["fields"].size(), 4u);
    EXPECT_EQ(cloud["data"].size(), 32u);
    EXPECT_EQ(altitude["range"], 6.5);
    EXPECT_EQ(altitude["max_range"], 30);
    EXPECT_EQ(altitude["header"]["frame_id"], "sonar");
}

TEST_F(PeerTest, SendsFixesAndOrientationsThatBecomePoses) {
    const types::Datum kiel{54.5, 10.25, 40};
    if (types::Diagnostics missing; checkDatum(kiel, missing), !missing.empty())
        GTEST_SKIP() << "this build has no GeographicLib";
    Subscribing subscribing("/fix", PoseType::NavSatFix, [&](SubscriberConfig& config) {
        config.topics[0].orientation = OrientationIn{.topic = "/imu", .type = OrientationType::Imu};
        config.datum = kiel;
        config.reliability = Reliability::Reliable;
        config.depth = 200;
    });
    Peer peer("fixes 60 100 --greet");
    auto pose = subscribing.next();
    peer.begin();
    while (pose && pose->position.x < -1e5) pose = subscribing.next();
    for (int i = 0; i < 60; i += 3) {
        if (i > 0) pose = subscribing.next();
        ASSERT_TRUE(pose) << i;
        EXPECT_NEAR(pose->position.x, i * 1.113, 0.01);
        EXPECT_LT(glm::length(glm::dvec2(pose->position.y, pose->position.z)), 1e-3);
        EXPECT_GT(glm::dot(pose->orientation * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)), 1 - 1e-12) << "to the west";
        EXPECT_EQ(pose->cov_position, glm::dmat3(1, 0, 0, 0, 4, 0, 0, 0, 9));
        EXPECT_EQ(pose->source_frame, "gps");
    }
    EXPECT_EQ(peer.result()["count"], 60);
    EXPECT_TRUE(subscribing.task.isRunning()) << subscribing.task.lastError();
    EXPECT_THAT(types::lines(subscribing.task.notices()),
                testing::IsSupersetOf({HasSubstr("20 messages dropped: /fix: the receiver has no fix"),
                                       HasSubstr("20 messages dropped: /fix: latitude or longitude")}));
}

class SpoiltPoses : public PeerTest, public testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(SpoiltPoses, AreDroppedAndTheRunContinues) {
    Subscribing subscribing("/auv/odometry", PoseType::Odometry, [](SubscriberConfig& config) {
        config.reliability = Reliability::Reliable;
        config.depth = 1000;
    });
    Peer peer("odometry /auv/odometry 40 100 " + std::string(GetParam().first) + " --greet");
    ASSERT_TRUE(subscribing.next());
    subscribing.task.activity().hold();  // takes all at the same time: a stall would otherwise count as a silence
    peer.begin();
    peer.result();
    subscribing.task.environment().now = [now = framework::wallClock()] { return now; };
    subscribing.task.update();
    int good = 0;
    for (types::Pose pose; subscribing.reader.port.readNew(pose);) {
        if (pose.position == glm::dvec3(0)) continue;
        ++good;
        EXPECT_EQ(std::abs(int(pose.position.y)) % 2, 0);
    }
    EXPECT_EQ(good, 20);
    EXPECT_TRUE(subscribing.task.isRunning()) << subscribing.task.lastError();
    const auto notices = subscribing.task.notices();
    ASSERT_EQ(notices.size(), 1u) << testing::PrintToString(notices);
    EXPECT_THAT(notices[0],
                testing::AllOf(HasSubstr("20 messages dropped: /auv/odometry: "), HasSubstr(GetParam().second)));
}

INSTANTIATE_TEST_SUITE_P(PeerTest, SpoiltPoses,
                         testing::Values(std::pair("nan", "not finite"), std::pair("zero", "no length"),
                                         std::pair("back", "the stamp is before"),
                                         std::pair("bytes", "not a message of its type")),
                         [](const auto& tested) { return std::string(tested.param.first); });
