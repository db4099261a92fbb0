#pragma once
#include <atomic>
#include <glm/mat4x4.hpp>
#include <memory>
#include <vector>

#include "components/sonar/base/SharedValues.hpp"
#include "components/sonar/rays/Embree.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** A run of triangles of one material. */
struct MaterialRun {
    uint32_t first_index, index_count;
    int material;
};
std::vector<MaterialRun> materialRuns(const types::Mesh& mesh);

/** Meaning of a geometry of a tree: a command, and the first triangle of its run. */
struct TreePart {
    uint32_t command, first_triangle;
};

/** A scene of Embree. All scenes of a process share one device. It builds each scene with one thread, so that rays hit
 *  the same one of coincident surfaces on any machine. */
class EmbreeScene {
public:
    enum class Kind {
        Built,     ///< Built once, for fast rays.
        Refitted,  ///< Its parts keep the shape of their trees when their vertices move.
    };

    /** Throws std::runtime_error where Embree has no device. */
    explicit EmbreeScene(Kind kind = Kind::Built);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene scene() const { return scene_; }
    /** Adds a run of a mesh whose vertices are at `at`, which has one more element. Both must outlive the scene. */
    void add(const types::Mesh& mesh, const MaterialRun& run, const std::vector<glm::vec3>& at);
    /** Adds another scene, which must outlive this one. */
    void add(const EmbreeScene& other, const glm::dmat4& place);
    /** Builds the tree. Throws std::runtime_error with Embree's error, and soon after `quits` becomes true; null: it
     *  does not. */
    void commit(const std::atomic<bool>* quits = nullptr);
    /** Refits a Kind::Refitted scene after vertices have moved. */
    void recommit();

private:
    void attach(RTCGeometry geometry, bool has_vertices);

    RTCDevice device_;
    Kind kind_;
    RTCScene scene_;
    std::vector<bool> has_vertices_;  ///< Whether each part has vertices; else it is another scene.
};

/** The tree of a mesh in its own axes, with a part for each run of one material. Commands are counted from the object's
 *  first. All callers share the tree of a mesh. */
class MeshTree {
public:
    static std::shared_ptr<MeshTree> of(const types::MeshPtr& mesh);
    explicit MeshTree(types::MeshPtr mesh) : mesh_(std::move(mesh)) {}

    /** Returns the tree, built at the first call. Thread-safe. */
    const EmbreeScene& tree();
    const std::vector<TreePart>& parts() const { return parts_; }  ///< Valid once the tree is built.

private:
    types::MeshPtr mesh_;
    Once built_;
    std::vector<glm::vec3> positions_;
    std::vector<TreePart> parts_;
    std::unique_ptr<EmbreeScene> tree_;
};

/** An object at its place, and the command of its first run. */
struct TreeObject {
    types::MeshPtr mesh;
    glm::dmat4 place;
    uint32_t command;

    bool operator==(const TreeObject&) const = default;
};

/** The tree of objects at rest, with their triangles copied to their places. All callers with the same objects share
 *  it. */
class StillTree {
public:
    static std::shared_ptr<StillTree> of(const std::vector<TreeObject>& objects);
    explicit StillTree(const std::vector<TreeObject>& objects) : objects_(objects) {}

    /** Returns the tree, built at the first call. Thread-safe. Throws, without a tree, soon after `quits` becomes
     *  true. */
    const EmbreeScene& tree(const std::atomic<bool>* quits = nullptr);
    /** Returns how many trees this thread has built so far [1]. */
    static size_t builtByThisThread();
    const TreePart& part(uint32_t geometry) const { return parts_[geometry]; }
    bool isEmpty() const { return objects_.empty(); }

private:
    void build(const std::atomic<bool>* quits);

    std::vector<TreeObject> objects_;
    Once built_;
    std::vector<std::vector<glm::vec3>> positions_;  ///< Positions of each object.
    std::vector<TreePart> parts_;                    ///< Part of each geometry.
    std::unique_ptr<EmbreeScene> tree_;
};

/** Embree's trees of a scene about an origin, and the meaning of their hits. The tree of the objects at rest is used
 *  alone, or as one of the instances of a tree of trees. */
class SceneTrees {
public:
    /** `apart`: objects whose meshes have their own trees. Builds the trees that are missing. Throws std::runtime_error
     *  with Embree's error. */
    SceneTrees(const std::vector<TreeObject>& still, const std::vector<TreeObject>& apart);

    bool hasInstances() const { return top_ != nullptr; }
    RTCScene scene() const { return (top_ ? *top_ : still_->tree()).scene(); }
    /** Returns the command and first triangle of a hit. */
    TreePart meaning(uint32_t geometry, uint32_t instance) const {
        if (instance == RTC_INVALID_GEOMETRY_ID || !instances_[instance].mesh) return still_->part(geometry);
        const TreePart& part = instances_[instance].mesh->parts()[geometry];
        return {instances_[instance].command + part.command, part.first_triangle};
    }

private:
    /** A geometry of the tree of trees; no mesh: the objects at rest. */
    struct Instance {
        std::shared_ptr<MeshTree> mesh;
        uint32_t command = 0;
    };
    std::shared_ptr<StillTree> still_;
    std::vector<Instance> instances_;
    std::unique_ptr<EmbreeScene> top_;
};

}  // namespace insonify::sonar
