// Soundings compared with closed forms: they are on the plane, where the bearings of the beams meet it.
#include <gmock/gmock.h>

#include <cmath>

#include "components/sonar/tasks/ProfilerTask.hpp"
#include "tests/sonar/WallScene.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::sonar {
namespace {

using test::ground;
using test::makeScene;
using test::quad;

constexpr double profile_bin = 0.03;  // 20 us at 1500 m/s [m]
constexpr double down = 90;

struct ProfilerTaskTest : test::TaskBench<ProfilerTask, types::SnapshotPtr, types::PointCloudPtr> {
    ProfilerTaskTest() : TaskBench(&ProfilerTask::snapshot, &ProfilerTask::soundings) {}
    static ProfilerConfig profiler() {
        ProfilerConfig config;
        config.sonar.range = 30;
        config.sonar.beam_count = 128;
        config.sonar.bin_count = 1000;
        config.sonar.field_of_view_deg = 120;
        config.sonar.quality.rows = 8;
        config.sonar.quality.columns_per_beam = 8;
        return config;
    }
    types::PointCloudPtr getSoundings(types::Snapshot snapshot) {
        return answerTo(std::make_shared<types::Snapshot>(std::move(snapshot)));
    }
    /** Returns the soundings of a vehicle with these angles [deg], whose profiler looks down. */
    static types::Snapshot above(types::GeometryPtr floor, glm::dvec3 position, double yaw = 0, double roll = 0) {
        types::Snapshot snapshot =
            test::makeSnapshot(std::move(floor), position, types::radians(yaw), 0, types::radians(roll));
        snapshot.sonar.orientation *= glm::angleAxis(types::radians(down), glm::dvec3(0, 1, 0));
        return snapshot;
    }
};

/** z = -D, y = D tan(a); with the wrong sign of y it is to starboard. */
TEST_F(ProfilerTaskTest, AFlatBottomIsSoundedWhereTheBearingsMeetIt) {
    constexpr double height = 10;
    startWith(profiler());
    const auto cloud = getSoundings(above(makeScene({ground(-height)}), {5, -3, 0}));
    ASSERT_TRUE(cloud) << task_.lastError();
    EXPECT_EQ(cloud->time, types::Time{1'000'000});
    ASSERT_EQ(cloud->points.size(), 128u);
    double worst = 0, worst_mirrored = 0;
    for (int k = 0; k < 128; ++k) {
        const double a = types::radians(profiler().sonar.bearingDeg(k));
        const glm::dvec3 expected(5, -3 + height * std::tan(a), -height);
        const glm::dvec3& got = cloud->points[static_cast<size_t>(k)];
        worst = std::max(worst, glm::distance(got, expected));
        worst_mirrored = std::max(worst_mirrored, glm::distance(got, {5, -3 - height * std::tan(a), -height}));
        EXPECT_GT(cloud->intensity(static_cast<size_t>(k)), 0);
    }
    std::cout << "flat bottom: soundings at most " << worst << " m off, bins of " << profile_bin << " m\n";
    EXPECT_LT(worst, 0.5 * profile_bin);
    EXPECT_GT(worst_mirrored, 30);
}

/** n . p = 0 for each sounding, also with a rotated and rolled sonar. */
TEST_F(ProfilerTaskTest, SoundingsAreOnATiltedPlaneInTheWorldInAnyAttitude) {
    const double across = types::radians(15), along = types::radians(10);
    const glm::vec3 u(std::cos(along), 0, std::sin(along)), v(0, std::cos(across), std::sin(across));
    const auto plane = makeScene({quad(-500.f * u - 500.f * v, 1000.f * u, 1000.f * v)});
    const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(u), glm::dvec3(v)));
    ProfilerConfig config = profiler();
    config.sonar.field_of_view_deg = 90;
    startWith(config);
    for (const auto& [yaw, roll] : {std::pair{0.0, 0.0}, {90.0, 0.0}, {35.0, -12.0}, {200.0, 15.0}}) {
        const auto cloud = getSoundings(above(plane, {1, 2, 9}, yaw, roll));
        ASSERT_TRUE(cloud) << task_.lastError();
        EXPECT_GT(cloud->points.size(), 100u);
        double worst = 0;
        for (const glm::dvec3& p : cloud->points) worst = std::max(worst, std::abs(glm::dot(normal, p)));
        std::cout << "tilted plane, yaw " << yaw << ", roll " << roll << ": at most " << worst << " m off the plane\n";
        EXPECT_LT(worst, 0.5 * profile_bin);
    }
}

/** A box on the bottom is the strongest return where it is visible, and the bottom beyond the range is not sounded. */
TEST_F(ProfilerTaskTest, ABeamGivesItsStrongestReturnAndASilentBeamNone) {
    ProfilerConfig config = profiler();
    config.sonar.range = 12;
    config.sonar.bin_count = 400;
    startWith(config);
    const auto step = quad({-50, 1, -8}, {100, 0, 0}, {0, 2, 0});
    const auto cloud = getSoundings(above(makeScene({ground(-10), step}), {0, 0, 0}));
    ASSERT_TRUE(cloud) << task_.lastError();
    EXPECT_LT(cloud->points.size(), 100u) << "12 m reach 33 deg to either side";
    const auto onAnEdge = [](double y) { return std::abs(y - 1) < 0.3 || std::abs(y - 3) < 0.3; };  // either is right
    for (const glm::dvec3& p : cloud->points) {
        if (onAnEdge(p.y)) continue;
        EXPECT_NEAR(p.z, p.y > 1 && p.y < 3 ? -8 : -10, profile_bin) << p.y;
    }
}

/** The soundings are where the travel times and angles of the detections are in the world. */
TEST_F(ProfilerTaskTest, DetectionsAreTheSoundingsByBeam) {
    test::Reader<types::SonarDetectionsPtr> reader;
    task_.detections.connectTo(reader.port, framework::ConnPolicy::buffer(4));
    ProfilerConfig config = profiler();
    config.sonar.range = 14;
    config.sonar.bin_count = 470;
    config.sonar.speed_of_sound = 1480;
    startWith(config);
    for (const auto& [yaw, roll] : {std::pair{0.0, 0.0}, {35.0, -12.0}, {200.0, 15.0}}) {
        types::Snapshot snapshot = above(makeScene({ground(-10)}), {1, 2, 0}, yaw, roll);
        snapshot.time = types::Time{1'000'000 + static_cast<int64_t>(1e6 * yaw)};
        const types::Pose sonar = snapshot.sonar;
        const auto cloud = getSoundings(std::move(snapshot));
        types::SonarDetectionsPtr found;
        ASSERT_TRUE(cloud && reader.port.readNew(found)) << task_.lastError();
        EXPECT_EQ(found->time, cloud->time);
        EXPECT_EQ(found->speed_of_sound, 1480);
        EXPECT_NEAR(found->beam_height.deg(), 1, 1e-9) << "along the track";
        ASSERT_EQ(found->bearings.size(), 128u) << "every beam";
        EXPECT_EQ(found->diagnostic(), nullptr);
        size_t point = 0;
        for (size_t beam = 0; beam < 128; ++beam) {
            EXPECT_NEAR(found->bearings[beam].deg(), config.sonar.bearingDeg(static_cast<int>(beam)), 1e-9);
            EXPECT_EQ(found->elevations[beam], 0);
            const auto time = static_cast<double>(found->travel_times[beam]);
            if (!std::isfinite(time)) {
                EXPECT_EQ(found->intensities[beam], 0);
                continue;
            }
            const double bearing = found->bearings[beam].rad;
            const glm::dvec3 direction(std::cos(bearing), std::sin(bearing), 0);
            const glm::dvec3 place = sonar.position + sonar.orientation * direction * (time * 1480 / 2);
            ASSERT_LT(point, cloud->points.size());
            EXPECT_NEAR(glm::distance(place, cloud->points[point]), 0, 1e-5) << beam;
            EXPECT_EQ(found->intensities[beam], cloud->intensity(point++));
        }
        EXPECT_EQ(point, cloud->points.size());
        EXPECT_GT(point, 50u);
        EXPECT_LT(point, 128u) << "14 m do not reach the floor at the edges";
    }
}

TEST_F(ProfilerTaskTest, GivesACloudWithoutPointsForNothingInRange) {
    startWith(profiler());
    const auto cloud = getSoundings(above(makeScene({ground(-100)}), {0, 0, 0}));
    ASSERT_TRUE(cloud) << task_.lastError();
    EXPECT_TRUE(cloud->points.empty());
}

}  // namespace
}  // namespace insonify::sonar
