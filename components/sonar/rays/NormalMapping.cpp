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

/** Returns the mean of the positive part of a cosine with a mean and a variance, as if all values within a span of that
 *  variance were equally frequent. */
float meanFacing(float mean, float variance) {
    const float half = std::sqrt(3 * (variance > 1e-12f ? variance : 1e-12f)), above = mean + half;
    return mean > half ? mean : above > 0 ? above * above / (4 * half) : 0.0f;
}

/** Returns x^2, y^2 and xy of a texel's normal. */
glm::vec3 computeSquares(const uint8_t* texel) {
    const glm::vec2 lean = glm::vec2(texel[0], texel[1]) * (2 / 255.0f) - 1.0f;
    return {lean.x * lean.x, lean.y * lean.y, lean.x * lean.y};
}

/** Return 255 times the root of a mean square, and 128 plus 127 times that of a mean product, with its sign. */
uint8_t packRoot(float value) {
    return static_cast<uint8_t>(std::lround(255 * std::sqrt(std::clamp(value, 0.0f, 1.0f))));
}
uint8_t packSignedRoot(float value) {
    return static_cast<uint8_t>(128 +
                                std::lround(std::copysign(127 * std::sqrt(std::min(std::abs(value), 1.0f)), value)));
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
    Level level{map.width, map.height, {}, {}};
    for (size_t i = 0; i + 2 < map.rgb.size(); i += 3) appendScaled(&map.rgb[i], scale, level.texels);
    std::vector<glm::vec3> squares;  // means of x^2, y^2 and xy in the texels of the last level; empty: the finest
    while (level.width > 1 || level.height > 1) {
        const Level& finer = result.levels.emplace_back(std::move(level));
        level = {std::max(1, finer.width / 2), std::max(1, finer.height / 2), {}, {}};
        std::vector<glm::vec3> coarser;
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x) {
                glm::ivec4 sum(2);
                glm::vec3 square(0);
                for (int i = 0; i < 4; ++i) {
                    const int from_x = std::min(2 * x + (i & 1), finer.width - 1);
                    const int from_y = std::min(2 * y + (i >> 1), finer.height - 1);
                    const auto from = static_cast<size_t>(from_y * finer.width + from_x);
                    for (int channel = 0; channel < 4; ++channel)
                        sum[channel] += finer.texels[4 * from + static_cast<size_t>(channel)];
                    square += 0.25f * (squares.empty() ? computeSquares(&finer.texels[4 * from]) : squares[from]);
                }
                for (int channel = 0; channel < 4; ++channel)
                    level.texels.push_back(static_cast<uint8_t>(sum[channel] / 4));
                level.squares.push_back(packRoot(square.x));
                level.squares.push_back(packRoot(square.y));
                level.squares.push_back(packSignedRoot(square.z));
                level.squares.push_back(0);
                coarser.push_back(square);
            }
        squares = std::move(coarser);
    }
    result.levels.push_back(std::move(level));
    return result;
}

struct NormalMapping::Frames {
    alignas(64) float normal_x[max_samples], normal_y[max_samples], normal_z[max_samples];      // mesh axes
    float along_x[max_samples], along_y[max_samples], along_z[max_samples], hand[max_samples];  // tangents
    float u[max_samples], v[max_samples], density[max_samples];
    float ray_along[max_samples], ray_across[max_samples], ray_up[max_samples];  // the ray, seen from the side it hits
    float covered[max_samples];                                                  // texels of the finest level
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
    // Between texels, a level is a mean over two of them: wider levels would blur what the sample resolves.
    constexpr float part = 0.6f;
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
        tx *= per_along, ty *= per_along, tz *= per_along;
        const float bx = frames.hand[i] * (y * tz - z * ty), by = frames.hand[i] * (z * tx - x * tz),
                    bz = frames.hand[i] * (x * ty - y * tx);
        const float up = x * samples.x[i] + y * samples.y[i] + z * samples.z[i], side = up < 0 ? -1.0f : 1.0f;
        frames.ray_along[i] = side * (tx * samples.x[i] + ty * samples.y[i] + tz * samples.z[i]);
        frames.ray_across[i] = side * (bx * samples.x[i] + by * samples.y[i] + bz * samples.z[i]);
        frames.ray_up[i] = side * up;
        // Areas scale with the volume times the rotated normal's length.
        frames.covered[i] =
            part * samples.extent[i] * texels * frames.density[i] / std::sqrt(volume * samples.normal[i]);
    }
}

void NormalMapping::lookUp(const Map& map, int count, const Frames& frames, double* cosine) {
    const uint8_t *texels[max_samples], *squares[max_samples];
    alignas(64) float spreads[max_samples];  // 0 in the finest level, whose texels do not vary; else 1
    alignas(64) float width[max_samples], height[max_samples], share_u[max_samples], share_v[max_samples];
    alignas(64) int at[4][max_samples];
    alignas(64) uint32_t rgb[4][max_samples], roots[4][max_samples];
    const auto coarsest = static_cast<int>(map.levels.size()) - 1;
    for (int i = 0; i < count; ++i) {
        const Level& level = map.levels[static_cast<size_t>(std::min(computeLevel(frames.covered[i]), coarsest))];
        texels[i] = level.texels.data();
        squares[i] = level.squares.empty() ? texels[i] : level.squares.data();
        spreads[i] = level.squares.empty() ? 0.0f : 1.0f;
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
        for (int k = 0; k < 4; ++k) {
            std::memcpy(&rgb[k][i], texels[i] + 4 * static_cast<size_t>(at[k][i]), 4);
            std::memcpy(&roots[k][i], squares[i] + 4 * static_cast<size_t>(at[k][i]), 4);
        }
    for (int i = 0; i < count; ++i) {
        const auto mixed = [&](const auto& of, int shift) {
            const auto channel = [&](int k) { return static_cast<float>(static_cast<int>(of[k][i] >> shift & 255)); };
            const float low = channel(0) * (1 - share_u[i]) + channel(1) * share_u[i];
            const float high = channel(2) * (1 - share_u[i]) + channel(3) * share_u[i];
            return low * (1 - share_v[i]) + high * share_v[i];
        };
        const float x = mixed(rgb, 0) * (2 / 255.0f) - 1, y = mixed(rgb, 8) * (2 / 255.0f) - 1,
                    z = mixed(rgb, 16) * (2 / 255.0f) - 1;
        const float along = frames.ray_along[i], across = frames.ray_across[i];
        const float xx = mixed(roots, 0), yy = mixed(roots, 8), xy = mixed(roots, 16) - 128;
        const float lean = along * x + across * y, square = xx * xx * along * along + yy * yy * across * across;
        const float product = (xy < 0 ? -xy : xy) * xy * along * across * (2 / (127.0f * 127));
        const float variance = spreads[i] * (square * (1 / (255.0f * 255)) + product - lean * lean);
        // A mean of several unit normals is shorter than 1: its product is the mean of their cosines.
        const float length = computeLevel(frames.covered[i]) == 0 ? std::sqrt(x * x + y * y + z * z) : 1.0f;
        const float mean = (lean + frames.ray_up[i] * z) / length;
        const float facing = meanFacing(mean, variance);
        cosine[i] = static_cast<double>(facing > 1e-6f ? facing : 1e-6f);  // also where there is no frame
    }
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void NormalMapping::cosines(const ObjectRecord& placed, uint32_t object,
                                                                            int material, const Samples& samples,
                                                                            double* cosine) const {
    const Map& map = *maps_[static_cast<size_t>(material)];
    const Level& finest = map.levels.front();
    Frames frames;
    interpolate(object, samples, frames);
    place(placed, std::sqrt(static_cast<float>(finest.width) * static_cast<float>(finest.height)), samples, frames);
    lookUp(map, samples.count, frames, cosine);
}

}  // namespace insonify::sonar
