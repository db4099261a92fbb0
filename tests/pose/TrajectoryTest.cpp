#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "components/pose/Trajectory.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::pose {
namespace {

using ::testing::HasSubstr;

/** A file of the given text, gone at the end of the test. */
class TextFile {
public:
    explicit TextFile(const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

private:
    const Folder folder_;

public:
    const std::filesystem::path path = folder_ / "trajectory.csv";
};

types::Diagnostics findDiagnostics(const std::string& text) {
    const TextFile file(text);
    try {
        Trajectory::fromFile(file.path);
    } catch (const types::ConfigError& error) {
        return error.diagnostics();
    }
    return {};
}

constexpr double tiny = 1e-12;
const std::string header = "time,x,y,z,qw,qx,qy,qz\n";

TEST(TrajectoryTest, PositionIsLinearBetweenStampsAndHeldOutside) {
    const Trajectory path({Waypoint{.time = 1, .position = {0, 0, 0}}, Waypoint{.time = 3, .position = {4, -2, 1}}});
    EXPECT_LT(glm::distance(path.at(1.5).position, {1, -0.5, 0.25}), tiny);
    EXPECT_EQ(path.at(0).position, glm::dvec3(0, 0, 0));
    EXPECT_EQ(path.at(1e9).position, glm::dvec3(4, -2, 1));
    EXPECT_EQ(path.at(3).position, glm::dvec3(4, -2, 1));
}

/** Returns laps on a circle of 5 m, 20 s each, heading along the path, with a stamp each `step` seconds. */
std::vector<Trajectory::Stamp> circle(double step) {
    std::vector<Trajectory::Stamp> stamps;
    for (int i = 0; i * step <= 40; ++i) {
        const double angle = 2 * std::numbers::pi * i * step / 20;
        stamps.push_back(
            {i * step, {5 * std::sin(angle), -5 * std::cos(angle), -2}, glm::angleAxis(angle, glm::dvec3(0, 0, 1))});
    }
    return stamps;
}

TEST(TrajectoryTest, ASmoothPathPassesThroughItsStampsAndFollowsTheCurveBetween) {
    const double turn_rate = 2 * std::numbers::pi / 20;
    double error_before = 0;
    for (const double step : {2.0, 1.0, 0.5}) {
        const std::vector<Trajectory::Stamp> stamps = circle(step);
        const Trajectory path(stamps, true);
        const auto at_stamp = path.at(20);
        EXPECT_LT(glm::distance(at_stamp.position, stamps[static_cast<size_t>(20 / step)].position), tiny);
        double error = 0;
        for (double time = 15; time < 25; time += 0.03) {
            const types::Pose pose = path.at(time);
            const double angle = turn_rate * time;
            error = std::max(error, glm::distance(pose.position, {5 * std::sin(angle), -5 * std::cos(angle), -2}));
            EXPECT_NEAR(glm::length(pose.orientation), 1, tiny);
            EXPECT_NEAR(glm::length(pose.velocity), 5 * turn_rate, 0.02 * step * step);
            EXPECT_LT(glm::distance(pose.angular_velocity, {0, 0, turn_rate}), 0.01 * step * step);
        }
        if (error_before > 0) {
            EXPECT_NEAR(error_before / error, 16, 3) << "the fourth order of a cubic spline";
        }
        error_before = error;
    }
}

TEST(TrajectoryTest, VelocitiesOfASmoothPathAreDerivativesOfItsPositionsAndDoNotJump) {
    const Trajectory path({Waypoint{.time = 0}, Waypoint{.time = 1, .position = {1, 0, 0}, .yaw_deg = 30},
                           Waypoint{.time = 2.5, .position = {1, 2, -1}, .roll_deg = 10, .yaw_deg = 100},
                           Waypoint{.time = 4, .position = {0, 2, -1}, .yaw_deg = 200}},
                          true);
    constexpr double h = 1e-5;
    for (const double time : {0.5, 1 - 1e-7, 1 + 1e-7, 2.0, 3.5}) {
        const types::Pose before = path.at(time - h), pose = path.at(time), after = path.at(time + h);
        const glm::dquat turn = glm::conjugate(before.orientation) * after.orientation;
        EXPECT_LT(glm::distance(pose.velocity, (after.position - before.position) / (2 * h)), 1e-8) << time;
        EXPECT_LT(glm::distance(pose.angular_velocity, glm::dvec3(turn.x, turn.y, turn.z) / h), 1e-8) << time;
    }
}

TEST(TrajectoryTest, ASmoothPathOfOneOrTwoStampsIsAPointOrALine) {
    EXPECT_EQ(Trajectory({Waypoint{.time = 3, .position = {1, 2, 3}}}, true).at(5).position, glm::dvec3(1, 2, 3));
    const Trajectory line({Waypoint{.time = 0}, Waypoint{.time = 2, .position = {4, 0, -2}}}, true);
    EXPECT_LT(glm::distance(line.at(0.5).position, {1, 0, -0.5}), tiny);
    EXPECT_LT(glm::distance(line.at(0.5).velocity, {2, 0, -1}), tiny);
    EXPECT_EQ(line.at(3).velocity, glm::dvec3(0)) << "after the last stamp it holds still";
}

TEST(TrajectoryTest, VelocityIsThatOfTheSegmentAndZeroOutside) {
    const Trajectory path({Waypoint{.time = 0}, Waypoint{.time = 2, .position = {4, 0, -2}, .yaw_deg = 90}});
    EXPECT_LT(glm::distance(path.at(1).velocity, {2, 0, -1}), tiny);
    EXPECT_LT(glm::distance(path.at(1).angular_velocity, {0, 0, std::numbers::pi / 4}), tiny);
    EXPECT_EQ(path.at(2.5).velocity, glm::dvec3(0));
    EXPECT_EQ(path.at(-1).angular_velocity, glm::dvec3(0));
}

TEST(TrajectoryTest, OrientationTurnsEvenlyTheShorterWay) {
    const Trajectory path({Waypoint{.time = 0, .yaw_deg = 170}, Waypoint{.time = 1, .yaw_deg = -170}});
    const glm::dvec3 ahead = path.at(0.25).orientation * glm::dvec3(1, 0, 0);
    const double yaw = std::atan2(ahead.y, ahead.x) * 180 / std::numbers::pi;
    EXPECT_NEAR(yaw, 175, 1e-9);
    EXPECT_NEAR(glm::length(path.at(0.25).orientation), 1, tiny);
}

TEST(TrajectoryTest, QuaternionsOfOppositeSignAreTheSameOrientation) {
    const Trajectory path(std::vector<Trajectory::Stamp>{{0, {}, {1, 0, 0, 0}}, {1, {}, {-1, 0, 0, 0}}});
    EXPECT_NEAR(std::abs(path.at(0.5).orientation.w), 1, tiny);
    EXPECT_LT(glm::length(path.at(0.5).angular_velocity), tiny);
}

TEST(TrajectoryTest, PositivePitchLooksDownPositiveYawTurnsToPortPositiveRollLowersStarboard) {
    const auto turned = [](Waypoint waypoint, glm::dvec3 axis) { return waypoint.orientation() * axis; };
    EXPECT_LT(turned({.pitch_deg = 30}, {1, 0, 0}).z, -0.49);
    EXPECT_GT(turned({.yaw_deg = 30}, {1, 0, 0}).y, 0.49);
    EXPECT_LT(turned({.roll_deg = 30}, {0, -1, 0}).z, -0.49);
    // Rz(90) Ry(90): the nose points down, and the belly to the west, as turned by the yaw.
    EXPECT_LT(glm::distance(turned({.pitch_deg = 90, .yaw_deg = 90}, {0, 0, 1}), {0, 1, 0}), tiny);
}

TEST(TrajectoryTest, OneWaypointIsAFixedPose) {
    const Trajectory path({Waypoint{.time = 5, .position = {1, 2, 3}}});
    for (const double time : {0.0, 5.0, 10.0}) EXPECT_EQ(path.at(time).position, glm::dvec3(1, 2, 3)) << time;
    EXPECT_EQ(path.at(0).source_frame, "body");
    EXPECT_EQ(path.at(0).target_frame, "world");
}

TEST(TrajectoryTest, RejectsStampsThatDoNotIncrease) {
    EXPECT_THROW(Trajectory(std::vector<Waypoint>{}), std::invalid_argument);
    EXPECT_THROW(Trajectory({Waypoint{.time = 1}, Waypoint{.time = 1}}), std::invalid_argument);
}

TEST(TrajectoryTest, AFileWithCarriageReturnsBlankLinesAndByteOrderMarkIsRead) {
    const TextFile file("\xEF\xBB\xBFtime,x,y,z,qw,qx,qy,qz\r\n0,1,2,3,1,0,0,0\r\n\r\n 1.5 ,4,5,6e0,0,0,0,-1");
    const Trajectory path = Trajectory::fromFile(file.path);
    ASSERT_EQ(path.stamps().size(), 2u);
    EXPECT_EQ(path.stamps()[1].time, 1.5);
    EXPECT_EQ(path.stamps()[1].position, glm::dvec3(4, 5, 6));
}

TEST(TrajectoryTest, AQuaternionThatIsNotQuiteUnitIsNormalised) {
    const TextFile file(header + "0,0,0,0,1.001,0,0,0\n1,0,0,0,0,0,0,2e-6\n");
    const Trajectory path = Trajectory::fromFile(file.path);
    EXPECT_NEAR(path.stamps()[0].orientation.w, 1, tiny);
    EXPECT_NEAR(path.stamps()[1].orientation.z, 1, tiny);
}

TEST(TrajectoryTest, ReportsEveryErrorOfAFileWithItsPlace) {
    const auto diagnostics = findDiagnostics(header +
                                             "0,0,0,0,1,0,0,0\n"      // 2: good
                                             "1,0,abc,0,1,0,0,0\n"    // 3: no number
                                             "2,0,0,0,1,0,0\n"        // 4: too few
                                             "3,0,0,0,1,0,0,0,9\n"    // 5: too many
                                             "4,0,0,0,0,0,1e-7,0\n"   // 6: no direction
                                             "4,0,0,nan,1,0,0,0x1\n"  // 7: two diagnostics
                                             "4,0,0,0,1,0,0,0\n");    // 8: time does not advance
    struct Place {
        int line, column;
        const char *path, *message;
    };
    const Place expected[] = {{3, 5, "y", "'abc'"},       {4, 14, "qz", "missing"}, {5, 17, "", "too many"},
                              {6, 9, "qw", "quaternion"}, {7, 7, "z", "finite"},    {7, 17, "qz", "'0x1'"},
                              {8, 1, "time", "increase"}};
    ASSERT_EQ(diagnostics.size(), std::size(expected));
    for (size_t i = 0; i < diagnostics.size(); ++i) {
        EXPECT_EQ(diagnostics[i].line, expected[i].line) << i;
        EXPECT_EQ(diagnostics[i].column, expected[i].column) << i;
        EXPECT_EQ(diagnostics[i].path, expected[i].path) << i;
        EXPECT_THAT(diagnostics[i].message, HasSubstr(expected[i].message)) << i;
    }
}

TEST(TrajectoryTest, RejectsAFileWithoutHeaderStampsOrContent) {
    for (const char* text : {"", "\n\n", "time,x,y,z,qw,qx,qy,qz\n", "t,x\n0,0,0,0,1,0,0,0\n"})
        EXPECT_EQ(findDiagnostics(text).size(), 1u) << text;
}

std::string makeLine(std::vector<double> values, const char* separator) {
    std::string line;
    char number[40];
    for (const double value : values) {
        std::snprintf(number, sizeof number, "%.17g", value);
        line += (line.empty() ? "" : separator) + std::string(number);
    }
    return line;
}

TEST(TrajectoryTest, FilesOfTumAndEurocHaveThePosesOfTheCsv) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-50, 50), step(0.01, 2);
    for (int round = 0; round < 20; ++round) {
        std::string csv = header, tum = "# ground truth\n# timestamp tx ty tz qx qy qz qw\n",
                    euroc =
                        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
                        "q_RS_z [], v_RS_R_x [m s^-1], b_w_RS_S_x [rad s^-1]\r\n";
        int64_t ns = 1'403'636'580'838'555'648;
        for (int i = 0; i < 30; ++i) {
            ns += std::llround(step(random) * 1e9);
            const double s = static_cast<double>(ns) * 1e-9;
            const glm::dvec3 p(any(random), any(random), any(random));
            const glm::dquat q = glm::normalize(glm::dquat(any(random), any(random), any(random), any(random)));
            csv += makeLine({s, p.x, p.y, p.z, q.w, q.x, q.y, q.z}, ",") + "\n";
            tum += makeLine({s, p.x, p.y, p.z, q.x, q.y, q.z, q.w}, i % 2 ? " " : "  \t") + (i % 3 ? "\n" : " \r\n");
            euroc += std::to_string(ns) + "," + makeLine({p.x, p.y, p.z, q.w, q.x, q.y, q.z, 9, 9}, ",") + "\r\n";
            if (i == 10) tum += "\n# a gap\n", euroc += "#\n";
        }
        const TrajectoryTimes from_first{.start = TrajectoryStart::FirstPose};
        const auto read = [&](const std::string& text) {
            const TextFile file(text);
            return Trajectory::fromFile(file.path, false, from_first);
        };
        const Trajectory wanted = read(csv);
        EXPECT_EQ(read(euroc).timeUnit(), TimeUnit::Nanoseconds);
        for (const Trajectory& other : {read(tum), read(euroc)}) {
            ASSERT_EQ(other.stamps().size(), 30u);
            for (size_t i = 0; i < 30; ++i) {
                EXPECT_NEAR(other.stamps()[i].time, wanted.stamps()[i].time, 1e-6);
                EXPECT_EQ(other.stamps()[i].position, wanted.stamps()[i].position);
                EXPECT_GT(glm::dot(other.stamps()[i].orientation, wanted.stamps()[i].orientation), 1 - tiny);
            }
        }
    }
}

TEST(TrajectoryTest, AFileInTheAxesOfRosOrOfAircraftHasTheSamePath) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-50, 50);
    std::string rock = header, enu = header, ned = header;
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 p(any(random), any(random), any(random));  // north, west, up
        const glm::dquat q = glm::normalize(glm::dquat(any(random), any(random), any(random), any(random)));
        const double half = std::sqrt(0.5);
        const glm::dquat to_enu = glm::dquat(half, 0, 0, half) * q;  // north, the x of Rock, is the y of ENU
        rock += makeLine({double(i), p.x, p.y, p.z, q.w, q.x, q.y, q.z}, ",") + "\n";
        enu += makeLine({double(i), -p.y, p.x, p.z, to_enu.w, to_enu.x, to_enu.y, to_enu.z}, ",") + "\n";
        ned += makeLine({double(i), p.x, -p.y, -p.z, q.w, q.x, -q.y, -q.z}, ",") + "\n";
    }
    const TextFile file(rock);
    const Trajectory wanted = Trajectory::fromFile(file.path);
    for (const auto& [text, frame] : {std::pair(enu, types::WorldFrame::Enu), std::pair(ned, types::WorldFrame::Ned)}) {
        const TextFile other(text);
        const Trajectory path = Trajectory::fromFile(other.path, false, {}, frame);
        ASSERT_EQ(path.stamps().size(), 50u);
        for (size_t i = 0; i < 50; ++i) {
            EXPECT_EQ(path.stamps()[i].position, wanted.stamps()[i].position);
            EXPECT_GT(std::abs(glm::dot(path.stamps()[i].orientation, wanted.stamps()[i].orientation)), 1 - tiny);
        }
    }
    types::Diagnostics diagnostics;
    TrajectoryConfig config;
    config.waypoints = {Waypoint{}};
    config.world_frame = types::WorldFrame::Enu;
    config.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics.front().path, "world_frame");
}

TEST(TrajectoryTest, WrongFilesOfTumAndEurocAreRefusedWithLineAndColumn) {
    struct Wrong {
        std::string text;
        int line, column;
        const char* message;
    };
    const std::string euroc =
        "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n";
    for (const auto& [text, line, column, message] :
         std::vector<Wrong>{{"# t\n1 0 0 0 0 0 0\n", 2, 14, "is missing; a line has 8 fields"},
                            {"# t\n1 0 0 0 0 0 0 1 5\n", 2, 17, "too many fields"},
                            {"1 0 0 0 0 0 0 1\n2 0 0 x 0 0 0 1\n", 2, 7, "'x'"},
                            {"1 0 0 0 0 0 0 1\n\n1 0 0 0 0 0 0 1\n", 3, 1, "times must increase"},
                            {"1 0 0 0 0 0 0 0\n", 1, 9, "no usable length"},
                            {"# nothing\n", 1, 0, "has 0 lines of numbers"},
                            {euroc, 1, 0, "has 0 lines after its header"},
                            {euroc + "1,0,0,0,1,0,0\n", 2, 14, "is missing"},
                            {euroc + "1,0,0,inf,1,0,0,0\n", 2, 7, "'inf'"},
                            {"#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1]\n1,2,3\n", 1, 1,
                             "the header must begin with #timestamp,p_RS"},
                            {"0,0,0,0,1,0,0,0\n", 1, 1, "the header must have time,"}}) {
        const types::Diagnostics diagnostics = findDiagnostics(text);
        ASSERT_EQ(diagnostics.size(), 1u) << text;
        EXPECT_EQ(diagnostics[0].line, line) << text;
        if (column > 0) {
            EXPECT_EQ(diagnostics[0].column, column) << text;
        }
        EXPECT_THAT(diagnostics[0].message, HasSubstr(message)) << text;
    }
}

TEST(TrajectoryTest, RejectsAFolderAndAMissingFile) {
    EXPECT_THROW(Trajectory::fromFile(std::filesystem::temp_directory_path()), types::ConfigError);
    EXPECT_THROW(Trajectory::fromFile("no/such/file.csv"), types::ConfigError);
}

TEST(TrajectoryTest, AHundredDiagnosticsAreEnough) {
    std::string text = header;
    for (int i = 0; i < 5000; ++i) text += "x,x,x,x,x,x,x,x\n";
    EXPECT_LE(findDiagnostics(text).size(), 108u);
}

TEST(TrajectoryConfigTest, NeedsExactlyOneSourceAndIncreasingTimes) {
    const auto countRefusals = [](const TrajectoryConfig& config) { return test::countRefusals(config); };
    EXPECT_THAT(countRefusals({}), testing::SizeIs(1));
    EXPECT_THAT(countRefusals({.file = "a.csv", .waypoints = {Waypoint{}}}), testing::SizeIs(1));
    EXPECT_THAT(countRefusals({.file = "a.csv", .waypoints = {}}), testing::IsEmpty());
    EXPECT_THAT(countRefusals({.file = {}, .waypoints = {{.time = 1}, {.time = 2}, {.time = 2}, {.time = 1}}}),
                testing::ElementsAre(testing::StartsWith("waypoints[2].time: "), testing::_));
    EXPECT_THAT(countRefusals({.file = {}, .waypoints = {{.time = 0}, {.time = std::nan("")}}}), testing::SizeIs(1));
}

}  // namespace
}  // namespace insonify::pose
