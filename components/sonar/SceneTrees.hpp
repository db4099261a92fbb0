#pragma once
#include <embree3/rtcore.h>

#include <glm/mat4x4.hpp>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::sonar {

/** A run of triangles of one material. */
struct MaterialRun {
    uint32_t first_index, index_count;
    int material;
};
std::vector<MaterialRun> materialRuns(const types::Mesh& mesh);

/** Embree's trees of a geometry, and what the numbers of their hits mean. Built by one thread, so that of surfaces in
 *  the same place the same one is met on any machine. */
class SceneTrees {
public:
    /** What a geometry of a tree is: a command, and the first triangle of its run. */
    struct Part {
        uint32_t command, first_triangle;
    };
    /** A mesh in its own axes: a part for each run of one material, with commands counted from the object's first. */
    struct MeshTree {
        RTCScene scene = nullptr;
        std::vector<glm::vec3> positions;
        std::vector<Part> parts;
    };

    /** Throws std::runtime_error where Embree has no device. */
    explicit SceneTrees(const types::Geometry& geometry);
    ~SceneTrees();
    SceneTrees(const SceneTrees&) = delete;
    SceneTrees& operator=(const SceneTrees&) = delete;

    /** Forgets what stands still. */
    void clear();
    /** Adds an object that stands still, its triangles copied to their places, or as an instance of its mesh's tree. */
    void copy(int mesh, const glm::dmat4& place, uint32_t command);
    void instance(int mesh, const glm::dmat4& place, uint32_t command);
    /** Builds the tree of what stands still. Throws std::runtime_error with Embree's error. */
    void commit();
    /** The tree of a mesh, built when it is first asked for. */
    const MeshTree& treeOf(int mesh);

    RTCScene still() const { return still_; }  ///< Null before the first commit.
    /** The command and triangle of a hit in still(). */
    Part meaning(uint32_t geometry, uint32_t instance) const {
        if (instance == RTC_INVALID_GEOMETRY_ID) return parts_[geometry];
        const Part& part = instances_[instance].mesh->parts[geometry];
        return {instances_[instance].command + part.command, part.first_triangle};
    }

private:
    /** What a geometry of still() is an instance of; no mesh: it is none. */
    struct Instance {
        const MeshTree* mesh = nullptr;
        uint32_t command = 0;
    };
    RTCScene newScene() const;
    void addRun(RTCScene scene, const types::Mesh& mesh, const MaterialRun& run,
                const std::vector<glm::vec3>& at) const;
    const types::Mesh& mesh(int index) const { return geometry_.meshes[static_cast<size_t>(index)]; }

    const types::Geometry& geometry_;
    RTCDevice device_;
    RTCScene still_ = nullptr;
    std::vector<Part> parts_;                        ///< Of each geometry of still().
    std::vector<Instance> instances_;                ///< The same.
    std::vector<std::vector<glm::vec3>> positions_;  ///< Of what is copied.
    std::vector<MeshTree> meshes_;
};

}  // namespace insonify::sonar
