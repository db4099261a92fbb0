#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"
#include "components/scene/Surface.hpp"
#include "types/Thread.hpp"
#include "types/geometry/Datum.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::scene {

/** A rectangle of the posts of a survey. */
struct PostWindow {
    int column = 0, row = 0, columns = 0, rows = 0;

    bool isEmpty() const { return columns <= 0 || rows <= 0; }
    bool holds(const PostWindow& other) const {
        return column <= other.column && row <= other.row && other.column + other.columns <= column + columns &&
               other.row + other.rows <= row + rows;
    }
    friend bool operator==(const PostWindow&, const PostWindow&) = default;
};

/** The reason why a survey cannot be read any further. */
class SurveyError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/** A surveyed sea floor: elevations at posts of a grid on a map, in a file that is read by blocks. Only the requested
 *  windows are read, so a file, or the files of a mosaic, may be larger than memory. */
class Survey {
public:
    virtual ~Survey() = default;

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /** Returns whether the map is in degrees of longitude and latitude, which then take the place of metres. */
    bool isInDegrees() const { return is_in_degrees_; }
    /** Returns the distance from one post to the next, east and north [m]. North is usually negative: most files store
     *  rows from north to south. */
    glm::dvec2 spacing() const { return spacing_; }
    /** Returns the unit of the values as the file names it; empty if the file names none. */
    const std::string& unit() const { return unit_; }
    /** Returns the easting and northing of a post [m]. Column and row may be fractions. */
    glm::dvec2 place(double column, double row) const { return first_ + spacing_ * glm::dvec2(column, row); }
    /** Returns the column and row at an easting and northing. */
    glm::dvec2 postAt(const glm::dvec2& place) const { return (place - first_) / spacing_; }

    /** Returns the values of a window, row by row, as they are in the file [m]; NaN where the file has none. Throws
     *  SurveyError with the reason. */
    virtual std::vector<float> read(const PostWindow& window) const = 0;

    /** Converts places in the list; those that have no counterpart become infinite. For one thread at a time. */
    using Conversion = std::function<void(std::vector<glm::dvec2>& places)>;
    /** Returns the conversion of longitudes and latitudes of WGS 84 [deg] to eastings and northings [m]. Throws
     *  types::ConfigError if the file does not name its map. */
    virtual Conversion toMap() const = 0;
    /** Returns the inverse conversion. Throws as toMap(). */
    virtual Conversion toEarth() const = 0;

protected:
    int columns_ = 0, rows_ = 0;
    glm::dvec2 first_{0}, spacing_{1};
    std::string unit_;
    bool is_in_degrees_ = false;
};

using SurveyOpener = std::unique_ptr<Survey> (*)(const std::filesystem::path& file, int band);

/** Opens a band of a file by the component library survey. Throws types::ConfigError if the library is absent, or if
 *  the file is not a survey, or is rotated against north. */
std::unique_ptr<Survey> openSurvey(const std::filesystem::path& file, int band);

/** Replaces the opener that openSurvey() uses, for programs that are linked with their opener. */
void setSurveyOpener(SurveyOpener opener);

/** The places of a survey's posts in the world, x north, y west, z up. For one thread at a time.
 *
 *  Without a datum the world has the axes of the map: its zero is a place on the map, and z is the elevation. With a
 *  datum each post is where east, north and up of the datum have it: at its longitude and latitude by the map's own
 *  projection, at the datum's height plus its elevation. So the world's north is true north, its metres are those of
 * the ground, and the floor curves down with the earth, 0.08 m at 1 km. */
class SurveyPlaces {
public:
    /** Throws types::ConfigError if there is a datum and the survey does not name its map. */
    SurveyPlaces(const Survey& survey, const BathymetryConfig& config, const std::optional<types::Datum>& datum);

    /** Converts columns, rows and elevations of posts to places in the world [m]. z of an elevation that is not finite
     * is NaN. */
    void toWorld(std::vector<glm::dvec3>& posts) const;
    glm::dvec3 inWorld(const glm::dvec3& post) const;
    /** Returns the lowest and highest column and row within a distance of a place in the world [m]. */
    std::pair<glm::dvec2, glm::dvec2> around(const glm::dvec3& place, double reach) const;

private:
    const Survey& survey_;
    glm::dvec2 zero_{0};  ///< Easting and northing of the world's origin, without a datum [m].
    std::optional<types::Datum> datum_;
    Survey::Conversion to_map_, to_earth_;  ///< With a datum.
};

/** The part of a surveyed sea floor around the vehicle.
 *
 *  The floor consists of objects named "bathymetry", one per tile of posts, in the axes of the world. They follow the
 *  objects of the scene and have the material "bathymetry". A separate thread reads the tiles, beginning before the
 *  vehicle needs them, without a realtime priority. A tile that is needed earlier is waited for, at the priority of the
 *  waiting thread, so that the floor around a place does not depend on time. */
class Bathymetry {
public:
    /** @param map file of the mosaic on the floor, if the configuration has one
     *  @param datum the world's origin on the earth; none: a place on the map
     *
     *  Throws types::ConfigError for any error in the files, when `reach` covers too many posts, or for a datum outside
     *  of the survey. */
    Bathymetry(const BathymetryConfig& config, const std::filesystem::path& file, const std::filesystem::path& map = {},
               const std::optional<types::Datum>& datum = {});
    ~Bathymetry();
    Bathymetry(const Bathymetry&) = delete;
    Bathymetry& operator=(const Bathymetry&) = delete;

    /** Returns `rest` together with the floor around a place in the world. The floor of the previous call is reused
     *  while it reaches far enough on all sides. Otherwise the floor is made anew of whole tiles; tiles that both
     *  floors have keep their meshes. Returns `rest` alone where the survey has no values. Throws SurveyError when the
     *  file cannot be read any further. */
    types::GeometryPtr about(const glm::dvec3& place, const types::GeometryPtr& rest);
    /** Returns the meshes of tiles around the floor of the last call that have already been read. */
    std::shared_ptr<const std::vector<types::MeshPtr>> ahead();

    /** Returns where the datum is on the map, and how the map is turned and scaled there; empty without a datum. */
    std::string placeText() const;

    /** Forgets the previous floor: the next one follows from the place alone. */
    void forget() { window_.reset(); }

    /** Adds the floor's material and the materials of its mosaic's classes to a scene. Throws types::ConfigError if an
     *  object of the scene has the floor's name, or if a class is not a material. */
    static void addMaterials(Scene& scene, const BathymetryConfig& config);

private:
    /** Column and row of a tile among all tiles of the survey. */
    using Tile = std::pair<int, int>;
    /** The result of reading a tile. */
    struct Read {
        bool done = false;
        types::MeshPtr mesh;         ///< Null where the survey has no values.
        std::exception_ptr failure;  ///< The reason why there is no mesh.
    };
    /** Throws types::ConfigError if the datum is outside of the survey. */
    void checkDatum(const std::filesystem::path& file) const;
    /** Returns the distance from one post to the next on the ground, east and north, at the world's zero [m]. */
    glm::dvec2 groundSpacing() const;
    PostWindow postsAbout(const glm::dvec3& place) const;
    PostWindow wholeTiles(const PostWindow& posts) const;
    std::vector<Tile> makeTiles(const PostWindow& posts) const;
    /** Returns the origin of a tile's mesh in the world: its first post if that is far from the world's, else the
     * world's. */
    glm::dvec3 getOrigin(const Tile& tile, const SurveyPlaces& places) const;
    types::MeshPtr getMesh(const Tile& tile, const std::vector<int>& materials) const;
    /** Maps the mosaic onto a tile, whose positions are those of posts. */
    void addMap(const PostWindow& posts, const std::vector<int>& materials, Surface& surface, types::Mesh& mesh) const;
    /** Queues the tiles that are neither read nor queued, before or after all others in the queue. */
    void ask(const std::vector<Tile>& tiles, bool first);
    /** Forgets all other tiles. */
    void keep(const std::vector<Tile>& tiles);
    /** Waits for a queued tile. Throws the error if the tile cannot be read; the tile may then be queued again. */
    types::MeshPtr wait(const Tile& tile);
    void work();

    BathymetryConfig config_;
    std::unique_ptr<const Survey> survey_, mosaic_;  ///< Read by the worker alone; null: no mosaic.
    std::optional<types::Datum> datum_;
    SurveyPlaces places_, worker_places_;  ///< The second is the worker's.
    std::optional<PostWindow> window_;
    types::GeometryPtr geometry_, rest_;  ///< The geometry of `window_`, and the rest that it was made with.
    std::vector<Tile> around_;            ///< Tiles that the next window may have in addition to the tiles of this one.
    std::shared_ptr<const std::vector<types::MeshPtr>> ahead_;

    types::PriorityMutex mutex_;
    std::condition_variable asked_, read_;
    std::map<Tile, Read> tiles_;
    std::deque<Tile> queue_;
    std::vector<int> materials_{0};  ///< Indices in `rest` of the materials of the floor and of its mosaic's classes.
    bool quit_ = false;
    std::thread worker_;
};

}  // namespace insonify::scene
