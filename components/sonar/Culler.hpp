#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/ObjectPlaces.hpp"

namespace insonify::sonar {

/** What may be left out of a picture. */
struct CullRules {
    double range_min;       ///< Slant range from which on is drawn [m].
    Reach reach;            ///< Beyond it nothing is.
    bool draw_all = false;  ///< Nothing is culled.
};

/** Chooses what of a scene is drawn: objects, and clusters of triangles in them, whose boxes reach a frustum's view
 * within the range; of the clusters of a closed, single-sided mesh not those that turn their backs. They are drawn with
 * all their triangles: of a rough floor no fewer keep the echo within 0.005 (rel_l2_tvg). */
class Culler {
public:
    /** One draw: a run of triangles of one object and material; first_index counts within the indices of the object's
     *  mesh. */
    struct DrawRange {
        uint32_t object, first_index, index_count;
        int material;
    };

    /** `geometry` must outlive the culler. */
    Culler(const types::Geometry& geometry, const CullRules& rules);

    /** Places all objects relative to the sonar; once a ping, before `visible`. */
    void place(const types::Snapshot& snapshot) { places_.place(snapshot); }
    /** Runs that a frustum may see, neighbours joined. */
    void visible(const ViewFrustum& frustum, std::vector<DrawRange>& ranges) const;
    const std::vector<ObjectRecord>& records() const { return places_.records(); }
    size_t drawRangeLimit() const { return draw_range_limit_; }  ///< Of what `visible` gives.

private:
    using View = std::array<glm::vec3, 5>;
    /** What is asked of the parts of an object. */
    struct Query {
        size_t object;
        const View& view;
        std::optional<glm::vec3> before;  ///< Place of the sonar before the object's front, in its axes [m].
    };
    std::optional<glm::vec3> before(size_t object, float distance) const;
    void addObject(const Query& query, std::vector<DrawRange>& ranges) const;
    void addClusters(const Query& query, std::span<const types::Cluster> clusters,
                     std::vector<DrawRange>& ranges) const;
    bool isSingleSided(const types::Cluster& cluster) const;
    bool turnsItsBack(const Query& query, const types::Cluster& cluster) const;
    /** Distance that a box along an object's axes has at least [m]; infinite when it is out of view or range. */
    float nearest(const View& view, const ObjectRecord& object, glm::vec3 centre, glm::vec3 half) const;

    const types::Geometry& geometry_;
    CullRules rules_;
    ObjectPlaces places_;
    float range_max_;
    size_t draw_range_limit_ = 0;
};

}  // namespace insonify::sonar
