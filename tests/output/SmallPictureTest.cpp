// Every kind of picture at every width from the min on, of fans and ranges of all sizes: none throws, and no text
// leaves the picture or touches another.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "components/output/maps/ScanMosaic.hpp"
#include "components/output/maps/SoundingMap.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/RangeImage.hpp"
#include "components/output/pictures/SideScanImage.hpp"
#include "components/output/pictures/TruthImage.hpp"
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
    EXPECT_FALSE(showsColourBar(256, 360));
    EXPECT_TRUE(showsColourBar(640, 120));
    EXPECT_TRUE(showsColourBar(256, 20));
}

TEST(SmallPictureTest, TheColourBarIsInAnotherCornerIfTheFanReachesTheFirst) {
    const auto placeOf = [](double right_deg, double left_deg) {
        const FanLayout layout(480, types::radians(right_deg), types::radians(left_deg), 50);
        return cv::Point2d(placeOfBar(layout, widthConfig(480))) * (1.0 / 480);
    };
    EXPECT_LT(placeOf(-10, 10).y, 0.2);
    EXPECT_GT(placeOf(-45, 45).y, 0.4);
    EXPECT_LT(placeOf(-45, 45).x, 0.1);
    EXPECT_GT(placeOf(0, 90).x, 0.8) << "a fan to port";
}

/** What a test draws at random of a fan. */
struct DrawnFan {
    explicit DrawnFan(std::mt19937& random) {
        const auto draw = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
        config.width = static_cast<uint32_t>(draw(256, 1600));
        config.dynamic_range_db = draw(1, 300);
        config.scale = draw(0, 1) < 0.3 ? BinScale::Code : BinScale::Linear;
        config.code_bits = static_cast<int>(draw(1, 33));
        const double width = draw(0, 1) < 0.2 ? 360 : draw(0.1, 359);
        const double middle = draw(0, 1) < 0.6 || width == 360 ? 0 : draw(-180, 180);
        ping = test::emptyPing(width, 50, 20);
        for (types::Angle& bearing : ping.bearings)
            bearing = types::Angle::fromDeg(types::degrees(bearing.rad) + middle);
        ping.speed_of_sound *= std::pow(10, draw(-4, 7)) / 50;
        ping.bins.assign(ping.bins.size(), static_cast<float>(config.maxCode()));
    }
    DisplayConfig config;
    types::Sonar ping;
};

bool isInside(const cv::Rect& box, const cv::Rect& area) { return (box & area) == box; }

TEST(SmallPictureTest, TextsOfAnyFanAreWithinThePictureApartAndReadable) {
    std::mt19937 random(7);
    int bars = 0, plates = 0, unlabelled = 0;
    for (int draw = 0; draw < 100; ++draw) {
        DrawnFan drawn(random);
        drawn.config.colour_map = ColourMap::Gray;
        FanImage fan(drawn.config);
        types::Image picture;
        fan.paint(drawn.ping, picture);
        const cv::Mat pixels = test::toPixels(picture);
        const std::vector<cv::Rect>& texts = fan.overlay().taken();
        SCOPED_TRACE(testing::Message() << draw << ": " << pixels.cols << " pixels");
        for (size_t i = 0; i < texts.size(); ++i) {
            ASSERT_TRUE(isInside(texts[i], {{}, pixels.size()})) << texts[i];
            for (size_t j = 0; j < i; ++j) ASSERT_EQ((texts[i] & texts[j]).area(), 0) << texts[i] << texts[j];
            if (!fan.layout().reaches(texts[i])) continue;
            double darkest = 0;
            cv::minMaxLoc(pixels(texts[i]).clone().reshape(1), &darkest);
            EXPECT_LT(darkest, 70) << "white text on white echoes " << texts[i];
            ++plates;
        }
        const bool has_bar = !fan.bar().empty();
        size_t on_bar = 0;
        for (const cv::Rect& text : texts) on_bar += isInside(text, fan.bar()) ? 1 : 0;
        bars += has_bar;
        EXPECT_TRUE(!has_bar || on_bar >= 3) << "the bar and two labels";
        EXPECT_GE(texts.size() - on_bar, 2u) << "title and a label";
        unlabelled += texts.size() - on_bar < 3 ? 1 : 0;
    }
    EXPECT_GT(bars, 50);
    EXPECT_GT(plates, 20);
    EXPECT_LT(unlabelled, 3) << "without a range or a bearing: none of the round bearings is in a narrow fan";
}

/** Checks that no pixel at the edge of a picture is as bright as text. */
void expectFreeEdge(const types::Image& picture, const std::string& name) {
    const cv::Mat pixels = test::toPixels(picture);
    for (const cv::Mat& edge :
         {pixels.row(0), pixels.row(pixels.rows - 1), pixels.col(0), pixels.col(pixels.cols - 1)}) {
        double brightest = 0;
        cv::minMaxLoc(edge.clone().reshape(1), nullptr, &brightest);
        EXPECT_LT(brightest, 60) << name << " " << pixels.cols << " x " << pixels.rows;
    }
}

TEST(SmallPictureTest, NoTextIsCutAtTheEdgeOfAnyPicture) {
    std::mt19937 random(11);
    for (int draw = 0; draw < 40; ++draw) {
        DrawnFan drawn(random);
        drawn.ping.bins.assign(drawn.ping.bins.size(), 0);
        drawn.ping.time = types::Time::fromSeconds(std::pow(10, draw % 10));
        types::Image picture;
        FanImage(drawn.config).paint(drawn.ping, picture);
        expectFreeEdge(picture, "fan");
        WaterfallImage(drawn.config).paint(drawn.ping, picture);
        expectFreeEdge(picture, "waterfall");
        SideScanPictureConfig side;
        static_cast<DisplayConfig&>(side) = drawn.config;
        SideScanImage(side).paint(drawn.ping, picture);
        expectFreeEdge(picture, "side-scan");
        SoundingMap chart(drawn.config.width, ColourMap::Gray);
        auto cloud = std::make_shared<types::PointCloud>();
        cloud->points = {{0, 0, -1}, {std::pow(10, draw % 7), -std::pow(10, draw % 5), std::pow(10, draw % 4)}};
        chart.add(cloud);
        chart.paint(picture);
        expectFreeEdge(picture, "chart");
    }
}

/** Returns where two pictures of one size differ. */
cv::Rect findDifference(const cv::Mat& a, const cv::Mat& b) {
    EXPECT_EQ(a.size(), b.size());
    std::vector<cv::Mat> channels;
    cv::split(a != b, channels);
    return cv::boundingRect(channels[0] | channels[1] | channels[2]);
}

TEST(SmallPictureTest, AgesOfAWaterfallReachFromTopToBottomBesideIt) {
    for (const double between : {0.01, 0.5, 60.0, 3600.0, 86400.0}) {
        cv::Mat drawn[2];
        cv::Rect water;
        for (int aged = 0; aged < 2; ++aged) {
            WaterfallImage waterfall(test::grayPicture(300));
            types::Image picture;
            for (int i = WaterfallImage::history; i >= 0; --i) {
                types::Sonar ping = test::emptyPing(3, 1);
                ping.time = types::Time::fromSeconds(1e8 - (aged ? i * between : 0));
                i > 0 ? waterfall.skip(ping) : waterfall.paint(ping, picture);
            }
            drawn[aged] = test::toPixels(picture), water = waterfall.water();
        }
        const cv::Rect ages = findDifference(drawn[0], drawn[1]);
        EXPECT_GE(ages.x, 2) << between;
        EXPECT_LE(ages.br().x, water.x - 4) << between;
        EXPECT_LT(ages.y, water.y + 70) << between;
        EXPECT_GT(ages.br().y, water.y + 420) << between;
    }
}

TEST(SmallPictureTest, ShowsTheLevelOfWhiteAtTheMinWidth) {
    cv::Mat drawn[2];
    for (int i = 0; i < 2; ++i) {
        DisplayConfig config = widthConfig(256);
        config.reference_db = i == 0 ? -15 : -18;
        types::Image picture;
        FanImage(config).paint(test::emptyPing(60, 7), picture);
        drawn[i] = test::toPixels(picture);
    }
    const cv::Rect level = findDifference(drawn[0], drawn[1]);
    EXPECT_GT(level.x, 100);
    EXPECT_LT(level.br().y, FanLayout::title_height);
}

TEST(SmallPictureTest, LongNamesOfObjectsStayBesideTheFan) {
    cv::Mat drawn[2];
    types::Sonar ping = test::emptyPing(90, 20);
    ping.bins.assign(ping.bins.size(), 1);
    for (int i = 0; i < 2; ++i) {
        types::SonarTruth truth;
        truth.copyGrid(ping);
        for (int32_t object = 0; object < 30; ++object) {
            truth.objects.push_back(std::string(i == 0 ? 3 : 70, 'w'));
            truth.object[static_cast<size_t>(object)] = object;
        }
        TruthImage image(widthConfig(1000));
        image.setTruth(truth);
        types::Image picture;
        image.paint(ping, picture);
        drawn[i] = test::toPixels(picture);
    }
    const cv::Rect names = findDifference(drawn[0], drawn[1]);
    EXPECT_GT(names.width, 40);
    EXPECT_LE(names.br().x, 500 + 134);
}

TEST(SmallPictureTest, CaptionsAreBelowTheirPictures) {
    types::Image left, right, bare, captioned;
    FanImage(widthConfig(256)).paint(test::emptyPing(360, 7), left);
    FanImage(widthConfig(256)).paint(test::emptyPing(360, 7), right);
    sideBySide({left, "."}, {right, "."}, bare);
    sideBySide({left, std::string(200, 'w')}, {right, "."}, captioned);
    const cv::Rect caption = findDifference(test::toPixels(bare), test::toPixels(captioned));
    EXPECT_GE(caption.y, left.size.height);
    EXPECT_GT(caption.width, 150);
    EXPECT_LE(caption.br().x, 256);
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
