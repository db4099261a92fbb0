#pragma once
#include <glm/mat3x2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "components/scene/Surface.hpp"
#include "components/scene/gltf/GltfAnimation.hpp"
#include "components/scene/gltf/GltfFile.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::scene {

/** The set of texture coordinates of a material's map, and the transform of KHR_texture_transform on them. */
struct NormalMapping {
    int uv_set = 0;
    glm::mat3x2 transform{1, 0, 0, 1, 0, 0};  ///< map uv = transform * (u, v, 1)
};

/** The maps of a material, how they are placed on meshes, and how the material is drawn. */
struct MaterialMaps {
    float opacity = 1;                     ///< Opacity of its drawing: 0 is invisible [1].
    std::optional<NormalMapping> normals;  ///< None: no normal map.
    NormalMapping on_surface;
    std::shared_ptr<const types::SurfaceMap> surface;  ///< Null: no surface map.
};

/** Adds the file's materials in their order, then the materials of surface maps' classes, and normal maps to
 *  `geometry`. Returns the maps of each material of the file. A normal map that cannot be read is a notice. A wrong
 *  `extras.acoustics` and a surface map that cannot be read are a ConfigError. */
std::vector<MaterialMaps> readMaterials(const GltfFile& gltf, const GltfAccessors& accessors,
                                        types::Geometry& geometry);

/** The parts of a file's meshes that were omitted. */
struct Omissions {
    DroppedTriangles dropped;
    size_t other_primitives = 0;     ///< Points and lines.
    size_t unmapped_primitives = 0;  ///< Primitives with a map but without texture coordinates for it.
    std::set<int> invisible;         ///< Materials whose triangles are wholly transparent and have no acoustic values.
    size_t unweighted_vertices = 0;  ///< Vertices of skins without weights; they follow the first joint.
};

/** Converts the meshes of a file to types::Mesh, one at a time. */
class GltfMeshes {
public:
    /** `geometry` holds the file's materials; a default material is added when a primitive has none. */
    GltfMeshes(const GltfFile& gltf, const GltfAccessors& accessors, std::vector<MaterialMaps> maps,
               types::Geometry& geometry)
        : gltf_(gltf), accessors_(accessors), maps_(std::move(maps)), geometry_(geometry) {}

    /** Returns a mesh of the file with one cluster per primitive; the mesh may have no triangles.
     *  Throws types::ConfigError for wrong indices. */
    types::Mesh read(size_t mesh);
    /** The same of a mesh that deforms, in clusters, with its types::Deformation.
     *  @param joints  of its skin; 0: it has none */
    types::Mesh readDeforming(size_t mesh, size_t joints);
    const Omissions& omissions() const { return omissions_; }
    /** Returns the opacity of the most opaque material of a mesh of the file [1]. */
    float opacityOfMesh(size_t mesh) const;

private:
    void append(const tinygltf::Primitive& primitive, const std::string& path, types::Mesh& mesh);
    int material(const tinygltf::Primitive& primitive, const std::string& path);
    Surface getSurface(const tinygltf::Primitive& primitive, int positions, const std::string& path);
    /** Adds what the maps of a primitive's material need to the surface, and the map to the mesh. Returns the
     *  material. */
    int mapped(const tinygltf::Primitive& primitive, const std::string& path, Surface& surface, types::Mesh& mesh);
    int withoutMap(int material, bool of_surface);
    const MaterialMaps* getMaps(int material) const {
        return static_cast<size_t>(material) < maps_.size() ? &maps_[static_cast<size_t>(material)] : nullptr;
    }
    float getOpacity(int material) const { return getMaps(material) ? getMaps(material)->opacity : 1; }
    void charge(size_t vertices, const std::string& path);
    struct Attributes;
    [[noreturn]] void fail(const std::string& path, const std::string& message) const;

    const GltfFile& gltf_;
    const GltfAccessors& accessors_;
    std::vector<MaterialMaps> maps_;
    types::Geometry& geometry_;
    Omissions omissions_;
    GltfDeformation* deformation_ = nullptr;  ///< Deformation of the present mesh; null: rigid.
    std::vector<uint32_t> numbers_;           ///< Numbers of the vertices of that mesh.
    size_t elements_ = 0;
    int default_material_ = -1;
    std::map<std::pair<int, bool>, int> unmapped_;  ///< Material without normal map, or surface map, by material with.
};

}  // namespace insonify::scene
