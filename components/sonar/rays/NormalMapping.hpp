#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** Normal maps at the hits of rays, looked up once for each sample. */
class NormalMapping {
public:
    static constexpr int max_samples = 64;  ///< Max samples of one call of cosines() [1].

    /** Hits of rays on triangles of one material of one object: arrays of `count` entries. */
    struct Samples {
        int count;
        const uint32_t* triangle;  ///< Within the object's mesh [1].
        const float *u, *v;        ///< Barycentric coordinates of the triangle's second and third corner [1].
        const float *x, *y, *z;    ///< Directions of the rays, unit, sonar axes [1].
        const float* extent;       ///< Longer side of the sample's footprint on the triangle's plane [m].
        const float*
            normal;  ///< Length of the triangle's unit normal after rotation by ObjectRecord::normal_x to normal_z [1].
    };

    /** The geometry must outlive it. */
    explicit NormalMapping(const types::Geometry& geometry);
    bool isMapped(int material) const { return maps_[static_cast<size_t>(material)] != nullptr; }
    /** Fills `cosine` with the cosines of the angles between rays and mapped normals, on the side that the ray hits; at
     *  least 1e-6. They are means over the part of the map that the sample covers, in which normals that face away
     * count as 0. `placed`: the object relative to the sonar. */
    void cosines(const ObjectRecord& placed, uint32_t object, int material, const Samples& samples,
                 double* cosine) const;

private:
    /** A level of a map, each half as large as the one before; four bytes per texel. */
    struct Level {
        int width, height;
        std::vector<uint8_t> texels;
        /** Roots of the mean squares along and across of the normals within a texel, and of their mean product, with
         *  sign about 128. Empty for the finest level. */
        std::vector<uint8_t> squares;
    };
    struct Map {
        std::shared_ptr<const types::NormalMap> source;
        bool repeat_u, repeat_v;
        std::vector<Level> levels;
    };
    static Map makeMap(std::shared_ptr<const types::NormalMap> source, float scale);
    /** Returns the map; all callers with the same map and scale share it. */
    static std::shared_ptr<const Map> sharedMap(const std::shared_ptr<const types::NormalMap>& source, float scale);
    /** Frames and map coordinates of samples. */
    struct Frames;
    void interpolate(uint32_t object, const Samples& samples, Frames& frames) const;
    /** Rotates normals and tangents into unit frames of sonar axes, and computes rays in these frames and the number of
     *  texels that samples cover. `texels` is the geometric mean of the map's sides. */
    static void place(const ObjectRecord& placed, float texels, const Samples& samples, Frames& frames);
    static void lookUp(const Map& map, int count, const Frames& frames, double* cosine);

    const types::Geometry& geometry_;
    std::vector<std::shared_ptr<const Map>>
        maps_;  ///< Map of each material, with its scale; null for materials without a map.
    std::vector<std::shared_ptr<MeshFacts>> facts_;  ///< Facts of each mesh, for MeshFacts::mapDensity().
};

}  // namespace insonify::sonar
