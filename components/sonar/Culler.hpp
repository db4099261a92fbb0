#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/Interface.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** What may be left out of a picture. */
struct CullRules {
    double range_min, range_max;  ///< Slant ranges that are drawn [m].
    double pixels = 0;      ///< A surface may be so far from its place where that takes fewer triangles: across the
                            ///< line of sight, of a pixel's smaller side there; 0: all detail is drawn [1],
    double metres = 0;      ///< and at most [m].
    bool draw_all = false;  ///< Nothing is culled.
};

/** Chooses what of a scene is drawn: objects, and clusters of triangles in them, whose boxes reach a
 *  slab's view within the range; of patches of which no more can be told apart, what stands for them; and of the
 *  clusters of a closed, single-sided mesh not those that turn their backs. */
class Culler {
public:
    /** One draw: a run of triangles of one object and material; first_index counts within the indices of the object's
     *  mesh, after which come its coarse_indices. */
    struct Run {
        uint32_t object, first_index, index_count;
        int material;
        uint32_t stands_for =
            0;  ///< Indices of the finest triangles for which these are drawn; 0: they are the finest.
    };

    /** `geometry` must outlive the culler. */
    Culler(const types::Geometry& geometry, const CullRules& rules);

    /** Places all objects relative to the sonar; once a ping, before `visible`. */
    void place(const types::Snapshot& snapshot);
    /** Runs that a slab may see, neighbours joined; of detail, what deviates by `share` of what the rules allow is
     *  left out. */
    void visible(const Slab& slab, std::vector<Run>& runs, double share = 1) const;
    const std::vector<ObjectRecord>& records() const { return records_; }
    size_t runLimit() const { return run_limit_; }  ///< Of what `visible` gives.

private:
    using View = std::array<glm::vec3, 5>;
    vec4 extent(size_t index, const glm::dmat4& sonar_from_object) const;
    void placeObject(size_t index, const glm::dmat4& sonar_from_object);
    /** What is asked of the parts of an object. */
    struct Query {
        size_t object;
        const View& view;
        double pixels, metres;            ///< A surface may be off by so much for each metre of range, and at most.
        std::optional<glm::vec3> before;  ///< Place of the sonar before the object's front, in its axes [m].
    };
    std::optional<glm::vec3> before(size_t object, float distance) const;
    void addObject(const Query& query, std::vector<Run>& runs) const;
    void addClusters(const Query& query, std::span<const types::Cluster> clusters, std::vector<Run>& runs) const;
    /** How the triangles of a patch of a closed mesh face the sonar: some and some not at the limb, where a surface
     *  leans to the line of sight and a small step aside is a large one along it. */
    enum class Turn { Front, Limb, Back };
    Turn turnOf(const Query& query, const types::Patch& patch) const;
    bool isSingleSided(const types::Cluster& cluster) const;
    bool turnsItsBack(const Query& query, const types::Cluster& cluster) const;
    /** Distance that a box along an object's axes has at least [m]; infinite when it is out of view or range. */
    float nearest(const View& view, const ObjectRecord& object, glm::vec3 centre, glm::vec3 half) const;

    const types::Geometry& geometry_;
    CullRules rules_;
    float range_max_;
    struct Box {
        glm::dvec3 low{0}, high{0};
    };
    std::vector<Box> mesh_boxes_;  ///< In mesh coordinates.
    std::vector<glm::dmat4> world_from_object_;
    std::vector<ObjectRecord> records_;
    std::vector<double> scales_;  ///< The most by which each object may stretch lengths [1].
    std::vector<bool> far_;       ///< Out of range: their records are not of this ping.
    size_t run_limit_ = 0;
};

}  // namespace insonify::sonar
