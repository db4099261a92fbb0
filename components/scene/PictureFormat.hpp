#pragma once
#include <cstddef>
#include <string_view>

namespace insonify::scene {

/** Number of bytes that isPngOrJpeg() examines. */
inline constexpr size_t picture_mark_size = 8;

/** Returns whether a picture is PNG or JPEG by its first bytes. stb_image would read other formats with untested
 *  decoders. */
inline bool isPngOrJpeg(std::string_view begin) {
    return begin.starts_with("\x89PNG\r\n\x1a\n") || begin.starts_with("\xff\xd8\xff");
}

}  // namespace insonify::scene
