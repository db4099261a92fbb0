#include "components/scene/SdfHeightmap.hpp"

#include <fmt/format.h>
#include <stb_image.h>

#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "components/scene/PictureFormat.hpp"

namespace insonify::scene {
namespace {

constexpr int max_picture_side = 32768;  ///< Larger pictures are refused before they are decoded [pixels].
constexpr int max_corners = 2049;        ///< Along each side.

/** Pixels of one side that become corners: evenly apart, with both ends. */
std::vector<int> cornersOf(int pixels) {
    const int count = std::min(pixels, max_corners);
    std::vector<int> corners;
    for (int i = 0; i < count; ++i) corners.push_back(static_cast<int>(int64_t{i} * (pixels - 1) / (count - 1)));
    return corners;
}

bool isRead(const std::filesystem::path& file) {
    std::string begin(picture_mark_size, '\0');
    std::ifstream(file, std::ios::binary).read(begin.data(), picture_mark_size);
    return isPngOrJpeg(begin) || begin.starts_with("P5");
}

}  // namespace

Surface readHeightmap(const std::filesystem::path& file, glm::dvec3 size) {
    int width = 0, height = 0, channels = 0;
    if (!isRead(file) || !stbi_info(file.c_str(), &width, &height, &channels))
        throw std::runtime_error("is neither PNG nor JPEG nor PGM");
    if (width < 2 || height < 2 || width > max_picture_side || height > max_picture_side)
        throw std::runtime_error(
            fmt::format("has {} x {} pixels; may have 2 to {} a side", width, height, max_picture_side));
    const std::unique_ptr<stbi_us, decltype(&stbi_image_free)> pixels(
        stbi_load_16(file.c_str(), &width, &height, &channels, 1), stbi_image_free);
    if (!pixels) throw std::runtime_error(fmt::format("is damaged ({})", stbi_failure_reason()));

    const std::vector<int> columns = cornersOf(width), rows = cornersOf(height);
    Surface surface;
    for (const int row : rows)
        for (const int column : columns) {
            const double value = pixels.get()[size_t(row) * size_t(width) + size_t(column)] / 65535.0;
            surface.positions.emplace_back(
                size * glm::dvec3(double(column) / (width - 1) - 0.5, 0.5 - double(row) / (height - 1), value));
        }
    forEachCell(columns.size(), rows.size(), [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        surface.indices.insert(surface.indices.end(), {a, c, d, a, d, b});
    });
    return surface;
}

}  // namespace insonify::scene
