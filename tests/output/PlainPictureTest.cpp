#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <set>

#include "components/output/pictures/PlainPicture.hpp"
#include "tests/support/Pings.hpp"

namespace insonify::output {
namespace {

using test::emptyPing;
using test::withEcho;

PlainConfig getConfig(PlainShape shape, uint32_t height) {
    PlainConfig config;
    config.shape = shape;
    config.height = height;
    config.reference_db = 0;
    return config;
}

PlainPicture makePicture(const types::Sonar& ping, const PlainConfig& config) {
    PlainPicture picture(config);
    picture.take(ping);
    return picture;
}

/** Returns the middle of the pixels that are not black, {column, row}. */
cv::Point2d middle(const types::Image& picture) {
    cv::Point2d sum;
    double count = 0;
    for (int y = 0; y < picture.size.height; ++y)
        for (int x = 0; x < picture.size.width; ++x)
            if (picture.image[static_cast<size_t>(y) * picture.row_size + static_cast<size_t>(x)])
                sum += cv::Point2d(x, y), ++count;
    return sum / count;
}

TEST(PlainPictureTest, AFanHasOnlyWaterAheadIsUpAndPortIsLeft) {
    const types::Sonar empty = emptyPing(120, 121);
    const PlainConfig config = getConfig(PlainShape::Fan, 100);
    const PlainPicture nothing = makePicture(empty, config);
    EXPECT_THAT(nothing.image().image, testing::Each(0));
    EXPECT_EQ(nothing.height(), 100u);
    for (const uint32_t beam : {10u, 60u, 110u}) {
        const double bearing = empty.bearings[beam].rad;
        const cv::Point2d at = middle(makePicture(withEcho(empty, beam, 80), config).image());
        EXPECT_NEAR(at.x, nothing.width() / 2.0 - 0.5 - 80.5 * std::sin(bearing), 1) << beam;
        EXPECT_NEAR(at.y, 99.5 - 80.5 * std::cos(bearing), 1) << beam;
    }
}

/** Codes that rise evenly over beams and bins are met exactly between the cells; labels stay those of the nearest. */
TEST(PlainPictureTest, ASmoothFanIsInterpolatedBetweenBeamsAndBins) {
    types::Sonar ping = emptyPing(40, 17);
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        for (uint32_t bin = 0; bin < ping.bin_count; ++bin)
            ping.bins[beam * ping.bin_count + bin] = static_cast<float>(20 + 6 * beam + bin);
    PlainConfig config = getConfig(PlainShape::Fan, 300);
    config.reference_db.reset();
    config.scale = BinScale::Code;
    const PlainPicture nearest = makePicture(ping, config);
    config.smooth = true;
    const PlainPicture picture = makePicture(ping, config);
    EXPECT_EQ(picture.cells(), nearest.cells());
    const types::Image image = picture.image();
    const types::BeamArc& arc = picture.arc();
    size_t seen = 0;
    for (uint32_t y = 0; y < picture.height(); ++y)
        for (uint32_t x = 0; x < picture.width(); ++x) {
            const double ahead = 299.5 - y, port = picture.width() / 2.0 - 0.5 - x;
            const double place = (std::atan2(port, ahead) - arc.bearings.front()) /
                                 (arc.bearings.back() - arc.bearings.front()) * (ping.beam_count - 1);
            const double bin = std::hypot(ahead, port) / 300 * ping.bin_count - 0.5;
            if (place < 0 || place > ping.beam_count - 1 || bin < 0 || bin > ping.bin_count - 1) continue;
            const double beam = arc.beams.front() == 0 ? place : ping.beam_count - 1 - place;
            EXPECT_NEAR(image.image[size_t{y} * image.row_size + x], 20 + 6 * beam + bin, 0.52) << x << ", " << y;
            ++seen;
        }
    EXPECT_GT(seen, 10000u);
    config.shape = PlainShape::Polar;
    types::Diagnostics diagnostics;
    config.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_THAT(diagnostics[0].message, testing::HasSubstr("only a fan has others"));
}

TEST(PlainPictureTest, APolarPictureHasAPixelForEachBin) {
    const types::Sonar empty = emptyPing(120, 121);
    const PlainPicture picture = makePicture(withEcho(empty, 110, 80), getConfig(PlainShape::Polar, 100));
    EXPECT_EQ(picture.width(), 121u);
    EXPECT_EQ(picture.height(), 100u);
    EXPECT_EQ(middle(picture.image()), cv::Point2d(10, 19));
    EXPECT_EQ(picture.findPixel(110, 80), cv::Point(10, 19));
}

TEST(PlainPictureTest, FinerBinsShareACellThatShowsTheirMean) {
    const types::Sonar empty = emptyPing(120, 4);
    const PlainPicture picture = makePicture(withEcho(empty, 2, 99), getConfig(PlainShape::Polar, 32));
    EXPECT_EQ(picture.binsPerCell(), 4u);
    EXPECT_EQ(picture.cellsPerBeam(), 25u);
    const double mean = static_cast<double>(withEcho(empty, 2, 99).bins[2 * 100 + 99]) / 4;
    EXPECT_NEAR(picture.levels()[2 * 25 + 24], std::clamp(255 + 10 * std::log10(mean) * 255 / 50, 0.0, 255.0), 1);
}

TEST(PlainPictureTest, MapsPixelsToCellsAndCellsToPixels) {
    const types::Sonar ping = emptyPing(130, 64);
    for (const PlainShape shape : {PlainShape::Fan, PlainShape::Polar}) {
        const PlainPicture picture = makePicture(ping, getConfig(shape, 200));
        const auto count = static_cast<int32_t>(64 * picture.cellsPerBeam());
        for (const int32_t cell : picture.cells()) EXPECT_LT(cell, count);
        for (int32_t cell = count / 4; cell < count; cell += 97) {
            const auto cells = static_cast<int32_t>(picture.cellsPerBeam());
            if (cell % cells < cells / 3) continue;  // nearer, a pixel of a fan shows one of several beams
            const cv::Point at =
                picture.findPixel(static_cast<uint32_t>(cell / cells), static_cast<uint32_t>(cell % cells));
            const int32_t shown =
                picture.cells()[static_cast<size_t>(at.y) * picture.width() + static_cast<size_t>(at.x)];
            EXPECT_LE(std::abs(shown / cells - cell / cells), 1) << cell;
            EXPECT_LE(std::abs(shown % cells - cell % cells), 1) << cell;
        }
    }
}

/** Lines whose sides are in either order, with only a port side, or without one. */
TEST(PlainPictureTest, AWaterfallHasARowForEachLineTheNewestOnTopAndPortLeft) {
    const double sides[][2] = {{-90, 90}, {90, -90}, {60, 60}, {-80, -80}};  // [deg]; equal: one beam a line
    for (const auto& [first, second] : sides) {
        constexpr uint32_t lines = 7, bins = 50;
        const bool is_pair = first != second;
        types::Sonar run = emptyPing(120, is_pair ? 2 * lines : lines, bins);
        for (uint32_t beam = 0; beam < run.beam_count; ++beam)
            run.bearings[beam] = types::Angle::fromDeg(beam % 2 == 0 ? first : second);
        for (uint32_t beam = 0; beam < run.beam_count; ++beam) {
            const PlainPicture picture = makePicture(withEcho(run, beam, 11), getConfig(PlainShape::Waterfall, 100));
            ASSERT_EQ(picture.height(), lines);
            ASSERT_EQ(picture.width(), is_pair ? 2 * bins : bins);
            const double bearing = beam % 2 == 0 ? first : second;
            const uint32_t line = is_pair ? beam / 2 : beam, port = is_pair || bearing > 0 ? bins : 0;
            const double column = bearing > 0 ? bins - 1 - 11 : port + 11;
            EXPECT_EQ(middle(picture.image()), cv::Point2d(column, lines - 1 - line)) << first << " " << beam;
            EXPECT_EQ(picture.findPixel(beam, 11),
                      cv::Point(static_cast<int>(column), static_cast<int>(lines - 1 - line)));
        }
    }
}

TEST(PlainPictureTest, GroupsAreCellsThatTouchForAnyOrderOfBeams) {
    const types::Sonar ping = emptyPing(120, 30, 40);
    const std::vector<std::pair<uint32_t, uint32_t>> chosen = {{3, 5}, {4, 6}, {5, 6}, {20, 30}, {22, 30}};
    for (const uint32_t step : {1u, 7u, 11u}) {  // beam k of the fan is beam k * step % 30 of the ping
        types::Sonar shuffled = ping;
        for (uint32_t beam = 0; beam < 30; ++beam) shuffled.bearings[beam * step % 30] = ping.bearings[beam];
        const PlainPicture picture = makePicture(shuffled, getConfig(PlainShape::Fan, 100));
        std::vector<uint8_t> cells(size_t{30} * picture.cellsPerBeam(), 0);
        const auto at = [&](size_t i) {
            return size_t{chosen[i].first * step % 30} * picture.cellsPerBeam() + chosen[i].second;
        };
        for (size_t i = 0; i < chosen.size(); ++i) cells[at(i)] = 1;
        const std::vector<int32_t> groups = picture.groupBy(cells);
        EXPECT_EQ(std::ranges::count(groups, 0), static_cast<long>(groups.size() - chosen.size()));
        EXPECT_EQ(groups[at(0)], groups[at(1)]) << "they touch at a corner";
        EXPECT_EQ(groups[at(1)], groups[at(2)]);
        EXPECT_EQ((std::set{groups[at(0)], groups[at(3)], groups[at(4)]}), (std::set{1, 2, 3}));
    }
}

TEST(PlainPictureTest, ScalesEachPingIndependently) {
    const types::Sonar loud = withEcho(emptyPing(120, 31), 3, 50);
    types::Sonar faint = loud;
    for (float& bin : faint.bins) bin *= 1e-6f;
    PlainConfig config = getConfig(PlainShape::Fan, 64);
    config.reference_db.reset();
    PlainPicture both(config);
    both.take(loud);
    both.take(faint);
    EXPECT_EQ(both.image().image, makePicture(faint, config).image().image);
    EXPECT_NEAR(both.referenceDb(), makePicture(loud, config).referenceDb() - 60, 1e-4);
}

TEST(PlainPictureTest, RefusesAPingWithoutBins) {
    EXPECT_THROW(makePicture(types::Sonar{}, getConfig(PlainShape::Fan, 100)), std::runtime_error);
}

TEST(PlainPictureTest, GroupsOfAFullCircleTouchAcrossItsSeam) {
    for (const double view_deg : {360.0, 300.0}) {
        const PlainPicture picture = makePicture(emptyPing(view_deg, 36, 40), getConfig(PlainShape::Fan, 100));
        std::vector<uint8_t> chosen(size_t{36} * picture.cellsPerBeam(), 0);
        const auto at = [&](size_t beam, size_t cell) { return beam * picture.cellsPerBeam() + cell; };
        for (const size_t cell : {at(0, 5), at(35, 6), at(18, 5), at(34, 6), at(0, 20)}) chosen[cell] = 1;
        const std::vector<int32_t> groups = picture.groupBy(chosen);
        EXPECT_EQ(groups[at(0, 5)] == groups[at(35, 6)], view_deg == 360);
        EXPECT_EQ(groups[at(34, 6)], groups[at(35, 6)]);
        std::set<int32_t> all(groups.begin(), groups.end());
        EXPECT_EQ(*all.rbegin(), static_cast<int32_t>(all.size()) - 1) << "numbers without gaps";
    }
}

}  // namespace
}  // namespace insonify::output
