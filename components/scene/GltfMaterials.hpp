#pragma once
#include <glm/mat3x2.hpp>
#include <optional>
#include <vector>

#include "components/scene/GltfAccessor.hpp"
#include "components/scene/GltfFile.hpp"
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Which texture coordinates a material's normal map takes, and the transform of KHR_texture_transform on them. */
struct NormalMapping {
    int uv_set = 0;
    glm::mat3x2 transform{1, 0, 0, 1, 0, 0};  ///< map uv = transform * (u, v, 1)
};

/** Adds the file's materials, in its order, and their normal maps to `geometry`; what cannot be read is a notice.
 *  Returns the mapping of each material that has a normal map. `extras.acoustics` that is wrong is a ConfigError. */
std::vector<std::optional<NormalMapping>> readMaterials(const GltfFile& gltf, const GltfAccessors& accessors,
                                                        types::Geometry& geometry);

}  // namespace insonify::scene
