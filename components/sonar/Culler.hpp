#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/Interface.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Chooses what of a scene is drawn: objects, and clusters of triangles in them, whose boxes reach a
 *  slab's view within the range. */
class Culler {
public:
    /** One draw: a run of triangles of one object and material; first_index counts within the object's mesh. */
    struct Run {
        uint32_t object, first_index, index_count;
        int material;
    };

    /** `geometry` must outlive the culler. */
    Culler(const types::Geometry& geometry, double range_max);

    /** Places all objects relative to the sonar; once a ping, before `visible`. */
    void place(const types::Snapshot& snapshot);
    /** Runs that a slab may see, neighbours joined. */
    void visible(const Slab& slab, std::vector<Run>& runs) const;
    const std::vector<ObjectRecord>& records() const { return records_; }
    size_t runLimit() const { return run_limit_; }  ///< Of what `visible` gives.

private:
    using View = std::array<glm::vec3, 5>;
    vec4 extent(size_t index, const glm::dmat4& sonar_from_object) const;
    void placeObject(size_t index, const glm::dmat4& sonar_from_object);
    void addRuns(size_t object, const View& view, std::vector<Run>& runs) const;
    /** Whether a box along an object's axes may reach into a view and the range. */
    bool sees(const View& view, const ObjectRecord& object, glm::vec3 centre, glm::vec3 half) const;

    const types::Geometry& geometry_;
    float range_max_;
    struct Box {
        glm::dvec3 low{0}, high{0};
    };
    std::vector<Box> mesh_boxes_;  ///< In mesh coordinates.
    std::vector<glm::dmat4> world_from_object_;
    std::vector<ObjectRecord> records_;
    size_t run_limit_ = 0;
};

}  // namespace insonify::sonar
