// Detection in the water of the open sea, with a ring-down.
#include <gtest/gtest.h>

#include "components/output/pictures/SideScanImage.hpp"
#include "components/ros/Clouds.hpp"
#include "components/ros/Pings.hpp"
#include "components/sonar/tasks/AltimeterTask.hpp"
#include "components/sonar/tasks/ProfilerTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::sonar {
namespace {

/** A sonar of the open sea that rings. */
void putToSea(double volume_db, SonarConfig& config) {
    config.range = 60;
    config.bin_count = 600;
    config.speed_of_sound = 1500;
    config.frequency_khz = 200;
    config.range_rounding = RangeRounding::Exact;
    config.absorption.emplace().db_per_m = 0.05;
    config.volume.emplace_back().strength_db = volume_db;
    acoustics::PulseConfig& pulse = config.pulse.emplace();
    pulse.bandwidth_khz = 20;
    pulse.ring_down.emplace();
    pulse.ring_down->level_db = -40;
    pulse.ring_down->decay_db_per_m = 60;
    config.visibility = Visibility::Cpu;
}

/** Looks down at a floor; no floor where `depth` is 0. */
types::SnapshotPtr lookingDown(double depth) {
    types::Snapshot scene = test::makeSnapshot(
        depth > 0 ? test::makeScene({test::ground(static_cast<float>(-depth))}, -27) : test::openWater());
    scene.sonar.orientation = glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
    return std::make_shared<types::Snapshot>(scene);
}

constexpr double bin = 0.1;

struct SeaAltimeterTest : test::TaskBench<AltimeterTask, types::SnapshotPtr, types::Range> {
    SeaAltimeterTest() : TaskBench(&AltimeterTask::snapshot, &AltimeterTask::range) {}
    void startAt(double volume_db, double range_min = 0.1) {
        AltimeterConfig config;
        putToSea(volume_db, config.sonar);
        config.sonar.range_min = range_min;
        config.sonar.beam_width_deg = config.sonar.beam_height_deg = 10;
        config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 32;
        task_.stop();
        task_.cleanup();
        startWith(config);
    }
};

TEST_F(SeaAltimeterTest, TheBottomIsFoundInScatteringWater) {
    for (const double volume_db : {-90.0, -80.0, -70.0, -60.0}) {
        startAt(volume_db);
        for (const double depth : {3.0, 20.0, 50.0})
            EXPECT_NEAR(answerTo(lookingDown(depth)).range, depth, 2 * bin) << volume_db << " dB";
        EXPECT_TRUE(std::isnan(answerTo(lookingDown(0)).range)) << "deep water, " << volume_db << " dB";
    }
}

TEST_F(SeaAltimeterTest, ABottomNearerThanRangeMinIsTooNear) {
    startAt(-80, 1);
    const types::Range near = answerTo(lookingDown(0.6));
    EXPECT_EQ(near.range, types::Range::too_near);
    EXPECT_FALSE(near.isKnown());
    ros::Range message;
    ros::convert(near, "sonar", message);
    EXPECT_EQ(message.range, -std::numeric_limits<float>::infinity()) << "REP 117";
    types::Range again;
    ros::convert(message, again);
    EXPECT_EQ(again.range, types::Range::too_near);
    EXPECT_NEAR(answerTo(lookingDown(5)).range, 5, 2 * bin);
    EXPECT_TRUE(std::isnan(answerTo(lookingDown(0)).range));
    ros::convert(answerTo(lookingDown(0)), "sonar", message);
    EXPECT_EQ(message.range, std::numeric_limits<float>::infinity());
}

struct SeaProfilerTest : test::TaskBench<ProfilerTask, types::SnapshotPtr, types::PointCloudPtr> {
    SeaProfilerTest() : TaskBench(&ProfilerTask::snapshot, &ProfilerTask::soundings) {}
};

TEST_F(SeaProfilerTest, SoundingsAreOnTheBottomOrNowhere) {
    for (const double volume_db : {-90.0, -65.0}) {
        ProfilerConfig config;
        putToSea(volume_db, config.sonar);
        config.sonar.beam_count = 11;
        config.sonar.field_of_view_deg = 44;
        config.sonar.beam_height_deg = 2;
        config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 16;
        task_.stop();
        task_.cleanup();
        startWith(config);
        const auto cloud = answerTo(lookingDown(40));
        ASSERT_TRUE(cloud);
        ASSERT_EQ(cloud->points.size(), 11u) << volume_db << " dB";
        for (const auto& point : cloud->points) EXPECT_NEAR(point.z, -40, 5 * bin) << volume_db << " dB";
        const auto none = answerTo(lookingDown(0));
        ASSERT_TRUE(none);
        EXPECT_EQ(none->points.size(), 0u) << volume_db << " dB";
    }
}

struct Sea3dTest : test::TaskBench<Sonar3dTask, types::SnapshotPtr, types::DepthMapPtr> {
    Sea3dTest() : TaskBench(&Sonar3dTask::snapshot, &Sonar3dTask::range_image) {}
};

TEST_F(Sea3dTest, RangeImagesShowTheBottomOrNothing) {
    Sonar3dConfig config;
    putToSea(-70, config.sonar);
    config.horizontal = {5, 10};
    config.vertical = {5, 10};
    config.sonar.beam_height_deg = 2;
    startWith(config);
    const auto image = answerTo(lookingDown(40));
    ASSERT_TRUE(image);
    for (size_t row = 0; row < 5; ++row)
        for (size_t column = 0; column < 5; ++column) {
            const double along = image->direction(row, column).x;
            EXPECT_NEAR(image->distances[row * 5 + column] * along, 40, 5 * bin);
        }
    const auto none = answerTo(lookingDown(0));
    for (const float distance : none->distances) EXPECT_EQ(distance, types::DepthMap::too_far);
}

struct SeaSideScanTest : test::TaskBench<SideScanTask, types::SnapshotPtr, types::SonarPtr> {
    SeaSideScanTest() : TaskBench(&SideScanTask::snapshot, &SideScanTask::ping) {}

    /** Returns the range along the ground of the brightest column between 15 and 35 m to port [m]. */
    static double targetIn(const types::Sonar& ping, const types::ReturnRules& returns) {
        output::SideScanPictureConfig config;
        config.width = 1200;
        config.reference_db = -40;
        config.dynamic_range_db = 120;
        config.colour_map = output::ColourMap::Gray;
        config.ground_range.emplace();
        output::SideScanImage image(config);
        image.setReturns(returns);
        types::Image picture;
        image.paint(ping, picture);
        const cv::Rect water = image.water();
        const double per_pixel = 2 * ping.binStart(ping.bin_count) / water.width;
        double brightest = -1, at = 0;
        for (int x = water.x; x < water.x + water.width / 2; ++x) {
            const double ground = (water.x + water.width / 2.0 - x - 0.5) * per_pixel;
            const double level =
                picture.image[static_cast<size_t>(water.y) * picture.row_size + 3 * static_cast<size_t>(x)];
            if (ground > 15 && ground < 35 && level > brightest) brightest = level, at = ground;
        }
        return at;
    }
};

TEST_F(SeaSideScanTest, PicturesAlongTheGroundBeginAtTheBottom) {
    for (const double volume_db : {-90.0, -75.0, -60.0})
        for (const double depth : {5.0, 20.0}) {
            SideScanConfig config;
            putToSea(volume_db, config.sonar);
            config.depression_deg = 50;
            config.sonar.beam_height_deg = 90;  // to the bottom below
            config.sonar.quality.rows = 8;
            config.sonar.quality.columns_per_beam = 2048;
            task_.stop();
            task_.cleanup();
            startWith(config);
            types::Snapshot scene =
                test::makeSnapshot(test::makeScene({test::ground(static_cast<float>(-depth))}, -27));
            scene.targets = {{{0, 25, -depth + 0.5}, -25}};  // weaker than the bottom
            const types::SonarPtr ping = answerTo(std::make_shared<types::Snapshot>(scene));
            ASSERT_TRUE(ping);
            EXPECT_NEAR(targetIn(*ping, makeReturnRules(config.acrossTrack())), 25, 0.5)
                << volume_db << " dB, " << depth << " m";
            EXPECT_GT(std::abs(targetIn(*ping, {}) - 25), 0.4) << "the ring-down, where nothing is known of the sonar";
        }
}

TEST(SeaScanTest, LaserScansAndRangesShowTheWallAndMarkWhatIsTooNear) {
    SonarConfig config;
    putToSea(-70, config);
    config.beam_count = 5;
    config.field_of_view_deg = 20;
    config.beam_height_deg = 2;
    config.quality.rows = config.quality.columns_per_beam = 32;
    const types::Snapshot scene = test::makeSnapshot(test::makeScene({test::wall(30)}, -27));
    SonarRenderer renderer(config, scene.geometry, {.threads = 1});
    types::Sonar ping;
    renderer.render(scene, ping);
    ros::SonarOptions options;
    ros::LaserScan scan;
    convert(ping, options, scan);
    EXPECT_LT(scan.ranges[2], 1) << "the ring-down, where nothing is known of the sonar";
    options.returns = makeReturnRules(config);
    convert(ping, options, scan);
    for (const float range : scan.ranges) EXPECT_NEAR(range, 30.2, 0.6);
    options.range_min = 40;
    convert(ping, options, scan);
    for (const float range : scan.ranges) EXPECT_EQ(range, -std::numeric_limits<float>::infinity());
    EXPECT_EQ(scan.range_min, 40);
    ping.bins.assign(ping.bins.size(), 0);
    convert(ping, options, scan);
    for (const float range : scan.ranges) EXPECT_EQ(range, std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace insonify::sonar
