#include <gmock/gmock.h>

#include "components/ros/Samples.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::ros {
namespace {

types::Image smallPicture(types::ImageMode mode, uint32_t pixel_size) {
    types::Image picture;
    picture.time = {5'000'000};
    picture.size = {2, 2};
    picture.frame_mode = mode;
    picture.pixel_size = pixel_size;
    picture.row_size = 2 * pixel_size + 1;  // a byte of padding
    picture.image.resize(2 * picture.row_size, 7);
    return picture;
}

std::string getRefusal(const types::Image& picture) {
    Image message;
    return test::computeError<std::invalid_argument>([&] { convert(picture, "", message); });
}

TEST(PicturesTest, ConvertsColoursAndGreysToRosEncodingsAndBack) {
    const std::tuple<types::ImageMode, uint32_t, const char*> cases[] = {{types::ImageMode::Grayscale, 1, "mono8"},
                                                                         {types::ImageMode::Grayscale, 2, "mono16"},
                                                                         {types::ImageMode::Rgb, 3, "rgb8"},
                                                                         {types::ImageMode::Bgr, 3, "bgr8"}};
    for (const auto& [mode, pixel_size, encoding] : cases) {
        const types::Image picture = smallPicture(mode, pixel_size);
        Image message;
        convert(picture, "fan", message);
        EXPECT_EQ(message.encoding, encoding);
        EXPECT_EQ(message.step, picture.row_size);
        EXPECT_EQ(message.header, (Header{{5, 0}, "fan"}));
        types::Image again;
        convert(message, again);
        EXPECT_EQ(again.image, picture.image);
        EXPECT_EQ(again.frame_mode, mode);
        EXPECT_EQ(again.size.width, 2);
    }
}

TEST(PicturesTest, RefusesModesWithoutAnEncoding) {
    EXPECT_EQ(getRefusal(smallPicture(types::ImageMode{258}, 1)),
              "a picture of mode 258 with 1 bytes a pixel is not known: mono8, mono16, rgb8 and bgr8 are");
    types::Image picture = smallPicture(types::ImageMode::Bgr, 3);
    picture.image.pop_back();
    EXPECT_EQ(getRefusal(picture), "the picture does not hold the pixels that it announces");
}

}  // namespace
}  // namespace insonify::ros
