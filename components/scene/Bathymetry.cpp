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
#include "types/geometry/Angle.hpp"
#include "types/geometry/WorldFrame.hpp"
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

constexpr double far_off = -1e9;  ///< Column and row of places that are not on the map [1].
const types::Axes enu_axes{types::WorldFrame::Enu};

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

/** Checks that a survey without a datum is in metres. */
void checkMetres(const Survey& survey, const std::filesystem::path& file, bool has_datum) {
    if (survey.isInDegrees() && !has_datum)
        throw types::ConfigError(
            file.string(), "",
            "is in degrees; give the deployment a datum, the world's origin on the earth, or project "
            "it to metres: gdalwarp -t_srs EPSG:32632 IN OUT, with the zone of yours");
}

void checkSameUnit(const Survey& mosaic, const std::filesystem::path& file, const Survey& survey) {
    const auto findUnit = [](const Survey& map) { return map.isInDegrees() ? "degrees" : "metres"; };
    if (mosaic.isInDegrees() != survey.isInDegrees())
        throw types::ConfigError(file.string(), "",
                                 fmt::format("is in {}, and the survey in {}; project it to the survey's map: gdalwarp "
                                             "-t_srs EPSG:32632 IN OUT, with the map of yours",
                                             findUnit(mosaic), findUnit(survey)));
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

SurveyPlaces::SurveyPlaces(const Survey& survey, const BathymetryConfig& config,
                           const std::optional<types::Datum>& datum)
    : survey_(survey), zero_(survey.place((survey.columns() - 1) / 2.0, (survey.rows() - 1) / 2.0)), datum_(datum) {
    if (config.easting) zero_ = {*config.easting, *config.northing};
    if (!datum) return;
    to_map_ = survey.toMap();
    to_earth_ = survey.toEarth();
}

void SurveyPlaces::toWorld(std::vector<glm::dvec3>& posts) const {
    std::vector<glm::dvec2> map;
    map.reserve(posts.size());
    for (const glm::dvec3& post : posts) map.push_back(survey_.place(post.x, post.y));
    if (datum_) to_earth_(map);
    for (size_t i = 0; i < posts.size(); ++i) {
        const double up = posts[i].z;
        if (datum_) {
            const double height = datum_->height_m + (std::isfinite(up) ? up : 0);
            posts[i] = enu_axes.rockFromWorld(eastNorthUp(*datum_, {map[i].y, map[i].x, height}));
            if (!std::isfinite(up)) posts[i].z = NAN;
        } else {
            posts[i] = {map[i].y - zero_.y, zero_.x - map[i].x, up};
        }
    }
}

glm::dvec3 SurveyPlaces::inWorld(const glm::dvec3& post) const {
    std::vector<glm::dvec3> posts{post};
    toWorld(posts);
    return posts.front();
}

std::pair<glm::dvec2, glm::dvec2> SurveyPlaces::around(const glm::dvec3& place, double reach) const {
    if (!datum_) {
        const glm::dvec2 middle = survey_.postAt(zero_ + glm::dvec2(-place.y, place.x));
        const glm::dvec2 half = reach / glm::abs(survey_.spacing());
        return {middle - half, middle + half};
    }
    std::vector<glm::dvec2> rim;
    for (const double x : {-reach, 0.0, reach})
        for (const double y : {-reach, 0.0, reach}) {
            const types::Datum at = geodetic(*datum_, enu_axes.worldFromRock(place + glm::dvec3(x, y, 0)));
            rim.emplace_back(at.longitude_deg, at.latitude_deg);
        }
    to_map_(rim);
    glm::dvec2 low = survey_.postAt(rim.front()), high = low;
    for (const glm::dvec2& at : rim) {
        if (!std::isfinite(at.x + at.y)) return {glm::dvec2(far_off), glm::dvec2(far_off)};
        low = glm::min(low, survey_.postAt(at));
        high = glm::max(high, survey_.postAt(at));
    }
    return {low, high};
}

Bathymetry::Bathymetry(const BathymetryConfig& config, const std::filesystem::path& file,
                       const std::filesystem::path& map, const std::optional<types::Datum>& datum)
    : config_(config),
      survey_(openSurvey(file, config.band)),
      mosaic_(config.map ? openSurvey(map, config.map->band) : nullptr),
      datum_(datum),
      places_(*survey_, config, datum),
      worker_places_(*survey_, config, datum) {
    checkMetres(*survey_, file, datum.has_value());
    if (mosaic_) checkSameUnit(*mosaic_, map, *survey_);
    checkUnit(*survey_, file);
    checkDatum(file);
    if (mosaic_) checkTexels(*mosaic_, map, double(config.tile) * glm::abs(survey_->spacing()));
    const glm::dvec2 spacing = groundSpacing();
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
        getMaterials(config.map->meaning, "bathymetry.map.classes", *geometry, diagnostics);
        if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
        geometry->materials[floor].max_map_strength = config.map->meaning.maxStrength();
    }
    scene.geometry = std::move(geometry);
}

void Bathymetry::checkDatum(const std::filesystem::path& file) const {
    if (!datum_) return;
    const glm::dvec2 post = places_.around({}, 0).first;
    const glm::dvec2 last(survey_->columns() - 0.5, survey_->rows() - 0.5);
    if (post.x >= -0.5 && post.y >= -0.5 && post.x <= last.x && post.y <= last.y) return;
    const glm::dvec2 a = survey_->place(-0.5, -0.5), b = survey_->place(last.x, last.y),
                     at = survey_->place(post.x, post.y);
    throw types::ConfigError(
        file.string(), "",
        fmt::format(
            "reaches from easting {:.9g} to {:.9g} and from northing {:.9g} to {:.9g} on its map; the datum {} is {}"
            "outside: give a datum within the survey, latitude and longitude not exchanged",
            std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y), text(*datum_),
            post.x == far_off ? "" : fmt::format("at {:.9g}, {:.9g}, ", at.x, at.y)));
}

glm::dvec2 Bathymetry::groundSpacing() const {
    if (!datum_) return glm::abs(survey_->spacing());
    const glm::dvec3 post(places_.around({}, 0).first, 0);
    const auto to = [&](double columns, double rows) {
        return glm::distance(places_.inWorld(post), places_.inWorld(post + glm::dvec3(columns, rows, 0)));
    };
    return {to(1, 0), to(0, 1)};
}

std::string Bathymetry::placeText() const {
    if (!datum_) return "";
    const glm::dvec2 post = places_.around({}, 0).first, at = survey_->place(post.x, post.y),
                     above = survey_->postAt(at + glm::dvec2(0, std::abs(survey_->spacing().y)));
    const glm::dvec3 north = places_.inWorld({above, 0}) - places_.inWorld({post, 0});
    const std::string scale = survey_->isInDegrees() ? ""
                                                     : fmt::format(", and a metre on it is {:.6f} m on the ground",
                                                                   glm::length(north) / std::abs(survey_->spacing().y));
    return fmt::format(
        "bathymetry: the datum is at easting {:.10g}, northing {:.10g} of the map, whose north is turned by "
        "{:.4f} degrees to the east{}",
        at.x, at.y, types::degrees(std::atan2(-north.y, north.x)), scale);
}

/** Returns the posts that enclose the floor within reach. */
PostWindow Bathymetry::postsAbout(const glm::dvec3& place) const {
    const auto [low, high] = places_.around(place, config_.reach);
    const int column = wholeDown(low.x), row = wholeDown(low.y);
    return {column, row, wholeDown(high.x) + 2 - column, wholeDown(high.y) + 2 - row};
}

PostWindow Bathymetry::wholeTiles(const PostWindow& posts) const {
    const int tile = config_.tile;
    const int column = multipleDown(posts.column, tile), row = multipleDown(posts.row, tile);
    return {column, row, multipleDown(posts.column + posts.columns - 2, tile) + tile + 1 - column,
            multipleDown(posts.row + posts.rows - 2, tile) + tile + 1 - row};
}

std::vector<Bathymetry::Tile> Bathymetry::makeTiles(const PostWindow& posts) const {
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

glm::dvec3 Bathymetry::getOrigin(const Tile& tile, const SurveyPlaces& places) const {
    const glm::dvec3 first = places.inWorld({tile.first * config_.tile, tile.second * config_.tile, 0});
    return types::isFarOut(first) ? first : glm::dvec3(0);
}

types::MeshPtr Bathymetry::getMesh(const Tile& tile, const std::vector<int>& materials) const {
    const PostWindow posts =
        clipped({tile.first * config_.tile, tile.second * config_.tile, config_.tile + 1, config_.tile + 1}, *survey_);
    if (posts.isEmpty()) return nullptr;
    std::vector<float> values = survey_->read(posts);
    Surface surface;
    const glm::dvec3 origin = getOrigin(tile, worker_places_);
    std::vector<glm::dvec3> places;
    places.reserve(values.size());
    for (int row = 0; row < posts.rows; ++row)
        for (int column = 0; column < posts.columns; ++column)
            places.emplace_back(posts.column + column, posts.row + row,
                                double(values[places.size()]) * (config_.positive_down ? -1 : 1));
    worker_places_.toWorld(places);
    surface.positions.reserve(values.size());
    for (const glm::dvec3& at : places) {
        if (!std::isfinite(at.x + at.y)) values[surface.positions.size()] = NAN;
        surface.positions.emplace_back(at - origin);
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
            read.mesh = getMesh(tile, materials);
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
        const auto findIndex = [&](const std::string& name) {
            const auto material = std::ranges::find(rest->materials, name, &types::Material::name);
            return static_cast<int>(material - rest->materials.begin());
        };
        keep({});
        const std::lock_guard alone(mutex_);
        materials_ = {findIndex(floor_name)};
        for (const auto& [value, name] : config_.map ? config_.map->meaning.classes : MapValues().classes)
            materials_.push_back(findIndex(name));
    }
    const bool is_there = window_ && rest == rest_ && window_->holds(clipped(needed, *survey_));
    const PostWindow window = is_there ? *window_ : clipped(wholeTiles(needed), *survey_);
    const int early = (config_.tile + 1) / 2;
    std::vector<Tile> tiles = makeTiles(window);
    around_ = makeTiles(clipped(
        {needed.column - early, needed.row - early, needed.columns + 2 * early, needed.rows + 2 * early}, *survey_));
    std::erase_if(around_, [&](const Tile& tile) { return std::ranges::find(tiles, tile) != tiles.end(); });
    if (!is_there) ask(tiles, true);
    ask(around_, false);
    if (is_there) return geometry_;
    auto geometry = std::make_shared<types::Geometry>(*rest);
    for (const Tile& tile : tiles) {
        types::MeshPtr mesh = wait(tile);
        if (!mesh) continue;
        const glm::dmat4 world_from_tile = glm::translate(glm::dmat4(1), getOrigin(tile, places_));
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
