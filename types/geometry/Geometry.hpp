#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "types/text/Notice.hpp"

namespace insonify::types {

/** A list whose copies share their items. Before an item is changed through one list, it is copied if another owner has
 *  it as well. Two lists with the same pointer at an index therefore have the same item. */
template <class T>
class SharedList {
    template <class List, class Item>
    class Iterator {
    public:
        using value_type = T;
        using difference_type = std::ptrdiff_t;
        using reference = Item&;
        using pointer = Item*;
        using iterator_category = std::forward_iterator_tag;

        Iterator() = default;
        Iterator(List* list, size_t index) : list_(list), index_(index) {}
        Item& operator*() const { return (*list_)[index_]; }
        Item* operator->() const { return &(*list_)[index_]; }
        Iterator& operator++() {
            ++index_;
            return *this;
        }
        Iterator operator++(int) { return {list_, index_++}; }
        friend difference_type operator-(const Iterator& a, const Iterator& b) {
            return static_cast<difference_type>(a.index_) - static_cast<difference_type>(b.index_);
        }
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.index_ == b.index_; }

    private:
        List* list_ = nullptr;
        size_t index_ = 0;
    };

public:
    using Ptr = std::shared_ptr<const T>;
    using value_type = T;
    using iterator = Iterator<SharedList, T>;
    using const_iterator = Iterator<const SharedList, const T>;

    SharedList() = default;
    SharedList(std::vector<T> items) {  // NOLINT(google-explicit-constructor): a list of items is one
        items_.reserve(items.size());
        for (T& item : items) push_back(std::move(item));
    }
    SharedList(std::initializer_list<T> items) : SharedList(std::vector<T>(items)) {}

    size_t size() const { return items_.size(); }
    bool empty() const { return items_.empty(); }
    const T& operator[](size_t index) const { return *items_[index]; }
    const T& at(size_t index) const { return *items_.at(index); }
    const T& front() const { return *items_.front(); }
    const T& back() const { return *items_.back(); }
    const_iterator begin() const { return {this, 0}; }
    const_iterator end() const { return {this, size()}; }
    /** Returns an owner of the item, which may outlive the list. */
    const Ptr& shared(size_t index) const { return items_[index]; }
    /** Returns whether both lists have the same items, by their addresses. */
    bool sharesAll(const SharedList& other) const { return items_ == other.items_; }

    T& operator[](size_t index) { return own(items_[index]); }
    T& at(size_t index) { return own(items_.at(index)); }
    T& front() { return own(items_.front()); }
    T& back() { return own(items_.back()); }
    iterator begin() { return {this, 0}; }
    iterator end() { return {this, size()}; }
    void push_back(T item) { items_.push_back(std::make_shared<T>(std::move(item))); }
    void push_back(Ptr item) { items_.push_back(std::move(item)); }
    void replace(size_t index, Ptr item) { items_.at(index) = std::move(item); }
    template <class... Arguments>
    T& emplace_back(Arguments&&... arguments) {
        push_back(T{std::forward<Arguments>(arguments)...});
        return back();
    }
    void pop_back() { items_.pop_back(); }
    void clear() { items_.clear(); }
    void reserve(size_t count) { items_.reserve(count); }
    void resize(size_t count) {
        while (size() > count) pop_back();
        while (size() < count) emplace_back();
    }

private:
    static T& own(Ptr& item) {
        if (item.use_count() > 1) item = std::make_shared<T>(*item);
        return const_cast<T&>(*item);  // made by this class as a T that is not const, and nobody else has it
    }

    std::vector<Ptr> items_;
};

/** A wall that a surface represents, with water on both sides, or air or another fluid behind it. */
struct Shell {
    double thickness = 0;     ///< [m]
    double density = 0;       ///< [kg/m^3]
    double sound_speed = 0;   ///< Speed of longitudinal waves [m/s].
    double shear_speed = 0;   ///< Speed of shear waves [m/s]; 0: a fluid.
    double loss = 0;          ///< Imaginary over real part of the wave numbers [1].
    bool has_air = false;     ///< Air instead of water behind the wall.
    double fill_density = 0;  ///< Density of the fluid behind the wall [kg/m^3]; 0: air or water.
    double fill_speed = 0;    ///< Speed of sound in this fluid [m/s].
    double fill_loss = 0;     ///< Imaginary over real part of the wave number in this fluid [1].

    bool operator==(const Shell&) const = default;
};

/** Acoustic properties of a surface. The defaults are neutral: medium sand in `physical`, reflectivity 1 in
 *  `cerqueira2017`. */
struct Material {
    std::string name;
    float lambert_db = -16.7f;  ///< Lambert parameter mu, backscatter at normal incidence [dB].
    std::string seabed = {};    ///< Sediment of APL-UW TR 9407; replaces Lambert's law if the sonar has a frequency.
    std::string matter = {};    ///< A rough solid by name; replaces Lambert's law if the sonar has a frequency.
    std::vector<glm::dvec2> measured = {};      ///< Ascending grazing angles and strengths; replace both [deg, dB].
    float reflection = 0;                       ///< Pressure reflection coefficient at normal incidence, signed [1].
    std::optional<float> roughness_slope = {};  ///< Rms slope of the micro-relief: adds a specular lobe [1].
    std::optional<Shell> shell = {};            ///< A thin wall, which transmits sound; without it no sound passes.
    bool mirror = false;                        ///< Reflects sound as a flat mirror, in addition to scattering.
    float reflectivity = 1;                     ///< Factor of `cerqueira2017` [1].
    bool has_acoustics = false;                 ///< False: no acoustic values in the file, the defaults above apply.
    bool is_named = false;                      ///< The acoustic values follow from the material's name.
    bool double_sided = false;                  ///< Flag of the file; both sides reflect sound in any case.
    int normal_map = -1;                        ///< Index into Geometry::normal_maps, -1 for none [1].
    float normal_scale = 1;                     ///< Scale of the map's x and y [1].
    float max_map_strength = 0;                 ///< Max factor of maps on its surfaces; 0: no maps [1].

    bool operator==(const Material&) const = default;
};

/** A tangent-space normal map: RGB, 8 bits, rows from top to bottom; (r, g, b) * 2 / 255 - 1 is the normal. */
struct NormalMap {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
    bool repeat_u = true, repeat_v = true;  ///< Else clamped to the edge.
};

/** A picture on a surface with a factor of the echo, a material, or both for each texel. Rows are from top to
 *  bottom. */
struct SurfaceMap {
    static constexpr uint8_t no_class = 255;  ///< The texel has the surface's own material.

    int width = 0, height = 0;
    std::vector<float> strengths;           ///< Factor of each texel's intensity, at least 0 [1]; empty: 1.
    std::vector<uint8_t> classes;           ///< Index of each texel into `materials`, or no_class; may be empty.
    std::vector<int> materials;             ///< Index of each class into Geometry::materials.
    bool repeat_u = true, repeat_v = true;  ///< Else clamped to the edge.
};

/** The map of a mesh's triangles of one material. */
struct MappedMaterial {
    int material;  ///< Index into Geometry::materials.
    std::shared_ptr<const SurfaceMap> map;
};

/** Consecutive triangles of one material that are rasterised or culled together. */
struct Cluster {
    uint32_t first_index = 0;  ///< Into Mesh::indices; a multiple of 3 [1].
    uint32_t index_count = 0;  ///< A multiple of 3 [1].
    int material = 0;          ///< Index into Geometry::materials [1].
    glm::vec3 centre{0};       ///< Centre of the bounding box along the mesh's axes [m].
    glm::vec3 half{0};         ///< Half the box's size [m].
    glm::vec3 cone_apex{0};    ///< Apex of a cone from which only backs of the triangles are visible [m].
    glm::vec3 cone_axis{0};    ///< Unit vector from the apex, away from the cone [1].
    float cone_cutoff = 2;     ///< Cosine between the axis and the cone's side; 2: no cone [1].
};

/** A part of a large mesh, to cull many clusters at once. */
struct ClusterNode {
    uint32_t first_cluster = 0;  ///< Into Mesh::clusters [1].
    uint32_t cluster_count = 0;  ///< Number of clusters, all of one material [1].
    uint32_t next = 0;           ///< Index of the first node behind this node and its parts, which follow it [1].
    glm::vec3 centre{0};         ///< Centre of the bounding box along the mesh's axes [m].
    glm::vec3 half{0};           ///< Half the box's size [m].
};

/** Weight of one joint for a vertex. */
struct JointShare {
    uint32_t joint;  ///< Index in the pose [1].
    float weight;    ///< Above 0 [1].
};

/** Offsets that a morph target at weight 1 adds to the vertices of a mesh. Each list is empty or has one entry per
 * vertex. */
struct MorphTarget {
    std::vector<glm::vec3> positions;  ///< [m]
    std::vector<glm::vec3> normals;    ///< [1]
    std::vector<glm::vec3> tangents;   ///< [1]
};

/** Data that pose a mesh by the joints of a skin and the weights of morph targets. Lists are in the order of the mesh's
 *  vertices. */
struct Deformation {
    std::vector<glm::vec3> positions;   ///< Unposed [m].
    std::vector<glm::vec3> normals;     ///< Empty, or one per vertex [1].
    std::vector<glm::vec4> tangents;    ///< Empty, or one per vertex [1].
    uint32_t joint_count = 0;           ///< Joints of a pose; 0: no skin.
    std::vector<uint32_t> share_begin;  ///< Start of each vertex's `shares`, and the end; empty without a skin.
    std::vector<JointShare> shares;     ///< Weights of one vertex add up to 1.
    std::vector<MorphTarget> targets;
};

/** Triangles in their own coordinates (z up, x north-like). Every index is below positions.size(); positions are
 *  finite. */
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;  ///< [m]
    std::vector<glm::vec3> normals;    ///< Per vertex or empty; unit, for normal maps [1].
    std::vector<glm::vec4> tangents;   ///< Per vertex or empty; w = handedness [1].
    std::vector<glm::vec2> uvs;        ///< Per vertex or empty; for the normal map, texture transform applied [1].
    std::vector<glm::vec2> map_uvs;    ///< Per vertex or empty; for `maps`, texture transform applied [1].
    std::vector<MappedMaterial> maps;  ///< At most one map per material.
    std::vector<uint32_t> indices;     ///< Three per triangle.
    std::vector<Cluster> clusters;     ///< Together they cover all indices, in order.
    std::vector<ClusterNode> cluster_nodes;  ///< Trees over all clusters, each node before its parts; may be empty.
    std::vector<uint32_t> coarse_indices;    ///< A large mesh in few triangles, for display only.
    std::shared_ptr<const Deformation> deformation = {};  ///< Shape by pose (PosedMesh.hpp); null: rigid.
};

using MeshPtr = std::shared_ptr<const Mesh>;

/** An instance of a mesh in the world. */
struct Object {
    std::string name;                 ///< Name of the node; unique, except that all tiles of a survey share a name.
    int mesh = 0;                     ///< Index into Geometry::meshes.
    glm::dmat4 world_from_object{1};  ///< May scale and mirror [m].
    /** Whether the object may appear or disappear between geometries. A renderer keeps the data of its mesh separate,
     *  so that the data of other objects need not be made again. */
    bool transient = false;
};

/** A scene, immutable once loaded: an equal pointer means that nothing has changed. A changed copy shares all unchanged
 *  items with the original. The world is z-up. */
struct Geometry {
    SharedList<Mesh> meshes;
    std::vector<Object> objects;
    std::vector<Material> materials;  ///< Never empty when there is a mesh.
    SharedList<NormalMap> normal_maps;
    Notices notices;  ///< What the loader has omitted or repaired, a sentence each.

    size_t triangleCount() const {
        size_t count = 0;
        for (const Object& object : objects) count += meshes[static_cast<size_t>(object.mesh)].indices.size() / 3;
        return count;
    }
};
using GeometryPtr = std::shared_ptr<const Geometry>;

}  // namespace insonify::types
