#pragma once
#include <memory>
#include <vector>

#include "components/sonar/places/MeshFacts.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** A geometry in which each object that snapshots deform has a mesh of its own, which takes its shape anew in each
 *  ping, in place. All else is shared with the geometry of the snapshots. Whoever renders this geometry reads positions
 *  and MeshFacts as of any other one, between two pings and during a ping. */
class DeformedMeshes {
public:
    /** Of the objects that a snapshot deforms, and of `others`, those known before. */
    DeformedMeshes(const types::Snapshot& snapshot, const std::vector<uint32_t>& others);

    const types::GeometryPtr& geometry() const { return geometry_; }
    /** Objects that deform, ascending. */
    const std::vector<uint32_t>& objects() const { return objects_; }
    /** Whether it is of the snapshot's geometry, and has all objects that the snapshot deforms. */
    bool serves(const types::Snapshot& snapshot) const;
    /** Whether shapes are others than those of the snapshot before; true for the first. A ping may be rendered in many
     *  parts, all of one shape. */
    bool changes(const types::Snapshot& snapshot);
    /** Takes the next shapes for others than those before. */
    void forget() { has_taken_ = false; }
    /** Poses every parts-th object from the part-th on. Parts may run at a time, while nobody reads. Allocates nothing
     *  where no tree of triangles is asked for. */
    void take(const types::Snapshot& snapshot, size_t part, size_t parts);

private:
    struct Own {
        std::shared_ptr<types::Mesh> mesh;
        types::MeshPtr rest;
        std::shared_ptr<MeshFacts> facts;
    };
    types::GeometryPtr scene_;  ///< Of the snapshots.
    types::GeometryPtr geometry_;
    std::vector<uint32_t> objects_;
    std::vector<Own> own_;  ///< Of each of objects_.
    bool has_taken_ = false;
    std::vector<types::DeformedObject> deformed_;  ///< Of the snapshot before, as are the next two.
    std::vector<types::JointPose> joints_;
    std::vector<types::MorphPose> morphs_;
};

}  // namespace insonify::sonar
