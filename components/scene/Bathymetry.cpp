#include "components/scene/Bathymetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <utility>

#include "components/loader/ComponentLibrary.hpp"
#include "components/scene/Clusters.hpp"
#include "components/scene/SurfaceMaps.hpp"
#include "types/geometry/WorldPlaces.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::scene {
namespace {

std::atomic<SurveyOpener>& opener() {
    static std::atomic<SurveyOpener> opener = nullptr;
    return opener;
}

/** Returns the opener of the component library. */
auto* libraryOpener(const std::filesystem::path& file) try {
    return loader::load("survey").entry<Survey*(const std::filesystem::path&, int)>("insonify_open_survey");
} catch (const types::ConfigError& error) {
    throw types::ConfigError(file.string(), "", error.diagnostics().front().text());
}

constexpr const char* floor_name = "bathymetry";  ///< Name of the object and of its material.
constexpr double max_posts = 4096;                ///< Max posts of a window along each side [1].

int wholeDown(double value) { return static_cast<int>(std::clamp(std::floor(value), -1e9, 1e9)); }

/** Returns the largest multiple of `step` that is not above a number. */
int multipleDown(int value, int step) { return wholeDown(double(value) / step) * step; }

/** Adds triangles between posts that have a value, counterclockwise from above if `is_turned` is false. */
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

/** Returns the part of a window that is in a survey. */
PostWindow clipped(PostWindow posts, const Survey& survey) {
    const int end_column = std::min(posts.column + posts.columns, survey.columns());
    const int end_row = std::min(posts.row + posts.rows, survey.rows());
    posts.column = std::max(posts.column, 0);
    posts.row = std::max(posts.row, 0);
    posts.columns = std::max(end_column - posts.column, 0);
    posts.rows = std::max(end_row - posts.row, 0);
    return posts.isEmpty() ? PostWindow{} : posts;
}

void checkUnit(const Survey& survey, const std::filesystem::path& file) {
    static const std::set<std::string> metres = {"", "m", "metre", "metres", "meter", "meters"};
    if (!metres.contains(survey.unit()))
        throw types::ConfigError(
            file.string(), "",
            "has elevations in " + survey.unit() + "; may be metres: gdal_calc.py -A IN --calc=A*0.3048 of feet");
}

/** @param tile size of a tile of the survey [m]. */
void checkTexels(const Survey& mosaic, const std::filesystem::path& file, const glm::dvec2& tile) {
    const glm::dvec2 texels = tile / glm::abs(mosaic.spacing());
    if (std::max(texels.x, texels.y) > max_posts)
        throw types::ConfigError(
            file.string(), "",
            fmt::format("has {:.0f} x {:.0f} values on a tile of the survey; at most {:.0f} a side: lower "
                        "`tile`, or thin it out with gdalwarp -tr",
                        texels.x, texels.y, max_posts));
}

}  // namespace

std::unique_ptr<Survey> openSurvey(const std::filesystem::path& file, int band) {
    if (const SurveyOpener given = opener()) return given(file, band);
    return std::unique_ptr<Survey>(libraryOpener(file)(file, band));
}

void setSurveyOpener(SurveyOpener given) { opener() = given; }

void BathymetryConfig::check(types::Diagnostics& diagnostics) const {
    if (file.empty()) diagnostics.push_back({"file", "is missing; give the path of a survey"});
    if (easting.has_value() != northing.has_value())
        diagnostics.push_back({easting ? "northing" : "easting", "is missing; give both, or neither"});
}

void MosaicConfig::check(types::Diagnostics& diagnostics) const {
    if (file.empty()) diagnostics.push_back({"file", "is missing; give the path of a mosaic"});
    meaning.check(diagnostics);
}

Bathymetry::Bathymetry(const BathymetryConfig& config, const std::filesystem::path& file,
                       const std::filesystem::path& map)
    : config_(config),
      survey_(openSurvey(file, config.band)),
      mosaic_(config.map ? openSurvey(map, config.map->band) : nullptr),
      zero_(survey_->place((survey_->columns() - 1) / 2.0, (survey_->rows() - 1) / 2.0)) {
    if (config.easting) zero_ = {*config.easting, *config.northing};
    checkUnit(*survey_, file);
    if (mosaic_) checkTexels(*mosaic_, map, double(config.tile) * glm::abs(survey_->spacing()));
    const glm::dvec2 spacing = glm::abs(survey_->spacing());
    const double posts = 2 * config.reach / std::min(spacing.x, spacing.y) + 2 * config.tile;
    if (posts > max_posts)
        throw types::ConfigError(
            file.string(), "",
            fmt::format("has posts {:g} m apart, so that a reach of {:g} m with tiles of {} posts takes {:.0f} a side; "
                        "at most {:.0f}: lower reach, or thin it out with gdalwarp -tr",
                        std::min(spacing.x, spacing.y), config.reach, config.tile, posts, max_posts));
}

void Bathymetry::addMaterials(Scene& scene, const BathymetryConfig& config) {
    if (findNode(scene, floor_name) >= 0)
        throw types::ConfigError("", "",
                                 fmt::format("has a node {}, which is the name of the survey's floor", floor_name));
    auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
    const size_t floor = geometry->materials.size();
    geometry->materials.emplace_back().name = floor_name;
    if (config.map) {
        types::Diagnostics diagnostics;
        materialsOf(config.map->meaning, "bathymetry.map.classes", *geometry, diagnostics);
        if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
        geometry->materials[floor].max_map_strength = config.map->meaning.maxStrength();
    }
    scene.geometry = std::move(geometry);
}

/** Returns the posts that enclose the floor within reach. The world's x is north of its origin, y west. */
PostWindow Bathymetry::postsAbout(const glm::dvec3& place) const {
    const glm::dvec2 middle = survey_->postAt(zero_ + glm::dvec2(-place.y, place.x));
    const glm::dvec2 half = config_.reach / glm::abs(survey_->spacing());
    const int column = wholeDown(middle.x - half.x), row = wholeDown(middle.y - half.y);
    return {column, row, wholeDown(middle.x + half.x) + 2 - column, wholeDown(middle.y + half.y) + 2 - row};
}

PostWindow Bathymetry::wholeTiles(const PostWindow& posts) const {
    const int tile = config_.tile;
    const int column = multipleDown(posts.column, tile), row = multipleDown(posts.row, tile);
    return {column, row, multipleDown(posts.column + posts.columns - 2, tile) + tile + 1 - column,
            multipleDown(posts.row + posts.rows - 2, tile) + tile + 1 - row};
}

std::vector<Bathymetry::Tile> Bathymetry::tilesOf(const PostWindow& posts) const {
    std::vector<Tile> tiles;
    if (posts.isEmpty()) return tiles;
    const auto below = [&](int value) { return multipleDown(value, config_.tile) / config_.tile; };
    for (int row = below(posts.row); row <= below(posts.row + posts.rows - 2); ++row)
        for (int column = below(posts.column); column <= below(posts.column + posts.columns - 2); ++column)
            tiles.emplace_back(column, row);
    return tiles;
}

void Bathymetry::addMap(const PostWindow& posts, const std::vector<int>& materials, Surface& surface,
                        types::Mesh& mesh) const {
    const glm::dvec2 first = mosaic_->postAt(survey_->place(posts.column, posts.row)),
                     last =
                         mosaic_->postAt(survey_->place(posts.column + posts.columns - 1, posts.row + posts.rows - 1));
    const glm::dvec2 low = glm::min(first, last), high = glm::max(first, last);
    const int column = wholeDown(low.x), row = wholeDown(low.y);
    const PostWindow texels{column, row, wholeDown(high.x) + 2 - column, wholeDown(high.y) + 2 - row};
    const PostWindow known = clipped(texels, *mosaic_);
    if (known.isEmpty()) return;
    std::vector<float> values(static_cast<size_t>(texels.columns) * static_cast<size_t>(texels.rows), NAN);
    const std::vector<float> read = mosaic_->read(known);
    for (int y = 0; y < known.rows; ++y)
        std::copy_n(read.begin() + std::ptrdiff_t{y} * known.columns, known.columns,
                    values.begin() + std::ptrdiff_t{known.row + y - texels.row} * texels.columns + known.column -
                        texels.column);
    types::SurfaceMap map =
        surfaceMap(values, texels.columns, texels.rows, config_.map->meaning, {materials.begin() + 1, materials.end()});
    map.repeat_u = map.repeat_v = false;
    mesh.maps.push_back({materials.front(), std::make_shared<const types::SurfaceMap>(std::move(map))});
    for (int y = 0; y < posts.rows; ++y)
        for (int x = 0; x < posts.columns; ++x) {
            const glm::dvec2 at = mosaic_->postAt(survey_->place(posts.column + x, posts.row + y));
            surface.map_uvs.emplace_back((at.x - texels.column + 0.5) / texels.columns,
                                         (at.y - texels.row + 0.5) / texels.rows);
        }
}

glm::dvec3 Bathymetry::inWorld(int column, int row) const {
    const glm::dvec2 at = survey_->place(column, row);
    return {at.y - zero_.y, zero_.x - at.x, 0};
}

glm::dvec3 Bathymetry::originOf(const Tile& tile) const {
    const glm::dvec3 first = inWorld(tile.first * config_.tile, tile.second * config_.tile);
    return types::isFarOut(first) ? first : glm::dvec3(0);
}

types::MeshPtr Bathymetry::meshOf(const Tile& tile, const std::vector<int>& materials) const {
    const PostWindow posts =
        clipped({tile.first * config_.tile, tile.second * config_.tile, config_.tile + 1, config_.tile + 1}, *survey_);
    if (posts.isEmpty()) return nullptr;
    const std::vector<float> values = survey_->read(posts);
    Surface surface;
    const glm::dvec3 origin = originOf(tile);
    surface.positions.reserve(values.size());
    for (int row = 0, i = 0; row < posts.rows; ++row)
        for (int column = 0; column < posts.columns; ++column, ++i) {
            const glm::dvec3 at = inWorld(posts.column + column, posts.row + row) - origin;
            const double up = double(values[static_cast<size_t>(i)]) * (config_.positive_down ? -1 : 1);
            surface.positions.emplace_back(at.x, at.y, up);
        }
    addTriangles(values, posts, survey_->spacing().x * survey_->spacing().y > 0, surface);
    types::Mesh mesh;
    mesh.name = floor_name;
    DroppedTriangles dropped;
    cleanUp(surface, dropped);
    if (surface.indices.empty()) return nullptr;
    if (mosaic_) addMap(posts, materials, surface, mesh);
    appendSurface(surface, materials.front(), mesh);
    buildClusters(mesh);
    return std::make_shared<types::Mesh>(std::move(mesh));
}

Bathymetry::~Bathymetry() {
    {
        const std::lock_guard alone(mutex_);
        quit_ = true;
    }
    asked_.notify_one();
    if (worker_.joinable()) worker_.join();
}

void Bathymetry::work() {
    types::useDefaultScheduling();
    for (std::unique_lock<std::mutex> lock(mutex_);;) {
        asked_.wait(lock, [this] { return quit_ || !queue_.empty(); });
        if (quit_) return;
        const Tile tile = queue_.front();
        const std::vector<int> materials = materials_;
        queue_.pop_front();
        lock.unlock();
        Read read{true, nullptr, nullptr};
        try {
            read.mesh = meshOf(tile, materials);
        } catch (...) {
            read.failure = std::current_exception();
        }
        lock.lock();
        const auto wanted = tiles_.find(tile);
        if (wanted != tiles_.end() && materials == materials_) wanted->second = std::move(read);
        read_.notify_all();
    }
}

void Bathymetry::ask(const std::vector<Tile>& tiles, bool first) {
    {
        const std::lock_guard alone(mutex_);
        std::deque<Tile> wanted;
        for (const Tile& tile : tiles) {
            const auto [at, is_new] = tiles_.try_emplace(tile);
            if (!is_new && first && !at->second.done && std::erase(queue_, tile) > 0) wanted.push_back(tile);
            if (is_new) wanted.push_back(tile);
        }
        queue_.insert(first ? queue_.begin() : queue_.end(), wanted.begin(), wanted.end());
    }
    if (!worker_.joinable()) worker_ = types::startThread("the tiles of a survey", [this] { work(); });
    asked_.notify_one();
}

void Bathymetry::keep(const std::vector<Tile>& tiles) {
    const std::lock_guard alone(mutex_);
    const auto is_over = [&](const Tile& tile) { return std::ranges::find(tiles, tile) == tiles.end(); };
    std::erase_if(queue_, is_over);
    std::erase_if(tiles_, [&](const auto& each) { return is_over(each.first); });
}

types::MeshPtr Bathymetry::wait(const Tile& tile) {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto read = tiles_.find(tile);
    if (!read->second.done) {
        const types::LentScheduling lent(worker_);
        read_.wait(lock, [&] { return read->second.done; });
    }
    if (!read->second.failure) return read->second.mesh;
    const std::exception_ptr failure = read->second.failure;
    tiles_.erase(read);
    std::rethrow_exception(failure);
}

types::GeometryPtr Bathymetry::about(const glm::dvec3& place, const types::GeometryPtr& rest) {
    const PostWindow needed = postsAbout(place);
    if (rest != rest_) {
        const auto indexOf = [&](const std::string& name) {
            const auto material = std::ranges::find(rest->materials, name, &types::Material::name);
            return static_cast<int>(material - rest->materials.begin());
        };
        keep({});
        const std::lock_guard alone(mutex_);
        materials_ = {indexOf(floor_name)};
        for (const auto& [value, name] : config_.map ? config_.map->meaning.classes : MapValues().classes)
            materials_.push_back(indexOf(name));
    }
    const bool is_there = window_ && rest == rest_ && window_->holds(clipped(needed, *survey_));
    const PostWindow window = is_there ? *window_ : clipped(wholeTiles(needed), *survey_);
    const int early = (config_.tile + 1) / 2;
    std::vector<Tile> tiles = tilesOf(window);
    around_ = tilesOf(clipped(
        {needed.column - early, needed.row - early, needed.columns + 2 * early, needed.rows + 2 * early}, *survey_));
    std::erase_if(around_, [&](const Tile& tile) { return std::ranges::find(tiles, tile) != tiles.end(); });
    if (!is_there) ask(tiles, true);
    ask(around_, false);
    if (is_there) return geometry_;
    auto geometry = std::make_shared<types::Geometry>(*rest);
    for (const Tile& tile : tiles) {
        types::MeshPtr mesh = wait(tile);
        if (!mesh) continue;
        const glm::dmat4 world_from_tile = glm::translate(glm::dmat4(1), originOf(tile));
        geometry->objects.push_back({floor_name, static_cast<int>(geometry->meshes.size()), world_from_tile, true});
        geometry->meshes.push_back(std::move(mesh));
    }
    tiles.insert(tiles.end(), around_.begin(), around_.end());
    keep(tiles);
    window_ = window;
    rest_ = rest;
    return geometry_ = std::move(geometry);
}

std::shared_ptr<const std::vector<types::MeshPtr>> Bathymetry::ahead() {
    std::vector<types::MeshPtr> meshes;
    const std::lock_guard alone(mutex_);
    for (const Tile& tile : around_)
        if (const auto read = tiles_.find(tile); read != tiles_.end() && read->second.mesh)
            meshes.push_back(read->second.mesh);
    if (!ahead_ || *ahead_ != meshes) ahead_ = std::make_shared<const std::vector<types::MeshPtr>>(std::move(meshes));
    return ahead_;
}

}  // namespace insonify::scene
