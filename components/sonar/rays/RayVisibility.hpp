#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/rays/AngularView.hpp"
#include "components/sonar/rays/SceneTrees.hpp"
#include "types/geometry/Snapshot.hpp"

struct RTCRayHit16;

namespace insonify::sonar {

class RayPaths;

/** Directions of a tile's rays in sonar axes, of any length above 0 [1]; `active`: bit i is set if ray i is traced. */
struct TileRays {
    alignas(64) float x[tile_samples], y[tile_samples], z[tile_samples];
    uint32_t active = 0xffff;
};

/** First hits of the rays of a tile. */
struct TileHits {
    static constexpr uint32_t nothing = 0xffffffff;

    alignas(64) uint32_t command[tile_samples];  ///< Index into RayVisibility::commands(), or `nothing`.
    uint32_t triangle[tile_samples];             ///< Within the mesh of the command's object [1].
    float u[tile_samples], v[tile_samples];  ///< Barycentric coordinates of the triangle's second and third corner [1].
    float distance[tile_samples];            ///< In lengths of the ray's direction [1].
    float range[tile_samples];               ///< Slant range, set by traceAlong() only [m].
};

/** Rays of a tile with any origins, sonar axes; distances along them in lengths of their directions. */
struct PathRays {
    alignas(64) float from_x[tile_samples], from_y[tile_samples], from_z[tile_samples];  ///< [m]
    TileRays towards;
    alignas(64) float nearest[tile_samples], farthest[tile_samples];  ///< Hits are between these [1].
};

/** Finds the visible triangles by rays on the processor (Embree).
 *
 *  Objects at rest form one tree about an origin near the sonar, on a coarse grid, so that world coordinates may be
 *  large. Each object that may move, or is transient, has a tree of its mesh, which is placed anew and never rebuilt.
 *  Objects that deform have trees that are refitted to their meshes in each ping. All trees are shared with other
 * renderers of the same meshes. Surfaces nearer than `nearest` are not seen. */
class RayVisibility {
public:
    static constexpr double nearest = 1e-3;     ///< [m]
    static constexpr size_t tiles_at_once = 4;  ///< Tiles that are traced together, which is faster [1].

    /** @param deforming  objects whose meshes change from ping to ping, ascending.
     *  The geometry must outlive it. Throws std::runtime_error where Embree refuses it. */
    explicit RayVisibility(const types::Geometry& geometry, std::span<const uint32_t> deforming = {});
    ~RayVisibility();

    /** Switches to another geometry from the next ping on, which must outlive it. Keeps trees of unchanged objects. */
    void setScene(const types::Geometry& geometry, std::span<const uint32_t> deforming = {});

    /** Forgets which objects have moved. Trees stay until the next ping has reused those that it needs. */
    void forget();

    /** Places the sonar and the moving objects; call it once per ping. Builds a tree in the first ping, when an object
     *  moves that no snapshot has called movable, and when the sonar jumps near another origin than the last two; the
     *  trees of origins that it approaches are built ahead. Allocates only where origins or objects change. What is
     *  seen depends on the snapshot alone, not on the pings before. */
    void place(const types::Snapshot& snapshot);
    /** Fits the trees of every parts-th object that deforms from the part-th on, after place(). Parts may run at a
     * time.
     */
    void fitDeforming(size_t part, size_t parts);
    /** Ends the fitting, before anything is cast. */
    void joinDeforming();
    /** The meshes of objects that deform have other shapes now. */
    void updateShapes() { is_fitted_ = false; }
    /** Whether trees of objects that deform are to be fitted in this ping. */
    bool needsFitting() const { return !deforming_.isEmpty() && !is_fitted_; }

    /** Traces tiles from the sonar, at most `tiles_at_once`, which should be neighbours: hits[i] are the hits of
     *  rays[i]. Thread-safe. */
    void trace(std::span<const TileRays> rays, std::span<TileHits> hits) const;

    /** Finds the first hits of rays with other origins. */
    void trace(const PathRays& rays, TileHits& hits) const;
    /** Returns the active rays, as bits, that hit anything. */
    uint32_t blocked(const PathRays& rays) const;
    /** Traces a tile along paths that are not straight, by straight pieces between their corners. */
    void traceAlong(const RayPaths& paths, const TileRays& rays, TileHits& hits) const;

    /** Returns whether all trees are built that the sonar may need next. */
    bool hasTreesAhead() const { return trees_ahead_.isDone(); }

    /** Returns the commands that hits refer to: one for each object and run of one material. */
    const std::vector<CommandRecord>& commands() const { return commands_; }

private:
    struct Mover;
    struct Tree;
    /** Places of a tile's rays, sonar axes about the sonar [m]. */
    using Places = std::array<glm::vec3, tile_samples>;
    /** Part of the paths of a tile's rays between two ranges [m]. */
    struct Piece {
        double start, end;
        Places from, to;
    };
    void tracePiece(const RayPaths& paths, const TileRays& rays, const Piece& piece, RTCRayHit16& all,
                    TileHits& hits) const;
    void listCommands();
    bool hasNewMover(const types::Snapshot& snapshot) const;
    bool isStill(uint32_t object) const { return !moves_[object] && !doesDeform(object); }
    /** Records the objects of a snapshot as moving; every tree is to be rebuilt. */
    void forgetTrees(const types::Snapshot& snapshot);
    /** Lists the objects at rest, and those that have trees of their meshes. */
    void sortObjects();
    void build(const glm::dvec3& origin);
    void placeMovers(const types::Snapshot& snapshot);
    void placeDeforming(const types::Snapshot& snapshot);
    bool doesDeform(size_t object) const { return !deforms_.empty() && deforms_[object]; }
    void tracePieceAtDeforming(const RayPaths& paths, const TileRays& rays, const Piece& piece, const int* valid,
                               RTCRayHit16& all, TileHits& hits) const;
    void traceToMovers(const TileRays& rays, RTCRayHit16& all, TileHits& hits) const;

    const types::Geometry* geometry_;
    std::vector<CommandRecord> commands_;
    std::vector<uint32_t> first_command_;  ///< First command of each object.
    std::vector<bool> moves_;              ///< Whether an object has ever moved, or been movable.
    TreesAhead::Objects still_;            ///< Objects of the tree at rest, in the world; null: to be sorted out.
    std::vector<TreeObject> apart_;        ///< Objects at rest with trees of their meshes, in the world.
    TreesAhead trees_ahead_;
    std::vector<bool> deforms_;  ///< Whether each object deforms; empty if no object does.
    DeformingTrees deforming_;
    std::vector<glm::dmat4> deforming_places_;  ///< Places of the deforming objects about the origin.
    bool is_fitted_ = false;                    ///< Whether the trees match these places and the present meshes.
    /** The scene about the current origin, and about the one before, for a sonar that moves between the two. */
    std::unique_ptr<Tree> here_, before_;
    glm::mat3 world_from_sonar_;  ///< [1]
    glm::vec3 place_{0};          ///< Place of the sonar about the origin [m].
};

}  // namespace insonify::sonar
