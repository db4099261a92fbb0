#include "components/scene/Bathymetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/scene/Clusters.hpp"
#include "components/scene/Surface.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

constexpr const char* name = "bathymetry";  ///< Of the object and of its material.
constexpr double max_posts = 4096;          ///< Of a window, along each side.

int wholeDown(double value) { return static_cast<int>(std::clamp(std::floor(value), -1e9, 1e9)); }

/** The next multiple of `step` at or below a number. */
int multipleDown(int value, int step) { return wholeDown(double(value) / step) * step; }

/** Triangles between posts that have a value, seen from above anticlockwise where `is_turned` is false. */
void addTriangles(const std::vector<float>& values, const PostWindow& posts, bool is_turned, Surface& surface) {
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        if (std::isfinite(values[a] + values[b] + values[c]))
            surface.indices.insert(surface.indices.end(), {a, is_turned ? c : b, is_turned ? b : c});
    };
    forEachCell(static_cast<size_t>(posts.columns), static_cast<size_t>(posts.rows),
                [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
                    add(a, c, b);
                    add(c, d, b);
                });
}

}  // namespace

void BathymetryConfig::check(types::Diagnostics& diagnostics) const {
    if (file.empty()) diagnostics.push_back({"file", "is missing; give the path of a survey"});
    if (easting.has_value() != northing.has_value())
        diagnostics.push_back({easting ? "northing" : "easting", "is missing; give both, or neither"});
}

Bathymetry::Bathymetry(const BathymetryConfig& config, const std::filesystem::path& file)
    : config_(config),
      survey_(file, config.band),
      zero_(survey_.place((survey_.columns() - 1) / 2.0, (survey_.rows() - 1) / 2.0)) {
    if (config.easting) zero_ = {*config.easting, *config.northing};
    const glm::dvec2 spacing = glm::abs(survey_.spacing());
    const double posts = 2 * config.reach / std::min(spacing.x, spacing.y) + 2 * config.tile;
    if (posts > max_posts)
        throw types::ConfigError(
            file.string(), "",
            fmt::format("has posts {:g} m apart, so that a reach of {:g} m with tiles of {} posts takes {:.0f} a side; "
                        "at most {:.0f}: lower reach, or thin it out with gdalwarp -tr",
                        std::min(spacing.x, spacing.y), config.reach, config.tile, posts, max_posts));
}

void Bathymetry::addMaterial(Scene& scene) {
    if (findNode(scene, name) >= 0)
        throw types::ConfigError("", "", fmt::format("has a node {}, which is the name of the survey's floor", name));
    auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
    geometry->materials.emplace_back().name = name;
    scene.geometry = std::move(geometry);
}

/** Posts between which the floor reaches as far as it is to. The world's x is north of its zero, y west. */
PostWindow Bathymetry::postsAbout(const glm::dvec3& place) const {
    const glm::dvec2 middle = survey_.postAt(zero_ + glm::dvec2(-place.y, place.x));
    const glm::dvec2 half = config_.reach / glm::abs(survey_.spacing());
    const int column = wholeDown(middle.x - half.x), row = wholeDown(middle.y - half.y);
    return {column, row, wholeDown(middle.x + half.x) + 2 - column, wholeDown(middle.y + half.y) + 2 - row};
}

PostWindow Bathymetry::wholeTiles(const PostWindow& posts) const {
    const int tile = config_.tile;
    const int column = multipleDown(posts.column, tile), row = multipleDown(posts.row, tile);
    return {column, row, multipleDown(posts.column + posts.columns - 2, tile) + tile + 1 - column,
            multipleDown(posts.row + posts.rows - 2, tile) + tile + 1 - row};
}

PostWindow Bathymetry::clipped(PostWindow posts) const {
    const int end_column = std::min(posts.column + posts.columns, survey_.columns());
    const int end_row = std::min(posts.row + posts.rows, survey_.rows());
    posts.column = std::max(posts.column, 0);
    posts.row = std::max(posts.row, 0);
    posts.columns = std::max(end_column - posts.column, 0);
    posts.rows = std::max(end_row - posts.row, 0);
    return posts.isEmpty() ? PostWindow{} : posts;
}

types::Mesh Bathymetry::meshOf(const PostWindow& posts) const {
    const std::vector<float> values = survey_.read(posts);
    Surface surface;
    surface.positions.reserve(values.size());
    for (int row = 0, i = 0; row < posts.rows; ++row)
        for (int column = 0; column < posts.columns; ++column, ++i) {
            const glm::dvec2 at = survey_.place(posts.column + column, posts.row + row);
            const double up = double(values[static_cast<size_t>(i)]) * (config_.positive_down ? -1 : 1);
            surface.positions.emplace_back(at.y - zero_.y, zero_.x - at.x, up);
        }
    addTriangles(values, posts, survey_.spacing().x * survey_.spacing().y > 0, surface);
    types::Mesh mesh;
    mesh.name = name;
    DroppedTriangles dropped;
    cleanUp(surface, dropped);
    if (surface.indices.empty()) return mesh;
    appendSurface(surface, 0, mesh);
    return mesh;
}

types::GeometryPtr Bathymetry::about(const glm::dvec3& place, const types::GeometryPtr& rest) {
    const PostWindow needed = postsAbout(place);
    if (window_ && rest == rest_ && window_->holds(clipped(needed))) return geometry_;
    const PostWindow window = clipped(wholeTiles(needed));
    types::Mesh mesh;
    if (!window.isEmpty()) mesh = meshOf(window);
    auto geometry = std::make_shared<types::Geometry>(*rest);
    if (!mesh.indices.empty()) {
        const auto material = std::ranges::find(geometry->materials, name, &types::Material::name);
        for (types::Cluster& cluster : mesh.clusters)
            cluster.material = static_cast<int>(material - geometry->materials.begin());
        buildClusters(mesh);
        geometry->objects.push_back({name, static_cast<int>(geometry->meshes.size()), glm::dmat4(1)});
        geometry->meshes.push_back(std::move(mesh));
    }
    window_ = window;
    rest_ = rest;
    return geometry_ = std::move(geometry);
}

}  // namespace insonify::scene
