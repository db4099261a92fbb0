#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "components/sonar/echo/Interface.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** How normal maps bend what rays meet: looked up for what is seen, once for each sample. */
class NormalMapping {
public:
    /** Where a ray has met a triangle. */
    struct Place {
        uint32_t object, triangle;  ///< Of the geometry; within the object's mesh [1].
        int material;
        float u, v;           ///< Barycentric coordinates of the triangle's second and third corner [1].
        glm::vec3 direction;  ///< Of the ray, unit, sonar axes [1].
        float extent;         ///< Of the sample across the ray [m].
    };

    /** The geometry must outlive it. */
    explicit NormalMapping(const types::Geometry& geometry);
    bool isMapped(int material) const { return geometry_.materials[static_cast<size_t>(material)].normal_map >= 0; }
    /** Cosine of the angle between the ray and the bent normal, on the side that the ray meets; at least 1e-6. Cosines
     *  are averaged over as much of the map as the sample covers. `placed`: the object relative to
     *  the sonar. */
    float cosine(const ObjectRecord& placed, const Place& place) const;

private:
    /** A map and its halvings, four bytes a texel. */
    struct Level {
        int width, height;
        std::vector<uint8_t> texels;
    };
    struct Map {
        std::shared_ptr<const types::NormalMap> source;
        bool repeat_u, repeat_v;
        std::vector<Level> levels;
    };
    static Map mapOf(std::shared_ptr<const types::NormalMap> source, float scale);
    /** The same; all who ask for the same map and scale share it. */
    static std::shared_ptr<const Map> sharedMap(const std::shared_ptr<const types::NormalMap>& source, float scale);
    static glm::vec3 texel(const Map& map, glm::vec2 uv, float level);
    /** Texels of a map on a metre of a triangle as it is placed. */
    float texelsPerMetre(const ObjectRecord& placed, const types::Mesh& mesh, const uint32_t* corners,
                         const Level& finest) const;

    const types::Geometry& geometry_;
    std::vector<std::shared_ptr<const Map>> maps_;  ///< Of each material, with its scale; null for one without.
};

}  // namespace insonify::sonar
