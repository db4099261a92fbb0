#include "components/meshes/Shapes.hpp"

#include <fmt/format.h>
#include <stb_image.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "components/scene/PictureFormat.hpp"

namespace insonify::meshes {

using namespace scene;
namespace {

constexpr uint32_t facets = 64;

/** Revolves a profile of (radius, z), from the bottom up, about z. */
Surface revolve(const std::vector<glm::dvec2>& profile) {
    Surface surface;
    for (const glm::dvec2 point : profile)
        for (uint32_t k = 0; k < facets; ++k) {
            const double angle = 2 * std::numbers::pi * k / facets;
            surface.positions.emplace_back(point.x * std::cos(angle), point.x * std::sin(angle), point.y);
        }
    for (uint32_t ring = 0; ring + 1 < profile.size(); ++ring)
        for (uint32_t k = 0; k < facets; ++k) {
            const uint32_t a = ring * facets + k, b = ring * facets + (k + 1) % facets;
            const uint32_t c = b + facets, d = a + facets;
            if (profile[ring].x > 0) surface.indices.insert(surface.indices.end(), {a, b, c});
            if (profile[ring + 1].x > 0) surface.indices.insert(surface.indices.end(), {a, c, d});
        }
    return surface;
}

/** Adds half of a sphere's outline about (0, z): the lower half from its pole, or the upper half to its pole. */
void addQuarter(std::vector<glm::dvec2>& profile, double radius, double z, bool is_upper) {
    constexpr uint32_t steps = facets / 4;
    for (uint32_t i = 0; i <= steps; ++i) {
        const double elevation = std::numbers::pi / 2 * (is_upper ? i : steps - i) / steps;
        const bool is_pole = i == (is_upper ? steps : 0);
        profile.emplace_back(is_pole ? 0 : radius * std::cos(elevation),
                             z + (is_upper ? 1 : -1) * radius * std::sin(elevation));
    }
}

constexpr int max_picture_side = 32768;  ///< Max side of pictures, checked before they are decoded [pixels].
constexpr int max_corners = 2049;        ///< Max vertices along each side.

/** Returns the pixels of one side that become vertices: evenly spaced, including both ends. */
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

Surface unitBox() {
    Surface surface;
    for (int i = 0; i < 8; ++i)
        surface.positions.emplace_back(i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f);
    surface.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return surface;
}

Surface unitPlane() {
    Surface surface;
    surface.positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
    surface.indices = {0, 1, 2, 0, 2, 3};
    return surface;
}

Surface unitSphere() { return capsule(1, 0); }

Surface unitCylinder() { return revolve({{0, -0.5}, {1, -0.5}, {1, 0.5}, {0, 0.5}}); }

Surface unitCone() { return revolve({{0, -0.5}, {1, -0.5}, {0, 0.5}}); }

Surface capsule(double radius, double length) {
    std::vector<glm::dvec2> profile;
    addQuarter(profile, radius, -length / 2, false);
    if (length == 0) profile.pop_back();
    addQuarter(profile, radius, length / 2, true);
    return revolve(profile);
}

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

}  // namespace insonify::meshes
