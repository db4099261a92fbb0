#pragma once
#include <cstdint>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/plan/EchoRules.hpp"

namespace insonify::sonar {

/** Rotation of the triangles of one draw, or of one run that rays hit, from object axes to sonar axes. */
struct PlacedRun {
    double normal_x[3], normal_y[3], normal_z[3];  ///< Rows of the normals' matrix [1].
    double eye[3];                                 ///< Place of the sonar in object axes [m].
    double near_limit, far_limit;                  ///< Inverse ranges of the object [1/m].
    double strength;                               ///< Strength of the material at normal incidence [1].
    const PlaneRecord* planes;                     ///< One per triangle of the mesh.
    const FacetRecord* facets;                     ///< One per triangle; null where no material of the mesh has a lobe.
    const CurveRecord* curves;  ///< One per triangle; null where no part of the mesh is a smooth body.
    uint32_t material;          ///< Index of its law in EchoRules::laws [1].
};
/** Places a run. `planes`, `facets`, `curves`: of the triangles of the object's mesh; null where it has no lobes, or is
 *  not a smooth body. */
PlacedRun placedRun(const ObjectRecord& object, const CommandRecord& command, const EchoRules& rules,
                    const PlaneRecord* planes, const FacetRecord* facets, const CurveRecord* curves);

/** Returns a normal, or a vector that is rotated like normals, in sonar axes. */
inline glm::dvec3 turned(const PlacedRun& run, const vec4& normal) {
    const auto by = [&](const double* row) {
        return row[0] * static_cast<double>(normal.x) + row[1] * static_cast<double>(normal.y) +
               row[2] * static_cast<double>(normal.z);
    };
    return {by(run.normal_x), by(run.normal_y), by(run.normal_z)};
}

/** A batch of cells. A cell is the part of a triangle's plane that is seen within a rectangle of azimuth and elevation.
 *  The rectangle belongs to one ray, to neighbouring rays of one beam, or to a beam's share of a pixel. All in sonar
 *  axes. */
struct Cells {
    static constexpr int capacity = 64;  ///< Few enough to stay in the nearest cache.

    double normal_x[capacity], normal_y[capacity], normal_z[capacity], distance[capacity];  ///< Planes, any length [m].
    double cos_az[capacity], sin_az[capacity], cos_el[capacity], sin_el[capacity];  ///< Direction of the cell's middle.
    double width[capacity], height[capacity],
        lean[capacity];                  ///< [rad], [rad], dazimuth / delevation of its sides [1].
    double size[capacity];               ///< Solid angle, in units of the source [1].
    double strength[capacity];           ///< Strength of the material [1].
    const FacetRecord* facet[capacity];  ///< Facet of its triangle; null where no material of its mesh has a lobe.
    const PlacedRun* run[capacity];      ///< Run that rotates the facet.
    uint32_t material[capacity];
    double mapped[capacity];  ///< Cosine of a mapped normal, or of a bent ray; 0: the plane's [1].
    double gain[capacity];    ///< Factor of its echo by surface maps, where EchoRules::has_maps [1].
    double focus[capacity];   ///< Intensity of bent rays relative to straight rays [1].
    double near_limit[capacity], far_limit[capacity];  ///< Inverse ranges of the object [1/m].
    int beam[capacity];
    int64_t object[capacity];  ///< Set where the truth is recorded, by getObject(); -1: a miss.
    uint32_t hits[capacity];   ///< Samples of the cell [1]. Set where the truth is recorded.
    int count = 0;
    /** A cell of a smooth body, and its curvature. */
    struct OfBody {
        int cell;
        const CurveRecord* curve;
    };
    OfBody of_bodies[capacity];
    int of_bodies_count = 0;

    /** Returns an index into Geometry::objects, which may have the bits of Truth.hpp, and a triangle in one number. */
    static int64_t getObject(uint32_t object, uint32_t triangle) { return int64_t{triangle} << 32 | object; }
    bool isFull() const { return count == capacity; }
    /** Sets the plane of cell i to that of a triangle, and the values of its material and object. */
    void setPlane(int i, const PlacedRun& placed, uint32_t triangle);
    /** Records that cell i belongs to a facet that may bend. */
    void setCurve(int i, const CurveRecord& curve) { of_bodies[of_bodies_count++] = {i, &curve}; }
    /** Empties the batch. */
    void clear() { count = of_bodies_count = 0; }
    /** Sets cell i to a miss. */
    void setMiss(int i);
};

/** Coverage of cells: Footprint as arrays, and strength times slant range. */
struct Covered {
    double pixel[Cells::capacity], centre[Cells::capacity], wide[Cells::capacity], narrow[Cells::capacity],
        per_wide[Cells::capacity], steepness[Cells::capacity], near_end[Cells::capacity], far_end[Cells::capacity],
        nearest[Cells::capacity], limb[Cells::capacity], fade[Cells::capacity], size[Cells::capacity];
    double strength_range[Cells::capacity];  ///< [m]
};

inline void Cells::setPlane(int i, const PlacedRun& placed, uint32_t triangle) {
    const vec4 &n = placed.planes[triangle].normal, &p = placed.planes[triangle].point;
    const glm::dvec3 normal = turned(placed, n);
    normal_x[i] = normal.x;
    normal_y[i] = normal.y;
    normal_z[i] = normal.z;
    distance[i] = static_cast<double>(n.x) * (static_cast<double>(p.x) - placed.eye[0]) +
                  static_cast<double>(n.y) * (static_cast<double>(p.y) - placed.eye[1]) +
                  static_cast<double>(n.z) * (static_cast<double>(p.z) - placed.eye[2]) + static_cast<double>(n.w);
    strength[i] = placed.strength;
    facet[i] = placed.facets ? placed.facets + triangle : nullptr;
    run[i] = &placed;
    material[i] = placed.material;
    mapped[i] = 0;
    near_limit[i] = placed.near_limit;
    far_limit[i] = placed.far_limit;
}

inline void Cells::setMiss(int i) {
    normal_x[i] = 1;
    normal_y[i] = normal_z[i] = distance[i] = strength[i] = mapped[i] = 0;
    near_limit[i] = far_limit[i] = focus[i] = 0;
    facet[i] = nullptr;
    material[i] = 0;
    object[i] = -1;
    hits[i] = 0;
}

}  // namespace insonify::sonar
