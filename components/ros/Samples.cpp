#include "components/ros/Samples.hpp"

#include <limits>
#include <stdexcept>

#include "components/ros/Stamps.hpp"

namespace insonify::ros {

namespace {

struct Encoding {
    const char* name;
    types::ImageMode mode;
    uint32_t depth, pixel_size;  ///< [bit], [B]
};
constexpr Encoding encodings[] = {{"mono8", types::ImageMode::Grayscale, 8, 1},
                                  {"mono16", types::ImageMode::Grayscale, 16, 2},
                                  {"rgb8", types::ImageMode::Rgb, 8, 3},
                                  {"bgr8", types::ImageMode::Bgr, 8, 3}};

const Encoding& encodingWhere(const std::string& what, auto&& is) {
    for (const Encoding& encoding : encodings)
        if (is(encoding)) return encoding;
    throw std::invalid_argument(what + " is not known: mono8, mono16, rgb8 and bgr8 are");
}

const Encoding& getEncoding(const types::Image& picture) {
    return encodingWhere(
        "a picture of mode " + std::to_string(static_cast<int>(picture.frame_mode)) + " with " +
            std::to_string(picture.pixel_size) + " bytes a pixel",
        [&](const Encoding& e) { return e.mode == picture.frame_mode && e.pixel_size == picture.pixel_size; });
}

}  // namespace

void convert(const types::Image& picture, const std::string& frame_id, Image& message) {
    message.encoding = getEncoding(picture).name;
    if (!picture.holdsPixels()) throw std::invalid_argument("the picture does not hold the pixels that it announces");
    message.header.stamp = toRos(picture.time);
    message.header.frame_id = frame_id;
    message.height = picture.size.height;
    message.width = picture.size.width;
    message.is_bigendian = 0;
    message.step = picture.row_size;
    message.data.assign(picture.image.begin(), picture.image.begin() + int64_t{picture.size.height} * picture.row_size);
}

void convert(const Image& message, types::Image& picture) {
    const Encoding encoding = encodingWhere("encoding '" + message.encoding + "'",
                                            [&](const Encoding& e) { return e.name == message.encoding; });
    constexpr uint32_t maximum = std::numeric_limits<uint16_t>::max();
    if (message.height > maximum || message.width > maximum)
        throw std::invalid_argument("a picture of more than 65535 rows or columns");
    if (message.is_bigendian && encoding.depth > 8) throw std::invalid_argument("big-endian pixels are not read");
    picture.time = picture.received_time = fromRos(message.header.stamp);
    picture.size = {static_cast<uint16_t>(message.width), static_cast<uint16_t>(message.height)};
    picture.data_depth = encoding.depth;
    picture.pixel_size = encoding.pixel_size;
    picture.row_size = message.step;
    picture.frame_mode = encoding.mode;
    picture.frame_status = types::ImageStatus::Valid;
    picture.attributes.clear();
    picture.image = message.data;
    if (!picture.holdsPixels()) throw std::invalid_argument("the image does not hold the pixels that it announces");
}

}  // namespace insonify::ros
