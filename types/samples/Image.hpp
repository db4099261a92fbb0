#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "types/Time.hpp"

namespace insonify::types {

/** The values of Rock that are written or shown here. A log, where an enum is an int32, may contain others. */
enum class ImageMode : int32_t { Undefined = 0, Grayscale = 1, Rgb = 2, Bgr = 4 };
enum class ImageStatus : int32_t { Empty = 0, Valid = 1, Invalid = 2 };

struct ImageAttribute {
    static constexpr const char* type_name = "/base/samples/frame/frame_attrib_t";
    std::string data;
    std::string name;
    static void describe(auto& self, auto& visit) {
        visit({"data_", "", "value"}, self.data);
        visit({"name_", "", "key"}, self.name);
    }
};

struct ImageSize {
    static constexpr const char* type_name = "/base/samples/frame/frame_size_t";
    uint16_t width = 0;
    uint16_t height = 0;
    static void describe(auto& self, auto& visit) {
        visit({"width", "1", "pixels in a row"}, self.width);
        visit({"height", "1", "rows"}, self.height);
    }
};

/** A picture, field for field Rock's base::samples::frame::Frame. Rows from top to bottom, row_size bytes each. */
struct Image {
    static constexpr const char* type_name = "/base/samples/frame/Frame";
    static constexpr bool shared = true;

    Time time;
    Time received_time;
    std::vector<uint8_t> image;
    std::vector<ImageAttribute> attributes;
    ImageSize size;
    uint32_t data_depth = 8;
    uint32_t pixel_size = 0;
    uint32_t row_size = 0;
    ImageMode frame_mode = ImageMode::Undefined;
    ImageStatus frame_status = ImageStatus::Empty;

    /** Returns whether `image` contains `size` pixels of pixel_size bytes, in rows of row_size; false for JPEG and
     *  PNG. */
    bool holdsPixels() const {
        return row_size >= uint64_t{size.width} * pixel_size && image.size() >= uint64_t{size.height} * row_size;
    }

    void forEachStamp(auto&& visit) { visit(received_time); }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the picture was true in the world"}, self.time);
        visit({"received_time", "us", "when it reached this system"}, self.received_time);
        visit({"image", "1", "pixels"}, self.image);
        visit({"attributes", "", "keys and values"}, self.attributes);
        visit({"size", "1", "width and height"}, self.size);
        visit({"data_depth", "bit", "effective bits per channel"}, self.data_depth);
        visit({"pixel_size", "B", "size of a pixel"}, self.pixel_size);
        visit({"row_size", "B", "size of a row"}, self.row_size);
        visit({"frame_mode", "1", "1 grey, 2 RGB, 4 BGR, others as in Rock"}, self.frame_mode);
        visit({"frame_status", "1", "0 empty, 1 valid, 2 invalid"}, self.frame_status);
    }
};
using ImagePtr = std::shared_ptr<const Image>;

/** Name and symbols of each enum, as the log's registry lists them. */
template <>
struct EnumTable<ImageMode> {
    static constexpr const char* name = "/base/samples/frame/frame_mode_t";
    static constexpr EnumSymbol symbols[] = {
        {"MODE_UNDEFINED", 0},     {"MODE_GRAYSCALE", 1},    {"MODE_RGB", 2},          {"MODE_UYVY", 3},
        {"MODE_BGR", 4},           {"MODE_RGB32", 5},        {"RAW_MODES", 128},       {"MODE_BAYER", 128},
        {"MODE_BAYER_RGGB", 129},  {"MODE_BAYER_GRBG", 130}, {"MODE_BAYER_BGGR", 131}, {"MODE_BAYER_GBRG", 132},
        {"COMPRESSED_MODES", 256}, {"MODE_PJPG", 257},       {"MODE_JPEG", 258},       {"MODE_PNG", 259}};
};
template <>
struct EnumTable<ImageStatus> {
    static constexpr const char* name = "/base/samples/frame/frame_status_t";
    static constexpr EnumSymbol symbols[] = {{"STATUS_EMPTY", 0}, {"STATUS_VALID", 1}, {"STATUS_INVALID", 2}};
};

}  // namespace insonify::types
