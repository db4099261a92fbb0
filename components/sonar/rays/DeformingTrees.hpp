#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <vector>

#include "components/sonar/rays/SceneTrees.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Embree's trees of the objects that deform: one per object, and a tree of these trees. The structure of an object's
 *  tree follows from its mesh in the file; its boxes are refitted to the triangles of each ping. Triangles are copied
 * at their places, like those of a StillTree: rays meet them in the same places, whether they deform or not. */
class DeformingTrees {
public:
    struct Object {
        uint32_t object, first_command;
        types::MeshPtr mesh;  ///< Its positions change between pings.
    };

    DeformingTrees();
    /** Builds the trees. Throws std::runtime_error with Embree's error. */
    explicit DeformingTrees(std::vector<Object> objects);
    ~DeformingTrees();
    DeformingTrees(DeformingTrees&&) noexcept;
    DeformingTrees& operator=(DeformingTrees&&) noexcept;

    bool isEmpty() const { return objects_.empty(); }
    size_t size() const { return objects_.size(); }
    uint32_t object(size_t i) const { return objects_[i].object; }
    /** Refits the tree of one object. Several threads may call this concurrently, each with another object.
     *  @param place  place of the object about the origin of the rays */
    void fit(size_t i, const glm::dmat4& place);
    /** Refits the tree of trees, after all objects are refitted. */
    void join();

    RTCScene scene() const { return top_->scene(); }
    RTCScene scene(size_t i) const;
    /** Returns the command and triangle of a hit in scene(). */
    TreePart meaning(uint32_t geometry, uint32_t instance) const { return meaningIn(instance, geometry); }
    /** Returns the command and triangle of a hit in scene(i). */
    TreePart meaningIn(size_t i, uint32_t geometry) const;

private:
    struct Tree;

    std::vector<Object> objects_;
    std::vector<Tree> trees_;
    std::unique_ptr<EmbreeScene> top_;
};

}  // namespace insonify::sonar
