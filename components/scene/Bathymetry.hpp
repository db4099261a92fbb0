#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"
#include "components/scene/Surface.hpp"
#include "components/scene/Survey.hpp"
#include "types/Geometry.hpp"

namespace insonify::scene {

/** The part of a surveyed sea floor around the vehicle: objects "bathymetry" of that material, one for each tile of
 *  posts, in the axes of the world, after those of the scene. Tiles are read by a thread of its own. Those that the
 *  vehicle may need next are read before it comes to them; a tile that is needed earlier is waited for, so that the
 *  floor about a place does not depend on time. */
class Bathymetry {
public:
    /** `map`: file of the mosaic on it, where the configuration has one. Throws types::ConfigError for whatever is
     * wrong with the files, or when `reach` holds too many posts. */
    Bathymetry(const BathymetryConfig& config, const std::filesystem::path& file,
               const std::filesystem::path& map = {});
    ~Bathymetry();
    Bathymetry(const Bathymetry&) = delete;
    Bathymetry& operator=(const Bathymetry&) = delete;

    /** `rest` and the floor about a place in the world: the one of the call before as long as that reaches far enough
     *  on all sides, else one of whole tiles, of which those that both have are the same meshes. `rest` alone where the
     *  survey has nothing. Throws SurveyError where the file cannot be read on. */
    types::GeometryPtr about(const glm::dvec3& place, const types::GeometryPtr& rest);
    /** Meshes of tiles around the floor of the last call that have been read by now. */
    std::shared_ptr<const std::vector<types::MeshPtr>> ahead();

    /** Begins anew: what is there next follows from the place alone. */
    void forget() { window_.reset(); }

    /** Gives a scene the material that the floor has there, and those of the classes of its mosaic. Throws
     *  types::ConfigError for one that has an object of the floor's name, or for a class that is no material. */
    static void addMaterials(Scene& scene, const BathymetryConfig& config);

private:
    /** Column and row of the tile among all tiles of the survey. */
    using Tile = std::pair<int, int>;
    /** What has been read of a tile. */
    struct Read {
        bool done = false;
        types::MeshPtr mesh;         ///< Null where nothing was surveyed.
        std::exception_ptr failure;  ///< Why there is none.
    };
    PostWindow postsAbout(const glm::dvec3& place) const;
    PostWindow wholeTiles(const PostWindow& posts) const;
    std::vector<Tile> tilesOf(const PostWindow& posts) const;
    types::MeshPtr meshOf(const Tile& tile, const std::vector<int>& materials) const;
    /** Lays the mosaic on a tile, whose positions are those of posts. */
    void addMap(const PostWindow& posts, const std::vector<int>& materials, Surface& surface, types::Mesh& mesh) const;
    /** Asks for tiles that are neither there nor asked for, before or after all others that are. */
    void ask(const std::vector<Tile>& tiles, bool first);
    /** Forgets all tiles but these. */
    void keep(const std::vector<Tile>& tiles);
    /** Waits for a tile that was asked for. Throws why it cannot be read; it may then be asked for again. */
    types::MeshPtr wait(const Tile& tile);
    void work();

    BathymetryConfig config_;
    std::unique_ptr<const Survey> survey_, mosaic_;  ///< Read by the worker alone; null: there is no mosaic.
    glm::dvec2 zero_;                                ///< Easting and northing of the world's zero [m].
    std::optional<PostWindow> window_;
    types::GeometryPtr geometry_, rest_;  ///< Of the window, and what it was made with.
    std::vector<Tile> around_;            ///< Tiles that the next window may have beside those of this one.
    std::shared_ptr<const std::vector<types::MeshPtr>> ahead_;

    std::mutex mutex_;
    std::condition_variable asked_, read_;
    std::map<Tile, Read> tiles_;
    std::deque<Tile> queue_;
    std::vector<int> materials_{0};  ///< Of the floor and of the classes of its mosaic, in `rest`.
    bool quit_ = false;
    std::thread worker_;
};

}  // namespace insonify::scene
