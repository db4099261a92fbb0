#include "components/sonar/rays/SurfaceMapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "components/sonar/base/SharedValues.hpp"

namespace insonify::sonar {
namespace {

std::shared_ptr<const MapLevels> sharedLevels(const std::shared_ptr<const types::SurfaceMap>& map) {
    static auto& all = *new SharedValues<std::shared_ptr<const types::SurfaceMap>,
                                         const MapLevels>;  // threads may use it until the process ends
    return all.of(map, [&] { return std::make_shared<const MapLevels>(*map); });
}

/** Returns the texel of a side of the map for any number. */
int texelAt(int texel, int count, bool repeats) {
    if (!repeats) return std::clamp(texel, 0, count - 1);
    const int rest = texel % count;
    return rest < 0 ? rest + count : rest;
}

/** Returns a coordinate, or 0 for NaN and numbers too large to have a fraction. */
float knownAt(float coordinate) { return std::abs(coordinate) < 1e6f ? coordinate : 0.0f; }

}  // namespace

MapLevels::MapLevels(const types::SurfaceMap& map)
    : channels_(1 + map.materials.size()), repeat_u_(map.repeat_u), repeat_v_(map.repeat_v), materials_(map.materials) {
    const size_t texels = static_cast<size_t>(map.width) * static_cast<size_t>(map.height);
    if (texels == 0 || (!map.strengths.empty() && map.strengths.size() != texels) ||
        (!map.classes.empty() && map.classes.size() != texels) || map.materials.size() > max_classes)
        throw std::invalid_argument(fmt::format("a surface map of {} x {} has {} strengths, {} classes of {} kinds",
                                                map.width, map.height, map.strengths.size(), map.classes.size(),
                                                map.materials.size()));
    Level& finest = levels_.emplace_back(Level{map.width, map.height, std::vector<float>(texels * channels_)});
    for (size_t i = 0; i < texels; ++i) {
        float* const texel = &finest.channels[i * channels_];
        texel[0] = map.strengths.empty() ? 1 : map.strengths[i];
        if (!map.classes.empty() && map.classes[i] < map.materials.size()) texel[1 + map.classes[i]] = 1;
    }
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

/** Halves a level. Each texel is the mean over its area, so that means do not depend on the size. */
MapLevels::Level MapLevels::halved(const Level& finer) const {
    Level level{(finer.width + 1) / 2, (finer.height + 1) / 2, {}};
    level.channels.resize(static_cast<size_t>(level.width) * static_cast<size_t>(level.height) * channels_);
    const double per_x = static_cast<double>(finer.width) / level.width,
                 per_y = static_cast<double>(finer.height) / level.height;
    std::vector<double> sums(channels_);
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
            const double left = x * per_x, top = y * per_y, right = left + per_x, bottom = top + per_y;
            std::ranges::fill(sums, 0.0);
            for (int v = static_cast<int>(top); v < std::min<double>(bottom, finer.height); ++v)
                for (int u = static_cast<int>(left); u < std::min<double>(right, finer.width); ++u) {
                    const double wide = std::min(right, u + 1.0) - std::max<double>(left, u),
                                 tall = std::min(bottom, v + 1.0) - std::max<double>(top, v);
                    const float* const from = &finer.channels[static_cast<size_t>(v * finer.width + u) * channels_];
                    for (size_t c = 0; c < channels_; ++c) sums[c] += wide * tall * static_cast<double>(from[c]);
                }
            float* const to = &level.channels[static_cast<size_t>(y * level.width + x) * channels_];
            for (size_t c = 0; c < channels_; ++c) to[c] = static_cast<float>(sums[c] / (per_x * per_y));
        }
    return level;
}

void MapLevels::addTexels(const Level& level, glm::vec2 at, float* sums) const {
    const glm::vec2 place(knownAt(at.x), knownAt(at.y));
    const glm::vec2 wrapped(repeat_u_ ? place.x - std::floor(place.x) : std::clamp(place.x, 0.0f, 1.0f),
                            repeat_v_ ? place.y - std::floor(place.y) : std::clamp(place.y, 0.0f, 1.0f));
    const glm::vec2 texel = wrapped * glm::vec2(level.width, level.height) - 0.5f, low = glm::floor(texel),
                    share = texel - low;
    const float* corners[4];
    for (int corner = 0; corner < 4; ++corner) {
        const int x = texelAt(static_cast<int>(low.x) + (corner & 1), level.width, repeat_u_),
                  y = texelAt(static_cast<int>(low.y) + (corner >> 1), level.height, repeat_v_);
        corners[corner] = &level.channels[static_cast<size_t>(y * level.width + x) * channels_];
    }
    for (size_t c = 0; c < channels_; ++c) {  // equal texels keep their value between them
        const float upper = corners[0][c] + share.x * (corners[1][c] - corners[0][c]),
                    lower = corners[2][c] + share.x * (corners[3][c] - corners[2][c]);
        sums[c] += upper + share.y * (lower - upper);
    }
}

MapLevels::Look MapLevels::look(const Footprint& footprint) const {
    const glm::vec2 texels(levels_.front().width, levels_.front().height);
    const glm::vec2 sides[2] = {footprint.along, footprint.across};
    const float lengths[2] = {glm::length(sides[0] * texels), glm::length(sides[1] * texels)};
    const int longer = lengths[1] > lengths[0];
    const float length = lengths[longer] < 1e9f ? lengths[longer] : 1e9f;  // not NaN
    const float narrow = std::max(std::min(lengths[1 - longer], length), std::max(length / max_probes, 1.0f));
    const int probes = std::clamp(static_cast<int>(std::ceil(length / narrow)), 1, max_probes);
    const auto level = std::min(static_cast<size_t>(std::max(std::lround(std::log2(narrow)), 0l)), levels_.size() - 1);
    std::array<float, max_classes + 1> sums{};
    for (int probe = 0; probe < probes; ++probe) {
        const float off = (static_cast<float>(probe) + 0.5f) / static_cast<float>(probes) - 0.5f;
        const glm::vec2 at = probes > 1 ? footprint.at + off * sides[longer] : footprint.at;
        addTexels(levels_[level], at, sums.data());
    }
    Look seen;
    const auto count = static_cast<float>(probes);
    seen.strength = sums[0] / count;
    for (size_t c = 1; c < channels_; ++c) {
        seen.shares[c] = sums[c] / count;
        seen.shares[0] -= seen.shares[c];
    }
    return seen;
}

SurfaceMapping::SurfaceMapping(const types::Geometry& geometry, std::span<const CommandRecord> commands)
    : geometry_(geometry), commands_(commands.begin(), commands.end()) {
    of_command_.resize(commands.size(), nullptr);
    first_class_.resize(commands.size(), 0);
    for (size_t i = 0; i < commands.size(); ++i) {
        const CommandRecord& command = commands[i];
        const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(geometry.objects[command.object].mesh)];
        const auto of_material =
            std::ranges::find(mesh.maps, static_cast<int>(command.material), &types::MappedMaterial::material);
        if (of_material == mesh.maps.end()) continue;
        of_command_[i] = maps_.emplace_back(sharedLevels(of_material->map)).get();
        first_class_[i] = static_cast<uint32_t>(commands_.size());
        for (const int material : of_command_[i]->materials()) {
            commands_.push_back(command);
            commands_.back().material = static_cast<uint32_t>(material);
        }
    }
}

bool SurfaceMapping::isMapped(const TileHits& hits) const {
    return std::ranges::any_of(
        hits.command, [this](uint32_t command) { return command < of_command_.size() && of_command_[command]; });
}

MapLevels::Look SurfaceMapping::look(const TracedView& view, const PlacedScene& scene, const TracedTile& tile,
                                     int i) const {
    const uint32_t command = tile.hits->command[i];
    if (command >= of_command_.size() || !of_command_[command]) return {};
    const types::Mesh& mesh = geometry_.meshes[static_cast<size_t>(geometry_.objects[commands_[command].object].mesh)];
    const uint32_t* const corners = &mesh.indices[3 * static_cast<size_t>(tile.hits->triangle[i])];
    const float u = tile.hits->u[i], v = tile.hits->v[i];
    const glm::dvec3 a = mesh.positions[corners[0]], to_b = glm::dvec3(mesh.positions[corners[1]]) - a,
                     to_c = glm::dvec3(mesh.positions[corners[2]]) - a;
    const glm::vec2 uv = mesh.map_uvs[corners[0]], uv_b = mesh.map_uvs[corners[1]] - uv,
                    uv_c = mesh.map_uvs[corners[2]] - uv;
    const double* const eye = scene.ranges[command].eye;
    const glm::dvec3 way =
        a + static_cast<double>(u) * to_b + static_cast<double>(v) * to_c - glm::dvec3(eye[0], eye[1], eye[2]);
    const glm::dvec3 normal = glm::normalize(glm::cross(to_b, to_c));
    const double range = glm::length(way), cosine = std::max(std::abs(glm::dot(way, normal)) / range, 0.01);
    glm::dvec3 ahead = way - normal * glm::dot(way, normal);
    const double level = glm::length(ahead);
    ahead = level > 1e-9 * range ? ahead / level : to_b / glm::length(to_b);
    const glm::dvec3 aside = glm::cross(normal, ahead);
    const AngularView& cells = view.cells;
    const size_t left = cells.at(tile.first_column + view.shape.at[i].columns),
                 row = static_cast<size_t>(tile.first_row + view.shape.at[i].rows);
    const double width = cells.bearings[left + 2] - cells.bearings[left], height = cells.height(row, 1);
    // Barycentric coordinates of a vector in the triangle's plane, by its Gram matrix.
    const double bb = glm::dot(to_b, to_b), bc = glm::dot(to_b, to_c), cc = glm::dot(to_c, to_c);
    const double determinant = std::max(bb * cc - bc * bc, 1e-300);
    const auto inMap = [&](const glm::dvec3& vector) {
        const double on_b = glm::dot(vector, to_b), on_c = glm::dot(vector, to_c);
        return static_cast<float>((cc * on_b - bc * on_c) / determinant) * uv_b +
               static_cast<float>((bb * on_c - bc * on_b) / determinant) * uv_c;
    };
    return of_command_[command]->look(
        {uv + u * uv_b + v * uv_c, inMap(range * height / cosine * ahead), inMap(range * width * aside)});
}

double PlacedScene::computeMean(std::span<const double> property, const TracedView& view, const TracedTile& tile,
                                int i) const {
    const uint32_t command = tile.hits->command[i];
    if (!maps) return property[commands[command].material];
    const MapLevels::Look look = maps->look(view, *this, tile, i);
    double sum = 0;
    for (size_t k = 0; k <= maps->getClasses(command); ++k)
        sum += static_cast<double>(look.shares[k]) * property[commands[maps->getCommand(command, k)].material];
    return static_cast<double>(look.strength) * sum;
}

namespace {

/** One of the materials of a sample, with the factor of its echo. */
struct Seen {
    uint32_t command;
    float gain;
};

/** Lists the materials of a sample, that with the largest share first; it gets the shares of the omitted materials.
 *  Returns their number. */
size_t split(const SurfaceMapping& maps, uint32_t command, const MapLevels::Look& look, float min_share,
             std::span<Seen> seen) {
    std::array<std::pair<float, size_t>, MapLevels::max_classes + 1> shares;
    const size_t count = maps.getClasses(command) + 1;
    for (size_t k = 0; k < count; ++k) shares[k] = {look.shares[k], k};
    std::sort(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(count), std::greater<>());
    float rest = 1;
    size_t found = 1;
    for (; found < std::min(count, seen.size()) && shares[found].first >= min_share; ++found) {
        seen[found] = {maps.getCommand(command, shares[found].second), look.strength * shares[found].first};
        rest -= shares[found].first;
    }
    seen[0] = {maps.getCommand(command, shares[0].second), look.strength * rest};
    return found;
}

/** Chooses one material for sample `i` of a tile, so that the number of a tile's samples with each material is in
 *  proportion to its share. */
Seen choose(const SurfaceMapping& maps, uint32_t command, const MapLevels::Look& look, size_t i) {
    constexpr int reversed[tile_samples] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    float left = (static_cast<float>(reversed[i]) + 0.5f) / tile_samples;
    size_t chosen = 0;
    for (const size_t count = maps.getClasses(command); chosen < count && left >= look.shares[chosen]; ++chosen)
        left -= look.shares[chosen];
    return {maps.getCommand(command, chosen), look.strength};
}

}  // namespace

void MappedTiles::take(const TracedView& view, const PlacedScene& scene, std::span<const TracedTile> tiles,
                       bool apart) {
    const SurfaceMapping& maps = *scene.maps;
    whole_.assign(tiles.begin(), tiles.end());
    rest_.clear();
    parts_.clear();
    std::array<MapLevels::Look, tile_samples> looks;
    for (size_t at = 0; at < tiles.size(); ++at) {
        if (!maps.isMapped(*tiles[at].hits)) continue;
        for (int i = 0; i < tile_samples; ++i) looks[static_cast<size_t>(i)] = maps.look(view, scene, tiles[at], i);
        add(maps, tiles[at], at, looks.data(), apart);
    }
    for (Part& part : parts_) {
        TracedTile& tile = part.tile < whole_.size() ? whole_[part.tile] : rest_[part.tile - whole_.size()];
        tile.hits = &part.hits;
        tile.gains = part.gains.data();
    }
}

void MappedTiles::add(const SurfaceMapping& maps, const TracedTile& tile, size_t at, const MapLevels::Look* looks,
                      bool apart) {
    std::array<std::array<Seen, max_materials>, tile_samples> seen;
    size_t count = 1;
    for (size_t i = 0; i < tile_samples; ++i) {
        const uint32_t command = tile.hits->command[i];
        seen[i].fill({TileHits::nothing, 0});
        if (command == TileHits::nothing) continue;
        if (apart)
            seen[i][0] = choose(maps, command, looks[i], i);
        else
            count = std::max(count, split(maps, command, looks[i], min_share, seen[i]));
    }
    for (size_t material = 0; material < count; ++material) {
        Part& part = parts_.emplace_back(Part{at, *tile.hits, {}});
        for (size_t i = 0; i < tile_samples; ++i) {
            part.hits.command[i] = seen[i][material].command;
            part.gains[i] = seen[i][material].gain;
        }
        if (material == 0) continue;
        part.tile = whole_.size() + rest_.size();
        rest_.push_back(tile);
    }
}

}  // namespace insonify::sonar
