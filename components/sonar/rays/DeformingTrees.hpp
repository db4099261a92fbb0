#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <vector>

#include "components/sonar/rays/SceneTrees.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Embree's trees of the objects that deform: one for each, and a tree of these trees. The shape of an object's tree
 *  follows from its mesh as the file has it, and is fitted to the triangles of each ping. Triangles are copied to where
 *  they are, as those of a StillTree are: the same triangles are met in the same places, whether they deform or not. */
class DeformingTrees {
public:
    struct Object {
        uint32_t object, first_command;
        types::MeshPtr mesh;  ///< Its positions change between pings.
    };

    DeformingTrees();
    /** Throws std::runtime_error with Embree's error. */
    explicit DeformingTrees(std::vector<Object> objects);
    ~DeformingTrees();
    DeformingTrees(DeformingTrees&&) noexcept;
    DeformingTrees& operator=(DeformingTrees&&) noexcept;

    bool isEmpty() const { return objects_.empty(); }
    size_t size() const { return objects_.size(); }
    uint32_t object(size_t i) const { return objects_[i].object; }
    /** Fits the tree of one object. Several threads may do so at a time, each with another object.
     *  @param place  of the object about the origin of the rays */
    void fit(size_t i, const glm::dmat4& place);
    /** Fits the tree of trees, once all of them are fitted. */
    void join();

    RTCScene scene() const { return top_->scene(); }
    RTCScene scene(size_t i) const;
    /** The command and triangle of a hit in scene(). */
    TreePart meaning(uint32_t geometry, uint32_t instance) const { return meaningIn(instance, geometry); }
    /** The same of a hit in scene(i). */
    TreePart meaningIn(size_t i, uint32_t geometry) const;

private:
    struct Tree;

    std::vector<Object> objects_;
    std::vector<Tree> trees_;
    std::unique_ptr<EmbreeScene> top_;
};

}  // namespace insonify::sonar
