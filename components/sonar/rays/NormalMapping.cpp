#include "components/sonar/rays/NormalMapping.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <utility>

#include "components/sonar/base/SharedValues.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Appends a texel with scaled lean, as a unit normal. */
void appendScaled(const uint8_t* rgb, float scale, std::vector<uint8_t>& texels) {
    if (scale == 1) return void(texels.insert(texels.end(), {rgb[0], rgb[1], rgb[2], 0}));
    const glm::vec3 normal = glm::vec3(rgb[0], rgb[1], rgb[2]) * (2 / 255.0f) - 1.0f;
    const glm::vec3 scaled = glm::normalize(normal * glm::vec3(scale, scale, 1));
    for (int i = 0; i < 3; ++i) texels.push_back(static_cast<uint8_t>(std::lround((scaled[i] + 1) * 127.5f)));
    texels.push_back(0);
}

/** Returns the level of a map that is nearest to log2 of the texels that a sample covers. */
int computeLevel(float covered) {
    const float root_2 = 1.41421356f, bounded = covered > 1 ? (covered < 1e30f ? covered : 1e30f) : 1.0f;
    return (std::bit_cast<int32_t>(bounded * root_2) >> 23) - 127;
}

/** The two texels next to a coordinate of a map, and the weight of the second. */
struct Neighbours {
    int first, second;
    float share;
};
Neighbours neighbours(float coordinate, float texels, bool repeats) {
    const float known = std::abs(coordinate) < 1e6f ? coordinate : 0.0f;  // excludes NaN and lost fractions
    const float wrapped = repeats ? known - std::floor(known) : known;
    const float at = wrapped * texels - 0.5f, low = std::floor(at);
    const float held = low < -1.0f ? -1.0f : low > texels ? texels : low;
    const int first = static_cast<int>(held), second = first + 1, last = static_cast<int>(texels) - 1;
    const int before = repeats ? last : 0, behind = repeats ? 0 : last;
    return {first < 0      ? before
            : first > last ? last
                           : first,
            second > last ? behind
            : second < 0  ? 0
                          : second,
            at - low};
}

}  // namespace

NormalMapping::NormalMapping(const types::Geometry& geometry) : geometry_(geometry) {
    for (const types::Material& material : geometry.materials)
        maps_.push_back(material.normal_map < 0
                            ? nullptr
                            : sharedMap(geometry.normal_maps.shared(static_cast<size_t>(material.normal_map)),
                                        material.normal_scale));
    facts_ = MeshFacts::ofAll(geometry);
    for (size_t i = 0; i < geometry.meshes.size(); ++i)
        if (std::ranges::any_of(geometry.meshes[i].clusters, [this](const auto& c) { return isMapped(c.material); }))
            facts_[i]->mapDensity();  // computed before the first ping
}

std::shared_ptr<const NormalMapping::Map> NormalMapping::sharedMap(
    const std::shared_ptr<const types::NormalMap>& source, float scale) {
    static auto& all = *new SharedValues<std::pair<const types::NormalMap*, float>,
                                         const Map>;  // threads may use it until the process ends
    return all.of({source.get(), scale}, [&] { return std::make_shared<const Map>(makeMap(source, scale)); });
}

NormalMapping::Map NormalMapping::makeMap(std::shared_ptr<const types::NormalMap> source, float scale) {
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

struct NormalMapping::Frames {
    alignas(64) float normal_x[max_samples], normal_y[max_samples], normal_z[max_samples];      // mesh axes, then unit
    float along_x[max_samples], along_y[max_samples], along_z[max_samples], hand[max_samples];  // tangents
    float u[max_samples], v[max_samples], density[max_samples];
    float covered[max_samples];  // texels of the finest level
};

struct NormalMapping::Leanings {
    alignas(64) float x[max_samples], y[max_samples], z[max_samples];
};

void NormalMapping::interpolate(uint32_t object, const Samples& samples, Frames& frames) const {
    const auto number = static_cast<size_t>(geometry_.objects[object].mesh);
    const types::Mesh& mesh = geometry_.meshes[number];
    const float* const density = facts_[number]->mapDensity().data();
    for (int i = 0; i < samples.count; ++i) {
        const uint32_t* corners = mesh.indices.data() + 3 * static_cast<size_t>(samples.triangle[i]);
        const float u = samples.u[i], v = samples.v[i], w = 1 - u - v;
        const auto between = [&](const auto& of) {
            return w * of[corners[0]] + u * of[corners[1]] + v * of[corners[2]];
        };
        const glm::vec3 normal = between(mesh.normals);
        const glm::vec4 along = between(mesh.tangents);
        const glm::vec2 uv = between(mesh.uvs);
        frames.normal_x[i] = normal.x, frames.normal_y[i] = normal.y, frames.normal_z[i] = normal.z;
        frames.along_x[i] = along.x, frames.along_y[i] = along.y, frames.along_z[i] = along.z;
        frames.hand[i] = along.w;
        frames.u[i] = uv.x, frames.v[i] = uv.y;
        frames.density[i] = density[samples.triangle[i]];
    }
}

void NormalMapping::place(const ObjectRecord& placed, float texels, const Samples& samples, Frames& frames) {
    const vec4 &nx = placed.normal_x, &ny = placed.normal_y, &nz = placed.normal_z;
    const vec4 &rx = placed.row_x, &ry = placed.row_y, &rz = placed.row_z;
    const float volume = std::abs(glm::dot(glm::vec3(rx), glm::cross(glm::vec3(ry), glm::vec3(rz))));
    for (int i = 0; i < samples.count; ++i) {
        const float mx = frames.normal_x[i], my = frames.normal_y[i], mz = frames.normal_z[i];
        float x = nx.x * mx + nx.y * my + nx.z * mz, y = ny.x * mx + ny.y * my + ny.z * mz,
              z = nz.x * mx + nz.y * my + nz.z * mz;
        const float per_length = 1 / std::sqrt(x * x + y * y + z * z);
        x *= per_length, y *= per_length, z *= per_length;
        const float ax = frames.along_x[i], ay = frames.along_y[i], az = frames.along_z[i];
        float tx = rx.x * ax + rx.y * ay + rx.z * az, ty = ry.x * ax + ry.y * ay + ry.z * az,
              tz = rz.x * ax + rz.y * ay + rz.z * az;
        const float lean = x * tx + y * ty + z * tz;
        tx -= x * lean, ty -= y * lean, tz -= z * lean;
        const float per_along = 1 / std::sqrt(tx * tx + ty * ty + tz * tz);
        frames.normal_x[i] = x, frames.normal_y[i] = y, frames.normal_z[i] = z;
        frames.along_x[i] = tx * per_along, frames.along_y[i] = ty * per_along, frames.along_z[i] = tz * per_along;
        const float facing = std::abs(x * samples.x[i] + y * samples.y[i] + z * samples.z[i]);
        // Areas scale with the volume times the rotated normal's length.
        frames.covered[i] = samples.extent[i] / (facing > 0.01f ? facing : 0.01f) * texels * frames.density[i] /
                            std::sqrt(volume * samples.normal[i]);
    }
}

void NormalMapping::lookUp(const Map& map, int count, const Frames& frames, Leanings& bent) {
    const uint8_t* texels[max_samples];
    alignas(64) float width[max_samples], height[max_samples], share_u[max_samples], share_v[max_samples];
    alignas(64) int at[4][max_samples];
    alignas(64) uint32_t rgb[4][max_samples];
    const auto coarsest = static_cast<int>(map.levels.size()) - 1;
    for (int i = 0; i < count; ++i) {
        const Level& level = map.levels[static_cast<size_t>(std::min(computeLevel(frames.covered[i]), coarsest))];
        texels[i] = level.texels.data();
        width[i] = static_cast<float>(level.width), height[i] = static_cast<float>(level.height);
    }
    const bool repeat_u = map.repeat_u, repeat_v = map.repeat_v;
    for (int i = 0; i < count; ++i) {
        const Neighbours x = neighbours(frames.u[i], width[i], repeat_u),
                         y = neighbours(frames.v[i], height[i], repeat_v);
        const int columns = static_cast<int>(width[i]);
        at[0][i] = y.first * columns + x.first, at[1][i] = y.first * columns + x.second;
        at[2][i] = y.second * columns + x.first, at[3][i] = y.second * columns + x.second;
        share_u[i] = x.share, share_v[i] = y.share;
    }
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 4; ++k) std::memcpy(&rgb[k][i], texels[i] + 4 * static_cast<size_t>(at[k][i]), 4);
    for (int i = 0; i < count; ++i) {
        const auto mixed = [&](int shift) {
            const auto channel = [&](int k) { return static_cast<float>(static_cast<int>(rgb[k][i] >> shift & 255)); };
            const float low = channel(0) * (1 - share_u[i]) + channel(1) * share_u[i];
            const float high = channel(2) * (1 - share_u[i]) + channel(3) * share_u[i];
            return (low * (1 - share_v[i]) + high * share_v[i]) * (2 / 255.0f) - 1.0f;
        };
        bent.x[i] = mixed(0), bent.y[i] = mixed(8), bent.z[i] = mixed(16);
    }
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void NormalMapping::cosines(const ObjectRecord& placed, uint32_t object,
                                                                            int material, const Samples& samples,
                                                                            double* cosine) const {
    const Map& map = *maps_[static_cast<size_t>(material)];
    const Level& finest = map.levels.front();
    Frames frames;
    Leanings bent;
    interpolate(object, samples, frames);
    place(placed, std::sqrt(static_cast<float>(finest.width) * static_cast<float>(finest.height)), samples, frames);
    lookUp(map, samples.count, frames, bent);
    for (int i = 0; i < samples.count; ++i) {
        const float nx = frames.normal_x[i], ny = frames.normal_y[i], nz = frames.normal_z[i];
        const float tx = frames.along_x[i], ty = frames.along_y[i], tz = frames.along_z[i];
        const float across = frames.hand[i] * bent.y[i];
        const float x = tx * bent.x[i] + (ny * tz - nz * ty) * across + nx * bent.z[i];
        const float y = ty * bent.x[i] + (nz * tx - nx * tz) * across + ny * bent.z[i];
        const float z = tz * bent.x[i] + (nx * ty - ny * tx) * across + nz * bent.z[i];
        const float facing = nx * samples.x[i] + ny * samples.y[i] + nz * samples.z[i];
        const float along = x * samples.x[i] + y * samples.y[i] + z * samples.z[i];
        // A mean of several unit normals is shorter than 1: its product is the mean of their cosines.
        const float length = computeLevel(frames.covered[i]) == 0 ? std::sqrt(x * x + y * y + z * z) : 1.0f;
        const float towards = (facing < 0 ? -along : along) / length;
        cosine[i] = towards > 1e-6f ? static_cast<double>(towards) : 1e-6;  // also where there is no frame
    }
}

}  // namespace insonify::sonar
