#include "components/sonar/rays/NormalMapping.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "components/sonar/places/SharedValues.hpp"

namespace insonify::sonar {
namespace {

glm::vec3 turned(const vec4& x, const vec4& y, const vec4& z, glm::vec3 v) {
    return {x.x * v.x + x.y * v.y + x.z * v.z, y.x * v.x + y.y * v.y + y.z * v.z, z.x * v.x + z.y * v.y + z.z * v.z};
}

/** The two texels about a coordinate of a map, and the share of the second. */
struct Neighbours {
    int first, second;
    float share;
};
Neighbours neighbours(float coordinate, int size, bool repeats) {
    if (!(std::abs(coordinate) < 1e6f)) coordinate = 0;  // NaN and what is as good as lost
    const auto texels = static_cast<float>(size);
    if (repeats) coordinate -= std::floor(coordinate);
    const float at = coordinate * texels - 0.5f, low = std::floor(at);
    const int first = static_cast<int>(std::clamp(low, -1.0f, texels)), second = first + 1, last = size - 1;
    if (!repeats) return {std::clamp(first, 0, last), std::clamp(second, 0, last), at - low};
    return {first < 0 ? last : std::min(first, last), second > last ? 0 : second, at - low};
}

/** A texel, its lean scaled, as a unit normal again. */
void appendScaled(const uint8_t* rgb, float scale, std::vector<uint8_t>& texels) {
    if (scale == 1) return void(texels.insert(texels.end(), {rgb[0], rgb[1], rgb[2], 0}));
    const glm::vec3 normal = glm::vec3(rgb[0], rgb[1], rgb[2]) * (2 / 255.0f) - 1.0f;
    const glm::vec3 scaled = glm::normalize(normal * glm::vec3(scale, scale, 1));
    for (int i = 0; i < 3; ++i) texels.push_back(static_cast<uint8_t>(std::lround((scaled[i] + 1) * 127.5f)));
    texels.push_back(0);
}

}  // namespace

NormalMapping::NormalMapping(const types::Geometry& geometry) : geometry_(geometry) {
    for (const types::Material& material : geometry.materials)
        maps_.push_back(material.normal_map < 0
                            ? nullptr
                            : sharedMap(geometry.normal_maps.shared(static_cast<size_t>(material.normal_map)),
                                        material.normal_scale));
}

std::shared_ptr<const NormalMapping::Map> NormalMapping::sharedMap(
    const std::shared_ptr<const types::NormalMap>& source, float scale) {
    static SharedValues<std::pair<const types::NormalMap*, float>, const Map> all;
    return all.of({source.get(), scale}, [&] { return std::make_shared<const Map>(mapOf(source, scale)); });
}

NormalMapping::Map NormalMapping::mapOf(std::shared_ptr<const types::NormalMap> source, float scale) {
    const types::NormalMap& map = *source;
    Map result{std::move(source), map.repeat_u, map.repeat_v, {}};
    Level level{map.width, map.height, {}};
    for (size_t i = 0; i + 2 < map.rgb.size(); i += 3) appendScaled(&map.rgb[i], scale, level.texels);
    while (level.width > 1 || level.height > 1) {
        const Level& finer = result.levels.emplace_back(std::move(level));
        level = {std::max(1, finer.width / 2), std::max(1, finer.height / 2), {}};
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x)
                for (int channel = 0; channel < 4; ++channel) {
                    int sum = 2;
                    for (int i = 0; i < 4; ++i) {
                        const int from_x = std::min(2 * x + (i & 1), finer.width - 1);
                        const int from_y = std::min(2 * y + (i >> 1), finer.height - 1);
                        sum += finer.texels[4 * static_cast<size_t>(from_y * finer.width + from_x) +
                                            static_cast<size_t>(channel)];
                    }
                    level.texels.push_back(static_cast<uint8_t>(sum / 4));
                }
    }
    result.levels.push_back(std::move(level));
    return result;
}

/** Bilinear, in the halving that is nearest to `level`. */
glm::vec3 NormalMapping::texel(const Map& map, glm::vec2 uv, float level) {
    const auto coarsest = static_cast<float>(map.levels.size() - 1);
    const Level& texels = map.levels[static_cast<size_t>(std::clamp(level, 0.0f, coarsest) + 0.5f)];
    const Neighbours x = neighbours(uv.x, texels.width, map.repeat_u),
                     y = neighbours(uv.y, texels.height, map.repeat_v);
    const auto at = [&](int column, int row) {
        const uint8_t* rgb = texels.texels.data() + 4 * static_cast<size_t>(row * texels.width + column);
        return glm::vec3(rgb[0], rgb[1], rgb[2]);
    };
    const auto mixed = [&](int row) { return at(x.first, row) * (1 - x.share) + at(x.second, row) * x.share; };
    const glm::vec3 sum = mixed(y.first) * (1 - y.share) + mixed(y.second) * y.share;
    return sum * (2 / 255.0f) - 1.0f;
}

float NormalMapping::texelsPerMetre(const ObjectRecord& placed, const types::Mesh& mesh, const uint32_t* corners,
                                    const Level& finest) const {
    const glm::vec3 a = mesh.positions[corners[0]];
    const glm::vec3 ab = turned(placed.row_x, placed.row_y, placed.row_z, mesh.positions[corners[1]] - a);
    const glm::vec3 ac = turned(placed.row_x, placed.row_y, placed.row_z, mesh.positions[corners[2]] - a);
    const glm::vec2 size(finest.width, finest.height), uv = mesh.uvs[corners[0]];
    const glm::vec2 to_b = size * (mesh.uvs[corners[1]] - uv), to_c = size * (mesh.uvs[corners[2]] - uv);
    const float area = glm::length(glm::cross(ab, ac)), texels = std::abs(to_b.x * to_c.y - to_b.y * to_c.x);
    return area > 0 ? std::sqrt(texels / area) : 0;
}

float NormalMapping::cosine(const ObjectRecord& placed, const Place& place) const {
    const types::Mesh& mesh = geometry_.meshes[static_cast<size_t>(geometry_.objects[place.object].mesh)];
    const Map& map = *maps_[static_cast<size_t>(place.material)];
    const uint32_t* corners = mesh.indices.data() + 3 * static_cast<size_t>(place.triangle);
    const auto between = [&](const auto& of) {
        return (1 - place.u - place.v) * of[corners[0]] + place.u * of[corners[1]] + place.v * of[corners[2]];
    };
    const glm::vec3 n =
        glm::normalize(turned(placed.normal_x, placed.normal_y, placed.normal_z, between(mesh.normals)));
    const glm::vec4 along = between(mesh.tangents);
    const glm::vec3 leaning = turned(placed.row_x, placed.row_y, placed.row_z, glm::vec3(along));
    const glm::vec3 t = glm::normalize(leaning - n * glm::dot(n, leaning));
    const float facing = -glm::dot(n, place.direction);
    const float covered =
        place.extent / std::max(std::abs(facing), 0.01f) * texelsPerMetre(placed, mesh, corners, map.levels.front());
    const float level = covered > 1 ? std::log2(covered) : 0.0f;
    const glm::vec3 bent = texel(map, between(mesh.uvs), level);
    glm::vec3 normal = t * bent.x + glm::cross(n, t) * (along.w * bent.y) + n * bent.z;
    // A mean of several unit normals is shorter than 1: what it gives is the mean of their cosines.
    if (level < 0.5f) normal = glm::normalize(normal);
    const float cosine = glm::dot(normal, place.direction) * (facing > 0 ? -1.0f : 1.0f);
    return cosine > 1e-6f ? cosine : 1e-6f;  // also where normal and tangent make no frame
}

}  // namespace insonify::sonar
