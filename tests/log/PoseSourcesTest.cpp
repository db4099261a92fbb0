// Poses from bags of other programs, against the poses that were written.
#include <gmock/gmock.h>

#include <glm/gtc/quaternion.hpp>
#include <random>

#include "components/log/Files.hpp"
#include "components/log/PoseSources.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/support/Bag.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::log {
namespace {

using testing::HasSubstr;

constexpr double exact = 1e-9;
constexpr int64_t epoch = 1'700'000'000'000'000;  // [us]

types::Time seconds(double time) { return types::Time{epoch} + types::Time::fromSeconds(time); }

/** Draws poses, frames and times. */
class Draws {
public:
    explicit Draws(unsigned seed) : random_(seed) {}
    double from(double min, double max) { return std::uniform_real_distribution<double>(min, max)(random_); }
    int whole(int min, int max) { return std::uniform_int_distribution<int>(min, max)(random_); }
    glm::dquat turn() { return glm::normalize(glm::dquat(from(-1, 1), from(-1, 1), from(-1, 1), from(-1, 1) + 1e-3)); }
    glm::dvec3 place() { return {from(-100, 100), from(-100, 100), from(-100, 100)}; }
    types::Pose pose(double time) {
        types::Pose pose;
        pose.time = seconds(time);
        pose.target_frame = "map";
        pose.source_frame = "base_link";
        pose.position = place();
        pose.orientation = turn();
        return pose;
    }

private:
    std::mt19937 random_;
};

/** Returns the poses of a stream by name. */
std::vector<types::Pose> getPoses(Reader& log, const std::string& stream) {
    std::vector<types::Pose> poses;
    log.forEach<types::Pose>(stream, [&](const types::Pose& pose, const SampleRef& at) {
        EXPECT_EQ(pose.time, at.time);
        poses.push_back(pose);
    });
    return poses;
}

void expectSame(const types::Pose& read, const types::Pose& written) {
    EXPECT_EQ(read.time, written.time);
    EXPECT_LT(glm::distance(read.position, written.position), exact);
    EXPECT_GT(std::abs(glm::dot(read.orientation, written.orientation)), 1 - exact);
}

/** Opens a bag in each of its storages. */
void inEachStorage(const test::Bag& bag, types::WorldFrame frame, auto&& use) {
    const Folder folder;
    bag.writeMcap(folder / "bag.mcap");
    ASSERT_EQ(bag.writeDb3(folder / "bag.db3"), "");
    for (const char* name : {"bag.mcap", "bag.db3"}) {
        SCOPED_TRACE(name);
        const auto log = openLog(folder / name, AtDamage::Stop, frame);
        use(*log);
    }
}

std::string getRefusal(Reader& log, const PoseSource& source) {
    try {
        addPoses(log, source, types::WorldFrame::Enu);
    } catch (const types::ConfigError& error) {
        EXPECT_EQ(error.diagnostics().size(), 1u);
        return error.what();
    }
    return "";
}

template <class Message>
void expectTopicsPoses(Draws& draws, types::WorldFrame frame) {
    test::Bag bag;
    std::vector<types::Pose> written;
    double time = 0;
    for (int i = 0; i < 40; ++i) {
        written.push_back(draws.pose(time += draws.from(0.01, 1)));
        Message message;
        ros::convert(written.back(), frame, message);
        bag.add("/nav/state", written.back().time + types::Time::fromSeconds(draws.from(0, 0.2)), message);
    }
    inEachStorage(bag, frame, [&](Reader& log) {
        const std::vector<FoundPoses> found = findPoses(log);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].source, "/nav/state");
        EXPECT_EQ(found[0].type, Message::type_name);
        EXPECT_EQ(found[0].parent, "map");
        EXPECT_EQ(found[0].count, written.size());
        EXPECT_TRUE(addPoses(log, {"/nav/state", "vehicle.pose"}, frame).empty());
        const std::vector<types::Pose> read = getPoses(log, "vehicle.pose");
        ASSERT_EQ(read.size(), written.size());
        for (size_t i = 0; i < read.size(); ++i) expectSame(read[i], written[i]);
    });
}

TEST(PoseSourcesTest, PosesOfTopicsAreThoseThatWereWrittenInEveryWorldFrame) {
    Draws draws(1);
    for (const auto frame : {types::WorldFrame::Enu, types::WorldFrame::Ned, types::WorldFrame::AsIs}) {
        expectTopicsPoses<ros::Odometry>(draws, frame);
        expectTopicsPoses<ros::PoseStamped>(draws, frame);
        expectTopicsPoses<ros::PoseWithCovarianceStamped>(draws, frame);
    }
}

TEST(PoseSourcesTest, CovariancesOfAPoseAreKept) {
    types::Pose pose = Draws(7).pose(1);
    for (int i = 0; i < 3; ++i) pose.cov_position[i] = pose.cov_orientation[i] = glm::dvec3(0);
    for (int i = 0; i < 3; ++i) pose.cov_position[i][i] = i + 1, pose.cov_orientation[i][i] = 0.1 * (i + 1);
    test::Bag bag;
    ros::PoseWithCovarianceStamped message;
    ros::convert(pose, types::WorldFrame::Enu, message);
    EXPECT_NEAR(message.pose.covariance[0], 2, 1e-12);  // east is Rock's -y
    bag.add("/p", pose.time, message);
    inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
        const types::Pose read = getPoses(log, "p").front();
        for (int i = 0; i < 3; ++i) {
            EXPECT_LT(glm::distance(read.cov_position[i], pose.cov_position[i]), exact);
            EXPECT_LT(glm::distance(read.cov_orientation[i], pose.cov_orientation[i]), exact);
        }
    });
}

ros::TransformStamped makeTransform(const std::string& parent, const std::string& child, const types::Pose& pose) {
    ros::TransformStamped stamped{{ros::toRos(pose.time), parent}, child, {}};
    stamped.transform.translation = {pose.position.x, pose.position.y, pose.position.z};
    const glm::dquat& q = pose.orientation;
    stamped.transform.rotation = {q.x, q.y, q.z, q.w};
    return stamped;
}

/** A frame of a random tree: its parent, and its pose there over time. */
struct Branch {
    std::string name;
    int parent = -1;  ///< Index; -1: the root.
    bool moves = false;
    types::Pose fixed;
    glm::dvec3 rate{0}, axis{0, 0, 1};
    double turn = 0;

    types::Pose at(double time) const {
        types::Pose pose = fixed;
        pose.time = seconds(time);
        if (!moves) return pose;
        pose.position += rate * time;
        pose.orientation = fixed.orientation * glm::angleAxis(turn * time, axis);
        return pose;
    }
};

std::vector<Branch> randomTree(Draws& draws) {
    std::vector<Branch> tree;
    const int count = draws.whole(2, 7);
    for (int i = 0; i < count; ++i) {
        Branch branch;
        branch.name = "frame" + std::to_string(i);
        branch.parent = draws.whole(-1, i - 1);
        branch.moves = i == 0 || draws.whole(0, 1) == 1;
        branch.fixed = draws.pose(0);
        branch.rate = draws.place() * 0.01;
        branch.axis = glm::normalize(draws.place());
        branch.turn = draws.from(-0.5, 0.5);
        tree.push_back(branch);
    }
    return tree;
}

/** Returns a frame of the tree in its root; ENU. */
types::Pose inRoot(const std::vector<Branch>& tree, int frame, double time) {
    types::Pose all = tree[static_cast<size_t>(frame)].at(time);
    for (int up = tree[static_cast<size_t>(frame)].parent; up >= 0; up = tree[static_cast<size_t>(up)].parent) {
        const types::Pose one = tree[static_cast<size_t>(up)].at(time);
        all.position = one.position + one.orientation * all.position;
        all.orientation = one.orientation * all.orientation;
    }
    return all;
}

test::Bag makeBag(const std::vector<Branch>& tree, Draws& draws, int steps) {
    test::Bag bag;
    ros::TFMessage fixed;
    const auto getParent = [&](const Branch& b) {
        return b.parent < 0 ? "map" : tree[static_cast<size_t>(b.parent)].name;
    };
    for (const Branch& branch : tree)
        if (!branch.moves) fixed.transforms.push_back(makeTransform(getParent(branch), branch.name, branch.at(0)));
    const int static_step = draws.whole(0, steps - 1);  // a late publisher: the recorder joined before it
    for (int step = 0; step < steps; ++step) {
        const double time = 0.1 * step;
        if (step == static_step && !fixed.transforms.empty()) bag.add("/tf_static", seconds(time), fixed);
        ros::TFMessage moving;
        for (const Branch& branch : tree)
            if (branch.moves)
                moving.transforms.push_back(makeTransform(getParent(branch), branch.name, branch.at(time)));
        if (draws.whole(0, 1) == 1) {  // all in one message, or each in its own
            bag.add("/tf", seconds(time + 0.02), moving);
            continue;
        }
        for (const ros::TransformStamped& each : moving.transforms)
            bag.add("/tf", seconds(time + 0.02), ros::TFMessage{{each}});
    }
    return bag;
}

TEST(PoseSourcesTest, FramesOfRandomTreesAreFollowedAsTheyWereWritten) {
    constexpr int steps = 25;
    for (unsigned seed = 0; seed < 15; ++seed) {
        SCOPED_TRACE(seed);
        Draws draws(seed);
        const std::vector<Branch> tree = randomTree(draws);
        const test::Bag bag = makeBag(tree, draws, steps);
        const int child = draws.whole(0, static_cast<int>(tree.size()) - 1);
        const int parent = draws.whole(-1, static_cast<int>(tree.size()) - 1);
        bool moves = false;  // a transform between them, on the way over the frame that both are below
        std::map<int, int> on_way;
        for (const int end : {child, parent})
            for (int up = end; up >= 0; up = tree[static_cast<size_t>(up)].parent) ++on_way[up];
        for (const auto& [frame, times] : on_way) moves |= times == 1 && tree[static_cast<size_t>(frame)].moves;
        const std::string from = parent < 0 ? "map" : tree[static_cast<size_t>(parent)].name;
        const PoseSource source{from + "->" + tree[static_cast<size_t>(child)].name, "vehicle.pose"};
        inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
            if (!moves) {
                EXPECT_THAT(getRefusal(log, source), HasSubstr("gives no poses"));
                return;
            }
            EXPECT_TRUE(addPoses(log, source, types::WorldFrame::Enu).empty());
            const std::vector<types::Pose> read = getPoses(log, "vehicle.pose");
            ASSERT_EQ(read.size(), static_cast<size_t>(steps));
            for (int step = 0; step < steps; ++step) {
                const double time = 0.1 * step;
                types::Pose enu = inRoot(tree, child, time), in;
                if (parent >= 0) in = inRoot(tree, parent, time);
                const types::Axes axes{types::WorldFrame::Enu};
                types::Pose expected;
                expected.time = seconds(time);
                const glm::dquat back = glm::conjugate(in.orientation);
                expected.position = axes.rockFromWorld(back * (enu.position - in.position));
                expected.orientation = axes.rockFromOrientation(back * enu.orientation);
                expectSame(read[static_cast<size_t>(step)], expected);
                EXPECT_EQ(read[static_cast<size_t>(step)].target_frame, from);
            }
        });
    }
}

TEST(PoseSourcesTest, TwoBodiesComeFromOneTopicOfTransforms) {
    Draws draws(3);
    const std::vector<Branch> tree{{"auv", -1, true, draws.pose(0), {1, 0, 0}, {0, 0, 1}, 0.1},
                                   {"diver", -1, true, draws.pose(0), {0, 1, 0}, {0, 0, 1}, 0.2}};
    inEachStorage(makeBag(tree, draws, 10), types::WorldFrame::Enu, [&](Reader& log) {
        const std::vector<FoundPoses> found = findPoses(log);
        ASSERT_EQ(found.size(), 2u);
        EXPECT_THAT(found[0].text(), HasSubstr("(tf2_msgs/msg/TFMessage, 10 in 0.9 s)"));
        addPoses(log, {"map->auv", "vehicle.pose"}, types::WorldFrame::Enu);
        addPoses(log, {"map->diver", "diver.pose"}, types::WorldFrame::Enu);
        const auto auv = getPoses(log, "vehicle.pose"), diver = getPoses(log, "diver.pose");
        ASSERT_EQ(auv.size(), 10u);
        ASSERT_EQ(diver.size(), 10u);
        EXPECT_GT(glm::distance(auv.back().position, diver.back().position), 1);
    });
}

TEST(PoseSourcesTest, TransformsOfAClockThatRunsTenTimesAsFastAreFollowed) {
    test::Bag bag;
    Draws draws(4);
    for (int i = 0; i < 300; ++i) {
        types::Pose pose = draws.pose(0);
        pose.time = types::Time::fromSeconds(i * 1.0);  // a simulator's clock
        bag.add("/tf", seconds(i * 0.1), ros::TFMessage{{makeTransform("world", "auv", pose)}});
    }
    inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
        EXPECT_TRUE(addPoses(log, {"world->auv", "p"}, types::WorldFrame::Enu).empty());
        EXPECT_EQ(getPoses(log, "p").size(), 300u);
    });
}

TEST(PoseSourcesTest, PosesThatAreNotUsableAreOmittedWithAWarning) {
    test::Bag bag;
    Draws draws(5);
    for (int i = 0; i < 6; ++i) {
        types::Pose pose = draws.pose(i);
        if (i == 2) pose.position.x = std::numeric_limits<double>::quiet_NaN();
        if (i == 4) pose.orientation = glm::dquat(0, 0, 0, 0);
        ros::PoseStamped message;
        ros::convert(pose, types::WorldFrame::Enu, message);
        bag.add("/p", pose.time, message);
    }
    inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
        const types::Notices notices = addPoses(log, {"/p", "vehicle.pose"}, types::WorldFrame::Enu);
        ASSERT_EQ(notices.size(), 1u);
        EXPECT_THAT(notices[0].text, HasSubstr("2 of 6 poses of /p are omitted"));
        EXPECT_EQ(getPoses(log, "vehicle.pose").size(), 4u);
        EXPECT_THAT(addPoses(log, {"/p", "p", types::Datum{}}, types::WorldFrame::Enu)[0].text,
                    HasSubstr("datum and orientation are without effect on /p, which has whole poses"));
    });
}

TEST(PoseSourcesTest, ASourceThatCannotBeUsedIsRefusedWithThoseThatThereAre) {
    test::Bag bag;
    Draws draws(6);
    for (int i = 0; i < 3; ++i) {
        ros::Odometry odometry;
        ros::convert(draws.pose(i), types::WorldFrame::Enu, odometry);
        bag.add("/odom", seconds(i), odometry);
        bag.add("/depth", seconds(i), ros::Float64{1.0});
        types::Pose pose = draws.pose(i);
        bag.add("/tf", seconds(i),
                ros::TFMessage{{makeTransform("map", "odom", pose), makeTransform("left", "right", pose)}});
    }
    bag.add("/tf_static", seconds(0), ros::TFMessage{{makeTransform("odom", "base", draws.pose(0))}});
    bag.add("/tf", seconds(4),
            ros::TFMessage{{makeTransform("a", "b", draws.pose(4)), makeTransform("b", "a", draws.pose(4))}});
    inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
        const std::string there = "there are: /odom (nav_msgs/msg/Odometry, map -> base_link, 3 in 2 s), ";
        EXPECT_THAT(getRefusal(log, {"/odm"}), testing::AllOf(HasSubstr("did you mean /odom?"), HasSubstr(there)));
        EXPECT_THAT(getRefusal(log, {"/depth"}), testing::AllOf(HasSubstr("which is no pose"), HasSubstr(there)));
        EXPECT_THAT(getRefusal(log, {"odom->base"}), HasSubstr("is a fixed pose"));
        EXPECT_THAT(getRefusal(log, {"map->right"}), HasSubstr("no transforms lead from right to map, only to left"));
        EXPECT_THAT(getRefusal(log, {"map->b"}), HasSubstr("form a circle"));
        EXPECT_THAT(getRefusal(log, {"->"}), HasSubstr("gives no poses"));
        EXPECT_THAT(getRefusal(log, {""}), HasSubstr("is no stream"));
        EXPECT_EQ(getRefusal(log, {"map->base", "own"}), "");
    });
}

ros::NavSatFix fixAt(double time, double latitude, double longitude, double height) {
    ros::NavSatFix fix;
    fix.header = {ros::toRos(seconds(time)), "gps"};
    fix.latitude = latitude;
    fix.longitude = longitude;
    fix.altitude = height;
    fix.position_covariance = {9, 1, 0, 1, 4, 0, 0, 0, 16};  // to the east, north and up
    fix.position_covariance_type = 3;
    return fix;
}

/** Returns the place of a fix in the earth's axes [m]; WGS 84's definition. */
glm::dvec3 earthCentred(double latitude_deg, double longitude_deg, double height) {
    constexpr double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f);
    const double phi = latitude_deg * M_PI / 180, lambda = longitude_deg * M_PI / 180;
    const double n = a / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
    return {(n + height) * std::cos(phi) * std::cos(lambda), (n + height) * std::cos(phi) * std::sin(lambda),
            (n * (1 - e2) + height) * std::sin(phi)};
}

TEST(PoseSourcesTest, FixesBecomePlacesAboutTheDatum) {
    Draws draws(8);
    for (int round = 0; round < 10; ++round) {
        const types::Datum datum{draws.from(-89, 89), draws.from(-180, 180), draws.from(-50, 500)};
        test::Bag bag;
        std::vector<types::Datum> fixes;
        std::vector<glm::dquat> turns;
        for (int i = 0; i < 10; ++i) {
            fixes.push_back({datum.latitude_deg + draws.from(-0.05, 0.05),
                             datum.longitude_deg + draws.from(-0.05, 0.05), draws.from(-50, 500)});
            bag.add("/fix", seconds(i), fixAt(i, fixes[i].latitude_deg, fixes[i].longitude_deg, fixes[i].height_m));
            types::Imu imu;
            imu.time = seconds(i);
            imu.orientation = draws.turn();
            turns.push_back(imu.orientation);
            ros::Imu message;
            ros::convert(imu, types::WorldFrame::Enu, "imu", message);
            bag.add("/imu", seconds(i), message);
        }
        inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
            try {
                addPoses(log, {"/fix", "vehicle.pose", datum, "/imu"}, types::WorldFrame::Enu);
            } catch (const types::ConfigError& error) {
                if (std::string(error.what()).find("no GeographicLib") == std::string::npos) throw;
                GTEST_SKIP() << "this build has no GeographicLib";
            }
            const std::vector<types::Pose> read = getPoses(log, "vehicle.pose");
            ASSERT_EQ(read.size(), fixes.size());
            const double phi = datum.latitude_deg * M_PI / 180, lambda = datum.longitude_deg * M_PI / 180;
            const glm::dvec3 east(-std::sin(lambda), std::cos(lambda), 0),
                up(std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi)),
                north = glm::cross(up, east);
            for (size_t i = 0; i < read.size(); ++i) {
                const glm::dvec3 away = earthCentred(fixes[i].latitude_deg, fixes[i].longitude_deg, fixes[i].height_m) -
                                        earthCentred(datum.latitude_deg, datum.longitude_deg, datum.height_m);
                const glm::dvec3 rock(glm::dot(away, north), -glm::dot(away, east), glm::dot(away, up));
                EXPECT_LT(glm::distance(read[i].position, rock), 1e-7);  // differences of 6e6 m
                EXPECT_GT(std::abs(glm::dot(read[i].orientation, turns[i])), 1 - exact);
                EXPECT_EQ(read[i].source_frame, "gps");
                EXPECT_EQ(read[i].cov_position, glm::dmat3(4, 0, 0, 0, 9, 0, 0, 0, 16)) << "to the north, west and up";
            }
        });
    }
}

TEST(PoseSourcesTest, FixesWithoutADatumOrAnOrientationSayWhatIsMissing) {
    test::Bag bag;
    ros::NavSatFix lost = fixAt(0, 0, 0, 0);
    lost.status.status = ros::NavSatStatus::no_fix;
    bag.add("/fix", seconds(0), lost);
    bag.add("/fix", seconds(1), fixAt(1, 54.5, 10.25, std::numeric_limits<double>::quiet_NaN()));
    bag.add("/imu", seconds(1), ros::Imu{});
    bag.add("/none", seconds(2), lost);
    inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
        EXPECT_TRUE(findPoses(log)[0].has_fixes);
        EXPECT_THAT(getRefusal(log, {"/fix"}),
                    HasSubstr("datum: {latitude_deg: 54.5, longitude_deg: 10.25, height_m: 0}"));
        const types::Datum datum{54.5, 10.25, 3};
        EXPECT_THAT(getRefusal(log, {"/none", "p", datum}), HasSubstr("has no fix in its 1 messages"));
        EXPECT_THAT(getRefusal(log, {"/fix", "p", datum, "/fix"}),
                    HasSubstr("may be a stream of poses or of sensor_msgs/msg/Imu"));
        types::Notices notices;
        try {
            notices = addPoses(log, {"/fix", "p", datum}, types::WorldFrame::Enu);
        } catch (const types::ConfigError&) {
            GTEST_SKIP() << "this build has no GeographicLib";
        }
        ASSERT_EQ(notices.size(), 2u);
        EXPECT_THAT(notices[0].text, HasSubstr("1 messages of /fix are omitted: they have no fix"));
        EXPECT_THAT(notices[1].text, HasSubstr("the body is level and looks to the north; orientation may be /imu"));
        const types::Pose pose = getPoses(log, "p").front();
        EXPECT_LT(glm::length(pose.position), 1e-8);  // an unknown height is the datum's
        EXPECT_EQ(pose.orientation, glm::dquat(1, 0, 0, 0));
    });
}

TEST(PoseSourcesTest, AMessageThatCannotBeDecodedIsOmittedWhateverNeedsIt) {
    constexpr size_t fix = 0, imu = 1, tf = 2, odometry = 3, count = 4;
    for (const size_t damaged : {fix, imu, tf, odometry, count}) {
        SCOPED_TRACE(damaged);
        test::Bag bag;
        Draws draws(9);
        for (int i = 0; i < 6; ++i) {
            ros::Imu turn;
            types::Imu level;
            level.orientation = draws.turn();
            ros::convert(level, types::WorldFrame::Enu, "imu", turn);
            ros::Odometry pose;
            ros::convert(draws.pose(i), types::WorldFrame::Enu, pose);
            bag.add("/fix", seconds(i), fixAt(i, 54.5, 10.25, i));
            bag.add("/imu", seconds(i), turn);
            bag.add("/tf", seconds(i), ros::TFMessage{{makeTransform("map", "base", draws.pose(i))}});
            bag.add("/odom", seconds(i), pose);
        }
        if (damaged < count) bag.cut(3 * count + damaged, 20);
        inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
            const types::Datum datum{54.5, 10.25, 0};
            const auto expectPoses = [&](const PoseSource& source, bool is_damaged, size_t poses) {
                const types::Notices notices = addPoses(log, source, types::WorldFrame::Enu);
                EXPECT_EQ(notices.size(), is_damaged ? 1u : 0u);
                for (const types::Notice& notice : notices)
                    EXPECT_THAT(notice.text, HasSubstr(" are omitted: 1, the first because: "));
                EXPECT_EQ(getPoses(log, source.stream).size(), poses);
            };
            expectPoses({"map->base", "of_tf"}, damaged == tf, damaged == tf ? 5 : 6);
            expectPoses({"/odom", "of_odometry"}, damaged == odometry, damaged == odometry ? 5 : 6);
            if (!getRefusal(log, {"/fix", "placed", datum}).empty()) GTEST_SKIP() << "this build has no GeographicLib";
            log.rename(log.findIndex("placed"), "level");
            expectPoses({"/fix", "placed", datum, "/imu"}, damaged == imu, damaged == fix ? 5 : 6);
        });
    }
}

TEST(PoseSourcesTest, AStreamThatHasTheNameAlreadyIsKeptUnderAnother) {
    test::Bag bag;
    Draws draws(9);
    for (const char* topic : {"/vehicle/pose", "/ekf/pose"}) {
        ros::Odometry odometry;
        ros::convert(draws.pose(0), types::WorldFrame::Enu, odometry);
        bag.add(topic, seconds(0), odometry);
    }
    inEachStorage(bag, types::WorldFrame::Enu, [&](Reader& log) {
        const types::Pose chosen = getPoses(log, "ekf.pose").front();
        addPoses(log, {"/ekf/pose", "vehicle.pose"}, types::WorldFrame::Enu);
        expectSame(getPoses(log, "vehicle.pose").front(), chosen);
        EXPECT_NE(log.find("vehicle.pose_recorded"), nullptr);
    });
}

}  // namespace
}  // namespace insonify::log
