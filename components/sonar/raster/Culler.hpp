#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/surfaces/ObjectPlacements.hpp"

namespace insonify::sonar {

/** Rules for omitting triangles from a picture. */
struct CullRules {
    double range_min;       ///< Nearest slant range that is rasterised [m].
    Reach reach;            ///< Nothing beyond it is rasterised.
    bool draw_all = false;  ///< Nothing is culled.
};

/** Chooses the parts of a scene that are rasterised: objects, and clusters of their triangles, whose boxes intersect a
 *  frustum's view within the range. Omits the back-facing clusters of a closed, single-sided mesh. Clusters keep all
 *  their triangles: on a rough floor, fewer triangles do not keep the echo within 0.005 (rel_l2_tvg). */
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

    /** Switches to other rules from the next ping on. */
    void setRules(const CullRules& rules);
    /** Places all objects relative to the sonar; call it once per ping, before `visible`. */
    void place(const types::Snapshot& snapshot) { places_->place(snapshot); }
    /** Lists the runs that a frustum may see, neighbours joined. */
    void visible(const ViewFrustum& frustum, std::vector<DrawRange>& ranges) const;
    const std::vector<ObjectRecord>& records() const { return places_->records(); }
    size_t drawRangeLimit() const { return draw_range_limit_; }  ///< Max runs from `visible`.

    /** Outward normals of the planes that bound a frustum's view, all through the sonar; sonar axes, of any length. */
    using View = std::array<glm::vec3, 5>;
    static View computeView(const ViewFrustum& frustum);
    /** Returns what a frustum may see of an object: NOT_IN_VIEW, IN_VIEW, FRONT_IN_VIEW or WHOLE_IN_VIEW. */
    uint32_t inView(const View& view, size_t object) const;
    float rangeMax() const { return range_max_; }
    /** Returns whether the back of a cluster is never seen. */
    bool isSingleSided(const types::Cluster& cluster) const;

private:
    /** A query about the parts of an object. */
    struct Query {
        size_t object;
        const View& view;
        uint32_t in_view;
    };
    void addObject(const Query& query, std::vector<DrawRange>& ranges) const;
    void addClusters(const Query& query, std::span<const types::Cluster> clusters,
                     std::vector<DrawRange>& ranges) const;
    bool turnsItsBack(const Query& query, const types::Cluster& cluster) const;
    /** Returns whether a box along an object's axes may be in view and range. */
    bool mayShow(const Query& query, glm::vec3 centre, glm::vec3 half) const;

    const types::Geometry& geometry_;
    CullRules rules_;
    std::optional<ObjectPlacements> places_;
    float range_max_;
    size_t draw_range_limit_ = 0;
};

}  // namespace insonify::sonar
