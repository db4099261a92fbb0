#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "types/SharedList.hpp"

namespace insonify::types {

/** A wall that a surface stands for, with water on both sides, or air or another fluid behind it. */
struct Shell {
    double thickness = 0;     ///< [m]
    double density = 0;       ///< [kg/m^3]
    double sound_speed = 0;   ///< Speed of longitudinal waves [m/s].
    double shear_speed = 0;   ///< 0: as a fluid [m/s].
    double loss = 0;          ///< Imaginary over real part of the wave numbers [1].
    bool has_air = false;     ///< Air behind it, and not water.
    double fill_density = 0;  ///< Of the fluid behind it; 0: air or water [kg/m^3].
    double fill_speed = 0;    ///< Speed of sound there [m/s].
    double fill_loss = 0;     ///< Imaginary over real part of the wave number there [1].

    bool operator==(const Shell&) const = default;
};

/** What a surface does to sound. Neutral: medium sand in `physical`, reflectivity 1 in `cerqueira2017`. */
struct Material {
    std::string name;
    float lambert_db = -16.7f;  ///< Lambert parameter mu, backscatter at normal incidence [dB].
    std::string seabed = {};    ///< By APL-UW TR 9407, for Lambert's law where a sonar has a frequency.
    std::string matter = {};    ///< By name: a rough solid, for Lambert's law where a sonar has a frequency.
    std::vector<glm::dvec2> measured = {};  ///< Grazing angles, ascending, and strengths, in place of both [deg, dB].
    float reflection = 0;                   ///< Pressure reflection coefficient at normal incidence, signed [1].
    std::optional<float> roughness_slope = {};  ///< Rms slope of the micro-relief: adds a specular lobe [1].
    std::optional<Shell> shell = {};            ///< A thin wall: what goes through is heard; else nothing does.
    bool mirror = false;                        ///< Reflects sound as a flat mirror does, beside what it scatters.
    float reflectivity = 1;                     ///< Factor of `cerqueira2017` [1].
    bool has_acoustics = false;                 ///< False: no acoustic values in the file, the defaults above stand.
    bool is_named = false;                      ///< Its acoustic values follow from its name.
    bool double_sided = false;                  ///< As the file says; sound is reflected by both sides in any case.
    int normal_map = -1;                        ///< Index into Geometry::normal_maps, -1 for none [1].
    float normal_scale = 1;                     ///< Scale of the map's x and y [1].
    float max_map_strength = 0;                 ///< Surfaces of it have maps, with factors up to this; 0: none [1].

    bool operator==(const Material&) const = default;
};

/** A tangent-space normal map: RGB, 8 bits, rows from top to bottom; (r, g, b) * 2 / 255 - 1 is the normal. */
struct NormalMap {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
    bool repeat_u = true, repeat_v = true;  ///< Else clamped to the edge.
};

/** A picture on a surface: how much of its echo each place returns, of which material it is, or both. Rows from top to
 *  bottom. */
struct SurfaceMap {
    static constexpr uint8_t no_class = 255;  ///< Of the surface's own material.

    int width = 0, height = 0;
    std::vector<float> strengths;           ///< Factor of each texel's intensity, at least 0 [1]; or empty: 1.
    std::vector<uint8_t> classes;           ///< Index of each texel into `materials`, or no_class; or empty.
    std::vector<int> materials;             ///< Of each class an index into Geometry::materials.
    bool repeat_u = true, repeat_v = true;  ///< Else clamped to the edge.
};

/** The map of a mesh's triangles of one material. */
struct MappedMaterial {
    int material;  ///< Index into Geometry::materials.
    std::shared_ptr<const SurfaceMap> map;
};

/** A run of triangles of one material that is drawn or culled as one. */
struct Cluster {
    uint32_t first_index = 0;  ///< Into Mesh::indices; a multiple of 3 [1].
    uint32_t index_count = 0;  ///< A multiple of 3 [1].
    int material = 0;          ///< Index into Geometry::materials [1].
    glm::vec3 centre{0};       ///< Of a box along the mesh's axes that holds all its triangles [m].
    glm::vec3 half{0};         ///< Half the box's size [m].
    glm::vec3 cone_apex{0};    ///< Of a cone from which only backs of its triangles are seen [m].
    glm::vec3 cone_axis{0};    ///< Unit, from the apex away from there [1].
    float cone_cutoff = 2;     ///< Cosine between the axis and the cone's side; 2: there is no such cone [1].
};

/** A part of a large mesh, so that what is out of view is found out for many clusters at once. */
struct ClusterNode {
    uint32_t first_cluster = 0;  ///< Into Mesh::clusters [1].
    uint32_t cluster_count = 0;  ///< All of one material [1].
    uint32_t next = 0;           ///< The first patch that is no part of this one; its parts come directly after it [1].
    glm::vec3 centre{0};         ///< Of a box along the mesh's axes that holds all its triangles [m].
    glm::vec3 half{0};           ///< Half the box's size [m].
};

/** How much a vertex follows one joint. */
struct JointShare {
    uint32_t joint;  ///< Of the pose [1].
    float weight;    ///< Above 0 [1].
};

/** What a morph target at weight 1 adds to each vertex of a mesh. Each list is empty or has one entry per vertex. */
struct MorphTarget {
    std::vector<glm::vec3> positions;  ///< [m]
    std::vector<glm::vec3> normals;    ///< [1]
    std::vector<glm::vec3> tangents;   ///< [1]
};

/** How the vertices of a mesh follow the joints of a skin and the weights of morph targets. Its lists are in the order
 *  of the mesh's vertices. */
struct Deformation {
    std::vector<glm::vec3> positions;   ///< Before joints and targets move them [m].
    std::vector<glm::vec3> normals;     ///< Empty, or one per vertex [1].
    std::vector<glm::vec4> tangents;    ///< Empty, or one per vertex [1].
    uint32_t joint_count = 0;           ///< Joints that a pose has; 0: there is no skin.
    std::vector<uint32_t> share_begin;  ///< First of each vertex among `shares`, and their end; empty without a skin.
    std::vector<JointShare> shares;     ///< Weights of one vertex add up to 1.
    std::vector<MorphTarget> targets;
};

/** Triangles in their own coordinates (z up, x north-like). Every index is below positions.size(); positions are
 *  finite. */
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;  ///< [m]
    std::vector<glm::vec3> normals;    ///< Per vertex, unit, for normal maps; empty or as many as positions [1].
    std::vector<glm::vec4> tangents;   ///< Per vertex, w = handedness; empty or as many as positions [1].
    std::vector<glm::vec2> uvs;  ///< Of the normal map, texture transform applied; empty or as many as positions [1].
    std::vector<glm::vec2> map_uvs;          ///< Of `maps`, transform applied; empty or as many as positions [1].
    std::vector<MappedMaterial> maps;        ///< At most one of a material.
    std::vector<uint32_t> indices;           ///< Three a triangle.
    std::vector<Cluster> clusters;           ///< Together they cover all indices, in order.
    std::vector<ClusterNode> cluster_nodes;  ///< Trees over all clusters, each patch before its parts; or none.
    std::vector<uint32_t> coarse_indices;    ///< A large mesh in few triangles, to look at; never what a sonar hears.
    std::shared_ptr<const Deformation> deformation = {};  ///< How a pose changes its shape (PosedMesh.hpp); null: none.
};

using MeshPtr = std::shared_ptr<const Mesh>;

/** One placing of a mesh in the world. */
struct Object {
    std::string name;                 ///< Of the node; unique, but that all tiles of a survey have the same.
    int mesh = 0;                     ///< Index into Geometry::meshes.
    glm::dmat4 world_from_object{1};  ///< May scale and mirror [m].
    /** Whether it appears and disappears from one geometry to the next: what a renderer makes of its mesh is then kept
     *  apart from the rest, so that the rest is not made again. */
    bool transient = false;
};

/** A scene, immutable once loaded: an equal pointer means that nothing changed. A geometry that is copied and then
 *  changed shares with the first one all that has not changed. World is z-up. */
struct Geometry {
    SharedList<Mesh> meshes;
    std::vector<Object> objects;
    std::vector<Material> materials;  ///< Never empty when there is a mesh.
    SharedList<NormalMap> normal_maps;
    std::vector<std::string> notices;  ///< What the loader left out or mended, a sentence each.

    size_t triangleCount() const {
        size_t count = 0;
        for (const Object& object : objects) count += meshes[static_cast<size_t>(object.mesh)].indices.size() / 3;
        return count;
    }
};
using GeometryPtr = std::shared_ptr<const Geometry>;

}  // namespace insonify::types
