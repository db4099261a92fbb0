#pragma once
#include <cstddef>
#include <string_view>

namespace insonify::scene {

/** Bytes that isPngOrJpeg() looks at. */
inline constexpr size_t picture_mark_size = 8;

/** Whether a picture is PNG or JPEG, by its first bytes: stb_image would read more, by decoders that nobody tests. */
inline bool isPngOrJpeg(std::string_view begin) {
    return begin.starts_with("\x89PNG\r\n\x1a\n") || begin.starts_with("\xff\xd8\xff");
}

}  // namespace insonify::scene
