#pragma once
#include <memory>
#include <vector>

#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** A geometry in which each object that snapshots deform has its own mesh. The mesh is posed in place at each ping; all
 *  other parts are shared with the geometry of the snapshots. Renderers read positions and MeshFacts as of any other
 *  geometry, between two pings and during a ping. */
class DeformedMeshes {
public:
    /** Copies the meshes of the objects that a snapshot deforms, and of `others`, objects known from before. */
    DeformedMeshes(const types::Snapshot& snapshot, const std::vector<uint32_t>& others);

    const types::GeometryPtr& geometry() const { return geometry_; }
    /** Returns the objects that deform, ascending. */
    const std::vector<uint32_t>& objects() const { return objects_; }
    /** Returns whether this was made from the snapshot's geometry and contains all objects that the snapshot deforms.
     */
    bool serves(const types::Snapshot& snapshot) const;
    /** Returns whether shapes differ from those of the snapshot before; true for the first. A ping may be rendered in
     *  many parts, all with one shape. */
    bool changes(const types::Snapshot& snapshot);
    /** Makes changes() return true for the next snapshot. */
    void forget() { has_taken_ = false; }
    /** Poses every parts-th object, starting with the part-th. Parts may run concurrently, while no thread reads.
     *  Allocates nothing unless a tree of triangles is in use. */
    void take(const types::Snapshot& snapshot, size_t part, size_t parts);

private:
    struct Own {
        std::shared_ptr<types::Mesh> mesh;
        types::MeshPtr rest;
        std::shared_ptr<MeshFacts> facts;
    };
    types::GeometryPtr scene_;  ///< Geometry of the snapshots.
    types::GeometryPtr geometry_;
    std::vector<uint32_t> objects_;
    std::vector<Own> own_;  ///< One per objects_.
    bool has_taken_ = false;
    std::vector<types::DeformedObject> deformed_;  ///< From the snapshot before, like the next two.
    std::vector<types::JointPose> joints_;
    std::vector<types::MorphPose> morphs_;
};

}  // namespace insonify::sonar
