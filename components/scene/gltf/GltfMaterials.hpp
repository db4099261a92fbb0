#pragma once
#include <glm/mat3x2.hpp>
#include <memory>
#include <optional>
#include <vector>

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

}  // namespace insonify::scene
