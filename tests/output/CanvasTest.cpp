#include <gtest/gtest.h>

#include "components/output/pictures/Canvas.hpp"

namespace insonify::output {
namespace {

types::Image plainGrey(uint16_t width, uint16_t height, uint8_t level) {
    types::Image picture;
    openCanvas(picture, {width, height}, {1'000'000}).setTo(cv::Scalar::all(level));
    return picture;
}

/** Returns the level in the middle of a row, a few pixels from a column on. */
int greyAt(const types::Image& picture, int row, int column) {
    return picture.image[static_cast<size_t>(row) * picture.row_size + 3 * static_cast<size_t>(column)];
}

TEST(CanvasTest, PlacesPicturesOfDifferentHeightsSideBySide) {
    for (const bool is_left_lower : {true, false}) {
        const types::Image low = plainGrey(300, 100, 200), high = plainGrey(400, 160, 90);
        types::Image picture;
        const types::Image &left = is_left_lower ? low : high, &right = is_left_lower ? high : low;
        sideBySide({left, ""}, {right, ""}, picture);
        EXPECT_EQ(picture.size.width, 700);
        EXPECT_EQ(picture.size.height, 160);
        const int low_column = is_left_lower ? 150 : 550, high_column = is_left_lower ? 500 : 200;
        EXPECT_EQ(greyAt(picture, 50, low_column), 200);
        EXPECT_LT(greyAt(picture, 130, low_column), 60) << "background";
        EXPECT_EQ(greyAt(picture, 130, high_column), 90);
    }
}

}  // namespace
}  // namespace insonify::output
