#include <gtest/gtest.h>

#include "components/output/tasks/SamplePictureTask.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::output {
namespace {

types::DepthMapPtr smallMap() {
    auto map = std::make_shared<types::DepthMap>();
    map->time = {1'000'000};
    map->vertical_size = 2;
    map->horizontal_size = 3;
    map->vertical_interval = {-0.2, 0.2};
    map->horizontal_interval = {0.5, 0, -0.5};
    map->distances = {2, 6, types::DepthMap::too_far, 10, 2, 2};
    return map;
}

/** Returns the level in the middle of a cell. */
int cellLevel(const types::Image& picture, const cv::Rect& cells, int row, int column) {
    const cv::Point at(cells.x + cells.width * (2 * column + 1) / 6, cells.y + cells.height * (2 * row + 1) / 4);
    return test::toPixels(picture).at<cv::Vec3b>(at)[1];
}

TEST(RangeImageTest, TheNearestIsBrightestAndNoReturnIsBlack) {
    RangeImage image(400, ColourMap::Gray);
    image.add(smallMap());
    types::Image picture;
    image.paint(picture);
    EXPECT_EQ(picture.time.microseconds, 1'000'000);
    EXPECT_EQ(cellLevel(picture, image.cells(), 0, 0), 255);
    EXPECT_NEAR(cellLevel(picture, image.cells(), 0, 1), 127, 1);
    EXPECT_EQ(cellLevel(picture, image.cells(), 0, 2), 0);
    EXPECT_EQ(cellLevel(picture, image.cells(), 1, 0), 0) << "the farthest";
    EXPECT_EQ(cellLevel(picture, image.cells(), 1, 2), 255);
}

TEST(RangeImageTest, DrawsAnEmptyMapAndAMapWithoutReturns) {
    RangeImage image(256, ColourMap::Turbo);
    types::Image picture;
    image.paint(picture);
    EXPECT_EQ(picture.size.width, 256);
    auto silent = std::make_shared<types::DepthMap>(*smallMap());
    silent->distances.assign(6, types::DepthMap::too_far);
    image.add(silent);
    image.paint(picture);
    EXPECT_TRUE(picture.holdsPixels());
}

TEST(RangeImageTest, AnInconsistentMapEndsTheTaskWithAReason) {
    RangeImageTask task("image");
    test::Writer<types::DepthMapPtr> maps;
    test::Reader<types::ImagePtr> pictures;
    maps.port.connectTo(task.input, framework::ConnPolicy::buffer(2));
    task.image.connectTo(pictures.port, framework::ConnPolicy::buffer(2));
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    auto broken = std::make_shared<types::DepthMap>(*smallMap());
    broken->distances.pop_back();
    maps.port.write(broken);
    task.update();
    EXPECT_EQ(task.state(), framework::TaskState::Exception);
    EXPECT_NE(task.lastError().find("other numbers of distances"), std::string::npos) << task.lastError();
}

}  // namespace
}  // namespace insonify::output
