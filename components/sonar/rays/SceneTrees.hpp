#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/base/MadeAhead.hpp"
#include "components/sonar/base/SharedValues.hpp"
#include "components/sonar/rays/Embree.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "types/geometry/Geometry.hpp"

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

/** Returns the origin about which the scene has its trees, for a place of the sonar: the nearest point of a grid of
 *  512 m, so at most 444 m away, where float resolves 0.03 mm. It depends on nothing else, so that pings are
 *  independent of pings before [m]. */
glm::dvec3 originNear(const glm::dvec3& sonar);

/** Returns objects at their places about an origin [m]. */
std::vector<TreeObject> objectsAbout(const std::vector<TreeObject>& in_world, const glm::dvec3& origin);

/** Builds the trees of the objects at rest about the origins that a moving sonar may need next, by MadeAhead, and keeps
 *  them: up to eight, where the sonar is near a corner of the cells about origins. */
class TreesAhead {
public:
    using Objects = std::shared_ptr<const std::vector<TreeObject>>;

    static constexpr double near = 32;  ///< Distance from the cell of an origin at which its tree is built [m].
    static constexpr double kept = 64;  ///< Max distance at which it is kept [m].
    static constexpr size_t max_origins = 8;
    /** Max triangles of all trees, unless two trees alone have more [1]. */
    static constexpr size_t max_triangles = 16'000'000;

    /** Follows a sonar through the objects at rest, at their places in the world; the list must not change. A sonar
     *  that jumps further than `near`, or rests in new objects, needs nothing, and what it needed is given up. Returns
     * whether other origins are needed now, for send(). */
    bool follow(const glm::dvec3& sonar, const Objects& objects);
    /** Has the trees of the origins built. Does not wait. */
    void send();
    /** Whether an origin is needed. */
    bool needs(const glm::dvec3& origin) const;
    /** Returns whether all trees are built. */
    bool isDone() const { return ahead_.isDone(); }

private:
    struct Origins {
        std::array<glm::dvec3, max_origins> all;
        size_t count = 0;

        std::span<const glm::dvec3> needed() const { return std::span(all).first(count); }
    };
    /** Returns the origins of the cells near the sonar, the nearest first; none where it is near its own only, whose
     *  tree is in use. */
    Origins originsAround(const glm::dvec3& sonar) const;
    void setObjects(const Objects& objects);

    Objects objects_;
    size_t max_count_ = 0;  ///< Max number of origins, by the triangles of the objects.
    int64_t version_ = 0;   ///< Number of different lists of objects so far.
    Origins origins_;
    std::optional<glm::dvec3> before_;  ///< Place of the sonar in the ping before.
    MadeAhead ahead_{"trees ahead"};
};

/** Prepares the expensive data of meshes that a later ping will need, by MadeAhead. */
class MeshesAhead {
public:
    using Meshes = std::shared_ptr<const std::vector<types::MeshPtr>>;

    /** Sets the meshes that will be needed, with these laws; null: none. Does not wait. */
    void take(const Meshes& meshes, const MaterialLaws& laws);

private:
    Meshes taken_;  ///< Argument of the last take().
    MadeAhead ahead_{"meshes ahead"};
};

}  // namespace insonify::sonar
