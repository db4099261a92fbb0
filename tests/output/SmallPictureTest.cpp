// Every kind of picture at every width from the min on, of fans and ranges of all sizes: none throws.
#include <gtest/gtest.h>

#include "components/output/maps/ScanMosaic.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/WaterfallImage.hpp"
#include "components/output/tasks/PictureTask.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::output {
namespace {

constexpr double fields_of_view[] = {0.1, 1, 20, 60, 90, 120, 130, 150, 179.9, 180, 181, 270, 359, 360};
constexpr double ranges[] = {0, 1e-3, 0.7, 50, 3e4, 1e9};

/** Returns pings whose ranges cycle with the widths, so that every width meets every fan, and each fan every range. */
types::Sonar makePing(double field_of_view, size_t number) {
    types::Sonar ping = test::emptyPing(field_of_view, 7, 20);
    ping.speed_of_sound *= ranges[number % std::size(ranges)] / 50;
    return ping;
}

DisplayConfig widthConfig(uint32_t width) {
    DisplayConfig config;
    config.width = width;
    return config;
}

template <class Picture>
void expectPictures(uint32_t width, int expected_width, size_t& number) {
    for (const double field_of_view : fields_of_view) {
        SCOPED_TRACE(testing::Message() << width << " pixels, " << field_of_view << " degrees, number " << number);
        Picture painter(widthConfig(width));
        types::Image picture;
        ASSERT_NO_THROW(painter.paint(makePing(field_of_view, number++), picture));
        EXPECT_EQ(picture.size.width, expected_width);
        EXPECT_EQ(picture.image.size(), size_t{3} * picture.size.width * picture.size.height);
    }
}

int even(uint32_t width) { return static_cast<int>(width + width % 2); }

TEST(SmallPictureTest, DrawsEveryWidthFanAndRange) {
    size_t number = 0;
    for (uint32_t width = 256; width < 320; ++width) {
        expectPictures<FanImage>(width, even(width), number);
        expectPictures<WaterfallImage>(width, even(width), number);
        if (width % 4 == 0) expectPictures<DiscImage>(width, even(width), number);
    }
    for (const uint32_t width : {400u, 777u, 1024u}) {
        expectPictures<FanImage>(width, even(width), number);
        expectPictures<WaterfallImage>(width, even(width), number);
    }
    for (const uint32_t width : {512u, 513u, 514u, 515u, 530u, 640u})
        expectPictures<ScanMosaic>(width, 2 * even(width / 2), number);
}

TEST(SmallPictureTest, DrawsEveryDynamicRangeSmall) {
    types::Image picture;
    for (const double dynamic_range : {1.0, 3.0, 40.0, 299.0, 300.0}) {
        DisplayConfig config = widthConfig(256);
        config.dynamic_range_db = dynamic_range;
        EXPECT_NO_THROW(FanImage(config).paint(test::emptyPing(360, 7), picture)) << dynamic_range;
        EXPECT_NO_THROW(WaterfallImage(config).paint(test::emptyPing(360, 7), picture)) << dynamic_range;
    }
}

/** Returns whether the brightest colour is at the start of the colour bar. */
bool showsColourBar(uint32_t width, double field_of_view) {
    DisplayConfig config = widthConfig(width);
    config.colour_map = ColourMap::Gray;
    types::Image picture;
    FanImage(config).paint(test::emptyPing(field_of_view, 7), picture);
    return test::toPixels(picture).at<cv::Vec3b>(FanLayout::title_height + 19, 16)[1] > 200;
}

TEST(SmallPictureTest, OmitsTheColourBarIfItDoesNotFit) {
    EXPECT_FALSE(showsColourBar(256, 120));
    EXPECT_FALSE(showsColourBar(280, 180));
    EXPECT_TRUE(showsColourBar(320, 120));
    EXPECT_TRUE(showsColourBar(256, 60));
}

/** Draws nothing: OpenCV refuses. */
struct RefusedPicture final : Painter {
    explicit RefusedPicture(const DisplayConfig& /*config*/) {}
    void paint(const types::Sonar& /*ping*/, types::Image& /*picture*/) override { cv::Mat(2, 2, CV_8U).row(5); }
};

TEST(SmallPictureTest, ReportsErrorsOfOpenCvInPlainWords) {
    PingPictureTask<RefusedPicture> task("fan");
    test::Writer<types::SonarPtr> in;
    test::Reader<types::ImagePtr> out;
    in.port.connectTo(task.ping, {});
    task.image.connectTo(out.port, {});
    ASSERT_TRUE(task.configure() && task.start());
    in.port.write(std::make_shared<const types::Sonar>(test::emptyPing(120, 7, 100)));
    task.update();
    EXPECT_EQ(task.state(), framework::TaskState::Exception);
    const std::string part =
        "cannot draw 7 beams x 100 bins to 49.95 m in a picture 1024 pixels wide; try another `width` (OpenCV: ";
    EXPECT_NE(task.lastError().find(part), std::string::npos) << task.lastError();
}

}  // namespace
}  // namespace insonify::output
