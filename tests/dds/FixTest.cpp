// Fixes of satellites that become poses of the world, with the orientations of another topic.
#include <gmock/gmock.h>

#include <random>

#include "components/dds/Endpoints.hpp"
#include "components/log/Files.hpp"
#include "components/log/PoseSources.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/dds/Ends.hpp"
#include "tests/support/Bag.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Refused.hpp"

using namespace insonify;
using namespace insonify::dds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
const types::Datum kiel{54.5, 10.25, 40};

types::Time at(double seconds) { return types::Time::fromSeconds(1000 + seconds); }

ros::NavSatFix makeFix(double seconds, const types::Datum& place) {
    ros::NavSatFix fix;
    fix.header = {ros::toRos(at(seconds)), "gps"};
    fix.latitude = place.latitude_deg;
    fix.longitude = place.longitude_deg;
    fix.altitude = place.height_m;
    fix.position_covariance = {9, 1, 0, 1, 4, 0, 0, 0, 16};  // to the east, north and up
    fix.position_covariance_type = 3;
    return fix;
}

ros::Imu makeImu(double seconds, const glm::dquat& orientation) {
    types::Imu imu;
    imu.time = at(seconds);
    imu.orientation = orientation;
    imu.angular_velocity = {0, 0, 0};
    ros::Imu message;
    ros::convert(imu, types::WorldFrame::Enu, "imu", message);
    return message;
}

/** Returns a place in the earth's axes [m]; WGS 84's definition. */
glm::dvec3 earthCentred(const types::Datum& place) {
    constexpr double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f);
    const double phi = place.latitude_deg * M_PI / 180, lambda = place.longitude_deg * M_PI / 180;
    const double n = a / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
    return {(n + place.height_m) * std::cos(phi) * std::cos(lambda),
            (n + place.height_m) * std::cos(phi) * std::sin(lambda), (n * (1 - e2) + place.height_m) * std::sin(phi)};
}

/** Returns where a place is in Rock's axes about a datum, by the definition of the ellipsoid. */
glm::dvec3 aboutDatum(const types::Datum& datum, const types::Datum& place) {
    const double phi = datum.latitude_deg * M_PI / 180, lambda = datum.longitude_deg * M_PI / 180;
    const glm::dvec3 east(-std::sin(lambda), std::cos(lambda), 0),
        up(std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi)),
        away = earthCentred(place) - earthCentred(datum);
    return {glm::dot(away, glm::cross(up, east)), -glm::dot(away, east), glm::dot(away, up)};
}

struct FixTest : Loopback {
    void SetUp() override {
        types::Diagnostics diagnostics;
        checkDatum(kiel, diagnostics);
        if (!diagnostics.empty()) GTEST_SKIP() << "this build has no GeographicLib";
    }

    /** Subscribes to /fix, and for orientations to /imu. */
    void subscribe(const types::Datum& datum, bool turns = true, StampFrom stamp = StampFrom::Message) {
        SubscriberConfig config;
        config.depth = 1000;
        config.reliability = Reliability::Reliable;
        config.datum = datum;
        TopicIn topic;
        topic.topic = "/fix";
        topic.type = PoseType::NavSatFix;
        topic.stamp = stamp;
        if (turns) topic.orientation = OrientationIn{.topic = "/imu", .type = OrientationType::Imu};
        subscription_.emplace(node_, config, topic, counts_, [] {});
        fixes_.emplace(node_, "rt/fix", ros::NavSatFix::type_name, "", Quality{.depth = 1000});
        imus_.emplace(node_, "rt/imu", ros::Imu::type_name, "", Quality{.depth = 1000});
        EXPECT_TRUE(becomesTrue([&] { return fixes_->hasReaders() && imus_->hasReaders() == turns; }));
    }
    void send(Writer& writer, const auto& message) {
        Bytes bytes;
        ros::encode(message, bytes);
        ASSERT_TRUE(writer.write(bytes));
    }
    void send(const ros::NavSatFix& fix) { send(*fixes_, fix); }
    void send(const ros::Imu& imu) { send(*imus_, imu); }
    std::optional<types::Pose> take(double now = 1000) {
        types::Pose pose;
        return subscription_->take(at(now), pose) ? std::optional(pose) : std::nullopt;
    }
    double draw(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    glm::dquat drawTurn() {
        return glm::normalize(glm::dquat(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1) + 1e-3));
    }
    /** A place on all of the earth; half of them at a pole, at the date line or on the equator. */
    types::Datum drawPlace() {
        types::Datum place{draw(-90, 90), draw(-180, 180), draw(-500, 5000)};
        const int kind = static_cast<int>(draw(0, 6));
        if (kind == 0) place.latitude_deg = draw(0, 1) < 0.5 ? 90 : -90;
        if (kind == 1) place.longitude_deg = draw(0, 1) < 0.5 ? 180 : -180;
        if (kind == 2) place.latitude_deg = 0;
        return place;
    }

    std::mt19937_64 random_{7};
    Node node_{domainId({}), "judge", 16};
    Counts counts_;
    std::optional<Subscription> subscription_;
    std::optional<Writer> fixes_, imus_;
};

}  // namespace

TEST_F(FixTest, BecomesTheSamePoseAsInAReplayAndByTheDefinitionOfTheEllipsoid) {
    constexpr double step = 0.2;  // [s]
    for (int round = 0; round < 12; ++round) {
        const types::Datum datum = drawPlace();
        subscribe(datum);
        test::Bag bag;
        std::vector<types::Datum> places;
        const double reach = std::pow(10, draw(0, 5));  // up to 100 km
        for (int i = 0; i <= 20; ++i) {
            const double time = i * step;
            const ros::Imu imu = makeImu(time, drawTurn());
            bag.add("/imu", at(time), imu);
            send(imu);
            if (i == 0) continue;
            places.push_back(geodetic(datum, {draw(-reach, reach), draw(-reach, reach), draw(-500, 500)}));
            if (i % 5 == 0) places.back().longitude_deg += places.back().longitude_deg > 0 ? -360 : 360;
            const ros::NavSatFix fix = makeFix(draw(time - step, time), places.back());
            bag.add("/fix", at(time), fix);
            send(fix);
        }
        const Folder folder;
        bag.writeMcap(folder / "bag.mcap");
        const auto log = log::openLog(folder / "bag.mcap", log::AtDamage::Stop, types::WorldFrame::Enu);
        log::addPoses(*log, {"/fix", "pose", datum, "/imu"}, types::WorldFrame::Enu);
        size_t i = 0;
        log->forEach<types::Pose>("pose", [&](const types::Pose& replayed, const log::SampleRef&) {
            const auto live = take(5);
            ASSERT_TRUE(live) << i << counts_.drops.last();
            EXPECT_EQ(live->time, replayed.time);
            EXPECT_EQ(live->position, replayed.position);
            EXPECT_LT(glm::length(live->orientation - replayed.orientation), 1e-15);
            EXPECT_EQ(live->cov_position, replayed.cov_position);
            EXPECT_EQ(live->cov_position, glm::dmat3(4, 0, 0, 0, 9, 0, 0, 0, 16)) << "to the north, west and up";
            EXPECT_EQ(live->source_frame, "gps");
            EXPECT_EQ(live->source_frame, replayed.source_frame);
            EXPECT_LT(glm::distance(live->position, aboutDatum(datum, places[i++])), 1e-7) << text(datum);
        });
        EXPECT_EQ(i, 20u);
    }
    EXPECT_EQ(counts_.drops.count(), 0u) << counts_.drops.last();
}

TEST_F(FixTest, WithoutATopicOfOrientationsTheBodyIsLevelAndLooksToTheNorth) {
    subscribe(kiel, false);
    send(makeFix(0, {54.501, 10.25, unknown}));
    const auto pose = take();
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->orientation, glm::dquat(1, 0, 0, 0));
    EXPECT_NEAR(pose->position.x, 111.3, 0.1) << "to the north";
    EXPECT_NEAR(pose->position.z, -111.3 * 111.3 / 2 / 6.38e6, 1e-4) << "an unknown height is the datum's";
    ros::NavSatFix alone = makeFix(1, kiel);
    alone.position_covariance_type = ros::NavSatFix::unknown;
    send(alone);
    const auto next = take();
    ASSERT_TRUE(next);
    EXPECT_LT(glm::length(next->position), 1e-8);
    EXPECT_TRUE(ros::isUnknown(next->cov_position));
    EXPECT_TRUE(ros::isUnknown(next->velocity));
}

TEST_F(FixTest, AMessageWithoutAPlaceOnTheEarthIsDroppedAndCounted) {
    subscribe(kiel, false);
    ros::NavSatFix lost = makeFix(0, kiel);
    for (const int8_t status : {-1, -2}) {
        lost.status.status = status;
        send(lost);
    }
    const types::Datum nowhere[] = {{unknown, 10, 0},   {54, unknown, 0}, {90.001, 10, 0},
                                    {-1e300, 10, 0},    {54, 361, 0},     {54, infinite, 0},
                                    {54, 10, infinite}, {54, 10, -2e7},   {infinite, 0, 0}};
    for (const types::Datum& place : nowhere) send(makeFix(0, place));
    send(makeFix(1, {54.5, -349.75, 9.9e6}));
    const auto pose = take();
    ASSERT_TRUE(pose) << counts_.drops.last();
    EXPECT_NEAR(pose->position.z, 9.9e6 - 40, 1e-6);
    EXPECT_FALSE(take());
    EXPECT_THAT(
        counts_.drops.byReason(),
        ElementsAre(Pair("/fix: latitude or longitude is not on the earth, or the altitude is beyond 10,000 km", 9),
                    Pair("/fix: the receiver has no fix (status below 0)", 2)));
}

TEST_F(FixTest, IsDroppedWithoutAnOrientationWithinASecond) {
    subscribe(kiel);
    const std::string none = "/fix: no orientation of /imu is within a second of the fix";
    send(makeFix(0, kiel));
    EXPECT_FALSE(take());
    EXPECT_EQ(counts_.drops.last(), none);
    ros::Imu blind = makeImu(0.5, {1, 0, 0, 0});
    blind.orientation_covariance[0] = -1;  // as a driver without a magnetometer sends it
    send(blind);
    blind.orientation_covariance[0] = 0;
    blind.orientation = {0, 0, 0, 0};
    send(blind);
    send(makeFix(0.6, kiel));
    EXPECT_FALSE(take());
    EXPECT_THAT(counts_.drops.byReason(),
                ElementsAre(Pair(none, 2), Pair("/imu: the orientation is unknown (covariance -1), not finite or "
                                                "without a length",
                                                2)));
    const glm::dquat turned = glm::angleAxis(0.5, glm::dvec3(0, 0, 1));
    send(makeImu(2, turned));
    send(makeFix(3, kiel));  // held for a second
    const auto held = take();
    ASSERT_TRUE(held) << counts_.drops.last();
    EXPECT_GT(std::abs(glm::dot(held->orientation, turned)), 1 - 1e-12);
    send(makeFix(3.1, kiel));
    EXPECT_FALSE(take());
    EXPECT_EQ(counts_.drops.last(), none);
    EXPECT_EQ(counts_.drops.count(), 5u);
}

TEST_F(FixTest, OrientationsOfAClockThatWasSetBackReplaceTheOthers) {
    subscribe(kiel);
    const glm::dquat before = glm::angleAxis(1.0, glm::dvec3(0, 0, 1)),
                     after = glm::angleAxis(2.0, glm::dvec3(0, 0, 1));
    send(makeImu(100, before));
    send(makeFix(100, kiel));
    ASSERT_TRUE(take(100));
    send(makeImu(50, after));
    send(makeFix(50.5, kiel));
    const auto pose = take(102);
    ASSERT_TRUE(pose) << counts_.drops.last();
    EXPECT_GT(std::abs(glm::dot(pose->orientation, after)), 1 - 1e-12);
}

TEST_F(FixTest, WithStampsOfArrivalBothTopicsHaveThatOfTheClock) {
    subscribe(kiel, true, StampFrom::Arrival);
    send(makeImu(0, {1, 0, 0, 0}));
    send(makeFix(500, kiel));
    const auto pose = take(200);
    ASSERT_TRUE(pose) << counts_.drops.last();
    EXPECT_EQ(pose->time, at(200));
}

TEST_F(FixTest, ReportsOnceThatTheFixesBeginFarFromTheDatum) {
    subscribe(kiel, false);
    for (int i = 0; i < 3; ++i) send(makeFix(i, {0, 0, 0}));  // as receivers send it before they know
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(take());
    EXPECT_EQ(counts_.far.count(), 1u);
    EXPECT_THAT(counts_.far.last(),
                AllOf(HasSubstr("/fix begins more than 100 km from the datum"), HasSubstr("it is 5")));
}

TEST_F(FixTest, TheTaskNeedsADatum) {
    SubscriberTask task("gps");
    SubscriberConfig config;
    config.topics.resize(1);
    config.topics[0].topic = "/fix";
    config.topics[0].type = PoseType::NavSatFix;
    task.config.set(config);
    EXPECT_THAT(test::countRefusals(task), testing::Contains(HasSubstr("datum: is missing; give the deployment")));
    EXPECT_THAT(task.configure().reason, HasSubstr("gps.datum: is missing"));
    EXPECT_TRUE(task.recover());
    config.datum = kiel;
    task.config.set(config);
    EXPECT_THAT(test::countRefusals(task), testing::Not(testing::Contains(HasSubstr("datum"))));
    const framework::Outcome configured = task.configure();
    EXPECT_TRUE(configured) << configured.reason;
    ASSERT_EQ(task.notices().size(), 1u);
    EXPECT_EQ(task.notices()[0].text, "/fix has only positions: the body is level and looks to the north");
}

TEST_F(FixTest, ReportsTheAbsenceOfOrientations) {
    subscribe(kiel);
    imus_.reset();
    Node other(domainId({}), "asking", 16);
    EXPECT_TRUE(becomesTrue([&] {
        return subscription_->absence(other).starts_with("no orientation: nobody publishes /imu (");
    })) << subscription_->absence(other);
}

namespace {

const std::string fix_vehicle = R"(schedule: realtime
datum: {latitude_deg: 54.5, longitude_deg: 10.25, height_m: 40}
tasks:
  boat: {type: pose::TrajectoryTask, activity: {period: 0.05}, properties: {waypoints: [{time: 0, position: [100, -50, 0.5], yaw_deg: 40}]}}
  fix: {type: nav::FixTask}
  imu: {type: nav::ImuTask}
  ros:
    type: dds::PublisherTask
    properties:
      topics: [{port: imu, topic: /auv/imu/data, type: sensor_msgs/Imu}, {port: fix, topic: /auv/gps/fix, type: sensor_msgs/NavSatFix}]
connections:
  - {from: boat.pose, to: imu.pose, policy: {type: buffer, size: 16}}
  - {from: boat.pose, to: fix.pose, policy: {type: buffer, size: 16}}
  - {from: imu.imu, to: ros.imu, policy: {type: buffer, size: 16}}
  - {from: fix.fix, to: ros.fix, policy: {type: buffer, size: 16}}
)";

/** The example of components/dds/README.md, with a log. */
const std::string sonar = R"(schedule: realtime
namespace: auv
datum: {latitude_deg: 54.5, longitude_deg: 10.25, height_m: 40}
tasks:
  gps:
    type: dds::SubscriberTask
    properties:
      topics: [{topic: gps/fix, type: sensor_msgs/NavSatFix, port: pose, orientation: {topic: imu/data, type: sensor_msgs/Imu}}]
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
connections:
  - {from: gps.pose, to: log.pose, policy: {type: buffer, size: 256}}
)";

struct FixRunTest : FixTest {
    const deployer::TestFolder folder_;

    deployer::Outcome call(std::vector<std::string> words) const {
        return deployer::callInsonify(folder_, std::move(words));
    }
    /** Returns the outcome of a check of the deployment with a part replaced. */
    deployer::Outcome checkWith(const std::string& from, const std::string& to) const {
        std::string text = sonar;
        deployer::writeFile(folder_ / "x.yml", text.replace(text.find(from), from.size(), to));
        return call({"check", "x.yml"});
    }
};

}  // namespace

TEST_F(FixRunTest, AVehicleThatSendsItsFixesIsWhereItIs) {
    using namespace deployer;
    const TestFolder elsewhere;
    writeFile(elsewhere / "vehicle.yml", fix_vehicle);
    writeFile(folder_ / "sonar.yml", sonar);
    const Process boat(insonifyWords({"run", "vehicle.yml", "--out", "out"}), elsewhere.path());
    const Outcome outcome = call({"run", "sonar.yml", "--out", "out", "--duration", "6"});
    boat.signal(SIGINT);
    EXPECT_EQ(boat.wait().code, 0);
    ASSERT_THAT(outcome, succeeds());
    ASSERT_THAT(call({"log", "export", "out/x.0.log", "--stream", "gps.pose", "--to", "pose.csv"}), succeeds());
    std::istringstream lines(readFile(folder_ / "pose.csv"));
    std::string line;
    std::getline(lines, line);
    ASSERT_THAT(line, testing::StartsWith("time,x,y,z,")) << line;
    int count = 0;
    for (; std::getline(lines, line); ++count) {
        double time = 0, x = 0, y = 0, z = 0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &time, &x, &y, &z), 4) << line;
        EXPECT_LT(glm::distance(glm::dvec3(x, y, z), {100, -50, 0.5}), 1e-6) << line;
    }
    EXPECT_GT(count, 10);
}

TEST_F(FixRunTest, FaultyDeploymentsAreRefusedWithTheirPlace) {
    using deployer::isRefused, deployer::succeeds;
    const std::string datum = "datum: {latitude_deg: 54.5, longitude_deg: 10.25, height_m: 40}\n";
    EXPECT_THAT(checkWith("x.0.log", "x.1.log"), succeeds());
    EXPECT_THAT(checkWith(datum, ""),
                isRefused(AllOf(HasSubstr("x.yml:7:"), HasSubstr("tasks.gps.properties.datum: is missing"))));
    EXPECT_THAT(
        checkWith("    properties:\n", "    properties:\n      datum: {latitude_deg: 54.6, longitude_deg: 10.25}\n"),
        isRefused(HasSubstr("tasks.gps.properties.datum: is {latitude_deg: 54.6, longitude_deg: 10.25, "
                            "height_m: 0}, and datum is {latitude_deg: 54.5")));
    EXPECT_THAT(checkWith("sensor_msgs/NavSatFix", "sensor_msgs/Imu"),
                isRefused(AllOf(HasSubstr("topics[0].type: is sensor_msgs/Imu"), HasSubstr("sensor_msgs/NavSatFix"))));
    EXPECT_THAT(checkWith("type: sensor_msgs/Imu", "type: sensor_msgs/NavSatFix"),
                isRefused(AllOf(HasSubstr("topics[0].orientation.type: is sensor_msgs/NavSatFix"),
                                HasSubstr("nav_msgs/Odometry"))));
    EXPECT_THAT(checkWith("sensor_msgs/NavSatFix", "nav_msgs/Odometry"),
                isRefused(HasSubstr("topics[0].orientation: is given for nav_msgs/Odometry, which has its own")));
    EXPECT_THAT(checkWith("topic: imu/data", "topic: imu data"),
                isRefused(HasSubstr("topics[0].orientation.topic: is \"imu data\"")));
}
