#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"
#include "components/scene/Surface.hpp"
#include "components/scene/Survey.hpp"
#include "types/Geometry.hpp"
#include "types/Thread.hpp"

namespace insonify::scene {

/** The part of a surveyed sea floor around the vehicle.
 *
 *  The floor consists of objects named "bathymetry", one per tile of posts, in the axes of the world. They follow the
 *  objects of the scene and have the material "bathymetry". A separate thread reads the tiles, beginning before the
 *  vehicle needs them, without a realtime priority. A tile that is needed earlier is waited for, at the priority of the
 *  waiting thread, so that the floor around a place does not depend on time. */
class Bathymetry {
public:
    /** @param map file of the mosaic on the floor, if the configuration has one.
     *
     *  Throws types::ConfigError for any error in the files, or when `reach` covers too many posts. */
    Bathymetry(const BathymetryConfig& config, const std::filesystem::path& file,
               const std::filesystem::path& map = {});
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
    PostWindow postsAbout(const glm::dvec3& place) const;
    PostWindow wholeTiles(const PostWindow& posts) const;
    std::vector<Tile> tilesOf(const PostWindow& posts) const;
    /** Returns the place of a post in the world, at height 0. */
    glm::dvec3 inWorld(int column, int row) const;
    /** Returns the origin of a tile's mesh in the world: its first post if that is far from the world's, else the
     * world's. */
    glm::dvec3 originOf(const Tile& tile) const;
    types::MeshPtr meshOf(const Tile& tile, const std::vector<int>& materials) const;
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
    glm::dvec2 zero_;                                ///< Easting and northing of the world's origin [m].
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
