#pragma once
#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::study {

/** All triangles of a snapshot, with a search for the first triangle on a ray. Embree searches in float, about the
 *  sonar's place in that snapshot; all other data of a triangle are in double. No levels of detail. */
class RayTree {
public:
    static constexpr int packet = 16;
    static constexpr size_t packets_at_once = 4;
    static constexpr uint32_t none = ~0u;  ///< Instead of a triangle: no hit.

    struct Triangle {
        glm::dvec3 normal;  ///< Unit, axes of the world; 0 if its corners are collinear [1].
        double distance;    ///< normal.p of its points p about the origin [m].
        double mu;          ///< Its Lambert parameter [1].
        bool mapped;        ///< Its material has a normal map.
        int material;
    };
    /** Directions in the axes of the world, of any length; hits nearer than `nearest_met` lengths are ignored. */
    struct Rays {
        alignas(64) float x[packet], y[packet], z[packet], nearest[packet];
        void set(int i, const glm::dvec3& direction, double nearest_met = 0);
    };
    using Found = std::array<uint32_t, packet>;

    /** Throws std::runtime_error if Embree cannot build it. */
    explicit RayTree(const types::Snapshot& scene);
    ~RayTree();
    RayTree(const RayTree&) = delete;
    RayTree& operator=(const RayTree&) = delete;

    /** Finds the first triangle on each ray from a point about the origin, for at most `packets_at_once` packets. All
     *  rays of a call should be close together. */
    void trace(glm::dvec3 from, std::span<const Rays> rays, std::span<Found> found) const;

    /** Sets the materials' backscatter for a sonar of this configuration; before the first call Lambert's law. A call
     * that changes neither model nor frequency nor speed of sound does nothing. */
    void updateLaws(const sonar::SonarConfig& config);
    /** Returns sigma_b / cos(theta) of a triangle that is hit along a unit direction, axes of the world, at a range [1,
     *  m]. */
    double backscatter(uint32_t triangle, double cosine, const glm::dvec3& direction, double range) const {
        const Triangle& plane = triangles_[triangle];
        if (laws_.records.empty()) return plane.mu * cosine;
        const auto material = static_cast<size_t>(plane.material);
        return laws_.overCosine(material, cosine, lobeSlopes(triangle, cosine, direction, range));
    }

    /** Returns sigma_b over the cosine of one path, for sound that arrives or leaves along the other path [1].
     *  `middle`: of the two directions, unit, axes of the world; `range`: half of the path out and back [m].
     *  ACOUSTICS.md 5.23. */
    double bistatic(uint32_t triangle, double cosine, double other, const glm::dvec3& middle, double range) const;

    /** Returns whether a material has a lobe, which depends on direction and range. */
    bool hasLobes() const { return !facets_.empty(); }
    const glm::dvec3& origin() const { return origin_; }  ///< In the world [m].
    const Triangle& operator[](uint32_t triangle) const { return triangles_[triangle]; }
    /** Returns the object of a triangle: index into the geometry's objects [1]. */
    uint32_t getObject(uint32_t triangle) const { return sources_[triangle].object; }

    /** Returns the cosine between a unit direction and the mapped normal at a point of a mapped triangle (about the
     *  origin). As in glTF: normal, tangent and uv of the corners weighted by the point's place, the map bilinear
     *  without mipmaps. At least 1e-6, either side. */
    double mappedCosine(uint32_t triangle, glm::dvec3 point, glm::dvec3 direction) const;

private:
    sonar::LobeSlopes lobeSlopes(uint32_t triangle, double cosine, const glm::dvec3& direction, double range) const;

    struct Embree;
    /** The origin of a triangle. */
    struct Source {
        uint32_t object, first_index;
        int material;
    };
    /** Properties of a sonar that laws depend on. */
    struct Hearer {
        sonar::Model model;
        std::optional<double> frequency_khz;
        double speed_of_sound;
        bool operator==(const Hearer&) const = default;
    };
    struct Place {
        glm::dmat4 origin_from_object;
        glm::dmat3 normals;
    };
    void add(uint32_t object, std::vector<glm::dvec3>& corners);
    /** Returns the corners about the origin [m]. */
    std::array<glm::dvec3, 3> getCorners(const Source& source) const;

    types::GeometryPtr geometry_;
    glm::dvec3 origin_;
    std::vector<Place> places_;  ///< Place of each object.
    std::vector<Triangle> triangles_;
    std::vector<sonar::FacetRecord> facets_;  ///< Axes of each triangle in the world; empty without lobes.
    std::vector<Source> sources_;             ///< Source of each triangle.
    sonar::MaterialLaws laws_;                ///< None if all materials follow Lambert's law.
    std::optional<Hearer> received_by_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace insonify::study
