#include <gtest/gtest.h>

#include <limits>

#include "components/output/tasks/SamplePictureTask.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::output {
namespace {

types::PointCloudPtr makeCloud(std::vector<glm::dvec3> points, int64_t time = 1'000'000) {
    auto cloud = std::make_shared<types::PointCloud>();
    cloud->time = {time};
    for (const glm::dvec3& point : points) cloud->add(point, 1);
    return cloud;
}

cv::Vec3b colourAt(const types::Image& picture, cv::Point at) { return test::toPixels(picture).at<cv::Vec3b>(at); }

TEST(SoundingMapTest, NorthIsUpWestIsLeftAndTheHighestPointIsBrightest) {
    SoundingMap map(600, ColourMap::Gray);
    map.add(makeCloud({{0, 0, -10}, {20, 0, -6}, {0, 20, -8}}));
    types::Image picture;
    map.paint(picture);
    EXPECT_EQ(picture.time.microseconds, 1'000'000);
    EXPECT_LT(map.pixel(20, 0).y, map.pixel(0, 0).y);
    EXPECT_LT(map.pixel(0, 20).x, map.pixel(0, 0).x);
    EXPECT_EQ(colourAt(picture, map.pixel(20, 0))[1], 255);
    EXPECT_NEAR(colourAt(picture, map.pixel(0, 20))[1], 127, 1);
    EXPECT_EQ(colourAt(picture, map.pixel(0, 0))[1], 0);
}

TEST(SoundingMapTest, DrawsPointsThatAreNotFiniteAndNoPoints) {
    SoundingMap map(301, ColourMap::Turbo);
    types::Image picture;
    map.paint(picture);
    EXPECT_EQ(picture.size.width, 302);
    map.add(makeCloud({}));
    map.add(makeCloud({{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {1, 2, -3}}));
    map.paint(picture);
    EXPECT_TRUE(picture.holdsPixels());
}

TEST(SoundingMapTest, ForgetsOldPoints) {
    SoundingMap map(600, ColourMap::Gray);
    types::Image picture;
    map.add(makeCloud({{1e6, 1e6, 0}}));
    for (size_t i = 0; i < SoundingMap::history; ++i) map.add(makeCloud({{0, 0, -1}, {10, 10, 0}}));
    map.paint(picture);
    EXPECT_GT(map.pixel(0, 0).x - map.pixel(0, 10).x, 100) << "the chart fits the points that are left";
}

TEST(SoundingMapTest, TheTitleNamesTheDatum) {
    SoundingMap map(1000, ColourMap::Gray);
    map.add(makeCloud({{0, 0, -10}, {20, 0, -6}}));
    types::Image bare, placed;
    map.paint(bare);
    map.setDatum(types::Datum{54.5, 10.25, 40});
    map.paint(placed);
    ASSERT_EQ(bare.size.height, placed.size.height);
    const cv::Mat changed = test::toPixels(bare) != test::toPixels(placed);
    EXPECT_GT(cv::countNonZero(changed.reshape(1)), 100);
    const cv::Mat below = changed.rowRange(changed.rows / 2, changed.rows);
    EXPECT_EQ(cv::countNonZero(below.clone().reshape(1)), 0) << "a title is at the top";
}

TEST(SoundingMapTest, MakesAPictureForEveryFewClouds) {
    SoundingMapTask task("chart");
    SoundingMapConfig config;
    config.every = 3;
    config.width = 256;
    task.config.set(config);
    test::Writer<types::PointCloudPtr> clouds;
    test::Reader<types::ImagePtr> pictures;
    clouds.port.connectTo(task.input, framework::ConnPolicy::buffer(8));
    task.image.connectTo(pictures.port, framework::ConnPolicy::buffer(8));
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    types::ImagePtr picture;
    for (int64_t i = 1; i <= 6; ++i) {
        clouds.port.write(makeCloud({{0, 0, -1}, {10, 5, -2}}, i));
        task.update();
        ASSERT_EQ(pictures.port.readNew(picture), i % 3 == 0) << i;
    }
    EXPECT_EQ(picture->time.microseconds, 6);
    EXPECT_EQ(picture->size.width, 256);
}

}  // namespace
}  // namespace insonify::output
