#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "components/sonar/fan/BeamFan.hpp"
#include "components/sonar/places/ObjectPlaces.hpp"

namespace insonify::sonar {

/** What may be left out of a picture. */
struct CullRules {
    double range_min;       ///< Slant range from which on is drawn [m].
    Reach reach;            ///< Beyond it nothing is.
    bool draw_all = false;  ///< Nothing is culled.
};

/** Chooses what of a scene is drawn: objects, and clusters of triangles in them, whose boxes reach a frustum's view
 *  within the range; of the clusters of a closed, single-sided mesh not those that turn their backs. They are drawn
 *  with all their triangles: of a rough floor no fewer keep the echo within 0.005 (rel_l2_tvg). */
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

    /** Outward normals of the planes that bound a frustum's view, all through the sonar; sonar axes, of any length. */
    using View = std::array<glm::vec3, 5>;
    static View viewOf(const ViewFrustum& frustum);
    /** What a frustum may see of an object: NOT_IN_VIEW, IN_VIEW, FRONT_IN_VIEW or DRAWN_WHOLE. */
    uint32_t inView(const View& view, size_t object) const;
    float rangeMax() const { return range_max_; }
    /** Whether of a cluster the back is never seen. */
    bool isSingleSided(const types::Cluster& cluster) const;

private:
    /** What is asked of the parts of an object. */
    struct Query {
        size_t object;
        const View& view;
        uint32_t in_view;
    };
    void addObject(const Query& query, std::vector<DrawRange>& ranges) const;
    void addClusters(const Query& query, std::span<const types::Cluster> clusters,
                     std::vector<DrawRange>& ranges) const;
    bool turnsItsBack(const Query& query, const types::Cluster& cluster) const;
    /** Whether a box along an object's axes may be in view and range. */
    bool mayShow(const Query& query, glm::vec3 centre, glm::vec3 half) const;

    const types::Geometry& geometry_;
    CullRules rules_;
    ObjectPlaces places_;
    float range_max_;
    size_t draw_range_limit_ = 0;
};

}  // namespace insonify::sonar
